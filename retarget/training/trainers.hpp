// The trainers: one function a network, each in the file of its trainer.
#pragma once

#include "retarget/networks/train_options.hpp"

namespace understudy::training {

/// See nn::train. Samples are scans, for motion sequences, for deformation points.
int train(const nn::SkeletonTrainOptions& options);
int train(const nn::PartTrainOptions& options);
int train(const nn::MotionTrainOptions& options);
int train(const nn::DeformationTrainOptions& options);

}  // namespace understudy::training
