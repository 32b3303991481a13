// Whose each point of a scan is, kept for every frame: packed, a few kB where points lie in no order.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "retarget/editing/scan_edits.hpp"
#include "retarget/scene/scene.hpp"

namespace understudy::app {

class KeptOwners {
 public:
  /// Of the points of a scan taken apart, [V, 3]. Null where the whole scan is the person's.
  static std::shared_ptr<const KeptOwners> of(const Points& scan, const SceneFrame& scene, int person);

  /// Of each vertex a person's id, People::kScenery or People::kNobody, [V]; empty where these are not the
  /// points of that scan. Vertices that are not finite may be missing among them: they are nobody's.
  std::vector<int> owners(const Points& vertices) const;
  /// Around each who is a person, by id.
  const std::map<int, Box>& people() const { return people_; }

 private:
  std::vector<int> ids_;         // at most 255 that occur
  std::vector<uint8_t> packed_;  // of each finite vertex the index of its id; zlib's
  int64_t count_ = 0;            // of finite vertices
  std::map<int, Box> people_;
};

}  // namespace understudy::app
