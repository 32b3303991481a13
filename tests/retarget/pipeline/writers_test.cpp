#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <filesystem>

#include "retarget/formats/glb_writer.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/result_writer.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;
namespace fs = std::filesystem;

struct Folder {
  fs::path path;
  explicit Folder(const std::string& name) : path(fs::temp_directory_path() / ("understudy_" + name)) {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

Mesh triangles() {
  Mesh mesh = PointBody(human_rest()).mesh;
  mesh.faces.resize(mesh.vertices.rows() / 3, 3);
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) mesh.faces(f, k) = static_cast<int>(3 * f + k);
  return mesh;
}

tinygltf::Model write_and_read(const std::string& path, const Mesh& mesh, int frames) {
  GlbWriter writer(path, {mesh, human_rest(), PointBody(human_rest()).weights, "person"});
  for (int i = 0; i < frames; ++i) writer.push(dance(static_cast<float>(i) / 10), static_cast<float>(i) / 10);
  writer.finish();
  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(loader.LoadBinaryFromFile(&model, &error, &warning, path)) << error;
  EXPECT_TRUE(error.empty() && warning.empty()) << error << warning;
  return model;
}

std::vector<float> floats(const tinygltf::Model& model, int accessor) {
  const auto& a = model.accessors[static_cast<size_t>(accessor)];
  const auto& view = model.bufferViews[static_cast<size_t>(a.bufferView)];
  const auto& bytes = model.buffers[static_cast<size_t>(view.buffer)].data;
  std::vector<float> values(
      a.count * static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a.type))));
  std::memcpy(values.data(), bytes.data() + view.byteOffset + a.byteOffset, values.size() * sizeof(float));
  return values;
}

TEST(GlbWriter, PlaysTheSameMotionWhenReadBack) {
  const Folder folder("glb_plays");
  const auto model = write_and_read(folder.file("a.glb"), triangles(), 12);
  ASSERT_EQ(model.animations.size(), 1u);
  const auto& animation = model.animations[0];
  ASSERT_EQ(animation.channels.size(), 1u + kJointCount);
  const size_t frame = 7;
  Joints offsets;  // each joint from its parent, as the nodes say
  for (int j = 0; j < kJointCount; ++j)
    for (int k = 0; k < 3; ++k)
      offsets(j, k) =
          static_cast<float>(model.nodes[static_cast<size_t>(j)].translation[static_cast<size_t>(k)]);
  Rotations local;
  Vec3 root = Vec3::Zero();
  for (const auto& channel : animation.channels) {
    const auto values = floats(model, animation.samplers[static_cast<size_t>(channel.sampler)].output);
    if (channel.target_path == "translation") {
      root = Eigen::Map<const Vec3>(&values[3 * frame]);
    } else {
      local[static_cast<size_t>(channel.target_node)] =
          Eigen::Quaternionf(Eigen::Map<const Eigen::Vector4f>(&values[4 * frame])).toRotationMatrix();
    }
  }
  Joints rest = offsets;
  for (int j = 1; j < kJointCount; ++j) rest.row(j) += rest.row(kParents[j]);
  const Joints got = forward_kinematics(rest, Pose{local, root}).joints;
  EXPECT_LT((got - forward_kinematics(human_rest(), dance(0.7f)).joints).cwiseAbs().maxCoeff(), 1e-4f);
}

TEST(GlbWriter, NamesTheJointsAndKeepsTheParents) {
  const Folder folder("glb_names");
  const auto model = write_and_read(folder.file("a.glb"), triangles(), 2);
  ASSERT_EQ(model.skins[0].joints.size(), static_cast<size_t>(kJointCount));
  for (int j = 0; j < kJointCount; ++j) {
    const auto& node = model.nodes[static_cast<size_t>(j)];
    EXPECT_EQ(node.name, kJointNames[j]);
    for (const int child : node.children) EXPECT_EQ(kParents[child], j);
  }
}

TEST(GlbWriter, WeighsEveryVertexToOne) {
  const Folder folder("glb_weights");
  Mesh mesh = triangles();
  RowMatrix weights = RowMatrix::Random(mesh.vertices.rows(), kJointCount).cwiseAbs();
  GlbWriter writer(folder.file("a.glb"), {mesh, human_rest(), weights, "person"});
  writer.push(Pose{}, 0);
  writer.finish();
  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(loader.LoadBinaryFromFile(&model, &error, &warning, folder.file("a.glb")));
  const auto w = floats(model, model.meshes[0].primitives[0].attributes.at("WEIGHTS_0"));
  for (size_t v = 0; v < w.size(); v += 4) EXPECT_NEAR(w[v] + w[v + 1] + w[v + 2] + w[v + 3], 1, 1e-5f);
}

TEST(GlbWriter, TurnsQuaternionsTheShortWay) {
  const Folder folder("glb_short");
  GlbWriter writer(folder.file("a.glb"),
                   {triangles(), human_rest(), PointBody(human_rest()).weights, "person"});
  for (int i = 0; i < 60; ++i)
    writer.push(Pose{[&] {
                       Rotations R = identity_rotations();
                       R[Pelvis] = rotation_about_y(0.2f * static_cast<float>(i));
                       return R;
                     }(),
                     Vec3::Zero()},
                static_cast<float>(i));
  writer.finish();
  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(loader.LoadBinaryFromFile(&model, &error, &warning, folder.file("a.glb")));
  const auto q = floats(model, model.animations[0].samplers[1].output);
  for (size_t i = 4; i < q.size(); i += 4) {
    float dot = 0;
    for (size_t k = 0; k < 4; ++k) dot += q[i + k] * q[i - 4 + k];
    EXPECT_GT(dot, 0);
  }
}

TEST(GlbWriter, WritesACloudAsPoints) {
  const Folder folder("glb_points");
  const auto model = write_and_read(folder.file("a.glb"), PointBody(human_rest()).mesh, 3);
  EXPECT_EQ(model.meshes[0].primitives[0].mode, TINYGLTF_MODE_POINTS);
  EXPECT_EQ(model.meshes[0].primitives[0].indices, -1);
}

TEST(GlbWriter, LeavesNothingHalfWritten) {
  const Folder folder("glb_part");
  write_and_read(folder.file("a.glb"), triangles(), 2);
  EXPECT_FALSE(fs::exists(folder.file("a.glb.part")));
  GlbWriter writer(folder.file("none/b.glb"),
                   {triangles(), human_rest(), PointBody(human_rest()).weights, "person"});
  EXPECT_THROW(writer.finish(), Error);
}

TEST(GlbWriter, RefusesTimeThatDoesNotIncrease) {
  GlbWriter writer("unused.glb", {triangles(), human_rest(), PointBody(human_rest()).weights, "person"});
  writer.push(Pose{}, 1);
  EXPECT_THROW(writer.push(Pose{}, 1), Error);
}

TEST(ResultWriter, WritesWhatWasPushed) {
  const Folder folder("result");
  const Points vertices = PointBody(human_rest()).mesh.vertices;
  {
    ResultWriter writer(folder.file("r.npz"), vertices.rows());
    for (int i = 0; i < 5; ++i) {
      const Pose pose = dance(static_cast<float>(i));
      writer.push(vertices * static_cast<float>(i), forward_kinematics(human_rest(), pose).joints, pose.local,
                  human_rest());
    }
    writer.finish();
  }
  const Npz npz = read_npz(folder.file("r.npz"));
  const NpyArray& v = require(npz, "vertices", "r.npz");
  EXPECT_EQ(v.shape, (std::vector<int64_t>{5, vertices.rows(), 3}));
  EXPECT_FLOAT_EQ(v.values.back(), 4 * vertices(vertices.rows() - 1, 2));
  const NpyArray& R = require(npz, "rotations", "r.npz");
  EXPECT_EQ(R.shape, (std::vector<int64_t>{5, 22, 3, 3}));
  EXPECT_FLOAT_EQ(R.values[22 * 9 + 1], dance(1).local[0](0, 1));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), 1);
}

TEST(ResultWriter, LeavesNothingBehindWhenNotFinished) {
  const Folder folder("result_cut");
  { ResultWriter writer(folder.file("r.npz"), 10); }
  EXPECT_TRUE(fs::is_empty(folder.path));
}

TEST(ResultWriter, RefusesAFrameOfAnotherSize) {
  const Folder folder("result_size");
  ResultWriter writer(folder.file("r.npz"), 10);
  EXPECT_THROW(writer.push(Points::Zero(9, 3), human_rest(), identity_rotations(), human_rest()), Error);
}

}  // namespace
}  // namespace understudy
