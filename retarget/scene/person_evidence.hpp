// Whether points are a person, as the skeleton extractor sees them.
#pragma once

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// What a look with the extractor finds.
struct PersonEvidence {
  Extraction seen;
  float covered = 0;  ///< share of the points that are as near to a bone as a body's are
  float quality = 0;  ///< 0..1: how sure it is, of bones like a person's that have all points about them
  /// Whole people have 0.6 to 1, half ones 0.3 to 0.7, furniture, dogs and two people in one below 0.3.
  bool is_person() const { return quality >= 0.3f; }
};

/// No quality where there is nothing to look at. `scan` holds nothing but the candidate.
PersonEvidence look_for_person(SkeletonExtractor& extractor, const Mesh& scan);

/// Metres from the nearest of a skeleton's bones.
float bone_distance(const Vec3& point, const Joints& joints);
/// How far from its bones a body of that skeleton's size reaches, metres: 0.18 of an adult.
float body_reach(const Joints& joints);

}  // namespace understudy
