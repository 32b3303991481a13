// A map of movements: the steps of many motions, or what else is in them, by their codes; which are alike,
// and where each lies on a plane.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/motion_space/steps.hpp"

namespace understudy {

constexpr int kFigureMoments = 16;  ///< of a step that are kept to be shown
constexpr size_t kFigureNumbers = kFigureMoments * (kJointCount + 1) * 3;

/// A step with its code, or a stretch of another movement.
struct MappedStep {
  int first = 0, last = 0;  ///< frames of its motion, both inside
  bool left_first = false;  ///< of a step
  float seconds = 0;
  float speed_m_s = 0;      ///< over the floor, from its beginning straight to its end
  std::vector<float> code;  ///< MotionCode::mean
  /// Poses of evenly many moments, the first and the last frame among them, seen as movement_of sees them:
  /// [kFigureMoments * 23 * 3], of each joint's local rotation axis times angle in 1e-4 radians, then the
  /// root in millimetres.
  std::vector<int16_t> figure;
};

/// What is on a map: steps, or what else is in motions.
enum class MapOf { Steps, Others };
constexpr Names<2> kMapOfNames{"steps", "others"};

/// A motion and the steps in it, or its other movements.
struct MappedMotion {
  std::string path;        ///< its file; empty: it is in none
  std::string clip;        ///< which of the file's animations: a number from 1
  bool is_longest = true;  ///< it is the one that is taken of the file where none is named
  std::string name;        ///< for people: "dance.glb: spin"
  std::string action;      ///< what it shows: "walk"
  float fps = 30;
  int frames = 0;
  Joints rest = Joints::Zero();  ///< T-pose joints of who performs it, metres
  std::vector<MappedStep> steps;
};

/// The steps of a motion that lie wholly in frames first .. last, coded. Throws Error as the coder does.
std::vector<MappedStep> coded_steps(const Motion& motion, const Joints& rest, MovementEncoder& coder,
                                    int first = 0, int last = kFrameNumbers.high);

/// What else a motion holds: what is in none of its steps and in no flagged frame for a second or more, in
/// stretches of about two seconds, coded. `encoder` codes movements of 1 to 3 s. Throws Error as it does.
std::vector<MappedStep> coded_movements(const Motion& motion, const std::vector<MappedStep>& steps,
                                        const Joints& rest, MovementEncoder& encoder);
/// Frames first .. last as such stretches, whatever they show; none of less than half a second.
std::vector<MappedStep> coded_stretches(const Motion& motion, const Joints& rest, MovementEncoder& encoder,
                                        int first, int last);

/// A step as it is kept, along a smooth curve through its moments.
Motion motion_of(const MappedStep& step);
/// Its joints after so many seconds, again from the start after its end; `rest`: of who performs it. In
/// place: the pelvis stays above the origin.
Joints figure_at(const MappedStep& step, const Joints& rest, float seconds, bool in_place);

/// The words of a file's name: "walk" for "/clips/walk_03.bvh".
std::string action_of_name(const std::string& path);

using MapPlace = Eigen::Vector2f;

/// A step and how far it is from something, in median distances between neighbours.
struct NearStep {
  int step = 0;
  float distance = 0;
};

/// What lies at a place of the map.
struct MapBlend {
  /// Of two or three steps about it, the nearest first; weights sum to 1. One where the place is a step's
  /// own, or beyond all others.
  std::vector<std::pair<int, float>> weights;
  std::vector<float> code;
  NearStep known;  ///< the step whose code is nearest to it
};

/// Further than this from all that is known, in median distances between neighbours, is far.
constexpr float kFarFromKnown = 2;
/// "0.8 times as far from the nearest step as neighbours are", and whether that is far.
std::string distance_words(float distance);

/// Steps by the nearness of their codes. Places are the codes' two principal components. The same motions
/// give the same map to the bit.
class MotionMap {
 public:
  MotionMap() = default;
  /// Throws Error where codes are not finite, or of several sizes.
  explicit MotionMap(std::vector<MappedMotion> motions);

  /// Number of steps; they are counted through all motions.
  int size() const { return static_cast<int>(of_step_.size()); }
  const std::vector<MappedMotion>& motions() const { return motions_; }
  const MappedMotion& motion_of(int step) const { return motions_[of_step_[step].motion]; }
  const MappedStep& step(int step) const { return motion_of(step).steps[of_step_[step].step]; }
  MapPlace place(int step) const { return places_.row(step); }
  /// Share of the codes' variance along both axes.
  const std::array<float, 2>& shares() const { return shares_; }

  /// Throws Error where the code has another size.
  MapPlace place_of(const std::vector<float>& code) const;
  /// The steps nearest to any of the codes, the nearest first; those that `skip` names are left out.
  std::vector<NearStep> nearest(const std::vector<std::vector<float>>& codes, int count,
                                const std::function<bool(int step)>& skip = {}) const;
  /// Of the nearest step and the nearest in each of both other thirds of the plane, seen from the place, so
  /// that it lies between them; weights fall with the square of the distance. Throws Error on an empty map.
  MapBlend at(const MapPlace& place) const;
  /// The distance between neighbours: the median over steps of how far the nearest code is that is of no
  /// step that shares frames with it. 1 where there are no neighbours.
  float neighbour_distance() const { return unit_; }

 private:
  struct OfStep {
    int motion, step;
  };
  bool share_frames(int a, int b) const;
  std::vector<int> around(const MapPlace& place) const;
  void find_axes();
  void find_unit();

  std::vector<MappedMotion> motions_;
  std::vector<OfStep> of_step_;
  RowMatrix codes_;  // [N, D]
  Eigen::VectorXf squares_;
  Eigen::RowVectorXf mean_;
  Eigen::Matrix<float, Eigen::Dynamic, 2> axes_, places_;
  std::array<float, 2> shares_{};
  float unit_ = 1;
};

/// What colours the steps of a map.
enum class MapColour { Action, Speed, Duration, File };
constexpr Names<4> kMapColourNames{"action", "speed", "duration", "file"};

/// What is told of each step by its colour: one of a few groups, or a value along a scale.
struct MapColouring {
  std::vector<std::string> groups;  ///< the one with most steps first; empty: there is a scale
  std::vector<int> group;           ///< of each step; -1: of one too small to have a colour of its own
  std::vector<float> value;         ///< of each step along the scale, 0..1
  float low = 0, high = 1;          ///< what its ends mean; what lies beyond them has their colours
  std::string unit;                 ///< "m/s"
};
/// At most so many groups have colours of their own.
constexpr int kMapGroups = 8;
MapColouring map_colouring(const MotionMap& map, MapColour by);

}  // namespace understudy
