#include "retarget/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

/// The word as a number; `what` names it in errors.
template <class T>
T parsed(std::string_view word, bool (*parse)(std::string_view, T&), const std::string& source,
         const char* what) {
  T value = 0;
  US_CHECK(!word.empty(), source, ": ends before ", what);
  US_CHECK(parse(word, value), source, ": '", excerpt(word), "' in place of ", what);
  return value;
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string file_suffix(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);  // npos + 1 is 0
  const size_t dot = name.rfind('.');
  return dot == name.npos || dot == 0 || name == ".." ? "" : lower_case(name.substr(dot));
}

std::string file_name(const std::string& path) {
  const size_t last = path.find_last_not_of('/');
  if (last == std::string::npos) return path;
  const size_t slash = path.find_last_of('/', last);
  const size_t first = slash == std::string::npos ? 0 : slash + 1;
  return path.substr(first, last - first + 1);
}

std::string_view trim_end(std::string_view text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

void split_words(std::string_view line, std::string_view separators, std::vector<std::string_view>& words) {
  words.clear();
  const auto parts = [&](char c) { return is_blank(c) || separators.find(c) != separators.npos; };
  size_t at = 0;
  while (true) {
    while (at < line.size() && parts(line[at])) ++at;
    if (at >= line.size()) return;
    const size_t begin = at;
    while (at < line.size() && !parts(line[at])) ++at;
    words.push_back(line.substr(begin, at - begin));
  }
}

void append_item(std::string& list, std::string_view item, std::string_view separator) {
  if (!list.empty()) list += separator;
  list += item;
}

std::string joined_once(const std::vector<std::string>& items, std::string_view separator) {
  std::string list;
  for (auto item = items.begin(); item != items.end(); ++item)
    if (!item->empty() && std::find(items.begin(), item, *item) == item) append_item(list, *item, separator);
  return list;
}

std::vector<std::string> csv_cells(const std::string& line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  if (quoted) throw std::invalid_argument("a quote is not closed");
  return cells;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += c;
    cell += c;
  }
  return cell + '"';
}

std::string excerpt(std::string_view text) {
  std::string out(text.substr(0, 40));
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return text.size() > 40 ? out + "..." : out;
}

std::string printed(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  std::string text(static_cast<size_t>(std::vsnprintf(nullptr, 0, format, arguments)) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(arguments);
  va_end(again);
  text.pop_back();
  return text;
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return "\u2013";
  const double size = std::abs(value);
  return printed("%.*f", size >= 100 || size == 0 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3, value);
}

std::string grouped(int64_t count) {
  std::string digits = std::to_string(count);
  for (int64_t at = static_cast<int64_t>(digits.size()) - 3; at > (count < 0 ? 1 : 0); at -= 3)
    digits.insert(at, ",");
  return digits;
}

void append_fixed(std::string& out, double value, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
  out.append(text, end.ptr);
}

void append_exact(std::string& out, float value) {
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

bool parse_number(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
    const double size = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    value = text.front() == '-' ? -size : size;
  }
  return true;
}

bool parse_integer(std::string_view text, int64_t& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return stop == end && error == std::errc();
}

std::string_view TextCursor::word() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  const size_t begin = at_;
  while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string_view TextCursor::line() {
  if (at_end()) return {};
  const size_t end = std::min(text_.find('\n', at_), text_.size());
  std::string_view line = text_.substr(at_, end - at_);
  at_ = std::min(end + 1, text_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

double TextCursor::number(const char* what) {
  return parsed(word(), parse_number, source_, what);
}

int64_t TextCursor::integer(const char* what) {
  return parsed(word(), parse_integer, source_, what);
}

void TextCursor::skip_comments() {
  while (at_ < text_.size()) {
    if (is_blank(text_[at_])) {
      ++at_;
    } else if (text_[at_] == '#') {
      line();
    } else {
      return;
    }
  }
}

}  // namespace understudy
