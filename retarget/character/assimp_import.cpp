#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

using nlohmann::json;

Mat4 matrix_of(const aiMatrix4x4& m) {
  return Eigen::Map<const Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>>(&m.a1).cast<float>();
}

Points rows_of(const aiVector3D* vectors, unsigned count) {
  Points out(count, 3);
  for (unsigned i = 0; i < count; ++i) out.row(i) << vectors[i].x, vectors[i].y, vectors[i].z;
  return out;
}

class AssimpConverter {
 public:
  AssimpConverter(const aiScene& scene, const std::string& path) : scene_(scene), path_(path) {}
  Character convert();

 private:
  void add_nodes();
  void add_part(const aiMesh& mesh, int node);
  void add_skin(const aiMesh& mesh, CharacterPart& part);
  void add_material(const aiMaterial& material);
  void add_animation(const aiAnimation& animation);
  int add_texture(const std::string& name);
  std::string texture_bytes(const std::string& name) const;

  const aiScene& scene_;
  const std::string& path_;
  Character out_;
  std::vector<const aiNode*> nodes_;
  std::map<std::string, int> node_by_name_, texture_by_name_;
  std::map<int, int> skin_of_node_;
};

void AssimpConverter::add_nodes() {
  std::vector<std::pair<const aiNode*, int>> open = {{scene_.mRootNode, -1}};
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    const int at = out_.nodes.size();
    US_CHECK(at < 100000, path_, ": has more than 100000 nodes");
    node_by_name_.try_emplace(node->mName.C_Str(), at);
    out_.nodes.push_back(
        {node->mName.C_Str(), parent, Transform::from(matrix_of(node->mTransformation)), {}});
    nodes_.push_back(node);
    for (unsigned c = node->mNumChildren; c-- > 0;) open.emplace_back(node->mChildren[c], at);
  }
}

void AssimpConverter::add_skin(const aiMesh& mesh, CharacterPart& part) {
  const auto [entry, is_new] = skin_of_node_.try_emplace(part.node, out_.skins.size());
  if (is_new) out_.skins.emplace_back();
  part.skin = entry->second;
  CharacterSkin& skin = out_.skins[part.skin];
  std::vector<std::vector<std::pair<float, int>>> influences(mesh.mNumVertices);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto node = node_by_name_.find(bone.mName.C_Str());
    US_CHECK(node != node_by_name_.end(), path_, ": a skin names the bone '", excerpt(bone.mName.C_Str()),
             "', which does not exist");
    auto joint = std::find(skin.joints.begin(), skin.joints.end(), node->second);
    if (joint == skin.joints.end()) {
      joint = skin.joints.insert(skin.joints.end(), node->second);
      skin.inverse_bind.push_back(matrix_of(bone.mOffsetMatrix));
    }
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      US_CHECK(weight.mVertexId < mesh.mNumVertices, path_, ": a skin names a vertex that does not exist");
      if (weight.mWeight > 0)
        influences[weight.mVertexId].emplace_back(weight.mWeight,
                                                  static_cast<int>(joint - skin.joints.begin()));
    }
  }
  part.joints.setZero(mesh.mNumVertices, 8);
  part.weights.setZero(mesh.mNumVertices, 8);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    auto& list = influences[v];
    std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    float sum = 0;
    for (size_t k = 0; k < std::min<size_t>(8, list.size()); ++k) sum += list[k].first;
    for (size_t k = 0; k < std::min<size_t>(8, list.size()); ++k) {
      part.joints(v, k) = list[k].second;
      part.weights(v, k) = list[k].first / sum;
    }
    if (list.empty()) part.weights(v, 0) = 1;
  }
  if ((part.weights.rightCols(4).array() == 0).all()) {
    part.joints = part.joints.leftCols(4).eval();
    part.weights = part.weights.leftCols(4).eval();
  }
}

void AssimpConverter::add_part(const aiMesh& mesh, int node) {
  if (mesh.mNumVertices == 0) return;
  CharacterPart part;
  part.name = mesh.mName.C_Str();
  part.node = node;
  part.material = static_cast<int>(mesh.mMaterialIndex);
  part.vertices = rows_of(mesh.mVertices, mesh.mNumVertices);
  if (mesh.HasNormals()) part.normals = rows_of(mesh.mNormals, mesh.mNumVertices);
  for (unsigned set = 0; set < mesh.GetNumUVChannels(); ++set) {
    RowMatrix uv = rows_of(mesh.mTextureCoords[set], mesh.mNumVertices).leftCols<2>();
    uv.col(1) = 1 - uv.col(1).array();  // counted from below there, from above in glTF
    part.uvs.push_back(uv);
  }
  if (mesh.HasVertexColors(0)) {
    part.colors.resize(mesh.mNumVertices, 4);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiColor4D& c = mesh.mColors[0][v];
      part.colors.row(v) << c.r, c.g, c.b, c.a;
    }
  }
  std::vector<int> corners;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f)
    if (mesh.mFaces[f].mNumIndices == 3)
      for (int c = 0; c < 3; ++c) corners.push_back(static_cast<int>(mesh.mFaces[f].mIndices[c]));
  part.faces = Eigen::Map<const Faces>(corners.data(), corners.size() / 3, 3);
  for (unsigned s = 0; s < mesh.mNumAnimMeshes; ++s)
    if (mesh.mAnimMeshes[s]->HasPositions() && mesh.mAnimMeshes[s]->mNumVertices == mesh.mNumVertices)
      part.shapes.push_back(rows_of(mesh.mAnimMeshes[s]->mVertices, mesh.mNumVertices) - part.vertices);
  auto& weights = out_.nodes[node].shape_weights;
  weights.resize(std::max(weights.size(), part.shapes.size()), 0.0f);
  if (mesh.HasBones()) add_skin(mesh, part);
  out_.parts.push_back(std::move(part));
}

std::string AssimpConverter::texture_bytes(const std::string& name) const {
  if (const aiTexture* inside = scene_.GetEmbeddedTexture(name.c_str()); inside != nullptr) {
    if (inside->mHeight == 0) return {reinterpret_cast<const char*>(inside->pcData), inside->mWidth};
    return {};
  }
  std::string file = name;
  std::replace(file.begin(), file.end(), '\\', '/');
  // Paths in these files are those of the machine they were made on: the file's own folder is what counts.
  const auto here = std::filesystem::path(path_).parent_path() / std::filesystem::path(file).filename();
  return picture_or_white([&] { return read_file(here.string()); }, path_ + ": the picture " + excerpt(name));
}

int AssimpConverter::add_texture(const std::string& name) {
  const auto [entry, is_new] = texture_by_name_.try_emplace(name, out_.textures.size());
  if (!is_new) return entry->second;
  if (!add_picture(name, texture_bytes(name), out_)) entry->second = -1;
  return entry->second;
}

void AssimpConverter::add_material(const aiMaterial& material) {
  aiString name, picture;
  aiColor4D color(0.8f, 0.8f, 0.8f, 1.0f);
  float alpha = 1;
  material.Get(AI_MATKEY_NAME, name);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  material.Get(AI_MATKEY_OPACITY, alpha);
  int texture = -1;
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &picture) == AI_SUCCESS ||
      material.GetTexture(aiTextureType_BASE_COLOR, 0, &picture) == AI_SUCCESS)
    texture = add_texture(picture.C_Str());
  const auto unit = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
  const Vec3 rgb(unit(color.r), unit(color.g), unit(color.b));
  const json object = plain_material(name.C_Str(), rgb, unit(alpha), texture);
  out_.materials.push_back(object.dump(-1, ' ', false, json::error_handler_t::replace));
}

/// The keys of one value of a node. Those at the same time as the one before, which some exporters write, go.
template <class Key, class Append>
void add_track(const Key* keys, unsigned count, CharacterTrack track, double ticks_per_second,
               CharacterAnimation& out, Append append) {
  for (unsigned k = 0; k < count; ++k) {
    const auto seconds = static_cast<float>(keys[k].mTime / ticks_per_second);
    if (!std::isfinite(seconds) || (!track.times.empty() && seconds <= track.times.back())) continue;
    track.times.push_back(seconds);
    append(keys[k].mValue, track.values);
  }
  if (!track.times.empty()) out.tracks.push_back(std::move(track));
}

void AssimpConverter::add_animation(const aiAnimation& animation) {
  CharacterAnimation out;
  out.name = animation.mName.C_Str();
  // assimp's own default
  const double ticks = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25;
  const auto place = [](const aiVector3D& v, std::vector<float>& to) {
    to.insert(to.end(), {v.x, v.y, v.z});
  };
  const auto turn = [](const aiQuaternion& q, std::vector<float>& to) {
    to.insert(to.end(), {q.x, q.y, q.z, q.w});
  };
  for (unsigned c = 0; c < animation.mNumChannels; ++c) {
    const aiNodeAnim& channel = *animation.mChannels[c];
    const auto node = node_by_name_.find(channel.mNodeName.C_Str());
    if (node == node_by_name_.end()) continue;
    CharacterTrack track;
    track.node = node->second;
    track.path = TrackPath::Translation;
    add_track(channel.mPositionKeys, channel.mNumPositionKeys, track, ticks, out, place);
    track.path = TrackPath::Rotation;
    add_track(channel.mRotationKeys, channel.mNumRotationKeys, track, ticks, out, turn);
    track.path = TrackPath::Scale;
    add_track(channel.mScalingKeys, channel.mNumScalingKeys, track, ticks, out, place);
  }
  if (!out.tracks.empty()) out_.animations.push_back(std::move(out));
}

Character AssimpConverter::convert() {
  US_CHECK(scene_.mRootNode != nullptr && (scene_.mNumMeshes > 0 || scene_.mNumAnimations > 0),
           "it holds neither a mesh nor an animation");
  out_.name = std::filesystem::path(path_).stem().string();
  for (unsigned m = 0; m < scene_.mNumMaterials; ++m) add_material(*scene_.mMaterials[m]);
  add_nodes();
  for (size_t n = 0; n < nodes_.size(); ++n)
    for (unsigned m = 0; m < nodes_[n]->mNumMeshes; ++m) add_part(*scene_.mMeshes[nodes_[n]->mMeshes[m]], n);
  for (unsigned a = 0; a < scene_.mNumAnimations; ++a) add_animation(*scene_.mAnimations[a]);
  // A node has one skin: meshes without bones beside others with bones follow the first.
  for (auto& part : out_.parts) {
    const auto skin = skin_of_node_.find(part.node);
    if (part.skin >= 0 || skin == skin_of_node_.end()) continue;
    part.skin = skin->second;
    part.joints.setZero(part.vertices.rows(), 4);
    part.weights.setZero(part.vertices.rows(), 4);
    part.weights.col(0).setOnes();
  }
  check_character(out_, path_);
  return std::move(out_);
}

}  // namespace

Character import_by_assimp(const std::string& path) {
  check_file(path);
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                                     aiProcess_SortByPType | aiProcess_GenNormals);
  US_CHECK(scene != nullptr, importer.GetErrorString());
  return AssimpConverter(*scene, path).convert();
}

}  // namespace understudy
