// The source's own skeleton, as the document wants it: found and edited in the background, shown as it comes,
// compared with the 22 joints of people.
#include <algorithm>
#include <mutex>

#include "app/run/rig_finder.hpp"
#include "app/session/background.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/discovery/rig_refit.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/metrics/rig_metrics.hpp"

namespace understudy::app {

/// A search and its answers. The job has its inputs alone; what it tells is locked.
struct BonesJob {
  SourceOptions source;
  ScanEdits edits;
  SharedFrames<KeptSource> kept;
  std::shared_ptr<MotionBlender> blender;
  BoneSearch search;
  KeypointsLoader load;
  std::shared_ptr<const DiscoveredRig> from;  // to be edited further; null: nothing is found yet
  std::vector<RigEdit> further;
  std::string from_key, key;  // of `from`, and of the answer

  std::mutex mutex;
  std::string stage;
  std::shared_ptr<const PartsSoFar> so_far;
  // Once it has ended.
  std::shared_ptr<const DiscoveredRig> found, edited;
  std::string problem;
  bool cancelled = false;
};

namespace {

constexpr size_t kRigsKept = 16;  // so many edits are undone without another search

/// The scans as they are shown: edited, and of several people the source's own.
ScanSequence scans_of(const BonesJob& work) {
  SourceOptions quiet = work.source;
  quiet.quiet = true;
  quiet.follow = false;
  ScanSequence scans = scan_sequence(open_source(quiet, work.blender.get()), name_of(quiet), work.edits);
  scans.scan = [read = scans.scan, &work](int frame) {
    Mesh scan = read(frame);
    if (scan.vertices.rows() == 0) return scan;
    const auto t = static_cast<size_t>(frame);
    if (t < work.kept.size() && !cut_out(work.kept[t], scan)) scan = Mesh{};
    return scan;
  };
  return scans;
}

void find(BonesJob& work, const ScanSequence& scans, JobControl& control) {
  DiscoveryOptions how = discovery_options(work.search, work.load);
  how.parts_found = [&work](PartsSoFar so_far) {
    const std::lock_guard lock(work.mutex);
    work.so_far = std::make_shared<const PartsSoFar>(std::move(so_far));
  };
  how.progress = [&work, &control](const DiscoveryProgress& at) {
    control.progress(at.share);
    const std::lock_guard lock(work.mutex);
    work.stage = at.stage;
    return !control.cancelled();
  };
  work.found = std::make_shared<const DiscoveredRig>(discover(scans, how));
}

/// False: it was cancelled, and what is missing of the edits is still to be done.
bool edit(BonesJob& work, const ScanSequence& scans, JobControl& control) {
  DiscoveredRig rig = *work.found;
  for (const RigEdit& one : work.further) {
    const auto progress = [&](float share) {
      control.progress(share);
      const std::lock_guard lock(work.mutex);
      work.stage = "Fit";
      return !control.cancelled();
    };
    if (understudy::apply(rig, one, scans, progress).empty()) return false;
  }
  work.edited = std::make_shared<const DiscoveredRig>(std::move(rig));
  return true;
}

void find_and_edit(BonesJob& work, JobControl& control) {
  try {
    const ScanSequence scans = scans_of(work);
    work.found = work.from;
    if (!work.found) find(work, scans, control);
    if (!edit(work, scans, control)) work.problem = "Cancelled before the bones were fitted";
  } catch (const std::exception& error) {
    work.problem = control.cancelled() ? "Cancelled before any bones were found" : error.what();
  }
  work.cancelled = control.cancelled();
}

/// The diagonal of the box about the rest surface, metres; a few strays do not count.
float size_of(const DiscoveredRig& rig) {
  constexpr double kStrays = 2;  // per cent at each end
  const Points& points = rig.found.rig.surface.vertices;
  Vec3 sides = Vec3::Zero();
  for (int axis = 0; axis < 3 && points.rows() > 0; ++axis) {
    std::vector<double> along(static_cast<size_t>(points.rows()));
    for (Eigen::Index i = 0; i < points.rows(); ++i) along[static_cast<size_t>(i)] = points(i, axis);
    sides[axis] = static_cast<float>(percentile(along, 100 - kStrays) - percentile(along, kStrays));
  }
  return sides.norm();
}

/// Found joints and the 22, over the frames that show both.
struct Comparison {
  Eigen::MatrixXf apart;  // [J, 22] metres, mean; empty where no frame does
  SemanticConsistency consistency;
};

Comparison compare(const DiscoveredRig& rig, const SharedFrames<KeptSource>& frames) {
  const understudy::Rig& found = rig.found.rig;
  Eigen::MatrixXf sum = Eigen::MatrixXf::Zero(found.count(), kJointCount);
  Comparison of;
  int seen = 0;
  for (size_t t = 0; t < frames.size(); ++t) {
    const int at = frame_of_rig(rig, static_cast<int>(t));
    if (at < 0 || rig.doubted[static_cast<size_t>(at)] || frames[t].flagged) continue;
    const Points places =
        joint_places(found, bone_motions(found, rig.found.motion.poses[static_cast<size_t>(at)]));
    for (int j = 0; j < found.count(); ++j)
      sum.row(j) += (frames[t].joints.rowwise() - places.row(j)).rowwise().norm().transpose();
    of.consistency.push(places, frames[t].joints);
    ++seen;
  }
  if (seen > 0) of.apart = sum / static_cast<float>(seen);
  return of;
}

/// The nearest ones have the names, each of the 22 once.
void give_names(std::vector<NearJoint>& near) {
  constexpr float kNear = 0.05f;  // of the size: what joint_recall counts as the same joint
  std::vector<size_t> order(near.size());
  for (size_t j = 0; j < order.size(); ++j) order[j] = j;
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return near[a].apart_m < near[b].apart_m; });
  std::vector<bool> taken(kJointCount, false);
  for (const size_t j : order) {
    if (near[j].joint < 0 || near[j].share > kNear || taken[static_cast<size_t>(near[j].joint)]) continue;
    near[j].names = taken[static_cast<size_t>(near[j].joint)] = true;
  }
}

std::vector<NearJoint> nearest_joints(const DiscoveredRig& rig, const Eigen::MatrixXf& apart) {
  std::vector<NearJoint> near(static_cast<size_t>(rig.found.rig.count()));
  if (apart.size() == 0) return near;
  const float size = size_of(rig);
  for (size_t j = 0; j < near.size(); ++j) {
    Eigen::Index joint = 0;
    near[j].apart_m = apart.row(static_cast<Eigen::Index>(j)).minCoeff(&joint);
    near[j].joint = static_cast<int>(joint);
    near[j].share = size > 0 ? near[j].apart_m / size : 0;
  }
  give_names(near);
  return near;
}

std::vector<SteadyJoint> steady_joints(const Comparison& of) {
  std::vector<SteadyJoint> steady;
  for (const SemanticConsistency::Steadiest& one : of.consistency.joints())
    steady.push_back({one.keypoint, one.share, of.apart(one.keypoint, ssize(steady))});
  return steady;
}

}  // namespace

int frame_of_rig(const DiscoveredRig& rig, int source_frame) {
  const int at = source_frame - rig.first_frame;
  return at >= 0 && at < ssize(rig.found.motion.poses) ? at : -1;
}

namespace {

using Rigs = std::vector<std::pair<std::string, std::shared_ptr<const DiscoveredRig>>>;

std::shared_ptr<const DiscoveredRig> kept_rig(const Rigs& rigs, const std::string& key) {
  const auto found =
      std::find_if(rigs.begin(), rigs.end(), [&](const auto& one) { return one.first == key; });
  return found == rigs.end() ? nullptr : found->second;
}

void keep_rig(Rigs& rigs, const std::string& key, const std::shared_ptr<const DiscoveredRig>& rig) {
  rigs.erase(std::remove_if(rigs.begin(), rigs.end(), [&](const auto& one) { return one.first == key; }),
             rigs.end());
  rigs.emplace_back(key, rig);
  if (rigs.size() > kRigsKept) rigs.erase(rigs.begin());
}

/// What the bones of a document are made from, with the first `edits` of its edits; "" where none are wanted.
std::string bones_key(const OwnBones& bones, const std::string& source_key, size_t edits) {
  if (!bones.wanted || source_key.empty()) return "";
  const std::vector<RigEdit> first(bones.edits.begin(), bones.edits.begin() + static_cast<ptrdiff_t>(edits));
  return key_of(source_key, bones.search, first);
}

/// A match is of the bone, whatever it is called.
void rename_matches(OwnBones& bones, const DiscoveredRig& before, const RenameBone& edit) {
  const std::string& name = before.found.rig.joints[static_cast<size_t>(edit.joint)].name;
  for (ChosenMatch& match : bones.second.matches)
    if (match.bone == name) match.bone = edit.name;
}

}  // namespace

/// Makes what is shown of bones follow the document; begins the work that is missing.
void Studio::follow_bones() {
  Background& b = *background_;
  BonesState& state = session_.bones;
  const OwnBones& wanted = session_.document.bones;
  const std::string source = session_.document.source.path.empty() ? "" : b.source_key;
  const std::string key = bones_key(wanted, source, wanted.edits.size());
  if (key != b.bones_key) {
    if (state.job != 0) jobs_.cancel(state.job);
    b.bones_work.reset();
    b.bones_key = key;
    if (!key.empty()) withdraw_bones_offer();
    const int selected = state.selected;
    state = {};
    state.rig = kept_rig(b.rigs, key);
    if (state.rig && selected < state.rig->found.rig.count()) state.selected = selected;
  }
  if (b.bones_work) {
    const std::lock_guard lock(b.bones_work->mutex);
    state.stage = b.bones_work->stage, state.so_far = b.bones_work->so_far;
    for (const JobView& job : jobs_.views())
      if (job.id == state.job) state.share = std::max(0.0f, job.progress);
  }
  state.waits = !key.empty() && !state.rig && !b.bones_work && state.problem.empty() && session_.working;
  if (!key.empty() && !state.rig && !b.bones_work && state.problem.empty() && !session_.working)
    start_finding_bones();
  compare_bones();
}

/// It was answered, whether by its button or not.
void Studio::withdraw_bones_offer() {
  auto& notices = session_.notices;
  notices.erase(std::remove_if(notices.begin(), notices.end(),
                               [](const Notice& notice) { return notice.offer.command == "bones.find"; }),
                notices.end());
  for (Notice& notice : notices)
    if (notice.also.command == "bones.find") notice.also = {};
}

void Studio::start_finding_bones() {
  Background& b = *background_;
  const OwnBones& wanted = session_.document.bones;
  const auto work = std::make_shared<BonesJob>();
  work->source = source_as_read(session_);
  work->blender = blender_;
  work->edits = in_effect(session_.document.scan_edits);
  work->kept = session_.source.frames;
  work->search = wanted.search;
  work->load = services_.keypoints;
  size_t done = wanted.edits.size() + 1;
  while (!work->from && done-- > 0)
    work->from = kept_rig(b.rigs, work->from_key = bones_key(wanted, b.source_key, done));
  if (!work->from) done = 0;
  work->further.assign(wanted.edits.begin() + static_cast<ptrdiff_t>(done), wanted.edits.end());
  work->key = b.bones_key;
  BonesState& state = session_.bones;
  state.problem = failure_of([&] {
    state.job = jobs_.start(
        work->from ? "Fitting bones" : "Finding bones",
        [work](JobControl& control) { find_and_edit(*work, control); },
        [this, work] { take_in_bones(*work); });
    b.bones_work = work;
  });
}

void Studio::take_in_bones(BonesJob& work) {
  Background& b = *background_;
  if (work.found) keep_rig(b.rigs, work.from_key, work.found);
  if (work.edited) keep_rig(b.rigs, work.key, work.edited);
  if (b.bones_work.get() != &work) return;  // the document wants others by now
  BonesState& state = session_.bones;
  b.bones_work.reset();
  state.job = 0, state.stage.clear(), state.so_far.reset();
  state.problem = work.problem;
  state.rig = work.edited ? work.edited : work.found;
  if (!work.problem.empty())
    return work.cancelled ? notify(work.problem, true) : fail(work.problem, "bones.find");
  const int bones = state.rig->found.rig.count();
  if (session_.source.no_person) session_.view.metric = "bones_off";
  notify(bones == 1 ? "1 bone: nothing moves against anything else"
                    : std::to_string(bones) + " bones" + (state.rig->complete ? "" : ", found so far"),
         bones == 1 || !state.rig->complete);
}

void Studio::compare_bones() {
  Background& b = *background_;
  BonesState& state = session_.bones;
  const SourceState& source = session_.source;
  const bool person = state.rig && !source.no_person && !session_.working && !source.frames.empty();
  const std::string key =
      person ? b.bones_key + key_of(source.generation, source.frames.size()) : std::string();
  if (key == b.near_key) return;
  b.near_key = key;
  state.near.clear(), state.steady.clear();
  if (!person) return;
  const Comparison of = compare(*state.rig, source.frames);
  state.near = nearest_joints(*state.rig, of.apart);
  state.steady = steady_joints(of);
}

void Studio::look_for_bones_again() {
  BonesState& state = session_.bones;
  if (state.job != 0 || (state.problem.empty() && (!state.rig || state.rig->complete))) return;
  forget_incomplete_bones();
  state = {};
}

/// What ended early is not found again as such: a document that is opened finds all of it.
void Studio::forget_incomplete_bones() {
  auto& rigs = background_->rigs;
  rigs.erase(std::remove_if(rigs.begin(), rigs.end(), [](const auto& one) { return !one.second->complete; }),
             rigs.end());
}

void Studio::edit_bones(const RigEdit& edit) {
  follow_bones();
  Background& b = *background_;
  BonesState& state = session_.bones;
  US_CHECK(state.rig, state.job != 0 || state.waits ? "the bones are still being looked for"
                                                    : "no bones have been found yet");
  US_CHECK(state.problem.empty(), state.problem);
  OwnBones& bones = session_.document.bones;
  if (std::holds_alternative<FitAgain>(edit)) return bones.edits.push_back(edit);
  auto rig = std::make_shared<DiscoveredRig>(*state.rig);
  const std::vector<int> numbers = understudy::apply(*rig, edit, ScanSequence{});
  if (const auto* const renamed = std::get_if<RenameBone>(&edit)) rename_matches(bones, *state.rig, *renamed);
  bones.edits.push_back(edit);
  b.bones_key = bones_key(bones, b.source_key, bones.edits.size());
  const int* const selected = at_or_null(numbers, state.selected);
  state.rig = std::move(rig);
  state.selected = selected != nullptr ? *selected : -1;
  keep_rig(b.rigs, b.bones_key, state.rig);
}

}  // namespace understudy::app
