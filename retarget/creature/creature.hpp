// Creatures made by code: bodies with true joints and skin weights that perform motions of their kind.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "retarget/rig/rig.hpp"

namespace understudy {

enum class CreatureKind { Arm, Lamp, Excavator, Hand, Quadruped, Insect, Bird, Snake };
constexpr std::array<const char*, 8> kCreatureNames = {"arm",       "lamp",   "excavator", "hand",
                                                       "quadruped", "insect", "bird",      "snake"};

/// One creature; its proportions follow from the seed. A closed surface of 4,000 to 9,000 vertices on the
/// floor, facing +z, 0.2 m (a hand) to 4 m (an excavator) large, in the same bytes for the same seed.
Rig make_creature(CreatureKind kind, uint64_t seed);

/// Names of what a kind can do, at least two.
const std::vector<std::string>& creature_motions(CreatureKind kind);
/// A clip of one of them, `motion` counts as in creature_motions. rig: a creature of this kind. The seed
/// gives tempo and extent. Throws Error where there is no such motion, for frames < 1 and fps <= 0.
RigMotion creature_motion(CreatureKind kind, const Rig& rig, int motion, int frames, double fps,
                          uint64_t seed);
/// Its surface in every frame, [T] of [V, 3]: skinned, and what lives breathes and wobbles.
std::vector<Points> creature_surfaces(CreatureKind kind, const Rig& rig, const RigMotion& motion,
                                      uint64_t seed);

}  // namespace understudy
