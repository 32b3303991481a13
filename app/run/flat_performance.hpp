// A file of 2D poses performed by a person of other proportions, in a picture.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/pose_choice.hpp"
#include "app/run/report.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "retarget/pose2d/flat_retargeter.hpp"
#include "retarget/pose2d/growth_estimate.hpp"
#include "retarget/pose2d/proportion_estimate.hpp"

namespace understudy::app {

/// A new one: it keeps state. Throws Error for a name that there is not, and where weights are missing.
using FlatEngineMaker = std::function<std::unique_ptr<KeypointTransfer>(const FlatEngine& wanted)>;

/// What 2D poses are performed with: the program passes trained networks, tests their own.
struct FlatTools {
  std::shared_ptr<const LengthReader> lengths;
  FlatEngineMaker engine;  ///< empty: the engine that needs no weights is the only one
};

struct FlatSourceOptions {
  std::string path;
  Canvas canvas;  ///< unknown: as the file or a picture beside it tells
  double fps = 0;
  std::string layout;  ///< empty: as the file tells
  std::string person;  ///< a number; empty: who is seen longest
};

struct FlatOptions {
  FlatSourceOptions source, target;
  std::string engine = flat_engines().front().name;  ///< one of flat_engines()
  FlatPlace place = FlatPlace::Reference;
  bool touches = true;  ///< hands that touch keep touching
  bool growth = true;   ///< who comes nearer grows; false: the result stays as large as the target is
  float smoothing = 1;  ///< of the source's track, see KeypointFilterOptions
  bool ahead = true;    ///< the source's proportions are read off the whole file before the first frame
};

/// Reads with the picture beside the file, where there is one; `picture`, unless null, gets its path. Throws
/// Error as read_keypoints does.
KeypointReading open_keypoints(const FlatSourceOptions& options, std::string* picture = nullptr);

/// Lengths of whoever performs in the reading, from all of their poses. Throws Error naming the file when
/// none can be read.
Proportions proportions_of(const KeypointReading& reading, const LengthReader& lengths);

/// The target of a file: of 2D poses (the first in which most is seen stands for the person), or of
/// proportions alone, as write_proportions writes them. Adds to `told` what was decided.
FlatTarget open_flat_target(const FlatSourceOptions& options, const LengthReader& lengths,
                            std::vector<std::string>& told);
/// Whether a file is one of proportions.
bool is_proportions_file(const std::string& path);
/// {BONE: {"length", "doubt"}}, pixels.
Json to_json(const Proportions& lengths);
void write_proportions(const std::string& path, const Proportions& lengths);
/// Throws Error naming the file.
Proportions read_proportions(const std::string& path);

/// The person who performs in the reading: their lengths, and how they stand where most of them is seen
/// in its picture. Throws as proportions_of.
FlatTarget flat_target(const KeypointReading& reading, const LengthReader& lengths);
/// "from 12 poses; uncertain: left forearm": where lengths come from, and which nobody can be sure of.
std::string evidence_of(const Proportions& lengths);
/// Doubt of a length's logarithm above which it is uncertain.
constexpr float kUncertainLength = 0.12f;

/// Performs frame by frame: no pose depends on a later one. One thread at a time.
class FlatPerformer {
 public:
  /// Throws Error as FlatTools::engine and FlatRetargeter do.
  FlatPerformer(const FlatTarget& target, const FlatOptions& options, const FlatTools& tools, double fps);
  /// Read ahead; without it they are learned as frames come.
  void set_source_lengths(const Proportions& lengths) { ahead_ = lengths; }
  /// dt: seconds since the last frame. Nobody before anybody was seen.
  FlatPose push(const CleanPose& clean, double dt);
  /// As they are known by now.
  Proportions source_lengths() const;

 private:
  FlatRetargeter retargeter_;
  std::shared_ptr<const LengthReader> lengths_;
  bool keeps_size_;
  std::optional<Proportions> ahead_;
  ProportionEstimate estimate_;
  GrowthEstimate growth_;
};

/// A track performed by somebody else.
struct FlatTrack {
  KeypointReading result;      ///< one person, in the target's picture
  Proportions source_lengths;  ///< as known in the last frame
  int64_t flagged = 0;
};
/// All frames, online. clean: of the reading's performer. source_lengths: read ahead; none: learned as
/// frames come. Throws Error.
FlatTrack perform_track(const KeypointReading& source, const std::vector<CleanPose>& clean,
                        const std::optional<Proportions>& source_lengths, const FlatTarget& target,
                        const FlatOptions& options, const FlatTools& tools);

struct FlatPerformance {
  KeypointReading source, result;  ///< the result has one person, in the target's picture
  Proportions source_lengths, target_lengths;
  int64_t flagged = 0;
  std::vector<std::string> told;  ///< sentences
};

/// All frames, online. Throws Error.
FlatPerformance perform_flat(const FlatOptions& options, const FlatTools& tools);

/// The same of a folder that is still being written; the source's proportions are learned as its frames come.
/// `done` gets each frame when it is performed, as a result of one frame, whose canvas is unknown until
/// something tells it. Throws Error; also once Ctrl-C was pressed.
FlatPerformance follow_flat(const FlatOptions& options, const FlatTools& tools,
                            const std::function<void(const KeypointReading&)>& done);

/// Throws Error naming the path where write_flat knows no such file.
void check_flat_output(const std::string& path);
/// By the suffix: .json, .csv, .npz hold the poses; .mp4 or a folder pictures of them, see
/// write_pose_pictures. Throws Error naming the path.
void write_flat(const std::string& path, const KeypointReading& reading, const PoseChoice& choice);

}  // namespace understudy::app
