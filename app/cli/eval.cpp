#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "app/cli/attempt.hpp"
#include "app/cli/commands.hpp"
#include "app/cli/job.hpp"
#include "app/cli/options.hpp"
#include "app/run/case_folder.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/judge.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/mesh_reader.hpp"

namespace understudy::app {
namespace {

struct EvalOptions {
  std::string cases, out, oracle, filter;
  int limit = 0;  ///< cases; 0: all
  nn::NetworkOptions networks;
  RetargetOptions retarget;
};

struct Verdict {
  std::string name, error;
  std::vector<std::string> tags;
  int64_t frames = 0, flagged = 0;
  Metrics metrics;
  Latency latency;
};

/// What is true of a case by the format's definition, so that nothing has to be guessed: metres, y up, the
/// floor at 0.
SourceOptions case_source(const Case& c) {
  SourceOptions options;
  options.path = c.source;
  options.fps = c.fps;
  options.import.units = "m";
  options.import.up = "y";
  options.import.floor = 0.0f;
  return options;
}

/// Its target stands in T-pose as it is told, in the frame that the truth is in.
TargetOptions case_target(const Case& c) {
  TargetOptions options;
  options.path = c.target;
  options.import.units = "m";
  options.import.up = "y";
  options.import.floor = 0.0f;
  options.forward = false;
  options.rig = "ours";
  return options;
}

/// Where the figures of a case go.
struct Judging {
  Judge& judge;
  Verdict& verdict;
  const Truth* truth;  // null: none
};

double ms_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
}

/// Only the skeletons of the scans: cases without a target. Repaired and smoothed as for a performance.
void judge_extraction(const Case& c, SkeletonExtractor& extractor, Judging& to) {
  const auto source = open_source(case_source(c));
  JointFilter filter;
  std::optional<Joints> raw, smooth;  // of the last good frame
  float waited_s = 0;
  while (true) {
    check_interrupt("in case " + c.name);
    FrameTimes times;
    const auto began = std::chrono::steady_clock::now();
    const auto frame = source->next();
    if (!frame) break;
    times.read = ms_since(began);
    waited_s += static_cast<float>(1 / c.fps);
    const std::string problem = failure_of([&] {
      const Extraction seen = extractor.extract(frame->mesh);
      raw = seen.joints;
      smooth = filter.push(seen, waited_s).joints;
      waited_s = 0;
    });
    US_CHECK(smooth, frame->path, ": ", problem);
    times.total = ms_since(began);
    times.extract = times.total - times.read;
    to.verdict.latency.add(times);
    to.verdict.flagged += !problem.empty();
    JudgedFrame judged;
    judged.source_joints = &*smooth;
    judged.raw_joints = &*raw;
    judged.scan = frame->usable ? &frame->mesh : nullptr;
    to.judge.push(judged);
  }
}

/// The whole way, frame by frame; with `oracle` the true skeleton takes the place of the extracted one.
void judge_performance(const Case& c, const EvalOptions& options, Networks networks,
                       const PreparedCharacter& target, Judging& to) {
  const auto source = open_source(case_source(c));
  const std::vector<Joints>* const oracle =
      options.oracle == "skeleton" && to.truth ? &to.truth->source_joints : nullptr;
  US_CHECK(options.oracle.empty() || (oracle && !oracle->empty()), c.truth,
           ": --oracle skeleton wants source_joints");
  Performer performer(*source, target.target, std::move(networks), options.retarget);
  for (size_t t = 0;; ++t) {
    check_interrupt("in case " + c.name);
    US_CHECK(!oracle || t <= oracle->size(), c.name, ": the truth has too few source joints");
    const bool known = oracle && t < oracle->size();
    const auto frame = known ? performer.next((*oracle)[t]) : performer.next();
    if (!frame) break;
    const RetargetedFrame& result = frame->result;
    to.verdict.latency.add(frame->times);
    to.verdict.flagged += result.flagged;
    const Points vertices = target.surface.in_file_order(result.vertices);
    to.judge.push({&vertices, &result.joints, &result.pose.local, &frame->source_joints,
                   result.flagged ? &frame->source_joints : &result.source_raw.joints,
                   frame->scan.usable ? &frame->scan.mesh : nullptr});
  }
}

/// True rotations, root and joints of the target: only weights and offsets are the method's.
void judge_deformation(const Truth& truth, const Mesh& target, Deformer& deformer, Judging& to) {
  US_CHECK(truth.target_joints && !truth.joints.empty() && !truth.rotations.empty(),
           "--oracle pose wants target_joints, joints and rotations in the truth");
  deformer.bind(target.vertices, *truth.target_joints);
  for (int64_t t = 0; t < truth.frames; ++t) {
    const size_t i = static_cast<size_t>(t);
    const Pose pose{truth.rotations[i], truth.joints[i].row(Pelvis).transpose()};
    FrameTimes times;
    const auto began = std::chrono::steady_clock::now();
    const Points vertices = deformer.deform(pose);
    times.deform = times.total = ms_since(began);
    to.verdict.latency.add(times);
    const Joints joints = forward_kinematics(*truth.target_joints, pose).joints;
    to.judge.push({&vertices, &joints, &pose.local, nullptr, nullptr, nullptr});
  }
}

void judge_case(const Case& c, const EvalOptions& options, Verdict& verdict) {
  std::optional<Truth> truth;
  if (!c.truth.empty()) truth = read_truth(c.truth);
  US_CHECK(options.oracle.empty() || truth, c.name, ": --oracle wants a truth");
  std::optional<Mesh> mesh;  // with the file's own vertices
  std::shared_ptr<const PreparedCharacter> target;
  Networks networks;
  if (options.oracle == "pose" && !c.target.empty()) {
    mesh = read_mesh(c.target);
  } else {
    networks = nn::load_networks(options.networks);
    if (!c.target.empty()) target = open_target(case_target(c), networks);
    if (target) mesh = target->target_in_file_order();
  }
  Judge judge(c.fps, truth ? &*truth : nullptr, mesh ? &*mesh : nullptr);
  Judging to{judge, verdict, truth ? &*truth : nullptr};
  if (target)
    judge_performance(c, options, std::move(networks), *target, to);
  else if (mesh)
    judge_deformation(*truth, *mesh, *nn::load_deformer(options.networks), to);
  else
    judge_extraction(c, *networks.extractor, to);
  verdict.frames = verdict.latency.frames();
  verdict.metrics = judge.metrics();
}

Json case_json(const Verdict& verdict) {
  Json json = {{"name", verdict.name}, {"tags", verdict.tags}};
  if (!verdict.error.empty()) {
    json["error"] = verdict.error;
    return json;
  }
  json["frames"] = verdict.frames;
  json["flagged"] = verdict.flagged;
  json["metrics"] = to_json(verdict.metrics);
  json["ms"] = to_json(verdict.latency, 0.5);
  json["ms_p95"] = to_json(verdict.latency, 0.95);
  return json;
}

std::string one_line(const Verdict& verdict) {
  if (!verdict.error.empty()) return verdict.name + ": ERROR " + verdict.error;
  std::string line = verdict.name + ": " + std::to_string(verdict.frames) + " frames";
  if (verdict.flagged > 0) line += ", " + std::to_string(verdict.flagged) + " flagged";
  for (const char* key :
       {"mpjpe_m", "pa_mpjpe_m", "pa_mpvd_m", "medl_mm", "extraction_mpjpe_mm", "extraction_swap_rate"})
    for (const auto& [name, value] : verdict.metrics) {
      char text[64];
      std::snprintf(text, sizeof text, ", %s %.4g", key, value);
      if (name == key) line += text;
    }
  return line;
}

/// The report as a whole: written anew after each case, so that a long evaluation can be looked at.
Json whole_report(const EvalOptions& options, const std::vector<Verdict>& verdicts) {
  Json report = report_header(nn::weights_folder(options.networks));
  report["engine"] = options.networks.engine;
  if (!options.oracle.empty()) report["oracle"] = options.oracle;
  report["cases"] = Json::array();
  std::vector<Metrics> metrics;
  Latency latency;
  for (const Verdict& verdict : verdicts) {
    report["cases"].push_back(case_json(verdict));
    if (!verdict.error.empty()) continue;
    metrics.push_back(verdict.metrics);
    latency.add(verdict.latency);
  }
  report["mean"] = to_json(mean_metrics(metrics));
  report["ms"] = to_json(latency, 0.5);
  report["ms_p95"] = to_json(latency, 0.95);
  return report;
}

std::vector<std::string> chosen_cases(const EvalOptions& options) {
  std::vector<std::string> chosen;
  for (const std::string& folder : case_folders(options.cases)) {
    if (options.limit > 0 && static_cast<int>(chosen.size()) >= options.limit) break;
    if (folder.find(options.filter, folder.find_last_of('/') + 1) != std::string::npos)
      chosen.push_back(folder);
  }
  US_CHECK(!chosen.empty(), options.cases, ": no case's name holds ", options.filter);
  return chosen;
}

int eval(const EvalOptions& options) {
  check_writable(options.out);
  std::vector<Verdict> verdicts;
  bool failed = false;
  for (const std::string& folder : chosen_cases(options)) {
    Verdict verdict;
    verdict.name = folder.substr(folder.find_last_of('/') + 1);
    verdict.error = failure_of([&] {
      const Case c = read_case(folder);
      verdict.name = c.name;
      verdict.tags = c.tags;
      judge_case(c, options, verdict);
    });
    check_interrupt("in case " + verdict.name);
    failed |= !verdict.error.empty();
    verdicts.push_back(std::move(verdict));
    std::printf("%s\n", one_line(verdicts.back()).c_str());
    std::fflush(stdout);
  }
  const Json report = whole_report(options, verdicts);
  if (!options.out.empty()) write_json(options.out, report);
  std::printf("mean: %s\n", report["mean"].dump().c_str());
  return failed ? 1 : 0;
}

}  // namespace

Action declare_eval(CLI::App& command) {
  const auto options = std::make_shared<EvalOptions>();
  command.add_option("cases", options->cases, "a folder of cases, or one case")->required();
  command.add_option("--out", options->out, "report as JSON");
  command
      .add_option("--oracle", options->oracle,
                  "skeleton: true source joints; pose: true rotations, root, target joints")
      ->check(CLI::IsMember({"skeleton", "pose"}));
  command.add_option("--filter", options->filter, "only cases whose name holds this");
  command.add_option("--limit", options->limit, "at most so many cases")->check(CLI::NonNegativeNumber);
  command.add_flag("!--no-foot-lock", options->retarget.lock_feet, "standing feet may slide");
  add_network_options(command, options->networks);
  return [options] { return eval(*options); };
}

}  // namespace understudy::app
