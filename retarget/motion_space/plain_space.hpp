// Ways to complete a motion that know nothing of motions: what others are measured against.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/motion_space.hpp"
#include "retarget/skeleton/curve_doubt.hpp"

namespace understudy {

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
/// `glide`: hold, but the root goes on as fast as between the two known frames at that end of the gap.
std::unique_ptr<MotionSpace> make_glide_space();
/// `coast`: each joint goes on turning so fast, too, and never comes to rest.
std::unique_ptr<MotionSpace> make_coast_space();
/// `slerp`: from one known frame to the next each joint takes the shortest turn, the root the straight way.
/// Stays before the first and after the last.
std::unique_ptr<MotionSpace> make_slerp_space();
/// `hermite`: see fill_curves.
std::unique_ptr<MotionSpace> make_hermite_space();

}  // namespace understudy
