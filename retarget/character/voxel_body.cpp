#include "retarget/character/voxel_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy {
namespace {

constexpr char kSurface = 1, kReached = 2, kEnclosed = 4;
constexpr int kBorder = 5;  // empty cubes about the body, more than a point of a cloud is wide
constexpr float kUnreached = std::numeric_limits<float>::max();

struct Step {
  int x, y, z;
  float length;  // in cubes
};

const std::array<Step, 26>& steps() {
  static const std::array<Step, 26> all = [] {
    std::array<Step, 26> out{};
    size_t n = 0;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (x != 0 || y != 0 || z != 0)
            out[n++] = {x, y, z, std::sqrt(static_cast<float>(x * x + y * y + z * z))};
    return out;
  }();
  return all;
}

/// The shortest paths found so far, by cube of the grid. What is to be followed further waits in buckets by
/// length, a cube wide each: no path within one is shorter than a step.
class Paths {
 public:
  Paths(const std::vector<int>& cell_of, float size) : size_(size), length_(cell_of.size()) {
    std::transform(cell_of.begin(), cell_of.end(), length_.begin(),
                   [](int cell) { return cell < 0 ? kOutside : kUnreached; });
    followed_ = length_;
  }
  float length(int at) const { return length_[at]; }
  void reach(int at, float length) {
    if (length >= length_[at]) return;
    length_[at] = length;
    const size_t bucket = length / size_;
    if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
    buckets_[bucket].push_back(at);
  }
  /// onward(cube, its path's length) reaches what is beside it; the shortest come first.
  template <class Onward>
  void follow(Onward onward) {
    for (size_t b = 0; b < buckets_.size(); ++b)
      for (size_t i = 0; i < buckets_[b].size(); ++i) {
        const int at = buckets_[b][i];
        if (length_[at] == followed_[at])
          continue;  // it was reached twice, the shorter way has been followed
        followed_[at] = length_[at];
        onward(at, length_[at]);
      }
  }

 private:
  static constexpr float kOutside = -1;  // shorter than any path: nothing leads there
  float size_;
  std::vector<float> length_, followed_;
  std::vector<std::vector<int>> buckets_;
};

/// How far apart a cloud's points lie: the median distance of some of them to their third neighbour.
float spacing_of(const Points& points) {
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.rows() / 500);
  Points some((points.rows() + stride - 1) / stride, 3);
  for (Eigen::Index i = 0; i < some.rows(); ++i) some.row(i) = points.row(i * stride);
  const int k = std::min<Eigen::Index>(4, points.rows());
  const auto near = nearest_neighbours(points, some, k);
  std::vector<float> gaps;
  for (Eigen::Index i = 0; i < some.rows(); ++i)
    gaps.push_back((points.row(near(i, k - 1)) - some.row(i)).norm());
  std::nth_element(gaps.begin(), gaps.begin() + static_cast<long>(gaps.size() / 2), gaps.end());
  return gaps[gaps.size() / 2];
}

}  // namespace

VoxelBody::VoxelBody(const Mesh& mesh, int resolution) {
  lay_grid(mesh.vertices, resolution);
  std::vector<char> state(
      static_cast<size_t>(dims_[0]) * static_cast<size_t>(dims_[1]) * static_cast<size_t>(dims_[2]), 0);
  mark_surface(mesh, state);
  mark_reached(state);
  mark_enclosed(state);
  number_cells(state);
  join_parts();
}

void VoxelBody::lay_grid(const Points& vertices, int resolution) {
  Vec3 low = Vec3::Constant(kUnreached), high = Vec3::Constant(-kUnreached);
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    if (!vertices.row(v).allFinite()) continue;
    low = low.cwiseMin(vertices.row(v).transpose());
    high = high.cwiseMax(vertices.row(v).transpose());
  }
  US_CHECK(low.x() <= high.x(), "a body without a vertex has no inside");
  size_ = std::max(1e-6f, (high - low).maxCoeff() / static_cast<float>(std::max(8, resolution)));
  origin_ = low.array() - static_cast<float>(kBorder) * size_;
  for (int a = 0; a < 3; ++a)
    dims_[a] = static_cast<int>(std::floor((high[a] - low[a]) / size_)) + 1 + 2 * kBorder;
}

std::array<int, 3> VoxelBody::place(const Vec3& point) const {
  std::array<int, 3> at{};
  for (int a = 0; a < 3; ++a) {
    const float along = (point[a] - origin_[a]) / size_;
    at[a] = static_cast<int>(std::clamp(along, 0.0f, static_cast<float>(dims_[a] - 1)));
  }
  return at;
}

void VoxelBody::mark_surface(const Mesh& mesh, std::vector<char>& state) const {
  const auto mark = [&](const Vec3& p, int reach) {
    const auto at = place(p);
    for (int z = std::max(0, at[2] - reach); z <= std::min(dims_[2] - 1, at[2] + reach); ++z)
      for (int y = std::max(0, at[1] - reach); y <= std::min(dims_[1] - 1, at[1] + reach); ++y)
        for (int x = std::max(0, at[0] - reach); x <= std::min(dims_[0] - 1, at[0] + reach); ++x)
          state[grid_index(x, y, z)] = kSurface;
  };
  const bool cloud = mesh.is_cloud();
  const int reach =
      !cloud ? 0 : std::min(3, static_cast<int>(std::ceil(0.5f * spacing_of(mesh.vertices) / size_)));
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v)
    if (mesh.vertices.row(v).allFinite()) mark(mesh.vertices.row(v).transpose(), reach);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const Vec3 a = mesh.vertices.row(mesh.faces(f, 0)).transpose();
    const Vec3 u = mesh.vertices.row(mesh.faces(f, 1)).transpose() - a;
    const Vec3 w = mesh.vertices.row(mesh.faces(f, 2)).transpose() - a;
    const float longest = std::sqrt(std::max({u.squaredNorm(), w.squaredNorm(), (u - w).squaredNorm()}));
    if (!std::isfinite(longest)) continue;
    const int n = std::min(1024, static_cast<int>(std::ceil(longest / (0.5f * size_))));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        mark(a + (static_cast<float>(i) * u + static_cast<float>(j) * w) / static_cast<float>(std::max(1, n)),
             0);
  }
}

/// Floods from a corner: what it does not reach is enclosed.
void VoxelBody::mark_reached(std::vector<char>& state) const {
  std::vector<int> open = {0};
  state[0] |= kReached;
  const int row = dims_[0], layer = dims_[0] * dims_[1];
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    for (const int d : {-1, 1, -row, row, -layer, layer}) {
      const int next = at + d;  // past an end of a row another row begins, in the empty border too
      if (next < 0 || next >= ssize(state) || state[next] != 0) continue;
      state[next] = kReached;
      open.push_back(next);
    }
  }
}

/// Counts for each cube in how many of the six directions there is surface.
void VoxelBody::mark_enclosed(std::vector<char>& state) const {
  std::vector<char> seen(state.size(), 0);
  const std::array<int, 3> stride = {1, dims_[0], dims_[0] * dims_[1]};
  for (size_t a = 0; a < 3; ++a) {
    const size_t b = (a + 1) % 3, c = (a + 2) % 3;
    for (int j = 0; j < dims_[b]; ++j)
      for (int k = 0; k < dims_[c]; ++k) {
        const int start = j * stride[b] + k * stride[c];
        for (const bool back : {false, true}) {
          char hit = 0;
          for (int i = 0; i < dims_[a]; ++i) {
            const size_t at = start + (back ? dims_[a] - 1 - i : i) * stride[a];
            seen[at] = static_cast<char>(seen[at] + hit);
            if ((state[at] & kSurface) != 0) hit = 1;
          }
        }
      }
  }
  for (size_t i = 0; i < state.size(); ++i)
    if (state[i] == 0 || ((state[i] & kReached) != 0 && seen[i] >= 5)) state[i] |= kEnclosed;
}

void VoxelBody::number_cells(const std::vector<char>& state) {
  cell_of_.assign(state.size(), -1);
  for (size_t i = 0; i < state.size(); ++i) {
    if ((state[i] & (kSurface | kEnclosed)) == 0) continue;
    cell_of_[i] = cells_.size();
    cells_.push_back(i);
  }
}

Vec3 VoxelBody::centre(int cell) const {
  return origin_ + size_ * (grid_place(cells_[cell]).cast<float>().array() + 0.5f).matrix();
}

int VoxelBody::cell_at(const Vec3& point) const {
  if (((point - origin_).array() < 0).any()) return -1;
  for (int a = 0; a < 3; ++a)
    if (point[a] - origin_[a] >= size_ * static_cast<float>(dims_[a])) return -1;
  const auto at = place(point);
  return cell_of_[grid_index(at[0], at[1], at[2])];
}

int VoxelBody::nearest_cell(const Vec3& point) const {
  int best = 0;
  float least = kUnreached;
  for (int c = 0; c < count(); ++c) {
    const float d = (centre(c) - point).squaredNorm();
    if (d < least) {
      least = d;
      best = c;
    }
  }
  return best;
}

/// Of each cube the number of its part; cubes that touch, be it at a corner, are one part.
std::vector<int> VoxelBody::label_parts() const {
  std::vector<int> part(cells_.size(), -1), open;
  int parts = 0;
  for (size_t first = 0; first < cells_.size(); ++first) {
    if (part[first] >= 0) continue;
    part[first] = parts;
    open = {static_cast<int>(first)};
    while (!open.empty()) {
      const int at = cells_[open.back()];
      open.pop_back();
      for (const Step& s : steps()) {
        const int next = cell_of_[at + grid_index(s.x, s.y, s.z)];
        if (next < 0 || part[next] >= 0) continue;
        part[next] = parts;
        open.push_back(next);
      }
    }
    ++parts;
  }
  return part;
}

/// Grows all parts at once through the empty cubes; where two meet there is a bridge. Of two neighbours all
/// bridges stay that are not much longer than their shortest: parts that face each other touch as a whole.
void VoxelBody::join_parts() {
  const std::vector<int> part = label_parts();
  if (part.empty() || *std::max_element(part.begin(), part.end()) == 0) return;
  std::vector<int> source(cell_of_.size(), -1);
  std::queue<int> open;
  for (size_t c = 0; c < cells_.size(); ++c) {
    source[cells_[c]] = c;
    open.push(cells_[c]);
  }
  std::map<std::pair<int, int>, std::vector<Bridge>> meetings;
  while (!open.empty()) {
    const int at = open.front();
    open.pop();
    const int own = source[at];
    for (const Step& s : steps()) {
      if (std::abs(s.x) + std::abs(s.y) + std::abs(s.z) != 1) continue;
      const Eigen::Array3i p = grid_place(at) + Eigen::Vector3i(s.x, s.y, s.z);
      if ((p < 0).any() || (p >= Eigen::Map<const Eigen::Array3i>(dims_.data())).any()) continue;
      const size_t next = at + grid_index(s.x, s.y, s.z);
      const int other = source[next];
      if (other < 0) {
        source[next] = own;
        open.push(next);
      } else if (part[other] > part[own]) {
        meetings[{part[own], part[other]}].push_back({own, other, (centre(own) - centre(other)).norm()});
      }
    }
  }
  bridges_.assign(cells_.size(), {});
  for (auto& [pair, found] : meetings) {
    float least = kUnreached;
    for (const Bridge& b : found) least = std::min(least, b.length);
    for (const Bridge& b : found) {
      if (b.length > least + 1.5f * size_) continue;
      bridges_[b.a].push_back(b);
      bridges_[b.b].push_back({b.b, b.a, b.length});
    }
  }
}

std::vector<float> VoxelBody::distances_from(const std::vector<std::pair<Vec3, Vec3>>& segments) const {
  Paths paths(cell_of_, size_);
  for (const auto& [from, to] : segments) {
    const int n = 1 + static_cast<int>((to - from).norm() / (0.5f * size_));
    bool inside = false;
    for (int i = 0; i <= n; ++i) {
      const Vec3 p = from + static_cast<float>(i) / static_cast<float>(n) * (to - from);
      const int cell = cell_at(p);
      if (cell >= 0) paths.reach(cells_[cell], 0);
      inside = inside || cell >= 0;
    }
    if (!inside)
      for (const float t : {0.2f, 0.5f, 0.8f}) paths.reach(cells_[nearest_cell(from + t * (to - from))], 0);
  }
  std::array<std::pair<int, float>, 26> ways;  // to the neighbours: in the grid, in metres
  std::transform(steps().begin(), steps().end(), ways.begin(),
                 [this](const Step& s) { return std::pair(grid_index(s.x, s.y, s.z), s.length * size_); });
  paths.follow([&](int at, float here) {
    for (const auto& [offset, length] : ways) paths.reach(at + offset, here + length);
    if (bridges_.empty()) return;
    for (const Bridge& bridge : bridges_[cell_of_[at]])
      paths.reach(cells_[bridge.b], here + std::max(bridge.length, size_));
  });
  std::vector<float> lengths(cells_.size());
  for (size_t c = 0; c < cells_.size(); ++c) lengths[c] = paths.length(cells_[c]);
  return lengths;
}

float VoxelBody::at(const std::vector<float>& distances, const Vec3& point) const {
  const auto low = place(point - Vec3::Constant(0.5f * size_));
  float sum = 0, total = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = std::min(dims_[0] - 1, low[0] + (corner & 1)),
              y = std::min(dims_[1] - 1, low[1] + (corner >> 1 & 1)),
              z = std::min(dims_[2] - 1, low[2] + (corner >> 2));
    const int cell = cell_of_[grid_index(x, y, z)];
    if (cell < 0 || distances[cell] == kUnreached) continue;
    const Vec3 off = (centre(cell) - point).cwiseAbs() / size_;
    const float weight = std::max(1e-4f, (1 - off.x()) * (1 - off.y()) * (1 - off.z()));
    sum += weight * distances[cell];
    total += weight;
  }
  return total > 0 ? sum / total : distances[nearest_cell(point)];
}

}  // namespace understudy
