// What becomes of the flesh about elbows, knees, shoulders and hips when they are bent.
#pragma once

#include <array>
#include <vector>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Skinning without correction loses volume in bends (Lewis et al. 2000); this measures how much.
class BentVolume {
 public:
  static constexpr std::array<int, 8> kBends = {LeftElbow,    RightElbow,    LeftKnee, RightKnee,
                                                LeftShoulder, RightShoulder, LeftHip,  RightHip};

  /// rest: [V, 3] in T-pose, pelvis near x = 0; about a joint is what lies nearer to it, on its own side,
  /// than half the shorter of the bones that meet there, at hips and shoulders than half the limb's bone.
  /// Throws Error without faces.
  BentVolume(const Points& rest, const Faces& faces, const Joints& joints);
  /// Volume of the surface about kBends[bend], its cuts closed, over what it is in T-pose; NaN where the
  /// body has no surface there.
  double kept(size_t bend, const Points& vertices) const;

 private:
  struct Piece {
    Faces faces;
    std::vector<std::vector<std::array<int, 2>>> cuts;  // their edges, against the faces' way round
    double rest = 0;
  };
  static double volume(const Piece& piece, const Points& vertices);
  std::array<Piece, kBends.size()> pieces_;
};

}  // namespace understudy
