#include "retarget/discovery/articulated_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/discovery/bone_equations.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Row6 = Eigen::Matrix<double, 1, 6>;

constexpr double kPlainWeight = 0.03;  // of the distance beside that along the normal
constexpr double kStays = 0.02;        // of a bone's points: how firmly it stays where it was thought to be
constexpr float kMatchReach = 2.5f;    // in radii

/// One scan's fit.
class BoneFit {
 public:
  BoneFit(const Rig& rig, const FittedSurface& surface, const ThinnedFrame& scan, double stiffness)
      : rig_(rig), surface_(surface), scan_(scan), stiffness_(stiffness), count_(rig.count()) {
    weigh_bones();
  }
  void round(float radius, BoneMotions& bones);

 private:
  void weigh_bones();
  void add_match(int point, const Vec3& to, const Vec3& normal, float radius, const BoneMotions& bones);
  void match(float radius, const BoneMotions& bones);
  void hold_joint(int joint, const BoneMotions& bones);
  void add_pair(int joint, const Row6& of_child, const Row6& of_parent, double residual, double weight);
  Vec3 centre(int bone, const BoneMotions& bones) const {
    return bones[static_cast<size_t>(bone)](centres_.row(bone).transpose());
  }

  const Rig& rig_;
  const FittedSurface& surface_;
  const ThinnedFrame& scan_;
  double stiffness_;
  int count_;
  Points centres_{0, 3};         // of the bones' points at rest: their motions are counted about these
  std::vector<double> weights_;  // points that follow each bone
  std::vector<double> reach_;    // root of the mean square of their distance from the centre
  Points posed_{0, 3}, normals_{0, 3};
  Eigen::MatrixXd normal_;
  Eigen::VectorXd gradient_;
};

void BoneFit::weigh_bones() {
  centres_ = Points::Zero(count_, 3);
  weights_.assign(static_cast<size_t>(count_), 1e-6);
  reach_.assign(static_cast<size_t>(count_), 0);
  const auto visit = [&](const auto& see) {
    for (Eigen::Index i = 0; i < surface_.points.rows(); ++i)
      for (int k = 0; k < kSkinBones; ++k)
        if (surface_.skin.weights(i, k) > 0)
          see(surface_.skin.bones(i, k), surface_.skin.weights(i, k), surface_.points.row(i));
  };
  visit([&](int bone, float w, const auto& at) {
    centres_.row(bone) += w * at;
    weights_[static_cast<size_t>(bone)] += w;
  });
  for (int b = 0; b < count_; ++b) centres_.row(b) /= static_cast<float>(weights_[static_cast<size_t>(b)]);
  visit([&](int bone, float w, const auto& at) {
    reach_[static_cast<size_t>(bone)] += w * (at - centres_.row(bone)).squaredNorm();
  });
  for (size_t b = 0; b < reach_.size(); ++b) reach_[b] = std::sqrt(reach_[b] / weights_[b]);
}

void BoneFit::add_match(int point, const Vec3& to, const Vec3& normal, float radius,
                        const BoneMotions& bones) {
  const Vec3 off = posed_.row(point).transpose() - to, rest = surface_.points.row(point).transpose();
  const double scale2 = static_cast<double>(radius) * radius;
  const double share = scale2 / (scale2 + off.squaredNorm()), weight = share * share;
  for (int axis = -1; axis < 3; ++axis) {
    const Vec3 direction = axis < 0 ? normal : Vec3(Vec3::Unit(axis));
    const double w = axis < 0 ? weight : kPlainWeight * weight, residual = off.dot(direction);
    std::array<Row6, kSkinBones> rows;
    for (int k = 0; k < kSkinBones; ++k) {
      const float part = surface_.skin.weights(point, k);
      if (part <= 0) continue;
      const int bone = surface_.skin.bones(point, k);
      const Vec3 arm = bones[static_cast<size_t>(bone)](rest) - centre(bone, bones);
      rows[static_cast<size_t>(k)] << (part * arm.cross(direction)).cast<double>().transpose(),
          (part * direction).cast<double>().transpose();
    }
    for (int k = 0; k < kSkinBones; ++k) {
      if (surface_.skin.weights(point, k) <= 0) continue;
      const int a = 6 * surface_.skin.bones(point, k);
      gradient_.segment<6>(a) -= w * residual * rows[static_cast<size_t>(k)].transpose();
      for (int l = 0; l < kSkinBones; ++l)
        if (surface_.skin.weights(point, l) > 0)
          normal_.block<6, 6>(a, 6 * surface_.skin.bones(point, l)).noalias() +=
              w * rows[static_cast<size_t>(k)].transpose() * rows[static_cast<size_t>(l)];
    }
  }
}

void BoneFit::match(float radius, const BoneMotions& bones) {
  posed_ = skinned(surface_.points, surface_.skin, bones);
  normals_ = posed_normals(surface_, bones);
  const float reach2 = kMatchReach * kMatchReach * radius * radius;
  const auto agree = [&](Eigen::Index point, Eigen::Index of_scan) {
    return normals_.row(point).dot(scan_.normals.row(of_scan)) > 0.3f;
  };
  for (Eigen::Index i = 0; i < posed_.rows(); ++i) {
    const PointTree::Near near = scan_.tree.nearest(posed_.row(i).transpose());
    if (near.squared > reach2 || !agree(i, near.point)) continue;
    add_match(static_cast<int>(i), scan_.points.row(near.point).transpose(),
              scan_.normals.row(near.point).transpose(), radius, bones);
  }
  const PointTree tree(posed_);
  for (int q = 0; q < scan_.spread; ++q) {
    const PointTree::Near near = tree.nearest(scan_.points.row(q).transpose());
    if (near.squared > reach2 || !agree(near.point, q)) continue;
    add_match(near.point, scan_.points.row(q).transpose(), scan_.normals.row(q).transpose(), radius, bones);
  }
}

void BoneFit::add_pair(int joint, const Row6& of_child, const Row6& of_parent, double residual,
                       double weight) {
  const int c = 6 * joint, p = 6 * rig_.joints[static_cast<size_t>(joint)].parent;
  gradient_.segment<6>(c) -= weight * residual * of_child.transpose();
  gradient_.segment<6>(p) += weight * residual * of_parent.transpose();
  normal_.block<6, 6>(c, c).noalias() += weight * of_child.transpose() * of_child;
  normal_.block<6, 6>(p, p).noalias() += weight * of_parent.transpose() * of_parent;
  normal_.block<6, 6>(c, p).noalias() -= weight * of_child.transpose() * of_parent;
  normal_.block<6, 6>(p, c).noalias() -= weight * of_parent.transpose() * of_child;
}

/// Both bones carry the joint to one place (of a slider: beside its way alone), and turn alike about what is
/// no axis of theirs.
void BoneFit::hold_joint(int j, const BoneMotions& bones) {
  const RigJoint& joint = rig_.joints[static_cast<size_t>(j)];
  const RigidMotion &child = bones[static_cast<size_t>(j)],
                    &parent = bones[static_cast<size_t>(joint.parent)];
  const double weight =
      stiffness_ * std::min(weights_[static_cast<size_t>(j)], weights_[static_cast<size_t>(joint.parent)]);
  const Vec3 at_child = child(joint.rest), at_parent = parent(joint.rest), off = at_child - at_parent;
  const Vec3 arm_child = at_child - centre(j, bones), arm_parent = at_parent - centre(joint.parent, bones);
  const Mat3 frame = rotation_between(Vec3::UnitX(), joint.axis);  // its first column is the axis
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 direction = parent.R * frame.col(axis);
    if (joint.kind != JointKind::Slider || axis > 0) {
      Row6 rows[2];
      rows[0] << arm_child.cross(direction).transpose().cast<double>(), direction.transpose().cast<double>();
      rows[1] << arm_parent.cross(direction).transpose().cast<double>(), direction.transpose().cast<double>();
      add_pair(j, rows[0], rows[1], off.dot(direction), weight);
    }
    const bool turns = joint.kind == JointKind::Ball || (joint.kind == JointKind::Hinge && axis == 0);
    if (turns) continue;
    const Vec3 turned = rotation_to_axis_angle(child.R * parent.R.transpose());
    const double lever = reach_[static_cast<size_t>(j)];
    Row6 row;
    row << direction.transpose().cast<double>(), 0, 0, 0;
    add_pair(j, row, row, turned.dot(direction), weight * lever * lever);
  }
}

void BoneFit::round(float radius, BoneMotions& bones) {
  normal_.setZero(6 * count_, 6 * count_);
  gradient_.setZero(6 * count_);
  match(radius, bones);
  for (int j = 1; j < count_; ++j) hold_joint(j, bones);
  for (int b = 0; b < count_; ++b) {
    const auto s = static_cast<size_t>(b);
    const double stays = kStays * weights_[s] + 1e-6;
    normal_.block<3, 3>(6 * b, 6 * b).diagonal().array() += stays * reach_[s] * reach_[s] + 1e-9;
    normal_.block<3, 3>(6 * b + 3, 6 * b + 3).diagonal().array() += stays;
  }
  const Eigen::VectorXd step = solved(normal_, gradient_);
  for (int b = 0; b < count_; ++b) {
    RigidMotion& bone = bones[static_cast<size_t>(b)];
    bone = stepped(bone, centres_.row(b).transpose(), step.segment<6>(6 * b).cast<float>());
  }
}

}  // namespace

Points posed_normals(const FittedSurface& surface, const BoneMotions& bones) {
  Points normals(surface.normals.rows(), 3);
  for (Eigen::Index i = 0; i < normals.rows(); ++i)
    normals.row(i) =
        surface.normals.row(i) * bones[static_cast<size_t>(surface.skin.main_bone(i))].R.transpose();
  return normals;
}

void fit_bones(const Rig& rig, const FittedSurface& surface, const ThinnedFrame& scan,
               const ArticulatedFitOptions& options, BoneMotions& bones) {
  BoneFit fit(rig, surface, scan, options.joint_stiffness);
  const float shrinks = options.last_radius_m / options.first_radius_m;
  for (int round = 0; round < options.rounds; ++round) {
    const float share =
        options.rounds > 1 ? static_cast<float>(round) / static_cast<float>(options.rounds - 1) : 1;
    fit.round(options.first_radius_m * std::pow(shrinks, share), bones);
  }
}

ScanDistances distances_to(const ThinnedFrame& scan, const FittedSurface& surface, const BoneMotions& bones) {
  constexpr Eigen::Index kAsked = 500;  // points of the scan, for its spacing
  const Points posed = skinned(surface.points, surface.skin, bones);
  ScanDistances distances{Eigen::VectorXf(posed.rows())};
  for (Eigen::Index i = 0; i < posed.rows(); ++i)
    distances.off[i] = std::sqrt(scan.tree.nearest(posed.row(i).transpose()).squared);
  std::vector<double> apart;
  std::vector<PointTree::Near> near;
  for (Eigen::Index i = 0; i < scan.points.rows(); i += 1 + scan.points.rows() / kAsked) {
    scan.tree.nearest(scan.points.row(i).transpose(), 2, near);
    apart.push_back(std::sqrt(near.back().squared));
  }
  distances.spacing_m = static_cast<float>(percentile(apart, 50));
  return distances;
}

SkinWeights weights_between(const Points& places, const Points& known, const SkinWeights& weights,
                            int bones) {
  constexpr int kNear = 6;
  const PointTree tree(known);
  RowMatrix dense = RowMatrix::Zero(places.rows(), bones);
  std::vector<PointTree::Near> near;
  for (Eigen::Index v = 0; v < places.rows(); ++v) {
    tree.nearest(places.row(v).transpose(), kNear, near);
    const float softness = 0.01f * near.back().squared + 1e-12f;
    for (const PointTree::Near& n : near)
      for (int k = 0; k < kSkinBones; ++k)
        dense(v, weights.bones(n.point, k)) += weights.weights(n.point, k) / (n.squared + softness);
  }
  return SkinWeights::from(dense);
}

}  // namespace understudy
