#include "retarget/character/bone_map.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/bone_search.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

constexpr int kEnoughNamed = 8;  // limb joints with names
constexpr float kCertain = 1, kByName = 0.8f, kByPlace = 0.5f, kOpen = 0.4f;

void put(BoneMap& map, int joint, int node, float confidence) {
  map.node[joint] = node;
  map.confidence[joint] = confidence;
}

/// How many of the limbs' joints are called as what they are.
int named_limbs(const FoundBones& found) {
  int count = 0;
  for (size_t j = 0; j < kJointCount; ++j)
    if (kMirror[j] != static_cast<int>(j) && found.bone[j] >= 0 && found.evidence[j] > 1) ++count;
  return count;
}

/// By the joint's name, and by how much no other bone fits as well. Trunks are called spine from pelvis to
/// head, or by what is in them: where limbs are known by name, they say what hangs between them.
float confidence_of(const FoundBones& found, int joint, bool named) {
  constexpr float kClose = 0.7f;
  const bool close = found.margin[joint] < kClose;
  const bool called = found.evidence[joint] > (kMirror[joint] == joint ? -1.5f : 0.5f);
  if (called && named) return close ? kByName : kCertain;
  return close ? kOpen : kByPlace;
}

BoneMap map_of(const BoneTree& tree, const FoundBones& found) {
  constexpr int kSome = 3;
  BoneMap map;
  const int named = named_limbs(found);
  for (int j = 0; j < kJointCount; ++j)
    if (found.bone[j] >= 0)
      put(map, j, tree.bones[found.bone[j]].node, confidence_of(found, j, named >= kEnoughNamed));
  map.how = named >= kEnoughNamed ? "by names"
            : named >= kSome      ? "by names and position"
                                  : "by hierarchy and position";
  return map;
}

/// Of a rig in which no whole body is found: the bones that are called like a joint.
BoneMap map_by_names(const BoneTree& tree) {
  constexpr float kClear = 2;
  BoneMap map;
  std::array<float, kJointCount> best;
  best.fill(kClear);
  for (const TreeBone& bone : tree.bones)
    for (int j = 0; j < kJointCount; ++j) {
      const int side = kMirror[j] == j ? 0 : j < kMirror[j] ? -1 : 1;
      const float evidence = bone.name.evidence(role_of(j)) - 0.35f * bone.rank;
      const bool taken = std::find(map.node.begin(), map.node.end(), bone.node) != map.node.end();
      if (bone.name.side != side || taken || evidence < best[j] + (map.has(j) ? 0.1f : 0)) continue;
      best[j] = evidence;
      put(map, j, bone.node, kByName);
    }
  map.how = "by names";
  return map;
}

std::string family_of(const Character& character) {
  for (const auto& node : character.nodes) {
    const std::string& name = node.name;
    if (starts_with(name, "mixamorig")) return "Mixamo";
    if (starts_with(name, "DEF-") || starts_with(name, "ORG-")) return "Rigify";
    if (starts_with(name, "J_Bip_")) return "VRM";
    if (starts_with(name, "Bip0")) return "biped";
    if (name == "thigh_l" || name == "upperarm_l") return "Unreal";
    if (name == "LHipJoint") return "CMU";
  }
  return "";
}

void apply_choices(const Character& character, const BoneChoices& choices, BoneMap& map) {
  for (const auto& [joint, bone] : choices) {
    const int j = joint_named(joint);
    US_CHECK(j >= 0, character.called(), ": the map names a joint '", excerpt(joint),
             "', which does not exist");
    map.node[j] = -1;
    map.confidence[j] = 0;
    if (bone.empty()) continue;
    for (size_t n = 0; n < character.nodes.size() && map.node[j] < 0; ++n)
      if (character.nodes[n].name == bone) map.node[j] = n;
    US_CHECK(map.node[j] >= 0, character.called(), ": the map names a bone '", excerpt(bone),
             "', which the character does not have");
    map.confidence[j] = 1;
    map.how = "given";
  }
  for (size_t a = 0; a < kJointCount; ++a)
    for (size_t b = a + 1; b < kJointCount; ++b) {
      if (map.node[a] < 0 || map.node[a] != map.node[b]) continue;
      const bool both = choices.count(kJointNames[a]) > 0 && choices.count(kJointNames[b]) > 0;
      US_CHECK(!both, character.called(), ": the map gives the bone '", character.nodes[map.node[a]].name,
               "' to both ", kJointNames[a], " and ", kJointNames[b]);
      const size_t loser = choices.count(kJointNames[a]) > 0 ? b : a;  // the user's choice wins
      map.node[loser] = -1;
      map.confidence[loser] = 0;
    }
}

}  // namespace

int BoneMap::count() const {
  return static_cast<int>(std::count_if(node.begin(), node.end(), [](int n) { return n >= 0; }));
}

bool BoneMap::usable() const {
  const auto needed = {Pelvis,       LeftHip,       RightHip,  LeftKnee,  RightKnee,
                       LeftShoulder, RightShoulder, LeftElbow, RightElbow};
  return std::all_of(needed.begin(), needed.end(), [&](int j) { return has(j); });
}

BoneMap map_bones(const Character& character, const std::vector<Mat4>& bind, const BoneChoices& choices) {
  constexpr float kNobody = -1, kEach = 1;  // of the places, where names say nothing; a name makes up for it
  US_CHECK(bind.size() == character.nodes.size(), "the bind pose has ", bind.size(), " nodes, the character ",
           character.nodes.size());
  const BoneTree tree = make_bone_tree(character, bind);
  const FoundBones found = search_bones(tree);
  const int named = named_limbs(found);
  const bool is_body =
      found.found && (named >= kEnoughNamed || found.shape + kEach * static_cast<float>(named) > kNobody);
  BoneMap map = is_body ? map_of(tree, found) : map_by_names(tree);
  const std::string family = family_of(character);
  if (!family.empty()) map.how += " (" + family + ")";
  if (is_body && found.sides_by_shape) map.how += ", left and right by the feet";
  apply_choices(character, choices, map);
  return map;
}

BoneChoices parse_bone_choices(std::string_view text, const std::string& path) {
  const auto json = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
  US_CHECK(json.is_object(), path, R"(: is no map of bones; it looks like {"left_wrist": "Hand.L", ...})");
  BoneChoices choices;
  for (const auto& [joint, bone] : json.items()) {
    US_CHECK(bone.is_string(), path, ": the bone of '", excerpt(joint), "' is not a string");
    choices[joint] = bone.get<std::string>();
  }
  return choices;
}

BoneChoices read_bone_choices(const std::string& path) {
  return parse_bone_choices(read_file(path), path);
}

std::vector<int> BoneMap::guessed() const {
  std::vector<int> out;
  for (int j = 0; j < kJointCount; ++j)
    if (has(j) && confidence[j] < kGuessed) out.push_back(j);
  return out;
}

std::string guess_note(const BoneMap& map) {
  const std::vector<int> guessed = map.guessed();
  if (guessed.empty()) return "";
  if (static_cast<int>(guessed.size()) == map.count()) return "its bones are guessed by their places";
  std::string out = "guessed by their places, not by name:";
  for (const int j : guessed) out += (j == guessed[0] ? " " : ", ") + joint_label(j);
  return out;
}

std::string to_table(const BoneMap& map, const Character& character) {
  std::string out = "joint            bone                             sure   (" + map.how + ")\n";
  for (size_t j = 0; j < kJointCount; ++j) {
    const int n = map.node[j];
    std::string name = n < 0 ? "-" : character.nodes[n].name;
    if (n >= 0 && name.empty()) name = "node " + std::to_string(n);
    out += printed("%-16s %-32.60s %3.0f %%\n", kJointNames[j], name.c_str(),
                   100.0 * static_cast<double>(map.confidence[j]));
  }
  return out;
}

}  // namespace understudy
