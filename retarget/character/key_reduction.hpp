// Fewer keys for the same animation.
#pragma once

#include "retarget/character/character.hpp"

namespace understudy {

/// Leaves out keys of a linear track that its neighbours give back within the tolerance: radians for
/// rotations, the track's own unit otherwise. First and last stay; a track that does not change keeps one
/// key. Throws Error for tracks that are not linear.
CharacterTrack reduced(const CharacterTrack& track, float tolerance);

}  // namespace understudy
