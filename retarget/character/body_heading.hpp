// Where a body without bones faces, and whether it is the right way up.
#pragma once

#include <array>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// What the extractor says of a body, y up, that is turned by a quarter more each time.
using SideViews = std::array<Extraction, 4>;
SideViews seen_from_sides(const Mesh& mesh, SkeletonExtractor& extractor);

/// Radians about +y from +z towards +x: of the directions near what the views say, the one about which the
/// body is its own mirror image.
float body_heading(const Mesh& mesh, const SideViews& seen);

/// Whether a body without bones is head down: the head is seen below the pelvis and the ankles above it.
bool stands_on_head(const SideViews& seen);

/// The heading near `guess` about which points are most symmetric; the guess where none stands out.
float symmetric_heading(const Points& points, float guess);

}  // namespace understudy
