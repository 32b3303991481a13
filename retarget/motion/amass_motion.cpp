#include "retarget/motion/amass_motion.hpp"

#include <filesystem>

#include "retarget/body/body.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

constexpr float kAdultLeg = 0.8f;  // metres, thigh and shin

}  // namespace

Character read_amass_character(const std::string& path) {
  const Motion motion = read_amass_motion(path);
  Character out;
  out.name = std::filesystem::path(path).stem().string();
  const Joints rest = human_rest() * (kAdultLeg / leg_length(human_rest()));
  CharacterAnimation animation;
  animation.name = out.name;
  std::vector<float> times(motion.poses.size());
  for (size_t t = 0; t < times.size(); ++t)
    times[t] = static_cast<float>(static_cast<double>(t) / static_cast<double>(motion.fps));
  for (size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Index row = j;
    CharacterNode node;
    node.name = kJointNames[j];
    node.parent = kParents[j];
    if (node.parent >= 0) node.local.translation = (rest.row(row) - rest.row(node.parent)).transpose();
    out.nodes.push_back(node);
    CharacterTrack turn;
    turn.node = j;
    turn.times = times;
    for (const Pose& pose : motion.poses) {
      const Eigen::Quaternionf q(pose.local[j]);
      turn.values.insert(turn.values.end(), {q.x(), q.y(), q.z(), q.w()});
    }
    animation.tracks.push_back(std::move(turn));
  }
  CharacterTrack path_of_root;
  path_of_root.path = TrackPath::Translation;
  path_of_root.times = times;
  for (const Pose& pose : motion.poses)
    path_of_root.values.insert(path_of_root.values.end(), pose.root.data(), pose.root.data() + 3);
  animation.tracks.push_back(std::move(path_of_root));
  out.animations.push_back(std::move(animation));
  check_character(out, path);
  return out;
}

}  // namespace understudy
