#include "app/stimuli/clip_plan.hpp"

#include <algorithm>
#include <cmath>

namespace understudy::app {
namespace {

int frames_in(double seconds, int fps) {
  return static_cast<int>(std::lround(seconds * fps));
}

}  // namespace

ClipPlan::ClipPlan(const StudyClip& clip, int fps, double motion_s)
    : frames_(std::max(1, frames_in(clip.seconds, fps))),
      run_(std::clamp(frames_in(std::min(motion_s / clip.speed, 1e6), fps), 1, frames_)),
      card_(frames_in(clip.card_s, fps)),
      step_s_(static_cast<double>(clip.speed) / fps) {
  // One more for each card that at least half a second of motion follows, or all of a shorter one.
  const int least = card_ == 0 ? 1 : card_ + std::min(run_, std::max(1, fps / 2));
  const int left = frames_ - run_;
  runs_ = 1 + left / (run_ + card_) + (left % (run_ + card_) >= least ? 1 : 0);
}

ClipMoment ClipPlan::at(int frame) const {
  const int run = std::min(frame / (run_ + card_), runs_ - 1), into = frame - run * (run_ + card_);
  const bool is_card = into >= run_ && run < runs_ - 1;
  return {std::min(into, run_ - 1) * step_s_, is_card};
}

}  // namespace understudy::app
