#include "retarget/scene/people.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/index.hpp"
#include "retarget/scene/cell_sets.hpp"

namespace understudy {
namespace {

constexpr float kVotes_s = 0.15f;  // how long after it was seen a track's cells still say whose a place is
constexpr float kRemember_s = 60;  // how long somebody who left is known
constexpr float kReach_m = 0.25f;  // between a body and a piece of it
constexpr float kFastest = 3;      // metres a second that somebody who is not seen goes
constexpr float kHidden_s = 1.5f, kComesOut_m = 0.6f;  // behind another, and how far from where one would be
constexpr float kFresh_s = 0.3f;                       // joints older than this tell nothing
constexpr float kLeastThing_m2 = 0.12f, kLeastGuess_m2 = 0.3f;
constexpr float kGrown = 1.6f;                         // times as many cells as usual: something has joined
constexpr float kPerhaps = 0.1f, kLookAgain_s = 0.2f;  // quality of a thing that may be somebody, half seen
constexpr int kDoubts = 5;                             // frames of it before somebody is searched again
constexpr size_t kGapFrom = 60, kGapTo = 300;          // cells of two sets between which a gap is looked for
constexpr size_t kMostPlaces = 20000;                  // of one thing

std::optional<Vec3> mean_color(const CellFrame& frame, const CellSet& set) {
  if (frame.scan.colors.rows() != frame.scan.vertices.rows() || frame.scan.colors.rows() == 0)
    return std::nullopt;
  const std::vector<char> is_in = flags_of(frame.cells, set);
  Vec3 sum = Vec3::Zero();
  int count = 0;
  const std::vector<int>& cell = frame.cells.of_vertex();
  for (int v = 0; v < ssize(cell); ++v)
    if (cell[v] >= 0 && is_in[cell[v]]) sum += frame.scan.colors.row(v).transpose(), ++count;
  return count > 0 ? std::optional<Vec3>(sum / static_cast<float>(count)) : std::nullopt;
}

float area_of(const CellFrame& frame, const CellSet& set) {
  return static_cast<float>(set.size()) * frame.cells.size_m() * frame.cells.size_m();
}

}  // namespace

std::vector<int> People::push(const CellFrame& frame, std::vector<FlatPart>& flat) {
  label_.assign(frame.cells.count(), -1);
  contested_.clear();
  for (Track& track : tracks_) track.now.clear();
  share_cells(frame);
  refresh_rivals(frame);
  welcome_back(frame);
  give_pieces(frame);
  find_new(frame, flat);
  search_again(frame, flat);
  guess(frame);
  finish(frame);
  std::vector<int> owner(frame.cells.count(), kNobody);
  for (const Track& track : tracks_)
    for (const int c : track.now) owner[c] = track.kind == Kind::Thing ? kScenery : track.id;
  return owner;
}

int People::push_alone(const CellFrame& frame) {
  if (tracks_.empty()) {
    Track track;
    track.kind = Kind::Person;
    track.id = next_id();
    tracks_.push_back(track);
  }
  Track& track = tracks_[0];
  track.now.clear();
  for (int c = 0; c < frame.cells.count(); ++c) track.now.push_back(c);
  finish(frame);
  return tracks_[0].id;
}

void People::tell(int id, const Extraction& seen, bool believed) {
  Track* const track = person(id);
  if (!track) return;
  if (!believed) {
    track->doubts += 2;
    return;
  }
  track->joints = seen.joints;
  track->joints_age_s = 0;
  track->leg_m =
      track->leg_m > 0 ? 0.9f * track->leg_m + 0.1f * leg_length(seen.joints) : leg_length(seen.joints);
  track->quality = seen.confidence.mean();
  if (track->quality > 0.3f) track->kind = Kind::Person;
}

std::vector<ScenePerson> People::list() const {
  std::vector<ScenePerson> result;
  for (const Track& t : tracks_)
    if (t.kind != Kind::Thing)
      result.push_back(
          {t.id, t.kind == Kind::Person, t.quality, t.centre, t.size, t.points, t.moved_m, t.unseen_s});
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return result;
}

/// Found anew by a search.
void People::Track::see(const PersonEvidence& evidence) {
  quality = evidence.quality;
  joints = evidence.seen.joints;
  leg_m = leg_length(*joints);
  joints_age_s = 0;
}

bool People::any_thing() const {
  return std::any_of(tracks_.begin(), tracks_.end(), [](const Track& t) { return t.kind == Kind::Thing; });
}

People::Track* People::person(int id) {
  for (Track& track : tracks_)
    if (track.id == id && track.kind != Kind::Thing) return &track;
  return nullptr;
}

/// Whose each connected set of cells is, by whose cells were there; sets of several are split.
void People::share_cells(const CellFrame& frame) {
  const Cells& cells = frame.cells;
  CellMap before(4096);
  // What stands still is known best: its places win over those that somebody moved into.
  for (const bool things : {true, false})
    for (int t = 0; t < ssize(tracks_); ++t) {
      const Track& track = tracks_[t];
      if ((track.kind == Kind::Thing) != things || track.unseen_s > kVotes_s) continue;
      const CellMap::Place shift = (track.velocity * frame.dt / cells.size_m()).array().round().cast<int>();
      for (const CellMap::Place& place : track.places) before.at(place + shift, t);
    }
  const std::vector<CellSet> sets = connected_sets(cells, frame.taken);
  for (int c = 0; c < cells.count(); ++c) {
    if (!frame.taken[c]) continue;
    label_[c] = before.find(cells.place(c));
    for (size_t k = 0; k < neighbour_cells().size() && label_[c] < 0; ++k)
      label_[c] = before.find(cells.place(c) + neighbour_cells()[k]);
  }
  for (const CellSet& set : sets) {
    std::vector<int> votes(tracks_.size(), 0), rivals;
    for (const int c : set)
      if (label_[c] >= 0) ++votes[label_[c]];
    const int least = std::max(4, static_cast<int>(set.size()) / 50);
    for (int t = 0; t < ssize(votes); ++t)
      if (votes[t] >= least) rivals.push_back(t);
    if (rivals.empty() && set.size() < 8)
      if (const auto most = std::max_element(votes.begin(), votes.end()); most != votes.end() && *most > 0)
        rivals.push_back(static_cast<int>(most - votes.begin()));
    if (rivals.size() > 1)
      split(frame, set, rivals);
    else
      for (const int c : set) label_[c] = rivals.empty() ? -1 : rivals[0];
  }
  release_pieces(frame, sets);
  for (int c = 0; c < cells.count(); ++c)
    if (label_[c] >= 0) tracks_[label_[c]].now.push_back(c);
}

/// What somebody had, but hangs together with nothing else of theirs and is far from them: another, who was
/// hidden, comes out behind.
void People::release_pieces(const CellFrame& frame, const std::vector<CellSet>& sets) {
  std::vector<CellSet> main(tracks_.size());
  const auto owner_of = [&](const CellSet& set) { return label_[set[0]]; };
  for (const CellSet& set : sets)
    if (const int t = owner_of(set); t >= 0 && set.size() > main[t].size()) main[t] = set;
  for (const CellSet& set : sets) {
    const int t = owner_of(set);
    if (t < 0 || tracks_[t].kind == Kind::Thing || set[0] == main[t][0]) continue;
    const Track& track = tracks_[t];
    const bool is_known = track.joints && track.joints_age_s <= kFresh_s;
    const auto is_off = [&](int c) {
      return bone_distance(frame.cells.mean(c), *track.joints) > 1.5f * body_reach(*track.joints);
    };
    const bool is_far = gap_between(frame.cells, set, main[t], kGapFrom, kGapTo) > 2 * kReach_m;
    const auto off = is_known ? std::count_if(set.begin(), set.end(), is_off) : 0;
    if (!is_far && 2 * off <= ssize(set)) continue;
    for (const int c : set)
      if (label_[c] == t) label_[c] = -1;
  }
}

/// Cells that were somebody's stay theirs, the others go to the nearest of these through the set.
void People::split(const CellFrame& frame, const CellSet& set, const std::vector<int>& rivals) {
  std::vector<int> open, next;
  for (const int c : set) {
    if (std::find(rivals.begin(), rivals.end(), label_[c]) == rivals.end()) label_[c] = -1;
    if (label_[c] >= 0) open.push_back(c);
  }
  const std::vector<char> is_in = flags_of(frame.cells, set);
  for (; !open.empty(); open.swap(next)) {
    next.clear();
    for (const int c : open)
      for (const CellMap::Place& step : neighbour_cells()) {
        const int beside = frame.cells.find(frame.cells.place(c) + step);
        if (beside < 0 || !is_in[beside] || label_[beside] >= 0) continue;
        label_[beside] = label_[c];
        next.push_back(beside);
      }
  }
  for (const int t : rivals)
    if (tracks_[t].kind != Kind::Thing) contested_.push_back(t);
  // Where the bones of two are known, what lies on the other's goes over to them.
  for (const int c : set) {
    const Track& own = tracks_[label_[c]];
    if (own.kind == Kind::Thing || !own.joints || own.joints_age_s > kFresh_s) continue;
    const Vec3 p = frame.cells.mean(c);
    const float mine = bone_distance(p, *own.joints) / body_reach(*own.joints);
    if (mine < 1) continue;
    for (const int t : rivals) {
      const Track& other = tracks_[t];
      if (other.kind == Kind::Thing && mine > 1.4f) label_[c] = t;
      if (other.kind == Kind::Thing || !other.joints || other.joints_age_s > kFresh_s) continue;
      if (bone_distance(p, *other.joints) / body_reach(*other.joints) < std::min(0.8f, 0.6f * mine))
        label_[c] = t;
    }
  }
}

/// While people touch, the bones of one of them a frame are looked at anew.
void People::refresh_rivals(const CellFrame& frame) {
  std::vector<int> people;
  for (const int t : contested_)
    if (std::find(people.begin(), people.end(), t) == people.end()) people.push_back(t);
  if (people.size() < 2) return;
  Track& track = tracks_[people[turn_++ % people.size()]];
  if (area_of(frame, track.now) < kLeastThing_m2) return;
  const PersonEvidence evidence = frame.look(track.now);
  if (evidence.quality < 0.4f) return;
  track.joints = evidence.seen.joints;
  track.joints_age_s = 0;
  track.quality = evidence.quality;
}

/// Of each cell whether nobody has it yet.
std::vector<char> People::left_over(const CellFrame& frame) const {
  std::vector<char> left(frame.cells.count(), 0);
  for (int c = 0; c < frame.cells.count(); ++c) left[c] = frame.taken[c] && label_[c] < 0;
  return left;
}

/// Pieces that are near somebody, and small, are theirs.
void People::give_pieces(const CellFrame& frame) {
  for (const CellSet& set : connected_sets(frame.cells, left_over(frame))) {
    int nearest = -1;
    float least = kReach_m;
    for (int t = 0; t < ssize(tracks_); ++t) {
      const Track& track = tracks_[t];
      if (track.now.empty() || 3 * set.size() > track.now.size()) continue;
      const float gap = gap_between(frame.cells, set, track.now, kGapFrom, kGapTo);
      if (gap < least) least = gap, nearest = t;
    }
    if (nearest < 0) continue;
    for (const int c : set) label_[c] = nearest;
    tracks_[nearest].now.insert(tracks_[nearest].now.end(), set.begin(), set.end());
  }
}

/// Who was hidden for a moment comes out where they were going.
void People::welcome_back(const CellFrame& frame) {
  for (const CellSet& set : connected_sets(frame.cells, left_over(frame))) {
    if (area_of(frame, set) < kLeastThing_m2 || !is_body_sized(frame.cells, set)) continue;
    const Vec3 centre = extent_of(frame.cells, set).mean;
    int nearest = -1;
    float least = kComesOut_m;
    for (int t = 0; t < ssize(tracks_); ++t) {
      const Track& track = tracks_[t];
      if (track.kind != Kind::Person || !track.now.empty() || track.unseen_s > kHidden_s) continue;
      Vec3 off = centre - track.centre - track.velocity * track.unseen_s;
      off.y() *= 0.5f;  // the head or the legs alone
      if (off.norm() < least) least = off.norm(), nearest = t;
    }
    if (nearest < 0) continue;
    for (const int c : set) label_[c] = nearest;
    tracks_[nearest].now = set;
  }
}

/// What nobody had is searched for people.
void People::find_new(const CellFrame& frame, std::vector<FlatPart>& flat) {
  const std::vector<char> left = left_over(frame);
  const auto count = static_cast<float>(std::count(left.begin(), left.end(), 1));
  if (count * frame.cells.size_m() * frame.cells.size_m() >= kLeastThing_m2)
    adopt(frame, search_people(frame.cells, left, frame.look), flat);
  first_ = false;
}

/// Things that moved or grew may be people after all; people who grew may be two, or have taken something up.
void People::search_again(const CellFrame& frame, std::vector<FlatPart>& flat) {
  for (size_t t = 0; t < tracks_.size(); ++t) {
    Track& track = tracks_[t];
    track.look_in_s -= frame.dt;
    if (track.now.empty()) continue;
    const auto cells = static_cast<float>(track.now.size());
    const bool grown = cells > kGrown * track.usual_cells && area_of(frame, track.now) > 0.3f;
    const bool moves = track.velocity.norm() > 0.15f;
    if (track.kind == Kind::Person) track.doubts = grown ? track.doubts + 1 : std::max(0, track.doubts - 1);
    const bool perhaps = track.kind != Kind::Person && track.quality > kPerhaps;
    const bool wanted = track.kind == Kind::Person
                            ? track.doubts >= kDoubts
                            : (grown || moves || perhaps || track.kind == Kind::Unsure);
    if (!wanted || track.look_in_s > 0 || area_of(frame, track.now) < kLeastThing_m2) continue;
    track.look_in_s = track.kind == Kind::Person ? 2.0f : perhaps ? kLookAgain_s : 1.0f;
    SearchResult found = search_people(frame.cells, flags_of(frame.cells, track.now), frame.look);
    track.doubts = 0;
    track.usual_cells = std::max(track.usual_cells, cells);
    if (found.people.empty()) continue;
    if (track.kind != Kind::Thing) {  // the nearest stays who they are
      const auto distance = [&](const FoundPerson& one) {
        return (extent_of(frame.cells, one.cells).mean - track.centre).norm();
      };
      const auto same =
          std::min_element(found.people.begin(), found.people.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
      track.kind = Kind::Person;
      track.now = same->cells;
      track.usual_cells = static_cast<float>(track.now.size());
      track.see(same->evidence);
      found.people.erase(same);
    } else {
      track.now.clear();
      track.places.clear();
      track.unseen_s = kRemember_s + 1;
    }
    adopt(frame, std::move(found), flat);  // may move the tracks
  }
}

void People::adopt(const CellFrame& frame, SearchResult found, std::vector<FlatPart>& flat) {
  for (const FlatPart& part : found.flat_parts)
    if (flat.size() < kMost) flat.push_back(part);
  // Who is seen best comes first.
  std::stable_sort(found.people.begin(), found.people.end(), [](const FoundPerson& a, const FoundPerson& b) {
    return a.evidence.quality * std::sqrt(static_cast<float>(a.cells.size())) >
           b.evidence.quality * std::sqrt(static_cast<float>(b.cells.size()));
  });
  for (FoundPerson& one : found.people) add_person(frame, std::move(one));
  for (FoundPerson& thing : found.things) {
    const auto things =
        std::count_if(tracks_.begin(), tracks_.end(), [](const Track& t) { return t.kind == Kind::Thing; });
    if (things >= 2 * kMost) break;
    Track track;
    track.now = std::move(thing.cells);
    track.quality = thing.evidence.quality;
    if (track.quality > kPerhaps) track.look_in_s = kLookAgain_s;
    tracks_.push_back(std::move(track));
  }
}

void People::add_person(const CellFrame& frame, FoundPerson found) {
  const std::optional<Vec3> colour = mean_color(frame, found.cells);
  Track* track = who_returns(frame, found, colour);
  if (!track) {
    const auto people =
        std::count_if(tracks_.begin(), tracks_.end(), [](const Track& t) { return t.kind == Kind::Person; });
    Track another;
    if (people < kMost) another.kind = Kind::Person, another.id = next_id();
    left_out_ += people < kMost ? 0 : 1;
    tracks_.push_back(std::move(another));
    track = &tracks_.back();
  }
  track->now = std::move(found.cells);
  track->see(found.evidence);
  track->velocity.setZero();
  if (colour) track->colour = colour;
}

/// Somebody who was here before: as large, of the same colours, and who can have come so far.
People::Track* People::who_returns(const CellFrame& frame, const FoundPerson& found,
                                   const std::optional<Vec3>& colour) {
  const Vec3 place = extent_of(frame.cells, found.cells).mean;
  const float leg = leg_length(found.evidence.seen.joints);
  Track* best = nullptr;
  float least = 2;
  for (Track& track : tracks_) {
    const bool is_hidden = 3 * track.now.size() < static_cast<size_t>(track.usual_cells);  // but for a hand
    if (track.kind != Kind::Person || !is_hidden) continue;
    const float far = (place - track.centre).norm();
    if (far > 0.8f + kFastest * (track.unseen_s + frame.dt)) continue;
    float unlike = track.leg_m > 0 ? std::abs(std::log(leg / track.leg_m)) / 0.1f : 0.5f;
    if (colour && track.colour) unlike += (*colour - *track.colour).norm() / 0.15f;
    unlike += far / (2 + kFastest * track.unseen_s);
    if (unlike < least) least = unlike, best = &track;
  }
  return best;
}

/// Where nobody looks like a person, the most likely thing is tried all the same.
void People::guess(const CellFrame& frame) {
  const bool anybody = std::any_of(tracks_.begin(), tracks_.end(), [](const Track& t) {
    return t.kind == Kind::Person && (!t.now.empty() || t.unseen_s < 1);
  });
  for (Track& track : tracks_)
    if (track.kind == Kind::Unsure && anybody) track.kind = Kind::Thing;
  if (anybody) return;
  Track* best = nullptr;
  float most = 0;
  for (Track& track : tracks_) {
    if (track.kind == Kind::Person || track.now.empty() || !is_body_sized(frame.cells, track.now)) continue;
    if (area_of(frame, track.now) < kLeastGuess_m2) continue;
    if (track.kind == Kind::Unsure) return;
    const float score = (0.1f + track.quality) * static_cast<float>(track.now.size());
    if (score > most) most = score, best = &track;
  }
  if (!best) return;
  best->kind = Kind::Unsure;
  if (best->id == kScenery) best->id = next_id();
}

void People::finish(const CellFrame& frame) {
  std::vector<int> points(frame.cells.count(), 0);
  for (const int c : frame.cells.of_vertex())
    if (c >= 0) ++points[c];
  for (Track& track : tracks_) {
    track.points = 0;
    for (const int c : track.now) track.points += points[c];
    follow(track, frame);
  }
  tracks_.erase(
      std::remove_if(tracks_.begin(), tracks_.end(),
                     [](const Track& t) { return t.unseen_s > (t.kind == Kind::Thing ? 10 : kRemember_s); }),
      tracks_.end());
}

void People::follow(Track& track, const CellFrame& frame) {
  track.joints_age_s += frame.dt;
  if (track.now.empty()) {
    track.unseen_s += frame.dt;
    return;
  }
  const Cells& cells = frame.cells;
  const CellExtent extent = extent_of(cells, track.now);
  const Vec3 centre = extent.mean;
  const bool is_new = track.usual_cells == 0, returns = track.unseen_s > kVotes_s;
  const auto count = static_cast<float>(track.now.size());
  if (is_new) {
    track.found_at = centre;
    track.usual_cells = count;
  } else if (!returns) {
    const Vec3 step = centre - track.centre;
    const float share = std::min(1.0f, 4 * frame.dt);
    track.velocity += share * (step / std::max(frame.dt, 1e-3f) - track.velocity);
    if (track.velocity.norm() > kFastest) track.velocity *= kFastest / track.velocity.norm();
    if (track.joints) track.joints->rowwise() += step.transpose();
    track.usual_cells += 0.05f * (count - track.usual_cells);
  }
  track.moved_m = std::max(track.moved_m, (centre - track.found_at).norm());
  track.centre = centre;
  track.size = extent.size();
  track.unseen_s = 0;
  track.seen_s += frame.dt;
  const bool keeps =
      track.kind == Kind::Thing && track.velocity.norm() < 0.05f && track.places.size() < kMostPlaces;
  if (!keeps) track.places.clear();
  CellMap known(track.places.size() + track.now.size());
  for (const CellMap::Place& place : track.places) known.at(place, 0);
  for (const int c : track.now)
    if (known.find(cells.place(c)) < 0) track.places.push_back(cells.place(c));
}

}  // namespace understudy
