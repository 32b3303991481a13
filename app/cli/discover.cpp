#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/cli/preview.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/rig_moment.hpp"
#include "app/cli/studio.hpp"
#include "app/run/bone_search.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/rig_finder.hpp"
#include "app/run/rig_performance.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/discovery/rig_figures.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

struct DiscoverOptions {
  SourceOptions source;
  std::string out, result, report, preview;
  std::string rig, perform, matches;
  BoneSearch search;
  std::string weights;
};

void check_outputs(const DiscoverOptions& options) {
  US_CHECK(
      !options.out.empty() || !options.result.empty() || !options.report.empty() || !options.preview.empty(),
      "nothing is to be written: name a character (--out), an archive (--result), a report (--report) or "
      "a picture (--preview)");
  if (!options.out.empty()) check_rig_path(options.out);
  for (const std::string& path : {options.out, options.result, options.report, options.preview}) {
    check_not_read(path, {options.source.path, options.rig, options.perform, options.matches});
    check_writable(path);
  }
  if (!options.matches.empty() && !std::filesystem::exists(options.matches)) check_writable(options.matches);
}

void check_task(const DiscoverOptions& options) {
  US_CHECK(options.matches.empty() || !options.perform.empty(), "--matches is of --perform");
  US_CHECK(!options.source.path.empty() || (!options.rig.empty() && !options.perform.empty()),
           "name the scans of one thing that moves: --source");
  US_CHECK(options.source.person.empty() && options.source.complete <= 0,
           "--person and --complete look for people: bones are found in scans of one thing (--crop, "
           "--largest-part)");
  US_CHECK(options.source.path.empty() || options.rig.empty() || options.perform.empty(),
           "what is performed is either the motion of --rig or that of --source");
}

void check_method(const DiscoverOptions& options) {
  const BoneSearch& search = options.search;
  const bool is_network = rig_method_named(search.method).weights != nullptr;
  US_CHECK(is_network || (search.kind.empty() && options.weights.empty()), "--kind and --weights are of --",
           "method slots");
  const std::string wrong = failure_of([&] { check_search(search); });
  US_CHECK(wrong.empty(), "--kind: ", wrong);
  US_CHECK(!is_network || search.most == 0, "--method ", search.method,
           " finds as many bones as move: --parts does not apply");
}

DiscoveryOptions discovery_options(const DiscoverOptions& options, Progress& progress) {
  DiscoveryOptions how = discovery_options(options.search, keypoints_loader(options.weights));
  how.progress = [&progress](const DiscoveryProgress& at) {
    progress.step(static_cast<int64_t>(100 * at.share));
    return !interrupted();
  };
  return how;
}

DiscoveredRig found_in(const ScanSequence& scans, const DiscoverOptions& options) {
  Progress progress("finding its skeleton", 100, false, "");
  DiscoveredRig rig = discover(scans, discovery_options(options, progress));
  progress.finish();
  return rig;
}

void write_sheet(const DiscoverOptions& options, const DiscoveredRig& rig, const ScanSequence& scans) {
  std::vector<render::SheetMoment> moments;
  const int shown = std::min(PreviewMoments::kShown, scans.count);
  moments.reserve(static_cast<size_t>(shown));
  for (int i = 0; i < shown; ++i) {
    const int frame = i * (scans.count - 1) / std::max(1, shown - 1);
    moments.push_back(rig_moment(rig.found, frame));
    moments.back().source = scans.scan(frame);
  }
  render::SheetOptions sheet;
  const std::string bones = std::to_string(rig.found.rig.count()) + " bones";
  sheet.title = options.perform.empty() ? name_of(options.source) + ": " + bones + " found"
                                        : file_name(options.perform) + " performs, " + bones;
  sheet.source_caption = options.perform.empty() ? "Scan, found skeleton" : "Performance, skeleton";
  sheet.target_caption = "Rig, painted by bone";
  sheet.strays = false;
  render::write_png(options.preview, render::contact_sheet(moments, sheet));
}

void tell(const DiscoveredRig& rig) {
  const understudy::Rig& found = rig.found.rig;
  if (found.count() == 1)
    std::printf("1 bone: nothing moves against anything else\n");
  else
    std::printf("%d bones\n", found.count());
  for (size_t j = 1; j < found.joints.size(); ++j) {
    const RigJoint& joint = found.joints[j];
    std::printf("  %s on %s: %s, turns %.0f degrees, %.1f mm off the scans\n", joint.name.c_str(),
                found.joints[static_cast<size_t>(joint.parent)].name.c_str(),
                kJointKindNames[static_cast<size_t>(joint.kind)],
                static_cast<double>(rig.bones[j].turned_deg), 1000 * static_cast<double>(rig.bones[j].off_m));
  }
  const auto doubted = std::count(rig.doubted.begin(), rig.doubted.end(), true);
  if (doubted > 0)
    std::printf("%td of %td frames fit clearly worse or could not be used\n", doubted, ssize(rig.doubted));
  if (rig.seen_once())
    std::printf("seen in one frame: its joints are where the network sees them, no motion has shown them\n");
  if (!rig.complete) std::printf("ended early: this is the best that was found by then\n");
}

/// Character, archive, report; `more` stands in the report.
void write_files(const DiscoverOptions& options, const DiscoveredRig& rig, const Eigen::Matrix4d& to_file,
                 const Json& more) {
  if (!options.out.empty()) write_rig(options.out, rig.found);
  if (!options.result.empty()) write_found_rig(options.result, rig, to_file);
  if (options.report.empty()) return;
  Json report = more;
  report.update(to_json(rig));
  write_json(options.report, report);
}

int find_rig(const DiscoverOptions& options) {
  const std::shared_ptr<Source> source = open_source(as_it_is(options.source));
  const ScanSequence scans = scan_sequence(source, options.source.path, options.source.edits);
  const DiscoveredRig rig = found_in(scans, options);
  tell(rig);
  write_files(options, rig, source->to_file(), {{"source", options.source.path}});
  if (!options.preview.empty()) write_sheet(options, rig, scans);
  return 0;
}

/// A rig fits no scans of another body, in any frame: then none is worse than the others.
void warn_of_another_body(const DiscoveredRig& rig, const std::string& scans) {
  constexpr double kFarOfSize = 0.06;
  std::vector<double> off;
  for (const float one : rig.off_m)
    if (one >= 0) off.push_back(static_cast<double>(one));
  const double size = static_cast<double>(box_diagonal(rig.found.rig.surface.vertices));
  const double usual = off.empty() ? 0 : percentile(off, 50);
  if (usual > kFarOfSize * size)
    log::warn(scans + printed(": is %.0f mm off the rig, which is %.0f mm long: it may be of another body",
                              1000 * usual, 1000 * size));
}

/// Lays a known rig on scans as they come.
int follow_rig(const DiscoverOptions& options) {
  const RiggedMotion known = read_rig(options.rig);
  const std::shared_ptr<Source> source = open_source(as_it_is(options.source));
  Progress progress("following", source->count().value_or(0));
  const FollowedScans followed =
      follow_scans(known, *source, options.source.path, options.source.edits, [&](int64_t frames) {
        progress.step(frames);
        return !interrupted();
      });
  progress.finish();
  tell(followed.rig);
  warn_of_another_body(followed.rig, options.source.path);
  Json more = {{"source", options.source.path}, {"rig", options.rig}};
  if (!followed.ms.empty()) {
    more["ms"] = percentile(followed.ms, 50);
    more["ms_p95"] = percentile(followed.ms, 95);
    std::printf("%.1f ms a frame, 95 %% within %.1f\n", percentile(followed.ms, 50),
                percentile(followed.ms, 95));
  }
  write_files(options, followed.rig, source->to_file(), more);
  if (options.preview.empty()) return 0;
  source->seek(0);
  write_sheet(options, followed.rig, scan_sequence(source, options.source.path, options.source.edits));
  return 0;
}

RiggedMotion performing_source(const DiscoverOptions& options) {
  if (!options.rig.empty()) return read_rig(options.rig);
  const SourceOptions& scans = options.source;
  return found_in(scan_sequence(open_source(as_it_is(scans)), scans.path, scans.edits), options).found;
}

/// The partners in the file, or those that were found, which go into the file.
BoneMatches wanted_matches(const DiscoverOptions& options, const LaidOther& other,
                           const understudy::Rig& source) {
  if (!options.matches.empty() && std::filesystem::exists(options.matches))
    return read_matches(options.matches, source, other.body.rig);
  BoneMatches matches = matches_of(other, source);
  const std::string wrong = failure_of([&] { check_matches(matches, source, other.body.rig); });
  US_CHECK(wrong.empty(), options.perform, ": ", wrong);
  if (options.matches.empty()) return matches;
  write_json(options.matches, to_json(matches, source, other.body.rig));
  std::printf("%s: the partners; change them there and run this again\n", options.matches.c_str());
  return matches;
}

void tell(const BoneMatches& matches, const understudy::Rig& source, const understudy::Rig& target) {
  for (size_t k = 0; k < matches.partner.size(); ++k) {
    const int partner = matches.partner[k];
    if (partner < 0)
      std::printf("  %s goes with its neighbours\n", target.joints[k].name.c_str());
    else
      std::printf("  %s as %s, cost %.2f\n", target.joints[k].name.c_str(),
                  source.joints[static_cast<size_t>(partner)].name.c_str(),
                  static_cast<double>(matches.cost[k]));
  }
}

/// What is not known of a performance: how far it is from scans.
DiscoveredRig as_discovered(RiggedMotion performed) {
  DiscoveredRig rig;
  rig.found = std::move(performed);
  rig.off_m.assign(rig.found.motion.poses.size(), -1);
  rig.doubted.assign(rig.found.motion.poses.size(), false);
  measure_motion(rig.found, rig.bones);
  return rig;
}

int perform_rig(const DiscoverOptions& options) {
  const RiggedMotion source = performing_source(options);
  Progress progress("finding the skeleton of what performs", 100, false, "");
  const OtherBody read = other_body(options.perform, options.source, discovery_options(options, progress));
  progress.finish();
  US_CHECK(!read.is_scan || options.matches.empty(), options.perform,
           ": one scan has no bones of its own to match: --matches does not apply");
  const LaidOther target = laid_other(source, read);
  const BoneMatches matches = wanted_matches(options, target, source.rig);
  tell(matches, source.rig, target.body.rig);
  const DiscoveredRig rig = as_discovered(performed_by(source, target.body, target.laid, matches));
  Json more = {{"source", options.rig.empty() ? options.source.path : options.rig},
               {"performed_by", options.perform}};
  more["matches"] = to_json(matches, source.rig, rig.found.rig)["bones"];
  write_files(options, rig, Eigen::Matrix4d::Identity(), more);
  if (options.preview.empty()) return 0;
  ScanSequence shown;  // there is no scan of it: its own surface
  shown.count = static_cast<int>(rig.found.motion.poses.size());
  shown.scan = [&rig](int t) {
    const understudy::Rig& made = rig.found.rig;
    const BoneMotions bones = bone_motions(made, rig.found.motion.poses[static_cast<size_t>(t)]);
    return Mesh{skinned(made.surface.vertices, made.skin, bones), made.surface.faces};
  };
  write_sheet(options, rig, shown);
  return 0;
}

int discover_rig(const DiscoverOptions& options) {
  check_task(options);
  check_method(options);
  check_outputs(options);
  if (!options.perform.empty()) return perform_rig(options);
  return options.rig.empty() ? find_rig(options) : follow_rig(options);
}

}  // namespace

Action declare_discover(CLI::App& command) {
  const auto options = std::make_shared<DiscoverOptions>();
  command.add_option("--source", options->source.path,
                     "scans of one thing that moves: a folder of frames (" + format_names(kScanFrame) +
                         "), a list or an array");
  add_source_options(command, options->source);
  command.add_option("--out", options->out,
                     "the thing with bones, skin and animation, as .glb or .gltf; its motion alone as .bvh");
  command
      .add_option("--parts", options->search.most,
                  "at most so many bones (default: as many as its motion shows)")
      ->check(CLI::Range(1, kMostBones));
  command
      .add_option("--method", options->search.method,
                  help_of(rig_methods()) + " (default: " + rig_methods().front().name + ")")
      ->check([](const std::string& name) { return failure_of([&] { rig_method_named(name); }); });
  command.add_option("--kind", options->search.kind, "of --method slots: person, quadruped, hand or arm");
  command.add_option("--weights", options->weights, "folder of trained weights");
  command.add_option("--result", options->result, "vertices, joints, tree and weights as .npz");
  command.add_option("--report", options->report, "bones, and how well each frame fits, as JSON");
  command.add_option("--preview", options->preview, "contact sheet as PNG");
  command.add_option(
      "--rig", options->rig,
      "a rig that was found before (.glb, .gltf): it is laid on the scans of --source as they come; "
      "with --perform, what does its motion");
  command.add_option(
      "--perform", options->perform,
      "another body of the kind that performs the motion: scans, one scan, or a rig that was found "
      "before");
  command.add_option("--matches", options->matches,
                     "whose bone performs whose, as JSON: read where the file is there, else written");
  return [options] { return discover_rig(*options); };
}

}  // namespace understudy::app
