// Which joints a cloud shows: those with enough of the surface about them left.
#pragma once

#include "retarget/body/labelled_points.hpp"

namespace understudy {

using PerJoint = Eigen::Array<float, kJointCount, 1>;

/// How much of the surface about each joint a cloud holds: points on the parts that meet in it, near ones
/// counting most (a Gaussian as wide as a limb, about the trunk's joints as the trunk). In points; only
/// ratios mean something.
PerJoint surface_about_joints(const LabelledPoints& cloud, const PosedSkeleton& truth);

struct JointSight {
  PerJoint seen = PerJoint::Ones();  ///< 1 where the cloud shows a joint, else 0
  PerJoint away = PerJoint::Zero();  ///< from each joint to the person's nearest point, in leg lengths
};

/// What a cloud shows of a person whose whole surface had so much about each joint. A joint is seen where a
/// fifth of that is left, or a fifth of what is left about the joint seen best: a cloud that is thinner
/// everywhere shows as much as before. With none of the person's points nothing is seen, and all is as far
/// `away` as can be.
JointSight joint_sight(const PerJoint& whole, const LabelledPoints& cloud, const PosedSkeleton& truth);

}  // namespace understudy
