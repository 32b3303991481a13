// A folder of 2D poses that a detector is still writing, frame by frame.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "retarget/formats/folder_follower.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"

namespace understudy {

/// A frame as it came.
struct FollowedPose {
  int64_t number = 0;
  double dt = 0;                 ///< seconds since the last frame
  std::optional<FlatPose> pose;  ///< of who performs; none: they are not in it
  std::string problem;           ///< why there is none, one sentence
};

/// Hands out one JSON after the other, each as soon as it is whole, as FolderFollower tells. Numbers that are
/// left out come as frames that are missing. Who performs is the person asked for; else the largest in the
/// first frame with anybody, as nobody knows yet who is seen longest. One thread at a time.
class KeypointFollower {
 public:
  /// Throws Error when the folder cannot be read.
  KeypointFollower(const std::string& folder, const KeypointReaderOptions& options,
                   const FolderFollowOptions& follow = {});
  ~KeypointFollower();
  /// None at the end. Throws Error where no frame came at all.
  std::optional<FollowedPose> next();
  /// Frames per second.
  double fps() const;
  /// Of the pictures; unknown where nothing told it yet.
  Canvas canvas() const;
  /// All frames that were handed out, and what was decided: as read_keypoints gives it. Throws as that. Once.
  KeypointReading finish();

 private:
  class Folder;
  std::unique_ptr<Folder> folder_;
};

}  // namespace understudy
