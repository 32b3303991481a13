// How a body without bones stands: whether like a person, which way up, and where it faces.
#pragma once

#include <array>
#include <string>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy {

/// How a body stands, y up; all but the height are shares of the height. The one point in 250 that is
/// furthest out on each side does not count.
struct Stance {
  float height = 0;  ///< in the units of the mesh
  float length = 0;  ///< along the floor, where it is longest: the arms of a person, head to tail of a cat
  float width = 0;   ///< along the floor, across that
  float feet = 0;    ///< how far apart along `length` it touches the floor
  float centre = 0;  ///< height of the mean of the surface
};
/// Throws Error when there is no finite point.
Stance stance_of(const Mesh& mesh);

/// Flat on the floor, as a person who lies or whose file has another axis up.
bool lies_down(const Stance& stance);

/// Why this is no person, to follow "does not look like a person: "; empty: it may be one. Only what no
/// person, child, puppet or robot with two legs can be: T-poses have length 0.7 to 1.1, width 0.15 to 0.25
/// and feet 0.15 to 0.3.
std::string refusal(const Stance& stance);
/// Why this may not be a person; empty: nothing speaks against it.
std::string implausibility(const Stance& stance);

/// Why its shape alone leaves doubt; empty: none. Weaker than implausibility(): people with their legs far
/// apart and wide gowns have it, too, so it counts only where no person is recognised in the shape.
std::string doubt(const Stance& stance);

/// What the extractor predicts for a body, y up, that is turned by a quarter more each time.
using SideViews = std::array<Extraction, 4>;
SideViews seen_from_sides(const Mesh& mesh, SkeletonExtractor& extractor);

/// Whether no person is recognised: in at least three of the views the skeleton is not believed or
/// implausible.
bool shows_nobody(const SideViews& seen);

/// Radians about +y from +z towards +x: of the directions near the views' headings, the one about which the
/// body is its own mirror image.
float body_heading(const Mesh& mesh, const SideViews& seen);

/// Whether a body without bones is upside down: the head is seen below the pelvis and the ankles above it.
bool is_upside_down(const SideViews& seen);

/// The heading near `guess` about which points are most symmetric; the guess where none stands out.
float symmetric_heading(const Points& points, float guess);

}  // namespace understudy
