// What is asked of sets of a scan's cells.
#pragma once

#include <vector>

#include "retarget/geometry/cells.hpp"

namespace understudy {

/// The box about a set's points, and their mean. Metres.
struct CellExtent {
  Vec3 low = Vec3::Constant(1e9f), high = Vec3::Constant(-1e9f), mean = Vec3::Zero();
  Vec3 size() const { return high - low; }
};
CellExtent extent_of(const Cells& cells, const CellSet& set);

/// Of each cell whether it is in the set. [cells]
std::vector<char> flags_of(const Cells& cells, const CellSet& set);

/// The shortest distance, metres, between about `most_a` cells of one set and `most_b` of the other.
float gap_between(const Cells& cells, const CellSet& a, const CellSet& b, size_t most_a, size_t most_b);

}  // namespace understudy
