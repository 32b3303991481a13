#include "ui/widgets/controls.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "retarget/base/index.hpp"

namespace understudy::ui {
namespace {

/// An invisible button; the caller draws it.
struct Press {
  bool clicked = false, hovered = false, held = false;
  Rect rect;
};

Press press(Ui& ui, const std::string& name, ImVec2 size, const std::string& mark) {
  Press press;
  press.clicked = ImGui::InvisibleButton(name.c_str(), {std::max(size.x, 1.f), std::max(size.y, 1.f)});
  press.hovered = ImGui::IsItemHovered(), press.held = ImGui::IsItemActive();
  press.rect = {ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
  ui.mark(mark);
  ui.stop(mark);
  return press;
}

float rounding() {
  return ImGui::GetStyle().FrameRounding;
}

void fill(const Rect& rect, const ImVec4& with, float corner) {
  ImGui::GetWindowDrawList()->AddRectFilled(rect.min, rect.max, color(with), corner);
}

void write(const ImVec2& at, const std::string& words, const ImVec4& with) {
  ImGui::GetWindowDrawList()->AddText(at, color(with), words.c_str());
}

/// Words in the middle of the rectangle, cut so that `around` pixels of it stay free.
void write_centered(const Rect& rect, const std::string& words, const ImVec4& with, float around) {
  const std::string cut = cut_to(words, rect.width() - around);
  const ImVec2 size = ImGui::CalcTextSize(cut.c_str());
  const ImVec2 at(std::floor(rect.at(0.5f, 0).x - size.x / 2), std::floor(rect.at(0, 0.5f).y - size.y / 2));
  write(at, cut, with);
}

struct Resting {
  ImVec2 on{-1, -1};
  double since = 0;
  int frame = -2;
};

/// Whether the pointer has rested on the last item long enough for a tooltip.
bool rests(Ui& ui) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return false;
  auto& resting = ui.state<Resting>(ImHashStr("tooltip"));
  const ImVec2 on = ImGui::GetItemRectMin();
  const bool same =
      resting.on.x == on.x && resting.on.y == on.y && resting.frame >= ImGui::GetFrameCount() - 1;
  if (!same) resting.on = on, resting.since = ImGui::GetTime();
  resting.frame = ImGui::GetFrameCount();
  return ImGui::GetTime() - resting.since > 0.4;
}

struct ButtonColors {
  ImVec4 box, hovered, held, words;
};

ButtonColors button_colors(const Theme& t, ButtonLook look) {
  const ImVec4 none(t.field.x, t.field.y, t.field.z, 0);
  switch (look) {
    case ButtonLook::Main:
      return {t.accent, t.accent_hover, t.accent_active, t.on_accent};
    case ButtonLook::Danger:
      return {t.danger, mix(t.danger, t.on_accent, 0.12f), mix(t.danger, t.backdrop, 0.15f), t.on_accent};
    case ButtonLook::Quiet:
      return {none, t.field_hover, t.field_active, t.text};
    default:
      return {t.field, t.field_hover, t.field_active, t.text};
  }
}

float width_left(float wanted) {
  const float left = ImGui::GetContentRegionAvail().x;
  return wanted > 0 ? wanted : std::max(1.f, left + wanted);
}

void show_tooltip(Ui& ui, const std::string& text, const std::string& shortcut) {
  if (text.empty() || !rests(ui)) return;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(9), ui.px(6)});
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.f);  // also on what is greyed out
  ImGui::BeginTooltip();
  paragraph(text, ui.px(360));
  if (!shortcut.empty()) {
    ImGui::SameLine(0, ui.px(12));
    ImGui::TextColored(ui.theme().text_dim, "%s", shortcut.c_str());
  }
  ui.mark("tooltip", {ImGui::GetWindowPos(),
                      {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(),
                       ImGui::GetWindowPos().y + ImGui::GetWindowHeight()}});
  ImGui::EndTooltip();
  ImGui::PopStyleVar(2);
}

/// The grey label of a row; what follows begins `width` pixels right of its start.
void row_label(Ui& ui, const std::string& label, const std::string& explanation, float width) {
  const float start = ImGui::GetCursorPosX();
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  ui.explain({{at, {at.x + room.x, at.y + ImGui::GetFrameHeight()}}, label, explanation});
  {
    const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
    text_cut(ui, label, width - ui.px(8));
  }
  show_tooltip(ui, explanation, "");
  ImGui::SameLine(start + width);
}

/// Of a section.
struct Opened {
  bool seen = false, open = false;
};

void draw_bar(Ui& ui, const Rect& rect, float fraction) {
  const Theme& t = ui.theme();
  const float corner = rect.height() / 2;
  fill(rect, t.field_hover, corner);
  float from = 0, to = std::min(fraction, 1.f);
  if (fraction < 0) {
    const auto phase = static_cast<float>(std::fmod(ImGui::GetTime() * 0.7, 1.0));
    from = std::max(0.f, 1.3f * phase - 0.3f), to = std::min(1.f, 1.3f * phase);
  }
  if (to > from)
    fill({{rect.at(from, 0).x, rect.min.y},
          {std::max(rect.at(to, 0).x, rect.at(from, 0).x + 2 * corner), rect.max.y}},
         t.accent, corner);
}

/// Of choices beside each other: all alike, but where a word needs more and others less each has its own.
std::vector<float> segment_widths(const std::vector<std::string>& choices, float width, float around) {
  std::vector<float> widths;
  float needed = 0, widest = 0;
  for (const std::string& choice : choices) {
    widths.push_back(ImGui::CalcTextSize(choice.c_str()).x + around);
    needed += widths.back(), widest = std::max(widest, widths.back());
  }
  const float count = static_cast<float>(choices.size()), each = width / count;
  const bool alike = widest <= each || needed - width > count * around;
  for (float& one : widths) one = alike ? each : one + (width - needed) / count;
  return widths;
}

/// The text with "\u2026" for as few bytes as possible; `front` says how many of the kept ones are before it.
template <class Front>
std::string longest_cut(const std::string& text, float width, Front front) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  const auto is_inside = [&](size_t at) {  // a UTF-8 letter, which is never split
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
  };
  const auto cut = [&](size_t kept) {
    size_t begin = front(kept), end = text.size() - (kept - begin);
    while (begin > 0 && is_inside(begin)) --begin;
    while (is_inside(end)) ++end;
    return text.substr(0, begin) + "\u2026" + text.substr(end);
  };
  size_t low = 0, high = text.size();
  while (low < high) {
    const size_t middle = (low + high + 1) / 2;
    if (ImGui::CalcTextSize(cut(middle).c_str()).x <= width)
      low = middle;
    else
      high = middle - 1;
  }
  return cut(low);
}

}  // namespace

void tooltip(Ui& ui, const std::string& text, const std::string& shortcut) {
  ui.explain({{ImGui::GetItemRectMin(), ImGui::GetItemRectMax()}, "", text, shortcut});
  show_tooltip(ui, text, shortcut);
}

bool icon_button(Ui& ui, const std::string& name, Icon icon, const IconButtonOptions& options) {
  const DisabledScope disabled(options.disabled);
  const Theme& t = ui.theme();
  const float side = std::round(ui.px(options.size)),
              size = std::round(ui.px(std::min(options.size - 8, 18.f)));
  const Press p = press(ui, name, {side, side}, name);
  if (options.active)
    fill(p.rect, p.hovered ? t.accent_hover : t.accent, rounding());
  else if (p.hovered || p.held)
    fill(p.rect, p.held ? t.field_active : t.field_hover, rounding());
  const float margin = std::round((side - size) / 2);
  draw_icon(*ImGui::GetWindowDrawList(), icon, {p.rect.min.x + margin, p.rect.min.y + margin}, size,
            color(options.active ? t.on_accent : t.text));
  tooltip(ui, options.tooltip, options.shortcut);
  return p.clicked;
}

bool button(Ui& ui, const std::string& name, const std::string& label, const ButtonOptions& options) {
  const DisabledScope disabled(options.disabled);
  const float wanted =
      ImGui::CalcTextSize(label.c_str()).x + ui.px(options.look == ButtonLook::Quiet ? 16 : 28);
  const float width = options.width == 0 ? wanted : width_left(options.width);
  const ButtonColors colors = button_colors(ui.theme(), options.look);
  const Press p = press(ui, name, {std::round(width), ImGui::GetFrameHeight()}, name);
  fill(p.rect, p.held ? colors.held : p.hovered ? colors.hovered : colors.box, rounding());
  write_centered(p.rect, label, colors.words, ImGui::GetStyle().FramePadding.x);
  tooltip(ui, options.tooltip, options.shortcut);
  return p.clicked;
}

bool toggle(Ui& ui, const std::string& name, const std::string& label, bool& on) {
  const Theme& t = ui.theme();
  const float height = std::round(ui.px(16)), width = std::round(ui.px(28)), frame = ImGui::GetFrameHeight();
  const float words = label.empty() ? 0 : ImGui::CalcTextSize(label.c_str()).x + ui.px(9);
  const Press p = press(ui, name, {width + words, frame}, name);
  if (p.clicked) on = !on;
  const Rect track{{p.rect.min.x, p.rect.min.y + (frame - height) / 2},
                   {p.rect.min.x + width, p.rect.min.y + (frame + height) / 2}};
  fill(track, on ? (p.hovered ? t.accent_hover : t.accent) : (p.hovered ? t.field_active : t.field_hover),
       height / 2);
  const ImVec2 knob(on ? track.max.x - height / 2 : track.min.x + height / 2, track.at(0, 0.5f).y);
  ImGui::GetWindowDrawList()->AddCircleFilled(knob, height / 2 - ui.px(2.5f),
                                              color(on ? t.on_accent : t.text_dim));
  const ImVec2 at(track.max.x + ui.px(9), p.rect.min.y + (frame - ImGui::GetTextLineHeight()) / 2);
  write(at, label, t.text);
  return p.clicked;
}

bool segmented(Ui& ui, const std::string& name, const std::vector<std::string>& choices, int& chosen,
               const std::vector<std::string>& tips) {
  const Theme& t = ui.theme();
  const IdScope id(name);
  const float height = ImGui::GetFrameHeight(), width = width_left(0), inset = std::round(ui.px(2));
  const float around = 0.5f * ImGui::GetStyle().FramePadding.x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Rect all{at, {at.x + width, at.y + height}};
  fill(all, t.field, rounding());
  bool changed = false;
  const std::vector<float> widths = segment_widths(choices, width, 2 * inset + around);
  float left = at.x;
  for (int i = 0; i < ssize(choices); ++i) {
    const float each = widths[i];
    ImGui::SetCursorScreenPos({left, at.y});
    const Press p = press(ui, std::to_string(i), {each, height}, name + "." + std::to_string(i));
    if (p.clicked && chosen != i) chosen = i, changed = true;
    if (i < ssize(tips)) tooltip(ui, tips[i]);
    const Rect inner{{std::round(left + inset), at.y + inset},
                     {std::round(left + each - inset), at.y + height - inset}};
    const bool on = chosen == i;
    if (on || p.hovered) fill(inner, on ? t.accent : t.field_hover, rounding() * 0.75f);
    write_centered(inner, choices[i], on ? t.on_accent : p.hovered ? t.text : t.text_dim, around);
    left += each;
  }
  ui.mark(name, all);
  return changed;
}

bool dropdown(Ui& ui, const std::string& name, const std::vector<std::string>& choices, int& chosen,
              const std::vector<std::string>& tips) {
  const Theme& t = ui.theme();
  const bool known = chosen >= 0 && chosen < ssize(choices);
  const float width = width_left(0), height = ImGui::GetFrameHeight(), arrow = ui.px(14);
  const Press p = press(ui, name, {width, height}, name);
  const std::string popup = name + ".list";
  const float padding = ImGui::GetStyle().FramePadding.x;
  fill(p.rect, p.held ? t.field_active : p.hovered ? t.field_hover : t.field, rounding());
  write({p.rect.min.x + padding, p.rect.min.y + ImGui::GetStyle().FramePadding.y},
        cut_name(known ? choices[chosen] : "", width - 2 * padding - arrow), t.text);
  draw_icon(*ImGui::GetWindowDrawList(), Icon::ChevronDown,
            {p.rect.max.x - arrow - ui.px(5), p.rect.min.y + (height - arrow) / 2}, arrow, color(t.text_dim));
  if (p.clicked) ImGui::OpenPopup(popup.c_str());
  const float wanted = static_cast<float>(choices.size()) * ImGui::GetTextLineHeightWithSpacing() + ui.px(24);
  const bool above = p.rect.max.y + wanted > ImGui::GetIO().DisplaySize.y && p.rect.min.y > wanted;
  float widest = 0;
  for (const std::string& choice : choices) widest = std::max(widest, ImGui::CalcTextSize(choice.c_str()).x);
  const float room = ImGui::GetIO().DisplaySize.x - widest - 2 * ImGui::GetStyle().WindowPadding.x - ui.px(4);
  ImGui::SetNextWindowPos({std::max(0.f, std::min(p.rect.min.x, room)),
                           above ? p.rect.min.y - ui.px(3) : p.rect.max.y + ui.px(3)},
                          ImGuiCond_Always, {0, above ? 1.f : 0.f});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {std::max(width, ui.px(480)), ui.px(360)});
  bool changed = false;
  if (ImGui::BeginPopup(popup.c_str())) {
    for (int i = 0; i < ssize(choices); ++i) {
      const IdScope id(i);
      if (ImGui::Selectable(choices[i].c_str(), i == chosen)) changed = chosen != i, chosen = i;
      if (i == chosen && ImGui::IsWindowAppearing()) ImGui::SetItemDefaultFocus();
      ui.mark(name + "." + std::to_string(i));
      if (i < ssize(tips)) tooltip(ui, tips[i]);
    }
    ImGui::EndPopup();
  }
  return changed;
}

bool number(Ui& ui, const std::string& name, float& value, const NumberOptions& options) {
  const IdScope id(name);
  const bool reset = options.resettable && value != options.initial;
  const float size = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::SetNextItemWidth(reset ? -(size + gap) : -FLT_MIN);
  bool changed = ImGui::DragFloat("##value", &value, options.speed, options.min, options.max, options.format,
                                  ImGuiSliderFlags_AlwaysClamp);
  ui.mark(name);
  ui.stop(name, true);
  if (!reset) return changed;
  ImGui::SameLine(0, gap);
  char words[64];
  std::snprintf(words, sizeof words, options.format, options.initial);
  if (icon_button(ui, name + ".reset", Icon::Reset,
                  {std::string("Back to ") + words, "", false, false, size / ui.scale()}))
    value = options.initial, changed = true;
  return changed;
}

bool text_field(Ui& ui, const std::string& name, std::string& text, const std::string& hint) {
  ImGui::SetNextItemWidth(-FLT_MIN);
  const bool changed = ImGui::InputTextWithHint(("##" + name).c_str(), hint.c_str(), &text);
  ui.mark(name);
  ui.stop(name, true);
  return changed;
}

void row(Ui& ui, const std::string& label, const std::string& explanation, float label_width) {
  ImGui::AlignTextToFramePadding();
  row_label(ui, label, explanation, label_width > 0 ? label_width : 0.4f * ImGui::GetContentRegionAvail().x);
}

void row_text(Ui& ui, const std::string& label, const std::string& value) {
  row_label(ui, label, "", 0.4f * ImGui::GetContentRegionAvail().x);
  text_cut(ui, value);
}

bool section(Ui& ui, const std::string& name, const std::string& title, bool open_at_first) {
  const Theme& t = ui.theme();
  auto& state = ui.state<Opened>(ImGui::GetID(name.c_str()));
  if (!state.seen) state = {true, open_at_first};
  const float height = ImGui::GetFrameHeight(), icon = std::round(ui.px(14));
  const Press p = press(ui, name, {width_left(0), height}, name);
  if (p.clicked) state.open = !state.open;
  if (p.hovered) fill(p.rect, t.field, rounding());
  draw_icon(*ImGui::GetWindowDrawList(), state.open ? Icon::ChevronDown : Icon::ChevronRight,
            {p.rect.min.x + ui.px(2), p.rect.min.y + (height - icon) / 2}, icon, color(t.text_dim));
  const FontScope strong(ui.fonts().strong);
  write({p.rect.min.x + icon + ui.px(8), p.rect.min.y + (height - ImGui::GetTextLineHeight()) / 2},
        cut_to(title, p.rect.width() - icon - ui.px(10)), t.text);
  return state.open;
}

std::string cut_to(const std::string& text, float width) {
  return longest_cut(text, width, [](size_t kept) { return kept; });
}

std::string cut_name(const std::string& name, float width) {
  return longest_cut(name, width, [](size_t kept) { return (kept + 1) / 2; });
}

void text_cut(Ui& ui, const std::string& text, float width) {
  const std::string cut = cut_to(text, width_left(width));
  ImGui::TextUnformatted(cut.c_str());
  if (cut != text) show_tooltip(ui, text, "");
}

std::string in_lines(const std::string& text, float room) {
  std::string lines = text;
  const float space = ImGui::CalcTextSize(" ").x;
  float used = 0;
  for (size_t begin = 0; begin < lines.size();) {
    const size_t end = std::min(lines.find_first_of(" \n", begin), lines.size());
    const float word = ImGui::CalcTextSize(lines.c_str() + begin, lines.c_str() + end).x;
    const bool follows = begin > 0 && lines[begin - 1] == ' ', fits = used + space + word <= room;
    if (follows && !fits) lines[begin - 1] = '\n';
    used = follows && fits ? used + space + word : word;
    begin = end + 1;
  }
  return lines;
}

void paragraph(const std::string& text, float width) {
  const float room = width_left(width);
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room + 1);  // for a word that is longer than a line
  ImGui::TextUnformatted(in_lines(text, room).c_str());
  ImGui::PopTextWrapPos();
}

void hint(Ui& ui, const std::string& text) {
  const FontScope small(ui.fonts().small);
  const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
  paragraph(text);
}

bool progress(Ui& ui, const std::string& name, const ProgressOptions& options) {
  const IdScope id(name);
  const float width = width_left(0), cancel = options.cancellable ? std::round(ui.px(24)) : 0;
  const float inner = width - (cancel > 0 ? cancel + ui.px(6) : 0), line = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = line + ui.px(5) + std::round(ui.px(6));
  const float right = options.right.empty() ? 0 : ImGui::CalcTextSize(options.right.c_str()).x + ui.px(8);
  write(at, cut_to(options.left, inner - right), ui.theme().text);
  if (right > 0) write({at.x + inner - right + ui.px(8), at.y}, options.right, ui.theme().text_dim);
  draw_bar(ui, {{at.x, at.y + height - std::round(ui.px(6))}, {at.x + inner, at.y + height}},
           options.fraction);
  ImGui::Dummy({inner, height});
  ui.mark(name);
  if (!options.cancellable) return false;
  ImGui::SameLine(0, ui.px(6));
  ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x, at.y + (height - cancel) / 2});
  return icon_button(ui, name + ".cancel", Icon::Close, {"Cancel", "", false, false, 24});
}

void splitter(Ui& ui, const std::string& name, float& size, float min, float max) {
  ImGui::InvisibleButton(name.c_str(),
                         {std::round(ui.px(6)), std::max(1.f, ImGui::GetContentRegionAvail().y)});
  ui.mark(name);
  const bool held = ImGui::IsItemActive(), lit = held || ImGui::IsItemHovered();
  const Rect rect{ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
  if (lit) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  const float middle = rect.at(0.5f, 0).x, half = ui.px(lit ? 1 : 0.5f);
  fill({{middle - half, rect.min.y}, {middle + half, rect.max.y}},
       lit ? ui.theme().accent_hover : ui.theme().line, 0);
  if (held) size = std::clamp(size - ImGui::GetIO().MouseDelta.x / ui.scale(), min, max);
}

}  // namespace understudy::ui
