#include "app/session/refiner.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "app/session/frame_figures.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/worker.hpp"
#include "retarget/pipeline/running_median.hpp"

namespace understudy::app {

namespace {

/// Room behind the frames refined, so that those that came meanwhile are appended without a copy of all.
constexpr size_t kRoomForNewFrames = 1024;

Motion motion_of(const SharedFrames<KeptFrame>& frames, float fps) {
  Motion motion;
  motion.fps = fps;
  bool any_made = false;
  for (const KeptFrame& frame : frames) {
    any_made = any_made || frame.doubt_m > 0;
    motion.doubt_m.push_back(frame.doubt_m);
    motion.poses.push_back(frame.pose);
    motion.flags.push_back(frame.flagged);
    motion.standing.push_back(frame.standing);
  }
  if (!any_made) motion.doubt_m.clear();
  return motion;
}

/// Of the target's legs to those of who is performed.
float leg_ratio(const RefineRequest& request) {
  RunningMedian source;
  for (const KeptFrame& frame : request.performed)
    if (!frame.flagged) source.push(leg_length(frame.source));
  return source.empty() ? 1.0f : leg_length(request.target->joints) / std::max(source.value(), 1e-4f);
}

}  // namespace

Refined refine(const RefineRequest& request, MotionSpace* space) {
  const Motion performed = motion_of(request.performed, request.fps);
  Refined result;
  result.take_id = request.take_id;
  result.performed = performed.poses.size();
  result.shown = performed;
  PoseEdits edits = request.edits;
  if (!request.all_there) edits.go_on.reset();
  if (!edits.empty() && !performed.poses.empty()) {
    try {
      const EditedBody body = EditedBody::from(request.target->mesh.vertices, request.target->joints);
      result.shown = apply_poses(edits, performed, body, space);
      result.cost = edit_cost(performed, result.shown, request.target->joints);
    } catch (const Error& error) {
      result.shown = performed;
      result.problem = error.what();
    }
  }
  result.shown.poses.reserve(result.shown.poses.size() + kRoomForNewFrames);
  result.joints.reserve(result.shown.poses.size() + kRoomForNewFrames);
  for (const Pose& pose : result.shown.poses)
    result.joints.push_back(forward_kinematics(request.target->joints, pose).joints);
  result.leg_ratio = leg_ratio(request);
  if (request.edits.tempo && !result.joints.empty()) {
    const std::string problem = failure_of([&] {
      result.times = tempo_times(*request.edits.tempo, result.joints, request.fps, result.leg_ratio);
    });
    if (result.problem.empty()) result.problem = problem;
  }
  result.series =
      joint_figures({result.shown, result.joints, request.performed, request.source, request.truth.get(),
                     request.has_style || request.edits.tempo.has_value(), &result.times});
  return result;
}

Alternatives alternatives_of(const RefineRequest& request, MotionSpace* space) {
  Alternatives made{request.take_id, {}};
  PoseEdits edits = request.edits;
  if (!request.all_there) edits.go_on.reset();
  const bool any = need_space(edits.fill) || (edits.go_on && edits.go_on->learned > 0);
  if (!any || space == nullptr || space->variations() < 2 || request.performed.empty()) return made;
  const Motion performed = motion_of(request.performed, request.fps);
  const EditedBody body = EditedBody::from(request.target->mesh.vertices, request.target->joints);
  for (int variation = 0; variation < space->variations(); ++variation) {
    for (FillEdit& fill : edits.fill) fill.variation = variation;
    if (edits.go_on) edits.go_on->variation = variation;
    std::vector<Joints>& joints = made.joints.emplace_back();
    for (const Pose& pose : apply_poses(edits, performed, body, space).poses)
      joints.push_back(forward_kinematics(body.rest, pose).joints);
  }
  return made;
}

struct Refiner::Impl {
  explicit Impl(LoadSpace load) : load_space(std::move(load)) {}

  LoadSpace load_space;  // empty once it was called
  std::shared_ptr<MotionSpace> space;
  std::vector<RefineRequest> waiting;
  std::vector<Refined> finished;
  std::vector<Alternatives> alternatives;
  Worker worker{"refining", [this] { return next(); }};

  Worker::Task next() {
    if (waiting.empty()) return nullptr;
    const auto request = std::make_shared<const RefineRequest>(std::move(waiting.front()));
    waiting.erase(waiting.begin());
    return [this, request] {
      const bool waits = load_space && need_space(request->edits);
      answer(*request);
      if (waits) {
        const std::string problem = failure_of([&] { space = std::exchange(load_space, nullptr)(); });
        if (!problem.empty()) log::warn(problem + ": filled frames follow smooth curves");
        if (space) answer(*request);
      }
      answer_otherwise(*request);
    };
  }

  void answer_otherwise(const RefineRequest& request) {
    {
      const auto held = worker.lock();
      if (!waiting.empty()) return;
    }
    Alternatives made{request.take_id, {}};
    const std::string problem = failure_of([&] { made = alternatives_of(request, space.get()); });
    if (!problem.empty()) made = {request.take_id, {}};  // the answer itself has told it
    const auto held = worker.lock();
    alternatives.push_back(std::move(made));
  }

  void answer(const RefineRequest& request) {
    Refined result;
    const std::string problem = failure_of([&] { result = refine(request, space.get()); });
    if (!problem.empty()) result = {}, result.take_id = request.take_id, result.problem = problem;
    const auto held = worker.lock();
    finished.push_back(std::move(result));
  }
};

Refiner::Refiner(LoadSpace load_space) : impl_(std::make_unique<Impl>(std::move(load_space))) {}
Refiner::~Refiner() = default;

void Refiner::request(RefineRequest request) {
  const auto held = impl_->worker.lock();
  auto& waiting = impl_->waiting;
  const auto of_take = [&](const RefineRequest& other) { return other.take_id == request.take_id; };
  waiting.erase(std::remove_if(waiting.begin(), waiting.end(), of_take), waiting.end());
  waiting.push_back(std::move(request));
  impl_->worker.wake();
}

std::vector<Refined> Refiner::drain() {
  const auto held = impl_->worker.lock();
  return std::exchange(impl_->finished, {});
}

std::vector<Alternatives> Refiner::drain_alternatives() {
  const auto held = impl_->worker.lock();
  return std::exchange(impl_->alternatives, {});
}

bool Refiner::busy() const {
  const auto held = impl_->worker.lock();
  return impl_->worker.working() || !impl_->waiting.empty() || !impl_->finished.empty() ||
         !impl_->alternatives.empty();
}

}  // namespace understudy::app
