#include "retarget/networks/near_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "retarget/base/rng.hpp"

namespace understudy::nn {
namespace {

Points cube_of(int count) {
  Rng rng(4);
  Points points(count, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = rng.normal();
  return points;
}

float walk_along(const Points& points, const std::vector<int>& order) {
  float length = 0;
  for (size_t i = 1; i < order.size(); ++i)
    length += (points.row(order[i]) - points.row(order[i - 1])).norm();
  return length;
}

TEST(NearOrder, TakesEveryPointOnceAndNeighboursTogether) {
  const Points points = cube_of(500);
  const std::vector<int> order = near_order(points);
  std::vector<int> sorted = order, as_they_come(500);
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < 500; ++i) as_they_come[static_cast<size_t>(i)] = i;
  EXPECT_EQ(sorted, as_they_come);
  EXPECT_LT(walk_along(points, order), 0.4f * walk_along(points, as_they_come));
}

TEST(NearOrder, OfPointsThatCoincideIsTheirs) {
  EXPECT_EQ(near_order(Points::Ones(3, 3)), (std::vector<int>{0, 1, 2}));
}

}  // namespace
}  // namespace understudy::nn
