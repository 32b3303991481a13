#include "retarget/training/motion_evaluator.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/metrics/joint_metrics.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/training/motion_data.hpp"

namespace understudy::training {
namespace {

constexpr int kCases = 24, kMostFrames = 90;

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

/// Clips that give as many frames as the longest of them does, kMostFrames at the most; and how many.
std::pair<std::vector<const Clip*>, int> equally_long(const std::vector<Clip>& clips) {
  int frames = 0;
  for (const Clip& clip : clips) frames = std::max(frames, std::min(kMostFrames, longest_run(clip).count));
  std::vector<const Clip*> chosen;
  for (const Clip& clip : clips)
    if (frames > 1 && longest_run(clip).count >= frames) chosen.push_back(&clip);
  US_CHECK(!chosen.empty(), "the dev split has no motion to evaluate by");
  return {chosen, frames};
}

JointSequence performed(const Joints& rest, const std::vector<Rotations>& rotations) {
  JointSequence joints;
  for (const Rotations& local : rotations) {
    Pose pose;
    pose.local = local;
    joints.push_back(forward_kinematics(rest, pose).joints);
  }
  return joints;
}

}  // namespace

MotionEvaluator::MotionEvaluator(const TrainingData& dev, float noise) {
  Rng rng(7);
  const auto body = [&] { return dev.body.shaped(dev.betas[rng.below(dev.betas.size())]).joints; };
  const auto [clips, frames] = equally_long(dev.clips);
  std::vector<torch::Tensor> source, leg, rest;
  const size_t every = std::max<size_t>(1, clips.size() / kCases);
  for (size_t c = 0; c < clips.size(); c += every) {
    const auto first = clips[c]->motion.poses.begin() + longest_run(*clips[c]).first;
    Case one;
    for (int t = 0; t < frames; ++t) one.truth.push_back(first[t].local);
    JointSequence seen = performed(body(), one.truth);
    add_joint_errors(seen, noise, 1.0f / 30, rng);
    one.rest = body();
    for (const Joints& joints : seen) source.push_back(nn::tensor_of(joints));
    leg.push_back(torch::tensor(mean_leg_lengths(seen)));
    rest.push_back(nn::tensor_of(one.rest));
    cases_.push_back(std::move(one));
  }
  const auto count = static_cast<int64_t>(cases_.size());
  input_ = {torch::stack(source).view({count, frames, kJointCount, 3}), torch::stack(leg),
            torch::full({count, frames}, 1.0f / 30), torch::stack(rest)};
}

Figures MotionEvaluator::evaluate(nn::MotionGru& net, const std::string& prefix) const {
  const torch::NoGradGuard no_grad;
  nn::MotionState state;
  const auto local = net->forward(input_, state);  // [N, T, 22, 3, 3]
  double error = 0, aligned = 0, turned = 0;
  for (size_t n = 0; n < cases_.size(); ++n) {
    const auto& [rest, truth] = cases_[n];
    std::vector<Rotations> made;
    for (size_t t = 0; t < truth.size(); ++t) made.push_back(nn::rotations_of(local[n][t]));
    const JointSequence p = performed(rest, made), q = performed(rest, truth);
    error += mean_joint_error(p, q);
    aligned += mean_joint_error(aligned_joints(p, q), q);
    turned += rotation_error(made, truth).all_deg;
  }
  const auto count = static_cast<double>(cases_.size());
  return {{prefix + "mpjpe_mm", 1000 * error / count},
          {prefix + "pa_mpjpe_mm", 1000 * aligned / count},
          {prefix + "rot_deg", turned / count}};
}

}  // namespace understudy::training
