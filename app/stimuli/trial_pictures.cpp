#include "app/stimuli/trial_pictures.hpp"

#include <algorithm>
#include <utility>

namespace understudy::app {

struct TrialPictures::Kept {
  std::string study;  // all of it
  std::unique_ptr<StageMaker> maker;
  std::shared_ptr<const Stage> stage;
  render::PixelSize size;
  std::unique_ptr<StagePainter> painter;
};

TrialPictures::TrialPictures(StimulusServices services)
    : services_(std::move(services)), kept_(std::make_unique<Kept>()) {}
TrialPictures::~TrialPictures() = default;

render::Image TrialPictures::picture(const Study& study, const Trial& trial, float share,
                                     render::PixelSize size) {
  check(study);
  const std::string text = to_json(study, "").dump(-1, ' ', false, Json::error_handler_t::replace);
  if (kept_->study != text) {
    *kept_ = {};
    kept_->maker = std::make_unique<StageMaker>(study, services_);
    kept_->study = text;
  }
  if (kept_->stage == nullptr || kept_->stage->motion != trial.motion ||
      kept_->stage->target != trial.target) {
    kept_->painter.reset();
    kept_->stage = nullptr;
    kept_->stage = kept_->maker->stage(trial.motion, trial.target);
  }
  if (kept_->painter == nullptr || !same(kept_->size, size)) {
    kept_->painter = std::make_unique<StagePainter>(study, kept_->stage, size, renderers_);
    kept_->size = size;
  }
  const ClipPlan plan(study.clip, study.picture.fps, kept_->stage->motion_s);
  const int last = plan.frames() - 1;
  const int frame = std::clamp(static_cast<int>(share * static_cast<float>(plan.frames())), 0, last);
  return kept_->painter->picture(trial, plan.at(frame));
}

}  // namespace understudy::app
