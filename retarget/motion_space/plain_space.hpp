// Ways to complete a motion that know nothing of motions: what others are measured against.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/motion_space.hpp"

namespace understudy {

/// How far off a way to fill frames is on average: metres = size * s^by_time * (v + 0.1)^by_speed, where s is
/// the time to the nearest known frame in seconds, v the mean speed of the joints around it in m/s. Fitted to
/// gaps of 5 to 60 frames.
struct DoubtLaw {
  float size, by_time, by_speed;
  float metres(float seconds, float speed) const;
};

/// Of each frame the mean speed of all joints, m/s, as known frames show it: the mean of that from the known
/// frame before to the one after, and of those just before and behind these two. 0.5 where fewer than two
/// frames are wholly known.
std::vector<float> known_speeds(const KnownMotion& question);

/// Does for each MotionSpace of this folder what all have to: checks the question, keeps what is known, tells
/// the doubt.
class PlainSpace : public MotionSpace {
 public:
  Completion complete(const KnownMotion& question) final;

 protected:
  explicit PlainSpace(const DoubtLaw& doubt) : doubt_(doubt) {}
  /// Sets what is not known in `motion`, at first the question's own. What else it sets is undone.
  virtual void fill(const KnownMotion& question, Motion& motion) = 0;

 private:
  DoubtLaw doubt_;
};

/// `hold`: the last known pose stays; before the first known one, that.
std::unique_ptr<MotionSpace> make_hold_space();
/// `slerp`: from one known frame to the next each joint takes the shortest turn, the root the straight way.
/// Stays before the first and after the last.
std::unique_ptr<MotionSpace> make_slerp_space();
/// `hermite`: see fill_curves.
std::unique_ptr<MotionSpace> make_hermite_space();

}  // namespace understudy
