#include "retarget/marionette/motion_form.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// The rotation nearest to what is left of one after rows were blended.
Mat3 rotation_of_mean(const Eigen::RowVectorXf& row, int column) {
  const Vec3 a = row.segment<3>(column).transpose(), b = row.segment<3>(column + 3).transpose();
  Mat3 M;
  M << a, b, a.cross(b);
  return nearest_rotation(M);
}

/// How far a bone and all that hangs on it reach, metres, at rest.
std::vector<float> reaches(const Rig& rig) {
  std::vector<float> reach(rig.joints.size(), 0);
  for (Eigen::Index v = 0; v < rig.skin.size(); ++v) {
    const auto bone = static_cast<size_t>(rig.skin.main_bone(v));
    reach[bone] =
        std::max(reach[bone], (rig.surface.vertices.row(v).transpose() - rig.joints[bone].rest).norm());
  }
  for (size_t j = rig.joints.size(); j-- > 1;) {
    const auto parent = static_cast<size_t>(rig.joints[j].parent);
    reach[parent] = std::max(reach[parent], reach[j] + (rig.joints[j].rest - rig.joints[parent].rest).norm());
  }
  return reach;
}

}  // namespace

MotionForm::MotionForm(const Rig& rig) : rig_(rig) {
  const std::vector<float> reach = reaches(rig);
  size_ = std::max(reach[0], 1e-6f);
  std::vector<float> weights = {1, 1, 0.5f, 2};
  weights.insert(weights.end(), 6, 1);
  column_.assign(rig.joints.size(), -1);
  for (size_t j = 1; j < rig.joints.size(); ++j) {
    const JointKind kind = rig.joints[j].kind;
    if (kind == JointKind::Fixed) continue;
    column_[j] = static_cast<int>(ssize(weights));
    constexpr float kLeast = 0.15f;  // ends are seen, too
    weights.insert(weights.end(), kind == JointKind::Slider ? 1 : 6, std::max(kLeast, reach[j] / size_));
  }
  stands_ = static_cast<int>(ssize(weights));
  weights.insert(weights.end(), rig.joints.size(), 0);
  weights_ = Eigen::Map<Eigen::RowVectorXf>(weights.data(), ssize(weights));
}

Eigen::RowVectorXf MotionForm::row_of(const RigPose& pose) const {
  Eigen::RowVectorXf row = Eigen::RowVectorXf::Zero(width());
  row[kHeight] = pose.root.y() / size_;
  row.segment<6>(kTilt) =
      rotation_to_6d(rotation_about_y(-heading_of(pose.turns[0])) * pose.turns[0]).transpose();
  for (size_t j = 1; j < column_.size(); ++j) {
    if (column_[j] < 0) continue;
    if (rig_.joints[j].kind == JointKind::Slider)
      row[column_[j]] = pose.slides[j] / size_;
    else
      row.segment<6>(column_[j]) = rotation_to_6d(pose.turns[j]).transpose();
  }
  return row;
}

void MotionForm::put_pose(const Eigen::RowVectorXf& own, Eigen::Ref<Eigen::RowVectorXf> row) const {
  row.segment(kHeight, stands_ - kHeight) = own.segment(kHeight, stands_ - kHeight);
}

RowMatrix MotionForm::rows(const RigMotion& motion, const std::vector<std::vector<char>>& touches) const {
  RowMatrix rows(ssize(motion.poses), width());
  const auto fps = static_cast<float>(motion.fps);
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    const RigPose& pose = motion.poses[static_cast<size_t>(t)];
    rows.row(t) = row_of(pose);
    if (t > 0) {
      const RigPose& before = motion.poses[static_cast<size_t>(t - 1)];
      const float heading = heading_of(before.turns[0]);
      const Vec3 way = rotation_about_y(-heading) * (pose.root - before.root) * (fps / size_);
      rows(t, kSpeed) = way.x(), rows(t, kSpeed + 1) = way.z();
      rows(t, kTurn) = std::remainder(heading_of(pose.turns[0]) - heading, 2 * kPi) * fps;
    }
    for (size_t j = 0; !touches.empty() && j < rig_.joints.size(); ++j)
      rows(t, stands_ + static_cast<int>(j)) = touches[static_cast<size_t>(t)][j];
  }
  if (rows.rows() > 1) rows.row(0).head<3>() = rows.row(1).head<3>();
  return rows;
}

RigPose MotionForm::pose(const Eigen::RowVectorXf& row) const {
  RigPose pose = rest_pose(rig_);
  const Mat3 tilt = rotation_of_mean(row, kTilt);
  pose.turns[0] = rotation_about_y(-heading_of(tilt)) * tilt;
  pose.root = Vec3(0, row[kHeight] * size_, 0);
  for (size_t j = 1; j < column_.size(); ++j) {
    if (column_[j] < 0) continue;
    if (rig_.joints[j].kind == JointKind::Slider)
      pose.slides[j] = row[column_[j]] * size_;
    else
      pose.turns[j] = rotation_of_mean(row, column_[j]);
  }
  return pose_of(rig_, bone_motions(rig_, pose));  // of hinges what they can
}

RigMotion MotionForm::motion(const RowMatrix& rows, const RigPose& start, double fps) const {
  RigMotion made{fps, {}};
  float heading = heading_of(start.turns[0]);
  Vec3 place = start.root;
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    if (t > 0) {
      const Vec3 way = Vec3(rows(t, kSpeed), 0, rows(t, kSpeed + 1)) * (size_ / static_cast<float>(fps));
      place += rotation_about_y(heading) * way;
      heading += rows(t, kTurn) / static_cast<float>(fps);
    }
    RigPose next = pose(rows.row(t));
    next.root.x() = place.x(), next.root.z() = place.z();
    next.turns[0] = rotation_about_y(heading) * next.turns[0];
    made.poses.push_back(std::move(next));
  }
  return made;
}

std::vector<std::vector<char>> MotionForm::touches(const RowMatrix& rows) const {
  std::vector<std::vector<char>> touches;
  for (Eigen::Index t = 0; t < rows.rows(); ++t) {
    auto& now = touches.emplace_back(rig_.joints.size(), 0);
    for (size_t j = 0; j < now.size(); ++j) now[j] = rows(t, stands_ + static_cast<int>(j)) > 0.5f;
  }
  return touches;
}

}  // namespace understudy
