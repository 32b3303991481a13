#include "retarget/training/lift_step.hpp"

#include <utility>

#include "retarget/metrics/joint_metrics.hpp"

namespace understudy::training {
namespace {

constexpr double kWayWeight = 1, kLengthWeight = 0.3, kOffWeight = 0.02, kTurnWeight = 0.1,
                 kPitchWeight = 0.1;
constexpr uint64_t kLiftFigureSeed = 20210203;
constexpr float kLiftFigureJitter = 0.015f, kLiftFigureLengths = 0.05f;

torch::Tensor length_of(const torch::Tensor& ways) {
  return ways.square().sum(-1).add(1e-10).sqrt();
}

torch::Tensor lifted_bones(const torch::Tensor& joints) {
  const std::vector<int64_t> parents(kParents.begin() + 1, kParents.end());
  const auto from = torch::tensor(parents).to(joints.device());
  return length_of(joints.slice(-2, 1) - joints.index_select(-2, from));
}

}  // namespace

LossSum lift_loss(nn::LifterNet& net, const LiftBatch& batch, const torch::Device& device) {
  torch::Tensor state;
  const auto told = net(batch.frames.to(device), state);
  const auto joints = batch.joints.to(device);
  const auto off = length_of(told.joints - joints);  // [B, T, 22]
  const auto ways = [](const torch::Tensor& places) {
    return places.slice(1, 1) - places.slice(1, 0, places.size(1) - 1);
  };
  LossSum loss;
  loss.add("places", off.mean());
  loss.add("ways", length_of(ways(told.joints) - ways(joints)).mean(), kWayWeight);
  loss.add("lengths", (lifted_bones(told.joints) - lifted_bones(joints)).abs().mean(), kLengthWeight);
  loss.add("doubts", (off.detach() * torch::exp(-told.log_off) + told.log_off).mean(), kOffWeight);
  loss.add("turns", (told.turns - batch.turns.to(device)).abs().mean(), kTurnWeight);
  loss.add("pitch", (told.pitch - batch.pitch.to(device)).abs().mean(), kPitchWeight);
  return loss;
}

LiftFigures::LiftFigures(TrainingData data, int cases, int frames) {
  const FlatShots shots(std::move(data), frames);
  for (const bool noisy : {false, true}) {
    Rng rng(kLiftFigureSeed);
    LiftErrors errors;
    errors.lengths = kLiftFigureLengths;
    if (noisy) errors.detector.jitter_m = kLiftFigureJitter;
    Suite& suite =
        suites_.emplace_back(Suite{noisy ? "noisy" : "clean", empty_lift_batch(cases, frames), {}});
    for (int i = 0; i < cases; ++i) {
      const FlatShot shot = shots.plain(rng);
      LiftSequence sequence = lift_sequence(shot, shots.template_leg(), errors, rng);
      put_sequence(sequence, i, suite.batch);
      suite.truth.push_back(std::move(sequence.truth));
    }
  }
}

Figures LiftFigures::of(nn::LifterNet& net, const torch::Device& device) const {
  const torch::NoGradGuard no_grad;
  Figures figures;
  for (const Suite& suite : suites_) {
    torch::Tensor state;
    const auto told = net(suite.batch.frames.to(device), state);
    const auto joints = told.joints.cpu().contiguous();
    const float* row = joints.data_ptr<float>();
    JointSequence predicted, truth;
    for (const auto& one : suite.truth)
      for (const LiftTruth& frame : one) {
        predicted.push_back(Eigen::Map<const Joints>(row, kJointCount, 3));
        truth.push_back(frame.joints);
        row += 3 * kJointCount;
      }
    const auto pitch = told.pitch.cpu().mean(1).clamp(-1, 1).asin();
    const auto off = (pitch - suite.batch.pitch.select(1, 0).asin()).abs().mean();
    figures.push_back({std::string("pitch_deg_") + suite.name, off.item<double>() * 180 / M_PI});
    figures.push_back({std::string("n_mpjpe_mm_") + suite.name,
                       1000 * mean_joint_error(scaled_joints(predicted, truth), truth)});
    figures.push_back({std::string("pa_mpjpe_mm_") + suite.name,
                       1000 * mean_joint_error(aligned_joints(predicted, truth), truth)});
  }
  return figures;
}

}  // namespace understudy::training
