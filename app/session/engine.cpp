#include "app/session/engine.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "app/session/background_thread.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/pipeline/person_check.hpp"

namespace understudy::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kReplayChunk = 200;  // frames made anew between two looks at the plan

JointFilterOptions filter_options(const Method& method) {
  JointFilterOptions options;
  options.repair_swaps = method.repair_swaps;
  options.smooth = method.smooth_joints;
  options.fix_lengths = method.fix_lengths;
  return options;
}

RetargetOptions retarget_options(const Method& method) {
  RetargetOptions options;
  options.filter = filter_options(method);
  options.root.mode = method.root;
  options.lock_feet = method.lock_feet;
  options.vertices = false;  // made from the poses when they are looked at
  return options;
}

/// Where the networks' weights were doubted; null where they are not asked for any.
std::shared_ptr<const SafeBinding> binding_of(const std::shared_ptr<const Deformer>& deformer) {
  const auto careful = std::dynamic_pointer_cast<const CarefulDeformer>(deformer);
  return careful ? std::shared_ptr<const SafeBinding>(careful, &careful->binding()) : nullptr;
}

/// What one scan gave, kept to be performed again.
struct Extracted {
  Extraction extraction;
  std::optional<BodyGirth> girth;
  bool usable = true;
  std::string problem;
  int points = 0;
  double read_ms = 0, extract_ms = 0;
};

/// One extractor over the source so far.
struct Stream {
  std::unique_ptr<SkeletonExtractor> extractor;
  std::vector<Extracted> frames;
  RecentJoints recent;
  PersonCheck person;
};

/// A take at work.
struct TakeWork {
  Plan::TakePlan plan;
  std::string target_is, method_is, joints_are;
  std::shared_ptr<PreparedCharacter> standing;  // until it is the character
  std::shared_ptr<const PreparedCharacter> character;
  std::unique_ptr<Retargeter> retargeter;
  bool failed = false;
  size_t done = 0;      // frames performed with the present settings
  size_t told_new = 0;  // frames whose times have been told
};

}  // namespace

Plan plan_of(const Document& document, const std::vector<int64_t>& take_ids) {
  Plan plan;
  plan.source = document.source;
  plan.scan_edits = document.scan_edits;
  plan.skeleton_edits = document.skeleton_edits;
  for (size_t k = 0; k < document.takes.size(); ++k) {
    const Take& take = document.takes[k];
    plan.takes.push_back({take_ids[k], take.target, take.method, take.target_edits.joints});
  }
  if (!plan.takes.empty()) plan.extractor = plan.takes[0].method.extractor;
  return plan;
}

struct Engine::Impl {
  explicit Impl(NetworksOf source_of_networks) : networks_of(std::move(source_of_networks)) {
    thread = std::thread([this] { run(); });
  }

  // Shared with the UI thread, under the mutex.
  mutable std::mutex mutex;
  std::condition_variable wake;
  std::optional<Plan> next_plan;
  std::vector<EngineEvent> events;
  bool paused = false, stop = false, busy = false, next_is_afresh = false;
  std::string wanted_source;
  int64_t epoch = 0;  // counts sources

  // The thread's own.
  int64_t own_epoch = 0;  // of the plan at work
  NetworksOf networks_of;
  Plan plan;
  std::string source_is, skeleton_is;
  std::unique_ptr<Source> source;
  std::map<std::string, Stream> streams;
  bool opened = false, ended = false;
  JointFilter filter;
  size_t told = 0;  // frames of the shown stream that have been told
  bool has_faces = false;
  std::vector<TakeWork> takes;
  std::thread thread;

  void run();
  bool advance(std::optional<Plan> wanted, bool afresh);
  void forget_all();
  void give_up(const std::string& problem);
  void tell(EngineEvent event);
  void change_source(const std::string& key, bool afresh);
  bool step();
  void adopt(Plan wanted);
  void close_source();
  void open();
  void adopt_take(TakeWork& take, const Plan::TakePlan& wanted);
  bool stand(TakeWork& take);
  bool prepare(TakeWork& take);
  Stream& stream_of(const std::string& extractor);
  bool read_frame();
  Extracted extracted(Stream& stream, const SourceFrame& frame) const;
  /// Says where the source may be no person.
  void doubt(Stream& stream) const;
  bool tell_source();
  bool perform(TakeWork& take);
};

/// Whether an event says something of the source's frames, which another source makes untrue.
bool of_frames(const EngineEvent& event) {
  return !std::holds_alternative<TakeLoaded>(event) && !std::holds_alternative<TakeReady>(event) &&
         !std::holds_alternative<TakeFailed>(event);
}

void Engine::Impl::tell(EngineEvent event) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (own_epoch == epoch || !of_frames(event)) events.push_back(std::move(event));
}

/// Under the mutex. What is still being made of another source will not be told.
void Engine::Impl::change_source(const std::string& key, bool afresh) {
  if (key == wanted_source && !afresh) return;
  wanted_source = key;
  ++epoch;
  events.erase(std::remove_if(events.begin(), events.end(), of_frames), events.end());
}

void Engine::Impl::run() {
  yield_to_drawing();
  while (true) {
    std::optional<Plan> wanted;
    bool afresh = false;
    {
      std::unique_lock<std::mutex> lock(mutex);
      if (stop) return;
      wanted.swap(next_plan);
      if (wanted) afresh = std::exchange(next_is_afresh, false);
      if (wanted) own_epoch = epoch;
      if (!wanted && paused) {
        wake.wait(lock);
        continue;
      }
    }
    if (advance(std::move(wanted), afresh)) continue;
    std::unique_lock<std::mutex> lock(mutex);
    if (next_plan || stop) continue;
    busy = false;
    wake.wait(lock, [this] { return stop || next_plan; });
  }
}

/// Adopts what is wanted and does a little. False: nothing is left. Never throws: what no step expected ends
/// the work, not the program.
bool Engine::Impl::advance(std::optional<Plan> wanted, bool afresh) {
  try {
    if (afresh) forget_all();
    if (wanted) adopt(std::move(*wanted));
    return step();
  } catch (const std::bad_alloc&) {
    give_up("there is not enough memory to continue");
  } catch (const std::exception& error) {
    give_up(error.what());
  }
  return false;
}

void Engine::Impl::forget_all() {
  takes.clear();
  close_source();
  streams.clear();
  plan = Plan{};
  source_is.clear();
  skeleton_is.clear();
}

void Engine::Impl::give_up(const std::string& problem) {
  forget_all();
  opened = ended = true;
  tell(SourceFailed{problem});
}

/// Brings the thread's state in line with what is wanted; what still fits stays.
void Engine::Impl::adopt(Plan wanted) {
  const std::string source_wanted = key_of(wanted.source, wanted.scan_edits);
  if (source_wanted != source_is) {
    close_source();
    source_is = source_wanted;
  }
  const std::string skeleton_wanted = key_of(wanted.skeleton_edits);
  const bool shown_anew = wanted.extractor != plan.extractor;
  if (skeleton_wanted != skeleton_is || shown_anew) {
    told = 0;
    filter.reset();
  }
  std::vector<TakeWork> kept;
  for (const Plan::TakePlan& want : wanted.takes) {
    TakeWork take;
    for (TakeWork& old : takes)
      if (old.plan.id == want.id) take = std::move(old);
    adopt_take(take, want);
    if (skeleton_wanted != skeleton_is && take.retargeter) {
      take.retargeter->restart();
      take.done = 0;
    }
    kept.push_back(std::move(take));
  }
  takes = std::move(kept);
  skeleton_is = skeleton_wanted;
  plan = std::move(wanted);
}

void Engine::Impl::adopt_take(TakeWork& take, const Plan::TakePlan& wanted) {
  const std::string target_wanted = key_of(wanted.target), method_wanted = key_of(wanted.method),
                    joints_wanted = key_of(wanted.joints);
  if (target_wanted != take.target_is) take.character.reset(), take.standing.reset();
  if (target_wanted != take.target_is || method_wanted != take.method_is) take.told_new = 0;
  if (target_wanted != take.target_is || method_wanted != take.method_is ||
      joints_wanted != take.joints_are) {
    take.retargeter.reset();
    take.failed = false;
    take.done = 0;
  }
  take.plan = wanted;
  take.target_is = target_wanted;
  take.method_is = method_wanted;
  take.joints_are = joints_wanted;
}

void Engine::Impl::close_source() {
  source.reset();
  for (auto& [name, stream] : streams) stream.frames.clear(), stream.recent = {}, stream.person = {};
  opened = ended = has_faces = false;
  told = 0;
  filter.reset();
  for (TakeWork& take : takes) {
    if (take.retargeter) take.retargeter->restart();
    take.done = take.told_new = 0;
  }
}

/// Does a little of what is left, the most urgent first. False: nothing is left.
bool Engine::Impl::step() {
  for (TakeWork& take : takes)
    if (!take.character && !take.standing && !take.failed) return stand(take);
  if (!opened && !plan.source.path.empty()) {
    open();
    return true;
  }
  for (TakeWork& take : takes)
    if (!take.retargeter && !take.failed) return prepare(take);
  if (tell_source()) return true;
  for (TakeWork& take : takes)
    if (perform(take)) return true;
  return read_frame();
}

void Engine::Impl::open() {
  opened = true;
  try {
    source = open_source(plan.source);
    namespace fs = std::filesystem;
    const fs::path path =
        fs::path(plan.source.motion.empty() ? plan.source.path : plan.source.motion).lexically_normal();
    SourceOpened event;
    event.name = (path.has_filename() ? path : path.parent_path()).filename().string();
    event.count = source->count();
    event.fps = source->fps();
    event.clips = source->clips();
    event.clip = source->clip();
    tell(event);
  } catch (const std::exception& error) {
    source.reset();
    ended = true;
    tell(SourceFailed{error.what()});
  }
}

/// Reads a target's file and shows how it came: binding it takes longer.
bool Engine::Impl::stand(TakeWork& take) {
  try {
    take.standing = load_target(take.plan.target);
    auto shown = std::make_shared<Target>();
    shown->mesh = take.standing->surface.mesh;
    tell(TakeLoaded{take.plan.id, std::move(shown)});
  } catch (const std::exception& error) {
    take.failed = true;
    tell(TakeFailed{take.plan.id, error.what()});
  }
  return true;
}

bool Engine::Impl::prepare(TakeWork& take) {
  try {
    Networks networks = networks_of(take.plan.method);
    if (!take.character)
      take.character = bind_target(std::exchange(take.standing, nullptr), take.plan.target, networks);
    Stream& stream = streams[take.plan.method.extractor];
    if (!stream.extractor) stream.extractor = std::move(networks.extractor);
    networks.extractor.reset();
    networks.rest_extractor.reset();
    networks =
        networks_for(std::move(networks), *take.character, on_their_rig(take.plan.target, *take.character));
    const std::shared_ptr<const Deformer> deformer = networks.deformer;
    Target target = take.character->target;
    target.joints = understudy::apply(take.plan.joints, target.joints);
    auto retargeter = std::make_unique<Retargeter>(std::move(networks), retarget_options(take.plan.method));
    retargeter->set_target(target);
    take.retargeter = std::move(retargeter);  // only with a target: without one it can do nothing
    take.done = 0;
    tell(TakeReady{take.plan.id, take.character, std::make_shared<const Target>(std::move(target)), deformer,
                   binding_of(deformer)});
  } catch (const std::exception& error) {
    take.failed = true;
    tell(TakeFailed{take.plan.id, error.what()});
  }
  return true;
}

Stream& Engine::Impl::stream_of(const std::string& extractor) {
  Stream& stream = streams[extractor];
  if (!stream.extractor) {
    Method method;
    method.extractor = extractor;
    stream.extractor = networks_of(method).extractor;
    US_CHECK(stream.extractor, "there is no skeleton extractor '", extractor, "'");
  }
  return stream;
}

Extracted Engine::Impl::extracted(Stream& stream, const SourceFrame& frame) const {
  Extracted result;
  const auto began = Clock::now();
  result.points = static_cast<int>(frame.mesh.vertices.rows());
  result.usable = frame.usable;
  result.problem = frame.problem;
  if (!frame.usable) return result;
  try {
    if (frame.skeleton) {
      result.extraction = *frame.skeleton;
      return result;
    }
    result.extraction = stream.extractor->extract_next(frame.mesh, stream.recent);
    result.extraction.sole_height = sole_height(result.extraction.joints, frame.mesh.vertices);
    result.girth = measure_girth(result.extraction, frame.mesh.vertices);
  } catch (const Error& error) {
    result.usable = false;
    result.problem = error.what();
  }
  result.extract_ms = ms_since(began);
  return result;
}

void Engine::Impl::doubt(Stream& stream) const {
  const Extracted& last = stream.frames.back();
  const std::string why = last.usable ? stream.person.push(last.extraction) : "";
  if (!why.empty()) log::warn(plan.source.path + ": " + why);
}

/// The next scan through every extractor that a take or the view wants. A stream that came later catches up
/// first.
bool Engine::Impl::read_frame() {
  if (!source || plan.source.path.empty()) return false;
  try {
    std::vector<Stream*> wanted{&stream_of(plan.extractor)};
    for (const TakeWork& take : takes) {
      Stream* const stream = &stream_of(take.plan.method.extractor);
      if (std::find(wanted.begin(), wanted.end(), stream) == wanted.end()) wanted.push_back(stream);
    }
    size_t behind = wanted[0]->frames.size();
    bool even = true;
    for (const Stream* stream : wanted) {
      even = even && stream->frames.size() == behind;
      behind = std::min(behind, stream->frames.size());
    }
    if (even && ended) return false;
    if (!even) source->seek(static_cast<int64_t>(behind)), ended = false;
    const auto began = Clock::now();
    auto frame = source->next();
    if (!frame) {
      ended = true;
      return false;
    }
    has_faces = has_faces || !frame->mesh.is_cloud();
    if (frame->usable) frame->mesh = understudy::apply(plan.scan_edits, frame->mesh);
    const double read_ms = ms_since(began);
    for (Stream* stream : wanted)
      if (stream->frames.size() == behind) {
        stream->frames.push_back(extracted(*stream, *frame));
        stream->frames.back().read_ms = read_ms;
        doubt(*stream);
      }
    return true;
  } catch (const std::exception& error) {
    source.reset();
    tell(SourceFailed{error.what()});
    return true;
  }
}

/// Tells what was extracted and has not been told: edited, repaired, smoothed.
bool Engine::Impl::tell_source() {
  const auto found = streams.find(plan.extractor);
  if (found == streams.end() || told >= found->second.frames.size()) return false;
  const std::vector<Extracted>& frames = found->second.frames;
  SourceFrames event;
  event.first = static_cast<int>(told);
  event.decision = source ? source->decision() : "";
  if (source) event.to_file = source->to_file();
  event.has_faces = has_faces;
  const float dt = source ? static_cast<float>(1 / source->fps()) : 1 / 30.0f;
  for (int n = 0; n < kReplayChunk && told < frames.size(); ++n, ++told) {
    const Extracted& frame = frames[told];
    KeptSource kept;
    kept.raw = frame.extraction.joints;
    kept.points = frame.points;
    kept.flagged = !frame.usable;
    kept.reason = frame.problem;
    if (frame.usable) {
      kept.confidence_of = frame.extraction.confidence;
      kept.confidence = frame.extraction.confidence.mean();
      kept.joints =
          filter.push(understudy::apply(plan.skeleton_edits, frame.extraction, static_cast<int>(told)), dt)
              .joints;
    } else if (!event.frames.empty()) {
      kept.joints = event.frames.back().joints;
    }
    event.frames.push_back(std::move(kept));
  }
  tell(std::move(event));
  return true;
}

bool Engine::Impl::perform(TakeWork& take) {
  const std::vector<Extracted>& frames = streams[take.plan.method.extractor].frames;
  if (!take.retargeter || take.done >= frames.size()) return false;
  TakeFrames event;
  event.id = take.plan.id;
  event.first = static_cast<int>(take.done);
  const float dt = source ? static_cast<float>(1 / source->fps()) : 1 / 30.0f;
  for (int n = 0; n < kReplayChunk && take.done < frames.size(); ++n, ++take.done) {
    const Extracted& frame = frames[take.done];
    const RetargetedFrame result =
        frame.usable ? take.retargeter->push(understudy::apply(plan.skeleton_edits, frame.extraction,
                                                               static_cast<int>(take.done)),
                                             dt, frame.girth ? &*frame.girth : nullptr)
                     : take.retargeter->skip(frame.problem, dt);
    event.frames.push_back(kept(result));
    if (take.done < take.told_new) continue;
    take.told_new = take.done + 1;
    event.times.push_back({frame.read_ms, frame.extract_ms, result.ms.transfer, result.ms.deform,
                           frame.read_ms + frame.extract_ms + result.ms.transfer + result.ms.deform});
  }
  tell(std::move(event));
  return true;
}

Engine::Engine(NetworksOf networks) : impl_(std::make_unique<Impl>(std::move(networks))) {}

Engine::~Engine() {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->wake.notify_all();
  impl_->thread.join();
}

void Engine::set_plan(Plan plan, bool afresh) {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->next_is_afresh = impl_->next_is_afresh || afresh;  // the plan before may not have been seen yet
    impl_->change_source(key_of(plan.source, plan.scan_edits), afresh);
    impl_->next_plan = std::move(plan);
    impl_->busy = true;
  }
  impl_->wake.notify_all();
}

void Engine::pause(bool paused) {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    impl_->paused = paused;
  }
  impl_->wake.notify_all();
}

std::vector<EngineEvent> Engine::drain() {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return std::exchange(impl_->events, {});
}

bool Engine::working() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->busy;
}

}  // namespace understudy::app
