#include "ui/gui/theme.hpp"

#include <algorithm>

#include "render/colors.hpp"

namespace understudy::ui {
namespace {

ImVec4 hex(int rgb, float opacity = 1) {
  return {static_cast<float>((rgb >> 16) & 255) / 255, static_cast<float>((rgb >> 8) & 255) / 255,
          static_cast<float>(rgb & 255) / 255, opacity};
}

Theme make_dark() {
  Theme t;
  t.kind = ThemeKind::Dark;
  t.backdrop = hex(0x141518), t.panel = hex(0x1E2023), t.raised = hex(0x26292D);
  t.field = hex(0x2D3035), t.field_hover = hex(0x383C42), t.field_active = hex(0x434850);
  t.line = hex(0x363A40);
  t.text = hex(0xE6E8EB), t.text_dim = hex(0x9DA3AC), t.text_faint = hex(0x666C75);
  t.accent = hex(0x3D7EEB), t.accent_hover = hex(0x5590F2), t.accent_active = hex(0x2F6BD0);
  t.on_accent = hex(0xFFFFFF);
  t.good = hex(0x4CB782), t.warning = hex(0xE5A63C), t.danger = hex(0xE5645C);
  t.shade = hex(0x000000, 0.5f);
  t.series = {hex(0x6AA9FF), hex(0xF2A541), hex(0x56C4A0), hex(0xE57BB0),
              hex(0xB79CF2), hex(0xE8D36A), hex(0x8FD3F4), hex(0xD98E73)};
  return t;
}

Theme make_light() {
  Theme t;
  t.kind = ThemeKind::Light;
  t.backdrop = hex(0xDFE2E6), t.panel = hex(0xF6F7F8), t.raised = hex(0xFFFFFF);
  t.field = hex(0xE6E9ED), t.field_hover = hex(0xDADEE4), t.field_active = hex(0xCDD3DB);
  t.line = hex(0xD3D7DD);
  t.text = hex(0x1C1F23), t.text_dim = hex(0x5C636D), t.text_faint = hex(0x9BA2AC);
  t.accent = hex(0x2B6CE0), t.accent_hover = hex(0x4480EA), t.accent_active = hex(0x205AC2);
  t.on_accent = hex(0xFFFFFF);
  t.good = hex(0x1F8F5B), t.warning = hex(0xB87400), t.danger = hex(0xC93A32);
  t.shade = hex(0x1C1F23, 0.3f);
  t.series = {hex(0x0072B2), hex(0xD55E00), hex(0x009E73), hex(0xB8518D),
              hex(0x6A4FBF), hex(0x8A7A00), hex(0x3A9BD9), hex(0x8A4B20)};
  return t;
}

void set_measures(float scale, ImGuiStyle& style) {
  style = ImGuiStyle();
  style.WindowPadding = {12, 10}, style.FramePadding = {8, 5}, style.CellPadding = {8, 4};
  style.ItemSpacing = {8, 6}, style.ItemInnerSpacing = {6, 4};
  style.WindowRounding = 6, style.ChildRounding = 4, style.FrameRounding = 4, style.PopupRounding = 6;
  style.ScrollbarRounding = 6, style.GrabRounding = 4, style.TabRounding = 4;
  style.WindowBorderSize = 1, style.ChildBorderSize = 1, style.PopupBorderSize = 1, style.FrameBorderSize = 0;
  style.ScrollbarSize = 11, style.GrabMinSize = 10, style.IndentSpacing = 16;
  style.WindowTitleAlign = {0, 0.5f}, style.WindowMenuButtonPosition = ImGuiDir_None;
  style.WindowMinSize = {40, 32};
  style.ScaleAllSizes(scale);
}

ImVec4 faded(ImVec4 c, float opacity) {
  c.w *= opacity;
  return c;
}

void set_colors(const Theme& t, ImVec4* c) {
  const ImVec4 none(0, 0, 0, 0);
  c[ImGuiCol_Text] = t.text, c[ImGuiCol_TextDisabled] = t.text_dim;
  c[ImGuiCol_WindowBg] = t.panel, c[ImGuiCol_ChildBg] = none, c[ImGuiCol_PopupBg] = t.raised;
  c[ImGuiCol_Border] = t.line, c[ImGuiCol_BorderShadow] = none;
  c[ImGuiCol_FrameBg] = t.field, c[ImGuiCol_FrameBgHovered] = t.field_hover;
  c[ImGuiCol_FrameBgActive] = t.field_active;
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = t.raised;
  c[ImGuiCol_MenuBarBg] = t.raised;
  c[ImGuiCol_ScrollbarBg] = none, c[ImGuiCol_ScrollbarGrab] = t.field_hover;
  c[ImGuiCol_ScrollbarGrabHovered] = c[ImGuiCol_ScrollbarGrabActive] = t.field_active;
  c[ImGuiCol_CheckMark] = t.accent_hover;
  c[ImGuiCol_SliderGrab] = t.accent, c[ImGuiCol_SliderGrabActive] = t.accent_hover;
  c[ImGuiCol_Button] = t.field, c[ImGuiCol_ButtonHovered] = t.field_hover;
  c[ImGuiCol_ButtonActive] = t.field_active;
  c[ImGuiCol_Header] = faded(t.accent, 0.28f), c[ImGuiCol_HeaderHovered] = t.field_hover;
  c[ImGuiCol_HeaderActive] = t.field_active;
  c[ImGuiCol_Separator] = t.line, c[ImGuiCol_SeparatorHovered] = t.accent_hover;
  c[ImGuiCol_SeparatorActive] = t.accent;
  c[ImGuiCol_ResizeGrip] = none, c[ImGuiCol_ResizeGripHovered] = t.field_hover;
  c[ImGuiCol_ResizeGripActive] = t.accent;
  c[ImGuiCol_Tab] = c[ImGuiCol_TabUnfocused] = none, c[ImGuiCol_TabHovered] = t.field_hover;
  c[ImGuiCol_TabActive] = c[ImGuiCol_TabUnfocusedActive] = t.field;
  c[ImGuiCol_PlotLines] = c[ImGuiCol_PlotHistogram] = t.series[0];
  c[ImGuiCol_PlotLinesHovered] = c[ImGuiCol_PlotHistogramHovered] = t.accent_hover;
  c[ImGuiCol_TableHeaderBg] = t.raised, c[ImGuiCol_TableBorderStrong] = t.line;
  c[ImGuiCol_TableBorderLight] = faded(t.line, 0.6f), c[ImGuiCol_TableRowBg] = none;
  c[ImGuiCol_TableRowBgAlt] = faded(t.field, 0.35f);
  c[ImGuiCol_TextSelectedBg] = faded(t.accent, 0.45f), c[ImGuiCol_DragDropTarget] = t.accent_hover;
  c[ImGuiCol_NavHighlight] = t.accent_hover, c[ImGuiCol_NavWindowingHighlight] = t.accent_hover;
  c[ImGuiCol_NavWindowingDimBg] = c[ImGuiCol_ModalWindowDimBg] = t.shade;
}

}  // namespace

const Theme& theme(ThemeKind kind) {
  static const Theme dark = make_dark(), light = make_light();
  return kind == ThemeKind::Dark ? dark : light;
}

void apply(const Theme& theme, float scale, ImGuiStyle& style) {
  set_measures(scale, style);
  set_colors(theme, style.Colors);
}

ImVec4 person_color(const Theme& theme, int number) {
  const size_t k = static_cast<size_t>(std::max(number, 1) - 1), n = theme.series.size();
  return k % (2 * n) < n ? theme.series[k % n] : mix(theme.series[k % n], theme.text, 0.5f);
}

ImVec4 bone_color(int bone) {
  const Vec3& of = render::kCategories[static_cast<size_t>(std::max(0, bone)) % render::kCategories.size()];
  return {of.x(), of.y(), of.z(), 1};
}

ImVec4 made_color(uint64_t seed) {
  constexpr uint64_t kFirst = 3;  // the others are white, slate, and nearly the selected bone's yellow
  return bone_color(static_cast<int>(kFirst + seed % (render::kCategories.size() - kFirst)));
}

ImU32 color(const ImVec4& color, float opacity) {
  ImVec4 c = color;
  c.w *= opacity * ImGui::GetStyle().Alpha;
  return ImGui::ColorConvertFloat4ToU32(c);
}

ImVec4 mix(const ImVec4& a, const ImVec4& b, float t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z), a.w + t * (b.w - a.w)};
}

}  // namespace understudy::ui
