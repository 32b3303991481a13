// 2D poses as far as they are read and performed. All frames of it are made anew at every change: that is
// cheap.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/evaluator.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/keypoints/keypoint_filter.hpp"
#include "retarget/keypoints/proportions.hpp"
#include "retarget/keypoints/track_edits.hpp"
#include "retarget/pose2d/flat_retargeter.hpp"

namespace understudy::app {

/// The source's poses, sides exchanged and points dragged as the document wants.
struct FlatPoses {
  KeypointReading reading;
  std::vector<CleanPose> clean;   ///< of who performs, one a frame of the reading
  Proportions lengths;            ///< from all of their poses
  std::vector<float> confidence;  ///< mean of the points seen, 0..1, one a frame
};

/// What a take's target is: read once, whatever is chosen of it.
struct FlatReference {
  FlatTarget target;
  std::shared_ptr<const Pixels> picture;  ///< beside the poses' file; null: there is none
  std::vector<std::string> told;
};

/// A take, performed.
struct FlatResult {
  std::shared_ptr<const FlatReference> reference;
  Proportions lengths;           ///< those of the reference under the chosen ones
  KeypointReading made;          ///< one person
  std::vector<FlatPose> poses;   ///< the same, one a frame; nobody before anybody was seen
  Metrics figures;               ///< of the whole
  std::vector<float> violation;  ///< per cent of the pairs of points in another order than in the source
};

struct FlatState {
  std::shared_ptr<const FlatPoses> poses;  ///< null: none yet, or the source is none
  std::optional<PointDrag> dragging;       ///< as the mouse holds it: performed as if it were an edit
  int64_t generation = 0;                  ///< changes with any of it
};

}  // namespace understudy::app
