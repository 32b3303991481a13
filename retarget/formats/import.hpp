// From a file's units and axes to the program's: metres, y up, the floor at 0.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// Heights that can be asked for, metres.
constexpr Within<float> kBodyHeights{0.05f, 100};

/// What ImportOptions::units and up may be.
inline const std::vector<std::string> kUnitNames{"auto", "m", "cm", "mm", "dm", "in"};
inline const std::vector<std::string> kAxisNames{"auto", "x", "y", "z", "-x", "-y", "-z"};

/// What the user forces; what is left empty is guessed.
struct ImportOptions {
  std::string units;           ///< of kUnitNames; empty or "auto": from the height of the body
  std::string up;              ///< of kAxisNames; empty or "auto": from where the body extends
  float turn_deg = 0;          ///< turns the scan about y at the end, from +z towards +x
  std::optional<float> floor;  ///< height of the floor in the file, in metres; none: the lowest points
  std::optional<float>
      height{};  ///< metres that the body is made tall, whatever its units; none: by its units
};
template <class V, class S>
FieldsOf<S, ImportOptions> fields(V& visit, S& import) {
  visit("units", import.units);
  visit("up", import.up);
  visit(MemberName("turn_deg", "yaw_deg"), import.turn_deg);
  visit("floor_m", import.floor);
  visit("height_m", import.height, kBodyHeights);
}

/// Somebody of whom a scan does not show the feet, so that its height is not theirs.
struct UnseenFeet {
  float stature = 0;  ///< sole to crown
  float floor = 0;    ///< height at which they stand
  float upright = 1;  ///< 1: the trunk is upright, 0: it lies
};
/// Looks at a first frame as it would be imported by its height, and answers in those metres: too many rather
/// than too few. None where feet are seen, or nobody is.
using FeetCheck = std::function<std::optional<UnseenFeet>(const Mesh& upright)>;

/// How to bring every frame of a sequence into the program's world; decided from its first frame alone.
struct ImportDecision {
  float scale = 1;               ///< file units to metres
  Mat3 axes = Mat3::Identity();  ///< file axes to y up, with the yaw in it
  float floor = 0;               ///< height of the floor after scale and axes, metres
  float height = 0;              ///< of the body in the first frame, metres
  std::string units, up;         ///< as in ImportOptions
  std::string sentence;          ///< "units: millimetres (from the height 1750), up: z, floor at 0.03 m"
  std::string warning;           ///< why the size is odd; empty: it is not
  std::optional<ImportOptions>
      again;  ///< by which the scan alone decides the same; none: by the options given

  /// A frame in metres, y up, floor at 0.
  void apply(Mesh& mesh) const;
  Points apply(const Points& points) const;
  /// The inverse, from the program's world to the file's coordinates.
  Eigen::Matrix4d to_file() const;
};

/// Decides from the first usable frame. Outliers are left aside; a flat floor in the scan shows where down
/// is. One rule of size for sources and targets: what is 0.5 to 2.6 m tall in some unit keeps that size, and
/// so does who is lower and 0.5 to 2.6 m long (somebody who lies or crouches, in metres); all else is made
/// 1.7 m tall, with a warning. Axes can only be guessed positive unless a floor is seen.
/// Of a body whose feet are not seen its stature decides in place of the scan's height, and the floor is
/// where it stands, unless a floor is seen. Only asked where units or floor are to be decided;
/// it tells which way is up, too, where x seems to be.
/// Throws Error when the options are not among those named, or there is no finite point.
ImportDecision decide_import(const Mesh& first, const ImportOptions& forced, const FeetCheck& check = {});

/// The same from a scan that may show more than one body. Where bodies stand on a ground, that tells the way
/// up and the floor, and as whose people are 0.8 to 2.3 m tall the units; nobody is asked then. A wall behind
/// somebody is no ground. None where the scan shows only a ground or walls and not both units and up are
/// given: a later frame tells.
std::optional<ImportDecision> decide_scan_import(const Mesh& first, const ImportOptions& forced,
                                                 const FeetCheck& check = {});

}  // namespace understudy
