#include "ui/widgets/file_browser.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "ui/gui/gui.hpp"
#include "ui/widgets/controls.hpp"
#include "ui/widgets/dialogs.hpp"

namespace understudy::ui {
namespace {

namespace fs = std::filesystem;
using render::Key;

std::string home() {
  const char* path = std::getenv("HOME");
  return path != nullptr && *path != '\0' ? path : "/";
}

std::string date(int64_t seconds) {
  if (seconds == 0) return {};
  const auto when = static_cast<std::time_t>(seconds);
  std::tm parts{};
  localtime_r(&when, &parts);
  char words[32];
  return {words, std::strftime(words, sizeof words, "%Y-%m-%d %H:%M", &parts)};
}

/// A folder that is opened as one thing: an entry, or what is shown.
template <class Of>
bool is_special(const Of& folder) {
  return folder.frames > 0 || folder.poses > 0 || folder.is_case;
}

std::string counted(int count, const std::string& what) {
  return std::to_string(count) + (count >= 10000 ? "+ " : " ") + what;
}

Icon icon_of(const FolderEntry& entry) {
  if (entry.frames > 0) return Icon::Points;
  if (entry.poses > 0) return Icon::Skeleton;
  if (entry.is_case) return Icon::Check;
  if (entry.is_folder) return Icon::Folder;
  if (const FileFormat* const known = format_of_suffix(entry.name, ~0u); known && !known->is_plain_text) {
    if (known->uses & (kDocument | kStudy)) return Icon::Layers;
    if (known->uses == kMotion) return Icon::Skeleton;
    if (known->uses & kTarget && !known->open) return Icon::Mesh;
  }
  const std::string suffix = file_suffix(entry.name);
  if (suffix == ".png" || suffix == ".jpg") return Icon::Image;
  if (suffix == ".mp4") return Icon::Video;
  return Icon::File;
}

std::string about(const FolderEntry& entry) {
  if (entry.frames > 0) return counted(entry.frames, "frames");
  if (entry.poses > 0) return counted(entry.poses, "poses");
  if (entry.is_case) return "case";
  return entry.is_folder ? "" : file_size(entry.bytes);
}

bool pressed(Key key) {
  return key_pressed(key, false);
}

/// Puts the cursor behind what a text field holds as typing begins, instead of selecting all of it.
int go_on_behind(ImGuiInputTextCallbackData* field) {
  if (!std::exchange(*static_cast<bool*>(field->UserData), false)) return 0;
  field->CursorPos = field->BufTextLen;
  field->ClearSelection();
  return 0;
}

}  // namespace

bool FileFilter::passes(const std::string& name) const {
  return suffixes.empty() || std::find(suffixes.begin(), suffixes.end(), file_suffix(name)) != suffixes.end();
}

namespace {

/// And what holds 2D poses or proportions.
std::vector<std::string> with_poses(std::vector<std::string> suffixes) {
  for (const char* const suffix : {".json", ".npz", ".npy"})
    if (std::find(suffixes.begin(), suffixes.end(), suffix) == suffixes.end()) suffixes.emplace_back(suffix);
  return suffixes;
}

}  // namespace

FileFilter filter_of(FileKind kind) {
  static const std::array<FileFilter, 11> kFilters = {{
      {"Scans, motions and 2D poses", with_poses(format_suffixes(kScanFrame | kScanSequence | kMotion)),
       true},
      {"Targets", with_poses(format_suffixes(kTarget))},
      {"AMASS-format motions", format_suffixes(kBody)},  // both are .npz
      {"Tables of times or markers", {".csv", ".tsv", ".txt"}},
      {"Understudy documents", format_suffixes(kDocument)},
      {"Perceptual studies", format_suffixes(kStudy)},
      {"Answers", {".csv"}},
      {"All supported files", with_poses(format_suffixes(~0u)), true},
      {"All files", {}, true},
      {"Folders", {}, false, true},
      {"2D poses", with_poses({}), true},
  }};
  return kFilters[static_cast<size_t>(kind)];
}

void FileBrowser::open(BrowseRequest request) {
  request_ = std::move(request);
  if (request_.filters.empty()) request_.filters.push_back(filter_of(FileKind::Any));
  open_ = true, filter_ = 0, name_ = request_.name, chosen_.reset();
  overwrite_.clear();
  const std::string start = !request_.folder.empty() ? request_.folder : !folder_.empty() ? folder_ : home();
  go_to(start);
}

void FileBrowser::go_to(const std::string& folder, const std::string& selected) {
  std::error_code error;
  const fs::path whole = fs::absolute(folder, error).lexically_normal();
  std::string path = error ? folder : whole.string();
  if (path.size() > 1 && path.back() == '/') path.pop_back();
  selected_name_ = selected;
  scroll_to_selected_ = !selected.empty();
  folder_ = path;
  editing_path_ = path_begun_ = naming_folder_ = false;
  problem_.clear(), found_.clear();
  refresh();
}

/// What it came out of is selected.
void FileBrowser::go_up() {
  const fs::path left = folder_;
  wanted_ = left.parent_path().string(), left_ = left.filename().string();
}

void FileBrowser::refresh() {
  listing_ = std::make_unique<FolderListing>(folder_);
  contents_ = listing_->contents();
  rows_of_filter_ = -1;
}

const FileFilter& FileBrowser::filter() const {
  return request_.filters[std::clamp<int>(filter_, 0, request_.filters.size() - 1)];
}

bool FileBrowser::can_choose(const FolderEntry& entry) const {
  return !entry.is_folder || (!request_.save && filter().folders && is_special(entry));
}

/// Whether the folder that is shown can itself be opened.
bool FileBrowser::can_choose_folder() const {
  if (request_.save) return false;
  return filter().any_folder || (filter().folders && is_special(*contents_));
}

std::string FileBrowser::path_of(const FolderEntry& entry) const {
  return (fs::path(folder_) / entry.name).string();
}

/// -1 where nothing is.
int FileBrowser::selected_row() const {
  const auto at = std::find_if(rows_.begin(), rows_.end(),
                               [&](int i) { return contents_->entries[i].name == selected_name_; });
  return at == rows_.end() ? -1 : static_cast<int>(at - rows_.begin());
}

const FolderEntry* FileBrowser::selected() const {
  const int row = selected_row();
  return row < 0 ? nullptr : &contents_->entries[rows_[row]];
}

void FileBrowser::select(int row) {
  if (rows_.empty()) return;
  const size_t at = std::clamp<int>(row, 0, rows_.size() - 1);
  const FolderEntry& entry = contents_->entries[rows_[at]];
  selected_name_ = entry.name;
  scroll_to_selected_ = true;
  if (request_.save && !entry.is_folder) name_ = entry.name;
}

std::optional<std::string> FileBrowser::draw(Ui& ui) {
  if (!open_) return std::nullopt;
  auto newest = listing_->contents();
  if (newest != contents_ || rows_of_filter_ != filter_) {
    contents_ = std::move(newest), rows_of_filter_ = filter_;
    rows_.clear();
    for (int i = 0; i < ssize(contents_->entries); ++i) {
      const FolderEntry& entry = contents_->entries[i];
      if (entry.is_folder || filter().passes(entry.name)) rows_.push_back(i);
    }
  }
  if (!begin_dialog(ui, "browser", request_.title, 940, 580)) return std::nullopt;
  draw_header(ui);
  const float footer = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y + ui.px(8) +
                       (request_.save ? ImGui::GetFrameHeightWithSpacing() : 0);
  const float height = std::max(ui.px(60), ImGui::GetContentRegionAvail().y - footer),
              width = ImGui::GetContentRegionAvail().x;
  const bool wide = width > ui.px(560);
  if (wide) {
    if (ImGui::BeginChild("places", {ui.px(150), height})) draw_places(ui);
    ImGui::EndChild();
    ImGui::SameLine();
  }
  const float pane = preview && width > ui.px(720) ? ui.px(210) : 0;
  if (ImGui::BeginChild("list", {pane > 0 ? ImGui::GetContentRegionAvail().x - pane - ui.px(8) : 0, height},
                        true))
    draw_list(ui);
  ImGui::EndChild();
  if (pane > 0) {
    ImGui::SameLine();
    if (ImGui::BeginChild("preview", {0, height})) draw_preview(ui);
    ImGui::EndChild();
  }
  draw_footer(ui);
  if (overwrite_.empty() && !Focus::in_menu()) take_keys(ui.focus());
  draw_overwrite(ui);
  if (!open_) ImGui::CloseCurrentPopup();
  end_dialog();
  if (!wanted_.empty()) go_to(std::exchange(wanted_, {}), std::exchange(left_, {}));
  return std::exchange(chosen_, std::nullopt);
}

void FileBrowser::draw_header(Ui& ui) {
  IconButtonOptions up;
  up.tooltip = "One folder up", up.shortcut = "Backspace", up.disabled = folder_ == "/",
  up.size = ImGui::GetFrameHeight() / ui.scale();
  if (icon_button(ui, "browser.up", Icon::ChevronUp, up)) go_up();
  ImGui::SameLine();
  draw_path(ui);
  if (naming_folder_) draw_new_folder(ui);
}

void FileBrowser::draw_path(Ui& ui) {
  const float buttons = request_.save ? ImGui::CalcTextSize("New folder").x + ui.px(36) : 0;
  const float width = ImGui::GetContentRegionAvail().x - buttons;
  path_id_ = ImGui::GetID("##path");
  if (editing_path_) {
    ImGui::SetNextItemWidth(width);
    const bool entered =
        ImGui::InputText("##path", &typed_path_,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll |
                             ImGuiInputTextFlags_CallbackAlways,
                         go_on_behind, &path_begun_);
    const bool left = ImGui::IsItemDeactivated();
    ui.mark("browser.path");
    ui.stop("browser.path", true);
    const std::string path = typed_path();
    std::error_code error;
    if (entered && !request_.save && fs::is_regular_file(path, error))
      finish(path);
    else if (entered)
      wanted_ = path;
    if (left) editing_path_ = false;
  } else {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    const ColorScope field(ImGuiCol_ChildBg, ui.theme().field);
    if (ImGui::BeginChild("crumbs", {width, ImGui::GetFrameHeight()}, false,
                          ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse))
      draw_crumbs(ui);
    ImGui::EndChild();
    ImGui::PopStyleVar();
  }
  if (buttons == 0) return;
  ImGui::SameLine();
  if (button(ui, "browser.new_folder", "New folder", {ButtonLook::Plain, "", "", false, -1})) {
    naming_folder_ = !naming_folder_, new_folder_.clear();
    if (naming_folder_) ui.focus().type_into(ImGui::GetID("##folder_name"));
  }
}

/// The path as buttons, from its end: what does not fit is left out at the front. The rest of the field, when
/// clicked, turns into text.
void FileBrowser::draw_crumbs(Ui& ui) {
  std::vector<fs::path> crumbs;
  for (fs::path at = folder_;; at = at.parent_path()) {
    crumbs.insert(crumbs.begin(), at);
    if (at == at.parent_path() || at.empty()) break;
  }
  const auto label = [](const fs::path& path) {
    return path.filename().empty() ? std::string("/") : path.filename().string();
  };
  const auto width = [&](const fs::path& path) {
    return std::min(ImGui::CalcTextSize(label(path).c_str()).x + ui.px(16), ui.px(240)) + ui.px(10);
  };
  float left = ImGui::GetContentRegionAvail().x - ui.px(40);
  size_t first = crumbs.size();
  while (first > 0 && (left -= width(crumbs[first - 1])) > 0) --first;
  first = std::min(first, crumbs.size() - 1);
  for (size_t i = first; i < crumbs.size(); ++i) {
    const std::string name = "browser.crumb." + std::to_string(i);
    if (button(ui, name, label(crumbs[i]), {ButtonLook::Quiet, "", "", false, width(crumbs[i]) - ui.px(10)}))
      wanted_ = crumbs[i].string();
    ImGui::SameLine(0, 0);
    if (i + 1 == crumbs.size()) break;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    draw_icon(*ImGui::GetWindowDrawList(), Icon::ChevronRight,
              {at.x, at.y + (ImGui::GetFrameHeight() - ui.px(10)) / 2}, ui.px(10),
              color(ui.theme().text_faint));
    ImGui::SetCursorScreenPos({at.x + ui.px(10), at.y});
  }
  const float rest = std::max(1.f, ImGui::GetContentRegionAvail().x);
  bool edit = ImGui::InvisibleButton("edit", {rest, ImGui::GetFrameHeight()});
  if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_TextInput);
  ui.mark("browser.path");
  ui.stop("browser.path");
  tooltip(ui, "Type a path", "/ or Ctrl+L");
  edit |= ImGui::GetIO().KeyCtrl && pressed(Key::L);
  if (!edit) return;
  editing_path_ = true, typed_path_ = folder_;
  ui.focus().type_into(path_id_);
}

void FileBrowser::draw_places(Ui& ui) {
  std::vector<Place> all = {{"Home", home(), Icon::Home}};
  const std::string documents = home() + "/Documents";
  if (std::error_code error; fs::is_directory(documents, error))
    all.push_back({"Documents", documents, Icon::File});
  all.push_back({"Computer", "/", Icon::Layers});
  all.insert(all.end(), places.begin(), places.end());
  for (const Place& place : all) {
    const IdScope id(place.path);
    const float height = ImGui::GetTextLineHeight() + ui.px(8);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##place", folder_ == place.path, 0, {0, height})) wanted_ = place.path;
    ui.mark("browser.place." + place.label);
    ui.stop("browser.place." + place.label);
    const float width = ImGui::GetItemRectSize().x;
    tooltip(ui, place.path);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_icon(list, place.icon, {at.x + ui.px(4), at.y + (height - ui.px(15)) / 2}, ui.px(15),
              color(ui.theme().text_dim));
    list.AddText({at.x + ui.px(26), at.y + ui.px(4)}, color(ui.theme().text),
                 cut_to(place.label, width - ui.px(34)).c_str());
  }
}

void FileBrowser::draw_new_folder(Ui& ui) {
  row(ui, "New folder", "", ui.px(90));
  ImGui::SetNextItemWidth(-ui.px(90));
  const bool entered =
      ImGui::InputTextWithHint("##folder_name", "Name", &new_folder_, ImGuiInputTextFlags_EnterReturnsTrue);
  ui.mark("browser.folder_name");
  ui.stop("browser.folder_name", true);
  ImGui::SameLine();
  const bool clicked =
      button(ui, "browser.create", "Create", {ButtonLook::Main, "", "", new_folder_.empty(), -1});
  if (!(entered || clicked) || new_folder_.empty()) return;
  std::error_code error;
  const fs::path made = fs::path(folder_) / new_folder_;
  if (fs::create_directory(made, error))
    wanted_ = made.string();
  else
    problem_ =
        error ? "The folder cannot be made: " + error.message() + "." : new_folder_ + " is there already.";
}

void FileBrowser::draw_list(Ui& ui) {
  const std::string& problem = !problem_.empty() ? problem_ : contents_->problem;
  if (!problem.empty()) {
    icon_label(ui, Icon::Warning, ui.theme().warning);
    ImGui::SameLine();
    paragraph(problem);
    ui.mark("browser.problem");
  }
  const float height = ImGui::GetTextLineHeight() + ui.px(8);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  const int wanted = scroll_to_selected_ ? selected_row() : -1;
  if (wanted >= 0) {
    const float y = ImGui::GetCursorPosY() + height * static_cast<float>(wanted), top = ImGui::GetScrollY(),
                view = ImGui::GetWindowHeight() - ui.px(20);
    if (y < top) ImGui::SetScrollY(y);
    if (y + height > top + view) ImGui::SetScrollY(y + height - view);
    scroll_to_selected_ = false;
  }
  ImGuiListClipper clipper;
  clipper.Begin(rows_.size(), height);
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) draw_entry(ui, i);
  ImGui::PopStyleVar();
  if (rows_.empty() && problem.empty())
    hint(ui, contents_->finished ? "Nothing matches \u201c" + filter().label + "\u201d." : "Looking\u2026");
}

void FileBrowser::draw_entry(Ui& ui, int row_number) {
  const FolderEntry& entry = contents_->entries[rows_[row_number]];
  const IdScope id(entry.name);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight() + ui.px(8);
  const bool clicked =
      ImGui::Selectable("##entry", entry.name == selected_name_,
                        ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups |
                            ImGuiSelectableFlags_AllowItemOverlap,
                        {0, height});
  ui.mark("browser.entry." + entry.name);
  const Theme& t = ui.theme();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float icon = std::round(ui.px(15)), when = width > ui.px(430) ? ui.px(124) : 0, size = ui.px(96),
              look = ui.px(24);
  const float y = at.y + ui.px(4), dates = at.x + width - look - when, sizes = dates - ui.px(8);
  const bool special = is_special(entry);
  draw_icon(list, icon_of(entry), {at.x + ui.px(4), at.y + (height - icon) / 2}, icon,
            color(special ? t.accent_hover : t.text_dim));
  list.AddText({at.x + ui.px(26), y}, color(t.text),
               cut_name(entry.name, sizes - size - at.x - ui.px(26)).c_str());
  const std::string words = about(entry);
  list.AddText({sizes - ImGui::CalcTextSize(words.c_str()).x, y}, color(special ? t.text : t.text_dim),
               words.c_str());
  if (when > 0) list.AddText({dates + ui.px(6), y}, color(t.text_dim), date(entry.changed_s).c_str());
  if (entry.is_folder && can_choose(entry)) {
    ImGui::SetCursorScreenPos({at.x + width - look, at.y + (height - look) / 2});
    ImGui::PushAllowKeyboardFocus(false);  // the key Right does it
    if (icon_button(ui, "browser.look." + entry.name, Icon::ChevronRight,
                    {"Look inside", "Right", false, false, 24}))
      wanted_ = path_of(entry);
    ImGui::PopAllowKeyboardFocus();
    ImGui::SetCursorScreenPos({at.x, at.y + height});
  }
  if (!clicked) return;
  select(row_number);
  scroll_to_selected_ = false;
  if (ImGui::IsMouseDoubleClicked(0)) activate(entry);
}

void FileBrowser::draw_preview(Ui& ui) {
  const FolderEntry* entry = selected();
  if (entry == nullptr) return hint(ui, "Select something to see it here.");
  const FilePreview shown = preview(path_of(*entry));
  const float width = ImGui::GetContentRegionAvail().x;
  if (shown.texture != nullptr && shown.width > 0) {
    const float scale = std::min(width / shown.width, width / std::max(shown.height, 1.f));
    ImGui::Image(shown.texture, {shown.width * scale, shown.height * scale});
    ui.mark("browser.preview");
  }
  text_cut(ui, entry->name);
  const std::string words = about(*entry);
  if (!words.empty() && !starts_with(shown.text, words)) hint(ui, words);
  if (!shown.text.empty()) hint(ui, shown.text);
}

void FileBrowser::draw_footer(Ui& ui) {
  ImGui::Dummy({0, ui.px(2)});
  if (request_.save) {
    row(ui, "Name", "", ui.px(70));
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    text_field(ui, "browser.name", name_, "Name of the file");
    if (ImGui::IsItemDeactivated() && (pressed(Key::Enter) || pressed(Key::KeypadEnter))) accept();
  }
  std::vector<std::string> labels;
  for (const FileFilter& one : request_.filters) labels.push_back(one.label);
  const float buttons = 2 * ui.px(100) + ImGui::GetStyle().ItemSpacing.x;
  ImGui::BeginChild(
      "filter",
      {std::max(ui.px(80), std::min(ui.px(240), ImGui::GetContentRegionAvail().x - buttons - ui.px(8))),
       ImGui::GetFrameHeight()},
      false, ImGuiWindowFlags_NoScrollbar);
  if (labels.size() > 1) dropdown(ui, "browser.filter", labels, filter_);
  ImGui::EndChild();
  ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - buttons);
  if (button(ui, "browser.cancel", "Cancel", {ButtonLook::Plain, "", "Escape", false, ui.px(100)}))
    open_ = false;
  ImGui::SameLine();
  const FolderEntry* entry = selected();
  const bool ready = request_.save ? !name_.empty() : entry != nullptr || can_choose_folder();
  const bool enter = !request_.save && entry != nullptr && !can_choose(*entry);
  if (button(ui, "browser.accept", enter ? "Go there" : request_.accept,
             {ButtonLook::Main, "", "", !ready, ui.px(100)}))
    accept();
}

void FileBrowser::draw_overwrite(Ui& ui) {
  if (overwrite_.empty()) return;
  const std::string name = fs::path(overwrite_).filename().string();
  const Answer answer = ask(ui, "browser.overwrite",
                            {"Replace the file?", name + " is there already. Its contents will be lost.",
                             "Replace", "", "Cancel", true});
  if (answer == Answer::Yes) finish(overwrite_);
  if (answer != Answer::None) overwrite_.clear();
}

void FileBrowser::take_keys(Focus& focus) {
  if (ImGui::GetIO().WantTextInput || ImGui::IsWindowAppearing()) return;
  if (pressed(Key::Escape)) open_ = false;
  const int row_number = selected_row();
  for (const Key key : {Key::Down, Key::Up, Key::PageDown, Key::PageUp, Key::Home, Key::End})
    if (key_pressed(key)) focus.leave();  // Enter is for the list now
  if (key_pressed(Key::Down)) select(row_number + 1);
  if (key_pressed(Key::Up)) select(std::max(0, row_number - 1));
  if (key_pressed(Key::PageDown)) select(row_number + 12);
  if (key_pressed(Key::PageUp)) select(row_number - 12);
  if (pressed(Key::Home)) select(0);
  if (pressed(Key::End)) select(static_cast<int>(rows_.size()) - 1);
  if (pressed(Key::Backspace) && folder_ != "/") go_up();
  const FolderEntry* entry = selected();
  if (entry != nullptr && entry->is_folder && pressed(Key::Right)) wanted_ = path_of(*entry);
  if (entry != nullptr && (pressed(Key::Enter) || pressed(Key::KeypadEnter))) activate(*entry);
  begin_typed_path(focus);
  if (!path_begun_) find_typed();
}

/// A path begins with / or ~: what follows is typed into its field.
void FileBrowser::begin_typed_path(Focus& focus) {
  if (ImGui::GetTime() - found_at_ <= 1 && !found_.empty()) return;
  const auto& typed = ImGui::GetIO().InputQueueCharacters;
  if (request_.save || typed.empty() || (typed[0] != '/' && typed[0] != '~')) return;
  typed_path_.clear();
  for (const ImWchar c : typed) {
    char letter[5];
    typed_path_ += ImTextCharToUtf8(letter, c);
  }
  editing_path_ = path_begun_ = true;
  focus.type_into(path_id_);
}

/// From the folder shown, or from the home folder after a ~.
std::string FileBrowser::typed_path() const {
  const bool from_home = typed_path_ == "~" || starts_with(typed_path_, "~/");
  const fs::path path = from_home ? fs::path(home() + typed_path_.substr(1)) : fs::path(typed_path_);
  return (fs::path(folder_) / path).lexically_normal().string();
}

/// Letters typed within a second of each other select the first entry that begins with them.
void FileBrowser::find_typed() {
  if (ImGui::GetTime() - found_at_ > 1) found_.clear();
  for (const ImWchar c : ImGui::GetIO().InputQueueCharacters) {
    if (c < ' ' || (c == ' ' && found_.empty())) continue;
    char letter[5];
    ImTextCharToUtf8(letter, c);
    found_ += lower_case(letter);
    found_at_ = ImGui::GetTime();
    for (int i = 0; i < ssize(rows_); ++i)
      if (lower_case(contents_->entries[rows_[i]].name).rfind(found_, 0) == 0) {
        select(i);
        break;
      }
  }
}

void FileBrowser::activate(const FolderEntry& entry) {
  if (!can_choose(entry))
    wanted_ = path_of(entry);
  else if (request_.save)
    name_ = entry.name, accept();
  else
    finish(path_of(entry));
}

void FileBrowser::accept() {
  if (!request_.save) {
    if (const FolderEntry* entry = selected())
      activate(*entry);
    else if (can_choose_folder())
      finish(folder_);
    return;
  }
  if (name_.empty()) return;
  const std::string name = filter().passes(name_) ? name_ : name_ + filter().suffixes.front();
  const fs::path path = fs::path(folder_) / name;
  std::error_code error;
  if (fs::is_directory(path, error))
    wanted_ = path.string();
  else if (fs::exists(path, error))
    overwrite_ = path.string();
  else
    finish(path.string());
}

void FileBrowser::finish(const std::string& path) {
  chosen_ = path;
  open_ = false;
}

}  // namespace understudy::ui
