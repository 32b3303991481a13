#include "retarget/metrics/gap_score.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/metrics/confidence.hpp"

namespace understudy {
namespace {

/// Frames after the last that is known, and the figure of each.
constexpr std::pair<size_t, const char*> kPredicted[] = {{3, "mve_3_m"}, {8, "mve_8_m"}, {15, "mve_15_m"}};

/// Frames first .. last, as far as there are such.
JointSequence part_of(const JointSequence& all, int first, int last) {
  const int from = std::max(first, 0), to = std::min(last + 1, static_cast<int>(ssize(all)));
  return {all.begin() + from, all.begin() + to};
}

Joints less_pelvis(const Joints& joints) {
  return joints.rowwise() - Eigen::RowVector3f(joints.row(Pelvis));
}

}  // namespace

void GapScore::Mean::add(double value) {
  if (std::isfinite(value)) sum += value, ++count;
}

void GapScore::push(const FilledGap& gap, double fps) {
  const auto frames = gap.truth.size();
  US_CHECK(gap.joints.size() == frames && gap.doubt.size() == frames && gap.first >= 0 &&
               gap.first <= gap.last && gap.last < ssize(gap.truth),
           "a gap of frames ", gap.first, " to ", gap.last, " is not in ", frames, " frames");
  US_CHECK(gap.vertex_errors.empty() || ssize(gap.vertex_errors) == gap.last - gap.first + 1,
           "a gap of frames ", gap.first, " to ", gap.last, " has ", gap.vertex_errors.size(),
           " frames of vertices");
  push_frames(gap);
  const JointSequence p = part_of(gap.joints, gap.first - 1, gap.last + 1),
                      q = part_of(gap.truth, gap.first - 1, gap.last + 1);
  means_["gap_foot_skate"].add(foot_skate(p, fps));
  means_["gap_foot_skate_true"].add(foot_skate(q, fps));
  // the second differences of a frame more
  means_["gap_acc"].add(acceleration_error(part_of(gap.joints, gap.first - 2, gap.last + 2),
                                           part_of(gap.truth, gap.first - 2, gap.last + 2), fps));
  push_seams(gap, fps);
}

void GapScore::push_frames(const FilledGap& gap) {
  for (int t = gap.first; t <= gap.last; ++t) {
    errors_.push_back(mean_joint_error({gap.joints[t]}, {gap.truth[t]}));
    doubts_.push_back(static_cast<double>(gap.doubt[t]));
    means_["gap_mpjpe_m"].add(errors_.back());
    means_["gap_rel_mpjpe_m"].add(
        mean_joint_error({less_pelvis(gap.joints[t])}, {less_pelvis(gap.truth[t])}));
  }
  for (const double error : gap.vertex_errors) means_["mve_m"].add(error);
  if (gap.last + 1 < ssize(gap.truth)) return;
  for (const auto& [frames, key] : kPredicted)
    if (frames <= gap.vertex_errors.size()) means_[key].add(gap.vertex_errors[frames - 1]);
}

void GapScore::push_seams(const FilledGap& gap, double fps) {
  Mean seams;
  for (const int t : {gap.first - 1, gap.first, gap.last, gap.last + 1}) {
    if (t < 1 || t + 1 >= ssize(gap.truth)) continue;
    const JointSequence p = part_of(gap.joints, t - 1, t + 1), q = part_of(gap.truth, t - 1, t + 1);
    // of three neighbouring frames, seen as if at 30 frames/s: no frame is made between them
    seams.add(acceleration_error(p, q, 30) * fps * fps / 900);
  }
  if (seams.count > 0) means_["seam_m"].add(seams.sum / static_cast<double>(seams.count));
}

void GapScore::append(const GapScore& other) {
  for (const auto& [key, mean] : other.means_) {
    means_[key].sum += mean.sum;
    means_[key].count += mean.count;
  }
  errors_.insert(errors_.end(), other.errors_.begin(), other.errors_.end());
  doubts_.insert(doubts_.end(), other.doubts_.begin(), other.doubts_.end());
}

std::map<std::string, double> GapScore::figures() const {
  std::map<std::string, double> figures;
  for (const auto& [key, mean] : means_)
    if (mean.count > 0) figures[key] = mean.sum / static_cast<double>(mean.count);
  const double spread = rank_correlation(doubts_, errors_);
  if (std::isfinite(spread)) figures["spread"] = spread;
  return figures;
}

}  // namespace understudy
