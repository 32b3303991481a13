#include "ui/panels/export.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/run/export_presets.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"
#include "ui/panels/dialogs.hpp"
#include "ui/panels/export_poses.hpp"
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

/// Whether each of several takes gets a file of its own.
bool has_many_files(const app::Session& session, const ExportState& state) {
  return state.kind == ExportKind::Animation && !state.is_flat && state.takes == ExportTakes::Files &&
         session.document.takes.size() > 1;
}

/// Of each file; "" for a folder.
std::string file_suffix_of(const ExportState& state) {
  if (state.kind == ExportKind::Animation) {
    if (state.is_flat) return kFlatSuffixes[static_cast<size_t>(state.flat_as)];
    const app::ExportFormat* const format = format_of(state);
    if (format != nullptr && format->is_pictures && state.as_pictures &&
        format->suffix == std::string(".mp4"))
      return "";
    return format != nullptr ? format->suffix : ".csv";
  }
  return state.kind == ExportKind::Picture ? ".png" : state.as_pictures ? "" : ".mp4";
}

/// Of the path; "" for a folder.
std::string suffix_of(const app::Session& session, const ExportState& state) {
  return has_many_files(session, state) ? "" : file_suffix_of(state);
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
  const bool many = has_many_files(session, state), is_of_take = state.kind == ExportKind::Animation && !many;
  std::string name = take != nullptr && !many ? take->name : fs::path(session.source.name).stem().string();
  if (!is_of_take && !session.path.empty()) name = fs::path(session.path).stem().string();
  if (many) name += name.empty() ? "takes" : " takes";  // nothing else is called so
  const auto path = [&] {
    return (usual_folder(session) / (app::safe_file_name(name) + suffix_of(session, state))).string();
  };
  if (app::is_one_of(path(), files_read_by(session.document)))  // a character's own file is not written over
    name += " " + fs::path(session.source.name).stem().string();
  return path();
}

/// What was typed as a whole path: in the usual folder where it names none, with the suffix where that is
/// missing; in a folder that is there, the name proposed.
std::string whole_path(const app::Session& session, const ExportState& state, const std::string& typed) {
  const std::string suffix = suffix_of(session, state);
  fs::path path = (usual_folder(session) / typed).lexically_normal();
  if (has_many_files(session, state)) return (path.has_filename() ? path : path.parent_path()).string();
  std::error_code ignored;
  if (!path.has_filename() || (!suffix.empty() && fs::is_directory(path, ignored)))
    path /= fs::path(proposed_path(session, state)).filename();
  if (!suffix.empty() && file_suffix(path.string()) != suffix) path += suffix;
  return path.string();
}

/// After a choice that changes the suffix of the path, which was `before`.
void follow_suffix(const app::Session& session, ExportState& state, const std::string& before) {
  const std::string suffix = suffix_of(session, state);
  if (!state.typed || suffix == before) return;
  fs::path path = state.path;
  if (!before.empty() && file_suffix(state.path) == before) path.replace_extension();
  state.path = path.string() + suffix;
}

/// Options that a program reads whole; "Custom" where they are no preset's.
void draw_preset(const app::Session& session, Ui& ui, ExportState& state) {
  const auto& presets = app::export_presets();
  std::vector<std::string> labels, tips;
  for (const app::ExportPreset& preset : presets)
    labels.push_back(preset.label), tips.push_back(preset.words);
  const app::ExportFormat* const format = format_of(state);
  const app::ExportPreset* const now =
      format != nullptr ? app::preset_of(*format, state.choice.file) : nullptr;
  if (now == nullptr) labels.push_back("Custom"), tips.push_back("The options chosen below");
  int chosen = static_cast<int>(now != nullptr ? now - presets.data() : ssize(presets));
  const std::string before = suffix_of(session, state);
  row(ui, "Preset", "What another program reads");
  if (dropdown(ui, "export.preset", labels, chosen, tips)) {
    const app::ExportPreset& preset = presets[chosen];
    app::apply(preset, state.choice.file);
    const app::ExportFormat& wanted = app::export_format(preset.format, "");
    if (format == nullptr || !format->is_character)
      state.format = static_cast<int>(&wanted - app::export_formats().data());
    follow_suffix(session, state, before);
  }
  if (now == nullptr) return;
  hint(ui, now->words);
  ui.mark("export.preset.words");
}

void draw_format(const app::Session& session, Ui& ui, ExportState& state) {
  std::vector<std::string> labels;
  for (const app::ExportFormat& info : app::export_formats()) labels.push_back(info.label);
  labels.push_back("Metrics");
  const std::string before = suffix_of(session, state);
  if (choice_row(ui, {"export.format", "Format"}, labels, state.format))
    follow_suffix(session, state, before);
}

/// Whether the file's bones are the character's own, where it has any.
bool on_own_bones(const app::ExportFormat& format, const ExportState& state) {
  return state.choice.own_bones.value_or(format.is_character);
}

/// Whether a take that is exported performs on bones of its own.
bool has_own_bones(const app::Session& session, const ExportState& state) {
  for (size_t k = 0; k < session.takes.size(); ++k) {
    const bool counts = has_many_files(session, state) || static_cast<int>(k) == session.selected_take;
    const auto& character = session.takes[k].character;
    if (counts && character && on_their_rig(session.document.takes[k].target, *character)) return true;
  }
  return false;
}

void draw_bone_choice(Ui& ui, const app::ExportFormat& format, ExportState& state) {
  int bones = on_own_bones(format, state) ? 0 : 1;
  const Control control{"export.bones",
                        "Bones",
                        "The bones that the file animates",
                        "",
                        {"The character's own, with their names, from its own rest pose",
                         "The 22 joints of this program, from the T-pose"}};
  if (choice_row(ui, control, {"Own", "22 joints"}, bones)) state.choice.own_bones = bones == 0;
}

/// What only an animated character has.
void draw_character_rows(Ui& ui, const app::TakeState& take, bool own_bones, ExportState& state) {
  CharacterExportOptions& file = state.choice.file;
  int many = file.influences == 8 ? 1 : 0;
  if (choice_row(ui, {"export.influences", "Bones per vertex", "Older engines read only four"}, {"4", "8"},
                 many))
    file.influences = many == 1 ? 8 : 4;
  constexpr std::array<int, 4> kShapes = {0, 4, 8, 16};
  int shapes = static_cast<int>(std::find(kShapes.begin(), kShapes.end(), file.shapes) - kShapes.begin());
  if (choice_row(
          ui, {"export.morphs", "Morph targets", "Deformations that bones alone cannot make; the file grows"},
          {"None", "4", "8", "16"}, shapes))
    file.shapes = kShapes[shapes];
  if (const auto mm =
          typed_number_row(ui,
                           {"export.reduce", "Key reduction, mm",
                            "Removes keys as long as no vertex moves further than this; 0 keeps all"},
                           static_cast<double>(file.reduce_mm), 1))
    file.reduce_mm = static_cast<float>(std::clamp(*mm, 0.0, 1000.0));
  toggle_row(ui, {"export.t_pose", "T-pose first", "Adds the T-pose as its own clip"}, file.t_pose_clip);
  if (!own_bones || !take.character || take.character->character.animations.empty()) return;
  toggle_row(ui, {"export.keep_clips", "Keep original clips", "Keeps the file's own clips, after ours"},
             file.keep_clips);
}

/// Those that can be in one file with the current one.
std::vector<size_t> takes_that_fit(const app::Session& session) {
  const size_t selected = session.selected_take;
  return selected < session.document.takes.size() ? takes_of_one_file(session.document, selected)
                                                  : std::vector<size_t>();
}

bool are_in_one_file(const app::Session& session, const ExportState& state) {
  const app::ExportFormat* const format = format_of(state);
  return state.takes == ExportTakes::OneFile && format != nullptr && format->is_character &&
         takes_that_fit(session).size() > 1;
}

/// The takes that go into the file.
std::vector<size_t> takes_of_file(const app::Session& session, const ExportState& state) {
  if (!are_in_one_file(session, state)) return {static_cast<size_t>(session.selected_take)};
  std::vector<size_t> takes;
  for (const size_t k : takes_that_fit(session))
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
  const auto frames = moments_of(session, k).size();
  return grouped(static_cast<int64_t>(frames)) + " frames";
}

/// Which of the takes are in the file.
void draw_rows_of_file(const app::Session& session, Ui& ui, ExportState& state) {
  for (const size_t k : takes_that_fit(session)) {
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

/// Of several takes, which ones.
void draw_take_rows(const app::Session& session, PanelContext& context, ExportState& state) {
  Ui& ui = context.ui;
  std::vector<std::string> takes;
  for (const app::Take& take : session.document.takes) takes.push_back(take.name);
  const app::ExportFormat* const format = format_of(state);
  const bool can_be_one = format != nullptr && format->is_character && takes_that_fit(session).size() > 1;
  if (takes.size() > 1 && !state.is_flat) {
    std::vector<std::string> choices = {"This take", "One file per take"};
    if (can_be_one) choices.push_back("One file");
    int which = state.takes == ExportTakes::OneFile && !can_be_one ? 0 : static_cast<int>(state.takes);
    const std::string before = suffix_of(session, state);
    row(ui, "Takes", "Which takes are exported");
    if (dropdown(ui, "export.takes", choices, which,
                 {"The take below alone", "All takes, each in a file named after it",
                  "Takes of this target are its clips; targets of other people perform beside it, at once"}))
      state.takes = static_cast<ExportTakes>(which);
    follow_suffix(session, state, before);
  }
  if (has_many_files(session, state)) return;
  int chosen = session.selected_take;
  row(ui, "Take");
  if (dropdown(ui, "export.take", takes, chosen)) context.ask("target.select", {std::to_string(chosen)});
  if (are_in_one_file(session, state)) draw_rows_of_file(session, ui, state);
}

/// What becomes of the path across the floor: it is left out or carried by a bone, not both.
void draw_path_rows(Ui& ui, bool is_character, CharacterExportOptions& file) {
  if (!is_character) {
    if (toggle_row(ui, {"export.in_place", "In place", "Leaves out the path across the floor"},
                   file.in_place))
      file.root_motion = false;  // not to be seen here
    return;
  }
  {
    const DisabledScope disabled(file.root_motion);
    toggle_row(ui,
               {"export.in_place", "In place",
                file.root_motion ? "Not with root motion, which carries the path across the floor"
                                 : "Leaves out the path across the floor"},
               file.in_place);
  }
  const DisabledScope disabled(file.in_place);
  toggle_row(
      ui,
      {"export.root_motion", "Root motion",
       file.in_place ? "Not in place, where there is no path to carry"
                     : "Adds a root bone that carries the path across the floor, as game engines expect"},
      file.root_motion);
}

/// A film or a folder of pictures.
void draw_film_row(const app::Session& session, Ui& ui, ExportState& state) {
  const std::string before = suffix_of(session, state);
  int how = state.as_pictures ? 1 : 0;
  const Control control{"export.as", "As", "One MP4 file, or a folder of PNG pictures"};
  if (!choice_row(ui, control, {"Film", "Pictures"}, how)) return;
  state.as_pictures = how == 1;
  follow_suffix(session, state, before);
}

std::string frames_words_of_flat(const app::Session& session) {
  return grouped(app::frame_count(session)) + " frames";
}

void draw_animation_rows(const app::Session& session, PanelContext& context, ExportState& state,
                         FilesState& files) {
  Ui& ui = context.ui;
  if (state.is_flat) {
    draw_take_rows(session, context, state);
    if (draw_flat_rows(ui, state)) state.typed = false;
    return hint(ui, frames_words_of_flat(session) + ", " + figure(frames_per_second(session), "frames/s"));
  }
  draw_preset(session, ui, state);
  draw_format(session, ui, state);
  draw_take_rows(session, context, state);
  const app::ExportFormat* const format = format_of(state);
  const app::TakeState* const made = selected_state(session);
  if (format != nullptr && made != nullptr) {
    const bool own_bones = has_own_bones(session, state);
    if (own_bones && format->own_bones) draw_bone_choice(ui, *format, state);
    if (format->is_character)
      draw_character_rows(ui, *made, own_bones && on_own_bones(*format, state), state);
    if (format->is_pictures) {
      if (format->suffix == std::string(".mp4")) draw_film_row(session, ui, state);
      draw_pose_rows(session, context, state, files);
    } else {
      draw_path_rows(ui, format->is_character, state.choice.file);
    }
    const std::string frames = has_many_files(session, state)
                                   ? std::to_string(session.takes.size()) + " takes"
                                   : frames_words(session, session.selected_take);
    hint(ui, frames + ", " + figure(frames_per_second(session), "frames/s"));
  }
  hint(ui, format != nullptr ? format->words : "Every metric of every frame, as a table.");
}

/// What is not as it would be anyway. own_bones: whether the character has any.
app::Arguments export_words(const app::ExportFormat& format, const app::ExportChoice& choice,
                            bool own_bones) {
  app::Arguments words = {std::string("format=") + format.name};
  const CharacterExportOptions& file = choice.file;
  if (file.in_place) words.push_back("in_place=on");
  const bool own = choice.own_bones.value_or(format.is_character);
  if (format.own_bones && own_bones && own != format.is_character)
    words.push_back(own ? "bones=own" : "bones=22");
  if (!format.is_character) return words;
  if (file.root_motion) words.push_back("root_motion=on");
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

/// Pushes the command that writes an animation.
void ask_for_animation(const app::Session& session, PanelContext& context, ExportState& state) {
  const app::ExportFormat* const format = format_of(state);
  app::Arguments words;
  if (state.is_flat) {
    words = pose_words(state.choice, true);
    words.insert(words.begin(), {std::to_string(session.selected_take), state.path});
    return ask_noted(context, state, "export.run", words);
  }
  if (format != nullptr) words = export_words(*format, state.choice, has_own_bones(session, state));
  if (format != nullptr && format->is_pictures) {
    const app::Arguments more = pose_words(state.choice, false);
    words.insert(words.end(), more.begin(), more.end());
  }
  if (has_many_files(session, state)) {
    if (format == nullptr) words = {"format=csv"};
    words.insert(words.begin(), state.path);
    return ask_noted(context, state, "export.all", words);
  }
  const std::vector<size_t> takes = takes_of_file(session, state);
  if (takes.empty()) return;
  words.insert(words.begin(), {std::to_string(takes[0]), state.path});
  for (size_t i = 1; i < takes.size(); ++i)
    words.push_back("take=" + word_for_take(session.document, takes[i]));
  ask_noted(context, state, format != nullptr ? "export.run" : "export.csv", words);
}

/// Pushes the command that writes it.
void ask_for_export(const app::Session& session, PanelContext& context, ExportState& state) {
  if (state.kind == ExportKind::Animation) return ask_for_animation(session, context, state);
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

void draw_picture_rows(const app::Session& session, Ui& ui, ExportState& state) {
  draw_size_rows(ui, state);
  int what = state.all ? 0 : 1;
  if (choice_row(ui, {"export.all", "What"}, {"All views", "Active view"}, what)) state.all = what == 0;
  if (state.kind == ExportKind::Picture)
    toggle_row(ui, {"export.transparent", "Transparent", "Leaves out the background"}, state.transparent);
  else
    draw_film_row(session, ui, state);
}

bool enter_pressed() {
  return key_pressed(render::Key::Enter, false) || key_pressed(render::Key::KeypadEnter, false);
}

struct PathAnswer {
  bool browse = false;  ///< the user wants to
  bool entered = false;
};
/// Over a field that nobody types in: with the name of the file, which the field itself would cut off.
void draw_path_cut(Ui& ui, const std::string& path) {
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax(),
               padding = ImGui::GetStyle().FramePadding;
  const std::string cut = cut_name(path, max.x - min.x - 2 * padding.x);
  ui.mark("export.path.shown", {min, {min.x + ImGui::CalcTextSize(cut.c_str()).x, max.y}});
  if (cut == path) return;
  tooltip(ui, path);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(min, max, color(ui.theme().field), ImGui::GetStyle().FrameRounding);
  list.AddText({min.x + padding.x, min.y + padding.y}, color(ui.theme().text), cut.c_str());
}

/// The path to write, which follows the take until one is typed.
PathAnswer draw_path(const app::Session& session, Ui& ui, ExportState& state) {
  PathAnswer answer;
  if (!state.typed) state.path = proposed_path(session, state);
  row(ui, suffix_of(session, state).empty() ? "Folder" : "File");
  const float side = ImGui::GetFrameHeight();
  ImGui::BeginChild("##path", {std::max(1.f, ImGui::GetContentRegionAvail().x - side - ui.px(6)), side});
  const auto path = committed_text(ui, "export.path", state.path);
  answer.entered = ImGui::IsItemDeactivated() && enter_pressed();
  if (!ImGui::IsItemActive()) draw_path_cut(ui, state.path);
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

bool file_is_there(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) || (fs::is_directory(path, error) && !fs::is_empty(path, error));
}

/// Names of the files that would be replaced.
std::vector<std::string> files_in_the_way(const app::Session& session, const ExportState& state) {
  if (!has_many_files(session, state))
    return file_is_there(state.path) ? std::vector<std::string>{file_name(state.path)}
                                     : std::vector<std::string>{};
  std::vector<std::string> there;
  for (const std::string& name : app::take_file_names(session.document, file_suffix_of(state)))
    if (file_is_there((fs::path(state.path) / name).string())) there.push_back(name);
  return there;
}

/// Whether the dialog stays.
bool draw_overwrite(const app::Session& session, PanelContext& context, ExportState& state) {
  const std::vector<std::string>& there = state.in_the_way;
  QuestionWords question;
  question.title = there.size() > 1 ? "Replace the files?" : "Replace the file?";
  question.sentence = there[0] + (there.size() == 2  ? " and another are already there."
                                  : there.size() > 2 ? " and " + std::to_string(there.size() - 1) +
                                                           " others are already there."
                                                     : " is already there.");
  question.yes = "Replace", question.dangerous = true;
  const Answer answer = ask(context.ui, "export.overwrite", question);
  if (answer == Answer::None) return true;
  state.in_the_way.clear();
  if (answer == Answer::Yes) ask_for_export(session, context, state);
  return answer != Answer::Yes;
}

/// Whether a choice is missing without which nothing can be written.
bool is_unfinished(const app::Session& session, const ExportState& state) {
  if (state.kind != ExportKind::Animation) return false;
  const app::ExportFormat* const format = state.is_flat ? nullptr : format_of(state);
  const bool lays = format != nullptr && format->is_pictures && state.lays_onto;
  return takes_of_file(session, state).empty() || (lays && state.choice.poses.camera.reference.empty());
}

const char* title_of(ExportKind kind) {
  return kind == ExportKind::Animation ? "Export"
         : kind == ExportKind::Picture ? "Save picture"
                                       : "Save video";
}

/// The rows above the path and the buttons: where the window is too low for all of them they scroll, and path
/// and buttons stay.
template <class Draw>
void draw_choices_above(Ui& ui, const Draw& draw_rows) {
  float& height = ui.state<float>(ImGui::GetID("##choices.height"));  // as drawn last
  const ImGuiStyle& style = ImGui::GetStyle();
  const float line = ImGui::GetFrameHeight() + style.ItemSpacing.y;
  const float below = 2 * line + ui.px(4) + style.ItemSpacing.y + ui.px(16);
  const float room = ImGui::GetIO().DisplaySize.y - ui.px(16) - ImGui::GetCursorPosY() - below;
  const bool scrolls = height > room;
  if (scrolls) ImGui::BeginChild("##choices", {0, std::max(ui.px(60), room)});
  const float top = ImGui::GetCursorPosY();
  draw_rows();
  height = ImGui::GetCursorPosY() - top;
  if (scrolls) ImGui::EndChild();
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
  state.in_the_way.clear();
  state.typed = false;
  return true;
}

void choose_path(ExportState& state, const std::string& path) {
  state.path = state.agreed = path, state.typed = true;
}

void choose_reference(ExportState& state, const std::string& path) {
  state.choice.poses.camera.reference = path;
}

bool export_failed(const app::Session& session, ExportState& state) {
  const auto is_it = [&](const app::Notice& error) { return error.details == state.asked; };
  if (state.asked.empty() || std::none_of(session.errors.begin(), session.errors.end(), is_it)) return false;
  state.asked.clear(), state.agreed.clear();
  return true;
}

bool draw_export(const app::Session& session, PanelContext& context, ExportState& state, FilesState& files) {
  Ui& ui = context.ui;
  if (!state.in_the_way.empty()) return draw_overwrite(session, context, state);
  state.is_flat = app::is_flat_take(session, session.selected_take);
  if (!begin_dialog(ui, "export", title_of(state.kind), 460)) return true;
  draw_choices_above(ui, [&] {
    if (state.kind == ExportKind::Animation)
      draw_animation_rows(session, context, state, files);
    else
      draw_picture_rows(session, ui, state);
  });
  const PathAnswer path = draw_path(session, ui, state);
  if (path.browse) choose_file(session, files, FilePurpose::Export, state.path);
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions save;
  save.look = ButtonLook::Main, save.disabled = state.path.empty() || is_unfinished(session, state);
  bool stays = !buttons.add(ui, "export.cancel", "Cancel", {});
  const bool entered = path.entered || (enter_pressed() && !ImGui::GetIO().WantTextInput);
  if (buttons.add(ui, "export.save", "Save", save) ||
      (entered && !save.disabled && !ImGui::IsWindowAppearing())) {
    const bool agreed = state.path == state.agreed && !has_many_files(session, state);
    if (!agreed) state.in_the_way = files_in_the_way(session, state);
    if (state.in_the_way.empty()) ask_for_export(session, context, state), stays = false;
  }
  return finish_dialog(stays);
}

}  // namespace understudy::ui
