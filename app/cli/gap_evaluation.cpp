#include "app/cli/gap_evaluation.hpp"

#include <algorithm>
#include <chrono>

#include "app/run/interrupt.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

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
  return {all.begin() + first, all.begin() + first + count};
}

/// The window that begins at `start`, of a motion that was filled from frame `from` of the case on.
void push_window(const GapCase& of, const Joints& rest, const Completion& filled, int from, int start,
                 Evaluator& evaluator) {
  const GapPlan& plan = *of.c.gaps;
  FilledGap gap;
  gap.first = plan.ends, gap.last = plan.ends + plan.gap - 1;
  gap.truth = slice(of.truth.joints, start, plan.window());
  gap.doubt = slice(filled.doubt_m, start - from, plan.window());
  for (int t = 0; t < plan.window(); ++t) {
    const Pose& pose = filled.motion.poses[start - from + t];
    gap.joints.push_back(forward_kinematics(rest, pose).joints);
    if (of.target && !of.truth.vertices.empty() && t >= gap.first && t <= gap.last)
      gap.vertex_errors.push_back(mean_vertex_error(of.target(pose), of.truth.frame_vertices(start + t)));
  }
  evaluator.push_gap(gap);
}

}  // namespace

std::vector<double> evaluate_true_gaps(const GapCase& of, Evaluator& evaluator) {
  check(of);
  US_CHECK(of.truth.target_joints && !of.truth.rotations.empty(),
           "--oracle pose needs target_joints, joints and rotations in the truth");
  const GapPlan& plan = *of.c.gaps;
  std::vector<double> times;
  for (const int start : window_starts(plan)) {
    check_interrupt("in case " + of.c.name);
    KnownMotion question{{static_cast<float>(of.c.fps), {}, {}},
                         std::vector<KnownParts>(static_cast<size_t>(plan.window()), all_parts(true)),
                         *of.truth.target_joints};
    std::fill_n(question.known.begin() + plan.ends, plan.gap, all_parts(false));
    for (int t = start; t < start + plan.window(); ++t) {
      Pose& pose = question.motion.poses.emplace_back();
      if (question.known[t - start] == all_parts(false)) continue;
      pose = {of.truth.rotations[t], of.truth.joints[t].row(Pelvis).transpose()};
    }
    const auto began = std::chrono::steady_clock::now();
    const Completion filled = of.space.complete(question);
    times.push_back(ms_since(began));
    push_window(of, question.rest, filled, start, start, evaluator);
  }
  return times;
}

void evaluate_performed_gaps(const GapCase& of, const KnownMotion& performed, Evaluator& evaluator) {
  check(of);
  const Completion filled = of.space.complete(performed);
  for (const int start : window_starts(*of.c.gaps))
    push_window(of, performed.rest, filled, 0, start, evaluator);
}

}  // namespace understudy::app
