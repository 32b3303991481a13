// Evaluates rigs that are found in the scans of a case.
#pragma once

#include <functional>

#include "app/run/case_folder.hpp"
#include "app/run/evaluator.hpp"
#include "retarget/editing/scan_edits.hpp"
#include "retarget/metrics/rig_truth.hpp"

namespace understudy::app {

/// A rig and how it performs the scans, frame by frame; its surface is the scan of rest_frame.
struct FoundRig {
  RiggedMotion found;
  int rest_frame = 0;
};
/// Finds a rig in scans, metres, so many a second.
using RigFinder = std::function<FoundRig(const std::vector<Mesh>& scans, double fps)>;

/// The scans of a case, one a frame; after these edits; those that cannot be used are empty. Throws Error
/// naming what cannot be read.
std::vector<Mesh> scans_of(const Case& c, const ScanEdits& edits = {});

/// What a finder made of a case.
struct RigEvaluation {
  Metrics metrics;      ///< rig_figures()
  double found_ms = 0;  ///< how long finding took
  int64_t frames = 0;
};
struct RigEvaluationOptions {
  ScanEdits edits = {};   ///< of each scan, before anything is found
  bool held_out = false;  ///< the rig is found once more, in the even frames alone: held_out_figures()
};
/// Throws Error where the scans, the finder's frames and the
/// truth's are of different numbers.
RigEvaluation evaluate_rig(const Case& c, const RigTruth& truth, const RigFinder& find,
                           const RigEvaluationOptions& options = {});

/// Of a case of two bodies of a kind: both rigs are found, and the second performs what the first did, once
/// with its own rig and once as if there were the first of its scans alone: retarget_pct, retarget_scan_pct.
/// Throws Error where the case has no truth of it.
RigEvaluation evaluate_pair(const Case& c, const RigFinder& find, const ScanEdits& edits = {});

/// A rig found in the even frames alone, posed on the odd ones: surface_even_pct, surface_odd_pct and their
/// ratio, surface_held_out. Throws Error for fewer than four frames.
Metrics held_out_figures(const std::vector<Mesh>& scans, double fps, double size, const RigFinder& find);

}  // namespace understudy::app
