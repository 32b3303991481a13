#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "app/session/command_sets.hpp"
#include "app/session/follow.hpp"
#include "app/session/made_motions.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

constexpr float kDegree = kPi / 180;

/// The camera of the active pane, made where there is none yet.
CameraState& camera(Session& session, int pane) {
  View& view = session.view;
  if (view.linked || pane < 0) pane = 0;
  if (pane >= ssize(view.cameras)) view.cameras.resize(pane + 1, camera_of(view, pane));
  return view.cameras[pane];
}

CameraState& active_camera(Session& session) {
  return camera(session, session.view.active_pane);
}

void set_distance(CameraState& camera, float metres) {
  camera.distance = std::clamp(metres, 0.05f, 500.f);
}

void add_cameras(Commands& commands) {
  std::vector<std::string> names;
  std::string usage;
  for (const ViewPreset& preset : kViewPresets) {
    names.push_back(preset.name);
    append_item(usage, preset.name, "|");
    commands.add(
        {std::string("view.preset_") + preset.name, std::string(preset.label) + " view", "", preset.key},
        [&preset](Call& c) { c.studio.run("view.preset", {preset.name}); });
  }
  commands.add({"view.preset", "Camera preset", usage}, [names](Call& c) {
    const ViewPreset& preset = kViewPresets[c.choice(0, "preset", names)];
    active_camera(c.session).yaw = preset.yaw_deg * kDegree;
    active_camera(c.session).pitch = preset.pitch_deg * kDegree;
  });
  commands.add({"view.camera", "Camera", "YAW_DEG PITCH_DEG [DISTANCE]"}, [](Call& c) {
    CameraState& camera = active_camera(c.session);
    camera.yaw = c.number(0, "yaw") * kDegree;
    camera.pitch = c.clamped(1, "pitch", -89.f, 89.f) * kDegree;
    if (c.arguments.size() > 2) set_distance(camera, c.number(2, "distance"));
  });
  commands.add({"view.camera_state", "Camera", "PANE X Y Z YAW PITCH DISTANCE: radians, metres"},
               [](Call& c) {
                 CameraState& state = camera(c.session, c.number<int>(0, "pane"));
                 state.target = c.vector(1, "target");
                 state.yaw = c.number(4, "yaw");
                 state.pitch = c.number(5, "pitch");
                 set_distance(state, c.number(6, "distance"));
               });
  commands.add({"view.ortho", "Orthographic", "on|off|toggle", "5"}, [](Call& c) {
    CameraState& camera = active_camera(c.session);
    camera.orthographic = c.switched(0, camera.orthographic);
  });
}

using Extent = Eigen::AlignedBox3f;

void add_points(Extent& all, const Points& points, const Vec3& offset) {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) all.extend(Vec3(points.row(i).transpose() - offset));
}

/// The T-pose, or the mesh as it was loaded, placed where the person would be: on the floor, under the
/// following camera.
void add_rest(Extent& all, const TakeState& take) {
  const Target* const target = take.target ? take.target.get() : take.as_loaded.get();
  if (!target || target->mesh.vertices.rows() == 0) return;
  const Points& vertices = target->mesh.vertices;
  Vec3 from = 0.5f * (vertices.colwise().minCoeff() + vertices.colwise().maxCoeff()).transpose();
  if (take.target) from = target->joints.row(Pelvis);
  from.y() = vertices.col(1).minCoeff();
  add_points(all, vertices, from);
}

/// Around the scan, no further from the person than half a metre: strays and the floor do not count; where
/// people are told apart, around all of them. Of a take that is not bound around its joints.
Extent scan_extent(const Session& session, int pane, int frame, const Joints& joints) {
  constexpr float kBody = 0.2f,
                  kReach = 0.5f;  // metres of a body beyond its outermost joints; of clothes and props
  Extent all;
  if (!joints.allFinite()) return all;
  const Extent person(joints.colwise().minCoeff().transpose(), joints.colwise().maxCoeff().transpose());
  const auto grown = [&](float by) {
    return Extent(person.min() - Vec3::Constant(by), person.max() + Vec3::Constant(by));
  };
  const KeptSource* const seen = at_or_null(session.source.frames, frame);
  if (pane == 0 && seen && seen->owners) {
    all = grown(kBody);
    for (const auto& [id, box] : seen->owners->people()) all.extend(Extent(box.low, box.high));
    return all;
  }
  const ScanEdits& edits = session.document.scan_edits;
  const bool thinned = edits.floor || edits.largest_cluster;
  const bool scanned = pane == 0 && frame < ssize(session.source.frames) && !thinned;
  const std::optional<Box> box = scanned ? session.source.frames[frame].extent : std::nullopt;
  if (!box) return grown(kBody);
  if (session.source.no_person) return Extent(box->low, box->high);
  all = grown(kReach).intersection(Extent(box->low, box->high));
  if (edits.crop) all = all.intersection(Extent(edits.crop->low, edits.crop->high));
  return all.isEmpty() ? grown(kBody) : all;
}

/// What performs beside the scan, and what was found where it stands beside it.
void add_bodies_beside(Extent& all, const Session& session, int frame, const Vec3& offset) {
  const int at = session.bones.rig ? frame_of_rig(*session.bones.rig, frame) : -1;
  if (at < 0) return;
  const auto add = [&](const RiggedMotion& body, int pose, const Vec3& place) {
    const BoneMotions bones = bone_motions(body.rig, body.motion.poses[static_cast<size_t>(pose)]);
    add_points(all, skinned(body.rig.surface.vertices, body.rig.skin, bones), offset - place);
  };
  if (session.view.bone_surface == BoneSurface::Beside)
    add(session.bones.rig->found, at, painted_place(session));
  const int performed = second_pose(session, frame);
  if (performed >= 0) add(*session.second.performed, performed, second_place(session));
  const understudy::Rig& rig = session.bones.rig->found.rig;
  for (const ShownMotion& one : shown_motions(session, frame)) {
    const Points posed = skinned(rig.surface.vertices, rig.skin, bone_motions(rig, *one.pose));
    add_points(all, posed, offset - one.place);
  }
}

/// What a pane draws: the surface; the joints where there is none.
void add_pane(Extent& all, const Session& session, int pane, int frame) {
  const TakeState* const take = at_or_null(session.takes, pane - 1);
  const bool placing = is_of_rest(session.tool) && pane == session.selected_take + 1;
  const Joints* const joints = pane_joints(session, pane, frame);
  if (take && (placing || !joints)) add_rest(all, *take);
  if (!joints) return;
  const Vec3 offset = follow_offset(session, pane, frame) - spread_offset(session, pane);
  if (pane == 0 && session.tool == Tool::Crop) {
    const Box box = shown_crop(session);
    all.extend(Vec3(box.low - offset)).extend(Vec3(box.high - offset));
  }
  if (take && take->deformer && frame < ssize(take->shown.poses))
    add_points(all, take->deformer->deform(take->shown.poses[frame]), offset);
  else
    all.extend(scan_extent(session, pane, frame, *joints).translate(-offset));
  if (pane == 0) add_bodies_beside(all, session, frame, offset);
}

/// Of the panes that share the active camera.
Extent shown_extent(const Session& session) {
  const View& view = session.view;
  const bool alone = view.layout == Layout::Single || (view.layout == Layout::SideBySide && !view.linked);
  const int frame = shown_frame(session);
  Extent all;
  if (alone) add_pane(all, session, view.active_pane, frame);
  for (int pane = 0; !alone && pane <= ssize(session.takes); ++pane) add_pane(all, session, pane, frame);
  return all;
}

/// Turns the camera to the middle of all that is drawn and moves it back until it fits the view's narrow
/// side.
void fit(Call& call) {
  constexpr float kAir = 0.06f;    // of the height, around
  constexpr float kTitle = 0.08f;  // of the height stays free above the heads, for words
  const Session& session = call.session;
  call.session.view.canvases.clear();
  CameraState& c = active_camera(call.session);
  Extent shown = shown_extent(session);
  if (shown.isEmpty()) {
    c.target = CameraState{}.target;
    c.distance = CameraState{}.distance;
    return;
  }
  const Vec3 air = Vec3::Constant(kAir * shown.sizes().y());
  shown = Extent(shown.min() - air, shown.max() + air + Vec3(0, kTitle * shown.sizes().y(), 0));
  c.target = shown.center();
  const float aspect = aspect_of_a_view(session.view, session.takes.size());
  const Vec3 half = 0.5f * shown.sizes();
  const float wide = std::hypot(half.x(), half.z());
  set_distance(c, std::max(half.y(), wide / aspect) / std::tan(0.5f * c.fov) + 0.5f * wide);
}

void add_camera_motion(Commands& commands) {
  commands.add({"view.fit", "Fit", "all that is shown", "F"}, fit);
  commands.add({"view.reset", "Reset camera", "as at first, around all that is shown"}, [](Call& c) {
    active_camera(c.session) = CameraState{};
    fit(c);
  });
  commands.add({"view.orbit", "Orbit", "YAW_DEG PITCH_DEG"}, [](Call& c) {
    CameraState& camera = active_camera(c.session);
    camera.yaw += c.number(0, "yaw") * kDegree;
    camera.pitch = std::clamp(camera.pitch + c.number(1, "pitch") * kDegree, -89 * kDegree, 89 * kDegree);
  });
  commands.add({"view.pan", "Pan", "RIGHT UP: metres"}, [](Call& c) {
    CameraState& camera = active_camera(c.session);
    const float right = c.number(0, "distance"), up = c.number(1, "distance");
    camera.target += Vec3(right * std::cos(camera.yaw), up, -right * std::sin(camera.yaw));
  });
  commands.add({"view.zoom", "Zoom", "FACTOR: of the distance"}, [](Call& c) {
    CameraState& camera = active_camera(c.session);
    set_distance(camera, camera.distance * c.number(0, "factor"));
  });
  commands.add({"view.turntable", "Turntable", "DEGREES_PER_SECOND", "T"}, [](Call& c) {
    float& speed = c.session.view.turntable_deg_s;
    speed = c.arguments.empty() ? (speed == 0 ? 30.f : 0.f) : c.number(0, "speed");
  });
  commands.add({"view.follow", "Follow the person", "on|off|toggle"},
               [](Call& c) { c.session.view.follow = c.switched(0, c.session.view.follow); });
  commands.add({"view.cube", "View cube", "on|off|toggle"},
               [](Call& c) { c.session.view.cube = c.switched(0, c.session.view.cube); });
  commands.add({"view.link", "Link the cameras", "on|off|toggle"},
               [](Call& c) { c.session.view.linked = c.switched(0, c.session.view.linked); });
}

Layers& layers(const Call& c) {
  return c.choice(0, "pane", {"source", "take"}) == 0 ? c.session.view.source : c.session.view.take;
}

bool& layer(const Call& c) {
  std::vector<std::string> names;
  std::vector<bool*> which;
  const auto collect = [&](const char* name, auto& value, const auto&...) {
    if constexpr (std::is_same_v<decltype(value), bool&>) names.push_back(name), which.push_back(&value);
  };
  fields(collect, layers(c));
  return *which[c.choice(1, "layer", names)];
}

void add_layers(Commands& commands) {
  commands.add({"view.layer", "Layer", "source|take LAYER on|off|toggle"}, [](Call& c) {
    bool& shown = layer(c);
    shown = c.switched(2, shown);
  });
  commands.add({"view.colour", "Colour by",
                "source|take plain|weights|offsets|error|difference|confidence|uncertainty"},
               [](Call& c) { layers(c).colouring = c.choice<Colouring>(1, "colouring", kColouringNames); });
  commands.add({"view.weights_joint", "Weights of", "JOINT|all: shows them"}, [](Call& c) {
    c.session.view.weights_joint = c.word(0, "joint") == "all" ? -1 : c.joint(0);
    c.session.view.take.colouring = Colouring::Weights;
  });
  commands.add({"view.trail_joint", "Trail of", "JOINT on|off"}, [](Call& c) {
    std::vector<int>& joints = c.session.view.trail_joints;
    const int joint = c.joint(0);
    joints.erase(std::remove(joints.begin(), joints.end(), joint), joints.end());
    if (c.on(1)) joints.push_back(joint);
  });
  commands.add({"view.ghosts", "Ghosts", "COUNT STEP: to each side, frames between"}, [](Call& c) {
    c.session.view.ghost_count = c.clamped(0, "count", 0, 10);
    c.session.view.ghost_step = c.clamped(1, "step", 1, 1000);
  });
  commands.add({"view.ghosts_by_time", "Colour ghosts by time", "on|off|toggle"},
               [](Call& c) { c.session.view.ghosts_by_time = c.switched(0, c.session.view.ghosts_by_time); });
  commands.add({"view.error_scale", "Error scale", "MM: the upper end of the scale"},
               [](Call& c) { c.session.view.error_scale_mm = c.clamped(0, "scale", 0.1f, 1e4f); });
  commands.add({"view.steps", "Steps in the timeline", "on|off|toggle"},
               [](Call& c) { c.session.view.steps = c.switched(0, c.session.view.steps); });
  commands.add({"view.metric", "Plot in the timeline", "KEY"},
               [](Call& c) { c.session.view.metric = c.word(0, "figure"); });
}

void add_overlay(Commands& commands) {
  commands.add(
      {"view.opacity", "Opacity in the overlay", "scan|skeletons|results SHARE: 0 to 1"}, [](Call& c) {
        OverlayLook& look = c.session.view.overlay;
        float* const shares[] = {&look.scan, &look.skeletons, &look.results};
        *shares[c.choice(0, "layer", {"scan", "skeletons", "results"})] = c.clamped(1, "opacity", 0.f, 1.f);
      });
  commands.add({"view.spread", "Spread of the overlay", "METRES: between two people, 0 in one place"},
               [](Call& c) { c.session.view.overlay.spread_m = c.clamped(0, "distance", 0.f, 10.f); });
}

void add_light(Commands& commands) {
  commands.add({"view.light", "Light", "turn DEGREES | height DEGREES | brightness FACTOR"}, [](Call& c) {
    LightLook& light = c.session.view.light;
    const size_t which = c.choice(0, "what", {"turn", "height", "brightness"});
    if (which == 0) light.turn_deg = c.clamped(1, "angle", -180.f, 180.f);
    if (which == 1) light.height_deg = c.clamped(1, "angle", -90.f, 90.f);
    if (which == 2) light.brightness = c.clamped(1, "brightness", 0.f, 3.f);
  });
  commands.add({"view.background", "Background", "theme|white|black|custom [R G B]: 0 to 1"}, [](Call& c) {
    View& view = c.session.view;
    view.background = c.word(0, "background") == "own"  // its name before
                          ? Background::Custom
                          : c.choice<Background>(0, "background", kBackgroundNames);
    if (c.arguments.size() > 1) view.background_color = c.vector(1, "colour").cwiseMax(0.f).cwiseMin(1.f);
  });
}

void add_panes(Commands& commands) {
  commands.add({"view.layout", "Layout", "side-by-side|single|overlay|wipe"},
               [](Call& c) { c.session.view.layout = c.choice<Layout>(0, "layout", kLayoutNames); });
  commands.add({"view.pane", "Active view", "PANE: 0 the source, K + 1 the take K"}, [](Call& c) {
    const int pane = c.number<int>(0, "pane");
    US_CHECK(pane >= 0 && pane <= ssize(c.document.takes), "there is no view ", pane);
    choose_pane(c.session, pane);
  });
  commands.add({"view.canvas", "Move a canvas", "PANE X Y ZOOM: its place in the middle, 0..1; 1 is whole"},
               [](Call& c) {
                 const auto pane = c.clamped<int>(0, "pane", 0, 100);
                 auto& canvases = c.session.view.canvases;
                 if (pane >= ssize(canvases)) canvases.resize(static_cast<size_t>(pane) + 1);
                 CanvasView& canvas = canvases[static_cast<size_t>(pane)];
                 canvas.x = c.clamped(1, "x", -1.f, 2.f), canvas.y = c.clamped(2, "y", -1.f, 2.f);
                 canvas.zoom = c.clamped(3, "zoom", 0.1f, 50.f);
               });
  commands.add({"view.lifted", "Source of 2D poses as lifted", "on|off|toggle"},
               [](Call& c) { c.session.view.lifted = c.switched(0, c.session.view.lifted); });
  commands.add({"view.reference", "Brightness of the picture behind", "SHARE: 0 to 1"},
               [](Call& c) { c.session.view.reference = c.clamped(0, "share", 0.f, 1.f); });
  commands.add({"view.wipe", "Wipe line", "SHARE: 0 to 1 of the width"},
               [](Call& c) { c.session.view.wipe = c.clamped(0, "share", 0.f, 1.f); });
}

}  // namespace

void add_view_commands(Commands& commands) {
  add_panes(commands);
  add_cameras(commands);
  add_camera_motion(commands);
  add_layers(commands);
  add_overlay(commands);
  add_light(commands);
}

}  // namespace understudy::app
