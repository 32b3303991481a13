#include <torch/torch.h>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/step_cvae.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

class StepCoder final : public MotionCoder {
 public:
  explicit StepCoder(StepCvae net) : net_(std::move(net)) {}

  int size() const override { return static_cast<int>(net_->options().code); }
  std::string name() const override { return "paper"; }

  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    const StepNumbers numbers = step_numbers(movement, rest);
    const torch::NoGradGuard no_grad;
    const StepCodes codes = net_->encode(tensor_of(numbers).t());
    US_CHECK(torch::isfinite(codes.mean).all().item<bool>() &&
                 torch::isfinite(codes.log_variance).all().item<bool>(),
             "the motion coder's network gave no finite code");
    return {numbers_of(codes.mean), numbers_of((0.5 * codes.log_variance).exp())};
  }

  TimedPoses decode(const std::vector<float>& code, const Joints& rest) override {
    US_CHECK(ssize(code) == size(), "a movement's code is ", size(), " numbers, not ", code.size());
    const torch::NoGradGuard no_grad;
    const auto z = torch::tensor(code).unsqueeze(0);
    US_CHECK(torch::isfinite(z).all().item<bool>(), "a movement's code is not finite");
    const auto made = net_->decode(z, tensor_of(rest).unsqueeze(0)).contiguous();
    return movement_of_numbers(Eigen::Map<const StepNumbers>(made.data_ptr<float>(), kStepNumbers), rest);
  }

 private:
  static std::vector<float> numbers_of(const torch::Tensor& row) {
    const auto flat = row.contiguous();
    return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
  }

  StepCvae net_;
};

StepCvaeOptions step_options_of(const std::string& path) {
  const WeightsHeader header = read_weights_header(path);
  const auto flag = [&](const char* key, bool usual) {
    const auto found = header.numbers.find(key);
    return found == header.numbers.end() ? usual : found->second != 0;
  };
  StepCvaeOptions options;
  options.code = header_size(path, header, "code", options.code, 1024);
  options.width = header_size(path, header, "width", options.width, 4096);
  options.told = flag("told", options.told);
  options.timed = flag("timed", options.timed);
  return options;
}

}  // namespace

std::unique_ptr<MotionCoder> step_coder(StepCvae net) {
  return std::make_unique<StepCoder>(std::move(net));
}

std::unique_ptr<MotionCoder> load_step_coder(const std::string& path) {
  StepCvae net(step_options_of(path));
  load_weights(path, "motion-steps", kStepCvaeVersion, *net);
  net->eval();
  return step_coder(std::move(net));
}

}  // namespace understudy::nn
