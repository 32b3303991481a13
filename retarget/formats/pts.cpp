// PTS, the text format of Leica's Cyclone and other laser scanners.
#include <array>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {

Mesh parse_xyz(std::string_view bytes, const std::string& source);  // xyz.cpp

namespace {

constexpr int64_t kShortestPoint = 6;  // bytes: "0 0 0\n"

class PtsParser {
 public:
  PtsParser(std::string_view bytes, const std::string& source) : text_(bytes, source), source_(source) {}

  Mesh parse() {
    text_.skip_comments();
    while (!text_.at_end()) {
      scan();
      text_.skip_comments();
    }
    Mesh mesh;
    US_CHECK(!points_.empty(), source_, ": has no points in it");
    mesh.vertices = rows_of_three(points_);
    if (colours_.size() == points_.size()) mesh.colors = rows_of_three(colours_) / 255.0f;
    return mesh;
  }

 private:
  /// One scan: its count, then a point a line.
  void scan() {
    int64_t count = 0;
    const std::string_view line = text_.line();
    split_words(line, "", words_);
    US_CHECK(words_.size() == 1 && parse_integer(words_[0], count) && count >= 0, source_, ": '",
             excerpt(line), "' is not a count of points");
    US_CHECK(count <= static_cast<int64_t>(text_.left()) / kShortestPoint + 1, source_, ": announces ", count,
             " points, but is too short for them");
    for (int64_t i = 0; i < count; ++i) {
      US_CHECK(!text_.at_end(), source_, ": ends before point ", i + 1, " of ", count);
      point(text_.line());
    }
  }

  /// x y z [intensity] [r g b], colours 0..255.
  void point(std::string_view line) {
    split_words(line, "", words_);
    US_CHECK(words_.size() >= 3 && words_.size() <= 7 && words_.size() != 5, source_, ": '", excerpt(line),
             "' is not a point");
    std::array<double, 7> values{};
    for (size_t i = 0; i < words_.size(); ++i)
      US_CHECK(parse_number(words_[i], values[i]), source_, ": '", excerpt(words_[i]), "' is not a number");
    for (size_t i = 0; i < 3; ++i) points_.push_back(narrow(values[i]));
    if (words_.size() < 6) return;
    for (size_t i = words_.size() - 3; i < words_.size(); ++i) colours_.push_back(narrow(values[i]));
  }

  TextCursor text_;
  const std::string& source_;
  std::vector<std::string_view> words_;
  std::vector<float> points_, colours_;
};

}  // namespace

/// A cloud of one scan or several behind each other;
/// colours where every point has them, intensities are left out.
/// Without a count in front, as some programs write it, it is XYZ. Throws Error, naming `source`.
Mesh parse_pts(std::string_view bytes, const std::string& source) {
  TextCursor text(bytes, source);
  text.skip_comments();
  std::vector<std::string_view> words;
  split_words(text.line(), "", words);
  return words.size() == 1 ? PtsParser(bytes, source).parse() : parse_xyz(bytes, source);
}

}  // namespace understudy
