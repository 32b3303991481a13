// Searchable lists and tables.
#pragma once

#include <string>
#include <vector>

#include "ui/gui/ui.hpp"

namespace understudy::ui {

struct ListItem {
  std::string text;
  std::string note{};   ///< grey, on the right
  bool enabled = true;  ///< grey and not to be chosen where not
  std::string also{};   ///< not shown: other words that find it
};
/// A list with a search field above it; what begins with the words searched comes first. Returns the item
/// clicked or chosen by arrows and Enter, -1 for none. `height` pixels, 0: what is left.
/// The line is marked NAME.search, item i NAME.i.
int searchable_list(Ui& ui, const std::string& name, const std::vector<ListItem>& items, int selected,
                    float height = 0);

struct Column {
  std::string title;
  float width = 0;      ///< at scale 1; 0: shares what is left
  bool number = false;  ///< aligns its cells to the right
};
/// A table with a fixed header. Draw rows only while open() is true.
class Table {
 public:
  /// `height` pixels; 0: as high as its rows.
  Table(Ui& ui, const std::string& name, std::vector<Column> columns, float height = 0);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  bool open() const { return open_; }

  /// Begins a row, to be clicked when `selectable`; true when it was. Marked NAME.ROW.
  bool row(bool selected = false, bool selectable = true);
  /// The next cell of the row. Text is cut to fit; numbers align to the right.
  void cell(const std::string& text);
  void cell(double value);
  /// The next cell, for what is drawn next.
  void next_cell();
  /// The next cell, its text whole: in as many lines as it needs. Marked NAME.ROW.text.
  void whole_cell(const std::string& text);

 private:
  void write(const Column& column, const std::string& text);

  Ui& ui_;
  std::string name_;
  std::vector<Column> columns_;
  int row_ = -1, column_ = 0;
  bool open_;
};

}  // namespace understudy::ui
