// Rows of a sheet that show 2D poses in their picture, and pictures that were written of a take.
#pragma once

#include <string>
#include <vector>

#include "render/contact_sheet.hpp"
#include "retarget/keypoints/keypoint_track.hpp"

namespace understudy::app {

/// A picture for each time, seconds from the first frame: who performs in OpenPose's colours, others faint,
/// over the picture that lies beside the file, where there is one; a red bar where the performer is not seen,
/// or nothing in the frame can be used. All of one view, around who performs at any of the times. After the
/// last frame the pictures are white. width: pixels. Throws Error naming the file where nobody is seen at any
/// of the times.
render::PictureRow pose_row(const KeypointReading& reading, const std::vector<double>& times, int width);

/// Whether a folder holds PNGs.
bool is_folder_of_pictures(const std::string& path);
constexpr double kPictureRate = 30;  ///< a second, where nothing tells it
/// How many.
int64_t count_pictures(const std::string& folder);
/// The PNGs of a folder in the order of their names, whole, kPictureRate a second. Throws Error naming what
/// cannot be read.
render::PictureRow picture_row(const std::string& folder, const std::vector<double>& times, int width);

}  // namespace understudy::app
