// Another body of the kind that performs what was found in the source's scans.
#pragma once

#include <memory>
#include <string>

#include "retarget/discovery/bone_matching.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy::app {

struct LaidOther;

struct SecondBodyState {
  /// Laid on the found rig; null: it has not been read yet, or there is none.
  std::shared_ptr<const LaidOther> other;
  BoneMatches matches;                            ///< of its bones
  std::shared_ptr<const RiggedMotion> performed;  ///< a pose for each of the found rig's; null: none yet
  /// From where it performs to the right of the found body, on one floor with it; metres.
  Vec3 place = Vec3::Zero();
  std::string problem;  ///< why it does not perform, one sentence; empty: no problem
  int64_t job = 0;      ///< that makes it perform; 0: none
  std::string stage;    ///< of that work: as DiscoveryProgress has it, then "Laying", "Performing"
  float share = 0;      ///< of it that is done, 0 .. 1
};

}  // namespace understudy::app
