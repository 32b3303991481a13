#include "retarget/geometry/surface_view.hpp"

#include <algorithm>
#include <cmath>

namespace understudy {
namespace {

constexpr float kNearest = 0.01f;  // metres before the eye

/// One face drawn into what is seen so far. corners: x, y, depth of each as columns.
void draw_face(const Pinhole& camera, const Mat3& corners, int face, SurfaceView& seen) {
  const Vec3 x = corners.row(0), y = corners.row(1), z = corners.row(2);
  const float area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (!(std::abs(area) > 0)) return;
  const int left = static_cast<int>(std::ceil(std::clamp(x.minCoeff(), 0.f, 1e6f)));
  const int top = static_cast<int>(std::ceil(std::clamp(y.minCoeff(), 0.f, 1e6f)));
  const int right = static_cast<int>(std::floor(std::clamp(x.maxCoeff(), -1.f, seen.width - 1.f)));
  const int bottom = static_cast<int>(std::floor(std::clamp(y.maxCoeff(), -1.f, seen.height - 1.f)));
  for (int py = top; py <= bottom; ++py)
    for (int px = left; px <= right; ++px) {
      const float fx = static_cast<float>(px), fy = static_cast<float>(py);
      Vec3 in_picture;  // barycentric
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        in_picture[k] = ((x[a] - fx) * (y[b] - fy) - (x[b] - fx) * (y[a] - fy)) / area;
      }
      if (in_picture.minCoeff() < 0) continue;
      // in perspective 1 / depth is linear in the picture
      const Vec3 nearness = camera.orthographic ? in_picture : Vec3(in_picture.cwiseQuotient(z));
      const float depth = camera.orthographic ? in_picture.dot(z) : 1 / nearness.sum();
      const size_t at = seen.at(px, py);
      if (!(depth < seen.depth[at])) continue;
      seen.depth[at] = depth;
      seen.face[at] = face;
      seen.shares[at] = nearness / nearness.sum();
    }
}

}  // namespace

SurfaceView surface_view(const Pinhole& camera, int width, int height, const Points& vertices,
                         const Faces& faces) {
  SurfaceView seen;
  seen.width = width, seen.height = height;
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  seen.depth.assign(pixels, SurfaceView::kNothing);
  seen.face.assign(pixels, -1);
  seen.shares.assign(pixels, Vec3::Zero());
  const Points places = camera.project(vertices);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    Mat3 corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = places.row(faces(f, k)).transpose();
    const bool is_before = camera.orthographic || corners.row(2).minCoeff() > kNearest;
    if (corners.allFinite() && is_before) draw_face(camera, corners, static_cast<int>(f), seen);
  }
  return seen;
}

}  // namespace understudy
