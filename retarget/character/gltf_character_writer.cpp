#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"

namespace understudy {
namespace {

using nlohmann::json;

enum Target { NoTarget = 0, VertexData = 34962, Indices = 34963 };

template <class T>
constexpr int component_of() {
  if (std::is_same_v<T, uint8_t>) return 5121;
  if (std::is_same_v<T, uint16_t>) return 5123;
  if (std::is_same_v<T, uint32_t>) return 5125;
  return 5126;
}

/// The binary chunk, its views and the accessors into it.
class BinaryChunk {
 public:
  size_t add_view(const void* data, size_t size, Target target) {
    const size_t start = bytes_.size();
    bytes_.resize((start + size + 3) / 4 * 4, 0);
    if (size > 0) std::memcpy(bytes_.data() + start, data, size);
    json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", size}};
    if (target != NoTarget) view["target"] = static_cast<int>(target);
    views_.push_back(view);
    return views_.size() - 1;
  }
  template <class T>
  size_t add(const std::vector<T>& values, const char* type, Target target, bool bounds = false) {
    json accessor = {{"componentType", component_of<T>()},
                     {"count", values.size() / width(type)},
                     {"type", type},
                     {"bufferView", add_view(values.data(), values.size() * sizeof(T), target)}};
    if (bounds) add_bounds(values.data(), values.size(), width(type), accessor);
    accessors_.push_back(accessor);
    return accessors_.size() - 1;
  }
  size_t add(const RowMatrix& values, Target target, bool bounds = false) {
    static const std::array<const char*, 5> kTypes = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return add(std::vector<float>(values.data(), values.data() + values.size()),
               kTypes[static_cast<size_t>(values.cols())], target, bounds);
  }
  /// Rows of three that are mostly zero.
  size_t add_sparse(const Points& values) {
    std::vector<uint32_t> rows;
    std::vector<float> kept;
    for (Eigen::Index v = 0; v < values.rows(); ++v)
      if (values.row(v).squaredNorm() > 0 || (v + 1 == values.rows() && rows.empty())) {
        rows.push_back(static_cast<uint32_t>(v));
        kept.insert(kept.end(), values.row(v).data(), values.row(v).data() + 3);
      }
    json accessor = {{"componentType", 5126}, {"count", values.rows()}, {"type", "VEC3"}};
    add_bounds(values.data(), static_cast<size_t>(values.size()), 3, accessor);
    accessor["sparse"] = {
        {"count", rows.size()},
        {"indices",
         {{"bufferView", add_view(rows.data(), 4 * rows.size(), NoTarget)}, {"componentType", 5125}}},
        {"values", {{"bufferView", add_view(kept.data(), 4 * kept.size(), NoTarget)}}}};
    accessors_.push_back(accessor);
    return accessors_.size() - 1;
  }
  const std::vector<char>& bytes() const { return bytes_; }
  const json& views() const { return views_; }
  const json& accessors() const { return accessors_; }

 private:
  static size_t width(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<size_t>(type.back() - '0');
  }
  template <class T>
  static void add_bounds(const T* values, size_t count, size_t width, json& accessor) {
    std::vector<T> low(values, values + width), high = low;
    for (size_t i = 0; i < count; ++i) {
      low[i % width] = std::min(low[i % width], values[i]);
      high[i % width] = std::max(high[i % width], values[i]);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }
  std::vector<char> bytes_;
  json views_ = json::array(), accessors_ = json::array();
};

json named(const std::string& name) {
  json out = json::object();
  if (!name.empty()) out["name"] = name;
  return out;
}

/// Unit rows, as the format wants them; a row without a direction becomes `otherwise`.
RowMatrix unit_rows(const Points& directions, const Vec3& otherwise) {
  RowMatrix out = directions;
  for (Eigen::Index v = 0; v < out.rows(); ++v) {
    const float length = out.row(v).norm();
    if (std::isfinite(length) && length > 1e-12f)
      out.row(v) /= length;
    else
      out.row(v) = otherwise.transpose();
  }
  return out;
}

/// A bone that is named twice for one vertex has both weights in one place, which the format asks for.
RowMatrix weights_of_bones(const CharacterPart& part) {
  RowMatrix out = part.weights;
  for (Eigen::Index v = 0; v < out.rows(); ++v)
    for (Eigen::Index k = 1; k < out.cols(); ++k)
      for (Eigen::Index before = 0; before < k && out(v, k) > 0; ++before)
        if (part.joints(v, before) == part.joints(v, k) && out(v, before) > 0) {
          out(v, before) += out(v, k);
          out(v, k) = 0;
        }
  return out;
}

template <class T>
size_t add_joints(const CharacterPart& part, const RowMatrix& weights, Eigen::Index first,
                  BinaryChunk& chunk) {
  std::vector<T> joints;
  for (Eigen::Index v = 0; v < part.joints.rows(); ++v)
    for (Eigen::Index k = first; k < first + 4; ++k)
      joints.push_back(k < part.joints.cols() && weights(v, k) > 0 ? static_cast<T>(part.joints(v, k))
                                                                   : T{0});
  return chunk.add(joints, "VEC4", VertexData);
}

void add_skin_attributes(const Character& character, const CharacterPart& part, BinaryChunk& chunk,
                         json& attributes) {
  // The sums are one to the last bit, which validators want: the largest weight takes the rounding.
  RowMatrix exact = weights_of_bones(part);
  for (Eigen::Index v = 0; v < exact.rows(); ++v) {
    auto row = exact.row(v);
    Eigen::Index largest = 0;
    row.maxCoeff(&largest);
    row[largest] = 0;
    row[largest] = 1 - row.sum();
  }
  const bool wide = character.skins[static_cast<size_t>(part.skin)].joints.size() > 256;
  for (Eigen::Index first = 0; first < part.joints.cols(); first += 4) {
    const std::string end = std::to_string(first / 4);
    attributes["JOINTS_" + end] = wide ? add_joints<uint16_t>(part, exact, first, chunk)
                                       : add_joints<uint8_t>(part, exact, first, chunk);
    RowMatrix weights = RowMatrix::Zero(exact.rows(), 4);
    const Eigen::Index count = std::min<Eigen::Index>(4, exact.cols() - first);
    weights.leftCols(count) = exact.middleCols(first, count);
    attributes["WEIGHTS_" + end] = chunk.add(weights, VertexData);
  }
}

json primitive_of(const Character& character, const CharacterPart& part, size_t shapes, BinaryChunk& chunk) {
  json attributes;
  attributes["POSITION"] = chunk.add(RowMatrix(part.vertices), VertexData, true);
  if (part.normals.rows() > 0)
    attributes["NORMAL"] = chunk.add(unit_rows(part.normals, Vec3::UnitY()), VertexData);
  if (part.tangents.rows() > 0) {
    RowMatrix tangents = part.tangents;
    tangents.leftCols<3>() = unit_rows(part.tangents.leftCols<3>(), Vec3::UnitX());
    tangents.col(3) =
        (part.tangents.col(3).array() < 0).select(-1.0f, Eigen::VectorXf::Ones(tangents.rows()));
    attributes["TANGENT"] = chunk.add(tangents, VertexData);
  }
  for (size_t i = 0; i < part.uvs.size(); ++i)
    attributes["TEXCOORD_" + std::to_string(i)] = chunk.add(part.uvs[i], VertexData);
  if (part.colors.rows() > 0) {
    const RowMatrix colors = part.colors.cwiseMax(0.0f).cwiseMin(1.0f);
    const bool opaque = colors.col(3).minCoeff() == 1;
    attributes["COLOR_0"] = chunk.add(opaque ? RowMatrix(colors.leftCols<3>()) : colors, VertexData);
  }
  if (part.skin >= 0) add_skin_attributes(character, part, chunk, attributes);
  json primitive = {{"attributes", attributes}, {"mode", part.faces.rows() > 0 ? 4 : 0}};
  if (part.material >= 0) primitive["material"] = part.material;
  if (part.faces.rows() > 0 && part.vertices.rows() <= 65535)
    primitive["indices"] = chunk.add(
        std::vector<uint16_t>(part.faces.data(), part.faces.data() + part.faces.size()), "SCALAR", Indices);
  else if (part.faces.rows() > 0)
    primitive["indices"] = chunk.add(
        std::vector<uint32_t>(part.faces.data(), part.faces.data() + part.faces.size()), "SCALAR", Indices);
  for (size_t s = 0; s < shapes; ++s)
    primitive["targets"].push_back(
        {{"POSITION", chunk.add_sparse(s < part.shapes.size() ? part.shapes[s]
                                                              : Points::Zero(part.vertices.rows(), 3))}});
  return primitive;
}

/// Meshes, one a node that carries parts; gives the mesh of each node, -1 for none.
std::vector<int> add_meshes(const Character& character, BinaryChunk& chunk, json& gltf) {
  std::vector<int> mesh_of(character.nodes.size(), -1);
  json meshes = json::array();
  for (size_t n = 0; n < character.nodes.size(); ++n) {
    json primitives = json::array();
    std::string name;
    const size_t shapes = character.nodes[n].shape_weights.size();
    for (const auto& part : character.parts) {
      if (part.node != static_cast<int>(n) || part.vertices.rows() == 0) continue;
      primitives.push_back(primitive_of(character, part, shapes, chunk));
      name = part.name;
    }
    if (primitives.empty()) continue;
    mesh_of[n] = static_cast<int>(meshes.size());
    json mesh = named(name);
    mesh["primitives"] = primitives;
    if (shapes > 0) mesh["weights"] = character.nodes[n].shape_weights;
    meshes.push_back(mesh);
  }
  gltf["meshes"] = meshes;
  return mesh_of;
}

void add_nodes(const Character& character, const std::vector<int>& mesh_of, json& gltf) {
  json nodes = json::array(), roots = json::array();
  for (size_t n = 0; n < character.nodes.size(); ++n) {
    const CharacterNode& from = character.nodes[n];
    json node = named(from.name);
    const Transform& local = from.local;
    const auto& t = local.translation;
    const auto& s = local.scale;
    const Eigen::Quaternionf q = local.rotation.normalized();
    if (!t.isZero(0)) node["translation"] = {t.x(), t.y(), t.z()};
    if (!q.isApprox(Eigen::Quaternionf::Identity(), 0)) node["rotation"] = {q.x(), q.y(), q.z(), q.w()};
    if (s != Vec3::Ones()) node["scale"] = {s.x(), s.y(), s.z()};
    if (mesh_of[n] >= 0) {
      node["mesh"] = mesh_of[n];
      for (const auto& part : character.parts)
        if (part.node == static_cast<int>(n) && part.skin >= 0) node["skin"] = part.skin;
    }
    nodes.push_back(node);
    if (from.parent < 0)
      roots.push_back(n);
    else
      nodes[static_cast<size_t>(from.parent)]["children"].push_back(n);
  }
  gltf["nodes"] = nodes;
  gltf["scene"] = 0;
  gltf["scenes"] = json::array({{{"nodes", roots}}});
}

void add_skins(const Character& character, BinaryChunk& chunk, json& gltf) {
  for (const auto& skin : character.skins) {
    std::vector<float> matrices;
    for (Mat4 matrix : skin.inverse_bind) {
      matrix.row(3) << 0, 0, 0, 1;
      matrices.insert(matrices.end(), matrix.data(), matrix.data() + 16);
    }
    json object = named(skin.name);
    object["joints"] = skin.joints;
    object["inverseBindMatrices"] = chunk.add(matrices, "MAT4", NoTarget);
    gltf["skins"].push_back(object);
  }
}

void add_materials(const Character& character, BinaryChunk& chunk, json& gltf) {
  for (const auto& image : character.images) {
    json object = named(image.name);
    object["mimeType"] = image.mime;
    object["bufferView"] = chunk.add_view(image.bytes.data(), image.bytes.size(), NoTarget);
    gltf["images"].push_back(object);
  }
  for (const auto& text : character.samplers) gltf["samplers"].push_back(json::parse(text));
  for (const auto& text : character.textures) gltf["textures"].push_back(json::parse(text));
  for (const auto& text : character.materials) gltf["materials"].push_back(json::parse(text));
  if (!character.extensions.empty()) gltf["extensionsUsed"] = character.extensions;
  if (!character.required.empty()) gltf["extensionsRequired"] = character.required;
}

void add_animations(const Character& character, BinaryChunk& chunk, json& gltf) {
  static const std::array<const char*, 4> kPaths = {"translation", "rotation", "scale", "weights"};
  static const std::array<const char*, 3> kKinds = {"LINEAR", "STEP", "CUBICSPLINE"};
  for (const auto& animation : character.animations) {
    if (animation.tracks.empty()) continue;
    json samplers = json::array(), channels = json::array();
    std::vector<std::pair<const std::vector<float>*, size_t>> times;  // tracks with the same times share them
    for (const auto& track : animation.tracks) {
      auto same = std::find_if(times.begin(), times.end(),
                               [&](const auto& known) { return *known.first == track.times; });
      if (same == times.end()) {
        times.emplace_back(&track.times, chunk.add(track.times, "SCALAR", NoTarget, true));
        same = times.end() - 1;
      }
      const char* type = track.path == TrackPath::Rotation ? "VEC4"
                         : track.path == TrackPath::Shapes ? "SCALAR"
                                                           : "VEC3";
      channels.push_back(
          {{"sampler", samplers.size()},
           {"target", {{"node", track.node}, {"path", kPaths[static_cast<size_t>(track.path)]}}}});
      samplers.push_back({{"input", same->second},
                          {"output", chunk.add(track.values, type, NoTarget)},
                          {"interpolation", kKinds[static_cast<size_t>(track.interpolation)]}});
    }
    json object = named(animation.name);
    object["samplers"] = samplers;
    object["channels"] = channels;
    gltf["animations"].push_back(object);
  }
}

std::string base64(const std::vector<char>& bytes) {
  static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      out.push_back(k > 1 && i + k - 1 >= bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63u]);
  }
  return out;
}

void append_number(uint32_t value, std::string& out) {
  out.append(reinterpret_cast<const char*>(&value), 4);
}

std::string as_glb(std::string text, const std::vector<char>& bytes) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  append_number(2, out);
  append_number(static_cast<uint32_t>(28 + text.size() + bytes.size()), out);
  append_number(static_cast<uint32_t>(text.size()), out);
  out += "JSON" + text;
  append_number(static_cast<uint32_t>(bytes.size()), out);
  out.append("BIN\0", 4).append(bytes.data(), bytes.size());
  return out;
}

}  // namespace

std::string gltf_bytes(const Character& character, const std::string& path) {
  check_character(character, path);
  BinaryChunk chunk;
  json gltf;
  gltf["asset"] = {{"version", "2.0"}, {"generator", "Understudy"}};
  add_nodes(character, add_meshes(character, chunk, gltf), gltf);
  add_skins(character, chunk, gltf);
  add_materials(character, chunk, gltf);
  add_animations(character, chunk, gltf);
  gltf["bufferViews"] = chunk.views();
  gltf["accessors"] = chunk.accessors();
  json buffer = {{"byteLength", chunk.bytes().size()}};
  US_CHECK(chunk.bytes().size() < 0xf0000000u, path, ": the character needs ", chunk.bytes().size(),
           " bytes, glTF holds 4 GB");
  const bool is_text = file_suffix(path) == ".gltf";
  if (is_text) buffer["uri"] = "data:application/octet-stream;base64," + base64(chunk.bytes());
  gltf["buffers"] = json::array({buffer});
  const std::string text = gltf.dump(is_text ? 1 : -1, ' ', false, json::error_handler_t::replace);
  return is_text ? text : as_glb(text, chunk.bytes());
}

void write_gltf_character(const std::string& path, const Character& character) {
  write_file(path, gltf_bytes(character, path));
}

}  // namespace understudy
