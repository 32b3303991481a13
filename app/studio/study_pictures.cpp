#include "app/studio/study_pictures.hpp"

#include <algorithm>
#include <utility>

#include "app/stimuli/stage_painter.hpp"
#include "render/context/context.hpp"
#include "render/gl/program.hpp"
#include "retarget/base/error.hpp"
#include "ui/gui/draw_pass.hpp"

namespace understudy::app {
namespace gl = render::gl;
namespace {

constexpr size_t kKeptTrials = 48;  // pictures
constexpr int kWidth = 640;         // pixels
constexpr int kHighest = 960;       // of upright pictures

render::PixelSize size_of(const StudyPicture& picture) {
  const double height = static_cast<double>(kWidth) * picture.height / picture.width;
  const int whole = std::clamp(static_cast<int>(height), 64, kHighest);
  return {std::max(64, static_cast<int>(static_cast<double>(whole) * picture.width / picture.height)), whole};
}

}  // namespace

StudyPictures::StudyPictures(const StudioServices& services)
    : networks_(services.networks), motion_coder_(services.motion_coder) {}

StudyPictures::~StudyPictures() {
  stopped_ = true;
}

ui::TrialPicture StudyPictures::of(const Study& study, const Trial& trial, float share) {
  const std::string stage_key =
      understudy::key_of(study.conditions, study.motions, study.targets, study.clip, study.picture);
  const std::string key = stage_key + understudy::key_of(study.layout, trial.condition, trial.other,
                                                         trial.motion, trial.target, share);
  if (const auto known = pictures_.find(key); known != pictures_.end()) {
    known->second.used = ++uses_;
    return known->second.shown;
  }
  const auto held = worker_.lock();
  if (at_work_ != key && (!finished_ || finished_->key != key)) {
    wanted_ = Wanted{key, stage_key, study, trial, share};
    worker_.wake();
  }
  return {nullptr, 0, 0, "Retargeting\u2026"};
}

Worker::Task StudyPictures::next() {
  if (!wanted_ || finished_) return nullptr;
  const auto wanted = std::make_shared<const Wanted>(*std::exchange(wanted_, std::nullopt));
  at_work_ = wanted->key;
  return [this, wanted] {
    Made made{wanted->key, {}, {}};
    made.problem = failure_of([&] { made.image = draw(*wanted); });
    const auto held = worker_.lock();
    at_work_.clear();
    if (!stopped_) finished_ = std::move(made);
    ++made_;
  };
}

render::Image StudyPictures::draw(const Wanted& wanted) {
  if (maker_ == nullptr || stage_key_ != wanted.stage_key) {
    stage_ = nullptr;
    maker_ = nullptr;
    check_files(wanted.study);
    StimulusServices services;
    services.networks = networks_;
    services.motion_coder = motion_coder_;
    services.progress = [this](const std::string&, int64_t, int64_t) {
      US_CHECK(!stopped_, "the studio is closed");
    };
    maker_ = std::make_unique<StageMaker>(wanted.study, services);
    stage_key_ = wanted.stage_key;
  }
  const Trial& trial = wanted.trial;
  if (stage_ == nullptr || stage_->motion != trial.motion || stage_->target != trial.target) {
    stage_ = nullptr;
    stage_ = maker_->stage(trial.motion, trial.target);
  }
  const auto context = render::make_offscreen_context();
  ClipRenderers renderers;
  StagePainter painter(wanted.study, stage_, size_of(wanted.study.picture), renderers);
  const ClipPlan plan(wanted.study.clip, wanted.study.picture.fps, stage_->motion_s);
  const int frame = static_cast<int>(wanted.share * static_cast<float>(plan.frames()));
  return painter.picture(trial, plan.at(std::clamp(frame, 0, plan.frames() - 1)));
}

bool StudyPictures::update() {
  std::optional<Made> made;
  {
    const auto held = worker_.lock();
    made = std::exchange(finished_, std::nullopt);
    worker_.wake();
  }
  if (!made) return false;
  Picture& picture = pictures_[made->key];
  picture.used = ++uses_;
  picture.shown = {nullptr, 0, 0, made->problem};
  if (made->problem.empty()) {
    std::vector<uint8_t> opaque(static_cast<size_t>(made->image.width) * made->image.height * 4, 255);
    for (size_t i = 0; i < opaque.size() / 4; ++i)
      std::copy_n(made->image.pixels.data() + 3 * i, 3, opaque.data() + 4 * i);
    picture.texture = std::make_unique<gl::Texture>();
    gl::TextureImage image;
    image.width = made->image.width, image.height = made->image.height;
    image.pixels = opaque.data();
    gl::set_image(*picture.texture, image);
    picture.shown.texture = ui::texture_id(picture.texture->name());
    picture.shown.width = static_cast<float>(image.width);
    picture.shown.height = static_cast<float>(image.height);
  }
  forget_oldest();
  return true;
}

bool StudyPictures::busy() const {
  const auto held = worker_.lock();
  return wanted_ || finished_ || !at_work_.empty();
}

void StudyPictures::forget_oldest() {
  while (pictures_.size() > kKeptTrials)
    pictures_.erase(std::min_element(pictures_.begin(), pictures_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    }));
}

}  // namespace understudy::app
