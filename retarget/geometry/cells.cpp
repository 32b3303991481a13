#include "retarget/geometry/cells.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy {
namespace {

constexpr int kFarthestCell = (1 << 20) - 2;  // 21 bits an axis
constexpr int kMostSteps = 200;               // along a triangle's side

uint64_t key_of(const CellMap::Place& place) {
  const auto bits = [](int v) { return static_cast<uint64_t>(v + (1 << 20)) & 0x1fffff; };
  return bits(place.x()) << 42 | bits(place.y()) << 21 | bits(place.z());
}

uint64_t scattered(uint64_t key) {
  key ^= key >> 31;
  key *= 0x9e3779b97f4a7c15ull;
  return key ^ key >> 29;
}

size_t power_of_two(size_t least) {
  size_t size = 64;
  while (size < least) size *= 2;
  return size;
}

}  // namespace

CellMap::CellMap(size_t expected) : slots_(power_of_two(2 * expected), Slot{0, -1}) {}

size_t CellMap::slot_of(uint64_t key) const {
  const size_t mask = slots_.size() - 1;
  size_t slot = scattered(key) & mask;
  while (slots_[slot].number >= 0 && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

void CellMap::grow() {
  std::vector<Slot> old(2 * slots_.size(), Slot{0, -1});
  old.swap(slots_);
  for (const Slot& slot : old)
    if (slot.number >= 0) slots_[slot_of(slot.key)] = slot;
}

int& CellMap::at(const Place& place, int added) {
  const uint64_t key = key_of(place);
  size_t slot = slot_of(key);
  if (slots_[slot].number >= 0) return slots_[slot].number;
  if (2 * ++used_ > slots_.size()) {
    grow();
    slot = slot_of(key);
  }
  slots_[slot] = {key, added};
  return slots_[slot].number;
}

int CellMap::find(const Place& place) const {
  if (place.cwiseAbs().maxCoeff() > kFarthestCell) return -1;
  return slots_[slot_of(key_of(place))].number;
}

Cells::Cells(const Mesh& scan, float size_m) : size_(size_m), inverse_(1 / size_m), map_(4096) {
  US_CHECK(size_m > 0 && std::isfinite(inverse_), "cells cannot be ", size_m, " m large");
  of_vertex_.assign(scan.vertices.rows(), -1);
  for (int v = 0; v < scan.vertices.rows(); ++v) add(scan.vertices.row(v).transpose(), v);
  add_faces(scan);
  for (int c = 0; c < count(); ++c) means_.row(c) /= static_cast<float>(counts_[c]);
  means_.conservativeResize(count(), 3);
}

Cells::Place Cells::place_of(const Vec3& point) const {
  return (point * inverse_).array().floor().max(-4e6f).min(4e6f).cast<int>();
}

void Cells::add(const Vec3& point, int vertex) {
  const Place place = point.allFinite() ? place_of(point) : Place::Constant(kFarthestCell + 1);
  if (place.cwiseAbs().maxCoeff() > kFarthestCell) return;
  const int cell = map_.at(place, count());
  if (cell == count()) {
    places_.push_back(place);
    counts_.push_back(0);
    if (means_.rows() < count())
      means_.conservativeResize(std::max<Eigen::Index>(1024, 2 * means_.rows()), 3);
    means_.row(cell).setZero();
  }
  means_.row(cell) += point.transpose();
  ++counts_[cell];
  if (vertex >= 0) of_vertex_[vertex] = cell;
}

/// Puts points into triangles that are longer than a cell, so that no cell between corners is missed.
void Cells::add_faces(const Mesh& scan) {
  for (Eigen::Index f = 0; f < scan.faces.rows(); ++f) {
    const Vec3 a = scan.vertices.row(scan.faces(f, 0)), b = scan.vertices.row(scan.faces(f, 1)),
               c = scan.vertices.row(scan.faces(f, 2));
    const float longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!(longest > size_) || !std::isfinite(longest)) continue;
    const int n = static_cast<int>(std::min<float>(kMostSteps, std::ceil(1.2f * longest * inverse_)));
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k <= n - i; ++k) {
        const float u = static_cast<float>(i) / static_cast<float>(n),
                    v = static_cast<float>(k) / static_cast<float>(n);
        add(a + u * (b - a) + v * (c - a), -1);
      }
  }
}

const std::vector<CellMap::Place>& neighbour_cells() {
  static const std::vector<CellMap::Place> all = [] {
    std::vector<CellMap::Place> found;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (x != 0 || y != 0 || z != 0) found.emplace_back(x, y, z);
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
    return found;
  }();
  return all;
}

std::vector<int> connected_cells(const Cells& cells, const std::vector<char>& taken, int* count) {
  std::vector<int> set(cells.count(), -1), open;
  int sets = 0;
  for (int first = 0; first < cells.count(); ++first) {
    if (!taken[first] || set[first] >= 0) continue;
    set[first] = sets;
    open.assign(1, first);
    while (!open.empty()) {
      const int cell = open.back();
      open.pop_back();
      for (const CellMap::Place& step : neighbour_cells()) {
        const int beside = cells.find(cells.place(cell) + step);
        if (beside < 0 || !taken[beside] || set[beside] >= 0) continue;
        set[beside] = sets;
        open.push_back(beside);
      }
    }
    ++sets;
  }
  if (count) *count = sets;
  return set;
}

std::vector<CellSet> connected_sets(const Cells& cells, const std::vector<char>& taken) {
  int count = 0;
  const std::vector<int> set_of = connected_cells(cells, taken, &count);
  std::vector<CellSet> sets(count);
  for (int c = 0; c < cells.count(); ++c)
    if (set_of[c] >= 0) sets[set_of[c]].push_back(c);
  return sets;
}

}  // namespace understudy
