// Where a person goes in the half second after the last frame that could be used, judged by those before.
#pragma once

#include <optional>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Goes on as the last frames went and comes to rest: the limbs soon, the body's way over the floor at the
/// end. Looks only back; memory is constant.
class PosePrediction {
 public:
  static constexpr float kLongest_s = 0.5f;  ///< from then on it holds

  void reset() { *this = {}; }
  /// A frame that could be used, `dt` seconds after the one before that could.
  void push(const Pose& pose, const Standing& standing, float dt);
  /// The pose `seconds` after the last frame pushed; that frame's own where none came before it. Feet that
  /// stood then stay where they are. rest: T-pose joints. Throws Error where none was pushed.
  Pose after(float seconds, const Joints& rest) const;
  /// How far that pose may be off, metres: as people who walk and run are found to be.
  static float doubt_m(float seconds);

 private:
  struct Speed {
    std::array<Vec3, kJointCount> turn{};  // radians/s in the joints' own frames
    Vec3 root = Vec3::Zero();              // m/s
  };

  std::optional<Pose> last_;
  Standing standing_{};
  std::optional<Speed> speed_;
};

}  // namespace understudy
