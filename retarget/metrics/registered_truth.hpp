// How bones seen in a real capture turn against its surface, where all frames of the capture share one
// topology.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// What became of a part of the body over a sequence.
struct PartFigures {
  const char* part = "";  ///< "left_thigh"
  int vertices = 0;
  double fit_mm = 0;                    ///< median distance from the rigid fit: cloth and flesh
  double rot_deg = 0, rot_p95_deg = 0;  ///< median and 95th percentile over frames
  std::vector<int> joints;              ///< beside the part
  std::vector<double> const_mm;         ///< of each of them
};

/// Judges extracted skeletons without any skeleton's definition. The vertices of each part of the body
/// (pelvis, thighs, shins, feet, chest, head, upper arms, forearms, hands) are fitted rigidly from the first
/// frame to every other: Kabsch, four times, each vertex weighted by 1 / (1 + (e / 1 cm)^2) with e its
/// distance from the last fit. rot_deg is the angle between that turn and the one of the extracted bone since
/// the first frame, const_mm how far a joint wanders in the part's own frame: its mean distance from the
/// median of its places. A vertex belongs to the part whose bone, as extracted in the first frame, is
/// nearest. Cloth and flesh are in both figures: the truth is good to some 2 degrees and 10 mm.
/// Memory grows by 1 kB a frame.
class RegisteredTruth {
 public:
  RegisteredTruth();
  /// vertices [V, 3] in the topology's order, metres; joints and world rotations as extracted from the same
  /// frame. Throws Error when V changes.
  void push(const Points& vertices, const Joints& joints, const Rotations& global);
  /// Of the parts with 25 vertices or more; none before the second frame.
  std::vector<PartFigures> parts() const;

 private:
  struct Part {
    std::vector<int> vertices;                // [n] of the topology's
    std::vector<double> angles_deg, fits_mm;  // a frame each
    std::vector<Joints> places;               // all joints in the part's own frame
  };
  void choose_vertices(const Joints& joints);

  Points first_;
  Rotations first_global_;
  std::vector<Part> parts_;
  int64_t frames_ = 0;
};

/// Means over the parts; NaN where there is none.
double mean_rot_deg(const std::vector<PartFigures>& parts);
double mean_const_mm(const std::vector<PartFigures>& parts);

}  // namespace understudy
