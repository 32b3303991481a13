#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/session/command_sets.hpp"
#include "app/session/study_edits.hpp"
#include "app/session/study_showing.hpp"
#include "app/study/analysis_page.hpp"
#include "app/study/presets.hpp"
#include "app/study/study_analysis.hpp"
#include "app/study/trial_exports.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace fs = std::filesystem;
namespace {

/// Of a call. Throws Error where no study is open.
Study& open_study(const Call& c) {
  auto& study = c.session.study.study;
  US_CHECK(study, "no study is open");
  return *study;
}

void show_panel(Studio& studio) {
  if (studio.commands().find("panel.show") != nullptr) studio.run("panel.show", {"study", "on"});
}

/// In place of the open one, of which nothing is kept but its folders.
void replace_study(Studio& studio, std::optional<Study> study, const std::string& path) {
  StudyState fresh;
  fresh.history = StudyHistory(studio.session().settings.undo_depth);
  fresh.study = std::move(study);
  fresh.path = path;
  StudyState& state = studio.session().study;
  fresh.folders = std::move(state.folders);
  fresh.folders.erase("");
  state = std::move(fresh);
  follow_design(state);
  if (state.study) show_panel(studio);
}

std::string preset_names() {
  std::string names;
  for (const StudyPreset& preset : study_presets()) append_item(names, preset.name, "|");
  return names;
}

void make_study(Call& c) {
  const std::string from = c.arguments.empty() ? "takes" : c.arguments[0];
  if (!no_unsaved_study(c.studio, join_line("study.new", {from}))) return;
  const std::string& samples = c.studio.services().samples;
  US_CHECK(from == "takes" || !samples.empty(), "the bundled samples are missing");
  replace_study(c.studio, from == "takes" ? study_of_takes(c.session) : study_preset(from).make(samples), "");
  c.session.study.changed = true;
}

void open_study_file(Call& c) {
  const std::string path = c.path(0);
  if (!no_unsaved_study(c.studio, join_line("study.open", {path}))) return;
  auto& recent = c.session.settings.recent_studies;
  replace_study(c.studio, opened({&recent}, path, [&] { return read_draft(path); }), path);
  remember(recent, path);
  remember_folder(c.studio, path);
}

void add_files(Commands& commands) {
  commands.add(
      {"study.new", "New study", "[takes|" + preset_names() + "]: from the open takes, or a paper's"},
      make_study);
  commands.add({"study.open", "Open study", "PATH"}, open_study_file);
  commands.add({"study.save", "Save study"}, [](Call& c) {
    open_study(c);
    US_CHECK(!c.session.study.path.empty(), "the study has no file yet: save it under a name");
    save_study(c.studio, c.session.study.path);
  });
  commands.add({"study.save_as", "Save study as", "PATH"}, [](Call& c) {
    open_study(c);
    const std::string& path = c.word(0, "path");
    save_study(c.studio, can_be(path, kStudy) ? path : path + ".study");
  });
  commands.add({"study.close", "Close study"}, [](Call& c) {
    open_study(c);
    if (no_unsaved_study(c.studio, "study.close")) replace_study(c.studio, std::nullopt, "");
  });
}

std::vector<std::string> from_second(const Arguments& arguments) {
  return {arguments.begin() + 1, arguments.end()};
}

void set_value(Call& c) {
  Study& study = open_study(c);
  const std::string& name = c.word(0, "setting");
  study = with_value(study, name, from_second(c.arguments));
  const StudyField* const field = study_field(name);
  c.label = std::string("Change ") + (field != nullptr ? lower_case(field->label) : name);
}

const std::string& list_argument(const Call& c) {
  return c.one_of(0, "list", {"condition", "motion", "target", "question"});
}

void choose(StudyState& state, StudyList list, std::ptrdiff_t i) {
  state.chosen[static_cast<size_t>(list)] = static_cast<int>(std::max<std::ptrdiff_t>(0, i));
}

StudyList list_of(const std::string& name) {
  const auto found = std::find(kStudyListNames.begin(), kStudyListNames.end(), name);
  return static_cast<StudyList>(found - kStudyListNames.begin());
}

size_t place_argument(const Call& c, size_t i) {
  const int place = c.number<int>(i, "number");
  US_CHECK(place >= 0, "there is nothing with the number ", place);
  return static_cast<size_t>(place);
}

void add_lists(Commands& commands) {
  const std::string list = "condition|motion|target|question ";
  commands.add_edit({"study.remove", "Remove from study", list + "NUMBER"}, [](Call& c) {
    c.label = "Remove " + list_argument(c);
    remove_item(open_study(c), c.arguments[0], place_argument(c, 1));
  });
  commands.add_edit({"study.move", "Move in study", list + "FROM TO"}, [](Call& c) {
    c.label = "Move " + list_argument(c);
    move_item(open_study(c), c.arguments[0], place_argument(c, 1), place_argument(c, 2));
    choose(c.session.study, list_of(c.arguments[0]), c.number<int>(2, "number"));
  });
  commands.add_edit({"study.copy", "Copy in study", list + "NUMBER"}, [](Call& c) {
    c.label = "Copy " + list_argument(c);
    copy_item(open_study(c), c.arguments[0], place_argument(c, 1));
    choose(c.session.study, list_of(c.arguments[0]), c.number<int>(1, "number") + 1);
  });
}

/// Paths, made absolute.
std::vector<std::string> paths_from(const Call& c, size_t first) {
  std::vector<std::string> paths;
  for (size_t i = first; i < c.arguments.size(); ++i) paths.push_back(c.path(i));
  return paths;
}

Condition& condition_argument(const Call& c) {
  auto& all = open_study(c).conditions;
  const size_t i = place_argument(c, 0);
  US_CHECK(i < all.size(), "there is no condition ", i, " in the study");
  return all[i];
}

void add_condition_files(Commands& commands) {
  commands.add_edit({"study.add_file", "Add animation", "CONDITION PATH [MOTION [TARGET]]"}, [](Call& c) {
    const auto name = [&](size_t i) { return i < c.arguments.size() ? c.arguments[i] : std::string(); };
    condition_argument(c).files.push_back({name(2), name(3), c.path(1)});
  });
  commands.add_edit({"study.remove_file", "Remove animation", "CONDITION NUMBER"}, [](Call& c) {
    auto& files = condition_argument(c).files;
    const size_t i = place_argument(c, 1);
    US_CHECK(i < files.size(), "there is no animation ", i, " in the condition");
    files.erase(files.begin() + static_cast<std::ptrdiff_t>(i));
  });
}

/// The last of the list, which has grown.
template <class Item>
void choose_last(const Call& c, StudyList list, const std::vector<Item>& items) {
  choose(c.session.study, list, ssize(items) - 1);
}

void add_items(Commands& commands) {
  commands.add_edit({"study.add_conditions", "Add conditions", "a condition for each method of the takes"},
                    [](Call& c) {
                      US_CHECK(!c.document.takes.empty(), "no take is open");
                      add_conditions_of_takes(open_study(c), c.document);
                      choose_last(c, StudyList::Condition, open_study(c).conditions);
                    });
  commands.add_edit({"study.add_files", "Add imported animations", "PATH ...: one condition of all of them"},
                    [](Call& c) {
                      add_condition_of_files(open_study(c), paths_from(c, 0));
                      choose_last(c, StudyList::Condition, open_study(c).conditions);
                    });
  commands.add_edit({"study.add_motion", "Add motion", "[PATH ...]: the source that is open, or files"},
                    [](Call& c) {
                      Study& study = open_study(c);
                      if (c.arguments.empty()) add_motion_of_source(study, c.session);
                      for (const std::string& path : paths_from(c, 0)) add_motion_of_file(study, path);
                      choose_last(c, StudyList::Motion, open_study(c).motions);
                    });
  commands.add_edit({"study.add_blends", "Add steps of the blend",
                     "COUNT: as many motions, from the first of what is blended to the last"},
                    [](Call& c) {
                      add_blends(open_study(c), c.session, c.number<int>(0, "count"));
                      choose_last(c, StudyList::Motion, open_study(c).motions);
                    });
  commands.add_edit({"study.add_target", "Add target", "[PATH ...]: those of the takes, or files"},
                    [](Call& c) {
                      Study& study = open_study(c);
                      US_CHECK(!c.arguments.empty() || !c.document.takes.empty(), "no take is open");
                      if (c.arguments.empty()) add_targets_of_takes(study, c.document);
                      for (const std::string& path : paths_from(c, 0)) add_target_of_file(study, path);
                      choose_last(c, StudyList::Target, open_study(c).targets);
                    });
  commands.add_edit({"study.add_question", "Add question", "likert|choice|attention"}, [](Call& c) {
    add_question(open_study(c), c.choice<QuestionKind>(0, "kind", kQuestionKindNames));
    choose_last(c, StudyList::Question, open_study(c).questions);
  });
}

void add_design(Commands& commands) {
  commands.add_slider(
      {"study.set", "Change study",
       "SETTING VALUE ...: as in the file, as in study.set questions.0.points 5; none: no value"},
      set_value);
  commands.add_edit({"study.camera", "See as in the view", "the angles and light of the active view"},
                    [](Call& c) { see_as_in_view(open_study(c), c.session.view); });
  commands.add({"study.participant", "Trials of a participant", "[NAME]: in whose order they are listed"},
               [](Call& c) {
                 open_study(c);
                 c.session.study.participant = c.arguments.empty() ? "" : c.arguments[0];
                 follow_design(c.session.study);
               });
  commands.add({"study.choose", "Choose in study", "condition|motion|target|question|trial NUMBER: from 0"},
               [](Call& c) {
                 open_study(c);
                 const auto list = c.choice<StudyList>(0, "list", kStudyListNames);
                 choose(c.session.study, list, static_cast<std::ptrdiff_t>(place_argument(c, 1)));
               });
}

/// A job: lengths are known only when the files have been opened.
void export_trials(Call& c) {
  const TrialFormat& format = trial_format(c.word(0, "format"));
  const std::string path = c.path(1);
  const Study& study = open_study(c);
  US_CHECK(c.session.study.problem.empty(), c.session.study.problem);
  check_writable(path);
  c.studio.jobs().start(
      "Exporting " + file_name(path),
      [study, trials = c.session.study.trials, path, &format](JobControl&) {
        check_files(study);
        check_lengths(study);
        write_file(path, format.text(study, trials));
      },
      [&studio = c.studio, path] { studio.notify("Exported " + file_name(path), false, showing(path)); });
  remember_folder(c.studio, path);
}

/// The folder itself, or that of a file in it.
std::string folder_argument(const Call& c, size_t i) {
  const std::string path = c.path(i);
  std::error_code failed;
  return fs::is_regular_file(path, failed) ? fs::path(path).parent_path().string() : path;
}

void analyse_answers(Call& c) {
  const Study& study = open_study(c);
  US_CHECK(c.session.study.problem.empty(), c.session.study.problem);
  const std::string answers = folder_argument(c, 0);
  const std::string page = c.arguments.size() > 1 ? c.path(1) : answers + " report";
  const std::string& file = c.session.study.path;
  const std::string folder = file.empty() ? "" : folder_of_file(file);
  const auto outcome = std::make_shared<std::string>();
  c.studio.jobs().start(
      "Analysing " + file_name(answers),
      [study, answers, page, outcome, folder](JobControl&) {
        const AnalysisOptions options = analysis_options(study);
        const StudyReport report = analyse(counted_answers(read_answers(answers), study, folder), options);
        write_page(page, report);
        *outcome = printed("Analysed %d of %zu participants", report.analysed, report.participants.size());
      },
      [&studio = c.studio, page, outcome] {
        const std::string index = page + "/index.html";
        studio.notify(*outcome, false, Offer{"Open the report", join_line("file.open", {index}), true});
      });
  remember_folder(c.studio, answers);
}

void add_outputs(Commands& commands) {
  std::string formats;
  for (const TrialFormat& format : trial_formats()) append_item(formats, format.name, "|");
  commands.add({"study.export", "Export trials", formats + " PATH: in the order in which they are listed"},
               export_trials);
  commands.add({"study.analyse", "Analyse answers",
                "ANSWERS [FOLDER]: a folder of CSV files; the report's folder, beside it by default"},
               analyse_answers);
}

}  // namespace

bool no_unsaved_study(Studio& studio, const std::string& then) {
  Session& session = studio.session();
  if (!session.study.study || !session.study.changed) return true;
  const std::string name =
      session.study.path.empty() ? "the study " + session.study.study->name : file_name(session.study.path);
  session.question = Question{Question::Kind::UnsavedStudy, "Save the changes to " + name + "?", then};
  return false;
}

void save_study(Studio& studio, const std::string& path) {
  StudyState& state = studio.session().study;
  US_CHECK(state.study, "no study is open");
  const std::string whole = fs::absolute(path).lexically_normal().string();
  write_draft(whole, *state.study);
  state.folders[whole] = state.folders[state.path];
  if (state.path.empty()) state.folders.erase(state.path);
  state.path = whole;
  state.changed = false;
  remember(studio.session().settings.recent_studies, whole);
  remember_folder(studio, whole);
  studio.notify("Saved " + file_name(whole) + (state.problem.empty() ? "" : ", which cannot be run yet"));
}

void add_study_commands(Commands& commands) {
  add_files(commands);
  add_lists(commands);
  add_items(commands);
  add_condition_files(commands);
  add_design(commands);
  add_outputs(commands);
  add_study_showing(commands);
}

}  // namespace understudy::app
