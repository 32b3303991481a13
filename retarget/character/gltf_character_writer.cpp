#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/formats/gltf_file.hpp"

namespace understudy {
namespace {

enum BufferTarget {
  NoTarget = 0,
  VertexData = TINYGLTF_TARGET_ARRAY_BUFFER,
  Indices = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER
};

template <class T>
constexpr int component_of() {
  if (std::is_same_v<T, uint8_t>) return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
  if (std::is_same_v<T, uint16_t>) return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  if (std::is_same_v<T, uint32_t>) return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  return TINYGLTF_COMPONENT_TYPE_FLOAT;
}

/// The model in the making: one buffer, its views and the accessors into it.
class ModelMaker {
 public:
  ModelMaker() { model.buffers.resize(1); }

  int add_view(const void* data, size_t size, BufferTarget target) {
    auto& bytes = model.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = size;
    view.target = target;
    bytes.resize((view.byteOffset + size + 3) / 4 * 4, 0);
    if (size > 0) std::memcpy(bytes.data() + view.byteOffset, data, size);
    model.bufferViews.push_back(std::move(view));
    return model.bufferViews.size() - 1;
  }
  template <class T>
  int add(const std::vector<T>& values, int type, BufferTarget target, bool bounds = false) {
    const size_t width = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type));
    tinygltf::Accessor accessor = accessor_of(component_of<T>(), type, values.size() / width);
    accessor.bufferView = add_view(values.data(), values.size() * sizeof(T), target);
    if (bounds) add_bounds(values.data(), values.size(), width, accessor);
    return add(std::move(accessor));
  }
  int add(const RowMatrix& values, BufferTarget target, bool bounds = false) {
    return add(std::vector<float>(values.data(), values.data() + values.size()),
               values.cols() == 1 ? TINYGLTF_TYPE_SCALAR : static_cast<int>(values.cols()), target, bounds);
  }
  /// Rows of three that are mostly zero.
  int add_sparse(const Points& values) {
    std::vector<uint32_t> rows;
    std::vector<float> kept;
    for (Eigen::Index v = 0; v < values.rows(); ++v)
      if (values.row(v).squaredNorm() > 0 || (v + 1 == values.rows() && rows.empty())) {
        rows.push_back(static_cast<uint32_t>(v));
        kept.insert(kept.end(), values.row(v).data(), values.row(v).data() + 3);
      }
    tinygltf::Accessor accessor =
        accessor_of(TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, values.rows());
    add_bounds(values.data(), values.size(), 3, accessor);
    auto& sparse = accessor.sparse;
    sparse.isSparse = true;
    sparse.count = rows.size();
    sparse.indices = {0, add_view(rows.data(), 4 * rows.size(), NoTarget),
                      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT};
    sparse.values = {add_view(kept.data(), 4 * kept.size(), NoTarget), 0};
    return add(std::move(accessor));
  }

  tinygltf::Model model;

 private:
  static tinygltf::Accessor accessor_of(int component, int type, size_t count) {
    tinygltf::Accessor accessor;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    return accessor;
  }
  int add(tinygltf::Accessor accessor) {
    model.accessors.push_back(std::move(accessor));
    return model.accessors.size() - 1;
  }
  template <class T>
  static void add_bounds(const T* values, size_t count, size_t width, tinygltf::Accessor& accessor) {
    accessor.minValues.assign(values, values + width);
    accessor.maxValues = accessor.minValues;
    for (size_t i = 0; i < count; ++i) {
      const auto value = static_cast<double>(values[i]);
      accessor.minValues[i % width] = std::min(accessor.minValues[i % width], value);
      accessor.maxValues[i % width] = std::max(accessor.maxValues[i % width], value);
    }
  }
};

/// A name as JSON may hold it: what is no UTF-8 becomes a sign for that.
std::string text_of(const std::string& name) {
  using nlohmann::json;
  return json::parse(json(name).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

/// Unit rows, as the format needs them; a row without a direction becomes `otherwise`.
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

template <class T>
int add_joints(const CharacterPart& part, const RowMatrix& weights, Eigen::Index first, ModelMaker& out) {
  std::vector<T> joints;
  for (Eigen::Index v = 0; v < part.joints.rows(); ++v)
    for (Eigen::Index k = first; k < first + 4; ++k)
      joints.push_back(k < part.joints.cols() && weights(v, k) > 0 ? static_cast<T>(part.joints(v, k))
                                                                   : T{0});
  return out.add(joints, TINYGLTF_TYPE_VEC4, VertexData);
}

void add_skin_attributes(const Character& character, const CharacterPart& part, ModelMaker& out,
                         std::map<std::string, int>& attributes) {
  // The sums are one to the last bit, which validators require: the largest weight takes the rounding.
  RowMatrix exact = weights_of_bones(part);
  for (Eigen::Index v = 0; v < exact.rows(); ++v) {
    auto row = exact.row(v);
    Eigen::Index largest = 0;
    row.maxCoeff(&largest);
    row[largest] = 0;
    row[largest] = 1 - row.sum();
  }
  const bool wide = character.skins[part.skin].joints.size() > 256;
  for (Eigen::Index first = 0; first < part.joints.cols(); first += 4) {
    const std::string end = std::to_string(first / 4);
    attributes["JOINTS_" + end] =
        wide ? add_joints<uint16_t>(part, exact, first, out) : add_joints<uint8_t>(part, exact, first, out);
    RowMatrix weights = RowMatrix::Zero(exact.rows(), 4);
    const Eigen::Index count = std::min<Eigen::Index>(4, exact.cols() - first);
    weights.leftCols(count) = exact.middleCols(first, count);
    attributes["WEIGHTS_" + end] = out.add(weights, VertexData);
  }
}

tinygltf::Primitive primitive_of(const Character& character, const CharacterPart& part, size_t shapes,
                                 ModelMaker& out) {
  tinygltf::Primitive primitive;
  auto& attributes = primitive.attributes;
  attributes["POSITION"] = out.add(RowMatrix(part.vertices), VertexData, true);
  if (part.normals.rows() > 0)
    attributes["NORMAL"] = out.add(unit_rows(part.normals, Vec3::UnitY()), VertexData);
  if (part.tangents.rows() > 0) {
    RowMatrix tangents = part.tangents;
    tangents.leftCols<3>() = unit_rows(part.tangents.leftCols<3>(), Vec3::UnitX());
    tangents.col(3) =
        (part.tangents.col(3).array() < 0).select(-1.0f, Eigen::VectorXf::Ones(tangents.rows()));
    attributes["TANGENT"] = out.add(tangents, VertexData);
  }
  for (size_t i = 0; i < part.uvs.size(); ++i)
    attributes["TEXCOORD_" + std::to_string(i)] = out.add(part.uvs[i], VertexData);
  if (part.colors.rows() > 0) {
    const RowMatrix colors = part.colors.cwiseMax(0.0f).cwiseMin(1.0f);
    const bool opaque = colors.col(3).minCoeff() == 1;
    attributes["COLOR_0"] = out.add(opaque ? RowMatrix(colors.leftCols<3>()) : colors, VertexData);
  }
  if (part.skin >= 0) add_skin_attributes(character, part, out, attributes);
  primitive.mode = part.faces.rows() > 0 ? TINYGLTF_MODE_TRIANGLES : TINYGLTF_MODE_POINTS;
  primitive.material = std::max(part.material, -1);
  const int *first = part.faces.data(), *end = first + part.faces.size();
  if (part.faces.rows() > 0)
    primitive.indices = part.vertices.rows() <= 65535
                            ? out.add(std::vector<uint16_t>(first, end), TINYGLTF_TYPE_SCALAR, Indices)
                            : out.add(std::vector<uint32_t>(first, end), TINYGLTF_TYPE_SCALAR, Indices);
  for (size_t s = 0; s < shapes; ++s)
    primitive.targets.push_back(
        {{"POSITION",
          out.add_sparse(s < part.shapes.size() ? part.shapes[s] : Points::Zero(part.vertices.rows(), 3))}});
  return primitive;
}

/// Meshes, one a node that carries parts; gives the mesh of each node, -1 for none.
std::vector<int> add_meshes(const Character& character, ModelMaker& out) {
  std::vector<int> mesh_of(character.nodes.size(), -1);
  for (size_t n = 0; n < character.nodes.size(); ++n) {
    tinygltf::Mesh mesh;
    const std::vector<float>& weights = character.nodes[n].shape_weights;
    for (const auto& part : character.parts) {
      if (part.node != static_cast<int>(n) || part.vertices.rows() == 0) continue;
      mesh.primitives.push_back(primitive_of(character, part, weights.size(), out));
      mesh.name = text_of(part.name);
    }
    if (mesh.primitives.empty()) continue;
    mesh.weights.assign(weights.begin(), weights.end());
    mesh_of[n] = out.model.meshes.size();
    out.model.meshes.push_back(std::move(mesh));
  }
  return mesh_of;
}

void add_nodes(const Character& character, const std::vector<int>& mesh_of, ModelMaker& out) {
  tinygltf::Scene scene;
  auto& nodes = out.model.nodes;
  for (const CharacterNode& from : character.nodes) {
    const int n = nodes.size();
    tinygltf::Node node;
    node.name = text_of(from.name);
    const Vec3 &t = from.local.translation, &s = from.local.scale;
    const Eigen::Quaternionf q = from.local.rotation.normalized();
    if (!t.isZero(0)) node.translation.assign(t.begin(), t.end());
    if (!q.isApprox(Eigen::Quaternionf::Identity(), 0)) node.rotation = {q.x(), q.y(), q.z(), q.w()};
    if (s != Vec3::Ones()) node.scale.assign(s.begin(), s.end());
    node.mesh = mesh_of[n];
    for (const auto& part : character.parts)
      if (node.mesh >= 0 && part.node == n && part.skin >= 0) node.skin = part.skin;
    nodes.push_back(std::move(node));
    (from.parent < 0 ? scene.nodes : nodes[from.parent].children).push_back(n);
  }
  out.model.defaultScene = 0;
  out.model.scenes = {scene};
}

void add_skins(const Character& character, ModelMaker& out) {
  for (const auto& from : character.skins) {
    std::vector<float> matrices;
    for (Mat4 matrix : from.inverse_bind) {
      matrix.row(3) << 0, 0, 0, 1;
      matrices.insert(matrices.end(), matrix.data(), matrix.data() + 16);
    }
    tinygltf::Skin skin;
    skin.name = text_of(from.name);
    skin.joints = from.joints;
    skin.inverseBindMatrices = out.add(matrices, TINYGLTF_TYPE_MAT4, NoTarget);
    out.model.skins.push_back(std::move(skin));
  }
}

void add_images(const Character& character, ModelMaker& out) {
  for (const auto& from : character.images) {
    tinygltf::Image image;
    image.name = text_of(from.name);
    image.mimeType = from.mime;
    image.bufferView = out.add_view(from.bytes.data(), from.bytes.size(), NoTarget);
    out.model.images.push_back(std::move(image));
  }
}

/// Nobody is to take frames that were made for captured ones.
tinygltf::Value extras_of(const std::vector<MadeFrames>& made) {
  tinygltf::Value::Array list;
  for (const MadeFrames& one : made)
    list.emplace_back(
        tinygltf::Value::Object{{"first", tinygltf::Value(one.first)},
                                {"last", tinygltf::Value(one.last)},
                                {"doubt_m", tinygltf::Value(static_cast<double>(one.doubt_m))}});
  return tinygltf::Value(tinygltf::Value::Object{{"made_frames", tinygltf::Value(std::move(list))}});
}

void add_animations(const Character& character, ModelMaker& out) {
  static const std::array<const char*, 3> kKinds = {"LINEAR", "STEP", "CUBICSPLINE"};
  for (const auto& from : character.animations) {
    if (from.tracks.empty()) continue;
    tinygltf::Animation animation;
    animation.name = text_of(from.name);
    std::vector<std::pair<const std::vector<float>*, int>> times;  // tracks with the same times share them
    for (const auto& track : from.tracks) {
      auto same = std::find_if(times.begin(), times.end(),
                               [&](const auto& known) { return *known.first == track.times; });
      if (same == times.end()) {
        times.emplace_back(&track.times, out.add(track.times, TINYGLTF_TYPE_SCALAR, NoTarget, true));
        same = times.end() - 1;
      }
      const int type = track.path == TrackPath::Rotation ? TINYGLTF_TYPE_VEC4
                       : track.path == TrackPath::Shapes ? TINYGLTF_TYPE_SCALAR
                                                         : TINYGLTF_TYPE_VEC3;
      tinygltf::AnimationChannel channel;
      channel.sampler = animation.samplers.size();
      channel.target_node = track.node;
      channel.target_path = kTrackPaths[static_cast<size_t>(track.path)];
      tinygltf::AnimationSampler sampler;
      sampler.input = same->second;
      sampler.output = out.add(track.values, type, NoTarget);
      sampler.interpolation = kKinds[static_cast<size_t>(track.interpolation)];
      animation.channels.push_back(std::move(channel));
      animation.samplers.push_back(std::move(sampler));
    }
    if (!from.made.empty()) animation.extras = extras_of(from.made);
    out.model.animations.push_back(std::move(animation));
  }
}

/// The lists that tinygltf would not write as they came: it drops nulls, numbers beyond int, names of
/// samplers.
std::string kept_lists(const Character& character) {
  std::string out;
  const auto add = [&](const char* name, const std::vector<std::string>& texts) {
    for (size_t i = 0; i < texts.size(); ++i)
      out += (i > 0 ? "," : std::string("\"") + name + "\":[") + texts[i];
    if (!texts.empty()) out += "],";
  };
  add("materials", character.materials);
  add("textures", character.textures);
  add("samplers", character.samplers);
  return out;
}

/// Puts the beginning of a JSON object into that of a glTF file; in GLB it stands behind two lengths.
void put_first(std::string lists, bool is_text, std::string& file) {
  if (is_text) {
    file.insert(1, lists);
    return;
  }
  lists.append((4 - lists.size() % 4) % 4, ' ');
  for (const size_t at : {8u, 12u}) {  // of the file, of its JSON
    const auto length = static_cast<uint32_t>(load<uint32_t>(file.data() + at, false) + lists.size());
    std::memcpy(file.data() + at, &length, sizeof(length));
  }
  file.insert(21, lists);
}

}  // namespace

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

std::string gltf_bytes(const Character& character, const std::string& path) {
  check_character(character, path);
  ModelMaker out;
  out.model.asset.generator = "Understudy";
  out.model.asset.copyright = character.rights;
  add_nodes(character, add_meshes(character, out), out);
  add_skins(character, out);
  add_images(character, out);
  add_animations(character, out);
  out.model.extensionsUsed = character.extensions;
  out.model.extensionsRequired = character.required;
  const size_t size = out.model.buffers[0].data.size();
  US_CHECK(size < 0xf0000000u, path, ": the character needs ", size, " bytes, glTF holds 4 GB");
  const bool is_text = file_suffix(path) == ".gltf";
  std::ostringstream stream;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&out.model, stream, is_text, !is_text);
  US_CHECK(stream, path, ": there is not enough memory for it");
  std::string file = stream.str();
  put_first(kept_lists(character), is_text, file);
  return file;
}

void write_gltf_character(const std::string& path, const Character& character) {
  write_file(path, gltf_bytes(character, path));
}

}  // namespace understudy
