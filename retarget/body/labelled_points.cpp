#include "retarget/body/labelled_points.hpp"

#include <limits>

#include "retarget/math/segment.hpp"

namespace understudy {

void keep_rows(LabelledPoints& cloud, const std::vector<int>& kept) {
  std::vector<int> parts;
  parts.reserve(kept.size());
  for (const int row : kept) parts.push_back(cloud.parts[row]);
  cloud.points = Points(cloud.points(kept, Eigen::all));
  cloud.parts = std::move(parts);
}

void append(LabelledPoints& cloud, const std::vector<Vec3>& points, const std::vector<int>& parts) {
  const Eigen::Index before = cloud.points.rows();
  cloud.points.conservativeResize(before + static_cast<Eigen::Index>(points.size()), 3);
  cloud.points.bottomRows(points.size()) = rows_of(points);
  cloud.parts.insert(cloud.parts.end(), parts.begin(), parts.end());
}

float density(const LabelledPoints& cloud, const PosedSkeleton& truth) {
  const float leg = leg_length(truth.joints);
  return static_cast<float>(cloud.points.rows()) / (2.4f * leg * leg);
}

namespace {

bool is_last(int joint) {
  return std::find(kParents.begin(), kParents.end(), joint) == kParents.end();
}

}  // namespace

std::vector<int> nearest_parts(const Points& points, const Joints& joints) {
  std::vector<int> parts(points.rows(), Pelvis);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    float nearest = std::numeric_limits<float>::max();
    for (int j = 1; j < kJointCount; ++j) {
      const int p = kParents[j];
      const Vec3 point = points.row(i), upper = joints.row(p), lower = joints.row(j);
      const float along = along_segment(point, upper, lower);
      const float squared = (point - upper - along * (lower - upper)).squaredNorm();
      if (squared >= nearest) continue;
      nearest = squared;
      parts[i] = along >= 1 && is_last(j) ? j : p;
    }
  }
  return parts;
}

}  // namespace understudy
