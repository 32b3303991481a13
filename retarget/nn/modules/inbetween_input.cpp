#include "retarget/nn/modules/inbetween_input.hpp"

#include <algorithm>

#include "retarget/base/index.hpp"

namespace understudy::nn {

void put_poses(const std::vector<Pose>& poses, int64_t row, torch::Tensor& rotations, torch::Tensor& root) {
  float* R = rotations.data_ptr<float>() + row * rotations.stride(0);
  float* place = root.data_ptr<float>() + row * root.stride(0);
  for (const Pose& pose : poses) {
    for (const Mat3& local : pose.local)
      for (int i = 0; i < 9; ++i) *R++ = local(i / 3, i % 3);
    place = std::copy(pose.root.data(), pose.root.data() + 3, place);
  }
}

InbetweenInput input_of(const std::vector<MotionWindow>& windows) {
  const int64_t count = ssize(windows), samples = ssize(windows.front().curve);
  InbetweenInput input{torch::empty({count, samples, kJointCount, 3, 3}), torch::empty({count, samples, 3}),
                       torch::empty({count, samples, kPartCount, 2}), torch::empty({count, kJointCount, 3})};
  for (int64_t row = 0; row < count; ++row) {
    const MotionWindow& window = windows[static_cast<size_t>(row)];
    put_poses(window.curve, row, input.rotations, input.root);
    float* distance = input.distance.data_ptr<float>() + row * input.distance.stride(0);
    for (const KnownDistance& of_sample : window.distance)
      for (const auto& part : of_sample) distance = std::copy(part.begin(), part.end(), distance);
    std::copy_n(window.rest.data(), window.rest.size(),
                input.rest.data_ptr<float>() + row * input.rest.stride(0));
  }
  return input;
}

}  // namespace understudy::nn
