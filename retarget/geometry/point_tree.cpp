#include "retarget/geometry/point_tree.hpp"

#include <algorithm>
#include <cstdint>
#include <nanoflann.hpp>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

/// nanoflann's view of our points.
struct TreePoints {
  Points points;
  size_t kdtree_get_point_count() const { return static_cast<size_t>(points.rows()); }
  float kdtree_get_pt(size_t i, size_t axis) const {
    return points(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, TreePoints>, TreePoints,
                                                 /*dimensions=*/3, uint32_t>;

}  // namespace

struct PointTree::Impl {
  explicit Impl(Points of)
      : seen{std::move(of)}, tree(3, seen, nanoflann::KDTreeSingleIndexAdaptorParams(/*part_max_size=*/16)) {}
  TreePoints seen;
  Tree tree;
};

PointTree::PointTree(Points points) {
  US_CHECK(points.rows() > 0, "no point to be near to");
  impl_ = std::make_unique<Impl>(std::move(points));
}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

const Points& PointTree::points() const {
  return impl_->seen.points;
}

PointTree::Near PointTree::nearest(const Vec3& at) const {
  uint32_t point = 0;
  float squared = 0;
  impl_->tree.knnSearch(at.data(), 1, &point, &squared);
  return {static_cast<int>(point), squared};
}

void PointTree::nearest(const Vec3& at, int k, std::vector<Near>& found) const {
  const auto count = static_cast<size_t>(std::min<Eigen::Index>(k, points().rows()));
  std::vector<uint32_t> which(count);
  std::vector<float> squared(count);
  impl_->tree.knnSearch(at.data(), count, which.data(), squared.data());
  found.clear();
  for (size_t i = 0; i < count; ++i) found.push_back({static_cast<int>(which[i]), squared[i]});
}

}  // namespace understudy
