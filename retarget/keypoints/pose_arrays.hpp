// 2D poses in NumPy arrays.
#pragma once

#include <string>

#include "retarget/formats/npz.hpp"
#include "retarget/keypoints/raw_people.hpp"

namespace understudy {

/// The first bytes of a file, at most so many. Throws Error as check_file does.
std::string beginning_of(const std::string& path, size_t most);

/// [K, C], [T, K, C] or [T, P, K, C] with C 2 (x, y) or 3 (and confidence).
bool is_pose_array(const NpyArray& array);

/// Of a .npy or .npz; in the latter `keypoints`, else the only array of such a shape; and what our own
/// files have beside it: frames [T], people [P] or [T, P], canvas [2], fps, layout. Throws Error, naming
/// the file, when there is no such array, or one that does not fit to it.
void read_pose_arrays(const std::string& path, RawSink& sink);

}  // namespace understudy
