// The first stage of a frame: what of a scan is ground, furniture, and whom.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/geometry/ground_finder.hpp"
#include "retarget/scene/people.hpp"

namespace understudy {

/// What is in one frame.
struct SceneFrame {
  /// Of each vertex a person's id, People::kScenery or People::kNobody, [V]. Empty: all is the person's of
  /// `alone`.
  std::vector<int> owner;
  int alone = 0;  ///< id of the person whom the whole scan shows; 0: it shows more, or nobody
  std::vector<ScenePerson> people;  ///< all who were seen within the last minute, by id
  std::optional<Ground> ground;
  int left_out = 0;  ///< people so far, beyond People::kMost, who were not followed
};

/// Takes a stream of scans apart, y up, metres. Looks only back, the first frame included; memory is bounded.
/// One person alone, with no ground in the scan, passes through at once. One thread at a time.
class Scene {
 public:
  /// Without an extractor all is taken for one person.
  explicit Scene(std::shared_ptr<SkeletonExtractor> extractor);
  /// Forgets the past.
  void restart();
  /// A scan, dt seconds after the frame before.
  SceneFrame push(const Mesh& scan, float dt);
  /// What an observer saw of a person in that frame.
  void tell(int id, const Extraction& seen, bool believed) { people_.tell(id, seen, believed); }

 private:
  bool is_alone(const CellFrame& frame);
  std::vector<char> without_scenery(const Cells& cells) const;
  std::vector<int> owners(const CellFrame& frame, const std::vector<int>& of_cell) const;

  std::shared_ptr<SkeletonExtractor> extractor_;
  GroundFinder ground_;
  std::vector<FlatPart> flat_;
  People people_;
  std::optional<bool> alone_;  // the frame before; none: the first
  int accepted_cells_ = 0;     // of one person alone whom the extractor was asked about
};

/// The part of a scan that is a person's.
Mesh part_of(const Mesh& scan, const SceneFrame& frame, int id);

/// The cells' size for scans of so many points: 5 cm, more where points are few.
float scene_cell_m(int64_t points);

}  // namespace understudy
