#include "retarget/character/gltf_character.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/formats/gltf_file.hpp"

namespace understudy {
namespace {

using Json = nlohmann::json;
using Attributes = std::map<std::string, int>;  // accessors by their names

constexpr int kMaxNodeDepth = 1000, kMostParts = 10000;
constexpr int64_t kMostPrimitives = 1000000;

class CharacterReader {
 public:
  CharacterReader(std::string_view bytes, const std::string& path)
      : file_(bytes, path, GltfFile::Use::Character), model_(file_.model()), path_(path) {}
  Character read();

 private:
  void read_nodes();
  void order_nodes(const std::vector<int>& parents);
  void read_skins();
  void read_mesh(const tinygltf::Node& node, int to);
  void read_primitive(const tinygltf::Primitive& primitive, CharacterPart part);
  void read_attributes(const Attributes& attributes, CharacterPart& part);
  void read_influences(const Attributes& attributes, CharacterPart& part);
  void read_shapes(const tinygltf::Primitive& primitive, CharacterPart& part);
  void read_images();
  void keep_texts(const char* name, std::vector<std::string>& out);
  void keep_extensions(const Json& value, std::set<std::string>& found) const;
  void read_animations();
  void read_channel(const tinygltf::AnimationChannel& channel,
                    const std::vector<tinygltf::AnimationSampler>& samplers, CharacterAnimation& out);
  RowMatrix rows(int accessor, int parts, const char* what, Eigen::Index count);
  int node_number(int index) const { return file_.item(node_of_, index, "nodes"); }

  GltfFile file_;
  const tinygltf::Model& model_;
  const std::string& path_;
  Character out_;
  int64_t primitives_ = 0, vertices_ = 0;  // so far
  std::vector<int> node_of_;               // of each node of the file, its number here; -1: not in the scene
};

void CharacterReader::read_nodes() {
  const size_t count = model_.nodes.size();
  US_CHECK(count <= 100000, path_, ": has ", count, " nodes; 100000 are read at most");
  node_of_.assign(count, -1);
  std::vector<int> parents(count, -1);
  for (size_t n = 0; n < count; ++n)
    for (const int c : model_.nodes[n].children) {
      US_CHECK(static_cast<size_t>(c) < count, path_, ": node ", n, " has a child that does not exist");
      US_CHECK(parents[c] < 0, path_, ": node ", c, " is a child of two nodes");
      parents[c] = static_cast<int>(n);
    }
  order_nodes(parents);
  out_.nodes.resize(count);
  for (size_t n = 0; n < count; ++n) {
    const tinygltf::Node& from = model_.nodes[n];
    CharacterNode& node = out_.nodes[node_of_[n]];
    node.name = from.name;
    node.parent = parents[n] < 0 ? -1 : node_number(parents[n]);
    node.local = Transform::from(gltf_local_transform(file_, from));
    if (!from.scale.empty())
      node.local.scale = Vec3(narrow(from.scale[0]), narrow(from.scale[1]), narrow(from.scale[2]));
  }
}

// Numbers for the nodes, parents first: the file's own where they are so already.
void CharacterReader::order_nodes(const std::vector<int>& parents) {
  const int count = static_cast<int>(parents.size());
  std::vector<int> depth(parents.size(), 0);
  bool in_order = true;
  for (int n = 0; n < count; ++n) {
    for (int p = n; p >= 0 && depth[n] <= count; p = parents[p]) ++depth[n];
    US_CHECK(depth[n] <= count, path_, ": its nodes go round in a circle");
    US_CHECK(depth[n] <= kMaxNodeDepth, path_, ": its nodes are more than 1000 levels deep");
    in_order = in_order && parents[n] < n;
  }
  std::vector<size_t> order(parents.size());
  std::iota(order.begin(), order.end(), size_t{0});
  if (!in_order)
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return depth[a] < depth[b]; });
  for (size_t i = 0; i < order.size(); ++i) node_of_[order[i]] = static_cast<int>(i);
}

void CharacterReader::read_skins() {
  US_CHECK(model_.skins.size() <= kMostParts, path_, ": has ", model_.skins.size(), " skins; ", kMostParts,
           " are read at most");
  for (const tinygltf::Skin& from : model_.skins) {
    CharacterSkin skin;
    skin.name = from.name;
    for (const int joint : from.joints) skin.joints.push_back(node_number(joint));
    const std::vector<float> matrices = file_.inverse_bind(from);
    std::vector<int> sorted = skin.joints;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    US_CHECK(twice == sorted.end(), path_, ": a skin names the bone '", excerpt(out_.nodes[*twice].name),
             "' twice");
    skin.inverse_bind.assign(skin.joints.size(), Mat4::Identity());
    for (size_t j = 0; j < skin.joints.size() && !matrices.empty(); ++j)
      skin.inverse_bind[j] = Eigen::Map<const Mat4>(matrices.data() + 16 * j);
    out_.skins.push_back(std::move(skin));
  }
}

RowMatrix CharacterReader::rows(int accessor, int parts, const char* what, Eigen::Index count) {
  const GltfAccessor values = file_.accessor(accessor);
  US_CHECK(values.parts == parts && (count < 0 || values.count == count), path_, ": the ", what,
           " of a primitive are not ", count, " times ", parts, " numbers");
  return Eigen::Map<const RowMatrix>(values.values.data(), values.count, parts);
}

void CharacterReader::read_attributes(const Attributes& attributes, CharacterPart& part) {
  part.vertices = rows(attributes.at("POSITION"), 3, "positions", -1);
  const Eigen::Index count = part.vertices.rows();
  if (attributes.count("NORMAL")) part.normals = rows(attributes.at("NORMAL"), 3, "normals", count);
  if (attributes.count("TANGENT")) part.tangents = rows(attributes.at("TANGENT"), 4, "tangents", count);
  for (int i = 0; i < 8; ++i) {
    const std::string name = "TEXCOORD_" + std::to_string(i);
    if (attributes.count(name) == 0) break;
    part.uvs.push_back(rows(attributes.at(name), 2, "texture coordinates", count));
  }
  if (attributes.count("COLOR_0") == 0) return;
  const GltfAccessor colors = file_.accessor(attributes.at("COLOR_0"));
  US_CHECK((colors.parts == 3 || colors.parts == 4) && colors.count == count, path_,
           ": the colours of a primitive are not one a vertex");
  part.colors = RowMatrix::Ones(count, 4);
  part.colors.leftCols(colors.parts) =
      Eigen::Map<const RowMatrix>(colors.values.data(), colors.count, colors.parts);
}

void CharacterReader::read_influences(const Attributes& attributes, CharacterPart& part) {
  const Eigen::Index count = part.vertices.rows();
  US_CHECK(attributes.count("JOINTS_0") && attributes.count("WEIGHTS_0"), path_, ": the part '", part.name,
           "' has a skin but no weights");
  const int sets = attributes.count("JOINTS_1") && attributes.count("WEIGHTS_1") ? 2 : 1;
  part.joints.setZero(count, 4 * sets);
  part.weights.setZero(count, 4 * sets);
  for (int s = 0; s < sets; ++s) {
    const std::string end = std::to_string(s);
    const RowMatrix joints = rows(attributes.at("JOINTS_" + end), 4, "joints of the skin", count);
    part.joints.middleCols(4 * s, 4) = joints.cast<int>();
    part.weights.middleCols(4 * s, 4) = rows(attributes.at("WEIGHTS_" + end), 4, "skin weights", count);
  }
  US_CHECK(part.weights.allFinite() && (count == 0 || part.weights.minCoeff() >= 0), path_,
           ": a skin weight of the part '", part.name, "' is negative or not finite");
  for (Eigen::Index v = 0; v < count; ++v) {
    const float sum = part.weights.row(v).sum();
    if (sum > 1e-8f && std::abs(sum - 1) > 1e-6f) part.weights.row(v) /= sum;
    if (sum <= 1e-8f) part.weights(v, 0) = 1;  // bound to nothing: to its first bone
  }
  part.weights = weights_of_bones(part);
  part.joints = (part.weights.array() > 0).select(part.joints, 0);  // numbers without a weight mean nothing
}

void CharacterReader::read_shapes(const tinygltf::Primitive& primitive, CharacterPart& part) {
  US_CHECK(primitive.targets.size() <= 1000, path_, ": the part '", part.name, "' has ",
           primitive.targets.size(), " morph targets");
  for (const Attributes& target : primitive.targets) {
    const auto positions = target.find("POSITION");
    part.shapes.push_back(positions == target.end()
                              ? Points::Zero(part.vertices.rows(), 3)
                              : Points(rows(positions->second, 3, "morph targets", part.vertices.rows())));
  }
}

void CharacterReader::read_primitive(const tinygltf::Primitive& primitive, CharacterPart part) {
  US_CHECK(++primitives_ <= kMostPrimitives, path_, ": has too many primitives");
  if (!file_.is_shown(primitive)) return;
  part.material = std::min(primitive.material, 1 << 30);
  read_attributes(primitive.attributes, part);
  if (part.skin >= 0) read_influences(primitive.attributes, part);
  part.faces = file_.faces(primitive, part.vertices.rows());
  read_shapes(primitive, part);
  vertices_ += part.vertices.rows();
  US_CHECK(vertices_ <= 16000000, path_, ": has more than 16 million vertices");
  US_CHECK(out_.parts.size() < kMostParts, path_, ": has more than ", kMostParts, " parts");
  out_.parts.push_back(std::move(part));
}

void CharacterReader::read_mesh(const tinygltf::Node& node, int to) {
  const tinygltf::Mesh& mesh = file_.item(model_.meshes, node.mesh, "meshes");
  CharacterPart part;
  part.name = mesh.name;
  part.node = to;
  part.skin = node.skin;
  if (node.skin >= 0) file_.item(model_.skins, node.skin, "skins");
  size_t shapes = 0;
  for (const auto& primitive : mesh.primitives) {
    read_primitive(primitive, part);
    if (!out_.parts.empty()) shapes = std::max(shapes, out_.parts.back().shapes.size());
  }
  std::vector<float>& weights = out_.nodes[to].shape_weights;
  for (const double weight : node.weights.empty() ? mesh.weights : node.weights)
    weights.push_back(narrow(weight));
  weights.resize(shapes, 0.0f);
}

void CharacterReader::read_images() {
  for (const tinygltf::Image& from : model_.images) {
    CharacterImage image;
    image.name = from.name;
    const std::string what = "picture " + std::to_string(out_.images.size());
    if (from.bufferView >= 0) {
      image.bytes = std::string(file_.view_bytes(from.bufferView));
      file_.spend(image.bytes.size());
    } else if (!from.image.empty()) {
      image.bytes.assign(from.image.begin(), from.image.end());
    } else {
      if (image.name.empty()) image.name = std::filesystem::path(from.uri).stem().string();
      image.bytes = picture_or_white([&] { return file_.uri_bytes(from.uri, what); },
                                     path_ + ": " + what + " (" + excerpt(from.uri) + ")");
    }
    image.mime = picture_type(image.bytes);
    US_CHECK(!image.mime.empty(), path_, ": ", what, image.name.empty() ? "" : " '" + image.name + "'",
             " is not a picture (PNG, JPEG, WebP or KTX2)");
    out_.images.push_back(std::move(image));
  }
}

// Whether this is an object that names number `key` of a list of `count`, or does not name any.
void check_index(const Json& object, const char* key, size_t count, const std::string& path) {
  const auto found = object.find(key);
  if (found == object.end()) return;
  US_CHECK(found->is_number_integer() && found->get<int64_t>() >= 0 &&
               found->get<int64_t>() < static_cast<int64_t>(count),
           path, ": a texture names number ", found->dump(), " of its ", count, " ", key, "s");
}

void CharacterReader::keep_extensions(const Json& value, std::set<std::string>& found) const {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      if (key == "extensions" && inner.is_object())
        for (const auto& extension : inner.items()) found.insert(extension.key());
      if (ends_with(key, "Texture") && inner.is_object())
        check_index(inner, "index", file_.kept("textures").size(), path_);
    }
  }
  if (value.is_structured())
    for (const auto& inner : value) keep_extensions(inner, found);
}

void CharacterReader::keep_texts(const char* name, std::vector<std::string>& out) {
  std::set<std::string> extensions(out_.extensions.begin(), out_.extensions.end());
  for (const Json& object : file_.kept(name)) {
    US_CHECK(object.is_object(), path_, ": number ", out.size(), " of its ", name, " is not an object");
    if (std::string_view(name) == "textures") {
      check_index(object, "source", out_.images.size(), path_);
      check_index(object, "sampler", file_.kept("samplers").size(), path_);
      for (const auto& extension : object.value("extensions", Json::object()))
        if (extension.is_object()) check_index(extension, "source", out_.images.size(), path_);
    }
    const std::string text = object.dump(-1, ' ', false, Json::error_handler_t::replace);
    US_CHECK(text.size() <= 1000000, path_, ": number ", out.size(), " of its ", name, " is too long");
    keep_extensions(object, extensions);
    out.push_back(text);
  }
  out_.extensions.assign(extensions.begin(), extensions.end());
  out_.required.clear();
  for (const auto& required : file_.kept("extensionsRequired"))
    if (required.is_string() && extensions.erase(required.get<std::string>()) > 0)
      out_.required.push_back(required.get<std::string>());
}

TrackPath track_path(const std::string& name, const std::string& path) {
  const auto known = std::find(kTrackPaths.begin(), kTrackPaths.end(), name);
  US_CHECK(known != kTrackPaths.end(), path, ": an animation moves '", excerpt(name), "', which no node has");
  return static_cast<TrackPath>(known - kTrackPaths.begin());
}

void CharacterReader::read_channel(const tinygltf::AnimationChannel& channel,
                                   const std::vector<tinygltf::AnimationSampler>& samplers,
                                   CharacterAnimation& out) {
  if (channel.target_node < 0 || channel.target_path == "pointer") return;
  CharacterTrack track;
  track.node = node_number(channel.target_node);
  track.path = track_path(channel.target_path, path_);
  const tinygltf::AnimationSampler& sampler = file_.item(samplers, channel.sampler, "samplers");
  track.interpolation = sampler.interpolation == "STEP"          ? TrackInterpolation::Step
                        : sampler.interpolation == "CUBICSPLINE" ? TrackInterpolation::Cubic
                                                                 : TrackInterpolation::Linear;
  track.times = file_.accessor(sampler.input).values;
  track.values = file_.accessor(sampler.output).values;
  const size_t width = track.path == TrackPath::Rotation ? 4
                       : track.path == TrackPath::Shapes ? out_.nodes[track.node].shape_weights.size()
                                                         : 3;
  const size_t wanted =
      track.times.size() * width * (track.interpolation == TrackInterpolation::Cubic ? 3 : 1);
  US_CHECK(!track.times.empty() && track.values.size() == wanted, path_, ": an animation of the node '",
           out_.nodes[track.node].name, "' has ", track.values.size(), " numbers for ", track.times.size(),
           " keys");
  for (size_t i = 0; i < track.times.size(); ++i)
    US_CHECK(std::isfinite(track.times[i]) && (i == 0 || track.times[i] > track.times[i - 1]), path_,
             ": the times of an animation do not increase");
  for (const float value : track.values)
    US_CHECK(std::isfinite(value), path_, ": an animation has a number that is not finite");
  if (width > 0) out.tracks.push_back(std::move(track));
}

void CharacterReader::read_animations() {
  for (const tinygltf::Animation& from : model_.animations) {
    CharacterAnimation animation;
    animation.name = from.name;
    for (const auto& channel : from.channels) read_channel(channel, from.samplers, animation);
    out_.animations.push_back(std::move(animation));
  }
}

Character CharacterReader::read() {
  out_.name = std::filesystem::path(path_).stem().string();
  read_nodes();
  read_skins();
  read_images();
  keep_texts("samplers", out_.samplers);
  keep_texts("textures", out_.textures);
  keep_texts("materials", out_.materials);
  const GltfSceneNodes scene = walk_gltf_scene(file_);
  std::vector<int> order = scene.order;  // parts in the order of their nodes here
  std::sort(order.begin(), order.end(), [&](int a, int b) { return node_number(a) < node_number(b); });
  for (const int index : order) {
    const tinygltf::Node& node = model_.nodes[index];
    if (node.mesh >= 0) read_mesh(node, node_number(index));
  }
  read_animations();
  check_character(out_, path_);
  return std::move(out_);
}

}  // namespace

Character parse_gltf_character(std::string_view bytes, const std::string& path) {
  return CharacterReader(bytes, path).read();
}

}  // namespace understudy
