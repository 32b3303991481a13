#include "ui/viewport/overlay.hpp"

#include <algorithm>

#include "ui/panels/panel.hpp"
#include "ui/widgets/controls.hpp"
#include "ui/widgets/icons.hpp"

namespace understudy::ui {
namespace {

constexpr int kBarSteps = 24;

ImU32 color_of(const Vec3& rgb) {
  return color(ImVec4(rgb.x(), rgb.y(), rgb.z(), 1));
}

/// Colours and their names, one a line, under a title at `at`.
void draw_swatches(Ui& ui, const Legend& legend, const ImVec2& at) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float swatch = ui.px(9), line = ImGui::GetTextLineHeight(), step = line + ui.px(1);
  for (size_t i = 0; i < legend.categories.size(); ++i) {
    const float y = at.y + ui.px(6) + step * static_cast<float>(i + 1), middle = y + line / 2 - swatch / 2;
    const ImVec2 from(at.x + ui.px(8), middle), to(from.x + swatch, from.y + swatch);
    list.AddRectFilled(from, to, color_of(legend.categories[i].color), ui.px(2));
    list.AddRect(from, to, color(ui.theme().text_dim, 0.6f), ui.px(2));
    list.AddText({to.x + ui.px(6), y}, color(ui.theme().text_dim), legend.categories[i].label.c_str());
  }
}

class Writer {
 public:
  Writer(Ui& ui, const Overlay& overlay) : ui_(ui), in_(overlay), list_(*ImGui::GetWindowDrawList()) {}
  void draw();

 private:
  float px(float length) const { return ui_.px(length); }
  static float line() { return ImGui::GetTextLineHeight(); }
  /// A quiet box to write upon.
  void box(const Rect& rect, const ImVec4& fill, float opacity = 0.78f) {
    list_.AddRectFilled(rect.min, rect.max, color(fill, opacity), px(5));
  }
  void text(const ImVec2& at, const ImVec4& ink, const std::string& words) {
    list_.AddText(at, color(ink), words.c_str());
  }
  static Rect around(const ImVec2& at, const ImVec2& size, float x, float y) {
    return {{at.x - x, at.y - y}, {at.x + size.x + x, at.y + size.y + y}};
  }
  ImVec2 legend_box(const ImVec2& inner, const ImVec4& ink, const std::string& words);
  void draw_title();
  void draw_warning(float top);
  void draw_hint();
  void draw_scale();
  void draw_categories();
  void draw_missing();
  void draw_labels();
  void draw_handles();
  void draw_tags();
  void draw_tip();

  Ui& ui_;
  const Overlay& in_;
  ImDrawList& list_;
};

void Writer::draw() {
  list_.PushClipRect(in_.rect.min, in_.rect.max, true);
  draw_labels();
  draw_handles();
  draw_tags();
  draw_title();
  draw_hint();
  if (!in_.legend.title.empty()) {
    if (!in_.legend.missing.empty())
      draw_missing();
    else if (in_.legend.categories.empty())
      draw_scale();
    else
      draw_categories();
  }
  if (in_.active) list_.AddRect(in_.rect.min, in_.rect.max, color(ui_.theme().accent), 0, 0, px(1.5f));
  list_.PopClipRect();
  draw_tip();
}

void Writer::draw_title() {
  const float pad = px(8), room = in_.rect.width() - in_.right_taken - px(20) - 2 * pad;
  if (room < px(30)) return;
  std::string title;
  ImVec2 title_size, subtitle_size(0, 0);
  {
    const FontScope strong(ui_.fonts().strong);
    title = cut_name(in_.title, room);
    title_size = ImGui::CalcTextSize(title.c_str());
  }
  const FontScope small(ui_.fonts().small);
  const std::string subtitle = cut_to(in_.subtitle, room);
  if (!subtitle.empty()) subtitle_size = ImGui::CalcTextSize(subtitle.c_str());
  const float width = std::max(title_size.x, subtitle_size.x) + 2 * pad;
  const float height = title_size.y + subtitle_size.y + px(8);
  const float left =
      in_.title_right ? in_.rect.max.x - in_.right_taken - px(10) - width : in_.rect.min.x + px(10);
  const ImVec2 at(left, in_.rect.min.y + px(10));
  if (!title.empty() || !subtitle.empty()) {
    box({at, {at.x + width, at.y + height}}, ui_.theme().panel);
    text({at.x + pad, at.y + px(4) + title_size.y}, ui_.theme().text_dim, subtitle);
    const FontScope strong(ui_.fonts().strong);
    text({at.x + pad, at.y + px(4)}, ui_.theme().text, title);
  }
  draw_warning(at.y + height + px(6));
}

void Writer::draw_warning(float top) {
  if (in_.warning.empty()) return;
  const float icon = line(), pad = px(6);
  const std::string words = cut_to(in_.warning, in_.rect.width() - in_.right_taken - px(20) - icon - 3 * pad);
  const float width = ImGui::CalcTextSize(words.c_str()).x + icon + 3 * pad;
  const float left =
      in_.title_right ? in_.rect.max.x - in_.right_taken - px(10) - width : in_.rect.min.x + px(10);
  const Rect rect{{left, top}, {left + width, top + line() + px(6)}};
  box(rect, mix(ui_.theme().panel, ui_.theme().warning, 0.18f), 0.92f);
  draw_icon(list_, Icon::Warning, {left + pad, top + px(3)}, icon, color(ui_.theme().warning));
  text({left + icon + 2 * pad, top + px(3)}, ui_.theme().text, words);
  ui_.mark("view.warning", rect);
}

void Writer::draw_hint() {
  if (in_.hint.empty()) return;
  const float room = std::max(px(60), std::min(in_.rect.width() - px(32), px(300)));
  const ImVec2 size = ImGui::CalcTextSize(in_.hint.c_str(), nullptr, false, room);
  const ImVec2 middle = in_.rect.at(0.5f, 0.5f);
  const ImVec2 at(middle.x - size.x / 2, middle.y - size.y / 2);
  box(around(at, size, px(14), px(10)), ui_.theme().panel);
  list_.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, color(ui_.theme().text_dim), in_.hint.c_str(),
                nullptr, room);
}

/// The box at the bottom left around an area of this size, its first line written; the box's top left corner.
ImVec2 Writer::legend_box(const ImVec2& inner, const ImVec4& ink, const std::string& words) {
  const ImVec2 at(in_.rect.min.x + px(10), in_.rect.max.y - px(10) - inner.y);
  const Rect rect{at, {at.x + inner.x + px(16), at.y + inner.y}};
  box(rect, ui_.theme().panel);
  ui_.mark("view.legend", rect);
  text({at.x + px(8), at.y + px(4)}, ink, words);
  return at;
}

void Writer::draw_scale() {
  const FontScope small(ui_.fonts().small);
  const float width = std::min(px(170), in_.rect.width() - px(36)), bar = px(9);
  if (width < px(50)) return;
  const std::string unit = in_.legend.unit.empty() ? "" : ", " + in_.legend.unit;
  const ImVec2 at = legend_box({width, 2 * line() + bar + px(16)}, ui_.theme().text,
                               cut_to(in_.legend.title + unit, width));
  const float left = at.x + px(8), top = at.y + px(6) + line();
  for (int i = 0; i < kBarSteps; ++i) {
    const float from = static_cast<float>(i) / kBarSteps, to = static_cast<float>(i + 1) / kBarSteps;
    const ImU32 a = color_of(scale_color(in_.legend.scale, from)),
                b = color_of(scale_color(in_.legend.scale, to));
    list_.AddRectFilledMultiColor({left + from * width, top}, {left + to * width, top + bar}, a, b, b, a);
  }
  for (const float share : {0.f, 0.5f, 1.f}) {
    if (share == 0.5f && width <= px(110)) continue;
    const std::string words = argument(static_cast<double>(share * in_.legend.high));
    const float x = left + share * (width - ImGui::CalcTextSize(words.c_str()).x);
    text({x, top + bar + px(2)}, ui_.theme().text_dim, words);
  }
}

/// All of them in one column, or nothing but the title where there is no room.
void Writer::draw_categories() {
  const FontScope small(ui_.fonts().small);
  const ImVec2 whole = legend_size(ui_, in_.legend);
  const bool room = whole.y < in_.rect.height() - px(70) && whole.x < 0.4f * in_.rect.width();
  const float title = ImGui::CalcTextSize(in_.legend.title.c_str()).x;
  const ImVec2 inner = room ? whole : ImVec2(title, line() + px(9));
  const ImVec2 at = legend_box(inner, ui_.theme().text, in_.legend.title);
  if (room) draw_swatches(ui_, in_.legend, at);
}

void Writer::draw_missing() {
  const FontScope small(ui_.fonts().small);
  const std::string words = cut_to(in_.legend.title + ": " + in_.legend.missing, in_.rect.width() - px(36));
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  legend_box({size.x, size.y + px(8)}, ui_.theme().text_dim, words);
}

void Writer::draw_labels() {
  const FontScope small(ui_.fonts().small);
  for (const Overlay::Label& label : in_.labels) {
    if (label.strong) {
      list_.AddCircle(label.at, px(9), color(ui_.theme().panel, 0.8f), 24, px(3.5f));
      list_.AddCircle(label.at, px(9), color(ui_.theme().accent_hover), 24, px(2));
    }
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    const float away = label.strong ? px(14) : px(7);
    const ImVec2 at(label.at.x + away, label.at.y - size.y / 2);
    box(around(at, size, px(3), px(1)), ui_.theme().panel, label.strong ? 0.85f : 0.6f);
    text(at, label.strong ? ui_.theme().text : ui_.theme().text_dim, label.text);
  }
}

/// Of one size on the screen, whatever the distance.
void Writer::draw_handles() {
  const float half = px(5);
  for (const Overlay::Handle& handle : in_.handles) {
    const Rect rect = around(handle.at, {0, 0}, half, half);
    const ImVec4 fill = handle.hovered ? ui_.theme().accent_hover : ImVec4(1, 1, 1, 1);
    list_.AddRectFilled(rect.min, rect.max, color(fill), px(2));
    list_.AddRect(rect.min, rect.max, color(ImVec4(0, 0, 0, 0.8f)), px(2), 0, px(1));
    ui_.mark(handle.name, rect);
  }
}

void Writer::draw_tags() {
  const FontScope small(ui_.fonts().small);
  const float chip = px(9), gap = px(5);
  for (const Overlay::Tag& tag : in_.tags) {
    const ImVec2 words = ImGui::CalcTextSize(tag.text.c_str()), size(words.x + chip + gap, words.y);
    const float left = in_.rect.min.x + px(6), right = in_.rect.max.x - px(6) - size.x;
    const ImVec2 at(std::max(left, std::min(tag.at.x - size.x / 2, right)), tag.at.y - size.y - px(6));
    const Rect rect = around(at, size, px(5), px(2));
    box(rect, ui_.theme().panel, tag.strong ? 0.9f : 0.65f);
    if (tag.strong) list_.AddRect(rect.min, rect.max, color(tag.color), px(5), 0, px(1.5f));
    const float top = at.y + 0.5f * (size.y - chip);
    list_.AddRectFilled({at.x, top}, {at.x + chip, top + chip}, color(tag.color), px(2));
    text({at.x + chip + gap, at.y}, tag.strong ? ui_.theme().text : ui_.theme().text_dim, tag.text);
    ui_.mark(tag.name, rect);
  }
}

void Writer::draw_tip() {
  if (in_.tip.empty()) return;
  const FontScope small(ui_.fonts().small);
  const ImVec2 size = ImGui::CalcTextSize(in_.tip.c_str());
  ImVec2 at(in_.tip_at.x + px(16), in_.tip_at.y + px(14));
  at.x = std::min(at.x, in_.rect.max.x - size.x - px(10));
  at.y = std::min(at.y, in_.rect.max.y - size.y - px(8));
  const Rect rect = around(at, size, px(6), px(3));
  box(rect, ui_.theme().raised, 0.95f);
  ui_.mark("view.tip", rect);
  text(at, ui_.theme().text, in_.tip);
}

}  // namespace

void draw_overlay(Ui& ui, const Overlay& overlay) {
  if (overlay.rect.empty()) return;
  Writer(ui, overlay).draw();
}

ImVec2 legend_size(Ui& ui, const Legend& legend) {
  const FontScope small(ui.fonts().small);
  float widest = ImGui::CalcTextSize(legend.title.c_str()).x;
  for (const auto& one : legend.categories)
    widest = std::max(widest, ui.px(15) + ImGui::CalcTextSize(one.label.c_str()).x);
  const float step = ImGui::GetTextLineHeight() + ui.px(1);
  return {widest, step * static_cast<float>(legend.categories.size() + 1) + ui.px(12)};
}

void draw_legend(Ui& ui, const Legend& legend, const Rect& rect) {
  const FontScope small(ui.fonts().small);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(rect.min, rect.max, color(ui.theme().panel));
  list.AddText({rect.min.x + ui.px(8), rect.min.y + ui.px(4)}, color(ui.theme().text), legend.title.c_str());
  draw_swatches(ui, legend, rect.min);
  ui.mark("view.legend", rect);
}

std::vector<Overlay::Label> joint_labels(const PaneView& view, const Joints& joints, bool all, int hovered,
                                         int selected) {
  std::vector<Overlay::Label> labels;
  for (int j = 0; j < kJointCount; ++j) {
    const bool strong = j == hovered || j == selected;
    if ((!all && !strong) || !joints.row(j).allFinite()) continue;
    const auto at = view.project(joints.row(j));
    if (at && view.rect.contains(*at)) labels.push_back({*at, joint_label(j), strong});
  }
  std::stable_sort(labels.begin(), labels.end(),
                   [](const auto& a, const auto& b) { return a.strong < b.strong; });
  return labels;
}

}  // namespace understudy::ui
