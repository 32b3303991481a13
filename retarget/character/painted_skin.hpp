// Skin weights that a user painted for the 22 joints, put into a character's own skins.
#pragma once

#include "retarget/character/prepared_character.hpp"

namespace understudy {

/// Changes JOINTS and WEIGHTS of `out`, a copy of character.character, at the vertices whose row of `weights`
/// [V, 22], those on screen, differs from the rig's own. A joint's weight is shared among its bones as they
/// share the vertex now; where none of them pulls yet, the joint's own bone does. `most`: bones a vertex,
/// unless the part has more. Parts that followed a node alone become skinned.
void apply_painted_weights(const PreparedCharacter& character, const RowMatrix& weights, int most,
                           Character& out);

}  // namespace understudy
