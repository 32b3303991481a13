// A six-legged insect: head with feelers, thorax, abdomen, legs of three pieces.
#include <array>
#include <cmath>

#include "retarget/creature/forms.hpp"
#include "retarget/creature/gait.hpp"

namespace understudy {
namespace {

constexpr std::array<const char*, 6> kInsectLegs = {"left_front",   "right_front", "left_middle",
                                                    "right_middle", "left_hind",   "right_hind"};

struct InsectSizes {
  float legs, high, abdomen, fat, head;
};

void insect_leg(CreaturePlan& plan, const InsectSizes& size, size_t leg) {
  const std::string name = kInsectLegs[leg];
  const float side = leg % 2 == 0 ? 1.0f : -1.0f;
  const std::array<float, 3> turned_deg = {42, 92, 138}, ahead = {0.11f, 0.0f, -0.1f};
  const float turned = from_degrees(turned_deg[leg / 2]), l = size.legs * (leg / 2 == 2 ? 1.12f : 1.0f);
  const Vec3 out(side * std::sin(turned), 0, std::cos(turned));
  const Vec3 root = Vec3(side * 0.06f, size.high - 0.02f, ahead[leg / 2]) + 0.03f * out;
  const auto at = [&](float far, float y) -> Vec3 { return Vec3(root.x(), y, root.z()) + far * out; };
  plan.joint(name + "_hip", "thorax", JointKind::Ball, root);
  plan.joint(name + "_knee", name + "_hip", JointKind::Hinge, at(0.21f * l, size.high + 0.15f * l),
             Vec3::UnitY().cross(out));
  plan.joint(name + "_ankle", name + "_knee", JointKind::Hinge, at(0.43f * l, 0.06f),
             Vec3::UnitY().cross(out));
  plan.add(name + "_hip", cone_part(root, 0.03f, plan.at(name + "_knee"), 0.021f), 0.015f);
  plan.add(name + "_knee", cone_part(plan.at(name + "_knee"), 0.021f, plan.at(name + "_ankle"), 0.016f),
           0.008f);
  plan.add(name + "_ankle", cone_part(plan.at(name + "_ankle"), 0.016f, at(0.56f * l, 0.0125f), 0.0125f),
           0.008f);
}

CreaturePlan insect_plan(Rng& rng) {
  const InsectSizes size{rng.uniform(0.85f, 1.15f), rng.uniform(0.17f, 0.22f), rng.uniform(0.9f, 1.25f),
                         rng.uniform(0.85f, 1.2f), rng.uniform(0.9f, 1.15f)};
  CreaturePlan plan;
  plan.scale = rng.uniform(0.3f, 0.5f);
  plan.vertices = 7000;
  plan.cell = 0.008f;
  const float h = size.high, fat = size.fat, behind = 0.23f * size.abdomen;
  plan.joint("thorax", "", JointKind::Free, Vec3(0, h, 0));
  plan.joint("head", "thorax", JointKind::Ball, Vec3(0, h + 0.015f, 0.19f));
  plan.joint("abdomen", "thorax", JointKind::Ball, Vec3(0, h + 0.01f, -0.17f));
  plan.add("thorax", ellipsoid_part({0, h, 0}, {0.1f * fat, 0.095f, 0.18f}));
  plan.add("head", ellipsoid_part({0, h + 0.02f, 0.27f}, Vec3(0.1f, 0.08f, 0.095f) * size.head), 0.025f);
  plan.add("abdomen", cone_part({0, h + 0.01f, -0.17f}, 0.05f, {0, h + 0.02f, -0.24f}, 0.06f), 0.03f);
  plan.add("abdomen", ellipsoid_part({0, h + 0.025f, -0.2f - behind}, {0.135f * fat, 0.12f * fat, behind}),
           0.03f);
  for (const float side : {1.0f, -1.0f}) {
    const Vec3 root(side * 0.045f, h + 0.07f, 0.32f), bend = root + Vec3(side * 0.07f, 0.11f, 0.08f);
    plan.add("head", cone_part(root, 0.014f, bend, 0.013f), 0.01f);
    plan.add("head", cone_part(bend, 0.013f, bend + Vec3(side * 0.08f, -0.01f, 0.12f), 0.012f), 0.005f);
    plan.add("head", ellipsoid_part({side * 0.08f, h + 0.045f, 0.29f}, Vec3::Constant(0.034f) * size.head),
             0.005f);
    plan.add("head",
             cone_part({side * 0.045f, h - 0.01f, 0.34f}, 0.018f, {side * 0.03f, h - 0.03f, 0.41f}, 0.013f),
             0.01f);
  }
  for (size_t leg = 0; leg < kInsectLegs.size(); ++leg) insect_leg(plan, size, leg);
  return plan;
}

std::vector<Limb> insect_limbs(const Rig& rig) {
  std::vector<Limb> limbs;
  limbs.reserve(std::size(kInsectLegs));
  for (const std::string name : kInsectLegs)
    limbs.push_back(limb_of(rig, {name + "_hip", name + "_knee", name + "_ankle"}));
  return limbs;
}

void insect_ends(Puppet& puppet, float t, float period) {
  puppet.turn("head", Vec3::UnitY(), 0.3f * wave(t, 1.9f * period));
  puppet.turn("head", Vec3::UnitX(), 0.15f * wave(t, 1.3f * period, 0.3f));
  puppet.turn("abdomen", Vec3::UnitY(), 0.2f * wave(t, 1.5f * period));
  puppet.turn("abdomen", Vec3::UnitX(), 0.08f - 0.14f * wave(t, period, 0.2f));
}

/// Three feet on the floor, the other three ahead.
Performance insect_walks(const Rig& rig, Rng& rng) {
  const std::vector<Limb> limbs = insect_limbs(rig);
  const float size = size_of(rig);
  GaitStyle style;
  style.period = rng.uniform(0.95f, 1.2f);
  style.down = 0.56f;
  style.speed = 0.13f * size / (style.down * style.period);
  style.turning = rng.uniform(-0.4f, 0.4f);
  style.lift = 0.1f * size;
  const float begin = rng.uniform();
  for (const float phase : {0.0f, 0.5f, 0.5f, 0.0f, 0.0f, 0.5f}) style.phases.push_back(begin + phase);
  return [=, gait = Gait(contacts_of(limbs), style)](Puppet& puppet, float seconds) {
    const float t = seconds + begin * style.period;
    const RigidMotion body = gait.body(seconds);
    puppet.pose.root =
        body(puppet.rest("thorax") + Vec3(0, size * (0.01f + 0.018f * wave(t, 0.5f * style.period)), 0));
    puppet.pose.turns[0] = body.R;
    puppet.turn("thorax", Vec3::UnitY(), 0.05f * wave(t, style.period));
    insect_ends(puppet, t, style.period);
    plant_feet(puppet, limbs, gait, seconds, 0);
  };
}

/// Rocks and turns on its planted hind and middle feet, and feels about with the front ones.
Performance insect_feels(const Rig& rig, Rng& rng) {
  const std::vector<Limb> limbs = insect_limbs(rig);
  const float size = size_of(rig), period = rng.uniform(1.8f, 2.4f), begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    const Vec3 sway(0.045f * wave(t, period), 0.045f + 0.03f * wave(t, 0.8f * period),
                    0.045f * wave(t, 1.3f * period, 0.2f));
    puppet.pose.root = puppet.rest("thorax") + size * sway;
    puppet.turn("thorax", Vec3::UnitX(), -0.08f + 0.1f * wave(t, 1.1f * period));
    puppet.turn("thorax", Vec3::UnitY(), 0.16f * wave(t, 1.4f * period, 0.1f));
    insect_ends(puppet, t, 0.8f * period);
    for (size_t i = 0; i < limbs.size(); ++i) {
      Vec3 place = limbs[i].contact;
      if (i < 2) {
        const float side = i == 0 ? 1.0f : -1.0f, phase = i == 0 ? 0.0f : 0.45f;
        place +=
            size * Vec3(side * 0.04f * wave(t, period, phase), 0.13f + 0.07f * wave(t, 0.7f * period, phase),
                        0.05f * wave(t, 0.9f * period, phase));
      }
      puppet.plant(limbs[i], place, Mat3::Identity(), i < 2 ? 0.3f * wave(t, 0.8f * period) : 0);
    }
  };
}

}  // namespace

CreatureForm insect_form() {
  return {insect_plan, {{"walk", insect_walks}, {"feel", insect_feels}}, {"abdomen"}};
}

}  // namespace understudy
