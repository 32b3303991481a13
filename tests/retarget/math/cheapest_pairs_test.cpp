#include "retarget/math/cheapest_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"

namespace understudy {
namespace {

double sum_of(const Eigen::MatrixXd& cost, const std::vector<int>& columns) {
  double sum = 0;
  for (size_t r = 0; r < columns.size(); ++r)
    if (columns[r] >= 0) sum += cost(static_cast<Eigen::Index>(r), columns[r]);
  return sum;
}

TEST(CheapestPairs, GiveUpTheCheapestForTheLeastSum) {
  Eigen::MatrixXd cost(2, 2);
  cost << 1, 2, 1, 9;  // greedily 1 + 9
  EXPECT_EQ(cheapest_pairs(cost), (std::vector<int>{1, 0}));
}

TEST(CheapestPairs, LeaveOutWhomNobodyIsLeftFor) {
  Eigen::MatrixXd cost(3, 2);
  cost << 5, 5, 1, 4, 4, 1;
  EXPECT_EQ(cheapest_pairs(cost), (std::vector<int>{-1, 0, 1}));
  EXPECT_EQ(cheapest_pairs(cost.transpose()), (std::vector<int>{1, 2}));
  EXPECT_TRUE(cheapest_pairs(Eigen::MatrixXd(0, 3)).empty());
  EXPECT_EQ(cheapest_pairs(Eigen::MatrixXd(2, 0)), (std::vector<int>{-1, -1}));
}

TEST(CheapestPairs, AreTheBestOfAllOrders) {
  Rng rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd cost(5, 6);
    for (double& x : cost.reshaped()) x = static_cast<double>(rng.uniform(-1, 1));
    std::vector<int> order(6);
    std::iota(order.begin(), order.end(), 0);
    double best = 1e9;
    do best = std::min(best, sum_of(cost, {order.begin(), order.end() - 1}));
    while (std::next_permutation(order.begin(), order.end()));
    EXPECT_NEAR(sum_of(cost, cheapest_pairs(cost)), best, 1e-9);
  }
}

TEST(CheapestPairs, RefuseWhatIsNoNumber) {
  EXPECT_THROW(cheapest_pairs(Eigen::MatrixXd::Constant(2, 2, NAN)), Error);
}

}  // namespace
}  // namespace understudy
