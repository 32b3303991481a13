// One GL context for a test binary, and how alike two pictures are.
#pragma once

#include <algorithm>
#include <cstdlib>

#include "render/context/context.hpp"
#include "render/renderer.hpp"

namespace understudy::render {

/// Share of pixels that differ by more than 20 of 255 in some channel; 1 when the sizes differ. Drivers
/// differ by a few levels and at edges; a pass that is missing or lit from the wrong side differs by far
/// more.
inline double difference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) return 1;
  int different = 0;
  for (size_t i = 0; i < a.pixels.size(); i += 3) {
    int most = 0;
    const int alpha_a = a.alpha.empty() ? 255 : a.alpha[i / 3],
              alpha_b = b.alpha.empty() ? 255 : b.alpha[i / 3];
    most = std::abs(alpha_a - alpha_b);
    for (size_t c = i; c < i + 3; ++c)  // as seen over black: the colour of what is transparent is no matter
      most = std::max(most, std::abs(a.pixels[c] * alpha_a - b.pixels[c] * alpha_b) / 255);
    different += most > 20 ? 1 : 0;
  }
  return different / (static_cast<double>(a.width) * a.height);
}

/// Draws once with a context of its own whose complaints are fatal.
inline Image picture(const Scene& scene, const Camera& camera, PixelSize size = {160, 160},
                     ContextKind kind = ContextKind::Any, Quality quality = Quality::Best) {
  const auto context = make_offscreen_context({kind, gl::DebugMode::Fatal});
  Renderer renderer({4, quality});
  return renderer.render_image(scene, camera, size);
}

}  // namespace understudy::render
