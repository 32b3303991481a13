#include "retarget/motion_space/knot_coder.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kKnots = 20, kOfKnot = kJointCount * 6 + 3 + 1;
constexpr float kLongest_s = 10;

class KnotCoder final : public MotionCoder {
 public:
  int size() const override { return kKnots * kOfKnot; }
  std::string name() const override { return "plain"; }

  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    US_CHECK(movement.duration() <= kLongest_s, "a movement of ", movement.duration(),
             " s is too long to be coded: ", kLongest_s, " s is the most");
    const std::vector<Pose> knots = sampled_evenly(movement, kKnots);
    const float leg = leg_length(rest);
    MotionCode code;
    for (int k = 0; k < kKnots; ++k) {
      for (const Mat3& R : knots[k].local) {
        const Vec6 r = rotation_to_6d(R);
        code.mean.insert(code.mean.end(), r.begin(), r.end());
      }
      for (const float metres : knots[k].root) code.mean.push_back(metres / leg);
      code.mean.push_back(movement.duration() * static_cast<float>(k) / (kKnots - 1));
    }
    return code;
  }

  TimedPoses decode(const std::vector<float>& code, const Joints& rest) override {
    US_CHECK(ssize(code) == size(), "a code of ", code.size(), " numbers, not ", size());
    US_CHECK(std::all_of(code.begin(), code.end(), [](float x) { return std::isfinite(x); }),
             "a code that is not finite");
    const float leg = leg_length(rest);
    TimedPoses movement;
    for (int k = 0; k < kKnots; ++k) {
      const float* at = code.data() + static_cast<ptrdiff_t>(k) * kOfKnot;
      Pose& pose = movement.poses.emplace_back();
      for (int j = 0; j < kJointCount; ++j, at += 6)
        pose.local[j] = rotation_from_6d(Eigen::Map<const Vec6>(at));
      pose.root = leg * Eigen::Map<const Vec3>(at);
      movement.seconds.push_back(at[3]);
    }
    return movement;
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
  for (int i = 0; i < count; ++i)
    samples.push_back(pose_at(movement, times[0] + (times.back() - times[0]) * static_cast<float>(i) /
                                                       static_cast<float>(count - 1)));
  return samples;
}

}  // namespace understudy
