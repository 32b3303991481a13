// Where a body without bones faces.
#pragma once

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// Radians about +y from +z towards +x. The extractor looks at the body from several sides; of the directions
/// near what it says, the one is taken about which the body is its own mirror image. y up.
float body_heading(const Mesh& mesh, SkeletonExtractor& extractor);

/// The heading near `guess` about which points are most symmetric; the guess where none stands out.
float symmetric_heading(const Points& points, float guess);

}  // namespace understudy
