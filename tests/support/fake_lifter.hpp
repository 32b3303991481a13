// A lifter that knows nothing: everybody stands like the mean human where the picture has their hips.
#pragma once

#include "retarget/base/error.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/pipeline/lifter.hpp"

namespace understudy {

class FakeLifter final : public Lifter {
 public:
  void reset(const LiftView& view) override { view_ = view, pushed_ = 0; }
  /// The pelvis is at a metre for a hundred pixels, and rises by a metre a frame.
  Extraction push(const FlatPose& pose, float dt) override {
    US_CHECK(dt > 0, "no time has passed");
    Extraction out;
    out.joints = human_rest();
    out.joints.rowwise() +=
        Eigen::RowVector3f(pose.at(body25::MidHip).x() / 100, static_cast<float>(pushed_++), dt);
    return out;
  }
  std::string name() const override { return "fake"; }
  std::any memory() const override { return pushed_; }
  void restore(const std::any& memory) override { pushed_ = std::any_cast<int>(memory); }

 private:
  LiftView view_;
  int pushed_ = 0;
};

}  // namespace understudy
