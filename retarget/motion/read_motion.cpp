#include "retarget/motion/read_motion.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/motion/bvh.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

constexpr int kDeepestJson = 200;
constexpr float kAdultLeg = 0.8f;  // metres, thigh and shin

bool is_amass_motion(const std::string& path) {
  const std::vector<std::string> names = npz_names(path);
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return has("poses") && has("trans") && !has("v_template");
}

/// The 22 joints of a mean adult in T-pose as nodes, named as in kJointNames, and the motion of an
/// AMASS-format .npz as their one animation; no part. Axes are the file's. Throws Error naming the file.
Character read_amass_character(const std::string& path) {
  const Motion motion = read_amass_motion(path);
  Character out;
  out.name = std::filesystem::path(path).stem().string();
  const Joints rest = human_rest() * (kAdultLeg / leg_length(human_rest()));
  CharacterAnimation animation;
  animation.name = out.name;
  std::vector<float> times(motion.poses.size());
  for (size_t t = 0; t < times.size(); ++t)
    times[t] = static_cast<float>(static_cast<double>(t) / static_cast<double>(motion.fps));
  for (size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Index row = j;
    CharacterNode node;
    node.name = kJointNames[j];
    node.parent = kParents[j];
    if (node.parent >= 0) node.local.translation = (rest.row(row) - rest.row(node.parent)).transpose();
    out.nodes.push_back(node);
    CharacterTrack turn;
    turn.node = j;
    turn.times = times;
    for (const Pose& pose : motion.poses) {
      const Eigen::Quaternionf q(pose.local[j]);
      turn.values.insert(turn.values.end(), {q.x(), q.y(), q.z(), q.w()});
    }
    animation.tracks.push_back(std::move(turn));
  }
  CharacterTrack path_of_root;  // of the pelvis, node 0
  path_of_root.path = TrackPath::Translation;
  path_of_root.times = times;
  for (const Pose& pose : motion.poses)
    path_of_root.values.insert(path_of_root.values.end(), pose.root.data(), pose.root.data() + 3);
  animation.tracks.push_back(std::move(path_of_root));
  out.animations.push_back(std::move(animation));
  check_character(out, path);
  return out;
}

/// Formats of bones alone.
struct Reader {
  std::string_view format;
  Character (*read)(const std::string& path);
};
constexpr Reader kReaders[] = {{"BVH", read_bvh}, {"NPZ", read_amass_character}};

/// Whether a glTF's JSON has an animation with channels. None where the text ends before the first
/// and is not `whole`.
std::optional<bool> has_animation(const std::string& text, bool whole) {
  using Json = nlohmann::json;
  struct Known {
    bool animated;
  };
  const auto look = [within = false](int depth, Json::parse_event_t event, const Json& parsed) mutable {
    if (depth > kDeepestJson) throw Known{false};
    if (depth == 1 && event == Json::parse_event_t::key) within = parsed == "animations";
    const bool one_ends = within && depth == 2 && event == Json::parse_event_t::object_end;
    if (one_ends && parsed.contains("channels") && !parsed["channels"].empty()) throw Known{true};
    return depth == 0 || within;  // the rest is skipped
  };
  try {
    static_cast<void>(Json::parse(text, look));
    return false;
  } catch (const Known& known) {
    return known.animated;
  } catch (const Json::parse_error& error) {
    if (whole || error.byte < text.size()) return false;
    return std::nullopt;
  }
}

}  // namespace

bool is_motion_file(const std::string& path) {
  const FileFormat* const format = format_of_suffix(path, kMotion);
  if (!format || format->parse) return false;
  std::error_code failed;
  US_CHECK(std::filesystem::exists(path, failed), path, ": there is no such file");
  if (std::filesystem::is_directory(path)) return false;
  return !format->open || is_amass_motion(path);
}

bool may_hold_motion(const std::string& path) {
  const FileFormat* const format = format_of_suffix(path, kMotion);
  return format && format->parse;
}

std::optional<bool> is_animated_gltf(const std::string& path, uint64_t most) {
  if (!may_hold_motion(path)) return false;
  const uint64_t size = check_file(path);
  std::ifstream file(path, std::ios::binary);
  std::string head(20, '\0');
  file.read(head.data(), 20);
  const bool is_glb = starts_with(head, "glTF");
  const uint64_t json = is_glb ? std::min<uint64_t>(load<uint32_t>(head.data() + 12, false), size) : size;
  std::string text(std::min(json, most), '\0');
  file.clear();
  file.seekg(is_glb ? 20 : 0);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  return has_animation(text, text.size() == json);
}

std::optional<Character> read_motion(const std::string& path, const ReadCharacterOptions& options) {
  std::error_code failed;
  const bool is_gltf = may_hold_motion(path);
  if (std::filesystem::is_directory(path, failed) || (!is_gltf && !is_motion_file(path))) return std::nullopt;
  for (const Reader& reader : kReaders)
    if (reader.format == format_of_suffix(path, kMotion)->name) {
      Character character = reader.read(path);
      character.file = path;
      return character;
    }
  Character character = read_character(path, options);
  auto& all = character.animations;
  all.erase(std::remove_if(all.begin(), all.end(), [](const auto& one) { return one.tracks.empty(); }),
            all.end());
  if (is_gltf && all.empty()) return std::nullopt;
  US_CHECK(!all.empty(), path, ": has no animation");
  return character;
}

}  // namespace understudy
