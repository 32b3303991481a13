#include "retarget/formats/csv_lines.hpp"

#include <stdexcept>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"

namespace understudy {
namespace {

constexpr uint64_t kMostTableBytes = uint64_t{1} << 30;

std::vector<std::string> cells_of(const std::string& line, char separator, const std::string& where) {
  std::vector<std::string> cells;
  try {
    cells = csv_cells(line, separator);
  } catch (const std::invalid_argument&) {
    throw Error(where + ": a quote is not closed");
  }
  for (std::string& cell : cells) {
    cell = trim_end(cell);
    cell.erase(0, cell.find_first_not_of(" \t"));
  }
  return cells;
}

/// What parts the first line.
char separator_of(const std::string& line, const std::string& where) {
  for (const char separator : {'\t', ';'})
    if (cells_of(line, separator, where).size() > 1) return separator;
  return ',';
}

/// Spreadsheets write a byte order mark.
std::string_view without_mark(std::string_view text) {
  if (starts_with(text, "\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

}  // namespace

std::string in_line(const std::string& table, int64_t line) {
  return table + ": line " + std::to_string(line);
}

CsvLines::CsvLines(const std::string& path)
    : path_(path), text_(read_file(path, kMostTableBytes)), lines_(without_mark(text_), path) {}

std::optional<std::vector<std::string>> CsvLines::next() {
  while (!lines_.at_end()) {
    ++number_;
    const std::string line(trim_end(lines_.line()));
    if (line.empty()) continue;
    if (separator_ == 0) separator_ = separator_of(line, where());
    return cells_of(line, separator_, where());
  }
  return std::nullopt;
}

}  // namespace understudy
