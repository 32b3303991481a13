#include "retarget/geometry/ambient_occlusion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/math/directions.hpp"

namespace understudy {
namespace {

constexpr int kDirections = 96, kSide = 160;  // pixels of a depth map

/// What a light far away along a direction sees: for each pixel how far towards it the surface reaches.
class DepthMap {
 public:
  DepthMap() : nearest_(static_cast<size_t>(kSide) * kSide) {}

  /// Turns the surface towards the light and draws it.
  void draw(const Points& vertices, const Faces& faces, const Vec3& towards_light) {
    const Vec3 u = towards_light.unitOrthogonal(), v = towards_light.cross(u);
    Mat3 axes;
    axes << u, v, towards_light;
    seen_.noalias() = vertices * axes;  // [V, 3]: across, up, towards the light; metres
    const Eigen::RowVector3f low = seen_.colwise().minCoeff(), high = seen_.colwise().maxCoeff();
    pixel_ = std::max({high.x() - low.x(), high.y() - low.y(), 1e-6f}) / (kSide - 2);
    seen_.col(0) = (seen_.col(0).array() - low.x()) / pixel_ + 1;
    seen_.col(1) = (seen_.col(1).array() - low.y()) / pixel_ + 1;
    std::fill(nearest_.begin(), nearest_.end(), -std::numeric_limits<float>::infinity());
    for (Eigen::Index f = 0; f < faces.rows(); ++f) draw_triangle(faces.data() + 3 * f);
  }

  /// Whether vertex i, its normal at `cosine` to the light, is lit: nothing lies clearly before it. A slanted
  /// surface covers itself within a pixel, so it needs more room.
  bool lights(Eigen::Index i, float cosine) const {
    const float slack = pixel_ * (1.2f + 1.0f * std::sqrt(1 - cosine * cosine) / std::max(cosine, 0.15f));
    const int x = static_cast<int>(seen_(i, 0)), y = static_cast<int>(seen_(i, 1));
    return nearest_[static_cast<size_t>(y) * kSide + x] <= seen_(i, 2) + slack;
  }

 private:
  /// Pixels whose centre is inside; barycentric coordinates are linear in x and y.
  void draw_triangle(const int* corner) {
    const float* a = seen_.data() + 3 * corner[0];
    const float* b = seen_.data() + 3 * corner[1];
    const float* c = seen_.data() + 3 * corner[2];
    const float area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if (!(std::abs(area) > 1e-9f)) return;
    const int x0 = static_cast<int>(std::min({a[0], b[0], c[0]}) + 0.5f);
    const int x1 = static_cast<int>(std::max({a[0], b[0], c[0]}) + 0.5f);
    const int y0 = static_cast<int>(std::min({a[1], b[1], c[1]}) + 0.5f);
    const int y1 = static_cast<int>(std::max({a[1], b[1], c[1]}) + 0.5f);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const float px = static_cast<float>(x) + 0.5f - a[0], py = static_cast<float>(y) + 0.5f - a[1];
        const float s = (px * (c[1] - a[1]) - (c[0] - a[0]) * py) / area;  // towards b
        const float t = ((b[0] - a[0]) * py - px * (b[1] - a[1])) / area;  // towards c
        if (s < 0 || t < 0 || s + t > 1) continue;
        float& nearest = nearest_[static_cast<size_t>(y) * kSide + x];
        nearest = std::max(nearest, a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]));
      }
  }

  Points seen_;
  float pixel_ = 0;  ///< metres
  std::vector<float> nearest_;
};

/// Each value and its neighbours' mean, half and half: takes away what single pixels did.
Eigen::VectorXf smoothed(const Eigen::VectorXf& values, const Faces& faces) {
  Eigen::VectorXf sum = Eigen::VectorXf::Zero(values.size()), count = Eigen::VectorXf::Zero(values.size());
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int v = faces(f, k);
      sum[v] += values[faces(f, (k + 1) % 3)] + values[faces(f, (k + 2) % 3)];
      count[v] += 2;
    }
  return (count.array() > 0).select(0.5f * values + 0.5f * sum.cwiseQuotient(count.cwiseMax(1.f)), values);
}

}  // namespace

Eigen::VectorXf ambient_occlusion(const Points& vertices, const Faces& faces, const Points& normals) {
  US_CHECK(normals.rows() == vertices.rows(), normals.rows(), " normals for ", vertices.rows(), " vertices");
  if (faces.rows() == 0) return Eigen::VectorXf::Ones(vertices.rows());
  US_CHECK(faces.minCoeff() >= 0 && faces.maxCoeff() < vertices.rows(),
           "a face names a vertex that is not among the ", vertices.rows());
  US_CHECK(vertices.allFinite(), "a vertex of the mesh is not finite");
  Eigen::VectorXf light = Eigen::VectorXf::Zero(vertices.rows()), sky = light;
  DepthMap map;
  for (int i = 0; i < kDirections; ++i) {
    const Vec3 towards_light = spread_direction(i, kDirections);
    map.draw(vertices, faces, towards_light);
    const Eigen::VectorXf cosines = normals * towards_light;
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      if (!(cosines[v] > 0.02f)) continue;
      sky[v] += cosines[v];
      if (map.lights(v, std::min(cosines[v], 1.f))) light[v] += cosines[v];
    }
  }
  light = (sky.array() > 0).select(light.cwiseQuotient(sky.cwiseMax(1e-6f)), 1.f);
  return smoothed(smoothed(light, faces), faces);
}

}  // namespace understudy
