// Evaluates motion transfer on people and clips that training does not see.
#pragma once

#include <string>
#include <vector>

#include "retarget/nn/modules/motion_gru.hpp"
#include "retarget/training/loss_sum.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// Sources with or without errors like an extractor's, each for a target body.
class MotionEvaluator {
 public:
  /// `noise`: mean length of the errors of the source's joints, metres. Throws Error without clips.
  MotionEvaluator(const TrainingData& dev, float noise);
  /// mpjpe_mm, pa_mpjpe_mm and rot_deg of design.md, the prefix before each name: pelvis-relative, on other
  /// bodies than the source's; the truth is the source's rotations.
  Figures evaluate(nn::MotionGru& net, const std::string& prefix) const;

 private:
  struct Case {
    Joints rest;  // of the target
    std::vector<Rotations> truth;
  };
  nn::MotionInput input_;  // of all cases
  std::vector<Case> cases_;
};

}  // namespace understudy::training
