// Clips of motion in a folder: their good frames, and what they show.
#pragma once

#include <string>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

struct Clip {
  Motion motion;
  std::vector<int> good;  ///< frames without a flag
};

/// All clips (.npz, AMASS-format) of a folder in the order of their names; those without a good frame are
/// left out. Throws Error naming a file that cannot be read.
std::vector<Clip> read_clips(const std::string& folder);
Clip read_clip(const std::string& path);
/// The paths of them.
std::vector<std::string> clip_files(const std::string& folder);

/// Frames first .. first + count - 1 of a clip, none of them flagged.
struct ClipRun {
  int clip = 0, first = 0, count = 0;
};
/// All runs of at least `shortest` frames, as long as they are but for `longest`.
std::vector<ClipRun> good_runs(const std::vector<Clip>& clips, int shortest, int longest);

/// What a clip shows, as its file says ("actions" of the JSON text `info`): "walk", "run", "turn". Empty
/// where the file does not say.
std::vector<std::string> clip_labels(const std::string& path);
/// The same of that text.
std::vector<std::string> labels_of_info(const std::string& info);
/// The same in a sentence ("desc"): "Wave your other hand". Empty where the file does not say.
std::string clip_description(const std::string& path);

}  // namespace understudy
