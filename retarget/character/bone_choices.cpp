#include "retarget/character/bone_choices.hpp"

#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {

BoneChoices parse_bone_choices(std::string_view text, const std::string& path) {
  const auto json = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
  US_CHECK(json.is_object(), path, R"(: is no map of bones; it looks like {"left_wrist": "Hand.L", ...})");
  BoneChoices choices;
  for (const auto& [joint, bone] : json.items()) {
    US_CHECK(bone.is_string(), path, ": the bone of '", excerpt(joint), "' is no text");
    choices[joint] = bone.get<std::string>();
  }
  return choices;
}

BoneChoices read_bone_choices(const std::string& path) {
  return parse_bone_choices(read_file(path), path);
}

}  // namespace understudy
