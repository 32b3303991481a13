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

/// Not at what is still being typed: what stands between may be a whole disk.
void look_at(TaughtFolder& folder) {
  constexpr double kTyped = 0.4;  // seconds without a change
  const double now = ImGui::GetTime();
  if (folder.path != folder.seen) folder.seen = folder.path, folder.seen_since = now;
  if (folder.path == folder.looked_at || now - folder.seen_since < kTyped) return;
  if (!folder.look) folder.look = std::make_unique<app::RecordingsLook>();
  folder.look->look(folder.path);
  folder.looked_at = folder.path;
}

/// One line whatever is known: nothing below it moves under the pointer.
void draw_holds(Ui& ui, const TaughtFolder& folder, const std::string& mark) {
  const bool looks = folder.look && !folder.path.empty() && folder.path == folder.looked_at;
  const app::RecordingsHeld held = looks ? folder.look->held() : app::RecordingsHeld{};
  row(ui, "");
  if (!held.listed)
    return text_cut(ui, folder.path.empty() ? "Two recordings at least" : "Looks into it\u2026");
  const std::string path = folder.path + ": ";
  if (!held.problem.empty())
    text_cut(ui, held.problem.substr(starts_with(held.problem, path) ? path.size() : 0));
  else
    text_cut(ui, held.sentence() + (held.count < 2 ? "; several are needed" : ""));
  ui.mark(mark);
}

/// True when the user wants to choose it.
bool draw_folder(Ui& ui, const Control& control, TaughtFolder& folder) {
  const bool browses = folder_row(ui, control, "folder of recordings", folder.path);
  look_at(folder);
  draw_holds(ui, folder, control.name + ".holds");
  return browses;
}

void draw_folder_rows(const app::Session& session, Ui& ui, TeachState& state, FilesState& files) {
  const auto browse = [&](bool to) {
    state.browses_to = to;
    choose_file(session, files, FilePurpose::Folder, to ? state.to.path : state.from.path);
  };
  const std::string holds = "A folder of motions (BVH, NPZ, glTF ...) or of folders of scans, two at least";
  if (draw_folder(ui, {"teach_style.from", "How they move now", holds}, state.from)) browse(false);
  if (draw_folder(ui, {"teach_style.to", "How they shall move", holds}, state.to)) browse(true);
}

/// The dialog closes: the next time it looks again.
void forget_looks(TeachState& state) {
  for (TaughtFolder* const folder : {&state.from, &state.to}) {
    if (folder->look) folder->look->look("");
    folder->looked_at.clear();
  }
}

void draw_choices(Ui& ui, TeachState& state) {
  row(ui, "Name", "What lists call it: letters, digits, blanks, - and _");
  text_field(ui, "teach_style.name", state.name);
  row(ui, "Licence", "Of the recordings: it is written into the style and into what is exported in it");
  text_field(ui, "teach_style.licence", state.licence, "needed");
  row(ui, "Attribution", "Whom the licence wants named: it is written beside it");
  text_field(ui, "teach_style.attribution", state.attribution, "nobody");
  std::vector<std::string> labels, tips;
  for (const TaughtJoints& one : kTaughtJoints) labels.push_back(one.label), tips.push_back(one.explanation);
  row(ui, "Joints", "Which joints move in the style");
  dropdown(ui, "teach_style.joints", labels, state.joints, tips);
  hint(ui, kTaughtJoints[static_cast<size_t>(state.joints)].explanation);
}

/// Why it cannot be taught yet; empty: it can.
std::string missing_yet(const TeachState& state, bool exists) {
  if (state.from.path.empty() || state.to.path.empty()) return "Choose both folders first";
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
  forget.tooltip = "Removes the style of that name from this machine";
  if (button(ui, "teach_style.forget", "Forget it", forget)) context.ask("style.forget", {state.name});
}

/// The style of that name was forgotten last.
void draw_forgotten(PanelContext& context, const TeachState& state) {
  row(context.ui, "");
  ButtonOptions restore;
  restore.width = -1, restore.tooltip = "The style of that name as it was before it was forgotten";
  if (button(context.ui, "teach_style.restore", "Bring it back", restore))
    context.ask("style.restore", {state.name});
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
  const auto& forgotten = session.styles.forgotten;
  if (exists)
    draw_taken(context, state);
  else if (forgotten && forgotten->name == state.name)
    draw_forgotten(context, state);
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
  app::Arguments arguments = {state.from.path, state.to.path, state.name, "licence=" + state.licence};
  if (!state.attribution.empty()) arguments.push_back("attribution=" + state.attribution);
  if (state.joints != 0)
    arguments.push_back(std::string("joints=") + kTaughtJoints[static_cast<size_t>(state.joints)].name);
  if (state.replace) arguments.push_back("replace=1");
  return arguments;
}

}  // namespace

void choose_manner_folder(TeachState& state, const std::string& path) {
  (state.browses_to ? state.to : state.from).path = folder_of_choice(path);
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
  if (!stays) forget_looks(state);
  return finish_dialog(stays);
}

}  // namespace understudy::ui
