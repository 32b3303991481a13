#include "app/studio/study_player.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <utility>

#include "app/run/interrupt.hpp"
#include "app/study/trial_exports.hpp"
#include "render/gl/functions.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

namespace gl = render::gl;
using Kind = render::InputEvent::Kind;

constexpr double kResting = 0.25, kPlaying = 0.004;  // seconds between looks at what happens
constexpr double kLongestFrame = 0.25;               // seconds that one frame of the interface may be
constexpr int kToRest = 4;                           // frames that widgets take to come to rest
constexpr float kDesignHeight = 640;                 // pixels of the interface at scale 1

std::string clip_file(const StudyRun& run, const std::string& stimuli, const Trial& trial) {
  return (std::filesystem::path(stimuli) / clip_path(run.study(), trial)).string();
}

std::string time_of_day() {
  using std::chrono::system_clock, std::chrono::milliseconds;
  const auto since = std::chrono::duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
  const auto now = static_cast<std::time_t>(since / 1000);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  return text + printed(".%03dZ", static_cast<int>(since % 1000));
}

}  // namespace

/// Its picture number `shown` was the last to be read, at a time that counts from its first.
struct StudyPlayer::Clip {
  render::VideoReader reader;
  double began_s;
  int shown = -1;
  bool has_ended = false;
};

StudyPlayer::StudyPlayer(StudyRun& run, std::string stimuli, std::unique_ptr<Surface> surface)
    : run_(run), stimuli_(std::move(stimuli)), surface_(std::move(surface)) {
  surface_->set_title("Understudy");
  unsettled_ = kToRest;
}
StudyPlayer::~StudyPlayer() = default;

/// Reads as far as the time has come; pictures that come too late are passed over.
void StudyPlayer::follow_clip(double now_s) {
  if (run_.screen() != RunScreen::Clip) {
    clip_.reset();
    return;
  }
  if (clip_ == nullptr) {
    clip_ = std::make_unique<Clip>(
        Clip{render::VideoReader(clip_file(run_, stimuli_, run_.trial())), now_s, -1, false});
    unsettled_ = kToRest;
  }
  Clip& clip = *clip_;
  if (state_.asks_to_leave) {  // it stands still meanwhile
    clip.began_s = now_s - (clip.shown + 0.5) / clip.reader.fps();
    return;
  }
  const int wanted = static_cast<int>(std::floor((now_s - clip.began_s) * clip.reader.fps()));
  bool is_new = false;
  while (!clip.has_ended && clip.shown < wanted) {
    clip.has_ended = !clip.reader.next();
    is_new = is_new || !clip.has_ended;
    clip.shown += clip.has_ended ? 0 : 1;
  }
  if (is_new) show_picture();
  if (clip.has_ended && wanted > clip.shown) {
    clip_.reset();
    run_.clip_ended(now_s, time_of_day());
    unsettled_ = kToRest;
  }
}

void StudyPlayer::show_picture() {
  const render::Image image = clip_->reader.picture();
  if (texture_ == nullptr) texture_ = std::make_unique<gl::Texture>();
  gl::api().BindTexture(GL_TEXTURE_2D, texture_->name());
  gl::api().PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl::api().TexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                       image.pixels.data());
  for (const unsigned filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl::api().TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const unsigned wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl::api().TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  unsettled_ = std::max(unsettled_, 1);
}

void StudyPlayer::frame(double now_s, double patience_s) {
  const std::vector<render::InputEvent> events = surface_->events(patience_s);
  surface_->context().make_current();
  for (const render::InputEvent& event : events)
    if (event.kind == Kind::Close) state_.leaves = true;
  if (!events.empty()) unsettled_ = kToRest;
  follow_clip(now_s);
  if (unsettled_ == 0 && !gui_.pending()) return;
  unsettled_ = std::max(0, unsettled_ - 1);
  draw(now_s, events);
}

void StudyPlayer::draw(double now_s, const std::vector<render::InputEvent>& events) {
  const render::RenderTarget target = surface_->target();
  if (target.size.width <= 0 || target.size.height <= 0) return;
  ui::FrameInput input;
  input.size = target.size;
  input.scale = std::clamp(static_cast<float>(target.size.height) / kDesignHeight, 1.f, 3.f);
  input.dt = static_cast<float>(std::clamp(now_s - last_s_, 1e-4, kLongestFrame));
  input.theme = ui::theme_upon(run_.study().picture.background);
  last_s_ = now_s;
  ui::RunFrame frame{run_, {}, now_s};
  if (clip_ != nullptr && texture_ != nullptr && clip_->shown >= 0)
    frame.clip = {ui::texture_id(texture_->name()), static_cast<float>(clip_->reader.width()),
                  static_cast<float>(clip_->reader.height())};
  gui_.begin_frame(input, events);
  ui::draw_run_screen(gui_.ui(), state_, frame);
  const ImDrawData& data = gui_.end_frame();
  pass_.present(data, gui_.atlas(), target, gui_.ui().theme().backdrop);
  surface_->present();
  const bool watches = clip_ != nullptr && !state_.asks_to_leave;
  surface_->set_cursor(watches ? render::CursorShape::Hidden : gui_.cursor());
}

double StudyPlayer::patience_s() const {
  if (unsettled_ > 0 || gui_.pending()) return 0;
  return run_.screen() == RunScreen::Clip ? kPlaying : kResting;
}

void StudyPlayer::run() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  while (!is_over() && !interrupted())
    frame(std::chrono::duration<double>(Clock::now() - began).count(), patience_s());
}

}  // namespace understudy::app
