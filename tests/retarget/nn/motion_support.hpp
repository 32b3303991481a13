// Shared by the tests of motion transfer: people, motions, finite differences.
#pragma once

#include <torch/torch.h>

#include <functional>

#include "retarget/nn/modules/motion_gru.hpp"
#include "retarget/skeleton/skeleton.hpp"
#include "retarget/training/motion_data.hpp"

namespace understudy::testing {

/// Greatest difference between the gradient of a scalar function at x (float64) and its central differences.
double gradient_error(const std::function<torch::Tensor(const torch::Tensor&)>& scalar,
                      const torch::Tensor& x);

/// T-pose joints of somebody, [B, 22, 3] metres, a little different in each row.
torch::Tensor rest_joints(int64_t batch, torch::Dtype type = torch::kFloat32);
/// Valid random rotations, [B, T, 22, 3, 3].
torch::Tensor random_rotations(int64_t batch, int64_t frames, torch::Dtype type = torch::kFloat32);
/// What the network sees of somebody in smooth random motion.
nn::MotionInput random_input(int64_t batch, int64_t frames);

/// A folder of data for training with one body and two clips; removed with the object.
class DataFolder {
 public:
  DataFolder();
  ~DataFolder();
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace understudy::testing
