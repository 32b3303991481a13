#include "retarget/scene/flat_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "retarget/scene/cell_sets.hpp"

namespace understudy {
namespace {

constexpr float kUprightArea = 0.9f, kLevelArea = 0.3f;  // square metres
constexpr float kMargin = 0.1f;                          // metres that a part is made larger
constexpr int kPlaneTries = 300;

/// The largest connected set of those cells.
std::vector<int> largest_set(const Cells& cells, const std::vector<int>& which) {
  std::vector<CellSet> sets = connected_sets(cells, flags_of(cells, which));
  const auto smaller = [](const auto& a, const auto& b) { return a.size() < b.size(); };
  const auto largest = std::max_element(sets.begin(), sets.end(), smaller);
  return largest == sets.end() ? CellSet{} : std::move(*largest);
}

/// The rectangle about cells that lie on a plane.
FlatPart rectangle(const Cells& cells, const std::vector<int>& on, const Vec3& normal) {
  FlatPart part;
  const Vec3 level = std::abs(normal.y()) > 0.7f ? Vec3::UnitX() : Vec3::UnitY();
  part.axes.col(2) = normal;
  part.axes.col(0) = level.cross(normal).normalized();
  part.axes.col(1) = normal.cross(Vec3(part.axes.col(0)));
  Vec3 low = Vec3::Constant(1e9f), high = -low, sum = Vec3::Zero();
  for (const int c : on) {
    const Vec3 own = part.axes.transpose() * cells.mean(c);
    low = low.cwiseMin(own), high = high.cwiseMax(own), sum += own;
  }
  Vec3 middle = 0.5f * (low + high);
  middle.z() = sum.z() / static_cast<float>(on.size());
  part.centre = part.axes * middle;
  part.half = 0.5f * (high - low).head<2>().array() + kMargin;
  return part;
}

/// Whether hardly anything is just before or behind it: a body that a plane goes through is as thick as wide.
bool is_thin(const Cells& cells, const std::vector<char>& taken, const FlatPart& part, size_t on) {
  size_t beside = 0;
  for (int c = 0; c < cells.count(); ++c) {
    if (!taken[c]) continue;
    const Vec3 own = part.axes.transpose() * (cells.mean(c) - part.centre);
    const float off = std::abs(own.z());
    beside += std::abs(own.x()) <= part.half.x() && std::abs(own.y()) <= part.half.y() &&
              off > 1.5f * FlatPart::kThickness && off < 4 * FlatPart::kThickness;
  }
  return 3 * beside < on;
}

/// The level sheet with most cells.
std::optional<FlatPart> level_part(const Cells& cells, const std::vector<char>& taken) {
  std::vector<std::pair<float, int>> open;  // height, cell with nothing right above
  for (int c = 0; c < cells.count(); ++c) {
    if (!taken[c]) continue;
    bool covered = false;
    for (int up = 2; up <= 4 && !covered; ++up)
      covered = cells.find(cells.place(c) + CellMap::Place(0, up, 0)) >= 0;
    if (!covered) open.emplace_back(cells.mean(c).y(), c);
  }
  std::sort(open.begin(), open.end());
  size_t best = 0, most = 0;
  for (size_t low = 0, high = 0; high < open.size(); ++high) {
    while (open[high].first - open[low].first > FlatPart::kThickness) ++low;
    if (high - low + 1 > most) most = high - low + 1, best = low;
  }
  const float cell_area = cells.size_m() * cells.size_m();
  if (static_cast<float>(most) * cell_area < kLevelArea) return std::nullopt;
  std::vector<int> on;
  for (size_t i = best; i < best + most; ++i) on.push_back(open[i].second);
  on = largest_set(cells, on);
  if (static_cast<float>(on.size()) * cell_area < kLevelArea) return std::nullopt;
  const FlatPart part = rectangle(cells, on, Vec3::UnitY());
  return is_thin(cells, taken, part, on.size()) ? std::optional(part) : std::nullopt;
}

/// The upright plane with most cells.
std::optional<FlatPart> upright_part(const Cells& cells, const std::vector<char>& taken) {
  std::vector<int> which;
  for (int c = 0; c < cells.count(); ++c)
    if (taken[c]) which.push_back(c);
  const float cell_area = cells.size_m() * cells.size_m();
  if (static_cast<float>(which.size()) * cell_area < kUprightArea) return std::nullopt;
  Rng rng(1);
  Points some(std::min<size_t>(which.size(), 3000), 3);
  for (auto row : some.rowwise()) row = cells.means().row(which[rng.below(which.size())]);
  Vec3 normal = Vec3::UnitX();
  float offset = 0;
  Eigen::Index most = 0;
  for (int t = 0; t < kPlaneTries; ++t) {
    const Vec3 a = some.row(rng.below(some.rows())), b = some.row(rng.below(some.rows()));
    const Vec3 n = (b - a).cross(Vec3::UnitY());
    if (n.norm() < 0.2f) continue;
    const Vec3 unit = n.normalized();
    const Eigen::Index on = (((some * unit).array() - unit.dot(a)).abs() < FlatPart::kThickness).count();
    if (on > most) most = on, normal = unit, offset = unit.dot(a);
  }
  std::vector<int> on;
  for (const int c : which)
    if (std::abs(normal.dot(cells.mean(c)) - offset) < FlatPart::kThickness) on.push_back(c);
  on = largest_set(cells, on);
  if (static_cast<float>(on.size()) * cell_area < kUprightArea) return std::nullopt;
  const FlatPart part = rectangle(cells, on, normal);
  return is_thin(cells, taken, part, on.size()) ? std::optional(part) : std::nullopt;
}

}  // namespace

std::vector<FlatPart> find_flat_parts(const Cells& cells, const std::vector<char>& taken, int most) {
  std::vector<char> left = taken;
  std::vector<FlatPart> parts;
  while (static_cast<int>(parts.size()) < most) {
    auto part = upright_part(cells, left);
    if (!part) part = level_part(cells, left);
    if (!part) break;
    parts.push_back(*part);
    for (int c = 0; c < cells.count(); ++c)
      if (left[c] && part->holds(cells.mean(c))) left[c] = 0;
  }
  return parts;
}

}  // namespace understudy
