// Completes a motion by movements that a coder knows: paper 2's optimisation of codes (sections 5 and 6).
#pragma once

#include <memory>

#include "retarget/motion_space/learned_space.hpp"
#include "retarget/pipeline/motion_coder.hpp"

namespace understudy {

/// `paper`: a decoded movement is fitted to what is known around each gap (fit_step, from the built-in walk
/// at several phases and speeds) and bent to pass through it. Where something is known on both sides the path
/// over the floor stays the curve's. What is made lies between curve and movement, by how far either is
/// expected to be off; so where no movement fits it is nearly the curve. All else is as in LearnedSpace.
class PaperSpace final : public MotionSpace {
 public:
  explicit PaperSpace(std::unique_ptr<MotionCoder> coder);
  Completion complete(const KnownMotion& question) override { return space_.complete(question); }
  std::string name() const override { return "paper"; }

 private:
  LearnedSpace space_;
};

}  // namespace understudy
