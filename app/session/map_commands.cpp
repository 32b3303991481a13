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
#include "retarget/motion_space/knot_coder.hpp"

namespace understudy::app {
namespace {

constexpr int kMostAlike = 12;

using LoadCoder = std::function<std::shared_ptr<MotionCoder>()>;

/// What codes steps, loaded when it is first needed; the plain one where there is none. For one job at a
/// time, each of which waits for the one before.
class MapCoder {
 public:
  template <class Use>
  auto use(const LoadCoder& load, const Use& with) {
    const std::lock_guard lock(mutex_);
    if (!coder_) {
      std::string problem = load ? "" : "there is no learned coder of movements";
      if (load) problem = failure_of([&] { coder_ = load(); });
      if (!coder_) log::warn(problem + ": on the map steps are compared pose by pose");
      if (!coder_) coder_ = make_knot_coder();
    }
    return with(*coder_);
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<MotionCoder> coder_;
};

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

void set_map(MapState& state, MotionMap map, const std::string& words) {
  state = {};
  state.words = words;
  state.map = std::make_shared<const MotionMap>(std::move(map));
}

void color_map(MapState& state, MapColour by) {
  state.colour = by;
  state.colouring = state.map ? std::make_shared<const MapColouring>(map_colouring(*state.map, by)) : nullptr;
}

struct Indexing {
  std::vector<std::string> paths;
  std::string index;                // folder
  std::optional<MotionRange> open;  // shown, from no file
  // The job's answer.
  std::shared_ptr<MotionMap> map;
  std::string words;
};

void index_all(Indexing& work, MotionCoder& coder, JobControl& control) {
  StepIndexOptions how;
  how.folder = work.index;
  how.progress = [&](int done, int of) {
    control.check();
    control.progress(of > 0 ? 0.99f * static_cast<float>(done) / static_cast<float>(of) : 0);
  };
  IndexedSteps steps = index_steps(motion_files(work.paths), coder, how);
  log::Tally left_out;
  for (const std::string& problem : steps.problems) left_out.warn(problem);
  for (const std::string& file : steps.without_steps) left_out.warn(file + ": nobody steps in it");
  left_out.finish();
  if (work.open) {
    MappedMotion open;
    open.clip = work.open->motion.clip, open.name = "open motion", open.action = "open";
    open.fps = work.open->motion.motion.fps, open.frames = work.open->last + 1;
    open.rest = work.open->motion.rest;
    open.steps = coded_steps(work.open->motion.motion, open.rest, coder);
    if (!open.steps.empty()) steps.motions.push_back(std::move(open));
  }
  work.words = index_words(steps);
  control.check();
  work.map = std::make_shared<MotionMap>(std::move(steps.motions));
}

void start_indexing(Call& c, const std::shared_ptr<MapCoder>& coder) {
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
      [work, coder, load = c.studio.services().motion_coder](JobControl& control) {
        coder->use(load, [&](MotionCoder& by) { index_all(*work, by, control); });
      },
      [&studio = c.studio, work] {
        MapState& state = studio.session().map;
        const MapColour colour = state.colour;
        set_map(state, std::move(*work->map), work->words);
        color_map(state, colour);
        studio.notify(state.any() ? "On the map: " + work->words
                                  : "Nobody steps in any of these motions: " + work->words,
                      !state.any());
      });
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

void ask_alike(Call& c, const std::shared_ptr<MapCoder>& coder) {
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
      [work, coder, load = c.studio.services().motion_coder](JobControl&) {
        if (work->from_file) work->range.motion = read_file_motion(work->range.path, work->clip);
        work->like = coder->use(
            load, [&](MotionCoder& by) { return like_this(*work->map, work->range, by, kMostAlike); });
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

}  // namespace

void add_map_commands(Commands& commands) {
  const auto coder = std::make_shared<MapCoder>();
  commands.add({"map.index", "Map motions",
                "[FOLDER|FILE ...]: reads all skeletal motions there, and the open one, onto the map"},
               [coder](Call& c) { start_indexing(c, coder); });
  commands.add({"map.color", "Colour the map", "action|speed|duration|file"},
               [](Call& c) { color_map(c.session.map, c.choice<MapColour>(0, "colour", kMapColourNames)); });
  commands.add_edit({"map.take", "Take a step of the map", "STEP: its motion becomes the source"}, take_step);
  commands.add({"map.like", "Find what is alike",
                "FIRST LAST: the steps of the map that are most like those in these frames"},
               [coder](Call& c) { ask_alike(c, coder); });
  commands.add({"map.decode", "Take what lies between", "X Y: a place of the map becomes the source"},
               decode_place);
}

}  // namespace understudy::app
