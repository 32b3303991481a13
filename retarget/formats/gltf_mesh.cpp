// The surface in a glTF or GLB file: what a target or a single scan needs of it.
#include <map>
#include <vector>

#include "retarget/formats/bytes.hpp"
#include "retarget/formats/gltf_file.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Mat4 = Eigen::Matrix4f;

// From the bind pose of a skin to the world: as its root joint carries it there.
Mat4 bind_transform(GltfFile& file, const tinygltf::Skin& skin, const GltfSceneNodes& nodes) {
  const std::vector<float> matrices = file.inverse_bind(skin);
  std::vector<size_t> ranks(nodes.world.size(), nodes.order.size());
  for (size_t i = 0; i < nodes.order.size(); ++i) ranks[nodes.order[i]] = i;
  size_t best = 0, best_rank = nodes.order.size();
  for (size_t j = 0; j < skin.joints.size(); ++j) {
    const size_t node = skin.joints[j];
    if (node >= ranks.size() || ranks[node] >= best_rank) continue;
    best = j;
    best_rank = ranks[node];
  }
  if (best_rank == nodes.order.size()) return Mat4::Identity();  // a skeleton outside of the scene
  Mat4 inverse_bind = Mat4::Identity();
  if (!matrices.empty()) inverse_bind = Eigen::Map<const Mat4>(matrices.data() + 16 * best);
  Mat4 world = nodes.world[nodes.order[best_rank]] * inverse_bind;
  const Mat3 M = world.topLeftCorner<3, 3>();
  const float scale = std::cbrt(std::abs(M.determinant()));
  if (!(scale > 1e-12f) || !inverse_bind.allFinite() || std::abs(inverse_bind.determinant()) < 1e-20f)
    return world;
  const Vec3 joint = inverse_bind.inverse().topRightCorner<3, 1>();  // in the bind pose
  const Vec3 there = M * joint + world.topRightCorner<3, 1>();
  const Mat3 upright = nearest_quarter_turn(M / scale) * scale;
  world.topLeftCorner<3, 3>() = upright;
  world.topRightCorner<3, 1>() = there - upright * joint;
  return world;
}

class MeshCollector {
 public:
  explicit MeshCollector(GltfFile& file) : file_(file) {}

  void add_mesh(const tinygltf::Mesh& mesh, const Mat4& transform) {
    // of each accessor of positions: primitives that share it share vertices
    std::map<int, int64_t> first_vertex;
    for (const auto& primitive : mesh.primitives) {
      US_CHECK(++primitives_ <= 1000000, file_.path(), ": has more than a million primitives");
      if (!file_.is_shown(primitive)) continue;
      const int index = primitive.attributes.at("POSITION");
      const GltfAccessor positions = file_.accessor(index);
      US_CHECK(positions.parts == 3, file_.path(), ": the positions of a primitive are not of three numbers");
      const auto [known, is_new] =
          first_vertex.try_emplace(index, static_cast<int64_t>(positions_.size() / 3));
      if (is_new) add_vertices(primitive, positions, transform);
      const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0;
      const Faces faces = file_.faces(primitive, positions.count);
      for (const auto& face : faces.rowwise())
        faces_.add(known->second + face[0], known->second + face[mirrored ? 2 : 1],
                   known->second + face[mirrored ? 1 : 2]);
    }
  }

  Mesh finish() const { return mesh_of(positions_, colours_, faces_, file_.path()); }

 private:
  void add_vertices(const tinygltf::Primitive& primitive, const GltfAccessor& positions,
                    const Mat4& transform) {
    US_CHECK(static_cast<int64_t>(positions_.size() / 3) + positions.count <= 16000000, file_.path(),
             ": has more than 16 million vertices");
    const Mat3 M = transform.topLeftCorner<3, 3>();
    const Vec3 t = transform.topRightCorner<3, 1>();
    for (int64_t i = 0; i < positions.count; ++i) {
      const Vec3 p = M * Eigen::Map<const Vec3>(positions.values.data() + 3 * i) + t;
      positions_.insert(positions_.end(), {p.x(), p.y(), p.z()});
    }
    const auto colour = primitive.attributes.find("COLOR_0");
    if (colour == primitive.attributes.end()) return;
    const GltfAccessor colours = file_.accessor(colour->second);
    if (colours.parts < 3 || colours.parts > 4 || colours.count != positions.count) return;
    for (int64_t i = 0; i < colours.count; ++i)
      for (int c = 0; c < 3; ++c) colours_.push_back(colours.values[i * colours.parts + c]);
  }

  GltfFile& file_;
  int64_t primitives_ = 0;
  std::vector<float> positions_, colours_;
  FaceList faces_;
};

}  // namespace

/// All triangles and points of the default scene in one mesh, with the transforms of their nodes; skinned
/// meshes in their bind pose, placed by the root of their skeleton. Metres and y up are the format's own;
/// colours from COLOR_0 when every primitive has them. Every accessor is checked against its buffer before it
/// is read. `path` is where outside buffers are looked for, and names the file in errors. Throws Error,
/// also for Draco and meshopt compression.
Mesh parse_gltf(std::string_view bytes, const std::string& path) {
  GltfFile file(bytes, path, GltfFile::Use::Surface);
  const tinygltf::Model& model = file.model();
  const GltfSceneNodes nodes = walk_gltf_scene(file);
  MeshCollector collector(file);
  std::map<int, Mat4> bound;  // of each skin: many meshes may share one
  for (const int index : nodes.order) {
    const tinygltf::Node& node = model.nodes[index];
    if (node.mesh < 0) continue;
    Mat4 transform = nodes.world[index];
    if (node.skin >= 0) {
      const auto [known, is_new] = bound.try_emplace(node.skin);
      if (is_new) known->second = bind_transform(file, file.item(model.skins, node.skin, "skins"), nodes);
      transform = known->second;
    }
    collector.add_mesh(file.item(model.meshes, node.mesh, "meshes"), transform);
  }
  Mesh mesh = collector.finish();
  US_CHECK(mesh.vertices.rows() > 0, path, ": holds no mesh");
  return mesh;
}

}  // namespace understudy
