#include "ui/panels/teach_style.hpp"

#include <algorithm>
#include <array>

#include "app/session/taught_styles.hpp"
#include "retarget/base/text.hpp"
#include "ui/panels/dialogs.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

struct TaughtJoints {
  const char *name, *label, *explanation;
};
constexpr std::array<TaughtJoints, 3> kTaughtJoints = {
    {{"all", "All", "For motion capture and other clean recordings. Ankles and toes stay the source's."},
     {"trunk-and-limbs", "Trunk and limbs", "Wrists stay the source's, too: a depth camera sees them badly."},
     {"upper-body", "Upper body", "Legs stay the source's: for recordings of people who stand."}}};

void draw_folder_rows(const app::Session& session, Ui& ui, TeachState& state, FilesState& files) {
  const auto browse = [&](bool to) {
    state.browses_to = to;
    choose_file(session, files, FilePurpose::Folder, to ? state.to : state.from);
  };
  const std::string holds = "A folder of motions (BVH, NPZ, glTF ...) or of folders of scans, two at least";
  if (folder_row(ui, {"teach_style.from", "How they move now", holds}, "folder of recordings", state.from))
    browse(false);
  if (folder_row(ui, {"teach_style.to", "How they shall move", holds}, "folder of recordings", state.to))
    browse(true);
}

void draw_choices(Ui& ui, TeachState& state) {
  row(ui, "Name", "What lists call it: letters, digits, blanks, - and _");
  text_field(ui, "teach_style.name", state.name);
  row(ui, "Licence", "Of the recordings: it is written into the style and into what is exported in it");
  text_field(ui, "teach_style.licence", state.licence, "needed");
  std::vector<std::string> labels, tips;
  for (const TaughtJoints& one : kTaughtJoints) labels.push_back(one.label), tips.push_back(one.explanation);
  row(ui, "Joints", "Which joints move in the style");
  dropdown(ui, "teach_style.joints", labels, state.joints, tips);
  hint(ui, kTaughtJoints[static_cast<size_t>(state.joints)].explanation);
}

/// Why it cannot be taught yet; empty: it can.
std::string missing_yet(const TeachState& state, bool exists) {
  if (state.from.empty() || state.to.empty()) return "Choose both folders first";
  if (state.name.empty()) return "The style needs a name first";
  if (state.licence.empty()) return "Say first under which licence the recordings are";
  if (exists && !state.replace) return "There is a style of that name already";
  return state.problem;
}

/// There is a style of that name already.
void draw_taken(PanelContext& context, TeachState& state) {
  Ui& ui = context.ui;
  toggle_row(ui, {"teach_style.replace", "Replace", "The style of that name is taught anew"}, state.replace);
  row(ui, "");
  ButtonOptions forget;
  forget.look = ButtonLook::Danger, forget.width = -1;
  forget.tooltip = "Removes the style of that name from this machine for good";
  if (button(ui, "teach_style.forget", "Forget it", forget)) context.ask("style.forget", {state.name});
}

/// What is wrong with the name, or that it is taken. Whether it is.
bool draw_name_check(const app::Session& session, PanelContext& context, TeachState& state) {
  Ui& ui = context.ui;
  if (state.checked != state.name) {
    state.checked = state.name, state.replace = false;
    state.problem = state.name.empty() ? "" : app::why_no_style_name(state.name);
  }
  if (!state.problem.empty()) {
    warning_sentence(ui, "Not yet: " + state.problem + ".");
    ui.mark("teach_style.problem");
  }
  const auto& taught = session.styles.taught;
  const bool exists = std::any_of(taught.begin(), taught.end(),
                                  [&](const auto& style) { return style.note.name == state.name; });
  if (exists) draw_taken(context, state);
  return exists;
}

void draw_words(const app::Session& session, Ui& ui) {
  const app::Take* const take = selected_take(session);
  hint(ui, "The style is kept on this machine" +
               (take == nullptr ? std::string(".") : ", and " + take->name + " gets it."));
  hint(ui, "Recordings of children need their parents' consent and, in a form fit for their age, their own.");
  ui.mark("teach_style.consent");
}

app::Arguments lesson_of(const TeachState& state) {
  app::Arguments arguments = {state.from, state.to, state.name, "licence=" + state.licence};
  if (state.joints != 0)
    arguments.push_back(std::string("joints=") + kTaughtJoints[static_cast<size_t>(state.joints)].name);
  if (state.replace) arguments.push_back("replace=1");
  return arguments;
}

}  // namespace

void choose_manner_folder(TeachState& state, const std::string& path) {
  (state.browses_to ? state.to : state.from) = folder_of_choice(path);
}

bool teaching_failed(const app::Session& session, TeachState& state) {
  const auto is_it = [&](const app::Notice& error) { return error.details == state.asked; };
  if (state.asked.empty() || std::none_of(session.errors.begin(), session.errors.end(), is_it)) return false;
  state.asked.clear();
  return true;
}

bool draw_teach_style(const app::Session& session, PanelContext& context, TeachState& state,
                      FilesState& files) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "teach_style", "Teach a style", 480)) return true;
  hint(ui,
       "Fits a style to recordings of two manners of moving, some of each: what is done, and by whom, may "
       "differ. It takes seconds, with many scans minutes.");
  draw_folder_rows(session, ui, state, files);
  draw_choices(ui, state);
  const std::string missing = missing_yet(state, draw_name_check(session, context, state));
  draw_words(session, ui);
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions apply;
  apply.look = ButtonLook::Main, apply.disabled = !missing.empty(), apply.tooltip = missing;
  bool stays = !buttons.add(ui, "teach_style.cancel", "Cancel", {});
  if (buttons.add(ui, "teach_style.apply", "Teach", apply)) {
    const app::Arguments arguments = lesson_of(state);
    state.asked = app::join_line("style.teach", arguments), state.replace = false;
    context.ask("style.teach", arguments);
    stays = false;
  }
  return finish_dialog(stays);
}

}  // namespace understudy::ui
