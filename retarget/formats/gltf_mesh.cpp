#include "retarget/formats/gltf_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "retarget/formats/bytes.hpp"
#include "retarget/formats/gltf_file.hpp"

namespace understudy {
namespace {

using Json = nlohmann::json;
using Mat4 = Eigen::Matrix4f;

// The nearest turn by quarters: the rest pose of the root joint may lean and look aside, but a bind pose is
// modelled along the axes.
Mat3 snapped(const Mat3& R) {
  Mat3 out = Mat3::Zero();
  for (int c = 0; c < 3; ++c) {
    Eigen::Index row = 0;
    R.col(c).cwiseAbs().maxCoeff(&row);
    out(row, c) = R(row, c) > 0 ? 1.0f : -1.0f;
  }
  const bool is_rotation =
      std::abs(out.determinant() - 1.0f) < 1e-3f && (out * out.transpose()).isIdentity(1e-3f);
  return is_rotation ? out : R;
}

// Where the bind pose of a skin stands in the world: as its root joint carries it there.
Mat4 bind_transform(GltfFile& file, const Json& skin, const GltfSceneNodes& nodes) {
  const auto joints = skin.find("joints");
  US_CHECK(joints != skin.end() && joints->is_array() && !joints->empty(), file.path(),
           ": a skin has no joints");
  std::vector<size_t> ranks(nodes.world.size(), nodes.order.size());
  for (size_t i = 0; i < nodes.order.size(); ++i) ranks[static_cast<size_t>(nodes.order[i])] = i;
  size_t best = joints->size(), best_rank = nodes.order.size();
  for (size_t j = 0; j < joints->size(); ++j) {
    US_CHECK((*joints)[j].is_number_unsigned(), file.path(), ": a joint of a skin is no number");
    const int64_t node = whole((*joints)[j].get<double>());
    if (node < 0 || node >= static_cast<int64_t>(ranks.size())) continue;
    if (ranks[static_cast<size_t>(node)] >= best_rank) continue;
    best = j;
    best_rank = ranks[static_cast<size_t>(node)];
  }
  if (best == joints->size()) return Mat4::Identity();  // a skeleton outside of the scene
  Mat4 inverse_bind = Mat4::Identity();
  if (skin.contains("inverseBindMatrices")) {
    const GltfAccessor matrices = file.accessor(file.integer(skin, "inverseBindMatrices", -1));
    US_CHECK(matrices.parts == 16 && static_cast<size_t>(matrices.count) >= joints->size(), file.path(),
             ": a skin has fewer bind matrices than joints");
    inverse_bind = Eigen::Map<const Mat4>(matrices.values.data() + 16 * best);
  }
  Mat4 world = nodes.world[static_cast<size_t>(nodes.order[best_rank])] * inverse_bind;
  const Mat3 M = world.topLeftCorner<3, 3>();
  const float scale = std::cbrt(std::abs(M.determinant()));
  if (!(scale > 1e-12f) || !inverse_bind.allFinite() || std::abs(inverse_bind.determinant()) < 1e-20f)
    return world;
  const Vec3 joint = inverse_bind.inverse().topRightCorner<3, 1>();  // in the bind pose
  const Vec3 there = M * joint + world.topRightCorner<3, 1>();
  const Mat3 upright = snapped(M / scale) * scale;
  world.topLeftCorner<3, 3>() = upright;
  world.topRightCorner<3, 1>() = there - upright * joint;
  return world;
}

class MeshCollector {
 public:
  explicit MeshCollector(GltfFile& file) : file_(file) {}

  void add_mesh(const Json& mesh, const Mat4& transform) {
    first_vertex_.clear();
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) return;
    for (const auto& primitive : *primitives) {
      US_CHECK(primitive.is_object(), file_.path(), ": a primitive is no object");
      add_primitive(primitive, transform);
    }
  }

  Mesh finish() const {
    Mesh mesh;
    mesh.vertices = rows_of_three(positions_);
    if (colours_.size() == positions_.size()) mesh.colors = rows_of_three(colours_);
    mesh.faces = faces_.finish(mesh.vertices.rows(), file_.path());
    return mesh;
  }

 private:
  void add_primitive(const Json& primitive, const Mat4& transform) {
    US_CHECK(++primitives_ <= 1000000, file_.path(), ": has more than a million primitives");
    const int64_t mode = file_.integer(primitive, "mode", 4);
    const auto attributes = primitive.find("attributes");
    if ((mode != 0 && mode < 4) || mode > 6 || attributes == primitive.end() || !attributes->is_object() ||
        !attributes->contains("POSITION"))
      return;  // lines, or nothing to see
    const auto extensions = primitive.find("extensions");
    US_CHECK(extensions == primitive.end() || !extensions->contains("KHR_draco_mesh_compression") ||
                 file_.item("accessors", file_.integer(*attributes, "POSITION", -1)).contains("bufferView"),
             file_.path(), ": is compressed with Draco, which is not read; export it without");
    int64_t count = 0;
    const int64_t base = add_vertices(*attributes, transform, count);
    if (mode == 0) return;
    std::vector<int64_t> corners;
    if (primitive.contains("indices")) {
      const GltfAccessor indices = file_.accessor(file_.integer(primitive, "indices", -1));
      US_CHECK(indices.parts == 1, file_.path(), ": the indices of a primitive are no single numbers");
      for (const float index : indices.values) {
        US_CHECK(index >= 0 && index < static_cast<float>(count), file_.path(), ": a face names vertex ",
                 index, " of a primitive of ", count);
        corners.push_back(base + static_cast<int64_t>(index));
      }
    } else {
      for (int64_t i = 0; i < count; ++i) corners.push_back(base + i);
    }
    add_faces(mode, transform.topLeftCorner<3, 3>().determinant() < 0, corners);
  }

  // Primitives that share their positions share their vertices.
  int64_t add_vertices(const Json& attributes, const Mat4& transform, int64_t& count) {
    const int64_t index = file_.integer(attributes, "POSITION", -1);
    const GltfAccessor positions = file_.accessor(index);
    US_CHECK(positions.parts == 3, file_.path(), ": the positions of a primitive are not of three numbers");
    count = positions.count;
    const auto base = static_cast<int64_t>(positions_.size() / 3);
    const auto [known, is_new] = first_vertex_.try_emplace(index, base);
    if (!is_new) return known->second;
    US_CHECK(base + count <= 16000000, file_.path(), ": has more than 16 million vertices");
    const Mat3 M = transform.topLeftCorner<3, 3>();
    const Vec3 t = transform.topRightCorner<3, 1>();
    for (int64_t i = 0; i < count; ++i) {
      const Vec3 p = M * Eigen::Map<const Vec3>(positions.values.data() + 3 * i) + t;
      positions_.insert(positions_.end(), {p.x(), p.y(), p.z()});
    }
    add_colours(attributes, count);
    return base;
  }

  void add_colours(const Json& attributes, int64_t count) {
    if (!attributes.contains("COLOR_0")) return;
    const GltfAccessor colours = file_.accessor(file_.integer(attributes, "COLOR_0", -1));
    if (colours.parts < 3 || colours.parts > 4 || colours.count != count) return;
    for (int64_t i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c)
        colours_.push_back(colours.values[static_cast<size_t>(i * colours.parts + c)]);
  }

  void add_faces(int64_t mode, bool mirrored, const std::vector<int64_t>& c) {
    const size_t step = mode == 4 ? 3 : 1;
    for (size_t i = 0; i + 2 < c.size(); i += step) {
      const bool turn = (mode == 5 && i % 2 == 1) != mirrored;
      const int64_t a = mode == 6 ? c[0] : c[i];
      faces_.add(a, c[i + (turn ? 2 : 1)], c[i + (turn ? 1 : 2)]);
    }
  }

  GltfFile& file_;
  int64_t primitives_ = 0;
  std::map<int64_t, int64_t> first_vertex_;  // of each accessor of positions in this mesh
  std::vector<float> positions_, colours_;
  FaceList faces_;
};

}  // namespace

Mesh parse_gltf(std::string_view bytes, const std::string& path) {
  GltfFile file(bytes, path);
  const GltfSceneNodes nodes = walk_gltf_scene(file);
  MeshCollector collector(file);
  std::map<int64_t, Mat4> bound;  // of each skin: many meshes may share one
  for (const int64_t index : nodes.order) {
    const Json& node = file.item("nodes", index);
    if (!node.contains("mesh")) continue;
    const Json& mesh = file.item("meshes", file.integer(node, "mesh", -1));
    Mat4 transform = nodes.world[static_cast<size_t>(index)];
    if (node.contains("skin")) {
      const int64_t skin = file.integer(node, "skin", -1);
      const auto [known, is_new] = bound.try_emplace(skin);
      if (is_new) known->second = bind_transform(file, file.item("skins", skin), nodes);
      transform = known->second;
    }
    collector.add_mesh(mesh, transform);
  }
  const Mesh mesh = collector.finish();
  US_CHECK(mesh.vertices.rows() > 0, path, ": holds no mesh");
  return mesh;
}

}  // namespace understudy
