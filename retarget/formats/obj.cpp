// OBJ, Wavefront's text format: its vertices (with colours where they follow the position) and faces.
#include <vector>

#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

class ObjParser {
 public:
  explicit ObjParser(const std::string& source) : source_(source) {}

  void line(std::string_view text, int64_t number) {
    number_ = number;
    const size_t hash = text.find('#');
    split_words(text.substr(0, hash), "", words_);
    if (words_.empty()) return;
    if (words_[0] == "v") vertex();
    if (words_[0] == "f" || words_[0] == "fo") face();
  }

  Mesh finish() const { return mesh_of(positions_, colours_, faces_, source_); }

 private:
  float value(size_t word) const {
    double value = 0;
    US_CHECK(parse_number(words_[word], value), source_, ": line ", number_, ": '", excerpt(words_[word]),
             "' is not a number");
    return narrow(value);
  }

  // v x y z [w], or with a colour behind: v x y z [w] r g b
  void vertex() {
    US_CHECK(words_.size() >= 4, source_, ": line ", number_, ": a vertex has fewer than three coordinates");
    for (size_t i = 1; i <= 3; ++i) positions_.push_back(value(i));
    if (words_.size() < 7) return;
    for (size_t i = words_.size() - 3; i < words_.size(); ++i) colours_.push_back(value(i));
  }

  // Each corner is vertex[/texture][/normal]; numbers start at 1, negative ones count back from the last
  // vertex.
  void face() {
    const auto vertices = static_cast<int64_t>(positions_.size() / 3);
    corners_.clear();
    for (size_t i = 1; i < words_.size(); ++i) {
      int64_t index = 0;
      US_CHECK(parse_integer(words_[i].substr(0, words_[i].find('/')), index), source_, ": line ", number_,
               ": '", excerpt(words_[i]), "' is not a corner of a face");
      US_CHECK(index != 0 && index >= -vertices, source_, ": line ", number_, ": a face names vertex ", index,
               ", which does not exist");
      corners_.push_back(index > 0 ? index - 1 : vertices + index);
    }
    faces_.add(corners_.data(), corners_.size());
  }

  const std::string& source_;
  int64_t number_ = 0;
  std::vector<std::string_view> words_;
  std::vector<float> positions_, colours_;
  std::vector<int64_t> corners_;
  FaceList faces_;
};

}  // namespace

/// Vertices and faces of all objects and groups of a .obj; materials, lines, curves are ignored. Throws
/// Error, naming `source`.
Mesh parse_obj(std::string_view bytes, const std::string& source) {
  ObjParser parser(source);
  TextCursor text(bytes, source);
  std::string joined;  // lines that end in a backslash go on in the next
  for (int64_t number = 1; !text.at_end(); ++number) {
    const std::string_view line = text.line();
    if (ends_with(line, "\\")) {
      joined.append(line.substr(0, line.size() - 1)).push_back(' ');
      continue;
    }
    parser.line(joined.append(line), number);
    joined.clear();
  }
  if (!joined.empty()) parser.line(joined, 0);
  return parser.finish();
}

// The first words of the lines of an OBJ file, as far as they are seen in its beginning.
bool is_obj(std::string_view bytes) {
  TextCursor text(bytes.substr(0, 65536), "");
  std::vector<std::string_view> words;
  double number = 0;
  while (!text.at_end()) {
    split_words(text.line(), "", words);
    if (words.empty() || words[0][0] == '#') continue;
    if (words[0] == "v") return words.size() >= 4 && parse_number(words[1], number);
    const auto known = {"mtllib", "usemtl", "o", "g", "s", "vn", "vt", "vp", "f", "l", "p"};
    if (std::find(known.begin(), known.end(), words[0]) == known.end()) return false;
  }
  return false;
}

}  // namespace understudy
