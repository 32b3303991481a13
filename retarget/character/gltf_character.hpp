// Characters from and to glTF 2.0: text (.gltf) and binary (.glb).
#pragma once

#include <string>
#include <string_view>

#include "retarget/character/character.hpp"

namespace understudy {

/// Everything of the default scene that Character holds. Pictures and buffers outside must lie in the file's
/// folder. A picture that is missing becomes a white one, with a warning. Throws Error naming `path`: cut
/// off, accessors past their buffers, nodes in a circle or more than 1000 deep, data that are not base64,
/// pictures of no known format, ...
Character parse_gltf_character(std::string_view bytes, const std::string& path);

/// Skin weights, [V, K]: a bone that is named twice for one vertex has both of them in the first place.
RowMatrix weights_of_bones(const CharacterPart& part);

/// The bytes of such a file; the suffix of `path` .gltf makes text with everything inside, else binary.
/// Throws Error naming the path, also where the file would pass 4 GB.
std::string gltf_bytes(const Character& character, const std::string& path);
/// Writes them beside the path, then renames.
void write_gltf_character(const std::string& path, const Character& character);

}  // namespace understudy
