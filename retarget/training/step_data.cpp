#include "retarget/training/step_data.hpp"

#include <algorithm>
#include <array>

#include "retarget/base/index.hpp"
#include "retarget/motion_space/step_form.hpp"

namespace understudy::training {
namespace {

constexpr float kOtherPhase = 0.5f, kOtherArms = 0.3f;  // shares of a batch
constexpr float kSlower = 0.8f, kQuicker = 1.25f;

constexpr std::array<int, 8> kArms = {LeftCollar, RightCollar, LeftShoulder, RightShoulder,
                                      LeftElbow,  RightElbow,  LeftWrist,    RightWrist};

std::vector<Clip> clips_of(const std::vector<StepClip>& clips) {
  std::vector<Clip> found;
  for (const StepClip& clip : clips) found.push_back(clip.clip);
  return found;
}

StepBatch empty_batch(int64_t count) {
  return {torch::empty({count, kStepNumbers}), torch::empty({count, kJointCount, 3})};
}

}  // namespace

StepData::StepData(const std::vector<StepClip>& clips, float mean_leg_m)
    : poses_(clips_of(clips)), mean_leg_m_(mean_leg_m), of_clip_(clips.size()) {
  for (int c = 0; c < ssize(clips); ++c) {
    rest_.push_back(clips[c].rest);
    const Motion& motion = clips[c].clip.motion;
    const auto good = [&](int t) { return motion.flags.empty() || motion.flags[t] == 0; };
    for (const Step& step : clips[c].steps) {
      Captured captured;
      captured.clip = c;
      captured.first = static_cast<float>(step.first);
      captured.frames = static_cast<float>(step.last - step.first);
      captured.left_first = step.left_first;
      captured.run_first = step.first, captured.run_last = step.last;
      while (captured.run_first > 0 && good(captured.run_first - 1)) --captured.run_first;
      while (captured.run_last + 1 < ssize(motion.poses) && good(captured.run_last + 1)) ++captured.run_last;
      of_clip_[c].push_back(static_cast<int>(ssize(steps_)));
      steps_.push_back(captured);
    }
  }
}

double StepData::mean_seconds() const {
  double sum = 0;
  for (const Captured& step : steps_) sum += static_cast<double>(step.frames / kClipRate);
  return sum / static_cast<double>(steps_.size());
}

const StepData::Captured& StepData::random_step(Rng& rng) const {
  if (rng.chance(0.5f)) return steps_[rng.below(static_cast<int>(ssize(steps_)))];
  const auto& mine = of_clip_[rng.below(static_cast<int>(ssize(of_clip_)))];
  return steps_[mine[rng.below(static_cast<int>(ssize(mine)))]];
}

StepData::Knots StepData::knots_of(const Captured& step, float phase, bool mirror) const {
  const float first = std::clamp(step.first + phase * step.frames, static_cast<float>(step.run_first),
                                 static_cast<float>(step.run_last) - step.frames);
  Knots knots;
  for (int k = 0; k < kKnots; ++k) {
    const float share = static_cast<float>(k) / static_cast<float>(kKnots - 1);
    const Pose pose = poses_.at(step.clip, first + share * step.frames);
    knots.push_back(mirror ? mirrored(pose) : pose);
  }
  return knots;
}

void StepData::put(const Knots& knots, float seconds, int clip, int64_t row, StepBatch& batch) const {
  put_step_numbers(knots, seconds, mean_leg_m_, batch.movements.data_ptr<float>() + row * kStepNumbers);
  std::copy_n(rest_[clip].data(), rest_[clip].size(),
              batch.rest.data_ptr<float>() + row * rest_[clip].size());
}

StepBatch StepData::batch(int count, Rng& rng) const {
  StepBatch batch = empty_batch(count);
  for (int64_t row = 0; row < count; ++row) {
    const Captured& step = random_step(rng);
    const bool mirror = rng.chance(0.5f);
    const float phase = rng.chance(kOtherPhase) ? rng.uniform(-0.5f, 0.5f) : 0;
    Knots knots = knots_of(step, phase, mirror);
    if (rng.chance(kOtherArms)) {
      const Captured& other = random_step(rng);  // in a mirror, too, where it begins with the other foot
      const Knots arms = knots_of(other, phase, mirror == (other.left_first == step.left_first));
      for (int k = 0; k < kKnots; ++k)
        for (const int joint : kArms) knots[k].local[joint] = arms[k].local[joint];
    }
    put(knots, step.frames / kClipRate / rng.uniform(kSlower, kQuicker), step.clip, row, batch);
  }
  return batch;
}

}  // namespace understudy::training
