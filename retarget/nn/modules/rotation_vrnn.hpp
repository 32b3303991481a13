// The dynamics of paper 3: a variational recurrent network that knows how bodies of a kind move.
#pragma once

#include <torch/torch.h>

#include <vector>

namespace understudy::nn {

/// Of the network's form; weights of another version are refused.
constexpr int kDynamicsVersion = 1;
constexpr const char* kDynamicsWeights = "marionette-dynamics";  ///< kind in the header of weights

/// Sizes of supplement A.1, but for the joints.
struct VrnnOptions {
  int64_t joints = 22;
  bool positions = false;  ///< the paper's baseline: places of joints in place of their rotations
  int64_t latent = 128, hidden = 512, inner = 128;
};

/// Normal, each number by itself.
struct Gaussian {
  torch::Tensor mean, deviation;  ///< [..., latent]
};
/// D_KL(q || p) summed over the numbers and averaged over everything else (eq. 4).
torch::Tensor divergence(const Gaussian& q, const Gaussian& p);
/// |x - x^|^2 summed over the last two dimensions and averaged over everything else (eq. 3).
torch::Tensor squared_error(const torch::Tensor& x, const torch::Tensor& again);

/// Between two frames.
struct VrnnState {
  torch::Tensor hidden;  ///< [B, hidden], h_t
  torch::Tensor last;    ///< [B, width], the frame before
};

/// Rows are MotionForm's without what stands: how the root goes, its height, and the joints' 6D rotations
/// against their parents, the root's with its heading taken off. Those are of the rig's own rest pose, where
/// the paper draws random directions. Of `positions` places of joints about the root, sizes, in its heading.
class RotationVrnnImpl : public torch::nn::Module {
 public:
  static constexpr int64_t kRoot = 4;  ///< numbers of the root: three speeds, height

  explicit RotationVrnnImpl(const VrnnOptions& options);

  int64_t width() const { return kRoot + options_.joints * (options_.positions ? 3 : 6); }
  const VrnnOptions& options() const { return options_; }
  VrnnState begin(int64_t batch, const torch::Device& device) const;
  /// p(z | h) and q(z | x, h); dt [B, 1] seconds to the frame that comes.
  Gaussian prior(const VrnnState& state, const torch::Tensor& dt);
  Gaussian posterior(const VrnnState& state, const torch::Tensor& x, const torch::Tensor& dt);
  /// The frame that z [B, latent] says, [B, width]: phi_g the root (eq. 18), phi_r the rotations (eq. 19),
  /// both but for the root's speeds as changes of the frame before. Rotations are orthonormal.
  torch::Tensor decoded(const torch::Tensor& z, const VrnnState& state, const torch::Tensor& dt);
  /// The recurrent cell sees what was decoded.
  void advance(const torch::Tensor& decoded, const torch::Tensor& z, const torch::Tensor& dt,
               VrnnState& state);

 private:
  VrnnOptions options_;
  torch::nn::Sequential prior_, posterior_, phi_g_, phi_r_;
  torch::nn::GRUCell cell_;
};
TORCH_MODULE(RotationVrnn);

/// Joints about the root in its heading, sizes, [B, T, J, 3], of rows [B, T, width]; rest [B, J, 3] in sizes.
torch::Tensor row_places(const RotationVrnnImpl& net, const torch::Tensor& rows, const torch::Tensor& rest,
                         const std::vector<int>& parents);
/// [B, T, J, 3, 3] of rows of rotations.
torch::Tensor row_turns(const torch::Tensor& rows);
/// Where the root goes: headings [B, T], places [B, T, 3] in sizes, the first frame at the origin and facing
/// along +z; dt [B, T].
struct RootWay {
  torch::Tensor headings, places;
};
RootWay root_way(const torch::Tensor& rows, const torch::Tensor& dt);

}  // namespace understudy::nn
