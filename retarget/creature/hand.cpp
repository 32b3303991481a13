// A human hand with a piece of its forearm, fingers up and spread, its palm to the front.
#include <array>
#include <cmath>

#include "retarget/creature/forms.hpp"

namespace understudy {
namespace {

struct FingerShape {
  const char* name;
  Vec3 knuckle;      // from the wrist, of a hand 1 long
  float spread_deg;  // of the finger against straight up, to the thumb's side
  std::array<float, 3> bones;
  float radius;
};

const std::array<FingerShape, 4> kFingers = {{
    {"index", {0.155f, 0.50f, 0.005f}, 9, {0.205f, 0.125f, 0.105f}, 0.048f},
    {"middle", {0.048f, 0.52f, 0.01f}, 1, {0.225f, 0.145f, 0.11f}, 0.05f},
    {"ring", {-0.06f, 0.495f, 0.005f}, -8, {0.205f, 0.135f, 0.105f}, 0.047f},
    {"little", {-0.16f, 0.44f, -0.005f}, -19, {0.16f, 0.1f, 0.09f}, 0.041f},
}};
const std::array<const char*, 3> kPhalanges = {"_proximal", "_middle", "_distal"};

struct HandSizes {
  float long_fingers, stout, spread, side;  // side: 1 a right hand (its thumb at +x), -1 a left one
};

void add_finger(CreaturePlan& plan, const HandSizes& hand, const FingerShape& finger) {
  const Vec3 wrist = plan.at("wrist"), mirror(hand.side, 1, 1);
  const float aside = from_degrees(finger.spread_deg * hand.spread);
  const Vec3 way = Vec3(std::sin(aside), std::cos(aside), 0.06f).normalized().cwiseProduct(mirror);
  const Vec3 bend = Vec3(std::cos(aside), -std::sin(aside), 0).cwiseProduct(Vec3(1, hand.side, 1));
  Vec3 at = wrist + finger.knuckle.cwiseProduct(mirror);
  float r = finger.radius * hand.stout;
  plan.add("wrist",
           cone_part(wrist + Vec3(0.55f * finger.knuckle.x() * hand.side, 0.08f, 0), 0.075f, at - 0.03f * way,
                     1.12f * r),
           0.06f);
  std::string parent = "wrist";
  for (size_t i = 0; i < 3; ++i) {
    const std::string name = std::string(finger.name) + kPhalanges[i];
    plan.joint(name, parent, i == 0 ? JointKind::Ball : JointKind::Hinge, at, bend);
    const Vec3 next = at + finger.bones[i] * hand.long_fingers * way,
               end = i == 2 ? Vec3(next - 0.8f * r * way) : next;
    plan.add(name, cone_part(at, r, end, 0.92f * r), i == 0 ? 0.03f : 0.02f);
    parent = name;
    at = next;
    r *= 0.92f;
  }
}

void add_thumb(CreaturePlan& plan, const HandSizes& hand) {
  const Vec3 wrist = plan.at("wrist"), mirror(hand.side, 1, 1);
  const Vec3 way = Vec3(0.66f, 0.7f, 0.26f).normalized().cwiseProduct(mirror);
  const Vec3 bend = way.cross(Vec3(0.35f * hand.side, 0, -1)).normalized() * hand.side;
  const std::array<const char*, 3> names = {"thumb_metacarpal", "thumb_proximal", "thumb_distal"};
  const std::array<float, 3> bones = {0.2f, 0.16f, 0.13f}, radii = {0.085f, 0.06f, 0.055f};
  Vec3 at = wrist + Vec3(0.1f * hand.side, 0.09f, 0.03f);
  for (size_t i = 0; i < 3; ++i) {
    plan.joint(names[i], i == 0 ? "wrist" : names[i - 1], i == 0 ? JointKind::Ball : JointKind::Hinge, at,
               bend);
    const float r = radii[i] * hand.stout, to = i == 0 ? 0.065f * hand.stout : 0.9f * r;
    const Vec3 next = at + bones[i] * way;
    plan.add(names[i], cone_part(at, r, i == 2 ? Vec3(next - 0.8f * to * way) : next, to),
             i == 0 ? 0.06f : 0.02f);
    at = next;
  }
}

CreaturePlan hand_plan(Rng& rng) {
  const HandSizes hand{rng.uniform(0.92f, 1.1f), rng.uniform(0.9f, 1.08f), rng.uniform(0.95f, 1.15f),
                       rng.chance(0.5f) ? 1.0f : -1.0f};
  CreaturePlan plan;
  plan.mirrored = false;
  plan.scale = rng.uniform(0.17f, 0.21f);
  plan.cell = 0.0115f;
  plan.coarse_at = 0.05f;
  plan.finest = 0.7f;
  const Vec3 wrist(0, 0.36f, 0);
  plan.joint("wrist", "", JointKind::Free, wrist);
  const float side = hand.side;
  for (const float x : {0.055f, -0.055f}) {  // forearm
    plan.add("wrist", cone_part({1.1f * x, 0.11f, -0.005f}, 0.105f, {x, 0.34f, 0}, 0.085f), 0.05f);
  }
  for (const FingerShape& finger : kFingers) add_finger(plan, hand, finger);
  plan.add("wrist", ellipsoid_part(wrist + Vec3(-0.1f * side, 0.2f, 0.03f), {0.07f, 0.17f, 0.075f}), 0.06f);
  add_thumb(plan, hand);
  return plan;
}

void bend_finger(Puppet& puppet, const std::string& name, float bent) {
  const Rig& rig = puppet.rig();
  const Vec3 axis = rig.joints[static_cast<size_t>(puppet.joint(name + "_proximal"))].axis;
  puppet.turn(name + "_proximal", axis, 1.1f * bent);
  puppet.turn(name + "_middle", 1.35f * bent);
  puppet.turn(name + "_distal", 0.9f * bent);
}

void bend_thumb(Puppet& puppet, float bent) {
  const Vec3 up = puppet.rest("thumb_proximal") - puppet.rest("thumb_metacarpal");
  const float side = up.x() > 0 ? 1.0f : -1.0f;
  puppet.turn("thumb_metacarpal", Vec3::UnitY(), -0.55f * side * bent);
  puppet.turn("thumb_metacarpal", Vec3::UnitX(), 0.25f * bent);
  puppet.turn("thumb_proximal", 0.6f * bent);
  puppet.turn("thumb_distal", 0.8f * bent);
}

/// Closes around something and opens again.
Performance hand_grasps(const Rig&, Rng& rng) {
  const float period = rng.uniform(2.2f, 2.8f), firm = rng.uniform(0.8f, 1.0f),
              begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.turn("wrist", Vec3::UnitX(), 0.2f * wave(t, 1.3f * period));
    puppet.turn("wrist", Vec3::UnitY(), 0.3f * wave(t, 1.7f * period, 0.3f));
    float late = 0;
    for (const FingerShape& finger : kFingers) {
      bend_finger(puppet, finger.name, firm * (0.5f - 0.5f * std::cos(2 * kPi * (t - late) / period)));
      late += 0.07f;
    }
    bend_thumb(puppet, firm * (0.5f - 0.5f * std::cos(2 * kPi * (t - 0.25f) / period)));
  };
}

/// Each finger in its turn, as on a piano.
Performance hand_plays(const Rig&, Rng& rng) {
  const float period = rng.uniform(1.5f, 1.9f), deep = rng.uniform(0.5f, 0.65f),
              begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.turn("wrist", Vec3::UnitZ(), 0.25f * wave(t, 2.2f * period));
    puppet.turn("wrist", Vec3::UnitX(), 0.3f + 0.15f * wave(t, 1.6f * period));
    float order = 0.2f;
    bend_thumb(puppet, 0.3f + 0.4f * wave(t, period));
    for (const FingerShape& finger : kFingers) {
      bend_finger(puppet, finger.name, 0.1f + deep * std::pow(0.5f + 0.5f * wave(t, period, -order), 2.0f));
      order += 0.2f;
    }
  };
}

/// Counts: stretches one finger after the other out of the fist, then spreads and closes them.
Performance hand_counts(const Rig&, Rng& rng) {
  const float period = rng.uniform(4.2f, 5), begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.turn("wrist", Vec3::UnitY(), 0.35f * wave(t, 0.8f * period));
    bend_thumb(puppet, visiting(t, period, {0.9f, 0.9f, 0.9f, 0.1f, 0, 0.5f}));
    bend_finger(puppet, "index", visiting(t, period, {0, 0, 0, 0, 0, 0.85f}));
    bend_finger(puppet, "middle", visiting(t, period, {0.9f, 0, 0, 0, 0, 0.85f}));
    bend_finger(puppet, "ring", visiting(t, period, {0.9f, 0.8f, 0, 0, 0, 0.85f}));
    bend_finger(puppet, "little", visiting(t, period, {0.85f, 0.85f, 0.1f, 0, 0, 0.8f}));
  };
}

}  // namespace

CreatureForm hand_form() {
  return {hand_plan, {{"grasp", hand_grasps}, {"play", hand_plays}, {"count", hand_counts}}, {}};
}

}  // namespace understudy
