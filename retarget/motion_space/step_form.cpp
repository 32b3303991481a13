#include "retarget/motion_space/step_form.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/motion_window.hpp"

namespace understudy {
namespace {

constexpr float kLeastStep = 1e-3f;  // seconds between two knots

const Vec6 kNoTurn = rotation_to_6d(Mat3::Identity());

bool is_finite(const Pose& pose) {
  return pose.root.allFinite() &&
         std::all_of(pose.local.begin(), pose.local.end(), [](const Mat3& R) { return R.allFinite(); });
}

void check_movement(const TimedPoses& movement) {
  const auto& seconds = movement.seconds;
  US_CHECK(movement.poses.size() == seconds.size(), "a movement of ", movement.poses.size(), " poses has ",
           seconds.size(), " times");
  US_CHECK(seconds.size() >= 2, "a movement needs two poses, this has ", seconds.size());
  US_CHECK(seconds.front() == 0, "a movement begins at 0 s, not at ", seconds.front());
  for (size_t t = 1; t < seconds.size(); ++t)
    US_CHECK(seconds[t] > seconds[t - 1], "the times of a movement do not rise from pose ", t - 1, " to ", t);
  US_CHECK(seconds.back() <= kLongestMovement, "a movement of ", seconds.back(), " s is more than a step (",
           kLongestMovement, " s at most)");
  for (size_t t = 0; t < seconds.size(); ++t)
    US_CHECK(is_finite(movement.poses[t]), "pose ", t, " of a movement is not finite");
}

Outlook floor_outlook(const Pose& pose) {
  Outlook outlook = Outlook::of(pose);
  outlook.place.y() = 0;
  return outlook;
}

}  // namespace

void put_step_numbers(const std::vector<Pose>& knots, float seconds, float leg_m, float* row) {
  const Outlook outlook = floor_outlook(knots.front());
  float *turns = row, *path = row + kStepTurns, *times = path + kStepPath;
  for (int k = 0; k < kKnots; ++k) {
    const Pose pose = outlook.seen(knots[k]);
    for (const Mat3& R : pose.local) {
      Eigen::Map<Vec6>(turns, 6) = rotation_to_6d(R) - kNoTurn;
      turns += 6;
    }
    Eigen::Map<Vec3>(path + 3 * k, 3) = pose.root / leg_m;
    times[k] = seconds / kStepSeconds * static_cast<float>(k) / static_cast<float>(kKnots - 1);
  }
}

StepNumbers step_numbers(const TimedPoses& movement, const Joints& rest) {
  check_movement(movement);
  std::vector<Pose> knots;
  knots.reserve(kKnots);
  for (int k = 0; k < kKnots; ++k)
    knots.push_back(
        pose_at(movement, movement.duration() * static_cast<float>(k) / static_cast<float>(kKnots - 1)));
  StepNumbers numbers(kStepNumbers);
  put_step_numbers(knots, movement.duration(), leg_length(rest), numbers.data());
  return numbers;
}

TimedPoses movement_of_numbers(const StepNumbers& numbers, const Joints& rest) {
  US_CHECK(numbers.size() == kStepNumbers, "a movement is ", kStepNumbers, " numbers, not ", numbers.size());
  US_CHECK(numbers.allFinite(), "the numbers of a movement are not finite");
  const float *turns = numbers.data(), *path = turns + kStepTurns, *times = path + kStepPath;
  const float leg = leg_length(rest);
  TimedPoses movement;
  for (int k = 0; k < kKnots; ++k) {
    Pose& pose = movement.poses.emplace_back();
    for (Mat3& R : pose.local) {
      R = rotation_from_6d(Eigen::Map<const Vec6>(turns, 6) + kNoTurn);
      turns += 6;
    }
    pose.root = leg * Eigen::Map<const Vec3>(path + 3 * k, 3);
    const float since = kStepSeconds * (times[k] - times[0]);
    movement.seconds.push_back(k == 0 ? 0 : std::max(since, movement.seconds.back() + kLeastStep));
  }
  movement.poses = floor_outlook(movement.poses.front()).seen(std::move(movement.poses));
  return movement;
}

}  // namespace understudy
