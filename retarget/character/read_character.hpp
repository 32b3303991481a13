// Characters from files of any known format.
#pragma once

#include <string>

#include "retarget/character/character.hpp"

namespace understudy {

struct ReadCharacterOptions {
  /// The program that reads FBX and DAE in a process of its own: called as `PROGRAM import-worker IN OUT`.
  /// Empty: this very program.
  std::string worker;
  double patience_s = 30;            ///< of that process
  int64_t memory_bytes = 4ll << 30;  ///< of that process
};

/// glTF and GLB whole; OBJ with its materials; PLY, OFF, STL and clouds as one part; FBX and DAE by a process
/// of its own, which may crash. Throws Error: one sentence that names the file.
Character read_character(const std::string& path, const ReadCharacterOptions& options = {});

/// A mesh without anything more as a character.
Character character_of_mesh(const Mesh& mesh, const std::string& name);

}  // namespace understudy
