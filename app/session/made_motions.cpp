// Further motions of the found rig: made when the user asks for them, and the document's clips made again
// where they, the rig or its edits change; in the background.
#include "app/session/made_motions.hpp"

#include <algorithm>

#include "app/session/background.hpp"
#include "app/session/follow.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

/// What is to be made, and the answers. The job has its inputs alone.
struct MotionsJob {
  std::shared_ptr<const DiscoveredRig> rig;
  std::string name;                       // of the rig, in sentences
  std::vector<GenerationOptions> wanted;  // one motion each
  DynamicsLoader load;
  // Once it has ended.
  std::vector<MadeMotion> made;
  std::string remark, problem;
  bool cancelled = false;
};

namespace {

constexpr size_t kMotionsKept = 200;  // so many are undone and kept without being made once more

/// Between frames of the rig's own motion.
GenerationOptions of_rig(const DiscoveredRig& rig, GenerationOptions how) {
  if (!how.between) return how;
  for (const int frame : {how.between->first, how.between->last})
    US_CHECK(frame_of_rig(rig, frame) >= 0, "the found rig has no frame ", frame,
             " to make a motion between");
  how.between->first -= rig.first_frame, how.between->last -= rig.first_frame;
  return how;
}

void make_one(MotionsJob& work, const RiggedMotion& known, const GenerationOptions& how) {
  GeneratedMotions all = generate_motions(
      known, of_rig(*work.rig, how), work.load, [](int) { return true; }, work.rig->first_frame);
  work.remark = all.remark;
  work.made.push_back({how, std::make_shared<const GeneratedMotion>(std::move(all.motions.at(0)))});
}

/// One that cannot be made leaves the others.
void make_all(MotionsJob& work, JobControl& control) {
  RiggedMotion known = work.rig->found;
  known.rig.name = work.name;
  for (size_t i = 0; i < work.wanted.size() && !control.cancelled(); ++i) {
    control.progress(static_cast<float>(i) / static_cast<float>(work.wanted.size()));
    const std::string wrong = failure_of([&] { make_one(work, known, work.wanted[i]); });
    if (work.problem.empty()) work.problem = wrong;
  }
  work.cancelled = control.cancelled();
}

std::string made_words(const MotionsJob& work) {
  const size_t count = work.made.size();
  const std::string motions = count == 1 ? "1 motion" : std::to_string(count) + " motions";
  if (work.cancelled) return "Cancelled: " + motions + " of " + std::to_string(work.wanted.size()) + " made";
  return motions + " made: a click on one, in the list or in the view, keeps it as a clip";
}

/// Whether they are one rig and one motion but for the bones' names: what was made of one is of the other.
bool moves_alike(const DiscoveredRig& a, const DiscoveredRig& b) {
  const RiggedMotion &one = a.found, &other = b.found;
  const auto same_joint = [](const RigJoint& x, const RigJoint& y) {
    return x.parent == y.parent && x.kind == y.kind && x.rest == y.rest && x.axis == y.axis;
  };
  const auto same_pose = [](const RigPose& x, const RigPose& y) {
    return x.root == y.root && x.turns == y.turns && x.slides == y.slides;
  };
  const auto same_points = [](const auto& x, const auto& y) {
    return x.rows() == y.rows() && x.cols() == y.cols() && x == y;
  };
  return a.first_frame == b.first_frame && one.motion.fps == other.motion.fps &&
         std::equal(one.rig.joints.begin(), one.rig.joints.end(), other.rig.joints.begin(),
                    other.rig.joints.end(), same_joint) &&
         std::equal(one.motion.poses.begin(), one.motion.poses.end(), other.motion.poses.begin(),
                    other.motion.poses.end(), same_pose) &&
         same_points(one.rig.surface.vertices, other.rig.surface.vertices) &&
         same_points(one.rig.skin.bones, other.rig.skin.bones) &&
         same_points(one.rig.skin.weights, other.rig.skin.weights);
}

/// It goes on where the playhead has gone round, and begins anew at its own end.
size_t pose_at(const Session& session, int at, size_t count) {
  const FrameRange range = play_range(session.playback, frame_count(session));
  const int64_t lap = std::max(0, range.last - range.first + 1);
  return static_cast<size_t>(at + session.made_motions.laps * lap) % count;
}

}  // namespace

void check_making(const Session& session, const GenerationOptions& how) {
  const auto& rig = session.bones.rig;
  US_CHECK(rig, "no bones have been found yet");
  check_generation(rig->found, of_rig(*rig, how));
}

int clip_of(const Document& document, const GenerationOptions& how) {
  const auto& clips = document.bones.clips;
  const auto found =
      std::find_if(clips.begin(), clips.end(), [&](const MadeClip& clip) { return same(clip.how, how); });
  return found == clips.end() ? -1 : static_cast<int>(found - clips.begin());
}

std::shared_ptr<const GeneratedMotion> performed_clip(const Session& session) {
  const auto& clips = session.document.bones.clips;
  for (size_t i = 0; i < clips.size() && i < session.made_motions.clips.size(); ++i)
    if (clips[i].name == session.document.bones.second.clip) return session.made_motions.clips[i];
  return nullptr;
}

int second_pose(const Session& session, int frame) {
  const auto& rig = session.bones.rig;
  const auto& performed = session.second.performed;
  const int at = rig && performed ? frame_of_rig(*rig, frame) : -1;
  if (at < 0) return -1;
  const auto count = static_cast<int>(ssize(performed->motion.poses));
  if (session.document.bones.second.clip.empty()) return at < count ? at : -1;
  return static_cast<int>(pose_at(session, at, static_cast<size_t>(count)));
}

std::vector<ShownMotion> shown_motions(const Session& session, int frame) {
  std::vector<ShownMotion> shown;
  const auto& rig = session.bones.rig;
  const BoneSurface where = session.view.made_motions;
  const int at = rig && where != BoneSurface::Off ? frame_of_rig(*rig, frame) : -1;
  if (at < 0) return shown;
  const MadeMotionsState& state = session.made_motions;
  for (size_t i = 0; i < state.clips.size(); ++i)
    if (state.clips[i]) shown.push_back({state.clips[i], static_cast<int>(i)});
  for (const MadeMotion& one : state.offered)
    if (clip_of(session.document, one.how) < 0) shown.push_back({one.made});
  const auto box = extent_of(rig->found.rig.surface.vertices);
  const float apart = where == BoneSurface::Beside && box ? kApart * width_of(*box) : 0;
  for (size_t i = 0; i < shown.size(); ++i) {
    const std::vector<RigPose>& poses = shown[i].made->motion.poses;
    shown[i].pose = &poses[pose_at(session, at, poses.size())];
    shown[i].place.x() = -apart * static_cast<float>(i + 1);
  }
  return shown;
}

/// Makes what the document keeps follow it and the rig; begins the work that is missing. What was offered is
/// of one rig and goes with it, but for one whose bones have other names alone.
void Studio::follow_made_motions() {
  Background& b = *background_;
  MadeMotionsState& state = session_.made_motions;
  const auto& rig = session_.bones.rig;
  if (b.motions_of && rig && b.motions_of != rig && moves_alike(*b.motions_of, *rig)) {
    for (auto& [of, one] : b.motions)
      if (of == b.motions_of) of = rig;
    b.motions_of = rig;
  }
  if (b.motions_of != rig) {
    b.motions_of = rig;
    if (state.job != 0) jobs_.cancel(state.job);
    if (state.clips_job != 0) jobs_.cancel(state.clips_job);
    b.motions_work.reset(), b.clips_work.reset();
    state = {};
  }
  for (const JobView& job : jobs_.views())
    if (job.id == state.job) state.share = std::max(0.0f, job.progress);
  const auto& clips = session_.document.bones.clips;
  state.clips.assign(rig ? clips.size() : 0, nullptr);
  std::vector<GenerationOptions> missing;
  for (size_t i = 0; i < state.clips.size(); ++i) {
    state.clips[i] = kept_motion(clips[i].how);
    if (!state.clips[i]) missing.push_back(clips[i].how);
  }
  if (missing.empty()) return state.problem.clear();
  const bool is_last = b.clips_work && same(b.clips_work->wanted, missing);
  if (!is_last) start_clips(std::move(missing));
}

/// Of the rig that is shown; null: it is not known.
std::shared_ptr<const GeneratedMotion> Studio::kept_motion(const GenerationOptions& how) const {
  for (const auto& [rig, one] : background_->motions)
    if (rig == session_.bones.rig && same(one.how, how)) return one.made;
  return nullptr;
}

std::shared_ptr<MotionsJob> Studio::motions_job(std::vector<GenerationOptions> wanted) const {
  auto work = std::make_shared<MotionsJob>();
  work->rig = session_.bones.rig;
  work->name = session_.source.name.empty() ? "the found rig" : session_.source.name;
  work->wanted = std::move(wanted);
  work->load = services_.dynamics;
  if (!work->load)
    work->load = [](const understudy::Rig&) -> std::unique_ptr<MotionDynamics> {
      throw Error("there are no weights of a network that makes motions");
    };
  return work;
}

void Studio::start_clips(std::vector<GenerationOptions> missing) {
  Background& b = *background_;
  MadeMotionsState& state = session_.made_motions;
  if (state.clips_job != 0) jobs_.cancel(state.clips_job);
  const auto work = b.clips_work = motions_job(std::move(missing));
  state.problem.clear();
  state.clips_job = jobs_.start(
      "Making clips", [work](JobControl& control) { make_all(*work, control); },
      [this, work] { take_in_clips(*work); });
}

/// One that is still wanted is of the rig that is shown, whose bones may have been renamed meanwhile.
void Studio::keep_made(const MotionsJob& work) {
  Background& b = *background_;
  auto& motions = b.motions;
  const bool wanted = b.motions_work.get() == &work || b.clips_work.get() == &work;
  for (const MadeMotion& one : work.made) motions.emplace_back(wanted ? b.motions_of : work.rig, one);
  if (motions.size() > kMotionsKept)
    motions.erase(motions.begin(), motions.end() - static_cast<ptrdiff_t>(kMotionsKept));
}

void Studio::take_in_clips(MotionsJob& work) {
  keep_made(work);
  Background& b = *background_;
  if (b.clips_work.get() != &work) return;  // the document wants others by now
  MadeMotionsState& state = session_.made_motions;
  state.clips_job = 0;
  const auto is_made = [&](const GenerationOptions& how) { return kept_motion(how) != nullptr; };
  work.wanted.erase(std::remove_if(work.wanted.begin(), work.wanted.end(), is_made), work.wanted.end());
  state.problem =
      work.cancelled && work.problem.empty() ? "Cancelled before all clips were made" : work.problem;
  if (!work.problem.empty()) return fail(work.problem, "generate.keep");
  if (work.cancelled) notify(state.problem, true);
}

void Studio::make_motions(const GenerationOptions& how) {
  check_making(session_, how);
  MadeMotionsState& state = session_.made_motions;
  if (state.job != 0) jobs_.cancel(state.job);
  std::vector<GenerationOptions> wanted(static_cast<size_t>(how.count), how);
  for (size_t i = 0; i < wanted.size(); ++i) wanted[i].seed += i, wanted[i].count = 1;
  const auto work = background_->motions_work = motions_job(std::move(wanted));
  state.share = 0;
  state.job = jobs_.start(
      "Making motions", [work](JobControl& control) { make_all(*work, control); },
      [this, work] { take_in_motions(*work); });
}

/// Where none was made those that were offered before stay.
void Studio::take_in_motions(MotionsJob& work) {
  keep_made(work);
  if (background_->motions_work.get() != &work) return;  // others were asked for, or the rig is another
  MadeMotionsState& state = session_.made_motions;
  state.job = 0;
  if (!work.problem.empty()) return fail(work.problem, "generate.make");
  if (work.made.empty()) return notify("Cancelled before any motion was made", true);
  state.offered = work.made, state.remark = work.remark, state.laps = 0;
  if (session_.view.made_motions == BoneSurface::Off) session_.view.made_motions = BoneSurface::Beside;
  notify(made_words(work), work.cancelled, {"Fit the view", "view.fit"});
}

}  // namespace understudy::app
