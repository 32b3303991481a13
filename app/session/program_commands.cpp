#include <algorithm>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

/// Goes as far back as the spread arms of a T-pose ask; never nearer.
void see_whole(Studio& studio) {
  Session& session = studio.session();
  if (!session.view.linked) session.view.active_pane = session.selected_take + 1;
  const size_t i = session.view.linked ? 0 : session.view.active_pane;
  const View before = session.view;
  studio.run("view.fit");
  if (i < before.cameras.size() && session.view.cameras[i].distance <= before.cameras[i].distance)
    session.view.cameras = before.cameras;
}

void add_tools(Commands& commands) {
  struct Row {
    const char *name, *label, *key;
  };
  static constexpr Row kTools[] = {{"look", "Look", "Q"},           {"joints", "Extracted joints", "W"},
                                   {"bones", "Bones", "E"},         {"target-joints", "Target joints", "R"},
                                   {"paint", "Paint weights", "P"}, {"crop", "Crop", "C"}};
  for (const Row& row : kTools)
    commands.add({std::string("tool.") + row.name, row.label, "", row.key, false, false,
                  [&row](Studio& s, const Arguments&) { s.run("tool", {row.name}); }});
  commands.add({"tool", "Tool", "look|joints|bones|target-joints|paint|crop", "", false, false,
                [](Studio& s, const Arguments& a) {
                  const auto tool = static_cast<Tool>(
                      choice(a, 0, "tool", {"look", "joints", "bones", "target-joints", "paint", "crop"}));
                  const bool changes = s.session().tool != tool;
                  s.session().tool = tool;
                  if (changes && tool == Tool::TargetJoints) see_whole(s);
                }});
  commands.add({"tool.falloff", "Falloff", "FRAMES", "", false, false, [](Studio& s, const Arguments& a) {
                  s.session().falloff = std::clamp(whole_number(a, 0, "falloff"), 0, 10000);
                }});
  commands.add({"tool.children", "Children follow", "on|off", "", false, false,
                [](Studio& s, const Arguments& a) { s.session().drag_children = on_off(a, 0); }});
  commands.add({"tool.mirror", "Mirror joint follows", "on|off", "", false, false,
                [](Studio& s, const Arguments& a) { s.session().mirror_joint = on_off(a, 0); }});
  commands.add(
      {"select.joint", "Select joint", "JOINT|none", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().selected_joint = word(a, 0, "joint") == "none" ? -1 : joint_argument(a, 0);
       }});
}

void add_brush(Commands& commands) {
  commands.add(
      {"tool.brush_radius", "Brush radius", "METRES", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().brush.radius_m = std::clamp(static_cast<float>(number(a, 0, "radius")), 0.002f, 1.f);
       }});
  commands.add({"tool.brush_strength", "Brush strength", "0 to 1", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().brush.strength =
                      std::clamp(static_cast<float>(number(a, 0, "strength")), 0.f, 1.f);
                }});
  commands.add({"tool.brush_mode", "Brush mode", "add|subtract|smooth", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().brush.mode =
                      static_cast<Brush::Mode>(choice(a, 0, "mode", {"add", "subtract", "smooth"}));
                }});
}

void add_work(Commands& commands) {
  commands.add({"work.pause", "Pause retargeting", "", "", false, false,
                [](Studio& s, const Arguments&) { s.pause_work(true); }});
  commands.add({"work.resume", "Continue retargeting", "", "", false, false,
                [](Studio& s, const Arguments&) { s.pause_work(false); }});
  commands.add({"work.restart", "Retarget again", "", "Ctrl+R", false, false,
                [](Studio& s, const Arguments&) { s.restart_work(); }});
  commands.add({"job.cancel", "Cancel", "ID", "", false, false,
                [](Studio& s, const Arguments& a) { s.jobs().cancel(whole_number(a, 0, "job")); }});
  commands.add({"error.dismiss", "Close", "", "", false, false, [](Studio& s, const Arguments&) {
                  if (!s.session().errors.empty()) s.session().errors.pop_front();
                }});
  commands.add({"log.clear", "Clear the log", "", "", false, false,
                [](Studio& s, const Arguments&) { s.session().log.clear(); }});
  commands.add({"notice", "Notice", "TEXT", "", false, false,
                [](Studio& s, const Arguments& a) { s.notify(word(a, 0, "text")); }});
  commands.add({"app.quit", "Quit", "", "Ctrl+Q", false, false, [](Studio& s, const Arguments&) {
                  Session& session = s.session();
                  if (session.changed) {
                    session.question = Question{};
                    session.question->text = "Save the changes before you quit?";
                    session.question->then = "app.quit";
                    return;
                  }
                  session.quit = true;
                }});
}

void add_settings(Commands& commands) {
  commands.add({"settings.theme", "Theme", "dark|light", "", false, false, [](Studio& s, const Arguments& a) {
                  s.session().settings.dark = choice(a, 0, "theme", {"dark", "light"}) == 0;
                  s.save_settings();
                }});
  commands.add({"settings.scale", "Scale of the interface", "0.75 to 3 | auto", "", false, false,
                [](Studio& s, const Arguments& a) {
                  float& scale = s.session().settings.scale;
                  scale = word(a, 0, "scale") == "auto"
                              ? 0.f
                              : std::clamp(static_cast<float>(number(a, 0, "scale")), 0.75f, 3.f);
                  s.save_settings();
                }});
  commands.add(
      {"settings.samples", "Antialiasing", "1|2|4", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().settings.samples = 1 << choice(a, 0, "number of samples", {"1", "2", "4"});
         s.save_settings();
       }});
  commands.add(
      {"settings.cache_mb", "Memory for frames", "MB", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().settings.cache_mb = std::clamp(whole_number(a, 0, "size"), 64, 8192);
         s.cache().set_limit(s.session().settings.cache_mb);
         s.save_settings();
       }});
  commands.add(
      {"settings.autosave_s", "Autosave", "SECONDS", "", false, false, [](Studio& s, const Arguments& a) {
         s.session().settings.autosave_s = std::clamp(number(a, 0, "time"), 1.0, 600.0);
         s.save_settings();
       }});
  commands.add({"settings.mouse", "Mouse sensitivity", "FACTOR: 0.2 to 4", "", false, false,
                [](Studio& s, const Arguments& a) {
                  s.session().settings.mouse_sensitivity =
                      std::clamp(static_cast<float>(number(a, 0, "factor")), 0.2f, 4.f);
                  s.save_settings();
                }});
  commands.add({"settings.undo_depth", "Undo steps", "STEPS: 10 to 1000; takes effect at the next start", "",
                false, false, [](Studio& s, const Arguments& a) {
                  s.session().settings.undo_depth = std::clamp(whole_number(a, 0, "number"), 10, 1000);
                  s.save_settings();
                }});
  commands.add(
      {"panel.show", "Panel", "NAME on|off|toggle", "", false, false, [](Studio& s, const Arguments& a) {
         auto& panels = s.session().settings.panels;
         const auto found = panels.find(word(a, 0, "panel"));
         panels[a[0]] = switched(a, 1, found == panels.end() || found->second);
       }});
}

}  // namespace

void add_program_commands(Commands& commands) {
  add_tools(commands);
  add_brush(commands);
  add_work(commands);
  add_settings(commands);
}

}  // namespace understudy::app
