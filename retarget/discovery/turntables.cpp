#include "retarget/discovery/turntables.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr double kRoundShare = 0.8;   // of its points whose normals tell no turn about the axis
constexpr float kRoundNormal = 0.3f;  // sine of the angle from such a normal
constexpr float kTwoAxesOff = 0.06f;  // radians: what turns about two axes alone may do otherwise
constexpr float kLeastTurn = 0.12f;   // radians from end to end

/// R = turn about `first` (fixed in the parent) times turn about `second` (fixed in the child); both at rest.
struct TwoAxes {
  Vec3 first, second;
  float off = std::numeric_limits<float>::infinity();  // of the angle between them, radians
};

/// The direction across `axis` along which vectors change least, and by how much.
std::pair<Vec3, float> least_changing(const std::vector<Vec3>& vectors, const Vec3& axis) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : vectors) mean += v / static_cast<float>(vectors.size());
  const Mat3 frame = rotation_between(Vec3::UnitX(), axis);
  Eigen::Matrix2f scatter = Eigen::Matrix2f::Zero();
  for (const Vec3& v : vectors) {
    const Eigen::Vector2f across = (frame.transpose() * (v - mean)).tail<2>();
    scatter += across * across.transpose() / static_cast<float>(vectors.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> solver(scatter);
  const Eigen::Vector2f least = solver.eigenvectors().col(0);
  return {frame.col(1) * least.x() + frame.col(2) * least.y(),
          std::sqrt(std::max(0.0f, solver.eigenvalues()[0]))};
}

/// The two axes, at right angles, about which rotations turn: one of the child stays at that angle from one
/// of the parent.
TwoAxes two_axes_of(const std::vector<Mat3>& turns) {
  constexpr int kSteps = 30;
  TwoAxes best;
  for (const Vec3& start : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    TwoAxes axes{start, Vec3::Zero()};
    for (int step = 0; step < kSteps; ++step) {
      std::vector<Vec3> seen(turns.size());
      for (size_t t = 0; t < turns.size(); ++t) seen[t] = turns[t].transpose() * axes.first;
      axes.second = least_changing(seen, axes.first).first;
      for (size_t t = 0; t < turns.size(); ++t) seen[t] = turns[t] * axes.second;
      std::tie(axes.first, axes.off) = least_changing(seen, axes.second);
    }
    if (axes.off < best.off) best = axes;
  }
  return best;
}

/// The angle about `axis` from one vector to the other.
float angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  const Vec3 a = from - axis.dot(from) * axis, b = to - axis.dot(to) * axis;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

struct Range {
  float least = 0, most = 0;
  void add(float value) { least = std::min(least, value), most = std::max(most, value); }
  float width() const { return most - least; }
};

/// The points of a part, seen along an axis through a joint.
class Foot {
 public:
  Foot(const DeformationGraph& graph, const std::vector<int>& of_point, int part, const Vec3& joint,
       const Vec3& axis) {
    for (size_t i = 0; i < of_point.size(); ++i) {
      if (of_point[i] != part) continue;
      const auto row = static_cast<Eigen::Index>(i);
      const Vec3 from = graph.points.row(row).transpose() - joint, n = graph.normals.row(row).transpose();
      const Vec3 across = axis.cross(from);
      round_ += std::abs(n.dot(across)) <= kRoundNormal * across.norm() ? 1 : 0;
      points_.push_back(static_cast<int>(i));
      along_.push_back(axis.dot(from));
    }
    if (points_.empty()) return;
    const auto [low, high] = std::minmax_element(along_.begin(), along_.end());
    middle_ = (*low + *high) / 2;
  }
  bool is_round() const { return round_ >= kRoundShare * static_cast<double>(points_.size()) && round_ > 0; }
  /// From the joint to the middle of the part, along the axis.
  float middle() const { return middle_; }
  /// Those on the joint's side of the middle.
  void give_near_half(int to, std::vector<int>& of_point) const {
    for (size_t k = 0; k < points_.size(); ++k)
      if ((along_[k] > middle_) == (middle_ < 0)) of_point[static_cast<size_t>(points_[k])] = to;
  }

 private:
  std::vector<int> points_;
  std::vector<float> along_;
  int round_ = 0;
  float middle_ = 0;
};

void insert_bone(PartTree& tree, int before, const RigJoint& joint, int part) {
  std::vector<RigJoint>& joints = tree.rig.joints;
  for (RigJoint& other : joints)
    if (other.parent >= before) ++other.parent;
  joints.insert(joints.begin() + before, joint);
  joints[static_cast<size_t>(before) + 1].parent = before;
  tree.part_of_bone.insert(tree.part_of_bone.begin() + before, part);
}

/// False where the joint does not turn so.
bool turn_on_two_axes(const SurfaceTracks& tracks, int j, RigidParts& parts, PartTree& tree) {
  RigJoint& joint = tree.rig.joints[static_cast<size_t>(j)];
  const int foot_part = tree.part_of_bone[static_cast<size_t>(joint.parent)];
  const std::vector<RigidMotion>& child =
      parts.motions[static_cast<size_t>(tree.part_of_bone[static_cast<size_t>(j)])];
  std::vector<Mat3> turns;
  turns.reserve(child.size());
  for (const RigidMotion& motion : child) turns.push_back(motion.R);
  const TwoAxes axes = two_axes_of(turns);
  if (axes.off > kTwoAxesOff) return false;
  const Foot foot(tracks.graph, parts.of_point, foot_part, joint.rest, axes.first);
  if (!foot.is_round()) return false;
  std::vector<RigidMotion> between;
  Range first, second;
  for (const Mat3& R : turns) {
    const float angle = angle_about(axes.first, axes.second, R * axes.second);
    RigidMotion motion;
    motion.R = rotation_from_axis_angle(angle * axes.first);
    first.add(angle);
    second.add(axes.second.dot(rotation_to_axis_angle(motion.R.transpose() * R)));
    motion.t = joint.rest - motion.R * joint.rest;
    between.push_back(motion);
  }
  if (std::min(first.width(), second.width()) < kLeastTurn) return false;
  const int part = parts.count();
  parts.motions.push_back(between);
  foot.give_near_half(part, parts.of_point);
  joint.kind = JointKind::Hinge, joint.axis = axes.second;
  const RigJoint table{joint.name + " turn", joint.parent, JointKind::Hinge,
                       joint.rest + foot.middle() * axes.first, axes.first};
  insert_bone(tree, j, table, part);
  return true;
}

}  // namespace

void add_turntables(const SurfaceTracks& tracks, RigidParts& parts, PartTree& tree, int most) {
  const float size = box_diagonal(tracks.graph.points);
  for (int j = tree.rig.count() - 1; j > 0; --j) {
    RigJoint& joint = tree.rig.joints[static_cast<size_t>(j)];
    const int foot_part = tree.part_of_bone[static_cast<size_t>(joint.parent)];
    if (!stands_still(parts.motions[static_cast<size_t>(foot_part)], joint.rest, size)) continue;
    if (joint.kind != JointKind::Ball && joint.kind != JointKind::Hinge) continue;
    const bool may_be_two = most == 0 || parts.count() < most;
    if ((may_be_two && turn_on_two_axes(tracks, j, parts, tree)) || joint.kind == JointKind::Ball) continue;
    const Foot foot(tracks.graph, parts.of_point, foot_part, joint.rest, joint.axis);
    if (!foot.is_round()) continue;
    foot.give_near_half(tree.part_of_bone[static_cast<size_t>(j)], parts.of_point);
    joint.rest += foot.middle() * joint.axis;
  }
}

}  // namespace understudy
