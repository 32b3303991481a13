#include <algorithm>
#include <cmath>

#include "app/session/command_sets.hpp"
#include "app/session/follow.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

constexpr float kDegree = kPi / 180;

/// The camera of the active pane, made where there is none yet.
CameraState& camera(Session& session, int pane) {
  View& view = session.view;
  if (view.linked || pane < 0) pane = 0;
  const CameraState first = view.cameras.empty() ? CameraState{} : view.cameras[0];
  if (pane >= ssize(view.cameras)) view.cameras.resize(pane + 1, first);
  return view.cameras[pane];
}

CameraState& active_camera(Studio& studio) {
  return camera(studio.session(), studio.session().view.active_pane);
}

struct Preset {
  const char* name;
  const char* label;
  const char* key;
  float yaw, pitch;  // degrees
};
constexpr Preset kPresets[] = {
    {"front", "Front view", "1", 0, 0},      {"right", "Right view", "3", 90, 0},
    {"top", "Top view", "7", 0, 89},         {"back", "Back view", "Ctrl+1", 180, 0},
    {"left", "Left view", "Ctrl+3", -90, 0}, {"three-quarter", "Three-quarter view", "0", 32, 10}};

void add_cameras(Commands& commands) {
  for (const Preset& preset : kPresets)
    commands.add({std::string("view.preset_") + preset.name, preset.label, "", preset.key, false, false,
                  [&preset](Studio& s, const Arguments&) { s.run("view.preset", {preset.name}); }});
  commands.add({"view.preset", "Camera preset", "front|right|top|back|left|three-quarter", "", false, false,
                [](Studio& s, const Arguments& a) {
                  std::vector<std::string> names;
                  for (const Preset& preset : kPresets) names.push_back(preset.name);
                  const Preset& preset = kPresets[choice(a, 0, "preset", names)];
                  active_camera(s).yaw = preset.yaw * kDegree;
                  active_camera(s).pitch = preset.pitch * kDegree;
                }});
  commands.add({"view.camera", "Camera", "YAW_DEG PITCH_DEG [DISTANCE]", "", false, false,
                [](Studio& s, const Arguments& a) {
                  CameraState& c = active_camera(s);
                  c.yaw = static_cast<float>(number(a, 0, "yaw")) * kDegree;
                  c.pitch = std::clamp(static_cast<float>(number(a, 1, "pitch")), -89.f, 89.f) * kDegree;
                  if (a.size() > 2)
                    c.distance = std::clamp(static_cast<float>(number(a, 2, "distance")), 0.05f, 500.f);
                }});
  commands.add({"view.camera_state", "Camera", "PANE X Y Z YAW PITCH DISTANCE: radians, metres", "", false,
                false, [](Studio& s, const Arguments& a) {
                  CameraState& c = camera(s.session(), whole_number(a, 0, "pane"));
                  c.target = vector_argument(a, 1, "target");
                  c.yaw = static_cast<float>(number(a, 4, "yaw"));
                  c.pitch = static_cast<float>(number(a, 5, "pitch"));
                  c.distance = std::clamp(static_cast<float>(number(a, 6, "distance")), 0.05f, 500.f);
                }});
  commands.add(
      {"view.ortho", "Orthographic", "on|off|toggle", "5", false, false, [](Studio& s, const Arguments& a) {
         CameraState& c = active_camera(s);
         c.orthographic = switched(a, 0, c.orthographic);
       }});
}

/// The T-pose placed where the person would be: on the floor, under the following camera.
Joints rest_as_shown(const Target& target) {
  const float floor = target.mesh.vertices.rows() > 0 ? target.mesh.vertices.col(1).minCoeff() : 0;
  const Vec3 from(target.joints(Pelvis, 0), floor, target.joints(Pelvis, 2));
  return target.joints.rowwise() - from.transpose();
}

/// Joints of everybody who is shown at the frame, as their cameras see them; of the targets in T-pose while
/// there is no frame.
std::vector<Joints> shown_joints(const Session& session) {
  std::vector<Joints> all;
  const int frame = shown_frame(session);
  for (int pane = 0; pane <= ssize(session.takes); ++pane) {
    const Joints* const joints = pane_joints(session, pane, frame);
    const Vec3 offset = follow_offset(session, pane, frame);
    if (joints)
      all.push_back(joints->rowwise() - offset.transpose());
    else if (pane > 0 && session.takes[pane - 1].target)
      all.push_back(session.takes[pane - 1].target->joints);
  }
  const size_t selected = session.selected_take;
  if (session.tool == Tool::TargetJoints && selected < session.takes.size() && session.takes[selected].target)
    all.push_back(rest_as_shown(*session.takes[selected].target));
  return all;
}

/// Turns the camera to the middle of everyone shown and moves it back until all fit the view's narrow side.
void fit(Studio& studio) {
  constexpr float kBody = 0.2f;          // metres of a body beyond its outermost joints
  constexpr float kTitle = 0.08f;        // of the height stays free above the heads, for words
  constexpr float kViewsAspect = 1.55f;  // of all views together in a usual window
  Session& session = studio.session();
  CameraState& c = active_camera(studio);
  const std::vector<Joints> people = shown_joints(session);
  if (people.empty()) {
    c.target = CameraState{}.target;
    c.distance = CameraState{}.distance;
    return;
  }
  Vec3 low = Vec3::Constant(1e9f), high = -low;
  for (const Joints& joints : people) {
    low = low.cwiseMin(joints.colwise().minCoeff().transpose());
    high = high.cwiseMax(joints.colwise().maxCoeff().transpose());
  }
  high.y() += kTitle * (high.y() - low.y() + 2 * kBody);
  c.target = 0.5f * (low + high);
  const int panes = std::max(1, pane_count(session.view, session.takes.size()));
  const float aspect = kViewsAspect / static_cast<float>(panes);
  const float tall = 0.5f * (high.y() - low.y()) + kBody;
  const float wide = 0.5f * std::hypot(high.x() - low.x(), high.z() - low.z()) + kBody;
  c.distance = std::max(tall, wide / aspect) / std::tan(0.5f * c.fov) + 0.5f * wide;
}

void add_camera_motion(Commands& commands) {
  commands.add({"view.fit", "Fit", "all that is shown", "F", false, false,
                [](Studio& s, const Arguments&) { fit(s); }});
  commands.add(
      {"view.orbit", "Orbit", "YAW_DEG PITCH_DEG", "", false, false, [](Studio& s, const Arguments& a) {
         CameraState& c = active_camera(s);
         c.yaw += static_cast<float>(number(a, 0, "yaw")) * kDegree;
         const float pitch = c.pitch + static_cast<float>(number(a, 1, "pitch")) * kDegree;
         c.pitch = std::clamp(pitch, -89 * kDegree, 89 * kDegree);
       }});
  commands.add({"view.pan", "Pan", "RIGHT UP: metres", "", false, false, [](Studio& s, const Arguments& a) {
                  CameraState& c = active_camera(s);
                  const float right = static_cast<float>(number(a, 0, "distance"));
                  c.target += Vec3(right * std::cos(c.yaw), static_cast<float>(number(a, 1, "distance")),
                                   -right * std::sin(c.yaw));
                }});
  commands.add(
      {"view.zoom", "Zoom", "FACTOR: of the distance", "", false, false, [](Studio& s, const Arguments& a) {
         CameraState& c = active_camera(s);
         c.distance = std::clamp(c.distance * static_cast<float>(number(a, 0, "factor")), 0.05f, 500.f);
       }});
  commands.add({"view.turntable", "Turntable", "DEGREES_PER_SECOND", "T", false, false,
                [](Studio& s, const Arguments& a) {
                  float& speed = s.session().view.turntable_deg_s;
                  speed = a.empty() ? (speed == 0 ? 30.f : 0.f) : static_cast<float>(number(a, 0, "speed"));
                }});
  commands.add({"view.follow", "Follow the person", "on|off|toggle", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().view.follow = switched(a, 0, s.session().view.follow);
                }});
  commands.add(
      {"view.link", "Link the cameras", "on|off|toggle", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().view.linked = switched(a, 0, s.session().view.linked);
       }});
}

bool& layer(Layers& layers, const Arguments& a) {
  std::vector<std::string> names;
  std::vector<bool*> which;
  const auto collect = [&](const char* name, auto& value, const auto&...) {
    if constexpr (std::is_same_v<decltype(value), bool&>) names.push_back(name), which.push_back(&value);
  };
  fields(collect, layers);
  return *which[choice(a, 1, "layer", names)];
}

Layers& layers(Session& session, const Arguments& a) {
  return choice(a, 0, "pane", {"source", "take"}) == 0 ? session.view.source : session.view.take;
}

void add_layers(Commands& commands) {
  commands.add({"view.layer", "Layer", "source|take LAYER on|off|toggle", "", false, false,
                [](Studio& s, const Arguments& a) {
                  bool& shown = layer(layers(s.session(), a), a);
                  shown = switched(a, 2, shown);
                }});
  commands.add({"view.colour", "Colour by",
                "source|take plain|weights|offsets|error|difference|confidence|doubt", "", false, false,
                [](Studio& s, const Arguments& a) {
                  layers(s.session(), a).colouring =
                      static_cast<Colouring>(choice(a, 1, "colouring", kColouringNames));
                }});
  commands.add(
      {"view.weights_joint", "Weights of", "JOINT|all", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().view.weights_joint = word(a, 0, "joint") == "all" ? -1 : joint_argument(a, 0);
       }});
  commands.add(
      {"view.trail_joint", "Trail of", "JOINT on|off", "", false, false, [](Studio& s, const Arguments& a) {
         std::vector<int>& joints = s.session().view.trail_joints;
         const int joint = joint_argument(a, 0);
         joints.erase(std::remove(joints.begin(), joints.end(), joint), joints.end());
         if (on_off(a, 1)) joints.push_back(joint);
       }});
  commands.add({"view.ghosts", "Ghosts", "COUNT STEP: to each side, frames between", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().view.ghost_count = std::clamp(whole_number(a, 0, "count"), 0, 10);
                  s.session().view.ghost_step = std::clamp(whole_number(a, 1, "step"), 1, 1000);
                }});
  commands.add({"view.error_scale", "Error scale", "MM: the upper end of the scale", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().view.error_scale_mm =
                      std::clamp(static_cast<float>(number(a, 0, "scale")), 0.1f, 1e4f);
                }});
  commands.add({"view.metric", "Plot in the timeline", "KEY", "", false, false,
                [](Studio& s, const Arguments& a) { s.session().view.metric = word(a, 0, "figure"); }});
}

void add_panes(Commands& commands) {
  commands.add({"view.layout", "Layout", "side-by-side|single|overlay|wipe", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().view.layout = static_cast<Layout>(choice(a, 0, "layout", kLayoutNames));
                }});
  commands.add({"view.pane", "Active view", "PANE: 0 the source, K + 1 the take K", "", false, false,
                [](Studio& s, const Arguments& a) {
                  Session& session = s.session();
                  const int pane = whole_number(a, 0, "pane");
                  US_CHECK(pane >= 0 && pane <= ssize(session.document.takes), "there is no view ", pane);
                  session.view.active_pane = pane;
                  if (pane > 0) session.selected_take = pane - 1;
                }});
  commands.add({"view.wipe", "Wipe line", "SHARE: 0 to 1 of the width", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().view.wipe = std::clamp(static_cast<float>(number(a, 0, "share")), 0.f, 1.f);
                }});
}

}  // namespace

void add_view_commands(Commands& commands) {
  add_panes(commands);
  add_cameras(commands);
  add_camera_motion(commands);
  add_layers(commands);
}

}  // namespace understudy::app
