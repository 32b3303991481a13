#include "retarget/motion_space/person_equations.hpp"

namespace understudy {
namespace {

Mat3 cross_of(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

PosedPerson::PosedPerson(const PersonModel& model, const Eigen::VectorXf& shape, const Points& rest,
                         const Pose& pose)
    : model_(model),
      rest_(model.joints(shape)),
      skeleton_(forward_kinematics(rest_, pose)),
      vertices_(rest.rows(), 3),
      normals_(rest.rows(), 3),
      rest_vertices_(rest) {
  std::array<Vec3, kJointCount> shift;
  for (int b = 0; b < kJointCount; ++b)
    shift[b] = skeleton_.joints.row(b).transpose() - skeleton_.global[b] * rest_.row(b).transpose();
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    const PersonModel::Skin& skin = model.skin[v];
    Mat3 turn = Mat3::Zero();
    Vec3 way = Vec3::Zero();
    for (int k = 0; k < 4 && skin.weight[k] > 0; ++k)
      turn += skin.weight[k] * skeleton_.global[skin.bone[k]], way += skin.weight[k] * shift[skin.bone[k]];
    vertices_.row(v) = turn * rest.row(v).transpose() + way;
    normals_.row(v) = (turn * model.normals.row(v).transpose()).normalized();
  }
  for (const Joints& dir : model.joint_dirs) {
    Joints& slope = joint_slopes_.emplace_back(Joints::Zero());
    for (int j = 1; j < kJointCount; ++j)
      slope.row(j) =
          slope.row(kParents[j]) +
          (skeleton_.global[kParents[j]] * (dir.row(j) - dir.row(kParents[j])).transpose()).transpose();
  }
}

FrameEquations::FrameEquations(const PosedPerson& person, bool with_shape)
    : person_(person), shapes_(with_shape ? person.model_.parameters() : 0) {
  H = Eigen::MatrixXd::Zero(kPoseUnknowns + shapes_, kPoseUnknowns + shapes_);
  g = Eigen::VectorXd::Zero(kPoseUnknowns + shapes_);
}

/// The columns of `slopes`: the root's, those of columns_, the shape's.
void FrameEquations::add(const Slopes& slopes, const Mat3& weight, const Vec3& weighted_residual) {
  const int blocks = static_cast<int>(columns_.size()), poses = 3 * blocks;
  const Slopes weighted = weight * slopes;
  const Eigen::VectorXf pull = slopes.transpose() * weighted_residual;
  for (int a = 0; a < blocks; ++a) {
    g.segment<3>(columns_[a]) += pull.segment<3>(3 * a).cast<double>();
    for (int b = 0; b <= a; ++b) {
      const Mat3 block = slopes.middleCols<3>(3 * a).transpose() * weighted.middleCols<3>(3 * b);
      // Joints come from the leaves, so the one listed later is further up.
      if (columns_[a] >= columns_[b])
        H.block<3, 3>(columns_[a], columns_[b]) += block.cast<double>();
      else
        H.block<3, 3>(columns_[b], columns_[a]) += block.transpose().cast<double>();
    }
  }
  if (shapes_ == 0 || slopes.cols() == poses) return;
  const Eigen::MatrixXf with_shape = weighted.rightCols(shapes_).transpose() * slopes;  // [S, all]
  for (int a = 0; a < blocks; ++a)
    H.block(kPoseUnknowns, columns_[a], shapes_, 3) += with_shape.middleCols(3 * a, 3).cast<double>();
  H.bottomRightCorner(shapes_, shapes_) += with_shape.rightCols(shapes_).cast<double>();
  g.tail(shapes_) += pull.tail(shapes_).cast<double>();
}

void FrameEquations::add_vertex(int vertex, const Mat3& weight, const Vec3& weighted_residual) {
  const PersonModel& model = person_.model_;
  const PosedSkeleton& skeleton = person_.skeleton_;
  const PersonModel::Skin& skin = model.skin[vertex];
  std::array<float, kJointCount> carried{};
  std::array<Vec3, kJointCount> sum;
  sum.fill(Vec3::Zero());
  const Vec3 at = person_.rest_vertices_.row(vertex);
  Mat3 turn = Mat3::Zero();
  for (int k = 0; k < 4 && skin.weight[k] > 0; ++k) {
    const int b = skin.bone[k];
    const float w = skin.weight[k];
    carried[b] += w;
    sum[b] += w * (skeleton.global[b] * (at - person_.rest_.row(b).transpose()) +
                   skeleton.joints.row(b).transpose());
    turn += w * skeleton.global[b];
  }
  columns_.assign(1, 0);
  slopes_.resize(3, 3 + 3 * kJointCount + shapes_);
  slopes_.leftCols<3>().setIdentity();
  int count = 3;
  for (int j = kJointCount - 1; j >= 0; --j) {
    if (carried[j] <= 0) continue;
    const Vec3 lever = sum[j] - carried[j] * skeleton.joints.row(j).transpose();
    slopes_.middleCols<3>(count) = -cross_of(lever);
    count += 3;
    columns_.push_back(3 + 3 * j);
    if (j == 0) break;
    carried[kParents[j]] += carried[j];
    sum[kParents[j]] += sum[j];
  }
  for (int s = 0; s < shapes_; ++s) {
    Vec3 slope = turn * model.vertex_dirs[s].row(vertex).transpose();
    for (int k = 0; k < 4 && skin.weight[k] > 0; ++k) {
      const int b = skin.bone[k];
      slope += skin.weight[k] * (person_.joint_slopes_[s].row(b).transpose() -
                                 skeleton.global[b] * model.joint_dirs[s].row(b).transpose());
    }
    slopes_.col(count++) = slope;
  }
  add(slopes_.leftCols(count), weight, weighted_residual);
}

void FrameEquations::add_carried(int bone, const Vec3& offset, float weight, const Vec3& residual) {
  const PosedSkeleton& skeleton = person_.skeleton_;
  const Vec3 at = skeleton.joints.row(bone).transpose() + skeleton.global[bone] * offset;
  columns_.assign(1, 0);
  slopes_.resize(3, 3 + 3 * kJointCount + shapes_);
  slopes_.leftCols<3>().setIdentity();
  int count = 3;
  for (int j = bone; j >= 0; j = kParents[j]) {
    slopes_.middleCols<3>(count) = -cross_of(at - skeleton.joints.row(j).transpose());
    count += 3;
    columns_.push_back(3 + 3 * j);
  }
  for (int s = 0; s < shapes_; ++s) slopes_.col(count++) = person_.joint_slopes_[s].row(bone).transpose();
  add(slopes_.leftCols(count), weight * Mat3::Identity(), weight * residual);
}

void FrameEquations::add_joint(int joint, float weight, const Vec3& residual) {
  add_carried(joint, Vec3::Zero(), weight, residual);
}

void FrameEquations::add_turn(int joint, float weight, const Vec3& turn) {
  columns_.clear();
  slopes_.resize(3, 3 * kJointCount);
  int count = 0;
  for (int j = joint; j >= 0; j = kParents[j]) {
    slopes_.middleCols<3>(count) = Mat3::Identity();
    count += 3;
    columns_.push_back(3 + 3 * j);
  }
  add(slopes_.leftCols(count), weight * Mat3::Identity(), weight * turn);
}

void FrameEquations::parent_axes() {
  H = H.selfadjointView<Eigen::Lower>();
  for (int j = 1; j < kJointCount; ++j) {
    const Eigen::Matrix3d up = person_.skeleton_.global[kParents[j]].cast<double>();
    H.middleCols<3>(3 + 3 * j) = (H.middleCols<3>(3 + 3 * j) * up).eval();
    H.middleRows<3>(3 + 3 * j) = (up.transpose() * H.middleRows<3>(3 + 3 * j)).eval();
    g.segment<3>(3 + 3 * j) = (up.transpose() * g.segment<3>(3 + 3 * j)).eval();
  }
}

}  // namespace understudy
