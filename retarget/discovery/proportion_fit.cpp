#include "retarget/discovery/proportion_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/discovery/bone_equations.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr int kNumbers = 8;  // of a bone: turn, move, length, girth
using StretchRow = Eigen::Matrix<double, 1, kNumbers>;

constexpr double kSlides = 0.1;       // weight of the distance beside that along the normal
constexpr double kHoldsJoints = 3;    // in a bone's points
constexpr double kStaysThere = 0.01;  // how firmly a bone stays where it was in the round before
constexpr double kBendsLast = 0.01, kBendsFirst = 0.3;        // against the bone that carries it
constexpr double kStretchesLast = 0.02, kStretchesFirst = 1;  // away from the bone that carries it
constexpr float kFarthest = 2.5f;                             // in radii: no match beyond
constexpr float kMostStretch = 2.5f;

/// The fit of one body.
class Stretching {
 public:
  Stretching(const PosedBody& body, const ThinnedFrame& on);
  void round(float radius, double willing);
  ProportionFit finished(float radius) const;

 private:
  void match(float radius);
  void add_match(int point, const Vec3& to, const Vec3& normal, float radius);
  StretchRow row_of(int bone, const Vec3& rest, const Vec3& direction) const;
  void add_rows(int a, const StretchRow& of_a, int b, const StretchRow& of_b, double residual, double weight);
  void hold_joints(double willing);
  void solve();
  Points posed() const;
  Points turned_normals() const;

  const PosedBody& body_;
  const ThinnedFrame& on_;
  int count_;
  std::vector<StretchedBone> bones_;
  std::vector<double> weights_, reach_;
  Points posed_, normals_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd gradient_;
};

Stretching::Stretching(const PosedBody& body, const ThinnedFrame& on)
    : body_(body), on_(on), count_(static_cast<int>(body.joints.rows())) {
  bones_.resize(static_cast<size_t>(count_));
  weights_.assign(bones_.size(), 1e-3);
  reach_.assign(bones_.size(), 0);
  std::vector<Mat3> moments(bones_.size(), 1e-9f * Mat3::Identity());
  const FittedSurface& surface = body.surface;
  const auto visit = [&](const auto& see) {
    for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
      for (int k = 0; k < kSkinBones; ++k)
        if (surface.skin.weights(i, k) > 0)
          see(static_cast<size_t>(surface.skin.bones(i, k)), surface.skin.weights(i, k),
              Vec3(surface.points.row(i).transpose()));
  };
  for (int b = 0; b < count_; ++b)
    bones_[static_cast<size_t>(b)].centre = 1e-3f * body.joints.row(b).transpose();
  visit([&](size_t b, float w, const Vec3& at) {
    bones_[b].centre += w * at, weights_[b] += static_cast<double>(w);
  });
  for (size_t b = 0; b < bones_.size(); ++b) bones_[b].centre /= static_cast<float>(weights_[b]);
  visit([&](size_t b, float w, const Vec3& at) {
    const Vec3 off = at - bones_[b].centre;
    moments[b] += w * off * off.transpose();
  });
  for (size_t b = 0; b < bones_.size(); ++b) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(moments[b]);
    bones_[b].axis = solver.eigenvectors().col(2);
    reach_[b] = std::sqrt(static_cast<double>(moments[b].trace()) / weights_[b]);
    bones_[b].place = bones_[b].centre;
  }
}

Points Stretching::posed() const {
  const FittedSurface& surface = body_.surface;
  Points points = Points::Zero(surface.points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (int k = 0; k < kSkinBones; ++k)
      if (surface.skin.weights(i, k) > 0)
        points.row(i) += surface.skin.weights(i, k) * bones_[static_cast<size_t>(surface.skin.bones(i, k))](
                                                          surface.points.row(i).transpose())
                                                          .transpose();
  return points;
}

Points Stretching::turned_normals() const {
  const FittedSurface& surface = body_.surface;
  Points normals(surface.points.rows(), 3);
  for (Eigen::Index i = 0; i < normals.rows(); ++i)
    normals.row(i) =
        surface.normals.row(i) * bones_[static_cast<size_t>(surface.skin.main_bone(i))].R.transpose();
  return normals;
}

/// How a place that a bone carries goes along a direction when the bone's numbers change.
StretchRow Stretching::row_of(int b, const Vec3& rest, const Vec3& direction) const {
  const StretchedBone& bone = bones_[static_cast<size_t>(b)];
  const Vec3 off = rest - bone.centre, along = bone.axis.dot(off) * bone.axis,
             arm = bone.R * bone.stretched(rest);
  StretchRow row;
  row << arm.cross(direction).cast<double>().transpose(), direction.cast<double>().transpose(),
      static_cast<double>(direction.dot(bone.R * along)),
      static_cast<double>(direction.dot(bone.R * (off - along)));
  return row;
}

void Stretching::add_match(int point, const Vec3& to, const Vec3& normal, float radius) {
  const FittedSurface& surface = body_.surface;
  const Vec3 off = posed_.row(point).transpose() - to, rest = surface.points.row(point).transpose();
  const double scale2 = static_cast<double>(radius) * static_cast<double>(radius),
               share = scale2 / (scale2 + static_cast<double>(off.squaredNorm()));
  for (int axis = -1; axis < 3; ++axis) {
    const Vec3 direction = axis < 0 ? normal : Vec3(Vec3::Unit(axis));
    const double weight = (axis < 0 ? 1 : kSlides) * share * share,
                 residual = static_cast<double>(off.dot(direction));
    std::array<StretchRow, kSkinBones> rows;
    for (int k = 0; k < kSkinBones; ++k)
      if (surface.skin.weights(point, k) > 0)
        rows[static_cast<size_t>(k)] = static_cast<double>(surface.skin.weights(point, k)) *
                                       row_of(surface.skin.bones(point, k), rest, direction);
    for (int k = 0; k < kSkinBones; ++k) {
      if (surface.skin.weights(point, k) <= 0) continue;
      const int a = kNumbers * surface.skin.bones(point, k);
      gradient_.segment<kNumbers>(a) -= weight * residual * rows[static_cast<size_t>(k)].transpose();
      for (int l = 0; l < kSkinBones; ++l)
        if (surface.skin.weights(point, l) > 0)
          normal_.block<kNumbers, kNumbers>(a, kNumbers * surface.skin.bones(point, l)).noalias() +=
              weight * rows[static_cast<size_t>(k)].transpose() * rows[static_cast<size_t>(l)];
    }
  }
}

void Stretching::match(float radius) {
  posed_ = posed();
  normals_ = turned_normals();
  const float reach2 = kFarthest * kFarthest * radius * radius;
  const auto agree = [&](Eigen::Index point, Eigen::Index there) {
    return normals_.row(point).dot(on_.normals.row(there)) > 0.2f;
  };
  for (Eigen::Index i = 0; i < posed_.rows(); ++i) {
    const PointTree::Near near = on_.tree.nearest(posed_.row(i).transpose());
    if (near.squared > reach2 || !agree(i, near.point)) continue;
    add_match(static_cast<int>(i), on_.points.row(near.point).transpose(),
              on_.normals.row(near.point).transpose(), radius);
  }
  const PointTree tree(posed_);
  for (int q = 0; q < on_.spread; ++q) {
    const PointTree::Near near = tree.nearest(on_.points.row(q).transpose());
    if (near.squared > reach2 || !agree(near.point, q)) continue;
    add_match(near.point, on_.points.row(q).transpose(), on_.normals.row(q).transpose(), radius);
  }
}

void Stretching::add_rows(int a, const StretchRow& of_a, int b, const StretchRow& of_b, double residual,
                          double weight) {
  const int i = kNumbers * a, j = kNumbers * b;
  gradient_.segment<kNumbers>(i) -= weight * residual * of_a.transpose();
  gradient_.segment<kNumbers>(j) += weight * residual * of_b.transpose();
  normal_.block<kNumbers, kNumbers>(i, i).noalias() += weight * of_a.transpose() * of_a;
  normal_.block<kNumbers, kNumbers>(j, j).noalias() += weight * of_b.transpose() * of_b;
  normal_.block<kNumbers, kNumbers>(i, j).noalias() -= weight * of_a.transpose() * of_b;
  normal_.block<kNumbers, kNumbers>(j, i).noalias() -= weight * of_b.transpose() * of_a;
}

/// Bones carry their joint to one place; they turn and stretch as the one that carries them does, unless they
/// must.
void Stretching::hold_joints(double willing) {
  const double bends = kBendsFirst * std::pow(kBendsLast / kBendsFirst, willing),
               stretches = kStretchesFirst * std::pow(kStretchesLast / kStretchesFirst, willing);
  for (int b = 1; b < count_; ++b) {
    const int a = body_.parents[static_cast<size_t>(b)];
    const StretchedBone &child = bones_[static_cast<size_t>(b)], &parent = bones_[static_cast<size_t>(a)];
    const Vec3 joint = body_.joints.row(b).transpose();
    const Vec3 off = child(joint) - parent(joint),
               turned = rotation_to_axis_angle(child.R * parent.R.transpose());
    const double points = std::min(weights_[static_cast<size_t>(a)], weights_[static_cast<size_t>(b)]),
                 lever = reach_[static_cast<size_t>(b)] * reach_[static_cast<size_t>(b)];
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 direction = Vec3::Unit(axis);
      add_rows(b, row_of(b, joint, direction), a, row_of(a, joint, direction), static_cast<double>(off[axis]),
               kHoldsJoints * points);
      StretchRow turn = StretchRow::Zero();
      turn[axis] = 1;
      add_rows(b, turn, a, turn, static_cast<double>(turned[axis]),
               bends * weights_[static_cast<size_t>(b)] * lever);
    }
    for (int k = 0; k < 2; ++k) {
      StretchRow stretch = StretchRow::Zero();
      stretch[6 + k] = 1;
      const float difference = k == 0 ? child.length - parent.length : child.girth - parent.girth;
      add_rows(b, stretch, a, stretch, static_cast<double>(difference), stretches * points * lever);
    }
  }
  for (int b = 0; b < count_; ++b) {  // about as long as it is thick, about as large as before
    const StretchedBone& bone = bones_[static_cast<size_t>(b)];
    const double weight = stretches * weights_[static_cast<size_t>(b)] * reach_[static_cast<size_t>(b)] *
                          reach_[static_cast<size_t>(b)];
    for (int k = 0; k < 2; ++k) {
      const int i = kNumbers * b + 6 + k;
      normal_(i, i) += 0.2 * weight;
      gradient_[i] -= 0.2 * weight * static_cast<double>((k == 0 ? bone.length : bone.girth) - 1);
    }
    StretchRow both = StretchRow::Zero();
    both[6] = 1, both[7] = -1;
    normal_.block<kNumbers, kNumbers>(kNumbers * b, kNumbers * b).noalias() +=
        0.3 * weight * both.transpose() * both;
    gradient_.segment<kNumbers>(kNumbers * b) -=
        0.3 * weight * static_cast<double>(bone.length - bone.girth) * both.transpose();
  }
}

void Stretching::solve() {
  for (int b = 0; b < count_; ++b) {
    const auto s = static_cast<size_t>(b);
    const double stays = kStaysThere * weights_[s] + 1e-9;
    normal_.block<3, 3>(kNumbers * b, kNumbers * b).diagonal().array() +=
        stays * reach_[s] * reach_[s] + 1e-12;
    normal_.block<3, 3>(kNumbers * b + 3, kNumbers * b + 3).diagonal().array() += stays;
    normal_.block<2, 2>(kNumbers * b + 6, kNumbers * b + 6).diagonal().array() +=
        stays * reach_[s] * reach_[s] + 1e-12;
  }
  const Eigen::VectorXd step = solved(normal_, gradient_);
  for (int b = 0; b < count_; ++b) {
    StretchedBone& bone = bones_[static_cast<size_t>(b)];
    const Eigen::Matrix<float, kNumbers, 1> of = step.segment<kNumbers>(kNumbers * b).cast<float>();
    bone.R = nearest_rotation(rotation_from_axis_angle(of.head<3>()) * bone.R);
    bone.place += of.segment<3>(3);
    bone.length = std::clamp(bone.length + of[6], 1 / kMostStretch, kMostStretch);
    bone.girth = std::clamp(bone.girth + of[7], 1 / kMostStretch, kMostStretch);
  }
}

void Stretching::round(float radius, double willing) {
  normal_.setZero(kNumbers * count_, kNumbers * count_);
  gradient_.setZero(kNumbers * count_);
  match(radius);
  hold_joints(willing);
  solve();
}

ProportionFit Stretching::finished(float radius) const {
  ProportionFit fit;
  fit.bones = bones_;
  fit.points = posed();
  fit.joints = body_.joints;
  for (int b = 0; b < count_; ++b) {
    const int a = body_.parents[static_cast<size_t>(b)];
    const Vec3 joint = body_.joints.row(b).transpose();
    const StretchedBone& bone = bones_[static_cast<size_t>(b)];
    const StretchedBone& parent = bones_[static_cast<size_t>(std::max(a, 0))];
    fit.joints.row(b) = (0.5f * (bone(joint) + (a < 0 ? bone : parent)(joint))).transpose();
    fit.strained += static_cast<double>(geodesic_angle(parent.R, bone.R) + std::abs(std::log(bone.length)) +
                                        std::abs(std::log(bone.girth))) /
                    count_;
  }
  const Points normals = turned_normals();
  const PointTree tree(fit.points);
  const auto off = [&](const Vec3& at, const Vec3& to, float agree) {
    const float far2 = 4 * radius * radius, squared = agree > 0 ? (at - to).squaredNorm() : far2;
    return static_cast<double>(std::sqrt(squared * far2 / (squared + far2)));
  };
  double here = 0, there = 0;
  for (Eigen::Index i = 0; i < fit.points.rows(); ++i) {
    const int q = on_.tree.nearest(fit.points.row(i).transpose()).point;
    here += off(fit.points.row(i).transpose(), on_.points.row(q).transpose(),
                normals.row(i).dot(on_.normals.row(q)));
  }
  for (int q = 0; q < on_.spread; ++q) {
    const int i = tree.nearest(on_.points.row(q).transpose()).point;
    there += off(fit.points.row(i).transpose(), on_.points.row(q).transpose(),
                 normals.row(i).dot(on_.normals.row(q)));
  }
  fit.off_m = 0.5 * (here / static_cast<double>(fit.points.rows()) + there / on_.spread);
  return fit;
}

}  // namespace

ProportionFit fit_proportions(const PosedBody& body, const ThinnedFrame& on,
                              const ProportionFitOptions& options) {
  Stretching stretching(body, on);
  for (int round = 0; round < options.rounds; ++round) {
    const float share =
        options.rounds > 1 ? static_cast<float>(round) / static_cast<float>(options.rounds - 1) : 1;
    stretching.round(options.first_radius_m * std::pow(options.last_radius_m / options.first_radius_m, share),
                     static_cast<double>(share));
  }
  return stretching.finished(options.first_radius_m);
}

}  // namespace understudy
