#include "retarget/metrics/keypoint_metrics.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "retarget/keypoints/hand_pairs.hpp"
#include "retarget/keypoints/point_deviations.hpp"

namespace understudy {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

bool both(const FlatPose& a, const FlatPose& b, int point) {
  return a.has(point) && b.has(point);
}

FlatBox paper_box(const FlatPose& pose, const FlatPose& also) {
  FlatBox box;
  for (int point = 0; point < kPaperPoints; ++point)
    if (both(pose, also, point)) box.extend(pose.at(point));
  return box;
}

/// Mean over the points of f(point, distance) with both boxes' centres in one place.
template <typename F>
double mean_over_points(const FlatPose& pose, const FlatPose& truth, F f) {
  const FlatPose moved = centred_on(pose, truth);
  double sum = 0;
  int points = 0;
  for (int point = 0; point < kPaperPoints; ++point) {
    if (!both(moved, truth, point)) continue;
    sum += f(point, static_cast<double>((moved.at(point) - truth.at(point)).norm()));
    ++points;
  }
  return points > 0 ? sum / points : kNotKnown;
}

/// The four directions of equation 5, not normalised: only the order counts.
std::array<float, 4> projections(const Vec2& p) {
  return {p.x(), p.y(), p.x() + p.y(), p.x() - p.y()};
}

}  // namespace

FlatPose centred_on(const FlatPose& pose, const FlatPose& truth) {
  const FlatBox box = paper_box(pose, truth), goal = paper_box(truth, pose);
  FlatPose moved = pose;
  if (box.isEmpty()) return moved;
  const Vec2 way = goal.center() - box.center();
  for (int point = 0; point < kBodyPoints; ++point)
    if (pose.has(point)) moved.set(point, pose.at(point) + way, pose.confidence(point));
  return moved;
}

double keypoint_similarity(const FlatPose& pose, const FlatPose& truth) {
  const Vec2 size = paper_box(truth, truth).sizes();
  const double area = kAreaOfBox * static_cast<double>(size.x()) * static_cast<double>(size.y());
  return 100 * mean_over_points(pose, truth, [&](int point, double far) {
           const double k = 2 * kPointDeviation[static_cast<size_t>(point)];
           return std::exp(-far * far / std::max(2 * area * k * k, 1e-12));
         });
}

double normalised_point_error(const FlatPose& pose, const FlatPose& truth) {
  const double diagonal = static_cast<double>(paper_box(truth, truth).diagonal().norm());
  return 100 *
         mean_over_points(pose, truth, [&](int, double far) { return far / std::max(diagonal, 1e-12); });
}

double order_violation(const FlatPose& pose, const FlatPose& source) {
  int wrong = 0, all = 0;
  for (int i = 0; i < kPaperPoints; ++i)
    for (int j = 0; j < i; ++j) {
      if (!both(pose, source, i) || !both(pose, source, j)) continue;
      const auto is = projections(pose.at(i) - pose.at(j)), was = projections(source.at(i) - source.at(j));
      for (size_t d = 0; d < is.size(); ++d) {
        wrong += is[d] * was[d] < 0 ? 1 : 0;
        ++all;
      }
    }
  return all > 0 ? 100.0 * wrong / all : kNotKnown;
}

double bone_angle_error(const FlatPose& pose, const FlatPose& source) {
  double sum = 0;
  int bones = 0;
  for (const FlatBone& bone : kFlatBones) {
    if (!both(pose, source, bone.from) || !both(pose, source, bone.to)) continue;
    const Vec2 is = pose.at(bone.to) - pose.at(bone.from), was = source.at(bone.to) - source.at(bone.from);
    const double angle = std::atan2(static_cast<double>(was.x() * is.y() - was.y() * is.x()),
                                    static_cast<double>(was.dot(is)));
    sum += angle * angle;
    ++bones;
  }
  return bones > 0 ? std::sqrt(sum / bones) : kNotKnown;
}

double bone_ratio_error(const BoneLengths& believed, const BoneLengths& truth) {
  const BoneLengths off = (believed / believed.sum()) / (truth / truth.sum()) - 1;
  return 100 * static_cast<double>(off.abs().mean());
}

Touches touches_kept(const FlatPose& pose, double stature, const FlatPose& source, double source_stature) {
  Touches touches;
  for (const HandPair& pair : kHandPairs) {
    if (!both(pose, source, pair.wrist) || !both(pose, source, pair.other)) continue;
    const auto apart = [&](const FlatPose& of) {
      return static_cast<double>((of.at(pair.wrist) - of.at(pair.other)).norm());
    };
    if (apart(source) >= 0.05 * source_stature) continue;
    ++touches.near;
    touches.kept += apart(pose) < 0.08 * stature ? 1 : 0;
  }
  return touches;
}

}  // namespace understudy
