#include "retarget/motion/read_motion.hpp"

#include <algorithm>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/motion/amass_motion.hpp"
#include "retarget/motion/bvh.hpp"

namespace understudy {
namespace {

bool is_amass_motion(const std::string& path) {
  const std::vector<std::string> names = npz_names(path);
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return has("poses") && has("trans") && !has("v_template");
}

}  // namespace

bool is_motion_file(const std::string& path) {
  const std::string suffix = file_suffix(path);
  if (suffix != ".npz" && suffix != ".bvh" && suffix != ".fbx" && suffix != ".dae") return false;
  std::error_code failed;
  US_CHECK(std::filesystem::exists(path, failed), path, ": there is no such file");
  if (std::filesystem::is_directory(path)) return false;
  return suffix != ".npz" || is_amass_motion(path);
}

std::optional<Character> read_motion(const std::string& path, const ReadCharacterOptions& options) {
  std::error_code failed;
  const std::string suffix = file_suffix(path);
  const bool is_gltf = suffix == ".glb" || suffix == ".gltf";
  if (std::filesystem::is_directory(path, failed) || (!is_gltf && !is_motion_file(path))) return std::nullopt;
  const bool bones_alone = suffix == ".bvh" || suffix == ".npz";
  Character character = suffix == ".bvh"   ? read_bvh(path)
                        : suffix == ".npz" ? read_amass_character(path)
                                           : read_character(path, options);
  character.file = path;
  if (bones_alone) return character;
  auto& all = character.animations;
  all.erase(std::remove_if(all.begin(), all.end(), [](const auto& one) { return one.tracks.empty(); }),
            all.end());
  if (is_gltf && all.empty()) return std::nullopt;
  US_CHECK(!all.empty(), path, ": has no animation");
  return character;
}

}  // namespace understudy
