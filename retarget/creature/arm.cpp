// A robot arm on a foot: it turns, leans, bends, and grasps with two fingers.
#include <cmath>

#include "retarget/creature/forms.hpp"

namespace understudy {
namespace {

struct ArmSizes {
  float upper, fore, stout, finger;
};

void arm_joints(CreaturePlan& plan, const ArmSizes& arm) {
  const Vec3 shoulder(0, 0.29f, 0);
  const Vec3 elbow = shoulder + arm.upper * Vec3(0, 0.97f, -0.24f);
  const Vec3 ahead = Vec3(0, -0.3f, 0.95f).normalized();
  const Vec3 wrist = elbow + arm.fore * ahead, roll = wrist + 0.1f * ahead;
  const Vec3 up = ahead.cross(Vec3::UnitX());
  plan.joint("base", "", JointKind::Free, Vec3::Zero());
  plan.joint("turret", "base", JointKind::Hinge, Vec3(0, 0.12f, 0), Vec3::UnitY());
  plan.joint("shoulder", "turret", JointKind::Hinge, shoulder);
  plan.joint("elbow", "shoulder", JointKind::Hinge, elbow);
  plan.joint("wrist_pitch", "elbow", JointKind::Hinge, wrist);
  plan.joint("wrist_roll", "wrist_pitch", JointKind::Hinge, roll, ahead);
  const Vec3 palm = roll + 0.075f * ahead;
  plan.joint("left_finger", "wrist_roll", JointKind::Hinge, palm + 0.055f * Vec3::UnitX(), up);
  plan.joint("right_finger", "wrist_roll", JointKind::Hinge, palm - 0.055f * Vec3::UnitX(), -up);
}

/// A joint's housing: a drum along x.
void arm_drum(CreaturePlan& plan, const std::string& owner, const std::string& at, float half, float radius) {
  const Vec3 x = half * Vec3::UnitX();
  plan.add(owner, frustum_part(plan.at(at) - x, radius, plan.at(at) + x, radius, 0.012f));
}

void arm_hand(CreaturePlan& plan, const ArmSizes& arm) {
  const Vec3 roll = plan.at("wrist_roll"), ahead = (roll - plan.at("wrist_pitch")).normalized();
  const Mat3 frame = frame_along(ahead, Vec3::UnitX());
  plan.add("wrist_roll", frustum_part(roll - 0.02f * ahead, 0.05f, roll + 0.05f * ahead, 0.05f, 0.01f));
  plan.add("wrist_roll", box_part(roll + 0.06f * ahead, {0.085f, 0.034f, 0.024f}, 0.01f, frame));
  for (const float side : {1.0f, -1.0f}) {
    const std::string name = side > 0 ? "left_finger" : "right_finger";
    const Vec3 x = side * Vec3::UnitX(), from = plan.at(name), knuckle = from + 0.03f * x + 0.09f * ahead;
    const BladeShape shape{frame.col(1), 0.026f};
    plan.add(name, blade_part(from, 0.024f, knuckle, 0.02f, shape));
    plan.add(name, blade_part(knuckle, 0.02f, knuckle - 0.02f * x + arm.finger * ahead, 0.014f, shape));
  }
}

CreaturePlan arm_plan(Rng& rng) {
  const ArmSizes arm{rng.uniform(0.4f, 0.55f), rng.uniform(0.34f, 0.46f), rng.uniform(0.9f, 1.15f),
                     rng.uniform(0.07f, 0.1f)};
  CreaturePlan plan;
  plan.machine = true;
  plan.scale = rng.uniform(0.8f, 1.3f);
  arm_joints(plan, arm);
  const float s = arm.stout;
  plan.add("base", meshed_as(0.05f, frustum_part({0, 0, 0}, 0.22f, {0, 0.05f, 0}, 0.21f, 0.015f)));
  plan.add("base", frustum_part({0, 0.02f, 0}, 0.15f, {0, 0.12f, 0}, 0.13f, 0.012f));
  plan.add("turret", frustum_part({0, 0.12f, 0}, 0.15f, {0, 0.19f, 0}, 0.14f, 0.015f));
  plan.add("turret", box_part({0, 0.23f, 0}, {0.1f * s, 0.1f, 0.08f}, 0.02f));
  arm_drum(plan, "turret", "shoulder", 0.12f * s, 0.095f);
  const BladeShape wide{Vec3::UnitX(), 0.065f * s}, narrow{Vec3::UnitX(), 0.045f * s};
  plan.add("shoulder", blade_part(plan.at("shoulder"), 0.075f, plan.at("elbow"), 0.06f, wide));
  arm_drum(plan, "shoulder", "elbow", 0.09f * s, 0.075f);
  plan.add("elbow", blade_part(plan.at("elbow"), 0.055f, plan.at("wrist_pitch"), 0.038f, narrow));
  arm_drum(plan, "elbow", "wrist_pitch", 0.06f * s, 0.046f);
  plan.add("wrist_pitch", cone_part(plan.at("wrist_pitch"), 0.034f, plan.at("wrist_roll"), 0.034f));
  arm_hand(plan, arm);
  return plan;
}

void open_fingers(Puppet& puppet, float angle) {
  puppet.turn("left_finger", angle);
  puppet.turn("right_finger", angle);
}

/// Fetches something on its left and puts it down on its right.
Performance arm_fetches(const Rig&, Rng& rng) {
  const float period = rng.uniform(4.0f, 5.0f), far = from_degrees(rng.uniform(28, 36)),
              low = from_degrees(rng.uniform(24, 32)), begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.turn("turret", far * wave(t, period));
    puppet.turn("shoulder", 0.3f * low - 0.6f * low * wave(t, 0.5f * period, 0.25f));
    puppet.turn("elbow", -0.15f - 0.28f * wave(t, 0.5f * period, 0.2f));
    puppet.turn("wrist_pitch", 0.45f + 0.3f * wave(t, 0.5f * period, 0.3f));
    puppet.turn("wrist_roll", 0.7f * wave(t, period, 0.2f));
    open_fingers(puppet, visiting(t, period, {0.4f, -0.05f, -0.05f, 0.3f}));
  };
}

/// Moves all its joints at once, each at its own pace.
Performance arm_exercises(const Rig&, Rng& rng) {
  const float pace = rng.uniform(0.85f, 1.05f), begin = rng.uniform(0, 10);
  return [=](Puppet& puppet, float seconds) {
    const float t = pace * seconds + begin;
    puppet.turn("turret", 0.5f * wave(t, 4.6f));
    puppet.turn("shoulder", 0.08f + 0.22f * wave(t, 3.1f, 0.2f));
    puppet.turn("elbow", 0.3f * wave(t, 3.6f, 0.6f) - 0.12f);
    puppet.turn("wrist_pitch", 0.5f * wave(t, 2.7f, 0.1f));
    puppet.turn("wrist_roll", wave(t, 3.3f, 0.4f));
    open_fingers(puppet, 0.18f + 0.22f * wave(t, 1.7f));
  };
}

}  // namespace

CreatureForm arm_form() {
  return {arm_plan, {{"fetch", arm_fetches}, {"exercise", arm_exercises}}, {}, false};
}

}  // namespace understudy
