// Targets of `understudy retarget` that stand in no T-pose, with bones and without.
#include <cmath>
#include <fstream>

#include "retarget/body/builtin_person.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/character/characters.hpp"

namespace understudy::tests {
namespace {

float angle_deg(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kPi;
}

/// The source glides in T-pose: whoever performs it stands in T-pose, too.
class TargetCommand : public ShippedProgram {
 protected:
  std::vector<Joints> joints_of(const std::string& path, int64_t vertices) {
    const Npz npz = read_npz(path);
    EXPECT_EQ(npz.at("vertices").shape, (std::vector<int64_t>{kFrames, vertices, 3}));
    std::vector<Joints> all;
    for (int t = 0; t < kFrames; ++t)
      all.push_back(Eigen::Map<const Joints>(npz.at("joints").values.data() + t * kJointCount * 3));
    return all;
  }
  /// Arms stretched out, legs apart and straight, but for the millimetres by which soles are put on the
  /// floor.
  void expect_t_pose(const Joints& joints) {
    const auto bone = [&](int from, int to) { return Vec3((joints.row(to) - joints.row(from)).transpose()); };
    for (const int right : {0, 1}) {
      const Vec3 out(right == 1 ? -1.0f : 1.0f, 0, 0);
      EXPECT_LT(angle_deg(bone(LeftShoulder + right, LeftElbow + right), out), 20) << right;
      EXPECT_LT(angle_deg(bone(LeftElbow + right, LeftWrist + right), out), 20) << right;
      EXPECT_LT(angle_deg(bone(LeftHip + right, LeftKnee + right), -Vec3::UnitY()), 12) << right;
      EXPECT_LT(angle_deg(bone(LeftHip + right, LeftKnee + right), bone(LeftKnee + right, LeftAnkle + right)),
                15)
          << right;
    }
    EXPECT_GT(joints(LeftAnkle, 0), joints(RightAnkle, 0));  // shins do not cross
  }
  Finished perform(const std::string& character, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"retarget", "--source", scans(), "--target", character};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(TargetCommand, ARiggedCharacterInAPoseStandsInTheSourcesPoseOnEitherRig) {
  MadeCharacter made;
  made.arms_down_deg = 50;
  made.legs_apart_deg = 12;
  made.heading_deg = 90;
  const Character character = make_character(made);
  write_gltf_character(scratch.path("made.glb"), character);
  for (const std::string rig : {"own", "22", "ours"}) {
    const Finished done = perform(scratch.path("made.glb"), {"--out", out(rig + ".npz"), "--rig", rig});
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.err.find("22 of 22 joints"), std::string::npos) << done.err;
    for (const Joints& joints : joints_of(out(rig + ".npz"), character.vertex_count())) expect_t_pose(joints);
  }
}

TEST_F(TargetCommand, ABareBodyInAPoseStandsInTheSourcesPoseWithItsFilesVertices) {
  const ShapedBody body = builtin_person();
  Pose pose;
  pose.root = body.joints.row(Pelvis).transpose();
  pose.local[LeftShoulder] = rotation_from_axis_angle(Vec3(0, 0, -0.8f));
  pose.local[RightShoulder] = rotation_from_axis_angle(Vec3(0, 0, 0.8f));
  pose.local[LeftHip] = rotation_from_axis_angle(Vec3(0, 0, 0.12f));
  pose.local[RightHip] = rotation_from_axis_angle(Vec3(0, 0, -0.12f));
  const Points a_pose = posed_vertices(body, pose);
  std::ofstream file(scratch.path("a.obj"));
  file << "vt 0 0\nvt 1 0\nvt 1 1\nv 0 1 0\n";  // a vertex of no face, and texture coordinates
  for (Eigen::Index v = 0; v < a_pose.rows(); ++v) file << "v " << a_pose.row(v) << '\n';
  for (Eigen::Index f = 0; f < body.faces.rows(); ++f)
    file << "f " << body.faces(f, 0) + 2 << "/1 " << body.faces(f, 1) + 2 << "/2 " << body.faces(f, 2) + 2
         << "/3\n";
  file.close();
  const Finished done = perform(scratch.path("a.obj"), {"--out", out("a.npz")});
  ASSERT_EQ(done.code, 0) << done.err;
  for (const Joints& joints : joints_of(out("a.npz"), a_pose.rows() + 1)) expect_t_pose(joints);
}

TEST_F(TargetCommand, SaysWhatIsWrong) {
  expect_clean_failure(perform(target(), {"--out", out("a.npz"), "--rig", "theirs"}), "has no skeleton");
  expect_clean_failure(perform(scratch.path("gone.fbx"), {"--out", out("a.npz")}), "gone.fbx");
}

}  // namespace
}  // namespace understudy::tests
