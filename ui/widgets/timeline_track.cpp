#include "ui/widgets/timeline_track.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"

namespace understudy::ui {
namespace {

enum class Grip { None, Playhead, LoopFirst, LoopLast, Pan };

/// Remembered between frames: the part of the sequence that is shown, and what is being dragged.
struct TrackState {
  double first = 0, count = 0;  ///< count 0: everything
  Grip grip = Grip::None;
};

struct Track {
  Ui& ui;
  const TrackData& data;
  TrackState& state;
  ImDrawList& list;
  Rect ruler, body;
  FrameAxis axis;
};

void draw_ruler(Track& t) {
  const FontScope small(t.ui.fonts().small);
  const auto ticks =
      round_ticks(t.axis.first, t.axis.last, std::max(1, static_cast<int>(t.ruler.width() / t.ui.px(84))));
  const double step = ticks.size() > 1 ? std::max(1.0, ticks[1] - ticks[0]) : 1;
  for (const double tick : ticks) {
    if (tick != std::floor(tick)) continue;
    const float x = std::round(t.axis.x(tick));
    const std::string label = tick_label(tick, step);
    t.list.AddLine({x, t.ruler.max.y - t.ui.px(4)}, {x, t.ruler.max.y}, color(t.ui.theme().text_faint));
    if (x + t.ui.px(3) + ImGui::CalcTextSize(label.c_str()).x <= t.ruler.max.x)
      t.list.AddText({x + t.ui.px(3), t.ruler.min.y + t.ui.px(1)}, color(t.ui.theme().text_dim),
                     label.c_str());
  }
}

/// Whether the curve is mostly in the upper half right of `x`: a label has more room below.
bool runs_high(const Track& t, const Range& range, float x) {
  int high = 0, low = 0;
  for (int i = std::max(0, static_cast<int>(t.axis.frame(x)));
       i < std::min(t.data.curve.size, t.data.processed); ++i)
    if (const float value = t.data.curve.data[i]; std::isfinite(value) && t.axis.x(i) <= t.body.max.x)
      (2 * (value - range.low) > range.high - range.low ? high : low)++;
  return high > low;
}

void draw_body(Track& t, const std::string& name) {
  const Theme& theme = t.ui.theme();
  const float corner = t.ui.px(4);
  t.list.AddRectFilled(t.body.min, t.body.max, color(theme.backdrop), corner);
  t.list.PushClipRect(t.body.min, t.body.max, true);
  const float end = t.axis.x(t.data.processed - 0.5), start = t.axis.x(-0.5);
  if (t.data.processed > 0)
    t.list.AddRectFilled({start, t.body.min.y}, {end, t.body.max.y}, color(theme.field), corner);
  if (t.data.loop) {
    const float a = t.axis.x(t.data.loop->first), b = t.axis.x(t.data.loop->last);
    t.list.AddRectFilled({a, t.body.min.y}, {b, t.body.max.y}, color(theme.accent, 0.16f));
  }
  Range range;
  for (int i = 0; i < std::min(t.data.curve.size, t.data.processed); ++i) range.include(t.data.curve.data[i]);
  if (!range.empty()) {
    FrameAxis inner = t.axis;
    inner.area.min.y += t.ui.px(6), inner.area.max.y -= t.ui.px(9);
    if (range.high == range.low) range.high += 1;
    draw_curve(t.list, inner, {t.data.curve.data, std::min(t.data.curve.size, t.data.processed)}, range,
               color(theme.series[0], 0.9f), t.ui.px(1.3f));
  }
  for (const int bad : t.data.bad_frames) {
    const float x = t.axis.x(bad), half = std::max(t.ui.px(1), 0.5f * (t.axis.x(1) - t.axis.x(0)));
    if (x + half >= t.body.min.x && x - half <= t.body.max.x)
      t.list.AddRectFilled({x - half, t.body.max.y - t.ui.px(5)}, {x + half, t.body.max.y},
                           color(theme.danger));
  }
  t.list.PopClipRect();
  const FontScope small(t.ui.fonts().small);
  if (!range.empty() && !t.data.curve_label.empty()) {
    const ImVec2 size = ImGui::CalcTextSize(t.data.curve_label.c_str());
    const float x = t.body.max.x - size.x - t.ui.px(6);
    const bool below = runs_high(t, range, x);
    const float y = below ? t.body.max.y - t.ui.px(7) - size.y : t.body.min.y + t.ui.px(3);
    t.list.AddText({x, y}, color(theme.text_dim), t.data.curve_label.c_str());
    t.ui.mark(name + (below ? ".label_below" : ".label_above"), {{x, y}, {x + size.x, y + size.y}});
  }
}

Rect loop_grip(const Track& t, int frame, bool first) {
  const float x = t.axis.x(frame), width = t.ui.px(9);
  return {{first ? x - width : x, t.ruler.min.y}, {first ? x : x + width, t.ruler.max.y}};
}

void draw_loop(Track& t, const std::string& name) {
  if (!t.data.loop) return;
  const ImU32 blue = color(t.ui.theme().accent_hover);
  for (const bool first : {true, false}) {
    const int frame = first ? t.data.loop->first : t.data.loop->last;
    const Rect grip = loop_grip(t, frame, first);
    const float x = t.axis.x(frame), y = t.ruler.max.y;
    const float out = first ? grip.min.x : grip.max.x;
    t.list.AddTriangleFilled({x, y - t.ui.px(11)}, {x, y}, {out, y - t.ui.px(11)}, blue);
    t.list.AddLine({x, y - t.ui.px(11)}, {x, t.body.max.y}, blue, t.ui.px(1));
    t.ui.mark(name + (first ? ".loop_first" : ".loop_last"), grip);
  }
}

/// A line with the frame's number on top of it.
void draw_playhead(Track& t, const std::string& name) {
  const FontScope small(t.ui.fonts().strong);
  const Theme& theme = t.ui.theme();
  const float x = std::round(t.axis.x(t.data.current));
  if (x < t.body.min.x || x > t.body.max.x) return;
  const std::string number = std::to_string(t.data.current);
  const float width = ImGui::CalcTextSize(number.c_str()).x + t.ui.px(10);
  const float left =
      std::clamp(std::round(x - width / 2), t.ruler.min.x, std::max(t.ruler.min.x, t.ruler.max.x - width));
  const Rect flag{{left, t.ruler.min.y}, {left + width, t.ruler.max.y - t.ui.px(1)}};
  t.list.AddLine({x, flag.max.y}, {x, t.body.max.y}, color(theme.accent), t.ui.px(2));
  t.list.AddRectFilled(flag.min, flag.max, color(theme.accent), t.ui.px(4));
  t.list.AddText(
      {left + t.ui.px(5), std::round(flag.min.y + (flag.height() - ImGui::GetTextLineHeight()) / 2)},
      color(theme.on_accent), number.c_str());
  t.ui.mark(name + ".playhead", flag);
}

void draw_hover(Track& t, int frame) {
  const float x = std::round(t.axis.x(frame));
  t.list.AddLine({x, t.body.min.y}, {x, t.body.max.y}, color(t.ui.theme().text_dim, 0.6f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {t.ui.px(9), t.ui.px(6)});
  ImGui::BeginTooltip();
  ImGui::Text("Frame %d  %s", frame, clock_time(frame / std::max(t.data.fps, 1e-3)).c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, t.ui.theme().text_dim);
  if (frame >= t.data.processed) ImGui::TextUnformatted("not processed yet");
  if (std::isfinite(t.data.curve.at(frame)))
    ImGui::Text("%s  %s", t.data.curve_label.c_str(), short_number(t.data.curve.at(frame)).c_str());
  if (t.data.describe)
    if (const std::string more = t.data.describe(frame); !more.empty()) ImGui::TextUnformatted(more.c_str());
  ImGui::PopStyleColor();
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

/// Zooms, pans and follows; leaves the shown part inside the sequence.
void move_view(Track& t, bool hovered) {
  const ImGuiIO& io = ImGui::GetIO();
  TrackState& s = t.state;
  const double all = std::max(1, t.data.total - 1);
  if (s.count <= 0) s.first = 0, s.count = all;
  const bool whole = s.count >= all;
  if (hovered && io.MouseWheel != 0 && !io.KeyShift) {
    const double about = t.axis.frame(io.MousePos.x), zoom = std::pow(0.8, io.MouseWheel);
    const double count = std::clamp(s.count * zoom, std::min(all, 8.0), all);
    s.first = about - (about - s.first) * count / s.count, s.count = count;
  }
  const double wheel = io.MouseWheelH + (io.KeyShift ? io.MouseWheel : 0);
  if (hovered && wheel != 0) s.first -= 0.1 * wheel * s.count;
  if (s.grip == Grip::Pan)
    s.first -= static_cast<double>(io.MouseDelta.x / std::max(t.body.width(), 1.f)) * s.count;
  const bool out = t.data.current < s.first || t.data.current > s.first + s.count;
  if (t.data.follow && !whole && out) s.first = t.data.current - 0.1 * s.count;
  s.first = std::clamp(s.first, 0.0, std::max(0.0, all - s.count));
  if (s.count >= all * 0.999) s.count = 0;  // everything, however it grows
}

Grip grip_at(const Track& t, const ImVec2& mouse) {
  if (!t.ruler.contains(mouse) || !t.data.loop) return Grip::Playhead;
  if (loop_grip(t, t.data.loop->first, true).contains(mouse)) return Grip::LoopFirst;
  if (loop_grip(t, t.data.loop->last, false).contains(mouse)) return Grip::LoopLast;
  return Grip::Playhead;
}

/// What a drag that is held at `frame` asks for.
void answer_drag(const Track& t, int frame, TrackAnswer& answer) {
  if (t.state.grip == Grip::Playhead) answer.seek = frame;
  if (!t.data.loop) return;
  LoopRange loop = *t.data.loop;
  if (t.state.grip == Grip::LoopFirst) loop.first = std::min(frame, loop.last);
  if (t.state.grip == Grip::LoopLast) loop.last = std::max(frame, loop.first);
  if (loop.first != t.data.loop->first || loop.last != t.data.loop->last) answer.loop = loop;
}

}  // namespace

std::string clock_time(double seconds) {
  const auto hundredths = static_cast<long long>(std::llround(std::max(0.0, seconds) * 100));
  return printed("%lld:%02lld.%02lld", hundredths / 6000, hundredths / 100 % 60, hundredths % 100);
}

TrackAnswer timeline_track(Ui& ui, const std::string& name, const TrackData& data) {
  auto& state = ui.state<TrackState>(ImGui::GetID(name.c_str()));
  const ImVec2 at = ImGui::GetCursorScreenPos(),
               size(std::max(ImGui::GetContentRegionAvail().x, ui.px(60)), ui.px(data.height));
  const float ruler = std::round(ui.px(20)), margin = ui.px(8);
  Track t{ui,
          data,
          state,
          *ImGui::GetWindowDrawList(),
          {at, {at.x + size.x, at.y + ruler}},
          {{at.x, at.y + ruler}, {at.x + size.x, at.y + size.y}},
          {}};
  ImGui::InvisibleButton(name.c_str(), size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
  const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive(), began = ImGui::IsItemActivated();
  if (hovered) ImGui::SetItemUsingMouseWheel();
  const auto set_axis = [&] {
    const double count = state.count > 0 ? state.count : std::max(1, data.total - 1);
    t.axis = {{{t.body.min.x + margin, t.body.min.y}, {t.body.max.x - margin, t.body.max.y}},
              state.first,
              state.first + count};
  };
  set_axis();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (began) state.grip = ImGui::IsMouseDown(2) ? Grip::Pan : grip_at(t, mouse);
  if (!held) state.grip = Grip::None;
  move_view(t, hovered);
  if (hovered && t.ruler.contains(mouse) && ImGui::IsMouseDoubleClicked(0)) state = TrackState();
  set_axis();
  ui.mark(name, {{t.axis.area.min.x, t.body.min.y}, {t.axis.area.max.x, t.body.max.y}});
  ui.mark(name + ".ruler", t.ruler);

  draw_ruler(t);
  draw_body(t, name);
  draw_loop(t, name);
  draw_playhead(t, name);
  TrackAnswer answer;
  if (data.total <= 0) return answer;
  const int frame = std::clamp(static_cast<int>(std::lround(t.axis.frame(mouse.x))), 0, data.total - 1);
  if (held) answer_drag(t, frame, answer);
  if (hovered || held) draw_hover(t, frame);
  return answer;
}

}  // namespace understudy::ui
