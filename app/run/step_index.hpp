// An index of the steps and other movements in files of skeletal motion: what is unchanged is not read again.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "retarget/motion_space/motion_map.hpp"
#include "retarget/pipeline/motion_space.hpp"

namespace understudy::app {

/// A skeletal motion as poses of the 22 joints.
struct FileMotion {
  std::string clip;  ///< which of the file's animations, a number from 1
  std::string clip_name;
  bool is_longest = true;  ///< it is the one that is taken where none is named
  Motion motion;
  Joints rest = Joints::Zero();  ///< T-pose joints, metres
};
/// All animations of a skeletal file, at the rate of their keys; frames that an AMASS-format file flags are
/// flagged. Throws Error naming the file, also where it holds no motion.
std::vector<FileMotion> read_file_motions(const std::string& path);
/// One of them, as SourceOptions::clip names it.
FileMotion read_file_motion(const std::string& path, const std::string& clip);

/// All files of skeletal motion among the paths and in folders among them, folders inside too, in the order
/// of their names, each once. What a folder holds besides is passed over. Throws Error naming a path that is
/// not there.
std::vector<std::string> motion_files(const std::vector<std::string>& paths);

/// What codes movements: the learned coders; pose by pose where there are none, which is warned of.
class MapEncoders {
 public:
  MapEncoders(const std::function<std::shared_ptr<MotionCoder>()>& load_coder,
              const std::function<std::shared_ptr<MotionSpace>()>& load_space);
  MovementEncoder& of(MapOf kind);

 private:
  std::shared_ptr<MotionCoder> steps_;
  std::shared_ptr<MotionSpace> space_;
  std::unique_ptr<MotionCoder> plain_;
};

struct StepIndexOptions {
  std::string folder;  ///< of the index, made where it is missing; empty: nothing is kept
  /// Before each file, and at the end; what it throws ends the work. What was read before is in the index.
  std::function<void(int done, int files)> progress{};
};

/// What is told of files.
struct IndexedSteps {
  std::string coder;                       ///< that coded them: their names and what tells them from others
  std::vector<MappedMotion> motions;       ///< in which somebody steps, in the order of the files
  std::vector<MappedMotion> others;        ///< with what else is in them (coded_movements)
  std::vector<std::string> problems;       ///< a sentence for each file that cannot be read
  std::vector<std::string> without_steps;  ///< files in which nobody steps
  int files = 0;
  int read = 0;     ///< files that were not in the index, or have changed
  int damaged = 0;  ///< entries of the index that could not be read, and were made again
};

/// The steps of all motions in `files`. The index has an entry for each file, JSON, written beside and
/// renamed: a program that is killed loses the file that it was reading, and no more. An entry is good while
/// the file has the same size and time, or the same checksum, and the coder gives the same codes. A file that
/// cannot be read has none. An index that cannot be written is warned of, once.
IndexedSteps index_steps(const std::vector<std::string>& files, MapEncoders& encoders,
                         const StepIndexOptions& options);

/// Frames of a motion, both inside.
struct MotionRange {
  std::string path;  ///< its file; empty: it is in none
  FileMotion motion;
  int first = 0, last = 0;
};
/// The steps of a map that are most like any of those in the range, the likest first; those that share frames
/// with the range are left out. Of a map of other movements those most like the range, whatever it shows.
/// Throws Error where the motion has no such frames, nobody steps in them, or they are too few.
std::vector<NearStep> like_this(const MotionMap& map, MapOf kind, const MotionRange& range,
                                MapEncoders& encoders, int count);

/// "walk.bvh, frames 12 to 45".
std::string step_words(const MotionMap& map, int step);
/// One sentence: "237 files, 201 read anew, 2,364 steps in 195 motions".
std::string index_words(const IndexedSteps& indexed);

}  // namespace understudy::app
