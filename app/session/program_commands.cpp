#include <algorithm>
#include <utility>

#include "app/session/command_sets.hpp"
#include "app/session/follow.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

/// Goes as far back as the spread arms of a T-pose ask; never nearer.
void see_rest(Call& c) {
  View& view = c.session.view;
  if (!view.linked) choose_take(c.session, c.session.selected_take);
  const size_t i = view.linked ? 0 : view.active_pane;
  const View before = view;
  c.studio.run("view.fit");
  if (i < before.cameras.size() && view.cameras[i].distance <= before.cameras[i].distance)
    view.cameras = before.cameras;
}

/// Goes as far back as the crop box asks and turns nowhere else; never nearer.
void see_crop_box(Call& c) {
  View& view = c.session.view;
  if (view.cameras.empty()) view.cameras.resize(1);
  const Box box = shown_crop(c.session);
  const Vec3 offset = follow_offset(c.session, 0, shown_frame(c.session)) - spread_offset(c.session, 0);
  CameraState& camera = view.cameras[0];  // the source's, linked or not
  const float aspect = aspect_of_a_view(view, c.session.takes.size());
  camera.distance =
      std::max(camera.distance, distance_to_see(camera, aspect, box.low - offset, box.high - offset));
}

/// The head from the front, as large as it is with some room about it.
void see_head(Call& c) {
  Session& session = c.session;
  const TakeState* const take = at_or_null(session.takes, session.selected_take);
  if (take == nullptr || !take->target) return;
  View& view = session.view;
  if (!view.linked) choose_take(session, session.selected_take);
  const auto i = static_cast<size_t>(view.linked ? 0 : view.active_pane);
  if (view.cameras.size() <= i) view.cameras.resize(i + 1, active_camera(view));
  const FaceMarks& face = take->face;
  const Vec3 middle = 0.5f * (face.left_ear + face.right_ear);
  const float reach = 1.6f * std::max((face.nose - middle).norm(), (face.left_ear - middle).norm());
  const int pane = session.selected_take + 1;
  CameraState& camera = view.cameras[i];
  camera.yaw = camera.pitch = 0;
  camera.target = take->target->joints.row(Head).transpose() + middle -
                  rest_offset(session, pane, std::max(0, shown_frame(session)));
  const Vec3 room = Vec3::Constant(reach);
  camera.distance = distance_to_see(camera, aspect_of_a_view(view, session.takes.size()),
                                    camera.target - room, camera.target + room);
}

/// What a tool needs to see it sees; when it is left the cameras are as before,
/// unless they were moved meanwhile; from the head they always come back.
void adjust_cameras(Call& c, Tool left) {
  Session& session = c.session;
  auto& cameras = session.view.cameras;
  const auto stepped = std::exchange(session.stepped_back, std::nullopt);
  if (stepped && (left == Tool::Face || same(cameras, stepped->after))) cameras = stepped->before;
  const std::vector<CameraState> before = cameras;
  if (session.tool == Tool::Face)
    see_head(c);
  else if (is_of_rest(session.tool))
    see_rest(c);
  if (session.tool == Tool::Crop) see_crop_box(c);
  if (!same(cameras, before)) session.stepped_back = {before, cameras};
}

void add_tools(Commands& commands) {
  constexpr Names<kToolNames.size()> kKeys{"Q", "W", "E", "R", "P", "C", "", ""};
  for (size_t i = 0; i < kToolNames.size(); ++i)
    commands.add({std::string("tool.") + kToolNames[i], kToolLabels[i], "", kKeys[i]},
                 [name = kToolNames[i]](Call& c) { c.studio.run("tool", {name}); });
  commands.add({"tool", "Tool", "look|joints|bones|target-joints|paint|crop|rest-pose|face"}, [](Call& c) {
    const Tool before = std::exchange(c.session.tool, c.choice<Tool>(0, "tool", kToolNames));
    if (before != c.session.tool) adjust_cameras(c, before);
  });
  commands.add({"tool.falloff", "Falloff", "FRAMES"},
               [](Call& c) { c.session.falloff = c.clamped(0, "falloff", 0, 10000); });
  commands.add({"tool.children", "Children follow", "on|off"},
               [](Call& c) { c.session.drag_children = c.on(0); });
  commands.add({"tool.mirror", "Mirror joint follows", "on|off"},
               [](Call& c) { c.session.mirror_joint = c.on(0); });
  commands.add({"select.joint", "Select joint", "JOINT|none"},
               [](Call& c) { c.session.selected_joint = c.word(0, "joint") == "none" ? -1 : c.joint(0); });
}

void add_brush(Commands& commands) {
  commands.add({"tool.brush_radius", "Brush radius", "METRES"},
               [](Call& c) { c.session.brush.radius_m = c.clamped(0, "radius", 0.002f, 1.f); });
  commands.add({"tool.brush_strength", "Brush strength", "0 to 1"},
               [](Call& c) { c.session.brush.strength = c.clamped(0, "strength", 0.f, 1.f); });
  commands.add({"tool.brush_mode", "Brush mode", "add|subtract|smooth"},
               [](Call& c) { c.session.brush.mode = c.choice<BrushMode>(0, "mode", kBrushModeNames); });
}

void add_work(Commands& commands) {
  commands.add({"work.pause", "Pause processing"}, [](Call& c) { c.studio.pause_work(true); });
  commands.add({"work.resume", "Resume processing"}, [](Call& c) { c.studio.pause_work(false); });
  commands.add({"work.restart", "Recompute all frames", "", "Ctrl+R"},
               [](Call& c) { c.studio.restart_work(); });
  commands.add({"job.cancel", "Cancel", "ID"},
               [](Call& c) { c.studio.jobs().cancel(c.number<int>(0, "job")); });
  commands.add({"error.dismiss", "Close"}, [](Call& c) {
    if (!c.session.errors.empty()) c.session.errors.pop_front();
  });
  commands.add({"log.clear", "Clear the log"}, [](Call& c) {
    c.session.log.clear();
    c.session.failures.clear();
  });
  commands.add({"notice", "Notice", "TEXT"}, [](Call& c) { c.studio.notify(c.word(0, "text")); });
  commands.add({"notice.dismiss", "Dismiss notices", "[NUMBER]"}, [](Call& c) {
    auto& notices = c.session.notices;
    const int number = c.arguments.empty() ? 0 : c.number<int>(0, "notice");
    notices.erase(std::remove_if(notices.begin(), notices.end(),
                                 [&](const Notice& notice) { return number == 0 || notice.id == number; }),
                  notices.end());
  });
  commands.add({"app.quit", "Quit", "", "Ctrl+Q"}, [](Call& c) {
    c.session.quit = !c.session.changed && !c.session.study.changed;
    if (c.session.changed)
      c.session.question =
          Question{Question::Kind::UnsavedChanges, "Save the changes before you quit?", "app.quit"};
    else
      no_unsaved_study(c.studio, "app.quit");
  });
}

/// Which card of Getting started is shown.
void add_cards(Commands& commands) {
  commands.add({"help.getting_started", "Getting started", "[CARD: 1 to 5|off]"}, [](Call& c) {
    int& card = c.session.settings.getting_started;
    const bool is_off = !c.arguments.empty() && c.arguments[0] == "off";
    card = is_off ? 0 : c.arguments.empty() ? 1 : c.clamped(0, "card", 1, kGettingStartedCards);
    c.studio.save_settings();
  });
}

void add_settings(Commands& commands) {
  const auto setting = [&commands](CommandText text, auto set) {
    commands.add(std::move(text), [set](Call& c) {
      set(c, c.session.settings);
      c.studio.save_settings();
    });
  };
  setting({"settings.theme", "Theme", "dark|light"}, [](Call& c, Settings& s) {
    s.dark = c.choice(0, "theme", {"dark", "light"}) == 0;
  });
  setting({"settings.scale", "Scale of the interface", "0.75 to 3 | auto"}, [](Call& c, Settings& s) {
    s.scale = c.word(0, "scale") == "auto" ? 0.f : c.clamped(0, "scale", 0.75f, 3.f);
  });
  setting({"settings.samples", "Antialiasing", "1|2|4"}, [](Call& c, Settings& s) {
    s.samples = 1 << c.choice(0, "number of samples", {"1", "2", "4"});
  });
  setting({"settings.cache_mb", "Memory for frames", "MB"}, [](Call& c, Settings& s) {
    s.cache_mb = c.clamped(0, "size", 64, 8192);
    c.studio.cache().set_limit(s.cache_mb);
  });
  setting({"settings.autosave_s", "Autosave", "SECONDS"},
          [](Call& c, Settings& s) { s.autosave_s = c.clamped(0, "time", 1.0, 600.0); });
  setting({"settings.mouse", "Mouse sensitivity", "FACTOR: 0.2 to 4"},
          [](Call& c, Settings& s) { s.mouse_sensitivity = c.clamped(0, "factor", 0.2f, 4.f); });
  setting({"settings.undo_depth", "Undo steps", "STEPS: 10 to 1000; takes effect at the next start"},
          [](Call& c, Settings& s) { s.undo_depth = c.clamped(0, "number", 10, 1000); });
}

}  // namespace

void add_program_commands(Commands& commands) {
  add_tools(commands);
  add_brush(commands);
  add_work(commands);
  add_cards(commands);
  add_settings(commands);
}

}  // namespace understudy::app
