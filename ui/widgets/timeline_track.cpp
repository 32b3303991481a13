#include "ui/widgets/timeline_track.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"

namespace understudy::ui {
namespace {

enum class Grip { None, Playhead, LoopFirst, LoopLast, Pan, Mark, MarkFirst, MarkLast, TrimFirst, TrimLast };

constexpr float kRowHeight = 12, kBandHeight = 7, kBadHeight = 5, kNearlyStill = 4;  // points
constexpr float kEdge = 6, kTrimGrip = 7;                                            // points

/// Remembered between frames: the part of the sequence that is shown, and what is being dragged.
struct TrackState {
  double first = 0, count = 0;  ///< count 0: everything
  Grip grip = Grip::None;
  std::string chosen;               // the mark that Delete removes; empty: none
  ImVec2 pressed_at{0, 0};          // where what is gripped was
  bool moving = false;              // it has left its place
  int came_from = 0;                // the frame shown when it was gripped
  std::optional<LoopRange> loop{};  // the marks then
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

/// Where a mark is that has these frames.
Rect place_of(const Track& t, const TrackMark& mark, const LoopRange& frames) {
  const float height = t.ui.px(kRowHeight);
  const float top = t.body.max.y - t.ui.px(kBadHeight) - static_cast<float>(2 - mark.row) * height;
  if (mark.diamond) return around({t.axis.x(frames.first), top + height / 2}, height / 2);
  const float least = t.ui.px(3), middle = t.axis.x(0.5 * (frames.first + frames.last));
  return {{std::min(t.axis.x(frames.first - 0.5), middle - least), top + t.ui.px(2)},
          {std::max(t.axis.x(frames.last + 0.5), middle + least), top + height - t.ui.px(2)}};
}

/// A mark, or an end of it, that may be gripped.
struct MarkGrip {
  int mark = -1;  ///< below 0: none
  Grip grip = Grip::Mark;
};

/// What is gripped at a pixel, the mark drawn last first. A bar's end reaches a little out of the bar, where
/// nothing else is.
MarkGrip mark_at(const Track& t, const ImVec2& at) {
  for (const float out : {0.f, t.ui.px(kEdge - 2)})
    for (int i = static_cast<int>(t.data.marks.size()) - 1; i >= 0; --i) {
      const TrackMark& mark = t.data.marks[i];
      const bool whole = mark.diamond || mark.fixed;
      const Rect bar = place_of(t, mark, {mark.first, mark.last});
      const float reach = whole ? 0 : out, in = std::min(t.ui.px(kEdge), bar.width() / 4);
      if (!Rect{{bar.min.x - reach, bar.min.y}, {bar.max.x + reach, bar.max.y}}.contains(at)) continue;
      if (whole) return {i, Grip::Mark};
      return {i, at.x < bar.min.x + in    ? Grip::MarkFirst
                 : at.x >= bar.max.x - in ? Grip::MarkLast
                                          : Grip::Mark};
    }
  return {};
}

int chosen_mark(const Track& t) {
  for (size_t i = 0; i < t.data.marks.size(); ++i)
    if (!t.state.chosen.empty() && t.data.marks[i].name == t.state.chosen) return i;
  return -1;
}

/// The range as the pointer has carried it, or the end that is gripped. It stays inside what is made.
LoopRange carried(const Track& t, const LoopRange& range) {
  if (!t.state.moving) return range;
  const double frames = t.axis.frame(ImGui::GetIO().MousePos.x) - t.axis.frame(t.state.pressed_at.x);
  const int by = static_cast<int>(std::lround(frames)), end = std::max(range.last, t.data.processed - 1);
  switch (t.state.grip) {
    case Grip::Mark: {
      const int all = std::clamp(by, -range.first, end - range.last);
      return {range.first + all, range.last + all};
    }
    case Grip::MarkFirst:
    case Grip::TrimFirst:
      return {std::clamp(range.first + by, 0, range.last), range.last};
    case Grip::MarkLast:
    case Grip::TrimLast:
      return {range.first, std::clamp(range.last + by, range.first, end)};
    default:
      return range;
  }
}

bool is_of_mark(Grip grip) {
  return grip == Grip::Mark || grip == Grip::MarkFirst || grip == Grip::MarkLast;
}

bool is_of_trim(Grip grip) {
  return grip == Grip::TrimFirst || grip == Grip::TrimLast;
}

/// The frames of a mark as it is shown now; `chosen`: it may be gripped.
LoopRange frames_of(const Track& t, const TrackMark& mark, bool chosen) {
  const LoopRange own{mark.first, mark.last};
  return chosen && !mark.fixed && is_of_mark(t.state.grip) ? carried(t, own) : own;
}

/// The part that is kept as it is shown now; only where there is one.
LoopRange kept_now(const Track& t) {
  return is_of_trim(t.state.grip) ? carried(t, *t.data.kept) : *t.data.kept;
}

/// Both sides of a line, to a part of a pixel.
void draw_about(Track& t, const Rect& line, float half, const ImVec4& ink) {
  const float y = std::round(line.at(0, 0.5f).y), whole = std::floor(half), rest = half - whole;
  const auto rows = [&](float from, float to, float strength) {
    if (to > from && strength > 0)
      t.list.AddRectFilled({line.min.x, y + from}, {line.max.x, y + to}, color(ink, strength));
  };
  rows(-whole, whole, 1);
  rows(-whole - 1, -whole, rest);
  rows(whole, whole + 1, rest);
}

void draw_bar(Track& t, const TrackMark& mark, const LoopRange& frames, const Rect& place) {
  const ImVec4& ink = t.ui.theme().series[mark.color];
  const bool whole = mark.heights.empty();
  const float strength = mark.fixed ? 0.5f : whole ? 1.f : 0.3f;
  t.list.AddRectFilled(place.min, place.max, color(ink, strength), t.ui.px(2));
  for (size_t i = 0; i < mark.heights.size(); ++i) {
    const int frame = frames.first + static_cast<int>(i);
    if (frame > frames.last || mark.heights[i] <= 0) continue;
    const Rect line{{std::max(place.min.x, t.axis.x(frame - 0.5)), place.min.y},
                    {std::min(place.max.x, t.axis.x(frame + 0.5)), place.max.y}};
    draw_about(t, line, std::max(t.ui.px(0.5f), 0.5f * mark.heights[i] * place.height()), ink);
  }
}

void draw_marks(Track& t, const std::string& name) {
  const int chosen = chosen_mark(t);
  for (size_t i = 0; i < t.data.marks.size(); ++i) {
    const TrackMark& mark = t.data.marks[i];
    const bool lit = static_cast<int>(i) == chosen;
    const LoopRange frames = frames_of(t, mark, lit);
    const Rect place = place_of(t, mark, frames);
    const ImVec2 middle = place.at(0.5f, 0.5f);
    const ImU32 rim = color(lit ? t.ui.theme().text : t.ui.theme().backdrop);
    if (mark.diamond) {
      if (mark.reach > 0)
        t.list.AddLine({t.axis.x(frames.first - mark.reach), middle.y},
                       {t.axis.x(frames.first + mark.reach), middle.y},
                       color(t.ui.theme().series[mark.color], 0.5f), t.ui.px(1));
      draw_diamond(t, middle, t.ui.px(lit ? 7 : 6), rim);
      draw_diamond(t, middle, t.ui.px(4.5f), color(t.ui.theme().series[mark.color]));
    } else {
      draw_bar(t, mark, frames, place);
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

/// Each is drawn where the one before leaves room; the line of each is.
void draw_letters(Track& t, const std::string& name) {
  const FontScope small(t.ui.fonts().small);
  float free = t.body.min.x;
  for (size_t k = 0; k < t.data.letters.size(); ++k) {
    const TrackLetter& letter = t.data.letters[k];
    const float x = std::round(t.axis.x(letter.frame)), y = t.body.min.y + t.ui.px(1);
    if (x < t.body.min.x || x > t.body.max.x) continue;
    const ImVec4& ink = t.ui.theme().series[letter.color];
    const ImVec2 size = ImGui::CalcTextSize(letter.letter.c_str());
    t.list.AddLine({x, t.body.min.y}, {x, y + size.y}, color(ink, 0.8f), t.ui.px(1));
    if (x < free) continue;
    t.list.AddText({x + t.ui.px(2), y}, color(ink), letter.letter.c_str());
    free = x + t.ui.px(4) + size.x;
    t.ui.mark(name + ".letter." + std::to_string(k), {{x, y}, {free, y + size.y}});
  }
}

/// The frame of a letter that is near one in pixels, else the frame itself.
int snapped(const Track& t, int frame) {
  int nearest = frame;
  float least = t.ui.px(kEdge);
  for (const TrackLetter& letter : t.data.letters)
    if (const float away = std::abs(t.axis.x(letter.frame) - t.axis.x(frame)); away < least)
      least = away, nearest = letter.frame;
  return nearest;
}

/// Where an end of the part that is kept is gripped; empty where it is not to be seen.
Rect trim_grip(const Track& t, bool first) {
  if (!t.data.kept) return {};
  const LoopRange kept = kept_now(t);
  const int frame = first ? kept.first : kept.last;
  const float inside = t.axis.x(frame), half = t.ui.px(kTrimGrip) / 2;
  if (frame >= t.data.processed || inside < t.body.min.x || inside > t.body.max.x) return {};
  const float x =
      std::clamp(t.axis.x(first ? frame - 0.5 : frame + 0.5), t.body.min.x + half, t.body.max.x - half);
  const float bottom = t.body.max.y - t.ui.px(kBadHeight) - rows_height(t);
  const float middle = (t.body.min.y + bottom) / 2, tall = std::min(t.ui.px(24), bottom - t.body.min.y);
  return {{x - half, middle - tall / 2}, {x + half, middle + tall / 2}};
}

/// Whether the pointer is on it, or nearly.
bool is_on_trim(const Track& t, bool first, const ImVec2& at) {
  const Rect grip = trim_grip(t, first);
  const float reach = t.ui.px(2);
  return !grip.empty() &&
         Rect{{grip.min.x - reach, grip.min.y}, {grip.max.x + reach, grip.max.y}}.contains(at);
}

/// Greys the ends that were trimmed, with a grip at each.
void draw_trimmed(Track& t, const std::string& name) {
  if (!t.data.kept) return;
  const LoopRange kept = kept_now(t);
  const auto grey = [&](const char* end, float from, float to) {
    const Rect rect{{from, t.body.min.y}, {to, t.body.max.y}};
    if (rect.empty()) return;
    t.list.AddRectFilled(rect.min, rect.max, color(t.ui.theme().backdrop, 0.72f));
    t.ui.mark(name + ".trimmed." + end, rect);
  };
  grey("before", t.axis.x(-0.5), t.axis.x(kept.first - 0.5));
  grey("after", t.axis.x(kept.last + 0.5), t.axis.x(t.data.processed - 0.5));
  for (const bool first : {true, false}) {
    const Rect grip = trim_grip(t, first);
    if (grip.empty()) continue;
    const bool held = t.state.grip == (first ? Grip::TrimFirst : Grip::TrimLast);
    const ImVec4& ink = held ? t.ui.theme().text : t.ui.theme().text_dim;
    const float x = std::round(grip.at(0.5f, 0).x);
    t.list.AddLine({x, t.body.min.y}, {x, t.body.max.y}, color(ink, 0.6f), t.ui.px(1));
    t.list.AddRectFilled(grip.min, grip.max, color(ink), t.ui.px(2));
    t.ui.mark(name + (first ? ".trim_first" : ".trim_last"), grip);
  }
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
  draw_letters(t, name);
  draw_marks(t, name);
  t.list.PopClipRect();
  const FontScope small(t.ui.fonts().small);
  if (!range.empty() && !t.data.curve_label.empty()) {
    const ImVec2 size = ImGui::CalcTextSize(t.data.curve_label.c_str());
    const float x = t.body.max.x - size.x - t.ui.px(14);  // beside the playhead at the last frame
    const bool below = runs_high(t, range, x);
    const float y =
        below ? t.body.max.y - t.ui.px(kBadHeight + 2) - rows_height(t) - size.y : t.body.min.y + t.ui.px(3);
    t.list.AddRectFilled({x - t.ui.px(4), y}, {x + size.x + t.ui.px(3), y + size.y},
                         color(theme.field, 0.85f), t.ui.px(3));  // three curves leave no place free
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
  const double* const moment = at_or_null(t.data.times, frame);
  const double seconds = moment != nullptr ? *moment : frame / std::max(t.data.fps, 1e-3);
  ImGui::Text("Frame %d  %s", frame, clock_time(seconds).c_str());
  ImGui::PushStyleColor(ImGuiCol_Text, t.ui.theme().text_dim);
  if (frame >= t.data.processed) ImGui::TextUnformatted("not processed yet");
  if (t.data.kept && (frame < t.data.kept->first || frame > t.data.kept->last))
    ImGui::TextUnformatted("trimmed: left out of playback and export");
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (const MarkGrip at = mark_at(t, mouse); at.mark >= 0) {
    ImGui::TextUnformatted(t.data.marks[at.mark].words.c_str());
    if (at.grip != Grip::Mark)
      ImGui::TextUnformatted("Drag this end: lengthen or shorten");
    else if (!t.data.marks[at.mark].fixed)
      ImGui::TextUnformatted("Drag: move. Click, then Delete: remove");
  }
  if (is_on_trim(t, true, mouse) || is_on_trim(t, false, mouse))
    ImGui::TextUnformatted("Drag: trim more or less");
  for (const std::string& words : bands_at(t, frame)) ImGui::TextUnformatted(words.c_str());
  for (const TrackLetter& letter : t.data.letters)
    if (letter.frame == frame) ImGui::TextUnformatted(letter.words.c_str());
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
  if (const MarkGrip at = mark_at(t, mouse); at.mark >= 0) return at.grip;
  if (is_on_trim(t, true, mouse)) return Grip::TrimFirst;
  if (is_on_trim(t, false, mouse)) return Grip::TrimLast;
  if (!t.ruler.contains(mouse) || !t.data.loop) return Grip::Playhead;
  if (loop_grip(t, t.data.loop->first, true).contains(mouse)) return Grip::LoopFirst;
  if (loop_grip(t, t.data.loop->last, false).contains(mouse)) return Grip::LoopLast;
  return Grip::Playhead;
}

bool is_an_end(Grip grip) {
  return grip != Grip::None && grip != Grip::Playhead && grip != Grip::Pan && grip != Grip::Mark;
}

/// What is under the pointer is gripped; a mark is chosen by it.
void begin_drag(Track& t) {
  TrackState& s = t.state;
  s.pressed_at = ImGui::GetIO().MousePos, s.moving = false;
  s.grip = ImGui::IsMouseDown(2) ? Grip::Pan : grip_at(t, s.pressed_at);
  const int mark = is_of_mark(s.grip) ? mark_at(t, s.pressed_at).mark : -1;
  s.chosen = mark < 0 ? "" : t.data.marks[mark].name;
  s.came_from = t.data.current, s.loop = t.data.loop;
}

/// Leaves everything as it was before the drag.
void cancel_drag(Track& t, TrackAnswer& answer) {
  if (t.state.grip != Grip::Pan) answer.seek = t.state.came_from;
  if (t.state.grip == Grip::LoopFirst || t.state.grip == Grip::LoopLast) answer.loop = t.state.loop;
  t.state.grip = Grip::None;
  ImGui::ClearActiveID();
}

/// The frame that is shown while a range is gripped: its end's, so that one sees where it is let go.
std::optional<int> frame_to_show(const Track& t, const LoopRange& range, bool began) {
  if (t.state.grip == Grip::Mark) return began ? std::optional<int>(range.first) : std::nullopt;
  const bool last = t.state.grip == Grip::MarkLast || t.state.grip == Grip::TrimLast;
  return last ? range.last : range.first;
}

/// A diamond is named after its frame, "drags.12".
std::string moved_name(const TrackMark& mark, const LoopRange& to) {
  if (!mark.diamond) return mark.name;
  return mark.name.substr(0, mark.name.rfind('.') + 1) + std::to_string(to.first);
}

/// The mark that is gripped: shown where it is clicked, changed where it is let go.
void work_on_mark(Track& t, bool began, bool held, TrackAnswer& answer) {
  const int chosen = chosen_mark(t);
  if (chosen < 0 || !is_of_mark(t.state.grip)) return;
  const TrackMark& mark = t.data.marks[chosen];
  const LoopRange to = frames_of(t, mark, true);
  if (held) {
    answer.seek = frame_to_show(t, to, began);
  } else if (to.first != mark.first || to.last != mark.last) {
    answer.move = TrackAnswer::Move{static_cast<size_t>(chosen), to};
    t.state.chosen = moved_name(mark, to);  // for Delete
  }
}

/// The trimmed end that is gripped.
void work_on_trim(Track& t, bool began, bool held, TrackAnswer& answer) {
  if (!t.data.kept || !is_of_trim(t.state.grip)) return;
  const LoopRange to = kept_now(t);
  if (held)
    answer.seek = frame_to_show(t, to, began);
  else if (to.first != t.data.kept->first || to.last != t.data.kept->last)
    answer.kept = to;
}

/// Delete removes the mark that is chosen.
void remove_chosen(Track& t, TrackAnswer& answer) {
  const int chosen = chosen_mark(t);
  if (chosen < 0 || t.data.marks[chosen].fixed || is_of_mark(t.state.grip)) return;
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
  frame = snapped(t, frame);
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
  const bool hovered = ImGui::IsItemHovered(), began = ImGui::IsItemActivated();
  bool held = ImGui::IsItemActive();
  if (hovered) ImGui::SetItemUsingMouseWheel();
  const auto set_axis = [&] {
    const double count = state.count > 0 ? state.count : std::max(1, data.total - 1);
    t.axis = {{{t.body.min.x + margin, t.body.min.y}, {t.body.max.x - margin, t.body.max.y}},
              state.first,
              state.first + count};
  };
  set_axis();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  TrackAnswer answer;
  if (began) begin_drag(t);
  if (!began && ImGui::IsMouseClicked(0)) state.chosen.clear();  // elsewhere
  if (held) state.moving |= std::abs(mouse.x - state.pressed_at.x) > ui.px(kNearlyStill);
  if (held && key_pressed(render::Key::Escape, false)) held = false, cancel_drag(t, answer);
  work_on_mark(t, began, held, answer);
  work_on_trim(t, began, held, answer);
  if (!held) state.grip = Grip::None;
  if (is_an_end(held ? state.grip : hovered ? grip_at(t, mouse) : Grip::None))
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
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
