// The studio without its window: the session, the commands that change it, and what works in the background.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/session/commands.hpp"
#include "app/session/frame_cache.hpp"
#include "app/session/job_queue.hpp"
#include "app/session/session.hpp"

namespace understudy::app {

/// Where the networks come from; the program plugs the trained ones in, tests their own.
struct StudioServices {
  std::function<Networks(const Method&)> networks;  ///< called off the UI thread
  std::function<std::string()> weights;             ///< checksums, for documents; called off the UI thread
  std::string samples;                              ///< folder of the bundled samples; empty: none
  std::string settings_file;                        ///< empty: nothing is remembered
  std::string autosave_folder;                      ///< empty: no autosave
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

  /// Runs one command. Throws Error: the sentence for the user.
  void run(const std::string& name, const Arguments& arguments = {});
  /// The same; a failure becomes a dialog.
  void try_run(const std::string& name, const Arguments& arguments = {});
  void run_all(CommandQueue& queue);

  /// Once a drawn frame: takes in what the background has finished, moves the playhead by `seconds`.
  void tick(double seconds);
  /// Ticks until all frames are made and nothing is to do; throws Error after `timeout_s`. For scripts and
  /// tests.
  void wait_idle(double timeout_s = 600);

  /// Opens what was dropped or chosen: a scan, a target, a motion, a document, a case folder.
  void open(const std::string& path);
  /// Whether nothing works in the background.
  bool idle() const;
  /// Whether every frame is made and edited; figures may still be taken.
  bool made() const;
  /// Shows a sentence in a dialog; details are for "copy details".
  void fail(const std::string& sentence, const std::string& details = "");
  /// Shows a sentence for some seconds.
  void notify(const std::string& sentence, bool warning = false);
  /// What would be written now.
  SavedDocument saved_document() const;
  /// A new, an opened or a recovered document takes the place of the open one.
  void replace_document(SavedDocument saved, const std::string& path);
  void save_settings();
  /// Nothing is unsaved any more: the copy kept for recovery goes, one that is being written too.
  void drop_autosave();
  /// Which vertices of a take's target are joined; made on first use.
  const Neighbours& neighbours(size_t take);
  void pause_work(bool paused);
  /// Makes every frame anew.
  void restart_work();

 private:
  struct Background;
  void ask_about_autosaves();
  void load_weights_name();
  void follow_document();
  void follow_source();
  void follow_edits();
  void forget_outdated(TakeState& state, const Take& before, const Take& now);
  void apply_weights(size_t k);
  void take_in_results();
  template <class Event>
  void take_in(Event& event);
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
  JobQueue jobs_;
  FrameCache cache_;
  std::unique_ptr<Background> background_;
};

}  // namespace understudy::app
