// A perceptual study: what is shown to whom, and what they are asked.
// Marks: study.new, study.new.PRESET, study.open (without a study); study.size, study.problem, study.gone;
// study.save, study.close, study.format, study.render, study.web, study.run, study.export, study.analyse;
// study.SETTING, a name as in the file ("study.plan.seed", "study.questions.0.text"); study.LIST.K, the rows
// of condition, motion, target, question and trial; study.LIST.up, .down, .copy, .remove of the chosen one;
// study.add_conditions, .add_files, .add_source, .add_motion, .add_targets, .add_target, .add_likert,
// .add_choice, .add_attention; study.add_animation, study.file.K.remove; study.camera; study.participant,
// study.picture (study.no_picture until there is one), study.moment. Sections: study.conditions, .motions,
// .targets, .questions, .options (of a method), .layout, .clip, .picture_section, .plan, .words, .trials.
#include "ui/panels/study.hpp"

#include <imgui_stdlib.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "app/session/study_edits.hpp"
#include "app/study/presets.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

/// In which the list of trials is exported.
struct TrialsFormat {
  int chosen = 0;
};

Control control_of(const std::string& setting) {
  const app::StudyField* const field = app::study_field(setting);
  Control control{"study." + setting, setting};
  control.command = "study.set " + setting;
  if (field != nullptr) control.label = field->label, control.explanation = field->explanation;
  return control;
}

void draw_beginning(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  hint(ui, "A study shows people clips of several methods and asks them the same questions of each.");
  ImGui::Dummy({0, ui.px(4)});
  const bool any = has_document(session);
  ask_button(context,
             {"study.new", "New study from the open takes",
              any ? "A condition for each method of the takes, with their targets and the source"
                  : "Open a source and a target first",
              "study.new takes"},
             any);
  for (const app::StudyPreset& preset : app::study_presets())
    ask_button(context, {std::string("study.new.") + preset.name, std::string("New: ") + preset.label,
                         preset.sentence, std::string("study.new ") + preset.name});
  ask_button(context, {"study.open", "Open study\u2026", "", "dialog.open open_study"});
}

/// Trials and minutes, and what is wrong.
void draw_size(const app::StudyState& state, Ui& ui) {
  if (state.problem.empty()) {
    paragraph(app::size_in_words(*state.study) + ".");
    ui.mark("study.size");
  } else {
    warning_sentence(ui, "Cannot be run yet: " + state.problem + ".");
    ui.mark("study.problem");
  }
  if (state.gone.empty()) return;
  warning_sentence(ui, state.gone + ".");
  ui.mark("study.gone");
}

void draw_files(const app::StudyState& state, PanelContext& context) {
  const std::string name = state.path.empty() ? "Not saved yet" : file_name(state.path);
  row_text(context.ui, "File", name + (state.changed ? " *" : ""));
  const bool is_new = state.path.empty();
  ButtonRow files(3);
  files.ask(context, {"study.save", is_new ? "Save\u2026" : "Save", "",
                      is_new ? "dialog.open save_study" : "study.save"});
  files.ask(context, {"study.open", "Open\u2026", "Opens another study", "dialog.open open_study"});
  files.ask(context,
            {"study.close", "Close", "Closes this study; asks first where it is not saved", "study.close"});
}

/// What is made of the study for others, and of their answers.
void draw_outputs(const app::StudyState& state, PanelContext& context) {
  Ui& ui = context.ui;
  const bool whole = state.problem.empty();
  const std::string wrong = "Complete the study first";
  ButtonRow showing(3);
  showing.ask(context,
              {"study.render", "Render\u2026",
               whole ? "Every clip of the study, as videos in a folder; what is there already stays" : wrong,
               "dialog.open study_stimuli"},
              whole);
  showing.ask(context,
              {"study.web", "Web page\u2026", whole ? "A folder that runs the study in any browser" : wrong,
               "dialog.open study_web"},
              whole);
  showing.ask(context,
              {"study.run", "Run\u2026", whole ? "Shows it to a participant, on the whole screen" : wrong,
               "dialog.open study_run"},
              whole);
  auto& format = panel_state<TrialsFormat>(context).chosen;
  std::vector<std::string> labels;
  for (const app::TrialFormat& one : app::trial_formats()) labels.emplace_back(one.label);
  row(ui, "Trials as",
      "Of the exported list of trials: to be read, or for another program that runs the study");
  dropdown(ui, "study.format", labels, format);
  ButtonRow outputs(2);
  const std::string name = app::trial_formats()[static_cast<size_t>(format)].name;
  outputs.ask(
      context,
      {"study.export", "Export trials\u2026",
       whole ? "The trials in the order in which they are listed below" : wrong, "dialog.open study_" + name},
      whole);
  outputs.ask(
      context,
      {"study.analyse", "Analyse answers\u2026",
       whole ? "Statistics and plots of a folder of answers, as a page" : wrong, "dialog.open study_answers"},
      whole);
}

struct Writing {
  bool active = false;
  std::string text;
};

/// Several lines, and below how they are read, since a field does not break them.
void draw_paragraphs(PanelContext& context, const std::string& setting, const std::string& value) {
  Ui& ui = context.ui;
  const Control control = control_of(setting);
  auto& writing = ui.state<Writing>(ImGui::GetID((control.name + ".writing").c_str()));
  if (!writing.active) writing.text = value;
  row(ui, control.label, control.explanation);
  ImGui::NewLine();
  const float height = 4 * ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().FramePadding.y;
  ImGui::InputTextMultiline(("##" + control.name).c_str(), &writing.text, {-FLT_MIN, height});
  ui.mark(control.name);
  ui.stop(control.name, true);
  writing.active = ImGui::IsItemActive();
  if (ImGui::IsItemDeactivatedAfterEdit() && writing.text != value)
    context.ask("study.set", {setting, writing.text});
  if (!value.empty()) hint(ui, value);
}

void draw_words(const app::Study& study, PanelContext& context) {
  if (!section(context.ui, "study.words", "Note and consent", false)) return;
  draw_paragraphs(context, "note", study.note);
  draw_paragraphs(context, "consent", study.consent);
}

/// Every order of panes that has the result in it.
const std::vector<std::vector<app::StudyPane>>& pane_choices() {
  using Pane = app::StudyPane;
  static const std::vector<std::vector<Pane>> all = {{Pane::Source, Pane::Target, Pane::Result},
                                                     {Pane::Target, Pane::Source, Pane::Result},
                                                     {Pane::Source, Pane::Result, Pane::Target},
                                                     {Pane::Target, Pane::Result, Pane::Source},
                                                     {Pane::Result, Pane::Source, Pane::Target},
                                                     {Pane::Result, Pane::Target, Pane::Source},
                                                     {Pane::Source, Pane::Result},
                                                     {Pane::Result, Pane::Source},
                                                     {Pane::Target, Pane::Result},
                                                     {Pane::Result, Pane::Target},
                                                     {Pane::Result}};
  return all;
}

void draw_layout(const app::StudyLayout& layout, PanelContext& context) {
  if (!section(context.ui, "study.layout", "Layout", false)) return;
  const auto& choices = pane_choices();
  std::vector<std::string> labels;
  for (const auto& panes : choices) {
    std::string label;
    for (const app::StudyPane pane : panes)
      append_item(label, app::kStudyPaneNames[static_cast<size_t>(pane)]);
    labels.push_back(label);
  }
  int chosen = static_cast<int>(std::find(choices.begin(), choices.end(), layout.panes) - choices.begin());
  const Control panes = control_of("layout.panes");
  row(context.ui, panes.label, panes.explanation);
  if (dropdown(context.ui, panes.name, labels, chosen)) {
    app::Arguments words = {"layout.panes"};
    for (const app::StudyPane pane : choices[static_cast<size_t>(chosen)])
      words.emplace_back(app::kStudyPaneNames[static_cast<size_t>(pane)]);
    context.ask("study.set", words);
  }
  study_choice(
      context, "layout.results", {"One", "Pair"},
      {app::kTrialResultsNames.begin(), app::kTrialResultsNames.end()},
      app::kTrialResultsNames[static_cast<size_t>(layout.results)],
      {"One result at a time: for ratings", "Two results side by side: each pair of conditions is a trial"});
  study_toggle(context, "layout.labels", layout.labels);
}

void draw_clip(const app::StudyClip& clip, PanelContext& context) {
  if (!section(context.ui, "study.clip", "Clips", false)) return;
  study_number(context, "clip.seconds", clip.seconds, {0.5f, 600, 0.05f, "%.1f s", 10, true});
  study_number(context, "clip.speed", clip.speed, {0.1f, 10, 0.005f, "\u00d7 %.2f", 1, true});
  study_text(context, "clip.card", clip.card, "no words");
  study_number(context, "clip.card_s", clip.card_s, {0, 10, 0.02f, "%.1f s", 1, true});
}

void draw_background(const Vec3& now, PanelContext& context) {
  const Control control = control_of("picture.background");
  row(context.ui, control.label, control.explanation);
  Vec3 color = now;
  ImGui::SetNextItemWidth(-FLT_MIN);
  const bool changed = ImGui::ColorEdit3("##background", color.data(), ImGuiColorEditFlags_NoOptions);
  context.ui.mark(control.name);
  if (!changed) return;
  app::Arguments words = {"picture.background"};
  for (int i = 0; i < 3; ++i) words.push_back(argument(static_cast<double>(color[i])));
  context.ask("study.set", words);
}

void draw_picture(const app::Session& session, PanelContext& context) {
  if (!section(context.ui, "study.picture_section", "Picture", false)) return;
  const app::StudyPicture& picture = session.study.study->picture;
  study_count(context, "picture.width", picture.width);
  study_count(context, "picture.height", picture.height);
  study_count(context, "picture.fps", picture.fps);
  ask_button(context,
             {"study.camera", "Camera and light as in the view",
              has_document(session) ? "The angles of the active view, and its light"
                                    : "Open something to look at first"},
             has_document(session));
  study_number(context, "picture.yaw_deg", picture.yaw_deg, {-360, 360, 0.5f, "%.1f\u00b0", 32, true});
  study_number(context, "picture.pitch_deg", picture.pitch_deg, {-89, 89, 0.5f, "%.1f\u00b0", 10, true});
  study_number(context, "picture.fov_deg", picture.fov_deg, {5, 120, 0.2f, "%.1f\u00b0", 28, true});
  study_number(context, "picture.margin", picture.margin, {0, 0.4f, 0.001f, "%.2f", 0.05f, true});
  study_number(context, "picture.light_turn_deg", picture.light_turn_deg,
               {-360, 360, 0.5f, "%.0f\u00b0", 0, true});
  study_number(context, "picture.light_height_deg", picture.light_height_deg,
               {-90, 90, 0.5f, "%.0f\u00b0", 0, true});
  study_number(context, "picture.brightness", picture.brightness, {0.05f, 5, 0.005f, "%.2f", 1, true});
  draw_background(picture.background, context);
}

void draw_exclusion(const app::StudyPlan& plan, PanelContext& context) {
  const Control control = control_of("plan.least_right");
  const auto share = typed_number_row(context.ui, control, 100 * static_cast<double>(plan.least_right), 0);
  if (share) context.ask("study.set", {"plan.least_right", argument(*share / 100)});
  study_toggle(context, "plan.must_exceed", plan.must_exceed);
}

void draw_plan(const app::StudyPlan& plan, PanelContext& context) {
  if (!section(context.ui, "study.plan", "Plan", false)) return;
  study_count(context, "plan.participants", plan.participants);
  study_count(context, "plan.repetitions", plan.repetitions);
  study_count(context, "plan.trials_per_participant", plan.trials_per_participant);
  study_choice(context, "plan.order", {"Random", "Latin square"},
               {app::kTrialOrderNames.begin(), app::kTrialOrderNames.end()},
               app::kTrialOrderNames[static_cast<size_t>(plan.order)],
               {"Shuffled anew for each participant",
                "Williams' balanced Latin square over the conditions: each follows each equally often"});
  study_count(context, "plan.practice", plan.practice);
  study_count(context, "plan.break_every", plan.break_every);
  study_count(context, "plan.seed", plan.seed);
  draw_exclusion(plan, context);
}

}  // namespace

void study_text(PanelContext& context, const std::string& setting, const std::string& value,
                const std::string& hint) {
  if (const auto text = text_row(context.ui, control_of(setting), value, hint))
    context.ask("study.set", {setting, *text});
}

void study_count(PanelContext& context, const std::string& setting, int value) {
  const auto number = typed_number_row(context.ui, control_of(setting), value, 0);
  if (number) context.ask("study.set", {setting, argument(std::round(*number))});
}

void study_number(PanelContext& context, const std::string& setting, float value,
                  const NumberOptions& options) {
  ask_number(context, control_of(setting), value, options);
}

void study_optional(PanelContext& context, const std::string& setting, const std::optional<float>& value) {
  const std::string now = value ? argument(static_cast<double>(*value)) : "auto";
  const auto text = text_row(context.ui, control_of(setting), now);
  if (!text) return;
  const auto number = parse_number(*text);
  if (number || *text == "auto" || text->empty())
    context.ask("study.set", {setting, number ? argument(*number) : "none"});
}

void study_toggle(PanelContext& context, const std::string& setting, bool on) {
  ask_toggle(context, control_of(setting), on);
}

void study_choice(PanelContext& context, const std::string& setting, const std::vector<std::string>& labels,
                  const std::vector<std::string>& words, const std::string& chosen,
                  const std::vector<std::string>& tips) {
  Control control = control_of(setting);
  control.tips = tips;
  ask_choice(context, control, labels, words, chosen);
}

void draw_study(const app::Session& session, PanelContext& context) {
  const app::StudyState& state = session.study;
  if (!state.study) return draw_beginning(session, context);
  draw_size(state, context.ui);
  study_text(context, "name", state.study->name);
  draw_files(state, context);
  draw_outputs(state, context);
  draw_study_conditions(session, context);
  draw_study_motions(session, context);
  draw_study_targets(session, context);
  draw_study_questions(session, context);
  draw_layout(state.study->layout, context);
  draw_clip(state.study->clip, context);
  draw_picture(session, context);
  draw_plan(state.study->plan, context);
  draw_words(*state.study, context);
  draw_study_trials(session, context);
}

}  // namespace understudy::ui
