// A small table of text: CSV parted by comma, semicolon or tab, line by line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "retarget/base/text.hpp"

namespace understudy {

/// "times.csv: line 3".
std::string in_line(const std::string& table, int64_t line);

/// Walks over the lines of a table that are not blank. What parts the first line parts all of them.
class CsvLines {
 public:
  /// Throws Error where the file cannot be read or is larger than a gigabyte.
  explicit CsvLines(const std::string& path);
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;
  /// Without blanks around each cell; none at the end. Throws Error naming the line where a quote is not
  /// closed.
  std::optional<std::vector<std::string>> next();
  /// The number of the line that next() gave, from 1.
  int64_t number() const { return number_; }
  std::string where() const { return in_line(path_, number_); }

 private:
  std::string path_, text_;
  TextCursor lines_;
  int64_t number_ = 0;
  char separator_ = 0;  // 0: no line yet
};

}  // namespace understudy
