#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>

#include "app/run/step_index.hpp"
#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/motion_space/motion_window.hpp"
#include "retarget/pipeline/copy_transfer.hpp"
#include "retarget/pipeline/performer.hpp"

namespace understudy::app {
namespace {

constexpr int kMostAlike = 12;

/// What codes movements, loaded when it is first needed. For one job at a time, each of which waits for the
/// one before.
class LoadedEncoders {
 public:
  template <class Use>
  auto use(const StudioServices& services, const Use& with) {
    const std::lock_guard lock(mutex_);
    if (!encoders_) encoders_.emplace(services.motion_coder, services.motion_space);
    return with(*encoders_);
  }

 private:
  std::mutex mutex_;
  std::optional<MapEncoders> encoders_;
};
using Encoders = std::shared_ptr<LoadedEncoders>;

/// What the open document shows, where it comes from no file that holds a skeletal motion: the current take
/// as performed.
std::optional<MotionRange> shown_motion(const Session& session) {
  const TakeState* const take = at_or_null(session.takes, session.selected_take);
  if (take == nullptr || !take->target || take->shown.poses.size() < 2) return std::nullopt;
  MotionRange range;
  range.motion.clip = "1";
  range.motion.motion = take->shown;
  range.motion.rest = take->target->joints;
  range.last = static_cast<int>(ssize(take->shown.poses)) - 1;
  return range;
}

/// Whether the source is a file of skeletal motion as it is.
bool is_of_file(const SourceOptions& source) {
  if (source.path.empty() || !source.motion.empty() || source.blend || source.as_scan || source.fps != 0)
    return false;
  std::error_code failed;
  if (!std::filesystem::exists(source.path, failed)) return false;
  return is_motion_file(source.path) || may_hold_motion(source.path);
}

void color_map(MapState& state, MapColour by) {
  state.colour = by;
  state.colouring = state.map ? std::make_shared<const MapColouring>(map_colouring(*state.map, by)) : nullptr;
}

void show_map(MapState& state, MapOf kind) {
  state.shown = kind;
  state.map = state.maps[static_cast<size_t>(kind)];
  state.like.clear(), state.like_what.clear();
  state.decoded.reset(), state.performance.reset();
  color_map(state, state.colour);
}

struct Indexing {
  std::vector<std::string> paths;
  std::string index;                // folder
  std::optional<MotionRange> open;  // shown, from no file
  // The job's answer.
  std::array<std::shared_ptr<const MotionMap>, 2> maps;
  std::string words;
};

void index_all(Indexing& work, MapEncoders& encoders, JobControl& control) {
  StepIndexOptions how;
  how.folder = work.index;
  how.progress = [&](int done, int of) {
    control.check();
    control.progress(of > 0 ? 0.99f * static_cast<float>(done) / static_cast<float>(of) : 0);
  };
  IndexedSteps steps = index_steps(motion_files(work.paths), encoders, how);
  log::Tally left_out;
  for (const std::string& problem : steps.problems) left_out.warn(problem);
  for (const std::string& file : steps.without_steps) left_out.warn(file + ": nobody steps in it");
  left_out.finish();
  if (work.open) {
    MappedMotion open;
    open.clip = work.open->motion.clip, open.name = "open motion", open.action = "open";
    open.fps = work.open->motion.motion.fps, open.frames = work.open->last + 1;
    open.rest = work.open->motion.rest;
    MappedMotion others = open;
    open.steps = coded_steps(work.open->motion.motion, open.rest, encoders.of(MapOf::Steps));
    others.steps =
        coded_movements(work.open->motion.motion, open.steps, open.rest, encoders.of(MapOf::Others));
    if (!open.steps.empty()) steps.motions.push_back(std::move(open));
    if (!others.steps.empty()) steps.others.push_back(std::move(others));
  }
  work.words = index_words(steps);
  control.check();
  work.maps = {std::make_shared<const MotionMap>(std::move(steps.motions)),
               std::make_shared<const MotionMap>(std::move(steps.others))};
}

/// What was read takes the old maps' place.
void show_indexed(Studio& studio, const Indexing& work) {
  MapState& state = studio.session().map;
  MapOf kind = state.shown;
  state.maps = work.maps, state.words = work.words, state.job = 0;
  for (const MapOf one : {MapOf::Others, MapOf::Steps})
    if (work.maps[static_cast<size_t>(kind)]->size() == 0) kind = one;
  show_map(state, kind);
  studio.notify(state.any() ? "On the map: " + work.words
                            : "Nobody moves in any of these motions for a second: " + work.words,
                !state.any());
}

void start_indexing(Call& c, const Encoders& encoders) {
  const auto work = std::make_shared<Indexing>();
  for (size_t i = 0; i < c.arguments.size(); ++i) work->paths.push_back(c.path(i));
  for (const std::string& path : work->paths)
    US_CHECK(std::filesystem::exists(path), path, ": there is no such file or folder");
  if (is_of_file(c.document.source))
    work->paths.push_back(c.document.source.path);
  else
    work->open = shown_motion(c.session);
  US_CHECK(!work->paths.empty() || work->open, "nothing is open, and no folder of motions was named");
  const std::string& kept = c.studio.services().autosave_folder;
  if (!kept.empty()) work->index = kept + "/steps";
  if (!c.arguments.empty()) remember_folder(c.studio, work->paths[0]);
  if (c.session.map.job != 0) c.studio.jobs().cancel(c.session.map.job);
  c.session.map.job = c.studio.jobs().start(
      "Reading motions",
      [work, encoders, services = c.studio.services()](JobControl& control) {
        encoders->use(services, [&](MapEncoders& by) { index_all(*work, by, control); });
      },
      [&studio = c.studio, work] { show_indexed(studio, *work); });
}

const MotionMap& open_map(const Call& c) {
  US_CHECK(c.session.map.any(), "there is no map yet: a folder of motions is to be read first");
  return *c.session.map.map;
}

int step_number(const Call& c) {
  const MotionMap& map = open_map(c);
  const auto step = c.number<int>(0, "step");
  US_CHECK(step >= 0 && step < map.size(), "there is no step ", step, " on the map, there are ", map.size());
  return step;
}

/// The step plays, over and over.
void play_step(Playback& playback, const MappedStep& step) {
  playback.in = step.first, playback.out = step.last;
  playback.frame = step.first;
  playback.live = false, playback.playing = true;
}

/// Whether a file may hold several animations.
bool has_clips(const std::string& path) {
  const std::string suffix = file_suffix(path);
  return suffix != ".bvh" && suffix != ".npz";
}

void take_step(Call& c) {
  const int number = step_number(c);
  const MotionMap& map = open_map(c);
  const MappedMotion& motion = map.motion_of(number);
  if (!motion.path.empty()) {
    std::error_code failed;
    US_CHECK(std::filesystem::exists(motion.path, failed), motion.path,
             ": there is no such file any more, read the motions of the map again");
    SourceOptions source;
    source.path = motion.path;
    if (has_clips(motion.path)) source.clip = motion.clip;
    if (!same(source, c.document.source)) set_source(c, source);
  }
  play_step(c.session.playback, map.step(number));
  c.label = "Take " + step_words(map, number);
}

void ask_alike(Call& c, const Encoders& encoders) {
  open_map(c);
  struct Asking {
    std::shared_ptr<const MotionMap> map;
    MotionRange range;
    std::string clip;
    bool from_file = false;
    std::vector<NearStep> like;
  };
  const auto work = std::make_shared<Asking>();
  work->map = c.session.map.map;
  work->from_file = is_of_file(c.document.source);
  if (work->from_file) {
    work->range.path = c.document.source.path, work->clip = c.document.source.clip;
  } else {
    auto shown = shown_motion(c.session);
    US_CHECK(shown, "nothing is open whose steps could be compared");
    work->range = std::move(*shown);
  }
  work->range.first = c.number<int>(0, "first frame"), work->range.last = c.number<int>(1, "last frame");
  c.studio.jobs().start(
      "Looking for what is alike",
      [work, encoders, kind = c.session.map.shown, services = c.studio.services()](JobControl&) {
        if (work->from_file) work->range.motion = read_file_motion(work->range.path, work->clip);
        work->like = encoders->use(services, [&](MapEncoders& by) {
          return like_this(*work->map, kind, work->range, by, kMostAlike);
        });
      },
      [&studio = c.studio, work] {
        MapState& state = studio.session().map;
        if (state.map != work->map) return;  // another was read meanwhile
        state.like = work->like;
        state.like_what =
            "frames " + std::to_string(work->range.first) + " to " + std::to_string(work->range.last);
      });
}

/// What lies between steps, as a blend of them: a source like any other.
void decode_place(Call& c) {
  const MotionMap& map = open_map(c);
  const MapPlace place(c.number(0, "x"), c.number(1, "y"));
  const MapBlend blend = map.at(place);
  const std::string words = distance_words(blend.known.distance);
  if (blend.weights.size() == 1) {
    c.studio.run("map.take", {std::to_string(blend.weights[0].first)});
  } else {
    Arguments parts;
    std::string weights;
    for (const auto& [step, weight] : blend.weights) {
      const MappedMotion& motion = map.motion_of(step);
      US_CHECK(!motion.path.empty(), "the open motion is in no file, so it cannot be blended with others");
      US_CHECK(motion.is_longest, motion.name,
               ": is not the longest animation of its file, only that can be blended");
      BlendPart part{motion.path, BlendRange{map.step(step).first, map.step(step).last}, 1, ""};
      parts.push_back(in_words(part));
      append_item(weights, printed("%.4f", static_cast<double>(weight)), ",");
    }
    parts.push_back(weights);
    c.studio.run("source.blend", parts);
  }
  c.session.map.decoded = {place, blend};
  c.studio.notify("This place is " + words, blend.known.distance > kFarFromKnown);
}

/// As one that stands in the middle of where the take is now, and heads as it does.
Outlook stage_of(const TakeState& take, int frame, const std::vector<StepPerformance::Frame>& frames) {
  Outlook stage;
  if (const Pose* const now = at_or_null(take.shown.poses, frame)) stage = Outlook::of(*now);
  const Vec3 way = 0.5f * (frames.front().pose.root + frames.back().pose.root);
  stage.place -= stage.heading * way;
  stage.place.y() = 0;
  return stage;
}

/// A step as a take's target performs it, hands' contacts apart.
std::vector<StepPerformance::Frame> performed(const TakeState& take, const Method& method,
                                              const MappedMotion& motion, const Motion& step) {
  RetargetOptions options = retarget_options(method);
  options.vertices = options.keep_contacts = false;
  Performer performer(*take.target, std::make_shared<CopyTransfer>(), nullptr, options);
  std::vector<StepPerformance::Frame> frames;
  for (const Pose& pose : step.poses) {
    Observation seen;
    static_cast<Extraction&>(seen) = exact_extraction(forward_kinematics(motion.rest, pose));
    const PerformedFrame frame = performer.perform(seen, 1 / step.fps);
    frames.push_back({frame.pose, frame.joints});
  }
  return frames;
}

void perform_step(Call& c) {
  MapState& state = c.session.map;
  if (c.arguments.empty()) return state.performance.reset();
  StepPerformance performance;
  performance.step = step_number(c);
  performance.since = c.session.time;
  const Motion step = motion_of(state.map->step(performance.step));
  performance.fps = step.fps;
  for (size_t k = 0; k < c.session.takes.size(); ++k) {
    const TakeState& take = c.session.takes[k];
    auto& frames = performance.takes.emplace_back();
    if (!take.target || !take.ready) continue;
    frames = performed(take, c.document.takes[k].method, state.map->motion_of(performance.step), step);
    const Outlook stage = stage_of(take, shown_frame(c.session), frames);
    for (StepPerformance::Frame& frame : frames) {
      frame.pose = stage.placed(frame.pose);
      frame.joints = forward_kinematics(take.target->joints, frame.pose).joints;
    }
  }
  state.performance = std::move(performance);
}

}  // namespace

int StepPerformance::frame_at(double time, size_t take) const {
  const auto* const frames = at_or_null(takes, take);
  if (frames == nullptr || frames->empty()) return -1;
  const auto gone = static_cast<int64_t>(std::max(0.0, time - since) * static_cast<double>(fps));
  return static_cast<int>(gone % ssize(*frames));
}

void add_map_commands(Commands& commands) {
  const auto encoders = std::make_shared<LoadedEncoders>();
  commands.add({"map.index", "Map motions",
                "[FOLDER|FILE ...]: reads all skeletal motions there, and the open one, onto the map"},
               [encoders](Call& c) { start_indexing(c, encoders); });
  commands.add(
      {"map.show", "Choose the map", "steps|others: the steps, or movements that are no steps"},
      [](Call& c) { show_map(c.session.map, c.choice<MapOf>(0, "what is on the map", kMapOfNames)); });
  commands.add({"map.perform", "Look at a step",
                "[STEP]: the targets perform it over and over; without one they are as they were"},
               perform_step);
  commands.add({"map.color", "Colour the map", "action|speed|duration|file"},
               [](Call& c) { color_map(c.session.map, c.choice<MapColour>(0, "colour", kMapColourNames)); });
  commands.add_edit({"map.take", "Take a step of the map", "STEP: its motion becomes the source"}, take_step);
  commands.add({"map.like", "Find what is alike",
                "FIRST LAST: the steps of the map that are most like those in these frames"},
               [encoders](Call& c) { ask_alike(c, encoders); });
  commands.add({"map.decode", "Take what lies between", "X Y: a place of the map becomes the source"},
               decode_place);
}

}  // namespace understudy::app
