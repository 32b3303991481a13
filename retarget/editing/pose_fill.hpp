// What lies between known frames, where it was not seen: a smooth curve through both ends.
#pragma once

#include "retarget/base/fields.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Frames that are made from those around them; both inside, numbers before any edit.
struct FillEdit {
  int first = 0, last = 0;
};
template <class V, class S>
FieldsOf<S, FillEdit> fields(V& visit, S& fill) {
  visit("first", fill.first, kFrameNumbers);
  visit("last", fill.last, kFrameNumbers);
}

/// Makes the frames first .. last anew, the others stay as they are to the bit: each joint's rotation and the
/// root follow the cubic Hermite curve through the frames beside, with their velocities (rotations by their
/// logarithm, seen from the first end). A foot that stands before and after, at one place, stands meanwhile.
/// At the motion's start or end it is a prediction: the motion goes on and comes to rest within half a
/// second. Throws Error for frames that the motion does not have, or where none is left that is known.
void fill_frames(const FillEdit& fill, const Joints& rest, Motion& motion);

}  // namespace understudy
