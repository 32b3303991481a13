// Teaches a style: fits a manner to recordings of two manners of moving.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "retarget/pipeline/interfaces.hpp"
#include "retarget/style/manner_file.hpp"

namespace understudy::app {

/// What a style is taught from. Folders, with all in them, hold skeletal motions and folders of scans.
struct StyleLesson {
  std::string from, to;        ///< the manner to be left, and that to be taken
  std::string joints = "all";  ///< see fitted_joints()
  bool coupled = true;         ///< false: a gain of each joint by itself (fit_manner)
  double smooth = 1.5;         ///< see MannerSample
  StyleNote note;  ///< what its file is to say; label and licence are needed, the rest follows where empty
};

/// The recordings in a folder and those in it, in the order of their names. look: called for each of their
/// files, may throw. Throws Error where there is no such folder, or none.
std::vector<std::string> recordings(const std::string& folder, const std::function<void()>& look = {});

/// Called after each frame and each recording. What it throws ends the lesson.
using LessonStep = std::function<void(size_t done, size_t of, const std::string& recording)>;

/// Throws Error where a folder is missing, or both are the same or one lies in the other.
void check_folders(const StyleLesson& lesson);

/// A recording that cannot be read is left out and logged. Throws Error as check_folders does, and naming the
/// folder where fewer than two recordings can be used.
MannerFile teach_style(const StyleLesson& lesson, const Networks& networks, const LessonStep& step = {});

}  // namespace understudy::app
