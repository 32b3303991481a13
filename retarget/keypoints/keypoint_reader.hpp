// Reads files and folders of 2D poses, whatever program wrote them.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/keypoint_track.hpp"

namespace understudy {

/// Places in 0..1 or -1..1 of a picture whose size nothing tells: only who made them knows it.
struct CanvasUnknownError : Error {
  using Error::Error;
};

/// What forces a decision; otherwise the file decides, and the reading tells.
struct KeypointReaderOptions {
  Canvas canvas;                  ///< unknown: as the file says or a picture beside it
  double fps = 0;                 ///< 0: as the file says, else 30
  std::string layout;             ///< name of a KeypointLayout; empty: as names or count of the points say
  std::optional<int64_t> person;  ///< who performs, by KeypointTrack::person; none: who is seen longest
  /// Asked for the size of a picture beside the file, with its name but for the suffix ("pose.png" beside
  /// "pose.json"); none: it cannot be read. Unset: pictures are not looked for.
  std::function<std::optional<Canvas>(const std::string& picture)> picture_size;
};

/// A folder with a JSON a frame, one JSON, NPY or NPZ. The content alone decides what it is:
///   OpenPose           {"people": [{"pose_keypoints_2d": [x, y, c, ...]}]}, older "pose_keypoints"
///   ControlNet         the same with canvas_width and canvas_height; one frame, or a list of frames
///   COCO annotations   {"images", "annotations", "categories"}
///   COCO results       [{"image_id", "keypoints": [...], "score"}]: Detectron2, AlphaPose (cmu, open, too)
///   MMPose             {"meta_info", "instance_info"}, or [{"frame_id", "instances"}], or instances alone
///   MediaPipe          lists of {x, y, z, visibility} a frame, in any wrapping
///   arrays             [T, K, 2 or 3] or [T, P, K, 2 or 3]; in a .npz `keypoints` or the only one
/// Layout, scale (pixels, 0..1, -1..1) and what confidences mean are decided by the first frame with
/// somebody in it, and told: no pose depends on a later frame. (Who performs, the canvas that is guessed
/// where none is told and the rate are no poses.) A frame that cannot be read or is of another layout or
/// scale stays, with the problem; so do up to a thousand frames that are missing in one place. Throws
/// Error, one sentence naming the file, when nothing in it can be used: no pose file, broken, nobody in any
/// frame, an unknown layout, 0..1 without a canvas (CanvasUnknownError).
KeypointReading read_keypoints(const std::string& path, const KeypointReaderOptions& options = {});
/// The same of a JSON's text; `source` names it in messages.
KeypointReading parse_keypoints(const std::string& json, const std::string& source,
                                const KeypointReaderOptions& options = {});

/// Whether a file or folder looks like 2D poses, from its beginning: cheap, for those who sort dropped files.
bool looks_like_keypoints(const std::string& path);

}  // namespace understudy
