#include "ui/panels/export.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "ui/gui/gui.hpp"
#include "ui/panels/rows.hpp"
#include "ui/widgets/dialogs.hpp"

namespace understudy::ui {
namespace fs = std::filesystem;
namespace {

struct Format {
  const char *label, *suffix, *command, *words;
};
constexpr std::array<Format, 3> kFormats = {
    {{"GLB", ".glb", "export.glb", "The animated target, for any engine."},
     {"NPZ", ".npz", "export.npz", "Vertices, joints and rotations as arrays."},
     {"CSV", ".csv", "export.csv", "Every figure of every frame, as a table."}}};

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

const Format& format_of(const ExportState& state) {
  return kFormats[static_cast<size_t>(std::clamp(state.format, 0, 2))];
}

/// A name that any file system takes.
std::string safe_name(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 32 || std::string("/\\:*?\"<>|").find(c) != std::string::npos)
      c = '_';
  return name.empty() ? "take" : name;
}

void draw_animation_rows(const app::Session& session, PanelContext& context, ExportState& state) {
  Ui& ui = context.ui;
  if (const auto i = choice_row(ui, {"export.format", "Format", ""}, {"GLB", "NPZ", "CSV"}, state.format)) {
    const bool own = !state.path.empty() && fs::path(state.path).extension() == suffix_of(state);
    state.format = *i;
    if (own) state.path = fs::path(state.path).replace_extension(suffix_of(state)).string();
  }
  std::vector<std::string> takes;
  for (const app::Take& take : session.document.takes) takes.push_back(take.name);
  int take = session.selected_take;
  row(ui, "Take");
  if (dropdown(ui, "export.take", takes, take)) context.ask("target.select", {std::to_string(take)});
  hint(ui, format_of(state).words);
}

void draw_size_rows(Ui& ui, ExportState& state) {
  std::vector<std::string> labels;
  int chosen = -1;
  for (const Size& size : kSizes) {
    if (size.width == state.width && size.height == state.height) chosen = static_cast<int>(labels.size());
    labels.push_back(size.label);
  }
  if (chosen < 0) chosen = static_cast<int>(labels.size()), labels.push_back("Another");
  row(ui, "Size");
  if (dropdown(ui, "export.size", labels, chosen) && chosen < static_cast<int>(kSizes.size()))
    state.width = kSizes[static_cast<size_t>(chosen)].width,
    state.height = kSizes[static_cast<size_t>(chosen)].height;
  const auto whole = [](double value) { return static_cast<int>(std::clamp(value, 16.0, double{kLargest})); };
  if (const auto w = typed_number_row(ui, {"export.width", "Width", "Pixels"}, state.width, 0))
    state.width = whole(*w);
  if (const auto h = typed_number_row(ui, {"export.height", "Height", "Pixels"}, state.height, 0))
    state.height = whole(*h);
}

void draw_picture_rows(Ui& ui, ExportState& state) {
  draw_size_rows(ui, state);
  if (const auto i =
          choice_row(ui, {"export.all", "What", ""}, {"All views", "Active view"}, state.all ? 0 : 1))
    state.all = *i == 0;
  if (state.kind == ExportKind::Picture) {
    if (const auto on = toggle_row(ui, {"export.transparent", "Transparent", "Nothing behind the bodies"},
                                   state.transparent))
      state.transparent = *on;
  } else {
    hint(ui, "A name with .mp4 gives a film, any other a folder of PNG pictures.");
  }
}

/// Where it goes; true when the user wants to choose.
bool draw_path(const app::Session& session, Ui& ui, ExportState& state) {
  if (state.path.empty()) state.path = proposed_path(session, state);
  row(ui, "File");
  const float side = ImGui::GetFrameHeight();
  ImGui::BeginChild("##path", {std::max(1.f, ImGui::GetContentRegionAvail().x - side - ui.px(6)), side});
  if (const auto path = committed_text(ui, "export.path", state.path)) state.path = *path;
  ImGui::EndChild();
  ImGui::SameLine(0, ui.px(6));
  return icon_button(ui, "export.browse", Icon::Folder,
                     {"Choose the folder and the name", "", false, false, side / ui.scale()});
}

ExportAnswer draw_overwrite(const app::Session& session, PanelContext& context, ExportState& state) {
  Question question;
  question.title = "Replace the file?";
  question.sentence = file_name(state.path) + " is already there.";
  question.yes = "Replace", question.dangerous = true;
  const Answer answer = ask(context.ui, "export.overwrite", question);
  if (answer == Answer::None) return {};
  state.asking = false;
  if (answer != Answer::Yes) return {};
  ask_for_export(session, context, state);
  return {false, false};
}

const char* title_of(ExportKind kind) {
  return kind == ExportKind::Animation ? "Export"
         : kind == ExportKind::Picture ? "Save picture"
                                       : "Save video";
}

bool file_is_there(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

void begin_export(ExportState& state, ExportKind kind, int format) {
  state.kind = kind, state.format = format;
  state.path.clear(), state.agreed.clear();
  state.asking = false;
}

std::string suffix_of(const ExportState& state) {
  if (state.kind == ExportKind::Animation) return format_of(state).suffix;
  return state.kind == ExportKind::Picture ? ".png" : ".mp4";
}

std::string proposed_path(const app::Session& session, const ExportState& state) {
  const fs::path folder =
      session.path.empty() ? fs::path(session.settings.last_folder) : fs::path(session.path).parent_path();
  const app::Take* take = selected_take(session);
  std::string name = take != nullptr ? take->name : session.source.name;
  if (state.kind != ExportKind::Animation && !session.path.empty())
    name = fs::path(session.path).stem().string();
  const fs::path file = safe_name(name) + suffix_of(state);
  return (folder.empty() ? fs::absolute(file) : folder / file).string();
}

void ask_for_export(const app::Session& session, PanelContext& context, const ExportState& state) {
  if (state.kind == ExportKind::Animation)
    return context.ask(format_of(state).command, {std::to_string(session.selected_take), state.path});
  app::Arguments arguments = {state.path, std::to_string(state.width), std::to_string(state.height)};
  if (state.kind == ExportKind::Picture && state.transparent) arguments.push_back("transparent");
  arguments.push_back(state.all ? "all" : "view");
  context.ask(state.kind == ExportKind::Picture ? "picture.save" : "video.save", arguments);
}

ExportAnswer draw_export(const app::Session& session, PanelContext& context, ExportState& state) {
  Ui& ui = context.ui;
  if (state.asking) return draw_overwrite(session, context, state);
  if (!begin_dialog(ui, "export", title_of(state.kind), 460)) return {};
  ExportAnswer answer;
  if (state.kind == ExportKind::Animation)
    draw_animation_rows(session, context, state);
  else
    draw_picture_rows(ui, state);
  answer.browse = draw_path(session, ui, state);
  ImGui::Dummy({0, ui.px(4)});
  ButtonRow buttons(2);
  ButtonOptions save;
  save.look = ButtonLook::Main, save.disabled = state.path.empty();
  const bool escape =
      !ImGui::IsWindowAppearing() && !ImGui::GetIO().WantTextInput && key_pressed(render::Key::Escape, false);
  if (buttons.add(ui, "export.cancel", "Cancel", {}) || escape) answer.stays = false;
  if (buttons.add(ui, "export.save", "Save", save)) {
    state.asking = state.path != state.agreed && file_is_there(state.path);
    if (!state.asking) ask_for_export(session, context, state), answer.stays = false;
  }
  if (!answer.stays) ImGui::CloseCurrentPopup();
  end_dialog();
  return answer;
}

}  // namespace understudy::ui
