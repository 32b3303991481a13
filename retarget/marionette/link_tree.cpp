#include "retarget/marionette/link_tree.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/spanning_tree.hpp"

namespace understudy {

std::vector<int> tree_of_links(const RowMatrix& costs) {
  struct Link {
    int a, b;
    float cost;
  };
  const auto count = static_cast<int>(costs.rows());
  US_CHECK(count > 0 && costs.rows() == costs.cols(), "costs of links are ", costs.rows(), " x ",
           costs.cols(), ", not square");
  std::vector<Link> links;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      US_CHECK(std::isfinite(costs(a, b)) && std::isfinite(costs(b, a)), "the cost of a link is not finite");
      links.push_back({a, b, std::min(costs(a, b), costs(b, a))});
    }
  std::stable_sort(links.begin(), links.end(), [](const Link& x, const Link& y) { return x.cost < y.cost; });
  const std::vector<Link> tree = spanning_tree(links, count);
  std::vector<int> parents(static_cast<size_t>(count), -1);
  const std::vector<int> alike(parents.size(), 1);
  for (const auto& [keypoint, l] : outwards_from(central_node(tree, alike), tree))
    if (l >= 0) parents[static_cast<size_t>(keypoint)] = other_end(tree[static_cast<size_t>(l)], keypoint);
  return parents;
}

}  // namespace understudy
