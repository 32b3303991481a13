// W_net and O_net: skin weights and pose-corrective offsets of surface points (paper 1, section 3.2), as
// LibTorch modules.
#pragma once

#include <torch/torch.h>

#include <utility>
#include <vector>

#include "retarget/networks/deformation_forward.hpp"

namespace understudy::nn {

struct DeformationOptions {
  int64_t width = 256;                      ///< hidden units a point
  int64_t trunk_blocks = 3;                 ///< residual blocks shared by W_net and O_net
  int64_t context = 96;                     ///< size of the summary of the whole surface
  int64_t code = 128;                       ///< size of the body code: joints and summary
  int64_t context_points = kContextPoints;  ///< points that the summary is made of
};

/// Size of a body: the length of its bones together over that of an adult's, [B, 1, 1]. joints [B, 22, 3].
torch::Tensor body_scale(const torch::Tensor& joints);

/// Input of W_net and O_net for a point besides the body code, [B, N, kPointFeatureCount]: its position
/// from every joint and along every bone, over the body's size, and waves of both. Unchanged when body and
/// point move or grow together.
torch::Tensor point_features(const torch::Tensor& points, const torch::Tensor& joints);

/// Points [B, N, 3] in a mirror at x = middle [B].
torch::Tensor mirror_points(const torch::Tensor& points, const torch::Tensor& middle);
/// Joints in a mirror: reflected and sides exchanged, [B, 22, 3].
torch::Tensor mirror_joints(const torch::Tensor& joints, const torch::Tensor& middle);
/// x of the plane between left and right, [B].
torch::Tensor middle_plane(const torch::Tensor& joints);
torch::Tensor mirror_weights(const torch::Tensor& weights);  ///< sides exchanged, [.., 22]
/// An offset basis [.., 567] of the mirrored body: sides exchanged, matrices and offsets reflected.
torch::Tensor mirror_basis(const torch::Tensor& basis);

/// h + fc2(silu(film(fc1(norm(h))))): film's scale and shift come from the body's code.
struct FilmBlockImpl : torch::nn::Module {
  FilmBlockImpl(int64_t width, int64_t code);
  torch::Tensor forward(const torch::Tensor& h, const torch::Tensor& code);  // [B, N, width], [B, code]
  torch::nn::LayerNorm norm{nullptr};
  torch::nn::Linear fc1{nullptr}, fc2{nullptr}, film{nullptr};
};
TORCH_MODULE(FilmBlock);

/// Output of the networks for points on their own side of a body.
struct SurfaceFunctions {
  torch::Tensor log_weights;  ///< [B, N, 22], log of skin weights that sum to 1
  torch::Tensor basis;        ///< [B, N, 567]: offset = basis as 3x189 times pose features, metres
  /// [B, N, 3] the same place on the mean body (a stepping stone: trained, not used)
  torch::Tensor canonical;
};

/// W_net and O_net with a common trunk. O_net is factored, o(theta, p) = B(p) c(theta): everything that costs
/// is computed once per target. Eq. 3 and 4 of paper 1 hold with W = exp(log_weights), o =
/// pose_offsets(basis, c).
struct DeformationNetImpl : torch::nn::Module {
  explicit DeformationNetImpl(const DeformationOptions& net_options = {});

  /// Summary of the whole body, [B, code]: T-pose joints [B, 22, 3] and points spread over its surface
  /// [B, M, 3] (in any order).
  torch::Tensor body_code(const torch::Tensor& joints, const torch::Tensor& surface);
  /// points [B, N, 3] on the own side.
  SurfaceFunctions forward(const torch::Tensor& points, const torch::Tensor& joints,
                           const torch::Tensor& code);

  DeformationOptions options;
  torch::nn::Linear context1{nullptr}, context2{nullptr}, context3{nullptr}, code1{nullptr}, code2{nullptr};
  torch::nn::Linear entry{nullptr}, to_canonical{nullptr}, from_canonical{nullptr};
  torch::nn::ModuleList trunk{nullptr};
  FilmBlock weight_block{nullptr}, offset_block{nullptr};
  torch::nn::LayerNorm weight_norm{nullptr}, offset_norm{nullptr};
  torch::nn::Linear to_weights{nullptr}, to_basis{nullptr}, to_gate{nullptr};
};
TORCH_MODULE(DeformationNet);

/// Offsets of P poses, [B, N, 3, P] metres. basis [B, N, 567], features [B, P, 189].
torch::Tensor pose_offsets(const torch::Tensor& basis, const torch::Tensor& features);

/// Eq. 3: posed points of P poses, [B, N, P, 3]. weights [B, N, 22], rest [B, N, 3, P] (offsets added),
/// transforms [B, P, 22, 12]: each joint's world transform from the T-pose, rotation row-major then
/// translation.
torch::Tensor blend_skin(const torch::Tensor& weights, const torch::Tensor& rest,
                         const torch::Tensor& transforms);

/// Skin weights [V, 22] and offset basis [V, 567] of a whole target, both sides: points [V, 3], joints [22,
/// 3], surface [M, 3] points spread over it.
struct BoundSurface {
  torch::Tensor weights, basis;
};
BoundSurface bind_surface(DeformationNet& net, const torch::Tensor& points, const torch::Tensor& joints,
                          const torch::Tensor& surface);

}  // namespace understudy::nn
