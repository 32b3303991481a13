#include "app/session/take_export.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "app/run/export_presets.hpp"
#include "app/session/command_sets.hpp"
#include "app/session/follow.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// Whether it is one of pose pictures.
bool set_drawing_option(PoseChoice& poses, const std::string& key, const std::string& value) {
  const ArgumentReader words({value});
  if (key == "points")
    poses.drawing.layout = words.choice<render::PoseLayout>(0, "points", render::kPoseLayoutNames);
  else if (key == "stick_width")
    poses.drawing.half_width = words.clamped(0, "stick width", 0.f, 200.f);
  else if (key == "hide_limbs")
    poses.hides_limbs = words.on(0);
  else if (key == "whole_face")
    poses.hides_face = !words.on(0);
  else if (key == "pose_file")
    poses.file = words.choice<PoseFile>(0, "file of points", kPoseFileNames);
  else
    return false;
  return true;
}

bool set_pose_option(PoseChoice& poses, const std::string& key, const std::string& value) {
  const ArgumentReader words({value});
  if (key == "camera")
    poses.camera = picture_camera(value);
  else if (key == "canvas")
    poses.canvas = parse_canvas(value);
  else if (key == "rate")
    poses.rate = words.number<double>(0, key.c_str());
  else if (key == "count")
    poses.count = picture_count(value);
  else if (key == "depth")
    poses.depth = words.on(0);
  else if (key == "normals")
    poses.normals = words.on(0);
  else if (key == "mask")
    poses.mask = words.on(0);
  else
    return set_drawing_option(poses, key, value);
  return true;
}

void set_option(ExportChoice& out, const std::string& key, const std::string& value) {
  const ArgumentReader words({value});
  const auto in_range = [&](float high) {
    const auto number = words.number<double>(0, key.c_str());
    US_CHECK(number >= 0 && number <= high, key, " is between 0 and ", high, ", not ", value);
    return number;
  };
  if (key == "bones")
    out.own_bones = words.choice(0, "bones", {"own", "22"}) == 0;
  else if (key == "influences")
    out.file.influences = words.choice(0, "influences", {"4", "8"}) == 0 ? 4 : 8;
  else if (key == "morphs")
    out.file.shapes = static_cast<int>(in_range(64));
  else if (key == "reduce")
    out.file.reduce_mm = static_cast<float>(in_range(1000));
  else if (key == "in_place")
    out.file.in_place = words.on(0);
  else if (key == "root_motion")
    out.file.root_motion = words.on(0);
  else if (key == "t_pose")
    out.file.t_pose_clip = words.on(0);
  else if (key == "keep_clips")
    out.file.keep_clips = words.on(0);
  else if (key == "take")
    out.takes.push_back(value);
  else if (key == "camera" && value == "view")
    out.pane_camera = true;
  else if (!set_pose_option(out.poses, key, value))
    throw Error("there is no export option '" + key + "'");
}

/// Of the clip: what the source is called.
std::string clip_name(const Session& session, const Take& take) {
  const std::string stem = fs::path(session.source.name).stem().string();
  return stem.empty() ? take.name : stem;
}

void add_clip(ExportInput& out, const Session& session, size_t k, const std::string& name) {
  const TakeState& state = session.takes[k];
  CharacterClip clip{name, session.source.fps, {}};
  std::vector<float> doubt_m;
  for (const MomentBetween& moment : moments_of(session, k)) {
    const size_t t = moment.share < 0.5f ? moment.before : moment.after;
    const auto& poses = state.shown.poses;
    clip.poses.push_back(pose_between(poses[static_cast<size_t>(moment.before)],
                                      poses[static_cast<size_t>(moment.after)], moment.share));
    if (t < state.shown.doubt_m.size()) doubt_m.push_back(state.shown.doubt_m[t]);
    const size_t seen = std::min(t + 1, state.performed.size());  // beyond the last it stays
    out.source_joints.push_back(seen > 0 ? state.performed[seen - 1].source : Joints::Zero());
  }
  clip.made = made_frames(doubt_m);
  out.source_to_scan = session.source.to_file;
  out.clips.push_back(std::move(clip));
}

/// Without what this take's character has not.
ExportChoice choice_for(const Session& session, size_t k, ExportChoice choice) {
  const auto& character = session.takes[k].character;
  const bool own = character && on_their_rig(session.document.takes[k].target, *character);
  if (!own) choice.own_bones.reset();
  if (!own || !choice.own_bones.value_or(true)) choice.file.keep_clips = false;
  return choice;
}

/// The marks of a face are no part of a body: only pose pictures show them.
bool are_one_body(const Take& a, const Take& b) {
  const auto without_face = [](TargetEdits edits) {
    edits.face.clear();
    return edits;
  };
  return same(a.target, b.target) && same(without_face(a.target_edits), without_face(b.target_edits)) &&
         a.method.offsets == b.method.offsets;
}

/// As the view of a take is seen in the frame shown; it stays there.
PictureCamera camera_of_view(const Session& session, size_t take) {
  const int pane = static_cast<int>(take) + 1;
  const CameraState state = camera_of(session.view, pane);
  PictureCamera camera;
  camera.yaw_deg = state.yaw * 180 / kPi, camera.pitch_deg = state.pitch * 180 / kPi;
  camera.distance_m = state.distance, camera.fov_deg = state.fov * 180 / kPi;
  camera.target = state.target + follow_offset(session, pane, std::max(0, shown_frame(session)));
  camera.orthographic = state.orthographic;
  return camera;
}

/// Takes of one body.
ExportInput input_of(const Session& session, const std::vector<size_t>& takes, const ExportChoice& choice) {
  const Take& take = session.document.takes[takes[0]];
  const TakeState& state = session.takes[takes[0]];
  ExportInput out;
  out.name = take.name;
  std::vector<std::string> rights;
  for (const size_t k : takes) {
    const std::string& name = session.document.takes[k].name;
    US_CHECK(session.takes[k].problem.empty(), name, ": ", session.takes[k].problem);
    US_CHECK(!session.document.takes[k].flat, name,
             ": is 2D poses, which are exported by themselves: .mp4, a folder, .json, .csv or .npz");
    US_CHECK(session.takes[k].ready && session.takes[k].character && !session.takes[k].shown.poses.empty(),
             name, ": has no frames to export yet");
    add_clip(out, session, k, takes.size() > 1 ? name : clip_name(session, take));
    rights.push_back(session.takes[k].rights);
  }
  out.body = {state.character, state.deformer, choice.file, choice.poses, take.target_edits.face};
  if (choice.pane_camera) out.body.poses.camera = camera_of_view(session, takes[0]);
  out.body.file.rights = joined_once(rights, "; ");
  const bool own = on_their_rig(take.target, *state.character);
  US_CHECK(own || !choice.own_bones.value_or(false), take.name, ": does not perform on bones of its own");
  out.body.file.their_rig = choice.own_bones.value_or(own && choice.format->is_character);
  out.body.file.joints = state.target->joints;
  return out;
}

/// Makes a folder, and those above it that are missing.
/// In the end those of them that are still empty go again.
class MadeFolder {
 public:
  explicit MadeFolder(const fs::path& folder) {
    std::error_code failed;
    for (fs::path each = folder; !each.empty() && !fs::exists(each, failed); each = each.parent_path())
      made_.push_back(each);
    fs::create_directories(folder, failed);  // what is written into it says why it is not there
  }
  ~MadeFolder() {
    std::error_code failed;
    for (const fs::path& each : made_)
      if (fs::is_directory(each, failed)) fs::remove(each, failed);
  }
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

 private:
  std::vector<fs::path> made_;  // the innermost first
};

using WriteTake = decltype(TakeFile::write);
/// A file of each take. `writing` gives what writes the take k to a path, or throws.
std::vector<TakeFile> files_of(const Session& session, const std::string& folder, const std::string& suffix,
                               const std::function<WriteTake(size_t k, const std::string& path)>& writing) {
  std::vector<TakeFile> files;
  for (const std::string& name : take_file_names(session.document, suffix)) {
    TakeFile file{(fs::path(folder) / name).string(), "", {}};
    file.problem = failure_of([&] { file.write = writing(files.size(), file.path); });
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace

ExportChoice export_choice(const std::string& path, const std::vector<std::string>& words) {
  ExportChoice out;
  std::string format;
  const bool is_character =
      std::any_of(export_formats().begin(), export_formats().end(),
                  [&](const auto& one) { return one.is_character && file_suffix(path) == one.suffix; });
  for (const std::string& text : words) {
    const size_t equals = text.find('=');
    US_CHECK(equals != std::string::npos, "an option of an export is key=value, not '", text, "'");
    const std::string key = text.substr(0, equals), value = text.substr(equals + 1);
    if (key == "preset") {
      const ExportPreset& preset = export_preset(value);
      apply(preset, out.file);
      if (!is_character) format = preset.format;
    } else if (key == "format")
      format = value;
    else
      set_option(out, key, value);
  }
  out.format = &export_format(format, path);
  if (out.own_bones.value_or(false)) check_own_bones(path, *out.format);
  return out;
}

size_t take_called(const Document& document, const std::string& name, int first) {
  const auto& takes = document.takes;
  std::vector<size_t> named;
  std::string all;
  for (size_t k = 0; k < takes.size(); ++k) {
    if (takes[k].name == name) named.push_back(k);
    all += (k > 0 ? ", " : "") + std::to_string(static_cast<int>(k) + first) + " " + takes[k].name;
  }
  US_CHECK(named.size() <= 1, "several takes are called '", name, "': give its number, of ", all);
  if (!named.empty()) return named[0];
  for (size_t k = 0; k < takes.size(); ++k)
    if (std::to_string(static_cast<int>(k) + first) == name) return k;
  throw Error("there is no take '" + name + "'" + (all.empty() ? "" : ", only " + all));
}

std::vector<size_t> takes_of_one_file(const Document& document, size_t take) {
  std::map<std::string, const Take*> characters;  // by whom they perform
  characters[person_of(document, document.takes.at(take))] = &document.takes[take];
  std::vector<size_t> out;
  for (size_t k = 0; k < document.takes.size(); ++k) {
    const Take& one = document.takes[k];
    if (are_one_body(one, *characters.emplace(person_of(document, one), &one).first->second))
      out.push_back(k);
  }
  return out;
}

std::vector<ExportInput> export_inputs(const Session& session, const std::vector<size_t>& takes,
                                       const ExportChoice& choice) {
  US_CHECK(!takes.empty(), "no take was chosen for export");
  std::vector<std::vector<size_t>> of_people;  // takes of the same person
  for (const size_t k : takes) {
    const Take& take = session.document.takes.at(k);
    const auto same_person = [&](const auto& of) {
      const Document& document = session.document;
      return person_of(document, document.takes[of[0]]) == person_of(document, take);
    };
    const auto found = std::find_if(of_people.begin(), of_people.end(), same_person);
    if (found == of_people.end()) {
      of_people.push_back({k});
      continue;
    }
    const Take& first = session.document.takes[found->front()];
    US_CHECK(
        are_one_body(take, first), take.name, ": is no take of the same target as ", first.name,
        ", with the same joints, weights and offsets, nor of another person: it cannot be in the same file");
    found->push_back(k);
  }
  std::vector<ExportInput> inputs;
  inputs.reserve(of_people.size());
  for (const auto& of : of_people)
    inputs.push_back(
        input_of(session, of, of_people.size() > 1 ? choice_for(session, of[0], choice) : choice));
  return inputs;
}

KeypointReading exported_poses(const Session& session, size_t take, const PictureCount& count) {
  const Take& of = session.document.takes.at(take);
  const TakeState& state = session.takes.at(take);
  US_CHECK(state.problem.empty(), of.name, ": ", state.problem);
  US_CHECK(state.flat && !state.flat->poses.empty(), of.name, ": has no frames to export yet");
  KeypointReading made = state.flat->made;
  const int64_t all = ssize(made.frames);
  const auto& trim = of.pose_edits.trim;
  const int64_t first = trim ? std::min<int64_t>(trim->first, all - 1) : 0;
  int64_t length = (trim ? std::min<int64_t>(trim->last + 1, all) : all) - first;
  if (count.count > 0) length = std::min<int64_t>(length, count.count);
  if (count.is_4n_plus_1) length = (length - 1) / 4 * 4 + 1;
  made.frames = {made.frames.begin() + first, made.frames.begin() + first + length};
  for (KeypointTrack& track : made.tracks) {
    std::vector<TrackedPose> kept;
    for (TrackedPose& pose : track.poses)
      if (pose.frame >= first && pose.frame < first + length)
        pose.frame -= first, kept.push_back(std::move(pose));
    track.poses = std::move(kept);
  }
  return made;
}

std::string safe_file_name(const std::string& name) {
  std::string safe = name;
  for (char& c : safe)
    if (static_cast<unsigned char>(c) < 32 || std::string("/\\:*?\"<>|").find(c) != std::string::npos)
      c = '_';
  return safe.empty() || safe == "." || safe == ".." ? "take" : safe;
}

std::vector<std::string> take_file_names(const Document& document, const std::string& suffix) {
  std::vector<std::string> names;
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& one) { return lower_case(one) == lower_case(name); });
  };
  for (const Take& take : document.takes) {
    const std::string stem = safe_file_name(take.name);
    std::string name = stem + suffix;
    for (int i = 2; is_taken(name); ++i) name = stem + " " + std::to_string(i) + suffix;
    names.push_back(std::move(name));
  }
  return names;
}

std::vector<TakeFile> take_files(const Session& session, const std::string& folder,
                                 const ExportChoice& choice) {
  const ExportFormat& format = *choice.format;
  return files_of(session, folder, format.suffix, [&](size_t k, const std::string& path) -> WriteTake {
    check_not_read(path, files_read_by(session.document));
    const auto performers = std::make_shared<std::vector<ExportInput>>(
        export_inputs(session, {k}, choice_for(session, k, choice)));
    return [performers, path, &format](const std::function<void(float)>& progress) {
      check_export(path, format);
      performers->front().body.file.progress = progress;
      export_motion(path, format, *performers);
    };
  });
}

std::vector<TakeFile> figure_files(const Session& session, const std::string& folder) {
  return files_of(session, folder, ".csv", [&](size_t k, const std::string& path) -> WriteTake {
    US_CHECK(!session.takes[k].series.empty(), session.document.takes[k].name, ": there are no metrics yet");
    return [path, series = session.takes[k].series, times = session.takes[k].times,
            fps = session.source.fps](const auto&) { write_csv(path, series, fps, times); };
  });
}

std::vector<std::string> write_takes(const std::string& folder, const std::vector<TakeFile>& files,
                                     const std::function<void(float)>& progress) {
  const MadeFolder made(folder);
  std::vector<std::string> problems;
  for (size_t i = 0; i < files.size(); ++i) {
    const auto of_all = [&](float done) {
      if (progress) progress((static_cast<float>(i) + done) / static_cast<float>(files.size()));
    };
    of_all(0);
    problems.push_back(files[i].write ? failure_of([&] { files[i].write(of_all); }) : files[i].problem);
  }
  if (progress) progress(1);  // whoever stopped the last one is heard here
  const auto is_written = [](const std::string& problem) { return problem.empty(); };
  if (std::any_of(problems.begin(), problems.end(), is_written)) return problems;
  std::string all;
  for (const std::string& problem : problems) append_item(all, problem, "; ");
  throw Error(all.empty() ? "there is no take to export" : all);
}

}  // namespace understudy::app
