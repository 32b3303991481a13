// The background workers of a Studio and the requests they last got.
#pragma once

#include <map>
#include <mutex>
#include <set>

#include "app/session/engine.hpp"
#include "app/session/refiner.hpp"
#include "app/session/shown_pose_sender.hpp"
#include "app/session/studio.hpp"

namespace understudy::app {

struct Studio::Background {
  Background(const StudioServices& services, std::shared_ptr<MotionBlender> blender)
      : engine(services.networks, std::move(blender), {{}, services.motion_space, services.lifter, {}}),
        refiner(services.motion_space) {}

  /// The inputs from which a take in the session was made.
  struct Applied {
    std::shared_ptr<const Deformer> deformer;   // with the networks' weights
    std::shared_ptr<const WeightRows> weights;  // the user's, put over them
    PoseEdits poses;                            // the edits of the result
    double refined_at = -1e9;                   // Session::time
    size_t refined_frames = 0;
    bool goes_on = false;                         // beyond the last frame, as it was refined last
    std::shared_ptr<const Target> neighbours_of;  // the target that `neighbours` are of
    Neighbours neighbours;
    bool asked_about_paint = false;
    bool measured = false;
    int64_t measuring = 0;           // the job; 0: none
    std::string fill_of;             // the source key of which it was looked for frames to fill
    std::vector<FillEdit> unusable;  // those found
    int64_t fill_notice = 0;         // that offers to fill them; 0: none
  };

  /// What was there before something was opened, until that has been read.
  struct Opening {
    Document before;
    size_t steps = 0;      // of undo, with this one
    bool changed = false;  // the document before
  };

  /// Shared with the job that writes the copy for recovery.
  struct Autosaving {
    bool running = false;  // the UI thread's own
    std::mutex writing;
    int64_t version = 0;  // changed under the mutex, by the UI thread; of another one nothing is written
    std::string problem;  // the job's, then the UI thread's: of the last one; empty: it was written
  };

  Engine engine;
  Refiner refiner;
  Document followed;
  std::vector<int64_t> take_ids;  // beside document.takes
  int followed_take = -1;         // Session::selected_take then; -1: of another document
  int64_t next_id = 1;
  std::map<int64_t, Applied> applied;
  std::set<int64_t> dirty;                    // takes whose result is to be refined
  std::map<int64_t, Opening> opened_targets;  // by the take
  std::optional<Opening> opened_source;
  std::string advised;        // the source key for which a clean-up was offered
  std::set<int64_t> doubted;  // takes whose target may be no person: to be asked about
  std::string plan_key, source_key, truth_path;
  std::string scans_key;  // of the source and its edits but for who is taken: of what is drawn
  std::string extent_of;  // the source that SourceState::extent is of
  std::string people_of;  // the scans that these are in
  std::vector<PersonSeen> people_before, people_now;  // of them, until they are met again
  std::string told_of;                                // the scans of which it was told who is taken
  /// What was found and edited, by what it was made from; the last used at the end.
  std::vector<std::pair<std::string, std::shared_ptr<const DiscoveredRig>>> rigs;
  std::string bones_key;                 // of what is shown of bones, or on its way
  std::shared_ptr<BonesJob> bones_work;  // null: none runs
  std::string near_key;                  // of what BonesState::near was found from
  std::string autosave_problem;          // the last one reported
  /// What the second body was last made to perform, or is made to; null: nothing yet.
  std::shared_ptr<SecondBodyJob> second_work;
  std::shared_ptr<const DiscoveredRig> motions_of;  // the rig that MadeMotionsState is of
  /// The last ones that made what is offered, and the document's clips; null: none yet.
  std::shared_ptr<MotionsJob> motions_work, clips_work;
  /// All that was made, with the rig that it is of; the newest at the end.
  std::vector<std::pair<std::shared_ptr<const DiscoveredRig>, MadeMotion>> motions;
  int64_t sending = 0;                    // the switch's number: what was asked for before it is late
  std::optional<ShownPoseSender> sender;  // none: nothing is sent, or not yet
  std::string flat_key;                   // of what is shown of 2D poses, or on its way
  std::shared_ptr<FlatJob> flat_work;     // the last one; null: none yet
  std::string flat_shown;                 // the source's part of that key, as it is shown
  double since_autosave = 0;
  std::shared_ptr<Autosaving> autosaving = std::make_shared<Autosaving>();
};

template <>
void Studio::take_in(SourceOpened& event);
template <>
void Studio::take_in(SourceFailed& event);
template <>
void Studio::take_in(SourceFrames& event);
template <>
void Studio::take_in(TakeFailed& event);

/// Leaves what is the person's of a frame's scan. False: that is nothing.
bool cut_out(const KeptSource& kept, Mesh& scan);

/// Whether the user is being asked where a file is: a second dialog need not say that it is missing.
bool asked_for(const Session& session, const std::string& problem);
/// Whether all frames of a take are performed.
bool is_performed(const Session& session, size_t take);
/// Whether both give the same poses: trim and skip only change what plays.
bool same_poses(PoseEdits a, PoseEdits b);

}  // namespace understudy::app
