#include "retarget/training/scan_streams.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/math/directions.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::training {
namespace {

constexpr float kWrong = 0.06f;  // share of scans with a past that is not theirs

}  // namespace

ScanStreams::ScanStreams(const TrainingData& data, const ScanMakerOptions& options, uint64_t seed, int people)
    : maker_(data, options, seed), rng_(seed + 1), people_(people) {}

/// Sides exchanged, somebody else's, or displaced.
RecentJoints ScanStreams::wrong(const RecentJoints& recent) {
  const RecentJoints& other = people_[rng_.below(people_.size())].recent;
  const int how = rng_.below(3);
  const Eigen::RowVector3f away = 0.2f * rng_.normal() * random_direction(rng_).transpose();
  const auto made = [&](const Joints& own) -> Joints {
    if (how == 0) return own(kMirror, Eigen::all);  // sides exchanged
    if (how == 1 && other.last)
      return (other.last->rowwise() - other.last->row(Pelvis)).rowwise() + own.row(Pelvis);
    return own.rowwise() + away;
  };
  RecentJoints result;
  if (recent.before_last) result.push(made(*recent.before_last));
  if (recent.last) result.push(made(*recent.last));
  return result;
}

FollowedScans ScanStreams::next(int count) {
  US_CHECK(count <= ssize(people_), "only ", people_.size(), " people are followed");
  FollowedScans batch;
  shown_.clear();
  for (int i = 0; i < count; ++i) {
    shown_.push_back(turn_++ % people_.size());
    Followed& one = people_[shown_.back()];
    if (one.stream.poses.empty()) one = {maker_.start(), {}};
    batch.scans.push_back(maker_.next(one.stream));
    batch.recent.push_back(rng_.chance(kWrong) ? wrong(one.recent) : one.recent);
  }
  return batch;
}

void ScanStreams::saw(const std::vector<Joints>& joints) {
  US_CHECK(joints.size() == shown_.size(), shown_.size(), " scans were shown, not ", joints.size());
  for (size_t i = 0; i < joints.size(); ++i) people_[shown_[i]].recent.push(joints[i]);
}

}  // namespace understudy::training
