#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>

#include "app/cli/commands.hpp"
#include "app/cli/file_preview.hpp"
#include "app/cli/headless.hpp"
#include "app/cli/options.hpp"
#include "app/cli/progress.hpp"
#include "app/run/doubt_tally.hpp"
#include "app/run/export_presets.hpp"
#include "app/run/exports.hpp"
#include "app/run/flat_performance.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/report.hpp"
#include "app/run/retargeted_source.hpp"
#include "app/session/document_file.hpp"
#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace {

struct ExportOptions {
  std::string document;            // empty: --source and --target
  std::vector<std::string> takes;  // by name, or number from 1; empty: the first
  std::vector<std::string> sources, targets;
  std::string format, bones, out, preview, report;
  std::string not_of_documents;  // a given option that a document answers itself
  SourceOptions source;          // what all sources share
  TargetOptions target;          // what all targets share
  CharacterExportOptions file;
  MethodOptions how;
  TempoChoice tempo;
  PoseChoice poses;
  bool print_map = false, all_takes = false, chose_influences = false;
  int64_t frames = 0;
};

/// What is written, and who performs it, for people.
struct Performance {
  std::vector<ExportInput> performers;
  std::string by;
  DoubtTally doubt{};  // of sources; a document's takes bring none
  int64_t flagged = 0;
};

/// One of the people of a source, as it is opened for them.
struct Role {
  SourceOptions source;
  std::string called;
};

/// The numbers in "1,3"; none: it is no list.
std::vector<int> listed_people(const std::string& person) {
  std::vector<int> numbers;
  if (person.find(',') == std::string::npos) return numbers;
  std::istringstream words(person);
  for (std::string word; std::getline(words, word, ',');) {
    numbers.push_back(person_number(word));
    US_CHECK(numbers.back() > 0, "--person ", person, ": a list holds numbers from 1 alone");
  }
  return numbers;
}

std::string counted_people(size_t count) {
  return std::to_string(count) + (count == 1 ? " person" : " people");
}

/// A target each for several people: whether all is given that this needs.
void check_cast(const ExportOptions& options, const ExportFormat& format) {
  const size_t targets = options.targets.size();
  if (targets == 1) return;
  check_performers(options.out, format, targets);
  if (options.source.person == "all") return;
  const size_t people = listed_people(options.source.person).size();
  US_CHECK(
      people > 0, options.sources[0], ": ", targets,
      " targets perform as many of its people: --person all, or a list such as --person 1,2, tells which");
  US_CHECK(people == targets, options.sources[0], ": --person ", options.source.person, " is ",
           counted_people(people), ", but there are ", targets, " targets");
}

/// Those who are performed of a source: for one target each is a clip, of several each has one.
std::vector<Role> roles_in(const ExportOptions& options, const std::string& path,
                           const std::shared_ptr<SkeletonExtractor>& extractor) {
  SourceOptions one = options.source;
  one.path = path;
  std::vector<int> people = listed_people(one.person);
  if (one.person != "all" && people.empty()) return {{one, clip_name(path)}};
  if (one.person == "all") people = all_people(one, extractor);
  std::vector<Role> roles;
  for (const int id : people) {
    one.person = std::to_string(id);
    roles.push_back({one, clip_name(path) + " person " + one.person});
  }
  const size_t targets = options.targets.size();
  if (targets == 1) return roles;
  US_CHECK(roles.size() >= targets, path, ": shows ", counted_people(roles.size()), ", too few for ", targets,
           " targets");
  for (size_t left = targets; left < roles.size(); ++left)
    log::info(roles[left].called + " is left out: there are " + std::to_string(targets) + " targets");
  roles.resize(targets);
  return roles;
}

/// One source to its end, after what was performed before.
void perform(const ExportOptions& options, const Role& role, Retargeter& retargeter, ExportInput& input,
             Performance& out) {
  const std::string& path = role.source.path;
  const auto source = open_source(role.source);
  RetargetedSource retargeted(*source, retargeter, role.source, source_tools(options.how));
  const bool is_together = options.targets.size() > 1;
  CharacterClip clip{is_together ? clip_name(path) : role.called, source->fps(), {}};
  std::vector<float> doubt_m;
  TempoStream tempo(options.tempo, retargeter.performer().target().joints, source->fps());
  const auto add = [&](const std::vector<PerformedFrame>& frames) {
    for (const PerformedFrame& frame : frames) {
      clip.poses.push_back(frame.pose);
      doubt_m.push_back(frame.observed.doubt_m);
      input.source_joints.push_back(source_joints(frame));
    }
  };
  Progress progress(role.called + " -> " + input.name, source->count().value_or(0));
  while (const auto frame = retargeted.next()) {
    out.doubt.add(frame->result);
    add(tempo.push(frame->result));
    progress.step(retargeted.frames());
    check_interrupt("after frame " + std::to_string(frame->scan.number));
    if (options.frames > 0 && retargeted.frames() >= options.frames) break;
  }
  progress.finish();
  add(tempo.finish());
  check_interrupt("after " + std::to_string(retargeted.frames()) + " frames");
  retargeted.check_used();
  out.flagged += retargeted.flagged();
  if (retargeted.flagged() > 0)
    log::warn(path + ": " + std::to_string(retargeted.flagged()) +
              " of its frames could not be used and repeat the last pose");
  clip.made = made_frames(doubt_m);
  input.source_to_scan = source->to_file();
  input.clips.push_back(std::move(clip));
}

/// A target, and what performs on it.
struct CastTarget {
  std::shared_ptr<const PreparedCharacter> character;
  CharacterExportOptions file;
  std::unique_ptr<Retargeter> retargeter;
};

CastTarget open_cast_target(const ExportOptions& options, const std::string& path,
                            const ExportFormat& format) {
  TargetOptions target = options.target;
  target.path = path;
  Networks networks = nn::load_networks(network_options(options.how));
  CastTarget out{open_target(target, networks), options.file, nullptr};
  const bool theirs = on_their_rig(target, *out.character);
  CharacterExportOptions& file = out.file;
  file.rights = style_rights(options.how.method.style);
  US_CHECK(theirs || options.bones != "own", path, ": does not perform on bones of its own");
  file.their_rig = options.bones.empty() ? theirs && format.is_character : options.bones == "own";
  check_export_options(options.out, format, file);
  US_CHECK(!file.their_rig || !options.chose_influences || file.influences == 4, path,
           ": keeps its own skin weights; --influences needs --bones 22");
  RetargetOptions quick = retarget_options(options.how);
  quick.vertices = false;
  out.retargeter =
      std::make_unique<Retargeter>(networks_for(std::move(networks), *out.character, theirs), quick);
  out.retargeter->set_target(out.character->target);
  return out;
}

Performance perform_sources(const ExportOptions& options, const ExportFormat& format) {
  check(options.tempo);
  US_CHECK(!options.sources.empty(), "--source is required: the motion to perform");
  US_CHECK(!options.targets.empty(), "--target is required: the character that performs it");
  US_CHECK(options.sources.size() == 1 || format.is_character, options.out, ": ", format.label,
           " holds one motion, not ", options.sources.size());
  US_CHECK(options.sources.size() == 1 || options.source.times.empty(), options.source.times,
           ": --times is of one source, not of ", options.sources.size());
  check_cast(options, format);
  Performance out;
  std::vector<std::vector<Role>> roles;  // of each source
  for (size_t k = 0; k < options.targets.size(); ++k) {
    const std::string& path = options.targets[k];
    const CastTarget target = open_cast_target(options, path, format);
    Retargeter& retargeter = *target.retargeter;
    if (k == 0)
      for (const std::string& source : options.sources)
        roles.push_back(roles_in(options, source, retargeter.extractor()));
    ExportInput input{
        {target.character, retargeter.performer().deformer(), target.file, options.poses}, {}, {}};
    input.name = clip_name(path);
    for (const auto& of_source : roles)
      for (size_t i = 0; i < of_source.size(); ++i)
        if (options.targets.size() == 1 || i == k) perform(options, of_source[i], retargeter, input, out);
    append_item(out.by, options.targets.size() == 1 ? path : file_name(path));
    out.performers.push_back(std::move(input));
  }
  const size_t clips = out.performers[0].clips.size();
  US_CHECK(clips == 1 || format.is_character, options.out, ": ", format.label, " holds one motion, not ",
           clips, " people's");
  return out;
}

std::vector<size_t> chosen_takes(const ExportOptions& options, const Document& document,
                                 const ExportFormat& format) {
  std::vector<size_t> takes;
  try {
    for (const std::string& name : options.takes) takes.push_back(take_called(document, name, 1));
  } catch (const Error& error) {
    throw Error(options.document + ": " + error.what());
  }
  if (takes.empty()) takes.push_back(0);
  US_CHECK(takes.size() == 1 || format.is_character, options.out, ": ", format.label,
           " holds one motion, not ", takes.size());
  return takes;
}

std::unique_ptr<Studio> open_document(const ExportOptions& options) {
  US_CHECK(options.not_of_documents.empty(), options.document, ": a document has its own source and target, ",
           options.not_of_documents, " cannot be combined with it");
  auto studio = headless_studio(options.how.weights);
  studio->run("document.open", {options.document});
  const Document& document = studio->session().document;
  US_CHECK(!document.source.path.empty() && !document.takes.empty(), options.document, ": has no ",
           document.source.path.empty() ? "source" : "target");
  return studio;
}

ExportChoice choice_of(const ExportOptions& options, const ExportFormat& format) {
  ExportChoice choice{&format, options.file, {}, {}, options.poses};
  if (options.target.rig != Rig::Auto && format.is_character)
    choice.own_bones = options.target.rig == Rig::Own;
  if (!options.bones.empty()) choice.own_bones = options.bones == "own";
  return choice;
}

/// The document's takes as the studio shows them: its edits, its corrections of joints and weights.
Performance perform_document(const ExportOptions& options, const ExportFormat& format) {
  const auto studio = open_document(options);
  const Session& session = studio->session();
  const std::vector<size_t> takes = chosen_takes(options, session.document, format);
  check_not_read(options.out, files_read_by(session.document));
  make_takes(*studio, takes[0], {clip_name(options.document), options.all_takes});
  Performance out{export_inputs(session, takes, choice_of(options, format)), ""};
  for (const ExportInput& one : out.performers) append_item(out.by, one.name);
  return out;
}

/// A file of each take into the folder --out; what goes wrong with one keeps no other out.
/// 1 where something did.
int export_takes(const ExportOptions& options) {
  US_CHECK(!options.document.empty(), "--all-takes: only a document has takes");
  US_CHECK(options.takes.empty(), "--all-takes: --take cannot be combined with it");
  US_CHECK(options.preview.empty() && options.report.empty(),
           "--all-takes: --preview and --report are of one file");
  const ExportFormat& format = export_format(options.format.empty() ? "glb" : options.format, options.out);
  if (options.bones == "own") check_own_bones(options.out, format);
  const auto studio = open_document(options);
  make_takes(*studio, 0, {clip_name(options.document), options.all_takes});
  const auto files = take_files(studio->session(), options.out, choice_of(options, format));
  const auto problems = write_takes(options.out, files, [](float) { check_interrupt("during the export"); });
  size_t written = 0;
  for (const std::string& problem : problems)
    if (problem.empty())
      ++written;
    else
      log::warn(problem);
  std::printf("%s %zu of %zu takes\n", options.out.c_str(), written, files.size());
  return written == files.size() ? 0 : 1;
}

Json report_of(const std::string& target, const ExportInput& performer) {
  const PreparedCharacter& prepared = *performer.body.character;
  return {{"target", target},
          {"rig", kRigNames[static_cast<size_t>(performer.body.file.their_rig ? Rig::Own : Rig::Ours)]},
          {"mapped", prepared.map.count()},
          {"notes", prepared.notes}};
}

void report_cost(const ExportOptions& options, const Performance& done, const ExportCost& cost) {
  if (cost.measured)
    std::printf(
        "%s %lld bytes, differs from the viewport by %.3f mm on average, %.3f mm at most over %lld frames, "
        "%lld keys\n",
        options.out.c_str(), static_cast<long long>(cost.bytes), cost.mean_mm, cost.largest_mm,
        static_cast<long long>(cost.frames), static_cast<long long>(cost.keys));
  else
    std::printf("%s %lld bytes, %lld frames\n", options.out.c_str(), static_cast<long long>(cost.bytes),
                static_cast<long long>(cost.frames));
  if (options.report.empty()) return;
  Json report = report_header(nn::weights_folder(network_options(options.how)));
  if (done.performers.size() == 1)
    report.update(report_of(done.by, done.performers[0]));
  else
    for (size_t k = 0; k < done.performers.size(); ++k)
      report["performers"].push_back(report_of(
          k < options.targets.size() ? options.targets[k] : done.performers[k].name, done.performers[k]));
  report["cost"] = {{"frames", cost.frames}, {"keys", cost.keys}, {"bytes", cost.bytes}};
  if (cost.measured) {
    report["cost"]["mean_mm"] = cost.mean_mm;
    report["cost"]["largest_mm"] = cost.largest_mm;
  }
  if (options.document.empty()) {
    report["flagged"] = done.flagged;
    report["doubt"] = done.doubt.json();
  }
  write_json(options.report, report);
}

int print_map(const ExportOptions& options) {
  US_CHECK(!options.targets.empty(), "--target is required: the character whose bones are printed");
  for (const std::string& path : options.targets) {
    const Character character = read_character(path);
    const BoneMap map = map_bones(character, bind_pose(character).nodes, options.target.bones);
    std::printf("%s", to_table(map, character).c_str());
    US_CHECK(map.usable(), path, ": too few of its bones were recognised to drive it");
  }
  return 0;
}

/// The document's take that is asked for, where it is of 2D poses. False: it is not.
bool export_flat_take(const ExportOptions& options) {
  if (options.document.empty() || options.takes.size() > 1 || options.all_takes) return false;
  const Document document = read_document(options.document).document;
  const size_t take = options.takes.empty() ? 0 : take_called(document, options.takes[0], 1);
  if (take >= document.takes.size() || !document.takes[take].flat) return false;
  const auto studio = open_document(options);
  check_not_read(options.out, files_read_by(document));
  studio->wait_idle();
  const Session& session = studio->session();
  US_CHECK(session.errors.empty(), session.errors.front().text);
  US_CHECK(!session.question, session.question->text);
  const KeypointReading poses = exported_poses(session, take, options.poses.count);
  write_flat(options.out, poses, options.poses);
  std::printf("%s %zu frames\n", options.out.c_str(), poses.frames.size());
  return true;
}

int run_export(const ExportOptions& options) {
  if (options.print_map) return print_map(options);
  US_CHECK(!options.out.empty(), "--out is required: the file to write");
  if (export_flat_take(options)) return 0;
  if (options.all_takes) return export_takes(options);
  const ExportFormat& format = export_format(options.format, options.out);
  US_CHECK(options.preview.empty() || format.is_character, options.preview,
           ": --preview needs a GLB or glTF file");
  std::vector<std::string> read = options.sources;
  read.insert(read.end(), options.targets.begin(), options.targets.end());
  read.push_back(options.source.motion);
  read.push_back(options.source.times);
  read.push_back(options.source.markers);
  check_not_read(options.out, read);
  check_export(options.out, format);
  if (options.bones == "own") check_own_bones(options.out, format);
  CharacterExportOptions on_any_rig = options.file;
  on_any_rig.their_rig = options.target.rig != Rig::Ours && options.bones != "22";
  check_export_options(options.out, format, on_any_rig);
  check_pose_choice(options.out, format, options.poses);
  US_CHECK(options.takes.empty() || !options.document.empty(), "--take: only a document has takes");
  for (const std::string& path : {options.preview, options.report}) check_writable(path);
  Performance done =
      options.document.empty() ? perform_sources(options, format) : perform_document(options, format);
  done.performers[0].body.file.progress = [](float) { check_interrupt("during the export"); };
  const auto began = std::chrono::steady_clock::now();
  const ExportCost cost = export_motion(options.out, format, done.performers);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::fprintf(stderr, "written and measured in %.2f s\n", seconds);
  report_cost(options, done, cost);
  if (!options.preview.empty())
    write_file_preview(options.preview, options.out, done.performers,
                       done.performers.size() == 1 ? clip_name(done.by) : done.by);
  return 0;
}

void add_file_options(CLI::App& command, ExportOptions& options) {
  std::string formats;
  for (const ExportFormat& info : export_formats()) append_item(formats, info.name);
  command.add_option("--format", options.format,
                     formats +
                         " (default: by the suffix; ply and obj are folders, poses is one where --out does "
                         "not end in .mp4)");
  // Before the options that it sets: those that are given count.
  command.add_option_function<std::string>(
      "--preset", [&options](const std::string& name) { apply(export_preset(name), options.file); },
      "options for a program: " + help_of_presets());
  command
      .add_option(
          "--bones", options.bones,
          "own: the file's bones are the character's own; 22: the 22 joints (default: own in GLB and glTF "
          "where the character performs on them, else 22)")
      ->check(CLI::IsMember({"own", "22"}));
  command.add_option("--influences", options.file.influences, "bones per vertex of the 22 joints: 4 or 8")
      ->check(CLI::IsMember({4, 8}));
  command.add_option("--morphs", options.file.shapes, "morph targets for the pose-corrective offsets")
      ->check(CLI::Range(0, 64));
  command.add_option("--reduce", options.file.reduce_mm, "removes keys up to this error, mm")
      ->check(CLI::Range(0.0, 1000.0));
  command.add_flag("--in-place", options.file.in_place, "leaves out the path across the floor");
  command.add_flag("--root-motion,!--no-root-motion", options.file.root_motion,
                   "adds a root bone that carries the path across the floor, as game engines expect");
  command.add_flag("--t-pose-clip", options.file.t_pose_clip, "the first clip is the T-pose");
  command.add_flag("--keep-clips", options.file.keep_clips, "keeps the file's own animations");
  command.add_option("--frames", options.frames, "at most this many frames of each source")
      ->check(CLI::Range(1, 100000000));
}

/// Empty: none was given.
std::string first_not_of_documents(const CLI::App& command) {
  static const std::set<std::string> kOfDocuments = {
      "DOCUMENT",      "--help",        "--take",        "--out",        "--format",  "--all-takes",
      "--preset",      "--bones",       "--rig",         "--influences", "--morphs",  "--reduce",
      "--root-motion", "--in-place",    "--t-pose-clip", "--keep-clips", "--preview", "--report",
      "--weights",     "--camera",      "--canvas",      "--rate",       "--count",   "--points",
      "--pose-file",   "--stick-width", "--whole-face",  "--hide-limbs", "--depth",   "--normals",
      "--mask"};
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 && kOfDocuments.count(option->get_single_name()) == 0 &&
        kOfDocuments.count("--" + option->get_single_name()) == 0)
      return option->get_name();
  return {};
}

}  // namespace

Action declare_export(CLI::App& command) {
  const auto options = std::make_shared<ExportOptions>();
  command.add_option("DOCUMENT", options->document,
                     "a document of the studio: exports its take as the studio shows it");
  command.add_option("--take", options->takes,
                     "takes of the document, by name or number from 1; each becomes a clip");
  command.add_flag("--all-takes", options->all_takes,
                   "a file of each take of the document, named after it, in the folder --out (default: GLB)");
  command.add_option("--source", options->sources, "motions to perform; each becomes a clip")
      ->type_name(kReadPath);
  command
      .add_option("--target", options->targets,
                  "a character or an SMPL-format body: " + format_names(kTarget) +
                      "; several perform several people of the source at once, in one GLB or glTF file: "
                      "--person all, or a list such as 1,3 with a person for each target")
      ->type_name(kReadPath);
  command.add_option("--out", options->out, "the file, or the folder of a sequence")->type_name(kWrittenPath);
  command.add_flag("--print-map", options->print_map, "prints which bone is which joint, and stops");
  command.add_option("--preview", options->preview, "contact sheet of the written file as PNG")
      ->type_name(kWrittenPath);
  command.add_option("--report", options->report, "file size and differences from the viewport, as JSON")
      ->type_name(kWrittenPath);
  add_source_options(command, options->source);
  add_target_options(command, options->target);
  add_file_options(command, *options);
  add_method_options(command, options->how);
  add_tempo_options(command, options->tempo);
  add_pose_options(command, options->poses);
  return [options, &command] {
    options->not_of_documents = first_not_of_documents(command);
    options->chose_influences = command.get_option("--influences")->count() > 0;
    return run_export(*options);
  };
}

}  // namespace understudy::app
