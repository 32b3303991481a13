#include "retarget/scene/person_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/scene/cell_sets.hpp"

namespace understudy {
namespace {

constexpr float kLongestBody = 2.6f;    // metres
constexpr float kLeastArea_m2 = 0.12f;  // of what is looked at
constexpr float kOneBody = 0.25f;       // metres between parts of one body
constexpr float kHeadGap = 0.4f;        // metres between two heads
// Of many cuts some look like a person by chance: what was cut has to look so the more.
constexpr float kGood = 0.5f;
constexpr int kMostFlat = 6, kMostHeads = 6;

std::vector<CellSet> largest_first(std::vector<CellSet> sets) {
  std::stable_sort(sets.begin(), sets.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return sets;
}

/// The shortest distance between two sets, metres.
float gap(const Cells& cells, const CellSet& a, const CellSet& b) {
  return gap_between(cells, a, b, 120, 400);
}

CellSet united(CellSet a, const CellSet& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Where heads may be: the highest places of what is seen from above, far apart.
std::vector<Vec3> heads_in(const Cells& cells, const CellSet& set) {
  std::vector<Vec3> tops;
  for (const int c : set) tops.push_back(cells.mean(c));
  std::stable_sort(tops.begin(), tops.end(), [](const Vec3& a, const Vec3& b) { return a.y() > b.y(); });
  const CellExtent bounds = extent_of(cells, set);
  const float least = bounds.low.y() + 0.5f * bounds.size().y();
  std::vector<Vec3> heads;
  // Arms that are raised are near a head, and shoulders: only what is far from all higher places is another.
  for (const Vec3& top : tops) {
    if (top.y() < least || static_cast<int>(heads.size()) == kMostHeads) break;
    const bool apart = std::all_of(heads.begin(), heads.end(), [&](const Vec3& head) {
      return std::hypot(head.x() - top.x(), head.z() - top.z()) > kHeadGap;
    });
    if (apart) heads.push_back(top);
  }
  return heads;
}

/// The search through one scan.
class Search {
 public:
  Search(const Cells& cells, const LookAtCells& look) : cells_(cells), look_(look) {}

  SearchResult run(const std::vector<char>& taken) {
    std::vector<CellSet> small;
    for (CellSet& set : largest_first(connected_sets(cells_, taken))) {
      if (is_large(set))
        take_apart(set);
      else
        small.push_back(std::move(set));
    }
    join_pieces();
    for (const CellSet& set : small) give_to_nearest(set);
    return std::move(result_);
  }

 private:
  bool is_large(const CellSet& set) const {
    return static_cast<float>(set.size()) * cells_.size_m() * cells_.size_m() >= kLeastArea_m2;
  }

  /// A set that hangs together: one person, several, or none.
  void take_apart(const CellSet& set) {
    const bool fits = is_body_sized(cells_, set);
    FoundPerson whole{set, fits ? look_(set) : PersonEvidence{}};
    if (whole.evidence.quality >= kGood && whole.evidence.covered > 0.9f) {
      result_.people.push_back(std::move(whole));
      return;
    }
    if (!cut_flat(set)) take_rest_apart(std::move(whole));
  }

  /// What has no large flat parts.
  void take_rest_apart(FoundPerson whole) {
    const float quality = whole.evidence.quality;
    const bool is_whole = quality >= kGood && whole.evidence.covered > 0.9f;
    if (!is_whole && (under_heads(whole.cells, quality) || around_skeleton(whole))) return;
    add(std::move(whole));
  }

  void add(FoundPerson found) {
    if (found.cells.empty()) return;
    (found.evidence.is_person() ? result_.people : result_.things).push_back(std::move(found));
  }

  /// Without its large flat parts it falls into pieces. False: it has none.
  bool cut_flat(const CellSet& set) {
    const std::vector<FlatPart> parts = find_flat_parts(cells_, flags_of(cells_, set), kMostFlat);
    if (parts.empty()) return false;
    std::vector<char> left(cells_.count(), 0);
    for (const int c : set)
      left[c] = std::none_of(parts.begin(), parts.end(),
                             [&](const FlatPart& p) { return p.holds(cells_.mean(c)); });
    result_.flat_parts.insert(result_.flat_parts.end(), parts.begin(), parts.end());
    for (CellSet& piece : largest_first(connected_sets(cells_, left))) {
      if (!is_large(piece)) continue;
      FoundPerson found{piece, is_body_sized(cells_, piece) ? look_(piece) : PersonEvidence{}};
      take_rest_apart(std::move(found));
    }
    return true;
  }

  /// Each cell goes to the head above it: people who touch. False: that finds nobody better than the whole
  /// is.
  bool under_heads(const CellSet& set, float quality) {
    const std::vector<Vec3> heads = heads_in(cells_, set);
    if (heads.size() < 2) return false;
    std::vector<FoundPerson> parts(heads.size());
    for (const int c : set) {
      const Vec3 p = cells_.mean(c);
      const auto nearer = [&](const Vec3& a, const Vec3& b) {
        return std::hypot(a.x() - p.x(), a.z() - p.z()) < std::hypot(b.x() - p.x(), b.z() - p.z());
      };
      parts[std::min_element(heads.begin(), heads.end(), nearer) - heads.begin()].cells.push_back(c);
    }
    float best = 0;
    for (FoundPerson& part : parts) {
      if (is_large(part.cells) && is_body_sized(cells_, part.cells)) part.evidence = look_(part.cells);
      best = std::max(best, part.evidence.quality);
    }
    if (best < kGood || best < quality + 0.1f) return false;
    share_out(parts);
    return true;
  }

  /// Cells of parts that are people go to the skeleton that they are nearest to; what is near none is a
  /// thing.
  void share_out(std::vector<FoundPerson>& parts) {
    CellSet all;
    std::vector<FoundPerson> people;
    for (FoundPerson& part : parts) {
      all.insert(all.end(), part.cells.begin(), part.cells.end());
      if (part.evidence.quality >= kGood) people.push_back({{}, part.evidence});
    }
    FoundPerson rest;
    for (const int c : all) {
      float nearest = 1.3f;  // of the reach
      FoundPerson* owner = &rest;
      for (FoundPerson& person : people) {
        const Joints& joints = person.evidence.seen.joints;
        const float distance = bone_distance(cells_.mean(c), joints) / body_reach(joints);
        if (distance < nearest) nearest = distance, owner = &person;
      }
      owner->cells.push_back(c);
    }
    for (FoundPerson& person : people) {
      person.evidence = look_(person.cells);
      if (person.evidence.quality < kGood)
        person.evidence.quality = 0;  // a better view of it is worse: a thing
      add(std::move(person));
    }
    if (is_large(rest.cells)) result_.things.push_back(std::move(rest));
  }

  /// Somebody who touches something: what is near the bones seen is looked at again. False: nobody is there.
  bool around_skeleton(const FoundPerson& whole) {
    FoundPerson best = whole;
    for (int round = 0; round < 3; ++round) {
      if (best.evidence.quality <= 0 && best.evidence.seen.confidence.mean() < 0.1f) return false;
      CellSet near;
      const Joints& joints = best.evidence.seen.joints;
      for (const int c : whole.cells)
        if (bone_distance(cells_.mean(c), joints) <= 1.2f * body_reach(joints)) near.push_back(c);
      if (!is_large(near)) return false;
      const FoundPerson closer{near, look_(near)};
      if (closer.evidence.quality <= best.evidence.quality) break;
      best = closer;
    }
    if (best.evidence.quality < std::max(kGood, whole.evidence.quality + 0.1f)) return false;
    std::vector<char> left = flags_of(cells_, whole.cells);
    for (const int c : best.cells) left[c] = 0;
    result_.people.push_back(std::move(best));
    for (CellSet& piece : largest_first(connected_sets(cells_, left)))
      if (is_large(piece)) result_.things.push_back({std::move(piece), {}});
    return true;
  }

  /// A body seen in two pieces, above and below, is one where that is the better person.
  void join_pieces() {
    auto& people = result_.people;
    auto& things = result_.things;
    for (size_t i = 0; i < people.size(); ++i) {
      for (size_t k = i + 1; k < people.size(); ++k)
        if (join(people[i], people[k])) people.erase(people.begin() + static_cast<int64_t>(k--));
      for (size_t k = 0; k < things.size(); ++k)
        if (join(people[i], things[k])) things.erase(things.begin() + static_cast<int64_t>(k--));
    }
  }

  bool join(FoundPerson& a, const FoundPerson& b) {
    if (a.evidence.quality > 0.8f && b.evidence.quality > 0.8f) return false;
    if (gap(cells_, b.cells, a.cells) > kOneBody) return false;
    FoundPerson both{united(a.cells, b.cells), {}};
    if (!is_body_sized(cells_, both.cells)) return false;
    both.evidence = look_(both.cells);
    if (both.evidence.quality < std::max(a.evidence.quality, b.evidence.quality) + 0.02f) return false;
    a = std::move(both);
    return true;
  }

  /// A hand or a foot that nothing joins to the body.
  void give_to_nearest(const CellSet& set) {
    FoundPerson* nearest = nullptr;
    float least = kOneBody;
    for (FoundPerson& person : result_.people) {
      const float away = gap(cells_, set, person.cells);
      if (away < least) least = away, nearest = &person;
    }
    if (!nearest) return;
    const Joints& joints = nearest->evidence.seen.joints;
    const bool near = std::any_of(set.begin(), set.end(), [&](int c) {
      return bone_distance(cells_.mean(c), joints) <= 1.2f * body_reach(joints);
    });
    if (near) nearest->cells.insert(nearest->cells.end(), set.begin(), set.end());
  }

  const Cells& cells_;
  const LookAtCells& look_;
  SearchResult result_;
};

}  // namespace

bool is_body_sized(const Cells& cells, const CellSet& set) {
  return extent_of(cells, set).size().maxCoeff() <= kLongestBody;
}

SearchResult search_people(const Cells& cells, const std::vector<char>& taken, const LookAtCells& look) {
  return Search(cells, look).run(taken);
}

}  // namespace understudy
