// Skeletal motions from files of any known format.
#pragma once

#include <optional>
#include <string>

#include "retarget/character/character.hpp"
#include "retarget/character/read_character.hpp"

namespace understudy {

/// Whether a file holds a skeletal motion, decided quickly: .bvh, .fbx and .dae by their names, .npz by the
/// names of its arrays. A glTF may be one, too: only reading it shows that. Throws Error when there is no
/// such file.
bool is_motion_file(const std::string& path);
/// Whether a file of this name may hold a motion, and only reading it shows that.
bool may_hold_motion(const std::string& path);

/// Whether a glTF or GLB has an animation, by the first `most` bytes of its JSON alone: of a GLB the numbers
/// are not read. None where only later bytes can decide. False for other formats and for JSON that breaks
/// before an animation. Throws Error when there is no such file.
std::optional<bool> is_animated_gltf(const std::string& path, uint64_t most);

/// The animated character of a BVH, FBX, DAE, glTF or GLB file, or of an AMASS-format .npz; it may have no
/// mesh. None when the file is of another kind or a glTF without an animation. Throws Error naming the file,
/// also where an FBX or DAE has no animation.
std::optional<Character> read_motion(const std::string& path, const ReadCharacterOptions& options = {});

}  // namespace understudy
