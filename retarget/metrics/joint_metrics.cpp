#include "retarget/metrics/joint_metrics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kSeen = 0.5f;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
using Joints64 = Eigen::Matrix<double, kJointCount, 3, Eigen::RowMajor>;

void check_same_length(size_t predicted, size_t truth) {
  US_CHECK(predicted == truth, predicted, " predicted frames and ", truth, " true ones cannot be compared");
  US_CHECK(predicted > 0, "no frames to compare");
}

double distance(const Joints& p, int a, const Joints& q, int b) {
  return (p.row(a).cast<double>() - q.row(b).cast<double>()).norm();
}

/// The limbs that have a left and a right: each side's joints by their left one.
constexpr std::array<std::array<int, 4>, 2> kLimbs = {
    {{LeftHip, LeftKnee, LeftAnkle, LeftFoot}, {LeftCollar, LeftShoulder, LeftElbow, LeftWrist}}};

bool limb_swapped(const Joints& p, const Joints& q, const std::array<int, 4>& limb) {
  double straight = 0, crossed = 0;
  for (const int left : limb) {
    const int right = kMirror[left];
    straight += distance(p, left, q, left) + distance(p, right, q, right);
    crossed += distance(p, left, q, right) + distance(p, right, q, left);
  }
  return crossed < straight;
}

Joints64 second_difference(const JointSequence& x, size_t t) {
  return x[t + 2].cast<double>() - 2.0 * x[t + 1].cast<double>() + x[t].cast<double>();
}

}  // namespace

double mean_joint_error(const JointSequence& predicted, const JointSequence& truth) {
  check_same_length(predicted.size(), truth.size());
  double sum = 0;
  for (size_t t = 0; t < truth.size(); ++t)
    sum += (predicted[t].cast<double>() - truth[t].cast<double>()).rowwise().norm().sum();
  return sum / (static_cast<double>(truth.size()) * kJointCount);
}

double seen_joint_error(const JointSequence& predicted, const JointSequence& truth,
                        const std::vector<SeenJoints>& seen) {
  check_same_length(predicted.size(), truth.size());
  check_same_length(seen.size(), truth.size());
  double sum = 0;
  int64_t count = 0;
  for (size_t t = 0; t < truth.size(); ++t)
    for (int j = 0; j < kJointCount; ++j)
      if (seen[t][j] >= kSeen) sum += distance(predicted[t], j, truth[t], j), ++count;
  return count > 0 ? sum / static_cast<double>(count) : kNan;
}

double visibility_right(const std::vector<SeenJoints>& predicted, const std::vector<SeenJoints>& truth) {
  check_same_length(predicted.size(), truth.size());
  Eigen::Index right = 0;
  for (size_t t = 0; t < truth.size(); ++t) right += ((predicted[t] >= kSeen) == (truth[t] >= kSeen)).count();
  return static_cast<double>(right) / (static_cast<double>(truth.size()) * kJointCount);
}

JointSequence aligned_joints(const JointSequence& predicted, const JointSequence& truth) {
  check_same_length(predicted.size(), truth.size());
  JointSequence aligned(truth.size());
  for (size_t t = 0; t < truth.size(); ++t) {
    const Eigen::Matrix<double, 3, kJointCount> p = predicted[t].cast<double>().transpose();
    const Eigen::Matrix<double, 3, kJointCount> q = truth[t].cast<double>().transpose();
    const Eigen::Matrix4d T = Eigen::umeyama(p, q, /*with_scaling=*/true);
    const Eigen::Matrix<double, 3, kJointCount> moved =
        (T.topLeftCorner<3, 3>() * p).colwise() + T.topRightCorner<3, 1>();
    aligned[t] = moved.transpose().cast<float>();
  }
  return aligned;
}

JointSequence scaled_joints(const JointSequence& predicted, const JointSequence& truth) {
  check_same_length(predicted.size(), truth.size());
  const auto hips = [](const Joints& joints) {
    return Eigen::RowVector3f((joints.row(LeftHip) + joints.row(RightHip)) / 2);
  };
  JointSequence scaled(truth.size());
  for (size_t t = 0; t < truth.size(); ++t) {
    const Joints p = predicted[t].rowwise() - hips(predicted[t]), q = truth[t].rowwise() - hips(truth[t]);
    const double over = p.cast<double>().squaredNorm();
    const double scale = over > 0 ? p.cast<double>().cwiseProduct(q.cast<double>()).sum() / over : 1;
    scaled[t] = (static_cast<float>(scale) * p).rowwise() + hips(truth[t]);
  }
  return scaled;
}

JointSequence resampled(const JointSequence& joints, double from_fps, double to_fps) {
  US_CHECK(from_fps > 0 && to_fps > 0, "frame rates must be positive, not ", from_fps, " and ", to_fps);
  if (joints.size() < 2 || from_fps == to_fps) return joints;
  const double last = static_cast<double>(joints.size() - 1), step = from_fps / to_fps;
  const size_t count = static_cast<size_t>(std::floor(last / step + 1e-9)) + 1;
  JointSequence result(count);
  for (size_t i = 0; i < count; ++i) {
    const double at = std::min(static_cast<double>(i) * step, last);
    const size_t before = std::min(static_cast<size_t>(at), joints.size() - 2);
    const double u = at - static_cast<double>(before);
    result[i] =
        ((1 - u) * joints[before].cast<double>() + u * joints[before + 1].cast<double>()).cast<float>();
  }
  return result;
}

double acceleration_error(const JointSequence& predicted, const JointSequence& truth, double fps) {
  check_same_length(predicted.size(), truth.size());
  const JointSequence p = resampled(predicted, fps, 30), q = resampled(truth, fps, 30);
  if (q.size() < 3) return kNan;
  double sum = 0;
  for (size_t t = 0; t + 2 < q.size(); ++t)
    sum += (second_difference(p, t) - second_difference(q, t)).rowwise().norm().sum();
  return sum / (static_cast<double>(q.size() - 2) * kJointCount);
}

double swap_rate(const JointSequence& predicted, const JointSequence& truth) {
  check_same_length(predicted.size(), truth.size());
  int swapped = 0;
  for (size_t t = 0; t < truth.size(); ++t)
    for (const auto& limb : kLimbs) swapped += limb_swapped(predicted[t], truth[t], limb);
  return swapped / (static_cast<double>(truth.size()) * kLimbs.size());
}

double flip_rate(const JointSequence& predicted, const JointSequence& truth) {
  check_same_length(predicted.size(), truth.size());
  // The hip line itself, not its shadow on the floor: it gives the heading of a lying body too.
  const auto hip_line = [](const Joints& x) { return Vec3(x.row(LeftHip) - x.row(RightHip)); };
  int flipped = 0;
  for (size_t t = 0; t < truth.size(); ++t) flipped += hip_line(predicted[t]).dot(hip_line(truth[t])) < 0;
  return static_cast<double>(flipped) / static_cast<double>(truth.size());
}

RotationError rotation_error(const std::vector<Rotations>& predicted, const std::vector<Rotations>& truth) {
  check_same_length(predicted.size(), truth.size());
  std::array<double, kJointCount> angle{};  // summed over frames, radians
  for (size_t t = 0; t < truth.size(); ++t) {
    const Rotations p = global_rotations(predicted[t]), q = global_rotations(truth[t]);
    for (int j = 0; j < kJointCount; ++j) angle[j] += geodesic_angle(p[j], q[j]);
  }
  const auto mean_deg = [&](std::initializer_list<int> joints) {
    double sum = 0;
    for (const int j : joints) sum += angle[j];
    return sum / (static_cast<double>(joints.size() * truth.size())) * 180 / M_PI;
  };
  double all = 0;
  for (const double a : angle) all += a;
  all *= 180 / M_PI / (static_cast<double>(kJointCount * truth.size()));
  return {all, mean_deg({Head}), mean_deg({LeftWrist, RightWrist}), mean_deg({LeftFoot, RightFoot})};
}

double bone_drift(const JointSequence& joints) {
  US_CHECK(!joints.empty(), "no frames to evaluate");
  const double frames = static_cast<double>(joints.size());
  double sum = 0;
  for (int j = 1; j < kJointCount; ++j) {
    double mean = 0, variance = 0;
    for (const Joints& x : joints) mean += distance(x, j, x, kParents[j]) / frames;
    for (const Joints& x : joints) variance += std::pow(distance(x, j, x, kParents[j]) - mean, 2) / frames;
    if (mean > 0) sum += std::sqrt(variance) / mean;
  }
  return sum / (kJointCount - 1);
}

double foot_skate(const JointSequence& joints, double fps) {
  US_CHECK(fps > 0, "frame rate must be positive, not ", fps);
  constexpr float kNear = 0.05f;  // metres from the floor
  double sum = 0;
  int count = 0;
  for (size_t t = 0; t + 1 < joints.size(); ++t)
    for (const int foot : {LeftFoot, RightFoot}) {
      const Vec3 now = joints[t].row(foot), next = joints[t + 1].row(foot);
      if (std::abs(now.y()) > kNear || std::abs(next.y()) > kNear) continue;
      sum +=
          std::hypot(static_cast<double>(next.x()) - now.x(), static_cast<double>(next.z()) - now.z()) * fps;
      ++count;
    }
  return count == 0 ? kNan : sum / count;
}

double jerk(const JointSequence& joints, double fps) {
  US_CHECK(fps > 0, "frame rate must be positive, not ", fps);
  if (joints.size() < 4) return kNan;
  double sum = 0;
  for (size_t t = 0; t + 3 < joints.size(); ++t)
    sum += (second_difference(joints, t + 1) - second_difference(joints, t)).rowwise().norm().sum();
  return sum * fps * fps * fps / (static_cast<double>(joints.size() - 3) * kJointCount);
}

}  // namespace understudy
