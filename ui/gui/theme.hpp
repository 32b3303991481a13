// The studio's look: two palettes and one set of measures.
#pragma once

#include <imgui.h>

#include <array>

namespace understudy::ui {

enum class ThemeKind { Dark, Light };

/// Every colour the studio uses. Panels use these names, never numbers.
struct Theme {
  ThemeKind kind = ThemeKind::Dark;
  ImVec4 backdrop;                             ///< behind and between the panels
  ImVec4 panel, raised;                        ///< a panel; menus, popups and headers on it
  ImVec4 field, field_hover, field_active;     ///< what can be clicked or typed into
  ImVec4 line;                                 ///< borders and separators
  ImVec4 text, text_dim, text_faint;           ///< words; labels and units; disabled
  ImVec4 accent, accent_hover, accent_active;  ///< the one colour: what is on, chosen, or the main action
  ImVec4 on_accent;                            ///< words and icons upon the accent
  ImVec4 good, warning, danger;
  ImVec4 shade;                  ///< over everything behind a dialog
  std::array<ImVec4, 8> series;  ///< curves, in order; distinct for any colour vision
};

const Theme& theme(ThemeKind kind);

/// Of the person with that number, from 1, in lists and views.
ImVec4 person_color(const Theme& theme, int number);

/// Of a found bone, in lists and views; one of 22.
ImVec4 bone_color(int bone);
/// Of a motion that was made with that seed, as distinct.
ImVec4 made_color(uint64_t seed);

/// Measures and colours for ImGui. `scale` is 1 to 3.
void apply(const Theme& theme, float scale, ImGuiStyle& style);

/// A colour for draw lists, its opacity multiplied; fainter where things are greyed out.
ImU32 color(const ImVec4& color, float opacity = 1);
/// Between two colours; 0 is `a`.
ImVec4 mix(const ImVec4& a, const ImVec4& b, float t);

}  // namespace understudy::ui
