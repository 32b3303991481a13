#include "retarget/pipeline/torn_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "retarget/base/union_find.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

constexpr float kStiff = 0.1f;      // summed differences of weights across a link within a piece
constexpr float kTouching = 0.01f;  // of the height

using Pair = std::pair<int, int>;

std::vector<Pair> edges_of(const Faces& faces) {
  std::vector<Pair> out;
  out.reserve(static_cast<size_t>(3 * faces.rows()));
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = faces(f, k), b = faces(f, (k + 1) % 3);
      if (a != b) out.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Where different shells come near each other: of each two in cells side by side a pair of vertices.
std::vector<Pair> touching_shells(const Points& vertices, const std::vector<int>& shell, float cell) {
  using Cell = std::array<int, 3>;
  std::map<Cell, std::map<int, int>> cells;  // of each shell a vertex
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    const auto at = [&](int axis) { return static_cast<int>(std::floor(vertices(v, axis) / cell)); };
    cells[{at(0), at(1), at(2)}].emplace(shell[v], static_cast<int>(v));
  }
  std::vector<Pair> out;
  for (const auto& [where, here] : cells)
    for (int i = 0; i < 14; ++i) {  // itself and half of its neighbours
      const int n = i + 13;
      const auto other = cells.find({where[0] + n / 9 - 1, where[1] + n / 3 % 3 - 1, where[2] + n % 3 - 1});
      if (other == cells.end()) continue;
      for (const auto& [shell_a, a] : here)
        for (const auto& [shell_b, b] : other->second)
          if (shell_a != shell_b) out.emplace_back(a, b);
    }
  return out;
}

std::vector<Pair> links_of(const Mesh& rest, float height) {
  std::vector<Pair> links = edges_of(rest.faces);
  UnionFind shells(static_cast<size_t>(rest.vertices.rows()));
  for (const auto& [a, b] : links) shells.join(a, b);
  std::vector<int> shell(static_cast<size_t>(rest.vertices.rows()));
  for (size_t v = 0; v < shell.size(); ++v) shell[v] = shells.root(static_cast<int>(v));
  const bool is_one = std::all_of(shell.begin(), shell.end(), [&](int s) { return s == shell[0]; });
  if (is_one) return links;
  const auto touching = touching_shells(rest.vertices, shell, kTouching * height);
  links.insert(links.end(), touching.begin(), touching.end());
  return links;
}

}  // namespace

TornSurface::TornSurface(const Mesh& rest, const RowMatrix& weights) {
  const Eigen::Index count = rest.vertices.rows();
  if (rest.is_cloud() || weights.rows() != count || !rest.vertices.allFinite()) return;
  height_ = rest.vertices.col(1).maxCoeff() - rest.vertices.col(1).minCoeff();
  if (!(height_ > 0)) return;
  const std::vector<Pair> all = links_of(rest, height_);
  UnionFind pieces(static_cast<size_t>(count));
  for (const auto& [a, b] : all)
    if ((weights.row(a) - weights.row(b)).cwiseAbs().sum() < kStiff) pieces.join(a, b);
  std::vector<int> number(static_cast<size_t>(count), -1), piece_of(static_cast<size_t>(count));
  for (Eigen::Index v = 0; v < count; ++v) {
    int& piece = number[pieces.root(static_cast<int>(v))];
    if (piece < 0) {
      piece = static_cast<int>(size_.size());
      size_.push_back(0);
    }
    piece_of[v] = piece;
    ++size_[piece];
  }
  smallest_ = static_cast<int>(count / 100) + 1;
  std::unordered_map<int, int> end_of;
  const auto end = [&](int v) {
    const auto [found, is_new] = end_of.emplace(v, static_cast<int>(end_vertices_.size()));
    if (is_new) {
      end_vertices_.push_back(v);
      piece_.push_back(piece_of[v]);
    }
    return found->second;
  };
  for (const auto& [a, b] : all)
    if (piece_of[a] != piece_of[b])
      links_.push_back({end(a), end(b), (rest.vertices.row(a) - rest.vertices.row(b)).norm()});
  const auto ends = static_cast<Eigen::Index>(end_vertices_.size());
  ends_.resize(ends, 3);
  weights_.resize(ends, weights.cols());
  for (Eigen::Index e = 0; e < ends; ++e) {
    ends_.row(e) = rest.vertices.row(end_vertices_[e]);
    weights_.row(e) = weights.row(end_vertices_[e]);
  }
}

float TornSurface::parted(const Points& vertices) const {
  if (links_.empty()) return 0;
  Points ends(ends_.rows(), 3);
  for (Eigen::Index e = 0; e < ends.rows(); ++e) ends.row(e) = vertices.row(end_vertices_[e]);
  return parted_ends(ends);
}

float TornSurface::parted(const Joints& rest_joints, const Pose& pose) const {
  if (links_.empty()) return 0;
  return parted_ends(
      linear_blend_skinning(ends_, weights_, rest_joints, forward_kinematics(rest_joints, pose)));
}

float TornSurface::parted_ends(const Points& ends) const {
  const auto grown = [&](const Link& link) {
    return ((ends.row(link.a) - ends.row(link.b)).norm() - link.length) / height_;
  };
  UnionFind held(size_.size());
  bool all_hold = true;
  for (const Link& link : links_) {
    const bool holds = grown(link) <= kMost;
    if (holds) held.join(piece_[link.a], piece_[link.b]);
    all_hold = all_hold && holds;
  }
  if (all_hold) return 0;
  std::vector<int> size(size_.size(), 0);
  for (size_t p = 0; p < size_.size(); ++p) size[held.root(static_cast<int>(p))] += size_[p];
  std::map<Pair, float> gap;  // between two that no longer hold: its best link
  for (const Link& link : links_) {
    const int a = held.root(piece_[link.a]), b = held.root(piece_[link.b]);
    if (a == b || std::min(size[a], size[b]) < smallest_) continue;
    const auto [found, is_new] = gap.emplace(Pair(std::min(a, b), std::max(a, b)), grown(link));
    if (!is_new) found->second = std::min(found->second, grown(link));
  }
  float most = 0;
  for (const auto& [pieces, share] : gap) most = std::max(most, share);
  return most;
}

}  // namespace understudy
