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

constexpr int kMaxDepth = 1000, kMostParts = 10000;
constexpr int64_t kMostPrimitives = 1000000;

std::string text_of(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

const Json& object_in(const Json& object, const char* name) {
  static const Json kEmpty = Json::object();
  const auto found = object.find(name);
  return found != object.end() && found->is_object() ? *found : kEmpty;
}

class CharacterReader {
 public:
  CharacterReader(std::string_view bytes, const std::string& path) : file_(bytes, path), path_(path) {}
  Character read();

 private:
  void read_nodes();
  void order_nodes(const std::vector<int64_t>& parents);
  void read_skins();
  void read_skin_joints(const Json& skin, CharacterSkin& out);
  void read_mesh(const Json& node, int to);
  void read_primitive(const Json& primitive, CharacterPart part);
  void read_attributes(const Json& attributes, CharacterPart& part);
  void read_influences(const Json& attributes, CharacterPart& part);
  void read_faces(const Json& primitive, int64_t mode, CharacterPart& part);
  void read_shapes(const Json& primitive, CharacterPart& part);
  void read_images();
  void keep_texts(const char* name, std::vector<std::string>& out);
  void keep_extensions(const Json& value, std::set<std::string>& found) const;
  void read_animations();
  void read_channel(const Json& channel, const Json& samplers, CharacterAnimation& out);
  RowMatrix rows(int64_t accessor, int parts, const char* what, Eigen::Index count);
  int node_number(int64_t index) const;

  GltfFile file_;
  const std::string& path_;
  Character out_;
  int64_t primitives_ = 0, vertices_ = 0;  // so far
  std::vector<int> node_of_;               // of each node of the file, its number here; -1: not in the scene
};

int CharacterReader::node_number(int64_t index) const {
  US_CHECK(index >= 0 && index < static_cast<int64_t>(node_of_.size()), path_, ": names number ", index,
           " of its ", node_of_.size(), " nodes");
  return node_of_[static_cast<size_t>(index)];
}

void CharacterReader::read_nodes() {
  const auto count = static_cast<int64_t>(file_.list("nodes").size());
  US_CHECK(count <= 100000, path_, ": has ", count, " nodes; 100000 are read at most");
  node_of_.assign(static_cast<size_t>(count), -1);
  std::vector<int64_t> parents(static_cast<size_t>(count), -1);
  for (int64_t n = 0; n < count; ++n) {
    const auto children = file_.item("nodes", n).find("children");
    if (children == file_.item("nodes", n).end()) continue;
    US_CHECK(children->is_array(), path_, ": the children of node ", n, " are no list");
    for (const auto& child : *children) {
      US_CHECK(child.is_number(), path_, ": a child of node ", n, " is no number");
      const int64_t c = whole(child.get<double>());
      US_CHECK(c >= 0 && c < count, path_, ": node ", n, " has a child that is not there");
      US_CHECK(parents[static_cast<size_t>(c)] < 0, path_, ": node ", c, " is a child of two nodes");
      parents[static_cast<size_t>(c)] = n;
    }
  }
  order_nodes(parents);
  out_.nodes.resize(static_cast<size_t>(count));
  for (int64_t n = 0; n < count; ++n) {
    const Json& object = file_.item("nodes", n);
    CharacterNode& node = out_.nodes[static_cast<size_t>(node_of_[static_cast<size_t>(n)])];
    const int64_t parent = parents[static_cast<size_t>(n)];
    node.name = text_of(object, "name");
    node.parent = parent < 0 ? -1 : node_of_[static_cast<size_t>(parent)];
    node.local = Transform::from(gltf_local_transform(file_, object));
    if (const auto s = file_.numbers(object, "scale", 3); !s.empty())
      node.local.scale = Vec3(s[0], s[1], s[2]);
  }
}

// Numbers for the nodes, parents first: the file's own where they are so already.
void CharacterReader::order_nodes(const std::vector<int64_t>& parents) {
  std::vector<int> depth(parents.size(), 0);
  bool in_order = true;
  for (size_t n = 0; n < parents.size(); ++n) {
    int steps = 1;
    for (int64_t p = parents[n]; p >= 0 && steps <= kMaxDepth; p = parents[static_cast<size_t>(p)]) ++steps;
    depth[n] = steps;
    in_order = in_order && parents[n] < static_cast<int64_t>(n);
  }
  for (size_t n = 0; n < parents.size(); ++n) {  // a way up without an end is a circle, or only long
    int64_t slow = static_cast<int64_t>(n), fast = slow;
    const auto up = [&](int64_t& at) { at = at < 0 ? at : parents[static_cast<size_t>(at)]; };
    if (depth[n] <= kMaxDepth) continue;
    do {
      up(slow);
      up(fast);
      up(fast);
    } while (fast >= 0 && slow != fast);
    US_CHECK(fast < 0, path_, ": its nodes go round in a circle");
    throw Error(path_ + ": its nodes are more than 1000 levels deep");
  }
  std::vector<size_t> order(parents.size());
  std::iota(order.begin(), order.end(), size_t{0});
  if (!in_order)
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return depth[a] < depth[b]; });
  for (size_t i = 0; i < order.size(); ++i) node_of_[order[i]] = static_cast<int>(i);
}

void CharacterReader::read_skin_joints(const Json& skin, CharacterSkin& out) {
  const auto joints = skin.find("joints");
  US_CHECK(joints != skin.end() && joints->is_array() && !joints->empty(), path_, ": a skin has no joints");
  for (const auto& joint : *joints) {
    US_CHECK(joint.is_number(), path_, ": a joint of a skin is no number");
    out.joints.push_back(node_number(whole(joint.get<double>())));
  }
  std::vector<int> sorted = out.joints;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  US_CHECK(twice == sorted.end(), path_, ": a skin names the bone '",
           excerpt(out_.nodes[static_cast<size_t>(*twice)].name), "' twice");
}

void CharacterReader::read_skins() {
  const auto count = static_cast<int64_t>(file_.list("skins").size());
  US_CHECK(count <= kMostParts, path_, ": has ", count, " skins; ", kMostParts, " are read at most");
  for (int64_t s = 0; s < count; ++s) {
    const Json& object = file_.item("skins", s);
    CharacterSkin skin;
    skin.name = text_of(object, "name");
    read_skin_joints(object, skin);
    if (object.contains("inverseBindMatrices")) {
      const GltfAccessor matrices = file_.accessor(file_.integer(object, "inverseBindMatrices", -1));
      US_CHECK(matrices.parts == 16 && static_cast<size_t>(matrices.count) >= skin.joints.size(), path_,
               ": a skin has fewer bind matrices than joints");
      for (size_t j = 0; j < skin.joints.size(); ++j)
        skin.inverse_bind.push_back(Eigen::Map<const Mat4>(matrices.values.data() + 16 * j));
    } else {
      skin.inverse_bind.assign(skin.joints.size(), Mat4::Identity());
    }
    out_.skins.push_back(std::move(skin));
  }
}

RowMatrix CharacterReader::rows(int64_t accessor, int parts, const char* what, Eigen::Index count) {
  const GltfAccessor values = file_.accessor(accessor);
  US_CHECK(values.parts == parts && (count < 0 || values.count == count), path_, ": the ", what,
           " of a primitive are not ", count, " times ", parts, " numbers");
  return Eigen::Map<const RowMatrix>(values.values.data(), values.count, parts);
}

void CharacterReader::read_attributes(const Json& attributes, CharacterPart& part) {
  part.vertices = rows(file_.integer(attributes, "POSITION", -1), 3, "positions", -1);
  const Eigen::Index count = part.vertices.rows();
  if (attributes.contains("NORMAL"))
    part.normals = rows(file_.integer(attributes, "NORMAL", -1), 3, "normals", count);
  if (attributes.contains("TANGENT"))
    part.tangents = rows(file_.integer(attributes, "TANGENT", -1), 4, "tangents", count);
  for (int i = 0; i < 8; ++i) {
    const std::string name = "TEXCOORD_" + std::to_string(i);
    if (!attributes.contains(name)) break;
    part.uvs.push_back(rows(file_.integer(attributes, name.c_str(), -1), 2, "texture coordinates", count));
  }
  if (!attributes.contains("COLOR_0")) return;
  const GltfAccessor colors = file_.accessor(file_.integer(attributes, "COLOR_0", -1));
  US_CHECK((colors.parts == 3 || colors.parts == 4) && colors.count == count, path_,
           ": the colours of a primitive are not one a vertex");
  part.colors = RowMatrix::Ones(count, 4);
  part.colors.leftCols(colors.parts) =
      Eigen::Map<const RowMatrix>(colors.values.data(), colors.count, colors.parts);
}

void CharacterReader::read_influences(const Json& attributes, CharacterPart& part) {
  const Eigen::Index count = part.vertices.rows();
  US_CHECK(attributes.contains("JOINTS_0") && attributes.contains("WEIGHTS_0"), path_, ": the part '",
           part.name, "' has a skin but no weights");
  const int sets = attributes.contains("JOINTS_1") && attributes.contains("WEIGHTS_1") ? 2 : 1;
  part.joints.setZero(count, 4 * sets);
  part.weights.setZero(count, 4 * sets);
  for (int s = 0; s < sets; ++s) {
    const std::string end = std::to_string(s);
    const RowMatrix joints =
        rows(file_.integer(attributes, ("JOINTS_" + end).c_str(), -1), 4, "joints of the skin", count);
    part.joints.middleCols(4 * s, 4) = joints.cast<int>();
    part.weights.middleCols(4 * s, 4) =
        rows(file_.integer(attributes, ("WEIGHTS_" + end).c_str(), -1), 4, "skin weights", count);
  }
  US_CHECK(part.weights.allFinite() && (count == 0 || part.weights.minCoeff() >= 0), path_,
           ": a skin weight of the part '", part.name, "' is negative or not finite");
  for (Eigen::Index v = 0; v < count; ++v) {
    const float sum = part.weights.row(v).sum();
    if (sum > 1e-8f && std::abs(sum - 1) > 1e-6f) part.weights.row(v) /= sum;
    if (sum <= 1e-8f) part.weights(v, 0) = 1;  // bound to nothing: to its first bone
    for (Eigen::Index k = 0; k < part.joints.cols(); ++k) {
      for (Eigen::Index i = 0; i < k; ++i)  // a bone named twice counts once
        if (part.weights(v, k) > 0 && part.joints(v, i) == part.joints(v, k) && part.weights(v, i) > 0) {
          part.weights(v, i) += part.weights(v, k);
          part.weights(v, k) = 0;
        }
      if (part.weights(v, k) == 0) part.joints(v, k) = 0;  // numbers without a weight mean nothing
    }
  }
}

void CharacterReader::read_faces(const Json& primitive, int64_t mode, CharacterPart& part) {
  const int64_t count = part.vertices.rows();
  std::vector<int64_t> c;
  if (primitive.contains("indices")) {
    const GltfAccessor indices = file_.accessor(file_.integer(primitive, "indices", -1));
    US_CHECK(indices.parts == 1, path_, ": the indices of a primitive are no single numbers");
    for (const float index : indices.values) {
      US_CHECK(index >= 0 && index < static_cast<float>(count), path_, ": a face names vertex ", index,
               " of a primitive of ", count);
      c.push_back(static_cast<int64_t>(index));
    }
  } else {
    for (int64_t i = 0; i < count; ++i) c.push_back(i);
  }
  FaceList faces;
  for (size_t i = 0; i + 2 < c.size(); i += mode == 4 ? 3 : 1) {
    const bool turn = mode == 5 && i % 2 == 1;
    faces.add(mode == 6 ? c[0] : c[i], c[i + (turn ? 2 : 1)], c[i + (turn ? 1 : 2)]);
  }
  part.faces = faces.finish(count, path_);
}

void CharacterReader::read_shapes(const Json& primitive, CharacterPart& part) {
  const auto targets = primitive.find("targets");
  if (targets == primitive.end() || !targets->is_array()) return;
  US_CHECK(targets->size() <= 1000, path_, ": the part '", part.name, "' has ", targets->size(),
           " morph targets");
  for (const auto& target : *targets) {
    US_CHECK(target.is_object(), path_, ": a morph target is no object");
    part.shapes.push_back(target.contains("POSITION") ? Points(rows(file_.integer(target, "POSITION", -1), 3,
                                                                    "morph targets", part.vertices.rows()))
                                                      : Points::Zero(part.vertices.rows(), 3));
  }
}

void CharacterReader::read_primitive(const Json& primitive, CharacterPart part) {
  US_CHECK(primitive.is_object() && ++primitives_ <= kMostPrimitives, path_,
           ": a primitive is no object, or there are too many");
  const int64_t mode = file_.integer(primitive, "mode", 4);
  const Json& attributes = object_in(primitive, "attributes");
  if ((mode != 0 && mode < 4) || mode > 6 || !attributes.contains("POSITION")) return;  // lines, or nothing
  part.material = static_cast<int>(std::min<int64_t>(file_.integer(primitive, "material", -1), 1 << 30));
  read_attributes(attributes, part);
  if (part.skin >= 0) read_influences(attributes, part);
  if (mode != 0) read_faces(primitive, mode, part);
  read_shapes(primitive, part);
  vertices_ += part.vertices.rows();
  US_CHECK(vertices_ <= 16000000, path_, ": has more than 16 million vertices");
  US_CHECK(out_.parts.size() < kMostParts, path_, ": has more than ", kMostParts, " parts");
  out_.parts.push_back(std::move(part));
}

void CharacterReader::read_mesh(const Json& node, int to) {
  const Json& mesh = file_.item("meshes", file_.integer(node, "mesh", -1));
  CharacterPart part;
  part.name = text_of(mesh, "name");
  part.node = to;
  if (node.contains("skin")) {
    const int64_t skin = file_.integer(node, "skin", -1);
    file_.item("skins", skin);
    part.skin = static_cast<int>(skin);
  }
  const auto primitives = mesh.find("primitives");
  if (primitives == mesh.end() || !primitives->is_array()) return;
  size_t shapes = 0;
  for (const auto& primitive : *primitives) {
    read_primitive(primitive, part);
    if (!out_.parts.empty()) shapes = std::max(shapes, out_.parts.back().shapes.size());
  }
  std::vector<float>& weights = out_.nodes[static_cast<size_t>(to)].shape_weights;
  const Json& from = node.contains("weights") ? node : mesh;
  if (from.contains("weights")) weights = file_.numbers(from, "weights", from["weights"].size());
  weights.resize(shapes, 0.0f);
}

void CharacterReader::read_images() {
  for (int64_t i = 0; i < static_cast<int64_t>(file_.list("images").size()); ++i) {
    const Json& object = file_.item("images", i);
    CharacterImage image;
    image.name = text_of(object, "name");
    const std::string what = "picture " + std::to_string(i), uri = text_of(object, "uri");
    if (object.contains("bufferView")) {
      const std::string_view bytes = file_.view_bytes(file_.integer(object, "bufferView", -1));
      file_.spend(bytes.size());
      image.bytes = std::string(bytes);
    } else {
      const bool is_data = starts_with(uri, "data:");
      if (image.name.empty() && !is_data) image.name = std::filesystem::path(uri).stem().string();
      image.bytes = is_data ? file_.uri_bytes(uri, what)
                            : picture_or_white([&] { return file_.uri_bytes(uri, what); },
                                               path_ + ": " + what + " (" + excerpt(uri) + ")");
    }
    image.mime = picture_type(image.bytes);
    US_CHECK(!image.mime.empty(), path_, ": ", what, image.name.empty() ? "" : " '" + image.name + "'",
             " is no picture (PNG, JPEG, WebP or KTX2)");
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
        check_index(inner, "index", file_.list("textures").size(), path_);
    }
  }
  if (value.is_structured())
    for (const auto& inner : value) keep_extensions(inner, found);
}

void CharacterReader::keep_texts(const char* name, std::vector<std::string>& out) {
  std::set<std::string> extensions(out_.extensions.begin(), out_.extensions.end());
  for (int64_t i = 0; i < static_cast<int64_t>(file_.list(name).size()); ++i) {
    const Json& object = file_.item(name, i);
    if (std::string_view(name) == "textures") {
      check_index(object, "source", out_.images.size(), path_);
      check_index(object, "sampler", file_.list("samplers").size(), path_);
      for (const auto& extension : object_in(object, "extensions"))
        if (extension.is_object()) check_index(extension, "source", out_.images.size(), path_);
    }
    const std::string text = object.dump(-1, ' ', false, Json::error_handler_t::replace);
    US_CHECK(text.size() <= 1000000, path_, ": number ", i, " of its ", name, " is too long");
    keep_extensions(object, extensions);
    out.push_back(text);
  }
  out_.extensions.assign(extensions.begin(), extensions.end());
  out_.required.clear();
  for (const auto& required : file_.list("extensionsRequired"))
    if (required.is_string() && extensions.erase(required.get<std::string>()) > 0)
      out_.required.push_back(required.get<std::string>());
}

TrackPath track_path(const std::string& name, const std::string& path) {
  if (name == "translation") return TrackPath::Translation;
  if (name == "rotation") return TrackPath::Rotation;
  if (name == "scale") return TrackPath::Scale;
  US_CHECK(name == "weights", path, ": an animation moves '", excerpt(name), "', which no node has");
  return TrackPath::Shapes;
}

void CharacterReader::read_channel(const Json& channel, const Json& samplers, CharacterAnimation& out) {
  US_CHECK(channel.is_object(), path_, ": an animation's channel is no object");
  const Json& target = object_in(channel, "target");
  if (!target.contains("node") || text_of(target, "path") == "pointer") return;
  CharacterTrack track;
  track.node = node_number(file_.integer(target, "node", -1));
  track.path = track_path(text_of(target, "path"), path_);
  const int64_t index = file_.integer(channel, "sampler", -1);
  US_CHECK(samplers.is_array() && index >= 0 && index < static_cast<int64_t>(samplers.size()) &&
               samplers[static_cast<size_t>(index)].is_object(),
           path_, ": an animation names a sampler that is not there");
  const Json& sampler = samplers[static_cast<size_t>(index)];
  const std::string kind = text_of(sampler, "interpolation");
  track.interpolation = kind == "STEP"          ? TrackInterpolation::Step
                        : kind == "CUBICSPLINE" ? TrackInterpolation::Cubic
                                                : TrackInterpolation::Linear;
  track.times = file_.accessor(file_.integer(sampler, "input", -1)).values;
  track.values = file_.accessor(file_.integer(sampler, "output", -1)).values;
  const size_t width = track.path == TrackPath::Rotation ? 4
                       : track.path == TrackPath::Shapes
                           ? out_.nodes[static_cast<size_t>(track.node)].shape_weights.size()
                           : 3;
  const size_t wanted =
      track.times.size() * width * (track.interpolation == TrackInterpolation::Cubic ? 3 : 1);
  US_CHECK(!track.times.empty() && track.values.size() == wanted, path_, ": an animation of the node '",
           out_.nodes[static_cast<size_t>(track.node)].name, "' has ", track.values.size(), " numbers for ",
           track.times.size(), " keys");
  for (size_t i = 0; i < track.times.size(); ++i)
    US_CHECK(std::isfinite(track.times[i]) && (i == 0 || track.times[i] > track.times[i - 1]), path_,
             ": the times of an animation do not increase");
  for (const float value : track.values)
    US_CHECK(std::isfinite(value), path_, ": an animation has a number that is not finite");
  if (width > 0) out.tracks.push_back(std::move(track));
}

void CharacterReader::read_animations() {
  for (int64_t a = 0; a < static_cast<int64_t>(file_.list("animations").size()); ++a) {
    const Json& object = file_.item("animations", a);
    CharacterAnimation animation;
    animation.name = text_of(object, "name");
    const auto channels = object.find("channels"), samplers = object.find("samplers");
    if (channels != object.end() && channels->is_array() && samplers != object.end())
      for (const auto& channel : *channels) read_channel(channel, *samplers, animation);
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
  std::vector<int64_t> order = scene.order;  // parts in the order of their nodes here
  std::sort(order.begin(), order.end(),
            [&](int64_t a, int64_t b) { return node_number(a) < node_number(b); });
  for (const int64_t index : order) {
    const Json& node = file_.item("nodes", index);
    if (!node.contains("mesh")) continue;
    read_mesh(node, node_number(index));
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
