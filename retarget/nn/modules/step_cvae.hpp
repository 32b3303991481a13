// The network of paper 2, section 3.2: a movement of at most one cycle of the legs as one code, with its path
// and its times.
#pragma once

#include <torch/torch.h>

#include <memory>
#include <utility>

#include "retarget/motion_space/step_form.hpp"

namespace understudy::nn {

/// Of the network's form; weights of another version are refused.
constexpr int kStepCvaeVersion = 1;

/// Lengths of the bones, each with that of the other side, as the decoder is told them.
constexpr int64_t kBoneNumbers = 13;

struct StepCvaeOptions {
  int64_t code = 64;    ///< numbers of a code, paper 2's z
  int64_t width = 208;  ///< of a hidden layer
  bool told = true;     ///< the decoder is told the body
  bool timed = true;    ///< a movement has its times; without, each takes as long as the usual one
};

/// N(mean, deviation^2) of codes, [B, code] each.
struct StepCodes {
  torch::Tensor mean, log_variance;
};

/// Fully connected layers with ReLU, and a straight way beside them both to codes and to movements: what is
/// large and simple, the path above all, need not go through the bends. The encoder does not know whose
/// movement it is, the decoder does.
/// Movements [B, kStepNumbers] are as put_step_numbers lays them out.
class StepCvaeImpl : public torch::nn::Module {
 public:
  explicit StepCvaeImpl(const StepCvaeOptions& options = {});

  StepCodes encode(const torch::Tensor& movements);
  /// Of codes [B, code] and T-pose joints [B, 22, 3], metres.
  torch::Tensor decode(const torch::Tensor& codes, const torch::Tensor& rest);

  const StepCvaeOptions& options() const { return options_; }
  /// What is usual: bones against which a body is told, and a movement's duration, seconds.
  void set_usual(const torch::Tensor& rest, double seconds);
  /// Begins as linear coder: codes are to_codes [code, kStepNumbers] times what a movement is off the mean
  /// [kStepNumbers], and back by to_movements [kStepNumbers, code].
  void begin_linear(const torch::Tensor& mean, const torch::Tensor& to_codes,
                    const torch::Tensor& to_movements);

 private:
  StepCvaeOptions options_;
  torch::Tensor usual_bones, usual_times;  // [kBoneNumbers] logarithms of metres; [kStepTimes]
  torch::nn::Linear encoder1{nullptr}, encoder2{nullptr}, encoder3{nullptr};
  torch::nn::Linear decoder1{nullptr}, decoder2{nullptr}, decoder3{nullptr};
  torch::nn::Linear straight_to_codes{nullptr}, straight_to_movements{nullptr};
};
TORCH_MODULE(StepCvae);

/// The network as a coder of movements. Its codes and movements are those of the module as it is when they
/// are asked for.
std::unique_ptr<MotionCoder> step_coder(StepCvae net);

}  // namespace understudy::nn
