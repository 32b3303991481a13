// Colours that carry meaning. All sRGB, 0..1, and readable with any colour vision.
#pragma once

#include <array>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy::render {

/// A person's left, right and middle (blue, orange, dark grey; Okabe and Ito's safe pair).
extern const Vec3 kLeftColor, kRightColor, kMiddleColor;

/// Kelly's 22 colours of maximum contrast, ordered so that each differs most from those before it; his black
/// is a slate that shows on dark grounds.
extern const std::array<Vec3, 22> kCategories;

/// Viridis at t in 0..1 (clamped; NaN is grey, as in all scales).
Vec3 viridis(float t);
/// For errors: pale where there is none, through red and violet to near black; magma from its bright end.
Vec3 error_color(float t);
/// For signed values: blue, near white in the middle, orange brown.
Vec3 diverging_color(float t);
/// For moments: blue for the first, pale in the middle, red for the last.
Vec3 time_color(float t);

/// A colour for each value, `low` to `high` along one of the scales above, [N, 3].
Points colors_along(Vec3 (*scale)(float), const Eigen::VectorXf& values, float low, float high);

/// Skin weights as colours: each vertex the mix of its joints' category colours. weights [V, J] -> [V, 3].
Points weight_colors(const RowMatrix& weights);

}  // namespace understudy::render
