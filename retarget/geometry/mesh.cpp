#include "retarget/geometry/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/geometry/point_tree.hpp"

namespace understudy {

float box_diagonal(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

Points vertex_normals(const Points& vertices, const Faces& faces) {
  Points normals = Points::Zero(vertices.rows(), 3);
  const float* at = vertices.data();  // plain loops: this runs for every frame of a film
  float* out = normals.data();
  for (const int *f = faces.data(), *end = f + faces.size(); f != end; f += 3) {
    const float *a = at + 3 * f[0], *b = at + 3 * f[1], *c = at + 3 * f[2];
    const float u[] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    // u x v is twice the area long: the weighting comes for free
    const float n[] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis) out[3 * f[k] + axis] += n[axis];
  }
  for (float *n = out, *end = out + normals.size(); n != end; n += 3) {
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (length > 1e-20f)
      for (int axis = 0; axis < 3; ++axis) n[axis] /= length;
  }
  return normals;
}

bool is_closed(const Faces& faces) {
  std::vector<uint64_t> edges;
  edges.reserve(faces.size());
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<uint64_t>(faces(f, k)), b = static_cast<uint64_t>(faces(f, (k + 1) % 3));
      edges.push_back(std::min(a, b) << 32 | std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  const size_t n = edges.size();
  for (size_t i = 0; i < n; i += 2)  // each edge twice, never four times
    if (i + 1 == n || edges[i] != edges[i + 1] || (i + 2 < n && edges[i] == edges[i + 2])) return false;
  return n > 0;
}

SurfaceSampler::SurfaceSampler(const Points& vertices, const Faces& faces) : cumulative_area_(faces.rows()) {
  double total = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = vertices.row(faces(f, 0)), b = vertices.row(faces(f, 1)), c = vertices.row(faces(f, 2));
    const float area = 0.5f * (b - a).cross(c - a).norm();
    if (std::isfinite(area)) total += area;
    cumulative_area_[f] = total;
  }
  US_CHECK(total > 0, "the mesh has no surface to sample");
}

SurfaceSampler::Sample SurfaceSampler::sample(Rng& rng) const {
  const double at = rng.uniform() * cumulative_area_.back();
  const auto it = std::upper_bound(cumulative_area_.begin(), cumulative_area_.end(), at);
  const int face =
      static_cast<int>(std::min<size_t>(it - cumulative_area_.begin(), cumulative_area_.size() - 1));
  const float u = std::sqrt(rng.uniform()), w = rng.uniform();
  return {face, Vec3(1 - u, u * (1 - w), u * w)};
}

namespace {

Points some_points(const Points& points, int count, Rng& rng) {
  if (points.rows() <= count) return points;
  std::vector<int> order(points.rows());
  std::iota(order.begin(), order.end(), 0);
  Points chosen(count, 3);
  for (int i = 0; i < count; ++i) {
    std::swap(order[i], order[i + rng.below(static_cast<int>(order.size()) - i)]);
    chosen.row(i) = points.row(order[i]);
  }
  return chosen;
}

}  // namespace

Points sample_points(const Mesh& mesh, int count, Rng& rng) {
  if (mesh.is_cloud()) return some_points(mesh.vertices, count, rng);
  const SurfaceSampler sampler(mesh.vertices, mesh.faces);
  Points points(count, 3);
  for (int i = 0; i < count; ++i) {
    const auto s = sampler.sample(rng);
    points.row(i).setZero();
    for (int k = 0; k < 3; ++k) points.row(i) += s.barycentric[k] * mesh.vertices.row(mesh.faces(s.face, k));
  }
  return points;
}

std::vector<int> farthest_points(const Points& points, int count, int first) {
  US_CHECK(count <= points.rows(), "farthest point sampling needs ", count, " of ", points.rows(), " points");
  // Coordinates apart: the compiler then turns the inner loop into vector instructions.
  const Eigen::ArrayXf x = points.col(0), y = points.col(1), z = points.col(2);
  Eigen::ArrayXf distance = Eigen::ArrayXf::Constant(points.rows(), std::numeric_limits<float>::max());
  std::vector<int> chosen(count);
  Eigen::Index current = first;
  for (int i = 0; i < count; ++i) {
    chosen[i] = current;
    distance =
        distance.min((x - x[current]).square() + (y - y[current]).square() + (z - z[current]).square());
    distance.maxCoeff(&current);
  }
  return chosen;
}

std::vector<int> far_apart(const Points& points, const std::vector<int>& of, int count) {
  if (of.empty()) return {};
  std::vector<int> chosen = farthest_points(points(of, Eigen::all), std::min<int>(count, of.size()));
  for (int& i : chosen) i = of[i];
  return chosen;
}

void thin_cloud(Mesh& scan, Eigen::Index most) {
  if (!scan.is_cloud() || scan.vertices.rows() <= most) return;
  const Eigen::Index finite = finite_count(scan.vertices);
  if (finite <= most) return;
  const int run = static_cast<int>((finite + most - 1) / most);
  std::vector<Eigen::Index> kept;
  kept.reserve(static_cast<size_t>(most));
  Rng rng(0);  // no stripes where points come in rows
  int left = rng.below(run), in_run = 0;
  for (Eigen::Index i = 0; i < scan.vertices.rows(); ++i) {
    if (finite < scan.vertices.rows() && !scan.vertices.row(i).allFinite()) continue;
    if (in_run == left) kept.push_back(i);
    if (++in_run == run) in_run = 0, left = rng.below(run);
  }
  scan.vertices = Points(scan.vertices(kept, Eigen::all));
  if (scan.colors.rows() > 0) scan.colors = Points(scan.colors(kept, Eigen::all));
}

Points finite_points(const Points& points) {
  Points kept(points.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) kept.row(count++) = points.row(i);
  return kept.topRows(count);
}

Eigen::Index finite_count(const Points& points) {
  return points.array().isFinite().rowwise().all().count();
}

IntMatrix nearest_neighbours(const Points& points, const Points& queries, int k) {
  US_CHECK(k <= points.rows(), k, " neighbours wanted of ", points.rows(), " points");
  const PointTree tree(points);
  IntMatrix result(queries.rows(), k);
  std::vector<PointTree::Near> found;
  for (Eigen::Index q = 0; q < queries.rows(); ++q) {
    tree.nearest(queries.row(q).transpose(), k, found);
    for (int i = 0; i < k; ++i) result(q, i) = found[static_cast<size_t>(i)].point;
  }
  return result;
}

Mesh kept_part(const Mesh& scan, const std::vector<char>& kept) {
  std::vector<char> used(kept.size(), 0);
  std::vector<Eigen::Index> faces;
  for (Eigen::Index f = 0; f < scan.faces.rows(); ++f) {
    const auto corners = scan.faces.row(f);
    if (!std::all_of(corners.begin(), corners.end(), [&](int v) { return kept[v]; })) continue;
    faces.push_back(f);
    for (const int v : corners) used[v] = 1;
  }
  const std::vector<char>& stays = scan.is_cloud() ? kept : used;
  std::vector<int> which, renumbered(kept.size(), -1);
  for (int v = 0; v < scan.vertices.rows(); ++v)
    if (stays[v]) renumbered[v] = static_cast<int>(which.size()), which.push_back(v);
  Mesh result;
  result.vertices = scan.vertices(which, Eigen::all);
  if (scan.colors.rows() == scan.vertices.rows()) result.colors = scan.colors(which, Eigen::all);
  result.faces = scan.faces(faces, Eigen::all).unaryExpr([&](int v) { return renumbered[v]; });
  return result;
}

}  // namespace understudy
