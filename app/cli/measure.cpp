#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/run/evaluator.hpp"
#include "app/run/flat_figures.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/registered_source.hpp"
#include "app/run/report.hpp"
#include "app/run/retargeted_source.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/pipeline/copy_transfer.hpp"

namespace understudy::app {
namespace {

struct MeasureOptions {
  SourceOptions source;
  MethodOptions how;
  std::string out;
  int every = 1;  ///< frames between looks at what is inside
  Registered registered = Registered::Auto;
};

/// The figures of one kind of skeletons. Their bones turn as the engine "copy" turns a target's.
class Judged {
 public:
  Judged(double fps, int every) : evaluator_(fps, nullptr, nullptr, every) {}
  void push(const Extraction& seen, const RetargetedFrame& from, float dt) {
    const SourceFrame& scan = from.scan;
    const Rotations local = bones_.push(seen, dt);
    EvaluatedFrame frame;
    frame.joints = frame.source_joints = &seen.joints;
    frame.rotations = &local;
    frame.scan = &scan.mesh;
    frame.limbs = from.result.limbs;
    frame.truth = scan.truth ? &*scan.truth : nullptr;
    frame.registered = scan.registered.rows() > 0 ? &scan.registered : nullptr;
    evaluator_.push(frame);
  }
  const Evaluator& evaluator() const { return evaluator_; }

 private:
  Evaluator evaluator_;
  CopyTransfer bones_;
};

/// What can be measured of the skeletons seen in scans: as extracted, and repaired and smoothed.
struct Measured {
  Measured(double fps, int every) : raw(fps, every), smooth(fps, every) {}
  Judged raw, smooth;
  int64_t frames = 0, flagged = 0;
  std::array<int64_t, kFourLimbs.size()> seen{};
  int person = 0;                  // who was measured
  std::vector<PersonSeen> people;  // all who are there
};

Measured measured(const MeasureOptions& options, const Networks& networks) {
  Retargeter retargeter(networks, retarget_options(options.how));
  auto opened = open_source(options.source);
  look_with(retargeter, *opened);
  const auto source = hide_topology(std::move(opened), options.source, options.registered);
  RetargetedSource retargeted(*source, retargeter, options.source, source_tools(options.how));
  Measured result(source->fps(), options.every);
  log::Tally problems;
  while (const auto frame = retargeted.next()) {
    check_interrupt("after " + std::to_string(frame->index) + " frames");
    const PerformedFrame& seen = frame->result;
    if (seen.flagged) {
      problems.warn("frame " + std::to_string(frame->scan.number) + ": " + seen.reason);
      continue;
    }
    const auto dt = static_cast<float>(1 / source->fps());
    result.raw.push(seen.observed, *frame, dt);
    result.smooth.push(seen.source, *frame, dt);
  }
  problems.finish();
  retargeted.check_used();
  result.frames = retargeted.frames();
  result.flagged = retargeted.flagged();
  result.person = retargeted.cut().person();
  result.people = retargeted.cut().people();
  result.seen = retargeted.seen();
  return result;
}

Json parts_json(const std::vector<PartFigures>& parts) {
  Json all = Json::array();
  for (const PartFigures& part : parts) {
    Json one = {{"part", part.part},
                {"vertices", part.vertices},
                {"fit_mm", part.fit_mm},
                {"rot_deg", part.rot_deg},
                {"rot_p95_deg", part.rot_p95_deg}};
    for (size_t i = 0; i < part.joints.size(); ++i)
      one["const_mm"][kJointNames[part.joints[i]]] = part.const_mm[i];
    all.push_back(std::move(one));
  }
  return all;
}

void print_parts(const std::vector<PartFigures>& parts) {
  for (const PartFigures& part : parts) {
    std::string joints;
    for (size_t i = 0; i < part.joints.size(); ++i)
      joints += printed(" %s %.0f", kJointNames[part.joints[i]], part.const_mm[i]);
    std::printf("%-15s %5d vertices, fit %4.1f mm | rot_deg %5.1f, p95 %5.1f | const_mm%s\n", part.part,
                part.vertices, part.fit_mm, part.rot_deg, part.rot_p95_deg, joints.c_str());
  }
}

Json people_json(const std::vector<PersonSeen>& people) {
  Json list = Json::array();
  for (const PersonSeen& one : people)
    list.push_back({{"id", one.id},
                    {"is_sure", one.is_sure},
                    {"frames", one.frames},
                    {"points", one.points / static_cast<double>(one.frames)},
                    {"moved_m", one.moved_m}});
  return list;
}

Json json_of(const Measured& result) {
  Json json;
  if (result.person > 0) json["person"] = result.person;
  json["frames"] = result.frames;
  json["flagged"] = result.flagged;
  const Evaluator& smooth = result.smooth.evaluator();
  for (size_t k = 0; k < kFourLimbs.size(); ++k) json["limbs_seen"][kFourLimbs[k]] = result.seen[k];
  json["metrics"] = to_json(smooth.metrics());
  json["raw"] = to_json(result.raw.evaluator().metrics());
  const std::vector<PartFigures> parts = smooth.registered().parts();
  if (!parts.empty()) json["registered"] = parts_json(parts);
  return json;
}

void print(const Measured& result, bool with_name) {
  print_parts(result.smooth.evaluator().registered().parts());
  const std::string name = with_name ? "person " + std::to_string(result.person) + ", " : "";
  std::printf("%sextracted: %s\n%ssmoothed: %s\n", name.c_str(),
              to_json(result.raw.evaluator().metrics()).dump().c_str(), name.c_str(),
              to_json(result.smooth.evaluator().metrics()).dump().c_str());
  for (size_t k = 0; k < kFourLimbs.size(); ++k)
    std::printf("%s%s seen in %lld of %lld frames\n", name.c_str(), kFourLimbs[k],
                static_cast<long long>(result.seen[k]), static_cast<long long>(result.frames));
}

/// Of 2D poses.
int measure_flat(const MeasureOptions& options) {
  check_writable(options.out);
  const std::string weights = nn::weights_folder(network_options(options.how));
  FlatSourceOptions source;
  source.path = options.source.path;
  source.fps = options.source.fps;
  source.person = options.source.person;
  const FlatFigures figures = flat_figures(source, *nn::load_length_reader(weights));
  for (const std::string& sentence : figures.told) log::info(sentence);
  Json report = report_header(weights);
  report["source"] = source.path;
  report["frames"] = figures.frames;
  report["flagged"] = figures.flagged;
  report["mended"] = figures.mended;
  report["metrics"] = to_json(figures.metrics);
  std::printf("%lld frames, %lld could not be used, in %lld left and right were exchanged: %s\n",
              static_cast<long long>(figures.frames), static_cast<long long>(figures.flagged),
              static_cast<long long>(figures.mended), report["metrics"].dump().c_str());
  if (!options.out.empty()) write_json(options.out, report);
  return 0;
}

int measure(const MeasureOptions& options) {
  if (looks_like_keypoints(options.source.path)) return measure_flat(options);
  US_CHECK(!options.how.method.style.any(),
           "--style: what is measured is the source as it is; `style --report` tells "
           "how a style changes it");
  check_writable(options.out);
  NetworkParts seeing;
  seeing.extractor = true;
  const Networks networks = nn::load_networks(network_options(options.how), seeing);
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  report["source"] = options.source.path;
  std::vector<PersonSeen> people;
  if (options.source.person == "all") {
    for (const int id : all_people(options.source, networks.extractor)) {
      MeasureOptions one = options;
      one.source.person = std::to_string(id);
      const Measured result = measured(one, networks);
      people = result.people;
      report["measured"].push_back(json_of(result));
      print(result, true);
    }
  } else {
    const Measured result = measured(options, networks);
    people = result.people;
    report.update(json_of(result));
    print(result, false);
  }
  if (!people.empty()) {
    report["people"] = people_json(people);
    std::printf("who is there: %s\n", in_words(people).c_str());
  }
  if (!options.out.empty()) write_json(options.out, report);
  return 0;
}

}  // namespace

Action declare_measure(CLI::App& command) {
  const auto options = std::make_shared<MeasureOptions>();
  command
      .add_option("source", options->source.path, "scans, or anything else that has motion, 2D poses, too")
      ->required();
  command.add_option("--out", options->out, "report as JSON");
  command.add_option("--every", options->every, "checks what is inside every so many frames only")
      ->check(CLI::Range(1, 1000000));
  std::map<std::string, Registered> choices;
  for (const char* name : kRegisteredNames) choices.emplace(name, static_cast<Registered>(choices.size()));
  command
      .add_option(
          "--registered", options->registered,
          "whether all frames share one topology: bones are then judged by it, and the method sees it "
          "shuffled (default: auto, by the faces)")
      ->transform(CLI::CheckedTransformer(choices));
  options->source.truth = true;
  add_source_options(command, options->source);
  add_method_options(command, options->how);
  return [options] { return measure(*options); };
}

}  // namespace understudy::app
