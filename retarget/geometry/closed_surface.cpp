#include "retarget/geometry/closed_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/union_find.hpp"
#include "retarget/geometry/cloud_normals.hpp"
#include "retarget/geometry/implicit_surface.hpp"
#include "retarget/geometry/point_tree.hpp"

namespace understudy {
namespace {

// The work is done in a body of this size, metres: what polygonise() is made for.
constexpr float kWorkSize = 1.6f;
constexpr float kFinestCell = kWorkSize / 230;
constexpr float kCellInSpacings = 1.1f;
constexpr int kMargin = 6;       // cells about the body
constexpr float kScreening = 1;  // of the points' own places, beside their normals'
constexpr int kLevels = 3;
constexpr float kThick = 0.09f;  // of the body's size: pieces as thick as that have the longest edges
constexpr float kFinestEdges = 0.45f;

/// Numbers at the nodes of a regular grid.
struct NodeGrid {
  std::array<int, 3> count;
  Vec3 low;
  float cell;
  size_t size() const {
    return static_cast<size_t>(count[0]) * static_cast<size_t>(count[1]) * static_cast<size_t>(count[2]);
  }
  size_t at(int x, int y, int z) const {
    return static_cast<size_t>(x) +
           static_cast<size_t>(count[0]) *
               (static_cast<size_t>(y) + static_cast<size_t>(count[1]) * static_cast<size_t>(z));
  }
  std::array<size_t, 3> strides() const {
    return {1, static_cast<size_t>(count[0]), static_cast<size_t>(count[0]) * static_cast<size_t>(count[1])};
  }
  Vec3 high() const { return low + cell * Vec3(count[0] - 1, count[1] - 1, count[2] - 1); }

  /// visit(node, share) of the eight nodes about a place, which are moved by `shift` cells.
  template <class Visit>
  void about(const Vec3& place, const Vec3& shift, Visit&& visit) const {
    const Vec3 in_cells = (place - low) / cell - shift;
    std::array<int, 3> first;
    Vec3 part;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = std::clamp(static_cast<int>(std::floor(in_cells[axis])), 0, count[axis] - 2);
      part[axis] = std::clamp(in_cells[axis] - static_cast<float>(first[axis]), 0.0f, 1.0f);
    }
    for (int corner = 0; corner < 8; ++corner) {
      const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
      const float share =
          (x ? part.x() : 1 - part.x()) * (y ? part.y() : 1 - part.y()) * (z ? part.z() : 1 - part.z());
      visit(at(first[0] + x, first[1] + y, first[2] + z), share);
    }
  }
  float value(const std::vector<float>& nodes, const Vec3& place) const {
    float sum = 0;
    about(place, Vec3::Zero(), [&](size_t node, float share) { sum += share * nodes[node]; });
    return sum;
  }
};

NodeGrid grid_about(const Points& points, float cell) {
  NodeGrid grid;
  grid.cell = cell;
  const Vec3 low = points.colwise().minCoeff().transpose(), high = points.colwise().maxCoeff().transpose();
  for (int axis = 0; axis < 3; ++axis)
    grid.count[axis] = static_cast<int>(std::ceil((high[axis] - low[axis]) / cell)) + 2 * kMargin + 1;
  grid.low = low - Vec3::Constant(static_cast<float>(kMargin) * cell);
  return grid;
}

/// How much surface each point stands for, square metres: as many as face alike about it share a disc.
std::vector<float> areas_of(const OrientedPoints& cloud, const PointTree& tree, float spacing) {
  constexpr int kNear = 24;
  const float reach = 2.5f * spacing;
  std::vector<float> areas(static_cast<size_t>(cloud.points.rows()));
  std::vector<PointTree::Near> near;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    tree.nearest(cloud.points.row(i).transpose(), kNear, near);
    float widest = reach * reach;
    int count = 0;
    if (ssize(near) == kNear) widest = std::min(widest, near.back().squared);
    for (const PointTree::Near& n : near)
      count += n.squared <= widest && cloud.normals.row(i).dot(cloud.normals.row(n.point)) > 0;
    areas[static_cast<size_t>(i)] = kPi * widest / static_cast<float>(std::max(count, 3));
  }
  return areas;
}

/// The indicator of a solid: about 1 inside, 0 outside.
class Poisson {
 public:
  Poisson(const OrientedPoints& cloud, const std::vector<float>& areas, float cell)
      : grid(grid_about(cloud.points, cell)), values(grid.size(), 0.0f) {
    splat(cloud, areas);
  }
  /// Begins with a coarser solution.
  void start_from(const Poisson& coarse) {
    inner([&](size_t node, int x, int y, int z) {
      values[node] = coarse.grid.value(coarse.values, grid.low + grid.cell * Vec3(x, y, z));
    });
  }
  void solve(int steps);

  NodeGrid grid;
  std::vector<float> values;

 private:
  void splat(const OrientedPoints& cloud, const std::vector<float>& areas);
  void applied(const std::vector<float>& to, std::vector<float>& result) const;
  template <class Visit>
  void inner(Visit&& visit) const {
    for (int z = 1; z + 1 < grid.count[2]; ++z)
      for (int y = 1; y + 1 < grid.count[1]; ++y)
        for (int x = 1; x + 1 < grid.count[0]; ++x) visit(grid.at(x, y, z), x, y, z);
  }

  std::vector<float> wanted_, holds_;  // the right side; the screening, beside the Laplacian's diagonal
};

/// Everything times the cell's square, so that the Laplacian is made of whole numbers.
void Poisson::splat(const OrientedPoints& cloud, const std::vector<float>& areas) {
  wanted_.assign(grid.size(), 0.0f);
  holds_.assign(grid.size(), 0.0f);
  const std::array<size_t, 3> strides = grid.strides();
  const float square = grid.cell * grid.cell;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const Vec3 place = cloud.points.row(i).transpose();
    const float area = areas[static_cast<size_t>(i)] / square;
    grid.about(place, Vec3::Zero(), [&](size_t node, float share) {
      holds_[node] += kScreening * area * share;
      wanted_[node] += 0.5f * kScreening * area * share;
    });
    for (int axis = 0; axis < 3; ++axis) {  // normals between nodes: the field's flow out of each
      const float flow = area * cloud.normals(i, axis);
      grid.about(place, 0.5f * Vec3::Unit(axis), [&](size_t node, float share) {
        wanted_[node] += flow * share;
        wanted_[node + strides[static_cast<size_t>(axis)]] -= flow * share;
      });
    }
  }
}

void Poisson::applied(const std::vector<float>& to, std::vector<float>& result) const {
  const auto [sx, sy, sz] = grid.strides();
  for (int z = 1; z + 1 < grid.count[2]; ++z)
    for (int y = 1; y + 1 < grid.count[1]; ++y) {
      const size_t begin = grid.at(1, y, z), end = begin + static_cast<size_t>(grid.count[0]) - 2;
      for (size_t i = begin; i < end; ++i)
        result[i] = (6 + holds_[i]) * to[i] - to[i - sx] - to[i + sx] - to[i - sy] - to[i + sy] - to[i - sz] -
                    to[i + sz];
    }
}

/// Conjugate gradients.
void Poisson::solve(int steps) {
  std::vector<float> residual(grid.size(), 0.0f), direction(grid.size(), 0.0f), image(grid.size(), 0.0f);
  applied(values, image);
  inner([&](size_t i, int, int, int) { direction[i] = residual[i] = wanted_[i] - image[i]; });
  const auto product = [](const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i] * b[i]);
    return sum;
  };
  double square = product(residual, residual);
  const double enough = 1e-7 * square;
  for (int step = 0; step < steps && square > enough && square > 0; ++step) {
    applied(direction, image);
    const auto length = static_cast<float>(square / product(direction, image));
    for (size_t i = 0; i < values.size(); ++i) {
      values[i] += length * direction[i];
      residual[i] -= length * image[i];
    }
    const double next = product(residual, residual);
    const auto kept = static_cast<float>(next / square);
    square = next;
    for (size_t i = 0; i < values.size(); ++i) direction[i] = residual[i] + kept * direction[i];
  }
}

Poisson solved(const OrientedPoints& cloud, const std::vector<float>& areas, float cell, int level) {
  Poisson poisson(cloud, areas, cell);
  if (level > 0) poisson.start_from(solved(cloud, areas, 2 * cell, level - 1));
  poisson.solve(level > 0 ? 30 : 150);
  return poisson;
}

/// The solution as distances, about.
class FoundSolid {
 public:
  FoundSolid(const OrientedPoints& cloud, Poisson poisson) : poisson_(std::move(poisson)) {
    double sum = 0, slope = 0;
    for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
      const Vec3 at = cloud.points.row(i).transpose(),
                 step = poisson_.grid.cell * cloud.normals.row(i).transpose();
      sum += static_cast<double>(inside(at));
      slope += static_cast<double>(inside(at - step) - inside(at + step));
    }
    const auto count = static_cast<double>(cloud.points.rows());
    level_ = static_cast<float>(sum / count);
    US_CHECK(slope > 0, "points that enclose nothing");
    slope_ = static_cast<float>(slope / count) / (2 * poisson_.grid.cell);
  }
  float distance(const Vec3& at) const { return (level_ - inside(at)) / slope_; }
  /// How far through the body it is from a place on the surface.
  float thickness(const Vec3& at, float most) const {
    const float h = poisson_.grid.cell;
    Vec3 inwards;
    for (int axis = 0; axis < 3; ++axis)
      inwards[axis] = distance(at - h * Vec3::Unit(axis)) - distance(at + h * Vec3::Unit(axis));
    inwards.normalize();
    float through = h;
    while (through < most && distance(at + through * inwards) < 0) through += h;
    return through;
  }
  const NodeGrid& grid() const { return poisson_.grid; }

 private:
  float inside(const Vec3& at) const { return poisson_.grid.value(poisson_.values, at); }
  Poisson poisson_;
  float level_ = 0.5f, slope_ = 1;
};

Mesh polygonised(const FoundSolid& found, int vertices) {
  ImplicitSolid solid;
  solid.value = [&](const Vec3& at) { return found.distance(at); };
  solid.warp = [](const Vec3& at) { return at; };
  constexpr float kMost = kThick * kWorkSize;
  solid.detail = [&](const Vec3& at) {
    return std::clamp(found.thickness(at, kMost) / kMost, kFinestEdges, 1.0f);
  };
  solid.low = found.grid().low;
  solid.high = found.grid().high();
  solid.cell = found.grid().cell;
  solid.vertices = vertices;
  solid.mirrored = false;
  return polygonise(solid);
}

/// Without the pieces that are small.
Mesh large_pieces(const Mesh& mesh) {
  constexpr int kSmall = 50;
  UnionFind pieces(static_cast<size_t>(mesh.vertices.rows()));
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    pieces.join(mesh.faces(f, 0), mesh.faces(f, 1));
    pieces.join(mesh.faces(f, 0), mesh.faces(f, 2));
  }
  std::vector<int> sizes(static_cast<size_t>(mesh.vertices.rows()), 0);
  for (int v = 0; v < mesh.vertices.rows(); ++v) ++sizes[static_cast<size_t>(pieces.root(v))];
  const int largest = *std::max_element(sizes.begin(), sizes.end());
  std::vector<char> kept(sizes.size());
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    kept[static_cast<size_t>(v)] = kSmall * sizes[static_cast<size_t>(pieces.root(v))] >= largest;
  return kept_part(mesh, kept);
}

/// Each vertex along its normal to the mean plane of the points about it that face as it does.
void lay_on(const OrientedPoints& cloud, const PointTree& tree, float radius, Mesh& mesh) {
  constexpr int kNear = 20;
  const Points normals = vertex_normals(mesh.vertices, mesh.faces);
  std::vector<PointTree::Near> near;
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v) {
    const Vec3 at = mesh.vertices.row(v).transpose(), normal = normals.row(v).transpose();
    tree.nearest(at, kNear, near);
    float off = 0, weights = 0;
    for (const PointTree::Near& n : near) {
      const Vec3 facing = cloud.normals.row(n.point).transpose();
      const float alike = facing.dot(normal);
      if (alike < 0.5f || n.squared > 4 * radius * radius) continue;
      const float weight = alike * std::exp(-n.squared / (radius * radius));
      off += weight * facing.dot(cloud.points.row(n.point).transpose() - at) * alike;
      weights += weight;
    }
    if (weights > 1e-3f)
      mesh.vertices.row(v) += (std::clamp(off / weights, -radius, radius) * normal).transpose();
  }
}

}  // namespace

Mesh closed_surface(const OrientedPoints& cloud, int vertices) {
  constexpr Eigen::Index kFewest = 30;
  US_CHECK(cloud.points.rows() >= kFewest, "a surface through ", cloud.points.rows(), " points");
  const float size = box_diagonal(cloud.points);
  US_CHECK(std::isfinite(size) && size > 0, "points that enclose nothing");
  const float scale = kWorkSize / size;
  const Eigen::RowVector3f middle = cloud.points.colwise().mean();
  const OrientedPoints worked{scale * (cloud.points.rowwise() - middle), cloud.normals};
  const float spacing = point_spacing(worked.points);
  const PointTree tree(worked.points);
  const float cell = std::max(kFinestCell, kCellInSpacings * spacing);
  const FoundSolid found(worked, solved(worked, areas_of(worked, tree, spacing), cell, kLevels - 1));
  Mesh mesh = large_pieces(polygonised(found, vertices));
  for (int pass = 0; pass < 2; ++pass) lay_on(worked, tree, 1.6f * spacing, mesh);
  mesh.vertices = (mesh.vertices / scale).rowwise() + middle;
  return mesh;
}

}  // namespace understudy
