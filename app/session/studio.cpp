#include "app/session/studio.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <thread>

#include "app/run/keypoint_source.hpp"
#include "app/run/pose_pictures.hpp"
#include "app/session/background.hpp"
#include "app/session/command_sets.hpp"
#include "app/session/taught_styles.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"

namespace understudy::app {
namespace {

constexpr double kNoticeSeconds = 8;

/// For each take of `now` the index of the take of `before` that it continues, -1 for a new one: the same
/// target made the same way, else the same target, else the same file.
std::vector<int> matched_takes(const std::vector<Take>& before, const std::vector<Take>& now) {
  std::vector<int> match(now.size(), -1);
  std::vector<bool> used(before.size(), false);
  const auto pass = [&](const auto& alike) {
    for (size_t k = 0; k < now.size(); ++k)
      for (size_t i = 0; match[k] < 0 && i < before.size(); ++i)
        if (!used[i] && alike(before[i], now[k])) match[k] = i, used[i] = true;
  };
  const auto same_target = [](const Take& a, const Take& b) { return same(a.target, b.target); };
  pass([&](const Take& a, const Take& b) {
    return same_target(a, b) && same(a.method, b.method) && a.name == b.name && a.person == b.person;
  });
  pass([&](const Take& a, const Take& b) { return same_target(a, b); });
  pass([&](const Take& a, const Take& b) { return a.target.path == b.target.path; });
  return match;
}

}  // namespace

Studio::Studio(StudioServices services)
    : services_(std::move(services)),
      blender_(std::make_shared<MotionBlender>(services_.motion_coder)),
      cache_(512,
             [blender = blender_, lifter = services_.lifter](const SourceOptions& of) {
               auto source = open_source(of, blender.get());
               if (is_keypoint_source(of)) source->set_tools({{}, {}, lifter, {}});
               return source;
             }),
      background_(std::make_unique<Background>(services_, blender_)) {
  if (!services_.settings_file.empty()) session_.settings = read_settings(services_.settings_file);
  std::error_code ignored;
  const bool is_first =
      !services_.settings_file.empty() && !std::filesystem::exists(services_.settings_file, ignored);
  if (services_.greets_newcomers && is_first) session_.settings.getting_started = 1;
  session_.history = History(session_.settings.undo_depth);
  session_.study.history = StudyHistory(session_.settings.undo_depth);
  cache_.set_limit(session_.settings.cache_mb);
  add_all_commands(commands_);
  session_.styles.taught = taught_styles(styles_folder(services_.settings_file));
  ask_about_autosaves();
  load_weights_name();
}

Studio::~Studio() {
  try {
    end_autosave();
    save_settings();
  } catch (const std::exception& error) {
    log::warn(error.what());
  }
}

void Studio::save_settings() {
  if (!services_.settings_file.empty()) write_settings(services_.settings_file, session_.settings);
}

/// The checksum of the weights takes a moment: read once, in the background.
void Studio::load_weights_name() {
  if (!services_.weights) return;
  auto name = std::make_shared<std::string>();
  const auto weights = services_.weights;
  jobs_.start(
      "Reading weights", [name, weights](JobControl&) { *name = weights(); },
      [this, name] { session_.weights = *name; });
}

void Studio::warm_up() {
  jobs_.start("Loading networks", [networks = services_.networks](JobControl&) {
    failure_of([&] { networks(Method{}, NetworkParts{}); });  // told when they are needed
  });
}

void Studio::ask_about_autosaves() {
  if (services_.autosave_folder.empty()) return;
  const auto found = found_autosaves(services_.autosave_folder);
  if (found.empty()) return;
  session_.question = Question{
      Question::Kind::Recover, "The studio was not closed properly. Unsaved work was saved.", "", {}, found};
}

void Studio::run(const std::string& name, const Arguments& arguments) {
  const Command* const command = commands_.find(name);
  US_CHECK(command, "there is no command ", name);
  Call call(*this, arguments);
  if (command->undo == Command::Undo::None) {
    command->run(call);
    follow_document();
    return mend(session_, name);
  }
  const Document before = session_.document;
  const std::optional<Study> study_before = session_.study.study;
  const std::vector<int64_t> ids_before = background_->take_ids;
  const bool changed_before = session_.changed;
  const bool merges = command->undo == Command::Undo::Merged;
  const auto label = [&] { return call.label.empty() ? command->label : call.label; };
  // Of one thing: the label tells bones and points from each other.
  const auto merge = [&] {
    return merges ? name + (arguments.empty() ? "" : " " + arguments[0]) + '\n' + label() : "";
  };
  try {
    command->run(call);
    mend(session_, name);
    if (study_before && session_.study.study && !same(*study_before, *session_.study.study))
      keep_study_step(*study_before, label(), merge());
    if (same(before, session_.document)) return;
    follow_document();
  } catch (...) {
    session_.document = before;  // a command does all of its work or nothing
    session_.study.study = study_before;
    throw;
  }
  session_.history.add(before, label(), merge());
  session_.study.history.forget_redo();
  session_.changed = true;
  note_openings(before, ids_before, changed_before);
}

void Studio::keep_study_step(const Study& before, const std::string& label, const std::string& merge) {
  StudyState& state = session_.study;
  state.history.add(before, label, merge);
  session_.history.forget_redo();
  state.changed = true;
  follow_design(state);
}

void Studio::try_run(const std::string& name, const Arguments& arguments) {
  const std::string line = join_line(name, arguments);
  jobs_.set_command(line);
  try {
    run(name, arguments);
  } catch (const std::exception& error) {
    fail(error.what(), line);
  }
  jobs_.set_command("");
}

void Studio::run_all(CommandQueue& queue) {
  const CommandQueue now = std::exchange(queue, {});
  for (const auto& [name, arguments] : now) try_run(name, arguments);
}

void Studio::fail(const std::string& sentence, const std::string& details) {
  log::warn(sentence);
  session_.errors.push_back({Notice::Kind::Error, sentence, details, 0});
  const std::string command = details.substr(0, details.find(' '));
  if (commands_.find(command) != nullptr) session_.failures.push_back({sentence, command});
}

void Studio::notify(const std::string& sentence, bool warning, const Offer& offer, const Offer& also) {
  const Arguments offered = split_line(offer.command);
  if (offered.size() == 2 && offered[0] == "file.show")
    log::info(offered[1] + ": is written");  // the notice is gone soon, and names no folder
  const auto kind = warning ? Notice::Kind::Warning : Notice::Kind::Info;
  const double until = offer.waits ? std::numeric_limits<double>::infinity() : session_.time + kNoticeSeconds;
  session_.notices.push_back({kind, sentence, "", until, offer, ++session_.notices_made, also});
}

/// Gives the background the plan, and drops what no longer belongs to anything. Where it throws nothing has
/// changed.
void Studio::follow_document() {
  Background& b = *background_;
  Document now = session_.document;
  const auto match = matched_takes(b.followed.takes, now.takes);
  std::vector<int64_t> ids;
  std::vector<bool> other_target, other_method;
  for (size_t k = 0; k < now.takes.size(); ++k) {
    const Take* const before = match[k] < 0 ? nullptr : &b.followed.takes[match[k]];
    ids.push_back(before ? b.take_ids[match[k]] : b.next_id++);
    other_target.push_back(before && !same(before->target, now.takes[k].target));
    other_method.push_back(before && !same(before->method, now.takes[k].method));
  }
  Plan plan = plan_of(now, ids);
  std::string key = key_of(plan);
  std::vector<TakeState> takes(now.takes.size());
  // From here on nothing throws.
  for (size_t k = 0; k < takes.size(); ++k) {
    if (match[k] >= 0) takes[k] = std::move(session_.takes[match[k]]);
    if (other_target[k]) forget_target(takes[k]), b.applied[ids[k]].deformer.reset();
    if (other_method[k]) takes[k].problem.clear(), takes[k].latency = {};
  }
  session_.takes = std::move(takes);
  follow_current_take(ids);
  b.take_ids = std::move(ids);
  const bool other_source = now.source.path != b.followed.source.path;
  b.followed = std::move(now);
  forget_removed();
  const std::string problem = failure_of([&] {
    follow_source(other_source);
    follow_edits();
    if (key == b.plan_key) return;
    if (!b.take_ids.empty()) plan.first = b.take_ids[session_.selected_take];
    b.engine.set_plan(std::move(plan));
    b.plan_key = std::move(key);
    session_.working = true;
  });
  if (!problem.empty()) fail(problem);  // what was not followed differs from its key, and is at the next time
}

/// The current take stays so when others go, unless the command chose another.
void Studio::follow_current_take(const std::vector<int64_t>& ids_now) {
  Background& b = *background_;
  const int64_t* const current = at_or_null(b.take_ids, session_.selected_take);
  const bool any_gone = ids_now.size() < b.take_ids.size();
  if (current && any_gone && session_.selected_take == b.followed_take) {
    const auto found = std::find(ids_now.begin(), ids_now.end(), *current);
    if (found != ids_now.end()) session_.selected_take = static_cast<int>(found - ids_now.begin());
  }
  settle_current_take(session_);
  b.followed_take = session_.selected_take;
}

/// Of a target prepared in another way only the file is the same.
void Studio::forget_target(TakeState& state) {
  TakeState fresh;
  fresh.character = std::move(state.character);
  fresh.generation = state.generation + 1;
  state = std::move(fresh);
}

/// What was made for takes that are no more.
void Studio::forget_removed() {
  Background& b = *background_;
  bool any = false;
  for (auto applied = b.applied.begin(); applied != b.applied.end();) {
    const int64_t id = applied->first;
    const bool stays = std::find(b.take_ids.begin(), b.take_ids.end(), id) != b.take_ids.end();
    if (!stays && applied->second.measuring != 0) jobs_.cancel(applied->second.measuring);
    if (!stays) b.dirty.erase(id), b.opened_targets.erase(id), b.doubted.erase(id);
    if (!stays) withdraw_notice(applied->second.fill_notice);
    any = any || !stays;
    applied = stays ? std::next(applied) : b.applied.erase(applied);
  }
  if (any) cache_.forget_takes();
}

void Studio::follow_source(bool other_path) {
  Background& b = *background_;
  const Document& document = session_.document;
  const ScanEdits edits = in_effect(document.scan_edits);
  const std::string key = key_of(document.source, edits);
  if (key != b.source_key) {
    const std::string scans = key_of(without_people(document.source), edits);
    if (scans != b.scans_key) {
      cache_.set_source(without_people(document.source), edits);
      session_.source.import.reset();
      b.scans_key = scans;
    }
    auto& notices = session_.notices;
    notices.erase(std::remove_if(notices.begin(), notices.end(),
                                 [](const Notice& notice) { return notice.offer.waits; }),
                  notices.end());
    b.source_key = key;
    session_.source.problem.clear();
    if (other_path) session_.source.clips.clear();
    if (document.source.path.empty()) session_.source = SourceState{};
  }
  if (document.truth == b.truth_path) return;
  auto truth = std::make_shared<Truth>();
  const std::string path = document.truth;
  if (!path.empty())
    jobs_.start(
        "Reading the ground truth", [truth, path](JobControl&) { *truth = read_truth(path); },
        [this, truth, path] {
          if (path != background_->truth_path) return;
          session_.truth = truth;
          for (int64_t id : background_->take_ids) background_->dirty.insert(id);
        });
  b.truth_path = path;  // only now: starting may fail
  session_.truth.reset();
}

/// Edits that need no new frames: painted weights at once, edits of the result in the background.
void Studio::follow_edits() {
  Background& b = *background_;
  for (size_t k = 0; k < session_.document.takes.size(); ++k) {
    const Take& take = session_.document.takes[k];
    Background::Applied& applied = b.applied[b.take_ids[k]];
    if (take.target_edits.weights != applied.weights) apply_weights(k);
    if (same_poses(take.pose_edits, applied.poses)) continue;
    applied.poses = take.pose_edits;
    b.dirty.insert(b.take_ids[k]);
  }
}

/// Puts the user's skin weights over the networks'. Those that were painted on another surface are left out.
void Studio::apply_weights(size_t k) {
  Background::Applied& applied = background_->applied[background_->take_ids[k]];
  TakeState& state = session_.takes[k];
  const auto weights_wanted = session_.document.takes[k].target_edits.weights;
  applied.weights.reset();  // until they are there: what throws is done at the next time
  if (!applied.deformer) return;
  state.deformer = applied.deformer;
  state.paint_problem.clear();
  applied.asked_about_paint = false;
  if (weights_wanted && !weights_wanted->empty()) try {
      RowMatrix weights = applied.deformer->weights();
      understudy::apply(*weights_wanted, weights);
      state.deformer = applied.deformer->with_weights(std::move(weights));
    } catch (const Error& error) {
      state.paint_problem = session_.document.takes[k].name + ": " + error.what();
    }
  state.weights = std::shared_ptr<const RowMatrix>(state.deformer, &state.deformer->weights());
  ExportBody body{state.character, state.deformer, {}};
  body.file.joints = state.target->joints;
  state.face = marks_of(body).face;
  applied.weights = weights_wanted;
  ++state.generation;
}

/// Painted weights that do not fit are asked about, one take after the other.
void Studio::ask_about_paint() {
  for (size_t k = 0; k < session_.takes.size() && !session_.question; ++k) {
    bool& asked = background_->applied[background_->take_ids[k]].asked_about_paint;
    if (session_.takes[k].paint_problem.empty() || asked) continue;
    asked = true;
    session_.question = Question{
        Question::Kind::PaintMisfit, session_.takes[k].paint_problem + ". They are left out.", "", {}, {},
        static_cast<int>(k)};
  }
}

const Neighbours& Studio::neighbours(size_t take) {
  US_CHECK(take < session_.takes.size() && session_.takes[take].target, "the target is still being prepared");
  Background::Applied& applied = background_->applied[background_->take_ids[take]];
  if (applied.neighbours_of != session_.takes[take].target) {
    applied.neighbours_of = session_.takes[take].target;
    applied.neighbours = Neighbours::from(applied.neighbours_of->mesh);
  }
  return applied.neighbours;
}

void Studio::tick(double seconds, double played) {
  session_.time += seconds;
  take_in_results();
  const bool takes = !session_.takes.empty();
  const PoseEdits none;
  const PoseEdits& edits = takes ? session_.document.takes[session_.selected_take].pose_edits : none;
  const int count = frame_count(session_);
  if (session_.playback.live && !session_.playback.playing) session_.playback.frame = count - 1;
  Playback trimmed = session_.playback;
  if (edits.trim && trimmed.in < 0) trimmed.in = edits.trim->first;
  if (edits.trim && trimmed.out < 0) trimmed.out = edits.trim->last;
  const double length =
      takes ? length_at(session_.takes[session_.selected_take].times, session_.source.fps, trimmed.frame) : 1;
  const double before = trimmed.frame;
  advance(trimmed, played, session_.source.fps / length, count, edits.skip);
  // A new target, and a scan that is cropped, start without frames: the place is kept until it comes there.
  const auto& source = session_.source;
  const int64_t known =
      std::max<int64_t>(source.count.value_or(0), static_cast<int64_t>(source.frames.size()));
  const double comes = static_cast<double>(std::max<int64_t>(count, known));
  session_.playback.frame = std::clamp(trimmed.frame, 0.0, std::max(0.0, comes - 1e-3));
  if (trimmed.playing && trimmed.frame < before) ++session_.made_motions.laps;
  session_.playback.playing = trimmed.playing;
  if (session_.view.turntable_deg_s != 0)
    for (CameraState& camera : session_.view.cameras)
      camera.yaw += static_cast<float>(played) * session_.view.turntable_deg_s * kPi / 180;
  if (background_->sender) background_->sender->push(session_, seconds);
  session_.jobs = jobs_.views();
  for (size_t k = 0; k < session_.takes.size(); ++k)
    if (session_.takes[k].as_loaded && session_.takes[k].problem.empty() && !session_.paused)
      session_.jobs.push_back({0, "Binding " + session_.document.takes[k].name, -1, -1, false});
  auto& notices = session_.notices;
  notices.erase(std::remove_if(notices.begin(), notices.end(),
                               [this](const Notice& notice) { return notice.until < session_.time; }),
                notices.end());
  autosave(seconds);
}

/// A host's name may take long to find: looked up in the background.
void Studio::send_poses(bool wanted) {
  background_->sender.reset();
  session_.sends_to.clear();
  const int64_t asked = ++background_->sending;
  if (!wanted) return;
  const std::string address = session_.settings.send_to;
  auto sender = std::make_shared<std::optional<PoseSender>>();
  jobs_.start(
      "Finding " + address, [sender, address](JobControl&) { sender->emplace(address); },
      [this, sender, asked] {
        if (asked != background_->sending) return;
        session_.sends_to = (*sender)->address();
        background_->sender.emplace(std::move(**sender));
      });
}

void Studio::autosave(double seconds) {
  Background& b = *background_;
  if (services_.autosave_folder.empty() || session_.question || seconds <= 0) return;
  b.since_autosave += seconds;
  if (!session_.changed || b.since_autosave < session_.settings.autosave_s || b.autosaving->running) return;
  b.since_autosave = 0;
  const auto state = b.autosaving;
  const auto work = [saved = saved_document(), folder = services_.autosave_folder, path = session_.path,
                     state, version = state->version](JobControl&) {
    const std::lock_guard lock(state->writing);
    try {
      if (state->version == version) write_autosave(folder, saved, path);
      state->problem.clear();
    } catch (const std::exception& error) {
      state->problem = error.what();
    }
  };
  jobs_.start("Autosave", work, [this] { autosave_ended(); });
  state->running = true;
}

/// Reports a copy that cannot be written once, without a dialog: no work is lost yet.
void Studio::autosave_ended() {
  Background::Autosaving& state = *background_->autosaving;
  state.running = false;
  if (!state.problem.empty() && state.problem != background_->autosave_problem) {
    log::warn(state.problem);
    notify("Unsaved work cannot be saved for recovery: " + state.problem, true);
  }
  background_->autosave_problem = state.problem;
}

void Studio::end_autosave() {
  if (services_.autosave_folder.empty()) return;
  const std::lock_guard lock(background_->autosaving->writing);
  ++background_->autosaving->version;
  if (session_.changed)
    write_autosave(services_.autosave_folder, saved_document(), session_.path);
  else
    remove_autosave(services_.autosave_folder);
}

SavedDocument Studio::saved_document() const {
  return {session_.document, session_.view, session_.playback, session_.weights, session_.selected_take};
}

bool Studio::idle() const {
  return made() && !jobs_.running() && !cache_.busy();
}

bool Studio::made() const {
  return !session_.working && !background_->refiner.busy() && background_->dirty.empty();
}

void Studio::wait_idle(double timeout_s) {
  const auto began = std::chrono::steady_clock::now();
  do {
    tick(0);
    US_CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() < timeout_s,
             "the studio was still working after ", timeout_s, " s");
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  } while (!idle());
  tick(0);
}

}  // namespace understudy::app
