#include "retarget/geometry/implicit_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

using Triangle = std::array<int, 3>;

struct TriangleSoup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> faces;
};

Vec3 gradient(const ImplicitSolid& solid, const Vec3& p) {
  constexpr float h = 5e-4f;
  const float at = solid.value(p);
  Vec3 g;
  for (int axis = 0; axis < 3; ++axis) g[axis] = solid.value(p + h * Vec3::Unit(axis)) - at;
  return g / h;
}

/// One Newton step to the surface, no longer than `limit`. Points of the mirror plane stay in it.
Vec3 projected(const ImplicitSolid& solid, const Vec3& p, float limit) {
  const bool on_plane = solid.mirrored && p.x() == 0;
  const Vec3 inside_half(solid.mirrored ? std::max(p.x(), 0.0f) : p.x(), p.y(), p.z());
  Vec3 g = gradient(solid, inside_half);
  if (on_plane) g.x() = 0;
  const Vec3 step = -solid.value(inside_half) / std::max(g.squaredNorm(), 0.04f) * g;
  const float length = step.norm();
  return inside_half + (length > limit ? Vec3(step * (limit / length)) : step);
}

// ---- marching tetrahedra

/// Samples of the solid on the grid, only near its surface.
class Grid {
 public:
  static constexpr int kBlock = 8;
  using Cell = std::array<int, 3>;

  explicit Grid(const ImplicitSolid& solid) : solid_(solid) {
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = solid.high[axis] - solid.low[axis];
      blocks_[axis] = static_cast<int>(std::ceil(extent / (solid.cell * kBlock)));
      nodes_[axis] = blocks_[axis] * kBlock + 1;
    }
    values_.assign(static_cast<size_t>(nodes_[0]) * nodes_[1] * nodes_[2], kFar);
    seen_.assign(static_cast<size_t>(blocks_[0]) * blocks_[1] * blocks_[2], 0);
    for (int z = 0; z < blocks_[2]; ++z)
      for (int y = 0; y < blocks_[1]; ++y)
        for (int x = 0; x < blocks_[0]; ++x)
          if (near_surface({x, y, z})) add({x, y, z});
    // The solid's value is no exact distance, so a block may have been missed: follow the surface through the
    // walls.
    for (size_t i = 0; i < filled_.size(); ++i) follow(filled_[i]);
    std::sort(filled_.begin(), filled_.end());
  }

  const std::vector<Cell>& filled() const { return filled_; }
  size_t index(int x, int y, int z) const {
    return static_cast<size_t>(x) + static_cast<size_t>(nodes_[0]) * (y + static_cast<size_t>(nodes_[1]) * z);
  }
  Vec3 position(int x, int y, int z) const { return solid_.warp(solid_.low + Vec3(x, y, z) * solid_.cell); }
  float value(size_t node) const { return values_[node]; }

 private:
  static constexpr float kFar = 1e9f;

  bool near_surface(const Cell& block) const {
    const Vec3 half = Vec3::Constant(0.5f * kBlock * solid_.cell);
    const Vec3 centre = solid_.low + Vec3(block[0], block[1], block[2]) * (kBlock * solid_.cell) + half;
    return std::abs(solid_.value(solid_.warp(centre))) < half.norm();
  }

  void add(const Cell& block) {
    for (int axis = 0; axis < 3; ++axis)
      if (block[axis] < 0 || block[axis] >= blocks_[axis]) return;
    char& seen = seen_[block[0] + static_cast<size_t>(blocks_[0]) *
                                      (block[1] + static_cast<size_t>(blocks_[1]) * block[2])];
    if (seen) return;
    seen = 1;
    filled_.push_back(block);
    for_each_node({0, 0, 0}, {kBlock, kBlock, kBlock}, block, [this](int x, int y, int z) {
      float& v = values_[index(x, y, z)];
      if (v != kFar) return;
      v = solid_.value(position(x, y, z));
      if (std::abs(v) < 1e-6f) v = 1e-6f;  // no vertex on a node: every crossing is on an edge
    });
  }

  void follow(const Cell block) {
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        Cell from = {0, 0, 0}, to = {kBlock, kBlock, kBlock}, next = block;
        from[axis] = to[axis] = side * kBlock;
        next[axis] += side ? 1 : -1;
        int inside = 0, count = 0;
        for_each_node(from, to, block,
                      [&](int x, int y, int z) { inside += values_[index(x, y, z)] < 0, ++count; });
        if (inside > 0 && inside < count) add(next);
      }
  }

  template <class F>
  static void for_each_node(const Cell& from, const Cell& to, const Cell& block, F&& f) {
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i)
          f(block[0] * kBlock + i, block[1] * kBlock + j, block[2] * kBlock + k);
  }

  const ImplicitSolid& solid_;
  Cell blocks_{}, nodes_{};
  std::vector<float> values_;
  std::vector<char> seen_;
  std::vector<Cell> filled_;
};

/// The six tetrahedra about the diagonal of a cube (Kuhn). The same in each cube, so neighbours agree on
/// faces.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                   {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

class MarchingTetrahedra {
 public:
  explicit MarchingTetrahedra(const ImplicitSolid& solid) : grid_(solid) {
    for (const Grid::Cell& block : grid_.filled())
      for (int k = 0; k < Grid::kBlock; ++k)
        for (int j = 0; j < Grid::kBlock; ++j)
          for (int i = 0; i < Grid::kBlock; ++i)
            cube({block[0] * Grid::kBlock + i, block[1] * Grid::kBlock + j, block[2] * Grid::kBlock + k});
  }
  TriangleSoup soup;

 private:
  struct Corner {
    size_t node;
    std::array<int, 3> at;
    float value;
  };

  void cube(const std::array<int, 3>& at) {
    std::array<Corner, 8> corners;
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      const std::array<int, 3> p = {at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2)};
      const size_t node = grid_.index(p[0], p[1], p[2]);
      corners[c] = {node, p, grid_.value(node)};
      inside += corners[c].value < 0;
    }
    if (inside == 0 || inside == 8) return;
    for (const auto& tetrahedron : kTetrahedra) {
      std::array<Corner, 4> t;
      for (int c = 0; c < 4; ++c) t[c] = corners[tetrahedron[c]];
      cut(t);
    }
  }

  void cut(const std::array<Corner, 4>& t) {
    std::array<int, 4> in{}, out{};
    int n_in = 0, n_out = 0;
    for (int c = 0; c < 4; ++c) (t[c].value < 0 ? in[n_in++] : out[n_out++]) = c;
    if (n_in == 0 || n_out == 0) return;
    const auto edge = [&](int a, int b) { return std::make_pair(a, b); };
    if (n_in == 1) add(t, {edge(in[0], out[0]), edge(in[0], out[1]), edge(in[0], out[2])}, in[0], out[0]);
    if (n_in == 3) add(t, {edge(in[0], out[0]), edge(in[1], out[0]), edge(in[2], out[0])}, in[0], out[0]);
    if (n_in == 2) {
      const auto a = edge(in[0], out[0]), b = edge(in[0], out[1]), c = edge(in[1], out[1]),
                 d = edge(in[1], out[0]);
      add(t, {a, b, c}, in[0], out[0]);
      add(t, {a, c, d}, in[0], out[0]);
    }
  }

  Vec3 position(const Corner& c) const { return grid_.position(c.at[0], c.at[1], c.at[2]); }

  int vertex(const Corner& a, const Corner& b) {
    const Corner& low = a.node < b.node ? a : b;
    const Corner& high = a.node < b.node ? b : a;
    const uint64_t key = static_cast<uint64_t>(low.node) << 32 | high.node;
    const auto [found, is_new] = numbers_.try_emplace(key, soup.vertices.size());
    if (is_new) {
      const float s = std::clamp(low.value / (low.value - high.value), 0.15f, 0.85f);
      soup.vertices.push_back(position(low) * (1 - s) + position(high) * s);
    }
    return found->second;
  }

  /// The triangle through three edges of a tetrahedron. Which way it faces is asked of the edges' midpoints:
  /// the vertices themselves may lie so close that rounding decides.
  void add(const std::array<Corner, 4>& t, const std::array<std::pair<int, int>, 3>& cut_edges, int in,
           int out) {
    const auto at = [&t](int c) { return Vec3(t[c].at[0], t[c].at[1], t[c].at[2]); };
    std::array<Vec3, 3> middle;
    Triangle face;
    for (int c = 0; c < 3; ++c) {
      const auto [a, b] = cut_edges[c];
      middle[c] = 0.5f * (at(a) + at(b));
      face[c] = vertex(t[a], t[b]);
    }
    const Vec3 normal = (middle[1] - middle[0]).cross(middle[2] - middle[0]);
    if (normal.dot(at(out) - at(in)) < 0) std::swap(face[1], face[2]);
    soup.faces.push_back(face);
  }

  Grid grid_;
  std::unordered_map<uint64_t, int> numbers_;
};

// ---- remeshing (after Botsch and Kobbelt, SGP 2004)

class Remesher {
 public:
  Remesher(TriangleSoup soup, const ImplicitSolid& solid)
      : v_(std::move(soup.vertices)),
        f_(std::move(soup.faces)),
        solid_(solid),
        edge_length_(solid.vertices > 0 ? edge_length_for(solid.vertices) : solid.edge_length) {}

  TriangleSoup run() {
    for (int pass = 0; pass < 3; ++pass) smooth(0.5f, false);
    for (int pass = 0; pass < 7; ++pass) {
      collapse_short_edges();
      flip_edges();
      if (pass >= 2) smooth(0.5f);
    }
    for (int pass = 0; pass < 2; ++pass) {
      flip_edges();
      smooth(0.5f);
    }
    for (Vec3& p : v_) p = projected(solid_, p, 0.002f);
    return compacted();
  }

 private:
  bool on_plane(int v) const { return solid_.mirrored && v_[v].x() == 0; }
  bool alive(int f) const { return f_[f][0] >= 0; }
  bool has(int f, int v) const { return alive(f) && std::find(f_[f].begin(), f_[f].end(), v) != f_[f].end(); }
  /// So that the whole surface has about so many vertices, each the middle of six equal triangles.
  float edge_length_for(int vertices) const {
    double patches = 0;  // area over that of one vertex, were the edge length 1
    for (const Triangle& t : f_) {
      const float detail = solid_.detail((v_[t[0]] + v_[t[1]] + v_[t[2]]) / 3);
      patches += 0.5 * normal(t).norm() / (0.866 * detail * detail);
    }
    return static_cast<float>(std::sqrt((solid_.mirrored ? 2 : 1) * patches / vertices));
  }
  float wanted(int a, int b) const { return 0.5f * (size_[a] + size_[b]); }

  void rebuild() {
    around_.resize(v_.size());
    for (auto& list : around_) list.clear();
    for (size_t f = 0; f < f_.size(); ++f)
      if (alive(f))
        for (int v : f_[f]) around_[v].push_back(f);
    size_.resize(v_.size());
    for (size_t v = 0; v < v_.size(); ++v) size_[v] = edge_length_ * solid_.detail(v_[v]);
  }

  struct Edge {
    int a, b;
    float length;  // relative to the wanted one
  };
  std::vector<Edge> edges() const {
    std::vector<Edge> result;
    for (const Triangle& t : f_) {
      if (t[0] < 0) continue;
      for (int c = 0; c < 3; ++c) {
        const int a = t[c], b = t[(c + 1) % 3];
        const bool boundary = on_plane(a) && on_plane(b) && shared(a, b).size() == 1;
        if (a < b || boundary) result.push_back({a, b, (v_[a] - v_[b]).norm() / wanted(a, b)});
      }
    }
    return result;
  }

  std::vector<int> shared(int a, int b) const {
    std::vector<int> result;
    for (int f : around_[a])
      if (has(f, a) && has(f, b)) result.push_back(f);
    return result;
  }

  std::vector<int> neighbours(int v) const {
    std::vector<int> result;
    for (int f : around_[v])
      if (alive(f))
        for (int n : f_[f])
          if (n != v && std::find(result.begin(), result.end(), n) == result.end()) result.push_back(n);
    return result;
  }

  void collapse_short_edges() {
    rebuild();
    std::vector<Edge> short_edges = edges();
    short_edges.erase(
        std::remove_if(short_edges.begin(), short_edges.end(), [](const Edge& e) { return e.length > 0.8f; }),
        short_edges.end());
    std::sort(short_edges.begin(), short_edges.end(), [](const Edge& p, const Edge& q) {
      return p.length != q.length ? p.length < q.length : std::make_pair(p.a, p.b) < std::make_pair(q.a, q.b);
    });
    for (const Edge& e : short_edges) {
      if (shared(e.a, e.b).empty()) continue;  // one end is gone by now
      if ((v_[e.a] - v_[e.b]).norm() < 0.8f * wanted(e.a, e.b)) try_collapse(e.a, e.b);
    }
  }

  /// Merges b into a, when the surface stays a manifold, no triangle turns over and no edge becomes long.
  void try_collapse(int a, int b) {
    const std::vector<int> common_faces = shared(a, b);
    if (on_plane(a) && on_plane(b) && common_faces.size() != 1) return;
    if (on_plane(b) && !on_plane(a)) std::swap(a, b);
    const std::vector<int> na = neighbours(a), nb = neighbours(b);
    size_t common = 0;
    for (int n : na) common += std::find(nb.begin(), nb.end(), n) != nb.end();
    if (common != common_faces.size() || nb.size() + na.size() < 8 || bridges_plane(a, b, na, nb)) return;
    const Vec3 p = on_plane(a) && !on_plane(b) ? v_[a] : Vec3(0.5f * (v_[a] + v_[b]));
    for (int n : na)
      if ((v_[n] - p).norm() > 1.4f * wanted(a, n)) return;
    for (int n : nb)
      if ((v_[n] - p).norm() > 1.4f * wanted(b, n)) return;
    if (turns_over(a, b, p) || turns_over(b, a, p)) return;

    v_[a] = p;
    for (int f : around_[b]) {
      if (!alive(f)) continue;
      if (std::find(f_[f].begin(), f_[f].end(), a) != f_[f].end()) {
        f_[f][0] = -1;
        continue;
      }
      std::replace(f_[f].begin(), f_[f].end(), b, a);
      around_[a].push_back(f);
    }
  }

  /// Would merging b, off the mirror plane, into a, on it, join a to another vertex of the plane by an inner
  /// edge? The mirror image would have the same edge: four triangles at it.
  bool bridges_plane(int a, int b, const std::vector<int>& na, const std::vector<int>& nb) const {
    if (!on_plane(a) || on_plane(b)) return false;
    return std::any_of(nb.begin(), nb.end(), [&](int n) {
      return n != a && on_plane(n) && std::find(na.begin(), na.end(), n) == na.end();
    });
  }

  bool turns_over(int moving, int other, const Vec3& to) const {
    for (int f : around_[moving]) {
      if (!alive(f) || std::find(f_[f].begin(), f_[f].end(), other) != f_[f].end()) continue;
      std::array<Vec3, 3> p, q;
      for (int c = 0; c < 3; ++c) {
        p[c] = v_[f_[f][c]];
        q[c] = f_[f][c] == moving ? to : p[c];
      }
      const Vec3 before = (p[1] - p[0]).cross(p[2] - p[0]), after = (q[1] - q[0]).cross(q[2] - q[0]);
      if (after.dot(before) < 0.5f * after.norm() * before.norm()) return true;
      const float longest = std::max({(q[1] - q[0]).norm(), (q[2] - q[1]).norm(), (q[0] - q[2]).norm()});
      const float was = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
      const float quality = after.norm() / (longest * longest);
      if (quality < 0.15f && quality * was * was < before.norm()) return true;  // a worse sliver
    }
    return false;
  }

  /// Flips edges that bring the valences nearer to 6 (4 on the mirror plane).
  void flip_edges() {
    rebuild();
    std::vector<int> valence(v_.size());
    for (size_t v = 0; v < v_.size(); ++v) valence[v] = neighbours(v).size();
    for (const Edge& e : edges()) try_flip(e.a, e.b, valence);
  }

  void try_flip(int a, int b, std::vector<int>& valence) {
    const std::vector<int> two = shared(a, b);
    if (two.size() != 2) return;
    const auto opposite = [&](int f) {
      for (int n : f_[f])
        if (n != a && n != b) return n;
      return -1;
    };
    const int c = opposite(two[0]), d = opposite(two[1]);
    if (c == d || !shared(c, d).empty() || (on_plane(c) && on_plane(d))) return;
    const auto cost = [&](int v, int change) {
      const int off = valence[v] + change - (on_plane(v) ? 4 : 6);
      return off * off;
    };
    if (cost(a, -1) + cost(b, -1) + cost(c, 1) + cost(d, 1) >=
        cost(a, 0) + cost(b, 0) + cost(c, 0) + cost(d, 0))
      return;
    const bool forward = follows(two[0], a, b);
    const Triangle t0 = forward ? Triangle{c, a, d} : Triangle{c, d, a};
    const Triangle t1 = forward ? Triangle{c, d, b} : Triangle{c, b, d};
    const Vec3 n0 = normal(f_[two[0]]), n1 = normal(f_[two[1]]), m0 = normal(t0), m1 = normal(t1);
    const Vec3 mean = n0.normalized() + n1.normalized();
    if (m0.dot(mean) < 0.8f * m0.norm() * mean.norm() || m1.dot(mean) < 0.8f * m1.norm() * mean.norm())
      return;
    if (std::min(m0.norm(), m1.norm()) < 0.5f * std::min(n0.norm(), n1.norm())) return;
    f_[two[0]] = t0;
    f_[two[1]] = t1;
    drop(a, two[1]);  // t0 = c a d, t1 = c d b
    drop(b, two[0]);
    around_[c].push_back(two[1]);
    around_[d].push_back(two[0]);
    --valence[a], --valence[b], ++valence[c], ++valence[d];
  }

  void drop(int v, int f) {
    auto& list = around_[v];
    list.erase(std::remove(list.begin(), list.end(), f), list.end());
  }
  bool follows(int f, int a, int b) const {
    for (int c = 0; c < 3; ++c)
      if (f_[f][c] == a) return f_[f][(c + 1) % 3] == b;
    return false;
  }
  Vec3 normal(const Triangle& t) const { return (v_[t[1]] - v_[t[0]]).cross(v_[t[2]] - v_[t[0]]); }

  /// Moves each vertex towards the middle of its neighbours, along the surface, then onto it.
  void smooth(float amount, bool onto_surface = true) {
    rebuild();
    std::vector<Vec3> next = v_;
    for (size_t v = 0; v < v_.size(); ++v) {
      const std::vector<int> ring = neighbours(v);
      if (ring.empty()) continue;
      const bool plane = on_plane(v);
      Vec3 middle = Vec3::Zero(), n = Vec3::Zero();
      int count = 0;
      for (int r : ring)
        if (!plane || on_plane(r)) middle += v_[r], ++count;
      if (count < 2) continue;
      for (int f : around_[v])
        if (alive(f)) n += normal(f_[f]);
      if (plane) n.x() = 0;
      n.normalize();
      Vec3 step = amount * (middle / static_cast<float>(count) - v_[v]);
      step -= 0.9f * n * n.dot(step);
      next[v] = v_[v] + step;
      if (onto_surface) next[v] = projected(solid_, next[v], 0.4f * size_[v]);
      if (plane)
        next[v].x() = 0;
      else if (solid_.mirrored)
        next[v].x() = std::max(next[v].x(), 2e-4f);
    }
    v_ = std::move(next);
  }

  TriangleSoup compacted() const {
    TriangleSoup result;
    std::vector<int> number(v_.size(), -1);
    for (Triangle t : f_) {
      if (t[0] < 0) continue;
      for (int& v : t) {
        if (number[v] < 0) {
          number[v] = result.vertices.size();
          result.vertices.push_back(v_[v]);
        }
        v = number[v];
      }
      result.faces.push_back(t);
    }
    return result;
  }

  std::vector<Vec3> v_;
  std::vector<Triangle> f_;
  std::vector<std::vector<int>> around_;  // faces at each vertex, dead ones included
  std::vector<float> size_;               // wanted edge length at each vertex
  const ImplicitSolid& solid_;
  float edge_length_;
};

Mesh as_mesh(const TriangleSoup& soup) {
  Mesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(soup.vertices.size()), 3);
  mesh.faces.resize(static_cast<Eigen::Index>(soup.faces.size()), 3);
  int row = 0;
  for (const Vec3& v : soup.vertices) mesh.vertices.row(row++) = v.transpose();
  row = 0;
  for (const Triangle& t : soup.faces) mesh.faces.row(row++) << t[0], t[1], t[2];
  return mesh;
}

Mesh with_mirror_image(const TriangleSoup& half) {
  const int count = half.vertices.size();
  std::vector<int> image(count);
  int total = count;
  for (int v = 0; v < count; ++v) image[v] = half.vertices[v].x() > 0 ? total++ : v;
  Mesh mesh;
  mesh.vertices.resize(total, 3);
  for (int v = 0; v < count; ++v) {
    mesh.vertices.row(v) = half.vertices[v].transpose();
    if (image[v] != v)
      mesh.vertices.row(image[v]) << -half.vertices[v].x(), half.vertices[v].y(), half.vertices[v].z();
  }
  mesh.faces.resize(2 * static_cast<int>(half.faces.size()), 3);
  int row = 0;
  for (const Triangle& t : half.faces) {
    mesh.faces.row(row++) << t[0], t[1], t[2];
    mesh.faces.row(row++) << image[t[0]], image[t[2]], image[t[1]];
  }
  return mesh;
}

}  // namespace

Mesh polygonise(const ImplicitSolid& solid) {
  MarchingTetrahedra marching(solid);
  US_CHECK(!marching.soup.faces.empty(), "the solid has no surface inside its box");
  const TriangleSoup made = Remesher(std::move(marching.soup), solid).run();
  return solid.mirrored ? with_mirror_image(made) : as_mesh(made);
}

}  // namespace understudy
