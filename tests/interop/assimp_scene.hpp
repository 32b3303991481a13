// A file as assimp has it: its nodes, bones, weights, morphs and keys give vertices.
#pragma once

#include <memory>
#include <string>

#include "retarget/character/character.hpp"

namespace understudy::tests {

class AssimpScene {
 public:
  /// file: the same as our reader has it, for the order of the meshes. Throws Error where assimp cannot read
  /// it.
  AssimpScene(const std::string& path, const Character& file);
  ~AssimpScene();
  AssimpScene(const AssimpScene&) = delete;
  AssimpScene& operator=(const AssimpScene&) = delete;
  /// At a time of a clip, [V, 3], meshes in the order of our nodes.
  Points at(int clip, float seconds);
  unsigned clip_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::tests
