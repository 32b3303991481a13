// When a foot stands on the floor, decided from the past only.
#pragma once

#include <algorithm>

#include "retarget/base/fields.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Figures of a person with legs (thigh and shin) of 0.8 m; scaled with the legs. Two thresholds each:
/// contact begins below the first and ends above the second.
struct FootContactOptions {
  float begin_height_m = 0.03f, end_height_m = 0.05f;  ///< over where the foot stands
  float begin_speed = 0.6f, end_speed = 1.0f;          ///< m/s
};
template <class V, class S>
FieldsOf<S, FootContactOptions> fields(V& visit, S& contact) {
  visit("begin_height_m", contact.begin_height_m);
  visit("end_height_m", contact.end_height_m);
  visit("begin_speed", contact.begin_speed);
  visit("end_speed", contact.end_speed);
}

/// Height of the lowest joint of the feet.
inline float lowest_foot(const Joints& joints) {
  return std::min({joints(LeftAnkle, 1), joints(RightAnkle, 1), joints(LeftFoot, 1), joints(RightFoot, 1)});
}

/// Hysteresis for one point of a foot.
class ContactSwitch {
 public:
  explicit ContactSwitch(const FootContactOptions& options = {}, float leg_m = 0.8f);
  void reset() { on_ = started_ = false; }
  /// Whether the point is in contact. position: world; standing_height: y of the point when it stands.
  bool push(const Vec3& position, float standing_height, float dt);
  /// m/s of a person with legs of 0.8 m, as of the last push().
  float speed() const { return velocity_.norm() / scale_; }

 private:
  FootContactOptions options_;
  float scale_;
  Vec3 last_ = Vec3::Zero(), velocity_ = Vec3::Zero();
  bool on_ = false, started_ = false;
};

}  // namespace understudy
