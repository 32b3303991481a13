#include "retarget/training/training_data.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy::training {
namespace {

void find_hands(TrainingData& data, const std::string& file) {
  data.dressed_hands.resize(data.dressed.size());
  if (file.empty()) {
    log::warn_once("The data has no hand_poses.npz beside the body: all hands are flat");
    return;
  }
  data.hand_poses = std::make_shared<HandPoses>(file);
  data.hands = data.hand_poses->vertices_of(data.body.weights, data.body.weights);
  for (size_t i = 0; i < data.dressed.size(); ++i)
    data.dressed_hands[i] = data.hand_poses->vertices_of(data.body.weights, data.dressed[i].weights);
}

}  // namespace

TrainingData load_training_data(const std::string& folder, Split split) {
  const DataSplit part = read_split(folder, split == Split::Train ? "train" : "dev");
  TrainingData data;
  data.body = read_smpl_body(part.body);
  data.template_leg = leg_length(data.body.shaped(Eigen::VectorXf::Zero(1)).joints);
  data.betas = part.betas;
  for (const auto& file : part.clothed) data.dressed.push_back(read_dressed_body(file));
  find_hands(data, part.hand_poses);
  for (const auto& subject : part.motion_folders)
    for (Clip& clip : read_clips(subject)) data.clips.push_back(std::move(clip));
  for (const Clip& clip : data.clips) data.good_frames += static_cast<int64_t>(clip.good.size());
  US_CHECK(data.good_frames > 0, folder, ": the split has no usable motion");
  return data;
}

Eigen::VectorXf random_shape(const TrainingData& data, Rng& rng) {
  const auto pick = [&] { return data.betas[rng.below(static_cast<int>(data.betas.size()))]; };
  const Eigen::VectorXf a = pick();
  if (rng.chance(0.5f)) return a;
  const float mix = rng.uniform();
  return (1 - mix) * a + mix * pick();
}

namespace {

/// A clip and the number of one of its good frames.
std::pair<const Clip*, size_t> random_frame(const TrainingData& data, Rng& rng) {
  if (rng.chance(0.5f)) {
    const Clip& clip = data.clips[rng.below(static_cast<int>(data.clips.size()))];
    return {&clip, rng.below(static_cast<int>(clip.good.size()))};
  }
  int64_t at = rng.below(static_cast<int>(data.good_frames));
  for (const Clip& clip : data.clips) {
    if (at < static_cast<int64_t>(clip.good.size())) return {&clip, at};
    at -= static_cast<int64_t>(clip.good.size());
  }
  return {&data.clips.back(), data.clips.back().good.size() - 1};
}

}  // namespace

const Pose& random_pose(const TrainingData& data, Rng& rng) {
  const auto [clip, number] = random_frame(data, rng);
  return clip->motion.poses[clip->good[number]];
}

std::vector<Pose> random_poses(const TrainingData& data, int count, Rng& rng) {
  const auto [clip, first] = random_frame(data, rng);
  const size_t step = count > 1 ? 1 + rng.below(3) : 1;
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) {
    const size_t number = first + k * step;
    if (number >= clip->good.size()) break;
    const int frame = clip->good[number];
    if (frame != clip->good[first] + static_cast<int>(k * step)) break;
    poses.push_back(clip->motion.poses[frame]);
  }
  return poses;
}

}  // namespace understudy::training
