#include "ui/panels/performance.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/text.hpp"
#include "retarget/style/load_style.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

/// The styles that come with the program, read once.
struct StyleList {
  std::vector<StyleNote> notes;
  bool is_read = false;
  void read() {
    if (std::exchange(is_read, true)) return;
    for (const MannerFile& style : bundled_styles()) notes.push_back(style.note);
  }
};

std::string licence_words(const StyleNote& note) {
  const std::string words = note.licence + (note.non_commercial() ? ", non-commercial" : "");
  return words + (note.attribution.empty() ? "" : ", " + note.attribution);
}

/// Those that come with the program, then those that were taught, then a file that is neither.
void draw_style_choice(const StyleList& list, const app::StylesState& kept, const StyleChoice& style,
                       PanelContext& context, const std::string& k) {
  std::vector<std::string> words = {"none"}, labels = {"None"}, tips = {"As the source moves"};
  const auto add = [&](const StyleNote& note, const std::string& word) {
    words.push_back(word);
    labels.push_back(note.label + (note.non_commercial() ? ", non-commercial" : ""));
    tips.push_back(note.sentence + ". Made from: " + note.made_from + ". Licence: " + licence_words(note));
  };
  for (const StyleNote& note : list.notes) add(note, note.name);
  for (const app::TaughtStyle& taught : kept.taught) add(taught.note, taught.file);
  if (!style.file.empty() && app::taught_style(kept, style.file) == nullptr)
    words.push_back(style.file), labels.push_back(file_name(style.file)), tips.push_back(style.file);
  ask_choice(context,
             {"performance.style", "Style", "How the motion is performed, whatever is done",
              "method.style " + k, tips},
             labels, words, style.called().empty() ? "none" : style.called());
}

void draw_shares(const StyleChoice& style, PanelContext& context, const std::string& k) {
  struct Share {
    const char *name, *label, *explanation;
    float value;
  };
  const Share shares[] = {
      {"strength", "Strength", "0: the source as it is, 1: the style, up to 1.5", style.strength},
      {"posture", "Posture", "How much of how the style holds the body", style.posture},
      {"size", "Size", "How much of how far the style moves", style.size},
      {"liveliness", "Liveliness", "How much of its sway, bounce and looking about", style.liveliness}};
  for (const Share& share : shares)
    ask_number(context,
               {std::string("performance.") + share.name, share.label, share.explanation,
                std::string("method.style_") + share.name + " " + k},
               share.value, {kStyleStrengths.low, kStyleStrengths.high, 0.005f, "%.2f", 1, true});
}

/// While a style is being taught how far that is; else a button for it.
void draw_teaching(const app::Session& session, PanelContext& context) {
  for (const app::JobView& job : session.jobs)
    if (job.id == session.styles.job)
      return job_progress(session, context, "performance.teaching", job.id, job.progress,
                          job.doing.empty() ? job.name : job.doing);
  ask_button(context, {"performance.teach", "Teach a style\u2026", "Fits a style to recordings of your own",
                       "dialog.open teach_style"});
}

/// A body much smaller than the performer's floats at the performer's tempo.
void draw_hint(const app::Take& take, const app::TakeState* state, PanelContext& context,
               const std::string& k) {
  constexpr float kSmall = 0.8f;
  const float ratio = state != nullptr ? state->leg_ratio : 1;
  if (take.pose_edits.tempo || ratio >= kSmall) return;
  hint(context.ui,
       printed("This body's legs are %.2f of the performer's: at the performer's tempo it falls at %.2f of "
               "gravity.",
               static_cast<double>(ratio), static_cast<double>(ratio)));
  ask_button(context, {"tempo.falls", "Fall as the performer does",
                       "The body's tempo: the root of that ratio", "edit.tempo " + k + " body"});
}

void draw_phases(const TempoEdit& tempo, PanelContext& context, const std::string& k) {
  struct Phase {
    const char *name, *label;
    float value;
  };
  const Phase phases[] = {{"anticipation", "Anticipation", tempo.anticipation},
                          {"stroke", "Stroke", tempo.stroke},
                          {"recovery", "Recovery", tempo.recovery}};
  for (const Phase& phase : phases)
    ask_number(context,
               {std::string("tempo.") + phase.name, phase.label,
                "How many times as long this part of each movement lasts, on top of the rest",
                "edit.tempo_phase " + k + " " + phase.name},
               phase.value, {0.25f, 4, 0.005f, "\u00d7 %.2f", 1, true});
  ask_number(context,
             {"tempo.spread", "Spread",
              "How unlike in length movements are: children of 6 to 8 years 0.036, adults "
              "0.013 of their steps",
              "edit.tempo_spread " + k},
             tempo.spread, {0, 0.2f, 0.0005f, "%.3f", 0, true});
}

void draw_length(const app::TakeState* state, double fps, Ui& ui) {
  if (state == nullptr || state->times.empty()) return;
  const double before = static_cast<double>(state->times.size() - 1) / fps;
  row_text(ui, "Lasts", figure(state->times.back(), "s") + " of " + figure(before, "s"));
}

/// Of several takes of which one at least has a tempo: how they are seen beside each other.
void draw_beside(const app::Session& session, Ui& ui) {
  const auto& takes = session.document.takes;
  const auto has_tempo = [](const app::Take& take) { return take.pose_edits.tempo.has_value(); };
  if (takes.size() < 2 || std::none_of(takes.begin(), takes.end(), has_tempo)) return;
  hint(ui,
       "All views show the same moment of the action; playback and clock go at the current take's tempo.");
  ui.mark("tempo.beside");
}

void draw_tempo(const app::Session& session, const app::Take& take, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "inspector.tempo", take_title(session, "Tempo"), false)) return;
  const std::string k = std::to_string(session.selected_take);
  const app::TakeState* const state = selected_state(session);
  const auto& tempo = take.pose_edits.tempo;
  const bool is_number = tempo && tempo->by == TempoBy::Number;
  const std::string number = argument(is_number ? tempo->length : 1.0f);
  ask_choice(context,
             {"tempo.by",
              "Tempo",
              "When the frames of the result are shown; poses stay as they are",
              "edit.tempo " + k,
              {"As long as the source", "Things fall on this body as they do on the performer's",
               "So many times as long"}},
             {"Source", "Body", "Number"}, {"off", "body", number},
             !tempo      ? "off"
             : is_number ? number
                         : "body");
  draw_beside(session, ui);
  if (!tempo) return;
  if (is_number)
    ask_number(context,
               {"tempo.length", "Length", "How many times as long the result lasts", "edit.tempo " + k},
               tempo->length, {0.25f, 4, 0.005f, "\u00d7 %.2f", 1, true});
  draw_phases(*tempo, context, k);
  draw_length(state, frames_per_second(session), ui);
  ButtonRow buttons(2);
  buttons.ask(context,
              {"tempo.mark", "Add a handle", "Keeps this frame's moment; drag it in the timeline to shift it",
               "edit.tempo_mark " + k + " " + std::to_string(std::max(0, app::shown_frame(session)))});
  buttons.ask(
      context,
      {"tempo.of_style", "As the style", "Strokes and spread as the style has them", "edit.tempo_style " + k},
      !take.method.style.called().empty());
}

}  // namespace

void draw_performance(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const app::Take* const take = selected_take(session);
  if (take == nullptr) return;
  auto& list = panel_state<StyleList>(context);
  if (section(ui, "inspector.performance", take_title(session, "Performance"))) {
    list.read();
    const std::string k = std::to_string(session.selected_take);
    const StyleChoice& style = take->method.style;
    draw_style_choice(list, session.styles, style, context, k);
    if (!style.called().empty()) draw_shares(style, context, k);
    ButtonRow buttons(2);
    buttons.ask(context,
                {"performance.open", "From a file\u2026", "A style's file", "dialog.open style_file"});
    buttons.ask(context,
                {"performance.compare", "Compare", "Adds a take without the style beside this one",
                 "compare.add " + k + " style=none"},
                style.any());
    draw_teaching(session, context);
    draw_hint(*take, selected_state(session), context, k);
  }
  draw_tempo(session, *take, context);
}

void PhaseBands::follow(const app::Session& session) {
  const app::Take* const take = selected_take(session);
  const app::TakeState* const state = selected_state(session);
  const bool any = take != nullptr && take->pose_edits.tempo && state != nullptr && !state->joints.empty();
  if (!any) {
    bands.clear(), take_ = -1;
    return;
  }
  if (session.working && take_ == session.selected_take) return;  // each look is at all frames
  if (take_ == session.selected_take && generation_ == state->generation && frames_ == state->joints.size())
    return;
  take_ = session.selected_take, generation_ = state->generation, frames_ = state->joints.size();
  const auto phases = movement_phases(state->joints, static_cast<float>(frames_per_second(session)));
  bands = {
      {"anticipation", "Anticipation", {}, 3}, {"stroke", "Stroke", {}, 4}, {"recovery", "Recovery", {}, 2}};
  for (int t = 0; t < static_cast<int>(phases.size()); ++t) {
    const MovementPhase phase = phases[static_cast<size_t>(t)];
    if (phase == MovementPhase::Rest) continue;
    auto& bars = bands[static_cast<size_t>(phase) - 1].bars;
    if (bars.empty() || bars.back().last + 1 < t) bars.push_back({t, t});
    bars.back().last = t;
  }
}

}  // namespace understudy::ui
