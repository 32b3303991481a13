// What panels and widgets get besides their data: theme, fonts, named places and memory.
#pragma once

#include <imgui.h>

#include <any>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ui/gui/focus.hpp"
#include "ui/gui/theme.hpp"

namespace understudy::ui {

/// Pixels from the top left; empty when it has no inside.
struct Rect {
  ImVec2 min, max;
  float width() const { return max.x - min.x; }
  float height() const { return max.y - min.y; }
  bool empty() const { return !(max.x > min.x && max.y > min.y); }
  bool contains(const ImVec2& p) const { return p.x >= min.x && p.x < max.x && p.y >= min.y && p.y < max.y; }
  /// The point at shares of width and height; {0.5, 0.5} is the middle.
  ImVec2 at(float x, float y) const { return {min.x + x * width(), min.y + y * height()}; }
};

Rect intersection(const Rect& a, const Rect& b);

/// The fonts of one size of the interface; all from one atlas.
struct Fonts {
  ImFont* body = nullptr;
  ImFont* strong = nullptr;  ///< body size, semi-bold: headings
  ImFont* title = nullptr;   ///< large, semi-bold
  ImFont* small = nullptr;   ///< axes, hints, captions
};

/// Where a named item was drawn.
struct Mark {
  std::string name;
  Rect rect;            ///< the whole item
  Rect visible;         ///< the part inside its window; empty when scrolled away
  bool enabled = true;  ///< false: greyed out, a click does nothing
};

/// What a part of the window is for.
struct Explanation {
  Rect place;
  std::string title;  ///< "Falloff"; empty: the text says all
  std::string text;
  std::string keys{};  ///< "Ctrl+S"; empty: none
};

/// One per Gui. Widgets read its theme and fonts, name their items for scripts, tests and the manual
/// ("timeline.play"), and keep here what must outlive a frame.
class Ui {
 public:
  const Theme& theme() const { return *theme_; }
  const Fonts& fonts() const { return fonts_; }
  float scale() const { return scale_; }
  /// A length in pixels at scale 1, as real pixels.
  float px(float length) const { return length * scale_; }

  /// Names the item just made; the name must be unique in the frame (the last one wins).
  void mark(const std::string& name);
  /// Names a part of the current window.
  void mark(const std::string& name, const Rect& rect);
  /// The marks of the last finished frame, in drawing order.
  const std::vector<Mark>& marks() const { return finished_; }
  /// Null when no such item was drawn in the last finished frame.
  const Mark* find(const std::string& name) const;
  /// Says what a place of the current window is for, as far as it is to be seen.
  void explain(Explanation explanation);
  /// The explanation of the smallest place there, of the last finished frame; without a title it has that of
  /// what is around it. None where nothing is explained.
  std::optional<Explanation> explanation_at(const ImVec2& at) const;
  /// The item just made can be reached by Tab; typed: typing begins as soon as it is.
  void stop(const std::string& name, bool typed = false) { focus_.add(name, typed); }
  /// Which of them keys are about, and whether the menus are wanted.
  Focus& focus() { return focus_; }
  const Focus& focus() const { return focus_; }
  /// Scrolls to an item when it is next drawn.
  void reveal(const std::string& name) { reveal_ = name; }

  /// Something drawn in this frame moves by itself: the next is wanted at once.
  void keep_moving() { drawing_moves_ = true; }
  /// Whether the last finished frame had such a thing.
  bool moves() const { return moves_; }

  /// Whether the dialog `name` may be open now: only one is open at a time, the others wait. Call in every
  /// frame while it is open. A dialog inside another need not call it.
  bool claim_dialog(const std::string& name);

  /// The state of the widget `id` between frames; T() at first.
  template <class T>
  T& state(ImGuiID id) {
    std::any& kept = memory_[id];
    if (std::any_cast<T>(&kept) == nullptr) kept = T();
    return *std::any_cast<T>(&kept);
  }

 private:
  friend class Gui;
  void add(const std::string& name, const Rect& rect, bool enabled);
  void finish_frame();

  const Theme* theme_ = &ui::theme(ThemeKind::Dark);
  Fonts fonts_;
  float scale_ = 1;
  std::vector<Mark> drawing_, finished_;
  std::vector<Explanation> explaining_, explained_;
  std::unordered_map<std::string, size_t> drawing_at_, finished_at_;
  std::unordered_map<ImGuiID, std::any> memory_;
  Focus focus_;
  std::string reveal_, dialog_;
  int dialog_frame_ = -2;
  bool drawing_moves_ = false, moves_ = false;
};

/// Uses a font until the end of the scope.
class FontScope {
 public:
  explicit FontScope(ImFont* font) { ImGui::PushFont(font); }
  ~FontScope() { ImGui::PopFont(); }
  FontScope(const FontScope&) = delete;
  FontScope& operator=(const FontScope&) = delete;
};

/// Changes one colour of the style until the end of the scope.
class ColorScope {
 public:
  ColorScope(ImGuiCol which, const ImVec4& color) { ImGui::PushStyleColor(which, color); }
  ~ColorScope() { ImGui::PopStyleColor(); }
  ColorScope(const ColorScope&) = delete;
  ColorScope& operator=(const ColorScope&) = delete;
};

/// Greys out and ignores what is drawn in the scope when `disabled`.
class DisabledScope {
 public:
  explicit DisabledScope(bool disabled) { ImGui::BeginDisabled(disabled); }
  ~DisabledScope() { ImGui::EndDisabled(); }
  DisabledScope(const DisabledScope&) = delete;
  DisabledScope& operator=(const DisabledScope&) = delete;
};

/// Ids inside the scope belong to `name`.
class IdScope {
 public:
  explicit IdScope(const std::string& name) { ImGui::PushID(name.c_str()); }
  explicit IdScope(int number) { ImGui::PushID(number); }
  ~IdScope() { ImGui::PopID(); }
  IdScope(const IdScope&) = delete;
  IdScope& operator=(const IdScope&) = delete;
};

}  // namespace understudy::ui
