// The surface about each bone, followed from frame to frame.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "retarget/base/rng.hpp"
#include "retarget/geometry/near_points.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// How much is believed of what.
struct SurfaceTrackerOptions {
  float joint_errors = 1.75f;    ///< standard deviation of an extracted joint, in errors that it expects
  float least_joint_m = 0.006f;  ///< the same, at least
  float turn_deg = 6;            ///< of an extracted rotation
  float offset_m = 0.005f;       ///< of a joint's place beside its parent, which stays
  float mark_share = 0.16f;      ///< marks side by side err alike: so much of one counts
  float hand_share = 0.04f;      ///< the same of a hand's marks: fingers move on their own
  float renewed = 0.02f;         ///< of a bone's marks, each frame
  float settling = 0.2f;         ///< how fast a bone's deviation follows what is left after a fit
  float anchoring = 0.02f;       ///< how fast bones follow the extractor where surface and extractor disagree
  int rounds = 3;                ///< of the fit
  int marks = 80;                ///< for each bone, at most
};

/// An extractor sees each frame anew, and errs anew: bones turn a little otherwise than the surface that they
/// carry. Here marks on the surface (places with a normal, in the frame of their bone) are remembered, and in
/// each scan joints and rotations are sought that lay them on the surface again (point to plane, robust:
/// articulated ICP), stay near what was extracted, and keep each joint at its place beside its parent. Gauss-
/// Newton over 22 x 6 unknowns; their tree is solved from the leaves to the root. What turns freely on a
/// round surface stays as extracted.
///
/// What the extractor says again and again is believed: bones are drawn to it against their marks, slowly,
/// but joints at first as fast as the mean over the frames so far.
///
/// Looks only back, memory is constant. The same scans give the same joints. One thread at a time.
class SurfaceTracker {
 public:
  explicit SurfaceTracker(const SurfaceTrackerOptions& options = {});
  /// Forgets the past.
  void restart();
  /// What was extracted from this scan, in agreement with the frames before. The first frame, and what has no
  /// rotations, stays as it is.
  Extraction follow(const Extraction& seen, const Mesh& scan);

 private:
  struct Mark {
    Vec3 place, normal;  // in the bone's frame, metres
  };
  struct Bones {
    Joints joints;
    Rotations turns;  // world
  };
  struct Match {
    Vec3 arm, normal;  // from the joint to the mark; world
    float off;         // metres along the normal
  };
  /// What one bone's six unknowns (place, turn) have to do with themselves and with the parent's.
  struct Block;
  using Blocks = std::array<Block, kJointCount>;

  void fit(const Extraction& seen, const NearPoints& surface, Bones& bones);
  std::vector<Match> matches(int bone, const Bones& bones, const NearPoints& surface) const;
  void lay_on_surface(int bone, const std::vector<Match>& matches, Block& block) const;
  static void step(Blocks& blocks, Bones& bones);
  void settle(int bone, const std::vector<Match>& matches);
  void pull_to_extracted(const Extraction& seen, const Bones& bones, Blocks& blocks) const;
  void hold_together(const Bones& bones, Blocks& blocks) const;
  void anchor(const Extraction& seen, Bones& bones);
  void remember_offsets(const Bones& bones);
  void renew_marks(const Extraction& seen, const NearPoints& surface, const Bones& bones);

  SurfaceTrackerOptions options_;
  Rng rng_{0};
  std::array<std::vector<Mark>, kJointCount> marks_;
  std::array<float, kJointCount> variance_;  // m^2, of marks about the surface after a fit
  Joints offsets_;                           // of each joint in its parent's frame, metres
  Bones extracted_, corrected_;              // the frame before
  int frames_ = 0;
};

}  // namespace understudy
