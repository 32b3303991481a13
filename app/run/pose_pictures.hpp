// A performed motion as pictures of its 2D pose: what generators of images and films are steered by.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/run/exports.hpp"
#include "app/run/pose_choice.hpp"
#include "retarget/keypoints/keypoint_track.hpp"
#include "retarget/pose2d/body_view.hpp"

namespace understudy::app {

/// A path in .mp4 is a film; one in .json the poses alone, as ControlNet lists them; any other is a folder of
/// PNGs, frame_00000.png and so on. Depth, normals, mask and the poses' file lie beside: control.mp4 has
/// control_depth.mp4, control_normals.mp4, control_mask.mp4, and control.json or the folder control_openpose.
/// The poses are kept, some kB a frame, and all is written at the end: the camera sees the whole take.
/// Throws Error where the path cannot be written, or the choice makes no sense; finish() also where nobody is
/// in view.
std::unique_ptr<MotionOutput> open_pose_pictures(const std::string& path, const ExportBody& body,
                                                 const std::string& name, double fps);

/// Of poses that are flat already: the same files, on the reading's canvas at its rate. Throws Error.
void write_pose_pictures(const std::string& path, const KeypointReading& reading, const PoseChoice& choice);

/// The same of a folder whose frames still come: each picture, and each file of OpenPose, is there as soon as
/// its frame is; the list that ControlNet reads at the end.
class ComingPictures {
 public:
  ComingPictures(std::string folder, const PoseChoice& choice);
  ~ComingPictures();
  /// A reading of one frame. It waits until a canvas is known. Throws Error; what was written stays.
  void push(const KeypointReading& one);
  /// All frames at once, for what is one file. Throws Error.
  void finish(const KeypointReading& all);

 private:
  class Files;
  void write(const Canvas& canvas);

  std::string folder_;
  PoseChoice choice_;
  std::vector<KeypointReading> waiting_;
  std::unique_ptr<Files> files_;  // none before the first frame
};

/// Whether such a path is a folder.
bool is_picture_folder(const std::string& path);

/// The points of the body's face and feet: on the head's own surface where the target has one,
/// or where its user put them.
BodyMarks marks_of(const ExportBody& body);

}  // namespace understudy::app
