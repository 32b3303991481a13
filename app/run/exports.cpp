#include "app/run/exports.hpp"

#include <algorithm>
#include <filesystem>
#include <type_traits>

#include "app/run/pose_pictures.hpp"
#include "app/run/report.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/own_bones.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/formats/surface_writer.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

Joints joints_of(const ExportBody& body) {
  return body.file.joints.value_or(body.character->target.joints);
}

/// The surface as the target's file has it: its vertices in its order, its corners' texture coordinates.
SurfaceTopology topology_of(const PreparedCharacter& c) {
  SurfaceTopology out;
  out.vertex_count = static_cast<int64_t>(c.surface.in_file.size());
  Eigen::Index faces = 0, vertices = 0;
  bool colored = true, textured = true;
  for (const auto& part : c.character.parts) {
    faces += part.faces.rows();
    vertices += part.vertices.rows();
    colored = colored && part.colors.rows() > 0;
    textured = textured && !part.uvs.empty();
  }
  const auto& numbers = c.character.file_vertices;
  const auto number = [&](Eigen::Index v) { return numbers.empty() ? static_cast<int>(v) : numbers[v]; };
  out.faces.resize(faces, 3);
  if (textured) out.uv_faces.resize(faces, 3), out.uvs.resize(vertices, 2);
  if (colored) out.colors = Points::Zero(out.vertex_count, 3);
  Eigen::Index face = 0, first = 0;
  for (const auto& part : c.character.parts) {
    for (Eigen::Index f = 0; f < part.faces.rows(); ++f, ++face)
      for (int k = 0; k < 3; ++k) {
        out.faces(face, k) = number(first + part.faces(f, k));
        if (textured) out.uv_faces(face, k) = static_cast<int>(first) + part.faces(f, k);
      }
    for (Eigen::Index v = 0; v < part.vertices.rows(); ++v) {
      if (colored) out.colors.row(number(first + v)) = part.colors.row(v).head<3>();
      if (textured) out.uvs.row(first + v) << part.uvs[0](v, 0), 1 - part.uvs[0](v, 1);  // v up
    }
    first += part.vertices.rows();
  }
  return out;
}

/// Who performs what is written.
class ExportedBody {
 public:
  explicit ExportedBody(const ExportBody& body) : body_(body), rest_(joints_of(body)) {}
  /// The frame as the options ask for it.
  ExportFrame performed(const ExportFrame& frame, Pose& pose) const {
    pose = frame.pose;
    if (!body_.file.in_place) return {pose, frame.source_joints, frame.vertices};
    pose.root = Vec3(rest_(Pelvis, 0), pose.root.y(), rest_(Pelvis, 2));
    return {pose, frame.source_joints, nullptr};
  }
  Joints joints(const ExportFrame& frame) const { return forward_kinematics(rest_, frame.pose).joints; }
  /// In the file's order.
  Points surface(const ExportFrame& frame) const {
    const MergedSurface& merged = body_.character->surface;
    return merged.in_file_order(frame.vertices ? *frame.vertices : body_.screen->deform(frame.pose));
  }

 private:
  ExportBody body_;
  Joints rest_;
};

/// A format that takes frame after frame. kSurface: its vertices are those of the screen.
template <class Writer, bool kSurface>
class FrameOutput final : public MotionOutput {
 public:
  using Write = void (*)(Writer& writer, const ExportedBody& by, const ExportFrame& frame);
  template <class... Arguments>
  FrameOutput(const std::string& path, const ExportBody& body, Write write, Arguments&&... of_writer)
      : path_(path), by_(body), write_(write), writer_(path, std::forward<Arguments>(of_writer)...) {}
  void push(const ExportFrame& frame) override {
    Pose pose;
    write_(writer_, by_, by_.performed(frame, pose));
    ++frames_;
  }
  ExportCost finish() override {
    US_CHECK(frames_ > 0, path_, ": there is no motion to export");
    if constexpr (std::is_same_v<Writer, ResultWriter>)
      writer_.finish(source_to_scan_);
    else
      writer_.finish();
    ExportCost cost;
    cost.measured = kSurface;
    cost.frames = frames_;
    cost.bytes = bytes_at(path_);
    return cost;
  }

 private:
  std::string path_;
  ExportedBody by_;
  Write write_;
  Writer writer_;
  int64_t frames_ = 0;
};

/// The animated character: poses are kept, under 1 kB a frame, and written at the end.
class CharacterOutput final : public MotionOutput {
 public:
  CharacterOutput(std::string path, const ExportBody& body, const std::string& name, double fps)
      : path_(std::move(path)), body_(body), clip_{name, fps, {}} {}
  void push(const ExportFrame& frame) override {
    clip_.poses.push_back(frame.pose);
    doubt_m_.push_back(frame.doubt_m);
  }
  ExportCost finish() override {
    US_CHECK(!clip_.poses.empty(), path_, ": there is no motion to export");
    clip_.made = made_frames(doubt_m_);
    return export_character(path_, {{*body_.character, *body_.screen, {clip_}, body_.file}});
  }

 private:
  std::string path_;
  ExportBody body_;
  CharacterClip clip_;
  std::vector<float> doubt_m_;  // of each pose
};

std::unique_ptr<MotionOutput> open_character(const std::string& path, const ExportBody& body,
                                             const std::string& name, double fps) {
  return std::make_unique<CharacterOutput>(path, body, name, fps);
}

}  // namespace

const std::vector<ExportFormat>& export_formats() {
  using P = const std::string&;
  using B = const ExportBody&;
  using Output = std::unique_ptr<MotionOutput>;
  static constexpr auto pose = [](auto& to, const ExportedBody&, const ExportFrame& frame) {
    to.push(frame.pose);
  };
  static constexpr auto joints = [](auto& to, const ExportedBody& by, const ExportFrame& f) {
    to.push(by.joints(f));
  };
  static constexpr auto surface = [](auto& to, const ExportedBody& by, const ExportFrame& f) {
    to.push(by.surface(f));
  };
  static constexpr auto all = [](auto& to, const ExportedBody& by, const ExportFrame& frame) {
    to.push(by.surface(frame), by.joints(frame), frame.pose.local, frame.source_joints);
  };
  static const std::vector<ExportFormat> formats = {
      {"glb", ".glb", "GLB", "The animated character, for any engine.", true, true, true, open_character},
      {"gltf", ".gltf", "glTF", "The same as text.", true, true, true, open_character},
      {"bvh", ".bvh", "BVH", "The motion of the bones, in centimetres.", true, false, true,
       [](P path, B body, P, double fps) -> Output {
         if (body.file.their_rig)
           return std::make_unique<FrameOutput<OwnBonesBvh, false>>(
               path, body, pose, body.character, body.file.joints.value_or(body.character->pose.rest), fps);
         return std::make_unique<FrameOutput<BvhWriter, false>>(path, body, pose, joints_of(body), fps);
       }},
      {"amass", ".npz", "AMASS", "The rotations of SMPL's joints, z up.", false, false, false,
       [](P path, B body, P, double fps) -> Output {
         return std::make_unique<FrameOutput<AmassWriter, false>>(path, body, pose, fps);
       }},
      {"npz", ".npz", "NPZ", "Vertices, joints and rotations as arrays.", true, false, false,
       [](P path, B body, P, double) -> Output {
         const auto vertices = static_cast<int64_t>(body.character->surface.in_file.size());
         return std::make_unique<FrameOutput<ResultWriter, true>>(path, body, all, vertices);
       }},
      {"ply", "", "PLY", "A folder with the surface of every frame.", false, false, false,
       [](P path, B body, P, double) -> Output {
         return std::make_unique<FrameOutput<SequenceWriter, true>>(path, body, surface, SequenceFormat::Ply,
                                                                    topology_of(*body.character));
       }},
      {"obj", "", "OBJ", "The same as text, with texture coordinates.", false, false, false,
       [](P path, B body, P, double) -> Output {
         return std::make_unique<FrameOutput<SequenceWriter, true>>(path, body, surface, SequenceFormat::Obj,
                                                                    topology_of(*body.character));
       }},
      {"pc2", ".pc2", "PC2", "A vertex cache, and the mesh that it moves.", true, false, false,
       [](P path, B body, P, double) -> Output {
         const PreparedCharacter& of = *body.character;
         return std::make_unique<FrameOutput<PointCacheWriter, true>>(
             path, body, surface, topology_of(of), of.surface.in_file_order(of.target.mesh.vertices));
       }},
      {"joints", ".csv", "CSV", "The positions of the 22 joints, as a table.", true, false, false,
       [](P path, B body, P, double fps) -> Output {
         return std::make_unique<FrameOutput<JointTable, false>>(path, body, joints, fps);
       }},
      {"poses", ".mp4", "Pose pictures", "What OpenPose would draw, for generators of images and films.",
       true, false, false, open_pose_pictures, true},
      {"pose_list", ".json", "Pose JSON", "The same as a list of points, as ControlNet has it.", true, false,
       false, open_pose_pictures, true}};
  return formats;
}

std::string export_suffixes() {
  std::string suffixes;
  for (const ExportFormat& format : export_formats())
    if (format.by_suffix) append_item(suffixes, format.suffix);
  return suffixes;
}

const ExportFormat& export_format(const std::string& name, const std::string& path) {
  std::string names;
  for (const ExportFormat& format : export_formats()) {
    if (name.empty() ? format.by_suffix && file_suffix(path) == format.suffix : format.name == name)
      return format;
    append_item(names, format.name);
  }
  US_CHECK(name.empty(), path, ": there is no format '", name, "', use one of ", names);
  throw Error(path + ": its suffix is not a known output format; use " + export_suffixes() +
              "; or name a format: " + names);
}

void check_export(const std::string& path, const ExportFormat& format) {
  US_CHECK(!format.is_character || file_suffix(path) == format.suffix, path, ": a ", format.label,
           " file must end in ", format.suffix);
  if (format.is_pictures ? !is_picture_folder(path) : *format.suffix != 0) return check_writable(path);
  const PartFolder made_and_removed(path);
}

int64_t bytes_at(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return static_cast<int64_t>(fs::file_size(path, error));
  int64_t sum = 0;
  for (const auto& entry : fs::directory_iterator(path, error))
    sum += static_cast<int64_t>(entry.file_size(error));
  return sum;
}

bool is_one_of(const std::string& path, const std::vector<std::string>& files) {
  return std::any_of(files.begin(), files.end(), [&](const std::string& file) {
    std::error_code is_none;
    return !file.empty() && fs::equivalent(path, file, is_none);
  });
}

void check_not_read(const std::string& path, const std::vector<std::string>& files) {
  US_CHECK(!is_one_of(path, files), path, ": is read here, and would be lost; choose another name");
}

void check_export_options(const std::string& path, const ExportFormat& format,
                          const CharacterExportOptions& file) {
  US_CHECK(!format.is_character || file.their_rig || !file.keep_clips, path,
           ": the file's own clips need its own bones; they cannot be kept on the 22 joints");
  US_CHECK(
      !file.in_place || !file.root_motion, path,
      ": the path across the floor is either left out (in place) or carried by a root bone (root motion)");
  if (format.is_character) return;
  US_CHECK(!file.t_pose_clip, path, ": ", format.label, " holds one motion, no T-pose besides");
  US_CHECK(!file.keep_clips, path, ": ", format.label,
           " holds one motion, so the file's own clips cannot be kept");
  US_CHECK(!file.root_motion, path, ": ", format.label, " has no root bone that could carry the path");
  US_CHECK(file.shapes == 0, path, ": ", format.label, " holds no morph targets");
  US_CHECK(file.influences == 4, path, ": ", format.label, " holds no skin weights, so no ", file.influences,
           " bones per vertex");
  US_CHECK(!(file.reduce_mm > 0), path, ": ", format.label, " holds every frame, so keys cannot be left out");
}

void check_pose_choice(const std::string& path, const ExportFormat& format, const PoseChoice& poses) {
  US_CHECK(format.is_pictures || is_usual(poses), path, ": ", format.label,
           " shows no pictures: camera, canvas, rate, count and drawing are of pose pictures");
}

void check_performers(const std::string& path, const ExportFormat& format, size_t count) {
  US_CHECK(count <= 1 || format.is_character, path, ": ", format.label, " holds one motion, not ", count,
           " performers");
}

void check_own_bones(const std::string& path, const ExportFormat& format) {
  US_CHECK(format.own_bones, path, ": ", format.label, " cannot be on the character's own bones");
}

std::unique_ptr<MotionOutput> open_export(const std::string& path, const ExportFormat& format,
                                          const ExportBody& body, const std::string& name, double fps) {
  check_export_options(path, format, body.file);
  check_pose_choice(path, format, body.poses);
  if (!format.is_character) tell_left_out(path, body.file.rights);
  return format.open(path, body, name, fps);
}

void tell_left_out(const std::string& path, const std::string& rights) {
  if (!rights.empty()) log::warn(path + ": such a file has no place for its rights: " + rights);
}

ExportCost export_motion(const std::string& path, const ExportFormat& format,
                         const std::vector<ExportInput>& performers) {
  const auto has_motion = [](const ExportInput& one) { return !one.clips.empty(); };
  US_CHECK(!performers.empty() && std::all_of(performers.begin(), performers.end(), has_motion), path,
           ": there is no motion to export");
  if (format.is_character) {
    check_export(path, format);
    std::vector<CharacterPerformance> performances;
    for (const ExportInput& one : performers) {
      check_export_options(path, format, one.body.file);
      check_pose_choice(path, format, one.body.poses);
      performances.push_back({*one.body.character, *one.body.screen, one.clips, one.body.file, one.name});
    }
    return export_character(path, performances);
  }
  check_performers(path, format, performers.size());
  const ExportInput& input = performers[0];
  US_CHECK(input.clips.size() == 1, path, ": ", format.label, " holds one motion, not ", input.clips.size());
  const CharacterClip& clip = input.clips[0];
  const auto output = open_export(path, format, input.body, clip.name, clip.fps);
  const bool tells = input.body.file.progress && !output->is_written_at_end();
  for (size_t t = 0; t < clip.poses.size(); ++t) {
    if (tells) input.body.file.progress(static_cast<float>(t) / static_cast<float>(clip.poses.size()));
    ExportFrame frame{clip.poses[t]};
    if (t < input.source_joints.size()) frame.source_joints = input.source_joints[t];
    output->push(frame);
  }
  if (tells) input.body.file.progress(1);
  output->set_source_to_scan(input.source_to_scan);
  return output->finish();
}

std::string sentence(const ExportCost& cost) {
  const double megabytes = static_cast<double>(cost.bytes) / 1e6;
  if (!cost.measured) return printed("%s frames, %.1f MB", grouped(cost.frames).c_str(), megabytes);
  return printed("differs from the viewport by %s mm on average, %s mm at most; %.1f MB",
                 short_number(cost.mean_mm).c_str(), short_number(cost.largest_mm).c_str(), megabytes);
}

}  // namespace understudy::app
