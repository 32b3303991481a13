#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/run/evaluator.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/run/retargeted_source.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"

namespace understudy::app {
namespace {

struct MeasureOptions {
  SourceOptions source;
  MethodOptions how;
  std::string out;
  int every = 1;  ///< frames between looks at what is inside
};

/// What can be measured of the skeletons seen in scans without ground truth: as extracted, and repaired
/// and smoothed.
struct Measured {
  explicit Measured(double fps, int every)
      : raw(fps, nullptr, nullptr, every), smooth(fps, nullptr, nullptr, every) {}
  Evaluator raw, smooth;
  int64_t frames = 0, flagged = 0;
};

void push(Evaluator& evaluator, const Joints& joints, const Mesh& scan) {
  EvaluatedFrame frame;
  frame.joints = frame.source_joints = &joints;
  frame.scan = &scan;
  evaluator.push(frame);
}

Measured measured(const MeasureOptions& options) {
  const auto source = open_source(options.source);
  NetworkParts seeing;
  seeing.extractor = true;
  Retargeter retargeter(nn::load_networks(network_options(options.how), seeing),
                        retarget_options(options.how));
  RetargetedSource retargeted(*source, retargeter, options.source.path, options.source.edits);
  Measured result(source->fps(), options.every);
  log::Tally problems;
  while (const auto frame = retargeted.next()) {
    check_interrupt("after " + std::to_string(frame->index) + " frames");
    const PerformedFrame& seen = frame->result;
    if (seen.flagged) {
      problems.warn("frame " + std::to_string(frame->scan.number) + ": " + seen.reason);
      continue;
    }
    push(result.raw, seen.observed.joints, frame->scan.mesh);
    push(result.smooth, seen.source.joints, frame->scan.mesh);
  }
  problems.finish();
  retargeted.check_used();
  result.frames = retargeted.frames();
  result.flagged = retargeted.flagged();
  return result;
}

int measure(const MeasureOptions& options) {
  check_writable(options.out);
  const Measured result = measured(options);
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  report["source"] = options.source.path;
  report["frames"] = result.frames;
  report["flagged"] = result.flagged;
  report["metrics"] = to_json(result.smooth.metrics());
  report["raw"] = to_json(result.raw.metrics());
  if (!options.out.empty()) write_json(options.out, report);
  std::printf("extracted: %s\nsmoothed: %s\n", report["raw"].dump().c_str(),
              report["metrics"].dump().c_str());
  return 0;
}

}  // namespace

Action declare_measure(CLI::App& command) {
  const auto options = std::make_shared<MeasureOptions>();
  command.add_option("source", options->source.path, "scans, or anything else that has motion")->required();
  command.add_option("--out", options->out, "report as JSON");
  command.add_option("--every", options->every, "checks what is inside every so many frames only")
      ->check(CLI::Range(1, 1000000));
  add_source_options(command, options->source);
  add_method_options(command, options->how);
  return [options] { return measure(*options); };
}

}  // namespace understudy::app
