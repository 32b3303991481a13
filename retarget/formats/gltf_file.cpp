#include "retarget/formats/gltf_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <climits>
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
// Of a list of objects: tinygltf makes hundreds of bytes of the two of "{}", twice as many while the list
// grows.
constexpr uint64_t kObject = sizeof(tinygltf::Node), kSmallList = 256 << 10, kListGrowth = 32;
constexpr uint32_t kGlbJson = 0x4E4F534A, kGlbBinary = 0x004E4942;
constexpr const char* kData = "data:application/octet-stream;base64,";
constexpr const char* kBuffer = "buffer:";  // and its number: the name of a buffer to tinygltf

std::string decode_percent(const std::string& uri) {
  const auto is_digit = [&](size_t i) { return std::isxdigit(static_cast<unsigned char>(uri[i])) != 0; };
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool is_coded = uri[i] == '%' && i + 2 < uri.size() && is_digit(i + 1) && is_digit(i + 2);
    out.push_back(is_coded ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i]);
    if (is_coded) i += 2;
  }
  return out;
}

NumberType component_type(int code, const std::string& path) {
  US_CHECK(code >= TINYGLTF_COMPONENT_TYPE_BYTE && code <= TINYGLTF_COMPONENT_TYPE_FLOAT &&
               code != TINYGLTF_COMPONENT_TYPE_INT,
           path, ": an accessor has the unknown component type ", code);
  return code == TINYGLTF_COMPONENT_TYPE_FLOAT ? NumberType::F32
                                               : static_cast<NumberType>(code - TINYGLTF_COMPONENT_TYPE_BYTE);
}

// What makes the largest integer of a type one.
float normalizer(NumberType type) {
  if (size_of(type) > 2) return 1;
  const bool is_signed = type == NumberType::I8 || type == NumberType::I16;
  return 1.0f / static_cast<float>((1 << (8 * size_of(type) - (is_signed ? 1 : 0))) - 1);
}

void check_version(const Json& asset, const std::string& path) {
  for (const char* name : {"minVersion", "version"}) {
    if (!asset.is_object() || !asset.contains(name)) continue;
    const Json& version = asset[name];
    const std::string text = version.is_string() ? version.get<std::string>() : version.dump();
    US_CHECK(starts_with(text, "2.") || text == "2", path, ": is glTF version ", excerpt(text),
             ", only 2 is read");
    return;
  }
}

// An index or a size as tinygltf takes it, which casts what it reads to int.
void bound_number(Json& value, const std::string& key, const std::string& path) {
  US_CHECK(value.is_number(), path, ": '", key, "' is not a list of numbers");
  const int64_t number = value.is_number_float() ? whole(value.get<double>()) : value.get<int64_t>();
  const bool is_size = key == "byteOffset" || key == "byteLength" || key == "count";
  US_CHECK(number >= 0 && (is_size || number <= INT_MAX), path, ": '", key, "' is negative or too large");
  value = static_cast<uint64_t>(number);
}

bool keep_picture(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

std::vector<float> floats(const std::vector<double>& values, size_t count, const char* name,
                          const std::string& path) {
  US_CHECK(values.empty() || values.size() == count, path, ": '", name, "' is not a list of ", count,
           " numbers");
  std::vector<float> out;
  out.reserve(values.size());
  for (const double value : values) out.push_back(narrow(value));
  return out;
}

}  // namespace

GltfFile::GltfFile(std::string_view bytes, const std::string& path, Use use)
    : path_(path), size_(bytes.size()) {
  try {
    Json root = parse(bytes.substr(0, 4) == "glTF" ? split_glb(bytes) : bytes);
    Json lean = {{"asset", {{"version", "2.0"}}}};
    for (const char* name : {"materials", "textures", "samplers", "extensionsRequired"})
      kept_[name] = root.contains(name) && root[name].is_array() ? std::move(root[name]) : Json::array();
    for (const char* name : {"accessors", "animations", "bufferViews", "buffers", "images", "meshes", "nodes",
                             "scene", "scenes", "skins"})
      if (root.contains(name)) lean[name] = std::move(root[name]);
    if (use == Use::Surface) {
      lean.erase("animations");
      lean.erase("images");
    }
    bound(lean, "");
    bound_buffers(lean);
    const std::string text = lean.dump();
    root = lean = nullptr;
    fill_model(text);
  } catch (const Json::exception&) {
    throw Error(path_ + ": something in its JSON is of another type than glTF requires");
  }
}

Json GltfFile::parse(std::string_view text) {
  US_CHECK(json_depth(text) <= kDeepestJson, path_, ": its JSON is nested more than ", kDeepestJson,
           " levels deep");
  Json root = Json::parse(text.begin(), text.end(), nullptr, false);
  US_CHECK(root.is_object(), path_, ": its JSON is broken or cut off");
  US_CHECK(root.contains("asset"), path_, ": is JSON, but no glTF");
  check_version(root["asset"], path_);
  if (root.contains("extensionsRequired"))
    for (const auto& name : root["extensionsRequired"])
      US_CHECK(name != "KHR_draco_mesh_compression" && name != "EXT_meshopt_compression", path_,
               ": is compressed with ", name.get<std::string>(), ", which is not read; export it without");
  return root;
}

// Nothing that tinygltf would make much of, cast or pass over in silence reaches it.
void GltfFile::bound(Json& value, const std::string& key) {
  if (value.is_array()) {
    const auto objects = static_cast<uint64_t>(
        std::count_if(value.begin(), value.end(), [](const Json& inner) { return inner.is_object(); }));
    US_CHECK(2 * kObject * objects <= kListGrowth * size_ + kSmallList, path_, ": '", key, "' lists ",
             objects, " things, more than a file of its size may");
    spend(kObject * objects);
    const bool is_indices = key == "children" || key == "joints" || key == "nodes";
    for (auto& inner : value) {
      if (inner.is_structured())
        bound(inner, key);
      else if (is_indices)
        bound_number(inner, key, path_);
    }
  } else if (value.is_object()) {
    value.erase("extras");
    if (value.contains("extensions")) {
      Json names = Json::object();
      for (const auto& extension : value["extensions"].items()) names[extension.key()] = Json::object();
      has_draco_ = has_draco_ || names.contains("KHR_draco_mesh_compression");
      value["extensions"] = names;
    }
    for (const auto& [name, inner] : value.items()) {
      if (inner.is_number()) bound_number(inner, name, path_);
      if (inner.is_structured()) bound(inner, name);
      if (name == "uri" && key == "images" && inner.is_string()) {
        const std::string& uri = inner.get_ref<const std::string&>();
        if (starts_with(uri, "data:")) inner = plain_data(uri, "a picture");
      }
    }
  }
}

// Buffers go by their numbers, so that tinygltf asks us for them, and views lie inside of them.
void GltfFile::bound_buffers(Json& root) {
  for (auto& buffer : root["buffers"]) {
    const std::string number = std::to_string(buffer_uris_.size());
    US_CHECK(!buffer.contains("uri") || buffer["uri"].is_string(), path_, ": the uri of buffer ", number,
             " is not a string");
    buffer_uris_.push_back(buffer.value("uri", ""));
    buffer_sizes_.push_back(buffer.value("byteLength", uint64_t{0}));
    buffer["uri"] = kBuffer + number;
  }
  size_t index = 0;
  for (auto& view : root["bufferViews"]) {
    const auto buffer = view.value("buffer", uint64_t{0}), offset = view.value("byteOffset", uint64_t{0}),
               length = view.value("byteLength", uint64_t{0});
    US_CHECK(buffer < buffer_sizes_.size(), path_, ": names number ", buffer, " of its ",
             buffer_sizes_.size(), " buffers");
    US_CHECK(offset <= buffer_sizes_[buffer] && length <= buffer_sizes_[buffer] - offset, path_,
             ": buffer view ", index, " reaches beyond its buffer");
    if (length == 0) view["byteOffset"] = uint64_t{0};  // tinygltf takes the address of the first byte
    ++index;
  }
}

void GltfFile::fill_model(const std::string& text) {
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(keep_picture, nullptr);
  const auto exists = [](const std::string& name, void*) { return starts_with(name, kBuffer); };
  const auto same = [](const std::string& name, void*) { return name; };
  const auto read = [](std::vector<unsigned char>* out, std::string*, const std::string& name, void* file) {
    const std::string bytes = static_cast<GltfFile*>(file)->buffer_bytes(std::stoull(name.substr(7)));
    out->assign(bytes.begin(), bytes.end());
    return true;
  };
  parser.SetFsCallbacks({exists, same, read, nullptr, this});
  std::string problem, warning;
  if (parser.LoadASCIIFromString(&model_, &problem, &warning, text.data(),
                                 static_cast<unsigned int>(text.size()), ""))
    return;
  US_CHECK(!has_draco_, path_, ": is compressed with Draco, which is not read; export it without");
  throw Error(path_ + ": something that glTF requires is missing or of another type: " +
              excerpt(problem.substr(0, problem.find('\n'))));
}

void GltfFile::spend(uint64_t bytes) {
  const uint64_t most = std::min(kMostDecoded, kSmall + kGrowth * size_);
  US_CHECK(spent_ <= most && bytes <= most - spent_, path_, ": unpacks to more than ", most >> 20,
           " MiB, which a file of its size may not");
  spent_ += bytes;
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

std::string GltfFile::buffer_bytes(size_t index) {
  const std::string what = "buffer " + std::to_string(index), uri = buffer_uris_.at(index);
  US_CHECK(!uri.empty() || (index == 0 && !binary_.empty()), path_, ": ", what, " has no data");
  std::string bytes = uri.empty() ? std::string(binary_) : uri_bytes(uri, what);
  US_CHECK(bytes.size() >= buffer_sizes_[index], path_, ": ", what, " holds ", bytes.size(),
           " bytes, it should hold ", buffer_sizes_[index]);
  bytes.resize(buffer_sizes_[index]);
  return bytes;
}

// The same data as a uri that tinygltf knows: of another type, and without line ends.
std::string GltfFile::plain_data(std::string uri, const std::string& what) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
  const size_t comma = uri.find(',');
  US_CHECK(comma != uri.npos && uri.find(";base64") < comma, path_, ": the data of ", what,
           " are not base64");
  uri.erase(0, comma + 1);
  uri.erase(std::remove_if(uri.begin(), uri.end(), [](char c) { return c == '\n' || c == '\r' || c == ' '; }),
            uri.end());
  US_CHECK(uri.find_first_not_of(kDigits) == uri.npos, path_, ": the data of ", what, " are not base64");
  spend(uri.size() / 4 * 3);
  return kData + uri;
}

std::string GltfFile::uri_bytes(const std::string& uri, const std::string& what) {
  if (starts_with(uri, "data:")) {
    std::vector<unsigned char> bytes;
    std::string type;
    tinygltf::DecodeDataURI(&bytes, type, plain_data(uri, what), 0, false);
    return {bytes.begin(), bytes.end()};
  }
  const std::string name = decode_percent(uri);
  US_CHECK(name.find("://") == name.npos, path_, ": ", what, " is on the network (", excerpt(name),
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

std::string_view GltfFile::view_bytes(int index) const {
  const tinygltf::BufferView& view = item(model_.bufferViews, index, "bufferViews");
  const auto& data = model_.buffers[view.buffer].data;
  return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
}

// Fills out.values from bytes. Indices above 2^24 do not fit a float, so U32 is checked there by the callers'
// counts.
void GltfFile::read(int view, uint64_t offset, NumberType type, bool normalized, GltfAccessor& out) {
  const std::string_view bytes = view_bytes(view);
  const uint64_t width = size_of(type) * static_cast<uint64_t>(out.parts), size = bytes.size();
  const uint64_t apart = model_.bufferViews[view].byteStride;
  const uint64_t stride = apart == 0 ? width : apart, count = static_cast<uint64_t>(out.count);
  US_CHECK(count == 0 ||
               (offset <= size && width <= size - offset && (count - 1) <= (size - offset - width) / stride),
           path_, ": an accessor of ", count, " elements reaches beyond its buffer view");
  spend(count * static_cast<uint64_t>(out.parts) * sizeof(float));
  out.values.resize(count * static_cast<uint64_t>(out.parts));
  const float scale = normalized ? normalizer(type) : 1.0f;
  float* to = out.values.data();
  for (uint64_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + offset + i * stride;
    for (int p = 0; p < out.parts; ++p, at += size_of(type))
      *to++ = narrow(load_number(type, at, false)) * scale;
  }
}

GltfAccessor GltfFile::accessor(int index) {
  const tinygltf::Accessor& from = item(model_.accessors, index, "accessors");
  GltfAccessor out;
  out.count = static_cast<int64_t>(from.count);
  out.parts = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type));
  US_CHECK(out.parts > 0 && from.type != TINYGLTF_TYPE_MAT2, path_, ": an accessor has no type that is read");
  const NumberType type = component_type(from.componentType, path_);
  if (from.bufferView >= 0) {
    read(from.bufferView, from.byteOffset, type, from.normalized, out);
  } else {
    US_CHECK(from.sparse.isSparse || !has_draco_, path_,
             ": is compressed with Draco, which is not read; export it without");
    // Zeros need no bytes in the file, so nothing bounds their count but sense.
    US_CHECK(from.sparse.isSparse && out.count <= 10000000, path_, ": accessor ", index, " has no data");
    spend(static_cast<uint64_t>(out.count) * static_cast<uint64_t>(out.parts) * sizeof(float));
    out.values.assign(static_cast<size_t>(out.count) * static_cast<size_t>(out.parts), 0.0f);
  }
  if (from.sparse.isSparse) apply_sparse(from, type, out);
  return out;
}

void GltfFile::apply_sparse(const tinygltf::Accessor& from, NumberType type, GltfAccessor& out) {
  const auto& sparse = from.sparse;
  GltfAccessor indices, values;
  indices.count = values.count = sparse.count;
  values.parts = out.parts;
  read(sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset),
       component_type(sparse.indices.componentType, path_), false, indices);
  read(sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset), type, from.normalized,
       values);
  const auto parts = static_cast<size_t>(out.parts);
  for (size_t i = 0; i < indices.values.size(); ++i) {
    const int64_t row = whole(indices.values[i]);
    US_CHECK(row >= 0 && row < out.count, path_, ": a sparse accessor names element ", row, " of ",
             out.count);
    std::copy_n(values.values.begin() + static_cast<int64_t>(i * parts), parts,
                out.values.begin() + static_cast<int64_t>(static_cast<size_t>(row) * parts));
  }
}

std::vector<float> GltfFile::inverse_bind(const tinygltf::Skin& skin) {
  US_CHECK(!skin.joints.empty(), path_, ": a skin has no joints");
  if (skin.inverseBindMatrices < 0) return {};
  GltfAccessor matrices = accessor(skin.inverseBindMatrices);
  US_CHECK(matrices.parts == 16 && static_cast<size_t>(matrices.count) >= skin.joints.size(), path_,
           ": a skin has fewer bind matrices than joints");
  return std::move(matrices.values);
}

bool GltfFile::is_shown(const tinygltf::Primitive& primitive) const {
  const int mode = primitive.mode;
  return (mode == TINYGLTF_MODE_POINTS ||
          (mode >= TINYGLTF_MODE_TRIANGLES && mode <= TINYGLTF_MODE_TRIANGLE_FAN)) &&
         primitive.attributes.count("POSITION") > 0;
}

Faces GltfFile::faces(const tinygltf::Primitive& primitive, int64_t count) {
  std::vector<int64_t> c;
  if (primitive.mode == TINYGLTF_MODE_POINTS) return Faces(0, 3);
  if (primitive.indices >= 0) {
    const GltfAccessor indices = accessor(primitive.indices);
    US_CHECK(indices.parts == 1, path_, ": the indices of a primitive are not single numbers");
    for (const float index : indices.values) {
      US_CHECK(index >= 0 && index < static_cast<float>(count), path_, ": a face names vertex ", index,
               " of a primitive of ", count);
      c.push_back(static_cast<int64_t>(index));
    }
  } else {
    for (int64_t i = 0; i < count; ++i) c.push_back(i);
  }
  FaceList faces;
  for (size_t i = 0; i + 2 < c.size(); i += primitive.mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1) {
    const bool turn = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1;
    faces.add(primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN ? c[0] : c[i], c[i + (turn ? 2 : 1)],
              c[i + (turn ? 1 : 2)]);
  }
  return faces.finish(count, path_);
}

Mat4 gltf_local_transform(const GltfFile& file, const tinygltf::Node& node) {
  const auto matrix = floats(node.matrix, 16, "matrix", file.path());
  if (!matrix.empty()) return Eigen::Map<const Mat4>(matrix.data());  // column-major as Eigen's
  Mat4 out = Mat4::Identity();
  if (const auto r = floats(node.rotation, 4, "rotation", file.path()); !r.empty()) {
    const Eigen::Quaternionf q(r[3], r[0], r[1], r[2]);
    if (q.norm() > 1e-8f) out.topLeftCorner<3, 3>() = q.normalized().toRotationMatrix();
  }
  if (const auto s = floats(node.scale, 3, "scale", file.path()); !s.empty())
    out.topLeftCorner<3, 3>() = (out.topLeftCorner<3, 3>() * Vec3(s[0], s[1], s[2]).asDiagonal()).eval();
  if (const auto t = floats(node.translation, 3, "translation", file.path()); !t.empty())
    out.topRightCorner<3, 1>() = Vec3(t[0], t[1], t[2]);
  return out;
}

GltfSceneNodes walk_gltf_scene(const GltfFile& file) {
  const tinygltf::Model& model = file.model();
  const size_t count = model.nodes.size();
  GltfSceneNodes nodes{{}, std::vector<Mat4>(count, Mat4::Identity())};
  std::vector<bool> reached(count, false);
  std::vector<std::pair<int, Mat4>> open;
  if (!model.scenes.empty()) {
    for (const int root : file.item(model.scenes, std::max(model.defaultScene, 0), "scenes").nodes)
      open.emplace_back(root, Mat4::Identity());
  } else {
    for (size_t i = count; i > 0; --i) open.emplace_back(static_cast<int>(i - 1), Mat4::Identity());
  }
  while (!open.empty()) {
    const auto [index, parent] = open.back();
    open.pop_back();
    const tinygltf::Node& node = file.item(model.nodes, index, "nodes");
    const auto i = static_cast<size_t>(index);
    if (reached[i]) continue;  // a loop, or a child of two parents: neither is allowed
    reached[i] = true;
    nodes.order.push_back(index);
    nodes.world[i] = parent * gltf_local_transform(file, node);
    for (const int child : node.children) open.emplace_back(child, nodes.world[i]);
  }
  return nodes;
}

}  // namespace understudy
