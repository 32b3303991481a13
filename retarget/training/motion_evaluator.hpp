// How good motion transfer is on people and clips that training does not see.
#pragma once

#include "retarget/nn/modules/motion_gru.hpp"
#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// Figures of design.md, pelvis-relative, on other bodies than the source's; the truth is the source's
/// rotations.
struct MotionFigures {
  double mpjpe_mm = 0, pa_mpjpe_mm = 0, rot_deg = 0;
  double acc_mm = 0;  ///< per frame squared
};

/// Of bodies with T-pose joints `rest` [B, 22, 3] in local rotations [B, T, 22, 3, 3], T >= 3, and what was
/// true.
MotionFigures motion_figures(const torch::Tensor& rest, const torch::Tensor& local,
                             const torch::Tensor& truth);

/// Sources with and without extractor-like errors, each for a target body. It evaluates only; nothing learns
/// from it.
class MotionEvaluator {
 public:
  /// `noise`: mean length of the errors of the source's joints, metres. Clips give `most_frames` each, or all
  /// as many as the longest of them has.
  MotionEvaluator(const TrainingData& dev, float noise, int most_frames = 90);
  MotionFigures evaluate(nn::MotionGru& net) const;

 private:
  nn::MotionInput input_;
  torch::Tensor rotations_;  // of the targets, [N, T, 22, 3, 3]
};

}  // namespace understudy::training
