#include "retarget/marionette/dynamics_rows.hpp"

#include "retarget/base/index.hpp"
#include "retarget/marionette/motion_keys.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

Rig with_balls(Rig rig) {
  for (size_t j = 1; j < rig.joints.size(); ++j) rig.joints[j].kind = JointKind::Ball;
  return rig;
}

}  // namespace

std::string bones_of(const Rig& rig) {
  std::string bones;
  for (const RigJoint& joint : rig.joints)
    bones +=
        joint.name + ":" + (joint.parent < 0 ? "" : rig.joints[static_cast<size_t>(joint.parent)].name) + ";";
  return bones;
}

DynamicsRows::DynamicsRows(const Rig& rig) : rig_(rig), free_(with_balls(rig)), form_(free_) {}

RowMatrix DynamicsRows::rows(const RigMotion& motion) const {
  return form_.rows(motion, {}).leftCols(width());
}

Eigen::RowVectorXf DynamicsRows::row(const RigPose& before, const RigPose& pose, double dt) const {
  return rows({1 / dt, {before, pose}}).row(1);
}

Eigen::RowVectorXf DynamicsRows::first_row(const RigPose& pose) const {
  return form_.row_of(pose).head(width());
}

RigPose DynamicsRows::pose(const RigPose& before, const Eigen::RowVectorXf& row, double dt) const {
  RowMatrix both = RowMatrix::Zero(2, form_.width());
  both.row(0).head(width()) = first_row(before);
  both.row(1).head(width()) = row;
  const RigPose made = form_.motion(both, before, 1 / dt).poses[1];
  return pose_of(rig_, bone_motions(rig_, made));
}

RigPose DynamicsRows::pose_at(const RigPose& before, const Eigen::RowVectorXf& row, double dt) const {
  Eigen::RowVectorXf turned = first_row(before);
  turned.head<4>() = row.head<4>();
  const RigPose gone = pose(before, turned, dt);  // the root's way, in the pose of before
  Points places(rig_.count(), 3);
  const Mat3 facing = rotation_about_y(heading_of(gone.turns[0]));
  for (Eigen::Index j = 0; j < places.rows(); ++j)
    places.row(j) = (gone.root + facing * row.segment<3>(4 + 3 * j).transpose() * size()).transpose();
  return pose_at_places(rig_, places, gone);
}

Eigen::RowVectorXf DynamicsRows::places_row(const RigPose& pose, const Eigen::RowVectorXf& row) const {
  const Points places = joint_places(rig_, bone_motions(rig_, pose));
  const Mat3 facing = rotation_about_y(-heading_of(pose.turns[0]));
  Eigen::RowVectorXf own(4 + 3 * rig_.count());
  own.head<4>() = row.head<4>();
  for (Eigen::Index j = 0; j < places.rows(); ++j)
    own.segment<3>(4 + 3 * j) = (facing * (places.row(j).transpose() - pose.root) / size()).transpose();
  return own;
}

Points DynamicsRows::rest() const {
  const Points rest = rig_.rest_joints();
  return (rest.rowwise() - rest.row(0)) / size();
}

}  // namespace understudy
