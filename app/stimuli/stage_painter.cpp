#include "app/stimuli/stage_painter.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

constexpr int kSource = -1, kTarget = -2;
constexpr int64_t kMostKept = int64_t{400} << 20;  // bytes of pictures

/// Dark on a light background, light on a dark one.
Vec3 ink(const Vec3& background) {
  return Vec3::Constant(background.mean() > 0.45f ? 0.16f : 0.92f);
}

/// Text in the middle of a box, smaller where it would not fit.
void draw_centred(render::Image& image, const render::Font& font, const std::string& text,
                  const Eigen::Vector4f& box, const Vec3& color) {
  const float x = box[0], y = box[1], width = box[2];
  float size = box[3];
  const float full = font.width(text, size), room = 0.94f * width;
  if (full > room) size *= room / full;
  font.draw(image, text, {x + (width - font.width(text, size)) / 2, y + 0.35f * size}, size, color);
}

}  // namespace

render::Renderer& ClipRenderers::of(size_t pane) {
  while (all_.size() <= pane)
    all_.push_back(
        std::make_unique<render::Renderer>(render::RendererOptions{4, render::Quality::Interactive}));
  return *all_[pane];
}

StagePainter::StagePainter(const Study& study, std::shared_ptr<const Stage> stage, render::PixelSize size,
                           ClipRenderers& renderers)
    : study_(study),
      stage_(std::move(stage)),
      size_(size),
      renderers_(renderers),
      font_(render::Font::system()),
      panes_(frame_panes(study, stage_->extents, size)),
      frame_(size.width, size.height, study.picture.background),
      border_(std::max(1, size.height / 360), size.height,
              0.82f * study.picture.background + 0.18f * ink(study.picture.background)) {
  const int strip = label_height(study, size);
  if (strip == 0) return;
  const float letters = 0.52f * static_cast<float>(strip);
  for (size_t p = 0; p < panes_.size(); ++p)
    draw_centred(frame_, font_, label(p),
                 {static_cast<float>(panes_[p].x), 0.55f * static_cast<float>(strip),
                  static_cast<float>(panes_[p].size.width), letters},
                 ink(study.picture.background));
}

std::string StagePainter::label(size_t pane) const {
  const PaneView& view = panes_[pane];
  if (view.pane == StudyPane::Source) return "Source";
  if (view.pane == StudyPane::Target) return "Target";
  if (study_.layout.results == TrialResults::One) return "Result";
  return view.side == 0 ? "A" : "B";
}

int StagePainter::subject(const Trial& trial, size_t pane) const {
  const PaneView& view = panes_[pane];
  if (view.pane == StudyPane::Source) return kSource;
  if (view.pane == StudyPane::Target) return kTarget;
  return view.side == 0 ? trial.condition : trial.other;
}

const MovingSurface& StagePainter::surface(int subject) const {
  if (subject == kSource) return stage_->source;
  return subject == kTarget ? stage_->standing : stage_->results[static_cast<size_t>(subject)];
}

render::Scene StagePainter::scene(const Trial& trial, size_t pane, const ClipMoment& moment) const {
  const StudyPicture& picture = study_.picture;
  const MovingSurface& shown = surface(subject(trial, pane));
  render::Scene scene;
  scene.background.top = scene.background.bottom = picture.background;
  scene.light = render::turned_light(picture.light_turn_deg, picture.light_height_deg, picture.brightness);
  if (picture.background.mean() < 0.45f)
    scene.ground.line = Vec3(0.42f, 0.45f, 0.50f), scene.ground.shadow = 0.8f;
  app::add(scene, shown, shown.at(moment.motion_s));
  return scene;
}

/// What no other picture of this trial's shows makes room.
void StagePainter::forget_others(const Trial& trial) {
  for (auto at = kept_.begin(); at != kept_.end();) {
    const int subject = at->first.first;
    if (subject < 0 || subject == trial.condition || subject == trial.other) {
      ++at;
      continue;
    }
    kept_bytes_ -= ssize(at->second->pixels);
    at = kept_.erase(at);
  }
}

StagePainter::Picture StagePainter::drawn_pane(const Trial& trial, size_t pane, const ClipMoment& moment) {
  const int who = subject(trial, pane);
  const std::pair<int, size_t> key{who, surface(who).index_at(moment.motion_s)};
  const auto known = kept_.find(key);
  if (known != kept_.end()) return known->second;
  const PaneView& view = panes_[pane];
  auto made = std::make_shared<const render::Image>(
      renderers_.of(pane).render_image(scene(trial, pane, moment), view.camera, view.size));
  ++drawn_;
  const int64_t bytes = ssize(made->pixels);
  if (kept_bytes_ + bytes > kMostKept) forget_others(trial);
  if (kept_bytes_ + bytes > kMostKept) return made;
  kept_[key] = made;
  kept_bytes_ += bytes;
  return made;
}

render::Image StagePainter::card(render::PixelSize size) const {
  render::Image image(size.width, size.height, study_.picture.background);
  draw_centred(image, font_, study_.clip.card,
               {0, static_cast<float>(size.height) / 2, static_cast<float>(size.width),
                0.09f * static_cast<float>(size_.height)},
               ink(study_.picture.background));
  return image;
}

render::Image StagePainter::pane_picture(const Trial& trial, size_t pane, const ClipMoment& moment) {
  if (moment.is_card) return card(panes_[pane].size);
  return *drawn_pane(trial, pane, moment);
}

render::Image StagePainter::picture(const Trial& trial, const ClipMoment& moment) {
  if (moment.is_card) return card(size_);
  render::Image whole = frame_;
  for (size_t p = 0; p < panes_.size(); ++p)
    render::paste(whole, *drawn_pane(trial, p, moment), panes_[p].x, panes_[p].y);
  for (size_t p = 1; p < panes_.size(); ++p)
    render::paste(whole, border_, panes_[p].x - border_.width / 2, 0);
  return whole;
}

}  // namespace understudy::app
