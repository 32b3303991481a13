// An excavator: tracks, a cab that turns, boom, stick, a piece that slides out of the stick, bucket.
#include "retarget/creature/forms.hpp"

namespace understudy {
namespace {

struct ExcavatorSizes {
  float boom, stick, bucket;
};

const Vec3 kStickWay = Vec3(0, -0.9f, 0.3f).normalized();

void excavator_joints(CreaturePlan& plan, const ExcavatorSizes& size) {
  const Vec3 boom(0, 0.42f, 0.24f), stick = boom + size.boom * Vec3(0, 0.6f, 0.8f);
  const Vec3 inner = stick + 0.52f * size.stick * kStickWay, bucket = stick + size.stick * kStickWay;
  plan.joint("tracks", "", JointKind::Free, Vec3(0, 0.12f, 0));
  plan.joint("cab", "tracks", JointKind::Hinge, Vec3(0, 0.25f, 0), Vec3::UnitY());
  plan.joint("boom", "cab", JointKind::Hinge, boom);
  plan.joint("stick", "boom", JointKind::Hinge, stick);
  plan.joint("extension", "stick", JointKind::Slider, inner, kStickWay);
  plan.joint("bucket", "extension", JointKind::Hinge, bucket);
}

void excavator_house(CreaturePlan& plan) {
  for (const float side : {1.0f, -1.0f}) {
    const BladeShape track{Vec3::UnitX(), 0.08f, 0.025f};
    plan.add("tracks", blade_part({side * 0.25f, 0.115f, -0.33f}, 0.115f, {side * 0.25f, 0.115f, 0.33f},
                                  0.115f, track));
  }
  plan.add("tracks", box_part({0, 0.14f, 0}, {0.22f, 0.05f, 0.2f}, 0.02f));
  plan.add("tracks", frustum_part({0, 0.15f, 0}, 0.16f, {0, 0.25f, 0}, 0.16f, 0.01f));
  plan.add("cab", box_part({0, 0.33f, -0.08f}, {0.29f, 0.08f, 0.34f}, 0.05f));
  plan.add("cab", box_part({0, 0.45f, -0.31f}, {0.28f, 0.1f, 0.12f}, 0.05f));
  plan.add("cab", box_part({0.17f, 0.54f, 0.07f}, {0.115f, 0.18f, 0.16f}, 0.04f));
  plan.carve("cab", meshed_as(0.03f, box_part({0.17f, 0.6f, 0.26f}, {0.085f, 0.075f, 0.05f}, 0.02f)), 0.03f);
  plan.carve("cab", meshed_as(0.03f, box_part({0.31f, 0.6f, 0.07f}, {0.05f, 0.075f, 0.11f}, 0.02f)), 0.03f);
}

/// A scoop that is open towards the cab, with teeth.
void excavator_bucket(CreaturePlan& plan, float wide) {
  const Vec3 pin = plan.at("bucket"), middle = pin + Vec3(0, -0.13f, 0), x = Vec3::UnitX();
  const auto fine = [](const SolidPart& part) { return meshed_as(0.03f, part); };
  plan.add("bucket", blade_part(pin, 0.045f, middle + Vec3(0, 0.05f, 0.03f), 0.06f, {x, 0.05f}));
  plan.add("bucket", fine(blade_part(middle + Vec3(0, 0.03f, 0.02f), 0.125f, middle + Vec3(0, -0.03f, -0.08f),
                                     0.11f, {x, wide, 0.012f})));
  const Vec3 hollow = middle + Vec3(0, 0.01f, -0.04f);
  const BladeShape inside{x, wide - 0.035f, 0.01f};
  plan.carve("bucket", fine(blade_part(hollow, 0.09f, hollow + Vec3(0, 0.03f, -0.25f), 0.13f, inside)));
  for (int tooth = -1; tooth <= 1; ++tooth) {
    const Vec3 root = middle + Vec3((wide - 0.03f) * static_cast<float>(tooth), -0.125f, -0.12f);
    plan.add("bucket", cone_part(root, 0.024f, root + Vec3(0, -0.012f, -0.08f), 0.012f));
  }
}

CreaturePlan excavator_plan(Rng& rng) {
  const float boom = rng.uniform(0.68f, 0.82f);
  const ExcavatorSizes size{boom, boom * rng.uniform(0.7f, 0.78f), rng.uniform(0.12f, 0.16f)};
  CreaturePlan plan;
  plan.machine = true;
  plan.mirrored = false;  // the driver sits on the left
  plan.vertices = 9000;
  plan.scale = rng.uniform(1.8f, 2.6f);
  plan.cell = 0.014f;
  excavator_joints(plan, size);
  excavator_house(plan);
  const Vec3 foot = plan.at("boom"), top = plan.at("stick");
  const Vec3 knee = foot + Vec3(0, 0.68f * size.boom, 0.38f * size.boom);
  const BladeShape thick{Vec3::UnitX(), 0.055f}, thin{Vec3::UnitX(), 0.042f}, inner{Vec3::UnitX(), 0.03f};
  plan.add("boom", blade_part(foot, 0.06f, knee, 0.085f, thick));
  plan.add("boom", blade_part(knee, 0.085f, top, 0.05f, thick));
  plan.add("stick", blade_part(top - 0.1f * kStickWay, 0.04f, top + 0.05f * kStickWay, 0.062f, thin));
  plan.add("stick", blade_part(top, 0.062f, plan.at("extension"), 0.05f, thin));
  plan.add("extension", blade_part(plan.at("extension"), 0.035f, plan.at("bucket"), 0.035f, inner));
  excavator_bucket(plan, size.bucket);
  return plan;
}

/// Digs on one side and unloads on the other.
Performance excavator_digs(const Rig& rig, Rng& rng) {
  const float period = rng.uniform(4, 5), side = from_degrees(rng.uniform(26, 36)),
              begin = rng.uniform(0, period), in = -0.075f * size_of(rig) * rng.uniform(0.8f, 1);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.turn("cab", side * wave(t, period));
    puppet.turn("boom", -0.26f + 0.2f * wave(t, 0.5f * period));
    puppet.turn("stick", visiting(t, period, {-0.3f, 0.3f, 0.2f, -0.35f}));
    puppet.slide("extension", visiting(t, period, {0.1f * in, 0.8f * in, in, 0}));
    puppet.turn("bucket", visiting(t, period, {-0.3f, 0.7f, 0.5f, -0.5f}));
  };
}

/// Stretches and folds its arm while it looks around.
Performance excavator_swings(const Rig& rig, Rng& rng) {
  const float pace = rng.uniform(0.9f, 1.1f), begin = rng.uniform(0, 10), in = -0.035f * size_of(rig);
  return [=](Puppet& puppet, float seconds) {
    const float t = pace * seconds + begin;
    puppet.turn("tracks", Vec3::UnitY(), 0.15f * wave(t, 5, 0.3f));
    puppet.turn("cab", 0.5f * wave(t, 4.4f));
    puppet.turn("boom", -0.22f + 0.2f * wave(t, 3.2f, 0.2f));
    puppet.turn("stick", -0.1f + 0.4f * wave(t, 2.8f, 0.5f));
    puppet.slide("extension", in + in * wave(t, 2.6f));
    puppet.turn("bucket", 0.6f * wave(t, 2.1f, 0.7f));
  };
}

}  // namespace

CreatureForm excavator_form() {
  return {excavator_plan, {{"dig", excavator_digs}, {"swing", excavator_swings}}, {}, false};
}

}  // namespace understudy
