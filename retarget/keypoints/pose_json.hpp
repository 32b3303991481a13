// The shapes of JSON that hold 2D poses, told apart by their content.
#pragma once

#include <string>

#include "retarget/keypoints/json_points.hpp"

namespace understudy {

/// Hands what the file holds to the sink. Throws Error, naming `source`, when it is of no shape that we
/// know, or broken as a whole; what is wrong in one frame is that frame's problem.
void read_pose_json(const PoseJson& json, const std::string& source, RawSink& sink);
bool is_pose_json(const PoseJson& json);

// The shapes; each knows itself and reads itself.
bool is_openpose(const PoseJson& json);  // one frame or a list, ControlNet's too
void read_openpose(const PoseJson& json, const std::string& source, RawSink& sink);
bool is_alphapose_frames(const PoseJson& json);  // its cmu and open
void read_alphapose_frames(const PoseJson& json, const std::string& source, RawSink& sink);
bool is_coco_annotations(const PoseJson& json);
void read_coco_annotations(const PoseJson& json, const std::string& source, RawSink& sink);
bool is_coco_results(const PoseJson& json);
void read_coco_results(const PoseJson& json, const std::string& source, RawSink& sink);
bool is_mmpose(const PoseJson& json);
void read_mmpose(const PoseJson& json, const std::string& source, RawSink& sink);
bool is_landmarks(const PoseJson& json);  // MediaPipe's and the like
void read_landmarks(const PoseJson& json, const std::string& source, RawSink& sink);

/// A list's first item, null where there is none or it is no list.
inline const PoseJson* first_of(const PoseJson* list) {
  return list && list->is_array() && !list->empty() ? &list->front() : nullptr;
}
inline bool has(const PoseJson* json, std::initializer_list<const char*> names) {
  return json && member(*json, names);
}
/// Throws Error when a frame has more people than a picture holds.
void check_people(size_t people, const std::string& what);
/// "poses.json: frame 7".
std::string frame_of(const std::string& source, int64_t number);

}  // namespace understudy
