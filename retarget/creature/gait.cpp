#include "retarget/creature/gait.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"

namespace understudy {

RigidMotion Gait::body(float seconds) const {
  const float heading = style_.turning * seconds;
  if (std::abs(style_.turning) < 1e-3f) return {Mat3::Identity(), {0, 0, style_.speed * seconds}};
  const float radius = style_.speed / style_.turning;  // of the circle that it walks on
  return {rotation_about_y(heading), {radius * (1 - std::cos(heading)), 0, radius * std::sin(heading)}};
}

Gait::Step Gait::step(size_t foot, float seconds) const {
  const float cycles = seconds / style_.period + style_.phases[foot];
  const float number = std::floor(cycles), phase = cycles - number;
  const auto standing = [&](float of) {  // in the middle of that stance the body is right above
    return body((of + 0.5f * style_.down - style_.phases[foot]) * style_.period);
  };
  const RigidMotion here = standing(number);
  if (phase < style_.down) return {here(feet_[foot]), here.R, 0};
  const RigidMotion next = standing(number + 1);
  const float swing = (phase - style_.down) / (1 - style_.down), way = smooth_step(0, 1, swing);
  Vec3 place = (1 - way) * here(feet_[foot]) + way * next(feet_[foot]);
  place.y() += style_.lift * std::sin(kPi * swing);
  const float turned = heading_of(here.R.transpose() * next.R);
  return {place, here.R * rotation_about_y(way * turned), swing};
}

void plant_feet(Puppet& puppet, const std::vector<Limb>& limbs, const Gait& gait, float seconds, float tip) {
  for (size_t i = 0; i < limbs.size(); ++i) {
    const Gait::Step step = gait.step(i, seconds);
    const float tipped = tip * std::pow(std::sin(kPi * step.swing), 2.0f);
    const Mat3 down = Eigen::AngleAxisf(tipped, Vec3::UnitX()).toRotationMatrix();
    puppet.plant(limbs[i], step.place, step.facing * (limbs[i].paw >= 0 ? down : Mat3::Identity()),
                 limbs[i].paw >= 0 ? 0.5f * tipped : 0);
  }
}

std::vector<Vec3> contacts_of(const std::vector<Limb>& limbs) {
  std::vector<Vec3> contacts;
  contacts.reserve(limbs.size());
  for (const Limb& limb : limbs) contacts.push_back(limb.contact);
  return contacts;
}

}  // namespace understudy
