#include "retarget/nn/load.hpp"

#include <torch/torch.h>

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/motion_gru.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

class PaperTransfer : public MotionTransfer {
 public:
  explicit PaperTransfer(const std::string& path) : net_(options_of(path)) {
    load_weights(path, "motion", kMotionGruVersion, *net_);
    net_->eval();
  }

  void reset(const Joints& rest_b) override {
    US_CHECK(rest_b.allFinite() && leg_length(rest_b) > 1e-3f,
             "the target's T-pose joints are not those of a body");
    rest_b_ = tensor_of(rest_b).unsqueeze(0);
    memory_ = {};
  }

  Rotations push(const Extraction& source, float dt) override {
    US_CHECK(rest_b_.defined(), "motion transfer: no target was set");
    US_CHECK(source.joints.allFinite(), "the source's joints are not finite");
    US_CHECK(leg_length(source.joints) > 1e-3f, "the source's legs have no length");
    const torch::NoGradGuard no_grad;
    Memory next = memory_;  // kept only when the answer is good: a bad frame leaves no trace
    next.leg_sum += leg_length(source.joints);
    const auto leg = static_cast<float>(next.leg_sum / static_cast<double>(++next.frames));
    const MotionInput input{tensor_of(source.joints).view({1, 1, kJointCount, 3}), torch::full({1, 1}, leg),
                            torch::full({1, 1}, std::clamp(dt, 1.0f / 240, 0.5f)), rest_b_};
    const auto local = net_->forward(input, next.state);  // [1, 1, 22, 3, 3]
    US_CHECK(torch::isfinite(local).all().item<bool>(), "the motion network gave no finite rotation");
    memory_ = next;
    return rotations_of(local);
  }

  /// Tensors are shared, not copied: the network makes new ones each frame.
  std::any memory() const override { return memory_; }
  void restore(const std::any& memory) override { memory_ = std::any_cast<const Memory&>(memory); }
  std::string name() const override { return "paper"; }

 private:
  struct Memory {
    MotionState state;
    double leg_sum = 0;
    int64_t frames = 0;
  };

  static MotionGruOptions options_of(const std::string& path) {
    const WeightsHeader header = read_weights_header(path);
    MotionGruOptions options;
    options.hidden = header_size(path, header, "hidden", options.hidden, 1024);
    options.layers = header_size(path, header, "layers", options.layers, 4);
    const auto quaternions = header.numbers.find("quaternions");
    if (quaternions != header.numbers.end()) options.quaternions = quaternions->second != 0;
    return options;
  }

  MotionGru net_;
  torch::Tensor rest_b_;
  Memory memory_;
};

}  // namespace

std::unique_ptr<MotionTransfer> load_paper_transfer(const std::string& path) {
  return std::make_unique<PaperTransfer>(path);
}

}  // namespace understudy::nn
