#include "retarget/body/exact_body.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/percentile.hpp"

namespace understudy {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Eigen::VectorXd bent(const Rotations64& local) {
  Eigen::VectorXd features(9 * (kJointCount - 1));
  for (int j = 1; j < kJointCount; ++j)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) features[9 * (j - 1) + 3 * r + c] = local[j](r, c) - (r == c);
  return features;
}

struct PosedPerson {
  Points64 vertices;
  Joints64 joints;
};

PosedPerson posed(const ExactPerson& person, const Rotations64& local, const Vector3d& root) {
  Rotations64 global;
  PosedPerson result;
  Joints64 shift;  // of what follows a joint
  for (int j = 0; j < kJointCount; ++j) {
    const int up = kParents[j];
    global[j] = up < 0 ? local[j] : Matrix3d(global[up] * local[j]);
    if (up < 0)
      result.joints.row(j) = root.transpose();
    else
      result.joints.row(j) =
          result.joints.row(up) + (person.joints.row(j) - person.joints.row(up)) * global[up].transpose();
    shift.row(j) = result.joints.row(j) - person.joints.row(j) * global[j].transpose();
  }
  Points64 rest = person.vertices;
  if (person.pose_dirs)
    Eigen::Map<Eigen::VectorXd>(rest.data(), rest.size()).noalias() += *person.pose_dirs * bent(local);
  result.vertices = Points64::Zero(rest.rows(), 3);
  for (Eigen::Index v = 0; v < rest.rows(); ++v)
    for (int j = 0; j < kJointCount; ++j)
      if (const double w = person.weights(v, j); w != 0)
        result.vertices.row(v) += w * (rest.row(v) * global[j].transpose() + shift.row(j));
  return result;
}

void turn_y_up(ExactMotion& motion) {
  const Vector3d up = motion.local[0][Pelvis].col(1);
  if (std::abs(up.z()) <= std::abs(up.y())) return;
  Matrix3d turn;
  turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // z to y, y to -z
  for (Rotations64& local : motion.local) local[Pelvis] = turn * local[Pelvis];
  for (Vector3d& root : motion.root) root = turn * root;
}

}  // namespace

double ExactPerson::leg() const {
  const auto bone = [this](int a, int b) { return (joints.row(a) - joints.row(b)).norm(); };
  return (bone(LeftKnee, LeftHip) + bone(LeftAnkle, LeftKnee) + bone(RightKnee, RightHip) +
          bone(RightAnkle, RightKnee)) /
         2;
}

ExactBody::ExactBody(const Body& body) : body_(body) {
  if (body.pose_dirs) pose_dirs_ = std::make_shared<Eigen::MatrixXd>(body.pose_dirs->cast<double>());
}

ExactPerson ExactBody::shaped(const Eigen::VectorXf& betas) const {
  US_CHECK(betas.size() <= body_.shape_dirs.cols(), betas.size(), " shape parameters for a body that has ",
           body_.shape_dirs.cols());
  ExactPerson person;
  person.vertices = body_.template_vertices.cast<double>();
  for (Eigen::Index k = 0; k < betas.size(); ++k)
    Eigen::Map<Eigen::VectorXd>(person.vertices.data(), person.vertices.size()) +=
        static_cast<double>(betas[k]) * body_.shape_dirs.col(k).cast<double>();
  person.joints = body_.joint_regressor.cast<double>() * person.vertices;
  person.faces = body_.faces;
  person.weights = body_.weights;
  person.pose_dirs = pose_dirs_;
  return person;
}

ExactPerson exact_person(const ShapedBody& body) {
  return {body.vertices.cast<double>(), body.joints.cast<double>(), body.faces, body.weights, nullptr};
}

Matrix3d exact_rotation(const Vector3d& axis_angle) {
  const double angle = axis_angle.norm();
  const Vector3d k = axis_angle / std::max(angle, 1e-9);
  Matrix3d K;
  K << 0, -k.z(), k.y(), k.z(), 0, -k.x(), -k.y(), k.x(), 0;
  return Matrix3d::Identity() + std::sin(angle) * K + (1 - std::cos(angle)) * (K * K);
}

ExactMotion read_exact_motion(const std::string& path, int start, int frames) {
  const AmassArrays arrays = read_amass_arrays(path);
  const double step = std::max(1.0, static_cast<double>(arrays.fps) / 30);
  ExactMotion motion;
  for (int i = 0; i < frames; ++i) {
    const Eigen::Index t = std::lround((start + i) * step);
    if (t >= arrays.angles.rows()) break;
    Rotations64 local;
    for (int j = 0; j < kJointCount; ++j)
      local[j] = exact_rotation(arrays.angles.block<1, 3>(t, 3 * j).transpose().cast<double>());
    motion.local.push_back(local);
    motion.root.push_back(arrays.trans.row(t).transpose().cast<double>());
  }
  US_CHECK(!motion.local.empty(), path, ": ends before frame ", start);
  turn_y_up(motion);
  return motion;
}

Performance perform(const ExactPerson& person, const ExactMotion& motion, double path_scale) {
  return perform(person, {}, motion, path_scale);
}

Performance perform(const ExactPerson& person, const std::vector<Points64>& shapes, const ExactMotion& motion,
                    double path_scale) {
  Performance performance;
  std::vector<double> lowest;
  ExactPerson now = person;
  for (size_t t = 0; t < motion.local.size(); ++t) {
    if (!shapes.empty()) now.vertices = shapes.at(t);
    PosedPerson frame = posed(now, motion.local[t], motion.root[t] * path_scale);
    lowest.push_back(frame.vertices.col(1).minCoeff());
    performance.vertices.push_back(std::move(frame.vertices));
    performance.joints.push_back(frame.joints);
  }
  const double floor = percentile(lowest, 2);
  for (Points64& vertices : performance.vertices) vertices.col(1).array() -= floor;
  for (Joints64& joints : performance.joints) joints.col(1).array() -= floor;
  return performance;
}

}  // namespace understudy
