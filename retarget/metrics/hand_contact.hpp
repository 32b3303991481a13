// What hands touch: gaps between the hands and other parts of the same body, and arms inside it.
#pragma once

#include <array>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/metrics/inside.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// What a hand may touch, apart from its own arm.
enum TouchedPart : int { TouchTorso, TouchHead, TouchThighs, TouchOtherArm, TouchOtherHand, kTouchedParts };

/// Metres between each hand (left, right) and each part; at most kFarGap.
using HandGaps = std::array<std::array<float, kTouchedParts>, 2>;
constexpr float kFarGap = 0.3f;

/// Knows which vertices of a body are hands and which what they may touch, by the bones nearest to them in
/// T-pose.
class HandContact {
 public:
  /// rest: T-pose vertices. Throws Error without faces.
  HandContact(const Points& rest, const Faces& faces, const Joints& rest_joints);
  /// Of the same vertices in another pose: the nearest that a vertex of the hand comes to a vertex or the
  /// middle of a triangle of the part.
  HandGaps gaps(const Points& vertices) const;
  /// Share of vertices of hands and forearms that lie inside the rest of the body, their own whole arm left
  /// out, 0..1. Of 40 vertices an arm, far apart.
  double buried(const Points& vertices) const;

 private:
  std::array<std::vector<int>, 2> hands_, evaluated_;                 // vertices a side
  std::array<std::array<std::vector<int>, kTouchedParts>, 2> parts_;  // vertices
  std::array<std::array<Faces, kTouchedParts>, 2> part_faces_;
  std::vector<Windings> others_;  // a side: the body without this arm
};

/// Sums up a sequence: of the hands that come within `touch_m` of a part of the source, how many do so of the
/// target. Each frame, hand and part counts.
class ContactsKept {
 public:
  static constexpr float touch_m = 0.02f;
  void add(const HandGaps& source, const HandGaps& target);
  int count() const { return count_; }                                 ///< contacts of the source
  double kept() const { return static_cast<double>(kept_) / count_; }  ///< share; NaN without contacts
  double gap_m() const { return gap_sum_ / count_; }  ///< mean gap of the target in them; NaN without

 private:
  int count_ = 0, kept_ = 0;
  double gap_sum_ = 0;
};

}  // namespace understudy
