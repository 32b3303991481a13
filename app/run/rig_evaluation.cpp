#include "app/run/rig_evaluation.hpp"

#include <chrono>

#include "app/run/case_source.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/rig_performance.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/discovery/rig_follower.hpp"
#include "retarget/metrics/rig_metrics.hpp"

namespace understudy::app {

std::vector<Mesh> scans_of(const Case& c, const ScanEdits& edits) {
  const auto source = open_source(case_source(c));
  std::vector<Mesh> scans;
  while (auto frame = source->next()) {
    check_interrupt("in case " + c.name);
    scans.push_back(!frame->usable  ? Mesh{Points(0, 3)}
                    : edits.empty() ? std::move(frame->mesh)
                                    : apply(edits, frame->mesh));
  }
  return scans;
}

RigEvaluation evaluate_rig(const Case& c, const RigTruth& truth, const RigFinder& find,
                           const RigEvaluationOptions& options) {
  const std::vector<Mesh> scans = scans_of(c, options.edits);
  US_CHECK(ssize(scans) == truth.frames(), c.name, ": has ", scans.size(), " scans, the truth ",
           truth.frames(), " frames");
  RigEvaluation evaluation;
  const auto began = std::chrono::steady_clock::now();
  const FoundRig rig = find(scans, c.fps);
  evaluation.found_ms = ms_since(began);
  evaluation.frames = ssize(scans);
  evaluation.metrics = rig_figures(rig.found, rig.rest_frame, scans, truth);
  if (options.held_out)
    for (const auto& figure : held_out_figures(scans, c.fps, body_size(truth.vertices), find))
      evaluation.metrics.push_back(figure);
  return evaluation;
}

RigEvaluation evaluate_pair(const Case& c, const RigFinder& find, const ScanEdits& edits) {
  US_CHECK(!c.target.empty() && !c.target_truth.empty(), c.name, ": has no target with a truth of its own");
  Case second = c;
  second.source = c.target;
  const std::vector<Mesh> scans = scans_of(c, edits), target_scans = scans_of(second, edits);
  const Truth own = read_truth(c.target_truth), wanted = read_truth(c.performed_truth);
  US_CHECK(own.rig && wanted.rig, c.name, ": its truths are of people, not of bodies of any kind");
  US_CHECK(ssize(target_scans) == own.frames, c.name, ": the target has ", target_scans.size(),
           " scans, its truth ", own.frames, " frames");
  RigEvaluation evaluation;
  const auto began = std::chrono::steady_clock::now();
  const FoundRig source = find(scans, c.fps), target = find(target_scans, c.fps);
  const LaidOther other = laid_other(source.found, {target.found});
  const RiggedMotion performed =
      performed_by(source.found, other.body, other.laid, matches_of(other, source.found.rig));
  evaluation.found_ms = ms_since(began);
  evaluation.frames = ssize(scans) + ssize(target_scans);
  evaluation.metrics.emplace_back(
      "retarget_pct", performance_error_pct(performed, target.found.rig.surface.vertices, *own.rig,
                                            target.rest_frame, wanted.rig->vertices));
  const LaidOther once = laid_other(source.found, {body_of_one_scan(target_scans[0]), true});
  evaluation.metrics.emplace_back(
      "retarget_scan_pct",
      performance_error_pct(
          performed_by(source.found, once.body, once.laid, matches_of(once, source.found.rig)),
          once.body.rig.surface.vertices, *own.rig, 0, wanted.rig->vertices));
  return evaluation;
}

Metrics held_out_figures(const std::vector<Mesh>& scans, double fps, double size, const RigFinder& find) {
  US_CHECK(scans.size() >= 4, "every other one of ", scans.size(), " frames shows no motion");
  std::vector<Mesh> even, odd;
  for (size_t t = 0; t < scans.size(); ++t) (t % 2 == 0 ? even : odd).push_back(scans[t]);
  const understudy::RiggedMotion found = find(even, fps / 2).found;
  RigFollower follower(found.rig);
  const auto surface = [&](const RigPose& pose) {
    return skinned(found.rig.surface.vertices, found.rig.skin, bone_motions(found.rig, pose));
  };
  std::vector<Points> fitted, followed;
  for (size_t t = 0; t < even.size(); ++t) fitted.push_back(surface(found.motion.poses[t]));
  for (size_t t = 0; t < odd.size(); ++t) {
    follower.start_from(found.motion.poses[t]);  // the even frame before
    followed.push_back(finite_count(odd[t].vertices) > 0 ? surface(follower.follow(odd[t]).pose) : fitted[t]);
  }
  const double at_even = surface_error_pct(fitted, found.rig.surface.faces, even, size),
               at_odd = surface_error_pct(followed, found.rig.surface.faces, odd, size);
  return {{"surface_even_pct", at_even}, {"surface_odd_pct", at_odd}, {"surface_held_out", at_odd / at_even}};
}

}  // namespace understudy::app
