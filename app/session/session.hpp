// The studio's whole state: plain data that panels read. Only the UI thread touches it.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/case_folder.hpp"
#include "app/run/evaluator.hpp"
#include "app/run/latency.hpp"
#include "app/run/person_cut.hpp"
#include "app/session/bones_state.hpp"
#include "app/session/document.hpp"
#include "app/session/document_file.hpp"
#include "app/session/flat_state.hpp"
#include "app/session/history.hpp"
#include "app/session/kept_owners.hpp"
#include "app/session/made_motions_state.hpp"
#include "app/session/map_state.hpp"
#include "app/session/playback.hpp"
#include "app/session/second_body_state.hpp"
#include "app/session/series.hpp"
#include "app/session/settings.hpp"
#include "app/session/shared_frames.hpp"
#include "app/session/study_state.hpp"
#include "app/session/styles_state.hpp"
#include "app/session/view.hpp"
#include "retarget/character/careful_deformer.hpp"

namespace understudy::app {

/// The data kept of each frame of the source: under 1 kB, and whose its points are where there are several.
struct KeptSource {
  Joints raw = Joints::Zero();  ///< as extracted, before the user's edits
  Confidence raw_confidence = Confidence::Zero();
  Confidence visibility = Confidence::Ones();
  bool exact = false;  ///< a skeleton's own, not to be repaired
  /// 0..1 a joint
  Eigen::Array<float, kJointCount, 1> confidence_of = Eigen::Array<float, kJointCount, 1>::Zero();
  Joints joints = Joints::Zero();  ///< edited, repaired and smoothed; of the last good frame where flagged
  float confidence = 0;            ///< mean over joints that are seen
  bool flagged = false;
  std::string reason;                        ///< why; empty when good
  int points = 0;                            ///< in the scan
  std::optional<Box> extent;                 ///< of the scan before any edit; none: it has no points
  int person = 0;                            ///< who was cut out of the scan; 0: nobody, or there is no scan
  std::shared_ptr<const KeptOwners> owners;  ///< of the scan after its edits; null: all is the person's
};

/// The source, as far as it has been read.
struct SourceState {
  std::string name;              ///< for people
  std::string problem;           ///< why it gives no frames, one sentence; empty: no problem
  std::optional<int64_t> count;  ///< frames in all, where known
  double fps = 30;
  float completing = -1;  ///< while scans are completed the share that is done, 0..1; else below 0
  std::string decision;   ///< "units: millimetres (from the height 1750), up: z, floor at 0.03 m"
  /// from the frames' joints to the file's coordinates
  Eigen::Matrix4d to_file = Eigen::Matrix4d::Identity();
  /// by which units, axes and floor are decided again as they were; none: by the document's
  std::optional<ImportOptions> import;
  std::shared_ptr<const MadeCapture> made;  ///< of scans that are completed, once they are
  std::vector<SourceClip> clips;            ///< animations in the file; none of scans
  int clip = -1;                            ///< the one that is played
  /// of the points of all frames so far before any edit;
  /// stays while the same source is read again with other edits
  std::optional<Box> extent;
  /// Who is in the scans, by id. While the same scans are read again who is not met yet stays among them.
  std::vector<PersonSeen> people;
  int person = 0;                   ///< who is cut out of them; 0: nobody yet
  bool has_scene = false;           ///< the scans hold more than one person
  bool no_person = false;           ///< it may be none that is seen
  SharedFrames<KeptSource> frames;  ///< of the extractor of the first take
  bool has_faces = false;
  int64_t generation = 0;  ///< changes whenever earlier frames are no longer valid
};

/// A take as far as it has been performed.
struct TakeState {
  bool ready = false;         ///< target, weights and joints below are there
  std::string problem;        ///< why it cannot become ready, one sentence; empty: no problem
  std::string paint_problem;  ///< why painted weights are left out, one sentence; empty: they are not
  /// The character as read and brought to the T-pose; the one prepared before, until the new one is ready.
  std::shared_ptr<const PreparedCharacter> character;
  /// The mesh as loaded, upright and at its size; shown until `target` is there, then null.
  std::shared_ptr<const Target> as_loaded;
  std::shared_ptr<const Target> target;  ///< T-pose mesh and joints (edited)
  /// where the networks' weights are uncertain; null: not checked
  std::shared_ptr<const SafeBinding> binding;
  std::shared_ptr<const RowMatrix> weights;  ///< [V, 22], edited
  std::shared_ptr<const Deformer> deformer;  ///< bound to the target, with those weights
  FaceMarks face;                            ///< found on the head's surface by those weights
  SharedFrames<KeptFrame> performed;         ///< the engine's frames
  std::string rights;                        ///< what files made of them have to say; empty: nothing
  SharedFrames<KeptSource> another;          ///< who is performed, where that is not the source's person
  LimbsSight limbs{};                        ///< the least that is seen of each limb so far
  Motion shown;                ///< after the user's edits of the result; may trail `performed` shortly
  std::vector<Joints> joints;  ///< of `shown`
  /// of each frame of `shown` its moment in the take, seconds, where it has a tempo of its own; else empty
  std::vector<double> times;
  float leg_ratio = 1;  ///< of the target's legs to those of who is performed, as far as they are known
  /// Of each of the motion space's answers to what is filled or goes on, as of `joints`; empty: there is one.
  std::vector<std::vector<Joints>> alternatives;
  std::vector<Series> series;  ///< as many values as frames shown
  Metrics metrics;             ///< of the whole, once all frames are there
  Latency latency;
  EditCost cost;                           ///< of the edits of the result
  std::shared_ptr<const FlatResult> flat;  ///< of a flat take all that was made; else null, or not yet
  int64_t generation = 0;                  ///< changes whenever earlier frames are no longer valid
};

/// A background job, for the progress bar.
struct JobView {
  int64_t id = 0;
  std::string name;          ///< "Retargeting", "Exporting dance.glb"
  float progress = -1;       ///< 0..1; below 0: not known
  double seconds_left = -1;  ///< below 0: not known yet
  bool cancellable = true;
  std::string doing{};  ///< "recording 12 of 80"; empty: it does not tell
};

/// What a notice offers to do about it: a button.
struct Offer {
  std::string label{};    ///< "Undo"; empty: nothing is offered
  std::string command{};  ///< as a line of a script
  bool waits = false;     ///< the notice stays until it is answered or the source is another
};

/// A message. Dialogs wait for the user; notices disappear after a while.
struct Notice {
  enum class Kind { Info, Warning, Error };
  Kind kind = Kind::Info;
  std::string text;     ///< one sentence
  std::string details;  ///< for "copy details": the command and the versions
  double until = 0;     ///< Session::time at which a notice disappears; infinite: it waits
  Offer offer{};
  int64_t id = 0;  ///< of a notice: its number since the start, from 1
  Offer also{};    ///< a second button
};

struct LogLine {
  bool warning = false;
  std::string text;
  double time = 0;  ///< Session::time
};

/// A command that failed and whose reason still stands.
struct Failure {
  std::string text;     ///< one sentence
  std::string command;  ///< its name
};

/// A question that the user must answer before the studio continues.
struct Question {
  enum class Kind { UnsavedChanges, Recover, MissingFiles, PaintMisfit, NotAPerson, UnsavedStudy, Canvas };
  Kind kind = Kind::UnsavedChanges;
  std::string text{};
  std::string then{};  ///< the command to continue with ("app.quit", "document.open PATH"); Canvas: its
                       ///< last argument, WIDTHxHEIGHT, is the answer
  std::vector<std::string> missing{};  ///< MissingFiles: the missing paths
  std::vector<Autosave> autosaves{};   ///< Recover
  int take =
      -1;  ///< PaintMisfit: whose weights were painted on another surface; the others: whose target it is
};

/// What the mouse does in the views.
enum class Tool { Look, Joints, Bones, TargetJoints, Paint, Crop, RestPose, Face };
constexpr Names<8> kToolNames{"look",  "joints", "bones",     "target-joints",
                              "paint", "crop",   "rest-pose", "face"};
constexpr Names<8> kToolLabels{"Look around",        "Drag extracted joints",
                               "Pose bones",         "Place the target's joints",
                               "Paint skin weights", "Crop the scan",
                               "Edit rest pose",     "Place the face's marks"};  ///< on the screen
/// Whether a tool works on the target before it performs, which is then seen instead of a frame.
constexpr bool is_of_rest(Tool tool) {
  return tool == Tool::TargetJoints || tool == Tool::RestPose || tool == Tool::Face;
}

struct Session {
  Document document;
  std::string path;      ///< where it is saved; empty: never
  bool changed = false;  ///< since it was last saved
  std::string weights;   ///< checksums of the networks here; empty: not known yet
  History history;
  StudyState study;
  MapState map;
  BonesState bones;
  SecondBodyState second;
  MadeMotionsState made_motions;
  StylesState styles;
  std::string sends_to;  ///< the address in full that shown poses go to (ShownPoseSender); empty: none
  View view;
  Playback playback;
  Settings settings;

  SourceState source;
  FlatState flat;
  std::vector<TakeState> takes;        ///< beside document.takes
  std::shared_ptr<const Truth> truth;  ///< null: none
  bool working = false;                ///< frames are still being made
  bool paused = false;                 ///< the user paused the making of frames

  std::vector<JobView> jobs;
  std::deque<LogLine> log;        ///< the newest 2,000
  double said_before = -1;        ///< Session::time up to which messages belong to another document
  std::vector<Failure> failures;  ///< not mended yet, the newest last
  std::vector<Notice> notices;
  int64_t notices_made = 0;   ///< since the start
  std::deque<Notice> errors;  ///< shown one after the other in a dialog
  std::optional<Question> question;
  double time = 0;  ///< seconds since the studio started
  bool quit = false;

  Tool tool = Tool::Look;
  int selected_joint = -1;  ///< of the active pane
  int selected_take = 0;    ///< the current one: that of the active view, else the last that was
  /// What the cameras were before a tool stepped back, and as it left them; none: it did not.
  struct SteppedBack {
    std::vector<CameraState> before, after;
  };
  std::optional<SteppedBack> stepped_back;
  Brush brush;
  int falloff = 5;  ///< frames, of edits by hand
  bool drag_children = false, mirror_joint = true;
};

/// The document's source, with what was decided about units, axes and floor when its first frame was looked
/// at.
SourceOptions source_as_read(const Session& session);
/// Whether people are told apart by their colours: there is more than one.
bool has_several_people(const Session& session);
/// Whether the step to be undone, or redone, is one of the study: steps of document and study are undone in
/// the order in which they were made.
bool undoes_study(const Session& session);
bool redoes_study(const Session& session);
/// That step; "" for none.
std::string undo_label(const Session& session);
std::string redo_label(const Session& session);
/// Makes a take the current one and its view the active one. The take must be in the document, or come with
/// the command that runs.
void choose_take(Session& session, int take);
/// Makes a view the active one: 0 the source's, k that of the take k - 1, which becomes the current one.
void choose_pane(Session& session, int pane);
/// After takes have come or gone: the current take is one that there is,
/// and the active view is its or the source's.
void settle_current_take(Session& session);
/// Who is performed by a take, as far as they were seen.
const SharedFrames<KeptSource>& performed_by(const Session& session, size_t take);
/// Whether a take is of 2D poses; one that is not there is not.
bool is_flat_take(const Session& session, int take);
/// Whether a view (0 the source, k the take k - 1) is a canvas with 2D poses, not a space.
bool is_canvas(const Session& session, int pane);
/// The number of frames that can be shown: of the selected take, or of the source where there is no take.
int frame_count(const Session& session);
/// What the status bar says: the newest message for ten seconds, then the newest failure until it is mended.
std::optional<LogLine> status_line(const Session& session);
/// Drops the failures that a command's success mends.
void mend(Session& session, const std::string& command);
/// The frame shown, -1 without one.
int shown_frame(const Session& session);
/// What is shown of a take, in order, at the source's rate: without what trim and skip leave out, at its
/// tempo.
std::vector<MomentBetween> moments_of(const Session& session, size_t take);
/// How long a frame of a take lasts against the source's: its tempo there. times: as TakeState's.
double length_at(const std::vector<double>& times, double fps, double frame);
/// The clock is that of the selected take, at its tempo where it has one, else the source's. All views show
/// the same frame, so the same moment of the action, whatever the tempo of their takes.
/// The moment of each frame of the selected take, seconds; empty: evenly, at the source's rate.
const std::vector<double>& clock_times(const Session& session);
/// Seconds on that clock, and the frame, with its fraction, that is shown then; both go on beyond the ends.
double moment_of(const Session& session, double frame);
double frame_at(const Session& session, double seconds);
/// The crop box as it is shown: open sides, and all of them without a crop, around all points of all frames
/// so far (of a skeletal motion: around its people).
Box shown_crop(const Session& session);
/// Frames to mark as bad, with the reason ("low confidence").
struct BadFrame {
  int frame;
  std::string why;
};
std::vector<BadFrame> bad_frames(const Session& session);
/// Those in which found bones are not to be trusted: bad_frames() of a source that is no person.
std::vector<BadFrame> doubted_frames(const Session& session);
/// Runs of frames that could not be used, of who is performed by a take, in order of time.
std::vector<FillEdit> unusable_runs(const Session& session, size_t take);

}  // namespace understudy::app
