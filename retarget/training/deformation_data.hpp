// Training data of the deformation networks: places on the surfaces of bodies in T-pose, with their skin
// weights, offset bases and poses.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "retarget/training/training_data.hpp"

namespace understudy::training {

/// One step's worth, everything seen from the own side of each body (nn/modules/deformation.hpp). Points 2i
/// and 2i+1 are neighbours on the surface.
struct DeformationBatch {
  torch::Tensor points;  ///< [B, N, 3] metres
  /// [B, 22, 3] what the networks get: some bodies' joints are wrong, as at run time
  torch::Tensor seen_joints;
  torch::Tensor surface;        ///< [B, M, 3] points spread over the body
  torch::Tensor weights;        ///< [B, N, 22] truth
  torch::Tensor basis;          ///< [B, N, 567] truth, 0 on clothed people
  torch::Tensor canonical;      ///< [B, N, 3] the same place on the mean body
  torch::Tensor has_canonical;  ///< [B] 1 for bodies of the parametric family
  torch::Tensor features;       ///< [B, P, 189] pose features
  torch::Tensor transforms;     ///< [B, P, 22, 12] world transforms from the T-pose, about the true joints
};

struct DeformationDataOptions {
  int bodies = 8, points = 512, poses = 4, context_points = 512;
  float clothed_share = 0.3f;
  float noisy_share = 0.35f;   ///< of bodies seen with wrong joints
  float joint_noise = 0.015f;  ///< largest standard deviation of those, metres
  float warped_share = 0.2f;   ///< of bodies with other bone lengths, girth and a T-pose not quite held
};

/// Makes batches; the same seed gives the same batches.
class DeformationSampler {
 public:
  DeformationSampler(const TrainingData& data, const DeformationDataOptions& options, uint64_t seed);
  DeformationBatch next();
  uint64_t state() const { return rng_.state(); }
  void set_state(uint64_t state) { rng_ = Rng(state); }

 private:
  struct Surface;  // what is constant of one topology
  struct Person;   // one body of a batch
  Person draw_person();
  Rotations draw_pose();
  void warp(Person& person);
  void place(const Person& person, int row, DeformationBatch& batch);
  Points surface_of(const Person& person);
  int neighbour_face(const Surface& surface, int face);

  const TrainingData& data_;
  DeformationDataOptions options_;
  Rng rng_;
  std::vector<std::shared_ptr<const Surface>> surfaces_;  // 0 the parametric body, then the clothed
};

}  // namespace understudy::training
