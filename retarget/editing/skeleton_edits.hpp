// Edits of the joints found in a scan, before they are transferred.
#pragma once

#include <variant>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// A joint taken by the hand at one frame; the frames around follow less and less.
struct DragEdit {
  int frame = 0;
  int joint = 0;
  Vec3 offset = Vec3::Zero();  ///< metres, world, added to where the joint was seen
  int falloff = 5;             ///< frames to each side that follow
  bool with_children = false;  ///< the joints further out move along, rigidly; otherwise they were seen right
};
template <class V, class S>
FieldsOf<S, DragEdit> fields(V& visit, S& drag) {
  visit("frame", drag.frame, kFrameNumbers);
  visit("joint", drag.joint, Within<int>{0, kJointCount - 1});
  visit("offset", drag.offset);
  visit("falloff", drag.falloff, kFrameNumbers);
  visit("with_children", drag.with_children);
}

/// Left and right were taken for each other from frame `first` to frame `last`.
struct SwapEdit {
  enum class Limbs { Arms, Legs, Both };
  int first = 0, last = 0;  ///< both inside
  Limbs limbs = Limbs::Both;
};
constexpr Names<3> kLimbNames{"arms", "legs", "both"};
template <class V, class S>
FieldsOf<S, SwapEdit> fields(V& visit, S& swap) {
  visit("first", swap.first, kFrameNumbers);
  visit("last", swap.last, kFrameNumbers);
  visit("limbs", swap.limbs, kLimbNames);
}

using SkeletonEdit = std::variant<DragEdit, SwapEdit>;

/// The joints of frame `frame` after the edits, in their order. Depends on nothing but the edits and this
/// frame, so that an online run with edits equals an edit of a finished one. What a hand set is believed: the
/// confidence of moved joints rises to 1 by the edit's weight, of exchanged ones to at least 0.9. Seen
/// rotations follow a drag (bones turn with their ends) and are dropped by a swap. Throws Error for a joint
/// that is none.
Extraction apply(const std::vector<SkeletonEdit>& edits, Extraction seen, int frame);

}  // namespace understudy
