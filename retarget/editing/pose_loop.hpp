// A stretch of a motion that plays round and round: two like moments, and the seam between them closed.
#pragma once

#include "retarget/base/fields.hpp"
#include "retarget/pipeline/motion_space.hpp"

namespace understudy {

/// The last of these frames is the first one again, farther along the path: a player that goes from the last
/// to the first does not jump. Frames are those of the motion before any edit.
struct LoopEdit {
  int first = 0, last = 0;  ///< both inside
  float seam_s = 0.2f;      ///< to each side of the seam, what is made anew
  float learned = 1;        ///< 0 the smooth curve over the seam .. 1 the motion space's answer
};
template <class V, class S>
FieldsOf<S, LoopEdit> fields(V& visit, S& edit) {
  visit("first", edit.first, kFrameNumbers);
  visit("last", edit.last, kFrameNumbers);
  visit("seam_s", edit.seam_s, Within<float>{0, 2});
  visit("learned", edit.learned, Within<float>{0, 1});
}

/// The two moments of frames first .. last that are most alike, seen each from its own place and heading: the
/// same feet stand, joints are near, and move alike. So a walk is cut to whole cycles of its steps. Of those
/// that are about as like the nearest to each other; between them lie 0.5 to 20 s in which something moves,
/// or, where nothing does, whatever there is. Throws Error, in one sentence, where no moments are alike, and
/// for frames that the motion does not have.
LoopEdit find_loop(const Motion& motion, const Joints& rest, int first, int last);

/// From the loop's first frame to its last: where it goes in one round.
struct LoopTravel {
  float metres = 0;    ///< over the floor
  float turn_deg = 0;  ///< about the vertical, from +z towards +x
};
LoopTravel travel_of(const LoopEdit& edit, const Motion& motion);

/// The frames of a seam on each side: none where nothing is made anew.
int seam_frames(const LoopEdit& edit, double fps);

/// Makes the frames at the loop's ends anew, as if its last went on as its first does, and the last one equal
/// to the first: what was made tells its doubt, the others stay as they are to the bit. `space`: as
/// fill_frames. Throws Error for frames that the motion does not have, and for fewer than five of them.
void close_loop(const LoopEdit& edit, const Joints& rest, MotionSpace* space, Motion& motion);

}  // namespace understudy
