#include "tests/interop/assimp_scene.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <map>
#include <utility>

#include "retarget/base/error.hpp"

namespace understudy::tests {
namespace {

/// Two keys and how far between them a time is.
template <class Key>
struct Between {
  const Key *a, *b;
  float u;
};
template <class Key>
Between<Key> between(const Key* keys, unsigned count, double ticks) {
  const Key* above = std::upper_bound(keys, keys + count, ticks,
                                      [](double time, const Key& key) { return time < key.mTime; });
  if (above == keys) return {keys, keys, 0};
  if (above == keys + count) return {above - 1, above - 1, 0};
  return {above - 1, above, static_cast<float>((ticks - above[-1].mTime) / (above->mTime - above[-1].mTime))};
}

}  // namespace

struct AssimpScene::Impl {
 public:
  Impl(const std::string& path, Character file)
      : file_(std::move(file)), scene_(importer_.ReadFile(path, 0)) {
    US_CHECK(scene_ != nullptr, path, ": ", importer_.GetErrorString());
  }
  /// [V, 3], meshes in the order of our nodes.
  Points at(int clip, float seconds) {
    const aiAnimation& animation = *scene_->mAnimations[clip];
    const double per_second = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 1;
    worlds_.clear();
    place(*scene_->mRootNode, aiMatrix4x4(), animation, seconds * per_second);
    std::vector<float> values;
    for (const CharacterNode& named : file_.nodes) {
      const aiNode* node = scene_->mRootNode->FindNode(named.name.c_str());
      for (unsigned i = 0; node != nullptr && i < node->mNumMeshes; ++i) {
        const aiMesh& mesh = *scene_->mMeshes[node->mMeshes[i]];
        for (const aiVector3D& v :
             skinned(mesh, *node, morphed(mesh, *node, animation, seconds * per_second)))
          values.insert(values.end(), {v.x, v.y, v.z});
      }
    }
    return Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
  }
  unsigned clip_count() const { return scene_->mNumAnimations; }

 private:
  void place(const aiNode& node, const aiMatrix4x4& above, const aiAnimation& animation, double ticks) {
    const aiMatrix4x4 world = above * local(node, animation, ticks);
    worlds_[node.mName.C_Str()] = world;
    for (unsigned i = 0; i < node.mNumChildren; ++i) place(*node.mChildren[i], world, animation, ticks);
  }
  static aiMatrix4x4 local(const aiNode& node, const aiAnimation& animation, double ticks) {
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
      const aiNodeAnim& channel = *animation.mChannels[c];
      if (channel.mNodeName != node.mName) continue;
      const auto s = between(channel.mScalingKeys, channel.mNumScalingKeys, ticks);
      const auto t = between(channel.mPositionKeys, channel.mNumPositionKeys, ticks);
      const auto r = between(channel.mRotationKeys, channel.mNumRotationKeys, ticks);
      aiQuaternion q;
      aiQuaternion::Interpolate(q, r.a->mValue, r.b->mValue, r.u);
      return {s.a->mValue + (s.b->mValue - s.a->mValue) * s.u, q.Normalize(),
              t.a->mValue + (t.b->mValue - t.a->mValue) * t.u};
    }
    return node.mTransformation;
  }
  static std::vector<aiVector3D> morphed(const aiMesh& mesh, const aiNode& node, const aiAnimation& animation,
                                         double ticks) {
    std::vector<aiVector3D> out(mesh.mVertices, mesh.mVertices + mesh.mNumVertices);
    std::vector<double> weights(mesh.mNumAnimMeshes, 0);
    for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i)
      weights[i] = static_cast<double>(mesh.mAnimMeshes[i]->mWeight);
    for (unsigned c = 0; c < animation.mNumMorphMeshChannels; ++c) {
      const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[c];
      if (channel.mName != node.mName) continue;
      const auto k = between(channel.mKeys, channel.mNumKeys, ticks);
      for (unsigned i = 0; i < k.a->mNumValuesAndWeights; ++i)
        weights[k.a->mValues[i]] =
            k.a->mWeights[i] + (k.b->mWeights[i] - k.a->mWeights[i]) * static_cast<double>(k.u);
    }
    for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i)
      for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        out[v] += (mesh.mAnimMeshes[i]->mVertices[v] - mesh.mVertices[v]) * static_cast<ai_real>(weights[i]);
    return out;
  }
  std::vector<aiVector3D> skinned(const aiMesh& mesh, const aiNode& node,
                                  const std::vector<aiVector3D>& rest) const {
    std::vector<aiVector3D> out(rest.size());
    if (!mesh.HasBones()) {
      for (size_t v = 0; v < rest.size(); ++v) out[v] = worlds_.at(node.mName.C_Str()) * rest[v];
      return out;
    }
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const aiMatrix4x4 M = worlds_.at(bone.mName.C_Str()) * bone.mOffsetMatrix;
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight& weight = bone.mWeights[w];
        out[weight.mVertexId] += M * rest[weight.mVertexId] * weight.mWeight;
      }
    }
    return out;
  }

  Character file_;
  Assimp::Importer importer_;
  const aiScene* scene_;
  std::map<std::string, aiMatrix4x4> worlds_;
};

AssimpScene::AssimpScene(const std::string& path, const Character& file)
    : impl_(std::make_unique<Impl>(path, file)) {}
AssimpScene::~AssimpScene() = default;

Points AssimpScene::at(int clip, float seconds) {
  return impl_->at(clip, seconds);
}

unsigned AssimpScene::clip_count() const {
  return impl_->clip_count();
}

}  // namespace understudy::tests
