// A snake: one long chain that follows its own head.
#include <Eigen/Geometry>
#include <cmath>

#include "retarget/creature/forms.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kVertebrae = 13;  // joints from the tail's end to the neck; the head is one more

std::string vertebra(int i) {
  return i + 1 == kVertebrae ? "neck"
         : i < 3             ? "tail_" + std::to_string(3 - i)
                             : "spine_" + std::to_string(i - 2);
}

float snake_radius(float along, float thick) {  // along: 0 tail's end .. 1 neck
  const float tail = std::sqrt(std::min(1.0f, 0.06f + 1.6f * along)),
              neck = 1 - 0.35f * std::pow(along, 6.0f);
  return thick * tail * neck;
}

CreaturePlan snake_plan(Rng& rng) {
  const float thick = rng.uniform(0.058f, 0.075f), length = rng.uniform(1.6f, 1.9f),
              broad = rng.uniform(1.15f, 1.45f);
  CreaturePlan plan;
  plan.scale = rng.uniform(0.7f, 1.3f);
  plan.vertices = 5000;
  plan.coarse_at = 0.055f;
  const float bone = length / kVertebrae, back = -0.5f * length;
  const auto place = [&](float i) {
    const float r = snake_radius(std::min(1.0f, i / (kVertebrae - 1)), thick);
    return Vec3(0, r, back + bone * i);
  };
  for (int i = 0; i < kVertebrae; ++i)
    plan.joint(vertebra(i), i == 0 ? "" : vertebra(i - 1), i == 0 ? JointKind::Free : JointKind::Ball,
               place(static_cast<float>(i)));
  const Vec3 head = place(kVertebrae);
  plan.joint("head", "neck", JointKind::Ball, head);
  const Vec3 end = place(0) - Vec3(0, 0, 0.9f * bone);
  plan.add(vertebra(0), cone_part({0, 0.012f, end.z()}, 0.011f, place(0), snake_radius(0, thick)));
  for (int i = 0; i < kVertebrae; ++i) {
    const auto at = static_cast<float>(i);
    plan.add(vertebra(i), cone_part(place(at), place(at).y(), place(at + 1), place(at + 1).y()));
  }
  const float r = head.y();
  plan.add("head", ellipsoid_part(head + Vec3(0, 0.1f * r, 0.9f * r), {broad * r, 0.85f * r, 1.5f * r}));
  plan.add("head", ellipsoid_part(head + Vec3(0, -0.05f * r, 2.2f * r), {0.75f * r, 0.55f * r, 0.9f * r}),
           0.02f);
  for (const float side : {1.0f, -1.0f})
    plan.add("head",
             ellipsoid_part(head + Vec3(side * 0.6f * r, 0.75f * r, 1.4f * r), Vec3::Constant(0.25f * r)));
  return plan;
}

/// Lays the chain along a curve from curve(begin) on: each joint as high above it as above the floor at rest,
/// a bone's length after the last.
void lay_along(Puppet& puppet, const Rig& rig, float begin, const std::function<Vec3(float)>& curve) {
  float s = begin;
  const auto above = [&](float at, int i) -> Vec3 {
    const size_t j = static_cast<size_t>(std::min(i, rig.count() - 1));
    return curve(at) + rig.joints[j].rest.y() * Vec3::UnitY();
  };
  Vec3 here = above(s, 0);
  puppet.pose.root = here;
  Mat3 before = Mat3::Identity();
  for (int i = 0; i < rig.count(); ++i) {
    const bool last = i + 1 == rig.count();
    const auto j = static_cast<size_t>(i);
    const Vec3 bone = last ? Vec3(0, 0, (rig.joints[j].rest - rig.joints[j - 1].rest).norm())
                           : Vec3(rig.joints[j + 1].rest - rig.joints[j].rest);
    float low = s, high = s + 2 * bone.norm();
    for (int halving = 0; halving < 24; ++halving) {
      const float middle = 0.5f * (low + high);
      ((above(middle, i + 1) - here).norm() < bone.norm() ? low : high) = middle;
    }
    s = low;
    const Vec3 way = above(s, i + 1) - here;
    const Mat3 R = rotation_between(before * bone, way) * before;
    puppet.pose.turns[j] = before.transpose() * R;
    before = R;
    here += R * bone;
  }
}

/// Winds along a wavy track on the floor.
Performance snake_slithers(const Rig& rig, Rng& rng) {
  const float length = size_of(rig);
  const float swing = length * rng.uniform(0.085f, 0.115f), wavelength = length * rng.uniform(0.5f, 0.62f),
              speed = length * rng.uniform(0.2f, 0.28f), phase = rng.uniform(0, 1);
  return [=, &rig](Puppet& puppet, float seconds) {
    lay_along(puppet, rig, speed * seconds - 0.5f * length,
              [=](float s) { return Vec3(swing * std::sin(2 * kPi * (s / wavelength + phase)), 0, s); });
  };
}

/// Rears up in front and sways, while the rest winds in place.
Performance snake_rears(const Rig& rig, Rng& rng) {
  const float length = size_of(rig);
  const float swing = length * rng.uniform(0.08f, 0.1f), wavelength = length * rng.uniform(0.42f, 0.5f),
              period = rng.uniform(2.4f, 3.2f), up = length * rng.uniform(0.26f, 0.34f);
  return [=, &rig](Puppet& puppet, float seconds) {
    const float raised = up * (0.75f + 0.25f * wave(seconds, 1.3f * period)), sway = wave(seconds, period);
    lay_along(puppet, rig, -0.5f * length, [=](float s) {
      const float ahead = std::max(0.0f, (s / length - 0.02f) / 0.25f), lifted = std::min(1.0f, ahead);
      const float calm = 1 - lifted * lifted * (3 - 2 * lifted);
      const float x = calm * swing * std::sin(2 * kPi * (s / wavelength + seconds / (1.5f * period)));
      const float bow = lifted * lifted * (3 - 2 * lifted);
      return Vec3(x + 0.45f * up * bow * sway, raised * bow, s);
    });
    puppet.turn("head", Vec3::UnitX(), 0.7f);
    puppet.turn("head", Vec3::UnitY(), 0.4f * wave(seconds, period, 0.2f));
  };
}

}  // namespace

CreatureForm snake_form() {
  return {
      snake_plan, {{"slither", snake_slithers}, {"rear", snake_rears}}, {"spine_4", "spine_5", "spine_6"}};
}

}  // namespace understudy
