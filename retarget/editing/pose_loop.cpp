#include "retarget/editing/pose_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/editing/pose_fill.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kShortest_s = 0.5f, kLongest_s = 20;  // of a loop
constexpr float kAlike_m = 0.1f;                      // that like moments differ by at most, leg 0.8 m
constexpr float kVelocity_s = 0.1f;                   // a difference of speed counts as that way of it
constexpr float kAboutAsLike = 1.25f;
constexpr float kContext_s = 0.8f;  // known frames on each side of a seam
constexpr float kLookedAt = 30;     // frames/s: of faster motions not every frame is compared first
constexpr float kStill = 0.05f;     // m/s, on average over joints: what moves less has no rounds

/// Takes one pose's place and heading on the floor to another's.
struct Carry {
  Mat3 turn = Mat3::Identity();
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();

  static Carry between(const Pose& a, const Pose& b) {
    Carry carry;
    carry.turn = rotation_about_y(heading_of(b.local[Pelvis]) - heading_of(a.local[Pelvis]));
    carry.from = Vec3(a.root.x(), 0, a.root.z()), carry.to = Vec3(b.root.x(), 0, b.root.z());
    return carry;
  }
  Pose there(Pose pose) const {
    pose.root = to + turn * (pose.root - from);
    pose.local[Pelvis] = turn * pose.local[Pelvis];
    return pose;
  }
  Pose back(Pose pose) const {
    pose.root = from + turn.transpose() * (pose.root - to);
    pose.local[Pelvis] = turn.transpose() * pose.local[Pelvis];
    return pose;
  }
};

/// A frame seen from its own place on the floor and heading.
struct Moment {
  Joints joints, velocity;  // metres; metres in kVelocity_s
  float speed = 0;          // m/s, mean over joints
};

std::vector<Moment> moments_of(const Motion& motion, const Joints& rest) {
  std::vector<Joints> joints;
  for (const Pose& pose : motion.poses) joints.push_back(forward_kinematics(rest, pose).joints);
  const int last = ssize(joints) - 1;
  std::vector<Moment> moments(joints.size());
  for (int t = 0; t <= last; ++t) {
    const Pose& pose = motion.poses[t];
    const Mat3 seen = rotation_about_y(-heading_of(pose.local[Pelvis]));
    const int before = std::max(0, t - 1), after = std::min(last, t + 1);
    const float seconds = static_cast<float>(std::max(1, after - before)) / motion.fps;
    const Joints velocity = (joints[after] - joints[before]) / seconds;
    const Vec3 place(pose.root.x(), 0, pose.root.z());
    moments[t].joints = (joints[t].rowwise() - place.transpose()) * seen.transpose();
    moments[t].velocity = kVelocity_s * velocity * seen.transpose();
    moments[t].speed = velocity.rowwise().norm().mean();
  }
  return moments;
}

/// Compares moments of a motion.
class LikeMoments {
 public:
  LikeMoments(const Motion& motion, const Joints& rest, int first, int last)
      : motion_(motion),
        moments_(moments_of(motion, rest)),
        first_(first),
        last_(last),
        leg_(leg_length(rest) / 0.8f) {
    moved_.push_back(0);
    for (const Moment& moment : moments_) moved_.push_back(moved_.back() + moment.speed / motion.fps);
  }

  LoopEdit best() const {
    const int step = std::max(1, static_cast<int>(std::lround(motion_.fps / kLookedAt)));
    const float least = least_of_all(step);
    US_CHECK(least <= kAlike_m * leg_, "no two moments of frames ", first_, " to ", last_,
             " are alike: there is no loop in them");
    const LoopEdit rough = shortest(kAboutAsLike * least + 0.005f * leg_, step);
    return step == 1 ? rough : nearest(rough, step);
  }

 private:
  int shortest_frames() const { return std::max(5, static_cast<int>(std::ceil(kShortest_s * motion_.fps))); }
  int longest_frames() const { return static_cast<int>(kLongest_s * motion_.fps); }
  bool something_moves(int a, int b) const {
    const float still = kStill * leg_;
    const auto mean = [&](int from, int to) {
      return (moved_[to] - moved_[from]) * motion_.fps / static_cast<float>(to - from);
    };
    return mean(a, b) >= still || mean(first_, last_ + 1) < still;
  }
  float difference(int a, int b) const {
    constexpr float kNever = std::numeric_limits<float>::max();
    if (!motion_.standing.empty() && motion_.standing[a] != motion_.standing[b]) return kNever;
    const Moment &one = moments_[a], &other = moments_[b];
    const float apart = (one.joints - other.joints).rowwise().norm().mean();
    return apart + (one.velocity - other.velocity).rowwise().norm().mean();
  }

  template <class Each>
  void all_pairs(int step, const Each& each) const {
    for (int a = first_; a <= last_; a += step)
      for (int b = a + shortest_frames(); b <= std::min(last_, a + longest_frames()); b += step) each(a, b);
  }
  float least_of_all(int step) const {
    float least = std::numeric_limits<float>::max();
    all_pairs(step, [&](int a, int b) {
      if (something_moves(a, b)) least = std::min(least, difference(a, b));
    });
    return least;
  }
  /// Of those that differ by no more; of equally long ones the most alike.
  LoopEdit shortest(float most, int step) const {
    LoopEdit best;
    float least = 0;
    all_pairs(step, [&](int a, int b) {
      const bool longer = best.last > 0 && b - a > best.last - best.first;
      if (longer || !something_moves(a, b)) return;
      const float now = difference(a, b);
      if (now > most || (best.last > 0 && b - a == best.last - best.first && now >= least)) return;
      best.first = a, best.last = b, least = now;
    });
    return best;
  }
  /// The best of the pairs around one.
  LoopEdit nearest(const LoopEdit& rough, int step) const {
    LoopEdit best = rough;
    float least = difference(rough.first, rough.last);
    for (int a = std::max(first_, rough.first - step); a <= rough.first + step; ++a)
      for (int b = rough.last - step; b <= std::min(last_, rough.last + step); ++b)
        if (const float now = difference(a, b); now < least) least = now, best.first = a, best.last = b;
    return best;
  }

  const Motion& motion_;
  std::vector<Moment> moments_;
  int first_, last_;
  float leg_;                 // against 0.8 m
  std::vector<float> moved_;  // metres up to each frame, mean over joints
};

void check(const LoopEdit& edit, const Motion& motion) {
  US_CHECK(edit.first >= 0 && edit.last < ssize(motion.poses) && edit.last - edit.first >= 4, "frames ",
           edit.first, " to ", edit.last, " are no loop of a motion with frames 0 to ",
           ssize(motion.poses) - 1);
}

}  // namespace

LoopEdit find_loop(const Motion& motion, const Joints& rest, int first, int last) {
  US_CHECK(first >= 0 && last < ssize(motion.poses), "there are no frames ", first, " to ", last, " among ",
           motion.poses.size());
  return LikeMoments(motion, rest, first, last).best();
}

LoopTravel travel_of(const LoopEdit& edit, const Motion& motion) {
  check(edit, motion);
  const Carry round = Carry::between(motion.poses[edit.first], motion.poses[edit.last]);
  return {(round.to - round.from).norm(), heading_of(round.turn) * 180 / kPi};
}

int seam_frames(const LoopEdit& edit, double fps) {
  const int wanted = static_cast<int>(std::lround(static_cast<double>(edit.seam_s) * fps));
  return std::min(wanted, (edit.last - edit.first) / 4);
}

void close_loop(const LoopEdit& edit, const Joints& rest, MotionSpace* space, Motion& motion) {
  check(edit, motion);
  const int seam = seam_frames(edit, motion.fps), length = edit.last - edit.first;
  const int context = std::min(length - seam, seam + static_cast<int>(std::lround(kContext_s * motion.fps)));
  const Carry round = Carry::between(motion.poses[edit.first], motion.poses[edit.last]);
  if (motion.doubt_m.empty()) motion.doubt_m.resize(motion.poses.size());
  if (seam > 0) {
    Motion strip;  // the end, and after it the start as it goes on there
    strip.fps = motion.fps;
    for (int i = -context; i < context; ++i) {
      const int t = i < 0 ? edit.last + i : edit.first + i;
      strip.poses.push_back(i < 0 ? motion.poses[t] : round.there(motion.poses[t]));
      if (!motion.standing.empty()) strip.standing.push_back(motion.standing[t]);
    }
    fill_frames({{context - seam, context + seam - 1, edit.learned}}, rest, space, strip);
    for (int i = -seam; i < seam; ++i) {
      const int t = i < 0 ? edit.last + i : edit.first + i, at = context + i;
      motion.poses[t] = i < 0 ? strip.poses[at] : round.back(strip.poses[at]);
      motion.doubt_m[t] = std::max(motion.doubt_m[t], strip.doubt_m[at]);
      if (!motion.standing.empty()) motion.standing[t] = strip.standing[at];
    }
  }
  motion.poses[edit.last] = round.there(motion.poses[edit.first]);
  motion.doubt_m[edit.last] = std::max(motion.doubt_m[edit.last], motion.doubt_m[edit.first]);
  if (!motion.standing.empty()) motion.standing[edit.last] = motion.standing[edit.first];
}

}  // namespace understudy
