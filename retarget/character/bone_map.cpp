#include "retarget/character/bone_map.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

/// Words of a name: "mixamorig:LeftUpLeg" -> left up leg; "J_Bip_L_UpperArm" -> j bip l upper arm.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) words.push_back(lower_case(word));
    word.clear();
  };
  for (size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const auto before = i > 0 ? static_cast<unsigned char>(name[i - 1]) : ' ';
    const auto after = i + 1 < name.size() ? static_cast<unsigned char>(name[i + 1]) : ' ';
    if (!std::isalnum(c)) {
      finish();
      continue;
    }
    const bool hump =
        std::isupper(c) && (std::islower(before) || (std::isupper(before) && std::islower(after)));
    if (hump || (std::isdigit(c) != 0) != (std::isdigit(before) != 0)) finish();
    word.push_back(static_cast<char>(c));
  }
  finish();
  return words;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> list) {
  return std::any_of(list.begin(), list.end(), [&](const char* known) { return word == known; });
}

int side_of(const std::string& word) {
  if (is_one_of(word, {"left", "l", "lf", "lft"})) return -1;
  return is_one_of(word, {"right", "r", "rt", "rgt"}) ? 1 : 0;
}

/// What rigs call the parts of a body, in one word each.
const std::map<std::string, std::string>& same_words() {
  static const std::map<std::string, std::string> words = {
      {"hips", "pelvis"},      {"hip", "hip"},          {"pelvis", "pelvis"},     {"root", "root"},
      {"upleg", "thigh"},      {"upperleg", "thigh"},   {"thigh", "thigh"},       {"legupper", "thigh"},
      {"femur", "thigh"},      {"leg", "calf"},         {"lowerleg", "calf"},     {"lowleg", "calf"},
      {"leglower", "calf"},    {"calf", "calf"},        {"shin", "calf"},         {"knee", "calf"},
      {"tibia", "calf"},       {"foot", "foot"},        {"ankle", "ankle"},       {"toe", "toe"},
      {"toes", "toe"},         {"toebase", "toe"},      {"ball", "toe"},          {"footthumb", "toe"},
      {"clavicle", "collar"},  {"collar", "collar"},    {"collarbone", "collar"}, {"shoulder", "shoulder"},
      {"upperarm", "arm"},     {"uparm", "arm"},        {"armupper", "arm"},      {"arm", "arm"},
      {"shldr", "arm"},        {"humerus", "arm"},      {"forearm", "forearm"},   {"lowerarm", "forearm"},
      {"lowarm", "forearm"},   {"armlower", "forearm"}, {"elbow", "forearm"},     {"radius", "forearm"},
      {"hand", "hand"},        {"wrist", "hand"},       {"palm", "hand"},         {"neck", "neck"},
      {"head", "head"},        {"spine", "spine"},      {"chest", "spine"},       {"upperchest", "spine"},
      {"torso", "spine"},      {"abdomen", "spine"},    {"waist", "spine"},       {"lowerback", "spine"},
      {"spinelower", "spine"}, {"spineupper", "spine"}};
  return words;
}

struct Rig {
  const Character& character;
  std::vector<Vec3> place;              // of each node in the bind pose
  std::vector<bool> is_bone;            // may be mapped
  std::vector<std::vector<int>> below;  // children
  int parent(int n) const { return character.nodes[n].parent; }
  bool is_above(int a, int n) const {
    for (; n >= 0; n = parent(n))
      if (n == a) return true;
    return false;
  }
  int common(int a, int b) const {
    for (; a >= 0; a = parent(a))
      if (is_above(a, b)) return a;
    return -1;
  }
  /// From below `top` down to `end`, both in (top, end].
  std::vector<int> path(int top, int end) const {
    std::vector<int> out;
    for (int n = end; n >= 0 && n != top; n = parent(n)) out.push_back(n);
    std::reverse(out.begin(), out.end());
    return out;
  }
};

Rig make_rig(const Character& character, const std::vector<Mat4>& bind) {
  Rig rig{character, {}, std::vector<bool>(bind.size(), character.skins.empty()), {}};
  rig.below.resize(bind.size());
  for (size_t n = 0; n < bind.size(); ++n) {
    rig.place.push_back(bind[n].topRightCorner<3, 1>());
    if (rig.parent(n) >= 0) rig.below[rig.parent(n)].push_back(n);
  }
  for (const auto& skin : character.skins)
    for (const int joint : skin.joints) rig.is_bone[joint] = true;
  return rig;
}

/// The first bone with this name, nearest to the root; -1 for none. Helpers (twist, ik, pole ...) do not
/// count.
using NamedBones = std::map<std::pair<int, std::string>, int>;

NamedBones named_bones(const Rig& rig) {
  NamedBones found;
  for (size_t n = 0; n < rig.place.size(); ++n) {
    if (!rig.is_bone[n]) continue;
    const BoneName name = parse_bone_name(rig.character.nodes[n].name);
    if (!name.what.empty()) found.emplace(std::make_pair(name.side, name.what), n);
  }
  return found;
}

int find(const NamedBones& bones, int side, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const auto found = bones.find({side, name}); found != bones.end()) return found->second;
  return -1;
}

void put(BoneMap& map, int joint, int node, float confidence) {
  if (node < 0 || map.has(joint)) return;
  if (std::find(map.node.begin(), map.node.end(), node) != map.node.end()) return;
  map.node[joint] = node;
  map.confidence[joint] = confidence;
}

void map_limbs_by_name(const NamedBones& bones, BoneMap& map) {
  for (const int side : {-1, 1}) {
    const int right = side > 0 ? 1 : 0;
    put(map, LeftHip + right, find(bones, side, {"thigh", "hip"}), 0.8f);
    put(map, LeftKnee + right, find(bones, side, {"calf"}), 0.8f);
    put(map, LeftAnkle + right, find(bones, side, {"ankle", "foot"}), 0.8f);
    put(map, LeftFoot + right, find(bones, side, {"toe", "foot"}), 0.8f);
    // A shoulder is the collar bone where an arm is below it, else the arm.
    put(map, LeftShoulder + right, find(bones, side, {"arm", "shoulder"}), 0.8f);
    put(map, LeftCollar + right, find(bones, side, {"collar", "shoulder"}), 0.8f);
    put(map, LeftElbow + right, find(bones, side, {"forearm"}), 0.8f);
    put(map, LeftWrist + right, find(bones, side, {"hand"}), 0.8f);
  }
  put(map, Head, find(bones, 0, {"head"}), 0.8f);
  put(map, Neck, find(bones, 0, {"neck"}), 0.8f);
}

/// Pelvis, spine and neck from where limbs and head hang, whatever they are called.
void map_trunk(const Rig& rig, float confidence, BoneMap& map) {
  put(map, Pelvis, rig.common(map.node[LeftHip], map.node[RightHip]), confidence);
  const auto arm_start = [&](int right) {
    const int collar = map.node[LeftCollar + right];
    return collar >= 0 ? collar : map.node[LeftShoulder + right];
  };
  const int pelvis = map.node[Pelvis], chest = rig.common(arm_start(0), arm_start(1));
  if (pelvis < 0 || chest < 0 || !rig.is_above(pelvis, chest)) return;
  std::vector<int> spine = rig.path(pelvis, chest);  // the chest last
  if (chest == map.node[Neck]) map.node[Neck] = -1;  // arms hang on it: it is a chest, whatever its name
  if (!spine.empty()) {
    put(map, Spine3, spine.back(), confidence);
    spine.pop_back();
  }
  if (!spine.empty()) put(map, Spine1, spine.front(), confidence);
  if (spine.size() > 1) put(map, Spine2, spine[spine.size() / 2], confidence);
  if (map.has(Head) && !map.has(Neck)) {
    const auto neck = rig.path(chest, map.node[Head]);
    if (neck.size() > 1) put(map, Neck, neck.front(), confidence);
  }
  if (map.has(Head)) return;
  // Without a head by name: the end of the chain that goes up from the chest (Rigify's spine.006).
  int top = map.has(Neck) ? map.node[Neck] : chest;
  for (int next = top; next >= 0;) {
    top = next;
    next = -1;
    for (const int child : rig.below[top]) {
      const bool is_arm =
          rig.is_above(child, map.node[LeftShoulder]) || rig.is_above(child, map.node[RightShoulder]);
      if (rig.is_bone[child] && !is_arm && (next < 0 || rig.place[child].y() > rig.place[next].y()))
        next = child;
    }
  }
  const auto up = rig.path(chest, top);
  if (up.size() == 1) put(map, map.has(Neck) ? Head : Neck, up[0], 0.6f * confidence);
  if (up.size() > 1) {
    put(map, Neck, up.front(), confidence);
    put(map, Head, up.back(), confidence);
  }
}

void trust_hierarchy(const Rig& rig, BoneMap& map) {
  for (int j = 0; j < kJointCount; ++j) {
    int p = kParents[j];
    while (p >= 0 && !map.has(p)) p = kParents[p];
    if (map.has(j) && (p < 0 || rig.is_above(map.node[p], map.node[j])))
      map.confidence[j] = std::min(1.0f, map.confidence[j] * 1.25f);
  }
}

// The bones between the trunk and the end of a limb as joints. Chains are read from the trunk: a first bone
// much shorter than the next two is the collar.
void map_arm(const Rig& rig, int chest, int end, int right, BoneMap& map) {
  std::vector<int> chain = rig.path(chest, end);
  const auto length = [&](size_t i) { return (rig.place[chain[i + 1]] - rig.place[chain[i]]).norm(); };
  if (chain.size() >= 4 && length(0) < 0.75f * length(1)) {
    put(map, LeftCollar + right, chain[0], 0.5f);
    chain.erase(chain.begin());
  }
  for (size_t i = 0; i < std::min<size_t>(3, chain.size()); ++i)
    put(map, std::array<int, 3>{LeftShoulder, LeftElbow, LeftWrist}[i] + right, chain[i], 0.5f);
}

void map_leg(const Rig& rig, int pelvis, int end, int right, BoneMap& map) {
  std::vector<int> chain = rig.path(pelvis, end);
  const auto drop = [&](size_t i) { return rig.place[chain[i]].y() - rig.place[chain[i + 1]].y(); };
  if (chain.size() >= 4 && drop(0) < 0.4f * drop(1)) chain.erase(chain.begin());  // a link to the hip
  for (size_t i = 0; i < std::min<size_t>(4, chain.size()); ++i)
    put(map, std::array<int, 4>{LeftHip, LeftKnee, LeftAnkle, LeftFoot}[i] + right, chain[i], 0.5f);
}

/// The horizontal direction that the bones spread most in: across the body.
Vec3 across(const Rig& rig, const std::vector<int>& bones) {
  Vec3 mean = Vec3::Zero();
  for (const int n : bones) mean += rig.place[n] / static_cast<float>(bones.size());
  Eigen::Matrix2f covariance = Eigen::Matrix2f::Zero();
  for (const int n : bones) {
    const Vec3 d = rig.place[n] - mean;
    const Eigen::Vector2f flat(d.x(), d.z());
    covariance += flat * flat.transpose();
  }
  const float angle = 0.5f * std::atan2(2 * covariance(0, 1), covariance(0, 0) - covariance(1, 1));
  return {std::cos(angle), 0, std::sin(angle)};
}

/// Of the bones, the one furthest along a direction; -1 for none.
int furthest(const Rig& rig, const std::vector<int>& bones, const Vec3& direction) {
  int best = -1;
  for (const int n : bones)
    if (best < 0 || rig.place[n].dot(direction) > rig.place[best].dot(direction)) best = n;
  return best;
}

BoneMap map_by_place(const Rig& rig) {
  BoneMap map;
  std::vector<int> bones, ends;
  for (size_t n = 0; n < rig.place.size(); ++n) {
    if (!rig.is_bone[n]) continue;
    bones.push_back(n);
    const auto& below = rig.below[n];
    if (std::none_of(below.begin(), below.end(), [&](int c) { return rig.is_bone[c]; })) ends.push_back(n);
  }
  if (ends.size() < 5) return map;
  const Vec3 side = across(rig, bones);
  Vec3 mean = Vec3::Zero();
  for (const int n : bones) mean += rig.place[n] / static_cast<float>(bones.size());
  std::vector<int> a, b;  // ends on both sides
  for (const int n : ends) (side.dot(rig.place[n] - mean) > 0 ? a : b).push_back(n);
  std::array<int, 2> foot = {furthest(rig, a, -Vec3::UnitY()), furthest(rig, b, -Vec3::UnitY())};
  std::array<int, 2> hand = {furthest(rig, a, side), furthest(rig, b, -side)};
  if (foot[0] < 0 || foot[1] < 0) return map;
  // Toes lie before the ankles: which way the rig looks, and so which side is its left.
  Vec3 toes = Vec3::Zero();
  for (const int f : foot) toes += rig.place[f] - rig.place[std::max(0, rig.parent(f))];
  if (Vec3::UnitY().cross(toes).dot(side) < 0) {  // up x forward points to the left
    std::swap(foot[0], foot[1]);
    std::swap(hand[0], hand[1]);
  }
  const int pelvis = rig.common(foot[0], foot[1]), chest = rig.common(hand[0], hand[1]);
  if (pelvis < 0 || chest < 0 || !rig.is_above(pelvis, chest)) return map;
  for (const int right : {0, 1}) {
    map_leg(rig, pelvis, foot[right], right, map);
    map_arm(rig, chest, hand[right], right, map);
  }
  map_trunk(rig, 0.5f, map);
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

void apply_choices(const Rig& rig, const BoneChoices& choices, BoneMap& map) {
  for (const auto& [joint, bone] : choices) {
    const int j = joint_named(joint);
    US_CHECK(j >= 0, rig.character.called(), ": the map names a joint '", excerpt(joint),
             "', which does not exist");
    map.node[j] = -1;
    map.confidence[j] = 0;
    if (bone.empty()) continue;
    for (size_t n = 0; n < rig.place.size() && map.node[j] < 0; ++n)
      if (rig.character.nodes[n].name == bone) map.node[j] = n;
    US_CHECK(map.node[j] >= 0, rig.character.called(), ": the map names a bone '", excerpt(bone),
             "', which the character does not have");
    map.confidence[j] = 1;
    map.how = "given";
  }
  for (size_t a = 0; a < kJointCount; ++a)
    for (size_t b = a + 1; b < kJointCount; ++b) {
      if (map.node[a] < 0 || map.node[a] != map.node[b]) continue;
      const bool both = choices.count(kJointNames[a]) > 0 && choices.count(kJointNames[b]) > 0;
      US_CHECK(!both, rig.character.called(), ": the map gives the bone '",
               rig.character.nodes[map.node[a]].name, "' to both ", kJointNames[a], " and ", kJointNames[b]);
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

BoneName parse_bone_name(const std::string& name) {
  BoneName out;
  std::string joined;
  for (std::string word : words_of(name.substr(name.rfind(':') == name.npos ? 0 : name.rfind(':') + 1))) {
    if (std::isdigit(static_cast<unsigned char>(word[0]))) {
      // Numbered parts of a limb after the first are fingers, twist bones and the like.
      if (out.side != 0 && joined != "foot" && joined != "toe" && joined != "ball" &&
          std::stol("0" + word.substr(0, 4)) > 1 && same_words().count(joined) > 0)
        return {out.side, ""};
      continue;
    }
    if (is_one_of(word,
                  {"twist", "roll",  "ik",    "pole",   "target",     "end",   "nub",    "ctrl",   "effector",
                   "top",   "thumb", "index", "middle", "ring",       "pinky", "little", "finger", "fingers",
                   "eye",   "jaw",   "hair",  "skirt",  "metacarpal", "bust",  "breast"}) &&
        !(word == "thumb" && joined == "foot"))
      return {out.side, ""};
    if (starts_with(word, "mixamorig")) word = word.substr(9);
    if (const int side = side_of(word); side != 0 && out.side == 0) {
      out.side = side;
      continue;
    }
    // Poser and CMU write lShin, LHipJoint, and some Lefthand.
    for (const auto& [start, side] : {std::pair{"left", -1}, std::pair{"right", 1}})
      if (out.side == 0 && word.size() > 5 && starts_with(word, start)) {
        out.side = side;
        word = word.substr(std::string(start).size());
      }
    if (is_one_of(word, {"def", "org", "bip", "j", "c", "cc", "base", "bone", "armature", "sk", "rig", "b",
                         "jnt", "joint", "m", "valve", "biped", "deform", "bend"}))
      continue;
    joined += word;
  }
  if (const auto known = same_words().find(joined); known != same_words().end()) out.what = known->second;
  return out;
}

BoneMap map_bones(const Character& character, const std::vector<Mat4>& bind, const BoneChoices& choices) {
  US_CHECK(bind.size() == character.nodes.size(), "the bind pose has ", bind.size(), " nodes, the character ",
           character.nodes.size());
  const Rig rig = make_rig(character, bind);
  BoneMap map;
  map_limbs_by_name(named_bones(rig), map);
  if (map.has(LeftHip) && map.has(RightHip)) map_trunk(rig, 0.8f, map);
  trust_hierarchy(rig, map);
  const std::string family = family_of(character);
  map.how = "by names" + (family.empty() ? "" : " (" + family + ")");
  if (!map.usable() && !character.skins.empty()) {
    const BoneMap placed = map_by_place(rig);
    if (placed.usable() || placed.count() > map.count()) map = placed;
    map.how = "by hierarchy and position";
  }
  apply_choices(rig, choices, map);
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
