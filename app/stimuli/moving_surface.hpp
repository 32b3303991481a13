// What moves in a clip, ready to be drawn: a scan, a target that stands still, a result.
#pragma once

#include <optional>
#include <vector>

#include "render/scene.hpp"

namespace understudy::app {

/// Metres, y up, the floor at 0.
struct SurfaceFrame {
  render::SharedPoints vertices;     ///< [V, 3]
  render::SharedFaces faces;         ///< [F, 3]; none: a cloud
  render::SharedPoints colors;       ///< [V, 3]; none: the surface's colour
  render::SharedPoints normals;      ///< of a cloud [V, 3]; of a mesh none: they follow from its faces
  float spacing = 0;                 ///< of a cloud's points, metres
  std::optional<Joints> skeleton{};  ///< in place of the surface
};

struct MovingSurface {
  double fps = 30;
  std::vector<SurfaceFrame> frames;  ///< one: it stands still
  render::SharedValues ambient;      ///< of frames with the faces of the target, see MeshView
  bool closed = false;               ///< its inside is never visible
  Vec3 color = render::MeshView().color;
  /// The frame nearest to a time: nothing is interpolated, scans have no points in common. There is one.
  const SurfaceFrame& at(double seconds) const { return frames[index_at(seconds)]; }
  size_t index_at(double seconds) const;
};

/// A scan or any other mesh as a frame; a cloud's normals and spacing are estimated.
SurfaceFrame surface_frame(const Mesh& mesh);
/// All that is seen of it, [N, 3], finite.
Points seen_points(const SurfaceFrame& frame);
/// As the studio draws it.
void add(render::Scene& scene, const MovingSurface& surface, const SurfaceFrame& frame);

}  // namespace understudy::app
