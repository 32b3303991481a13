// Text: letters' case, beginnings and ends, words, lists, numbers; the same in every country's settings.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace understudy {

/// A to Z alone are changed; other letters, of any encoding, stay.
std::string lower_case(std::string_view text);
/// The last ".part" of a path's file name in lower case: ".glb" of "Walk.GLB"; empty where there is none.
/// Every comparison of a file's suffix uses this.
std::string file_suffix(std::string_view path);
/// The last part of a path, also of one that ends in a slash.
std::string file_name(const std::string& path);

inline bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}
inline bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}
/// Without blanks and line ends at the end.
std::string_view trim_end(std::string_view text);
/// The parts between the separators, empty ones too; an empty text has none.
std::vector<std::string> split(std::string_view text, char separator);
/// The words of one line; blanks, and the extra separators given, part them.
void split_words(std::string_view line, std::string_view separators, std::vector<std::string_view>& words);
/// Appends to a list in words: "a", then "a, b".
void append_item(std::string& list, std::string_view item, std::string_view separator = ", ");
/// As a list in words, each item once; empty ones are none.
std::string joined_once(const std::vector<std::string>& items, std::string_view separator = ", ");
/// The beginning of a text for use in a message: at most 40 printable characters.
std::string excerpt(std::string_view text);

/// A text as one cell of a CSV line, in quotes where it must be.
std::string csv_cell(const std::string& text);
/// The cells of one CSV line. Throws std::invalid_argument where a quote is not closed.
std::vector<std::string> csv_cells(const std::string& line, char separator = ',');

/// As std::snprintf prints it, of any length.
std::string printed(const char* format, ...) __attribute__((format(printf, 1, 2)));
/// 12345 as "12,345".
std::string grouped(int64_t count);
/// A value for reading: three significant digits or so, "–" for NaN.
std::string short_number(double value);
/// Appends a value with this many digits after the point.
void append_fixed(std::string& out, double value, int digits);
/// Appends the shortest text that reads back as the same float.
void append_exact(std::string& out, float value);
/// One number that fills the text exactly: what strtod takes in the C locale, less hexadecimals. False when
/// it is not.
bool parse_number(std::string_view text, double& value);
/// A whole number that fills the text exactly.
bool parse_integer(std::string_view text, int64_t& value);

/// Walks over text by words and lines. The text must outlive it.
class TextCursor {
 public:
  TextCursor(std::string_view text, std::string source) : text_(text), source_(std::move(source)) {}

  bool at_end() const { return at_ >= text_.size(); }
  size_t position() const { return at_; }
  size_t left() const { return text_.size() - at_; }
  /// The next word, over line ends; empty at the end.
  std::string_view word();
  /// The rest of this line without its end; steps behind it.
  std::string_view line();
  /// The next word as a number. Throws Error naming `what` when there is none.
  double number(const char* what);
  int64_t integer(const char* what);
  /// Steps over blanks, line ends and lines that start with '#'.
  void skip_comments();

 private:
  std::string_view text_;
  std::string source_;
  size_t at_ = 0;
};

}  // namespace understudy
