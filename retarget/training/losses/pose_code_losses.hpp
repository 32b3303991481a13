// What keeps a 2D pose a person's pose when another performs it (Zheng et al. 2021, section 3.3).
#pragma once

#include <torch/torch.h>

#include <string>

namespace understudy::training {

/// Between which points virtual links are (table 3).
enum class LinkPairs { Bones, BonesAndEnds, All };
/// [P, 2] of the first 15 points of BODY_25. Ends: nose, wrists, ankles.
torch::Tensor link_pairs(LinkPairs which);
/// [D, 2] unit vectors, half a turn over `count` apart, the first at `first_deg`: 4 at 0 are the projections
/// on x = 0, y = 0, x = y, x = -y.
torch::Tensor link_directions(int count, double first_deg);

/// Each of these takes poses [B, 15, 2] and what is made of them, and a mask [B, 15] of the points that
/// count; a mean over the batch.

/// L_VL (eq. 4 and 5), sigma 0.05: sum over directions of the mean over pairs. Points that are near stay so
/// (squared), others stay in their order with a margin.
torch::Tensor virtual_link_loss(const torch::Tensor& made, const torch::Tensor& source,
                                const torch::Tensor& mask, const torch::Tensor& pairs,
                                const torch::Tensor& directions);
/// The ranking loss that it comes from (Chen et al. 2016): log(1 + exp) of the way in the wrong direction.
torch::Tensor link_ranking_loss(const torch::Tensor& made, const torch::Tensor& source,
                                const torch::Tensor& mask, const torch::Tensor& pairs,
                                const torch::Tensor& directions);
/// L_AL (eq. 6): mean over the 14 bones of |cos(angle between both) - 1|.
torch::Tensor bone_angle_loss(const torch::Tensor& made, const torch::Tensor& source,
                              const torch::Tensor& mask);
/// L_L1 of eq. 3: the sum over points.
torch::Tensor same_pose_loss(const torch::Tensor& made, const torch::Tensor& source,
                             const torch::Tensor& mask);

/// L_G by hinges, of scores [B].
torch::Tensor hinge_real(const torch::Tensor& scores);
torch::Tensor hinge_made(const torch::Tensor& scores);

}  // namespace understudy::training
