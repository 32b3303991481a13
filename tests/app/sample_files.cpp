#include "tests/app/sample_files.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy::tests {
namespace {

const ShapedBody& person() {
  static const ShapedBody body = builtin_person();
  return body;
}

}  // namespace

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  US_CHECK(file, path, ": cannot be written");
}

void write_cloud(const std::string& path, const Points& points) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(points.rows()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  bytes.append(reinterpret_cast<const char*>(points.data()),
               static_cast<size_t>(points.size()) * sizeof(float));
  write_text(path + ".part", bytes);
  std::filesystem::rename(path + ".part", path);
}

void write_target(const std::string& path) {
  std::ofstream file(path);
  const ShapedBody& body = person();
  for (Eigen::Index v = 0; v < body.vertices.rows(); ++v)
    file << "v " << body.vertices(v, 0) << ' ' << body.vertices(v, 1) << ' ' << body.vertices(v, 2) << '\n';
  for (Eigen::Index f = 0; f < body.faces.rows(); ++f)
    file << "f " << body.faces(f, 0) + 1 << ' ' << body.faces(f, 1) + 1 << ' ' << body.faces(f, 2) + 1
         << '\n';
  file.close();
  US_CHECK(file, path, ": cannot be written");
}

Points person_points(int frame) {
  Rng rng(static_cast<uint64_t>(frame) + 1);
  Mesh mesh;
  mesh.vertices = person().vertices;
  mesh.faces = person().faces;
  Points points = sample_points(mesh, 2500, rng);
  points.rowwise() +=
      Eigen::RowVector3f(0, -mesh.vertices.col(1).minCoeff(), 0.02f * static_cast<float>(frame));
  return points;
}

std::string frame_name(int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%05d.ply", frame);
  return name;
}

void write_scans(const std::string& folder, int count) {
  std::filesystem::create_directories(folder);
  for (int i = 0; i < count; ++i) write_cloud(folder + "/" + frame_name(i), person_points(i));
}

void write_walk(const std::string& path, const WalkOptions& options) {
  const bool still = options.motion == "still";
  Motion motion = builtin_motion(still ? "walk" : options.motion, human_rest());
  const auto all = static_cast<int>(motion.poses.size());
  motion.poses.erase(motion.poses.begin() + std::min(options.last + 1, all), motion.poses.end());
  motion.poses.erase(motion.poses.begin(), motion.poses.begin() + options.first);
  NpyArray poses, trans, fps;
  const auto count = static_cast<int64_t>(motion.poses.size());
  poses.shape = {count, 3 * kJointCount}, trans.shape = {count, 3}, fps.values = {options.fps};
  for (Pose pose : motion.poses) {
    if (still) pose.local = identity_rotations();
    if (options.mirrored) pose = mirrored(pose);
    for (const Mat3& R : pose.local) {
      const Vec3 turn = rotation_to_axis_angle(R);
      poses.values.insert(poses.values.end(), turn.begin(), turn.end());
    }
    trans.values.insert(trans.values.end(), pose.root.begin(), pose.root.end());
  }
  write_npz(path, {{"poses", poses}, {"trans", trans}, {"mocap_framerate", fps}});
}

}  // namespace understudy::tests
