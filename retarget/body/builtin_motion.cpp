#include "retarget/body/builtin_motion.hpp"

#include <array>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_body_plan.hpp"

namespace understudy {
namespace {

float wave(float phase) {
  return std::sin(2 * kPi * phase);
}

/// The left foot lands at phase 0, the right one at phase 0.5.
MotionPlan walk_plan() {
  constexpr float kPeriod = 1.14f, kSpeed = 0.98f;      // seconds; leg lengths / 0.8 a second
  constexpr float kStance = 0.60f;                      // share of the period that a foot is on the floor
  constexpr float kLean = 4, kTwist = 7, kTilt = 3.5f;  // degrees
  MotionPlan plan;
  plan.seconds = 5;
  const auto landing = [](int side, int k) {
    return (static_cast<float>(k) + 0.5f * static_cast<float>(side)) * kPeriod;
  };
  const auto place = [landing](int side, int k) {
    return kSpeed * (landing(side, k) + 0.5f * kStance * kPeriod) + 0.02f;
  };
  const int cycles = static_cast<int>(plan.seconds / kPeriod) + 2;
  for (int side = 0; side < 2; ++side) {
    const float x = side == 0 ? 0.075f : -0.075f, out = side == 0 ? 6.0f : -6.0f;
    plan.feet[side] = Vec3(x, out, place(side, -2));
    for (int k = -2; k < cycles; ++k)
      plan.steps.push_back({side, landing(side, k) + kStance * kPeriod, landing(side, k + 1), x,
                            place(side, k + 1), out, 0.115f, 46});
  }
  plan.trunk = [](float t) {
    const float phase = t / kPeriod;
    TrunkPlan p;
    p.z = kSpeed * t + 0.008f * wave(2 * phase + 0.1f);
    p.x = 0.026f * wave(phase - 0.02f);  // over the left foot in its stance, phase 0 to 0.5
    p.drop = 0.035f + 0.014f * wave(2 * phase - 0.06f);
    p.yaw = -kTwist * wave(phase + 0.25f);  // the left hip is in front when the left foot lands
    p.pitch = 0.35f * kLean;
    p.roll = kTilt * wave(phase + 0.02f);  // the right hip hangs while the left foot carries
    p.spine_yaw = 1.9f * kTwist * wave(phase + 0.25f);
    p.spine_pitch = 0.65f * kLean + 1.0f * wave(2 * phase);
    p.spine_roll = -1.3f * kTilt * wave(phase + 0.02f);
    p.head_yaw = -0.9f * kTwist * wave(phase + 0.25f);
    p.head_pitch = -0.7f * kLean + 1.5f * wave(2 * phase + 0.2f);
    p.head_roll = 0.3f * kTilt * wave(phase);
    for (int side = 0; side < 2; ++side) {
      // against the leg of its side
      const float forward = wave(phase + (side == 0 ? -0.25f : 0.25f) - 0.03f);
      p.arms[side] = {24 * forward + 2, 13, 0, 18 + 10 * forward, -12};
    }
    return p;
  };
  return plan;
}

/// The arms at beat b: in turn to the chest, a wave from hand to hand, one arm high, at rest at both ends.
void dance_arms(std::array<ArmPlan, 2>& arms, float b) {
  for (int side = 0; side < 2; ++side) {
    ArmPlan& a = arms[side];
    const float o = side == 0 ? 0.0f : 0.5f;  // of a two-beat round: the arms alternate
    const float up = .5f + .5f * wave(.5f * b + o);
    a.raise = 34 + 46 * up;
    a.across = 26 + 24 * wave(.5f * b + o + .15f);
    a.elbow = 72 + 34 * wave(b + o + .2f);
    a.turn = -18 + 42 * up;
    a.wrist = 18 * wave(b + o);
  }
  // The wave from hand to hand in beats 4 to 6, one arm high in beats 7 and 8.
  const float open = keyed(b, {{3.6f, 0}, {4.3f, 1}, {6.1f, 1}, {6.7f, 0}});
  for (int side = 0; side < 2; ++side) {
    ArmPlan& a = arms[side];
    const float run = .5f * (b - 4) + (side == 0 ? 0.0f : -.35f);
    const auto towards = [open](float& v, float goal) { v += open * (goal - v); };
    towards(a.raise, 84 + 20 * wave(run));
    towards(a.across, 4);
    towards(a.elbow, 22 + 16 * wave(run - .12f));
    towards(a.turn, 50 * wave(run - .05f));
    towards(a.wrist, 26 * wave(run - .25f));
  }
  const float high = keyed(b, {{6.5f, 0}, {7.3f, 1}, {8.2f, 1}, {9, 0}});
  arms[0].raise += high * (152 - arms[0].raise);
  arms[0].elbow += high * (20 - arms[0].elbow);
  arms[0].across += high * (10 - arms[0].across);
  const float rest = keyed(b, {{0, 1}, {.9f, 0}, {9, 0}, {9.9f, 1}});
  for (ArmPlan& a : arms) {
    a.raise += rest * (24 - a.raise), a.across += rest * (5 - a.across);
    a.elbow += rest * (40 - a.elbow), a.turn += rest * (-12 - a.turn);
  }
}

/// Side steps and turns on the beat with a bounce, an arm wave, a chest roll. 100 beats a minute.
MotionPlan dance_plan() {
  constexpr float kBeat = 0.6f;
  MotionPlan plan;
  plan.seconds = 6;
  plan.feet = {Vec3(.14f, 12, 0), Vec3(-.14f, -12, 0)};
  const auto step = [&plan](float beat, int side, float x, float z, float yaw, float lift = .13f) {
    plan.steps.push_back({side, (beat + .05f) * kBeat, (beat + .72f) * kBeat, x, z, yaw, lift, 38});
  };
  step(1, 1, -.42f, .02f, -24), step(2, 0, -.10f, .04f, 4), step(3, 0, .32f, .02f, 24),
      step(4, 1, .02f, .05f, -4);
  step(5, 0, .40f, .16f, 34, .2f), step(6, 1, -.16f, .26f, -8, .2f), step(7, 1, -.24f, -.16f, -34, .18f);
  step(8, 0, .13f, -.06f, 12), step(9, 1, -.14f, -.06f, -12);
  plan.trunk = [](float t) {
    const float b = t / kBeat;
    TrunkPlan p;
    p.x = keyed(b, {{.4f, 0},
                    {1, .07f},
                    {1.9f, -.27f},
                    {2.9f, -.13f},
                    {3.9f, .19f},
                    {4.8f, .19f},
                    {5.9f, .22f},
                    {6.7f, .14f},
                    {7.5f, .12f},
                    {8.3f, -.13f},
                    {9.1f, .05f},
                    {9.8f, 0}});
    p.z = keyed(
        b, {{1, 0}, {4.5f, .02f}, {5.9f, .10f}, {6.8f, .18f}, {7.8f, .04f}, {8.8f, -.08f}, {9.8f, -.05f}});
    p.drop =
        .060f + .032f * wave(b + .25f) + keyed(b, {{4, 0}, {5.7f, .05f}, {6.5f, .02f}, {7.6f, .05f}, {9, 0}});
    p.yaw = 9 * wave(.5f * b) +
            keyed(b, {{0, 0}, {1.8f, -16}, {3.8f, 20}, {5.7f, 30}, {6.8f, 4}, {7.8f, -28}, {9.3f, 0}});
    p.pitch = 5 + 4 * wave(b + .1f);
    p.roll = 7 * wave(.5f * b + .25f);
    p.spine_yaw = -22 * wave(.5f * b + .05f) - .5f * keyed(b, {{0, 0}, {5.7f, 26}, {7.8f, -26}, {9.3f, 0}});
    p.spine_pitch =
        9 + 9 * wave(b - .15f) + keyed(b, {{4.4f, 0}, {5.6f, 10}, {6.6f, -8}, {7.5f, 10}, {9, 0}});
    p.spine_roll = -13 * wave(.5f * b + .32f);
    p.head_yaw = -.6f * (p.yaw + p.spine_yaw) + 10 * wave(.25f * b);
    p.head_pitch = -6 + 8 * wave(b - .30f) - .3f * p.spine_pitch;
    p.head_roll = 8 * wave(.5f * b + .1f);
    dance_arms(p.arms, b);
    return p;
  };
  return plan;
}

}  // namespace

Motion builtin_motion(const std::string& name, const Joints& rest, float fps) {
  US_CHECK(fps >= 5 && fps <= 240, "a built-in motion cannot be made at ", fps,
           " frames a second (5 to 240)");
  US_CHECK(name == "walk" || name == "dance", "no built-in motion is called ", name);
  return perform(name == "walk" ? walk_plan() : dance_plan(), rest, fps);
}

}  // namespace understudy
