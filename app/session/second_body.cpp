// The second body, as the document wants it: read, laid on the found rig and made to perform in the
// background; made again where that rig, the body or the matches change.
#include <mutex>

#include "app/run/rig_performance.hpp"
#include "app/session/background.hpp"
#include "app/session/follow.hpp"
#include "app/session/made_motions.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

/// What is performed and by whom, and the answers. The job has its inputs alone; what it tells is locked.
struct SecondBodyJob {
  std::shared_ptr<const DiscoveredRig> first;
  SecondBody wanted;
  std::shared_ptr<const GeneratedMotion> clip;  // null: what was found
  SourceOptions like;
  BoneSearch search;  // as of the first one
  KeypointsLoader load;
  std::shared_ptr<const OtherBody> known_body;   // null: it is still to be read
  std::shared_ptr<const LaidOther> known_other;  // null: still to be laid on the first one

  std::mutex mutex;
  std::string stage;
  // Once it has ended.
  bool ended = false;  // the UI thread's own
  std::shared_ptr<const OtherBody> body;
  std::shared_ptr<const LaidOther> other;
  BoneMatches matches;
  std::shared_ptr<const RiggedMotion> performed;
  Vec3 place = Vec3::Zero();
  std::string problem;
  bool cancelled = false;

  bool reads_as(const SecondBodyJob& o) const {
    return wanted.path == o.wanted.path && same(search, o.search) && same(like, o.like);
  }
};

namespace {

constexpr const char* kCancelled = "Cancelled before the second body performed";

void begin_stage(SecondBodyJob& work, JobControl& control, const char* stage, float share) {
  US_CHECK(!control.cancelled(), kCancelled);
  control.progress(share);
  const std::lock_guard lock(work.mutex);
  work.stage = stage;
}

OtherBody read_body(SecondBodyJob& work, JobControl& control) {
  constexpr float kShare = 0.7f;  // of all
  DiscoveryOptions how = discovery_options(work.search, work.load);
  how.progress = [&](const DiscoveryProgress& at) {
    control.progress(kShare * at.share);
    const std::lock_guard lock(work.mutex);
    work.stage = at.stage;
    return !control.cancelled();
  };
  return other_body(work.wanted.path, work.like, how);
}

/// The first poses beside each other, on the first one's floor.
Vec3 place_beside(const RiggedMotion& first, const RiggedMotion& performed) {
  const auto box_of = [](const RiggedMotion& body) {
    const BoneMotions bones = bone_motions(body.rig, body.motion.poses[0]);
    return extent_of(skinned(body.rig.surface.vertices, body.rig.skin, bones)).value_or(Box{});
  };
  const Box a = box_of(first), b = box_of(performed);
  Vec3 place = 0.5f * (a.low + a.high - b.low - b.high);
  place.x() += 0.5f * kApart * (width_of(a) + width_of(b));
  place.y() = a.low.y() - b.low.y();
  return place;
}

void perform(SecondBodyJob& work, JobControl& control) {
  const RiggedMotion& first = work.first->found;
  begin_stage(work, control, "Reading", 0);
  auto body = work.known_body;
  if (!body) body = std::make_shared<const OtherBody>(read_body(work, control));
  begin_stage(work, control, "Laying", 0.7f);
  work.body = body;  // not a skeleton whose search was cancelled
  work.other = work.known_other;
  if (!work.other) work.other = std::make_shared<const LaidOther>(laid_other(first, *body));
  begin_stage(work, control, "Performing", 0.9f);
  work.matches = matches_of(*work.other, first.rig, work.wanted.matches);
  RigRetargetOptions how;
  if (work.clip) how.motion = &work.clip->motion;
  work.performed = std::make_shared<const RiggedMotion>(
      performed_by(first, work.other->body, work.other->laid, work.matches, how));
  work.place = place_beside(first, *work.performed);
}

void make_perform(SecondBodyJob& work, JobControl& control) {
  try {
    perform(work, control);
  } catch (const std::exception& error) {
    work.cancelled = control.cancelled();
    work.problem = work.cancelled ? kCancelled : error.what();
    if (!work.cancelled && work.problem.find(work.wanted.path) == std::string::npos)
      work.problem = work.wanted.path + ": " + work.problem;
  }
}

/// How its scans are read: as the source's, of which nothing else is known of them.
SourceOptions read_like(const Session& session) {
  SourceOptions like;
  like.import = source_as_read(session).import;
  like.fps = session.document.source.fps;
  like.quiet = true;
  return like;
}

std::string performing_words(const SecondBodyJob& work) {
  const auto count = std::count_if(work.matches.partner.begin(), work.matches.partner.end(),
                                   [](int partner) { return partner >= 0; });
  const std::string& clip = work.wanted.clip;
  return file_name(work.wanted.path) + " performs" + (clip.empty() ? "" : " " + clip) + ": " +
         std::to_string(count) + " of " + std::to_string(work.matches.partner.size()) +
         " bones have a partner";
}

}  // namespace

/// Makes the second body follow the document and what was found; begins the work that is missing.
void Studio::follow_second_body() {
  SecondBodyState& state = session_.second;
  auto& last = background_->second_work;
  const OwnBones& bones = session_.document.bones;
  if (bones.second.path.empty() || !session_.bones.rig) {
    if (state.job != 0) jobs_.cancel(state.job), last.reset();
    state = {};
    return;
  }
  const auto clip = performed_clip(session_);
  if (!bones.second.clip.empty() && !clip) return wait_for_clip();
  const bool is_last = last && last->clip == clip && last->first == session_.bones.rig &&
                       same(last->search, bones.search) && same(last->wanted, bones.second) &&
                       same(last->like, read_like(session_));
  if (!is_last) {
    if (!session_.working) start_second_body();  // how the source is read is known
    return;
  }
  if (last->ended) {
    const bool is_told = !last->problem.empty() && state.problem == last->problem;
    if (!state.other && !is_told) take_in_second_body(*last);  // it is wanted again
    return;
  }
  const std::lock_guard lock(last->mutex);
  state.stage = last->stage;
  for (const JobView& job : jobs_.views())
    if (job.id == state.job) state.share = std::max(0.0f, job.progress);
}

/// The clip is being made, or cannot be.
void Studio::wait_for_clip() {
  SecondBodyState& state = session_.second;
  auto& last = background_->second_work;
  if (state.job != 0) jobs_.cancel(state.job);
  if (last && !last->ended) last.reset();
  const std::string& why = session_.made_motions.problem;
  state = {};
  state.problem = "the clip \"" + session_.document.bones.second.clip + "\" is not made" +
                  (why.empty() ? " yet" : ": " + why);
}

void Studio::start_second_body() {
  SecondBodyState& state = session_.second;
  auto& last = background_->second_work;
  const auto work = std::make_shared<SecondBodyJob>();
  work->first = session_.bones.rig;
  work->wanted = session_.document.bones.second;
  work->clip = performed_clip(session_);
  work->like = read_like(session_);
  work->search = session_.document.bones.search;
  work->load = services_.keypoints;
  if (state.job != 0) jobs_.cancel(state.job);
  const bool is_read = last && last->reads_as(*work);
  if (is_read) work->known_body = last->ended ? last->body : last->known_body;
  if (is_read && last->first == work->first)
    work->known_other = last->ended ? last->other : last->known_other;
  if (work->known_other)  // what is shown stays until the other matches are performed
    state.job = 0, state.problem.clear();
  else
    state = {};
  last = work;
  state.job = jobs_.start(
      "Second body performs", [work](JobControl& control) { make_perform(*work, control); },
      [this, work] { take_in_second_body(*work); });
}

void Studio::take_in_second_body(SecondBodyJob& work) {
  const bool is_new = !std::exchange(work.ended, true);
  if (background_->second_work.get() != &work) return;  // the document wants another by now
  SecondBodyState& state = session_.second;
  state = {};
  state.other = work.other, state.matches = work.matches;
  state.performed = work.performed, state.place = work.place;
  state.problem = work.problem;
  if (!is_new) return;
  if (work.cancelled) return notify(work.problem, true);
  if (work.problem.empty() && !work.known_other)
    notify(performing_words(work), false, {"Fit the view", "view.fit"});
  if (!work.problem.empty() && !asked_for(session_, work.problem)) fail(work.problem, "bones.perform");
}

void Studio::perform_again() {
  if (!session_.second.problem.empty()) background_->second_work.reset();
}

}  // namespace understudy::app
