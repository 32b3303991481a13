#include "retarget/body/builtin_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_body_plan.hpp"
#include "retarget/body/builtin_person.hpp"

namespace understudy {
namespace {

float wave(float phase) {
  return std::sin(2 * kPi * phase);
}

/// A walk or a jog: the same pattern with other figures.
struct Gait {
  float seconds, period, speed;  ///< speed in leg lengths / 0.8 a second
  float stance;                  ///< share of the period that a foot is on the floor
  float width, lift, heel_deg;
  float drop, bounce, bounce_phase, sway;
  float lean_deg, twist_deg, tilt_deg;
  float arm_deg, elbow_deg, elbow_swing_deg;
};

/// The left foot lands at phase 0, the right one at phase 0.5.
MotionPlan gait_plan(const Gait& g) {
  MotionPlan plan;
  plan.seconds = g.seconds;
  const auto landing = [g](int side, int k) {
    return (static_cast<float>(k) + 0.5f * static_cast<float>(side)) * g.period;
  };
  const auto place = [g, landing](int side, int k) {
    return g.speed * (landing(side, k) + 0.5f * g.stance * g.period) + 0.02f;
  };
  const int cycles = static_cast<int>(g.seconds / g.period) + 2;
  for (int side = 0; side < 2; ++side) {
    const float x = side == 0 ? g.width : -g.width, out = side == 0 ? 6.0f : -6.0f;
    plan.feet[side] = Vec3(x, out, place(side, -2));
    for (int k = -2; k < cycles; ++k)
      plan.steps.push_back({side, landing(side, k) + g.stance * g.period, landing(side, k + 1), x,
                            place(side, k + 1), out, g.lift, g.heel_deg});
  }
  plan.trunk = [g](float t) {
    const float phase = t / g.period;
    TrunkPlan p;
    p.z = g.speed * t + 0.008f * wave(2 * phase + 0.1f);
    p.x = g.sway * wave(phase - 0.02f);  // over the left foot in its stance, phase 0 to 0.5
    p.drop = g.drop + g.bounce * wave(2 * phase + g.bounce_phase);
    p.yaw = -g.twist_deg * wave(phase + 0.25f);  // the left hip is in front when the left foot lands
    p.pitch = 0.35f * g.lean_deg;
    p.roll = g.tilt_deg * wave(phase + 0.02f);  // the right hip hangs while the left foot carries
    p.spine_yaw = 1.9f * g.twist_deg * wave(phase + 0.25f);
    p.spine_pitch = 0.65f * g.lean_deg + 1.0f * wave(2 * phase);
    p.spine_roll = -1.3f * g.tilt_deg * wave(phase + 0.02f);
    p.head_yaw = -0.9f * g.twist_deg * wave(phase + 0.25f);
    p.head_pitch = -0.7f * g.lean_deg + 1.5f * wave(2 * phase + 0.2f);
    p.head_roll = 0.3f * g.tilt_deg * wave(phase);
    for (int side = 0; side < 2; ++side) {
      // against the leg of its side
      const float forward = wave(phase + (side == 0 ? -0.25f : 0.25f) - 0.03f);
      p.arms[side].swing = g.arm_deg * forward + (g.arm_deg > 30 ? -4.0f : 2.0f);
      p.arms[side].raise = 13;
      p.arms[side].elbow = g.elbow_deg + g.elbow_swing_deg * forward;
      p.arms[side].turn = g.elbow_deg > 50 ? -22.0f : -12.0f;
    }
    return p;
  };
  return plan;
}

MotionPlan walk_plan() {
  return gait_plan({5.0f, 1.14f, 0.98f, 0.60f, 0.075f, 0.115f, 46, 0.035f, 0.014f, -0.06f, 0.026f, 4, 7, 3.5f,
                    24, 18, 10});
}
MotionPlan jog_plan() {
  return gait_plan(
      {4.0f, 0.74f, 1.75f, 0.40f, 0.055f, 0.19f, 60, 0.060f, 0.034f, -0.02f, 0.014f, 11, 10, 4, 36, 84, 14});
}

MotionPlan throw_plan() {
  MotionPlan plan;
  plan.seconds = 4;
  plan.feet = {Vec3(.12f, 8, .04f), Vec3(-.12f, -14, -.04f)};
  plan.steps = {{0, 1.15f, 1.62f, .10f, .56f, 4, .17f, 25},     // the step into the throw
                {1, 2.02f, 2.50f, -.16f, .62f, -10, .13f, 50},  // the back foot follows
                {0, 2.85f, 3.25f, .12f, .66f, 8, .11f, 25}};
  plan.trunk = [](float t) {
    TrunkPlan p;
    p.z = keyed(t, {{.2f, 0}, {1.05f, -.075f}, {1.65f, .20f}, {2.0f, .40f}, {2.6f, .56f}, {3.4f, .63f}});
    p.x = keyed(t, {{.2f, 0}, {1.1f, -.085f}, {1.6f, -.01f}, {2.0f, .07f}, {2.7f, -.06f}, {3.4f, -.02f}});
    p.drop =
        .025f + keyed(t, {{.2f, 0}, {1.0f, .045f}, {1.4f, .03f}, {1.8f, .075f}, {2.3f, .05f}, {3.3f, 0}});
    p.yaw = keyed(t, {{.2f, 0}, {1.15f, -48}, {1.5f, -40}, {1.9f, 22}, {2.3f, 34}, {3.3f, 0}});
    p.pitch = keyed(t, {{.2f, 2}, {1.1f, -3}, {1.6f, -2}, {2.1f, 14}, {2.6f, 9}, {3.4f, 2}});
    p.roll = keyed(t, {{.4f, 0}, {1.1f, 4}, {1.9f, -5}, {2.6f, 0}});
    p.spine_yaw = keyed(t, {{.3f, 0}, {1.2f, -28}, {1.62f, -38}, {1.98f, 26}, {2.25f, 34}, {3.2f, 0}});
    p.spine_pitch = keyed(t, {{.3f, 3}, {1.2f, -9}, {1.65f, -14}, {2.05f, 22}, {2.4f, 26}, {3.3f, 3}});
    p.spine_roll = keyed(t, {{.5f, 0}, {1.4f, 9}, {1.8f, 4}, {2.05f, -14}, {2.5f, -8}, {3.3f, 0}});
    p.head_yaw = -0.85f * (p.yaw + p.spine_yaw);  // the eyes stay on the goal
    p.head_yaw = std::clamp(p.head_yaw, -65.0f, 65.0f);
    p.head_pitch = -0.6f * (p.pitch + p.spine_pitch);
    ArmPlan& l = p.arms[0];
    l.raise = keyed(t, {{.3f, 14}, {1.1f, 62}, {1.6f, 84}, {1.95f, 40}, {2.4f, 22}, {3.3f, 14}});
    l.across = keyed(t, {{.5f, 0}, {1.1f, 45}, {1.6f, 22}, {2.0f, -18}, {2.8f, 0}});
    l.elbow = keyed(t, {{.3f, 18}, {.9f, 78}, {1.55f, 14}, {2.0f, 92}, {2.6f, 45}, {3.4f, 18}});
    l.turn = keyed(t, {{.4f, -8}, {1.2f, -30}, {2.0f, -45}, {3.2f, -8}});
    ArmPlan& r = p.arms[1];
    r.raise = keyed(
        t,
        {{.3f, 14}, {.9f, 55}, {1.45f, 96}, {1.8f, 102}, {1.98f, 108}, {2.2f, 62}, {2.6f, 30}, {3.4f, 14}});
    r.across =
        keyed(t, {{.4f, 0}, {1.2f, -22}, {1.66f, -34}, {1.92f, 22}, {2.15f, 82}, {2.5f, 60}, {3.3f, 0}});
    r.elbow = keyed(
        t, {{.3f, 18}, {.9f, 80}, {1.5f, 98}, {1.75f, 100}, {1.95f, 32}, {2.1f, 14}, {2.6f, 50}, {3.4f, 18}});
    r.turn =
        keyed(t, {{.4f, -8}, {1.0f, 20}, {1.55f, 62}, {1.74f, 84}, {1.98f, 20}, {2.2f, -30}, {3.3f, -8}});
    r.wrist = keyed(t, {{1.2f, 0}, {1.75f, 32}, {2.02f, -38}, {2.6f, 0}});
    return p;
  };
  return plan;
}

MotionPlan kick_plan() {
  MotionPlan plan;
  plan.seconds = 4.2f;
  plan.feet = {Vec3(.11f, 6, 0), Vec3(-.11f, -6, 0)};
  plan.steps = {{0, .45f, .90f, .09f, .34f, 10, .12f, 40},
                {1,
                 1.02f,
                 2.02f,
                 -.13f,
                 .44f,
                 -6,
                 .12f,
                 45,
                 {Vec3(-.13f, .30f, -.42f), Vec3(-.10f, .36f, .34f), Vec3(-.04f, .68f, 1.04f),
                  Vec3(-.08f, .40f, .80f)}},
                {0, 2.45f, 2.90f, .11f, .47f, 6, .11f, 30}};
  plan.trunk = [](float t) {
    TrunkPlan p;
    p.z = keyed(t, {{.2f, 0}, {.9f, .22f}, {1.3f, .31f}, {1.65f, .36f}, {2.1f, .38f}, {2.9f, .45f}});
    p.x = keyed(
        t,
        {{.15f, 0}, {.5f, -.06f}, {.95f, .075f}, {1.75f, .085f}, {2.2f, -.01f}, {2.6f, -.085f}, {3.2f, 0}});
    p.drop = .022f + keyed(t, {{.3f, 0}, {1.1f, .06f}, {1.5f, .035f}, {2.1f, .05f}, {3.0f, 0}});
    p.yaw = keyed(t, {{.5f, 0}, {1.22f, -22}, {1.6f, 24}, {2.2f, 4}, {3, 0}});
    p.pitch = keyed(t, {{.3f, 2}, {1.2f, 9}, {1.55f, -13}, {1.8f, -6}, {2.4f, 2}});
    p.roll = keyed(t, {{.8f, 0}, {1.2f, -5}, {1.6f, -8}, {2.2f, 0}});
    p.spine_yaw = keyed(t, {{.5f, 0}, {1.24f, 30}, {1.6f, -34}, {2.3f, -4}, {3, 0}});
    p.spine_pitch = keyed(t, {{.4f, 3}, {1.2f, -12}, {1.58f, 24}, {2.0f, 10}, {3, 3}});
    p.spine_roll = keyed(t, {{.8f, 0}, {1.3f, 6}, {1.6f, 8}, {2.3f, 0}});
    p.head_yaw = -0.9f * (p.yaw + p.spine_yaw);
    p.head_pitch = -0.6f * (p.pitch + p.spine_pitch) + keyed(t, {{.3f, 0}, {1, 14}, {1.6f, 8}, {2.4f, 0}});
    ArmPlan& l = p.arms[0];  // opposite to the kicking leg
    l.raise = keyed(t, {{.4f, 14}, {1.2f, 58}, {1.6f, 48}, {2.2f, 24}, {3, 14}});
    l.swing = keyed(t, {{.4f, 0}, {.8f, -12}, {1.22f, -38}, {1.6f, 42}, {2.2f, 8}, {3, 0}});
    l.elbow = keyed(t, {{.4f, 18}, {1.2f, 32}, {1.6f, 48}, {2.4f, 25}, {3.2f, 18}});
    ArmPlan& r = p.arms[1];
    r.raise = keyed(t, {{.4f, 14}, {1.2f, 34}, {1.6f, 52}, {2.2f, 24}, {3, 14}});
    r.swing = keyed(t, {{.4f, 0}, {.8f, 16}, {1.22f, 34}, {1.6f, -36}, {2.2f, -6}, {3, 0}});
    r.elbow = keyed(t, {{.4f, 18}, {1.2f, 52}, {1.6f, 24}, {2.4f, 25}, {3.2f, 18}});
    l.turn = r.turn = -10;
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

MotionPlan jumping_jacks_plan() {
  constexpr float kPeriod = 1.1f;
  MotionPlan plan;
  plan.seconds = 4.4f;
  plan.feet = {Vec3(.07f, 5, 0), Vec3(-.07f, -5, 0)};
  for (int i = 0; i < 4; ++i)
    for (int half = 0; half < 2; ++half)
      for (int side = 0; side < 2; ++side) {
        const float start = (static_cast<float>(i) + .5f * static_cast<float>(half) + .11f) * kPeriod,
                    sign = side == 0 ? 1.0f : -1.0f;
        plan.steps.push_back({side, start, start + .36f * kPeriod, sign * (half == 0 ? .33f : .07f), 0,
                              sign * (half == 0 ? 16.0f : 5.0f), .10f, 26});
      }
  plan.trunk = [](float t) {
    const float b = t / kPeriod, open = .5f - .5f * std::cos(2 * kPi * (b - .04f));
    const float air = std::max(0.0f, wave(2 * b - .22f + .02f));
    TrunkPlan p;
    p.drop = .050f + .022f * wave(2 * b + .32f) - .085f * air;
    p.z = .006f * wave(2 * b);
    p.pitch = 3 + 2 * wave(2 * b);
    p.yaw = 2 * wave(b + .1f), p.spine_yaw = -3 * wave(b + .1f);
    p.roll = 1.2f * wave(b), p.spine_roll = -1.5f * wave(b);
    p.spine_pitch = 4 + 4 * wave(2 * b + .3f);
    p.head_pitch = -4 - 2 * wave(2 * b + .3f);
    for (ArmPlan& a : p.arms) {
      a.raise = 14 + 146 * open;
      a.elbow = 14 + 18 * wave(2 * b + .1f) * open * (1 - open) * 4 * .5f + 8;
      a.across = 10 * open;
      a.turn = 30 * open * (1 - open);
    }
    return p;
  };
  return plan;
}

}  // namespace

const std::vector<std::string>& builtin_motion_names() {
  static const std::vector<std::string> names = {"walk", "jog", "throw", "kick", "dance", "jumping_jacks"};
  return names;
}

Motion builtin_motion(const std::string& name, const Joints& rest, float fps) {
  US_CHECK(fps >= 5 && fps <= 240, "a built-in motion cannot be made at ", fps,
           " frames a second (5 to 240)");
  using Maker = MotionPlan (*)();
  constexpr Maker kMakers[] = {walk_plan, jog_plan, throw_plan, kick_plan, dance_plan, jumping_jacks_plan};
  const auto& names = builtin_motion_names();
  const auto found = std::find(names.begin(), names.end(), name);
  US_CHECK(found != names.end(), "no built-in motion is called ", name);
  return perform(kMakers[found - names.begin()](), rest, fps);
}

Motion builtin_motion(const std::string& name, float fps) {
  return builtin_motion(name, builtin_joints(), fps);
}

}  // namespace understudy
