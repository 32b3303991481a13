// Where the frames come from: scans on disk, an SMPL-format body that performs an AMASS-format motion, a
// skeleton that moves (BVH, AMASS-format motion, animated FBX, DAE, GLB, glTF), a blend of such motions, or
// 2D poses that are lifted.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/motion_blender.hpp"
#include "retarget/base/fields.hpp"
#include "retarget/character/bone_map.hpp"
#include "retarget/character/character.hpp"
#include "retarget/editing/scan_edits.hpp"
#include "retarget/formats/import.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/keypoints/track_edits.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/lifter.hpp"
#include "retarget/pipeline/motion_space.hpp"
#include "retarget/scene/person_edits.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::app {

struct MadeCapture;

struct SourceOptions {
  /// scans, a skeletal motion, or an SMPL-format body where `motion` is given; of a blend its first part
  std::string path;
  std::string motion;        ///< AMASS-format .npz that the body performs; empty: there is no body
  std::vector<float> betas;  ///< of the performing body; empty: those in the motion's file
  double fps = 0;            ///< 0: the motion's own, as `times` tell, or 30
  ImportOptions import;
  bool follow = false;    ///< the folder is still being written, or the stream is live
  bool as_scan = false;   ///< a skeletal motion's surface is sampled as a scan
  std::string clip;       ///< of a skeletal motion's animations, by name or number from 1; empty: the longest
  BoneChoices bones;      ///< of a skeletal motion, as the user wants them
  bool quiet = false;     ///< log nothing: another source has logged it all
  bool truth = false;     ///< of scans made from a body the bones come along, to be judged by
  std::string person{};   ///< who of a scan: a number, "largest", "all"; empty or "best": who is seen best
  std::string times{};    ///< of scans: CSV of when each was taken (see scan_times.hpp); empty: evenly
  double complete = 0;    ///< frames/s that sparse scans are completed to (see completed_source.hpp); 0: off
  std::string markers{};  ///< of scans that are completed: CSV of markers (see markers.hpp); empty: none
  std::shared_ptr<const MadeCapture>
      made{};                          ///< what `complete` made of the same scans before; null: nothing
  std::vector<PersonEdit> people{};    ///< who is who, where it was not seen rightly
  std::optional<BlendRecipe> blend{};  ///< made of several skeletal motions; none: no blend
  // Of 2D poses:
  std::string layout{};  ///< the order of their points; empty: as names or their count tell
  std::string canvas{};  ///< "1280x720"; empty: as the file or a picture beside it tells
  double stature = static_cast<double>(kUsualStature_m);  ///< of the person, metres
  double fov = static_cast<double>(kUsualFov_deg);        ///< vertical, of the camera, degrees
  std::optional<double> pitch{};         ///< how far the camera looks down, degrees; none: as the poses tell
  float smoothing = 1;                   ///< of their points, see KeypointFilterOptions
  std::vector<TrackEdit> point_edits{};  ///< by hand
  // Of a live stream, whose path is an address (see is_live):
  std::string stream{};  ///< how its clouds follow each other, of kStreamFormatNames; empty: auto
  double wait_s = 0;  ///< it ends when no frame came for so long, as a folder that is followed; 0: as usual
  ScanEdits
      edits{};  ///< of each frame, before anybody is looked for; documents have theirs beside the source
};
constexpr Within<float> kFlatSmoothing{0, 4};
/// What documents keep of it: `follow`, `quiet`, `truth`, `made`, `stream`, `wait_s` and `edits` belong to
/// one run.
template <class V, class S>
FieldsOf<S, SourceOptions> fields(V& visit, S& source) {
  visit("path", source.path, FilePath{});
  visit("motion", source.motion, FilePath{});
  visit("betas", source.betas);
  visit("fps", source.fps, Within<double>{0, 1e6});
  visit("times", source.times, FilePath{});
  visit("complete", source.complete, Within<double>{0, 1000});
  visit("markers", source.markers, FilePath{});
  visit("import", source.import);
  visit("as_scan", source.as_scan);
  visit("clip", source.clip);
  visit("bones", source.bones);
  visit("person", source.person);
  visit("people", source.people);
  visit("blend", source.blend);
  visit("layout", source.layout);
  visit("canvas", source.canvas);
  visit("stature", source.stature, Within<double>{0.3, 3});
  visit("fov", source.fov, Within<double>{1, 170});
  visit("pitch", source.pitch, Within<double>{-80, 80});
  visit("smoothing", source.smoothing, kFlatSmoothing);
  visit("point_edits", source.point_edits);
}
/// A source that is made by this recipe.
SourceOptions blended_source(BlendRecipe blend);
/// What a source is called, for people: the name of its file, "walk - run" of a blend.
std::string name_of(const SourceOptions& options);
/// Whether the path is no file but where a stream comes in: "tcp://HOST:PORT", or "-" for standard input.
bool is_live(const SourceOptions& options);
/// The options without those that say who of the scans is taken: scans that are read by equal ones are the
/// same.
SourceOptions without_people(SourceOptions options);

/// A scan, or what a skeleton looks like, and then the skeleton itself.
struct SourceFrame : ScanFrame {
  std::optional<Extraction> skeleton;  ///< nothing is to be extracted from the scan
  float doubt_m = 0;  ///< how far that skeleton may be off where it was made; 0: it was captured
  // To be judged by alone, the method never sees them.
  std::optional<Extraction> truth{};  ///< the bones that the scan was made from
  Points registered{0, 3};  ///< the scan's vertices in their topology's order; see registered_source.hpp
};

/// One of the animations in a file.
struct SourceClip {
  std::string name;
  double seconds = 0;
};

/// What frames are made with that are no files: of sparse scans that are completed, of 2D poses that are
/// lifted. Each is called at most once, and may be empty where no such source is read.
struct SourceTools {
  std::function<std::shared_ptr<SkeletonExtractor>()> extractor;
  std::function<std::shared_ptr<MotionSpace>()> space;  ///< fills between scans; empty: smooth curves do
  std::function<std::unique_ptr<Lifter>()> lifter;      ///< of 2D poses; empty: they cannot be lifted
  std::function<void(float)> progress;  ///< told the share that is done, 0..1; may throw; may be empty
};

/// What takes away that is no person, as options.
constexpr const char* kCleaning = "--remove-floor, --largest-part, --crop";

/// Hands out frames in metres, y up, floor at 0, one at a time and never a later one early.
class Source {
 public:
  virtual ~Source() = default;
  /// None at the end. usable = false: the frame exists but cannot be used.
  virtual std::optional<SourceFrame> next() = 0;
  /// next() goes on with this frame, 0 the first; units, axes and floor stay those of the first usable frame.
  /// Throws Error when there is no such frame.
  virtual void seek(int64_t frame) = 0;
  /// What was decided about units, axes and floor, one sentence; empty before the first usable frame.
  const std::string& decision() const { return decision_; }
  /// What is seen in the first usable frame then decides units and floor, too, where the scan shows somebody
  /// without feet: its height is not theirs. Called on the thread of next(), at most once; what throws sees
  /// nobody. Motions of bodies and skeletons do not ask.
  virtual void set_look(const std::function<Extraction(const Mesh&)>& /*look*/) {}
  /// Called before next(), whose thread then calls them. Sources that are neither completed nor lifted do
  /// not.
  virtual void set_tools(const SourceTools& /*tools*/) {}
  /// What was completed, for SourceOptions::made; null before it is and of other sources.
  virtual std::shared_ptr<const MadeCapture> made() const { return nullptr; }
  /// The options by which the same is decided without a look; none: those that it was opened with.
  const std::optional<ImportOptions>& import() const { return import_; }
  /// From frames as they are handed out back to the file's own units, axes and floor: scale, rotation and
  /// offset in one. Of a body that performs a motion to the body's, y up.
  /// The identity before the first usable frame.
  const Eigen::Matrix4d& to_file() const { return to_file_; }
  /// None while it is not known.
  virtual std::optional<int64_t> count() const = 0;
  /// Frames per second.
  double fps() const { return fps_; }
  /// Of a skeletal motion all animations in its file, and the one that is played; none of scans, and -1.
  const std::vector<SourceClip>& clips() const { return clips_; }
  int clip() const { return clip_; }

 protected:
  explicit Source(double fps) : fps_(fps) {}
  void set_clips(const Character& character, int clip);
  void set_decision(const std::string& sentence, const Eigen::Matrix4d& to_file);
  void set_import(const std::optional<ImportOptions>& import) { import_ = import; }

 private:
  double fps_;
  std::string decision_;
  std::optional<ImportOptions> import_;
  Eigen::Matrix4d to_file_ = Eigen::Matrix4d::Identity();
  std::vector<SourceClip> clips_;
  int clip_ = -1;
};

/// The number in SourceOptions::person; 0: it is a word.
/// Throws Error where it is no number from 1, nor "largest", "all", "best" or empty.
int person_number(const std::string& person);

/// Logs what it decided about units, axes and rate. Throws Error naming the path, also where
/// an option is about something that such a source does not have, as bones of a scan. blender: makes blends;
/// null: they go straight from pose to pose.
std::unique_ptr<Source> open_source(const SourceOptions& options, MotionBlender* blender = nullptr);

/// The same of the options, as far as the path alone shows what the source is.
void check_source_options(const SourceOptions& options);

/// Turns a motion whose up is z (AMASS's own) to y up; decided from where the body's up points in the first
/// frame. up: "auto", "y" or "z". True when it was turned.
bool turn_upright(Motion& motion, const std::string& up);

}  // namespace understudy::app
