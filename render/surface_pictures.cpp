#include "render/surface_pictures.hpp"

#include <algorithm>
#include <cmath>

namespace understudy::render {
namespace {

constexpr float kFarthestGrey = 48;  // of 255: darker than any surface, nothing is

uint8_t rounded_byte(float value) {
  return static_cast<uint8_t>(std::lround(std::clamp(value, 0.f, 255.f)));
}

/// Black, with a colour wherever there is a surface.
template <class Paint>
Image picture_of_seen(const SurfaceView& seen, const Paint& paint) {
  Image image(seen.width, seen.height, Vec3::Zero());
  for (size_t at = 0; at < seen.face.size(); ++at) {
    if (seen.face[at] < 0) continue;
    const Vec3 rgb = paint(at);
    for (size_t k = 0; k < 3; ++k) image.pixels[3 * at + k] = rounded_byte(rgb[static_cast<int>(k)]);
  }
  return image;
}

}  // namespace

Image depth_picture(const SurfaceView& seen, const DepthRange& range) {
  const float span = std::max(range.far - range.near, 1e-6f);
  return picture_of_seen(seen, [&](size_t at) {
    const float share = std::clamp((range.far - seen.depth[at]) / span, 0.f, 1.f);
    return Vec3::Constant(kFarthestGrey + share * (255 - kFarthestGrey)).eval();
  });
}

Image normal_picture(const SurfaceView& seen, const Pinhole& camera, const Faces& faces,
                     const Points& normals) {
  return picture_of_seen(seen, [&](size_t at) {
    Vec3 normal = Vec3::Zero();  // in the world
    for (int k = 0; k < 3; ++k)
      normal += seen.shares[at][k] * normals.row(faces(seen.face[at], k)).transpose();
    const Vec3 seen_normal = camera.rotation.transpose() * normal.normalized();
    return Vec3(Vec3::Constant(127.5f) + 127.5f * seen_normal);
  });
}

Image mask_picture(const SurfaceView& seen) {
  return picture_of_seen(seen, [](size_t) { return Vec3::Constant(255).eval(); });
}

}  // namespace understudy::render
