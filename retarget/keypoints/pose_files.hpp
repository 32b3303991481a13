// The files of a folder of 2D poses, one a frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "retarget/keypoints/frame_decoder.hpp"

namespace understudy {

/// The JSON files of a folder, naturally sorted. Throws Error when it cannot be read.
std::vector<std::string> pose_files_of(const std::string& folder);
/// The one frame that such a file holds, and what it says of itself. Throws Error naming the file.
RawFrame read_pose_file(const std::string& path, int64_t number, RawFacts& facts);
/// A picture with the name of the folder, or of its first frame, but for the suffix.
std::optional<PictureBeside> picture_of_folder(const std::string& folder,
                                               const KeypointReaderOptions& options);

}  // namespace understudy
