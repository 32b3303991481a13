// The studio without its window: the session, the commands that change it and the background workers.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/run/flat_performance.hpp"
#include "app/session/commands.hpp"
#include "app/session/frame_cache.hpp"
#include "app/session/job_queue.hpp"
#include "app/session/session.hpp"
#include "retarget/pipeline/keypoint_transfer.hpp"

namespace understudy::app {

struct SourceFrames;
struct BonesJob;
struct SecondBodyJob;
struct MotionsJob;
struct FlatJob;

/// Where the networks come from: the program passes the trained ones, tests their own.
struct StudioServices {
  std::function<Networks(const Method&, const NetworkParts&)> networks;  ///< called off the UI thread
  std::function<std::shared_ptr<MotionSpace>()> motion_space;  ///< what fills gaps; called off the UI thread
  /// what codes movements that are blended; called off the UI thread, once
  std::function<std::shared_ptr<MotionCoder>()> motion_coder;
  std::function<std::unique_ptr<Lifter>()> lifter;  ///< what lifts 2D poses; called off the UI thread
  /// what reads proportions off 2D poses; called off the UI thread, once
  std::function<std::shared_ptr<const LengthReader>()> lengths;
  FlatEngineMaker flat_engine;           ///< as FlatTools have it; called off the UI thread
  KeypointsLoader keypoints;             ///< of a kind of bodies; called off the UI thread
  DynamicsLoader dynamics;               ///< of how bodies of a kind move; called off the UI thread
  std::function<std::string()> weights;  ///< checksums, for documents; called off the UI thread
  std::string samples;                   ///< folder of the bundled samples; empty: none
  std::string program;                   ///< that shows a study; empty: this one, once more
  std::string settings_file;             ///< empty: settings are not kept
  bool greets_newcomers = false;         ///< without a settings file yet the cards of Getting started come
  std::string autosave_folder;           ///< empty: no autosave
};

class Studio {
 public:
  explicit Studio(StudioServices services);
  ~Studio();

  const Session& session() const { return session_; }
  Session& session() { return session_; }  ///< for commands only
  Commands& commands() { return commands_; }
  const Commands& commands() const { return commands_; }
  JobQueue& jobs() { return jobs_; }
  FrameCache& cache() { return cache_; }
  const StudioServices& services() const { return services_; }

  /// Has the networks' plug-in loaded before it is needed. Not before the first frame is drawn: while one
  /// thread loads it no other loads anything, a graphics driver neither.
  void warm_up();
  /// Runs one command. Throws Error with a sentence for the user.
  void run(const std::string& name, const Arguments& arguments = {});
  /// The same; a failure becomes a dialog.
  void try_run(const std::string& name, const Arguments& arguments = {});
  void run_all(CommandQueue& queue);

  /// Once per drawn frame: collects what the background has finished. Notices and copies of unsaved work go
  /// by the `seconds` gone by, the playhead moves by those `played`.
  void tick(double seconds, double played);
  void tick(double seconds) { tick(seconds, seconds); }
  /// Ticks until all frames are made and nothing is left to do. Throws Error after `timeout_s`. For scripts
  /// and tests.
  void wait_idle(double timeout_s = 600);

  /// Opens dropped or chosen files: a scan, a target, a motion, a document, a case folder.
  void open(const std::string& path);
  /// Whether no background work is left.
  bool idle() const;
  /// Whether every frame is made and edited; figures may still be missing.
  bool made() const;
  /// Shows a sentence in a dialog; details are for "copy details".
  void fail(const std::string& sentence, const std::string& details = "");
  /// Shows a sentence for some seconds, with what can be done about it.
  void notify(const std::string& sentence, bool warning = false, const Offer& offer = {},
              const Offer& also = {});
  /// The document as it would be saved now.
  SavedDocument saved_document() const;
  /// Takes back the opening of a take's target. False, and nothing is done, where it came with the document
  /// or has been read already.
  bool take_back_target(size_t k);
  /// Replaces the open document by a new, an opened or a recovered one.
  void replace_document(SavedDocument saved, const std::string& path);
  void save_settings();
  /// After saving, and at the end: removes the copy kept for recovery, also one that is being written, where
  /// nothing is unsaved; keeps what is unsaved for the next start.
  void end_autosave();
  /// The neighbouring vertices of a take's target; made on first use.
  const Neighbours& neighbours(size_t take);
  /// A number that stays with a take while others come and go; and its place now, -1 once it is gone.
  int64_t id_of_take(size_t take) const;
  int take_with_id(int64_t id) const;
  void pause_work(bool paused);
  /// Redoes every frame.
  void restart_work();
  /// Looks once more for bones that were not found, or not to the end.
  void look_for_bones_again();
  /// Does an edit of the found bones, and adds it to the document's. Throws Error while there are none, or
  /// where it is refused. FitAgain is done in the background.
  void edit_bones(const RigEdit& edit);

  /// Reads the second body once more where it did not come to perform.
  void perform_again();
  /// Makes `how.count` motions of the found rig, which are offered then. Throws Error where they cannot be.
  void make_motions(const GenerationOptions& how);

  /// Sends what is shown of the current take to the settings' address from now on, or no longer. An address
  /// that there is not becomes a dialog.
  void send_poses(bool wanted);

 private:
  struct Background;
  void ask_for_canvas(const std::string& path, const std::string& then, int take = -1);
  void keep_study_step(const Study& before, const std::string& label, const std::string& merge);
  void ask_about_autosaves();
  void load_weights_name();
  void follow_document();
  void follow_current_take(const std::vector<int64_t>& ids_now);
  void follow_source(bool other_path);
  void follow_edits();
  static void forget_target(TakeState& state);
  void forget_removed();
  void apply_weights(size_t k);
  void ask_about_paint();
  void ask_about_persons();
  void tell_unseen(size_t k, int first);
  void take_in_people(const SourceFrames& event);
  void offer_clean_up(const std::string& doubt);
  void offer_fills();
  void offer_fill(size_t k);
  void withdraw_notice(int64_t id);
  void follow_bones();
  void withdraw_bones_offer();
  void start_finding_bones();
  void take_in_bones(BonesJob& work);
  void compare_bones();
  void forget_incomplete_bones();
  void follow_second_body();
  void wait_for_clip();
  void start_second_body();
  void take_in_second_body(SecondBodyJob& work);
  void follow_made_motions();
  std::shared_ptr<const GeneratedMotion> kept_motion(const GenerationOptions& how) const;
  std::shared_ptr<MotionsJob> motions_job(std::vector<GenerationOptions> wanted) const;
  void start_clips(std::vector<GenerationOptions> missing);
  void keep_made(const MotionsJob& work);
  void take_in_clips(MotionsJob& work);
  void take_in_motions(MotionsJob& work);
  void follow_flat();
  void start_flat(std::string key);
  void take_in_flat(FlatJob& work);
  void show_flat_source(const FlatJob& work);
  void note_openings(const Document& before, const std::vector<int64_t>& ids_before, bool changed_before);
  void roll_back_source();
  void note_source_read();
  using Change = std::function<void(Document&)>;
  void roll_back(size_t steps, bool changed_before, const Change& change);
  void take_in_results();
  template <class Event>
  void take_in(Event& event);
  void show_skeleton(int first);
  void take_in_refined();
  void refine_dirty();
  void measure_finished();
  void measure(size_t k);
  TakeState* take_of(int64_t id);
  void autosave(double seconds);
  void autosave_ended();

  StudioServices services_;
  Session session_;
  Commands commands_;
  std::shared_ptr<MotionBlender> blender_;
  JobQueue jobs_;
  FrameCache cache_;
  std::unique_ptr<Background> background_;
};

}  // namespace understudy::app
