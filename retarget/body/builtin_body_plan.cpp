#include "retarget/body/builtin_body_plan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kDegrees = kPi / 180;

float smoother_step(float x, float from, float to) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * t * (t * (6 * t - 15) + 10);
}

Mat3 about(int axis, float angle_deg) {
  return rotation_from_axis_angle(Vec3(Vec3::Unit(axis) * (angle_deg * kDegrees)));
}
/// yaw about y, then pitch (forward) about x, then roll (to the person's right) about z.
Mat3 turn(float yaw, float pitch, float roll) {
  return about(1, yaw) * about(0, pitch) * about(2, roll);
}

/// Where one foot is at one moment.
struct FootState {
  Vec3 ball;  ///< world, metres
  float yaw_deg, heel_deg;
  bool planted;
  float toes_flat = 1;     ///< how far the toes undo the heel's angle
  float follows_shin = 0;  ///< 0: held level as planned, 1: hangs from the shin
};

class PlanPlayer {
 public:
  PlanPlayer(const MotionPlan& plan, const Joints& rest)
      : plan_(plan), rest_(rest), unit_(leg_length(rest) / 0.8f) {
    // The sole lies under the ball of the foot by about a quarter of the way from ankle to ball.
    gap_ = 0.235f * (rest(LeftAnkle, 1) - rest(LeftFoot, 1));
    standing_ = gap_ - rest(LeftFoot, 1);
  }

  Motion run(float fps) {
    Motion motion;
    motion.fps = fps;
    const int frames = static_cast<int>(std::lround(plan_.seconds * fps));
    const std::vector<float> heights = pelvis_heights(frames, fps);
    for (int i = 0; i < frames; ++i) motion.poses.push_back(pose(static_cast<float>(i) / fps, heights[i]));
    return motion;
  }

 private:
  Vec3 on_floor(float x, float z) const { return Vec3(x * unit_, gap_, z * unit_); }

  FootState foot(int side, float t) const {
    FootState state{on_floor(plan_.feet[side].x(), plan_.feet[side].z()), plan_.feet[side].y(), 0, true};
    for (const PlannedStep& step : plan_.steps) {
      if (step.side != side) continue;
      // The heel rises before the ball leaves.
      const float lead = 0.35f * (step.end - step.start);
      if (t > step.start - lead && t < step.start)
        state.heel_deg = step.heel_deg * 0.7f * smoother_step(t, step.start - lead, step.start);
      if (t < step.start) return state;
      const Vec3 to = on_floor(step.x, step.z);
      if (t < step.end) return in_the_air(step, state, to, (t - step.start) / (step.end - step.start));
      state = {to, step.yaw_deg, 0, true};
    }
    return state;
  }

  /// First up, then along, then down: near the floor a foot hardly moves along it.
  FootState in_the_air(const PlannedStep& step, const FootState& from, const Vec3& to, float s) const {
    FootState state = from;
    state.planted = false;
    const float along = smoother_step(s, 0.08f, 0.92f);
    state.ball = from.ball + along * (to - from.ball);
    const float up = smoother_step(s, -0.08f, 0.24f) - smoother_step(0, -0.08f, 0.24f);
    state.ball.y() += std::max(step.lift * unit_, 0.085f) * std::min(1.0f, 1.15f * up) *
                      (1 - smoother_step(s, 0.80f, 1.02f)) * (1 - 0.25f * smoother_step(s, 0.3f, 0.7f));
    state.yaw_deg = from.yaw_deg + along * (step.yaw_deg - from.yaw_deg);
    const float leaving = (0.7f + 0.5f * smoother_step(s, 0, 0.3f)) * (1 - smoother_step(s, 0.25f, 0.65f));
    state.heel_deg =
        step.heel_deg * leaving - 8 * smoother_step(s, 0.4f, 0.62f) * (1 - smoother_step(s, 0.62f, 0.86f));
    state.toes_flat = 1 - 0.6f * smoother_step(s, 0.06f, 0.35f);
    state.follows_shin = 0.25f * smoother_step(s, 0.08f, 0.25f) * (1 - smoother_step(s, 0.72f, 0.92f));
    return state;
  }

  Mat3 pelvis_rotation(const TrunkPlan& p) const { return turn(p.yaw, p.pitch, p.roll); }

  /// Ankle from the ball of the foot: the heel turns about the ball.
  Vec3 ankle(int side, const FootState& state) const {
    const Vec3 from_ball = (rest_.row(LeftAnkle + side) - rest_.row(LeftFoot + side)).transpose();
    return state.ball + about(1, state.yaw_deg) * about(0, state.heel_deg) * from_ball;
  }

  /// Planned heights, lowered where a planted foot would be out of reach, smoothed without ever rising again.
  std::vector<float> pelvis_heights(int frames, float fps) const {
    std::vector<float> limit(frames);
    for (int i = 0; i < frames; ++i) {
      const float t = static_cast<float>(i) / fps;
      const TrunkPlan p = plan_.trunk(t);
      limit[i] = standing_ - p.drop * unit_;
      for (int side = 0; side < 2; ++side) {
        const FootState state = foot(side, t);
        const Vec3 hip = pelvis_rotation(p) * Vec3(rest_.row(LeftHip + side).transpose());
        const Vec3 to = ankle(side, state) - Vec3(p.x * unit_, 0, p.z * unit_) - hip;
        const float reach = (state.planted ? 0.992f : 1.0f) * 0.998f * leg_length(rest_);
        const float flat = reach * reach - to.x() * to.x() - to.z() * to.z();
        if (state.planted || state.ball.y() < gap_ + 0.08f)
          limit[i] = std::min(limit[i], to.y() + std::sqrt(std::max(flat, 0.01f)));
      }
    }
    const int w = std::max(1, static_cast<int>(std::lround(0.07f * fps)));
    const auto window = [&](const std::vector<float>& in, int i, auto&& f) {
      for (int k = -w; k <= w; ++k) f(in[std::clamp(i + k, 0, frames - 1)]);
    };
    std::vector<float> low(frames), result(frames);
    for (int i = 0; i < frames; ++i) {
      low[i] = limit[i];
      window(limit, i, [&](float v) { low[i] = std::min(low[i], v); });
    }
    for (int i = 0; i < frames; ++i) {
      float sum = 0;
      window(low, i, [&](float v) { sum += v; });
      result[i] = sum / static_cast<float>(2 * w + 1);
    }
    return result;
  }

  Pose pose(float t, float height) const {
    const TrunkPlan p = plan_.trunk(t);
    Pose pose;
    pose.root = Vec3(p.x * unit_, height, p.z * unit_);
    pose.local[Pelvis] = pelvis_rotation(p);
    const Mat3 third = turn(p.spine_yaw / 3, p.spine_pitch / 3, p.spine_roll / 3);
    pose.local[Spine1] = pose.local[Spine2] = pose.local[Spine3] = third;
    pose.local[Neck] = turn(0.4f * p.head_yaw, 0.4f * p.head_pitch, 0.4f * p.head_roll);
    pose.local[Head] = turn(0.6f * p.head_yaw, 0.6f * p.head_pitch, 0.6f * p.head_roll);
    for (int side = 0; side < 2; ++side) {
      arm(p.arms[side], side, pose);
      leg(side, foot(side, t), pose);
    }
    return pose;
  }

  static void arm(const ArmPlan& a, int side, Pose& pose) {
    const Eigen::DiagonalMatrix<float, 3> flip(side ? -1.0f : 1.0f, 1.0f, 1.0f);
    const auto set = [&](int joint, const Mat3& left) { pose.local[joint + side] = flip * left * flip; };
    // the collar bone takes part above the shoulder
    const float shrug = 0.22f * std::max(a.raise - 60, 0.0f);
    set(LeftCollar, about(1, -0.15f * a.across) * about(2, shrug));
    set(LeftShoulder, about(1, -0.85f * a.across) * about(0, -a.swing) * about(2, a.raise - 90 - shrug) *
                          about(0, -a.turn));
    set(LeftElbow, about(1, -a.elbow));
    set(LeftWrist, about(2, a.wrist));
  }

  /// Rotation that takes the rest frame (bone, hinge along x) to the world's (bone, hinge).
  static Mat3 bone_rotation(const Vec3& rest_bone, const Vec3& bone, const Vec3& hinge) {
    const auto frame = [](const Vec3& along, const Vec3& axis) {
      Mat3 F;
      F.col(1) = along.normalized();
      F.col(0) = (axis - axis.dot(F.col(1)) * F.col(1)).normalized();
      F.col(2) = F.col(0).cross(F.col(1));
      return F;
    };
    return frame(bone, hinge) * frame(rest_bone, Vec3::UnitX()).transpose();
  }

  void leg(int side, const FootState& state, Pose& pose) const {
    const auto bone = [&](int from, int to) -> Vec3 {
      return (rest_.row(to + side) - rest_.row(from + side)).transpose();
    };
    const Vec3 thigh = bone(LeftHip, LeftKnee), shin = bone(LeftKnee, LeftAnkle);
    const float a = thigh.norm(), b = shin.norm();
    const Mat3& pelvis = pose.local[Pelvis];
    const Vec3 hip = pose.root + pelvis * Vec3(rest_.row(LeftHip + side).transpose());
    Vec3 to = ankle(side, state) - hip;
    const float c = std::clamp(to.norm(), std::abs(a - b) + 0.15f * a, 0.999f * (a + b));
    to.normalize();
    const Mat3 foot_turn = about(1, state.yaw_deg);
    const Vec3 forward = (foot_turn * Vec3::UnitZ() + 0.8f * pelvis * Vec3::UnitZ()).normalized();
    const Vec3 pole = (forward - forward.dot(to) * to).normalized();
    const float along = (a * a - b * b + c * c) / (2 * c);
    const Vec3 knee = along * to + std::sqrt(std::max(a * a - along * along, 0.0f)) * pole;
    const Vec3 hinge = pole.cross(to);
    const Mat3 R_hip = bone_rotation(thigh, knee, hinge), R_knee = bone_rotation(shin, c * to - knee, hinge);
    const Mat3 level = foot_turn * about(0, state.heel_deg), hanging = R_knee * about(0, 14);
    const Mat3 R_ankle =
        Eigen::Quaternionf(level).slerp(state.follows_shin, Eigen::Quaternionf(hanging)).toRotationMatrix();
    pose.local[LeftHip + side] = pelvis.transpose() * R_hip;
    pose.local[LeftKnee + side] = R_hip.transpose() * R_knee;
    pose.local[LeftAnkle + side] = R_knee.transpose() * R_ankle;
    // On the floor the toes stay flat while the heel rises.
    const float toes = -std::clamp(state.heel_deg, 0.0f, 45.0f) * state.toes_flat;
    pose.local[LeftFoot + side] = about(0, toes);
  }

  const MotionPlan& plan_;
  const Joints& rest_;
  float unit_, gap_ = 0, standing_ = 0;
};

}  // namespace

Motion perform(const MotionPlan& plan, const Joints& rest, float fps) {
  return PlanPlayer(plan, rest).run(fps);
}

float keyed(float t, std::initializer_list<std::pair<float, float>> keys) {
  const auto* k = keys.begin();
  const int last = keys.size() - 1;
  if (t <= k[0].first) return k[0].second;
  if (t >= k[last].first) return k[last].second;
  int i = 0;
  while (t > k[i + 1].first) ++i;
  const auto slope = [&](int n) {
    if (n <= 0 || n >= last) return 0.0f;
    const float before = k[n].second - k[n - 1].second, after = k[n + 1].second - k[n].second;
    if (before * after <= 0) return 0.0f;
    return 2 / ((k[n].first - k[n - 1].first) / before + (k[n + 1].first - k[n].first) / after);
  };
  const float d = k[i + 1].first - k[i].first, x = (t - k[i].first) / d, x2 = x * x, x3 = x2 * x;
  return (2 * x3 - 3 * x2 + 1) * k[i].second + (x3 - 2 * x2 + x) * d * slope(i) +
         (3 * x2 - 2 * x3) * k[i + 1].second + (x3 - x2) * d * slope(i + 1);
}

}  // namespace understudy
