// Colours that carry meaning. All sRGB, 0..1, and readable with any colour vision.
#pragma once

#include <array>

#include "retarget/math/types.hpp"

namespace understudy::render {

/// A person's left, right and middle (blue, orange, dark grey; Okabe and Ito's safe pair).
extern const Vec3 kLeftColor, kRightColor, kMiddleColor;

/// Kelly's 22 colours of maximum contrast, ordered so that each differs most from those before it.
extern const std::array<Vec3, 22> kCategories;

/// Viridis at t in 0..1 (clamped).
Vec3 viridis(float t);

/// A colour for each value, `low` to `high` along viridis, [N, 3].
Points viridis_colors(const Eigen::VectorXf& values, float low, float high);

/// Skin weights as colours: each vertex the mix of its joints' category colours. weights [V, J] -> [V, 3].
Points weight_colors(const RowMatrix& weights);

}  // namespace understudy::render
