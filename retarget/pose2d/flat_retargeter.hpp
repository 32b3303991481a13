// A 2D track performed by a body of other proportions, frame by frame.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/keypoints/keypoint_filter.hpp"
#include "retarget/keypoints/keypoint_track.hpp"
#include "retarget/pipeline/keypoint_transfer.hpp"
#include "retarget/pose2d/flat_placement.hpp"

namespace understudy {

/// Who performs: proportions, and where there is one, the person in the picture that shall move.
struct FlatTarget {
  Proportions lengths;
  std::optional<FlatPose> standing;  ///< none: proportions alone
  Canvas canvas;                     ///< of that picture; unknown without one
  std::vector<std::string> remarks;  ///< on that person, see reference_remarks
};

/// Online: no pose depends on a later frame. What the filter calls unusable stays the last pose.
class FlatRetargeter {
 public:
  /// Throws Error when a length of the target is not above 0.
  FlatRetargeter(std::unique_ptr<KeypointTransfer> engine, FlatTarget target, FlatPlace place);
  /// source: lengths of who is seen, as far as they are known by now. growth: how many times as large as
  /// those the source is in this frame, which the result shall not be; 1: it grows as the source does. Before
  /// anybody was seen: nobody.
  FlatPose push(const CleanPose& seen, const Proportions& source, float growth = 1);

 private:
  Proportions in_size_of(const Proportions& source) const;
  void hang_on_lost_hips(const FlatPose& seen, float trunk_ratio, FlatPose& made);

  std::unique_ptr<KeypointTransfer> engine_;
  FlatTarget target_;
  FlatPlace place_;
  FlatPlacement placement_;
  FlatPose last_;
  std::optional<Vec2> trunk_;  // of the source, from the neck to the hips when they were seen, pixels
};

}  // namespace understudy
