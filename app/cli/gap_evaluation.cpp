#include "app/cli/gap_evaluation.hpp"

#include <algorithm>
#include <chrono>

#include "app/run/interrupt.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::app {
namespace {

void check(const GapCase& of) {
  US_CHECK(of.truth.frames == of.c.gaps->frames, of.c.truth, ": has ", of.truth.frames,
           " frames, case.json says ", of.c.gaps->frames);
  US_CHECK(!of.truth.joints.empty(), of.c.truth, ": gaps are evaluated by its joints, which it lacks");
}

/// Frames first .. first + count - 1 of a list.
template <class List>
List slice(const List& all, int first, int count) {
  return all.empty() ? all : List(all.begin() + first, all.begin() + first + count);
}

KnownMotion slice(const KnownMotion& all, int first, int count) {
  KnownMotion part = all;
  part.motion.poses = slice(all.motion.poses, first, count);
  part.motion.standing = slice(all.motion.standing, first, count);
  part.known = slice(all.known, first, count);
  return part;
}

/// A window of a case, filled.
struct FilledWindow {
  int start;  // frame of the case
  JointSequence joints;
  std::vector<float> doubt;
  std::vector<double> vertex_errors;  // of each frame, 0 where it was known; empty: no surface
};

FilledWindow filled_window(const GapCase& of, const Joints& rest, const Completion& made, int start,
                           Evaluator& evaluator) {
  const GapPlan& plan = *of.c.gaps;
  const std::vector<bool> known = window_known(plan);
  const bool compared = of.surface.is_dense && plan.is_whole();
  FilledWindow window{start, {}, made.doubt_m, {}};
  for (int t = 0; t < plan.window(); ++t) {
    const Pose& pose = made.motion.poses[t];
    window.joints.push_back(forward_kinematics(rest, pose).joints);
    if (!of.surface.made) continue;
    if (!of.surface.is_another) window.vertex_errors.push_back(0);
    if (known[t] && !compared) continue;
    const Points shown = of.surface.made(pose), truth = of.surface.truth(start + t);
    if (!known[t] && !of.surface.is_another) window.vertex_errors.back() = mean_vertex_error(shown, truth);
    if (compared) evaluator.push_gap_surface(chamfer_distance(shown, truth));
  }
  return window;
}

/// Each gap of a window: frames in a row that were not known.
void push_gaps(const GapCase& of, const FilledWindow& window, Evaluator& evaluator) {
  const std::vector<bool> known = window_known(*of.c.gaps);
  const int count = static_cast<int>(ssize(known));
  FilledGap gap{window.joints, slice(of.truth.joints, window.start, count), 0, 0, window.doubt};
  for (int t = 0; t < count; ++t) {
    if (known[t]) continue;
    gap.first = t;
    while (t + 1 < count && !known[t + 1]) ++t;
    gap.last = t;
    gap.vertex_errors = slice(window.vertex_errors, gap.first, gap.last - gap.first + 1);
    evaluator.push_gap(gap);
  }
}

/// The window that begins at `start`.
void evaluate_window(const GapCase& of, const Joints& rest, const Completion& made, int start,
                     Evaluator& evaluator) {
  push_gaps(of, filled_window(of, rest, made, start, evaluator), evaluator);
}

Completion slice(const Completion& all, int first, int count) {
  Completion part;
  part.motion.fps = all.motion.fps;
  part.motion.poses = slice(all.motion.poses, first, count);
  part.doubt_m = slice(all.doubt_m, first, count);
  return part;
}

/// The true poses of a window's known frames.
KnownMotion true_question(const GapCase& of, int start) {
  const std::vector<bool> known = window_known(*of.c.gaps);
  KnownMotion question{
      {static_cast<float>(of.c.fps), std::vector<Pose>(known.size()), {}}, {}, *of.truth.target_joints};
  for (size_t i = 0; i < known.size(); ++i) {
    question.known.push_back(all_parts(known[i]));
    const size_t t = i + static_cast<size_t>(start);
    if (known[i])
      question.motion.poses[i] = {of.truth.rotations[t], of.truth.joints[t].row(Pelvis).transpose()};
  }
  return question;
}

/// The truth's skin, in made poses and in true ones.
GapSurface skin_surface(const Truth& truth) {
  if (truth.skin.rest.rows() == 0) return {};
  const auto in_pose = [&truth](const Pose& pose) {
    return linear_blend_skinning(truth.skin.rest, truth.skin.weights, *truth.target_joints,
                                 forward_kinematics(*truth.target_joints, pose));
  };
  return {in_pose, [&truth, in_pose](int64_t t) {
            const auto i = static_cast<size_t>(t);
            return in_pose({truth.rotations[i], truth.joints[i].row(Pelvis).transpose()});
          }};
}

}  // namespace

std::vector<double> evaluate_true_gaps(const GapCase& of, MotionSpace& space, Evaluator& evaluator) {
  check(of);
  US_CHECK(of.truth.target_joints && !of.truth.rotations.empty(),
           "--oracle pose needs target_joints, joints and rotations in the truth");
  const GapCase with_skin{of.c, of.truth, skin_surface(of.truth)};
  std::vector<double> times;
  for (const int start : window_starts(*of.c.gaps)) {
    check_interrupt("in case " + of.c.name);
    const KnownMotion question = true_question(of, start);
    const auto began = std::chrono::steady_clock::now();
    const Completion made = space.complete(question);
    times.push_back(ms_since(began));
    evaluate_window(with_skin, question.rest, made, start, evaluator);
  }
  return times;
}

void evaluate_performed_gaps(const GapCase& of, MotionSpace& space, const KnownMotion& performed,
                             Evaluator& evaluator) {
  check(of);
  const GapPlan& plan = *of.c.gaps;
  if (plan.is_whole() || plan.after > 0)
    return evaluate_completion(of, performed.rest, space.complete(performed), evaluator);
  for (const int start : window_starts(plan)) {
    KnownMotion question = slice(performed, start, plan.window());
    std::fill(question.known.begin() + plan.before, question.known.end(), all_parts(false));
    evaluate_window(of, performed.rest, space.complete(question), start, evaluator);
  }
}

void evaluate_completion(const GapCase& of, const Joints& rest, const Completion& made,
                         Evaluator& evaluator) {
  check(of);
  US_CHECK(ssize(made.motion.poses) == of.c.gaps->frames, of.c.name, ": ", made.motion.poses.size(),
           " frames were made, not ", of.c.gaps->frames);
  for (const int start : window_starts(*of.c.gaps))
    evaluate_window(of, rest, slice(made, start, of.c.gaps->window()), start, evaluator);
}

}  // namespace understudy::app
