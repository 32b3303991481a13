// Scans of streams, with the extractor's own joints of the frames before.
#pragma once

#include "retarget/pipeline/interfaces.hpp"
#include "retarget/training/scan_maker.hpp"

namespace understudy::training {

struct FollowedScans {
  std::vector<MadeScan> scans;
  std::vector<RecentJoints> recent;  ///< of each scan; wrong in some, as after a cut
};

/// Follows many people at once and takes some of them in turn, so that a batch's scans, and those of the
/// batches after it, have little to do with each other. One thread each; repeatable.
class ScanStreams {
 public:
  ScanStreams(const TrainingData& data, const ScanMakerOptions& options, uint64_t seed, int people = 128);
  /// count: up to the number of people.
  FollowedScans next(int count);
  /// The joints extracted from the scans of the last next(), world, metres.
  void saw(const std::vector<Joints>& joints);

 private:
  struct Followed {
    ScanMaker::Stream stream;
    RecentJoints recent;
  };
  RecentJoints wrong(const RecentJoints& recent);

  ScanMaker maker_;
  Rng rng_;
  std::vector<Followed> people_;
  std::vector<size_t> shown_;  // those of the last next()
  size_t turn_ = 0;
};

}  // namespace understudy::training
