#include "retarget/discovery/rig_retarget.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/discovery/ground_contacts.hpp"
#include "retarget/geometry/closed_surface.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// What a source did, put on a target bone by bone.
class Performance {
 public:
  Performance(const RiggedMotion& source, const RiggedMotion& target, const LaidBody& laid,
              const BoneMatches& matches)
      : source_(source),
        target_(target),
        laid_(laid),
        matches_(matches),
        leaders_(led_by(target.rig, matches)),
        source_bones_(bone_motions(source.rig, source_pose())),
        target_bones_(bone_motions(target.rig, target_pose())) {}
  RigPose pose(const RigPose& of_source) const;

 private:
  const RigPose& source_pose() const { return source_.motion.poses[static_cast<size_t>(laid_.source_frame)]; }
  const RigPose& target_pose() const { return target_.motion.poses[static_cast<size_t>(laid_.target_frame)]; }
  float slide(int k, const RigPose& of_source) const;

  const RiggedMotion &source_, &target_;
  const LaidBody& laid_;
  const BoneMatches& matches_;
  std::vector<int> leaders_;
  BoneMotions source_bones_, target_bones_;  // in the poses that are laid on each other
};

/// Of a slider: as its partner slides, along the way that goes there.
float Performance::slide(int k, const RigPose& of_source) const {
  const auto t = static_cast<size_t>(k);
  const int j = matches_.partner[t];
  const float stays = target_pose().slides[t];
  if (target_.rig.joints[t].kind != JointKind::Slider || j < 0) return stays;
  const auto s = static_cast<size_t>(j);
  const Vec3 way = laid_.turn * (source_bones_[s].R * source_.rig.joints[s].axis);
  const float along = way.dot(laid_.corrections[s] * (target_bones_[t].R * target_.rig.joints[t].axis));
  return stays + (along < 0 ? -1.0f : 1.0f) * laid_.scale * (of_source.slides[s] - source_pose().slides[s]);
}

RigPose Performance::pose(const RigPose& of_source) const {
  const BoneMotions bones = bone_motions(source_.rig, of_source);
  RigPose pose = rest_pose(target_.rig);
  std::vector<Mat3> turned(target_.rig.joints.size());
  for (int k = 0; k < target_.rig.count(); ++k) {
    const auto t = static_cast<size_t>(k),
               s = static_cast<size_t>(matches_.partner[static_cast<size_t>(leaders_[t])]);
    const Mat3 since = laid_.turn * bones[s].R * source_bones_[s].R.transpose() * laid_.turn.transpose();
    turned[t] = since * laid_.corrections[s] * target_bones_[t].R;
    const int parent = target_.rig.joints[t].parent;
    pose.turns[t] = nearest_rotation(
        parent < 0 ? turned[t] : Mat3(turned[static_cast<size_t>(parent)].transpose() * turned[t]));
    pose.slides[t] = slide(k, of_source);
  }
  const auto s = static_cast<size_t>(matches_.partner[static_cast<size_t>(leaders_[0])]);
  const Vec3 at = source_.rig.joints[s].rest;
  pose.root = target_pose().root + laid_.scale * (laid_.turn * (bones[s](at) - source_bones_[s](at)));
  return pose;
}

/// What turns otherwise than its kind of joint lets it is a ball.
void loosen_joints(RiggedMotion& body) {
  constexpr float kAlmost = 1e-3f;  // radians
  for (size_t j = 1; j < body.rig.joints.size(); ++j) {
    RigJoint& joint = body.rig.joints[j];
    if (joint.kind == JointKind::Ball || joint.kind == JointKind::Slider) continue;
    for (const RigPose& pose : body.motion.poses) {
      Vec3 turn = rotation_to_axis_angle(pose.turns[j]);
      if (joint.kind == JointKind::Hinge) turn -= turn.dot(joint.axis) * joint.axis;
      if (turn.norm() > kAlmost) joint.kind = JointKind::Ball;
    }
  }
}

/// What touches in the source stands in the performance, on the target's own ground.
void stand(const RiggedMotion& source, const RiggedMotion& target, const BoneMatches& matches,
           RiggedMotion& performed) {
  const GroundContacts contacts = ground_contacts(source);
  std::vector<std::vector<char>> touches;
  for (const std::vector<char>& of_source : contacts.touches) {
    auto& now = touches.emplace_back();
    for (const int partner : matches.partner)
      now.push_back(partner < 0 ? char{0} : of_source[static_cast<size_t>(partner)]);
  }
  stand_on(ground_contacts(target).ground, touches, performed);
}

}  // namespace

RiggedMotion performed_by(const RiggedMotion& source, const RiggedMotion& target, const LaidBody& laid,
                          const BoneMatches& matches, const RigRetargetOptions& options) {
  check_matches(matches, source.rig, target.rig);
  const Performance performance(source, target, laid, matches);
  RiggedMotion performed;
  performed.rig = target.rig;
  const RigMotion& motion = options.motion ? *options.motion : source.motion;
  performed.motion.fps = motion.fps;
  for (const RigPose& pose : motion.poses) performed.motion.poses.push_back(performance.pose(pose));
  if (options.contacts) stand({source.rig, motion}, target, matches, performed);
  loosen_joints(performed);
  return performed;
}

RiggedMotion body_of_one_scan(const Mesh& scan) {
  RiggedMotion body;
  body.rig.name = "scan";
  RigJoint& only = body.rig.joints.emplace_back();
  only.name = "body";
  only.kind = JointKind::Free;
  body.rig.surface = finite_part(scan);
  if (body.rig.surface.is_cloud()) {
    const auto all = static_cast<int>(body.rig.surface.vertices.rows());
    const ThinnedFrame points = thinned(body.rig.surface, all, all, 1);
    constexpr int kVertices = 7000;
    body.rig.surface = closed_surface({points.points, points.normals}, kVertices);
  }
  only.rest = body.rig.surface.vertices.colwise().mean().transpose();
  body.rig.skin =
      SkinWeights::rigid(std::vector<int>(static_cast<size_t>(body.rig.surface.vertices.rows()), 0));
  body.motion.poses.push_back(rest_pose(body.rig));
  return body;
}

RiggedMotion rig_laid_on(const RiggedMotion& source, const RiggedMotion& target, const LaidBody& laid) {
  RiggedMotion made;
  made.rig.name = target.rig.name;
  made.rig.joints = source.rig.joints;
  made.rig.surface = target.rig.surface;
  made.rig.surface.vertices =
      skinned(target.rig.surface.vertices, target.rig.skin,
              bone_motions(target.rig, target.motion.poses[static_cast<size_t>(laid.target_frame)]));
  const BoneMotions posed =
      bone_motions(source.rig, source.motion.poses[static_cast<size_t>(laid.source_frame)]);
  for (size_t j = 0; j < made.rig.joints.size(); ++j) {
    RigJoint& joint = made.rig.joints[j];
    joint.rest = laid.joints.row(static_cast<Eigen::Index>(j)).transpose();
    const auto carrier = static_cast<size_t>(std::max(0, joint.parent));
    joint.axis = laid.corrections[carrier].transpose() * (laid.turn * (posed[carrier].R * joint.axis));
  }
  made.rig.skin = weights_between(made.rig.surface.vertices, laid.points, laid.skin, made.rig.count());
  made.motion.poses.push_back(rest_pose(made.rig));
  return made;
}

BoneMatches same_bones(int count) {
  BoneMatches matches;
  matches.partner.resize(static_cast<size_t>(count));
  std::iota(matches.partner.begin(), matches.partner.end(), 0);
  matches.cost.assign(matches.partner.size(), 0);
  return matches;
}

}  // namespace understudy
