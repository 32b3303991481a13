#include "ui/panels/dialogs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

void draw_unsaved(const app::Session& session, PanelContext& context, FilesState& files) {
  QuestionWords question;
  question.title = "Unsaved changes";
  question.sentence = session.question->text.empty() ? "Save the changes first?" : session.question->text;
  const bool is_study = session.question->kind == app::Question::Kind::UnsavedStudy;
  const bool is_new = (is_study ? session.study.path : session.path).empty();
  question.yes = is_new ? "Save\u2026" : "Save", question.no = "Don't save";
  const Answer answer = ask(context.ui, "unsaved", question);
  if (answer == Answer::None) return;
  if (answer == Answer::Yes && is_new)
    return choose_file(session, files, is_study ? FilePurpose::SaveStudy : FilePurpose::SaveDocument);
  const char* const word = answer == Answer::Yes ? "save" : answer == Answer::No ? "discard" : "cancel";
  context.ask("question.answer", {word});
}

void draw_recover(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "recover", "Unsaved work", 480)) return;
  paragraph(session.question->text);
  for (size_t i = 0; i < session.question->autosaves.size(); ++i) {
    const app::Autosave& copy = session.question->autosaves[i];
    const std::string what = copy.document_path.empty() ? "Never saved" : file_name(copy.document_path);
    text_cut(ui, what + ", " + copy.time);
    ButtonRow buttons(2);
    ButtonOptions recover;
    recover.look = i == 0 ? ButtonLook::Main : ButtonLook::Plain;
    if (buttons.add(ui, "recover." + std::to_string(i), "Recover", recover))
      context.ask("document.recover", {copy.file});
    ButtonOptions discard;
    discard.tooltip = "Deletes this work permanently";
    if (buttons.add(ui, "discard." + std::to_string(i), "Discard", discard))
      context.ask("document.discard_recovery", {copy.file});
  }
  ButtonOptions later;
  later.look = ButtonLook::Quiet, later.width = -1,
  later.tooltip = "Keeps it and asks again at the next start";
  if (!finish_dialog(!button(ui, "recover.later", "Decide later", later)))
    context.ask("question.answer", {"cancel"});
}

void draw_missing(const app::Session& session, PanelContext& context, FilesState& files) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "missing", "Files are missing", 520)) return;
  paragraph(session.question->text);
  for (size_t i = 0; i < session.question->missing.size(); ++i) {
    const std::string& path = session.question->missing[i];
    const IdScope id(i);
    const float width = ui.px(80);
    ImGui::AlignTextToFramePadding();
    text_cut(ui, path, ImGui::GetContentRegionAvail().x - width - ui.px(10));
    ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width);
    ButtonOptions find;
    find.width = width;
    if (button(ui, "missing." + std::to_string(i), "Find\u2026", find))
      choose_file(session, files, FilePurpose::Relocate, path);
  }
  ButtonOptions leave;
  leave.look = ButtonLook::Quiet, leave.width = -1,
  leave.tooltip = "Opens the document with the files that are there";
  const bool stays = finish_dialog(!button(ui, "missing.leave", "Continue without them", leave));
  if (!stays) context.ask("question.answer", {"cancel"});
}

void draw_paint(const app::Session& session, PanelContext& context) {
  const size_t k = static_cast<size_t>(session.question->take);
  const auto& takes = session.document.takes;
  const bool known =
      k < takes.size() && takes[k].target_edits.weights && takes[k].target_edits.weights->places.rows() > 0;
  QuestionWords question;
  question.title = "Painted weights do not fit";
  question.sentence = session.question->text;
  question.yes = known ? "Transfer them" : "Drop them", question.no = known ? "Drop them" : "";
  question.cancel = "Decide later", question.dangerous = !known;
  const Answer answer = ask(context.ui, "paint", question);
  if (answer == Answer::None) return;
  context.ask("question.answer", {"cancel"});
  if (answer == Answer::Cancel) return;
  const bool project = known && answer == Answer::Yes;
  context.ask(project ? "edit.weights_reproject" : "edit.weights_clear", {std::to_string(k)});
}

/// The target is used, or taken back.
void draw_not_a_person(const app::Session& session, PanelContext& context) {
  QuestionWords question;
  question.title = "This may not be a person";
  question.sentence = session.question->text;
  question.yes = "Use anyway";
  const Answer answer = ask(context.ui, "person", question);
  if (answer == Answer::Yes) context.ask("target.use_anyway", {std::to_string(session.question->take)});
  if (answer == Answer::Cancel) context.ask("question.answer", {"cancel"});
}

/// Of pictures and films.
constexpr std::array<std::pair<Canvas, const char*>, 6> kPictureSizes = {{{{1920, 1080}, "1080p"},
                                                                          {{1280, 720}, "720p"},
                                                                          {{1080, 1920}, "1080p, tall"},
                                                                          {{720, 1280}, "720p, tall"},
                                                                          {{640, 480}, "VGA"},
                                                                          {{3840, 2160}, "4K"}}};

void draw_canvas_rows(Ui& ui, Canvas& canvas) {
  std::vector<std::string> labels;
  int chosen = -1;
  for (const auto& [size, words] : kPictureSizes) {
    if (size == canvas) chosen = static_cast<int>(labels.size());
    labels.push_back(canvas_text(size) + "   " + words);
  }
  row(ui, "Size", "Of the picture or the film in which the points were found");
  if (dropdown(ui, "canvas.size", labels, chosen)) canvas = kPictureSizes[static_cast<size_t>(chosen)].first;
  const auto side = [](double pixels) { return static_cast<int>(std::clamp(pixels, 1.0, 65536.0)); };
  if (const auto w = typed_number_row(ui, {"canvas.width", "Width", "Pixels"}, canvas.width, 0))
    canvas.width = side(*w);
  if (const auto h = typed_number_row(ui, {"canvas.height", "Height", "Pixels"}, canvas.height, 0))
    canvas.height = side(*h);
}

void draw_canvas_question(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "canvas", "How large is the picture?", 420)) return;
  paragraph(session.question->text);
  Canvas& canvas = ui.state<Canvas>(ImGui::GetID("##canvas"));
  if (!canvas.is_known()) canvas = kPictureSizes[0].first;
  draw_canvas_rows(ui, canvas);
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions open;
  open.look = ButtonLook::Main;
  const bool cancels = buttons.add(ui, "canvas.cancel", "Cancel", {});
  const bool opens = buttons.add(ui, "canvas.open", "Open", open);
  if (finish_dialog(!cancels && !opens)) return;
  context.ask("question.answer", {opens ? "discard" : "cancel"});
  if (!opens) return;
  app::Arguments words = app::split_line(session.question->then);
  const std::string command = words.front();
  words.erase(words.begin());
  words.push_back(std::to_string(canvas.width) + "x" + std::to_string(canvas.height));
  context.ask(command, words);
}

void draw_method_rows(app::Method& method, Ui& ui) {
  method_row(ui, {"compare.engine", "Transfer"}, engines(), method.engine);
  method_row(ui, {"compare.extractor", "Extractor"}, extractors(), method.extractor);
  toggle_row(ui, {"compare.offsets", "Offsets", app::kOffsetsExplanation}, method.offsets);
  int path = static_cast<int>(method.path);
  if (choice_row(ui, {"compare.path", "Path", app::kPathExplanation, "", path_tips()},
                 {"Scaled", "Original", "In place"}, path))
    method.path = static_cast<RootMode>(path);
}

/// The settings in which `other` differs from `base`, as arguments of compare.add.
app::Arguments differences(const app::Method& base, const app::Method& other) {
  app::Arguments settings;
  if (base.engine != other.engine) settings.push_back("engine=" + other.engine);
  if (base.extractor != other.extractor) settings.push_back("extractor=" + other.extractor);
  if (base.offsets != other.offsets) settings.push_back("offsets=" + on_off(other.offsets));
  if (base.path != other.path)
    settings.push_back(std::string("path=") + kRootNames[static_cast<int>(other.path)]);
  return settings;
}

/// The same of how 2D poses are performed.
app::Arguments draw_flat_rows(const app::FlatTake& base, app::FlatTake& other, Ui& ui) {
  int place = static_cast<int>(other.place);
  if (choice_row(ui, {"compare.place", "Stands", "Where the result begins"}, {"On the reference", "In place"},
                 place))
    other.place = static_cast<FlatPlace>(place);
  toggle_row(ui, {"compare.touches", "Touches", "Hands that touch the body or each other keep touching"},
             other.touches);
  toggle_row(ui, {"compare.growth", "Grows", "Who comes nearer grows"}, other.growth);
  if (flat_engines().size() > 1) method_row(ui, {"compare.engine", "Engine"}, flat_engines(), other.engine);
  app::Arguments settings;
  if (base.engine != other.engine) settings.push_back("engine=" + other.engine);
  if (base.growth != other.growth) settings.push_back("growth=" + on_off(other.growth));
  if (base.place != other.place)
    settings.push_back(std::string("place=") + kFlatPlaceNames[static_cast<size_t>(other.place)]);
  if (base.touches != other.touches) settings.push_back("touches=" + on_off(other.touches));
  return settings;
}

void draw_scale(const app::Settings& settings, PanelContext& context) {
  constexpr float kScales[] = {0, 0.75f, 1, 1.25f, 1.5f, 2, 2.5f, 3};
  std::vector<std::string> labels;
  int chosen = -1;
  for (const float scale : kScales) {
    if (scale == settings.scale) chosen = labels.size();
    labels.push_back(scale == 0 ? "Automatic" : std::to_string(std::lround(100 * scale)) + " %");
  }
  row(context.ui, "Scale", "Size of text and controls");
  if (dropdown(context.ui, "settings.scale", labels, chosen))
    context.ask("settings.scale", {chosen == 0 ? "auto" : argument(kScales[chosen])});
}

void draw_settings_rows(const app::Settings& settings, PanelContext& context) {
  Ui& ui = context.ui;
  ask_choice(context, {"settings.theme", "Theme"}, {"Dark", "Light"}, {"dark", "light"},
             settings.dark ? "dark" : "light");
  draw_scale(settings, context);
  ask_choice(context, {"settings.samples", "Antialiasing", "Samples per pixel; fewer are faster"},
             {"Off", "2", "4"}, {"1", "2", "4"},
             settings.samples >= 4   ? "4"
             : settings.samples >= 2 ? "2"
                                     : "1");
  ask_number(context, {"settings.mouse", "Mouse", "How fast the views turn when you drag"},
             settings.mouse_sensitivity, {0.2f, 4, 0.01f, "%.2f \u00d7", 1, true});
  if (const auto mb = typed_number_row(
          ui, {"settings.cache", "Frame cache, MB", "Memory for frames that were already shown"},
          settings.cache_mb, 0))
    context.ask("settings.cache_mb", {argument(std::round(*mb))});
  if (const auto s = typed_number_row(
          ui, {"settings.autosave", "Autosave, s", "How often unsaved work is saved for recovery"},
          settings.autosave_s, 0))
    context.ask("settings.autosave_s", {argument(*s)});
  if (const auto n = typed_number_row(ui,
                                      {"settings.undo_depth", "Undo steps",
                                       "How many steps can be undone; takes effect at the next start"},
                                      settings.undo_depth, 0))
    context.ask("settings.undo_depth", {argument(std::round(*n))});
}

}  // namespace

bool finish_dialog(bool stays) {
  const bool escape =
      !ImGui::IsWindowAppearing() && !ImGui::GetIO().WantTextInput && key_pressed(render::Key::Escape, false);
  if (escape) stays = false;
  if (!stays) ImGui::CloseCurrentPopup();
  end_dialog();
  return stays;
}

bool draw_error(const app::Session& session, PanelContext& context) {
  if (session.errors.empty()) return false;
  const app::Notice& error = session.errors.front();
  if (show_error(context.ui, "error", error.text, error.details)) context.ask("error.dismiss");
  return true;
}

void draw_question(const app::Session& session, PanelContext& context, FilesState& files) {
  using Kind = app::Question::Kind;
  switch (session.question->kind) {
    case Kind::Recover:
      return draw_recover(session, context);
    case Kind::MissingFiles:
      return draw_missing(session, context, files);
    case Kind::PaintMisfit:
      return draw_paint(session, context);
    case Kind::NotAPerson:
      return draw_not_a_person(session, context);
    case Kind::Canvas:
      return draw_canvas_question(session, context);
    default:
      return draw_unsaved(session, context, files);
  }
}

void draw_notices(const app::Session& session, PanelContext& context, NoticesState& state, const Rect& over) {
  constexpr std::ptrdiff_t kMost = 3;
  const auto& all = session.notices;
  std::vector<app::Notice> shown(all.end() - std::min(kMost, ssize(all)), all.end());
  const auto is_held = [&](const app::Notice& notice) { return state.held && notice.id == state.held->id; };
  const bool is_over = state.held && session.time > state.held->until;
  if (is_over && std::none_of(shown.begin(), shown.end(), is_held)) shown.insert(shown.begin(), *state.held);
  std::vector<Toast> toasts;
  toasts.reserve(shown.size());
  for (const app::Notice& notice : shown)
    toasts.push_back({notice.text,
                      notice.kind == app::Notice::Kind::Info ? NoticeKind::Good : NoticeKind::Warning,
                      notice.offer.label, notice.also.label});
  const Mark* const legend = context.ui.find("view.legend");
  const ToastUse use = draw_toasts(context.ui, toasts, over, legend != nullptr ? legend->rect : Rect());
  state.held.reset();
  const int answered = std::max({use.clicked, use.offered, use.also});
  if (answered >= 0) context.ask("notice.dismiss", {std::to_string(shown[answered].id)});
  if (use.offered >= 0) push(context, {shown[use.offered].offer.command, ""});
  if (use.also >= 0) push(context, {shown[use.also].also.command, ""});
  if (answered < 0 && use.hovered >= 0) state.held = shown[use.hovered];
}

bool draw_about(PanelContext& context, const std::string& about) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "about", "Understudy", 520)) return true;
  ImGui::BeginChild("##about", {0, std::min(ui.px(280), ImGui::GetIO().DisplaySize.y * 0.5f)});
  paragraph(about);
  ImGui::EndChild();
  ButtonRow buttons(2);
  ButtonOptions close;
  close.look = ButtonLook::Main;
  if (buttons.add(ui, "about.copy", "Copy", {})) ImGui::SetClipboardText(about.c_str());
  return finish_dialog(!buttons.add(ui, "about.close", "Close", close));
}

bool draw_compare(const app::Session& session, PanelContext& context, CompareState& state) {
  Ui& ui = context.ui;
  const app::Take* take = selected_take(session);
  if (take == nullptr) return false;
  if (!begin_dialog(ui, "compare", "Compare with", 420)) return true;
  if (!state.method) state.method = take->method, state.flat = take->flat;
  hint(ui, "A second take of " + take->name + ", made like this:");
  app::Arguments arguments;
  if (take->flat && state.flat) {
    arguments = draw_flat_rows(*take->flat, *state.flat, ui);
  } else {
    draw_method_rows(*state.method, ui);
    arguments = differences(take->method, *state.method);
  }
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions apply;
  apply.look = ButtonLook::Main;
  apply.disabled = arguments.empty();
  apply.tooltip = arguments.empty() ? "Choose something else first: this is how it is made now" : "";
  bool stays = !buttons.add(ui, "compare.cancel", "Cancel", {});
  if (buttons.add(ui, "compare.apply", "Compare", apply)) {
    arguments.insert(arguments.begin(), std::to_string(session.selected_take));
    context.ask("compare.add", arguments);
    stays = false;
  }
  stays = finish_dialog(stays);
  if (!stays) state = {};
  return stays;
}

bool draw_settings(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!begin_dialog(ui, "settings", "Settings", 440)) return true;
  draw_settings_rows(session.settings, context);
  ImGui::Dummy({0, ui.px(4)});
  ButtonOptions close;
  close.look = ButtonLook::Main, close.width = -1;
  return finish_dialog(!button(ui, "settings.close", "Close", close));
}

}  // namespace understudy::ui
