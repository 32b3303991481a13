#include "app/stimuli/framing.hpp"

#include <algorithm>
#include <cmath>

namespace understudy::app {
namespace {

using Outline = SeenExtent::Outline;
constexpr float kDegree = kPi / 180;

Eigen::Vector2f direction(int side) {
  const float angle = 2 * kPi * static_cast<float>(side) / SeenExtent::kSides;
  return {std::cos(angle), std::sin(angle)};
}

/// How far to the left (below) and the right (above) of the eye's axis the frustum's planes of this slope
/// must lie at the outline's depth 0: a point counts the more, the nearer it is.
struct Reach {
  float low = 0, high = 0;
};
Reach reach(const Outline& outline, float slope) {
  Reach most{-1e9f, -1e9f};
  for (const Eigen::Vector2f& corner : outline) {
    most.low = std::max(most.low, -corner.x() + slope * corner.y());
    most.high = std::max(most.high, corner.x() + slope * corner.y());
  }
  return most;
}

/// The smallest slope with which an eye at this distance sees all of it, its axis where it likes.
float needed_slope(const Outline& outline, float distance) {
  float low = 0, high = 100;
  for (int i = 0; i < 40; ++i) {
    const float slope = (low + high) / 2;
    const Reach r = reach(outline, slope);
    (r.low + r.high <= 2 * slope * distance ? high : low) = slope;
  }
  return high;
}

float nearest(const Outline& outline) {
  float z = -1e9f;
  for (const Eigen::Vector2f& corner : outline) z = std::max(z, corner.y());
  return z;
}

/// The panes while their places are sought.
class Framing {
 public:
  Framing(const Study& study, const StageExtents& extents, render::PixelSize size)
      : picture_(study.picture),
        size_{size.width, size.height - label_height(study, size)},
        top_(size.height - size_.height),
        free_(1 - 2 * picture_.margin),
        slope_(std::tan(picture_.fov_deg * kDegree / 2)) {
    for (const StudyPane pane : study.layout.panes) {
      const SeenExtent& extent = pane == StudyPane::Source   ? extents.source
                                 : pane == StudyPane::Target ? extents.target
                                                             : extents.result;
      const bool is_pair = pane == StudyPane::Result && study.layout.results == TrialResults::Pair;
      for (int side = 0; side < (is_pair ? 2 : 1); ++side)
        panes_.push_back({pane, side, extent.across(), extent.upright(), extent.middle_point()});
    }
  }

  std::vector<PaneView> views() {
    find_height();
    find_distance();
    std::vector<PaneView> views;
    float x = 0;
    const float spare =
        (static_cast<float>(size_.width) - width_at(distance_)) / static_cast<float>(panes_.size());
    for (const Pane& pane : panes_) {
      const int left = 2 * static_cast<int>(std::lround(x / 2));  // even, for films of a pane alone
      x += width_at(pane, distance_) + spare;
      const int right = &pane == &panes_.back() ? size_.width : 2 * static_cast<int>(std::lround(x / 2));
      views.push_back(view_of(pane, left, right - left));
    }
    return views;
  }

 private:
  struct Pane {
    StudyPane pane;
    int side;
    Outline across, upright;
    Vec3 middle;
  };

  /// The least distance by height alone, and how high all cameras look.
  void find_height() {
    const float slope = slope_ * free_;
    Reach most{-1e9f, -1e9f};
    for (const Pane& pane : panes_) {
      const Reach r = reach(pane.upright, slope);
      most.low = std::max(most.low, r.low), most.high = std::max(most.high, r.high);
      distance_ = std::max({distance_, nearest(pane.upright) + 0.5f, nearest(pane.across) + 0.5f});
    }
    distance_ = std::max(distance_, (most.low + most.high) / (2 * slope));
    height_ = (most.high - most.low) / 2;
  }

  /// No smaller than by height; farther where the panes would be too wide.
  void find_distance() {
    if (width_at(distance_) <= static_cast<float>(size_.width)) return;
    float low = distance_, high = 1000;
    for (int i = 0; i < 50; ++i) {
      const float middle = (low + high) / 2;
      (width_at(middle) <= static_cast<float>(size_.width) ? high : low) = middle;
    }
    distance_ = high;
  }

  /// Pixels that a pane needs.
  float width_at(const Pane& pane, float distance) const {
    constexpr float kLeast = 0.4f;  // of an equal share
    const float share = static_cast<float>(size_.width) / static_cast<float>(panes_.size());
    const float needed =
        static_cast<float>(size_.height) * needed_slope(pane.across, distance) / (free_ * slope_);
    return std::max(needed + 2, kLeast * share);  // 2: sides are even
  }
  float width_at(float distance) const {
    float sum = 0;
    for (const Pane& pane : panes_) sum += width_at(pane, distance);
    return sum;
  }

  PaneView view_of(const Pane& pane, int x, int width) const {
    PaneView view{pane.pane, pane.side, x, top_, {width, size_.height}, {}};
    const Reach r = reach(pane.across, slope_ * view.size.aspect() * free_);
    view.camera.yaw = picture_.yaw_deg * kDegree, view.camera.pitch = picture_.pitch_deg * kDegree;
    view.camera.fov = picture_.fov_deg * kDegree, view.camera.distance = distance_;
    const Mat3 axes = render::axes(view.camera);
    view.camera.target = pane.middle + (r.high - r.low) / 2 * axes.col(0) + height_ * axes.col(1);
    return view;
  }

  const StudyPicture& picture_;
  render::PixelSize size_;
  int top_;
  float free_, slope_;  // share of a pane for what moves; of the frustum's planes above and below
  std::vector<Pane> panes_;
  float distance_ = 0.5f, height_ = 0;
};

}  // namespace

SeenExtent::SeenExtent(float yaw, float pitch) : yaw_(yaw), pitch_(pitch) {
  across_.setConstant(-1e9f);
  upright_.setConstant(-1e9f);
}

void SeenExtent::add(const Points& points) {
  if (points.rows() == 0) return;
  render::Camera camera;
  camera.yaw = yaw_, camera.pitch = pitch_;
  const Mat3 axes = render::axes(camera);
  const Eigen::VectorXf x = points * axes.col(0), y = points * axes.col(1), z = points * axes.col(2);
  for (int side = 0; side < kSides; ++side) {
    const Eigen::Vector2f d = direction(side);
    across_[side] = std::max(across_[side], (d.x() * x + d.y() * z).maxCoeff());
    upright_[side] = std::max(upright_[side], (d.x() * y + d.y() * z).maxCoeff());
  }
  const Eigen::VectorXf depth = points * Vec3(std::sin(yaw_), 0, std::cos(yaw_));
  const bool first = is_empty();
  depth_low_ = first ? depth.minCoeff() : std::min(depth_low_, depth.minCoeff());
  depth_high_ = first ? depth.maxCoeff() : std::max(depth_high_, depth.maxCoeff());
}

void SeenExtent::add(const SeenExtent& other) {
  if (other.is_empty()) return;
  across_ = across_.max(other.across_);
  upright_ = upright_.max(other.upright_);
  depth_low_ = is_empty() ? other.depth_low_ : std::min(depth_low_, other.depth_low_);
  depth_high_ = std::max(depth_high_, other.depth_high_);
}

Vec3 SeenExtent::middle_point() const {
  const float depth = (depth_low_ + depth_high_) / 2;
  return is_empty() ? Vec3::Zero() : Vec3(depth * std::sin(yaw_), 0, depth * std::cos(yaw_));
}

Eigen::Vector2f SeenExtent::middle() const {
  const float depth = is_empty() ? 0 : (depth_low_ + depth_high_) / 2;
  return {-depth * std::sin(pitch_), depth * std::cos(pitch_)};
}

Outline SeenExtent::corners(const Supports& supports, const Eigen::Vector2f& about) const {
  if (is_empty()) return {{-0.5f, 0}, {0.5f, 0}, {0, 0}, {1.7f, 0}};
  Outline outline;
  for (int side = 0; side < kSides; ++side) {
    const int next = (side + 1) % kSides;
    Eigen::Matrix2f lines;
    lines << direction(side).transpose(), direction(next).transpose();
    outline.push_back(lines.inverse() * Eigen::Vector2f(supports[side], supports[next]) - about);
  }
  return outline;
}

std::vector<PaneView> frame_panes(const Study& study, const StageExtents& extents, render::PixelSize size) {
  return Framing(study, extents, size).views();
}

int label_height(const Study& study, render::PixelSize size) {
  return study.layout.labels ? static_cast<int>(std::lround(0.075f * static_cast<float>(size.height))) : 0;
}

}  // namespace understudy::app
