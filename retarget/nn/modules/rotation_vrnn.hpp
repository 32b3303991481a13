// The dynamics of paper 3: a variational recurrent network that knows how bodies of a kind move. It goes on
// from poses, as the paper's does, and where poses to come are known it is told them.
#pragma once

#include <torch/torch.h>

#include <vector>

#include "retarget/nn/modules/key_curve.hpp"

namespace understudy::nn {

/// Of the network's form; weights of another version are refused.
constexpr int kDynamicsVersion = 2;
constexpr const char* kDynamicsWeights = "marionette-dynamics";  ///< kind in the header of weights

/// Smaller than those of supplement A.1 (latent 128, hidden 512, inner 128).
struct VrnnOptions {
  int64_t joints = 22;
  bool positions = false;  ///< the paper's baseline: places of joints in place of their rotations
  int64_t latent = 32, hidden = 160, inner = 96;
  int64_t ahead = 64;  ///< numbers that sum up the keys to come
};

/// Normal, each number by itself.
struct Gaussian {
  torch::Tensor mean, deviation;  ///< [..., latent]
};
/// D_KL(q || p) summed over the numbers, [...] (eq. 4).
torch::Tensor divergence(const Gaussian& q, const Gaussian& p);
/// |x - x^|^2 summed over the last two dimensions (eq. 3).
torch::Tensor squared_error(const torch::Tensor& x, const torch::Tensor& again);

/// Between two frames.
struct VrnnState {
  torch::Tensor hidden;  ///< [B, hidden], h_t
  torch::Tensor last;    ///< [B, width], the frame before
  torch::Tensor place;   ///< [B, 3] where its root is over the floor, sizes, and its heading
};

/// What is known of the frames of a sequence before they are made.
struct Ahead {
  KeyCurve curve;
  torch::Tensor summary;  ///< [B, T, ahead], 0 where no key is ahead
};
/// The same of the step to one frame.
struct AheadStep {
  torch::Tensor from, to;  ///< [B, width] the curve's, before and after it
  torch::Tensor left;      ///< [B, 1] frames from its end to the next key; -1: there is none
  torch::Tensor summary;   ///< [B, ahead]
};
/// To frame t, of which the first is given and not made.
AheadStep step_of(const Ahead& ahead, int64_t t);

/// Rows are MotionForm's without what stands: how the root goes, its height, and the joints' 6D rotations
/// against their parents, the root's with its heading taken off. Those are of the rig's own rest pose, where
/// the paper draws random directions. Of `positions` places of joints about the root, sizes, in its heading.
/// A way is the same with where the root is and how it is headed in place of how it goes.
/// Unlike the paper's, the network is told the keys to come: a second recurrent cell reads the curve through
/// them from the end to the front (a form of Harvey et al.: Robust Motion In-betweening, SIGGRAPH 2020), and
/// what is decoded is a change of that curve (Oreshkin et al.: Motion In-Betweening via Deep
/// Delta-Interpolator, 2022), which fades towards a key.
class RotationVrnnImpl : public torch::nn::Module {
 public:
  static constexpr int64_t kRoot = 4;  ///< numbers of the root: three speeds, height

  explicit RotationVrnnImpl(const VrnnOptions& options);

  int64_t width() const { return kRoot + options_.joints * (options_.positions ? 3 : 6); }
  const VrnnOptions& options() const { return options_; }
  VrnnState begin(int64_t batch, const torch::Device& device) const;
  /// way [B, T, width], of which only known frames matter; known [B, T] bool, on the CPU, see
  /// curve_through(); dt [B, T] seconds since the frame before.
  Ahead ahead(const torch::Tensor& way, const torch::Tensor& known, const torch::Tensor& dt);
  /// No key is ahead.
  AheadStep nothing_ahead(int64_t batch, const torch::Device& device) const;
  /// p(z | h) and q(z | x, h); dt [B, 1] seconds to the frame that comes.
  Gaussian prior(const VrnnState& state, const AheadStep& to, const torch::Tensor& dt);
  Gaussian posterior(const VrnnState& state, const torch::Tensor& x, const AheadStep& to,
                     const torch::Tensor& dt);
  /// The frame that z [B, latent] says, [B, width]: phi_g the root (eq. 18), phi_r the rotations (eq. 19).
  /// Without a key ahead both but for the root's speeds are changes of the frame before; with one, of the
  /// curve, from which the frame before is off by what fades evenly until the key: in the key it is the key.
  /// Rotations are orthonormal.
  torch::Tensor decoded(const torch::Tensor& z, const VrnnState& state, const AheadStep& to,
                        const torch::Tensor& dt);
  /// The recurrent cell sees the frame, as decoded or as it is known.
  void advance(const torch::Tensor& row, const torch::Tensor& z, const torch::Tensor& dt, VrnnState& state);

 private:
  VrnnOptions options_;
  torch::nn::Sequential prior_, posterior_, phi_g_, phi_r_;
  torch::nn::GRUCell cell_{nullptr};
  torch::nn::GRU backward_{nullptr};
};
TORCH_MODULE(RotationVrnn);

/// Joints about the root in its heading, sizes, [B, T, J, 3], of rows [B, T, width]; rest [B, J, 3] in sizes.
torch::Tensor row_places(const RotationVrnnImpl& net, const torch::Tensor& rows, const torch::Tensor& rest,
                         const std::vector<int>& parents);
/// [B, T, J, 3, 3] of rows of rotations.
torch::Tensor row_turns(const torch::Tensor& rows);
/// Rows [B, T, width] as a way that begins at the origin and is headed along +z; dt [B, T].
torch::Tensor way_of(const torch::Tensor& rows, const torch::Tensor& dt);
/// And back; the first frame's speeds are 0.
torch::Tensor rows_of(const torch::Tensor& way, const torch::Tensor& dt);

}  // namespace understudy::nn
