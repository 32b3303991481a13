#include "retarget/formats/glb_writer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "retarget/base/error.hpp"

namespace understudy {

namespace {

using nlohmann::json;

enum ComponentType { UnsignedByte = 5121, UnsignedInt = 5125, Float = 5126 };
enum Target { None = 0, ArrayBuffer = 34962, ElementArrayBuffer = 34963 };

/// The binary chunk and the accessors into it.
class Buffer {
 public:
  /// Adds an array of `count` elements and returns its accessor's number.
  template <class T>
  int add(const std::vector<T>& values, const char* type, ComponentType component, Target target) {
    const size_t width = components(type), start = bytes_.size();
    US_CHECK(values.size() % width == 0, "glTF: ", values.size(), " values do not make ", type);
    const size_t size = values.size() * sizeof(T);
    bytes_.resize((start + size + 3) / 4 * 4, 0);
    if (size > 0) std::memcpy(bytes_.data() + start, values.data(), size);
    json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", size}};
    if (target != None) view["target"] = static_cast<int>(target);
    views_.push_back(view);
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", static_cast<int>(component)},
                          {"count", values.size() / width},
                          {"type", type}});
    return static_cast<int>(accessors_.size()) - 1;
  }
  /// Adds floats with the bounds that positions and times must have.
  int add_bounded(const std::vector<float>& values, const char* type, Target target) {
    const int accessor = add(values, type, Float, target);
    const size_t width = components(type);
    std::vector<float> low(values.begin(), values.begin() + static_cast<long>(width)), high = low;
    for (size_t i = 0; i < values.size(); ++i) {
      low[i % width] = std::min(low[i % width], values[i]);
      high[i % width] = std::max(high[i % width], values[i]);
    }
    accessors_[accessor]["min"] = low;
    accessors_[accessor]["max"] = high;
    return accessor;
  }
  const std::vector<char>& bytes() const { return bytes_; }
  const json& views() const { return views_; }
  const json& accessors() const { return accessors_; }

 private:
  static size_t components(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
  }
  std::vector<char> bytes_;
  json views_ = json::array(), accessors_ = json::array();
};

std::vector<float> flat(const Points& points) {
  return {points.data(), points.data() + points.size()};
}

/// Unit normals; where no face touches, straight up (glTF wants unit length everywhere).
Points unit_normals(const Mesh& mesh) {
  Points normals = vertex_normals(mesh.vertices, mesh.faces);
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    const float length = normals.row(v).norm();
    if (length > 0.5f && std::isfinite(length)) {
      normals.row(v) /= length;
    } else {
      normals.row(v) << 0, 1, 0;
    }
  }
  return normals;
}

struct Influences {
  std::vector<uint8_t> joints;  // [V, 4]
  std::vector<float> weights;   // [V, 4]
};

/// The four strongest joints of each vertex, strongest first, weights made to sum to 1; unused places are
/// joint 0.
Influences best_four(const RowMatrix& weights) {
  Influences result;
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    std::array<int, kJointCount> order;
    for (int j = 0; j < kJointCount; ++j) order[j] = j;
    std::partial_sort(order.begin(), order.begin() + 4, order.end(), [&](int a, int b) {
      return weights(v, a) > weights(v, b) || (weights(v, a) == weights(v, b) && a < b);
    });
    float sum = 0;
    for (int k = 0; k < 4; ++k) sum += std::max(0.0f, weights(v, order[k]));
    for (int k = 0; k < 4; ++k) {
      const float w = sum > 0 ? std::max(0.0f, weights(v, order[k])) / sum : (k == 0 ? 1.0f : 0.0f);
      result.joints.push_back(w > 0 ? static_cast<uint8_t>(order[k]) : uint8_t{0});
      result.weights.push_back(w);
    }
  }
  return result;
}

json mesh_primitive(const GlbCharacter& character, Buffer& buffer) {
  const Mesh& mesh = character.mesh;
  json attributes;
  attributes["POSITION"] = buffer.add_bounded(flat(mesh.vertices), "VEC3", ArrayBuffer);
  const Influences skin = best_four(character.weights);
  attributes["JOINTS_0"] = buffer.add(skin.joints, "VEC4", UnsignedByte, ArrayBuffer);
  attributes["WEIGHTS_0"] = buffer.add(skin.weights, "VEC4", Float, ArrayBuffer);
  if (mesh.colors.rows() == mesh.vertices.rows())
    attributes["COLOR_0"] =
        buffer.add(flat(mesh.colors.cwiseMax(0.0f).cwiseMin(1.0f)), "VEC3", Float, ArrayBuffer);
  if (mesh.is_cloud()) return {{"attributes", attributes}, {"mode", 0}, {"material", 0}};
  attributes["NORMAL"] = buffer.add(flat(unit_normals(mesh)), "VEC3", Float, ArrayBuffer);
  const std::vector<uint32_t> indices(mesh.faces.data(), mesh.faces.data() + mesh.faces.size());
  const int accessor = buffer.add(indices, "SCALAR", UnsignedInt, ElementArrayBuffer);
  return {{"attributes", attributes}, {"indices", accessor}, {"mode", 4}, {"material", 0}};
}

/// Nodes 0..21 are the joints, node 22 the mesh.
json skeleton_nodes(const GlbCharacter& character) {
  json nodes = json::array();
  for (int j = 0; j < kJointCount; ++j) {
    const int p = kParents[j];
    Vec3 offset = character.joints.row(j).transpose();
    if (p >= 0) offset -= character.joints.row(p).transpose();
    json node = {{"name", kJointNames[j]}, {"translation", {offset.x(), offset.y(), offset.z()}}};
    for (int child = 0; child < kJointCount; ++child)
      if (kParents[child] == j) node["children"].push_back(child);
    nodes.push_back(node);
  }
  nodes.push_back({{"name", character.name}, {"mesh", 0}, {"skin", 0}});
  return nodes;
}

int inverse_bind_matrices(const Joints& joints, Buffer& buffer) {
  std::vector<float> values;  // column-major
  for (int j = 0; j < kJointCount; ++j) {
    Eigen::Matrix4f inverse = Eigen::Matrix4f::Identity();
    inverse.topRightCorner<3, 1>() = -joints.row(j).transpose();
    values.insert(values.end(), inverse.data(), inverse.data() + 16);
  }
  return buffer.add(values, "MAT4", Float, None);
}

void write_chunk(std::ofstream& file, const char* type, const char* data, size_t size) {
  const uint32_t length = static_cast<uint32_t>(size);
  file.write(reinterpret_cast<const char*>(&length), 4);
  file.write(type, 4);
  file.write(data, static_cast<std::streamsize>(size));
}

void write_glb(const std::string& path, std::string text, const std::vector<char>& bytes) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const uint64_t total = 12 + 8 + uint64_t{text.size()} + 8 + uint64_t{bytes.size()};
  US_CHECK(total <= 0xffffffffull, path, ": the animation needs ", total, " bytes, glTF holds 4 GB");
  const std::string part = path + ".part";
  {
    std::ofstream file(part, std::ios::binary);
    US_CHECK(file, path, ": cannot be written");
    const std::array<uint32_t, 3> header = {0x46546c67u, 2u, static_cast<uint32_t>(total)};
    file.write(reinterpret_cast<const char*>(header.data()), 12);
    write_chunk(file, "JSON", text.data(), text.size());
    write_chunk(file, "BIN\0", bytes.data(), bytes.size());
    file.close();
    if (!file) {
      std::remove(part.c_str());
      US_CHECK(false, path, ": writing failed, the disk may be full");
    }
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    US_CHECK(false, path, ": cannot be written");
  }
}

}  // namespace

GlbWriter::GlbWriter(const std::string& path, GlbCharacter character)
    : path_(path), character_(std::move(character)) {
  const Mesh& mesh = character_.mesh;
  US_CHECK(mesh.vertices.rows() > 0 && mesh.vertices.allFinite(), path_,
           ": the target has no vertices or some are not finite");
  US_CHECK(character_.weights.rows() == mesh.vertices.rows() && character_.weights.cols() == kJointCount,
           path_, ": ", mesh.vertices.rows(), " vertices but weights of ", character_.weights.rows(), "x",
           character_.weights.cols());
  US_CHECK(character_.weights.allFinite() && character_.joints.allFinite(), path_,
           ": the skin is not finite");
  US_CHECK(mesh.is_cloud() || (mesh.faces.minCoeff() >= 0 && mesh.faces.maxCoeff() < mesh.vertices.rows()),
           path_, ": a face names a vertex that does not exist");
}

void GlbWriter::push(const Pose& pose, float time_s) {
  US_CHECK(std::isfinite(time_s) && (times_.empty() || time_s > times_.back()), path_,
           ": time does not increase at frame ", times_.size());
  US_CHECK(pose.root.allFinite(), path_, ": the pose of frame ", times_.size(), " is not finite");
  for (int j = 0; j < kJointCount; ++j) {
    US_CHECK(pose.local[j].allFinite(), path_, ": the pose of frame ", times_.size(), " is not finite");
    Eigen::Quaternionf q(pose.local[j]);
    q.normalize();
    std::vector<float>& kept = quaternions_[j];
    if (!kept.empty()) {  // q and -q are one rotation; the nearer one keeps interpolation short
      const Eigen::Vector4f before(kept[kept.size() - 4], kept[kept.size() - 3], kept[kept.size() - 2],
                                   kept.back());
      if (before.dot(q.coeffs()) < 0) q.coeffs() *= -1;
    }
    for (int i = 0; i < 4; ++i) kept.push_back(q.coeffs()[i]);
  }
  for (int i = 0; i < 3; ++i) roots_.push_back(pose.root[i]);
  times_.push_back(time_s);
}

void GlbWriter::finish() {
  Buffer buffer;
  json gltf;
  gltf["asset"] = {{"version", "2.0"}, {"generator", "Understudy"}};
  gltf["scene"] = 0;
  gltf["scenes"] = json::array({{{"nodes", {0, kJointCount}}}});
  gltf["nodes"] = skeleton_nodes(character_);
  gltf["materials"] = json::array(
      {{{"name", "body"},
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.8, 0.76, 0.72, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}}});
  gltf["meshes"] = json::array(
      {{{"name", character_.name}, {"primitives", json::array({mesh_primitive(character_, buffer)})}}});
  json joints = json::array();
  for (int j = 0; j < kJointCount; ++j) joints.push_back(j);
  gltf["skins"] = json::array({{{"joints", joints},
                                {"skeleton", 0},
                                {"inverseBindMatrices", inverse_bind_matrices(character_.joints, buffer)}}});
  if (!times_.empty()) {
    json samplers = json::array(), channels = json::array();
    const int times = buffer.add_bounded(times_, "SCALAR", None);
    const auto add = [&](int node, const char* path, int output) {
      channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
      samplers.push_back({{"input", times}, {"output", output}, {"interpolation", "LINEAR"}});
    };
    add(Pelvis, "translation", buffer.add(roots_, "VEC3", Float, None));
    for (int j = 0; j < kJointCount; ++j)
      add(j, "rotation", buffer.add(quaternions_[j], "VEC4", Float, None));
    gltf["animations"] = json::array({{{"name", "motion"}, {"samplers", samplers}, {"channels", channels}}});
  }
  gltf["buffers"] = json::array({{{"byteLength", buffer.bytes().size()}}});
  gltf["bufferViews"] = buffer.views();
  gltf["accessors"] = buffer.accessors();
  write_glb(path_, gltf.dump(), buffer.bytes());
}

}  // namespace understudy
