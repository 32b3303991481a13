// What lies between known frames, where it was not seen: a smooth curve through both ends, or what the motion
// space makes of it.
#pragma once

#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/pipeline/motion_space.hpp"

namespace understudy {

/// Frames that are made from those around them; both inside, numbers before any edit.
struct FillEdit {
  int first = 0, last = 0;
  float learned = 1;  ///< 0 the smooth curve .. 1 the motion space's answer
  int variation = 0;  ///< which of its answers (KnownMotion::variation)
};
constexpr Within<int> kVariationNumbers{0, kMostVariations - 1};
template <class V, class S>
FieldsOf<S, FillEdit> fields(V& visit, S& fill) {
  visit("first", fill.first, kFrameNumbers);
  visit("last", fill.last, kFrameNumbers);
  visit("learned", fill.learned, Within<float>{0, 1});
  visit("variation", fill.variation, kVariationNumbers);
}

/// The motion goes on beyond its last frame, which is a prediction.
struct GoOnEdit {
  float seconds = 1;
  float learned = 1;  ///< as FillEdit's
  int variation = 0;  ///< as FillEdit's: which of the futures
};
constexpr Within<float> kGoOnSeconds{0.05f, 60};
template <class V, class S>
FieldsOf<S, GoOnEdit> fields(V& visit, S& edit) {
  visit("seconds", edit.seconds, kGoOnSeconds);
  visit("learned", edit.learned, Within<float>{0, 1});
  visit("variation", edit.variation, kVariationNumbers);
}

/// Whether the motion space is asked for one of them.
bool need_space(const std::vector<FillEdit>& fills);

/// One sentence where little is behind what fills them: they are at an end of the motion, of `frames` frames,
/// or far from what is known; else empty.
std::string guess_of(const FillEdit& fill, int frames, double fps);

/// Makes these frames anew, the others stay as they are to the bit. The smooth curve: each joint's rotation
/// and the root follow the cubic Hermite curve through the frames beside, with their velocities
/// (fill_curves); a foot that stands before and after, at one place, stands meanwhile. At the motion's start
/// or end it is a prediction. What was made tells its doubt (Motion::doubt_m). Without a motion space all
/// follow the curve. It is asked once for each variation that a fill wants. Throws Error for frames that the
/// motion does not have, or where none is left that is known.
void fill_frames(const std::vector<FillEdit>& fills, const Joints& rest, MotionSpace* space, Motion& motion);

/// The frames that an edit adds at this rate, at least one.
int frames_added(const GoOnEdit& edit, double fps);

/// Makes the motion longer: what is added is predicted from what comes before, by a second or two at a time,
/// each of them from what was made just before it. So the doubt grows with the way from the last frame that
/// was there. Those that were there stay as they are to the bit. Throws Error for a motion without frames.
void go_on(const GoOnEdit& edit, const Joints& rest, MotionSpace* space, Motion& motion);

}  // namespace understudy
