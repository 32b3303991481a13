// Where a styled source goes: its feet stand where the source's stand, and its flights keep their shape.
#pragma once

#include "retarget/style/foot_level.hpp"
#include "retarget/style/foot_points.hpp"
#include "retarget/style/pose_style.hpp"

namespace understudy {

/// Online, of constant memory. While a foot of the source stands the pelvis moves so that the styled foot
/// stands, too, so styled steps lead along a path of their own; between, as the source's does, at the ratio
/// of the paths so far. Heights: the lower foot is as high as the source's lower foot, in flights the pelvis
/// rises and falls as the source's. Without a foot that stands (lying, hanging) the path is the source's.
class StyledRoot {
 public:
  void reset() { *this = StyledRoot(); }
  /// Where the pelvis of the styled pose is. styled: its local rotations.
  Vec3 push(const StyleFrame& source, const Rotations& styled);
  /// Of the newest frame.
  const StyledFeet& feet() const { return last_; }

 private:
  FootPoints<float> bearing(const FootPoints<Vec3>& feet, float leg, float dt);
  Vec3 step(const StyleFrame& source, const StyledFeet& feet);

  FootPoints<FootLevel> levels_;
  StyledFeet last_;
  Vec3 last_root_ = Vec3::Zero(), root_ = Vec3::Zero();  // of the source; of the result
  float offset_ = 0;                                     // of the result's height over the source's
  float way_source_ = 0, way_styled_ = 0;                // over the floor, of the last seconds
  bool started_ = false;
};

}  // namespace understudy
