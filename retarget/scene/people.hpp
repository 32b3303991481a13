// Who is in the scene: people and things, followed from frame to frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "retarget/scene/person_search.hpp"

namespace understudy {

/// Somebody in the scene, as all may know them.
struct ScenePerson {
  int id = 0;            ///< 1 and up, in the order in which they were found; stays theirs, returning too
  bool is_sure = false;  ///< else the best guess, where nothing looks like a person
  float quality = 0;     ///< of the last look, PersonEvidence
  Vec3 place = Vec3::Zero();  ///< centre of what is seen, metres
  Vec3 size = Vec3::Zero();   ///< of the box about it
  int64_t points = 0;         ///< in this frame
  float moved_m = 0;          ///< the farthest from where they were found
  float unseen_s = 0;         ///< 0: in this frame
};

/// The cells of one frame and what is to be known of them.
struct CellFrame {
  const Cells& cells;
  const Mesh& scan;
  std::vector<char> taken;  ///< what is neither ground nor wall
  const LookAtCells& look;  ///< what looks cost is for the caller to count
  float dt = 1.0f / 30;     ///< seconds since the frame before
};

/// Follows people and things by where their cells were: a set of cells that touches one's is theirs, one that
/// touches several is shared by nearness, to the cells of the frame before and to the bones seen. What nobody
/// had is searched for people. Who is lost keeps the identity for a minute: size, colour and the way that
/// they can have gone tell who returns. Memory is bounded: at most kMost people and as many things, a few
/// thousand cells each.
class People {
 public:
  static constexpr int kMost = 12, kNobody = -1, kScenery = 0;

  void restart() { *this = People(); }
  /// Of each cell the person's id, kScenery for things, or kNobody. Flat parts that come to light are added
  /// to `flat`.
  std::vector<int> push(const CellFrame& frame, std::vector<FlatPart>& flat);
  /// The same where all is one person's: nothing is looked for. Their id.
  int push_alone(const CellFrame& frame);
  /// What an observer saw of somebody in the last frame: it is believed or not.
  void tell(int id, const Extraction& seen, bool believed);

  /// All who were seen within the last minute.
  std::vector<ScenePerson> list() const;
  bool any_thing() const;
  /// Candidates that were people, but too many.
  int left_out() const { return left_out_; }

 private:
  enum class Kind { Person, Unsure, Thing };
  struct Track {
    int id = kScenery;
    Kind kind = Kind::Thing;
    std::vector<CellMap::Place> places;  // of the last frame in which it was seen
    CellSet now;                         // cells in this frame
    Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), size = Vec3::Zero(), found_at = Vec3::Zero();
    std::optional<Joints> joints;  // moved along
    float joints_age_s = 0, quality = 0, leg_m = 0, moved_m = 0, unseen_s = 0, seen_s = 0, look_in_s = 1;
    std::optional<Vec3> colour;
    float usual_cells = 0;
    int doubts = 0;
    int64_t points = 0;

    void see(const PersonEvidence& evidence);
  };

  std::vector<char> left_over(const CellFrame& frame) const;
  void share_cells(const CellFrame& frame);
  void split(const CellFrame& frame, const CellSet& set, const std::vector<int>& rivals);
  void release_pieces(const CellFrame& frame, const std::vector<CellSet>& sets);
  void welcome_back(const CellFrame& frame);
  void find_new(const CellFrame& frame, std::vector<FlatPart>& flat);
  void give_pieces(const CellFrame& frame);
  void search_again(const CellFrame& frame, std::vector<FlatPart>& flat);
  void refresh_rivals(const CellFrame& frame);
  void adopt(const CellFrame& frame, SearchResult found, std::vector<FlatPart>& flat);
  void add_person(const CellFrame& frame, FoundPerson found);
  Track* who_returns(const CellFrame& frame, const FoundPerson& found, const std::optional<Vec3>& colour);
  void guess(const CellFrame& frame);
  void finish(const CellFrame& frame);
  void follow(Track& track, const CellFrame& frame);
  Track* person(int id);
  int next_id() { return ++last_id_; }

  std::vector<Track> tracks_;
  std::vector<int> label_;      // [cells] track, -1 none, in this frame
  std::vector<int> contested_;  // tracks that shared a set in this frame
  int last_id_ = 0, left_out_ = 0;
  size_t turn_ = 0;  // whose bones are looked at next
  bool first_ = true;
};

}  // namespace understudy
