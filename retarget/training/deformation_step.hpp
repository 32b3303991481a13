// One step of the deformation networks: their loss on a batch, and how well they do on unseen people.
#pragma once

#include "retarget/nn/modules/deformation.hpp"
#include "retarget/training/deformation_data.hpp"
#include "retarget/training/loss_sum.hpp"

namespace understudy::training {

LossSum deformation_loss(nn::DeformationNet& net, const DeformationBatch& batch);

/// Evaluates on a fixed choice of a split's people, outfits and poses; every vertex counts.
class DeformationEvaluator {
 public:
  explicit DeformationEvaluator(const TrainingData& data);
  /// Dev figures, millimetres, with true rotations and root, the networks' weights and offsets: of the naked,
  /// of the naked where the networks see joints that are wrong by 10 mm (noisy), of the clothed.
  Figures evaluate(nn::DeformationNet& net) const;

 private:
  struct Target;
  void add(const TrainingData& data, const ShapedBody& body, Rng& rng);
  std::vector<std::shared_ptr<const Target>> targets_;
};

}  // namespace understudy::training
