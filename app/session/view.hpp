// What is shown and how: saved with the document, but not part of its result and not undone.
#pragma once

#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::app {

enum class Layout {
  SideBySide,  ///< the source, then each take
  Single,      ///< one pane: the active one
  Overlay,     ///< source and takes in one space
  Wipe         ///< the first take left of a line, the second right of it, in one pane
};
constexpr Names<4> kLayoutNames{"side-by-side", "single", "overlay", "wipe"};

/// What colours a surface.
enum class Colouring {
  Plain,
  Weights,     ///< skin weights: of View::weights_joint (viridis), or of all joints (categories)
  Offsets,     ///< length of the pose-corrective offsets, mm
  Error,       ///< distance to the truth, mm
  Difference,  ///< distance to the same vertex of the first take, mm
  Confidence,  ///< extraction confidence of the nearest joint (the source's scan)
  Uncertainty  ///< how far a vertex is bound by the shape alone, %
};
constexpr Names<7> kColouringNames{"plain",      "weights",    "offsets",    "error",
                                   "difference", "confidence", "uncertainty"};

/// An orbit camera, as render's: yaw and pitch in radians, distance in metres.
struct CameraState {
  Vec3 target = Vec3(0, 0.9f, 0);
  float yaw = 0.55f, pitch = 0.18f, distance = 4.2f, fov = 0.5f;
  bool orthographic = false;
};
template <class V, class S>
FieldsOf<S, CameraState> fields(V& visit, S& camera) {
  visit("target", camera.target);
  visit("yaw", camera.yaw, Clamped<float>{});
  visit("pitch", camera.pitch, Clamped<float>{});
  visit("distance", camera.distance, Clamped<float>{1e-3f, 1e6f});
  visit("fov", camera.fov, Clamped<float>{0.01f, 3});
  visit("orthographic", camera.orthographic);
}

/// What of a canvas is seen: the point in the view's middle, as shares of its sides, and how much larger it
/// is than whole.
struct CanvasView {
  float x = 0.5f, y = 0.5f, zoom = 1;
};
template <class V, class S>
FieldsOf<S, CanvasView> fields(V& visit, S& canvas) {
  visit("x", canvas.x, Clamped<float>{-1, 2});
  visit("y", canvas.y, Clamped<float>{-1, 2});
  visit("zoom", canvas.zoom, Clamped<float>{0.1f, 50});
}

/// A direction to look from.
struct ViewPreset {
  const char* name;   ///< of the command view.preset
  const char* label;  ///< on the screen
  const char* key;
  float yaw_deg, pitch_deg;
};
/// The faces of the view cube, then what is no face.
constexpr ViewPreset kViewPresets[] = {{"front", "Front", "1", 0, 0},
                                       {"back", "Back", "Ctrl+1", 180, 0},
                                       {"right", "Right", "3", 90, 0},
                                       {"left", "Left", "Ctrl+3", -90, 0},
                                       {"top", "Top", "7", 0, 89},
                                       {"bottom", "Bottom", "Ctrl+7", 0, -89},
                                       {"three-quarter", "Three-quarter", "0", 32, 10}};

/// Opacities of what lies over each other, and how far apart the people stand, in Layout::Overlay.
struct OverlayLook {
  float scan = 1, skeletons = 1, results = 0.62f;
  float spread_m = 0;  ///< between two of them along x; 0: on each other
};
template <class V, class S>
FieldsOf<S, OverlayLook> fields(V& visit, S& look) {
  visit("scan", look.scan, Clamped<float>{0, 1});
  visit("skeletons", look.skeletons, Clamped<float>{0, 1});
  visit("results", look.results, Clamped<float>{0, 1});
  visit("spread_m", look.spread_m, Clamped<float>{0, 10});
}

/// Where the main light comes from, beside where it usually does, and how bright all light is.
struct LightLook {
  float turn_deg = 0, height_deg = 0;  ///< to the right; upwards
  float brightness = 1;
};
template <class V, class S>
FieldsOf<S, LightLook> fields(V& visit, S& light) {
  visit("turn_deg", light.turn_deg, Clamped<float>{-180, 180});
  visit("height_deg", light.height_deg, Clamped<float>{-90, 90});
  visit("brightness", light.brightness, Clamped<float>{0, 3});
}

/// What is behind everything.
enum class Background { Theme, White, Black, Custom };
constexpr Names<4> kBackgroundNames{"theme", "white", "black", "custom"};

/// Where the surface is seen that moves with a found skeleton, painted by bone.
enum class BoneSurface { Off, Over, Beside };
constexpr Names<3> kBoneSurfaceNames{"off", "over", "beside"};

/// What a pane draws.
struct Layers {
  bool surface = true;       ///< the scan, or the target's mesh
  bool as_points = false;    ///< a scan that has faces as points all the same
  bool skeleton = true;      ///< extracted joints, or the target's
  bool x_ray = true;         ///< the skeleton shines through; off: depth-tested
  bool joint_names = false;  ///< all names; the hovered joint's is always shown
  bool ground = true;
  bool trails = false;     ///< paths of View::trail_joints
  bool ghosts = false;     ///< past and coming frames, faint
  bool wireframe = false;  ///< edges of the surface's faces over it
  bool scene = true;       ///< of a scan what is nobody's: ground and things
  bool bones = true;       ///< the scan's own skeleton that was found
  Colouring colouring = Colouring::Plain;
};
template <class V, class S>
FieldsOf<S, Layers> fields(V& visit, S& layers) {
  visit("surface", layers.surface);
  visit("as_points", layers.as_points);
  visit("skeleton", layers.skeleton);
  visit("x_ray", layers.x_ray);
  visit("joint_names", layers.joint_names);
  visit("ground", layers.ground);
  visit("trails", layers.trails);
  visit("ghosts", layers.ghosts);
  visit("wireframe", layers.wireframe);
  visit("scene", layers.scene);
  visit("bones", layers.bones);
  visit("colouring", layers.colouring, kColouringNames);
}

struct View {
  Layout layout = Layout::SideBySide;
  bool linked = true;                               ///< panes share camera 0
  std::vector<CameraState> cameras{CameraState{}};  ///< one per pane; missing ones are like the first
  bool follow = true;                               ///< the camera follows the pelvis over the floor
  float turntable_deg_s = 0;                        ///< degrees per second that the camera turns on its own
  Layers source, take;
  int active_pane = 0;                    ///< 0 the source, k the take k - 1
  int weights_joint = -1;                 ///< -1: all joints
  std::vector<int> trail_joints{20, 21};  ///< wrists
  int ghost_count = 3, ghost_step = 8;    ///< to each side; frames between two
  bool ghosts_by_time = false;            ///< from blue, the first of them, to red, the last
  float error_scale_mm = 50;              ///< upper end of the scales of errors, offsets and differences
  float wipe = 0.5f;                      ///< the wipe's line, share of the width
  bool cube = true;                       ///< a cube in each view that shows where it looks from
  OverlayLook overlay;
  LightLook light;
  Background background = Background::Theme;
  Vec3 background_color = Vec3(0.16f, 0.24f, 0.34f);  ///< of Background::Custom, sRGB
  std::string metric = "confidence";                  ///< plotted in the timeline
  bool steps = true;                                  ///< marked there
  BoneSurface bone_surface = BoneSurface::Off;
  BoneSurface made_motions = BoneSurface::Beside;  ///< the found body in further motions
  std::vector<CanvasView> canvases;                ///< one per pane; missing ones show the whole canvas
  bool lifted = false;                             ///< a source of 2D poses is seen in space, as lifted
  float reference = 0.45f;                         ///< how bright the picture behind a flat take is
};
template <class V, class S>
FieldsOf<S, View> fields(V& visit, S& view) {
  visit("layout", view.layout, kLayoutNames);
  visit("linked", view.linked);
  visit("cameras", view.cameras);
  visit("follow", view.follow);
  visit("turntable_deg_s", view.turntable_deg_s, Clamped<float>{-3600, 3600});
  visit("source", view.source);
  visit("take", view.take);
  visit("active_pane", view.active_pane, Clamped<int>{0, 10000});
  visit("weights_joint", view.weights_joint, Clamped<int>{-1, kJointCount - 1});
  visit("trail_joints", view.trail_joints, Within<int>{0, kJointCount - 1});
  visit("ghost_count", view.ghost_count, Clamped<int>{0, 100});
  visit("ghost_step", view.ghost_step, Clamped<int>{1, kFrameNumbers.high});
  visit("ghosts_by_time", view.ghosts_by_time);
  visit("error_scale_mm", view.error_scale_mm, Clamped<float>{1e-3f, 1e6f});
  visit("wipe", view.wipe, Clamped<float>{0, 1});
  visit("cube", view.cube);
  visit("overlay", view.overlay);
  visit("light", view.light);
  visit(MemberName("background", "backdrop"), view.background, kBackgroundNames);
  visit(MemberName("background_color", "backdrop_color"), view.background_color);
  visit("metric", view.metric);
  visit("steps", view.steps);
  visit("bone_surface", view.bone_surface, kBoneSurfaceNames);
  visit("made_motions", view.made_motions, kBoneSurfaceNames);
  visit("canvases", view.canvases);
  visit("lifted", view.lifted);
  visit("reference", view.reference, Clamped<float>{0, 1});
}

/// What a pane (0 the source, k the take k - 1) is seen through: the first camera while they are linked, else
/// its own; where it has none yet, one like the first.
inline CameraState camera_of(const View& view, int pane) {
  const size_t i = view.linked || pane < 0 ? 0 : static_cast<size_t>(pane);
  if (i < view.cameras.size()) return view.cameras[i];
  return view.cameras.empty() ? CameraState{} : view.cameras[0];
}
/// What commands about the camera change.
inline CameraState active_camera(const View& view) {
  return camera_of(view, view.active_pane);
}

inline CanvasView canvas_of(const View& view, int pane) {
  const auto i = static_cast<size_t>(pane);
  return i < view.canvases.size() ? view.canvases[i] : CanvasView{};
}

/// Width by height of one of the views in a usual window.
float aspect_of_a_view(const View& view, size_t takes);
/// The least distance, metres, from which a camera that looks as it does sees all of a box, with some air.
/// low <= high, in the camera's space; its fov is between 0 and pi, the aspect above 0.
float distance_to_see(const CameraState& camera, float aspect, const Vec3& low, const Vec3& high);

}  // namespace understudy::app
