#include "app/cli/worst_frames.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/run/case_source.hpp"
#include "render/context/context.hpp"
#include "render/renderer.hpp"
#include "render/text.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr int kWidth = 260, kHeight = 380, kCaption = 44, kColumns = 5;

Mesh scan_of(const WorstFrame& worst) {
  const auto source = open_source(case_source(read_case(worst.case_folder)));
  source->seek(worst.frame);
  const auto frame = source->next();
  return frame ? frame->mesh : Mesh{};
}

render::Scene scene_of(const WorstFrame& worst) {
  render::Scene scene;
  render::add(scene, scan_of(worst));
  scene.skeletons.push_back(render::skeleton_view(worst.seen));
  scene.skeletons.push_back(render::skeleton_view(worst.truth));
  scene.skeletons.back().tint = Vec3(0.1f, 0.6f, 0.2f);
  scene.skeletons.back().tint_share = 0.9f;
  scene.skeletons.back().thickness = 0.6f;
  return scene;
}

/// The frame from the true front and from the side, with what it is.
render::Image picture_of(render::Renderer& renderer, const render::Font& font, const WorstFrame& worst) {
  const render::Scene scene = scene_of(worst);
  const Vec3 left = worst.truth.row(LeftHip) - worst.truth.row(RightHip);
  render::Image picture(2 * kWidth, kHeight + kCaption);
  for (int side = 0; side < 2; ++side) {
    render::Camera camera;
    camera.yaw = std::atan2(-left.z(), left.x()) - static_cast<float>(side) * kPi / 2;
    Points both(2 * kJointCount, 3);
    both << worst.seen, worst.truth;
    const render::PixelSize size{kWidth, kHeight};
    camera = render::fitted(camera, both, size.aspect(), 0.12f);
    render::paste(picture, renderer.render_image(scene, camera, size), side * kWidth, kCaption);
  }
  const std::string line =
      printed(", frame %lld: %.0f mm", static_cast<long long>(worst.frame), 1000 * worst.error_m);
  std::string failures;
  for (int f = 0; f < kFailureCount; ++f)
    if (worst.failures[f]) append_item(failures, kFailureNames[f]);
  const Vec3 ink(0.13f, 0.15f, 0.18f);
  font.draw(picture, worst.case_name + line, {8, 18}, 15, ink);
  font.draw(picture, failures, {8, 37}, 14, ink);
  return picture;
}

}  // namespace

void write_worst_frames(const std::string& folder, const std::vector<WorstFrame>& frames) {
  if (frames.empty()) return;
  std::filesystem::create_directories(folder);
  const auto context = render::make_offscreen_context();
  render::Renderer renderer;
  const render::Font font = render::Font::system();
  const int count = frames.size(), columns = std::min(kColumns, count);
  render::Image sheet(columns * 2 * kWidth, (count + columns - 1) / columns * (kHeight + kCaption));
  for (int i = 0; i < count; ++i) {
    const render::Image picture = picture_of(renderer, font, frames[i]);
    render::write_png(folder + printed("/worst_%02d.png", i + 1), picture);
    render::paste(sheet, picture, i % columns * picture.width, i / columns * picture.height);
  }
  render::write_png(folder + "/worst.png", sheet);
  log::info("wrote " + folder + "/worst.png");
}

}  // namespace understudy::app
