// Where a body without bones faces, and whether it is the right way up.
#pragma once

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// Radians about +y from +z towards +x. The extractor looks at the body from several sides; of the directions
/// near what it says, the one is taken about which the body is its own mirror image. y up.
float body_heading(const Mesh& mesh, SkeletonExtractor& extractor);

/// Whether a body without bones is head down: the extractor, which looks at it from several sides, sees the
/// head below the pelvis and the ankles above it. y up.
bool stands_on_head(const Mesh& mesh, SkeletonExtractor& extractor);

/// The heading near `guess` about which points are most symmetric; the guess where none stands out.
float symmetric_heading(const Points& points, float guess);

}  // namespace understudy
