#include "ui/widgets/icons.hpp"

#include <array>
#include <cmath>
#include <initializer_list>

#include "retarget/math/types.hpp"

namespace understudy::ui {
namespace {

/// Draws on a grid of 16 x 16 units, y down, with lines 1.4 units thick.
class Pen {
 public:
  Pen(ImDrawList& list, const ImVec2& at, float size, ImU32 color)
      : list_(list), at_(std::round(at.x), std::round(at.y)), unit_(size / 16), color_(color) {}

  void line(std::initializer_list<ImVec2> points, bool closed = false) {
    for (const ImVec2& p : points) list_.PathLineTo(place(p));
    list_.PathStroke(color_, closed ? ImDrawFlags_Closed : 0, thickness());
  }
  void shape(std::initializer_list<ImVec2> convex) {
    for (const ImVec2& p : convex) list_.PathLineTo(place(p));
    list_.PathFillConvex(color_);
  }
  void ring(ImVec2 center, float radius) {
    list_.AddCircle(place(center), radius * unit_, color_, 0, thickness());
  }
  void disc(ImVec2 center, float radius) { list_.AddCircleFilled(place(center), radius * unit_, color_); }
  /// From angle to angle in quarter turns, clockwise from the right.
  void arc(ImVec2 center, float radius, float from, float to) {
    constexpr float kQuarter = kPi / 2;
    list_.PathArcTo(place(center), radius * unit_, from * kQuarter, to * kQuarter);
    list_.PathStroke(color_, 0, thickness());
  }
  void box(ImVec2 min, ImVec2 max, float rounding = 1.5f) {
    list_.AddRect(place(min), place(max), color_, rounding * unit_, 0, thickness());
  }
  void block(ImVec2 min, ImVec2 max, float rounding = 0.7f) {
    list_.AddRectFilled(place(min), place(max), color_, rounding * unit_);
  }

 private:
  ImVec2 place(const ImVec2& p) const { return {at_.x + p.x * unit_, at_.y + p.y * unit_}; }
  float thickness() const { return std::max(1.f, 1.4f * unit_); }

  ImDrawList& list_;
  ImVec2 at_;
  float unit_;
  ImU32 color_;
};

void turned_arrow(Pen& pen, bool left) {
  const auto x = [left](float at) { return left ? at : 16 - at; };
  pen.line({{x(5.5f), 2.8f}, {x(2.2f), 6}, {x(5.5f), 9.2f}});
  pen.line({{x(2.4f), 6}, {x(10), 6}});
  left ? pen.arc({10, 9.7f}, 3.7f, -1, 1) : pen.arc({6, 9.7f}, 3.7f, 1, 3);
  pen.line({{x(10), 13.4f}, {x(6.5f), 13.4f}});
}
void page(Pen& pen) {
  pen.line({{9.5f, 1.8f}, {3.5f, 1.8f}, {3.5f, 14.2f}, {12.5f, 14.2f}, {12.5f, 4.8f}}, true);
  pen.line({{9.3f, 2}, {9.3f, 5}, {12.3f, 5}});
}
void four_arrows(Pen& pen) {
  pen.line({{8, 1.6f}, {8, 14.4f}}), pen.line({{1.6f, 8}, {14.4f, 8}});
  pen.line({{6, 3.6f}, {8, 1.6f}, {10, 3.6f}}), pen.line({{6, 12.4f}, {8, 14.4f}, {10, 12.4f}});
  pen.line({{3.6f, 6}, {1.6f, 8}, {3.6f, 10}}), pen.line({{12.4f, 6}, {14.4f, 8}, {12.4f, 10}});
}

struct Entry {
  std::string_view name;
  void (*draw)(Pen&);
};

// clang-format off
constexpr std::array<Entry, static_cast<size_t>(Icon::Count)> kIcons = {{
  {"play", [](Pen& p) { p.shape({{4, 2.5f}, {13.5f, 8}, {4, 13.5f}}); }},
  {"pause", [](Pen& p) { p.block({3.8f, 2.8f}, {6.8f, 13.2f}), p.block({9.2f, 2.8f}, {12.2f, 13.2f}); }},
  {"step-back", [](Pen& p) { p.shape({{12, 3.2f}, {12, 12.8f}, {6, 8}}), p.block({3.4f, 3.2f}, {5.2f, 12.8f}); }},
  {"step-forward", [](Pen& p) { p.shape({{4, 3.2f}, {10, 8}, {4, 12.8f}}), p.block({10.8f, 3.2f}, {12.6f, 12.8f}); }},
  {"to-start", [](Pen& p) { p.shape({{9, 3.4f}, {9, 12.6f}, {3.8f, 8}}), p.shape({{14, 3.4f}, {14, 12.6f}, {8.8f, 8}}),
                            p.block({1.8f, 3.2f}, {3.4f, 12.8f}); }},
  {"to-end", [](Pen& p) { p.shape({{7, 3.4f}, {12.2f, 8}, {7, 12.6f}}), p.shape({{2, 3.4f}, {7.2f, 8}, {2, 12.6f}}),
                          p.block({12.6f, 3.2f}, {14.2f, 12.8f}); }},
  {"loop", [](Pen& p) { p.line({{2.2f, 8}, {2.2f, 6}, {3.2f, 4.4f}, {13, 4.4f}}), p.line({{10.8f, 2}, {13.2f, 4.4f}, {10.8f, 6.8f}}),
                        p.line({{13.8f, 8}, {13.8f, 10}, {12.8f, 11.6f}, {3, 11.6f}}), p.line({{5.2f, 9.2f}, {2.8f, 11.6f}, {5.2f, 14}}); }},
  {"undo", [](Pen& p) { turned_arrow(p, true); }},
  {"redo", [](Pen& p) { turned_arrow(p, false); }},
  {"reset", [](Pen& p) { p.arc({8, 8.4f}, 5.2f, -1.5f, 1.9f), p.line({{4.1f, 1.7f}, {4.1f, 5}, {7.4f, 5}}); }},
  {"folder", [](Pen& p) { p.line({{1.8f, 13}, {1.8f, 3.2f}, {6, 3.2f}, {7.6f, 5.2f}, {14.2f, 5.2f}, {14.2f, 13}}, true); }},
  {"file", page},
  {"image", [](Pen& p) { p.box({1.8f, 2.8f}, {14.2f, 13.2f}), p.disc({5.4f, 6.2f}, 1.2f), p.line({{2.5f, 12}, {6.2f, 9}, {8.2f, 10.6f}, {11, 7.4f}, {13.8f, 10.4f}}); }},
  {"video", [](Pen& p) { p.box({1.5f, 4}, {10.3f, 12}), p.line({{10.5f, 7}, {14.5f, 4.6f}, {14.5f, 11.4f}, {10.5f, 9}}); }},
  {"home", [](Pen& p) { p.line({{1.6f, 8}, {8, 2.2f}, {14.4f, 8}}), p.line({{3.6f, 6.6f}, {3.6f, 13.6f}, {12.4f, 13.6f}, {12.4f, 6.6f}}); }},
  {"clock", [](Pen& p) { p.ring({8, 8}, 6.2f), p.line({{8, 4.4f}, {8, 8}, {10.6f, 9.6f}}); }},
  {"copy", [](Pen& p) { p.box({5.4f, 5.4f}, {14, 14}), p.line({{3.6f, 10.6f}, {2, 10.6f}, {2, 2}, {10.6f, 2}, {10.6f, 3.6f}}); }},
  {"trash", [](Pen& p) { p.line({{2.2f, 4.4f}, {13.8f, 4.4f}}), p.line({{3.6f, 4.6f}, {4.4f, 14}, {11.6f, 14}, {12.4f, 4.6f}}), p.line({{6, 4.2f}, {6, 2.2f}, {10, 2.2f}, {10, 4.2f}}); }},
  {"warning", [](Pen& p) { p.line({{8, 2}, {14.6f, 13.6f}, {1.4f, 13.6f}}, true), p.line({{8, 6.2f}, {8, 9.8f}}), p.disc({8, 11.7f}, 0.9f); }},
  {"check", [](Pen& p) { p.line({{3, 8.6f}, {6.4f, 12}, {13, 4.6f}}); }},
  {"close", [](Pen& p) { p.line({{3.8f, 3.8f}, {12.2f, 12.2f}}), p.line({{12.2f, 3.8f}, {3.8f, 12.2f}}); }},
  {"chevron-right", [](Pen& p) { p.line({{6, 4}, {10, 8}, {6, 12}}); }},
  {"chevron-down", [](Pen& p) { p.line({{4, 6}, {8, 10}, {12, 6}}); }},
  {"chevron-up", [](Pen& p) { p.line({{4, 10}, {8, 6}, {12, 10}}); }},
  {"person", [](Pen& p) { p.ring({8, 4.4f}, 2.6f), p.arc({8, 14}, 5.2f, 2, 4), p.line({{2.8f, 14}, {13.2f, 14}}); }},
  {"skeleton", [](Pen& p) { p.ring({8, 2.8f}, 1.5f), p.line({{8, 4.4f}, {8, 9.4f}}), p.line({{2.6f, 7.4f}, {8, 5.6f}, {13.4f, 7.4f}}),
                            p.line({{4.6f, 14.4f}, {8, 9.4f}, {11.4f, 14.4f}}), p.disc({8, 9.4f}, 1.2f), p.disc({2.6f, 7.4f}, 1.1f), p.disc({13.4f, 7.4f}, 1.1f); }},
  {"mesh", [](Pen& p) { p.line({{8, 1.6f}, {13.8f, 4.8f}, {13.8f, 11.2f}, {8, 14.4f}, {2.2f, 11.2f}, {2.2f, 4.8f}}, true), p.line({{2.4f, 4.9f}, {8, 8}, {13.6f, 4.9f}}), p.line({{8, 8}, {8, 14.2f}}); }},
  {"points", [](Pen& p) { for (const ImVec2 at : {ImVec2(8, 2.6f), ImVec2(4.4f, 5.2f), ImVec2(11.6f, 5.2f), ImVec2(8, 6.8f), ImVec2(5.4f, 9.6f), ImVec2(10.6f, 9.6f), ImVec2(2.6f, 12.6f), ImVec2(8, 12.8f), ImVec2(13.4f, 12.6f)}) p.disc(at, 1.15f); }},
  {"brush", [](Pen& p) { p.line({{14, 2}, {7.6f, 8.6f}}), p.line({{7.4f, 8.2f}, {5, 8.8f}, {3.8f, 10.8f}, {3.4f, 13}, {2, 13.8f}, {5.4f, 14}, {7.6f, 12.8f}, {8.4f, 11}, {8, 9}}, true); }},
  {"camera", [](Pen& p) { p.line({{1.6f, 4.8f}, {4.6f, 4.8f}, {6, 2.8f}, {10, 2.8f}, {11.4f, 4.8f}, {14.4f, 4.8f}, {14.4f, 13}, {1.6f, 13}}, true), p.ring({8, 8.6f}, 2.5f); }},
  {"chart", [](Pen& p) { p.line({{2, 2}, {2, 14}, {14.4f, 14}}), p.line({{4.6f, 10.6f}, {7.2f, 6.6f}, {9.8f, 8.8f}, {13.6f, 3.6f}}); }},
  {"select", [](Pen& p) { p.line({{3.4f, 2}, {12.8f, 9}, {8.4f, 9.6f}, {5.8f, 13.4f}}, true); }},
  {"move", four_arrows},
  {"layers", [](Pen& p) { p.line({{8, 1.8f}, {14.4f, 5.2f}, {8, 8.6f}, {1.6f, 5.2f}}, true), p.line({{1.8f, 8.4f}, {8, 11.6f}, {14.2f, 8.4f}}), p.line({{1.8f, 11.2f}, {8, 14.4f}, {14.2f, 11.2f}}); }},
  {"menu", [](Pen& p) { p.line({{2.4f, 4}, {13.6f, 4}}), p.line({{2.4f, 8}, {13.6f, 8}}), p.line({{2.4f, 12}, {13.6f, 12}}); }},
  {"lock", [](Pen& p) { p.block({3.4f, 7.2f}, {12.6f, 14}, 1.2f), p.line({{5.2f, 7.2f}, {5.2f, 5}, {6.6f, 2.8f}, {9.4f, 2.8f}, {10.8f, 5}, {10.8f, 7.2f}}); }},
}};
// clang-format on

}  // namespace

std::string_view icon_name(Icon icon) {
  return kIcons[static_cast<size_t>(icon)].name;
}

void draw_icon(ImDrawList& list, Icon icon, const ImVec2& at, float size, ImU32 color) {
  Pen pen(list, at, size, color);
  kIcons[static_cast<size_t>(icon)].draw(pen);
}

void icon_label(Ui& ui, Icon icon, const ImVec4& color) {
  const float size = ui.px(16), line = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  draw_icon(*ImGui::GetWindowDrawList(), icon, {at.x, at.y + (line - size) / 2}, size, ui::color(color));
  ImGui::Dummy({size, line});
}

}  // namespace understudy::ui
