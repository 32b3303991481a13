// A person of 500 vertices all the way: opened, bound, bent, written and read back.
#include <array>
#include <fstream>
#include <map>

#include "retarget/body/builtin_person.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/bent_volume.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/motion/made_motion.hpp"

namespace understudy::tests {
namespace {

/// The built-in person with all vertices in one cell of a grid drawn together.
Mesh low_poly(float cell) {
  const ShapedBody body = builtin_person();
  std::map<std::array<int, 3>, int> at;
  std::vector<int> of;
  std::vector<Vec3> sums;
  std::vector<int> counts;
  for (Eigen::Index v = 0; v < body.vertices.rows(); ++v) {
    std::array<int, 3> key;
    for (int k = 0; k < 3; ++k) key[k] = static_cast<int>(std::floor(body.vertices(v, k) / cell));
    const int n = at.try_emplace(key, static_cast<int>(sums.size())).first->second;
    if (n == static_cast<int>(sums.size())) sums.push_back(Vec3::Zero()), counts.push_back(0);
    sums[n] += body.vertices.row(v).transpose();
    ++counts[n];
    of.push_back(n);
  }
  Mesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(sums.size()), 3);
  for (size_t n = 0; n < sums.size(); ++n)
    mesh.vertices.row(static_cast<Eigen::Index>(n)) = (sums[n] / static_cast<float>(counts[n])).transpose();
  std::vector<std::array<int, 3>> faces;
  for (Eigen::Index f = 0; f < body.faces.rows(); ++f) {
    const int a = of[body.faces(f, 0)], b = of[body.faces(f, 1)], c = of[body.faces(f, 2)];
    if (a != b && b != c && a != c) faces.push_back({a, b, c});
  }
  mesh.faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (size_t f = 0; f < faces.size(); ++f)
    mesh.faces.row(static_cast<Eigen::Index>(f)) << faces[f][0], faces[f][1], faces[f][2];
  return mesh;
}

void write_obj(const std::string& path, const Mesh& mesh) {
  std::ofstream file(path);
  for (Eigen::Index v = 0; v < mesh.vertices.rows(); ++v)
    file << "v " << mesh.vertices(v, 0) << ' ' << mesh.vertices(v, 1) << ' ' << mesh.vertices(v, 2) << '\n';
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    file << "f " << mesh.faces(f, 0) + 1 << ' ' << mesh.faces(f, 1) + 1 << ' ' << mesh.faces(f, 2) + 1
         << '\n';
}

/// The T-pose, then each limb bent by 100 degrees in a frame of its own, in the order of BentVolume.
std::vector<Pose> bends(const Joints& rest) {
  std::vector<Pose> poses(1 + BentVolume::kBends.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    poses[i].root = rest.row(Pelvis).transpose();
    if (i == 0) continue;
    const int joint = BentVolume::kBends[i - 1];
    const float side = i % 2 == 1 ? -1.0f : 1.0f;  // left, right
    Vec3 turn(-100, 0, 0);                         // hips
    if (joint == LeftElbow || joint == RightElbow) turn = Vec3(0, 100 * side, 0);
    if (joint == LeftKnee || joint == RightKnee) turn = Vec3(100, 0, 0);
    if (joint == LeftShoulder || joint == RightShoulder) turn = Vec3(0, 0, 80 * side);  // arms down
    poses[i].local[joint] = rotation_from_axis_angle(turn * kPi / 180);
  }
  return poses;
}

class LowPoly : public ShippedProgram {};

TEST_F(LowPoly, BendsWithoutTearingAndKeepsItsFlesh) {
  const Mesh mesh = low_poly(0.085f);
  ASSERT_GT(mesh.vertices.rows(), 300);
  ASSERT_LT(mesh.vertices.rows(), 650);
  write_obj(scratch.path("low.obj"), mesh);
  const Joints rest = builtin_person().joints;
  MadeBvh made;
  made.fps = 30;
  std::ofstream(scratch.path("bends.bvh")) << made_bvh(made, rest, bends(rest));
  const Finished done =
      run_program({"export", "--source", scratch.path("bends.bvh"), "--target", scratch.path("low.obj"),
                   "--no-foot-lock", "--fps", "30", "--out", out("low.glb")});
  ASSERT_EQ(done.code, 0) << done.err;
  const Character file = read_character(out("low.glb"));
  ASSERT_EQ(file.vertex_count(), mesh.vertices.rows());
  const auto nodes = file.world();
  Joints joints;
  for (int j = 0; j < kJointCount; ++j) joints.row(j) = nodes[j].topRightCorner<3, 1>();
  const Points still = vertices_at(file, 0, 0);
  const Faces& faces = file.parts.at(0).faces;
  const BentVolume volume(still, faces, joints);
  for (size_t bend = 0; bend < BentVolume::kBends.size(); ++bend) {
    const Points posed = vertices_at(file, 0, static_cast<float>(bend + 1) / 30);
    const double kept = volume.kept(bend, posed);
    EXPECT_GT(kept, 0.6) << bend;
    EXPECT_LT(kept, 1.5) << bend;
    float longest = 0;
    for (Eigen::Index f = 0; f < faces.rows(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int a = faces(f, k), b = faces(f, (k + 1) % 3);
        longest =
            std::max(longest, (posed.row(a) - posed.row(b)).norm() - (still.row(a) - still.row(b)).norm());
      }
    EXPECT_LT(longest, 0.12f) << bend;                                     // an edge is up to 0.15 m long
    EXPECT_GT((posed - still).rowwise().norm().maxCoeff(), 0.1f) << bend;  // it did bend
  }
}

}  // namespace
}  // namespace understudy::tests
