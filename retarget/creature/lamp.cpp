// A desk lamp: a heavy foot, two rods, and a shade that looks about.
#include "retarget/creature/forms.hpp"

namespace understudy {
namespace {

void lamp_shade(CreaturePlan& plan, float wide) {
  const Vec3 head = plan.at("shade"), ahead = Vec3(0, -0.75f, 0.66f).normalized();
  const Vec3 back = head - 0.03f * ahead, rim = head + 0.24f * ahead;
  plan.add("shade", frustum_part(back - 0.07f * ahead, 0.05f, back + 0.06f * ahead, 0.07f, 0.015f));
  plan.add("shade", meshed_as(0.035f, frustum_part(head + 0.01f * ahead, 0.075f, rim, wide, 0.02f)), 0.02f);
  plan.carve("shade",
             meshed_as(0.03f, frustum_part(head + 0.12f * ahead, 0.06f, rim + 0.06f * ahead, wide, 0.01f)),
             0.015f);
  plan.add("shade", ellipsoid_part(head + 0.15f * ahead, Vec3(0.055f, 0.055f, 0.055f)));
}

CreaturePlan lamp_plan(Rng& rng) {
  const float lower = rng.uniform(0.42f, 0.56f), upper = rng.uniform(0.4f, 0.52f),
              wide = rng.uniform(0.16f, 0.2f), rod = rng.uniform(0.022f, 0.03f);
  CreaturePlan plan;
  plan.machine = true;
  plan.scale = rng.uniform(0.4f, 0.6f);
  plan.vertices = 7500;
  plan.cell = 0.008f;
  const Vec3 knee(0, 0.115f, 0), elbow = knee + lower * Vec3(0, 0.9f, -0.43f),
                                 head = elbow + upper * Vec3(0, 0.55f, 0.83f);
  plan.joint("foot", "", JointKind::Free, Vec3::Zero());
  plan.joint("swivel", "foot", JointKind::Hinge, Vec3(0, 0.06f, 0), Vec3::UnitY());
  plan.joint("lower_arm", "swivel", JointKind::Hinge, knee);
  plan.joint("elbow", "lower_arm", JointKind::Hinge, elbow);
  plan.joint("shade", "elbow", JointKind::Ball, head);
  const Vec3 x = Vec3::UnitX();
  plan.add("foot", meshed_as(0.04f, frustum_part({0, 0, 0}, 0.235f, {0, 0.065f, 0}, 0.23f, 0.024f)));
  plan.add("swivel", frustum_part({0, 0.055f, 0}, 0.075f, {0, 0.11f, 0}, 0.05f, 0.015f));
  plan.add("swivel", cone_part(knee - 0.02f * x, 0.052f, knee + 0.02f * x, 0.052f));
  plan.add("lower_arm", cone_part(knee, rod, elbow, rod));
  plan.add("lower_arm", frustum_part(elbow - 0.05f * x, 0.048f, elbow + 0.05f * x, 0.048f, 0.02f));
  plan.add("elbow", cone_part(elbow, rod, head, rod));
  plan.add("elbow", cone_part(head, 0.04f, head + 0.001f * x, 0.04f));
  lamp_shade(plan, wide);
  return plan;
}

/// Looks at one thing after the other.
Performance lamp_looks_about(const Rig&, Rng& rng) {
  const float period = rng.uniform(3.8f, 4.6f), far = from_degrees(rng.uniform(22, 30)),
              begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin;
    puppet.turn("swivel", visiting(t, period, {far, far, -far, -far}));
    puppet.turn("lower_arm", visiting(t, period, {0, 0.22f, 0.05f, -0.15f}));
    puppet.turn("elbow", visiting(t, period, {-0.2f, 0.25f, -0.15f, 0.15f}));
    puppet.turn("shade", Vec3::UnitX(), visiting(t, period, {0.1f, -0.4f, 0.15f, -0.3f}));
    puppet.turn("shade", Vec3::UnitY(), visiting(t, period, {0.4f, 0.1f, -0.4f, 0}));
  };
}

/// Crouches and stretches, and shakes its head.
Performance lamp_stretches(const Rig&, Rng& rng) {
  const float period = rng.uniform(1.9f, 2.5f), deep = rng.uniform(0.3f, 0.42f),
              begin = rng.uniform(0, period);
  return [=](Puppet& puppet, float seconds) {
    const float t = seconds + begin, bent = wave(t, period);
    puppet.turn("swivel", 0.3f * wave(t, 1.7f * period));
    puppet.turn("lower_arm", 0.1f - deep * bent);
    puppet.turn("elbow", 0.1f + 1.3f * deep * bent);
    puppet.turn("shade", Vec3::UnitX(), -0.5f * deep * bent - 0.2f);
    puppet.turn("shade", Vec3(0, 0.66f, 0.75f), 0.4f * wave(t, 0.8f * period));
  };
}

}  // namespace

CreatureForm lamp_form() {
  return {lamp_plan, {{"look_about", lamp_looks_about}, {"stretch", lamp_stretches}}, {}, false};
}

}  // namespace understudy
