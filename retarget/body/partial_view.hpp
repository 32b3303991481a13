// Half a body: what a picture's edge, a desk or one camera leaves of somebody. All is put by `first`, the
// skeleton of a stream's first frame, and by a random number generator that begins the same in each of its
// frames: it stays where it is. Nothing is taken away where too little would be left.
#pragma once

#include "retarget/base/rng.hpp"
#include "retarget/body/labelled_points.hpp"

namespace understudy {

/// What is seen of somebody whom a plane cuts, tilted a little: at the chest, about the hips, at a thigh or
/// knee, at a shin.
enum class BodyCut { Chest, Hips, Knees, Shins };

/// Takes away what lies below.
void cut_below(LabelledPoints& cloud, const PosedSkeleton& first, BodyCut cut, Rng& rng);
/// The same anywhere: most often at the chest, the hips or the knees.
void cut_below(LabelledPoints& cloud, const PosedSkeleton& first, Rng& rng);

/// Takes away what lies beyond an upright plane beside a shoulder: an arm, or most of one.
void cut_beside(LabelledPoints& cloud, const PosedSkeleton& first, Rng& rng);

/// A desk or counter in front, and what a camera beyond it sees: not what the desk hides, most often not what
/// the person's own front hides. Half the time some of the desk is left in the cloud, which is no body.
void put_behind_desk(LabelledPoints& cloud, const PosedSkeleton& first, Rng& rng);

}  // namespace understudy
