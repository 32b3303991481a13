#include "retarget/nn/hybrid_transfer.hpp"

#include <torch/torch.h>

#include "retarget/base/error.hpp"
#include "retarget/nn/modules/hybrid_gru.hpp"
#include "retarget/nn/modules/joint_tensors.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

class HybridTransfer : public MotionTransfer {
 public:
  explicit HybridTransfer(const std::string& path) : net_(options_of(path)) {
    load_weights(path, "hybrid", kHybridVersion, *net_);
    net_->eval();
  }

  void reset(const Joints& rest_b) override {
    solve_.reset(rest_b);
    state_ = {};
    has_target_ = true;
  }

  Rotations push(const Extraction& source, float dt) override {
    US_CHECK(has_target_, "motion transfer: no target was set");
    const torch::NoGradGuard no_grad;
    HybridSolve solve = solve_;  // kept only when the answer is good: a bad frame leaves no trace
    HybridState state = state_;
    const auto global = net_->forward(stack_frames({{solve.push(source, dt)}}), state);  // [1, 1, 22, 3, 3]
    US_CHECK(torch::isfinite(global).all().item<bool>(), "the hybrid network gave no finite rotation");
    solve_ = std::move(solve);
    state_ = std::move(state);
    return understudy::local_rotations(to_rotations(global));
  }

  std::string name() const override { return "hybrid"; }

 private:
  static HybridGruOptions options_of(const std::string& path) {
    const WeightsHeader header = read_weights_header(path);
    HybridGruOptions options;
    options.hidden = header_size(path, header, "hidden", options.hidden, 1024);
    options.layers = header_size(path, header, "layers", options.layers, 4);
    return options;
  }

  HybridGru net_;
  HybridSolve solve_;
  HybridState state_;
  bool has_target_ = false;
};

}  // namespace

std::unique_ptr<MotionTransfer> load_hybrid_transfer(const std::string& path) {
  return std::make_unique<HybridTransfer>(path);
}

}  // namespace understudy::nn
