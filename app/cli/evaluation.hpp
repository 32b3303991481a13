// Evaluates the method on a folder of cases: what `eval` and `report` share.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/flat_pictures.hpp"
#include "app/cli/options.hpp"
#include "app/run/breakdown.hpp"
#include "app/run/latency.hpp"
#include "app/run/rig_finder.hpp"
#include "app/run/source.hpp"
#include "retarget/motion_space/motion_space_table.hpp"

namespace understudy::app {

struct EvalOptions {
  std::string cases, oracle, filter;
  int limit = 0;          ///< cases; 0: all
  int restart_every = 0;  ///< frames after which the method forgets the past; 0: never
  /// "fit": a body is fitted to each scan in place of the extractor; "complete": one to all known frames of a
  /// case at once; "nodes": of bodies of any kind, points of the first frame are followed; empty: none
  std::string baseline;
  std::string rig_method = "parts";  ///< one of rig_methods(): of bodies of any kind, without a baseline
  RigFinder find_rig = {};           ///< in its place; empty: the method's
  std::optional<int> file_shapes;    ///< the exported file is evaluated, too, with so many morph targets
  std::string body;                  ///< SMPL-format, of the baseline "fit"
  std::string fill = kDefaultMotionSpace;  ///< of cases with gaps: one of motion_spaces()
  std::string data;                        ///< a data folder for those that need clips
  bool held_out = false;  ///< of bodies of any kind: figures of frames that the rig was not found in, too
  // Of cases of the suite style, see StyleEvaluation:
  std::string judge;       ///< weights of `train style-judge`; empty: nobody judges
  std::string style_back;  ///< as --style: takes back what the style does; empty: none
  TempoChoice tempo;       ///< of what is styled
  double legs_m = 0;       ///< of who is to perform it, for the tempo "body"
  int worst = 20;          ///< frames listed as the worst
  bool pictures = false;   ///< moments of 2D poses are kept for pictures
  ScanEdits edits;         ///< of each scan, before anybody is looked for
  MethodOptions how;
};

struct CaseResult {
  std::string name, error;
  std::vector<std::string> tags;
  int64_t frames = 0, flagged = 0;
  Metrics metrics;
  Latency latency;
  GapScore gaps = {};
};

struct Evaluation {
  std::vector<CaseResult> results;
  Breakdown breakdown;
  Json keypoints;                        ///< KeypointEvaluation::summary()
  Json style;                            ///< StyleEvaluation::summary()
  std::string flat_engine;               ///< where cases are 2D poses
  std::vector<FlatMoment> flat_moments;  ///< FlatEvaluation::moments()
  Metrics mean;                          ///< over cases; what GapScore has is of all their gaps alike
  Latency latency;
  bool failed = false;  ///< some case
};

/// Evaluates every chosen case; `on_result` gets each when it is done. A case that fails has an error,
/// and the others go on. Throws Error when there is no case.
Evaluation evaluate(const EvalOptions& options, const std::function<void(const CaseResult&)>& on_result);

/// report.json: see Breakdown::json for "breakdown".
Json report_of(const EvalOptions& options, const Evaluation& evaluation);

}  // namespace understudy::app
