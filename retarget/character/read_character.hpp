// Characters from files of any known format.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "retarget/character/character.hpp"

namespace understudy {

#ifndef __has_feature  // clang's
#define __has_feature(name) 0
#endif
/// Bytes for the process that reads FBX and DAE; no bound under a sanitizer, whose shadow memory alone takes
/// terabytes of address space.
constexpr int64_t kImportMemory = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
                                      ? std::numeric_limits<int64_t>::max()
                                      : 4ll << 30;

struct ReadCharacterOptions {
  /// The program that reads FBX and DAE in a process of its own: called as `PROGRAM import-worker IN OUT`.
  /// Empty: this very program.
  std::string worker;
  double patience_s = 30;                ///< of that process
  int64_t memory_bytes = kImportMemory;  ///< of that process
};

/// glTF and GLB whole; OBJ with its materials; PLY, OFF, STL and clouds as one part; FBX and DAE by a process
/// of its own, which may crash. Throws Error: one sentence that names the file.
Character read_character(const std::string& path, const ReadCharacterOptions& options = {});

/// Wavefront OBJ: groups by material, texture coordinates, normals, .mtl and its pictures; one part a
/// material. Materials and pictures are looked for in the file's folder and under it; what is missing is
/// warned of. Throws Error naming `path`.
Character parse_obj_character(std::string_view bytes, const std::string& path);

/// FBX and DAE: parts, materials, pictures, nodes, skins, shapes, and animations of nodes. Damaged files can
/// crash it: call this in a process of its own only. Throws Error.
Character import_by_assimp(const std::string& path);

/// The last line of what such a process wrote, fit for a dialog box whatever it is: 200 printable characters
/// at most. May be empty.
std::string last_words(std::string_view written);

/// A mesh without anything more as a character.
Character character_of_mesh(const Mesh& mesh, const std::string& name);

}  // namespace understudy
