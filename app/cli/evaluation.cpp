#include "app/cli/evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <map>

#include "app/cli/flat_evaluation.hpp"
#include "app/cli/gap_evaluation.hpp"
#include "app/cli/generation_evaluation.hpp"
#include "app/cli/keypoint_evaluation.hpp"
#include "app/cli/lift_evaluation.hpp"
#include "app/cli/style_evaluation.hpp"
#include "app/run/case_source.hpp"
#include "app/run/file_figures.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/retargeted_source.hpp"
#include "app/run/target_file.hpp"
#include "retarget/base/clock.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/baselines/body_fit.hpp"
#include "retarget/baselines/node_rig.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/motion_space/person_fitter.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "retarget/scene/scene.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::app {

namespace {

/// Its target stands in T-pose as it is told, in the frame that the truth is in.
TargetOptions case_target(const Case& c) {
  TargetOptions options;
  options.path = c.target;
  options.import.units = "m";
  options.import.up = "y";
  options.import.floor = 0.0f;
  options.forward = false;
  options.rig = Rig::Ours;
  return options;
}

/// Where the figures of a case go.
struct CaseFigures {
  Evaluator& evaluator;
  CaseResult& result;
  const Truth* truth;  // null: none
  Metrics file;        // of the exported file, where asked for
};

/// One frame: of the target, where there is one, and of the skeleton in the scan.
void evaluate_frame(const RetargetedFrame& frame, const PreparedCharacter* target, Evaluator& evaluator) {
  const PerformedFrame& result = frame.result;
  EvaluatedFrame evaluated;
  Points vertices;
  if (target) {
    vertices = target->surface.in_file_order(result.vertices);
    evaluated.vertices = &vertices;
    evaluated.joints = &result.joints;
    evaluated.rotations = &result.pose.local;
  }
  evaluated.source_joints = &source_joints(result);
  evaluated.raw_joints =
      result.flagged || result.observed.unstyled ? &source_joints(result) : &result.observed.joints;
  evaluated.confidence = &result.confidence;
  const SeenJoints visibility = result.flagged ? SeenJoints::Zero() : result.source.visibility;
  evaluated.visibility = &visibility;
  evaluated.limbs = result.limbs;
  evaluated.scan = frame.scan.usable ? &frame.scan.mesh : nullptr;
  evaluator.push(evaluated);
}

/// The whole way, frame by frame; of cases without a target as far as the skeleton. With `oracle` the true
/// skeleton takes the place of the extracted one.
void evaluate_performance(const Case& c, const EvalOptions& options, Networks networks,
                          const std::shared_ptr<const PreparedCharacter>& character, CaseFigures& to) {
  SourceOptions from = case_source(c);
  from.edits = options.edits;
  const auto source = open_source(from);
  CharacterClip clip{c.name, c.fps, {}};
  const std::vector<Joints>* const oracle =
      options.oracle == "skeleton" && to.truth ? &to.truth->source_joints : nullptr;
  US_CHECK(options.oracle.empty() || (oracle && !oracle->empty()), c.truth,
           ": --oracle skeleton needs source_joints");
  Retargeter retargeter(std::move(networks), retarget_options(options.how));
  if (character) retargeter.set_target(character->target);
  RetargetedSource retargeted(*source, retargeter, from, source_tools(options.how));
  for (size_t t = 0;; ++t) {
    check_interrupt("in case " + c.name);
    US_CHECK(!oracle || t <= oracle->size(), c.name, ": the truth has too few source joints");
    if (options.restart_every > 0 && t > 0 && t % static_cast<size_t>(options.restart_every) == 0)
      retargeter.restart();
    const bool known = oracle && t < oracle->size();
    const auto frame = retargeted.next(known ? std::optional<Joints>((*oracle)[t]) : std::nullopt);
    if (!frame) break;
    clip.poses.push_back(frame->result.pose);
    to.result.latency.add(frame->times);
    evaluate_frame(*frame, character.get(), to.evaluator);
  }
  retargeted.check_used();
  to.result.flagged = retargeted.flagged();
  if (!options.file_shapes || !to.truth || to.truth->vertices.empty()) return;
  ExportBody body{character, retargeter.performer().deformer(), {}};
  body.file.their_rig = false;
  body.file.shapes = *options.file_shapes;
  to.file = file_figures(body, clip, *to.truth);
}

/// Everybody in a scene, followed.
class SceneWatch {
 public:
  SceneWatch(const EvalOptions& options, const Networks& networks)
      : options_(options), networks_(networks), scene_(networks.extractor) {}

  /// What is said of a scan, dt seconds after the one before.
  PredictedPeople push(const Mesh& scan, float dt) {
    const SceneFrame now = scene_.push(scan, dt);
    PredictedPeople said;
    said.owners.assign(scan.vertices.rows(), now.alone > 0 ? now.alone : kNobodysPoint);
    for (size_t i = 0; i < now.owner.size(); ++i)
      said.owners[i] = now.owner[i] > 0 ? now.owner[i] : kNobodysPoint;
    for (const ScenePerson& person : now.people) {
      if (person.unseen_s > 0) continue;
      Retargeter& one =
          followed_.try_emplace(person.id, networks_, retarget_options(options_.how)).first->second;
      const Observation seen = one.observer().observe(part_of(scan, now, person.id), dt);
      scene_.tell(person.id, seen, refusal(seen).empty());
      const PerformedFrame frame = one.push(seen, dt);
      if (!frame.flagged) said.people.push_back({person.id, frame.source.joints});
    }
    return said;
  }

 private:
  const EvalOptions& options_;
  const Networks& networks_;
  Scene scene_;
  std::map<int, Retargeter> followed_;
};

/// Each frame of a source and what is seen in it, without a target.
template <class See>
void watch(const SourceOptions& of, const EvalOptions& options, const Networks& networks, See&& see) {
  const auto source = open_source(of);
  Retargeter retargeter(networks, retarget_options(options.how));
  RetargetedSource retargeted(*source, retargeter, of);
  while (const auto frame = retargeted.next()) {
    check_interrupt("in " + of.path);
    see(*frame);
  }
}

/// Who is in a scan; then each of these people in scans of them alone.
void evaluate_scene(const Case& c, const EvalOptions& options, const Networks& networks, CaseFigures& to) {
  US_CHECK(options.edits.empty(), c.name, ": points are taken out of no scene: each has an owner");
  const auto source = open_source(case_source(c));
  SceneWatch watched(options, networks);
  while (const auto frame = source->next()) {
    check_interrupt("in case " + c.name);
    US_CHECK(frame->usable, c.source, ": ", frame->problem);
    const auto began = std::chrono::steady_clock::now();
    const PredictedPeople said = watched.push(frame->mesh, static_cast<float>(1 / source->fps()));
    FrameTimes times;
    times.extract = times.total = ms_since(began);
    to.result.latency.add(times);
    to.result.flagged += said.people.empty();
    EvaluatedFrame evaluated;
    evaluated.people = &said;
    to.evaluator.push(evaluated);
  }
  for (size_t person = 0; person < c.alone.size(); ++person) {
    SourceOptions alone = case_source(c);
    alone.path = c.alone[person];
    watch(alone, options, networks, [&](const RetargetedFrame& frame) {
      to.evaluator.push_alone(frame.index, person, frame.result.source.joints);
    });
  }
}

/// True rotations, root and joints of the target: only weights and offsets are the method's.
void evaluate_deformation(const Truth& truth, const Mesh& target, Deformer& deformer, CaseFigures& to) {
  US_CHECK(truth.target_joints && !truth.joints.empty() && !truth.rotations.empty(),
           "--oracle pose needs target_joints, joints and rotations in the truth");
  deformer.bind(target.vertices, *truth.target_joints);
  for (int64_t t = 0; t < truth.frames; ++t) {
    const size_t i = t;
    const Pose pose{truth.rotations[i], truth.joints[i].row(Pelvis).transpose()};
    FrameTimes times;
    const auto began = std::chrono::steady_clock::now();
    const Points vertices = deformer.deform(pose);
    times.deform = times.total = ms_since(began);
    to.result.latency.add(times);
    const Joints joints = forward_kinematics(*truth.target_joints, pose).joints;
    to.evaluator.push({&vertices, &joints, &pose.local, nullptr, nullptr, nullptr, nullptr});
  }
}

FoundRig find_nodes(const std::vector<Mesh>& scans, double fps) {
  std::vector<Points> frames;
  frames.reserve(scans.size());
  for (const Mesh& scan : scans) frames.push_back(scan.vertices);
  return {node_rig(frames, fps), 0};
}

/// What evaluates all cases alike.
struct Bench {
  const EvalOptions& options;
  std::shared_ptr<const FitBody> fit = {};      // null: no baseline
  std::shared_ptr<MotionSpace> space = {};      // made for the first case with gaps
  std::unique_ptr<StyleEvaluation> style = {};  // made for the first case of the suite style

  KeypointEvaluation keypoints = {};
  std::unique_ptr<FlatEvaluation> flat = {};  // made for the first case of 2D poses

  FlatEvaluation& flat_poses() {
    if (!flat) flat = std::make_unique<FlatEvaluation>(options);
    return *flat;
  }
  StyleEvaluation& styles() {
    if (!style) style = std::make_unique<StyleEvaluation>(options);
    return *style;
  }
  RigFinder rig_finder_of(const std::string& kind) {
    if (options.baseline == "nodes") return find_nodes;
    if (options.find_rig) return options.find_rig;
    const bool is_network = rig_method_named(options.rig_method).weights != nullptr;
    return is_network ? keypoints.finder(options, kind) : rig_finder();
  }
  MotionSpace& filling() {
    if (space) return *space;
    const bool plain = motion_space_named(options.fill).make;
    space = plain ? make_motion_space(options.fill, options.data)
                  : nn::load_motion_space(nn::weights_folder(network_options(options.how)), options.fill);
    return *space;
  }
};

void check_completing(const EvalOptions& options, const Case& c) {
  US_CHECK(options.oracle.empty(), c.name, ": --baseline complete is of scans and markers, not of --oracle");
  US_CHECK(c.gaps->is_whole() && !(c.source.empty() && c.markers.empty()), c.name,
           ": --baseline complete is of the suite sparse, with scans or markers");
}

/// The same of a case with gaps.
void check_gap_options(const EvalOptions& options, const Case& c) {
  US_CHECK(options.oracle.empty() || options.oracle == "pose", c.name,
           ": of frames that are to be made no skeleton is known: --oracle ", options.oracle,
           " does not apply");
  US_CHECK(!options.file_shapes && options.restart_every == 0, c.name,
           ": only frames that are not known are evaluated: --file and --restart-every do not apply");
  US_CHECK(!c.truth.empty(), c.name, ": frames that are to be made need a ground truth");
  if (options.baseline == "complete") return check_completing(options, c);
  US_CHECK(options.oracle == "pose" || (!c.source.empty() && !c.target.empty()), c.name, ": it has no ",
           c.source.empty() ? "scans" : "target", ": only --oracle pose can evaluate it");
}

/// What is asked of a case must mean something there.
void check_options(const EvalOptions& options, const Case& c) {
  if (c.gaps) return check_gap_options(options, c);
  const bool performed = !c.target.empty();
  US_CHECK(performed || (options.oracle.empty() && !options.file_shapes && options.restart_every == 0),
           c.name, ": it has no target: --oracle, --file and --restart-every do not apply");
  US_CHECK(options.oracle != "pose" ||
               (options.baseline.empty() && !options.file_shapes && options.restart_every == 0),
           "--oracle pose uses the true poses: --baseline, --file and --restart-every do not apply");
}

/// The poses that the known frames of a case are performed with.
KnownMotion performed_motion(const Case& c, const EvalOptions& options, Retargeter& retargeter,
                             const Joints& rest, CaseResult& result) {
  SourceOptions from = case_source(c);
  from.edits = options.edits;
  const auto source = open_source(from);
  const std::vector<bool> known = known_frames(*c.gaps);
  KnownMotion performed{
      {static_cast<float>(c.fps), std::vector<Pose>(known.size()), {}, std::vector<Standing>(known.size())},
      std::vector<KnownParts>(known.size(), all_parts(false)),
      rest};
  RetargetedSource retargeted(*source, retargeter, from);
  while (const auto frame = retargeted.next()) {
    check_interrupt("in case " + c.name);
    const int64_t t = frame->scan.number;
    US_CHECK(t >= 0 && t < c.gaps->frames, c.source, ": has a frame ", t, ", case.json says ", c.gaps->frames,
             " frames");
    if (!known[static_cast<size_t>(t)]) continue;
    result.latency.add(frame->times);
    result.flagged += frame->result.flagged;
    performed.motion.poses[static_cast<size_t>(t)] = frame->result.pose;
    performed.motion.standing[static_cast<size_t>(t)] = frame->result.standing;
    if (!frame->result.flagged) performed.known[static_cast<size_t>(t)] = all_parts(true);
  }
  retargeted.check_used();
  return performed;
}

/// A case of which the frames in gaps are evaluated, by true poses beside them.
void evaluate_true_gap_case(Bench& bench, const Case& c, const Truth& truth, CaseFigures& to) {
  for (const double ms : evaluate_true_gaps({c, truth, {}}, bench.filling(), to.evaluator)) {
    FrameTimes times;
    times.total = ms;
    to.result.latency.add(times);
  }
}

/// The same by poses performed from scans.
void evaluate_performed_gap_case(Bench& bench, const Case& c, const Truth& truth, CaseFigures& to) {
  Networks networks = nn::load_networks(network_options(bench.options.how), {true, true, true, true, false});
  const std::shared_ptr<const PreparedCharacter> character = open_target(case_target(c), networks);
  if (bench.fit) networks.extractor = std::make_shared<BodyFit>(bench.fit);
  Retargeter retargeter(std::move(networks), retarget_options(bench.options.how));
  retargeter.set_target(character->target);
  const KnownMotion performed =
      performed_motion(c, bench.options, retargeter, character->target.joints, to.result);
  GapSurface surface;
  if (!truth.vertices.empty()) {
    surface.made = [&](const Pose& pose) {
      return character->surface.in_file_order(retargeter.performer().deformer()->deform(pose));
    };
    surface.truth = [&](int64_t t) { return truth.frame_vertices(t); };
    surface.is_dense = true;
  }
  evaluate_performed_gaps({c, truth, surface}, bench.filling(), performed, to.evaluator);
}

/// A body of its own is fitted to all that is known (SparseFitter); the target is not looked at.
void evaluate_completed_case(Bench& bench, const Case& c, const Truth& truth, CaseFigures& to) {
  NetworkParts seeing;
  seeing.extractor = true;
  SparseCapture capture;
  capture.fps = c.fps;
  for (KnownFrame& frame : known_frames_of(c))
    capture.frames.push_back({frame.seconds, std::move(frame.points), std::move(frame.markers)});
  bench.filling();
  PersonFitter fitter(nn::load_networks(network_options(bench.options.how), seeing).extractor, bench.space);
  const auto began = std::chrono::steady_clock::now();
  CompletedCapture made = fitter.complete(capture, [&](float) { check_interrupt("in case " + c.name); });
  FrameTimes times;
  times.total = ms_since(began);
  to.result.latency.add(times);
  GapSurface surface;
  if (!truth.vertices.empty()) {
    surface.made = [&](const Pose& pose) {
      return linear_blend_skinning(made.vertices, made.weights, made.rest,
                                   forward_kinematics(made.rest, pose));
    };
    surface.truth = [&](int64_t t) { return truth.frame_vertices(t); };
    surface.is_dense = surface.is_another = true;
  }
  const Completion completion{made.motion, made.doubt_m};
  evaluate_completion({c, truth, surface}, made.rest, completion, to.evaluator);
}

void evaluate_gap_case(Bench& bench, const Case& c, CaseResult& result) {
  const Truth truth = read_truth(c.truth);
  Evaluator evaluator(c.fps, &truth, nullptr);
  CaseFigures to{evaluator, result, &truth, {}};
  if (bench.options.oracle == "pose")
    evaluate_true_gap_case(bench, c, truth, to);
  else if (bench.options.baseline == "complete")
    evaluate_completed_case(bench, c, truth, to);
  else
    evaluate_performed_gap_case(bench, c, truth, to);
  const std::vector<bool> known = window_known(*c.gaps);
  result.frames = ssize(window_starts(*c.gaps)) * std::count(known.begin(), known.end(), false);
  result.metrics = evaluator.metrics();
  result.gaps = evaluator.gaps();
}

/// A case of a body of any kind: its rig is found in all of its scans together.
void evaluate_rig_case(Bench& bench, const Case& c, const RigTruth& truth, CaseResult& result,
                       Breakdown& breakdown) {
  const EvalOptions& options = bench.options;
  US_CHECK(options.baseline.empty() || options.baseline == "nodes", c.name, ": --baseline ", options.baseline,
           " is of people, and this is any body");
  const std::string kind = c.tags.size() > 1 ? c.tags[1] : c.name;
  const RigFinder find = bench.rig_finder_of(kind);
  const RigEvaluation evaluation = c.performed_truth.empty()
                                       ? evaluate_rig(c, truth, find, {options.edits, options.held_out})
                                       : evaluate_pair(c, find, options.edits);
  FrameTimes times;
  times.extract = times.total = evaluation.found_ms / static_cast<double>(evaluation.frames);
  for (int64_t t = 0; t < evaluation.frames; ++t) result.latency.add(times);
  result.frames = evaluation.frames;
  result.metrics = evaluation.metrics;
  breakdown.add_kind(kind, result.metrics);
  bench.keypoints.add(kind, truth);
}

void evaluate_case(Bench& bench, const std::string& folder, const Case& c, CaseResult& result,
                   Breakdown& breakdown) {
  const EvalOptions& options = bench.options;
  if (c.style) return bench.styles().evaluate(c, result);
  if (c.flat) {
    bench.flat_poses().evaluate(c, result);
    return breakdown.add_kind(c.tags.size() > 1 ? c.tags[1] : c.name, result.metrics);
  }
  if (!c.rig.empty()) {
    evaluate_generation(c, options, result);
    return breakdown.add_kind(c.tags.size() > 1 ? c.tags[1] : c.name, result.metrics);
  }
  if (c.lifted) {
    evaluate_lifted(c, options, result);
    return breakdown.add_kind(c.tags.size() > 1 ? c.tags[1] : c.name, result.metrics);
  }
  check_options(options, c);
  if (c.gaps) return evaluate_gap_case(bench, c, result);
  std::optional<Truth> truth;
  if (!c.truth.empty()) truth = read_truth(c.truth);
  if (truth && truth->rig) return evaluate_rig_case(bench, c, *truth->rig, result, breakdown);
  US_CHECK(options.baseline != "nodes", c.name, ": --baseline nodes is of bodies whose rig is to be found");
  US_CHECK(options.oracle.empty() || truth, c.name, ": --oracle needs a ground truth");
  std::optional<Mesh> mesh;  // with the file's own vertices
  std::shared_ptr<const PreparedCharacter> target;
  const bool knows_poses = options.oracle == "pose", performed = !c.target.empty();
  US_CHECK(
      !options.how.method.style.any() || (performed && options.oracle.empty() && options.restart_every == 0),
      c.name, ": --style is of cases with a target, without --oracle and --restart-every");
  Networks networks = nn::load_networks(network_options(options.how),
                                        {!knows_poses, performed && !knows_poses, performed && !knows_poses,
                                         performed, performed && !knows_poses});
  if (knows_poses) {
    mesh = read_mesh(c.target);
  } else if (performed) {
    target = open_target(case_target(c), networks);
    mesh = target->target_in_file_order();
  }
  if (bench.fit) networks.extractor = std::make_shared<BodyFit>(bench.fit);  // of the source alone
  Evaluator evaluator(c.fps, truth ? &*truth : nullptr, mesh ? &*mesh : nullptr);
  CaseFigures to{evaluator, result, truth ? &*truth : nullptr, {}};
  if (knows_poses)
    evaluate_deformation(*truth, *mesh, *networks.deformer, to);
  else if (truth && !truth->scene.empty())
    evaluate_scene(c, options, networks, to);
  else
    evaluate_performance(c, options, std::move(networks), target, to);
  result.frames = result.latency.frames();
  result.metrics = evaluator.metrics();
  result.metrics.insert(result.metrics.end(), to.file.begin(), to.file.end());
  if (truth) breakdown.add(folder, c, evaluator, *truth);
}

Json case_json(const CaseResult& result) {
  Json json = {{"name", result.name}, {"tags", result.tags}};
  if (!result.error.empty()) {
    json["error"] = result.error;
    return json;
  }
  json["frames"] = result.frames;
  json["flagged"] = result.flagged;
  json["metrics"] = to_json(result.metrics);
  json["ms"] = to_json(result.latency, 0.5);
  json["ms_p95"] = to_json(result.latency, 0.95);
  return json;
}

/// Those whose name fits; with a limit, so many from the first to the last, evenly spread: of bodies x
/// motions every body and every motion.
std::vector<std::string> chosen_cases(const EvalOptions& options) {
  std::vector<std::string> fitting;
  for (const std::string& folder : case_folders(options.cases))
    if (folder.find(options.filter, folder.find_last_of('/') + 1) != std::string::npos)
      fitting.push_back(folder);
  US_CHECK(!fitting.empty(), options.cases, ": no case's name contains ", options.filter);
  const size_t limit = options.limit;
  if (limit == 0 || limit >= fitting.size()) return fitting;
  std::vector<std::string> chosen;
  for (size_t i = 0; i < limit; ++i)
    chosen.push_back(fitting[limit == 1 ? 0 : i * (fitting.size() - 1) / (limit - 1)]);
  return chosen;
}

/// A gap counts as much in a long clip as in a short one.
void set_gap_means(Evaluation& evaluation) {
  GapScore all;
  for (const CaseResult& result : evaluation.results) all.append(result.gaps);
  for (const auto& [key, value] : all.figures())
    for (auto& [name, mean] : evaluation.mean)
      if (name == key) mean = value;
}

}  // namespace

Evaluation evaluate(const EvalOptions& options, const std::function<void(const CaseResult&)>& on_result) {
  Bench bench{options};
  if (options.baseline == "fit") {
    US_CHECK(!options.body.empty(), "the baseline \"fit\" needs --body, an SMPL-format body");
    bench.fit = std::make_shared<const FitBody>(read_smpl_body(options.body));
  }
  Evaluation evaluation;
  evaluation.breakdown = Breakdown(options.worst);
  std::vector<Metrics> metrics;
  for (const std::string& folder : chosen_cases(options)) {
    CaseResult result;
    result.name = folder.substr(folder.find_last_of('/') + 1);
    result.error = failure_of([&] {
      const Case c = read_case(folder);
      result.name = c.name;
      result.tags = c.tags;
      evaluate_case(bench, folder, c, result, evaluation.breakdown);
    });
    check_interrupt("in case " + result.name);
    on_result(result);
    if (result.error.empty()) {
      metrics.push_back(result.metrics);
      evaluation.latency.add(result.latency);
    }
    evaluation.failed |= !result.error.empty();
    evaluation.results.push_back(std::move(result));
  }
  evaluation.mean = mean_metrics(metrics);
  set_gap_means(evaluation);
  if (bench.flat)
    evaluation.flat_engine = flat_engine(options.how), evaluation.flat_moments = bench.flat->moments();
  evaluation.keypoints = bench.keypoints.summary();
  if (bench.style) evaluation.style = bench.style->summary();
  return evaluation;
}

Json report_of(const EvalOptions& options, const Evaluation& evaluation) {
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  report["engine"] = evaluation.flat_engine.empty() ? options.how.method.engine : evaluation.flat_engine;
  if (!options.oracle.empty()) report["oracle"] = options.oracle;
  if (options.edits.floor) report["remove_floor"] = true;
  if (options.edits.largest_cluster) report["largest_part"] = true;
  if (options.edits.crop) report["crop"] = true;
  if (!options.baseline.empty()) report["baseline"] = options.baseline;
  const auto has_gaps = [](const CaseResult& result) { return !result.gaps.empty(); };
  if (std::any_of(evaluation.results.begin(), evaluation.results.end(), has_gaps))
    report["fill"] = options.fill;
  const Method& method = options.how.method;
  if (!method.offsets) report["offsets"] = false;
  for (const MethodSwitch& one : kSwitches)
    if (!(method.*one.on)) report[one.name] = false;
  if (method.predict) report["predict"] = true;
  if (method.extractor != Method().extractor) report["extractor"] = method.extractor;
  for (const Proportion& one : kProportions)
    if (method.*one.value != Method().*one.value) report[one.name] = method.*one.value;
  if (method.path != Method().path) report["path"] = kRootNames[static_cast<size_t>(method.path)];
  for (const BoneTurn& turn : options.how.rest_pose) report["rest_pose"].push_back(turn_words(turn));
  if (method.style.any()) report["style"] = style_json(method.style);
  if (options.tempo.any()) report["tempo"] = options.tempo.tempo;
  if (options.restart_every > 0) report["restart_every"] = options.restart_every;
  report["cases"] = Json::array();
  for (const CaseResult& result : evaluation.results) report["cases"].push_back(case_json(result));
  report["mean"] = to_json(evaluation.mean);
  report["ms"] = to_json(evaluation.latency, 0.5);
  report["ms_p95"] = to_json(evaluation.latency, 0.95);
  report["breakdown"] = evaluation.breakdown.json();
  if (!evaluation.keypoints.is_null()) report["keypoints"] = evaluation.keypoints;
  if (options.rig_method != EvalOptions().rig_method) report["rig_method"] = options.rig_method;
  if (!evaluation.style.is_null()) report["style_figures"] = evaluation.style;
  return report;
}

}  // namespace understudy::app
