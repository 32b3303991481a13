#include "app/run/actor.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "retarget/body/exact_body.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::app {
namespace {

constexpr size_t kFloorEvery = 5;  // frames between looks at where the soles are
constexpr size_t kDressedEvery = 3;

std::vector<Pose> clip_poses(const EvaluatedMotion& motion, int frames, float scale) {
  const ExactMotion clip = read_exact_motion(motion.path, motion.start, frames);
  std::vector<Pose> poses(clip.local.size());
  for (size_t t = 0; t < poses.size(); ++t) {
    for (int j = 0; j < kJointCount; ++j) poses[t].local[j] = clip.local[t][j].cast<float>();
    poses[t].root = scale * clip.root[t].cast<float>();
  }
  return poses;
}

}  // namespace

Actor::Actor(ShapedBody body, std::vector<Pose> poses)
    : body_(std::make_shared<const ShapedBody>(std::move(body))),
      sampler_(std::make_shared<const SurfaceSampler>(body_->vertices, body_->faces)) {
  perform(std::move(poses));
}

void Actor::perform(std::vector<Pose> poses) {
  poses_ = std::move(poses);
  float lowest = std::numeric_limits<float>::max();
  for (size_t t = 0; t < poses_.size(); t += kFloorEvery)
    lowest = std::min(lowest, posed_vertices(*body_, poses_[t]).col(1).minCoeff());
  for (Pose& pose : poses_) pose.root.y() -= lowest;
}

PosedSkeleton Actor::skeleton(size_t frame) const {
  return forward_kinematics(body_->joints, poses_.at(frame));
}

PosedSkeleton Actor::beside(size_t frame) const {
  return skeleton(frame + 1 < frames() ? frame + 1 : frame == 0 ? 0 : frame - 1);
}

LabelledPoints Actor::surface(size_t frame, int count, Rng& rng) const {
  const SurfaceLook look{hand_poses_, &hands_, angles_};
  PosedSurface posed(*body_, poses_.at(frame), look);
  return posed.sample(*sampler_, body_->faces, count, rng);
}

void Actor::hold_hands(const HandPoses& poses, HandVertices hands, const std::array<HandAngles, 2>& angles) {
  hand_poses_ = &poses;
  hands_ = std::move(hands);
  angles_ = angles;
}

void Actor::move(float yaw, const Vec3& by) {
  const Mat3 turn = rotation_about_y(yaw);
  for (Pose& pose : poses_) {
    pose.local[Pelvis] = turn * pose.local[Pelvis];
    pose.root = turn * pose.root + by;
  }
}

float nearest_joints(const Actor& a, const Actor& b) {
  float nearest = std::numeric_limits<float>::max();
  for (size_t t = 0; t < std::min(a.frames(), b.frames()); ++t) {
    const Joints one = a.skeleton(t).joints, other = b.skeleton(t).joints;
    for (const auto& joint : one.rowwise())
      nearest = std::min(nearest, (other.rowwise() - joint).rowwise().norm().minCoeff());
  }
  return nearest;
}

Cast::Cast(DataSplit split, const std::string& body)
    : split_(std::move(split)),
      body_(read_smpl_body(body.empty() ? split_.body : body)),
      template_leg_(leg_length(body_.shaped({}).joints)) {
  if (!split_.hand_poses.empty()) hand_poses_ = std::make_unique<HandPoses>(split_.hand_poses);
}

Actor Cast::actor(size_t person, size_t motion, int frames, Rng& rng) const {
  const bool is_dressed = !split_.clothed.empty() && person % kDressedEvery == kDressedEvery - 1;
  ShapedBody body = is_dressed
                        ? read_dressed_body(split_.clothed[person / kDressedEvery % split_.clothed.size()])
                        : body_.shaped(split_.betas[7 * person % split_.betas.size()]);
  HandVertices hands;
  if (hand_poses_) hands = hand_poses_->vertices_of(body_.weights, body.weights);
  const float scale = leg_length(body.joints) / template_leg_;
  Actor actor(std::move(body), clip_poses(split_.motions[motion % split_.motions.size()], frames, scale));
  if (hand_poses_) {
    const HandAngles left = hand_poses_->draw(rng), right = hand_poses_->draw(rng);
    actor.hold_hands(*hand_poses_, std::move(hands), {left, right});
  }
  return actor;
}

std::vector<size_t> Cast::longest_paths(int frames) const {
  std::vector<float> lengths;
  for (const EvaluatedMotion& motion : split_.motions) {
    const std::vector<Pose> poses = clip_poses(motion, frames, 1);
    const Vec3 way = poses.back().root - poses.front().root;
    lengths.push_back(Vec3(way.x(), 0, way.z()).norm());
  }
  std::vector<size_t> order(lengths.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return lengths[a] > lengths[b]; });
  return order;
}

}  // namespace understudy::app
