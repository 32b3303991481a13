// The parts of a glTF or GLB file, each checked before it is handed out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
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

/// One file: its JSON and buffers. Buffers outside must lie in the file's folder or under it. The bytes and
/// the path must outlive it. Everything throws Error naming the path.
class GltfFile {
 public:
  using Json = nlohmann::json;
  GltfFile(std::string_view bytes, const std::string& path);

  /// A list at the top of the document; empty when it is absent.
  const Json& list(const char* name) const;
  /// An object of such a list.
  const Json& item(const char* name, int64_t index) const;
  /// A whole number of an object; `otherwise` when it is absent.
  int64_t integer(const Json& object, const char* name, int64_t otherwise) const;
  /// The numbers of an array; empty when it is absent.
  std::vector<float> numbers(const Json& object, const char* name, size_t count) const;
  GltfAccessor accessor(int64_t index);
  /// The bytes of a buffer view; they live as long as this.
  std::string_view view_bytes(int64_t index) { return view(index).bytes; }
  /// What a uri stands for: data in it, or a file in the folder. `what` names it in complaints.
  std::string uri_bytes(const std::string& uri, const std::string& what);
  /// Counts what is made of the file, which may name its bytes again and again. Throws Error when all
  /// together passes 2 GiB, or 256 MiB and 64 times the file's size.
  void spend(uint64_t bytes);
  const std::string& path() const { return path_; }
  const Json& root() const { return root_; }

 private:
  struct Stretch {
    std::string_view bytes;
    uint64_t stride;  // 0: packed
  };

  void check_version() const;
  std::string_view split_glb(std::string_view bytes);
  std::string_view buffer(int64_t index);
  Stretch view(int64_t index);
  void apply_sparse(const Json& sparse, NumberType type, bool normalized, GltfAccessor& out);
  void read(const Stretch& from, uint64_t offset, NumberType type, bool normalized, GltfAccessor& out);

  const std::string& path_;
  Json root_;
  std::string_view binary_;
  std::map<int64_t, std::string> loaded_;
  uint64_t size_, spent_ = 0;  // of the file and of files beside it; of what was made of them
};

/// A node's transform to its parent.
Eigen::Matrix4f gltf_local_transform(const GltfFile& file, const nlohmann::json& node);

/// The nodes of the scene, parents first, with their transforms to the world.
struct GltfSceneNodes {
  std::vector<int64_t> order;
  std::vector<Eigen::Matrix4f> world;
  std::vector<bool> reached;
};
GltfSceneNodes walk_gltf_scene(const GltfFile& file);

}  // namespace understudy
