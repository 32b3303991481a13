#include "ui/panels/settings.hpp"

#include <cmath>

#include "ui/gui/gui.hpp"
#include "ui/panels/rows.hpp"
#include "ui/widgets/dialogs.hpp"

namespace understudy::ui {
namespace {

void draw_scale(const app::Settings& settings, PanelContext& context) {
  constexpr float kScales[] = {0, 0.75f, 1, 1.25f, 1.5f, 2, 2.5f, 3};
  std::vector<std::string> labels;
  int chosen = -1;
  for (const float scale : kScales) {
    if (scale == settings.scale) chosen = labels.size();
    labels.push_back(scale == 0 ? "Automatic" : std::to_string(std::lround(100 * scale)) + " %");
  }
  row(context.ui, "Scale", "Size of text and controls");
  if (dropdown(context.ui, "settings.scale", labels, chosen))
    context.ask("settings.scale", {chosen == 0 ? "auto" : argument(kScales[chosen])});
}

void draw_rows(const app::Settings& settings, PanelContext& context) {
  Ui& ui = context.ui;
  ask_choice(context, {"settings.theme", "Theme"}, {"Dark", "Light"}, {"dark", "light"},
             settings.dark ? "dark" : "light");
  draw_scale(settings, context);
  ask_choice(context, {"settings.samples", "Antialiasing", "Samples per pixel; fewer are faster"},
             {"Off", "2", "4"}, {"1", "2", "4"},
             settings.samples >= 4   ? "4"
             : settings.samples >= 2 ? "2"
                                     : "1");
  ask_number(context, {"settings.mouse", "Mouse", "How fast the views turn when you drag"},
             settings.mouse_sensitivity, {0.2f, 4, 0.01f, "%.2f \u00d7", 1, true});
  if (const auto mb = typed_number_row(
          ui, {"settings.cache", "Frames kept, MB", "Memory for frames already shown"}, settings.cache_mb, 0))
    context.ask("settings.cache_mb", {argument(std::round(*mb))});
  if (const auto s = typed_number_row(
          ui, {"settings.autosave", "Autosave, s", "How often unsaved work is saved for recovery"},
          settings.autosave_s, 0))
    context.ask("settings.autosave_s", {argument(*s)});
  if (const auto n = typed_number_row(ui,
                                      {"settings.undo_depth", "Undo steps",
                                       "How many steps can be undone; takes effect at the next start"},
                                      settings.undo_depth, 0))
    context.ask("settings.undo_depth", {argument(std::round(*n))});
}

}  // namespace

bool draw_settings(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "settings", "Settings", 440)) return true;
  draw_rows(session.settings, context);
  ImGui::Dummy({0, ui.px(4)});
  ButtonOptions close;
  close.look = ButtonLook::Main, close.width = -1;
  bool stays = !button(ui, "settings.close", "Close", close);
  stays &=
      ImGui::IsWindowAppearing() || ImGui::GetIO().WantTextInput || !key_pressed(render::Key::Escape, false);
  if (!stays) ImGui::CloseCurrentPopup();
  end_dialog();
  return stays;
}

}  // namespace understudy::ui
