// How thick a body is around its bones.
#pragma once

#include <array>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// Distances of a surface from the bones in it, at stations along trunk, head, thighs and arms, in eight
/// directions around each (of the trunk: left, left front, front, ...). Metres; 0 where nothing was seen.
struct BodyGirth {
  static constexpr int kStations = 13, kDirections = 8;
  std::array<std::array<float, kDirections>, kStations> radius{};
};

/// Where a point lies on a body: which bone, how far along it, how far from it.
struct GirthPlace {
  int joint = Pelvis, end = Spine1;  ///< of the bone; end -1: the head's, a hand's or a foot's
  int station = -1;                  ///< -1: of a part that has none
  float along = 0;                   ///< 0 at the joint, 1 at the bone's end; beyond both
  float direction = 0;               ///< 0 .. kDirections around the bone
  Vec3 radial = Vec3::Zero();        ///< from the bone's axis, T-pose axes, metres
  bool sure = false;                 ///< neither beyond the station nor as near to an arm as to a body
};

/// The place of a point near the body in this pose: `global` are the joints' world rotations.
GirthPlace girth_place(const Vec3& point, const Joints& joints, const Rotations& global);

/// Measured on at most 500 of the points, those that are sure. `global` as above.
BodyGirth measure_girth(const Joints& joints, const Rotations& global, const Points& surface);
/// The same of a scan and what was extracted from it; rotations that were not seen are solved, and bones that
/// are lost (is_lost) have no girth.
BodyGirth measure_girth(const Extraction& source, const Points& scan);

/// A mean adult's (of the built-in people), with legs one metre long.
const BodyGirth& human_girth();

/// One body's girth from the frames so far, in bounded memory.
class RunningGirth {
 public:
  void clear() { *this = RunningGirth(); }
  void push(const BodyGirth& seen);
  /// Of a person with legs of leg_m: where nothing was seen a human's, as thick as the rest of that station.
  BodyGirth value(float leg_m) const;

 private:
  BodyGirth mean_;
  std::array<std::array<float, BodyGirth::kDirections>, BodyGirth::kStations> count_{};
};

}  // namespace understudy
