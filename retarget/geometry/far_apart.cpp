#include "retarget/geometry/far_apart.hpp"

#include <algorithm>

namespace understudy {

std::vector<int> far_apart(const Points& points, const std::vector<int>& of, int count) {
  if (of.empty()) return {};
  std::vector<int> result;
  for (const int i : farthest_points(points(of, Eigen::all), std::min<int>(count, of.size())))
    result.push_back(of[i]);
  return result;
}

}  // namespace understudy
