#include "render/ghost_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "render/colors.hpp"
#include "render/context/context.hpp"
#include "render/text.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::render {
namespace {

constexpr int kEdge = 26, kBetween = 6, kHead = 58, kCaption = 32, kScale = 54;  // pixels
constexpr float kSideways = -1.05f, kLens = 0.28f;                               // radians
const Vec3 kSheet(0.992f, 0.993f, 0.994f), kText(0.13f, 0.15f, 0.18f), kFaintText(0.46f, 0.49f, 0.53f);

/// Not the brightest end, which would be lost on the paper.
Vec3 time_color(double share) {
  return viridis(0.93f * static_cast<float>(share));
}

Scene scene_of(const GhostSeries& series, double longest) {
  Scene scene;
  for (size_t i = 0; i < series.ghosts.size(); ++i) {
    Mesh plain = series.ghosts[i];
    plain.colors.resize(0, 3);
    add(scene, plain);
    const Vec3 color = time_color(longest > 0 ? series.seconds[i] / longest : 0);
    if (plain.faces.rows() > 0)
      scene.meshes.back().color = color;
    else
      scene.clouds.back().color = color;
  }
  return scene;
}

Vec3 middle_of(const Points& points) {
  return ((points.colwise().minCoeff() + points.colwise().maxCoeff()) / 2).transpose();
}

/// What is seen of all cells, each about its own middle: for one distance and shape of all.
struct View {
  Camera camera;
  std::vector<Vec3> targets;
  float aspect = 1;
};

View view_of(const std::vector<Scene>& scenes, float heading) {
  View view;
  view.camera.yaw = heading + kSideways;
  view.camera.pitch = 0.2f;
  view.camera.fov = kLens;
  const Mat3 turn = axes(view.camera);
  Eigen::RowVector3f size(0.5f, 0.5f, 0.5f);
  for (const Scene& scene : scenes) {
    const Points points = all_points(scene);
    view.targets.push_back(middle_of(points));
    const Points seen = points * turn;
    size = size.cwiseMax(seen.colwise().maxCoeff() - seen.colwise().minCoeff());
  }
  view.aspect = std::clamp(1.05f * size.x() / size.y(), 0.6f, 2.2f);
  view.camera.distance = 0.5f;
  for (size_t i = 0; i < scenes.size(); ++i) {
    Camera camera = view.camera;
    camera.target = view.targets[i];
    view.camera.distance =
        std::max(view.camera.distance, fitting_distance(camera, all_points(scenes[i]), view.aspect, 0.03f));
  }
  return view;
}

/// From 0 s to the longest movement's end.
void draw_time_scale(Image& sheet, const Font& font, double longest) {
  const int left = kEdge, right = sheet.width - kEdge, top = sheet.height - kScale;
  const int bar = std::min(420, right - left);
  for (int x = 0; x < bar; ++x) {
    const Vec3 color = time_color(static_cast<double>(x) / (bar - 1));
    for (int y = 0; y < 12; ++y)
      for (int c = 0; c < 3; ++c)
        sheet.at(left + x, top + y)[c] = static_cast<uint8_t>(255 * color[c] + 0.5f);
  }
  const std::string end = printed("%.2f s", longest);
  const float base = static_cast<float>(top) + 30;
  font.draw(sheet, "0 s", {static_cast<float>(left), base}, 17, kFaintText);
  font.draw(sheet, end, {static_cast<float>(left + bar) - font.width(end, 17), base}, 17, kFaintText);
}

}  // namespace

Image ghost_sheet(Renderer& renderer, const std::vector<GhostSeries>& series,
                  const GhostSheetOptions& options) {
  US_CHECK(!series.empty(), "a sheet of ghosts needs a movement");
  double longest = 0;
  for (const GhostSeries& one : series) {
    US_CHECK(!one.ghosts.empty() && one.ghosts.size() == one.seconds.size(),
             "a movement on a sheet needs a ghost, and a time of each");
    longest = std::max(longest, one.seconds.back());
  }
  std::vector<Scene> scenes;
  scenes.reserve(series.size());
  for (const GhostSeries& one : series) scenes.push_back(scene_of(one, longest));
  const View view = view_of(scenes, options.heading);
  const int columns = std::clamp(static_cast<int>(ssize(series)), 1, std::max(1, options.columns));
  const int rows = (static_cast<int>(ssize(series)) + columns - 1) / columns;
  PixelSize cell{(options.width - 2 * kEdge - (columns - 1) * kBetween) / columns, 0};
  US_CHECK(cell.width >= 24, "a sheet of ", options.width, " pixels is too narrow for ", columns, " columns");
  cell.height = static_cast<int>(static_cast<float>(cell.width) / view.aspect);
  const int band = kCaption + cell.height + kBetween;
  Image sheet(options.width, kHead + rows * band + kScale, kSheet);
  const Font font = Font::system();
  font.draw(sheet, options.title, {static_cast<float>(kEdge), kEdge + 20}, 25, kText);
  for (size_t i = 0; i < series.size(); ++i) {
    const int x = kEdge + static_cast<int>(i) % columns * (cell.width + kBetween);
    const int y = kHead + static_cast<int>(i) / columns * band;
    font.draw(sheet, series[i].caption, {static_cast<float>(x + 2), static_cast<float>(y + kCaption - 10)},
              18, kText);
    Camera camera = view.camera;
    camera.target = view.targets[i];
    paste(sheet, renderer.render_image(scenes[i], camera, cell), x, y + kCaption);
  }
  draw_time_scale(sheet, font, longest);
  return sheet;
}

Image ghost_sheet(const std::vector<GhostSeries>& series, const GhostSheetOptions& options) {
  const auto context = make_offscreen_context();
  Renderer renderer;
  return ghost_sheet(renderer, series, options);
}

}  // namespace understudy::render
