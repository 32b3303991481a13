// Soft-edged strokes on pictures.
#pragma once

#include <vector>

#include "render/image.hpp"

namespace understudy::render {

/// A line with round ends, as wide as is said at each of them; pixels. A dot where both ends are one.
struct Stroke {
  Eigen::Vector2f a, b;
  float width_a = 1, width_b = 1;
};

/// Blends the strokes onto the image as one shape: where they overlap it is no denser. colour 0..1; what
/// falls outside is left out.
void paint(Image& image, const std::vector<Stroke>& strokes, const Vec3& color, float opacity = 1);

}  // namespace understudy::render
