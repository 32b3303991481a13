#include "retarget/training/motion_evaluator.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/training/motion_data.hpp"

namespace understudy::training {
namespace {

constexpr int kCases = 24;

/// Frames in a row without a flag.
struct Run {
  int first = 0, count = 0;
};

Run longest_run(const Clip& clip) {
  Run best;
  for (size_t i = 0; i < clip.good.size();) {
    size_t end = i + 1;
    while (end < clip.good.size() && clip.good[end] == clip.good[end - 1] + 1) ++end;
    if (static_cast<int>(end - i) > best.count) best = {clip.good[i], static_cast<int>(end - i)};
    i = end;
  }
  return best;
}

torch::Tensor tensor_of(const std::vector<Joints>& joints) {
  const auto count = static_cast<int64_t>(joints.size());
  return torch::from_blob(const_cast<float*>(joints[0].data()), {count, kJointCount, 3}, torch::kFloat32)
      .clone();
}

double aligned_error_mm(const torch::Tensor& made, const torch::Tensor& truth) {
  const auto a = made.contiguous().view({-1, kJointCount, 3}),
             b = truth.contiguous().view({-1, kJointCount, 3});
  double sum = 0;
  for (int64_t i = 0; i < a.size(0); ++i) {
    const Points from = Eigen::Map<const Joints>(a.data_ptr<float>() + i * kJointCount * 3);
    const Points to = Eigen::Map<const Joints>(b.data_ptr<float>() + i * kJointCount * 3);
    sum += (similarity_alignment(from, to).apply(from) - to).rowwise().norm().mean();
  }
  return 1000 * sum / static_cast<double>(a.size(0));
}

}  // namespace

MotionFigures motion_figures(const torch::Tensor& rest, const torch::Tensor& local,
                             const torch::Tensor& true_local) {
  const auto made = nn::forward_kinematics(rest, local);
  const auto truth = nn::forward_kinematics(rest, true_local);
  const auto between = torch::matmul(made.global.transpose(-1, -2), truth.global);
  const auto trace = between.diagonal(0, -2, -1).sum(-1);
  const auto error = made.joints - truth.joints;
  const auto T = error.size(1);
  const auto bent = error.slice(1, 2) - 2 * error.slice(1, 1, T - 1) + error.slice(1, 0, T - 2);
  MotionFigures figures;
  figures.mpjpe_mm = 1000 * error.norm(2, -1).mean().item<double>();
  figures.pa_mpjpe_mm = aligned_error_mm(made.joints, truth.joints);
  figures.rot_deg = 180 / kPi * ((trace - 1) / 2).clamp(-1, 1).acos().mean().item<double>();
  figures.acc_mm = 1000 * bent.norm(2, -1).mean().item<double>();
  return figures;
}

MotionEvaluator::MotionEvaluator(const TrainingData& dev, float noise, int most_frames) {
  int frames = 0;
  for (const Clip& clip : dev.clips)
    frames = std::max(frames, std::min(most_frames, longest_run(clip).count));
  Rng rng(7);
  std::vector<torch::Tensor> source, leg, rest, rotations;
  const auto body = [&] {
    return dev.body.shaped(dev.betas[rng.below(static_cast<int>(dev.betas.size()))]).joints;
  };
  std::vector<const Clip*> clips;
  for (const Clip& clip : dev.clips)
    if (frames > 1 && longest_run(clip).count >= frames) clips.push_back(&clip);
  US_CHECK(!clips.empty(), "the dev split has no motion to evaluate by");
  const size_t every = std::max<size_t>(1, clips.size() / kCases);
  for (size_t c = 0; c < clips.size(); c += every) {
    const int first = longest_run(*clips[c]).first;
    const Joints rest_a = body();
    std::vector<Joints> seen;
    std::vector<torch::Tensor> local;
    for (int t = 0; t < frames; ++t) {
      Pose pose = clips[c]->motion.poses[first + t];
      pose.root.setZero();
      seen.push_back(forward_kinematics(rest_a, pose).joints);
      for (const Mat3& R : pose.local)
        local.push_back(torch::from_blob(const_cast<float*>(R.data()), {3, 3}, torch::kFloat32).t().clone());
    }
    add_joint_errors(seen, noise, 1.0f / 30, rng);
    std::vector<float> legs;
    float sum = 0;
    for (const Joints& joints : seen)
      legs.push_back((sum += leg_length(joints)) / static_cast<float>(legs.size() + 1));
    source.push_back(tensor_of(seen));
    leg.push_back(torch::tensor(legs));
    rotations.push_back(torch::stack(local).view({frames, kJointCount, 3, 3}));
    rest.push_back(tensor_of({body()})[0]);
  }
  input_ = {torch::stack(source), torch::stack(leg),
            torch::full({static_cast<int64_t>(leg.size()), frames}, 1.0f / 30), torch::stack(rest)};
  rotations_ = torch::stack(rotations);
}

MotionFigures MotionEvaluator::evaluate(nn::MotionGru& net) const {
  const torch::NoGradGuard no_grad;
  const auto device = net->parameters()[0].device();
  nn::MotionState state;
  const nn::MotionInput input{input_.joints.to(device), input_.leg.to(device), input_.dt.to(device),
                              input_.rest.to(device)};
  const auto local = net->forward(input, state).cpu();
  return motion_figures(input_.rest, local, rotations_);
}

}  // namespace understudy::training
