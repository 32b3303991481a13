#include "retarget/training/proportion_step.hpp"

#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/pose2d/proportion_input.hpp"

namespace understudy::training {

LossSum proportion_loss(nn::ProportionNet& net, const ProportionBatch& batch, const torch::Device& device) {
  const auto told = net(batch.poses.to(device));
  const auto off = batch.log_length.to(device) - told.log_length;  // [B, 14]
  LossSum loss;
  loss.add("likelihood", (0.5 * (off * torch::exp(-told.log_doubt)).square() + told.log_doubt).mean());
  loss.parts.push_back({"log_error", off.detach().abs().mean().item<double>()});
  return loss;
}

std::vector<PoseLengths> read_lengths(nn::ProportionNet& net, const std::vector<FlatPose>& poses) {
  const torch::NoGradGuard no_grad;
  const auto count = static_cast<int64_t>(poses.size());
  auto inputs = torch::empty({2 * count, kProportionInputs});  // the poses, then their mirror images
  std::vector<float> sizes;
  float* row = inputs.data_ptr<float>();
  for (const bool mirrored : {false, true})
    for (const FlatPose& pose : poses) {
      const ProportionInput input = proportion_input(mirrored ? in_mirror(pose) : pose);
      Eigen::Map<Eigen::Matrix<float, 1, kProportionInputs>>(row, 1, kProportionInputs) = input.numbers;
      row += kProportionInputs;
      sizes.push_back(input.size);
    }
  const auto told = net(inputs.to(net->parameters()[0].device()));
  const auto lengths = told.log_length.cpu().contiguous(), doubts = told.log_doubt.cpu().contiguous();
  const auto row_of = [](const torch::Tensor& rows, int64_t i) {
    return Eigen::Map<const BoneLengths>(rows.data_ptr<float>() + i * kFlatBoneCount, kFlatBoneCount);
  };
  std::vector<PoseLengths> read(poses.size());
  for (int64_t i = 0; i < count; ++i)
    for (int b = 0; b < kFlatBoneCount; ++b) {
      const int other = kFlatBoneMirror[static_cast<size_t>(b)];
      PoseLengths& one = read[static_cast<size_t>(i)];
      one.log_length[b] = (row_of(lengths, i)[b] + row_of(lengths, count + i)[other]) / 2 +
                          std::log(sizes[static_cast<size_t>(i)]);
      one.doubt[b] = std::exp((row_of(doubts, i)[b] + row_of(doubts, count + i)[other]) / 2);
    }
  return read;
}

}  // namespace understudy::training
