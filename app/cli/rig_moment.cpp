#include "app/cli/rig_moment.hpp"

#include "render/colors.hpp"

namespace understudy::app {

render::SheetMoment rig_moment(const RiggedMotion& performed, int frame) {
  const understudy::Rig& rig = performed.rig;
  const BoneMotions bones = bone_motions(rig, performed.motion.poses[static_cast<size_t>(frame)]);
  render::SheetMoment moment;
  moment.frame = frame;
  moment.seconds = frame / performed.motion.fps;
  render::SkeletonView& skeleton = moment.skeleton.emplace();
  skeleton.joints = joint_places(rig, bones);
  for (const RigJoint& joint : rig.joints) skeleton.parents.push_back(joint.parent);
  for (const BoneTip& tip : bone_tips(rig)) {
    skeleton.joints.conservativeResize(skeleton.joints.rows() + 1, 3);
    skeleton.joints.bottomRows<1>() = bones[static_cast<size_t>(tip.joint)](tip.rest).transpose();
    skeleton.parents.push_back(tip.joint);
  }
  constexpr float kAdult = 2;  // diagonal of an adult's box, metres
  skeleton.thickness = box_diagonal(rig.surface.vertices) / kAdult;
  moment.target = Mesh{skinned(rig.surface.vertices, rig.skin, bones), rig.surface.faces,
                       render::weight_colors(rig.skin.dense(rig.count()))};
  return moment;
}

}  // namespace understudy::app
