#include "app/run/samples.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/run/flat_samples.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/body/capture.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/formats/surface_writer.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

/// Name and FNV-1a checksum of each file written.
struct Written {
  fs::path folder;
  std::vector<std::pair<std::string, uint64_t>> files;
};

void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  US_CHECK(fs::is_directory(folder, failed), folder.string(), ": the folder cannot be made");
}

template <class T>
void append(std::string& bytes, const T* values, size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// A mesh as binary glTF 2.0: positions and indices, nothing else.
std::string glb_bytes(const Points& vertices, const Faces& faces, const std::string& name) {
  const auto numbers = [](const Eigen::RowVector3f& v) {
    return printed("[%.9g,%.9g,%.9g]", v.x(), v.y(), v.z());
  };
  const size_t position_bytes = static_cast<size_t>(vertices.size()) * 4,
               index_bytes = static_cast<size_t>(faces.size()) * 4;
  std::string json = printed(
      R"({"asset":{"version":"2.0","generator":"Understudy"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0,"name":"%s"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      R"("buffers":[{"byteLength":%zu}],"bufferViews":[{"buffer":0,"byteLength":%zu,"target":34962},)"
      R"({"buffer":0,"byteOffset":%zu,"byteLength":%zu,"target":34963}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":%td,"min":%s,"max":%s},)"
      R"({"bufferView":1,"componentType":5125,"type":"SCALAR","count":%td}]})",
      name.c_str(), position_bytes + index_bytes, position_bytes, position_bytes, index_bytes,
      vertices.rows(), numbers(vertices.colwise().minCoeff()).c_str(),
      numbers(vertices.colwise().maxCoeff()).c_str(), faces.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  const auto word = [&bytes](size_t value) {
    const auto v = static_cast<uint32_t>(value);
    append(bytes, &v, 1);
  };
  word(2), word(12 + 8 + json.size() + 8 + position_bytes + index_bytes), word(json.size());
  bytes += "JSON" + json;
  word(position_bytes + index_bytes);
  bytes += std::string("BIN\0", 4);
  append(bytes, vertices.data(), vertices.size());
  append(bytes, faces.data(), faces.size());
  return bytes;
}

/// The scans of a body in every frame, [T] of [V, 3].
void write_frames(const std::string& name, const std::vector<Points>& frames, const Faces& faces,
                  const CaptureOptions& capture, Written& written) {
  make_folder(written.folder / name);
  uint64_t hash = kFnvStart;
  for (size_t i = 0; i < frames.size(); ++i) {
    const Mesh scan = simulated_capture(frames[i], faces, static_cast<int>(i), capture);
    const std::string bytes = ply_bytes({}, scan.vertices, "");
    write_file(written.folder / name / printed("frame_%05d.ply", static_cast<int>(i)), bytes);
    hash = fnv1a(bytes, hash);
  }
  written.files.emplace_back(printed("%s/ (%zu frames in order)", name.c_str(), frames.size()), hash);
}

struct ScanSample {
  const char* name;
  const char* motion;
  PersonOptions person;
  float from, seconds;
  int points;
};

void write_person(const ScanSample& sample, Written& written) {
  constexpr float kFps = 30;
  const ShapedBody body = builtin_person(sample.person);
  const Motion motion = builtin_motion(sample.motion, body.joints, kFps);
  CaptureOptions capture;
  capture.points = sample.points;
  const int first = static_cast<int>(sample.from * kFps), count = static_cast<int>(sample.seconds * kFps);
  std::vector<Points> frames;
  for (int i = first; i < first + count; ++i)
    frames.push_back(linear_blend_skinning(body.vertices, body.weights, body.joints,
                                           forward_kinematics(body.joints, motion.poses.at(i))));
  write_frames(sample.name, frames, body.faces, capture, written);
}

/// An animal on four legs that walks by, without floor and outliers: its own skeleton is found in it.
void write_animal(Written& written) {
  constexpr auto kKind = CreatureKind::Quadruped;
  constexpr uint64_t kSeed = 4;
  constexpr int kFrames = 48, kMotion = 0;
  const understudy::Rig rig = make_creature(kKind, kSeed);
  const RigMotion motion = creature_motion(kKind, rig, kMotion, kFrames, 30, kSeed);
  CaptureOptions capture;
  capture.points = 4900;
  capture.noise = 0.002f, capture.floor = 0, capture.outliers = 0;
  write_frames("animal", creature_surfaces(kKind, rig, motion, kSeed), rig.surface.faces, capture, written);
}

void write_sample_target(const std::string& name, const PersonOptions& person, Written& written) {
  const ShapedBody body = builtin_person(person);
  Points standing = body.vertices;
  standing.col(1).array() -= standing.col(1).minCoeff();
  const std::string bytes = glb_bytes(standing, body.faces, name);
  write_file(written.folder / (name + ".glb"), bytes);
  written.files.emplace_back(name + ".glb", fnv1a(bytes));
}

/// What write_flat_samples() makes.
void add_flat_samples(Written& written) {
  write_flat_samples(written.folder.string());
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(written.folder / "poses")) frames.push_back(entry.path());
  std::sort(frames.begin(), frames.end());
  uint64_t hash = kFnvStart;
  for (const fs::path& frame : frames) hash = fnv1a(read_file(frame.string()), hash);
  written.files.emplace_back(printed("poses/ (%zu frames in order)", frames.size()), hash);
  for (const char* name : {"reference.json", "reference.png"})
    written.files.emplace_back(name, fnv1a(read_file((written.folder / name).string())));
}

std::string readme(const Written& written) {
  std::string text =
      "# Samples\n\nMade by the program itself (`understudy sample FOLDER`) from its built-in person, "
      "built-in motions and simulated\n"
      "capture; no outside data. Licence: MIT, as the program.\n\n"
      "- `scan/`: a woman, 1.68 m, dances for 2.9 s; what seven depth cameras see at 30 frames/s: point "
      "counts and order change from\n"
      "  frame to frame, 4 mm noise, holes, a few outliers, some floor. Binary PLY, metres, y up.\n"
      "- `walk/`: a man, 1.80 m, walks for 1.5 s, captured the same way.\n"
      "- `animal/`: an animal on four legs walks for 1.6 s, captured with 2 mm noise, without floor and "
      "outliers.\n"
      "- `target_adult.glb`: a broad heavy man, 1.76 m, in T-pose. `target_child.glb`: a girl of six, 1.15 "
      "m.\n"
      "- `poses/`: 2D poses (OpenPose's BODY_25, 1024 x 768, 30 frames/s): the woman dances for 3 s while a "
      "man walks by behind her; as a\n"
      "  good detector sees them, 6 mm off, one point in a hundred missing. `reference.json`, "
      "`reference.png`: a girl of six in one picture.\n\n"
      "| file | FNV-1a, 64 bit |\n|---|---|\n";
  for (const auto& [name, hash] : written.files)
    text += printed("| %s | %016llx |\n", name.c_str(), static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace

void write_samples(const std::string& folder) {
  Written written{folder, {}};
  make_folder(written.folder);
  write_person({"scan", "dance", PersonOptions{1.68f, 1.0f, 1, 28}, 1.2f, 2.9f, 4800}, written);
  write_person({"walk", "walk", PersonOptions{1.80f, .95f, 0, 35}, 1.0f, 1.5f, 4500}, written);
  write_animal(written);
  write_sample_target("target_adult", PersonOptions{1.76f, 1.40f, 0, 45}, written);
  write_sample_target("target_child", PersonOptions{1.15f, 1.0f, 1, 6}, written);
  add_flat_samples(written);
  write_file(written.folder / "README.md", readme(written));
}

}  // namespace understudy::app
