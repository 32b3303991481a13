// One frame of one person: all that later stages may know of it.
#pragma once

#include <optional>
#include <string>

#include "retarget/pipeline/body_girth.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy {

/// A skeleton, extracted or given, and what the scan shows around it.
struct Observation : Extraction {
  std::optional<BodyGirth> girth;  ///< of the scan; none where there is none
  std::string problem;             ///< why there is no skeleton, one sentence; empty: there is one
  /// where the skeletons so far may not be a person's; set once in a source's first frames
  std::string warning;
  int64_t points = 0;  ///< in the scan
  float doubt_m = 0;   ///< how far the skeleton may be off where it was made, as Motion's; 0: it was seen
  double extract_ms = 0;
  /// What it was before a style changed how it moves; none: no style did.
  struct Unstyled {
    Joints joints = Joints::Zero();  ///< repaired and smoothed, world, metres
    LimbsSight limbs{};              ///< what is seen of the limbs,
    Standing feet{};                 ///< and which feet are
  };
  std::optional<Unstyled> unstyled;
};

/// A frame without a skeleton, of no confidence.
Observation without_skeleton(std::string problem);

/// Whether all numbers are.
bool finite(const Rotations& rotations);

/// Why an observation is not to be performed; empty: it is. The one place that decides what is believed:
/// numbers that are finite, and a mean confidence of at least 0.08 in the joints that are seen.
std::string refusal(const Observation& seen);

}  // namespace understudy
