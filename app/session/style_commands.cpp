// How a take is performed: its style and its tempo.
#include <algorithm>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/style/load_style.hpp"

namespace understudy::app {
namespace {

struct StyleShare {
  const char *name, *label;
  float StyleChoice::*value;
};
constexpr StyleShare kShares[] = {{"style_strength", "Strength of the style", &StyleChoice::strength},
                                  {"style_posture", "Posture of the style", &StyleChoice::posture},
                                  {"style_size", "Size of movements", &StyleChoice::size},
                                  {"style_liveliness", "Liveliness", &StyleChoice::liveliness}};

TempoEdit& tempo_of(const Call& c, size_t take_argument = 0) {
  auto& tempo = c.take(take_argument).pose_edits.tempo;
  US_CHECK(tempo, "the take has the tempo of its source: edit.tempo gives it one of its own");
  return *tempo;
}

TempoMark& mark_at(const Call& c, size_t i) {
  std::vector<TempoMark>& marks = tempo_of(c, 1).marks;
  const int index = c.number<int>(i, "mark");
  US_CHECK(index >= 0 && index < ssize(marks), "there is no mark ", index, " of the tempo among ",
           marks.size());
  return marks[static_cast<size_t>(index)];
}

int frame_of_take(const Call& c, size_t take_argument, size_t i) {
  const int frame = c.number<int>(i, "frame"),
            count = static_cast<int>(c.take_state(take_argument).shown.poses.size());
  US_CHECK(frame >= 0 && frame < count, "there is no frame ", frame, " among ", count);
  return frame;
}

/// What would stop time or turn it back is refused before it is kept.
void check_tempo(const Call& c, size_t take_argument = 0) {
  const auto& tempo = c.take(take_argument).pose_edits.tempo;
  const TakeState& state = c.take_state(take_argument);
  if (!tempo || state.joints.empty()) return;
  tempo_times(*tempo, state.joints, static_cast<float>(c.session.source.fps), state.leg_ratio);
}

/// "off", "body", or how many times as long it lasts.
void set_tempo(Call& c) {
  auto& tempo = c.take().pose_edits.tempo;
  const std::string& word = c.word(1, "tempo");
  if (word == "off") return tempo.reset();
  TempoEdit edit = tempo.value_or(TempoEdit{});
  edit.by = word == "body" ? TempoBy::Body : TempoBy::Number;
  if (edit.by == TempoBy::Number) edit.length = c.clamped(1, "tempo", kTempoLengths.low, kTempoLengths.high);
  tempo = edit;
  check_tempo(c);
}

void set_phase(Call& c) {
  TempoEdit& tempo = tempo_of(c);
  const size_t phase = c.choice(1, "phase", {"anticipation", "stroke", "recovery"});
  float* const lengths[] = {&tempo.anticipation, &tempo.stroke, &tempo.recovery};
  *lengths[phase] = c.clamped(2, "length", kTempoLengths.low, kTempoLengths.high);
  check_tempo(c);
}

/// Throws Error where its file cannot be read. Networks are read where they are needed.
void check_style(const StyleChoice& style) {
  const std::string file = style_file(style);
  if (!is_words_file(file)) read_manner(file);
}

/// Strokes and the spread of single movements as the take's style has them.
void tempo_of_style(Call& c) {
  const StyleChoice& style = c.take().method.style;
  US_CHECK(!style.called().empty(), c.take().name, " has no style");
  US_CHECK(!is_words_file(style.file), style.file, ": has no tempo of its own");
  const MannerFile file = read_manner(style_file(style));
  TempoEdit edit = c.take().pose_edits.tempo.value_or(TempoEdit{});
  edit.stroke = file.stroke;
  edit.spread = file.spread;
  c.take().pose_edits.tempo = edit;
  check_tempo(c);
}

/// A frame that stays where it is, or comes later.
void set_mark(Call& c) {
  auto& tempo = c.take().pose_edits.tempo;
  const int frame = frame_of_take(c, 0, 1);
  if (!tempo) {  // a mark alone changes nothing else
    tempo = TempoEdit{};
    tempo->by = TempoBy::Number;
  }
  auto& marks = tempo->marks;
  const float later_s = c.arguments.size() > 2 ? c.number(2, "time") : 0.0f;
  const auto found =
      std::find_if(marks.begin(), marks.end(), [&](const auto& mark) { return mark.frame == frame; });
  if (found == marks.end())
    marks.push_back({frame, later_s});
  else
    found->later_s = later_s;
  std::sort(marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  check_tempo(c);
}

}  // namespace

std::vector<std::string> style_settings() {
  std::vector<std::string> names = {"style"};
  for (const StyleShare& share : kShares) names.push_back(share.name);
  return names;
}

bool set_style(StyleChoice& style, const std::string& setting, const ArgumentReader& value) {
  if (setting == "style") {
    const std::string& word = value.word(0, "style");
    StyleChoice chosen = style;
    chosen.choose(word == "none" ? "" : word);
    if (!chosen.file.empty()) chosen.file = value.path(0);
    if (!chosen.called().empty()) check_style(chosen);
    style = chosen;
    return true;
  }
  for (const StyleShare& share : kShares) {
    if (setting != share.name) continue;
    style.*share.value = value.clamped(0, "share", kStyleStrengths.low, kStyleStrengths.high);
    return true;
  }
  return false;
}

/// A mark is dragged to a frame: its own frame is then shown when that one is now.
void move_tempo_mark(Call& c) {
  TempoMark& mark = mark_at(c, 2);
  const TakeState& state = c.take_state(1);
  const auto to = static_cast<size_t>(frame_of_take(c, 1, 3)), from = static_cast<size_t>(mark.frame);
  US_CHECK(to < state.times.size() && from < state.times.size(), "the tempo is still being computed");
  mark.later_s += static_cast<float>(state.times[to] - state.times[from]);
  c.label = "Shift a moment";
  check_tempo(c, 1);
}

void remove_tempo_mark(Call& c) {
  std::vector<TempoMark>& marks = tempo_of(c, 1).marks;
  marks.erase(marks.begin() + (&mark_at(c, 2) - marks.data()));
}

void add_style_commands(Commands& commands) {
  commands.add_edit({"method.style", "Style", "TAKE NAME|none, or a style's file"}, [](Call& c) {
    set_style(c.take().method.style, "style", ArgumentReader({c.word(1, "style")}));
    const std::string& called = c.take().method.style.called();
    const TaughtStyle* const taught = taught_style(c.session.styles, called);
    c.label = called.empty() ? "No style" : "Style " + (taught ? taught->note.label : file_name(called));
  });
  for (const StyleShare& share : kShares)
    commands.add_slider({std::string("method.") + share.name, share.label, "TAKE SHARE: 0 to 1.5"},
                        [&share](Call& c) {
                          set_style(c.take().method.style, share.name, ArgumentReader({c.word(1, "share")}));
                        });
  commands.add_slider({"edit.tempo", "Tempo", "TAKE body|off, or how many times as long it lasts"},
                      set_tempo);
  commands.add_slider({"edit.tempo_phase", "Tempo of a phase",
                       "TAKE anticipation|stroke|recovery LENGTH: how many times as long it lasts"},
                      set_phase);
  commands.add_slider(
      {"edit.tempo_spread", "Spread of movements", "TAKE SHARE: of how long each lasts, 0 to 0.2"},
      [](Call& c) {
        tempo_of(c).spread = c.clamped(1, "share", 0.0f, 0.2f);
        check_tempo(c);
      });
  commands.add_edit(
      {"edit.tempo_style", "Tempo of the style", "TAKE: strokes and spread as the style has them"},
      tempo_of_style);
  commands.add_edit(
      {"edit.tempo_mark", "Shift a moment", "TAKE FRAME [SECONDS]: later; without a number it stays"},
      set_mark);
}

}  // namespace understudy::app
