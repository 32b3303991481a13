#include "retarget/formats/mesh_reader.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

using namespace test;

TEST(GltfMesh, AppliesNodeTransforms) {
  const Mesh mesh = parse_mesh(
      glb_bytes(R"(,"translation":[1,2,3],"scale":[2,2,2],"rotation":[0,0,0.70710678,0.70710678])"), "a.glb");
  EXPECT_TRUE(mesh.vertices.row(1).isApprox(Eigen::RowVector3f(1, 5, 3), 1e-5f)) << mesh.vertices;
}

TEST(GltfMesh, ReadsAnOutsideBufferBesideTheFile) {
  const TempFolder folder;
  folder.write("my data.bin", gltf_buffer());
  const std::string path = folder.write("a.gltf", gltf_json("", R"(,"uri":"my%20data.bin")"));
  EXPECT_EQ(read_mesh(path).vertices, four_points());
  std::filesystem::remove(folder.path("my data.bin"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh(path); }), "no such file"));
}

TEST(GltfMesh, SkinnedMeshComesInItsBindPoseWhereTheSkeletonCarriesIt) {
  // The root joint: bound at (0,0,1) of a z-up mesh in centimetres, carried by a node that turns and scales.
  const std::string matrix = bytes_of(1.0f) + std::string(16, '\0') + bytes_of(1.0f) + std::string(16, '\0') +
                             bytes_of(1.0f) + std::string(12, '\0') + bytes_of(-1.0f) + bytes_of(1.0f);
  const std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0,"translation":[9,9,9]},)"
      R"({"children":[2],"scale":[0.01,0.01,0.01],"rotation":[-0.70710678,0,0,0.70710678]},{"translation":[0,0,1]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"skins":[{"joints":[2],"inverseBindMatrices":2}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},{"bufferView":2,"componentType":5126,"count":1,"type":"MAT4"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24},)"
      R"({"buffer":0,"byteOffset":72,"byteLength":64}],"buffers":[{"byteLength":136,"uri":"data:;base64,)" +
      base64(gltf_buffer() + matrix) + "\"}]}";
  const Mesh mesh = parse_mesh(json, "a.gltf");
  ASSERT_EQ(mesh.vertices.rows(), 4);
  EXPECT_TRUE(mesh.vertices.row(2).isApprox(Eigen::RowVector3f(0, 0, -0.0225f), 1e-4f)) << mesh.vertices;
}

TEST(GltfMesh, MirroredNodesKeepFacesOutward) {
  const Mesh mesh = parse_mesh(gltf_text(R"(,"scale":[-1,1,1])"), "a.gltf");
  EXPECT_EQ(mesh.faces.row(0), Eigen::RowVector3i(0, 1, 2));
}

TEST(GltfMesh, RefusesWhatReachesBehindItsBuffer) {
  std::string json = gltf_text();
  json.replace(json.find("\"byteOffset\":48"), 15, "\"byteOffset\":60");
  EXPECT_TRUE(contains(error_of([&] { parse_mesh(json, "a.gltf"); }),
                       "a.gltf: buffer view 1 reaches beyond its buffer"));
  json = gltf_text();
  json.replace(json.find("\"byteLength\":24"), 15, "\"byteLength\":20");
  EXPECT_TRUE(contains(error_of([&] { parse_mesh(json, "a.gltf"); }), "reaches beyond its buffer view"));
  EXPECT_TRUE(contains(error_of([&] {
                         parse_mesh(gltf_json("", R"(,"uri":"data:;base64,AA==")",
                                              R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"),
                                    "a.gltf");
                       }),
                       "KHR_draco_mesh_compression"));
}

TEST(GltfMesh, SurvivesNodesThatGoRoundInCircles) {
  EXPECT_EQ(parse_mesh(gltf_text(R"(,"children":[0])"), "a.gltf").vertices.rows(), 4);
}

}  // namespace
}  // namespace understudy
