// What an imperfect segmentation leaves about somebody: ground, furniture, a ball, pieces of another person.
// None of it is the body. All is put by `first`, the skeleton of a stream's first frame, and by `scene`,
// which begins the same in each of its frames: it stays where it is; `rng` draws the points, new in each
// frame.
#pragma once

#include "retarget/base/rng.hpp"
#include "retarget/body/labelled_points.hpp"

namespace understudy {

/// Random numbers of a stream and of a frame.
struct SceneRandom {
  Rng scene;
  Rng& rng;
};

/// One to four pieces of the ground about the feet, tilted by a few degrees, noisy: 2 to 25 % more points.
void add_ground(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random);

/// A table, a chair or a cabinet beside somebody, or what is left of it: 2 to 30 % more points.
void add_furniture(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random);

/// The chair under somebody who sits.
void add_chair_below(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random);

/// A ball on the ground or in the air, not in a hand.
void add_loose_ball(LabelledPoints& cloud, const PosedSkeleton& first, SceneRandom random);

/// How another person, whose first skeleton is given, is moved to stand 0.4 to 1.2 m beside somebody.
Vec3 shift_beside(const PosedSkeleton& first, const PosedSkeleton& other, Rng& scene);

/// A piece of that other person, already there, about one of their joints: at most 30 % more points.
void add_piece(LabelledPoints& cloud, const PosedSkeleton& first, const LabelledPoints& other,
               const PosedSkeleton& others, SceneRandom random);

}  // namespace understudy
