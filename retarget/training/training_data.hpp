// Training data: bodies, dressed people and clips of a data folder (DATA/splits.json names the
// splits).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/body/hand_poses.hpp"

namespace understudy::training {

enum class Split { Train, Dev };

struct TrainingData {
  Body body;
  float template_leg = 1;              ///< leg length the clips' root paths are made for, metres
  std::vector<Eigen::VectorXf> betas;  ///< shape parameters of the split's people
  std::vector<ShapedBody> dressed;     ///< people with clothes and hair; no pose_dirs
  std::shared_ptr<const HandPoses> hand_poses = {};  ///< null where the folder has none: all hands are flat
  HandVertices hands = {};                           ///< of the body
  std::vector<HandVertices> dressed_hands =
      {};  ///< of each dressed person; empty where they are not the body's
  std::vector<Clip> clips;
  int64_t good_frames = 0;
};

/// Reads the split. Clips whose file is unreadable are an Error, clips without a good frame are left out.
TrainingData load_training_data(const std::string& folder, Split split);

/// A shape between two people of the data, or one of them.
Eigen::VectorXf random_shape(const TrainingData& data, Rng& rng);

/// A pose of the clips: any frame, half the time weighed by clip and half by frame, so that short rare
/// clips count.
const Pose& random_pose(const TrainingData& data, Rng& rng);

/// Up to `count` poses of a clip, one to three frames apart, the first as in random_pose. Fewer where a frame
/// is not good.
std::vector<Pose> random_poses(const TrainingData& data, int count, Rng& rng);

}  // namespace understudy::training
