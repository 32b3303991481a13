#include "retarget/nn/extractor_input.hpp"

#include <cstring>

#include "retarget/base/error.hpp"

namespace understudy::nn {
namespace {

using RecentRows = Eigen::Matrix<float, kJointCount, 6, Eigen::RowMajor>;

void copy_to(const Points& points, torch::Tensor tensor) {
  std::memcpy(tensor.data_ptr<float>(), points.data(), sizeof(float) * points.size());
}

void copy_recent(const RecentJoints& recent, const ScanPatches& patches, torch::Tensor joints,
                 torch::Tensor known) {
  if (!recent.last) return;
  RecentRows rows = RecentRows::Zero();
  rows.leftCols(3) = (recent.last->rowwise() - patches.centre.transpose()) / patches.scale;
  if (recent.before_last) rows.rightCols(3) = (*recent.last - *recent.before_last) / patches.scale;
  std::memcpy(joints.data_ptr<float>(), rows.data(), sizeof(float) * rows.size());
  known.data_ptr<float>()[0] = 1;
  known.data_ptr<float>()[1] = recent.before_last ? 1 : 0;
}

}  // namespace

ExtractorInput extractor_input(const std::vector<ScanPatches>& patches,
                               const std::vector<RecentJoints>& recent) {
  US_CHECK(recent.empty() || recent.size() == patches.size(), patches.size(), " scans with the past of ",
           recent.size());
  const auto B = static_cast<int64_t>(patches.size());
  ExtractorInput input;
  input.points = torch::empty({B, kScanPoints, 3});
  input.centres = torch::empty({B, kPatches, 3});
  input.offsets = torch::empty({B, kPatches, kPatchPoints, 3});
  if (!recent.empty()) {
    input.recent = torch::zeros({B, kJointCount, 6});
    input.recent_known = torch::zeros({B, 2});
  }
  for (int64_t b = 0; b < B; ++b) {
    const ScanPatches& of = patches[b];
    copy_to(of.points, input.points[b]);
    copy_to(of.centres, input.centres[b]);
    copy_to(of.offsets, input.offsets[b]);
    if (!recent.empty()) copy_recent(recent[b], of, input.recent[b], input.recent_known[b]);
  }
  return input;
}

}  // namespace understudy::nn
