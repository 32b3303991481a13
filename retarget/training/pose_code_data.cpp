#include "retarget/training/pose_code_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/metrics/keypoint_metrics.hpp"
#include "retarget/pose2d/pose_code.hpp"
#include "retarget/training/proportion_data.hpp"

namespace understudy::training {
namespace {

constexpr int kShortestRun = 10, kLongestRun = 150;  // frames of a stretch that one person has
constexpr float kOff = 0.03f;                        // of a length's logarithm, as estimates are
constexpr float kMasked = 0.15f;                     // share of poses with points missing
constexpr uint64_t kPoseCodeSeed = 20210121;

/// Somebody before a camera far away, as the paper has it.
FlatSight far_sight(const FlatPerson& person, Pose pose, float yaw, float pitch) {
  pose.root.setZero();
  Pinhole camera = looking_at(Vec3::Zero(), camera_axes(yaw, pitch), 10);
  camera.orthographic = true;
  camera.focal = 300;  // pixels a metre
  return seen_flat(person, pose, camera);
}

void put_input(torch::Tensor& rows, int64_t row, const PoseCodeInput& input) {
  Eigen::Map<PoseCodeInput>(rows.data_ptr<float>() + row * input.size()) = input;
}

void put_places(torch::Tensor& rows, int64_t row, const PoseCodeInput& input) {
  using Places = Eigen::Matrix<float, kPaperPoints, 2, Eigen::RowMajor>;
  Eigen::Map<Places>(rows.data_ptr<float>() + row * 2 * kPaperPoints) = input.leftCols<2>();
}

void put_person(torch::Tensor& rows, int64_t row, const BoneLengths& lengths) {
  Eigen::Map<PersonCodeInput>(rows.data_ptr<float>() + row * kFlatBoneCount) = person_code_input(lengths);
}

}  // namespace

PoseCodeData::PoseCodeData(TrainingData data, uint64_t seed) : data_(std::move(data)) {
  const std::vector<FlatPerson> people = flat_people_of(data_);
  const std::vector<ClipRun> runs = good_runs(data_.clips, kShortestRun, kLongestRun);
  US_CHECK(!people.empty() && !runs.empty(), "the data has no person, or no clip of ", kShortestRun,
           " frames");
  Rng rng(seed);
  for (int i = 0; i < kPeople; ++i) {
    Person& person = people_.emplace_back();
    person.body = people[static_cast<size_t>(rng.below(static_cast<int>(people.size())))];
    if (i % 2 == 1) person.body = scaled_apart(person.body, random_scales(rng));
  }
  for (size_t i = 0; i < std::max<size_t>(runs.size(), people_.size()); ++i)
    people_[i % people_.size()].runs.push_back(runs[i % runs.size()]);
}

FlatSight PoseCodeData::any_sight(const Person& person, Rng& rng) const {
  const ClipRun& run = person.runs[static_cast<size_t>(rng.below(static_cast<int>(person.runs.size())))];
  Pose pose = data_.clips[static_cast<size_t>(run.clip)]
                  .motion.poses[static_cast<size_t>(run.first + rng.below(run.count))];
  if (rng.chance(0.5f)) pose = mirrored(pose);
  const float yaw = rng.uniform(-kPi, kPi), pitch = rng.uniform(-kPi / 9, kPi / 9);
  return far_sight(person.body, pose, yaw, pitch);
}

PoseCodeBatch PoseCodeData::batch(int count, Rng& rng) const {
  PoseCodeBatch batch{torch::empty({count, kPaperPoints, kPoseCodeInputs}),
                      torch::empty({count, kPaperPoints, 2}),
                      torch::empty({count, kPaperPoints, 2}),
                      torch::empty({count, kFlatBoneCount}),
                      torch::empty({count}, torch::kLong),
                      count / 2};
  for (int i = 0; i < count; ++i) {
    const int b = rng.below(kPeople), a = i < batch.within ? b : (b + 1 + rng.below(kPeople - 1)) % kPeople;
    const FlatSight x = any_sight(people_[static_cast<size_t>(a)], rng),
                    y = any_sight(people_[static_cast<size_t>(b)], rng);
    PoseCodeInput seen = pose_code_input(x.pose, stature_of(x.length));
    put_places(batch.whole, i, seen);
    if (rng.chance(kMasked))
      for (int points = 1 + rng.below(4); points > 0; --points)
        seen.row(1 + rng.below(kPaperPoints - 1)).setZero();
    put_input(batch.poses, i, seen);
    put_places(batch.own, i, pose_code_input(y.pose, stature_of(y.length)));
    BoneLengths told = y.length;
    for (float& length : told) length *= std::exp(kOff * rng.normal());
    put_person(batch.people, i, told);
    batch.person.data_ptr<int64_t>()[i] = b;
  }
  return batch;
}

PoseCodeFigures::PoseCodeFigures(const TrainingData& data, int cases)
    : poses_(torch::empty({cases, kPaperPoints, kPoseCodeInputs})),
      people_(torch::empty({cases, kFlatBoneCount})) {
  const std::vector<FlatPerson> people = flat_people_of(data);
  Rng rng(kPoseCodeSeed);
  for (int i = 0; i < cases; ++i) {
    const auto any = [&] { return people[static_cast<size_t>(rng.below(static_cast<int>(people.size())))]; };
    FlatPerson a = any(), b = scaled_apart(any(), random_scales(rng));
    if (i % 2 == 0) a = scaled_apart(a, random_scales(rng));
    const Pose pose = random_pose(data, rng);
    const float yaw = rng.uniform(-kPi, kPi), pitch = rng.uniform(-kPi / 12, kPi / 12);
    const FlatSight source = far_sight(a, pose, yaw, pitch), truth = far_sight(b, pose, yaw, pitch);
    cases_.push_back({source.pose, truth.pose, stature_of(source.length), stature_of(truth.length)});
    put_input(poses_, i, pose_code_input(source.pose, stature_of(source.length)));
    put_person(people_, i, truth.length);
  }
}

Figures PoseCodeFigures::of(const Transfer& transfer) const {
  const auto made = transfer(poses_, people_).cpu().contiguous();
  double oks = 0, violation = 0, lengths = 0, angles = 0, joints = 0, against = 0, near = 0, kept = 0;
  for (size_t i = 0; i < cases_.size(); ++i) {
    const Case& one = cases_[i];
    const float unit = kPoseCodeUnit * one.stature;
    const float* const row = made.data_ptr<float>() + i * 2 * kPaperPoints;
    FlatPose pose;
    for (int p = 0; p < kPaperPoints; ++p) pose.set(p, unit * Vec2(row[2 * p], -row[2 * p + 1]), 1);
    oks += keypoint_similarity(pose, one.truth);
    violation += order_violation(pose, one.source);
    const FlatPose placed = centred_on(pose, one.truth);
    const double metre_unit = 0.958 * 300;
    for (int p = 0; p < kPaperPoints; ++p)
      joints += static_cast<double>((placed.at(p) - one.truth.at(p)).norm()) / metre_unit / kPaperPoints;
    lengths += static_cast<double>(
        ((seen_lengths(pose) - seen_lengths(one.truth)) / static_cast<float>(metre_unit)).square().mean());
    const double off = bone_angle_error(pose, one.truth), from_source = bone_angle_error(pose, one.source);
    angles += off * off, against += from_source;
    const Touches touches = touches_kept(pose, static_cast<double>(one.stature), one.source,
                                         static_cast<double>(one.source_stature));
    near += touches.near, kept += touches.kept;
  }
  const auto count = static_cast<double>(cases_.size());
  return {{"oks", oks / count},
          {"lengths", lengths / count},
          {"angles", angles / count},
          {"joints", joints / count},
          {"violation", violation / count},
          {"near_kept", 100 * kept / std::max(near, 1.0)},
          {"angles_rad", against / count}};
}

}  // namespace understudy::training
