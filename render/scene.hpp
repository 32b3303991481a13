// What is drawn: plain arrays and settings. Metres, y up; colours sRGB in 0..1.
#pragma once

#include <vector>

#include "render/shared.hpp"
#include "retarget/base/fields.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::render {

using SharedPoints = Shared<Points>;
using SharedFaces = Shared<Faces>;
using SharedValues = Shared<Eigen::VectorXf>;

/// A lit smooth surface. Its arrays stay on the graphics card for as long as the same ones are drawn: keep
/// and hand in the same Shared (or shared_ptr) where nothing changed.
struct MeshView {
  SharedPoints vertices;  ///< [V, 3]
  SharedFaces faces;      ///< [F, 3]
  SharedPoints normals;   ///< [V, 3]; empty: from the faces, each time it is drawn
  SharedPoints colors;    ///< [V, 3]; empty: `color` everywhere
  /// [V] share of the light from all around, see ambient_occlusion(); empty: all of it
  SharedValues ambient;
  Vec3 color = Vec3(0.77f, 0.74f, 0.71f);
  float opacity = 1;  ///< below 1 only the front layer is seen, and what is behind it
  /// show the inside, lit like the outside (scans have holes); a closed one draws faster without
  bool two_sided = true;
  bool wireframe = false;  ///< with the edges of its faces over it, those in front
};
template <class V, class S>
FieldsOf<S, MeshView> fields(V& visit, S& m) {
  unnamed(visit, m.vertices, m.faces, m.normals, m.colors, m.ambient, m.color, m.opacity, m.two_sided,
          m.wireframe);
}

/// Points as lit round discs.
struct PointsView {
  SharedPoints positions;  ///< [N, 3]
  SharedPoints normals;    ///< [N, 3], either side; empty: each point looks like a small ball
  SharedPoints colors;     ///< [N, 3]; empty: `color` everywhere
  Vec3 color = Vec3(0.60f, 0.66f, 0.72f);
  float radius = 0.008f;  ///< metres
  float opacity = 1;      ///< below 1 only the front layer is seen, and all that is behind it
};
template <class V, class S>
FieldsOf<S, PointsView> fields(V& visit, S& p) {
  unnamed(visit, p.positions, p.normals, p.colors, p.color, p.radius, p.opacity);
}

enum class Side : int { Middle, Left, Right };

/// A skeleton as solids: a tapered bone from each joint to its parent, balls at the joints.
struct SkeletonView {
  Points joints{0, 3};       ///< [J, 3]
  std::vector<int> parents;  ///< [J], -1 for a root
  std::vector<Side> sides;   ///< [J]; empty: all middle
  Vec3 tint = Vec3::Zero();  ///< mixed into the sides' colours,
  float tint_share = 0;      ///< by so much
  Points colors{0, 3};       ///< [J, 3] of balls that mark the joints, larger ones on grey bones; empty: none
  float thickness = 1;       ///< of bones and balls, 1 fits an adult
  bool x_ray = true;         ///< seen through everything else
  float opacity = 1;
};
template <class V, class S>
FieldsOf<S, SkeletonView> fields(V& visit, S& s) {
  unnamed(visit, s.joints, s.parents, s.sides, s.tint, s.tint_share, s.colors, s.thickness, s.x_ray,
          s.opacity);
}

/// Lines in space: trails, boxes.
struct LinesView {
  Points positions{0, 3};     ///< [N, 3]; a line to or from one that is not finite is left out
  bool connected = true;      ///< one polyline; false: each two points are a line
  Points colors{0, 3};        ///< [N, 3]; empty: `color` everywhere
  Eigen::VectorXf opacities;  ///< [N] in 0..1; empty: `opacity` everywhere
  Vec3 color = Vec3(0.25f, 0.28f, 0.33f);
  float opacity = 1;
  float width = 2;     ///< pixels
  bool x_ray = false;  ///< seen through everything else
};
template <class V, class S>
FieldsOf<S, LinesView> fields(V& visit, S& l) {
  unnamed(visit, l.positions, l.connected, l.colors, l.opacities, l.color, l.opacity, l.width, l.x_ray);
}

enum class GizmoHandle : int { None, AxisX, AxisY, AxisZ, PlaneYz, PlaneZx, PlaneXy, Centre };

/// Handles to drag something by: arrows and plates to move it, rings to turn it. Seen through everything; see
/// gizmo.hpp.
struct GizmoView {
  enum class Kind { Move, Turn };
  Kind kind = Kind::Move;
  Vec3 position = Vec3::Zero();             ///< metres
  Mat3 axes = Mat3::Identity();             ///< its x, y, z as columns
  int rings = 3;                            ///< of Turn: about the first so many axes
  float size = 0.13f;                       ///< of an arrow, as a share of the picture's height
  GizmoHandle hovered = GizmoHandle::None;  ///< drawn bright
};
template <class V, class S>
FieldsOf<S, GizmoView> fields(V& visit, S& g) {
  unnamed(visit, g.kind, g.position, g.axes, g.rings, g.size, g.hovered);
}

/// The floor: a grid that fades out, and soft shadows of all that stands above it.
struct GroundView {
  bool visible = true;
  float height = 0;      ///< metres
  float spacing = 0.5f;  ///< metres between lines
  float radius = 4.5f;   ///< metres from below the camera's target until it has faded
  float shadow = 0.55f;  ///< 0 none .. 1 black
  Vec3 line = Vec3(0.52f, 0.55f, 0.60f);
};
template <class V, class S>
FieldsOf<S, GroundView> fields(V& visit, S& g) {
  unnamed(visit, g.visible, g.height, g.spacing, g.radius, g.shadow, g.line);
}

/// Light that moves with the camera, and the sky's and the floor's that does not.
struct LightView {
  Vec3 key_direction = Vec3(-0.55f, 0.65f, 0.75f);  ///< towards it; camera's right, world's up, camera's back
  Vec3 fill_direction = Vec3(0.9f, 0.15f, 0.45f);
  Vec3 key = Vec3(0.80f, 0.77f, 0.72f);  ///< linear
  Vec3 fill = Vec3(0.16f, 0.18f, 0.21f);
  Vec3 sky = Vec3(0.36f, 0.38f, 0.42f);
  Vec3 floor = Vec3(0.17f, 0.16f, 0.15f);
  float shine = 0.10f;
};
template <class V, class S>
FieldsOf<S, LightView> fields(V& visit, S& l) {
  unnamed(visit, l.key_direction, l.fill_direction, l.key, l.fill, l.sky, l.floor, l.shine);
}

/// The usual light turned to the right and upwards, degrees, at most to 89 above or below; all of it so
/// bright.
LightView turned_light(float turn_deg, float height_deg, float brightness);

struct BackgroundView {
  Vec3 top = Vec3(0.885f, 0.905f, 0.925f);
  Vec3 bottom = Vec3(0.970f, 0.973f, 0.976f);
  bool transparent = false;  ///< nothing there: pictures with an alpha channel
};
template <class V, class S>
FieldsOf<S, BackgroundView> fields(V& visit, S& b) {
  unnamed(visit, b.top, b.bottom, b.transparent);
}

struct Scene {
  std::vector<MeshView> meshes;
  std::vector<PointsView> clouds;
  std::vector<SkeletonView> skeletons;
  std::vector<LinesView> lines;
  std::vector<GizmoView> gizmos;
  GroundView ground;
  LightView light;
  BackgroundView background;
  float occlusion = 0.6f;  ///< strength of ambient occlusion on meshes, 0 off: see Quality
};
template <class V, class S>
FieldsOf<S, Scene> fields(V& visit, S& s) {
  unnamed(visit, s.meshes, s.clouds, s.skeletons, s.lines, s.gizmos, s.ground, s.light, s.background,
          s.occlusion);
}

/// The 22 joints with sides.
SkeletonView skeleton_view(const Joints& joints);
/// A mesh as a mesh, a cloud as discs that just cover its surface; its colours are kept.
void add(Scene& scene, const Mesh& mesh);

/// Where something has been: a polyline through `points` that fades out towards the first of them.
LinesView trail(const Points& points, const Vec3& color, float width = 2);
/// The twelve edges of a box with sides along the axes.
LinesView box(const Vec3& low, const Vec3& high, const Vec3& color, float width = 1.5f);

/// The positions of meshes, clouds and skeletons, the finite ones, below one another: for fitting a camera.
Points all_points(const Scene& scene);

}  // namespace understudy::render
