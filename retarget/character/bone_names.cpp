#include "retarget/character/bone_names.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

#include "retarget/base/text.hpp"

namespace understudy {
namespace {

// What words mean, a row a meaning: a part of the body, or one of these.
constexpr const char *kLeftWord = "<", *kRightWord = ">", *kUpperWord = "+", *kLowerWord = "-";
constexpr const char *kHelperWord = "!", *kFingerWord = "?", *kSaysNothing = "";
struct Meaning {
  const char* what;
  const char* words;
};
constexpr Meaning kMeanings[] = {
    {kLeftWord, "left l lf lft 左 hidari links izquierda gauche"},
    {kRightWord, "right r rt rgt 右 migi rechts derecha droite"},
    {kUpperWord, "upper up"},
    {kLowerWord, "lower low"},
    {kSaysNothing, "base bone joint jnt bend stretch def org rig skin main fore"},
    {"pelvis", "pelvis hips 下半身 kahanshin 骨盤 becken bassin"},
    {"hip", "hip"},
    {"root", "root cog center centre master センター グルーブ 全ての親 腰 koshi"},
    {"thigh", "thigh femur 太もも もも 大腿 oberschenkel cuisse muslo coscia"},
    {"leg", "leg legs 足 脚 ashi bein jambe pierna gamba"},
    {"calf", "calf shin knee tibia shank ひざ 膝 hiza すね 小腿 unterschenkel knie genou rodilla"},
    {"ankle", "ankle talus 足首 ashikubi cheville tobillo"},
    {"foot", "foot feet fuss pied"},
    {"heel", "heel calcn calcaneus かかと"},
    {"toe", "toe toes ball つま先 足先 tsumasaki zehe"},
    {"metatarsal", "metatarsal metatarsals"},
    {"collar", "clavicle collar clav 鎖骨 sakotsu"},
    {"scapula", "scapula"},
    {"shoulder", "shoulder 肩 kata schulter epaule hombro spalla"},
    {"shldr", "shldr"},
    {"arm", "arm 腕 ude bras brazo braccio"},
    {"upperarm", "humerus 上腕 oberarm"},
    {"bicep", "bicep biceps"},
    {"forearm", "forearm radius ulna 前腕 unterarm antebrazo"},
    {"elbow", "elbow ひじ 肘 hiji ellbogen coude codo"},
    {"hand", "hand 手 mano"},
    {"wrist", "wrist 手首 tekubi handgelenk poignet"},
    {"palm", "palm"},
    {"neck", "neck throat 首 kubi hals cuello"},
    {"head", "head 頭 atama kopf tete cabeza"},
    {"skull", "skull"},
    {"face", "face 顔"},
    {"spine", "spine back abdomen waist belly stomach lumbar trunk 上半身 jouhanshin 背 bauch"},
    {"torso", "torso"},
    {"body", "body 体"},
    {"chest", "chest thorax ribcage rib ribs 胸 mune"},
    {kFingerWord, "middle mid ring little"},
    {kHelperWord,
     "twist roll ik fk pole target end nub ctrl control effector top tip dummy helper corrective muscle "
     "jiggle "
     "phys physics dyn dynamic offset socket attach weapon prop sword gun shield item holder bag strap belt "
     "finger fingers thumb index pinky pinkie metacarpal carpal digit knuckle nail eye eyes eyelid lid brow "
     "eyebrow jaw mouth lip lips tongue teeth tooth nose nostril cheek ear ears chin temple forehead hair "
     "bang "
     "bangs braid pony ponytail pigtail twintail ribbon bow hat helmet cap horn antenna halo beard mustache "
     "lash skirt dress gown cape cloak coat robe cloth hem sleeve scarf tie tassel frill apron tail wing "
     "wings "
     "feather fin breast bust boob butt buttock glute armor armour pad plate band backpack pocket share mch "
     "driver camera light locator space pivot assimp crotch groin platform accessory chain rope string cable "
     "earring rear part 捩 捻 ＩＫ 親指 人指 人差指 中指 薬指 小指 指 目 瞳 眉 髪 舌 歯 顎 あご 耳 リボン "
     "スカート "
     "袖 尻尾 しっぽ 翼 羽 ネクタイ マント 乳 ダミー 補助 先 キャンセル"}};

const std::map<std::string, std::string>& meanings() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> out;
    for (const Meaning& meaning : kMeanings) {
      std::istringstream words(meaning.words);
      for (std::string word; words >> word;) out[word] = meaning.what;
    }
    return out;
  }();
  return all;
}

/// What a part's word is worth for each role that it can mean; for all others it speaks against.
struct Worth {
  BoneRole role;
  float evidence;
};
const std::map<std::string, std::vector<Worth>>& worths() {
  using Role = BoneRole;
  static const std::map<std::string, std::vector<Worth>> all = {
      {"pelvis", {{Role::Pelvis, 3}}},
      {"root", {{Role::Pelvis, 0.5f}}},
      {"thigh", {{Role::Hip, 3}}},
      {"hip", {{Role::Hip, 2}}},
      {"leg", {{Role::Hip, 2}, {Role::Knee, 2}}},
      {"calf", {{Role::Knee, 3}}},
      {"ankle", {{Role::Ankle, 3}}},
      {"foot", {{Role::Ankle, 2.5f}, {Role::Toe, 1}}},
      {"heel", {{Role::Ankle, 0.5f}, {Role::Toe, -1}}},
      {"toe", {{Role::Toe, 3}}},
      {"metatarsal", {{Role::Toe, 1.5f}}},
      {"collar", {{Role::Collar, 3}}},
      {"scapula", {{Role::Collar, 2}}},
      {"shoulder", {{Role::Collar, 2}, {Role::Shoulder, 2}}},
      {"shldr", {{Role::Shoulder, 2.5f}, {Role::Collar, 1}}},
      {"arm", {{Role::Shoulder, 2}, {Role::Elbow, 0.5f}}},
      {"upperarm", {{Role::Shoulder, 3}}},
      {"bicep", {{Role::Shoulder, 1}, {Role::Elbow, -1.5f}}},
      {"forearm", {{Role::Elbow, 2.5f}}},
      {"elbow", {{Role::Elbow, 3}}},
      {"hand", {{Role::Wrist, 2.5f}}},
      {"wrist", {{Role::Wrist, 3}}},
      {"palm", {{Role::Wrist, 2}}},
      {"neck", {{Role::Neck, 3}}},
      {"head", {{Role::Head, 3}}},
      {"skull", {{Role::Head, 1.5f}}},
      {"face", {{Role::Head, -1}}},
      {"spine", {{Role::Spine, 2}, {Role::Chest, 2}, {Role::Pelvis, -1}, {Role::Neck, 0}, {Role::Head, 0}}},
      {"torso", {{Role::Spine, 2}, {Role::Chest, 2}, {Role::Pelvis, 0}}},
      {"lower torso", {{Role::Pelvis, 1.5f}, {Role::Spine, 1}, {Role::Chest, -1}}},
      {"body", {{Role::Spine, 0.5f}, {Role::Chest, 0.5f}, {Role::Pelvis, 0.5f}}},
      {"chest", {{Role::Chest, 3}, {Role::Spine, 1.5f}}}};
  return all;
}

/// Words as people see them: "mixamorig:LeftUpLeg" -> left up leg; other scripts stay in one piece.
std::vector<std::string> words_in(const std::string& name) {
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
    const bool foreign = c >= 0x80;
    if (!foreign && !std::isalnum(c)) {
      finish();
      continue;
    }
    const bool hump =
        std::isupper(c) && (std::islower(before) || (std::isupper(before) && std::islower(after)));
    if (hump || foreign != (before >= 0x80) || (std::isdigit(c) != 0) != (std::isdigit(before) != 0))
      finish();
    word.push_back(static_cast<char>(c));
  }
  finish();
  return words;
}

/// Without a namespace, and with the blanks that FBX writes as FBXASC032.
std::string plain_name(std::string name) {
  if (const size_t colon = name.find_last_of(":|"); colon != name.npos) name = name.substr(colon + 1);
  const std::string mark = "FBXASC";
  for (size_t at = name.find(mark); at != name.npos; at = name.find(mark, at)) {
    const size_t digits = std::min<size_t>(3, name.size() - at - mark.size());
    name.replace(at, mark.size() + digits, " ");
  }
  return name;
}

bool is_side(const std::string& piece) {
  const auto found = meanings().find(piece);
  return found != meanings().end() && (found->second == kLeftWord || found->second == kRightWord);
}

/// A word written together as the fewest known ones: "leftupperarm" -> left upper arm. Single letters are
/// sides, at its ends alone. Empty: it is not made of known words.
std::vector<std::string> pieces_of(const std::string& word) {
  constexpr size_t kLongest = 40;
  if (meanings().count(word) > 0) return {word};
  if (word.size() > kLongest) return {};
  std::vector<std::vector<std::string>> best(word.size() + 1);
  for (size_t end = 1; end <= word.size(); ++end)
    for (size_t begin = 0; begin < end; ++begin) {
      const std::string piece = word.substr(begin, end - begin);
      const bool known = meanings().count(piece) > 0 && (begin == 0 || !best[begin].empty());
      const bool at_end = begin == 0 || end == word.size();
      if (!known || (piece.size() < 3 && !(is_side(piece) ? at_end : piece == "up"))) continue;
      if (best[end].empty() || best[begin].size() + 1 < best[end].size()) {
        best[end] = best[begin];
        best[end].push_back(piece);
      }
    }
  return best[word.size()];
}

/// Known words in a run of another script, the longest first; what is between them says nothing.
std::vector<std::string> foreign_pieces(const std::string& word) {
  std::vector<std::string> out;
  for (size_t at = 0; at < word.size();) {
    size_t length = std::min<size_t>(24, word.size() - at);
    while (length > 0 && meanings().count(word.substr(at, length)) == 0) --length;
    if (length > 0) out.push_back(word.substr(at, length));
    at += std::max<size_t>(1, length);
  }
  return out;
}

/// The part that two words name together.
std::string with_height(const std::string& part, bool upper, bool lower, bool fore) {
  if (part == "arm" && upper) return "upperarm";
  if (part == "arm" && (lower || fore)) return "forearm";
  if (part == "leg" && upper) return "thigh";
  if (part == "leg" && lower) return "calf";
  if (part == "body" && (upper || lower)) return upper ? "spine" : "pelvis";
  return part == "torso" && lower ? "lower torso" : part;
}

}  // namespace

float BoneName::evidence(BoneRole role) const {
  constexpr float kHelper = -4, kOther = -2.5f, kUnknownWord = 0.25f;
  if (is_helper) return kHelper;
  const float less = kUnknownWord * static_cast<float>(std::min(unknown, 2));
  if (what.empty()) return 0;
  if (what == "hip" && side == 0) return role == BoneRole::Pelvis ? 2 - less : kOther;
  for (const Worth& worth : worths().at(what))
    if (worth.role == role) return worth.evidence - less;
  return kOther;
}

BoneName parse_bone_name(const std::string& name, const std::set<std::string>& ignored) {
  BoneName out;
  bool upper = false, lower = false, fore = false, finger = false;
  std::string part;
  const auto take = [&](const std::string& piece) {
    const std::string& what = meanings().at(piece);
    if (what != kLeftWord && what != kRightWord) out.key += piece + " ";
    if (what == kLeftWord || what == kRightWord)
      out.side = out.side != 0 ? out.side : what == kLeftWord ? -1 : 1;
    else if (what == kHelperWord && piece == "thumb" && part == "foot")
      part = "toe";
    else if (what == kHelperWord)
      out.is_helper = true;
    else if (what == kFingerWord)
      finger = true;
    else if (what == kUpperWord || what == kLowerWord)
      (what == kUpperWord ? upper : lower) = true;
    else if (what == kSaysNothing)
      fore = fore || piece == "fore";
    else
      part = part == "spine" && what == "shoulder" ? "chest" : what;  // SpineShoulder
  };
  for (const std::string& word : words_in(plain_name(name))) {
    const auto first = static_cast<unsigned char>(word[0]);
    if (std::isdigit(first)) {
      out.number = static_cast<int>(std::stol(word.substr(0, 6)));
      out.key += word + " ";
      continue;
    }
    if (ignored.count(word) > 0) continue;
    const auto pieces = first >= 0x80 ? foreign_pieces(word) : pieces_of(word);
    for (const std::string& piece : pieces) take(piece);
    if (!pieces.empty()) continue;
    out.key += word + " ";
    out.unknown += word.size() > 2 ? 1 : 0;
  }
  out.is_helper = out.is_helper || (finger && out.side != 0) || (out.side != 0 && part == "chest");
  if (!out.is_helper) out.what = with_height(part, upper, lower, fore);
  return out;
}

std::set<std::string> common_words(const std::vector<std::string>& names) {
  constexpr size_t kLeast = 10;
  std::map<std::string, size_t> count;
  size_t named = 0;
  for (const std::string& name : names) {
    const auto words = words_in(plain_name(name));
    named += words.empty() ? 0 : 1;
    for (const std::string& word : std::set<std::string>(words.begin(), words.end())) ++count[word];
  }
  std::set<std::string> out;
  for (const auto& [word, times] : count)
    if (named >= kLeast && 20 * times > 17 * named) out.insert(word);
  return out;
}

}  // namespace understudy
