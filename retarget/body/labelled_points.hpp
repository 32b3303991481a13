// Points on a person with the part of the body that each is on.
#pragma once

#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

constexpr int kNoBody = kJointCount;  ///< part of what is not the person: floor, outliers, held things

struct LabelledPoints {
  Points points;           ///< [N, 3], metres
  std::vector<int> parts;  ///< [N] joint that the point follows most, or kNoBody
};

/// Keeps the rows named, in that order; a row may be named twice.
void keep_rows(LabelledPoints& cloud, const std::vector<int>& kept);

/// Keeps the rows for which `stays(row)` is true.
template <class Stays>
void keep_where(LabelledPoints& cloud, Stays&& stays) {
  std::vector<int> kept;
  for (int i = 0; i < cloud.points.rows(); ++i)
    if (stays(i)) kept.push_back(i);
  keep_rows(cloud, kept);
}

/// Adds points, each with its part.
void append(LabelledPoints& cloud, const std::vector<Vec3>& points, const std::vector<int>& parts);

/// Points as rows, as long as the vector lives.
inline Eigen::Map<const Points> rows_of(const std::vector<Vec3>& points) {
  return {reinterpret_cast<const float*>(points.data()), static_cast<Eigen::Index>(points.size()), 3};
}

/// Points to the square metre of a whole person's cloud: a body's surface is about twice the square of its
/// leg's length and a bit.
float density(const LabelledPoints& cloud, const PosedSkeleton& truth);

/// Each point's part: the joint at the upper end of the nearest bone; beyond a limb's last joint that one.
std::vector<int> nearest_parts(const Points& points, const Joints& joints);

}  // namespace understudy
