#include "retarget/marionette/affinity_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr float kNoWay = 1e4f;      // the paper's, between keypoints that nothing joins
constexpr float kTieBreak = 0.01f;  // of a step: by so much an edge of full affinity is shorter

using Lengths = RowMatrix;  // [K, K]

RowMatrix joined(const std::vector<RowMatrix>& affinities) {
  US_CHECK(!affinities.empty() && affinities[0].rows() > 0, "there is no affinity");
  const Eigen::Index K = affinities[0].rows();
  RowMatrix joined = RowMatrix::Constant(K, K, -1);
  for (const RowMatrix& one : affinities) {
    US_CHECK(one.rows() == K && one.cols() == K && one.allFinite(), "an affinity is not ", K, " x ", K,
             " numbers");
    joined = joined.cwiseMax(one);
  }
  return joined;
}

/// BinarizeAffinity: 1 where one of two keypoints is among the other's `most` most affine ones.
RowMatrix neighbours_of(const RowMatrix& affinity, Eigen::Index most) {
  const Eigen::Index K = affinity.rows();
  RowMatrix edges = RowMatrix::Zero(K, K);
  for (Eigen::Index i = 0; i < K; ++i) {
    std::vector<Eigen::Index> order;
    for (Eigen::Index j = 0; j < K; ++j)
      if (j != i) order.push_back(j);
    std::stable_sort(order.begin(), order.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return affinity(i, a) > affinity(i, b); });
    for (size_t n = 0; n < std::min(order.size(), static_cast<size_t>(most)); ++n)
      edges(i, order[n]) = edges(order[n], i) = 1;
  }
  return edges;
}

/// Lengths of the shortest ways along edges of these lengths (0: no edge), kNoWay where there is none.
Lengths shortest_ways(const RowMatrix& edges) {
  const Eigen::Index K = edges.rows();
  Lengths ways = Lengths::Constant(K, K, kNoWay);
  for (Eigen::Index i = 0; i < K; ++i)
    for (Eigen::Index j = 0; j < K; ++j)
      if (i == j || edges(i, j) > 0) ways(i, j) = i == j ? 0 : edges(i, j);
  for (Eigen::Index k = 0; k < K; ++k)
    for (Eigen::Index i = 0; i < K; ++i)
      ways.row(i) = ways.row(i).cwiseMin((ways.row(k).array() + ways(i, k)).matrix());
  return ways.cwiseMin(kNoWay);
}

/// Of those for which `counts`, the one from which all others are nearest; -1: there is none.
template <class Counts>
int most_central(const Lengths& ways, const Counts& counts) {
  int best = -1;
  for (int i = 0; i < static_cast<int>(ways.rows()); ++i)
    if (counts(i) && (best < 0 || ways.row(i).sum() < ways.row(best).sum())) best = i;
  return best;
}

/// Joins root to root until all is one piece; returns the root.
int connect(RowMatrix& edges) {
  for (;;) {
    const Lengths ways = shortest_ways(edges);
    const int root = most_central(ways, [](int) { return true; });
    const int other = most_central(ways, [&](int i) { return ways(root, i) >= kNoWay; });
    if (other < 0) return root;
    edges(root, other) = edges(other, root) = 1;
  }
}

/// RefineGraph: how near each is to the root, 0 the root's own; those equally near have the same.
std::vector<int> ranks_of(const RowMatrix& affinity, const RowMatrix& edges, int root) {
  const RowMatrix both = affinity.cwiseMax(affinity.transpose());
  const RowMatrix lengths = (edges.array() * (1 - kTieBreak * both.array())).matrix();
  const Eigen::VectorXf far = shortest_ways(lengths).row(root).transpose();
  std::vector<float> steps(far.data(), far.data() + far.size());
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  std::vector<int> rank;
  for (const float way : far)
    rank.push_back(static_cast<int>(std::lower_bound(steps.begin(), steps.end(), way) - steps.begin()));
  return rank;
}

/// Lines 15 to 33 of the algorithm.
class Parents {
 public:
  Parents(const RowMatrix& affinity, const RowMatrix& edges, std::vector<int> rank)
      : affinity_(affinity), edges_(edges), rank_(std::move(rank)) {}

  /// Of the root -1.
  int of(int i, const std::vector<int>& so_far) const {
    if (rank(i) == 0) return -1;
    const std::vector<int> nearer = neighbours(i, [&](int j) { return rank(j) < rank(i); });
    const int usual =
        *std::max_element(nearer.begin(), nearer.end(), [this](int a, int b) { return rank(a) < rank(b); });
    for (const int j : neighbours(i, [&](int k) { return rank(k) == rank(i); })) {
      const int shared = furthest_shared(nearer, j);
      if (shared >= 0 && affinity_(shared, j) > affinity_(shared, i) && !hangs_on(j, i, so_far)) return j;
    }
    return usual;
  }

 private:
  int rank(int i) const { return rank_[static_cast<size_t>(i)]; }
  /// Three of one rank could each prefer the next: then it would be no tree.
  static bool hangs_on(int j, int i, const std::vector<int>& so_far) {
    while (j >= 0 && j != i) j = j < static_cast<int>(so_far.size()) ? so_far[static_cast<size_t>(j)] : -1;
    return j == i;
  }
  template <class Counts>
  std::vector<int> neighbours(int i, const Counts& counts) const {
    std::vector<int> found;
    for (int j = 0; j < static_cast<int>(edges_.rows()); ++j)
      if (j != i && edges_(i, j) > 0 && counts(j)) found.push_back(j);
    return found;
  }
  /// The one nearest to the root among these neighbours that is j's, too; -1: none is.
  int furthest_shared(const std::vector<int>& nearer, int j) const {
    int best = -1;
    for (const int k : nearer)
      if (edges_(j, k) > 0 && (best < 0 || rank(k) < rank(best))) best = k;
    return best;
  }

  const RowMatrix &affinity_, &edges_;
  std::vector<int> rank_;
};

}  // namespace

std::vector<int> tree_of_affinity(const std::vector<RowMatrix>& affinities) {
  const RowMatrix affinity = joined(affinities);
  US_CHECK(static_cast<Eigen::Index>(affinities.size()) < affinity.rows() || affinity.rows() == 1,
           affinities.size(), " affinities are too many for ", affinity.rows(), " keypoints");
  RowMatrix edges = neighbours_of(affinity, static_cast<Eigen::Index>(affinities.size()));
  const int root = connect(edges);
  const Parents parents(affinity, edges, ranks_of(affinity, edges, root));
  std::vector<int> tree;
  tree.reserve(static_cast<size_t>(affinity.rows()));
  for (int i = 0; i < static_cast<int>(affinity.rows()); ++i) tree.push_back(parents.of(i, tree));
  return tree;
}

}  // namespace understudy
