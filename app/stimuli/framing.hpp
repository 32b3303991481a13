// Where the cameras of a trial stand: everything is seen whole, and equally large in all panes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "app/study/study.hpp"
#include "render/camera.hpp"

namespace understudy::app {

/// The space that something takes up over all of its frames, as a camera of one direction sees it: a convex
/// outline with kSides sides in each of two planes that never cuts off a point.
class SeenExtent {
 public:
  static constexpr int kSides = 32;
  explicit SeenExtent(float yaw = 0, float pitch = 0);  ///< radians, as Camera's
  void add(const Points& points);                       ///< finite
  void add(const SeenExtent& other);                    ///< of the same direction
  bool is_empty() const { return depth_low_ > depth_high_; }

  /// In camera axes about a point of the floor below the middle of the depth: [kSides] corners of the outline
  /// across (x and towards the viewer) and upright (y and towards the viewer).
  using Outline = std::vector<Eigen::Vector2f>;
  Outline across() const { return corners(across_, {0, middle().y()}); }
  Outline upright() const { return corners(upright_, middle()); }
  /// That point, in the world.
  Vec3 middle_point() const;

 private:
  using Supports = Eigen::Array<float, kSides, 1>;
  Eigen::Vector2f middle() const;  // of that point, in camera axes: y and z
  Outline corners(const Supports& supports, const Eigen::Vector2f& about) const;

  float yaw_, pitch_;
  Supports across_, upright_;              // farthest in each direction
  float depth_low_ = 1, depth_high_ = -1;  // on the floor, towards the viewer
};

/// What moves in each kind of pane.
struct StageExtents {
  SeenExtent source, target, result;
};

/// A pane of a picture and its camera.
struct PaneView {
  StudyPane pane = StudyPane::Result;
  int side = 0;      ///< of a pair's results: 0 the left, 1 the right
  int x = 0, y = 0;  ///< its top left corner, pixels
  render::PixelSize size;
  render::Camera camera;
};

/// The panes of a layout from left to right, in all of the picture but a strip for labels above. One distance
/// for all, from the camera to the middle of what moves, as small as lets all panes show everything with the
/// margin; floors at one height; panes as wide as they need to be.
std::vector<PaneView> frame_panes(const Study& study, const StageExtents& extents, render::PixelSize size);

/// Height of the strip for labels, pixels; 0 without labels.
int label_height(const Study& study, render::PixelSize size);

}  // namespace understudy::app
