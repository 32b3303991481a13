#include "retarget/formats/gltf_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

using Json = nlohmann::json;
using Mat4 = Eigen::Matrix4f;

constexpr uint32_t kGlbJson = 0x4E4F534A, kGlbBinary = 0x004E4942;

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

std::string decode_base64(std::string_view text) {
  std::string out;
  out.reserve(text.size() / 4 * 3);
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = sextet(c);
    if (value < 0) continue;
    bits = bits << 6 | static_cast<uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.push_back(static_cast<char>(bits >> count & 255u));
  }
  return out;
}

std::string decode_percent(const std::string& uri) {
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    int64_t value = 0;
    const auto digit = [](char c) {
      return c >= '0' && c <= '9' ? c - '0' : c >= 'a' ? c - 'a' + 10 : c - 'A' + 10;
    };
    if (uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
        std::isxdigit(static_cast<unsigned char>(uri[i + 2]))) {
      value = digit(uri[i + 1]) * 16 + digit(uri[i + 2]);
      out.push_back(static_cast<char>(value));
      i += 2;
    } else {
      out.push_back(uri[i]);
    }
  }
  return out;
}

// Numbers of an accessor, checked against its buffer.
struct Accessor {
  int64_t count = 0;
  int parts = 1;              // numbers an element
  std::vector<float> values;  // [count, parts]
};

class GltfFile {
 public:
  GltfFile(std::string_view bytes, const std::string& path) : path_(path) {
    std::string_view text = bytes;
    if (bytes.substr(0, 4) == "glTF") text = split_glb(bytes);
    root_ = Json::parse(text.begin(), text.end(), nullptr, false);
    US_CHECK(root_.is_object(), path_, ": its JSON is broken or cut off");
    US_CHECK(root_.contains("asset"), path_, ": is JSON, but no glTF");
    for (const auto& name : list("extensionsRequired")) {
      const std::string extension = name.is_string() ? name.get<std::string>() : "";
      US_CHECK(extension != "KHR_draco_mesh_compression" && extension != "EXT_meshopt_compression", path_,
               ": is compressed with ", extension, ", which is not read; export it without");
    }
  }

  const Json& list(const char* name) const {
    static const Json kEmpty = Json::array();
    const auto found = root_.find(name);
    return found != root_.end() && found->is_array() ? *found : kEmpty;
  }
  const Json& item(const char* name, int64_t index) const {
    const Json& items = list(name);
    US_CHECK(index >= 0 && index < static_cast<int64_t>(items.size()), path_, ": names number ", index,
             " of its ", items.size(), " ", name);
    const Json& found = items[static_cast<size_t>(index)];
    US_CHECK(found.is_object(), path_, ": number ", index, " of its ", name, " is no object");
    return found;
  }
  // A whole number of an object; `otherwise` when it is absent.
  int64_t integer(const Json& object, const char* name, int64_t otherwise) const {
    const auto found = object.find(name);
    if (found == object.end()) return otherwise;
    US_CHECK(found->is_number(), path_, ": '", name, "' is no number");
    const int64_t value = found->is_number_float() ? whole(found->get<double>()) : found->get<int64_t>();
    US_CHECK(value >= 0, path_, ": '", name, "' is negative or too large");
    return value;
  }
  // The numbers of an array; empty when it is absent.
  std::vector<float> numbers(const Json& object, const char* name, size_t count) const {
    const auto found = object.find(name);
    if (found == object.end()) return {};
    US_CHECK(found->is_array() && found->size() == count, path_, ": '", name, "' is no list of ", count,
             " numbers");
    std::vector<float> values;
    for (const auto& value : *found) {
      US_CHECK(value.is_number(), path_, ": '", name, "' is no list of numbers");
      values.push_back(narrow(value.get<double>()));
    }
    return values;
  }

  Accessor accessor(int64_t index);
  const std::string& path() const { return path_; }
  const Json& root() const { return root_; }

 private:
  struct Stretch {
    std::string_view bytes;
    uint64_t stride;  // 0: packed
  };

  std::string_view split_glb(std::string_view bytes);
  std::string_view buffer(int64_t index);
  Stretch view(int64_t index);
  void apply_sparse(const Json& sparse, NumberType type, bool normalized, Accessor& out);
  void read(const Stretch& from, uint64_t offset, NumberType type, bool normalized, Accessor& out) const;

  const std::string& path_;
  Json root_;
  std::string_view binary_;
  std::map<int64_t, std::string> loaded_;
};

std::string_view GltfFile::split_glb(std::string_view bytes) {
  US_CHECK(bytes.size() >= 20, path_, ": ends inside the GLB header");
  US_CHECK(load<uint32_t>(bytes.data() + 4, false) == 2, path_, ": is GLB version ",
           load<uint32_t>(bytes.data() + 4, false), ", only 2 is read");
  std::string_view text;
  size_t at = 12;
  while (bytes.size() - at >= 8) {
    const uint32_t size = load<uint32_t>(bytes.data() + at, false),
                   kind = load<uint32_t>(bytes.data() + at + 4, false);
    US_CHECK(size <= bytes.size() - at - 8, path_, ": a chunk of the GLB is cut off");
    const std::string_view chunk = bytes.substr(at + 8, size);
    if (kind == kGlbJson && text.empty()) text = chunk;
    if (kind == kGlbBinary && binary_.empty()) binary_ = chunk;
    at += 8 + static_cast<size_t>(size);
  }
  return text;
}

std::string_view GltfFile::buffer(int64_t index) {
  const Json& object = item("buffers", index);
  const auto uri = object.find("uri");
  if (uri == object.end()) {
    US_CHECK(index == 0 && !binary_.empty(), path_, ": buffer ", index, " has no data");
    return binary_;
  }
  US_CHECK(uri->is_string(), path_, ": the uri of buffer ", index, " is no text");
  const auto [entry, is_new] = loaded_.try_emplace(index);
  if (!is_new) return entry->second;
  const auto& text = uri->get_ref<const std::string&>();
  if (text.rfind("data:", 0) == 0) {
    const size_t comma = text.find(',');
    US_CHECK(comma != text.npos && text.find(";base64") < comma, path_, ": the data of buffer ", index,
             " are not base64");
    entry->second = decode_base64(std::string_view(text).substr(comma + 1));
  } else {
    entry->second = read_file((std::filesystem::path(path_).parent_path() / decode_percent(text)).string());
  }
  return entry->second;
}

GltfFile::Stretch GltfFile::view(int64_t index) {
  const Json& object = item("bufferViews", index);
  const std::string_view whole_buffer = buffer(integer(object, "buffer", -1));
  const auto offset = static_cast<uint64_t>(integer(object, "byteOffset", 0));
  const auto length = static_cast<uint64_t>(integer(object, "byteLength", 0));
  US_CHECK(offset <= whole_buffer.size() && length <= whole_buffer.size() - offset, path_, ": buffer view ",
           index, " reaches behind its buffer");
  const auto stride = static_cast<uint64_t>(integer(object, "byteStride", 0));
  US_CHECK(stride <= 252, path_, ": buffer view ", index, " has a stride of ", stride, " bytes");
  return {whole_buffer.substr(offset, length), stride};
}

NumberType component_type(int64_t code, const std::string& path) {
  switch (code) {
    case 5120:
      return NumberType::I8;
    case 5121:
      return NumberType::U8;
    case 5122:
      return NumberType::I16;
    case 5123:
      return NumberType::U16;
    case 5125:
      return NumberType::U32;
    case 5126:
      return NumberType::F32;
    default:
      throw Error(path + ": an accessor has the unknown component type " + std::to_string(code));
  }
}

int part_count(const Json& accessor, const std::string& path) {
  static const std::map<std::string, int> kParts = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3},
                                                    {"VEC4", 4},   {"MAT3", 9}, {"MAT4", 16}};
  const auto type = accessor.find("type");
  const auto found =
      type != accessor.end() && type->is_string() ? kParts.find(type->get<std::string>()) : kParts.end();
  US_CHECK(found != kParts.end(), path, ": an accessor has no type that is read");
  return found->second;
}

float normalizer(NumberType type) {
  switch (type) {
    case NumberType::I8:
      return 1 / 127.0f;
    case NumberType::U8:
      return 1 / 255.0f;
    case NumberType::I16:
      return 1 / 32767.0f;
    case NumberType::U16:
      return 1 / 65535.0f;
    default:
      return 1;
  }
}

// Fills out.values from bytes. Indices above 2^24 do not fit a float, so U32 is checked there by the callers'
// counts.
void GltfFile::read(const Stretch& from, uint64_t offset, NumberType type, bool normalized,
                    Accessor& out) const {
  const uint64_t width = size_of(type) * static_cast<uint64_t>(out.parts);
  const uint64_t stride = from.stride == 0 ? width : from.stride, size = from.bytes.size();
  const auto count = static_cast<uint64_t>(out.count);
  US_CHECK(count == 0 ||
               (offset <= size && width <= size - offset && (count - 1) <= (size - offset - width) / stride),
           path_, ": an accessor of ", count, " elements reaches behind its buffer view");
  out.values.resize(count * static_cast<uint64_t>(out.parts));
  const float scale = normalized ? normalizer(type) : 1.0f;
  float* to = out.values.data();
  for (uint64_t i = 0; i < count; ++i) {
    const char* at = from.bytes.data() + offset + i * stride;
    for (int p = 0; p < out.parts; ++p, at += size_of(type))
      *to++ = narrow(load_number(type, at, false)) * scale;
  }
}

Accessor GltfFile::accessor(int64_t index) {
  const Json& object = item("accessors", index);
  Accessor out;
  out.count = integer(object, "count", 0);
  out.parts = part_count(object, path_);
  const NumberType type = component_type(integer(object, "componentType", 0), path_);
  const auto normalized_field = object.find("normalized");
  const bool normalized =
      normalized_field != object.end() && normalized_field->is_boolean() && *normalized_field;
  const auto sparse = object.find("sparse");
  if (object.contains("bufferView")) {
    read(view(integer(object, "bufferView", -1)), static_cast<uint64_t>(integer(object, "byteOffset", 0)),
         type, normalized, out);
  } else {
    // Zeros need no bytes in the file, so nothing bounds their count but sense.
    US_CHECK(sparse != object.end() && out.count <= 10000000, path_, ": accessor ", index, " has no data");
    out.values.assign(static_cast<size_t>(out.count) * static_cast<size_t>(out.parts), 0.0f);
  }
  if (sparse != object.end()) apply_sparse(*sparse, type, normalized, out);
  return out;
}

void GltfFile::apply_sparse(const Json& sparse, NumberType type, bool normalized, Accessor& out) {
  US_CHECK(sparse.is_object() && sparse.contains("indices") && sparse.contains("values") &&
               sparse["indices"].is_object() && sparse["values"].is_object(),
           path_, ": a sparse accessor is incomplete");
  const Json &where = sparse["indices"], &what = sparse["values"];
  Accessor indices, values;
  indices.count = values.count = integer(sparse, "count", 0);
  values.parts = out.parts;
  read(view(integer(where, "bufferView", -1)), static_cast<uint64_t>(integer(where, "byteOffset", 0)),
       component_type(integer(where, "componentType", 0), path_), false, indices);
  read(view(integer(what, "bufferView", -1)), static_cast<uint64_t>(integer(what, "byteOffset", 0)), type,
       normalized, values);
  const auto parts = static_cast<size_t>(out.parts);
  for (size_t i = 0; i < indices.values.size(); ++i) {
    const int64_t row = whole(indices.values[i]);
    US_CHECK(row >= 0 && row < out.count, path_, ": a sparse accessor names element ", row, " of ",
             out.count);
    std::copy_n(values.values.begin() + static_cast<int64_t>(i * parts), parts,
                out.values.begin() + static_cast<int64_t>(static_cast<size_t>(row) * parts));
  }
}

Mat4 local_transform(const GltfFile& file, const Json& node) {
  const auto matrix = file.numbers(node, "matrix", 16);
  if (!matrix.empty()) return Eigen::Map<const Mat4>(matrix.data());  // column-major as Eigen's
  Mat4 out = Mat4::Identity();
  if (const auto r = file.numbers(node, "rotation", 4); !r.empty()) {
    const Eigen::Quaternionf q(r[3], r[0], r[1], r[2]);
    if (q.norm() > 1e-8f) out.topLeftCorner<3, 3>() = q.normalized().toRotationMatrix();
  }
  if (const auto s = file.numbers(node, "scale", 3); !s.empty())
    out.topLeftCorner<3, 3>() = (out.topLeftCorner<3, 3>() * Vec3(s[0], s[1], s[2]).asDiagonal()).eval();
  if (const auto t = file.numbers(node, "translation", 3); !t.empty())
    out.topRightCorner<3, 1>() = Vec3(t[0], t[1], t[2]);
  return out;
}

// The nodes of the scene, parents first, with their transforms to the world.
struct SceneNodes {
  std::vector<int64_t> order;
  std::vector<Mat4> world;
  std::vector<bool> reached;
};

SceneNodes walk_scene(const GltfFile& file) {
  const size_t count = file.list("nodes").size();
  SceneNodes nodes{{}, std::vector<Mat4>(count, Mat4::Identity()), std::vector<bool>(count, false)};
  std::vector<std::pair<int64_t, Mat4>> open;
  const auto add = [&](const Json& object, const char* name, const Mat4& parent) {
    const auto found = object.find(name);
    if (found == object.end() || !found->is_array()) return;
    for (const auto& child : *found) {
      US_CHECK(child.is_number_unsigned(), file.path(), ": a node's child is no number");
      open.emplace_back(whole(child.get<double>()), parent);
    }
  };
  if (!file.list("scenes").empty()) {
    add(file.item("scenes", file.integer(file.root(), "scene", 0)), "nodes", Mat4::Identity());
  } else {
    for (size_t i = count; i > 0; --i) open.emplace_back(static_cast<int64_t>(i - 1), Mat4::Identity());
  }
  while (!open.empty()) {
    const auto [index, parent] = open.back();
    open.pop_back();
    const Json& node = file.item("nodes", index);
    const auto i = static_cast<size_t>(index);
    if (nodes.reached[i]) continue;  // a loop, or a child of two parents: neither is allowed
    nodes.reached[i] = true;
    nodes.order.push_back(index);
    nodes.world[i] = parent * local_transform(file, node);
    add(node, "children", nodes.world[i]);
  }
  return nodes;
}

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
Mat4 bind_transform(GltfFile& file, const Json& skin, const SceneNodes& nodes) {
  const auto joints = skin.find("joints");
  US_CHECK(joints != skin.end() && joints->is_array() && !joints->empty(), file.path(),
           ": a skin has no joints");
  size_t best = joints->size(), best_rank = nodes.order.size() + 1;
  for (size_t j = 0; j < joints->size(); ++j) {
    US_CHECK((*joints)[j].is_number_unsigned(), file.path(), ": a joint of a skin is no number");
    const auto at = std::find(nodes.order.begin(), nodes.order.end(), whole((*joints)[j].get<double>()));
    const auto rank = static_cast<size_t>(at - nodes.order.begin());
    if (at != nodes.order.end() && rank < best_rank) {
      best = j;
      best_rank = rank;
    }
  }
  if (best == joints->size()) return Mat4::Identity();  // a skeleton outside of the scene
  Mat4 inverse_bind = Mat4::Identity();
  if (skin.contains("inverseBindMatrices")) {
    const Accessor matrices = file.accessor(file.integer(skin, "inverseBindMatrices", -1));
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
      const Accessor indices = file_.accessor(file_.integer(primitive, "indices", -1));
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
    const Accessor positions = file_.accessor(index);
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
    const Accessor colours = file_.accessor(file_.integer(attributes, "COLOR_0", -1));
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
  std::map<int64_t, int64_t> first_vertex_;  // of each accessor of positions in this mesh
  std::vector<float> positions_, colours_;
  FaceList faces_;
};

}  // namespace

Mesh parse_gltf(std::string_view bytes, const std::string& path) {
  GltfFile file(bytes, path);
  const SceneNodes nodes = walk_scene(file);
  MeshCollector collector(file);
  for (const int64_t index : nodes.order) {
    const Json& node = file.item("nodes", index);
    if (!node.contains("mesh")) continue;
    const Json& mesh = file.item("meshes", file.integer(node, "mesh", -1));
    Mat4 transform = nodes.world[static_cast<size_t>(index)];
    if (node.contains("skin"))
      transform = bind_transform(file, file.item("skins", file.integer(node, "skin", -1)), nodes);
    collector.add_mesh(mesh, transform);
  }
  const Mesh mesh = collector.finish();
  US_CHECK(mesh.vertices.rows() > 0, path, ": holds no mesh");
  return mesh;
}

}  // namespace understudy
