// Scans that show more than one body: a ground and what stands on it, or nothing but ground and walls.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "retarget/geometry/mesh.hpp"

namespace understudy {

/// An axis of a file, 0 to 2, that points up or down.
struct UpAxis {
  int axis = 1;
  bool negative = false;
};

/// The points x with |normal . x - height| < tolerance; normal has unit length. Any units.
struct Slab {
  Vec3 normal = Vec3::UnitY();
  float height = 0, tolerance = 0;
};
/// The points that are in no slab, in their order.
Points outside(const std::vector<Slab>& slabs, Points points);

/// What is large and flat in a scan, and the rest; the file's units.
struct RoomView {
  Points points{0, 3};       ///< one for each cell of 1/200 of the extent that is not empty
  Points rest{0, 3};         ///< of these, what is in no plane
  std::vector<Slab> planes;  ///< at most six, of a twenty-fifth of the points each, the largest first
  float extent = 0;          ///< the longest side of the box about all but stray points
};
/// No points where the scan has no extent. Deterministic.
RoomView view_room(const Mesh& scan);

/// A ground that bodies stand on.
struct Room {
  UpAxis up;
  float metres = 1;  ///< of one unit of the file
  float floor = 0;   ///< height of the ground in the middle of the scan, along up, the file's units
  float height =
      0;           ///< of one body: the middle one of those as tall as people, else of all; the file's units
  int people = 0;  ///< bodies as tall as people, 0.8 to 2.3 m
};

/// The way up and the unit by which most stands on a plane as wide as all that: bodies as tall as people
/// count most. metres, ups: the guesses, the likeliest first. None where nothing stands on a plane, as in
/// scans of one body alone.
std::optional<Room> find_room(const RoomView& view, const std::vector<float>& metres,
                              const std::vector<UpAxis>& ups);

}  // namespace understudy
