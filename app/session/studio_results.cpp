// What the background has finished, taken into the session.
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/session/background.hpp"
#include "app/session/frame_figures.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr double kRefineEvery = 0.4;  // seconds between two passes over a result that still grows

/// Puts `frames` at `first`, over what is there and behind it. True when earlier ones were replaced.
template <class Frame>
bool put(SharedFrames<Frame>& all, size_t first, std::vector<Frame> frames) {
  const bool replaces = first < all.size();
  all.write(first, first + frames.size(),
            [&](size_t t, Frame& frame) { frame = std::move(frames[t - first]); });
  return replaces;
}

/// Puts the first `count` of newer items in the place of the first ones of a list that has grown meanwhile.
template <class Item>
void replace_first(std::vector<Item>& all, std::vector<Item> newer, size_t count) {
  newer.resize(std::min(count, newer.size()));
  if (newer.size() < all.size()) newer.insert(newer.end(), all.begin() + ssize(newer), all.end());
  all = std::move(newer);
}

/// What was refined takes the place of what is shown. Of frames that have come meanwhile it knows nothing:
/// these stay as they were performed.
void show(Refined refined, TakeState& take) {
  if (refined.performed == take.performed.size()) {
    take.shown = std::move(refined.shown);
    take.joints = std::move(refined.joints);
    return;
  }
  const size_t count = refined.performed;
  replace_first(take.shown.poses, std::move(refined.shown.poses), count);
  replace_first(take.shown.flags, std::move(refined.shown.flags), count);
  replace_first(take.shown.standing, std::move(refined.shown.standing), count);
  replace_first(take.joints, std::move(refined.joints), count);
  take.shown.doubt_m = std::move(refined.shown.doubt_m);
  if (take.shown.doubt_m.empty()) return;
  take.shown.doubt_m.resize(count);
  for (size_t t = count; t < take.shown.poses.size(); ++t)
    take.shown.doubt_m.push_back(t < take.performed.size() ? take.performed[t].doubt_m : 0);
}

/// Shows frames appended to a result without edits at once.
void append_shown(TakeState& take, int first, double fps) {
  take.shown.fps = static_cast<float>(fps);
  const size_t count = take.performed.size();
  if (first > ssize(take.shown.poses)) first = take.shown.poses.size();
  take.shown.poses.resize(count);
  take.shown.flags.resize(count);
  take.shown.standing.resize(count);
  bool any_made = false;
  for (size_t t = first; t < count; ++t) any_made = any_made || take.performed[t].doubt_m > 0;
  if (any_made || !take.shown.doubt_m.empty()) take.shown.doubt_m.resize(count);
  take.joints.resize(count);
  for (size_t t = first; t < count; ++t) {
    if (any_made) take.shown.doubt_m[t] = take.performed[t].doubt_m;
    take.shown.poses[t] = take.performed[t].pose;
    take.shown.flags[t] = take.performed[t].flagged;
    take.shown.standing[t] = take.performed[t].standing;
    take.joints[t] = forward_kinematics(take.target->joints, take.shown.poses[t]).joints;
  }
}

/// The series of both; where both have a key, the newer.
void merge_series(std::vector<Series>& into, std::vector<Series> newer) {
  for (Series& series : newer) {
    const auto same =
        std::find_if(into.begin(), into.end(), [&](const Series& s) { return s.key == series.key; });
    if (same == into.end())
      into.push_back(std::move(series));
    else
      *same = std::move(series);
  }
}

}  // namespace

bool asked_for(const Session& session, const std::string& problem) {
  if (!session.question || session.question->kind != Question::Kind::MissingFiles) return false;
  const auto& missing = session.question->missing;
  return std::any_of(missing.begin(), missing.end(),
                     [&](const std::string& path) { return problem.find(path) != std::string::npos; });
}

bool cut_out(const KeptSource& kept, Mesh& scan) {
  if (!kept.owners) return true;
  SceneFrame scene;
  scene.owner = kept.owners->owners(scan.vertices);
  if (!scene.owner.empty()) scan = part_of(scan, scene, kept.person);
  return scan.vertices.rows() > 0;
}

bool same_poses(PoseEdits a, PoseEdits b) {
  for (PoseEdits* edits : {&a, &b}) edits->trim.reset(), edits->skip.clear();
  return same(a, b);
}

TakeState* Studio::take_of(int64_t id) {
  const int k = take_with_id(id);
  return k < 0 ? nullptr : &session_.takes[k];
}

template <>
void Studio::take_in(SourceOpened& event) {
  Background& b = *background_;
  const int64_t generation = session_.source.generation + 1;
  const std::string source = key_of(without_people(session_.document.source));
  const bool again = std::exchange(b.extent_of, source) == source;
  const std::optional<Box> extent = again ? session_.source.extent : std::nullopt;
  const std::optional<ImportOptions> import = session_.source.import;
  const bool same_scans = std::exchange(b.people_of, b.scans_key) == b.scans_key;
  b.people_before = same_scans ? std::move(session_.source.people) : std::vector<PersonSeen>();
  const bool had_scene = session_.source.has_scene;
  b.people_now.clear();
  session_.source = SourceState{};
  session_.source.extent = extent;
  session_.source.import = import;
  session_.source.people = b.people_before;
  session_.source.has_scene = same_scans && had_scene;
  session_.source.generation = generation;
  session_.source.name = event.name;
  session_.source.count = event.count;
  session_.source.fps = event.fps;
  session_.source.clips = std::move(event.clips);
  session_.source.clip = event.clip;
  for (TakeState& take : session_.takes) {
    if (take.flat) continue;  // made from the same file by itself
    take.performed.clear();
    take.another.clear();
    take.shown = Motion{};
    take.joints.clear();
    take.times.clear();
    take.alternatives.clear();
    take.series.clear();
    take.metrics.clear();
    take.latency = {};
    ++take.generation;
  }
}

template <>
void Studio::take_in(SourceCompleting& event) {
  session_.source.completing = event.share;
}

template <>
void Studio::take_in(SourceFailed& event) {
  session_.source.problem = event.sentence;
  session_.source.completing = -1;
  if (asked_for(session_, event.sentence)) return log::warn(event.sentence);
  const bool is_asked = session_.question && session_.question->kind == Question::Kind::Canvas;
  if (event.wants_canvas && is_asked) return;  // both who lifts it and who performs it flat have tried
  const SourceOptions failed = session_.document.source;
  const bool is_new = background_->opened_source.has_value();
  roll_back_source();
  if (event.wants_canvas)
    return ask_for_canvas(failed.path, is_new ? join_line("source.open", {failed.path}) : "flat.canvas");
  auto& recent = session_.settings.recent_sources;
  fail(event.sentence +
           (is_new && !failed.blend ? taken_off({&recent}, recent_source(failed.path, failed.motion)) : ""),
       "source.open");
}

/// One after the other: what waits fails again, and asks, when this one is answered.
void Studio::ask_for_canvas(const std::string& path, const std::string& then, int take) {
  if (session_.question) return;
  session_.question = Question{
      Question::Kind::Canvas,
      file_name(path) + " has its points as shares of a picture, and does not say how large that is.",
      then,
      {},
      {},
      take};
}

/// The skeleton shown is the first take's: repaired and smoothed as it was transferred.
void Studio::show_skeleton(int first) {
  const size_t by = take_of_source(session_.document);
  if (by >= session_.takes.size()) return;
  const SharedFrames<KeptFrame>& performed = session_.takes[by].performed;
  SharedFrames<KeptSource>& frames = session_.source.frames;
  frames.write(first, std::min(performed.size(), frames.size()),
               [&](size_t t, KeptSource& frame) { frame.joints = performed[t].source; });
}

/// From its first good frame on a source that was opened stays, and is among the recent ones.
void Studio::note_source_read() {
  auto& opened = background_->opened_source;
  if (!opened) return;
  for (const KeptSource& frame : session_.source.frames) {
    if (frame.points == 0 && frame.flagged) continue;
    const SourceOptions& source = session_.document.source;
    if (!source.blend) remember(session_.settings.recent_sources, recent_source(source.path, source.motion));
    return opened.reset();
  }
}

template <>
void Studio::take_in(SourceFrames& event) {
  SourceState& source = session_.source;
  source.completing = -1;
  for (const KeptSource& frame : event.frames) {
    source.extent = united(source.extent, frame.extent);
    source.has_scene = source.has_scene || frame.owners;
  }
  if (put(source.frames, event.first, std::move(event.frames))) ++source.generation;
  show_skeleton(event.first);
  note_source_read();
  source.decision = event.decision;
  source.to_file = event.to_file;
  source.made = event.made;
  source.import = event.import;
  cache_.set_source(without_people(source_as_read(session_)), in_effect(session_.document.scan_edits));
  take_in_people(event);
  offer_clean_up(event.doubt);
  source.has_faces = event.has_faces;
}

/// Tells once of these scans who is taken where the user did not choose.
void Studio::take_in_people(const SourceFrames& event) {
  Background& b = *background_;
  SourceState& source = session_.source;
  source.person = event.person;
  source.people = b.people_now = event.people;
  for (const PersonSeen& before : b.people_before)
    if (std::none_of(event.people.begin(), event.people.end(),
                     [&](const PersonSeen& now) { return now.id == before.id; }))
      source.people.push_back(before);
  std::sort(source.people.begin(), source.people.end(),
            [](const auto& a, const auto& c) { return a.id < c.id; });
  const auto sure = std::count_if(event.people.begin(), event.people.end(),
                                  [](const PersonSeen& one) { return one.is_sure; });
  const std::string& wanted = session_.document.source.person;
  if (sure < 2 || person_number(wanted) > 0 || b.told_of == b.scans_key) return;
  b.told_of = b.scans_key;
  std::string sentence =
      std::to_string(sure) + " people are seen: person " + std::to_string(event.person) +
      (wanted == "largest" ? " performs, who has most points" : " performs, who is seen best");
  if (event.left_out > 0) sentence += "; more are left out";
  notify(sentence + ". A click on another in the source's view chooses them");
}

template <>
void Studio::take_in(TakeLoaded& event) {
  TakeState* const take = take_of(event.id);
  if (take && !take->target) take->as_loaded = std::move(event.as_loaded);
}

namespace {

/// A body taller than its view shows makes the camera go back; nothing brings it nearer.
void show_head(View& view, size_t pane, const Target& target) {
  CameraState* const camera = at_or_null(view.cameras, view.linked ? 0 : static_cast<std::ptrdiff_t>(pane));
  if (!camera || target.mesh.vertices.rows() == 0) return;
  const auto y = target.mesh.vertices.col(1);
  const float tall = 1.1f * (y.maxCoeff() - y.minCoeff()), opening = std::tan(0.5f * camera->fov);
  if (!(tall > camera->target.y() + camera->distance * opening) || !std::isfinite(tall)) return;
  camera->target.y() = 0.5f * tall;
  camera->distance = std::max(camera->distance, 0.5f * tall / opening);
}

}  // namespace

template <>
void Studio::take_in(TakeReady& event) {
  TakeState* const take = take_of(event.id);
  if (!take) return;
  take->ready = true;
  take->problem.clear();
  if (background_->opened_targets.erase(event.id) > 0)
    remember(session_.settings.recent_targets,
             session_.document.takes[take - session_.takes.data()].target.path);
  take->character = event.character;
  take->target = event.target;
  take->binding = event.binding;
  take->as_loaded.reset();
  background_->applied[event.id].deformer = event.deformer;
  apply_weights(take - session_.takes.data());
  show_head(session_.view, take - session_.takes.data() + 1, *event.target);
  for (const std::string& warning : event.target->warnings) notify(warning, true);
}

template <>
void Studio::take_in(TakeFailed& event) {
  TakeState* const take = take_of(event.id);
  if (!take) return;
  take->problem = event.sentence;
  if (asked_for(session_, event.sentence)) return log::warn(event.sentence);
  if (event.not_a_person) {
    log::warn(event.sentence);
    background_->doubted.insert(event.id);
    return;
  }
  const size_t k = take - session_.takes.data();
  const std::string path = session_.document.takes[k].target.path;
  if (event.wants_canvas)
    return ask_for_canvas(path, "flat.target_canvas " + std::to_string(k), static_cast<int>(k));
  const bool gone = event.not_opened && take_back_target(k);
  fail(event.sentence + (gone ? taken_off({&session_.settings.recent_targets}, path) : ""), "target.add");
}

/// Of each limb once, and anew where the frames are.
void Studio::tell_unseen(size_t k, int first) {
  TakeState& take = session_.takes[k];
  if (first == 0) take.limbs = {};
  UnseenTold told(take.limbs);
  for (size_t t = static_cast<size_t>(first); t < take.performed.size(); ++t) {
    const std::string sentence = told.push(take.performed[t].limbs);
    if (sentence.empty()) continue;
    log::warn(session_.document.takes[k].name + ": " + sentence);
    notify(sentence, true);
  }
  take.limbs = told.limbs();
}

template <>
void Studio::take_in(TakeFrames& event) {
  TakeState* const take = take_of(event.id);
  if (!take || !take->target) return;
  const bool redone = put(take->performed, event.first, std::move(event.frames));
  take->rights = std::move(event.rights);
  for (const FrameTimes& times : event.times) take->latency.add(times);
  const size_t k = take - session_.takes.data();
  if (!event.seen.empty()) put(take->another, event.first, std::move(event.seen));
  if (k == take_of_source(session_.document)) show_skeleton(event.first);
  if (redone) ++take->generation;
  tell_unseen(k, event.first);
  if (session_.document.takes[k].pose_edits.empty() || !redone)
    append_shown(*take, event.first, session_.source.fps);
  background_->applied[event.id].measured = false;
  background_->dirty.insert(event.id);
  if (!event.warning.empty()) notify(session_.document.takes[k].name + ": " + event.warning, true);
}

void Studio::take_in_refined() {
  for (Refined& refined : background_->refiner.drain()) {
    TakeState* const take = take_of(refined.take_id);
    if (!take) continue;
    if (!refined.problem.empty()) fail(refined.problem);
    const size_t count = refined.performed, k = take - session_.takes.data();
    const bool edited = !session_.document.takes[k].pose_edits.empty() ||
                        refined.shown.poses.size() != take->shown.poses.size() ||
                        !std::equal(take->joints.begin(), take->joints.end(), refined.joints.begin());
    take->cost = refined.cost;
    take->times = std::move(refined.times);
    take->leg_ratio = refined.leg_ratio;
    merge_series(take->series, std::move(refined.series));
    background_->applied[refined.take_id].refined_frames = count;
    if (!edited || count > take->performed.size()) continue;
    show(std::move(refined), *take);
    ++take->generation;
  }
  for (Alternatives& made : background_->refiner.drain_alternatives())
    if (TakeState* const take = take_of(made.take_id)) take->alternatives = std::move(made.joints);
}

/// A case's truth is of one person.
std::shared_ptr<const Truth> truth_of(const Session& session, size_t take) {
  return performs_another(session.document, session.document.takes[take]) ? nullptr : session.truth;
}

/// Whether all frames of a take are performed.
bool is_performed(const Session& session, size_t k) {
  const auto& performed = session.takes[k].performed;
  return !session.working && !session.paused && !performed.empty() &&
         performed.size() == performed_by(session, k).size();
}

void Studio::refine_dirty() {
  Background& b = *background_;
  for (auto id = b.dirty.begin(); id != b.dirty.end();) {
    TakeState* const take = take_of(*id);
    Background::Applied& applied = b.applied[*id];
    if (take && (!take->target || (session_.working && session_.time - applied.refined_at < kRefineEvery))) {
      if (!take->target && !session_.working) {
        id = b.dirty.erase(id);
        continue;
      }
      ++id;
      continue;
    }
    if (take && !take->performed.empty()) {
      const size_t k = take - session_.takes.data();
      b.refiner.request({*id, take->performed, static_cast<float>(session_.source.fps),
                         session_.document.takes[k].pose_edits, take->target, performed_by(session_, k),
                         truth_of(session_, k), session_.document.takes[k].method.style.any(),
                         is_performed(session_, k)});
      applied.goes_on = session_.document.takes[k].pose_edits.go_on && is_performed(session_, k);
      applied.refined_at = session_.time;
      applied.measured = false;
    }
    id = b.dirty.erase(id);
  }
}

/// Once all frames are there, each take's surface is evaluated frame by frame, one take after the other.
void Studio::measure_finished() {
  Background& b = *background_;
  if (session_.working || session_.paused || b.refiner.busy() || !b.dirty.empty()) return;
  for (size_t k = 0; k < session_.takes.size(); ++k) {
    Background::Applied& applied = b.applied[b.take_ids[k]];
    if (applied.measuring != 0) return;
    if (applied.measured || session_.takes[k].shown.poses.empty() || !session_.takes[k].deformer) continue;
    applied.measured = true;
    return measure(k);
  }
}

namespace {

/// All that evaluating a take needs, copied for its thread.
struct Measuring {
  SourceOptions source;
  ScanEdits edits;
  Motion shown;
  std::vector<Joints> joints, source_joints;
  SharedFrames<KeptSource> kept;
  std::vector<LimbsSight> limbs;
  std::shared_ptr<const PreparedCharacter> character;
  std::shared_ptr<const Deformer> deformer;
  std::shared_ptr<const Truth> truth;
  std::vector<Series> series;
  Metrics metrics;
  std::shared_ptr<MotionBlender> blender;
  std::function<std::unique_ptr<Lifter>()> lifter;  // of 2D poses alone
  std::vector<MomentBetween> moments;               // at the take's tempo, where it has one or a style
};

/// Of the frames that were performed; beyond them there is nothing to measure against.
void evaluate_all(Measuring& m, JobControl& control) {
  const size_t count = std::min(m.shown.poses.size(), m.source_joints.size());
  const bool comparable = m.truth && m.truth->frames == static_cast<int64_t>(count) &&
                          m.truth->vertex_count == static_cast<int64_t>(m.character->surface.in_file.size());
  const Mesh target = m.character->target_in_file_order();
  Evaluator evaluator(m.shown.fps, comparable ? m.truth.get() : nullptr, &target);
  for (const Metric& metric : metric_table())
    if (metric.per_frame && is_of_surfaces(metric) && (comparable || (metric.needs & kNeedsTruth) == 0))
      m.series.push_back(blank_series(metric.key, m.shown.poses.size()));
  SourceOptions quiet = m.source;
  quiet.quiet = true;
  const std::unique_ptr<Source> source = open_source(quiet, m.blender.get());
  if (m.lifter) source->set_tools({{}, {}, m.lifter, {}});
  for (size_t t = 0; t < count; ++t) {
    control.check();
    control.progress(static_cast<float>(t) / static_cast<float>(count));
    auto scan = source->next();
    if (scan && scan->usable) scan->mesh = understudy::apply(m.edits, scan->mesh);
    const Points vertices = m.character->surface.in_file_order(m.deformer->deform(m.shown.poses[t]));
    if (scan && scan->usable) scan->usable = cut_out(m.kept[t], scan->mesh);
    evaluator.push({&vertices, &m.joints[t], &m.shown.poses[t].local, &m.source_joints[t], &m.kept[t].raw,
                    scan && scan->usable ? &scan->mesh : nullptr, nullptr, m.limbs[t]});
    for (Series& series : m.series)
      if (const auto found = evaluator.last().find(series.key); found != evaluator.last().end())
        series.values[t] = static_cast<float>(found->second);
  }
  m.metrics = evaluator.metrics();
  std::vector<Pose> styled;
  for (const MomentBetween& moment : m.moments)
    styled.push_back(pose_between(m.shown.poses[static_cast<size_t>(moment.before)],
                                  m.shown.poses[static_cast<size_t>(moment.after)], moment.share));
  const Joints& rest = m.character->target.joints;
  for (const auto& figure : style_figures(styled, rest, m.shown.fps, evaluator.has_legs()))
    m.metrics.push_back(figure);
}

}  // namespace

void Studio::measure(size_t k) {
  const int64_t id = background_->take_ids[k];
  const TakeState& take = session_.takes[k];
  auto m = std::make_shared<Measuring>();
  m->source = source_as_read(session_);
  m->blender = blender_;
  if (session_.document.flat) m->lifter = services_.lifter;
  m->edits = session_.document.scan_edits;
  m->shown = take.shown;
  m->joints = take.joints;
  m->kept = performed_by(session_, k);
  for (const KeptFrame& frame : take.performed)
    m->source_joints.push_back(frame.source), m->limbs.push_back(frame.limbs);
  if (m->kept.size() < std::min(m->shown.poses.size(), m->source_joints.size())) return;
  m->character = take.character;
  m->deformer = take.deformer;
  const Take& of = session_.document.takes[k];
  if (of.method.style.any() || of.pose_edits.tempo)  // a trim that leaves nothing has none
    failure_of([&] { m->moments = moments_of(session_, k); });
  m->truth = truth_of(session_, k);
  const int64_t generation = take.generation;
  Background::Applied& applied = background_->applied[id];
  applied.measuring = jobs_.start(
      "Measuring " + session_.document.takes[k].name, [m](JobControl& control) { evaluate_all(*m, control); },
      [this, id, m, generation] {
        TakeState* const state = take_of(id);
        if (!state) return;
        background_->applied[id].measuring = 0;
        if (state->generation != generation) return;
        merge_series(state->series, std::move(m->series));
        state->metrics = std::move(m->metrics);
      });
}

void Studio::take_in_results() {
  Background& b = *background_;
  session_.working = b.engine.working();
  for (EngineEvent& event : b.engine.drain()) std::visit([this](auto& e) { take_in(e); }, event);
  ask_about_paint();
  ask_about_persons();
  take_in_refined();
  for (size_t k = 0; k < session_.takes.size(); ++k)  // what goes on does so when the last frame is there
    if (session_.document.takes[k].pose_edits.go_on && is_performed(session_, k) &&
        !b.applied[b.take_ids[k]].goes_on)
      b.dirty.insert(b.take_ids[k]);
  refine_dirty();
  for (const JobQueue::Failure& failed : jobs_.drain()) fail(failed.sentence, failed.command);
  for (auto& [id, applied] : b.applied) {  // a measuring that failed or was cancelled is over, too
    const auto views = jobs_.views();
    const bool running = std::any_of(views.begin(), views.end(), [&applied = applied](const JobView& view) {
      return view.id == applied.measuring;
    });
    if (applied.measuring != 0 && !running) applied.measuring = 0;
  }
  if (!session_.working && !session_.paused && !b.people_before.empty())
    b.people_before.clear(), session_.source.people = b.people_now;
  offer_fills();
  follow_bones();
  follow_made_motions();
  follow_second_body();  // whom they may be performed by
  follow_flat();
  measure_finished();
}

int64_t Studio::id_of_take(size_t take) const {
  return background_->take_ids.at(take);
}

int Studio::take_with_id(int64_t id) const {
  const auto& ids = background_->take_ids;
  const auto found = std::find(ids.begin(), ids.end(), id);
  return found == ids.end() ? -1 : static_cast<int>(found - ids.begin());
}

void Studio::pause_work(bool paused) {
  session_.paused = paused;
  background_->engine.pause(paused);
}

void Studio::restart_work() {
  Background& b = *background_;
  b.engine.set_plan(plan_of(session_.document, b.take_ids), /*afresh=*/true);
  session_.working = true;
}

}  // namespace understudy::app
