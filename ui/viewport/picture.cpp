#include "ui/viewport/picture.hpp"

#include <algorithm>
#include <cmath>

#include "render/text.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "ui/gui/theme.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/flat_canvas.hpp"
#include "ui/viewport/pane.hpp"

namespace understudy::ui {
namespace {

using app::Session;
using render::Image;

constexpr int kRounds = 4;  // of asking and waiting: what is asked for last may push out what came first

PanePictures awaited(const Session& session, app::FrameCache& cache, const PaneContent& pane) {
  PanePictures got;
  for (int round = 0; round < kRounds; ++round) {
    auto pictures = pictures_of(session, cache, pane, pane_frame(session, pane));
    if (pictures) got = std::move(*pictures);
    if (pictures && ghosts_ready(session, pane, got)) break;
    cache.wait();
  }
  prefetch(session, cache, pane);  // of a video, while this frame is drawn
  return got;
}

std::shared_ptr<const app::PosedPicture> awaited_rest(const Session& session, app::FrameCache& cache,
                                                      const PaneContent& pane, const TargetLook& look) {
  if (auto rest = rest_picture(session, cache, pane, look)) return rest;
  cache.wait();
  return rest_picture(session, cache, pane, look);
}

Vec3 ink_on(const PictureOptions& options, bool dark) {
  return dark && !options.transparent ? Vec3(0.9f, 0.91f, 0.93f) : Vec3(0.12f, 0.13f, 0.15f);
}

/// Pastes a part at x, y with its alpha; opaque where it has none.
void put(Image& image, const Image& part, int x, int y) {
  const int columns = std::min(part.width, image.width - x);
  for (int row = 0; row < part.height && y + row < image.height && columns > 0; ++row) {
    std::copy_n(part.at(0, row), 3 * columns, image.at(x, y + row));
    if (image.alpha.empty()) continue;
    const auto to = image.alpha.begin() + (static_cast<std::ptrdiff_t>(y + row) * image.width + x);
    if (part.alpha.empty())
      std::fill_n(to, columns, 255);
    else
      std::copy_n(part.alpha.begin() + static_cast<std::ptrdiff_t>(row) * part.width, columns, to);
  }
}

/// Writes the legend onto a picture; `height` of its words in pixels.
void draw_legend(Image& image, const Legend& legend, float height, const Vec3& ink) {
  if (legend.title.empty() || !legend.missing.empty()) return;
  const render::Font font = render::Font::system();
  const int margin = static_cast<int>(height), bar = std::max(3, static_cast<int>(0.6f * height));
  const int width = std::min(static_cast<int>(12 * height), image.width - 2 * margin);
  const bool scale = legend.categories.empty();
  const float lines = scale ? 3.2f : 1.3f * static_cast<float>(legend.categories.size() + 1);
  const int whole = static_cast<int>(lines * height);
  if (width < 2 * margin || whole + margin > image.height) return;
  const auto fill = [&](int x, int y, int w, int h, const Vec3& color) {
    put(image, Image(w, h, color), x, y);
  };
  const auto write = [&](const std::string& words, float x, float y) {
    font.draw(image, words, {x, y}, height, ink);
  };
  float y = static_cast<float>(image.height - margin - whole) + height;
  const float left = static_cast<float>(margin);
  write(legend.title + (legend.unit.empty() ? "" : ", " + legend.unit), left, y);
  for (const Legend::Category& one : legend.categories) {
    y += 1.3f * height;
    fill(margin, static_cast<int>(y - static_cast<float>(bar)), bar, bar, one.color);
    write(one.label, left + 1.2f * height, y);
  }
  if (!scale) return;
  const int top = static_cast<int>(y + 0.4f * height);
  for (int x = 0; x < width; ++x)
    fill(margin + x, top, 1, bar,
         scale_color(legend.scale, static_cast<float>(x) / static_cast<float>(width)));
  const float base = static_cast<float>(top + bar) + 1.1f * height;
  const std::string high = argument(static_cast<double>(legend.high));
  write("0", left, base);
  write(high, left + static_cast<float>(width) - font.width(high, height), base);
}

}  // namespace

Image PictureMaker::picture(const Session& session, app::FrameCache& cache, const PictureOptions& options) {
  const render::PixelSize size = options.size;
  if (options.pane >= 0) {
    US_CHECK(options.pane <= ssize(session.takes), "there is no view ", options.pane);
    const PaneContent pane = pane_of(options.pane);
    return one(session, cache, pane, pane_camera(session, pane), options);
  }
  const std::vector<PaneContent> panes = panes_of(session);
  if (session.view.layout == app::Layout::Wipe && panes.size() == 2)
    return wiped(session, cache, panes, options);
  const int count = panes.size();
  Image all(size.width, size.height);
  if (options.transparent)
    all.alpha.assign(static_cast<size_t>(size.width) * static_cast<size_t>(size.height), 0);
  for (int i = 0; i < count; ++i) {  // edges of the columns fall on whole pixels, none is left over
    const int left = size.width * i / count, right = size.width * (i + 1) / count;
    PictureOptions part = options;
    part.size.width = right - left;
    const PaneContent& pane = panes[i];
    put(all, one(session, cache, pane, pane_camera(session, pane), part), left, 0);
  }
  return all;
}

namespace {

/// As FlatCanvas shows it.
Image canvas_in(const Session& session, const PaneContent& pane, const PictureOptions& options) {
  const Theme& look = theme(session.settings.dark ? ThemeKind::Dark : ThemeKind::Light);
  Image image(options.size.width, options.size.height, Vec3(look.panel.x, look.panel.y, look.panel.z));
  const Canvas canvas = canvas_of_pane(session, pane);
  const Image picture = canvas.is_known() ? canvas_picture(session, pane) : Image();
  if (picture.width == 0) return image;
  const Rect whole{{0, 0}, {static_cast<float>(image.width), static_cast<float>(image.height)}};
  const bool is_wipe = session.view.layout == app::Layout::Wipe;
  const Rect place = canvas_place(whole, canvas, app::canvas_of(session.view, is_wipe ? 1 : pane.number));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f - place.min.x) / place.width(),
                  v = (static_cast<float>(y) + 0.5f - place.min.y) / place.height();
      if (u < 0 || v < 0 || u >= 1 || v >= 1) continue;
      const int column = static_cast<int>(u * static_cast<float>(picture.width)),
                row = static_cast<int>(v * static_cast<float>(picture.height));
      std::copy_n(picture.at(column, row), 3, image.at(x, y));
    }
  return image;
}

}  // namespace

Image PictureMaker::one(const Session& session, app::FrameCache& cache, const PaneContent& pane,
                        const render::Camera& camera, const PictureOptions& options) {
  if (app::is_canvas(session, pane.number)) return canvas_in(session, pane, options);
  looks_of(session, looks_, pane), unposed_look(session, looks_, pane);
  looks_.wait();
  PanePictures pictures;
  const auto unposed = unposed_look(session, looks_, pane);
  if (!unposed)
    pictures = awaited(session, cache, pane);
  else if (session.view.take.surface)
    pictures.takes = {awaited_rest(session, cache, pane, **unposed)};
  const ThemeKind theme = session.settings.dark ? ThemeKind::Dark : ThemeKind::Light;
  PaneScene made = build_scene({session, pane, pictures, looks_of(session, looks_, pane), {}, theme},
                               memories_[pane.number]);
  made.scene.background.transparent = options.transparent;
  Image image = renderer_.render_image(made.scene, camera, options.size);
  const float height = std::max(11.f, static_cast<float>(options.size.height) / 50);
  if (options.legend) draw_legend(image, made.legend, height, ink_on(options, session.settings.dark));
  return image;
}

Image PictureMaker::wiped(const Session& session, app::FrameCache& cache,
                          const std::vector<PaneContent>& panes, const PictureOptions& options) {
  const render::Camera camera = pane_camera(session, panes[0]);
  Image left = one(session, cache, panes[0], camera, options);
  PictureOptions plain = options;
  plain.legend = false;
  const Image right = one(session, cache, panes[1], camera, plain);
  const int line = static_cast<int>(
      std::lround(std::clamp(session.view.wipe, 0.f, 1.f) * static_cast<float>(options.size.width)));
  const int count = left.width - line;
  for (int y = 0; y < left.height; ++y) {
    std::copy_n(right.at(line, y), 3 * count, left.at(line, y));
    const auto from = static_cast<std::ptrdiff_t>(y) * left.width + line;
    if (!left.alpha.empty()) std::copy_n(right.alpha.begin() + from, count, left.alpha.begin() + from);
  }
  return left;
}

}  // namespace understudy::ui
