#include "retarget/character/joined_characters.hpp"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy {
namespace {

using Json = nlohmann::json;
using Numbers = std::vector<int>;  // of each item of a member's list, its number in the common one

template <class T>
void move_to_end(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

template <class T, class Same>
int number_in(std::vector<T>& list, T item, const Same& same) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const T& other) { return same(item, other); });
  const auto number = static_cast<int>(found - list.begin());
  if (found == list.end()) list.push_back(std::move(item));
  return number;
}

void renumber(Json& object, const char* key, const Numbers& numbers) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_integer()) return;
  const auto number = found->get<int64_t>();
  US_CHECK(number >= 0 && number < ssize(numbers), "a material names number ", number, " of ", numbers.size(),
           " as its ", key);
  *found = numbers[static_cast<size_t>(number)];
}

std::string renumbered_texture(const std::string& text, const Numbers& images, const Numbers& samplers) {
  Json texture = Json::parse(text);
  renumber(texture, "source", images);
  renumber(texture, "sampler", samplers);
  const auto extensions = texture.find("extensions");
  if (extensions != texture.end())
    for (Json& extension : *extensions)
      if (extension.is_object()) renumber(extension, "source", images);
  return texture.dump();
}

/// Every texture that a material names, in its extensions, too.
void renumber_textures(Json& value, const Numbers& textures) {
  if (value.is_object())
    for (const auto& item : value.items())
      if (ends_with(item.key(), "Texture") && item.value().is_object())
        renumber(item.value(), "index", textures);
  if (value.is_structured())
    for (Json& inner : value) renumber_textures(inner, textures);
}

void add_materials(Character& from, Character& out) {
  const auto same_text = [](const std::string& a, const std::string& b) { return a == b; };
  const auto same_picture = [](const CharacterImage& a, const CharacterImage& b) {
    return a.mime == b.mime && a.bytes == b.bytes;
  };
  Numbers images, samplers, textures;
  for (CharacterImage& image : from.images)
    images.push_back(number_in(out.images, std::move(image), same_picture));
  for (std::string& sampler : from.samplers)
    samplers.push_back(number_in(out.samplers, std::move(sampler), same_text));
  for (const std::string& texture : from.textures)
    textures.push_back(number_in(out.textures, renumbered_texture(texture, images, samplers), same_text));
  for (const std::string& text : from.materials) {
    Json material = Json::parse(text);
    renumber_textures(material, textures);
    out.materials.push_back(material.dump());
  }
}

void unite(const std::vector<std::string>& from, std::vector<std::string>& out) {
  std::set<std::string> all(out.begin(), out.end());
  all.insert(from.begin(), from.end());
  out.assign(all.begin(), all.end());
}

void put_below_top(CastMember& member) {
  CharacterNode top;
  top.name = member.name;
  top.local.translation = member.place;
  add_root(member.character, top);
  lift_skinned_nodes(member.character);
}

/// Of nodes or animations: those with a name in `taken` get the member's name before it.
template <class Named>
void rename_taken(const std::string& member, const std::set<std::string>& taken, std::vector<Named>& all) {
  for (Named& one : all)
    while (!one.name.empty() && taken.count(one.name) > 0) one.name.insert(0, member + ":");
}

template <class Named>
std::set<std::string> names_of(const std::vector<Named>& all) {
  std::set<std::string> names;
  for (const Named& one : all) names.insert(one.name);
  return names;
}

/// With all numbers as they are in `out` after it.
void add_shape(Character from, Character& out) {
  const auto first_node = static_cast<int>(out.nodes.size()), first_skin = static_cast<int>(out.skins.size()),
             first_material = static_cast<int>(out.materials.size());
  for (CharacterNode& node : from.nodes)
    if (node.parent >= 0) node.parent += first_node;
  for (CharacterSkin& skin : from.skins)
    for (int& joint : skin.joints) joint += first_node;
  for (CharacterPart& part : from.parts) {
    part.node += first_node;
    if (part.skin >= 0) part.skin += first_skin;
    if (part.material >= 0) part.material += first_material;
  }
  add_materials(from, out);
  unite(from.extensions, out.extensions);
  unite(from.required, out.required);
  move_to_end(from.nodes, out.nodes);
  move_to_end(from.skins, out.skins);
  move_to_end(from.parts, out.parts);
}

/// Of the member whose nodes begin with `first_node`. own: those that are nobody else's.
void add_animations(CastMember& member, int first_node, Character& out,
                    std::vector<CharacterAnimation>& own) {
  auto& animations = member.character.animations;
  for (CharacterAnimation& animation : animations)
    for (CharacterTrack& track : animation.tracks) track.node += first_node;
  for (size_t i = 0; i < animations.size(); ++i) {
    if (i >= member.shared)
      own.push_back(std::move(animations[i]));
    else if (i >= out.animations.size())
      out.animations.push_back(std::move(animations[i]));
    else
      move_to_end(animations[i].tracks, out.animations[i].tracks),
          move_to_end(animations[i].made, out.animations[i].made);
  }
}

}  // namespace

void add_root(Character& character, const CharacterNode& root) {
  for (auto& node : character.nodes) ++node.parent;  // -1 becomes the root, number 0
  character.nodes.insert(character.nodes.begin(), root);
  for (auto& part : character.parts) ++part.node;
  for (auto& skin : character.skins)
    for (int& joint : skin.joints) ++joint;
  for (auto& animation : character.animations)
    for (auto& track : animation.tracks) ++track.node;
}

void lift_skinned_nodes(Character& character) {
  std::vector<bool> is_needed(character.nodes.size(), false);
  for (const auto& node : character.nodes)
    if (node.parent >= 0) is_needed[node.parent] = true;
  for (const auto& skin : character.skins)
    for (const int joint : skin.joints) is_needed[joint] = true;
  for (const auto& part : character.parts) {
    if (part.skin < 0 || is_needed[part.node]) continue;
    CharacterNode& node = character.nodes[part.node];
    node.parent = -1;
    node.local = Transform();
  }
}

Character joined(std::vector<CastMember> cast) {
  Character out;
  std::vector<std::vector<CharacterAnimation>> own(cast.size());
  for (size_t m = 0; m < cast.size(); ++m) {
    CastMember& member = cast[m];
    std::set<std::string> taken = names_of(out.nodes);
    const std::string name = member.name;
    for (int i = 2; !taken.insert(member.name).second; ++i) member.name = name + " " + std::to_string(i);
    append_item(out.name, member.name);
    rename_taken(member.name, taken, member.character.nodes);
    put_below_top(member);
    add_animations(member, static_cast<int>(out.nodes.size()), out, own[m]);
    add_shape(std::move(member.character), out);
  }
  for (size_t m = 0; m < cast.size(); ++m) {
    rename_taken(cast[m].name, names_of(out.animations), own[m]);
    move_to_end(own[m], out.animations);
  }
  return out;
}

}  // namespace understudy
