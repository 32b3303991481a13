// How far frames that were made from those around them may be off.
#pragma once

#include <vector>

#include "retarget/skeleton/pose_curve.hpp"

namespace understudy {

/// How far off a plain way to fill frames is on average: metres = size * s^by_time * (v + 0.1)^by_speed,
/// where s is the time to the nearest known frame in seconds, v the mean speed of the joints around it in
/// m/s.
struct DoubtLaw {
  float size, by_time, by_speed;
  bool since_last = false;  ///< s is the time since the last known frame, where there is one
  float metres(float seconds, float speed) const;
};

/// Of a smooth curve (fill_curves). Fitted to gaps of 2 to 60 frames in 201 captured clips; on 36 others its
/// rank correlation with the error is 0.69 to 0.86.
constexpr DoubtLaw kCurveDoubt = {0.58f, 1.34f, 0.94f};

/// Of each frame the mean speed of all joints, m/s, as known frames show it: the mean of that from the known
/// frame before to the one after, and of those just before and behind these two. 0.5 where fewer than two
/// frames are wholly known.
std::vector<float> known_speeds(const std::vector<KnownParts>& known, const Motion& motion,
                                const Joints& rest);

/// Of each frame the error that is expected of its joints on average, metres; 0 where all is known. Parts
/// count alike. `motion`: what is not known of it is not looked at.
std::vector<float> doubt_of(const DoubtLaw& law, const std::vector<KnownParts>& known, const Motion& motion,
                            const Joints& rest);
/// The same of a smooth curve.
std::vector<float> curve_doubt(const std::vector<KnownParts>& known, const Motion& motion,
                               const Joints& rest);

}  // namespace understudy
