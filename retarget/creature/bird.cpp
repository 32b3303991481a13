// A bird with its wings spread: it flies on the spot, struts, and shakes its feathers.
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "retarget/creature/forms.hpp"
#include "retarget/creature/gait.hpp"

namespace understudy {
namespace {

struct ChordPair {
  float from, to;  // half as deep as the wing there
};

struct BirdSizes {
  float span, chord, leg, neck, beak, tail;
};

void bird_trunk(CreaturePlan& plan, const BirdSizes& size) {
  const float h = size.leg + 0.1f;
  plan.joint("body", "", JointKind::Free, Vec3(0, h, 0));
  const Vec3 neck(0, h + 0.07f, 0.17f), way = Vec3(0, 0.82f, 0.57f), head = neck + size.neck * way;
  plan.joint("neck", "body", JointKind::Ball, neck);
  plan.joint("upper_neck", "neck", JointKind::Ball, neck + 0.5f * size.neck * way);
  plan.joint("head", "upper_neck", JointKind::Ball, head);
  plan.joint("tail", "body", JointKind::Ball, Vec3(0, h + 0.015f, -0.22f));
  const Mat3 frame = frame_along({0, 0.22f, 1}, Vec3::UnitX());
  plan.add("body", ellipsoid_part({0, h, 0}, {0.125f, 0.125f, 0.24f}, frame));
  plan.add("body", cone_part({0, h, -0.12f}, 0.07f, {0, h + 0.01f, -0.22f}, 0.045f), 0.05f);
  plan.add("neck", cone_part(neck, 0.075f, plan.at("upper_neck"), 0.055f), 0.05f);
  plan.add("upper_neck", cone_part(plan.at("upper_neck"), 0.055f, head, 0.05f), 0.03f);
  const Vec3 skull = head + Vec3(0, 0.03f, 0.025f);
  plan.add("head", ellipsoid_part(skull, {0.066f, 0.068f, 0.08f}), 0.02f);
  plan.add(
      "head",
      cone_part(skull + Vec3(0, -0.01f, 0.05f), 0.03f, skull + Vec3(0, -0.03f, 0.08f + size.beak), 0.012f),
      0.012f);
  const Vec3 fan(0, h - 0.005f, -0.24f - size.tail);
  for (const float x : {-0.075f, 0.0f, 0.075f})
    plan.add("tail",
             blade_part(plan.at("tail"), 0.04f, fan + Vec3(x, 0, 0.5f * std::abs(x)), 0.055f,
                        {Vec3::UnitY(), 0.02f}),
             0.012f);
}

/// A piece of wing between two joints: the arm in front, feathers behind it.
void bird_wing_piece(CreaturePlan& plan, const std::string& name, const Vec3& to, const ChordPair& chord) {
  const Vec3 from = plan.at(name), behind(0, -0.008f, -1);
  plan.add(name, cone_part(from, 0.028f, to, 0.022f), 0.015f);
  plan.add(name,
           blade_part(from + (chord.from - 0.02f) * behind, chord.from, to + (chord.to - 0.02f) * behind,
                      chord.to, {Vec3::UnitY(), 0.017f}),
           0.012f);
}

void bird_wing(CreaturePlan& plan, const BirdSizes& size, float side) {
  const std::string of = side > 0 ? "left_" : "right_";
  const float h = size.leg + 0.1f, s = size.span, c = size.chord;
  const auto at = [&](float x, float y, float z) { return Vec3(side * x, h + y, z); };
  plan.joint(of + "shoulder", "body", JointKind::Ball, at(0.09f, 0.075f, 0.1f));
  plan.joint(of + "elbow", of + "shoulder", JointKind::Hinge, at(0.09f + 0.24f * s, 0.115f, 0.07f),
             Vec3(0, 0, 1));
  plan.joint(of + "wrist", of + "elbow", JointKind::Hinge, at(0.09f + 0.48f * s, 0.125f, 0.11f),
             Vec3(0, 0, 1));
  bird_wing_piece(plan, of + "shoulder", plan.at(of + "elbow"), {0.125f * c, 0.135f * c});
  bird_wing_piece(plan, of + "elbow", plan.at(of + "wrist"), {0.135f * c, 0.12f * c});
  const Vec3 wrist = plan.at(of + "wrist"), tip = at(0.09f + 0.86f * s, 0.115f, 0.0f);
  bird_wing_piece(plan, of + "wrist", wrist + 0.4f * (tip - wrist), {0.12f * c, 0.09f * c});
  const Vec3 root = wrist + Vec3(side * 0.05f, 0, -0.09f * c);
  for (int feather = 0; feather < 4; ++feather) {
    const auto f = static_cast<float>(feather);
    const Vec3 end = tip + Vec3(-side * 0.085f * f * s, 0, -0.09f * f * c);
    plan.add(of + "wrist", blade_part(root, 0.05f, end, 0.028f, {Vec3::UnitY(), 0.017f}), 0.01f);
  }
}

void bird_leg(CreaturePlan& plan, const BirdSizes& size, float side) {
  const std::string of = side > 0 ? "left_" : "right_";
  const float l = size.leg, x = side * 0.075f;
  plan.joint(of + "hip", "body", JointKind::Ball, Vec3(x, l + 0.03f, 0.0f));
  plan.joint(of + "ankle", of + "hip", JointKind::Hinge, Vec3(x, 0.52f * l, -0.055f));
  plan.joint(of + "foot", of + "ankle", JointKind::Ball, Vec3(x, 0.035f, 0.0f));
  const Vec3 ankle = plan.at(of + "ankle"), foot = plan.at(of + "foot"), sole(x, 0.016f, 0);
  plan.add(of + "hip", cone_part(plan.at(of + "hip"), 0.058f, ankle, 0.024f), 0.03f);
  plan.add(of + "ankle", cone_part(ankle, 0.02f, foot, 0.016f), 0.01f);
  plan.add(of + "foot", cone_part(foot, 0.016f, sole, 0.016f), 0.005f);
  for (const float toe_deg : {-32.0f, 0.0f, 32.0f, 180.0f}) {
    const float turned = from_degrees(toe_deg), far = toe_deg > 90 ? 0.07f : 0.11f;
    plan.add(of + "foot",
             cone_part(sole, 0.016f, Vec3(x, 0.013f, 0) + far * Vec3(std::sin(turned), 0, std::cos(turned)),
                       0.013f),
             0.008f);
  }
}

CreaturePlan bird_plan(Rng& rng) {
  const BirdSizes size{rng.uniform(0.85f, 1.1f),  rng.uniform(1.05f, 1.4f),  rng.uniform(0.24f, 0.36f),
                       rng.uniform(0.13f, 0.22f), rng.uniform(0.04f, 0.11f), rng.uniform(0.14f, 0.24f)};
  CreaturePlan plan;
  plan.scale = rng.uniform(0.4f, 0.8f);
  plan.vertices = 7500;
  plan.cell = 0.0085f;
  plan.coarse_at = 0.05f;
  bird_trunk(plan, size);
  for (const float side : {1.0f, -1.0f}) {
    bird_wing(plan, size, side);
    bird_leg(plan, size, side);
  }
  return plan;
}

/// Both wings the same: up turns shoulders, elbows and wrists so that the tips rise, in radians.
void bird_raise_wings(Puppet& puppet, const std::array<float, 3>& up, float twist) {
  for (const float side : {1.0f, -1.0f}) {
    const std::string of = side > 0 ? "left_" : "right_";
    puppet.turn(of + "shoulder", Vec3::UnitZ(), side * up[0]);
    puppet.turn(of + "shoulder", Vec3::UnitX(), twist);
    puppet.turn(of + "elbow", side * up[1]);
    puppet.turn(of + "wrist", side * up[2]);
  }
}

std::vector<Limb> bird_limbs(const Rig& rig) {
  std::vector<Limb> limbs;
  for (const std::string of : {"left_", "right_"})
    limbs.push_back(limb_of(rig, {of + "hip", of + "ankle"}, of + "foot"));
  return limbs;
}

/// Flies on the spot: a slow beat of the wings, the outer wing late.
Performance bird_flies(const Rig& rig, Rng& rng) {
  const float size = size_of(rig), period = rng.uniform(1.5f, 1.8f), begin = rng.uniform(0, period),
              wide = rng.uniform(0.5f, 0.6f);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.pose.root = puppet.rest("body") +
                       size * Vec3(0.02f * wave(t, 2.7f * period), 0.12f - 0.025f * wave(t, period, 0.1f), 0);
    puppet.turn("body", Vec3::UnitX(), -0.1f + 0.08f * wave(t, 1.9f * period));
    puppet.turn("body", Vec3::UnitZ(), 0.08f * wave(t, 2.3f * period));
    bird_raise_wings(puppet,
                     {wide * wave(t, period), -0.1f + 0.28f * wave(t, period, -0.14f),
                      -0.08f + 0.32f * wave(t, period, -0.24f)},
                     0.15f * wave(t, period, 0.25f));
    puppet.turn("tail", Vec3::UnitX(), 0.22f * wave(t, period, 0.2f));
    puppet.turn("neck", Vec3::UnitX(), 0.25f + 0.14f * wave(t, period, 0.3f));
    puppet.turn("upper_neck", Vec3::UnitX(), 0.14f * wave(t, period, 0.1f));
    puppet.turn("head", Vec3::UnitX(), -0.15f - 0.14f * wave(t, period, 0.2f));
    puppet.turn("head", Vec3::UnitY(), 0.3f * wave(t, 2.1f * period));
    for (const std::string of : {"left_", "right_"}) {
      const float late = of == "left_" ? 0 : 0.2f;
      puppet.turn(of + "hip", Vec3::UnitX(), 0.4f + 0.2f * wave(t, period, late));
      puppet.turn(of + "ankle", 0.2f * wave(t, period, 0.3f + late) + 0.1f);
      puppet.turn(of + "foot", Vec3::UnitX(), 0.5f + 0.25f * wave(t, period, late));
    }
  };
}

/// Walks with a nodding head, wings half raised.
Performance bird_struts(const Rig& rig, Rng& rng) {
  const std::vector<Limb> limbs = bird_limbs(rig);
  const float leg = rig.joints[static_cast<size_t>(limbs[0].joints[0])].rest.y();
  GaitStyle style;
  style.period = rng.uniform(1.1f, 1.35f);
  style.down = 0.6f;
  style.speed = 0.5f * leg / (style.down * style.period);
  style.turning = rng.uniform(-0.3f, 0.3f);
  style.lift = 0.22f * leg;
  const float begin = rng.uniform();
  style.phases = {begin, begin + 0.5f};
  return [=, gait = Gait(contacts_of(limbs), style)](Puppet& puppet, float seconds) {
    const float period = style.period, t = seconds + begin * period;
    const RigidMotion body = gait.body(seconds);
    puppet.pose.root = body(puppet.rest("body") -
                            leg * Vec3(0.04f * wave(t, period), 0.07f + 0.025f * wave(t, 0.5f * period), 0));
    puppet.pose.turns[0] = body.R;
    puppet.turn("body", Vec3::UnitZ(), 0.07f * wave(t, period));
    puppet.turn("body", Vec3::UnitY(), 0.08f * wave(t, period, 0.2f));
    const float nod = wave(t, 0.5f * period);
    puppet.turn("neck", Vec3::UnitX(), 0.05f + 0.3f * nod);
    puppet.turn("upper_neck", Vec3::UnitX(), 0.1f * nod);
    puppet.turn("head", Vec3::UnitX(), -0.05f - 0.4f * nod);
    puppet.turn("head", Vec3::UnitY(), 0.25f * wave(t, 2.1f * period));
    puppet.turn("tail", Vec3::UnitX(), 0.18f * wave(t, 0.5f * period, 0.3f));
    puppet.turn("tail", Vec3::UnitY(), 0.15f * wave(t, period));
    bird_raise_wings(puppet,
                     {0.22f + 0.22f * wave(t, 1.4f * period), -0.25f + 0.25f * wave(t, 1.4f * period, -0.15f),
                      -0.25f + 0.3f * wave(t, 1.4f * period, -0.25f)},
                     0);
    plant_feet(puppet, limbs, gait, seconds, 0.7f);
  };
}

/// Stands, crouches and stretches, looks about and lifts one wing, then the other.
Performance bird_preens(const Rig& rig, Rng& rng) {
  const std::vector<Limb> limbs = bird_limbs(rig);
  const float leg = rig.joints[static_cast<size_t>(limbs[0].joints[0])].rest.y();
  const float period = rng.uniform(2.2f, 2.8f), begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.pose.root =
        puppet.rest("body") - leg * Vec3(0.08f * wave(t, 1.3f * period), 0.14f + 0.11f * wave(t, period), 0);
    puppet.turn("body", Vec3::UnitX(), 0.16f * wave(t, period, 0.2f));
    puppet.turn("body", Vec3::UnitZ(), 0.08f * wave(t, 1.3f * period));
    puppet.turn("neck", Vec3::UnitY(), 0.4f * wave(t, 1.1f * period));
    puppet.turn("upper_neck", Vec3::UnitX(), 0.3f * wave(t, 0.7f * period));
    puppet.turn("head", Vec3::UnitY(), 0.5f * wave(t, 0.9f * period, 0.2f));
    puppet.turn("tail", Vec3::UnitY(), 0.3f * wave(t, 0.6f * period));
    for (const float side : {1.0f, -1.0f}) {
      const std::string of = side > 0 ? "left_" : "right_";
      const float phase = side > 0 ? 0.0f : 0.5f;
      puppet.turn(of + "shoulder", Vec3::UnitZ(), side * (0.3f + 0.24f * wave(t, period, phase)));
      puppet.turn(of + "shoulder", Vec3::UnitY(), side * 0.2f * wave(t, 0.8f * period, phase));
      puppet.turn(of + "elbow", side * (0.3f * wave(t, 0.8f * period, phase) - 0.12f));
      puppet.turn(of + "wrist", side * (0.32f * wave(t, 0.7f * period, phase) - 0.1f));
    }
    for (const Limb& limb : limbs) puppet.plant(limb, limb.contact, Mat3::Identity());
  };
}

}  // namespace

CreatureForm bird_form() {
  return {bird_plan, {{"fly", bird_flies}, {"strut", bird_struts}, {"preen", bird_preens}}, {"body"}};
}

}  // namespace understudy
