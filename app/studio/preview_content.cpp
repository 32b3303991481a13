#include "app/studio/preview_content.hpp"

#include <algorithm>
#include <filesystem>

#include "app/run/flat_performance.hpp"
#include "app/run/source.hpp"
#include "app/run/target_file.hpp"
#include "app/session/document_file.hpp"
#include "app/study/trials.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/motion/read_motion.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

constexpr uintmax_t kLargestFile = 256u << 20;  // bytes of a file that is read only to be looked at
constexpr size_t kClipsNamed = 4;
constexpr int kSkipped = 10;  // frames that cannot be used, before one is shown

std::string described(const Mesh& mesh) {
  return mesh.is_cloud()
             ? grouped(mesh.vertices.rows()) + " points"
             : grouped(mesh.vertices.rows()) + " vertices, " + grouped(mesh.faces.rows()) + " faces";
}

/// A value that a share of them lies below.
float quantile(Eigen::VectorXf values, float share) {
  const auto at = values.data() + static_cast<Eigen::Index>(share * static_cast<float>(values.size() - 1));
  std::nth_element(values.data(), at, values.data() + values.size());
  return *at;
}

/// Without the few points far from all others: a small picture is of what matters.
Mesh without_outliers(Mesh mesh) {
  if (!mesh.is_cloud() || mesh.vertices.rows() < 100) return mesh;
  std::vector<Eigen::Index> kept;
  Eigen::RowVector3f low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = quantile(mesh.vertices.col(axis), 0.02f),
    high[axis] = quantile(mesh.vertices.col(axis), 0.98f);
    const float room = 0.15f * (high[axis] - low[axis]);
    low[axis] -= room, high[axis] += room;
  }
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i)
    if ((mesh.vertices.row(i).array() >= low.array()).all() &&
        (mesh.vertices.row(i).array() <= high.array()).all())
      kept.push_back(i);
  const Points points = mesh.vertices(kept, Eigen::all);
  mesh.vertices = points;
  mesh.colors.resize(0, 3);
  return mesh;
}

/// On the floor, 1.7 high and round the y axis, whatever its units.
Mesh normalized(Mesh mesh) {
  if (mesh.is_cloud()) mesh.vertices = finite_points(mesh.vertices);
  if (mesh.vertices.rows() == 0) return mesh;
  US_CHECK(mesh.vertices.allFinite(), "has vertices that are not finite");
  mesh = without_outliers(std::move(mesh));
  const Eigen::RowVector3f low = mesh.vertices.colwise().minCoeff(),
                           high = mesh.vertices.colwise().maxCoeff();
  const float size = (high - low).maxCoeff();
  const Eigen::RowVector3f foot(0.5f * (low.x() + high.x()), low.y(), 0.5f * (low.z() + high.z()));
  mesh.vertices.rowwise() -= foot;
  if (size > 0) mesh.vertices *= 1.7f / size;
  return mesh;
}

/// "1 clip, 4.2 s", or "6 clips: walk 4.2 s, run 2.0 s, idle 8.1 s, jump 1.3 s, ...".
std::string clips_text(const std::vector<SourceClip>& clips) {
  if (clips.empty()) return "";
  if (clips.size() == 1) return printed("1 clip, %.1f s", clips[0].seconds);
  std::string text = std::to_string(clips.size()) + " clips: ";
  for (size_t i = 0; i < std::min(clips.size(), kClipsNamed); ++i)
    text += (i > 0 ? ", " : "") + (clips[i].name.empty() ? std::to_string(i + 1) : clips[i].name) +
            printed(" %.1f s", clips[i].seconds);
  return text + (clips.size() > kClipsNamed ? ", \u2026" : "");
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + "; " + b;
}

/// Upright and facing forward as it will be imported; as the file has it where no person is seen in it.
MergedSurface standing(const Character& character) {
  try {
    return load_character(character).surface;
  } catch (const Error&) {
    MergedSurface surface = merged_surface(character, bind_pose(character).vertices);
    paint(surface, character);
    return surface;
  }
}

PreviewContent of_character(const Character& character) {
  PreviewContent content;
  content.mesh = normalized(standing(character).mesh);
  std::vector<SourceClip> clips;
  for (const CharacterAnimation& animation : character.animations)
    clips.push_back({animation.name, static_cast<double>(animation.duration())});
  content.text = joined(described(content.mesh), clips_text(clips));
  return content;
}

/// The skeleton of a motion, else the first frame of a scan.
PreviewContent of_source(const std::string& path, const std::string& up = "") {
  PreviewContent content;
  SourceOptions options;
  options.path = path;
  options.quiet = true;
  if (!up.empty()) options.import.up = up;
  const auto source = open_source(options);
  const auto count = source->count();
  const bool moves = !source->clips().empty();
  if (moves && count && *count > 1) source->seek(*count / 2);
  auto frame = source->next();
  for (int skipped = 0; frame && !frame->usable && skipped < kSkipped; ++skipped) frame = source->next();
  US_CHECK(frame && frame->usable, frame ? frame->problem : path + ": has no frames");
  const std::string frames = count ? grouped(*count) + (*count == 1 ? " frame" : " frames") : "";
  if (!moves || !frame->skeleton) {
    content.mesh = normalized(frame->mesh);
    content.text = frames + (frames.empty() ? "" : ", ") + described(frame->mesh);
    return content;
  }
  Joints joints = frame->skeleton->joints;
  const Vec3 low = joints.colwise().minCoeff(), high = joints.colwise().maxCoeff();
  joints.rowwise() -= Vec3(0.5f * (low.x() + high.x()), low.y(), 0.5f * (low.z() + high.z())).transpose();
  content.joints = joints;
  content.text = joined(clips_text(source->clips()), frames);
  return content;
}

PreviewContent of_document(const std::string& path) {
  const SavedDocument saved = read_document(path);
  PreviewContent content;
  if (!saved.document.source.path.empty()) content = preview_content(saved.document.source.path);
  const size_t takes = saved.document.takes.size();
  content.text = joined(std::to_string(takes) + (takes == 1 ? " target" : " targets"), content.text);
  return content;
}

std::string study_in_words(const std::string& path) {
  const Study study = read_draft(path);
  std::string words;
  const std::string problem = failure_of([&] { words = size_in_words(study); });
  return study.name + ": " + (problem.empty() ? words : problem);
}

/// Words alone.
PreviewContent of_poses(const std::string& path) {
  FlatSourceOptions options;
  options.path = path;
  const KeypointReading reading = open_keypoints(options);
  const auto counted = [](size_t count, const char* one, const char* many) {
    return grouped(static_cast<int64_t>(count)) + " " + (count == 1 ? one : many);
  };
  PreviewContent content;
  content.text = reading.format + ", " + reading.layout + ", " +
                 counted(reading.frames.size(), "frame", "frames") + ", " +
                 counted(reading.tracks.size(), "person", "people");
  if (!reading.canvas_is_guessed) content.text += ", " + canvas_text(reading.canvas);
  return content;
}

PreviewContent of_folder(const std::string& path, const std::string& up) {
  try {
    return of_source(fs::exists(fs::path(path) / "case.json") ? path + "/source" : path, up);
  } catch (const std::exception&) {  // what it would say is about somebody's files, which nobody wants opened
    return {{}, std::nullopt, "No frames of a scan in this folder."};
  }
}

PreviewContent of_file(const std::string& path) {
  if (!can_be(path, kTarget | kScanSequence | kMotion)) return {};
  if (fs::file_size(path) > kLargestFile) return {{}, std::nullopt, "Too large for a preview."};
  const bool only_moves = can_be(path, kBody) && is_motion_file(path);
  if (can_be(path, kTarget) && !only_moves) {
    const Character character = read_target(path, {});
    if (character.vertex_count() > 0 || !can_be(path, kMotion)) return of_character(character);
  }
  return of_source(path);
}

}  // namespace

PreviewContent preview_content(const std::string& path, const std::string& up) {
  try {
    if (can_be(path, kDocument)) return of_document(path);
    if (can_be(path, kStudy)) return {{}, std::nullopt, study_in_words(path)};
    if (looks_like_keypoints(path)) return of_poses(path);
    return fs::is_directory(path) ? of_folder(path, up) : of_file(path);
  } catch (const CanvasUnknownError&) {
    return {{}, std::nullopt, "2D poses that do not say how large their picture is; you will be asked."};
  } catch (const std::exception& error) {
    return {{}, std::nullopt, error.what()};  // shown beside the file: it is only looked at
  }
}

}  // namespace understudy::app
