// Causal clean-up of one person's 2D track: jitter, gaps, exchanged sides, frames that cannot be used.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/keypoints/keypoint_track.hpp"

namespace understudy {

struct KeypointFilterOptions {
  float smoothing = 1;     ///< 0: points stay where they were seen; 1: as tuned; 2: twice as calm
  float gap_s = 0.5f;      ///< a point that is missing goes on for so long
  bool mend_sides = true;  ///< exchanged sides are put back
};

/// What was done to a frame.
struct CleanPose {
  FlatPose pose;              ///< before anybody was seen: nobody
  bool is_usable = true;      ///< false: the last pose again
  bool sides_mended = false;  ///< left and right, of arms, legs or both, were exchanged and put back
  int points_filled = 0;      ///< of the 25, missing here and carried on from before
  std::string problem;        ///< one sentence where anything is worth a flag, else empty
};

/// One person, frame by frame; no output depends on a later input. One thread at a time.
class KeypointFilter {
 public:
  explicit KeypointFilter(const KeypointFilterOptions& options = {});
  ~KeypointFilter();
  KeypointFilter(KeypointFilter&&) noexcept;
  KeypointFilter& operator=(KeypointFilter&&) noexcept;

  /// seen: null when the frame cannot be used, and `why` says it in a sentence. dt: seconds since the last
  /// frame, above 0. Throws Error for another dt.
  CleanPose push(const FlatPose* seen, double dt, const std::string& why = "");
  /// Forgets the person.
  void reset();

 private:
  struct State;
  KeypointFilterOptions options_;
  std::unique_ptr<State> state_;
};

/// Every frame of the reading for one of its tracks.
std::vector<CleanPose> clean_track(const KeypointReading& reading, int track,
                                   const KeypointFilterOptions& options = {});

}  // namespace understudy
