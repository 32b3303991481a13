#include "app/run/style_baselines.hpp"

#include "app/run/style_teacher.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/clips.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/foot_contact.hpp"
#include "retarget/style/fit_manner.hpp"

namespace understudy::app {
namespace {

constexpr float kLeastDeviation = 0.01f;  // radians: what is still is not made to move

/// [frames, 3 joints]; the pelvis' without its heading.
RowMatrix channels_of(const StyledClip& clip) {
  const std::vector<int> joints = fitted_joints("all");
  RowMatrix channels(static_cast<Eigen::Index>(clip.poses.size()),
                     static_cast<Eigen::Index>(3 * joints.size()));
  for (size_t t = 0; t < clip.poses.size(); ++t)
    for (size_t k = 0; k < joints.size(); ++k) {
      Mat3 local = clip.poses[t].local[joints[k]];
      if (joints[k] == Pelvis) local = rotation_about_y(-heading_of(local)) * local;
      channels.block<1, 3>(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(3 * k)) =
          rotation_to_axis_angle(local).transpose();
    }
  return channels;
}

}  // namespace

ChannelStatistics::Spread statistics_of(const StyledClip& clip) {
  const RowMatrix channels = channels_of(clip);
  const Eigen::RowVectorXf mean = channels.colwise().mean();
  const Eigen::RowVectorXf deviation = (channels.rowwise() - mean).array().square().colwise().mean().sqrt();
  return {mean.transpose(), deviation.transpose().cwiseMax(kLeastDeviation)};
}

ChannelStatistics::ChannelStatistics(const std::string& folder, const Networks& networks) {
  for (const std::string& path : recordings(folder)) {
    if (file_suffix(path) != ".npz") continue;
    SourceOptions source;
    source.path = path;
    source.quiet = true;
    const Spread spread = statistics_of(styled_clip(source, networks, {}));
    by_content_[""].push_back(spread);
    const std::vector<std::string> labels = clip_labels(path);
    if (!labels.empty()) by_content_[lower_case(labels.front())].push_back(spread);
  }
  US_CHECK(!by_content_.empty(), folder, ": holds no clip (.npz, AMASS-format)");
}

ChannelStatistics::Spread ChannelStatistics::of(const std::string& content) const {
  const auto found = by_content_.find(content);
  const std::vector<Spread>& all = (found == by_content_.end() ? by_content_.find("") : found)->second;
  Spread sum = all.front();
  sum.mean.setZero(), sum.deviation.setZero();
  for (const Spread& one : all) sum.mean += one.mean, sum.deviation += one.deviation.cwiseAbs2();
  const auto count = static_cast<float>(all.size());
  return {sum.mean / count, (sum.deviation / count).cwiseSqrt()};
}

StyledClip with_statistics(StyledClip clip, const ChannelStatistics::Spread& from,
                           const ChannelStatistics::Spread& to) {
  const std::vector<int> joints = fitted_joints("all");
  const RowMatrix channels = channels_of(clip);
  for (size_t t = 0; t < clip.poses.size(); ++t) {
    const Eigen::VectorXf is = channels.row(static_cast<Eigen::Index>(t)).transpose();
    const Eigen::VectorXf made =
        to.mean + (is - from.mean).cwiseProduct(to.deviation.cwiseQuotient(from.deviation));
    for (size_t k = 0; k < joints.size(); ++k) {
      Mat3& local = clip.poses[t].local[joints[k]];
      const Mat3 turned = rotation_from_axis_angle(Vec3(made.segment<3>(static_cast<Eigen::Index>(3 * k))));
      local = joints[k] == Pelvis ? Mat3(rotation_about_y(heading_of(local)) * turned) : turned;
    }
  }
  return clip;
}

}  // namespace understudy::app
