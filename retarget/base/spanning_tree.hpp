// Trees among numbered nodes: the cheapest links that join all, and how a tree hangs on one of its nodes. A
// link is anything with two nodes `a` and `b`.
#pragma once

#include <utility>
#include <vector>

#include "retarget/base/union_find.hpp"

namespace understudy {

/// Those of `links`, the cheapest first, that join nodes 0 .. count - 1 at the least cost (Kruskal).
template <class Link>
std::vector<Link> spanning_tree(const std::vector<Link>& links, int count) {
  UnionFind sets(static_cast<size_t>(count));
  std::vector<Link> tree;
  for (const Link& link : links) {
    if (sets.root(link.a) == sets.root(link.b)) continue;
    sets.join(link.a, link.b);
    tree.push_back(link);
  }
  return tree;
}

template <class Link>
int other_end(const Link& link, int node) {
  return link.a == node ? link.b : link.a;
}

/// Node by node from the root outwards, with the number of the link that leads to it (-1: the root).
template <class Link>
std::vector<std::pair<int, int>> outwards_from(int root, const std::vector<Link>& tree) {
  std::vector<std::pair<int, int>> order{{root, -1}};
  for (size_t at = 0; at < order.size(); ++at)
    for (size_t l = 0; l < tree.size(); ++l) {
      const Link& link = tree[l];
      const int here = order[at].first;
      if (static_cast<int>(l) == order[at].second || (link.a != here && link.b != here)) continue;
      order.emplace_back(other_end(link, here), static_cast<int>(l));
    }
  return order;
}

/// The first node from which all others are fewest steps away, counted as often as their weights say.
template <class Link>
int central_node(const std::vector<Link>& tree, const std::vector<int>& weights) {
  int best = 0;
  double least = -1;
  for (int root = 0; root < static_cast<int>(weights.size()); ++root) {
    std::vector<int> steps(weights.size(), 0);
    double sum = 0;
    for (const auto& [node, l] : outwards_from(root, tree)) {
      if (l < 0) continue;
      const int before = other_end(tree[static_cast<size_t>(l)], node);
      steps[static_cast<size_t>(node)] = steps[static_cast<size_t>(before)] + 1;
      sum += static_cast<double>(steps[static_cast<size_t>(node)]) * weights[static_cast<size_t>(node)];
    }
    if (least < 0 || sum < least) least = sum, best = root;
  }
  return best;
}

}  // namespace understudy
