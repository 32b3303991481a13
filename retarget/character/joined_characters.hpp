// Several animated characters in one document, where they play at once.
#pragma once

#include <string>
#include <vector>

#include "retarget/character/character.hpp"

namespace understudy {

/// One node above all, number 0.
void add_root(Character& character, const CharacterNode& root);
/// A skinned mesh goes where its bones are, whatever its node has: at the top, plain, no program is misled.
void lift_skinned_nodes(Character& character);

/// One of several characters that share a document.
struct CastMember {
  std::string name;           ///< of the node above all of its own but the skinned meshes
  Vec3 place = Vec3::Zero();  ///< of that node
  Character character;        ///< all in the same units and axes
  size_t shared = 0;          ///< so many of its animations, the first ones, play together with the others'
};

/// All of them, nodes and parts one member after the other. Number i of the shared animations moves everybody
/// who has as many, and is called as the first of them calls it; the animations that are nobody else's come
/// after. Equal pictures, samplers and textures are kept once. A name of a node or an animation that is
/// taken gets the member's before it, "Ann:Hips": programs that go by names confuse nobody.
Character joined(std::vector<CastMember> cast);

}  // namespace understudy
