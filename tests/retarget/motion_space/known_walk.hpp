// Questions made from motions that are known whole.
#pragma once

#include "retarget/pipeline/motion_space.hpp"

namespace understudy::tests {

/// The built-in person who walks or dances.
struct KnownWalk {
  explicit KnownWalk(const std::string& motion = "dance");
  /// Frames start .. start + count - 1, of which first .. last are not known and not to be seen.
  KnownMotion question(int start, int count, int first, int last) const;
  /// Mean distance of joints in frame t of an answer from those of frame start + t, metres.
  double error(const Motion& answer, int start, int t) const;

  Joints rest;
  Motion motion;
};

/// The same question, seen from elsewhere.
KnownMotion turned(KnownMotion question, const Mat3& turn, const Vec3& way);
Motion turned(Motion motion, const Mat3& turn, const Vec3& way);
/// In a mirror.
KnownMotion mirrored(KnownMotion question);
Motion mirrored(Motion motion);

/// The farthest that a joint of one is from that of the other, metres.
float farthest(const Joints& rest, const Motion& a, const Motion& b);

/// Whether a part of two poses is the same to the bit.
bool same_part(const Pose& a, const Pose& b, int part);

}  // namespace understudy::tests
