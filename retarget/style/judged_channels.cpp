#include "retarget/style/judged_channels.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kLeastSpread = 1e-4f;  // radians; only what stands still has less

Eigen::RowVectorXf spread_of(const RowMatrix& channels) {
  const RowMatrix centred = channels.rowwise() - channels.colwise().mean();
  return (centred.colwise().squaredNorm() / static_cast<float>(channels.rows())).cwiseSqrt();
}

/// Of each channel that of the joint on the other side.
std::vector<int> mirror_channels(bool legs) {
  const std::vector<int> joints = judged_joints(legs);
  std::vector<int> mirror;
  for (const int j : joints) {
    const auto other = std::find(joints.begin(), joints.end(), kMirror[static_cast<size_t>(j)]);
    for (int axis = 0; axis < 3; ++axis)
      mirror.push_back(3 * static_cast<int>(other - joints.begin()) + axis);
  }
  return mirror;
}

}  // namespace

std::vector<int> judged_joints(bool legs) {
  std::vector<int> joints = {Pelvis,     Spine1,      Spine2,       Spine3,        Neck,      Head,
                             LeftCollar, RightCollar, LeftShoulder, RightShoulder, LeftElbow, RightElbow};
  if (legs) joints.insert(joints.end(), {LeftHip, RightHip, LeftKnee, RightKnee});
  return joints;
}

RowMatrix judged_channels(const std::vector<Rotations>& local, bool legs) {
  const std::vector<int> joints = judged_joints(legs);
  RowMatrix channels(static_cast<Eigen::Index>(local.size()), static_cast<Eigen::Index>(3 * joints.size()));
  for (Eigen::Index t = 0; t < channels.rows(); ++t) {
    const Rotations& pose = local[static_cast<size_t>(t)];
    Eigen::Index column = 0;
    for (const int j : joints) {
      const Mat3 turn =
          j == Pelvis ? Mat3(rotation_about_y(heading_of(pose[j])).transpose() * pose[j]) : pose[j];
      channels.block<1, 3>(t, column) = rotation_to_axis_angle(turn).transpose();
      column += 3;
    }
  }
  return channels;
}

RowMatrix mirrored_channels(const RowMatrix& channels, bool legs) {
  const std::vector<int> mirror = mirror_channels(legs);
  RowMatrix made(channels.rows(), channels.cols());
  for (Eigen::Index c = 0; c < channels.cols(); ++c)  // a turn about x stays, the others go the other way
    made.col(c) = (c % 3 == 0 ? 1.0f : -1.0f) * channels.col(mirror[static_cast<size_t>(c)]);
  return made;
}

std::vector<int> moving_channels(const std::vector<RowMatrix>& clips, bool legs, float least) {
  US_CHECK(!clips.empty(), "there is no clip to find moving channels in");
  const std::vector<int> mirror = mirror_channels(legs);
  Eigen::RowVectorXf mean = Eigen::RowVectorXf::Zero(clips[0].cols());
  for (const RowMatrix& clip : clips) mean += spread_of(clip) / static_cast<float>(clips.size());
  std::vector<int> moving;
  for (Eigen::Index c = 0; c < mean.size(); ++c)
    if (std::max(mean[c], mean[mirror[static_cast<size_t>(c)]]) >= least)
      moving.push_back(static_cast<int>(c));
  return moving;
}

RowMatrix resampled(const RowMatrix& rows, float first, float length, int count) {
  RowMatrix made(count, rows.cols());
  const auto last = static_cast<float>(rows.rows() - 1);
  for (int i = 0; i < count; ++i) {
    const float share = count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0.0f;
    const float at = std::clamp(first + length * share, 0.0f, last), before = std::floor(at);
    const auto row = static_cast<Eigen::Index>(before), next = std::min(row + 1, rows.rows() - 1);
    made.row(i) = rows.row(row) + (at - before) * (rows.row(next) - rows.row(row));
  }
  return made;
}

RowMatrix coordination_of(const RowMatrix& channels) {
  US_CHECK(channels.rows() > 0, "a clip without frames has no coordination");
  RowMatrix made = resampled(channels, 0, static_cast<float>(channels.rows() - 1), kCoordinationFrames);
  made.rowwise() -= made.colwise().mean().eval();
  const Eigen::RowVectorXf spread = spread_of(made).cwiseMax(kLeastSpread);
  return made.array().rowwise() / spread.array();
}

}  // namespace understudy
