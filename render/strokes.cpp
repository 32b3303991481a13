#include "render/strokes.hpp"

#include <algorithm>
#include <cmath>

namespace understudy::render {
namespace {

using Eigen::Vector2f;

/// Whole pixels, both corners inside.
struct PixelBox {
  int left, top, right, bottom;
  static PixelBox around(const Stroke& s, const Image& image) {
    const float air = 0.5f * std::max(s.width_a, s.width_b) + 1;
    const Vector2f low = s.a.cwiseMin(s.b).array() - air, high = s.a.cwiseMax(s.b).array() + air;
    const auto whole = [](float value, int most) {
      return static_cast<int>(std::clamp(std::floor(value), 0.0f, static_cast<float>(most)));
    };
    PixelBox box{whole(low.x(), image.width), whole(low.y(), image.height), whole(high.x(), image.width - 1),
                 whole(high.y(), image.height - 1)};
    if (high.x() < 0 || high.y() < 0) box.right = box.left - 1;
    return box;
  }
};

/// How much of a pixel the stroke covers, 0..1.
float cover(const Stroke& s, const Vector2f& at) {
  const Vector2f along = s.b - s.a;
  const float t = std::clamp((at - s.a).dot(along) / std::max(along.squaredNorm(), 1e-12f), 0.f, 1.f);
  const float width = s.width_a + t * (s.width_b - s.width_a);
  return std::clamp(0.5f * width + 0.5f - (at - s.a - t * along).norm(), 0.f, 1.f);
}

}  // namespace

void paint(Image& image, const std::vector<Stroke>& strokes, const Vec3& color, float opacity) {
  PixelBox all{image.width, image.height, -1, -1};
  std::vector<PixelBox> boxes;
  for (const Stroke& stroke : strokes) {
    if (!stroke.a.allFinite() || !stroke.b.allFinite()) {
      boxes.push_back({0, 0, -1, -1});
      continue;
    }
    const PixelBox box = boxes.emplace_back(PixelBox::around(stroke, image));
    all = {std::min(all.left, box.left), std::min(all.top, box.top), std::max(all.right, box.right),
           std::max(all.bottom, box.bottom)};
  }
  for (int y = all.top; y <= all.bottom; ++y)
    for (int x = all.left; x <= all.right; ++x) {
      const Vector2f at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      float most = 0;
      for (size_t i = 0; i < strokes.size() && most < 1; ++i)
        if (x >= boxes[i].left && x <= boxes[i].right && y >= boxes[i].top && y <= boxes[i].bottom)
          most = std::max(most, cover(strokes[i], at));
      if (most <= 0) continue;
      most *= opacity;
      uint8_t* pixel = image.at(x, y);
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<uint8_t>(std::lround((1 - most) * pixel[c] + most * 255 * color[c]));
    }
}

}  // namespace understudy::render
