#include "render/floor_shadow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "retarget/base/index.hpp"

namespace understudy::render {
namespace {

constexpr int kSide = FloorShadow::kSide;
constexpr float kFreeFloor = 0.45f;                               // metres of free floor around what casts it
using Grid = Eigen::Array<float, kSide, kSide, Eigen::RowMajor>;  // rows along z

/// The height of the lowest thing above each cell.
class LowestHeights {
 public:
  LowestHeights(const Vec3& area, float floor)
      : x_(area.x()), z_(area.y()), cells_(kSide / area.z()), floor_(floor) {
    heights_.setConstant(std::numeric_limits<float>::infinity());
  }

  void add(const float* at) {
    const float x = (at[0] - x_) * cells_, z = (at[2] - z_) * cells_;
    if (!(x >= 0 && z >= 0 && x < kSide && z < kSide)) return;  // nor NaN
    float& height = heights_(static_cast<int>(z), static_cast<int>(x));
    height = std::min(height, std::max(0.f, at[1] - floor_));
  }
  void add(const Points& points) {
    for (Eigen::Index i = 0; i < points.rows(); ++i) add(points.data() + 3 * i);
  }
  void add_line(const Vec3& a, const Vec3& b) {
    const float length = (b - a).norm() * cells_;
    if (!std::isfinite(length)) return;
    const int steps = static_cast<int>(std::min(length, 4.f * kSide));
    for (int i = 0; i <= steps; ++i) {
      const Vec3 at = a + (b - a) * (static_cast<float>(i) / static_cast<float>(std::max(1, steps)));
      add(at.data());
    }
  }
  /// Places on the triangles larger than two cells; of smaller ones the corners do, as the blur closes the
  /// gaps.
  void add_large(const Points& vertices, const Faces& faces) {
    for (const int *f = faces.data(), *end = f + faces.size(); f != end; f += 3) {
      const float *a = vertices.data() + 3 * f[0], *b = vertices.data() + 3 * f[1],
                  *c = vertices.data() + 3 * f[2];
      const float longest = cells_ * std::max({std::abs(b[0] - a[0]), std::abs(b[2] - a[2]),
                                               std::abs(c[0] - a[0]), std::abs(c[2] - a[2])});
      if (!(longest > 2 && longest < 1e4f)) continue;
      const Vec3 A(a[0], a[1], a[2]), B(b[0], b[1], b[2]), C(c[0], c[1], c[2]);
      const int steps = std::min(2 * kSide, static_cast<int>(longest) + 1);
      for (int i = 0; i <= steps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps);
        add_line(A + t * (B - A), A + t * (C - A));
      }
    }
  }
  const Grid& heights() const { return heights_; }

 private:
  float x_, z_, cells_, floor_;
  Grid heights_;
};

/// The floor below the points: corner x, z and side of a square around them, with a margin.
Vec3 area_below(const Points& points) {
  if (points.rows() == 0) return Vec3(-1, -1, 2);
  const Eigen::RowVector3f low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const float side = std::max(high.x() - low.x(), high.z() - low.z()) + 2 * kFreeFloor;
  return Vec3((low.x() + high.x() - side) / 2, (low.z() + high.z() - side) / 2, side);
}

constexpr int kMost = 24;  // cells a blur can reach

/// The right half of a bell of `sigma` cells, its middle first, weighing 1 with its left half.
std::vector<float> half_bell(float sigma) {
  const int reach = std::clamp(static_cast<int>(std::ceil(2.5f * sigma)), 1, kMost);
  std::vector<float> bell;
  float sum = 0;
  for (int i = 0; i <= reach; ++i) {
    bell.push_back(std::exp(-0.5f * static_cast<float>(i * i) / std::max(1e-6f, sigma * sigma)));
    sum += (i == 0 ? 1.f : 2.f) * bell.back();
  }
  for (float& weight : bell) weight /= sum;
  return bell;
}

/// Each row blurred; beyond the edges it is light. Returned with rows and columns exchanged, so that twice is
/// both ways.
Grid blurred_once(const Grid& sharp, const std::vector<float>& bell) {
  Grid result;
  std::array<float, kSide + 2 * kMost> row{};
  for (int y = 0; y < kSide; ++y) {
    std::copy_n(sharp.data() + y * kSide, kSide, row.data() + kMost);
    std::array<float, kSide> sum;
    for (int x = 0; x < kSide; ++x) sum[x] = bell[0] * row[kMost + x];
    for (int i = 1; i < ssize(bell); ++i)
      for (int x = 0; x < kSide; ++x) sum[x] += bell[i] * (row[kMost + x - i] + row[kMost + x + i]);
    for (int x = 0; x < kSide; ++x) result(x, y) = sum[x];
  }
  return result;
}

Grid blurred(const Grid& sharp, float sigma) {
  const std::vector<float> bell = half_bell(sigma);
  return blurred_once(blurred_once(sharp, bell), bell);
}

void add_casters(LowestHeights& heights, const Scene& scene) {
  for (const auto& mesh : scene.meshes) {
    heights.add(mesh.vertices);
    heights.add_large(mesh.vertices, mesh.faces);
  }
  for (const auto& cloud : scene.clouds) heights.add(cloud.positions);
  for (const auto& skeleton : scene.skeletons)
    for (int j = 0; j < ssize(skeleton.parents) && j < skeleton.joints.rows(); ++j)
      if (const int parent = skeleton.parents[j]; parent >= 0 && parent < skeleton.joints.rows())
        heights.add_line(skeleton.joints.row(j), skeleton.joints.row(parent));
}

}  // namespace

FloorShadow floor_shadow(const Scene& scene) {
  FloorShadow shadow;
  shadow.area = area_below(all_points(scene));
  LowestHeights heights(shadow.area, scene.ground.height);
  add_casters(heights, scene);
  // What is within a hand of the floor makes the contact; all of the body the rest, fading with height.
  const float cells = kSide / shadow.area.z();
  // Never below exp(-60): the blur would crawl through denormal numbers.
  const Grid contact = blurred((-heights.heights() / 0.07f).max(-60.f).exp(), 0.033f * cells);
  const Grid body = blurred(0.75f * (-heights.heights() / 0.9f).max(-60.f).exp(), 0.08f * cells);
  const Grid dark = 1 - (1 - 0.75f * contact) * (1 - 0.75f * body);
  for (int i = 0; i < kSide * kSide; ++i)
    shadow.dark[i] = static_cast<uint8_t>(std::clamp(255 * dark.data()[i] + 0.5f, 0.f, 255.f));
  return shadow;
}

}  // namespace understudy::render
