// Curves over frames: what a change at one frame leaves to those around it, and smoothing both ways.
#pragma once

#include <algorithm>
#include <vector>

#include "retarget/math/types.hpp"

namespace understudy {

/// How much of an edit of frame `edited` there is at another frame: 1 there, then half a cosine down to 0 at
/// falloff + 1 frames away.
float falloff_weight(int frame, int edited, int falloff);

/// Standard deviation of the Gaussian that smooths most.
constexpr float kSmoothestSeconds = 0.2f;
/// Half a Gaussian: weights at 0, 1, 2 ... frames away, up to three standard deviations. strength: 0 nothing
/// .. 1 kSmoothestSeconds. Empty where it would change nothing. Throws Error for a strength outside 0..1.
std::vector<float> half_gaussian(float strength, float fps);

/// Mean over the window at each frame; the window shrinks on both sides alike towards the ends, so that what
/// moves evenly keeps moving so, and the first and the last stay. T: with + and *.
template <class T>
std::vector<T> filtered(const std::vector<T>& in, const std::vector<float>& half) {
  const int count = static_cast<int>(in.size()), reach = static_cast<int>(half.size()) - 1;
  std::vector<T> out = in;
  for (int t = 0; t < count; ++t) {
    const int r = std::min({reach, t, count - 1 - t});
    if (r <= 0) continue;
    T sum = half[0] * in[t];
    float total = half[0];
    for (int k = 1; k <= r; ++k) {
      sum += half[k] * (in[t - k] + in[t + k]);
      total += 2 * half[k];
    }
    out[t] = sum / total;
  }
  return out;
}
/// The same of rotations, as quaternions. Those without a mean stay.
std::vector<Mat3> filtered_rotations(const std::vector<Mat3>& in, const std::vector<float>& half);

}  // namespace understudy
