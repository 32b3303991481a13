#include "retarget/marionette/link_tree.hpp"

#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

using Neighbours = std::vector<std::vector<int>>;

/// Prim's: the nearest keypoint that does not belong joins, until all do.
Neighbours spanning_tree_of(const RowMatrix& costs) {
  const auto K = static_cast<int>(costs.rows());
  Neighbours tree(static_cast<size_t>(K));
  std::vector<char> belongs(static_cast<size_t>(K), 0);
  belongs[0] = 1;
  for (int joined = 1; joined < K; ++joined) {
    int from = -1, to = -1;
    float least = std::numeric_limits<float>::infinity();
    for (int a = 0; a < K; ++a)
      for (int b = 0; b < K; ++b) {
        if (!belongs[static_cast<size_t>(a)] || belongs[static_cast<size_t>(b)]) continue;
        const float cost = std::min(costs(a, b), costs(b, a));
        if (cost < least) least = cost, from = a, to = b;
      }
    belongs[static_cast<size_t>(to)] = 1;
    tree[static_cast<size_t>(from)].push_back(to);
    tree[static_cast<size_t>(to)].push_back(from);
  }
  return tree;
}

/// Parents of a tree that hangs on that root, and how many steps all are away from it together.
std::pair<std::vector<int>, int> hung_on(int root, const Neighbours& tree) {
  std::vector<int> parents(tree.size(), -1), steps(tree.size(), 0), order = {root};
  int sum = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    const int here = order[i];
    for (const int next : tree[static_cast<size_t>(here)]) {
      if (next == parents[static_cast<size_t>(here)]) continue;
      parents[static_cast<size_t>(next)] = here;
      sum += steps[static_cast<size_t>(next)] = steps[static_cast<size_t>(here)] + 1;
      order.push_back(next);
    }
  }
  return {parents, sum};
}

}  // namespace

std::vector<int> tree_of_links(const RowMatrix& costs) {
  US_CHECK(costs.rows() > 0 && costs.rows() == costs.cols(), "costs of links are ", costs.rows(), " x ",
           costs.cols(), ", not square");
  for (Eigen::Index a = 0; a < costs.rows(); ++a)
    for (Eigen::Index b = 0; b < costs.cols(); ++b)
      US_CHECK(a == b || std::isfinite(costs(a, b)), "the cost of a link is not finite");
  const Neighbours tree = spanning_tree_of(costs);
  auto best = hung_on(0, tree);
  for (int root = 1; root < static_cast<int>(tree.size()); ++root) {
    auto tried = hung_on(root, tree);
    if (tried.second < best.second) best = std::move(tried);
  }
  return best.first;
}

}  // namespace understudy
