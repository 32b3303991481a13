#include "retarget/motion_space/paper_space.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/motion_space/step_fit.hpp"
#include "retarget/motion_space/steps.hpp"
#include "retarget/skeleton/curve_doubt.hpp"
#include "retarget/skeleton/stances.hpp"

namespace understudy {
namespace {

/// Of each start so many moments of the cycle at which it begins, and how long it takes.
constexpr int kPhases = 8;
constexpr std::array<float, 3> kCycle_s = {0.75f, 1.05f, 1.4f};
/// How far a fitted movement is off where nothing is known, against where something is; and never less.
constexpr float kFarther = 1.5f, kLeastError_m = 0.01f;

/// Codes of the built-in walk.
std::vector<std::vector<float>> walk_codes(MotionCoder& coder) {
  const Joints rest = builtin_joints();
  const Motion walk = builtin_motion("walk", rest);
  const std::vector<Step> steps = find_steps(walk);
  US_CHECK(!steps.empty(), "the built-in walk has no cycle");
  const Step& step = steps[steps.size() / 2];
  const int frames = step.last - step.first;
  std::vector<std::vector<float>> codes;
  for (int phase = 0; phase < kPhases; ++phase) {
    const int first = step.first + (2 * phase - kPhases) * frames / (2 * kPhases);
    TimedPoses movement = movement_of(walk, first, first + frames);
    for (const float cycle : kCycle_s) {
      const float slower = cycle / movement.duration();
      for (float& seconds : movement.seconds) seconds *= slower;
      codes.push_back(coder.encode(movement, rest).mean);
    }
  }
  return codes;
}

/// What brings one pose to another, and the pose that it brings one to.
Pose way_between(const Pose& from, const Pose& to) {
  Pose way;
  for (int j = 0; j < kJointCount; ++j) way.local[j] = from.local[j].transpose() * to.local[j];
  way.root = to.root - from.root;
  return way;
}
Pose brought(Pose pose, const Pose& way) {
  for (int j = 0; j < kJointCount; ++j) pose.local[j] = pose.local[j] * way.local[j];
  pose.root += way.root;
  return pose;
}

/// Poses that pass through what is wholly known: what they are off there goes evenly over from one known
/// sample to the next.
std::vector<Pose> bent(const std::vector<Pose>& poses, const std::vector<KnownParts>& known,
                       const std::vector<Pose>& curve) {
  std::vector<int> whole;
  for (int i = 0; i < ssize(known); ++i)
    if (known[i] == all_parts(true)) whole.push_back(i);
  std::vector<Pose> made;
  for (int i = 0; i < ssize(poses); ++i) {
    const auto next = std::lower_bound(whole.begin(), whole.end(), i);
    const int after = next == whole.end() ? whole.back() : *next;
    const int before = next == whole.begin() ? after : *(next - 1);
    const float share =
        after == before ? 0.0f : static_cast<float>(i - before) / static_cast<float>(after - before);
    made.push_back(
        brought(poses[i], between(way_between(poses[before], curve[before]),
                                  way_between(poses[after], curve[after]), std::min(share, 1.0f))));
  }
  return made;
}

class StepWindows final : public WindowNetwork {
 public:
  explicit StepWindows(std::unique_ptr<MotionCoder> coder)
      : coder_(std::move(coder)), starts_(walk_codes(*coder_)) {}

  std::vector<WindowAnswer> answer(const std::vector<MotionWindow>& windows,
                                   const std::vector<WindowCode>&) override {
    std::vector<WindowAnswer> answers;
    answers.reserve(windows.size());
    for (const MotionWindow& window : windows) answers.push_back(answer(window));
    return answers;
  }

 private:
  WindowAnswer answer(const MotionWindow& window) {
    const std::vector<KnownParts> known = known_of(window);
    WindowAnswer answer;
    answer.poses = window.curve;
    answer.standing.resize(known.size(), {0, 0});
    answer.doubt_m = curve_doubt(known, {kWindowRate, window.curve, {}}, window.rest);
    if (std::find(known.begin(), known.end(), all_parts(true)) == known.end()) return answer;
    const FittedStep step = fit_step(*coder_, window, starts_);
    const std::vector<Pose> poses = bent(step.poses, known, window.curve);
    for (size_t i = 0; i < known.size(); ++i) mix(window, i, poses[i], step.error_m, answer);
    std::vector<Joints> joints;
    joints.reserve(answer.poses.size());
    for (const Pose& pose : answer.poses) joints.push_back(forward_kinematics(window.rest, pose).joints);
    const std::vector<Standing> stand = stances(joints, 1 / kWindowRate, leg_length(window.rest));
    for (size_t i = 0; i < stand.size(); ++i)
      for (size_t side = 0; side < 2; ++side) answer.standing[i][side] = stand[i][side] ? 1.0f : 0.0f;
    return answer;
  }

  /// The mean of curve and movement that is likeliest where each is off by what is expected of it.
  static void mix(const MotionWindow& window, size_t i, Pose made, float error_m, WindowAnswer& answer) {
    const Pose& curve = window.curve[i];
    const auto& [since, until] = window.distance[i][kRootPart];
    if (since < kFarFrames && until < kFarFrames)
      made.root = Vec3(curve.root.x(), made.root.y(), curve.root.z());
    float& doubt = answer.doubt_m[i];
    const float fit = std::max(kLeastError_m, kFarther * error_m);
    const float share = doubt * doubt / (doubt * doubt + fit * fit);
    answer.poses[i] = between(curve, made, share);
    doubt = fit * std::sqrt(share);
  }

  std::unique_ptr<MotionCoder> coder_;
  std::vector<std::vector<float>> starts_;
};

}  // namespace

PaperSpace::PaperSpace(std::unique_ptr<MotionCoder> coder)
    : space_(std::make_unique<StepWindows>(std::move(coder))) {}

}  // namespace understudy
