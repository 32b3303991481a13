#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

#include "app/cli/commands.hpp"
#include "app/cli/options.hpp"
#include "app/cli/preview.hpp"
#include "app/cli/progress.hpp"
#include "app/run/exports.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/rig_finder.hpp"
#include "render/colors.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace {

struct DiscoverOptions {
  SourceOptions source;
  std::string out, result, report, preview;
  int parts = 0;
};

using RigWriter = void (*)(const std::string& path, const RiggedMotion& found);

void write_rig_gltf(const std::string& path, const RiggedMotion& found) {
  write_gltf_character(path, to_character(found));
}

/// By the path's suffix; null where nothing writes such files.
RigWriter writer_of(const std::string& path) {
  static const std::map<std::string, RigWriter> writers = {
      {".glb", write_rig_gltf}, {".gltf", write_rig_gltf}, {".bvh", write_rig_bvh}};
  const auto found = writers.find(file_suffix(path));
  return found == writers.end() ? nullptr : found->second;
}

void check_outputs(const DiscoverOptions& options) {
  US_CHECK(
      !options.out.empty() || !options.result.empty() || !options.report.empty() || !options.preview.empty(),
      "nothing is to be written: name a character (--out), an archive (--result), a report (--report) or "
      "a picture (--preview)");
  US_CHECK(options.out.empty() || writer_of(options.out) != nullptr, options.out,
           ": a found rig is written as .glb, .gltf or .bvh");
  for (const std::string& path : {options.out, options.result, options.report, options.preview}) {
    check_not_read(path, {options.source.path});
    check_writable(path);
  }
}

DiscoveredRig found_in(const ScanSequence& scans, const DiscoverOptions& options) {
  Progress progress("finding its skeleton", 100, false, "%");
  DiscoveryOptions how;
  how.parts = options.parts;
  how.progress = [&progress](const DiscoveryProgress& at) {
    progress.step(static_cast<int64_t>(100 * at.share));
    return !interrupted();
  };
  DiscoveredRig rig = discover(scans, how);
  progress.finish();
  return rig;
}

/// The skeleton in the scan, and the surface painted by its bones.
render::SheetMoment moment_of(const DiscoveredRig& rig, const ScanSequence& scans, int frame,
                              const Points& colors) {
  const understudy::Rig& found = rig.found.rig;
  const BoneMotions bones = bone_motions(found, rig.found.motion.poses[static_cast<size_t>(frame)]);
  render::SheetMoment moment;
  moment.frame = frame;
  moment.seconds = frame / rig.found.motion.fps;
  moment.source = scans.scan(frame);
  render::SkeletonView& skeleton = moment.skeleton.emplace();
  skeleton.joints = joint_places(found, bones);
  for (const RigJoint& joint : found.joints) skeleton.parents.push_back(joint.parent);
  for (const BoneTip& tip : bone_tips(found)) {
    skeleton.joints.conservativeResize(skeleton.joints.rows() + 1, 3);
    skeleton.joints.bottomRows<1>() = bones[static_cast<size_t>(tip.joint)](tip.rest).transpose();
    skeleton.parents.push_back(tip.joint);
  }
  constexpr float kAdult = 2;  // diagonal of an adult's box, metres
  skeleton.thickness = box_diagonal(found.surface.vertices) / kAdult;
  moment.target = Mesh{skinned(found.surface.vertices, found.skin, bones), found.surface.faces, colors};
  return moment;
}

void write_sheet(const DiscoverOptions& options, const DiscoveredRig& rig, const ScanSequence& scans) {
  const Points colors = render::weight_colors(rig.found.rig.skin.dense(rig.found.rig.count()));
  std::vector<render::SheetMoment> moments;
  const int shown = std::min(PreviewMoments::kShown, scans.count);
  moments.reserve(static_cast<size_t>(shown));
  for (int i = 0; i < shown; ++i)
    moments.push_back(moment_of(rig, scans, i * (scans.count - 1) / std::max(1, shown - 1), colors));
  render::SheetOptions sheet;
  sheet.title = name_of(options.source) + ": " + std::to_string(rig.found.rig.count()) + " bones found";
  sheet.source_caption = "Scan, found skeleton";
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
  int doubted = 0;
  for (const bool frame : rig.doubted) doubted += frame ? 1 : 0;
  if (doubted > 0) std::printf("%d frames fit clearly worse than the others\n", doubted);
  if (!rig.complete) std::printf("ended early: this is the best that was found by then\n");
}

int discover_rig(const DiscoverOptions& options) {
  check_outputs(options);
  const std::shared_ptr<Source> source = open_source(as_it_is(options.source));
  const ScanSequence scans = scan_sequence(source);
  const DiscoveredRig rig = found_in(scans, options);
  tell(rig);
  if (!options.out.empty()) writer_of(options.out)(options.out, rig.found);
  if (!options.result.empty()) write_found_rig(options.result, rig, source->to_file());
  if (!options.report.empty()) {
    Json report = {{"source", options.source.path}};
    report.update(to_json(rig));
    write_json(options.report, report);
  }
  if (!options.preview.empty()) write_sheet(options, rig, scans);
  return 0;
}

}  // namespace

Action declare_discover(CLI::App& command) {
  const auto options = std::make_shared<DiscoverOptions>();
  command
      .add_option("--source", options->source.path,
                  "scans of one thing that moves: a folder of frames (" + format_names(kScanFrame) +
                      "), a list or an array")
      ->required();
  add_source_options(command, options->source);
  command.add_option("--out", options->out,
                     "the thing with bones, skin and animation, as .glb or .gltf; its motion alone as .bvh");
  command
      .add_option("--parts", options->parts, "at most so many bones (default: as many as its motion shows)")
      ->check(CLI::Range(1, 300));
  command.add_option("--result", options->result, "vertices, joints, tree and weights as .npz");
  command.add_option("--report", options->report, "bones, and how well each frame fits, as JSON");
  command.add_option("--preview", options->preview, "contact sheet as PNG");
  return [options] { return discover_rig(*options); };
}

}  // namespace understudy::app
