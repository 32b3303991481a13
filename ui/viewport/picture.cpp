#include "ui/viewport/picture.hpp"

#include <algorithm>
#include <cmath>

#include "render/text.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/pane_pictures.hpp"

namespace understudy::ui {
namespace {

using app::Session;
using render::Image;

constexpr int kRounds = 4;  // of asking and waiting: what is asked for last may push out what came first

bool whole(const PanePictures& pictures, const Session& session, const PaneContent& pane) {
  return std::all_of(pictures.ghosts.begin(), pictures.ghosts.end(), [&](const PanePictures::Ghost& ghost) {
    return (ghost.scan != nullptr || !session.view.source.ghosts || !pane.source) &&
           (ghost.take != nullptr || !session.view.take.ghosts || pane.takes.empty());
  });
}

PanePictures awaited(const Session& session, app::FrameCache& cache, const PaneContent& pane) {
  PanePictures got;
  for (int round = 0; round < kRounds; ++round) {
    auto pictures = pictures_of(session, cache, pane, pane_frame(session, pane));
    if (pictures) got = std::move(*pictures);
    if (pictures && whole(got, session, pane)) break;
    cache.wait();
  }
  return got;
}

Vec3 ink_on(const PictureOptions& options, bool dark) {
  return dark && !options.transparent ? Vec3(0.9f, 0.91f, 0.93f) : Vec3(0.12f, 0.13f, 0.15f);
}

/// `image` with alpha wherever `with` has it, pasted at x, y.
void put(Image& image, const Image& part, int x, int y) {
  for (int row = 0; row < part.height && y + row < image.height; ++row)
    for (int column = 0; column < part.width && x + column < image.width; ++column) {
      std::copy_n(part.at(column, row), 3, image.at(x + column, y + row));
      const size_t from = static_cast<size_t>(row) * part.width + column;
      if (!image.alpha.empty())
        image.alpha[static_cast<size_t>(y + row) * image.width + x + column] =
            part.alpha.empty() ? 255 : part.alpha[from];
    }
}

}  // namespace

struct PictureMaker::Impl {
  explicit Impl(int samples) : renderer({samples, render::Quality::Best}) {}
  Image one(const Session& session, app::FrameCache& cache, const PaneContent& pane,
            const render::Camera& camera, const PictureOptions& options);
  Image wiped(const Session& session, app::FrameCache& cache, const std::vector<PaneContent>& panes,
              const PictureOptions& options);

  render::Renderer renderer;
  TargetLooks looks;
  ColourMemory colours;
};

PictureMaker::PictureMaker(int samples) : impl_(std::make_unique<Impl>(samples)) {}
PictureMaker::~PictureMaker() = default;
PictureMaker::PictureMaker(PictureMaker&&) noexcept = default;

Image PictureMaker::picture(const Session& session, app::FrameCache& cache, const PictureOptions& options) {
  const render::PixelSize size = options.size;
  US_CHECK(size.width >= 16 && size.height >= 16 && size.width <= 16384 && size.height <= 16384,
           "a picture cannot be ", size.width, " x ", size.height, " pixels");
  if (options.pane >= 0) {
    US_CHECK(options.pane <= ssize(session.takes), "there is no view ", options.pane);
    const PaneContent pane = pane_of(options.pane);
    return impl_->one(session, cache, pane, pane_camera(session, pane), options);
  }
  const std::vector<PaneContent> panes = panes_of(session);
  if (session.view.layout == app::Layout::Wipe && panes.size() == 2)
    return impl_->wiped(session, cache, panes, options);
  const int count = panes.size();
  Image all(size.width, size.height);
  if (options.transparent)
    all.alpha.assign(static_cast<size_t>(size.width) * static_cast<size_t>(size.height), 0);
  for (int i = 0; i < count; ++i) {  // edges of the columns fall on whole pixels, none is left over
    const int left = size.width * i / count, right = size.width * (i + 1) / count;
    PictureOptions part = options;
    part.size.width = right - left;
    const PaneContent& pane = panes[i];
    put(all, impl_->one(session, cache, pane, pane_camera(session, pane), part), left, 0);
  }
  return all;
}

Image PictureMaker::Impl::one(const Session& session, app::FrameCache& cache, const PaneContent& pane,
                              const render::Camera& camera, const PictureOptions& options) {
  std::vector<std::shared_ptr<const TargetLook>> found;
  for (const int k : pane.takes) looks.of(session.takes[k].target);
  look_of_standing(session, looks, pane);
  looks.wait();
  for (const int k : pane.takes) found.push_back(looks.of(session.takes[k].target));
  PanePictures pictures;
  const auto standing = look_of_standing(session, looks, pane);
  if (!standing)
    pictures = awaited(session, cache, pane);
  else if (session.view.take.surface)
    pictures.takes = {std::shared_ptr<const app::PosedPicture>(*standing, &(*standing)->rest)};
  const ThemeKind theme = session.settings.dark ? ThemeKind::Dark : ThemeKind::Light;
  PaneScene made = build_scene({session, pane, pictures, found, {}, theme}, &colours);
  made.scene.background.transparent = options.transparent;
  Image image = renderer.render_image(made.scene, camera, options.size);
  const float height = std::max(11.f, static_cast<float>(options.size.height) / 50);
  if (options.legend) draw_legend(image, made.legend, height, ink_on(options, session.settings.dark));
  return image;
}

Image PictureMaker::Impl::wiped(const Session& session, app::FrameCache& cache,
                                const std::vector<PaneContent>& panes, const PictureOptions& options) {
  const render::Camera camera = pane_camera(session, panes[0]);
  Image left = one(session, cache, panes[0], camera, options);
  PictureOptions plain = options;
  plain.legend = false;
  const Image right = one(session, cache, panes[1], camera, plain);
  const int line = static_cast<int>(
      std::lround(std::clamp(session.view.wipe, 0.f, 1.f) * static_cast<float>(options.size.width)));
  for (int y = 0; y < left.height; ++y) {
    const size_t from = static_cast<size_t>(y) * left.width + line,
                 to = static_cast<size_t>(y + 1) * left.width;
    std::copy(right.pixels.begin() + static_cast<std::ptrdiff_t>(3 * from),
              right.pixels.begin() + static_cast<std::ptrdiff_t>(3 * to),
              left.pixels.begin() + static_cast<std::ptrdiff_t>(3 * from));
    if (!left.alpha.empty() && !right.alpha.empty())
      std::copy(right.alpha.begin() + static_cast<std::ptrdiff_t>(from),
                right.alpha.begin() + static_cast<std::ptrdiff_t>(to),
                left.alpha.begin() + static_cast<std::ptrdiff_t>(from));
  }
  return left;
}

void draw_legend(Image& image, const Legend& legend, float height, const Vec3& ink) {
  if (legend.title.empty() || !legend.missing.empty()) return;
  const render::Font font = render::Font::system();
  const int margin = static_cast<int>(height), bar = std::max(3, static_cast<int>(0.6f * height));
  const int width = std::min(static_cast<int>(12 * height), image.width - 2 * margin);
  const int rows = legend.categories.empty() ? 0 : static_cast<int>(legend.categories.size());
  const int whole =
      static_cast<int>((legend.categories.empty() ? 3.2f : 1.3f * static_cast<float>(rows + 1)) * height);
  if (width < 2 * margin || whole + margin > image.height) return;
  const auto fill = [&](int x, int y, int w, int h, const Vec3& color) {
    Image patch(w, h, color);
    put(image, patch, x, y);
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
  if (!legend.categories.empty()) return;
  const int top = static_cast<int>(y + 0.4f * height);
  for (int x = 0; x < width; ++x)
    fill(margin + x, top, 1, bar,
         scale_color(legend.scale, static_cast<float>(x) / static_cast<float>(width)));
  const float base = static_cast<float>(top + bar) + 1.1f * height;
  const std::string high = argument(static_cast<double>(legend.high));
  write(argument(static_cast<double>(legend.low)), left, base);
  write(high, left + static_cast<float>(width) - font.width(high, height), base);
}

}  // namespace understudy::ui
