#include "tests/retarget/nn/motion_support.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "retarget/nn/modules/forward_kinematics.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::testing {

double gradient_error(const std::function<torch::Tensor(const torch::Tensor&)>& scalar,
                      const torch::Tensor& x) {
  const auto at = x.to(torch::kFloat64).detach().clone().requires_grad_();
  scalar(at).backward();
  const auto gradient = at.grad().contiguous().view(-1);
  const double h = 1e-5;
  double worst = 0;
  for (int64_t i = 0; i < gradient.size(0); ++i) {
    const auto moved = [&](double by) {
      auto y = at.detach().clone();
      y.view(-1)[i] += by;
      return scalar(y).item<double>();
    };
    const double difference = (moved(h) - moved(-h)) / (2 * h);
    worst = std::max(worst, std::abs(difference - gradient[i].item<double>()));
  }
  return worst;
}

torch::Tensor rest_joints(int64_t batch, torch::Dtype type) {
  const auto one = torch::tensor({0.f,   0.f,   0.f,   .1f,  0.f,   0.f,  -.1f, 0.f,   0.f,   0.f,   .08f,
                                  0.f,   .13f,  -.4f,  0.f,  -.13f, -.4f, 0.f,  0.f,   .15f,  0.f,   .15f,
                                  -.8f,  0.f,   -.15f, -.8f, 0.f,   0.f,  .22f, 0.f,   .17f,  -.86f, .1f,
                                  -.17f, -.86f, .1f,   0.f,  .5f,   0.f,  .03f, .44f,  0.f,   -.03f, .44f,
                                  0.f,   0.f,   .6f,   .03f, .17f,  .46f, 0.f,  -.17f, .46f,  0.f,   .4f,
                                  .46f,  0.f,   -.4f,  .46f, 0.f,   .64f, .46f, 0.f,   -.64f, .46f,  0.f})
                       .view({1, kJointCount, 3});
  const auto size = 1 + 0.1 * torch::arange(batch, torch::kFloat32).view({batch, 1, 1});
  return (one * size).to(type);
}

torch::Tensor random_rotations(int64_t batch, int64_t frames, torch::Dtype type) {
  const auto upright = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f});
  const auto r6 = upright + 0.3 * torch::randn({batch, frames, kJointCount, 6});
  return nn::rotations_from_6d(r6.to(type));
}

nn::MotionInput random_input(int64_t batch, int64_t frames) {
  const auto phase = 6 * torch::rand({batch, 1, kJointCount, 6});
  const auto time = torch::arange(frames, torch::kFloat32).view({1, frames, 1, 1});
  const auto r6 = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) + 0.3 * torch::sin(0.2 * time + phase);
  const auto rest = rest_joints(batch);
  return {nn::forward_kinematics(rest, nn::rotations_from_6d(r6)).joints + 0.01 * time,
          torch::full({batch, frames}, 0.8f), torch::full({batch, frames}, 1.0f / 30), rest.flip(0)};
}

DataFolder::DataFolder()
    : path_(
          (std::filesystem::temp_directory_path() / ("motion_data_" + std::to_string(::getpid()))).string()) {
  test::write_training_folder(path_);
}

DataFolder::~DataFolder() {
  std::filesystem::remove_all(path_);
}

}  // namespace understudy::testing
