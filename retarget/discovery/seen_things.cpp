#include "retarget/discovery/seen_things.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/union_find.hpp"
#include "retarget/geometry/cloud_normals.hpp"

namespace understudy {
namespace {

/// The pieces of evenly spread points, largest first: their rows.
std::vector<std::vector<int>> pieces_of(const ThinnedFrame& frame) {
  constexpr int kNear = 10;
  constexpr float kNeighbours = 4;  // spacings: what is further apart does not touch
  const float reach = kNeighbours * point_spacing(frame.points);
  UnionFind sets(static_cast<size_t>(frame.spread));
  std::vector<PointTree::Near> near;
  for (int i = 0; i < frame.spread; ++i) {
    frame.tree.nearest(frame.points.row(i).transpose(), kNear, near);
    for (const PointTree::Near& n : near)
      if (n.squared <= reach * reach) sets.join(i, n.point);
  }
  std::vector<std::vector<int>> pieces(static_cast<size_t>(frame.spread));
  for (int i = 0; i < frame.spread; ++i) pieces[static_cast<size_t>(sets.root(i))].push_back(i);
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return pieces;
}

/// A square grid seen from above: which cells hold a point.
class CellsFromAbove {
 public:
  explicit CellsFromAbove(const Points& all)
      : low_(all.colwise().minCoeff().transpose()),
        sides_((all.colwise().maxCoeff().transpose() - low_).cwiseMax(1e-9f)) {}
  size_t of(const Eigen::RowVector3f& point) const { return along(point, 0) * kSide + along(point, 2); }
  static constexpr size_t kSide = 12, kCount = kSide * kSide;

 private:
  size_t along(const Eigen::RowVector3f& point, int axis) const {
    const float share = (point[axis] - low_[axis]) / sides_[axis];
    return std::min(static_cast<size_t>(share * kSide), kSide - 1);
  }
  Vec3 low_, sides_;
};

bool most(const std::vector<ThinnedFrame>& frames, bool (*show)(const ThinnedFrame&)) {
  return 2 * std::count_if(frames.begin(), frames.end(), show) > ssize(frames);
}

}  // namespace

bool shows_two_things(const ThinnedFrame& whole) {
  constexpr float kLarge = 0.2f, kAway = 0.05f;  // shares of all points, of the size
  const ThinnedFrame frame = spread_part(whole);
  const std::vector<std::vector<int>> pieces = pieces_of(frame);
  const float away = kAway * box_diagonal(frame.points);
  const PointTree first(frame.points(pieces[0], Eigen::all));
  for (size_t k = 1; k < pieces.size(); ++k) {
    if (static_cast<float>(pieces[k].size()) < kLarge * static_cast<float>(frame.spread)) return false;
    const bool clear = std::all_of(pieces[k].begin(), pieces[k].end(), [&](int i) {
      return first.nearest(frame.points.row(i).transpose()).squared > away * away;
    });
    if (clear) return true;
  }
  return false;
}

bool shows_ground(const ThinnedFrame& whole) {
  constexpr float kStrays = 0.02f, kFlat = 0.015f;  // of the points, of the size
  constexpr float kSeen = 0.2f, kWide = 0.6f, kBelowThings = 0.6f;
  const Points points = whole.points.topRows(whole.spread);
  std::vector<float> heights(points.col(1).begin(), points.col(1).end());
  const auto stray = static_cast<ptrdiff_t>(kStrays * static_cast<float>(heights.size()));
  std::nth_element(heights.begin(), heights.begin() + stray, heights.end());
  const float top = heights[static_cast<size_t>(stray)] + kFlat * box_diagonal(points);
  const CellsFromAbove cells(points);
  std::vector<char> ground(CellsFromAbove::kCount, 0), above = ground;
  int lying = 0;
  for (const auto& point : points.rowwise()) {
    const bool lies = point.y() <= top;
    (lies ? ground : above)[cells.of(point)] = 1;
    lying += lies ? 1 : 0;
  }
  int wide = 0, covered = 0;
  for (size_t cell = 0; cell < ground.size(); ++cell)
    if (ground[cell]) ++wide, covered += above[cell];
  return static_cast<float>(lying) > kSeen * static_cast<float>(points.rows()) &&
         static_cast<float>(wide) > kWide * CellsFromAbove::kCount &&
         static_cast<float>(covered) < kBelowThings * static_cast<float>(wide);
}

void warn_of_more_than_one(const std::vector<ThinnedFrame>& frames, const std::string& name) {
  if (most(frames, shows_ground))
    log::warn(name + ": a ground is seen, and becomes a bone of what stands on it: remove the floor");
  else if (most(frames, shows_two_things))
    log::warn(name + ": two things that do not touch are seen, and get one tree of bones: keep one of them");
}

}  // namespace understudy
