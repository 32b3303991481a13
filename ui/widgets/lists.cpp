#include "ui/widgets/lists.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "ui/gui/gui.hpp"
#include "ui/widgets/controls.hpp"

namespace understudy::ui {
namespace {

struct ListState {
  std::string search;
  int cursor = 0;  ///< among the items that match
};

/// Whether every word of `search` occurs in the text, in any case.
bool matches(const std::string& text, const std::string& search) {
  const std::string all = lower_case(text);
  std::istringstream words(lower_case(search));
  for (std::string word; words >> word;)
    if (all.find(word) == std::string::npos) return false;
  return true;
}

std::vector<int> matching(const std::vector<ListItem>& items, const std::string& search) {
  std::vector<int> found;
  for (int i = 0; i < ssize(items); ++i)
    if (matches(items[i].text + " " + items[i].note + " " + items[i].also, search)) found.push_back(i);
  const auto begins_a_word = [&, words = lower_case(search)](int i) {
    const std::string text = lower_case(items[i].text);
    const size_t at = text.find(words);
    return at == 0 ||
           (at != std::string::npos && std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0);
  };
  std::stable_partition(found.begin(), found.end(), begins_a_word);
  return found;
}

/// One line of the list; true when clicked.
bool draw_item(Ui& ui, const std::string& name, const ListItem& item, bool selected, bool under_cursor) {
  const float width = ImGui::GetContentRegionAvail().x;
  const float note = item.note.empty() ? 0 : ImGui::CalcTextSize(item.note.c_str()).x + ui.px(12);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight() + ui.px(8);
  const DisabledScope disabled(!item.enabled);
  const bool clicked = ImGui::Selectable(("##" + name).c_str(), selected, 0, {0, height});
  ui.mark(name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (under_cursor)
    list.AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), color(ui.theme().accent), ui.px(3));
  list.AddText({at.x + ui.px(4), at.y + ui.px(4)},
               color(item.enabled ? ui.theme().text : ui.theme().text_faint),
               cut_to(item.text, width - note - ui.px(8)).c_str());
  if (note > 0)
    list.AddText({at.x + width - note + ui.px(8), at.y + ui.px(4)}, color(ui.theme().text_dim),
                 item.note.c_str());
  return clicked;
}

}  // namespace

int searchable_list(Ui& ui, const std::string& name, const std::vector<ListItem>& items, int selected,
                    float height) {
  auto& state = ui.state<ListState>(ImGui::GetID(name.c_str()));
  if (ImGui::IsWindowAppearing()) state = {};
  if (text_field(ui, name + ".search", state.search, "Search")) state.cursor = 0;
  const bool typing = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
  const std::vector<int> shown = matching(items, state.search);
  const int last = shown.size() - 1;
  if (typing && key_pressed(render::Key::Down)) state.cursor = std::min(state.cursor + 1, last);
  if (typing && key_pressed(render::Key::Up)) state.cursor = state.cursor - 1;
  state.cursor = std::clamp(state.cursor, 0, std::max(0, last));
  const bool entered = typing && key_pressed(render::Key::Enter, false);
  int chosen = entered && last >= 0 ? shown[state.cursor] : -1;
  if (entered && (chosen < 0 || !items[chosen].enabled)) ImGui::SetKeyboardFocusHere(-1);
  if (ImGui::BeginChild((name + ".items").c_str(), {0, height})) {
    ImGuiListClipper clipper;
    clipper.Begin(shown.size(), ImGui::GetTextLineHeight() + ui.px(8) + ImGui::GetStyle().ItemSpacing.y);
    while (clipper.Step())
      for (int k = clipper.DisplayStart; k < clipper.DisplayEnd; ++k) {
        const int i = shown[k];
        if (draw_item(ui, name + "." + std::to_string(i), items[i], i == selected,
                      typing && k == state.cursor))
          chosen = i;
      }
    if (shown.empty()) hint(ui, "Nothing matches.");
  }
  ImGui::EndChild();
  return chosen >= 0 && items[chosen].enabled ? chosen : -1;
}

Table::Table(Ui& ui, const std::string& name, std::vector<Column> columns, float height)
    : ui_(ui), name_(name), columns_(std::move(columns)) {
  ImGuiTableFlags flags = ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_RowBg | ImGuiTableFlags_Resizable |
                          ImGuiTableFlags_PadOuterX | ImGuiTableFlags_NoSavedSettings;
  if (height > 0) flags |= ImGuiTableFlags_ScrollY;
  open_ = ImGui::BeginTable(name.c_str(), columns_.size(), flags, {0, height});
  if (!open_) return;
  if (height > 0) ImGui::TableSetupScrollFreeze(0, 1);
  for (const Column& column : columns_)
    ImGui::TableSetupColumn(
        column.title.c_str(),
        column.width > 0 ? ImGuiTableColumnFlags_WidthFixed : ImGuiTableColumnFlags_WidthStretch,
        column.width > 0 ? ui.px(column.width) : 1);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  const FontScope small(ui.fonts().small);
  const ColorScope dim(ImGuiCol_Text, ui.theme().text_dim);
  for (size_t i = 0; i < columns_.size(); ++i) {
    ImGui::TableSetColumnIndex(i);
    const std::string title = cut_name(columns_[i].title, ImGui::GetContentRegionAvail().x);
    write(columns_[i], title);
    ui.mark(name + ".title." + std::to_string(i));
    if (title != columns_[i].title) tooltip(ui, columns_[i].title);
  }
}

Table::~Table() {
  if (open_) ImGui::EndTable();
}

bool Table::row(bool selected, bool selectable) {
  ImGui::TableNextRow();
  ++row_, column_ = 0;
  if (!selectable) return false;
  ImGui::TableSetColumnIndex(0);
  const bool clicked = ImGui::Selectable(("##row" + std::to_string(row_)).c_str(), selected,
                                         ImGuiSelectableFlags_SpanAllColumns);
  ui_.mark(name_ + "." + std::to_string(row_));
  ui_.stop(name_ + "." + std::to_string(row_));
  ImGui::SameLine(0, 0);
  return clicked;
}

void Table::cell(const std::string& text) {
  if (column_ != ImGui::TableGetColumnIndex()) ImGui::TableSetColumnIndex(column_);
  write(columns_[std::min<int>(column_++, columns_.size() - 1)], text);
}

void Table::next_cell() {
  if (column_ != ImGui::TableGetColumnIndex()) ImGui::TableSetColumnIndex(column_);
  ++column_;
}

void Table::whole_cell(const std::string& text) {
  next_cell();
  paragraph(text);
  ui_.mark(name_ + "." + std::to_string(row_) + ".text");
}

void Table::cell(double value) {
  cell(std::isfinite(value) ? printed("%.1f", value) : "\u2013");
}

void Table::write(const Column& column, const std::string& text) {
  const float left = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (column.number && left > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + left);
  text_cut(ui_, text);
}

}  // namespace understudy::ui
