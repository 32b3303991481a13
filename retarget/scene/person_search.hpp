// Finds people among the cells of a scan of which nothing is known yet.
#pragma once

#include <functional>
#include <vector>

#include "retarget/scene/flat_parts.hpp"
#include "retarget/scene/person_evidence.hpp"

namespace understudy {

/// Looks with the extractor at the points in cells.
using LookAtCells = std::function<PersonEvidence(const CellSet&)>;

struct FoundPerson {
  CellSet cells;
  PersonEvidence evidence;
};

/// What a search finds. Every cell searched is of one person, of one thing, or of nobody (in none of them).
struct SearchResult {
  std::vector<FoundPerson> people;
  std::vector<FoundPerson> things;  ///< as large as a person or larger, but nobody by what the extractor says
  std::vector<FlatPart> flat_parts;
};

/// Whether an axis-aligned box about points can be about one body: no side longer than 2.6 m.
bool is_body_sized(const Cells& cells, const CellSet& set);

/// Finds people among the cells for which `taken` is not 0: connected sets first; what is no person so is cut
/// at large flat parts, under heads and around the skeleton seen in it.
SearchResult search_people(const Cells& cells, const std::vector<char>& taken, const LookAtCells& look);

}  // namespace understudy
