// XYZ, TXT, CSV, ASC, PTS: a point a line.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

constexpr std::string_view kSeparators = ",;\"";

struct Columns {
  std::array<int, 3> position = {0, 1, 2};
  std::array<int, 3> colour = {-1, -1, -1};
  bool named = false;
};

int column_of(const std::vector<std::string_view>& words, std::initializer_list<const char*> names) {
  for (size_t i = 0; i < words.size(); ++i)
    for (const char* const name : names)
      if (lower_case(words[i]) == name) return static_cast<int>(i);
  return -1;
}

// Columns by their names, when the words are such names.
std::optional<Columns> named_columns(const std::vector<std::string_view>& words) {
  Columns columns;
  columns.named = true;
  columns.position = {column_of(words, {"x", "//x", "#x"}), column_of(words, {"y"}), column_of(words, {"z"})};
  for (const int column : columns.position)
    if (column < 0) return {};
  columns.colour = {column_of(words, {"r", "red"}), column_of(words, {"g", "green"}),
                    column_of(words, {"b", "blue"})};
  return columns;
}

class XyzParser {
 public:
  explicit XyzParser(const std::string& source) : source_(source) {}

  void line(std::string_view text, int64_t number) {
    split_words(text, kSeparators, words_);
    if (words_.empty()) return;
    const bool comment = words_[0][0] == '#' || words_[0].substr(0, 2) == "//";
    if (points_.empty() && (comment || !leading_numbers())) {
      US_CHECK(comment || headings_++ < 2, source_, ": line ", number, ": '", excerpt(text),
               "' is not a point");
      if (const auto columns = named_columns(words_)) columns_ = *columns;
      return;
    }
    if (comment) return;
    if (points_.empty() && words_.size() == 1 && headings_++ < 2) return;  // the number of points
    point(number);
  }

  Mesh finish() {
    Mesh mesh;
    US_CHECK(!points_.empty(), source_, ": has no points in it");
    mesh.vertices = rows_of_three(points_);
    if (extra_.size() != points_.size()) return mesh;
    Points extra = rows_of_three(extra_);
    if (!columns_.named && are_normals(extra)) return mesh;
    if (extra.maxCoeff() > 1.0f) extra /= 255.0f;
    mesh.colors = extra;
    return mesh;
  }

 private:
  bool leading_numbers() const {
    double value = 0;
    for (size_t i = 0; i < std::min<size_t>(words_.size(), 3); ++i)
      if (!parse_number(words_[i], value)) return false;
    return true;
  }

  float value(int column, int64_t number) const {
    double value = 0;
    US_CHECK(static_cast<size_t>(column) < words_.size(), source_, ": line ", number, ": fewer than ",
             column + 1, " numbers");
    US_CHECK(parse_number(words_[column], value), source_, ": line ", number, ": '", excerpt(words_[column]),
             "' is not a number");
    return narrow(value);
  }

  // Three more numbers: behind the position, or behind an intensity when there are seven.
  void point(int64_t number) {
    if (points_.empty() && !columns_.named && words_.size() >= 6) {
      const int first = words_.size() == 7 ? 4 : 3;
      columns_.colour = {first, first + 1, first + 2};
    }
    for (const int column : columns_.position) points_.push_back(value(column, number));
    if (columns_.colour[0] < 0 || columns_.colour[1] < 0 || columns_.colour[2] < 0) return;
    for (const int column : columns_.colour) extra_.push_back(value(column, number));
  }

  static bool are_normals(const Points& extra) {
    if (extra.minCoeff() < 0.0f) return true;
    const Eigen::VectorXf length = extra.rowwise().norm();
    return (length.array() - 1.0f).abs().maxCoeff() < 0.01f;
  }

  const std::string& source_;
  Columns columns_;
  int headings_ = 0;
  std::vector<std::string_view> words_;
  std::vector<float> points_, extra_;
};

}  // namespace

/// A cloud from lines of numbers parted by blanks, commas or semicolons. The first three are the position,
/// unless a line of column names says otherwise; colours are taken from columns named so, or from three more
/// numbers that can be no normal. A leading count and lines that start with # or // are stepped over. Throws
/// Error, naming `source`.
Mesh parse_xyz(std::string_view bytes, const std::string& source) {
  US_CHECK(bytes.substr(0, 4096).find('\0') == bytes.npos, source, ": is binary, not lines of numbers");
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") bytes.remove_prefix(3);  // the byte order mark of some editors
  XyzParser parser(source);
  TextCursor text(bytes, source);
  for (int64_t number = 1; !text.at_end(); ++number) parser.line(text.line(), number);
  return parser.finish();
}

}  // namespace understudy
