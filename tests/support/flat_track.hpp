// Files of 2D poses, and a reader of lengths without a network.
#pragma once

#include <any>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "retarget/pipeline/keypoint_transfer.hpp"
#include "retarget/pipeline/lifter.hpp"
#include "retarget/pose2d/flat_placement.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy {

/// Believes what it sees.
class SeenLengths final : public LengthReader {
 public:
  PoseLengths read(const FlatPose& pose) const override {
    const BoneLengths seen = seen_lengths(pose);
    US_CHECK((seen > 0).count() >= 2, "fewer than two points are seen");
    PoseLengths told;
    for (int b = 0; b < kFlatBoneCount; ++b) {
      told.log_length[b] = std::log(seen[b] > 0 ? seen[b] : 50.0f);
      told.doubt[b] = seen[b] > 0 ? 0.05f : 0.5f;
    }
    return told;
  }
};

/// A person who stands as in T-pose and goes where the middle of the hips goes, a metre for 200 pixels.
class StandingLifter final : public Lifter {
 public:
  explicit StandingLifter(Joints rest) : rest_(std::move(rest)) {}
  void reset(const LiftView&) override { start_.reset(); }
  Extraction push(const FlatPose& pose, float) override {
    const float x = pose.at(body25::MidHip).x() / 200;
    if (!start_) start_ = x;
    Extraction seen;
    seen.joints = rest_.rowwise() + Eigen::RowVector3f(x - *start_, 0, 0);
    return seen;
  }
  std::any memory() const override { return start_; }
  void restore(const std::any& memory) override { start_ = std::any_cast<std::optional<float>>(memory); }
  std::string name() const override { return "standing"; }

 private:
  Joints rest_;
  std::optional<float> start_;
};

/// A reading of nobody yet, on a canvas of 640 x 560.
inline KeypointReading empty_track(int people = 1) {
  KeypointReading track;
  track.canvas = {640, 560};
  track.tracks.resize(static_cast<size_t>(people));
  for (int k = 0; k < people; ++k) track.tracks[static_cast<size_t>(k)].person = k + 1;
  return track;
}

/// A person who walks `step` pixels a frame to the right; of several, the others stand at the right, each
/// `apart` pixels from the one before.
inline KeypointReading walking_track(int frames, float step = 4, int people = 1, float apart = 150) {
  KeypointReading track = empty_track(people);
  for (int t = 0; t < frames; ++t) {
    track.frames.push_back({t, ""});
    for (int k = 0; k < people; ++k) {
      const float x = k == 0 ? 150 + step * static_cast<float>(t) : 300 + apart * static_cast<float>(k);
      track.tracks[static_cast<size_t>(k)].poses.push_back({t, 1, flat_person(x)});
    }
  }
  return track;
}

/// One picture's person, `size` times as tall as those above.
inline KeypointReading standing_track(float size) {
  KeypointReading track = empty_track();
  track.frames.push_back({0, ""});
  FlatPose pose = flat_person(320, size);
  move_pose(Vec2(0, 100), pose);
  track.tracks[0].poses.push_back({0, 1, pose});
  return track;
}

}  // namespace understudy
