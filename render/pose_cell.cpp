#include "render/pose_cell.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/change_points.hpp"

namespace understudy::render {
namespace {

constexpr float kMargin = 0.08f;     // of the longer side
constexpr float kStick = 1 / 50.0f;  // half a stick's width, of the cell's shorter side
constexpr int kBar = 5;              // pixels

/// From the poses' picture to the cell.
struct CellMap {
  float scale;
  Vec2 shift;

  Vec2 operator()(const Vec2& at) const { return scale * at + shift; }
  Vec2 back(const Vec2& at) const { return (at - shift) / scale; }
  FlatPose moved(FlatPose pose) const {
    change_points(pose, *this);
    return pose;
  }
};

void draw_behind(Image& image, const Image& picture, const CellMap& map) {
  constexpr int kDimmed = 45;  // per cent
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Vec2 at = map.back(Vec2(static_cast<float>(x), static_cast<float>(y)));
      const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
      if (u < 0 || v < 0 || u >= picture.width || v >= picture.height) continue;
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = static_cast<uint8_t>(picture.at(u, v)[c] * kDimmed / 100);
    }
}

/// Draws a pose in colours that `change` makes of OpenPose's.
template <class Change>
void draw_changed(Image& image, const FlatPose& pose, const PosePictureOptions& options,
                  const Change& change) {
  Image alone(image.width, image.height, Vec3::Zero());
  draw_pose(alone, pose, options);
  for (size_t i = 0; i + 2 < alone.pixels.size(); i += 3) {
    uint8_t* const pixel = alone.pixels.data() + i;
    if (pixel[0] + pixel[1] + pixel[2] == 0) continue;
    change(pixel);
    std::copy_n(pixel, 3, image.pixels.data() + i);
  }
}

void draw_people(Image& image, const PoseCell& cell, const CellMap& map, const PosePictureOptions& options) {
  for (const FlatPose& other : cell.others)
    draw_changed(image, map.moved(other), options, [](uint8_t* rgb) {
      for (int c = 0; c < 3; ++c) rgb[c] = static_cast<uint8_t>(rgb[c] * 3 / 10);
    });
  if (cell.truth) {
    PosePictureOptions wide = options;
    wide.half_width *= 1.9f;
    draw_changed(image, map.moved(*cell.truth), wide,
                 [](uint8_t* rgb) { std::fill_n(rgb, 3, uint8_t{120}); });
  }
  if (!cell.left) {
    if (cell.performer) draw_pose(image, map.moved(*cell.performer), options);
    return;
  }
  Image left = image;
  draw_pose(left, map.moved(*cell.left), options);
  if (cell.performer) draw_pose(image, map.moved(*cell.performer), options);
  const int middle = image.width / 2;
  for (int y = 0; y < image.height; ++y) {
    std::copy_n(left.at(0, y), 3 * static_cast<size_t>(middle), image.at(0, y));
    std::fill_n(image.at(middle, y), 3, uint8_t{255});
  }
}

}  // namespace

Image pose_cell(const PoseCell& cell, const FlatBox& view, int width, int height) {
  US_CHECK(!view.isEmpty() && view.sizes().minCoeff() > 0, "there is nobody to show in a cell");
  CellMap map{};
  map.scale = static_cast<float>(width) / view.sizes().x();
  map.shift = Vec2(static_cast<float>(width), static_cast<float>(height)) / 2 - map.scale * view.center();
  PosePictureOptions options;
  options.half_width = std::max(1.5f, kStick * static_cast<float>(std::min(width, height)));
  Image image(width, height, Vec3::Zero());
  if (cell.behind) draw_behind(image, *cell.behind, map);
  draw_people(image, cell, map, options);
  for (int y = std::max(0, height - kBar); cell.flagged && y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const uint8_t red[3] = {230, 60, 50};
      std::copy_n(red, 3, image.at(x, y));
    }
  return image;
}

FlatBox view_of(const std::vector<FlatPose>& poses) {
  FlatBox view;
  for (const FlatPose& pose : poses) view.extend(box_of(pose));
  if (view.isEmpty()) return view;
  const Vec2 margin = Vec2::Constant(std::max(kMargin * view.sizes().maxCoeff(), 1.0f));
  return {view.min() - margin, view.max() + margin};
}

}  // namespace understudy::render
