#include "retarget/body/labelled_points.hpp"

#include <algorithm>
#include <limits>

namespace understudy {

void keep_rows(LabelledPoints& cloud, const std::vector<int>& kept) {
  Points points(kept.size(), 3);
  std::vector<int> parts(kept.size());
  for (size_t i = 0; i < kept.size(); ++i) {
    points.row(static_cast<Eigen::Index>(i)) = cloud.points.row(kept[i]);
    parts[i] = cloud.parts[static_cast<size_t>(kept[i])];
  }
  cloud.points = std::move(points);
  cloud.parts = std::move(parts);
}

namespace {

bool is_last(int joint) {
  return std::find(kParents.begin(), kParents.end(), joint) == kParents.end();
}

}  // namespace

std::vector<int> nearest_parts(const Points& points, const Joints& joints) {
  std::vector<int> parts(static_cast<size_t>(points.rows()), Pelvis);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    float nearest = std::numeric_limits<float>::max();
    for (int j = 1; j < kJointCount; ++j) {
      const int p = kParents[static_cast<size_t>(j)];
      const Eigen::RowVector3f bone = joints.row(j) - joints.row(p), way = points.row(i) - joints.row(p);
      const float along = std::clamp(way.dot(bone) / std::max(bone.squaredNorm(), 1e-8f), 0.0f, 1.0f);
      const float squared = (way - along * bone).squaredNorm();
      if (squared >= nearest) continue;
      nearest = squared;
      parts[static_cast<size_t>(i)] = along >= 1 && is_last(j) ? j : p;
    }
  }
  return parts;
}

}  // namespace understudy
