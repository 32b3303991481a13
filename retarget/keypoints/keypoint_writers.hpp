// Writes people in pictures in the formats that other programs read. Each file appears whole at its path.
#pragma once

#include <string>

#include "retarget/keypoints/keypoint_track.hpp"

namespace understudy {

/// A folder with a JSON a frame, NAME_000000000012_keypoints.json: BODY_25, hands and face where there are
/// any. NAME is the folder's. Throws Error as PartFolder does.
void write_openpose_folder(const std::string& folder, const KeypointReading& reading);
/// One JSON, a list of frames with canvas_width and canvas_height: OpenPose-18, hands and face. The
/// confidence of what is shown is exactly 1.0: sd-webui-controlnet drops the points below.
void write_controlnet(const std::string& path, const KeypointReading& reading);
/// A list of people: COCO-17, image_id is the frame's number, track_id the person. Frames without anybody
/// do not exist in it, and there is no canvas.
void write_coco_results(const std::string& path, const KeypointReading& reading);
/// A line a person and frame: frame, seconds, person, then x, y, c of each point; hands and face where
/// anybody has them. What is missing is empty.
void write_keypoint_csv(const std::string& path, const KeypointReading& reading);
/// Arrays: keypoints [T, P, K, 3] (P: most at a time), people [T, P] (-1: nobody), frames [T], canvas [2],
/// fps, layout (BODY_25, with hands and face where anybody has them). Nothing is lost.
void write_keypoint_npz(const std::string& path, const KeypointReading& reading);

/// One frame of `write_openpose_folder` and of `write_controlnet`, as text, and the former's file.
std::string openpose_json(const KeypointReading& reading, int64_t frame);
std::string openpose_file_name(const std::string& folder, int64_t number);
std::string controlnet_json(const KeypointReading& reading, int64_t frame);

}  // namespace understudy
