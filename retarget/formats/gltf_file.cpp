#include "retarget/formats/gltf_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "retarget/base/text.hpp"
#include "retarget/math/types.hpp"

namespace understudy {
namespace {

using Json = nlohmann::json;
using Mat4 = Eigen::Matrix4f;

constexpr int kDeepestJson = 200;  // what works on it calls itself
// What may be made of a file: shared accessors and small numbers that become floats grow, but not without
// end.
constexpr uint64_t kMostDecoded = uint64_t{2} << 30, kSmall = uint64_t{256} << 20, kGrowth = 64;
constexpr uint32_t kGlbJson = 0x4E4F534A, kGlbBinary = 0x004E4942;

int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

bool is_base64(char c) {
  return sextet(c) >= 0 || c == '=' || c == '\n' || c == '\r' || c == ' ';
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

}  // namespace

GltfFile::GltfFile(std::string_view bytes, const std::string& path) : path_(path), size_(bytes.size()) {
  std::string_view text = bytes;
  if (bytes.substr(0, 4) == "glTF") text = split_glb(bytes);
  US_CHECK(json_depth(text) <= kDeepestJson, path_, ": its JSON is nested more than ", kDeepestJson,
           " levels deep");
  root_ = Json::parse(text.begin(), text.end(), nullptr, false);
  US_CHECK(root_.is_object(), path_, ": its JSON is broken or cut off");
  US_CHECK(root_.contains("asset"), path_, ": is JSON, but no glTF");
  check_version();
  for (const auto& name : list("extensionsRequired")) {
    const std::string extension = name.is_string() ? name.get<std::string>() : "";
    US_CHECK(extension != "KHR_draco_mesh_compression" && extension != "EXT_meshopt_compression", path_,
             ": is compressed with ", extension, ", which is not read; export it without");
  }
}

void GltfFile::check_version() const {
  const Json& asset = root_["asset"];
  for (const char* name : {"minVersion", "version"}) {
    const auto version = asset.is_object() ? asset.find(name) : asset.end();
    if (!asset.is_object() || version == asset.end()) continue;
    const std::string text = version->is_string() ? version->get<std::string>() : version->dump();
    US_CHECK(starts_with(text, "2.") || text == "2", path_, ": is glTF version ", excerpt(text),
             ", only 2 is read");
    return;
  }
}

void GltfFile::spend(uint64_t bytes) {
  const uint64_t most = std::min(kMostDecoded, kSmall + kGrowth * size_);
  US_CHECK(spent_ <= most && bytes <= most - spent_, path_, ": unpacks to more than ", most >> 20,
           " MiB, which a file of its size may not");
  spent_ += bytes;
}

const GltfFile::Json& GltfFile::list(const char* name) const {
  static const Json kEmpty = Json::array();
  const auto found = root_.find(name);
  return found != root_.end() && found->is_array() ? *found : kEmpty;
}
const GltfFile::Json& GltfFile::item(const char* name, int64_t index) const {
  const Json& items = list(name);
  US_CHECK(index >= 0 && index < static_cast<int64_t>(items.size()), path_, ": names number ", index,
           " of its ", items.size(), " ", name);
  const Json& found = items[static_cast<size_t>(index)];
  US_CHECK(found.is_object(), path_, ": number ", index, " of its ", name, " is no object");
  return found;
}
int64_t GltfFile::integer(const Json& object, const char* name, int64_t otherwise) const {
  const auto found = object.find(name);
  if (found == object.end()) return otherwise;
  US_CHECK(found->is_number(), path_, ": '", name, "' is no number");
  const int64_t value = found->is_number_float() ? whole(found->get<double>()) : found->get<int64_t>();
  US_CHECK(value >= 0, path_, ": '", name, "' is negative or too large");
  return value;
}
std::vector<float> GltfFile::numbers(const Json& object, const char* name, size_t count) const {
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
  return entry->second = uri_bytes(uri->get_ref<const std::string&>(), "buffer " + std::to_string(index));
}

std::string GltfFile::uri_bytes(const std::string& uri, const std::string& what) {
  if (starts_with(uri, "data:")) {
    const size_t comma = uri.find(',');
    US_CHECK(comma != uri.npos && uri.find(";base64") < comma, path_, ": the data of ", what,
             " are not base64");
    const std::string_view text = std::string_view(uri).substr(comma + 1);
    US_CHECK(std::all_of(text.begin(), text.end(), is_base64), path_, ": the data of ", what,
             " are not base64");
    spend(text.size() / 4 * 3);
    return decode_base64(text);
  }
  const std::string name = decode_percent(uri);
  US_CHECK(name.find("://") == name.npos, path_, ": ", what, " is on the net (", excerpt(name),
           "), only files beside it are read");
  // A file that somebody sent must not be able to show other files of this machine.
  const std::filesystem::path inside = std::filesystem::path(name).lexically_normal();
  US_CHECK(inside.is_relative() && !inside.empty() && *inside.begin() != ".." && name.find('\0') == name.npos,
           path_, ": ", what, " is outside of the file's folder (", excerpt(name), ")");
  std::string bytes;
  try {
    bytes = read_file((std::filesystem::path(path_).parent_path() / inside).string());
  } catch (const Error& error) {
    throw Error(path_ + ": " + what + ", " + error.what());
  }
  size_ += bytes.size();
  spend(bytes.size());
  return bytes;
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

// Fills out.values from bytes. Indices above 2^24 do not fit a float, so U32 is checked there by the callers'
// counts.
void GltfFile::read(const Stretch& from, uint64_t offset, NumberType type, bool normalized,
                    GltfAccessor& out) {
  const uint64_t width = size_of(type) * static_cast<uint64_t>(out.parts);
  const uint64_t stride = from.stride == 0 ? width : from.stride, size = from.bytes.size();
  const auto count = static_cast<uint64_t>(out.count);
  US_CHECK(count == 0 ||
               (offset <= size && width <= size - offset && (count - 1) <= (size - offset - width) / stride),
           path_, ": an accessor of ", count, " elements reaches behind its buffer view");
  spend(count * static_cast<uint64_t>(out.parts) * sizeof(float));
  out.values.resize(count * static_cast<uint64_t>(out.parts));
  const float scale = normalized ? normalizer(type) : 1.0f;
  float* to = out.values.data();
  for (uint64_t i = 0; i < count; ++i) {
    const char* at = from.bytes.data() + offset + i * stride;
    for (int p = 0; p < out.parts; ++p, at += size_of(type))
      *to++ = narrow(load_number(type, at, false)) * scale;
  }
}

GltfAccessor GltfFile::accessor(int64_t index) {
  const Json& object = item("accessors", index);
  GltfAccessor out;
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
    spend(static_cast<uint64_t>(out.count) * static_cast<uint64_t>(out.parts) * sizeof(float));
    out.values.assign(static_cast<size_t>(out.count) * static_cast<size_t>(out.parts), 0.0f);
  }
  if (sparse != object.end()) apply_sparse(*sparse, type, normalized, out);
  return out;
}

void GltfFile::apply_sparse(const Json& sparse, NumberType type, bool normalized, GltfAccessor& out) {
  US_CHECK(sparse.is_object() && sparse.contains("indices") && sparse.contains("values") &&
               sparse["indices"].is_object() && sparse["values"].is_object(),
           path_, ": a sparse accessor is incomplete");
  const Json &where = sparse["indices"], &what = sparse["values"];
  GltfAccessor indices, values;
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

Mat4 gltf_local_transform(const GltfFile& file, const Json& node) {
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

GltfSceneNodes walk_gltf_scene(const GltfFile& file) {
  const size_t count = file.list("nodes").size();
  GltfSceneNodes nodes{{}, std::vector<Mat4>(count, Mat4::Identity()), std::vector<bool>(count, false)};
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
    nodes.world[i] = parent * gltf_local_transform(file, node);
    add(node, "children", nodes.world[i]);
  }
  return nodes;
}

}  // namespace understudy
