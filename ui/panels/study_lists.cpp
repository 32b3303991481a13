// The lists of a study: conditions, motions, targets and questions. The chosen item of each is edited below
// its list.
#include <algorithm>

#include "app/session/study_edits.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/rows.hpp"
#include "ui/panels/study.hpp"

namespace understudy::ui {
namespace {

using app::StudyList;

struct Line {
  std::string name;
  std::string note;  ///< grey, on the right
};

template <class Item, class Write>
std::vector<Line> lines_of(const std::vector<Item>& items, Write write) {
  std::vector<Line> lines(items.size());
  std::transform(items.begin(), items.end(), lines.begin(), write);
  return lines;
}

std::string name_of(StudyList list) {
  return app::kStudyListNames[static_cast<size_t>(list)];
}

void draw_line(PanelContext& context, StudyList list, int i, const Line& line, bool is_chosen) {
  Ui& ui = context.ui;
  const std::string name = "study." + name_of(list) + "." + std::to_string(i);
  const IdScope id(name);
  const float width = ImGui::GetContentRegionAvail().x, half = 0.45f * width;
  const std::string note = line.note == line.name ? "" : cut_name(line.note, half);
  const float room = note.empty() ? 0 : ImGui::CalcTextSize(note.c_str()).x + ui.px(14);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::Selectable("##line", is_chosen, 0, {0, ImGui::GetTextLineHeight() + ui.px(6)}))
    context.ask("study.choose", {name_of(list), std::to_string(i)});
  ui.mark(name);
  ui.stop(name);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const std::string shown = cut_name(line.name, width - room - ui.px(10));
  if (shown != line.name || (note != line.note && !note.empty())) tooltip(ui, line.name + ": " + line.note);
  const float y = at.y + ui.px(3);
  draw.AddText({at.x + ui.px(6), y}, color(ui.theme().text), shown.c_str());
  draw.AddText({at.x + width - room + ui.px(8), y}, color(ui.theme().text_dim), note.c_str());
}

/// What can be done with the chosen item: an icon each, on the right of "Condition 2 of 3".
void draw_handles(PanelContext& context, StudyList list, int chosen, int count) {
  Ui& ui = context.ui;
  const std::string name = name_of(list), k = std::to_string(chosen);
  std::string title = name;
  title[0] = static_cast<char>(title[0] - 'a' + 'A');
  const float side = ImGui::GetFrameHeight(), gap = ui.px(2);
  const float start = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - 4 * side - 3 * gap;
  ImGui::AlignTextToFramePadding();
  {
    const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
    text_cut(ui, title + " " + std::to_string(chosen + 1) + " of " + std::to_string(count),
             start - ImGui::GetCursorPosX() - ui.px(8));
  }
  const float size = side / ui.scale();
  const auto handle = [&](float place, const char* what, Icon icon, const std::string& tip, bool possible,
                          const app::Arguments& words) {
    ImGui::SameLine(start + place * (side + gap));
    if (icon_button(ui, "study." + name + "." + what, icon, {tip, "", false, !possible, size}))
      context.ask(words.front(), {words.begin() + 1, words.end()});
  };
  handle(0, "up", Icon::ChevronUp, "Moves it up", chosen > 0,
         {"study.move", name, k, std::to_string(chosen - 1)});
  handle(1, "down", Icon::ChevronDown, "Moves it down", chosen + 1 < count,
         {"study.move", name, k, std::to_string(chosen + 1)});
  handle(2, "copy", Icon::Copy, "Adds a copy of it, to be changed", true, {"study.copy", name, k});
  handle(3, "remove", Icon::Trash, "Removes it; can be undone", true, {"study.remove", name, k});
}

/// The list and the handles of its chosen item, whose place it returns; -1: the list is empty.
int draw_list(const app::Session& session, PanelContext& context, StudyList list,
              const std::vector<Line>& lines) {
  const int chosen = app::chosen(session.study, list), count = static_cast<int>(ssize(lines));
  for (int i = 0; i < count; ++i) draw_line(context, list, i, lines[static_cast<size_t>(i)], i == chosen);
  if (chosen >= 0) draw_handles(context, list, chosen, count);
  return chosen;
}

std::string item(const char* list, int i, const std::string& setting) {
  return std::string(list) + "." + std::to_string(i) + "." + setting;
}

std::string counted_title(const std::string& title, std::ptrdiff_t count) {
  return title + " (" + std::to_string(count) + ")";
}

template <size_t N>
std::vector<std::string> words_of(const Names<N>& names) {
  return {names.begin(), names.end()};
}

// Conditions.

void draw_method(const app::Method& method, PanelContext& context, int i) {
  const auto setting = [i](const std::string& name) { return item("conditions", i, "method." + name); };
  const auto tips = [](const MethodChoices& choices) {
    std::vector<std::string> all;
    for (const MethodChoice& choice : choices) all.push_back(tip_of(choice));
    return all;
  };
  study_choice(context, setting("engine"), labels_of(engines()), names_of(engines()), method.engine,
               tips(engines()));
  study_choice(context, setting("extractor"), labels_of(extractors()), names_of(extractors()),
               method.extractor, tips(extractors()));
  study_toggle(context, setting("offsets"), method.offsets);
  study_choice(context, setting("path"), {"Scaled", "Original", "In place"}, words_of(kRootNames),
               kRootNames[static_cast<size_t>(method.path)], path_tips());
  if (!section(context.ui, "study.options", "More of this method", false)) return;
  for (const app::MethodSwitch& one : app::kSwitches) {
    const std::string name = setting(one.name);
    ask_toggle(context, {"study." + name, one.label, one.explanation, "study.set " + name}, method.*one.on);
  }
  for (const app::Proportion& one : app::kProportions) {
    const std::string name = setting(one.name);
    const float speed = (one.range.high - one.range.low) / 500;
    ask_number(context, {"study." + name, one.label, one.explanation, "study.set " + name}, method.*one.value,
               {one.range.low, one.range.high, speed, one.format, app::Method().*one.value, true});
  }
}

/// Which motion or target a file is of: all of them, or one.
template <class Item>
void draw_belonging(PanelContext& context, const std::string& setting, const std::vector<Item>& items,
                    const std::string& now) {
  std::vector<std::string> labels = {"All"}, words = {""};
  for (const Item& one : items) labels.push_back(one.name), words.push_back(one.name);
  const auto found = std::find(words.begin(), words.end(), now);
  int chosen = found == words.end() ? -1 : static_cast<int>(found - words.begin());
  const app::StudyField* const field = app::study_field(setting);
  row(context.ui, field->label, field->explanation);
  if (dropdown(context.ui, "study." + setting, labels, chosen))
    context.ask("study.set", {setting, words[static_cast<size_t>(chosen)]});
}

void draw_animations(const app::Study& study, PanelContext& context, int i) {
  Ui& ui = context.ui;
  const auto& files = study.conditions[static_cast<size_t>(i)].files;
  if (files.empty()) hint(ui, "No animation yet. Each motion on each target needs one.");
  for (size_t k = 0; k < files.size(); ++k) {
    const std::string number = std::to_string(k), place = item("conditions", i, "files." + number + ".");
    const IdScope id(place);
    const float side = ImGui::GetFrameHeight();
    ImGui::AlignTextToFramePadding();
    text_cut(ui, file_name(files[k].path), ImGui::GetContentRegionAvail().x - side - ui.px(8));
    ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - side);
    if (icon_button(ui, "study.file." + number + ".remove", Icon::Trash,
                    {"Removes this animation; can be undone", "", false, false, side / ui.scale()}))
      context.ask("study.remove_file", {std::to_string(i), number});
    draw_belonging(context, place + "motion", study.motions, files[k].motion);
    draw_belonging(context, place + "target", study.targets, files[k].target);
  }
  ask_button(context, {"study.add_animation", "Add animation\u2026",
                       "An imported animation of a motion on a target", "dialog.open study_animation"});
}

std::string note_of(const app::Condition& condition) {
  if (condition.kind == app::ConditionKind::Method) return app::method_in_words(condition.method);
  const std::string files =
      std::to_string(condition.files.size()) + (condition.files.size() == 1 ? " file" : " files");
  return condition.kind == app::ConditionKind::GroundTruth ? "truth, " + files : files;
}

void draw_question_words(const app::Study& study, PanelContext& context, int i) {
  const app::StudyQuestion& question = study.questions[static_cast<size_t>(i)];
  const auto setting = [i](const char* name) { return item("questions", i, name); };
  if (question.kind == app::QuestionKind::Likert) {
    study_count(context, setting("points"), question.points);
    study_text(context, setting("low"), question.low, "Not at all");
    study_text(context, setting("high"), question.high, "Very much");
    return;
  }
  std::string options;
  for (const std::string& option : question.options) append_item(options, option, " | ");
  const app::StudyField* const field = app::study_field("questions.options");
  const auto text = text_row(context.ui, {"study." + setting("options"), field->label, field->explanation},
                             options, "Adult | Child");
  if (text) {
    app::Arguments words = {setting("options")};
    for (const std::string& option : split(*text, '|')) {
      const size_t begin = option.find_first_not_of(' ');
      if (begin != option.npos) words.emplace_back(trim_end(option.substr(begin)));
    }
    context.ask("study.set", words);
  }
  if (question.kind != app::QuestionKind::Attention) return;
  std::vector<std::string> labels = {"The motion's action"}, words = {""};
  for (const std::string& option : question.options) labels.push_back(option), words.push_back(option);
  const auto found = std::find(words.begin(), words.end(), question.right);
  int chosen = found == words.end() ? -1 : static_cast<int>(found - words.begin());
  const app::StudyField* const right = app::study_field("questions.right");
  row(context.ui, right->label, right->explanation);
  if (dropdown(context.ui, "study." + setting("right"), labels, chosen))
    context.ask("study.set", {setting("right"), words[static_cast<size_t>(chosen)]});
}

/// What a participant reads.
std::string as_seen(const app::StudyQuestion& question) {
  std::string words = question.text;
  if (question.kind == app::QuestionKind::Likert)
    return words + "\n1 " + question.low + " \u2026 " + std::to_string(question.points) + " " + question.high;
  words += '\n';
  for (const std::string& option : question.options) words += (words.back() == '\n' ? "" : ", ") + option;
  return words;
}

std::string note_of(const app::StudyQuestion& question) {
  if (question.kind == app::QuestionKind::Likert) return std::to_string(question.points) + " points";
  const std::string options = std::to_string(question.options.size()) + " options";
  return question.kind == app::QuestionKind::Attention ? "attention, " + options : options;
}

}  // namespace

void draw_study_conditions(const app::Session& session, PanelContext& context) {
  const app::Study& study = *session.study.study;
  const auto& all = study.conditions;
  if (!section(context.ui, "study.conditions", counted_title("Conditions", ssize(all)))) return;
  const int i =
      draw_list(session, context, StudyList::Condition, lines_of(all, [](const app::Condition& one) {
                  return Line{one.name, note_of(one)};
                }));
  if (i >= 0) {
    const app::Condition& condition = all[static_cast<size_t>(i)];
    study_text(context, item("conditions", i, "name"), condition.name);
    study_choice(context, item("conditions", i, "kind"), {"Method", "Files", "Truth"},
                 words_of(app::kConditionKindNames),
                 app::kConditionKindNames[static_cast<size_t>(condition.kind)],
                 {"This program retargets the motions", "Imported animations, whoever made them",
                  "Imported animations that are known to be right"});
    if (condition.kind == app::ConditionKind::Method)
      draw_method(condition.method, context, i);
    else
      draw_animations(study, context, i);
  }
  ButtonRow add(2);
  const bool takes = !session.document.takes.empty();
  add.ask(context,
          {"study.add_conditions", "Add from takes",
           takes ? "A condition for each method of the takes" : "No take is open"},
          takes);
  add.ask(context, {"study.add_files", "Add animation\u2026", "A condition of imported animations",
                    "dialog.open study_files"});
}

void draw_study_motions(const app::Session& session, PanelContext& context) {
  const auto& all = session.study.study->motions;
  if (!section(context.ui, "study.motions", counted_title("Motions", ssize(all)), false)) return;
  const int i = draw_list(session, context, StudyList::Motion, lines_of(all, [](const app::StudyMotion& one) {
                            return Line{one.name, app::action_of(one) == one.name ? "" : one.action};
                          }));
  if (i >= 0) {
    const app::StudyMotion& motion = all[static_cast<size_t>(i)];
    study_text(context, item("motions", i, "name"), motion.name);
    study_text(context, item("motions", i, "action"), motion.action, motion.name);
    row_text(context.ui, motion.source.blend ? "Blend" : "File", name_of(motion.source));
    study_number(context, item("motions", i, "from_s"), motion.from_s, {0, 1e5f, 0.01f, "%.2f s", 0, true});
    study_optional(context, item("motions", i, "seconds"), motion.seconds);
  }
  ButtonRow add(2);
  const bool source = !session.document.source.path.empty();
  add.ask(context,
          {"study.add_source", "Add open source",
           source ? "The source, between the loop marks where there are any" : "No source is open",
           "study.add_motion"},
          source);
  add.ask(context, {"study.add_motion", "Add file\u2026", "A scan or a motion", "dialog.open study_motion"});
  if (session.document.source.blend)
    ask_button(context, {"study.add_blends", "Add 7 steps of the blend",
                         "A motion for each of seven weights, from the first of what is blended to the last",
                         "study.add_blends 7"});
}

void draw_study_targets(const app::Session& session, PanelContext& context) {
  const auto& all = session.study.study->targets;
  if (!section(context.ui, "study.targets", counted_title("Targets", ssize(all)), false)) return;
  const int i = draw_list(session, context, StudyList::Target, lines_of(all, [](const app::StudyTarget& one) {
                            return Line{one.name, file_name(one.target.path)};
                          }));
  if (i >= 0) {
    const app::StudyTarget& target = all[static_cast<size_t>(i)];
    study_text(context, item("targets", i, "name"), target.name);
    study_optional(context, item("targets", i, "target.import.height_m"), target.target.import.height);
  }
  ButtonRow add(2);
  const bool takes = !session.document.takes.empty();
  add.ask(context,
          {"study.add_targets", "Add from takes",
           takes ? "The targets of the takes, as their files are" : "No take is open", "study.add_target"},
          takes);
  add.ask(context, {"study.add_target", "Add file\u2026", "A body or character", "dialog.open study_target"});
}

void draw_study_questions(const app::Session& session, PanelContext& context) {
  const app::Study& study = *session.study.study;
  const auto& all = study.questions;
  if (!section(context.ui, "study.questions", counted_title("Questions", ssize(all)))) return;
  const int i =
      draw_list(session, context, StudyList::Question, lines_of(all, [](const app::StudyQuestion& one) {
                  return Line{one.name, note_of(one)};
                }));
  if (i >= 0) {
    const app::StudyQuestion& question = all[static_cast<size_t>(i)];
    study_text(context, item("questions", i, "name"), question.name);
    study_text(context, item("questions", i, "text"), question.text);
    study_choice(context, item("questions", i, "kind"), {"Scale", "Choice", "Attention"},
                 words_of(app::kQuestionKindNames),
                 app::kQuestionKindNames[static_cast<size_t>(question.kind)],
                 {"A point of a scale between two labels", "One of the options",
                  "One of the options, of which one is right: who misses it too often is excluded"});
    draw_question_words(study, context, i);
    study_count(context, item("questions", i, "every"), question.every);
    hint(context.ui, as_seen(question));
  }
  ButtonRow add(3);
  add.ask(context, {"study.add_likert", "Add scale", "A question with a scale", "study.add_question likert"});
  add.ask(context,
          {"study.add_choice", "Add choice", "A question with options", "study.add_question choice"});
  add.ask(context, {"study.add_attention", "Add check", "A question of attention, with a right answer",
                    "study.add_question attention"});
}

}  // namespace understudy::ui
