#include "retarget/editing/target_edits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/editing/point_grid.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Row = Eigen::Matrix<float, 1, kJointCount>;

void check_weights(const RowMatrix& weights, Eigen::Index vertices) {
  US_CHECK(weights.cols() == kJointCount && weights.rows() == vertices, "skin weights of ", weights.rows(),
           " x ", weights.cols(), " do not fit ", vertices, " vertices and ", kJointCount, " joints");
}

/// Not negative, sum 1; a row with nothing in it stays as it was.
Row normalised(const Row& row, const Row& otherwise) {
  const Row positive = row.cwiseMax(0.0f);
  const float sum = positive.sum();
  if (!(sum > 1e-8f) || !std::isfinite(sum)) return otherwise;
  return positive / sum;
}

Row mirrored(const Row& row) {
  Row result;
  for (int j = 0; j < kJointCount; ++j) result[kMirror[j]] = row[j];
  return result;
}

using RowsByVertex = std::map<int, Row>;

WeightRows in_order(const RowsByVertex& rows) {
  WeightRows result;
  result.rows.resize(rows.size(), kJointCount);
  for (const auto& [vertex, row] : rows) {
    result.rows.row(result.vertex.size()) = row;
    result.vertex.push_back(vertex);
  }
  return result;
}

using Pairs = std::vector<std::pair<int, int>>;

Pairs edges(const Faces& faces, int vertices) {
  Pairs pairs;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = faces(f, k), b = faces(f, (k + 1) % 3);
      US_CHECK(a >= 0 && a < vertices, "face ", f, " has vertex ", a, " of ", vertices);
      if (a != b) pairs.emplace_back(a, b);
    }
  return pairs;
}

/// Joins vertices at one place: exporters split them where textures have seams.
void add_seams(const Points& vertices, Pairs& pairs) {
  std::map<std::array<float, 3>, int> last;  // at each place
  for (int v = 0; v < vertices.rows(); ++v) {
    const auto [at, is_first] = last.try_emplace({vertices(v, 0), vertices(v, 1), vertices(v, 2)}, v);
    if (!is_first) pairs.emplace_back(std::exchange(at->second, v), v);
  }
}

Vec3 extent(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).transpose();
}

/// Metres, of a grid in whose cells a few points of a surface are.
float cell_size(const Points& points) {
  const Vec3 size = extent(points);
  const float area = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  return std::max(2 * std::sqrt(area / static_cast<float>(points.rows())), 1e-5f * size.norm() + 1e-9f);
}

/// The six nearest of each point of a cloud.
Pairs nearest_pairs(const Points& points) {
  constexpr int kNearest = 6;
  Pairs pairs;
  if (points.rows() <= kNearest) return pairs;
  const float cell = cell_size(points), size = extent(points).norm();
  const PointGrid grid(points, cell);
  std::vector<std::pair<float, int>> found;
  for (int v = 0; v < points.rows(); ++v) {
    for (float reach = cell;; reach *= 2) {
      found.clear();
      grid.around(points.row(v).transpose(), reach, [&](int k) {
        const float d = (points.row(k) - points.row(v)).squaredNorm();
        if (k != v && d <= reach * reach) found.emplace_back(d, k);
      });
      if (found.size() >= kNearest || reach > 4 * size) break;
    }
    const size_t count = std::min<size_t>(kNearest, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<long>(count), found.end());
    for (size_t i = 0; i < count; ++i) pairs.emplace_back(v, found[i].second);
  }
  return pairs;
}

/// Path lengths over the surface from the vertex nearest to `hit`, only inside the ball of the brush and up
/// to `reach`: pairs (vertex, length).
std::vector<std::pair<int, float>> hanging_together(const PaintSurface& surface, const Vec3& hit,
                                                    float radius, float reach) {
  const Points& p = surface.vertices;
  Eigen::Index seed = 0;
  (p.rowwise() - hit.transpose()).rowwise().squaredNorm().minCoeff(&seed);
  const auto from_hit = [&](int v) { return (p.row(v).transpose() - hit).norm(); };

  std::vector<float> length(p.rows(), std::numeric_limits<float>::infinity());
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<std::pair<int, float>> found;
  const float start = from_hit(seed);
  if (!(start < radius)) return found;
  length[seed] = start;
  open.push({start, static_cast<int>(seed)});
  while (!open.empty()) {
    const auto [d, v] = open.top();
    open.pop();
    if (d > length[v]) continue;
    found.emplace_back(v, d);
    for (int k = surface.neighbours.start[v]; k < surface.neighbours.start[v + 1]; ++k) {
      const int n = surface.neighbours.index[k];
      const float next = d + (p.row(n) - p.row(v)).norm();
      if (next >= reach || next >= length[n] || from_hit(n) >= radius) continue;
      length[n] = next;
      open.push({next, n});
    }
  }
  return found;
}

Row neighbours_mean(const RowMatrix& weights, const Neighbours& neighbours, int v) {
  const int begin = neighbours.start[v], end = neighbours.start[v + 1];
  if (begin == end) return weights.row(v);
  Row sum = Row::Zero();
  for (int k = begin; k < end; ++k) sum += weights.row(neighbours.index[k]);
  return sum / static_cast<float>(end - begin);
}

/// A row whose joint `j` has weight `wanted`, the rest shared as before.
Row with_weight(const Row& row, int j, float wanted) {
  const float others = row.sum() - row[j];
  Row result = row;
  if (others > 1e-6f)
    result *= (1 - wanted) / others;
  else
    result[j == Pelvis ? static_cast<int>(Spine1) : kParents[j]] = 1 - wanted;
  result[j] = wanted;
  return normalised(result, row);
}

Row painted(const RowMatrix& weights, const Neighbours& neighbours, int v, const Brush& brush, float amount) {
  const Row row = weights.row(v);
  const float now = row[brush.joint];
  switch (brush.mode) {
    case BrushMode::Add:
      return with_weight(row, brush.joint, now + amount * (1 - now));
    case BrushMode::Subtract:
      return now > 0 ? with_weight(row, brush.joint, now * (1 - amount)) : row;
    case BrushMode::Smooth:
      break;
  }
  return normalised(row + amount * (neighbours_mean(weights, neighbours, v) - row), row);
}

void check(const Brush& brush, const Vec3& hit) {
  US_CHECK(brush.joint >= 0 && brush.joint < kJointCount, "the brush paints joint ", brush.joint, " of ",
           kJointCount);
  US_CHECK(brush.radius_m > 0 && std::isfinite(brush.radius_m), "the brush's radius must be positive, not ",
           brush.radius_m);
  US_CHECK(brush.strength >= 0 && brush.strength <= 1, "the brush's strength must be in 0..1, not ",
           brush.strength);
  US_CHECK(hit.allFinite(), "the brush hits a place that is not finite");
}

}  // namespace

float symmetry_centre(const Joints& rest) {
  float sum = 0;
  for (int j = 0; j < kJointCount; ++j) sum += rest(j, 0);
  return sum / kJointCount;  // of a pair: twice the middle between both
}

Rotations rest_rotations(const std::vector<BoneTurn>& turns) {
  Rotations local = identity_rotations();
  for (const BoneTurn& turn : turns) {
    US_CHECK(turn.joint >= 0 && turn.joint < kJointCount, "a turned bone has number ", turn.joint,
             ", there are ", kJointCount);
    US_CHECK(turn.axis_angle.allFinite(), "a bone of the rest pose is turned by an angle that is not finite");
    local[turn.joint] = local[turn.joint] * rotation_from_axis_angle(turn.axis_angle);
  }
  return local;
}

std::vector<BoneTurn> turned(const std::vector<BoneTurn>& turns, const BoneTurn& more, bool mirror) {
  std::vector<BoneTurn> all = turns;
  all.push_back(more);
  const int other = kMirror[more.joint];
  // Seen in a mirror along x an axis keeps its x and the angle its amount.
  if (mirror && other != more.joint)
    all.push_back({other, Vec3(more.axis_angle.x(), -more.axis_angle.y(), -more.axis_angle.z())});
  const Rotations local = rest_rotations(all);
  std::vector<BoneTurn> result;
  for (int j = 0; j < kJointCount; ++j)
    if (const Vec3 turn = rotation_to_axis_angle(local[j]); turn.norm() > 1e-6f) result.push_back({j, turn});
  return result;
}

Joints apply(const std::vector<JointMove>& moves, const Joints& rest) {
  const float centre = symmetry_centre(rest);
  Joints joints = rest;
  for (const JointMove& move : moves) {
    US_CHECK(move.joint >= 0 && move.joint < kJointCount, "joint ", move.joint, " of ", kJointCount,
             " cannot be moved");
    US_CHECK(move.position.allFinite(), kJointNames[move.joint], " is moved to a place that is not finite");
    joints.row(move.joint) = move.position.transpose();
    if (!move.mirror) continue;
    const int other = kMirror[move.joint];
    const float x = other == move.joint ? centre : 2 * centre - move.position.x();
    joints.row(other) << x, move.position.y(), move.position.z();
  }
  return joints;
}

void apply(const WeightRows& edit, RowMatrix& weights) {
  if (edit.empty()) return;
  US_CHECK(edit.rows.cols() == weights.cols() && edit.rows.rows() == ssize(edit.vertex),
           "painted weights of ", edit.rows.rows(), " x ", edit.rows.cols(), " do not fit ",
           edit.vertex.size(), " vertices and ", weights.cols(), " joints");
  US_CHECK(edit.of == 0 || edit.of == weights.rows(), "weights were painted on ", edit.of,
           " vertices, the target has ", weights.rows());
  for (const int v : edit.vertex)
    US_CHECK(v >= 0 && v < weights.rows(), "weights were painted at vertex ", v, " of a target with ",
             weights.rows());
  for (size_t i = 0; i < edit.vertex.size(); ++i) weights.row(edit.vertex[i]) = edit.rows.row(i);
}

WeightRows placed(WeightRows edit, const Points& vertices) {
  edit.places = vertices(edit.vertex, Eigen::all);
  edit.of = static_cast<int>(vertices.rows());
  return edit;
}

WeightRows reprojected(const WeightRows& edit, const Points& vertices) {
  US_CHECK(edit.places.rows() == edit.rows.rows(), "where the weights were painted is not known");
  US_CHECK(vertices.rows() > 0 && vertices.allFinite() && edit.places.allFinite(),
           "weights cannot be brought to a surface without finite vertices");
  const float cell = cell_size(vertices);
  const PointGrid grid(vertices, cell);
  RowsByVertex rows;
  for (Eigen::Index i = 0; i < edit.places.rows(); ++i) {
    const int nearest = grid.nearest(edit.places.row(i), cell);
    rows.try_emplace(nearest, Row::Zero()).first->second += edit.rows.row(i);
  }
  for (auto& [vertex, row] : rows) row = normalised(row, row);
  return placed(in_order(rows), vertices);
}

WeightRows merged(const WeightRows& older, const WeightRows& newer) {
  RowsByVertex rows;
  for (const WeightRows* from : {&newer, &older})  // of a vertex in both the first stays
    for (size_t i = 0; i < from->vertex.size(); ++i) rows.try_emplace(from->vertex[i], from->rows.row(i));
  return in_order(rows);
}

Neighbours Neighbours::from(const Mesh& mesh) {
  const int count = mesh.vertices.rows();
  US_CHECK(mesh.vertices.allFinite(), "a vertex of the target is not finite");
  Pairs pairs = mesh.is_cloud() ? nearest_pairs(mesh.vertices) : edges(mesh.faces, count);
  if (!mesh.is_cloud()) add_seams(mesh.vertices, pairs);
  for (size_t i = pairs.size(); i-- > 0;) pairs.emplace_back(pairs[i].second, pairs[i].first);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Neighbours result;
  result.start.assign(static_cast<size_t>(count) + 1, 0);
  result.index.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    ++result.start[a + 1];
    result.index.push_back(b);
  }
  for (size_t v = 1; v < result.start.size(); ++v) result.start[v] += result.start[v - 1];
  return result;
}

WeightRows stroke(const RowMatrix& weights, const PaintSurface& surface, const Vec3& hit,
                  const Brush& brush) {
  check_weights(weights, surface.vertices.rows());
  US_CHECK(surface.neighbours.vertices() == weights.rows(), "neighbours of ", surface.neighbours.vertices(),
           " vertices do not fit ", weights.rows());
  check(brush, hit);
  constexpr float kDetour = 1.3f;  // paths along edges are longer than straight ones
  RowsByVertex rows;
  if (weights.rows() == 0) return {};
  for (const auto& [v, path] : hanging_together(surface, hit, brush.radius_m, kDetour * brush.radius_m)) {
    const float straight = (surface.vertices.row(v).transpose() - hit).norm();
    const float x = std::min(std::max(straight, path / kDetour) / brush.radius_m, 1.0f);
    const float amount = brush.strength * (1 - x * x) * (1 - x * x);
    const Row row = painted(weights, surface.neighbours, v, brush, amount);
    if (row != weights.row(v)) rows.emplace(v, row);
  }
  return in_order(rows);
}

WeightRows smoothed(const RowMatrix& weights, const Neighbours& neighbours, const std::vector<int>& vertex,
                    float strength, int rounds) {
  check_weights(weights, neighbours.vertices());
  US_CHECK(strength >= 0 && strength <= 1, "smoothing must be in 0..1, not ", strength);
  std::vector<int> which = vertex;
  if (which.empty()) {
    which.resize(weights.rows());
    std::iota(which.begin(), which.end(), 0);
  }
  for (const int v : which) US_CHECK(v >= 0 && v < weights.rows(), "vertex ", v, " of ", weights.rows());
  RowMatrix now = weights, next = weights;
  for (int round = 0; round < rounds; ++round) {
    for (const int v : which) {
      const Row row = now.row(v);
      next.row(v) = normalised(row + strength * (neighbours_mean(now, neighbours, v) - row), row);
    }
    now = next;
  }
  RowsByVertex rows;
  for (const int v : which)
    if (now.row(v) != weights.row(v)) rows.emplace(v, now.row(v));
  return in_order(rows);
}

WeightRows mirrored_weights(const RowMatrix& weights, const Points& vertices, BodySide from, float centre) {
  check_weights(weights, vertices.rows());
  US_CHECK(vertices.allFinite() && std::isfinite(centre), "a vertex of the target is not finite");
  RowsByVertex rows;
  if (vertices.rows() == 0) return {};
  const Vec3 size = extent(vertices);
  const float middle = 1e-4f * size.norm(), cell = std::max(0.02f * size.norm(), 1e-6f);
  const float sign = from == BodySide::Left ? 1.0f : -1.0f;  // left is +x
  std::vector<int> sources;
  for (int v = 0; v < vertices.rows(); ++v)
    if (sign * (vertices(v, 0) - centre) > -middle) sources.push_back(v);
  if (sources.empty()) return {};
  const Points places = vertices(sources, Eigen::all);
  const PointGrid grid(places, cell);

  for (int v = 0; v < vertices.rows(); ++v) {
    const float side = sign * (vertices(v, 0) - centre);
    if (side > middle) continue;
    Row row;
    if (side >= -middle) {
      row = 0.5f * (weights.row(v) + mirrored(weights.row(v)));
    } else {
      const Vec3 image(2 * centre - vertices(v, 0), vertices(v, 1), vertices(v, 2));
      row = mirrored(weights.row(sources[grid.nearest(image, 0.25f * cell)]));
    }
    row = normalised(row, weights.row(v));
    if (row != weights.row(v)) rows.emplace(v, row);
  }
  return in_order(rows);
}

}  // namespace understudy
