#include "app/run/rig_evaluation.hpp"

#include <chrono>

#include "app/run/case_source.hpp"
#include "app/run/interrupt.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
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
                           const ScanEdits& edits) {
  const std::vector<Mesh> scans = scans_of(c, edits);
  US_CHECK(ssize(scans) == truth.frames(), c.name, ": has ", scans.size(), " scans, the truth ",
           truth.frames(), " frames");
  RigEvaluation evaluation;
  const auto began = std::chrono::steady_clock::now();
  const FoundRig rig = find(scans, c.fps);
  evaluation.found_ms = ms_since(began);
  evaluation.frames = ssize(scans);
  evaluation.metrics = rig_figures(rig.found, rig.rest_frame, scans, truth);
  return evaluation;
}

}  // namespace understudy::app
