#include "ui/widgets/timeline_track.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"

namespace understudy::ui {
namespace {

enum class Grip { None, Playhead, LoopFirst, LoopLast, Pan, Mark };

constexpr float kRowHeight = 12, kBandHeight = 7, kBadHeight = 5, kNearlyStill = 4;  // points

/// Remembered between frames: the part of the sequence that is shown, and what is being dragged.
struct TrackState {
  double first = 0, count = 0;  ///< count 0: everything
  Grip grip = Grip::None;
  std::string chosen;       // the mark that Delete removes; empty: none
  ImVec2 pressed_at{0, 0};  // of the mark that is gripped
  bool moving = false;      // it has left its place
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

constexpr int kAxisColors[] = {1, 2, 0};  // of Theme::series: x, y, z

/// The finished frames of what is drawn inside.
std::vector<Values> curves_of(const Track& t) {
  std::vector<Values> curves = t.data.channel;
  if (curves.empty()) curves.push_back(t.data.curve);
  for (Values& curve : curves) curve.size = std::min(curve.size, t.data.processed);
  return curves;
}

Rect around(const ImVec2& at, float half) {
  return {{at.x - half, at.y - half}, {at.x + half, at.y + half}};
}

void draw_diamond(Track& t, const ImVec2& at, float half, ImU32 ink) {
  t.list.AddQuadFilled({at.x, at.y - half}, {at.x + half, at.y}, {at.x, at.y + half}, {at.x - half, at.y},
                       ink);
}

/// Whether the curve is mostly in the upper half right of `x`: a label has more room below.
bool runs_high(const Track& t, const Range& range, float x) {
  int high = 0, low = 0;
  for (const Values& curve : curves_of(t))
    for (int i = std::max(0, static_cast<int>(t.axis.frame(x))); i < curve.size; ++i)
      if (const float value = curve.data[i]; std::isfinite(value) && t.axis.x(i) <= t.body.max.x)
        (2 * (value - range.low) > range.high - range.low ? high : low)++;
  return high > low;
}

/// The bands that there is room for.
size_t band_count(const Track& t) {
  constexpr float kLeast = 48;  // points of the part under the ruler: less is left to the edits
  return t.body.height() < t.ui.px(kLeast) ? 0 : t.data.bands.size();
}

/// Of the rows of marks and bands over the bad frames.
float rows_height(const Track& t) {
  const float marks = t.data.marks.empty() ? 0 : 2 * t.ui.px(kRowHeight);
  return marks + t.ui.px(kBandHeight) * static_cast<float>(band_count(t));
}

/// The row of a band.
Rect band_row(const Track& t, size_t band) {
  const float height = t.ui.px(kBandHeight);
  const float top = t.body.max.y - t.ui.px(kBadHeight) - rows_height(t) + height * static_cast<float>(band);
  return {{t.body.min.x, top}, {t.body.max.x, top + height}};
}

/// The channel or the curve, with their keys; the range of their values.
Range draw_curves(Track& t, const std::string& name) {
  const Theme& theme = t.ui.theme();
  const std::vector<Values> curves = curves_of(t);
  Range range;
  for (const Values& curve : curves)
    for (int i = 0; i < curve.size; ++i) range.include(curve.data[i]);
  if (range.empty()) return range;
  FrameAxis inner = t.axis;
  inner.area.min.y += t.ui.px(6), inner.area.max.y -= t.ui.px(kBadHeight + 4) + rows_height(t);
  if (range.high == range.low) range.high += 1;
  const bool channel = !t.data.channel.empty();
  for (size_t c = 0; c < curves.size(); ++c) {
    const ImU32 ink = color(theme.series[channel ? kAxisColors[c % 3] : 0], 0.9f);
    draw_curve(t.list, inner, curves[c], range, ink, t.ui.px(1.3f));
    for (size_t k = 0; channel && k < t.data.keys.size(); ++k) {
      const float value = curves[c].at(t.data.keys[k]);
      if (!std::isfinite(value)) continue;
      const ImVec2 at(
          inner.x(t.data.keys[k]),
          inner.area.max.y - (value - range.low) / (range.high - range.low) * inner.area.height());
      draw_diamond(t, at, t.ui.px(3.5f), ink);
      if (c == 0) t.ui.mark(name + ".key." + std::to_string(k), around(at, t.ui.px(3.5f)));
    }
  }
  return range;
}

/// Where a mark is, `by` frames from its place.
Rect place_of(const Track& t, const TrackMark& mark, int by = 0) {
  const float height = t.ui.px(kRowHeight);
  const float top = t.body.max.y - t.ui.px(kBadHeight) - static_cast<float>(2 - mark.row) * height;
  if (mark.diamond) return around({t.axis.x(mark.first + by), top + height / 2}, height / 2);
  const float least = t.ui.px(3), middle = t.axis.x(0.5 * (mark.first + mark.last) + by);
  return {{std::min(t.axis.x(mark.first + by - 0.5), middle - least), top + t.ui.px(2)},
          {std::max(t.axis.x(mark.last + by + 0.5), middle + least), top + height - t.ui.px(2)}};
}

/// The mark under a pixel, the one drawn last first; -1 for none.
int mark_at(const Track& t, const ImVec2& at) {
  for (int i = static_cast<int>(t.data.marks.size()) - 1; i >= 0; --i)
    if (place_of(t, t.data.marks[i]).contains(at)) return i;
  return -1;
}

int chosen_mark(const Track& t) {
  for (size_t i = 0; i < t.data.marks.size(); ++i)
    if (!t.state.chosen.empty() && t.data.marks[i].name == t.state.chosen) return i;
  return -1;
}

/// How many frames the pointer has carried the gripped mark, which stays inside the sequence.
int carried(const Track& t, const TrackMark& mark) {
  if (!t.state.moving || mark.fixed) return 0;
  const double frames = t.axis.frame(ImGui::GetIO().MousePos.x) - t.axis.frame(t.state.pressed_at.x);
  const int most = std::max(0, t.data.processed - 1 - mark.last);
  return std::clamp(static_cast<int>(std::lround(frames)), -mark.first, most);
}

void draw_marks(Track& t, const std::string& name) {
  const int chosen = chosen_mark(t);
  for (size_t i = 0; i < t.data.marks.size(); ++i) {
    const TrackMark& mark = t.data.marks[i];
    const bool lit = static_cast<int>(i) == chosen;
    const int by = lit && t.state.grip == Grip::Mark ? carried(t, mark) : 0;
    const Rect place = place_of(t, mark, by);
    const ImVec2 middle = place.at(0.5f, 0.5f);
    const ImU32 ink = color(t.ui.theme().series[mark.color], mark.fixed ? 0.5f : 1.f);
    const ImU32 rim = color(lit ? t.ui.theme().text : t.ui.theme().backdrop);
    if (mark.diamond) {
      if (mark.reach > 0)
        t.list.AddLine({t.axis.x(mark.first + by - mark.reach), middle.y},
                       {t.axis.x(mark.first + by + mark.reach), middle.y},
                       color(t.ui.theme().series[mark.color], 0.5f), t.ui.px(1));
      draw_diamond(t, middle, t.ui.px(lit ? 7 : 6), rim);
      draw_diamond(t, middle, t.ui.px(4.5f), ink);
    } else {
      t.list.AddRectFilled(place.min, place.max, ink, t.ui.px(2));
      if (lit) t.list.AddRect(place.min, place.max, rim, t.ui.px(2), 0, t.ui.px(1.5f));
    }
    t.ui.mark(name + "." + mark.name, place);
    if (lit) t.ui.mark(name + ".chosen", place);
  }
}

void draw_bands(Track& t, const std::string& name) {
  for (size_t b = 0; b < band_count(t); ++b) {
    const TrackBand& band = t.data.bands[b];
    const Rect row = band_row(t, b);
    for (size_t k = 0; k < band.bars.size(); ++k) {
      const float from = t.axis.x(band.bars[k].first - 0.5), to = t.axis.x(band.bars[k].last + 0.5);
      if (to < row.min.x || from > row.max.x) continue;
      const Rect bar{{from, row.min.y + t.ui.px(1)}, {to, row.max.y - t.ui.px(1)}};
      t.list.AddRectFilled(bar.min, bar.max, color(t.ui.theme().series[band.color], 0.6f), t.ui.px(1.5f));
      t.ui.mark(name + "." + band.name + "." + std::to_string(k), bar);
    }
  }
}

/// Greys the ends that were trimmed.
void draw_trimmed(Track& t, const std::string& name) {
  if (!t.data.kept) return;
  const auto grey = [&](const char* end, float from, float to) {
    const Rect rect{{from, t.body.min.y}, {to, t.body.max.y}};
    if (rect.empty()) return;
    t.list.AddRectFilled(rect.min, rect.max, color(t.ui.theme().backdrop, 0.72f));
    t.ui.mark(name + ".trimmed." + end, rect);
  };
  grey("before", t.axis.x(-0.5), t.axis.x(t.data.kept->first - 0.5));
  grey("after", t.axis.x(t.data.kept->last + 0.5), t.axis.x(t.data.processed - 0.5));
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
  const Range range = draw_curves(t, name);
  for (const int bad : t.data.bad_frames) {
    const float x = t.axis.x(bad), half = std::max(t.ui.px(1), 0.5f * (t.axis.x(1) - t.axis.x(0)));
    if (x + half >= t.body.min.x && x - half <= t.body.max.x)
      t.list.AddRectFilled({x - half, t.body.max.y - t.ui.px(kBadHeight)}, {x + half, t.body.max.y},
                           color(theme.danger));
  }
  draw_bands(t, name);
  draw_trimmed(t, name);
  draw_marks(t, name);
  t.list.PopClipRect();
  const FontScope small(t.ui.fonts().small);
  if (!range.empty() && !t.data.curve_label.empty()) {
    const ImVec2 size = ImGui::CalcTextSize(t.data.curve_label.c_str());
    const float x = t.body.max.x - size.x - t.ui.px(6);
    const bool below = runs_high(t, range, x);
    const float y =
        below ? t.body.max.y - t.ui.px(kBadHeight + 2) - rows_height(t) - size.y : t.body.min.y + t.ui.px(3);
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

/// What holds in a frame while the pointer is on the bands: "Left foot on the floor, frames 3 to 17".
std::vector<std::string> bands_at(const Track& t, int frame) {
  std::vector<std::string> words;
  const float y = ImGui::GetIO().MousePos.y;
  const size_t count = band_count(t);
  if (count == 0 || y < band_row(t, 0).min.y || y > band_row(t, count - 1).max.y) return words;
  for (const TrackBand& band : t.data.bands)
    for (const LoopRange& bar : band.bars)
      if (frame >= bar.first && frame <= bar.last)
        words.push_back(band.words + printed(", frames %d to %d", bar.first, bar.last));
  return words;
}

void draw_hover(Track& t, int frame) {
  const float x = std::round(t.axis.x(frame));
  t.list.AddLine({x, t.body.min.y}, {x, t.body.max.y}, color(t.ui.theme().text_dim, 0.6f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {t.ui.px(9), t.ui.px(6)});
  ImGui::BeginTooltip();
  ImGui::Text("Frame %d  %s", frame, clock_time(frame / std::max(t.data.fps, 1e-3)).c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, t.ui.theme().text_dim);
  if (frame >= t.data.processed) ImGui::TextUnformatted("not processed yet");
  if (t.data.kept && (frame < t.data.kept->first || frame > t.data.kept->last))
    ImGui::TextUnformatted("trimmed: left out of playback and export");
  if (const int i = mark_at(t, ImGui::GetIO().MousePos); i >= 0) {
    ImGui::TextUnformatted(t.data.marks[i].words.c_str());
    if (!t.data.marks[i].fixed) ImGui::TextUnformatted("Drag: move. Click, then Delete: remove");
  }
  for (const std::string& words : bands_at(t, frame)) ImGui::TextUnformatted(words.c_str());
  if (t.data.channel.empty() && std::isfinite(t.data.curve.at(frame)))
    ImGui::Text("%s  %s", t.data.curve_label.c_str(), short_number(t.data.curve.at(frame)).c_str());
  if (!t.data.channel.empty()) {
    std::string words = t.data.curve_label + " ";
    for (const Values& axis : t.data.channel) words += " " + short_number(axis.at(frame));
    ImGui::TextUnformatted(words.c_str());
  }
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
  if (mark_at(t, mouse) >= 0) return Grip::Mark;
  if (!t.ruler.contains(mouse) || !t.data.loop) return Grip::Playhead;
  if (loop_grip(t, t.data.loop->first, true).contains(mouse)) return Grip::LoopFirst;
  if (loop_grip(t, t.data.loop->last, false).contains(mouse)) return Grip::LoopLast;
  return Grip::Playhead;
}

/// The mark that is gripped: chosen where it is pressed, shown where it is clicked, moved where it is let go.
void work_on_mark(Track& t, bool began, bool held, TrackAnswer& answer) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (began) {
    const int i = t.state.grip == Grip::Mark ? mark_at(t, mouse) : -1;
    t.state.chosen = i < 0 ? "" : t.data.marks[i].name;
    t.state.pressed_at = mouse, t.state.moving = false;
    if (i >= 0) answer.seek = t.data.marks[i].first;
  }
  if (ImGui::IsMouseClicked(0) && !began) t.state.chosen.clear();  // elsewhere
  const int chosen = chosen_mark(t);
  if (chosen < 0 || t.state.grip != Grip::Mark) return;
  if (held) {
    t.state.moving |= std::abs(mouse.x - t.state.pressed_at.x) > t.ui.px(kNearlyStill);
    return;
  }
  const int by = carried(t, t.data.marks[chosen]);
  if (by != 0) answer.move = TrackAnswer::Move{static_cast<size_t>(chosen), t.data.marks[chosen].first + by};
  if (by != 0) t.state.chosen.clear();
}

/// Delete removes the mark that is chosen.
void remove_chosen(Track& t, TrackAnswer& answer) {
  const int chosen = chosen_mark(t);
  if (chosen < 0 || t.data.marks[chosen].fixed || t.state.grip == Grip::Mark) return;
  if (ImGui::GetIO().WantTextInput || ImGui::GetTopMostPopupModal() != nullptr) return;
  if (!key_pressed(render::Key::Delete, false)) return;
  answer.remove = static_cast<size_t>(chosen);
  t.state.chosen.clear();
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
  TrackAnswer answer;
  work_on_mark(t, began, held, answer);
  if (!held) state.grip = Grip::None;
  remove_chosen(t, answer);
  move_view(t, hovered);
  if (hovered && t.ruler.contains(mouse) && ImGui::IsMouseDoubleClicked(0)) state = TrackState();
  set_axis();
  ui.mark(name, {{t.axis.area.min.x, t.body.min.y}, {t.axis.area.max.x, t.body.max.y}});
  ui.mark(name + ".ruler", t.ruler);

  draw_ruler(t);
  draw_body(t, name);
  draw_loop(t, name);
  draw_playhead(t, name);
  if (data.total <= 0) return answer;
  const int frame = std::clamp(static_cast<int>(std::lround(t.axis.frame(mouse.x))), 0, data.total - 1);
  if (held) answer_drag(t, frame, answer);
  if (hovered || held) draw_hover(t, frame);
  return answer;
}

}  // namespace understudy::ui
