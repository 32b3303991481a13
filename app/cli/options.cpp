#include "app/cli/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "retarget/base/error.hpp"
#include "retarget/base/program_files.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/bone_map.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {
namespace {

/// "--hip-height" is what documents call hip_height.
std::string dashed(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

/// "left_shoulder=0,0,-30": degrees about the joint's own axes.
BoneTurn parse_turn(const std::string& text) {
  const size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const int joint = joint_named(name);
  US_CHECK(joint >= 0, "--rest-pose: there is no joint '", name, "'");
  Vec3 degrees;
  char more = 0;
  const std::string angles = equals == std::string::npos ? "" : text.substr(equals + 1);
  const int count =
      std::sscanf(angles.c_str(), "%f,%f,%f%c", &degrees.x(), &degrees.y(), &degrees.z(), &more);
  US_CHECK(count == 3 && degrees.allFinite(), "--rest-pose ", text,
           ": must be a joint and three angles in degrees: left_shoulder=0,0,-30");
  return {joint, kPi / 180 * degrees};
}

/// "auto", "wide" or pixels.
void set_stick_width(render::PosePictureOptions& drawing, const std::string& width) {
  double pixels = 0;
  const bool is_word = width == "auto" || width == "wide";
  US_CHECK(is_word || (parse_number(width, pixels) && pixels >= 0.5 && pixels <= 200), "--stick-width ",
           width, ": is auto, wide, or half the width in pixels, 0.5 to 200");
  drawing.wide_sticks = width == "wide";
  drawing.half_width = static_cast<float>(pixels);
}

void add_drawing_options(CLI::App& command, PoseChoice& poses) {
  const auto named = [&command](const char* name, auto& value, const auto& names, const char* words) {
    command
        .add_option_function<std::string>(
            name,
            [&value, &names](const std::string& word) {
              using Value = std::decay_t<decltype(value)>;
              value = static_cast<Value>(std::find(names.begin(), names.end(), word) - names.begin());
            },
            words)
        ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
  };
  named("--points", poses.drawing.layout, render::kPoseLayoutNames,
        "of pose pictures: openpose18, as ControlNet draws people (default), or body25, with feet");
  named("--pose-file", poses.file, kPoseFileNames,
        "beside pose pictures: controlnet, a JSON (default); openpose, a folder of them; none");
  command.add_option_function<std::string>(
      "--stick-width", [&poses](const std::string& width) { set_stick_width(poses.drawing, width); },
      "of pose pictures: half of it in pixels; auto: 4 on canvases up to 512, more on larger ones "
      "(default); wide: as xinsir's SDXL model knows them");
  command.add_flag("!--whole-face", poses.hides_face,
                   "of pose pictures: nose, eyes and ears stay where the head turns them away");
  command.add_flag("--hide-limbs", poses.hides_limbs,
                   "of pose pictures: what another part of the body hides is left out");
  command.add_flag("--depth", poses.depth, "beside pose pictures: the same view's depth");
  command.add_flag("--normals", poses.normals, "beside pose pictures: the same view's normals");
  command.add_flag("--mask", poses.mask, "beside pose pictures: where the body is");
}

}  // namespace

void add_scan_options(CLI::App& command, ScanEdits& edits) {
  command.add_flag_callback(
      "--remove-floor", [&edits] { edits.floor = FloorCut{}; },
      "takes the floor out of each scan, but not the soles");
  command.add_flag("--largest-part", edits.largest_cluster,
                   "keeps only the largest part of each scan: takes a second person or a prop out");
  command
      .add_option_function<std::vector<float>>(
          "--crop",
          [&edits](const std::vector<float>& box) {
            edits.crop = Box{Vec3(box[0], box[1], box[2]), Vec3(box[3], box[4], box[5])};
            US_CHECK((edits.crop->high - edits.crop->low).minCoeff() > 0,
                     "--crop: the box has no inside; it is X Y Z of its low corner, then of its high one");
          },
          "keeps only what is inside a box: X Y Z of its low corner and of its high one, metres, y up")
      ->expected(6)
      ->delimiter(',');
}

namespace {

/// Of 2D poses and the camera that saw them.
void add_lifting_options(CLI::App& command, SourceOptions& source) {
  command.add_option("--layout", source.layout,
                     "of 2D poses: the order of the points (default: as names or their count tell)");
  command
      .add_option("--stature", source.stature,
                  "of the person in 2D poses, when they are performed in space, metres (default: 1.7)")
      ->check(CLI::Range(0.3, 3.0));
  command
      .add_option("--fov", source.fov,
                  "vertical field of view of the camera that saw the 2D poses, degrees (default: 50)")
      ->check(CLI::Range(1.0, 170.0));
  command
      .add_option("--pitch", source.pitch,
                  "how far the camera looks down that saw the 2D poses, degrees (default: as they tell)")
      ->check(CLI::Range(-80.0, 80.0));
}

}  // namespace

void add_source_options(CLI::App& command, SourceOptions& source) {
  add_scan_options(command, source.edits);
  command.add_option(
      "--person", source.person,
      "who of several people in scans: a number from 1, largest, or all (default: who is seen best); in 2D "
      "poses: the number that the file tells, else 1, 2 ... (default: who is seen longest)");
  command
      .add_option("--motion", source.motion, "AMASS-format motion that an SMPL-format source body performs")
      ->type_name(kReadPath);
  command.add_option("--source-betas", source.betas, "shape parameters of the source body")->delimiter(',');
  command.add_option("--clip", source.clip,
                     "which animation of a skeletal source: its name or number (default: the longest)");
  CLI::Option* const as_scan = command.add_flag(
      "--as-scan", source.as_scan, "treats an animated source's surface as a scan and ignores its skeleton");
  CLI::Option* const map =
      command
          .add_option_function<std::string>(
              "--source-map", [&source](const std::string& path) { source.bones = read_bone_choices(path); },
              R"(JSON that names bones of a skeletal source: {"left_wrist": "Hand.L"})")
          ->type_name(kReadPath);
  map->excludes(as_scan);
  command.add_flag("--follow", source.follow, "the source folder is still being written");
  command
      .add_option("--fps", source.fps, "frames per second of the source (default: the motion's own, or 30)")
      ->check(CLI::Range(1.0, 1000.0));
  command
      .add_option("--times", source.times,
                  "CSV of when each scan was taken: its file or number, seconds; --fps is then the rate of "
                  "the result (default: the usual interval's)")
      ->type_name(kReadPath);
  command
      .add_option(
          "--complete", source.complete,
          "fits one body to all scans, however few and sparse, and makes so many frames per second of "
          "them; looks both ways")
      ->check(CLI::Range(1.0, 1000.0));
  command
      .add_option("--markers", source.markers,
                  "CSV of markers for --complete: seconds,name,x,y,z in the scans' units and axes")
      ->type_name(kReadPath);
  add_lifting_options(command, source);
  command.add_option("--up", source.import.up, "the source's up axis: auto, x, y, z, -x, -y, -z");
  command.add_option("--units", source.import.units, "the source's units: auto, m, dm, cm, mm, in");
  command.add_option("--height", source.import.height,
                     "height of the person in the source, metres (default: by its units, else 1.7)");
  command.add_option("--turn,--yaw", source.import.turn_deg, "turns the source about y, degrees");
  command.add_option("--floor", source.import.floor,
                     "height of the source's floor, metres (default: the lowest points)");
}

void add_target_options(CLI::App& command, TargetOptions& target) {
  command
      .add_option_function<std::string>(
          "--rig",
          [&target](const std::string& word) {
            const auto name = std::find(kRigNames.begin(), kRigNames.end(), present_rig(word));
            target.rig = static_cast<Rig>(name - kRigNames.begin());
          },
          "own: the character's own bones and weights; 22: the 22 joints (default: own, if any)")
      ->check(CLI::IsMember({"auto", "own", "22", "theirs", "ours"}));
  command
      .add_option_function<std::string>(
          "--map", [&target](const std::string& path) { target.bones = read_bone_choices(path); },
          R"(JSON that names the character's bones: {"left_wrist": "Hand.L"})")
      ->type_name(kReadPath);
  command.add_option("--betas", target.betas, "shape parameters of an SMPL-format target")->delimiter(',');
  command.add_option("--target-units", target.import.units, "the target's units: auto, m, dm, cm, mm, in");
  command.add_option("--target-height", target.import.height,
                     "height of the target, metres (default: by its units, else 1.7)");
  target.not_a_person = NotAPerson::Refuse;
  command.add_flag_callback(
      "--use-anyway", [&target] { target.not_a_person = NotAPerson::Use; },
      "uses a target that does not look like a person");
  command.add_option("--target-up", target.import.up, "the target's up axis: auto, y (default), z, ...");
  command.add_option_function<float>(
      "--target-turn,--target-yaw",
      [&target](float turn_deg) {
        target.import.turn_deg = turn_deg;
        target.forward = false;
      },
      "turns the target about y, degrees (default: so that it faces forward)");
}

namespace {

/// Of both kinds; what the source is decides which of them may be asked for.
std::vector<std::string> engine_names() {
  std::vector<std::string> names = names_of(engines());
  for (std::string& name : names_of(flat_engines()))
    if (index_of(engines(), name) < 0) names.push_back(std::move(name));
  return names;
}

}  // namespace

void add_method_options(CLI::App& command, MethodOptions& how) {
  Method& method = how.method;
  command
      .add_option_function<std::string>(
          "--engine",
          [&how](const std::string& name) { how.method.engine = name, how.engine_is_asked = true; },
          "motion transfer; " + help_of(engines()) + "; of 2D poses " + help_of(flat_engines()))
      ->check(CLI::IsMember(engine_names()));
  command.add_option("--extractor", method.extractor, "skeleton extraction; " + help_of(extractors()))
      ->check(CLI::IsMember(names_of(extractors())));
  std::map<std::string, RootMode> roots;
  for (const char* name : kRootNames) roots.emplace(name, static_cast<RootMode>(roots.size()));
  command
      .add_option("--path,--root", method.path,
                  "path across the floor: scaled by leg length, original, in-place")
      ->transform(CLI::CheckedTransformer(roots, CLI::ignore_case));
  for (const MethodSwitch& one : kSwitches) {
    std::string names = "!--no-" + dashed(one.name);
    if (std::string(one.name) != one.old_name) names += ",!--no-" + dashed(one.old_name);
    command.add_flag(names, method.*one.on, std::string("switches off: ") + one.explanation);
  }
  command.add_flag("!--no-offsets", method.offsets, "no pose-corrective offsets");
  command.add_flag("--predict", method.predict,
                   "frames that cannot be used go on as those before went, for half a second, instead of "
                   "repeating the last; they stay flagged");
  command
      .add_option_function<std::string>(
          "--style", [&method](const std::string& word) { method.style.choose(word); },
          "how it is performed: a style that comes with the program (understudy style --list), or a "
          "style's file")
      ->type_name(kReadPath);
  command
      .add_option("--style-strength", method.style.strength,
                  "0: the source as it is, 1: the style, up to 1.5")
      ->check(CLI::Range(kStyleStrengths.low, kStyleStrengths.high));
  for (const Proportion& one : kProportions)
    command.add_option("--" + dashed(one.name), method.*one.value, one.explanation)
        ->check(CLI::Range(one.range.low, one.range.high));
  command
      .add_option_function<std::vector<std::string>>(
          "--rest-pose",
          [&how](const std::vector<std::string>& turns) {
            for (const std::string& turn : turns) how.rest_pose.push_back(parse_turn(turn));
          },
          "how the target stands where the source is in T-pose: a joint and degrees about its axes, "
          "left_shoulder=0,0,-30; may be given several times")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--weights", how.weights, "folder of the weights (default: beside the program)")
      ->type_name(kReadPath);
  command
      .add_option("--engine-weights", how.engine_file, "weights file of the engine in place of the folder's")
      ->type_name(kReadPath);
  command
      .add_option("--extractor-weights", how.extractor_file,
                  "weights file of the extractor in place of the folder's")
      ->type_name(kReadPath);
}

std::string flat_engine(const MethodOptions& how) {
  return flat_engine_named(how.engine_is_asked ? how.method.engine : flat_engines().front().name).name;
}

FlatTools flat_tools(const MethodOptions& how) {
  const nn::NetworkOptions options = network_options(how);
  return {nn::load_length_reader(nn::weights_folder(options)),
          [options](const FlatEngine& wanted) { return nn::load_keypoint_transfer(options, wanted); }};
}

void add_tempo_options(CLI::App& command, TempoChoice& tempo) {
  command.add_option(
      "--tempo", tempo.tempo,
      "body: so that jumps on the target fall as on the source; or how many times as long the result "
      "lasts (default: off)");
  command
      .add_option(
          "--delay", tempo.delay_s,
          "with --tempo: as many frames come out as go in, at most so many seconds late; strokes catch up, "
          "rests fall back")
      ->check(CLI::Range(0.0, 10.0));
}

void add_pose_options(CLI::App& command, PoseChoice& poses) {
  command
      .add_option_function<std::string>(
          "--camera", [&poses](const std::string& words) { poses.camera = picture_camera(words); },
          "of pose pictures: yaw=30,pitch=10,distance=4,fov=40 (degrees, metres) and orthographic, any of "
          "them; a JSON of them; or a file of 2D poses that the first frame is laid onto (default: before "
          "the front of the first frame, the whole take in view)")
      ->type_name(kReadPath);
  std::string sizes;
  for (const CanvasPreset& preset : kCanvasPresets)
    append_item(sizes, printed("%dx%d", preset.canvas.width, preset.canvas.height));
  command.add_option_function<std::string>(
      "--canvas", [&poses](const std::string& size) { poses.canvas = parse_canvas(size); },
      "of pose pictures: their size, such as " + sizes +
          " (default: the reference's, else 832x480); of 2D poses: of the picture that they lie on");
  command.add_option("--rate", poses.rate, "of pose pictures: how many a second (default: the source's)")
      ->check(CLI::Range(1.0, 1000.0));
  command.add_option_function<std::string>(
      "--count", [&poses](const std::string& count) { poses.count = picture_count(count); },
      "of pose pictures: how many, the last pose stays where the take is shorter; or 4n+1: the most of 1, 5, "
      "9, ... that it has");
  add_drawing_options(command, poses);
}

std::string turn_words(const BoneTurn& turn) {
  const Vec3 degrees = 180 / kPi * turn.axis_angle;
  return printed("%s=%g,%g,%g", kJointNames[turn.joint], static_cast<double>(degrees.x()),
                 static_cast<double>(degrees.y()), static_cast<double>(degrees.z()));
}

nn::NetworkOptions network_options(const MethodOptions& how) {
  nn::NetworkOptions options;
  options.weights = how.weights;
  options.engine = how.method.engine;
  options.offsets = how.method.offsets;
  options.near = how.method.part_refiner;
  options.extractor = how.method.extractor;
  options.engine_file = how.engine_file;
  options.extractor_file = how.extractor_file;
  options.style = how.method.style;
  return options;
}

nlohmann::ordered_json style_json(const StyleChoice& style) {
  if (!style.any()) return nullptr;
  const StyleNote note = nn::style_note(style);
  return {{"name", style.called()},
          {"strength", style.strength},
          {"licence", note.licence},
          {"attribution", note.attribution},
          {"non_commercial", note.non_commercial()}};
}

std::string style_rights(const StyleChoice& style) {
  return style.any() ? nn::style_note(style).rights() : "";
}

std::function<std::shared_ptr<MotionSpace>()> motion_space_loader(const MethodOptions& how) {
  return [folder = nn::weights_folder(network_options(how))] {
    return std::shared_ptr<MotionSpace>(nn::load_motion_space(folder));
  };
}

SourceTools source_tools(const MethodOptions& how) {
  SourceTools tools;
  tools.space = motion_space_loader(how);
  tools.lifter = [folder = nn::weights_folder(network_options(how))] { return nn::load_lifter(folder); };
  return tools;
}

RetargetOptions retarget_options(const MethodOptions& how) {
  RetargetOptions options = retarget_options(how.method);
  if (!how.rest_pose.empty()) options.rest_pose = rest_rotations(how.rest_pose);
  return options;
}

std::string samples_folder() {
  std::string folder = program_files("samples").string();
  US_CHECK(!folder.empty(),
           "the bundled samples are missing: no folder assets/samples beside the program or above it, "
           "nor ../share/understudy/samples");
  return folder;
}

}  // namespace understudy::app
