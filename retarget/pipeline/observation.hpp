// One frame of one person: all that later stages may know of it.
#pragma once

#include <optional>
#include <string>

#include "retarget/pipeline/body_girth.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// A skeleton, extracted or given, and what the scan shows around it.
struct Observation : Extraction {
  std::optional<BodyGirth> girth;  ///< of the scan; none where there is none
  std::string problem;             ///< why there is no skeleton, one sentence; empty: there is one
  /// where the skeletons so far may be no person's; told once in a source's first frames
  std::string warning;
  int64_t points = 0;  ///< in the scan
  double extract_ms = 0;
};

/// A frame without a skeleton, of no confidence.
Observation without_skeleton(std::string problem);

/// Whether all numbers are.
bool finite(const Rotations& rotations);

/// Why an observation is not to be performed; empty: it is. The one place that decides what is believed:
/// numbers that are finite, and a mean confidence of at least 0.08.
std::string refusal(const Observation& seen);

}  // namespace understudy
