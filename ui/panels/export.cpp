#include "ui/panels/export.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/dialogs.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace fs = std::filesystem;
namespace {

struct Size {
  const char* label;
  int width, height;
};
constexpr std::array<Size, 5> kSizes = {{{"1280 x 720", 1280, 720},
                                         {"1920 x 1080", 1920, 1080},
                                         {"3840 x 2160", 3840, 2160},
                                         {"1080 x 1080", 1080, 1080},
                                         {"1080 x 1920", 1080, 1920}}};
constexpr int kLargest = 16384;

/// Null: the figures.
const app::ExportFormat* format_of(const ExportState& state) {
  const auto& formats = app::export_formats();
  const bool is_motion = state.format >= 0 && state.format < ssize(formats);
  return is_motion ? &formats[state.format] : nullptr;
}

/// A name that any file system takes.
std::string safe_name(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 32 || std::string("/\\:*?\"<>|").find(c) != std::string::npos)
      c = '_';
  return name.empty() ? "take" : name;
}

/// Of the file; "" for a folder.
std::string suffix_of(const ExportState& state) {
  if (state.kind == ExportKind::Animation) {
    const app::ExportFormat* const format = format_of(state);
    return format != nullptr ? format->suffix : ".csv";
  }
  return state.kind == ExportKind::Picture ? ".png" : state.as_pictures ? "" : ".mp4";
}

/// Of a name without one: the document's, or the one used last.
fs::path usual_folder(const app::Session& session) {
  const fs::path folder =
      session.path.empty() ? fs::path(session.settings.last_folder) : fs::path(session.path).parent_path();
  return folder.empty() ? fs::current_path() : folder;
}

/// "dance.glb" in the usual folder.
std::string proposed_path(const app::Session& session, const ExportState& state) {
  const app::Take* take = selected_take(session);
  std::string name = take != nullptr ? take->name : session.source.name;
  if (state.kind != ExportKind::Animation && !session.path.empty())
    name = fs::path(session.path).stem().string();
  return (usual_folder(session) / (safe_name(name) + suffix_of(state))).string();
}

/// What was typed as a whole path: in the usual folder where it names none, with the suffix where that is missing; in
/// a folder that is there, the name proposed.
std::string whole_path(const app::Session& session, const ExportState& state, const std::string& typed) {
  const std::string suffix = suffix_of(state);
  fs::path path = (usual_folder(session) / typed).lexically_normal();
  std::error_code ignored;
  if (!path.has_filename() || (!suffix.empty() && fs::is_directory(path, ignored)))
    path /= fs::path(proposed_path(session, state)).filename();
  if (!suffix.empty() && file_suffix(path.string()) != suffix) path += suffix;
  return path.string();
}

/// After a choice that changes the suffix of the file.
void follow_suffix(ExportState& state, const std::string& before) {
  if (!state.typed) return;
  fs::path path = state.path;
  if (!before.empty() && file_suffix(state.path) == before) path.replace_extension();
  state.path = path.string() + suffix_of(state);
}

void draw_format(Ui& ui, ExportState& state) {
  std::vector<std::string> labels;
  for (const app::ExportFormat& info : app::export_formats()) labels.push_back(info.label);
  labels.push_back("Figures");
  const std::string before = suffix_of(state);
  if (choice_row(ui, {"export.format", "Format"}, labels, state.format)) follow_suffix(state, before);
}

/// What only an animated character has.
void draw_character_rows(Ui& ui, const app::TakeState& take, bool on_own_bones, ExportState& state) {
  CharacterExportOptions& file = state.choice.file;
  int rig = state.choice.theirs.value_or(true) ? 0 : 1, many = file.influences == 8 ? 1 : 0;
  if (on_own_bones)
    if (choice_row(ui, {"export.rig", "Skeleton", "Which bones the file animates"}, {"Its own", "22 joints"},
                   rig))
      state.choice.theirs = rig == 0;
  if (choice_row(ui, {"export.influences", "Bones a vertex", "Older engines read only four"}, {"4", "8"},
                 many))
    file.influences = many == 1 ? 8 : 4;
  constexpr std::array<int, 4> kShapes = {0, 4, 8, 16};
  int shapes = static_cast<int>(std::find(kShapes.begin(), kShapes.end(), file.shapes) - kShapes.begin());
  if (choice_row(
          ui, {"export.morphs", "Morph targets", "Deformations that bones alone cannot make; the file grows"},
          {"None", "4", "8", "16"}, shapes))
    file.shapes = kShapes[shapes];
  if (const auto mm = typed_number_row(ui,
                                       {"export.reduce", "Leave out keys, mm",
                                        "Removes keys that move no vertex further than this; 0 keeps all"},
                                       static_cast<double>(file.reduce_mm), 1))
    file.reduce_mm = static_cast<float>(std::clamp(*mm, 0.0, 1000.0));
  toggle_row(ui, {"export.t_pose", "T-pose first", "Adds the T-pose as its own clip"}, file.t_pose_clip);
  if (!on_own_bones || !take.character || take.character->character.animations.empty()) return;
  toggle_row(ui, {"export.keep_clips", "Its own clips", "Keeps the file's own clips, after ours"},
             file.keep_clips);
}

/// The takes that go into the file, one clip each.
std::vector<size_t> clips_of(const app::Session& session, const ExportState& state) {
  const size_t selected = session.selected_take;
  const app::ExportFormat* const format = format_of(state);
  if (!state.all_takes || format == nullptr || !format->is_character ||
      selected >= session.document.takes.size())
    return {selected};
  std::vector<size_t> takes;
  for (const size_t k : takes_of_one_body(session.document, selected))
    if (state.left_out.count(k) == 0) takes.push_back(k);
  return takes;
}

/// A take's name in commands; its number where several are called like it.
std::string word_for_take(const app::Document& document, size_t k) {
  const std::string& name = document.takes[k].name;
  const auto called = [&](const app::Take& take) { return take.name == name; };
  const bool is_clear = std::count_if(document.takes.begin(), document.takes.end(), called) == 1;
  return is_clear && !name.empty() ? name : std::to_string(k);
}

std::string frames_words(const app::Session& session, size_t k) {
  if (k >= session.takes.size()) return "";
  const int made = session.takes[k].shown.poses.size();
  const auto frames = kept_frames(session.document.takes[k].pose_edits, made).size();
  return grouped(static_cast<int64_t>(frames)) + " frames";
}

void draw_clip_rows(const app::Session& session, Ui& ui, ExportState& state) {
  const auto takes = takes_of_one_body(session.document, session.selected_take);
  if (takes.size() < 2) return;
  toggle_row(
      ui, {"export.all_takes", "All takes as clips", "All takes of this target in one file, one clip each"},
      state.all_takes);
  if (!state.all_takes) return;
  for (const size_t k : takes) {
    bool in_file = state.left_out.count(k) == 0;
    const std::string words = session.document.takes[k].name + "  \u00b7  " + frames_words(session, k);
    ImGui::Indent(ui.px(16));
    const std::string seen = cut_to(words, ImGui::GetContentRegionAvail().x - ui.px(44));
    const bool changed = toggle(ui, "export.clip." + std::to_string(k), seen, in_file);
    if (seen != words) tooltip(ui, words);
    ImGui::Unindent(ui.px(16));
    if (!changed) continue;
    if (in_file)
      state.left_out.erase(k);
    else
      state.left_out.insert(k);
  }
}

void draw_animation_rows(const app::Session& session, PanelContext& context, ExportState& state) {
  Ui& ui = context.ui;
  draw_format(ui, state);
  std::vector<std::string> takes;
  for (const app::Take& take : session.document.takes) takes.push_back(take.name);
  int chosen = session.selected_take;
  row(ui, "Take");
  if (dropdown(ui, "export.take", takes, chosen)) context.ask("target.select", {std::to_string(chosen)});
  const app::ExportFormat* const format = format_of(state);
  const app::Take* const take = selected_take(session);
  const app::TakeState* const made = selected_state(session);
  if (format != nullptr && take != nullptr && made != nullptr) {
    const bool own_bones = made->character && on_their_rig(take->target, *made->character);
    if (format->is_character) draw_clip_rows(session, ui, state);
    if (format->is_character) draw_character_rows(ui, *made, own_bones, state);
    toggle_row(ui, {"export.in_place", "In place", "Leaves out the path over the floor"},
               state.choice.file.in_place);
    hint(ui, frames_words(session, session.selected_take) + ", " +
                 figure(frames_per_second(session), "frames/s"));
  }
  hint(ui, format != nullptr ? format->words : "Every figure of every frame, as a table.");
}

/// What is not as it would be anyway.
app::Arguments export_words(const app::ExportFormat& format, const app::ExportChoice& choice) {
  app::Arguments words = {std::string("format=") + format.name};
  const CharacterExportOptions& file = choice.file;
  if (file.in_place) words.push_back("in_place=on");
  if (!format.is_character) return words;
  if (!choice.theirs.value_or(true)) words.push_back("rig=ours");
  if (file.influences == 8) words.push_back("influences=8");
  if (file.shapes > 0) words.push_back("morphs=" + std::to_string(file.shapes));
  if (file.reduce_mm > 0)
    words.push_back("reduce=" + argument(std::round(static_cast<double>(file.reduce_mm) * 10) / 10));
  if (file.t_pose_clip) words.push_back("t_pose=on");
  if (file.keep_clips) words.push_back("keep_clips=on");
  return words;
}

/// Pushes a command, and keeps it to know a failure as its own.
void ask_noted(PanelContext& context, ExportState& state, const std::string& command,
               app::Arguments arguments) {
  state.asked = app::join_line(command, arguments);
  context.ask(command, std::move(arguments));
}

/// Pushes the command that writes it.
void ask_for_export(const app::Session& session, PanelContext& context, ExportState& state) {
  if (state.kind == ExportKind::Animation) {
    const std::vector<size_t> takes = clips_of(session, state);
    if (takes.empty()) return;
    app::Arguments asked = {std::to_string(takes[0]), state.path};
    const app::ExportFormat* const format = format_of(state);
    if (format == nullptr) return ask_noted(context, state, "export.csv", asked);
    for (std::string& word : export_words(*format, state.choice)) asked.push_back(std::move(word));
    for (size_t i = 1; i < takes.size(); ++i)
      asked.push_back("take=" + word_for_take(session.document, takes[i]));
    return ask_noted(context, state, "export.run", asked);
  }
  app::Arguments arguments = {state.path, std::to_string(state.width), std::to_string(state.height)};
  if (state.kind == ExportKind::Picture && state.transparent) arguments.push_back("transparent");
  arguments.push_back(state.all ? "all" : "view");
  ask_noted(context, state, state.kind == ExportKind::Picture ? "picture.save" : "video.save", arguments);
}

void draw_size_rows(Ui& ui, ExportState& state) {
  std::vector<std::string> labels;
  int chosen = -1;
  for (const Size& size : kSizes) {
    if (size.width == state.width && size.height == state.height) chosen = labels.size();
    labels.push_back(size.label);
  }
  if (chosen < 0) chosen = labels.size(), labels.push_back("Another");
  row(ui, "Size");
  if (dropdown(ui, "export.size", labels, chosen) && chosen < ssize(kSizes))
    state.width = kSizes[chosen].width, state.height = kSizes[chosen].height;
  const auto whole = [](double value) { return static_cast<int>(std::clamp(value, 16.0, double{kLargest})); };
  if (const auto w = typed_number_row(ui, {"export.width", "Width", "Pixels"}, state.width, 0))
    state.width = whole(*w);
  if (const auto h = typed_number_row(ui, {"export.height", "Height", "Pixels"}, state.height, 0))
    state.height = whole(*h);
}

/// A film or a folder of pictures.
void draw_film_row(Ui& ui, ExportState& state) {
  const std::string before = suffix_of(state);
  int how = state.as_pictures ? 1 : 0;
  const Control control{"export.as", "As", "One MP4 file, or a folder of PNG pictures"};
  if (!choice_row(ui, control, {"Film", "Pictures"}, how)) return;
  state.as_pictures = how == 1;
  follow_suffix(state, before);
}

void draw_picture_rows(Ui& ui, ExportState& state) {
  draw_size_rows(ui, state);
  int what = state.all ? 0 : 1;
  if (choice_row(ui, {"export.all", "What"}, {"All views", "Active view"}, what)) state.all = what == 0;
  if (state.kind == ExportKind::Picture)
    toggle_row(ui, {"export.transparent", "Transparent", "Leaves out the background"}, state.transparent);
  else
    draw_film_row(ui, state);
}

bool enter_pressed() {
  return key_pressed(render::Key::Enter, false) || key_pressed(render::Key::KeypadEnter, false);
}

struct PathAnswer {
  bool browse = false;  ///< the user wants to
  bool entered = false;
};
/// The path to write, which follows the take until one is typed.
PathAnswer draw_path(const app::Session& session, Ui& ui, ExportState& state) {
  PathAnswer answer;
  if (!state.typed) state.path = proposed_path(session, state);
  row(ui, suffix_of(state).empty() ? "Folder" : "File");
  const float side = ImGui::GetFrameHeight();
  ImGui::BeginChild("##path", {std::max(1.f, ImGui::GetContentRegionAvail().x - side - ui.px(6)), side});
  const auto path = committed_text(ui, "export.path", state.path);
  answer.entered = ImGui::IsItemDeactivated() && enter_pressed();
  ImGui::EndChild();
  if (path) {
    state.typed = !path->empty();
    state.path = state.typed ? whole_path(session, state, *path) : proposed_path(session, state);
  }
  ImGui::SameLine(0, ui.px(6));
  answer.browse = icon_button(ui, "export.browse", Icon::Folder,
                              {"Choose the folder and the name", "", false, false, side / ui.scale()});
  return answer;
}

/// Whether the dialog stays.
bool draw_overwrite(const app::Session& session, PanelContext& context, ExportState& state) {
  QuestionWords question;
  question.title = "Replace the file?";
  question.sentence = file_name(state.path) + " is already there.";
  question.yes = "Replace", question.dangerous = true;
  const Answer answer = ask(context.ui, "export.overwrite", question);
  if (answer == Answer::None) return true;
  state.asking = false;
  if (answer == Answer::Yes) ask_for_export(session, context, state);
  return answer != Answer::Yes;
}

const char* title_of(ExportKind kind) {
  return kind == ExportKind::Animation ? "Export"
         : kind == ExportKind::Picture ? "Save picture"
                                       : "Save video";
}

bool file_is_there(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) || (fs::is_directory(path, error) && !fs::is_empty(path, error));
}

}  // namespace

bool begin_export(const app::Session& session, ExportState& state, const std::string& dialog) {
  constexpr std::pair<const char*, ExportKind> kKinds[] = {{"export", ExportKind::Animation},
                                                           {"csv", ExportKind::Animation},
                                                           {"picture", ExportKind::Picture},
                                                           {"video", ExportKind::Video}};
  const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                 [&](const auto& one) { return dialog == one.first; });
  if (kind == std::end(kKinds)) return false;
  const auto& formats = app::export_formats();
  const std::string last = dialog == "csv" ? "csv" : session.settings.export_format;
  const auto used =
      std::find_if(formats.begin(), formats.end(), [&](const auto& one) { return last == one.name; });
  const bool known = used != formats.end() || last == "csv";  // behind the formats: the figures
  state.kind = kind->second, state.format = known ? static_cast<int>(used - formats.begin()) : 0;
  state.path.clear(), state.agreed.clear(), state.asked.clear(), state.left_out.clear();
  state.typed = state.asking = false;
  return true;
}

void choose_path(ExportState& state, const std::string& path) {
  state.path = state.agreed = path, state.typed = true;
}

bool export_failed(const app::Session& session, ExportState& state) {
  const auto is_it = [&](const app::Notice& error) { return error.details == state.asked; };
  if (state.asked.empty() || std::none_of(session.errors.begin(), session.errors.end(), is_it)) return false;
  state.asked.clear(), state.agreed.clear();
  return true;
}

bool draw_export(const app::Session& session, PanelContext& context, ExportState& state, FilesState& files) {
  Ui& ui = context.ui;
  if (state.asking) return draw_overwrite(session, context, state);
  if (!begin_dialog(ui, "export", title_of(state.kind), 460)) return true;
  if (state.kind == ExportKind::Animation)
    draw_animation_rows(session, context, state);
  else
    draw_picture_rows(ui, state);
  const PathAnswer path = draw_path(session, ui, state);
  if (path.browse) choose_file(session, files, FilePurpose::Export, state.path);
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions save;
  save.look = ButtonLook::Main, save.disabled = state.path.empty() || (state.kind == ExportKind::Animation &&
                                                                       clips_of(session, state).empty());
  bool stays = !buttons.add(ui, "export.cancel", "Cancel", {});
  const bool entered = path.entered || (enter_pressed() && !ImGui::GetIO().WantTextInput);
  if (buttons.add(ui, "export.save", "Save", save) ||
      (entered && !save.disabled && !ImGui::IsWindowAppearing())) {
    state.asking = state.path != state.agreed && file_is_there(state.path);
    if (!state.asking) ask_for_export(session, context, state), stays = false;
  }
  return finish_dialog(stays);
}

}  // namespace understudy::ui
