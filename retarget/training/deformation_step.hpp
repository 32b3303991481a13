// One step of the deformation networks: their loss on a batch, and how well they do on unseen people.
#pragma once

#include "retarget/nn/modules/deformation.hpp"
#include "retarget/training/deformation_data.hpp"

namespace understudy::training {

struct DeformationLoss {
  torch::Tensor total;  ///< what is minimised
  double geometry_mm = 0, edge_mm = 0, weight_kl = 0, offset_mm = 0, canonical_mm = 0;
};

DeformationLoss deformation_loss(nn::DeformationNet& net, const DeformationBatch& batch);

/// Dev figures, millimetres: true rotations and root, the networks' weights and offsets.
struct DeformationScore {
  double mpvd_mm = 0, medl_mm = 0;  ///< naked
  double clothed_mpvd_mm = 0, clothed_medl_mm = 0;
  double noisy_mpvd_mm = 0;  ///< naked, the networks see joints that are wrong by 10 mm
};

/// Evaluates on a fixed choice of a split's people, outfits and poses; every vertex counts.
class DeformationEvaluator {
 public:
  explicit DeformationEvaluator(const TrainingData& data);
  DeformationScore score(nn::DeformationNet& net) const;

 private:
  struct Target;
  void add(const TrainingData& data, const ShapedBody& body, Rng& rng);
  std::vector<std::shared_ptr<const Target>> targets_;
};

}  // namespace understudy::training
