#include "app/session/engine.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "app/run/retargeted_source.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/base/worker.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"

namespace understudy::app {
namespace {

constexpr int kReplayChunk = 200;  // frames made anew between two looks at the plan

/// Vertices are made from the poses when they are looked at.
RetargetOptions poses_only(const Method& method) {
  RetargetOptions options = retarget_options(method);
  options.vertices = false;
  return options;
}

RetargetOptions options_of(const Plan::TakePlan& take) {
  RetargetOptions options = poses_only(take.method);
  if (!take.rest_pose.empty()) options.rest_pose = rest_rotations(take.rest_pose);
  return options;
}

/// Where the networks' weights are uncertain; null where no network binds.
std::shared_ptr<const SafeBinding> binding_of(const std::shared_ptr<const Deformer>& deformer) {
  const auto careful = std::dynamic_pointer_cast<const CarefulDeformer>(deformer);
  return careful ? std::shared_ptr<const SafeBinding>(careful, &careful->binding()) : nullptr;
}

/// What was seen in one frame, kept to be performed again.
struct Seen {
  Observation observation;
  double read_ms = 0;
  std::optional<Box> extent;  // of the scan before any edit
  int person = 0;             // as KeptSource's, with the owners
  std::shared_ptr<const KeptOwners> owners;
};

/// Whose skeletons are extracted, and how.
struct Whom {
  Method method;
  std::string person;  // as SourceOptions'
  std::string key() const { return extraction_key(method) + '\n' + person; }
};

/// One person over the source so far, as one extractor sees them.
struct Stream {
  std::shared_ptr<SkeletonExtractor> extractor;  // null: nothing has asked for it yet
  std::optional<PersonCut> cut;                  // none before the first scan
  std::optional<Observer> observer;              // none before the first frame
  std::vector<Seen> frames;
};

/// A take at work.
struct TakeWork {
  Plan::TakePlan plan;
  std::string target_is, networks_are, method_is, joints_are, rest_is;
  Whom wants() const { return {plan.method, plan.person}; }
  std::shared_ptr<PreparedCharacter> loaded;  // until it is the character
  std::shared_ptr<const PreparedCharacter> character;
  std::optional<Performer> performer;
  std::optional<StyledStream> styled;  // none before the first frame
  bool failed = false;
  size_t fed = 0;         // frames that the style has been given
  size_t done = 0;        // frames performed with the present settings
  size_t sent_times = 0;  // frames whose times have been sent
};

}  // namespace

Plan plan_of(const Document& document, const std::vector<int64_t>& take_ids) {
  Plan plan;
  if (!document.flat || performs_in_space(document)) plan.source = document.source;
  plan.scan_edits = in_effect(document.scan_edits);
  plan.skeleton_edits = document.skeleton_edits;
  for (size_t k = 0; k < document.takes.size(); ++k) {
    const Take& take = document.takes[k];
    if (take.flat) continue;
    plan.takes.push_back({take_ids[k], person_of(document, take), take.target, take.method,
                          take.target_edits.joints, take.target_edits.rest_pose});
  }
  const size_t by = take_of_source(document);
  if (by < document.takes.size()) plan.shown_by = take_ids[by];
  if (by < document.takes.size())
    plan.shown = document.takes[by].method;
  else if (!plan.takes.empty())
    plan.shown = plan.takes.front().method;
  return plan;
}

struct Engine::Impl {
  Impl(NetworksOf source_of_networks, std::shared_ptr<MotionBlender> of_blends, SourceTools tools_of_sources)
      : networks_of(std::move(source_of_networks)),
        blender(std::move(of_blends)),
        tools(std::move(tools_of_sources)) {}

  // Shared with the UI thread, under the worker's mutex.
  std::optional<Plan> next_plan;
  std::vector<EngineEvent> events;
  bool paused = false, busy = false, next_is_afresh = false;
  std::string wanted_source;
  int64_t epoch = 0;  // counts sources

  // The worker's own.
  bool rests = true;      // nothing is left of the plan at work
  int64_t own_epoch = 0;  // of the plan at work
  NetworksOf networks_of;
  std::shared_ptr<MotionBlender> blender;
  SourceTools tools;
  Plan plan;
  std::string source_is, skeleton_is;
  std::unique_ptr<Source> source;
  std::map<std::string, Stream> streams;
  bool opened = false, ended = false;
  size_t sent = 0;                 // frames of the shown stream that have been sent
  std::optional<Performer> alone;  // repairs and smooths what is shown where no take does
  bool has_faces = false, any_usable = false;
  std::string unusable;  // why the last frame is that cannot be used
  std::string doubt;     // why the source may be no person; empty once sent
  std::vector<TakeWork> takes;
  Worker worker{"retargeting", [this] { return next(); }};

  Worker::Task next();
  bool advance(std::optional<Plan> wanted, bool afresh);
  void forget_all();
  void give_up(const std::string& problem);
  void emit(EngineEvent event);
  void change_source(const std::string& key, bool afresh);
  bool step();
  void adopt(Plan wanted);
  void close_source();
  static void start_anew(TakeWork& take);
  bool has_work(TakeWork& take);
  std::optional<TimedObservation> next_styled(TakeWork& take);
  void open();
  void adopt_take(TakeWork& take, const Plan::TakePlan& wanted);
  template <class Work>
  bool of_take(TakeWork& take, Work work);
  void load(TakeWork& take);
  void prepare(TakeWork& take);
  TakeWork* next_to_prepare();
  Whom shown() const { return {plan.shown, plan.source.person}; }
  Stream& stream_of(const Whom& whom) { return streams[whom.key()]; }
  const std::shared_ptr<SkeletonExtractor>& extractor_of(const Whom& whom);
  std::vector<Whom> wanted_streams() const;
  bool read_frame();
  std::string nothing_in_it() const;
  Observer& observer_of(const Whom& whom);
  void observe(const SourceFrame& frame, const Whom& whom, double read_ms);
  Seen seen_in(const SourceFrame& frame, const Whom& whom, double read_ms);
  float interval() const;
  Observation edited(const Seen& seen, const Whom& whom, size_t frame) const;
  bool send_source();
  void perform(TakeWork& take);
};

/// Whether an event is about the source's frames, so that another source invalidates it.
bool of_frames(const EngineEvent& event) {
  return !std::holds_alternative<TakeLoaded>(event) && !std::holds_alternative<TakeReady>(event) &&
         !std::holds_alternative<TakeFailed>(event);
}

void Engine::Impl::emit(EngineEvent event) {
  const auto held = worker.lock();
  if (own_epoch == epoch || !of_frames(event)) events.push_back(std::move(event));
}

/// Under the mutex. Frames still in work for another source are dropped.
void Engine::Impl::change_source(const std::string& key, bool afresh) {
  if (key == wanted_source && !afresh) return;
  wanted_source = key;
  ++epoch;
  events.erase(std::remove_if(events.begin(), events.end(), of_frames), events.end());
}

Worker::Task Engine::Impl::next() {
  if (!next_plan && (paused || rests)) return nullptr;
  const bool afresh = next_plan && std::exchange(next_is_afresh, false);
  if (next_plan) own_epoch = epoch;
  return [this, afresh, wanted = std::exchange(next_plan, std::nullopt)]() mutable {
    const bool more = advance(std::move(wanted), afresh);
    const auto held = worker.lock();
    rests = !more;
    if (!more && !next_plan) busy = false;
  };
}

/// Adopts what is wanted and does a little. False: nothing is left. Never throws: what no step expected ends
/// the work, not the program.
bool Engine::Impl::advance(std::optional<Plan> wanted, bool afresh) {
  bool more = false;
  const std::string problem = failure_of([&] {
    if (afresh) forget_all();
    if (wanted) adopt(std::move(*wanted));
    more = step();
  });
  if (!problem.empty()) give_up(problem);
  return more;
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
  emit(SourceFailed{problem});
}

/// Brings the thread's state in line with what is wanted; what still fits stays.
void Engine::Impl::adopt(Plan wanted) {
  const std::string source_wanted = key_of(wanted.source, wanted.scan_edits);
  if (source_wanted != source_is) {
    close_source();
    source_is = source_wanted;
  }
  const std::string skeleton_wanted = key_of(wanted.skeleton_edits);
  const bool another_take = plan.shown_by != 0 && plan.shown_by != wanted.shown_by;
  if (skeleton_wanted != skeleton_is || extraction_key(wanted.shown) != extraction_key(plan.shown) ||
      another_take)
    sent = 0;
  std::vector<TakeWork> kept;
  for (const Plan::TakePlan& want : wanted.takes) {
    TakeWork take;
    for (TakeWork& old : takes)
      if (old.plan.id == want.id) take = std::move(old);
    adopt_take(take, want);
    if (skeleton_wanted != skeleton_is) start_anew(take);
    kept.push_back(std::move(take));
  }
  takes = std::move(kept);
  skeleton_is = skeleton_wanted;
  plan = std::move(wanted);
  std::map<std::string, Stream> still_wanted;  // what only removed takes used is dropped
  for (const Whom& whom : wanted_streams()) still_wanted.insert(streams.extract(whom.key()));
  streams = std::move(still_wanted);
}

void Engine::Impl::adopt_take(TakeWork& take, const Plan::TakePlan& wanted) {
  const std::string target_wanted = key_of(wanted.target), method_wanted = key_of(wanted.method),
                    networks_wanted = networks_key(wanted.method), joints_wanted = key_of(wanted.joints),
                    rest_wanted = key_of(wanted.rest_pose);
  const bool another = wanted.person != take.plan.person;
  if (target_wanted != take.target_is) take.character.reset(), take.loaded.reset();
  if (target_wanted != take.target_is || method_wanted != take.method_is || another) take.sent_times = 0;
  const bool bound = target_wanted == take.target_is && networks_wanted == take.networks_are &&
                     joints_wanted == take.joints_are;
  if (!bound || another || method_wanted != take.method_is || rest_wanted != take.rest_is) {
    if (!bound) take.performer.reset();
    take.failed = false;
    start_anew(take);
    if (take.performer) take.performer->restart(options_of(wanted));
  }
  take.plan = wanted;
  take.target_is = target_wanted;
  take.networks_are = networks_wanted;
  take.method_is = method_wanted;
  take.joints_are = joints_wanted;
  take.rest_is = rest_wanted;
}

void Engine::Impl::close_source() {
  source.reset();
  for (auto& [name, stream] : streams) stream.frames.clear(), stream.observer.reset(), stream.cut.reset();
  opened = ended = has_faces = any_usable = false;
  unusable.clear();
  doubt.clear();
  sent = 0;
  for (TakeWork& take : takes) {
    start_anew(take);
    take.sent_times = 0;
  }
}

/// Its frames from the first one on.
void Engine::Impl::start_anew(TakeWork& take) {
  if (take.performer) take.performer->restart();
  take.styled.reset();
  take.fed = take.done = 0;
}

/// Does a little of what is left, the most urgent first. False: nothing is left.
bool Engine::Impl::step() {
  for (TakeWork& take : takes)
    if (!take.character && !take.loaded && !take.failed) return of_take(take, [&] { load(take); });
  if (!opened && !plan.source.path.empty()) {
    open();
    return true;
  }
  if (TakeWork* const take = next_to_prepare()) return of_take(*take, [&] { prepare(*take); });
  if (send_source()) return true;
  for (TakeWork& take : takes)
    if (has_work(take)) return of_take(take, [&] { perform(take); });
  return read_frame();
}

/// Binding takes a second: the take that is looked at comes first, and what is bound performs its first frame
/// before the next one is. Null: none, now.
TakeWork* Engine::Impl::next_to_prepare() {
  const auto waits = [](const TakeWork& take) { return !take.performer && !take.failed; };
  auto next = std::find_if(takes.begin(), takes.end(),
                           [&](const TakeWork& take) { return waits(take) && take.plan.id == plan.first; });
  if (next == takes.end()) next = std::find_if(takes.begin(), takes.end(), waits);
  const bool has_frames = source && !ended;
  const bool first_comes = has_frames && std::any_of(takes.begin(), takes.end(), [](const TakeWork& take) {
                             return take.performer && take.done == 0;
                           });
  return next == takes.end() || first_comes ? nullptr : &*next;
}

/// Works for one take; an error ends that take alone.
template <class Work>
bool Engine::Impl::of_take(TakeWork& take, Work work) {
  bool not_a_person = false;
  const std::string problem = failure_of([&] {
    try {
      work();
    } catch (const NotAPersonError&) {
      not_a_person = true;
      throw;
    }
  });
  if (problem.empty()) return true;
  take.failed = true;
  take.performer.reset();
  emit(TakeFailed{take.plan.id, problem, !take.character && !take.loaded, not_a_person});
  return true;
}

void Engine::Impl::open() {
  opened = true;
  try {
    SourceOptions options = plan.source;
    if (options.complete > 0) options.edits = plan.scan_edits;
    source = open_source(options, blender.get());
    source->set_look([this](const Mesh& scan) { return observer_of(shown()).look(scan); });
    source->set_tools({[this] { return extractor_of(shown()); }, tools.space, tools.lifter,
                       [this](float share) {
                         emit(SourceCompleting{share});
                         const auto held = worker.lock();
                         US_CHECK(own_epoch == epoch, plan.source.path, ": is no longer wanted");
                       }});
    SourceOpened event;
    event.name = name_of(plan.source);
    event.count = source->count();
    event.fps = source->fps();
    event.clips = source->clips();
    event.clip = source->clip();
    emit(event);
  } catch (const std::exception& error) {
    source.reset();
    ended = true;
    emit(SourceFailed{error.what(), dynamic_cast<const CanvasUnknownError*>(&error) != nullptr});
  }
}

/// Reads a target's file and shows how it came: binding it takes longer.
void Engine::Impl::load(TakeWork& take) {
  take.loaded = load_target(take.plan.target);
  auto shown = std::make_shared<Target>();
  shown->mesh = take.loaded->surface.mesh;
  emit(TakeLoaded{take.plan.id, std::move(shown)});
}

void Engine::Impl::prepare(TakeWork& take) {
  const Method& method = take.plan.method;
  NetworkParts parts = NetworkParts::performers();
  const bool looked_at = !take.character && needs_extractor(take.plan.target, *take.loaded);
  parts.rest_extractor = looked_at;
  parts.style = false;
  Networks networks = networks_of(method, parts);
  if (looked_at) networks.extractor = extractor_of(take.wants());
  if (!take.character)
    take.character = bind_target(std::exchange(take.loaded, nullptr), take.plan.target, networks);
  networks =
      networks_for(std::move(networks), *take.character, on_their_rig(take.plan.target, *take.character));
  Target target = take.character->target;
  target.joints = understudy::apply(take.plan.joints, target.joints);
  take.performer.emplace(target, networks.transfer, networks.deformer, options_of(take.plan));
  start_anew(take);
  emit(TakeReady{take.plan.id, take.character, std::make_shared<const Target>(std::move(target)),
                 networks.deformer, binding_of(networks.deformer)});
}

/// Streams of one method share it.
const std::shared_ptr<SkeletonExtractor>& Engine::Impl::extractor_of(const Whom& whom) {
  const Method& method = whom.method;
  auto& extractor = stream_of(whom).extractor;
  for (const auto& [key, stream] : streams)
    if (!extractor && key.rfind(extraction_key(method) + '\n', 0) == 0) extractor = stream.extractor;
  if (!extractor) {
    NetworkParts parts;
    parts.extractor = true;
    extractor = networks_of(method, parts).extractor;
    US_CHECK(extractor, "there is no skeleton extractor '", method.extractor, "'");
  }
  return extractor;
}

/// All that the view or a take needs.
std::vector<Whom> Engine::Impl::wanted_streams() const {
  std::map<std::string, Whom> wanted{{shown().key(), shown()}};
  for (const TakeWork& take : takes)
    if (!take.failed) wanted.emplace(take.wants().key(), take.wants());
  std::vector<Whom> all;
  all.reserve(wanted.size());
  for (auto& [key, whom] : wanted) all.push_back(std::move(whom));
  return all;
}

/// The next frame, seen by every stream that is wanted. One that came later catches up first.
bool Engine::Impl::read_frame() {
  if (!source || plan.source.path.empty()) return false;
  try {
    const std::vector<Whom> wanted = wanted_streams();
    size_t behind = stream_of(shown()).frames.size();
    bool even = true;
    for (const Whom& whom : wanted) {
      const size_t seen = stream_of(whom).frames.size();
      even = even && seen == behind;
      behind = std::min(behind, seen);
    }
    if (even && ended) return false;
    if (!even) source->seek(static_cast<int64_t>(behind)), ended = false;
    const auto began = std::chrono::steady_clock::now();
    auto frame = source->next();
    if (!frame) {
      ended = true;
      if (!any_usable) emit(SourceFailed{nothing_in_it()});
      return false;
    }
    any_usable = any_usable || frame->usable;
    if (!frame->usable) unusable = frame->problem;
    has_faces = has_faces || !frame->mesh.is_cloud();
    const std::optional<Box> extent = frame->usable ? extent_of(frame->mesh.vertices) : std::nullopt;
    if (frame->usable && plan.source.complete <= 0)
      frame->mesh = understudy::apply(plan.scan_edits, frame->mesh);
    const double read_ms = ms_since(began);
    for (const Whom& whom : wanted) {
      Stream& stream = stream_of(whom);
      if (stream.frames.size() != behind) continue;
      observe(*frame, whom, read_ms);
      if (stream.frames.size() > behind) stream.frames.back().extent = extent;
    }
    return true;
  } catch (const std::exception& error) {
    source.reset();
    ended = true;  // what a style holds back comes yet
    emit(SourceFailed{error.what()});
    return true;
  }
}

/// Of a source that has ended.
std::string Engine::Impl::nothing_in_it() const {
  const std::string& path = plan.source.motion.empty() ? plan.source.path : plan.source.motion;
  return unusable.empty() ? path + ": has no frames" : path + ": no frame in it could be used: " + unusable;
}

/// Of scans, where none was made for skeletons.
Observer& Engine::Impl::observer_of(const Whom& whom) {
  std::optional<Observer>& observer = stream_of(whom).observer;
  if (!observer) observer.emplace(extractor_of(whom));
  return *observer;
}

/// Takes whose extractor cannot be had end here; where it is the view's, too, the source does.
void Engine::Impl::observe(const SourceFrame& frame, const Whom& whom, double read_ms) {
  Stream& stream = stream_of(whom);
  try {
    if (frame.skeleton && !stream.observer) stream.observer.emplace();
    observer_of(whom);
  } catch (const std::exception&) {
    for (TakeWork& take : takes)
      if (take.wants().key() == whom.key()) of_take(take, [] { throw; });
    if (shown().key() == whom.key()) throw;
    return;
  }
  stream.frames.push_back(seen_in(frame, whom, read_ms));
  const std::string& warning = stream.frames.back().observation.warning;
  if (!warning.empty()) doubt = warning;
}

/// Of the person who is cut out of it, where it is a scan.
Seen Engine::Impl::seen_in(const SourceFrame& frame, const Whom& whom, double read_ms) {
  Stream& stream = stream_of(whom);
  Seen seen;
  seen.read_ms = read_ms;
  if (!frame.usable || frame.skeleton) {
    seen.observation = observed(*stream.observer, frame, interval());
    return seen;
  }
  const auto began = std::chrono::steady_clock::now();
  if (!stream.cut) {
    SourceOptions options = plan.source;
    options.person = whom.person;
    options.edits = plan.scan_edits;
    options.quiet = true;  // the studio tells
    stream.cut.emplace(stream.extractor, options);
  }
  SourceFrame part = frame;
  stream.cut->apply(part, *source, ssize(stream.frames) + 1);
  seen.person = stream.cut->person();
  seen.owners = KeptOwners::of(frame.mesh.vertices, stream.cut->scene(), seen.person);
  seen.read_ms += ms_since(began);
  seen.observation = observed(*stream.observer, part, interval());
  if (part.usable) stream.cut->tell(seen.observation);
  return seen;
}

/// Seconds between two frames.
float Engine::Impl::interval() const {
  return source ? static_cast<float>(1 / source->fps()) : 1 / 30.0f;
}

/// As the user corrected it, who sees the source's own person alone.
Observation Engine::Impl::edited(const Seen& seen, const Whom& whom, size_t frame) const {
  Observation result = seen.observation;
  if (result.problem.empty() && whom.person == plan.source.person)
    static_cast<Extraction&>(result) = understudy::apply(plan.skeleton_edits, result, frame);
  return result;
}

/// What the session keeps of a frame. joints: repaired and smoothed.
KeptSource kept_source(const Seen& frame, const Observation& edited, const Joints& joints) {
  KeptSource kept;
  kept.raw = frame.observation.joints;
  kept.raw_confidence = frame.observation.confidence;
  kept.visibility = edited.visibility;
  kept.exact = frame.observation.exact;
  kept.points = static_cast<int>(edited.points);
  kept.extent = frame.extent;
  kept.person = frame.person;
  kept.owners = frame.owners;
  kept.reason = refusal(edited);
  kept.flagged = !kept.reason.empty();
  if (!kept.flagged) kept.confidence_of = edited.confidence;
  kept.confidence = kept.flagged ? 0 : mean_confidence(edited);
  kept.joints = joints;
  return kept;
}

/// Reports the frames seen since the last call. The first take of the source's own person repairs and smooths
/// them and reports the result; without such a take this does.
bool Engine::Impl::send_source() {
  const std::vector<Seen>& frames = stream_of(shown()).frames;
  const bool no_take = std::none_of(takes.begin(), takes.end(), [this](const TakeWork& take) {
    return take.plan.id == plan.shown_by && !take.failed;
  });
  if (no_take && !alone) {
    alone.emplace(poses_only(plan.shown));
    sent = 0;
  }
  if (!no_take) alone.reset();
  if (sent >= frames.size()) return false;
  if (sent == 0 && alone) alone->restart();
  SourceFrames event;
  event.first = sent;
  event.decision = source ? source->decision() : "";
  if (source) event.to_file = source->to_file(), event.import = source->import(), event.made = source->made();
  event.has_faces = has_faces;
  event.doubt = std::exchange(doubt, {});
  if (const auto& cut = stream_of(shown()).cut)
    event.people = cut->people(), event.person = cut->person(), event.left_out = cut->scene().left_out;
  for (int n = 0; n < kReplayChunk && sent < frames.size(); ++n, ++sent) {
    const Observation seen = edited(frames[sent], shown(), sent);
    const Joints joints = alone ? alone->perform(seen, interval()).source.joints : seen.joints;
    event.frames.push_back(kept_source(frames[sent], seen, joints));
  }
  emit(std::move(event));
  return true;
}

/// Frames that a style lets come later come when more are read, or there are no more.
bool Engine::Impl::has_work(TakeWork& take) {
  const size_t count = stream_of(take.wants()).frames.size();
  return take.performer && take.done < count && (take.fed < count || ended);
}

/// The next observation as the take's style has it; none where more must be read first.
std::optional<TimedObservation> Engine::Impl::next_styled(TakeWork& take) {
  const Whom whom = take.wants();
  const std::vector<Seen>& frames = stream_of(whom).frames;
  if (!take.styled) {
    NetworkParts style;
    style.style = true;
    const bool any = take.plan.method.style.any();
    take.styled.emplace(any ? networks_of(take.plan.method, style).style : nullptr,
                        options_of(take.plan).filter);
  }
  bool finished = false;
  while (take.done < frames.size()) {
    std::optional<TimedObservation> next = take.styled->pop();
    if (next || (!ended && take.fed == frames.size())) return next;
    US_CHECK(!finished, "the style gives fewer frames than it was given");
    if (take.fed < frames.size()) {
      take.styled->push(edited(frames[take.fed], whom, take.fed), interval());
      ++take.fed;
    } else {
      take.styled->finish();
      finished = true;
    }
  }
  return std::nullopt;
}

void Engine::Impl::perform(TakeWork& take) {
  const Whom whom = take.wants();
  const std::vector<Seen>& frames = stream_of(whom).frames;
  TakeFrames event;
  event.id = take.plan.id;
  event.first = static_cast<int>(take.done);
  for (int n = 0; n < kReplayChunk; ++n, ++take.done) {
    const std::optional<TimedObservation> styled = next_styled(take);
    if (!styled) break;
    const Seen& seen = frames[take.done];
    const PerformedFrame result = take.performer->perform(styled->seen, styled->dt);
    event.frames.push_back(kept(result));
    if (whom.person != plan.source.person)
      event.seen.push_back(kept_source(seen, edited(seen, whom, take.done), event.frames.back().source));
    if (!result.warning.empty()) event.warning = result.warning;
    if (take.done < take.sent_times) continue;
    take.sent_times = take.done + 1;
    const double extract_ms = seen.observation.extract_ms;
    event.times.push_back({seen.read_ms, extract_ms, result.transfer_ms, result.deform_ms,
                           seen.read_ms + extract_ms + result.transfer_ms + result.deform_ms});
  }
  if (event.frames.empty()) return;
  event.rights = take.styled->rights();
  emit(std::move(event));
}

Engine::Engine(NetworksOf networks, std::shared_ptr<MotionBlender> blender, SourceTools tools)
    : impl_(std::make_unique<Impl>(std::move(networks), std::move(blender), std::move(tools))) {}

Engine::~Engine() {
  const auto held = impl_->worker.lock();
  ++impl_->epoch;
}

void Engine::set_plan(Plan plan, bool afresh) {
  const auto held = impl_->worker.lock();
  impl_->next_is_afresh = impl_->next_is_afresh || afresh;  // the plan before may not have been seen yet
  impl_->change_source(key_of(plan.source, plan.scan_edits), afresh);
  impl_->next_plan = std::move(plan);
  impl_->busy = true;
  impl_->worker.wake();
}

void Engine::pause(bool paused) {
  const auto held = impl_->worker.lock();
  impl_->paused = paused;
  impl_->worker.wake();
}

std::vector<EngineEvent> Engine::drain() {
  const auto held = impl_->worker.lock();
  return std::exchange(impl_->events, {});
}

bool Engine::working() const {
  const auto held = impl_->worker.lock();
  return impl_->busy;
}

}  // namespace understudy::app
