#include "retarget/math/rigid.hpp"

#include "retarget/math/rotation.hpp"

namespace understudy {

RigidMotion stepped(const RigidMotion& motion, const Vec3& place, const Vec6& step) {
  RigidMotion next;
  next.R = nearest_rotation(rotation_from_axis_angle(step.head<3>()) * motion.R);
  next.t = motion(place) + step.tail<3>() - next.R * place;
  return next;
}

std::vector<RigidMotion> led_on(const std::vector<RigidMotion>& before, const std::vector<RigidMotion>& last,
                                const Points& places) {
  constexpr float kKept = 0.8f;
  std::vector<RigidMotion> next(last.size());
  for (size_t k = 0; k < last.size(); ++k) {
    const Vec3 place = places.row(static_cast<Eigen::Index>(k)).transpose();
    const Vec3 turn = rotation_to_axis_angle(last[k].R * before[k].R.transpose());
    const Vec3 at = last[k](place) + kKept * (last[k](place) - before[k](place));
    next[k].R = rotation_from_axis_angle(kKept * turn) * last[k].R;
    next[k].t = at - next[k].R * place;
  }
  return next;
}

}  // namespace understudy
