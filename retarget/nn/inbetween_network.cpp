#include <torch/torch.h>

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/motion_space/learned_space.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/inbetween_input.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

class InbetweenNetwork final : public WindowNetwork {
 public:
  explicit InbetweenNetwork(const std::string& path) : InbetweenNetwork(path, options_of(path)) {}
  InbetweenNetwork(const std::string& path, const InbetweenOptions& options)
      : net_(options), code_size_(static_cast<int>(options.code)) {
    load_weights(path, "motion-space", kInbetweenVersion, *net_);
    net_->eval();
  }

  std::vector<WindowAnswer> answer(const std::vector<MotionWindow>& windows,
                                   const std::vector<WindowCode>& codes) override {
    const torch::InferenceMode only_answers;
    const auto told = torch::ones({ssize(windows), 1});
    const InbetweenOutput made = net_->forward(input_of(windows), tensor_of(codes), told);
    US_CHECK(
        torch::isfinite(made.rotations).all().item<bool>() && torch::isfinite(made.root).all().item<bool>(),
        "the motion space's network gave no finite pose");
    const auto standing = made.standing.sigmoid().contiguous(), doubt = made.doubt.exp().contiguous(),
               root = made.root.contiguous();
    std::vector<WindowAnswer> answers(windows.size());
    for (int64_t b = 0; b < made.root.size(0); ++b)
      for (int64_t t = 0; t < made.root.size(1); ++t) {
        WindowAnswer& to = answers[static_cast<size_t>(b)];
        Pose& pose = to.poses.emplace_back();
        pose.local = rotations_of(made.rotations[b][t]);
        pose.root = Eigen::Map<const Vec3>(root[b][t].data_ptr<float>());
        const float* stands = standing[b][t].data_ptr<float>();
        to.standing.push_back({stands[0], stands[1]});
        to.doubt_m.push_back(doubt[b][t].item<float>());
      }
    return answers;
  }

  int code_size() const override { return code_size_; }

  WindowCode code_of(const MotionWindow& movement) override {
    const torch::InferenceMode only_answers;
    const auto mean = net_->encode(input_of({movement})).mean.contiguous();
    US_CHECK(torch::isfinite(mean).all().item<bool>(), "the motion space's network gave no finite code");
    return {mean.data_ptr<float>(), mean.data_ptr<float>() + mean.numel()};
  }

 private:
  /// [B, C]; undefined of none.
  torch::Tensor tensor_of(const std::vector<WindowCode>& codes) const {
    if (codes.empty()) return {};
    auto rows = torch::empty({ssize(codes), code_size_});
    for (int64_t i = 0; i < ssize(codes); ++i)
      std::copy_n(codes[static_cast<size_t>(i)].begin(), code_size_, rows[i].data_ptr<float>());
    return rows;
  }

  static InbetweenOptions options_of(const std::string& path) {
    const WeightsHeader header = read_weights_header(path);
    InbetweenOptions options;
    options.width = header_size(path, header, "width", options.width, 1024);
    options.inner = header_size(path, header, "inner", options.inner, 4096);
    options.layers = header_size(path, header, "layers", options.layers, 32);
    options.heads = header_size(path, header, "heads", options.heads, 64);
    options.code = header_size(path, header, "code", options.code, 256);
    US_CHECK(options.width % options.heads == 0, path, ": its width is no multiple of its heads");
    US_CHECK(options.code % 2 == 0, path, ": its codes have an odd number of numbers");
    return options;
  }

  InbetweenNet net_;
  int code_size_;
};

}  // namespace

std::unique_ptr<MotionSpace> load_inbetween_space(const std::string& path) {
  return std::make_unique<LearnedSpace>(std::make_unique<InbetweenNetwork>(path));
}

}  // namespace understudy::nn
