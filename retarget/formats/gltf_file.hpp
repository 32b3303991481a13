// A glTF or GLB file as tinygltf parses it: bounded before, checked before it is handed out.
#pragma once

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {

/// Numbers of an accessor, checked against its buffer.
struct GltfAccessor {
  int64_t count = 0;
  int parts = 1;              ///< numbers an element
  std::vector<float> values;  ///< [count, parts]
};

/// One file. Buffers outside must lie in the file's folder or under it. The bytes and the path must outlive
/// it. Everything throws Error naming the path.
class GltfFile {
 public:
  enum class Use { Surface, Character };  ///< a surface needs neither pictures nor animations
  GltfFile(std::string_view bytes, const std::string& path, Use use);

  /// Lists of objects without their extras, extensions by name alone; indices are not negative or -1: absent.
  const tinygltf::Model& model() const { return model_; }
  /// Materials, textures, samplers and extensionsRequired, which tinygltf would not keep as they are.
  const nlohmann::json& kept(const char* name) const { return kept_.at(name); }
  /// Number `index` of a list of the model; `name` is the list's name in errors.
  template <class T>
  const T& item(const std::vector<T>& list, int index, const char* name) const {
    US_CHECK(index >= 0 && static_cast<size_t>(index) < list.size(), path_, ": names number ", index,
             " of its ", list.size(), " ", name);
    return list[index];
  }
  GltfAccessor accessor(int index);
  /// The matrices that bring the mesh to each joint of a skin, [joints, 16]; empty when it has none.
  std::vector<float> inverse_bind(const tinygltf::Skin& skin);
  /// Whether a primitive is drawn as triangles or points: lines and what has no positions are left out.
  bool is_shown(const tinygltf::Primitive& primitive) const;
  /// Triangles of a primitive of `count` vertices, [F, 3]; none where it holds points.
  Faces faces(const tinygltf::Primitive& primitive, int64_t count);
  /// The bytes of a buffer view; they live as long as this.
  std::string_view view_bytes(int index) const;
  /// What a uri stands for: data in it, or a file in the folder. `what` names it in errors.
  std::string uri_bytes(const std::string& uri, const std::string& what);
  /// Counts what is made of the file, which may name its bytes again and again. Throws Error when all
  /// together passes 2 GiB, or 256 MiB and 64 times the file's size.
  void spend(uint64_t bytes);
  const std::string& path() const { return path_; }

 private:
  std::string_view split_glb(std::string_view bytes);
  nlohmann::json parse(std::string_view text);
  void bound(nlohmann::json& value, const std::string& key);
  void bound_buffers(nlohmann::json& root);
  void fill_model(const std::string& text);
  std::string plain_data(std::string uri, const std::string& what);
  std::string buffer_bytes(size_t index);
  void apply_sparse(const tinygltf::Accessor& from, NumberType type, GltfAccessor& out);
  void read(int view, uint64_t offset, NumberType type, bool normalized, GltfAccessor& out);

  const std::string& path_;
  tinygltf::Model model_;
  nlohmann::json kept_;
  std::string_view binary_;
  std::vector<std::string> buffer_uris_;
  std::vector<uint64_t> buffer_sizes_;
  uint64_t size_, spent_ = 0;  // of the file and of files beside it; of what was made of them
  bool has_draco_ = false;
};

/// A node's transform to its parent.
Eigen::Matrix4f gltf_local_transform(const GltfFile& file, const tinygltf::Node& node);

/// The nodes of the scene, parents first, with their transforms to the world.
struct GltfSceneNodes {
  std::vector<int> order;
  std::vector<Eigen::Matrix4f> world;
};
GltfSceneNodes walk_gltf_scene(const GltfFile& file);

}  // namespace understudy
