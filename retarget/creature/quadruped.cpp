// A four-legged animal, anything from a cat by way of a dog to a horse.
#include <Eigen/Geometry>
#include <cmath>

#include "retarget/creature/forms.hpp"
#include "retarget/creature/gait.hpp"
#include "retarget/math/smooth_step.hpp"

namespace understudy {
namespace {

struct QuadrupedLook {
  float leg, girth, neck, neck_deg, skull, muzzle, muzzle_deg, ear, tail, tail_deg, tail_thick, scale;
};
//                                 leg    girth  neck  up  skull  muzzle down ear  tail  up  thick  m
constexpr QuadrupedLook kCat = {0.36f, 0.105f, 0.14f, 38, 0.092f, 0.05f,
                                18,    0.085f, 0.62f, 28, 0.026f, 0.45f};
constexpr QuadrupedLook kDog = {0.47f, 0.118f, 0.21f, 48, 0.078f, 0.13f, 20, 0.1f, 0.42f, 20, 0.028f, 0.9f};
constexpr QuadrupedLook kHorse = {0.68f, 0.16f, 0.42f, 52, 0.082f, 0.2f, 42, 0.075f, 0.5f, -58, 0.04f, 1.9f};

QuadrupedLook between(const QuadrupedLook& a, const QuadrupedLook& b, float way) {
  const auto mix = [way](float from, float to) { return from + way * (to - from); };
  return {mix(a.leg, b.leg),
          mix(a.girth, b.girth),
          mix(a.neck, b.neck),
          mix(a.neck_deg, b.neck_deg),
          mix(a.skull, b.skull),
          mix(a.muzzle, b.muzzle),
          mix(a.muzzle_deg, b.muzzle_deg),
          mix(a.ear, b.ear),
          mix(a.tail, b.tail),
          mix(a.tail_deg, b.tail_deg),
          mix(a.tail_thick, b.tail_thick),
          mix(a.scale, b.scale)};
}

constexpr float kHoofed = 0.65f;  // from here on towards the horse it has hooves

void quadruped_trunk(CreaturePlan& plan, const QuadrupedLook& look) {
  const float h = look.leg, g = look.girth;
  plan.joint("pelvis", "", JointKind::Free, Vec3(0, h + 0.02f, -0.3f));
  plan.joint("spine", "pelvis", JointKind::Ball, Vec3(0, h + 0.03f, -0.1f));
  plan.joint("chest", "spine", JointKind::Ball, Vec3(0, h + 0.02f, 0.1f));
  plan.add("pelvis", cone_part({0, h, -0.32f}, 0.85f * g, {0, h, -0.14f}, 0.88f * g), 0.06f);
  plan.add("spine", cone_part({0, h - 0.005f, -0.1f}, 0.9f * g, {0, h - 0.015f, 0.08f}, 1.02f * g), 0.06f);
  plan.add("chest", cone_part({0, h - 0.03f, 0.12f}, 1.08f * g, {0, h - 0.01f, 0.27f}, 0.9f * g), 0.06f);
}

void quadruped_head(CreaturePlan& plan, const QuadrupedLook& look) {
  const float up = from_degrees(look.neck_deg), down = from_degrees(look.muzzle_deg), s = look.skull;
  const Vec3 way(0, std::sin(up), std::cos(up)), root(0, look.leg + 0.45f * look.girth, 0.3f);
  const Vec3 middle = root + 0.5f * look.neck * way, head = root + look.neck * way;
  const float thick = 0.68f * look.girth, thin = 0.75f * s;
  plan.joint("neck", "chest", JointKind::Ball, root);
  plan.joint("upper_neck", "neck", JointKind::Ball, middle);
  plan.joint("head", "upper_neck", JointKind::Ball, head);
  plan.add("neck", cone_part(root, thick, middle, 0.5f * (thick + thin)), 0.06f);
  plan.add("upper_neck", cone_part(middle, 0.5f * (thick + thin), head, thin), 0.04f);
  const Vec3 ahead(0, -std::sin(down), std::cos(down)), skull = head + Vec3(0, 0.3f * s, 0.55f * s);
  plan.add("head", ellipsoid_part(skull, {0.95f * s, 0.95f * s, 1.1f * s}), 0.03f);
  const float blunt = 0.5f + 0.12f * smooth_step(30, 42, look.muzzle_deg);
  const Vec3 nose = skull + (0.6f * s + look.muzzle) * ahead - Vec3(0, 0.15f * s, 0);
  plan.add("head", cone_part(skull + 0.2f * s * ahead, 0.72f * s, nose, blunt * s), 0.04f);
  for (const float side : {1.0f, -1.0f}) {
    const std::string name = side > 0 ? "left_ear" : "right_ear";
    const Vec3 base = skull + s * Vec3(side * 0.6f, 0.72f, -0.15f);
    const Vec3 tip = base + look.ear * Vec3(side * 0.42f, 0.9f, -0.1f);
    plan.joint(name, "head", JointKind::Ball, base);
    plan.add(name, blade_part(base, 0.36f * look.ear + 0.004f, tip, 0.012f, {Vec3(0, 0.1f, 1), 0.014f}),
             0.012f);
  }
}

void quadruped_tail(CreaturePlan& plan, const QuadrupedLook& look) {
  Vec3 at(0, look.leg + 0.35f * look.girth, -0.3f - 0.72f * look.girth);
  float up = from_degrees(look.tail_deg);
  std::string parent = "pelvis";
  for (int i = 1; i <= 3; ++i) {
    const std::string name = "tail_" + std::to_string(i);
    plan.joint(name, parent, JointKind::Ball, at);
    const Vec3 next = at + look.tail / 3 * Vec3(0, std::sin(up), -std::cos(up));
    plan.add(name, cone_part(at, look.tail_thick, next, i == 3 ? 0.7f * look.tail_thick : look.tail_thick),
             0.02f);
    parent = name;
    at = next;
    up += from_degrees(look.tail_deg > 0 ? 14 : -8);
  }
}

void quadruped_paw(CreaturePlan& plan, const std::string& name, bool hoof) {
  const Vec3 at = plan.at(name), floor(at.x(), 0, at.z());
  if (hoof) {
    plan.add(name, cone_part(at, 0.026f, floor + Vec3(0, 0.04f, 0.012f), 0.027f), 0.01f);
    plan.add(name,
             frustum_part(floor + Vec3(0, 0, 0.024f), 0.046f, floor + Vec3(0, 0.055f, 0.01f), 0.032f, 0.01f));
  } else {
    plan.add(name, cone_part(at, 0.026f, floor + Vec3(0, 0.032f, 0.01f), 0.03f), 0.01f);
    plan.add(name, ellipsoid_part(floor + Vec3(0, 0.028f, 0.036f), {0.037f, 0.028f, 0.052f}), 0.02f);
  }
}

void quadruped_legs(CreaturePlan& plan, const QuadrupedLook& look, bool hoof) {
  const float h = look.leg, w = 0.68f * look.girth, bulk = std::sqrt(look.girth / 0.12f);
  for (const float side : {1.0f, -1.0f}) {
    const std::string of = side > 0 ? "left_" : "right_";
    const auto at = [&](float y, float z) { return Vec3(side * w, y, z); };
    plan.joint(of + "shoulder", "chest", JointKind::Ball, at(h - 0.03f, 0.22f));
    plan.joint(of + "elbow", of + "shoulder", JointKind::Hinge, at(0.58f * h, 0.165f));
    plan.joint(of + "front_paw", of + "elbow", JointKind::Ball, at(0.075f, 0.205f));
    plan.add(of + "shoulder",
             cone_part(plan.at(of + "shoulder"), 0.062f * bulk, plan.at(of + "elbow"), 0.042f * bulk), 0.04f);
    plan.add(of + "elbow", cone_part(plan.at(of + "elbow"), 0.04f * bulk, plan.at(of + "front_paw"), 0.026f),
             0.02f);
    quadruped_paw(plan, of + "front_paw", hoof);
    plan.joint(of + "hip", "pelvis", JointKind::Ball, at(h - 0.02f, -0.31f));
    plan.joint(of + "knee", of + "hip", JointKind::Hinge, at(0.6f * h, -0.23f));
    plan.joint(of + "hock", of + "knee", JointKind::Hinge, at(0.33f * h, -0.385f));
    plan.joint(of + "hind_paw", of + "hock", JointKind::Ball, at(0.065f, -0.345f));
    plan.add(of + "hip", cone_part(plan.at(of + "hip"), 0.08f * bulk, plan.at(of + "knee"), 0.05f * bulk),
             0.04f);
    plan.add(of + "knee", cone_part(plan.at(of + "knee"), 0.047f * bulk, plan.at(of + "hock"), 0.028f),
             0.02f);
    plan.add(of + "hock", cone_part(plan.at(of + "hock"), 0.028f, plan.at(of + "hind_paw"), 0.025f), 0.015f);
    quadruped_paw(plan, of + "hind_paw", hoof);
  }
}

CreaturePlan quadruped_plan(Rng& rng) {
  const float size = rng.uniform();
  QuadrupedLook look = size < 0.5f ? between(kCat, kDog, 2 * size) : between(kDog, kHorse, 2 * size - 1);
  look.leg *= rng.uniform(0.92f, 1.06f);
  look.girth *= rng.uniform(0.9f, 1.25f);
  look.ear *= rng.uniform(0.85f, 1.25f);
  look.tail *= rng.uniform(0.85f, 1.15f);
  CreaturePlan plan;
  plan.scale = look.scale;
  plan.vertices = 7000;
  quadruped_trunk(plan, look);
  quadruped_head(plan, look);
  quadruped_tail(plan, look);
  quadruped_legs(plan, look, size > kHoofed);
  return plan;
}

std::vector<Limb> quadruped_limbs(const Rig& rig) {
  std::vector<Limb> limbs;
  for (const std::string of : {"left_", "right_"}) {
    limbs.push_back(limb_of(rig, {of + "hip", of + "knee", of + "hock"}, of + "hind_paw"));
    limbs.push_back(limb_of(rig, {of + "shoulder", of + "elbow"}, of + "front_paw"));
  }
  return limbs;
}

/// Tail, ears, neck: what moves besides the legs. `lively` 1: much.
void quadruped_upper(Puppet& puppet, float t, float period, float lively) {
  for (int i = 1; i <= 3; ++i) {
    const std::string tail = "tail_" + std::to_string(i);
    puppet.turn(tail, Vec3::UnitY(), 0.3f * lively * wave(t, 1.5f * period, -0.12f * static_cast<float>(i)));
    puppet.turn(tail, Vec3::UnitX(), 0.15f * lively * wave(t, 1.1f * period, -0.1f * static_cast<float>(i)));
  }
  puppet.turn("left_ear", Vec3::UnitX(), 0.3f * lively * wave(t, 1.3f * period));
  puppet.turn("right_ear", Vec3::UnitX(), 0.3f * lively * wave(t, 1.7f * period, 0.3f));
  puppet.turn("left_ear", Vec3::UnitZ(), -0.2f * lively * wave(t, 0.9f * period));
  puppet.turn("right_ear", Vec3::UnitZ(), 0.2f * lively * wave(t, 0.9f * period));
}

struct QuadrupedPace {
  float period, stride, down,
      bob;                    // seconds; share of the leg's length; share of the period; share of the leg
  std::vector<float> phases;  // left hind, left front, right hind, right front
};

Performance quadruped_goes(const Rig& rig, Rng& rng, const QuadrupedPace& pace) {
  const std::vector<Limb> limbs = quadruped_limbs(rig);
  const float leg = rig.joints[static_cast<size_t>(limbs[0].joints[0])].rest.y();
  GaitStyle style;
  style.period = pace.period * rng.uniform(0.92f, 1.1f);
  style.down = pace.down;
  style.speed = pace.stride * leg / (style.down * style.period);
  style.turning = rng.uniform(-0.25f, 0.25f);
  style.lift = leg * rng.uniform(0.13f, 0.18f);
  style.phases = pace.phases;
  const float begin = rng.uniform(0, style.period), bob = pace.bob * leg;
  for (float& phase : style.phases) phase += begin / style.period;
  return [=, gait = Gait(contacts_of(limbs), style)](Puppet& puppet, float seconds) {
    const float t = seconds + begin, period = style.period;
    const RigidMotion body = gait.body(seconds);
    const Vec3 root =
        puppet.rest("pelvis") - Vec3(0, 0.035f * leg + bob * (0.5f + 0.5f * wave(t, 0.5f * period)), 0);
    puppet.pose.root = body(root);
    puppet.pose.turns[0] = body.R;
    puppet.turn("pelvis", Vec3::UnitZ(), 0.04f * wave(t, period));
    puppet.turn("spine", Vec3::UnitY(), 0.17f * wave(t, period, 0.1f));
    puppet.turn("chest", Vec3::UnitY(), -0.17f * wave(t, period, 0.1f));
    puppet.turn("chest", Vec3::UnitZ(), -0.05f * wave(t, period));
    puppet.turn("neck", Vec3::UnitX(), 0.1f + 0.16f * wave(t, 0.5f * period, 0.2f));
    puppet.turn("upper_neck", Vec3::UnitY(), 0.25f * wave(t, 2.3f * period));
    puppet.turn("head", Vec3::UnitX(), -0.05f - 0.16f * wave(t, 0.5f * period, 0.1f));
    puppet.turn("head", Vec3::UnitY(), 0.15f * wave(t, 2.3f * period, -0.1f));
    quadruped_upper(puppet, t, period, 1);
    plant_feet(puppet, limbs, gait, seconds, 0.6f);
  };
}

Performance quadruped_walks(const Rig& rig, Rng& rng) {
  return quadruped_goes(rig, rng, {1.3f, 0.36f, 0.66f, 0.012f, {0, 0.75f, 0.5f, 0.25f}});
}

Performance quadruped_trots(const Rig& rig, Rng& rng) {
  return quadruped_goes(rig, rng, {0.85f, 0.36f, 0.54f, 0.04f, {0, 0.5f, 0.5f, 0}});
}

/// Stands, bows to the floor and stretches up, looks about, wags its tail, lifts a paw.
Performance quadruped_plays(const Rig& rig, Rng& rng) {
  const std::vector<Limb> limbs = quadruped_limbs(rig);
  const float leg = rig.joints[static_cast<size_t>(limbs[0].joints[0])].rest.y();
  const float period = rng.uniform(2.6f, 3.4f), begin = rng.uniform(0, period),
              deep = rng.uniform(0.2f, 0.26f);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin, bow = 0.5f + 0.5f * wave(t, period);
    const float crouch = 0.5f + 0.5f * wave(t, period, 0.35f);
    puppet.pose.root = puppet.rest("pelvis") - leg * Vec3(0, 0.03f + 0.14f * crouch, 0.05f * wave(t, period));
    puppet.turn("pelvis", Vec3::UnitX(), deep * bow - 0.1f * crouch);
    puppet.turn("pelvis", Vec3::UnitY(), 0.06f * wave(t, 0.7f * period));
    puppet.turn("spine", Vec3::UnitX(), 0.14f * bow - 0.14f);
    puppet.turn("chest", Vec3::UnitX(), -0.14f * bow);
    puppet.turn("spine", Vec3::UnitY(), 0.13f * wave(t, 0.7f * period, 0.2f));
    puppet.turn("neck", Vec3::UnitX(), 0.3f - 0.4f * bow);
    puppet.turn("upper_neck", Vec3::UnitY(), 0.35f * wave(t, 1.2f * period));
    puppet.turn("head", Vec3::UnitY(), 0.4f * wave(t, 0.8f * period, 0.1f));
    puppet.turn("head", Vec3::UnitZ(), 0.2f * wave(t, 0.9f * period));
    quadruped_upper(puppet, t, 0.45f * period, 1.2f);
    for (const Limb& limb : limbs) puppet.plant(limb, limb.contact, Mat3::Identity());
    const float raised = std::max(0.0f, wave(t, 1.5f * period));
    const Mat3 hanging = Eigen::AngleAxisf(0.8f * raised, Vec3::UnitX()).toRotationMatrix();
    puppet.plant(limbs[1], limbs[1].contact + leg * raised * raised * Vec3(0, 0.3f, 0.16f), hanging);
  };
}

}  // namespace

CreatureForm quadruped_form() {
  return {quadruped_plan,
          {{"walk", quadruped_walks}, {"trot", quadruped_trots}, {"play", quadruped_plays}},
          {"spine", "chest"}};
}

}  // namespace understudy
