#include "retarget/motion_space/knot_coder.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/motion_space/step_form.hpp"

namespace understudy {
namespace {

class KnotCoder final : public MotionCoder {
 public:
  int size() const override { return kStepNumbers; }
  std::string name() const override { return "plain"; }

  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    const StepNumbers numbers = step_numbers(movement, rest);
    return {{numbers.begin(), numbers.end()}, {}};
  }

  TimedPoses decode(const std::vector<float>& code, const Joints& rest) override {
    const auto count = static_cast<Eigen::Index>(code.size());
    return movement_of_numbers(Eigen::Map<const StepNumbers>(code.data(), count), rest);
  }
};

}  // namespace

std::unique_ptr<MotionCoder> make_knot_coder() {
  return std::make_unique<KnotCoder>();
}

std::vector<Pose> sampled_evenly(const TimedPoses& movement, int count) {
  const auto& times = movement.seconds;
  US_CHECK(times.size() == movement.poses.size() && times.size() >= 2,
           "a movement needs two poses, and a time of each");
  for (size_t i = 1; i < times.size(); ++i)
    US_CHECK(times[i] > times[i - 1], "the times of a movement do not rise: ", times[i], " s follow ",
             times[i - 1], " s");
  std::vector<Pose> samples;
  samples.reserve(static_cast<size_t>(std::max(count, 0)));
  for (int i = 0; i < count; ++i)
    samples.push_back(pose_at(movement, times[0] + (times.back() - times[0]) * static_cast<float>(i) /
                                                       static_cast<float>(count - 1)));
  return samples;
}

}  // namespace understudy
