// What a user puts right in a 2D track by hand.
#pragma once

#include <variant>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/keypoints/keypoint_filter.hpp"

namespace understudy {

/// A point of the body put elsewhere in one frame; in those around it the same point follows less and less.
struct PointDrag {
  int frame = 0;
  int point = 0;       ///< of BODY_25
  float x = 0, y = 0;  ///< pixels of the canvas, as FlatPoints
  int falloff = 0;     ///< frames to each side that follow
};
template <class V, class S>
FieldsOf<S, PointDrag> fields(V& visit, S& drag) {
  visit("frame", drag.frame, kFrameNumbers);
  visit("point", drag.point, Within<int>{0, kBodyPoints - 1});
  visit("x", drag.x);
  visit("y", drag.y);
  visit("falloff", drag.falloff, kFrameNumbers);
}

/// Left and right are taken for each other from frame `first` to frame `last`, both inside.
struct SidesExchange {
  enum class Limbs { Arms, Legs, Both };
  int first = 0, last = 0;
  Limbs limbs = Limbs::Both;
};
constexpr Names<3> kExchangedNames{"arms", "legs", "both"};
template <class V, class S>
FieldsOf<S, SidesExchange> fields(V& visit, S& exchange) {
  visit("first", exchange.first, kFrameNumbers);
  visit("last", exchange.last, kFrameNumbers);
  visit("limbs", exchange.limbs, kExchangedNames);
}

using TrackEdit = std::variant<PointDrag, SidesExchange>;

/// Adds a drag; one that goes on takes the place of the one before.
void add_drag(const PointDrag& drag, std::vector<TrackEdit>& edits);

/// Edits the cleaned track, which is what the user sees, one edit after the other; so no clean-up takes back
/// what they decided. Exchanged sides are those that were seen, whether they had been put back or not, of
/// both limbs eyes and ears, too. A point that is dragged is certain; with a wrist goes its hand, with the
/// nose the face. One that is missing is there in its own frame alone; in a frame before anybody was seen,
/// and beyond the track, nothing happens.
void edit_track(const std::vector<TrackEdit>& edits, std::vector<CleanPose>& clean);

}  // namespace understudy
