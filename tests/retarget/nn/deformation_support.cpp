#include "tests/retarget/nn/deformation_support.hpp"

#include <filesystem>
#include <fstream>

#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy::testing {

Joints adult_joints() {
  Joints joints;
  joints << 0, 0, 0, 0.1f, -0.015f, 0, -0.1f, -0.015f, 0, 0, 0.07f, -0.03f, 0.136f, -0.4f, 0, -0.136f, -0.4f,
      0, 0, 0.137f, -0.02f, 0.15f, -0.81f, -0.01f, -0.15f, -0.81f, -0.01f, 0, 0.21f, -0.02f, 0.17f, -0.87f,
      0.1f, -0.17f, -0.87f, 0.1f, 0, 0.52f, 0, 0.02f, 0.45f, 0.01f, -0.02f, 0.45f, 0.01f, 0, 0.62f, 0.03f,
      0.17f, 0.46f, 0.01f, -0.17f, 0.46f, 0.01f, 0.41f, 0.46f, 0.01f, -0.41f, 0.46f, 0.01f, 0.64f, 0.46f,
      0.01f, -0.64f, 0.46f, 0.01f;
  return joints;
}

Body octahedron_body() {
  constexpr float kRadius = 0.08f;
  constexpr int kVertices = 6 * kJointCount;
  const Joints joints = adult_joints();
  Body body;
  body.template_vertices.resize(kVertices, 3);
  body.faces.resize(8 * kJointCount, 3);
  body.joint_regressor = RowMatrix::Zero(kJointCount, kVertices);
  body.weights = RowMatrix::Zero(kVertices, kJointCount);
  auto dirs = std::make_shared<RowMatrix>(RowMatrix::Zero(3 * kVertices, 9 * (kJointCount - 1)));
  for (int j = 0; j < kJointCount; ++j) {
    for (int k = 0; k < 6; ++k) {
      const int v = 6 * j + k;
      Vec3 direction = Vec3::Zero();
      direction[k / 2] = k % 2 ? -1.f : 1.f;
      body.template_vertices.row(v) = joints.row(j) + kRadius * direction.transpose();
      body.joint_regressor(j, v) = 1.f / 6;
      body.weights(v, j) = 0.7f;
      body.weights(v, j > 0 ? kParents[j] : 0) += 0.3f;
      if (j > 0) dirs->block<3, 9>(3 * v, 9 * (j - 1)).setConstant(k % 2 ? -0.01f : 0.01f);
    }
    int face = 8 * j;
    for (int x : {0, 1})
      for (int y : {2, 3})
        for (int z : {4, 5}) body.faces.row(face++) << 6 * j + x, 6 * j + y, 6 * j + z;
  }
  body.pose_dirs = dirs;
  body.shape_dirs = 0.1f * Eigen::Map<const RowMatrix>(body.template_vertices.data(), 3 * kVertices, 1);
  return body;
}

Pose random_test_pose(uint64_t seed) {
  Rng rng(seed);
  Pose pose;
  for (auto& R : pose.local)
    R = rotation_from_axis_angle(0.4f * Vec3(rng.normal(), rng.normal(), rng.normal()));
  pose.root = Vec3(rng.normal(), rng.normal(), rng.normal());
  return pose;
}

namespace {

Motion test_motion() {
  Motion motion;
  for (uint64_t t = 0; t < 40; ++t) motion.poses.push_back(random_test_pose(t));
  return motion;
}

NpyArray array(std::vector<int64_t> shape, const float* values) {
  NpyArray a;
  a.shape = std::move(shape);
  int64_t count = 1;
  for (int64_t extent : a.shape) count *= extent;
  a.values.assign(values, values + count);
  return a;
}

}  // namespace

training::TrainingData octahedron_data() {
  training::TrainingData data;
  data.body = octahedron_body();
  for (float size : {-1.f, 0.f, 1.f}) data.betas.push_back(Eigen::VectorXf::Constant(1, size));
  Clip clip{test_motion(), {}};
  for (int t = 0; t < static_cast<int>(clip.motion.poses.size()); ++t) clip.good.push_back(t);
  data.good_frames = static_cast<int64_t>(clip.good.size());
  data.clips.push_back(std::move(clip));
  return data;
}

void write_octahedron_data(const std::string& folder) {
  std::filesystem::create_directories(folder + "/body");
  std::filesystem::create_directories(folder + "/motion/one");
  const Body body = octahedron_body();
  const int64_t V = body.template_vertices.rows(), F = body.faces.rows();
  const RowMatrix faces = body.faces.cast<float>();
  RowMatrix tree(2, kJointCount);
  for (int j = 0; j < kJointCount; ++j) tree.col(j) << static_cast<float>(kParents[j]), static_cast<float>(j);
  write_npz(folder + "/body/makehuman_smplformat.npz",
            {{"v_template", array({V, 3}, body.template_vertices.data())},
             {"shapedirs", array({V, 3, 1}, body.shape_dirs.data())},
             {"posedirs", array({V, 3, 189}, body.pose_dirs->data())},
             {"J_regressor", array({kJointCount, V}, body.joint_regressor.data())},
             {"weights", array({V, kJointCount}, body.weights.data())},
             {"f", array({F, 3}, faces.data())},
             {"kintree_table", array({2, kJointCount}, tree.data())}});
  const std::vector<float> betas = {-1, 0, 1};
  write_npz(folder + "/body/betas.npz", {{"betas", array({3, 1}, betas.data())}});
  RowMatrix poses(40, 66), trans = RowMatrix::Zero(40, 3);
  const Motion motion = test_motion();
  for (int t = 0; t < 40; ++t)
    for (int j = 0; j < kJointCount; ++j)
      poses.block<1, 3>(t, 3 * j) = rotation_to_axis_angle(motion.poses[t].local[j]).transpose();
  const float fps = 30;
  write_npz(folder + "/motion/one/a_poses.npz", {{"poses", array({40, 66}, poses.data())},
                                                 {"trans", array({40, 3}, trans.data())},
                                                 {"mocap_framerate", array({1}, &fps)}});
  const std::string split =
      R"({"betas": {"file": "body/betas.npz", "rows": [0, 3]}, "clothed": [], "motion_subjects": ["motion/one"]})";
  std::ofstream(folder + "/splits.json") << "{\"train\": " << split << ", \"dev\": " << split << "}";
}

}  // namespace understudy::testing
