// Tables, chairs and cabinets of blocks.
#pragma once

#include "retarget/body/block.hpp"

namespace understudy {

/// Made about the origin on the ground y = 0, facing +z.
using Furniture = std::vector<Block>;

/// For people of a height, share of a mean one's; random in size.
Furniture table(float size, Rng& rng);
/// With a seat at this height, metres; most with a back.
Furniture chair(float seat, Rng& rng);
Furniture cabinet(Rng& rng);
/// One of them.
Furniture any_furniture(float size, Rng& rng);

/// Turns it about its foot, then puts that somewhere.
void place(Furniture& thing, const Vec3& foot, const Mat3& turn);

/// Square metres.
float surface_of(const Furniture& thing);
/// A point of it, all alike likely; `surface` is surface_of().
Vec3 sample_of(const Furniture& thing, float surface, Rng& rng);

}  // namespace understudy
