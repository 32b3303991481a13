// The pieces that a creature's body is put together from: rounded cones, ellipsoids, boxes, frusta, plates.
#pragma once

#include "retarget/math/types.hpp"

namespace understudy {

/// One piece, in the creature's rest pose. Make it with the functions below.
struct SolidPart {
  enum class Shape { Cone, Ellipsoid, Box, Frustum, Blade };
  Shape shape = Shape::Ellipsoid;
  int joint = 0;                 ///< the bone that it belongs to
  Vec3 origin = Vec3::Zero();    ///< of its own frame, world
  Mat3 axes = Mat3::Identity();  ///< rows: its own x, y, z in the world; those that have a length lie along z
  Vec3 half = Vec3::Ones();      ///< radii of an ellipsoid, half the sides of a box, x of a blade's thickness
  float length = 0;              ///< of cone, frustum and blade
  float from = 0, to = 0;        ///< their radii at either end
  float round = 0;               ///< how much the edges are rounded; half, from and to are without it
  float thickness = 0.1f;        ///< about its smallest radius
  float blend = 0;               ///< how softly it joins what was there before it
  bool carved = false;           ///< taken away instead of added
};

/// From a to b, a ball of that radius at either end.
SolidPart cone_part(const Vec3& a, float from, const Vec3& b, float to);
/// Radii along the columns of `frame`.
SolidPart ellipsoid_part(const Vec3& centre, const Vec3& radii, const Mat3& frame = Mat3::Identity());
/// Half its sides along the columns of `frame`, edges rounded by `round` inside these measures.
SolidPart box_part(const Vec3& centre, const Vec3& half, float round, const Mat3& frame = Mat3::Identity());
/// From a to b like cone_part, but with flat ends; edges rounded by `round`.
SolidPart frustum_part(const Vec3& a, float from, const Vec3& b, float to, float round);
/// A plate from a to b with round ends, `from` and `to` half as wide there, `half_thick` to either side along
/// `normal`.
struct BladeShape {
  Vec3 normal;
  float half_thick;
  float round = -1;  ///< of its edges; below 0: as round as can be
};
SolidPart blade_part(const Vec3& a, float from, const Vec3& b, float to, const BladeShape& shape);

/// The same piece with edges of the mesh as fine, or as coarse, as where a body is `thickness` thick.
inline SolidPart meshed_as(float thickness, SolidPart part) {
  part.thickness = thickness;
  return part;
}

/// About how far p lies outside, negative inside.
float distance_to(const SolidPart& part, const Vec3& p);
/// How far p lies beyond the ends of a piece that has a length; 0 of the others.
float beyond_ends(const SolidPart& part, const Vec3& p);
/// The smaller of both, rounded over where they differ by less than `blend`.
float smooth_minimum(float a, float b, float blend);

/// Right-handed, columns x, y, z: z along `z`, x as near to `x` as can be.
Mat3 frame_along(const Vec3& z, const Vec3& x);

}  // namespace understudy
