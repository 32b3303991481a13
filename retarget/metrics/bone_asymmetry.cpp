// How unlike the left and right side of a skeleton are: a body's own bones are as long on either side.
#include <cmath>
#include <iterator>

#include "retarget/metrics/metric_table.hpp"

namespace understudy {

/// Mean over frames and the eight pairs of bones of the source's skeleton of |left - right| over the mean of both
/// lengths: 0 where the sides are alike, 2 where one has none. Without truth. The left joint of a pair stands
/// directly before the right one (SMPL's order).
double bone_asymmetry(const MetricSequence& p, const MetricSequence& /*q*/, double /*fps*/) {
  const auto length = [](const Joints& joints, int j) {
    return (joints.row(j) - joints.row(kParents[j])).cast<double>().norm();
  };
  const int lefts[] = {LeftHip,    LeftKnee,     LeftAnkle, LeftFoot,
                       LeftCollar, LeftShoulder, LeftElbow, LeftWrist};
  double sum = 0;
  for (const Joints& joints : p.source_joints)
    for (const int left : lefts) {
      const double l = length(joints, left), r = length(joints, left + 1);
      if (l + r > 0) sum += std::abs(l - r) / ((l + r) / 2);
    }
  return sum / (static_cast<double>(p.source_joints.size()) * std::size(lefts));
}

}  // namespace understudy
