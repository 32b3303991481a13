// OFF, Geomview's format, ascii and binary, with its prefixes for colours, normals and texture coordinates.
#include <utility>
#include <vector>

#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

struct OffHeader {
  bool texture = false, colours = false, normals = false, binary = false;
  int64_t vertices = 0, faces = 0;
};

// [ST][C][N]OFF; the 4 and n of higher dimensions are refused.
OffHeader read_keyword(std::string_view keyword, const std::string& source) {
  OffHeader header;
  US_CHECK(keyword.size() >= 3 && keyword.substr(keyword.size() - 3) == "OFF", source,
           ": does not begin with OFF");
  std::string_view prefix = keyword.substr(0, keyword.size() - 3);
  const std::pair<std::string_view, bool*> flags[] = {
      {"ST", &header.texture}, {"C", &header.colours}, {"N", &header.normals}};
  for (const auto& [letters, flag] : flags) {
    *flag = starts_with(prefix, letters);
    if (*flag) prefix.remove_prefix(letters.size());
  }
  US_CHECK(prefix.empty(), source, ": ", excerpt(keyword), " is a kind of OFF that is not read");
  return header;
}

// Counts are checked against the bytes that are left before anything is allocated for them.
void check_counts(const OffHeader& header, uint64_t left, uint64_t vertex_bytes, uint64_t face_bytes,
                  const std::string& source) {
  US_CHECK(header.vertices >= 0 && header.faces >= 0, source, ": the header has a negative count");
  US_CHECK(static_cast<uint64_t>(header.vertices) <= left / vertex_bytes, source, ": the header says ",
           header.vertices, " vertices, the file has room for at most ", left / vertex_bytes);
  US_CHECK(static_cast<uint64_t>(header.faces) <= left / face_bytes, source, ": the header says ",
           header.faces, " faces, the file has room for at most ", left / face_bytes);
}

// Colours are whole numbers to 255 or fractions to 1, and only all of them together tell which.
void scale_colours(Points& colours) {
  if (colours.rows() > 0 && colours.maxCoeff() > 1.0f) colours /= 255.0f;
}

class AsciiOff {
 public:
  AsciiOff(TextCursor text, const OffHeader& header, const std::string& source)
      : text_(std::move(text)), header_(header), source_(source) {}

  Mesh read() {
    Mesh mesh;
    mesh.vertices.resize(header_.vertices, 3);
    for (int64_t i = 0; i < header_.vertices; ++i) vertex(i, mesh);
    scale_colours(mesh.colors);
    FaceList faces;
    faces.reserve(header_.faces);
    for (int64_t i = 0; i < header_.faces; ++i) face(i, faces);
    mesh.faces = faces.finish(mesh.vertices.rows(), source_);
    return mesh;
  }

 private:
  void next_line(const char* what, int64_t row) {
    text_.skip_comments();
    US_CHECK(!text_.at_end(), source_, ": ends before ", what, " ", row);
    const std::string_view line = text_.line();
    split_words(line.substr(0, line.find('#')), "", words_);
  }

  double value(size_t word, const char* what, int64_t row) const {
    double value = 0;
    US_CHECK(word < words_.size(), source_, ": ", what, " ", row, " is cut off");
    US_CHECK(parse_number(words_[word], value), source_, ": ", what, " ", row, " has '",
             excerpt(words_[word]), "' in place of a number");
    return value;
  }

  // Position, normal, colour, texture. Many writers put colours into a plain OFF: six or seven numbers a
  // line.
  void vertex(int64_t row, Mesh& mesh) {
    next_line("vertex", row);
    for (int c = 0; c < 3; ++c) mesh.vertices(row, c) = narrow(value(c, "vertex", row));
    const bool plain = !header_.normals && !header_.texture && (words_.size() == 6 || words_.size() == 7);
    if (row == 0 && (header_.colours || plain)) mesh.colors.resize(header_.vertices, 3);
    if (mesh.colors.rows() == 0) return;
    const size_t first = header_.normals ? 6 : 3;
    for (size_t c = 0; c < 3; ++c) mesh.colors(row, c) = narrow(value(first + c, "vertex", row));
  }

  void face(int64_t row, FaceList& faces) {
    next_line("face", row);
    const int64_t count = whole(value(0, "face", row));
    US_CHECK(count >= 0 && static_cast<size_t>(count) < words_.size(), source_, ": face ", row,
             " is cut off");
    corners_.clear();
    for (size_t i = 1; i <= static_cast<size_t>(count); ++i) corners_.push_back(whole(value(i, "face", row)));
    faces.add(corners_.data(), corners_.size());
  }

  TextCursor text_;
  const OffHeader& header_;
  const std::string& source_;
  std::vector<std::string_view> words_;
  std::vector<int64_t> corners_;
};

// Geomview's binary OFF: 32-bit big-endian integers and floats.
class BinaryOff {
 public:
  BinaryOff(std::string_view body, OffHeader header, const std::string& source)
      : body_(body), header_(header), source_(source) {}

  Mesh read() {
    header_.vertices = integer();
    header_.faces = integer();
    integer();  // edges
    const size_t floats =
        3 + (header_.normals ? 3 : 0) + (header_.colours ? 4 : 0) + (header_.texture ? 2 : 0);
    check_counts(header_, body_.size() - at_, 4 * floats, 4, source_);
    Mesh mesh;
    mesh.vertices.resize(header_.vertices, 3);
    if (header_.colours) mesh.colors.resize(header_.vertices, 3);
    const size_t colour = header_.normals ? 6 : 3;
    for (Eigen::Index row = 0; row < header_.vertices; ++row)
      for (size_t i = 0; i < floats; ++i) {
        const float value = load<float>(take(), true);
        if (i < 3) mesh.vertices(row, i) = value;
        if (header_.colours && i >= colour && i < colour + 3) mesh.colors(row, i - colour) = value;
      }
    scale_colours(mesh.colors);
    FaceList faces;
    faces.reserve(header_.faces);
    for (int64_t row = 0; row < header_.faces; ++row) face(faces);
    mesh.faces = faces.finish(mesh.vertices.rows(), source_);
    return mesh;
  }

 private:
  const char* take() {
    US_CHECK(body_.size() - at_ >= 4, source_, ": ends before the last value that the header promises");
    at_ += 4;
    return body_.data() + at_ - 4;
  }
  int32_t integer() { return load<int32_t>(take(), true); }
  size_t length() {
    const int32_t count = integer();
    US_CHECK(count >= 0 && static_cast<size_t>(count) <= (body_.size() - at_) / 4, source_,
             ": a face is longer than the file");
    return static_cast<size_t>(count);
  }

  void face(FaceList& faces) {
    corners_.resize(length());
    for (auto& corner : corners_) corner = integer();
    for (size_t n = length(); n > 0; --n) take();  // its colour
    faces.add(corners_.data(), corners_.size());
  }

  std::string_view body_;
  OffHeader header_;
  const std::string& source_;
  size_t at_ = 0;
  std::vector<int64_t> corners_;
};

}  // namespace

/// A mesh or cloud from the bytes of a .off ([ST][C][N]OFF [BINARY]). Throws Error, naming `source`.
Mesh parse_off(std::string_view bytes, const std::string& source) {
  TextCursor text(bytes, source);
  text.skip_comments();
  OffHeader header = read_keyword(text.word(), source);
  TextCursor ahead = text;
  if (ahead.word() == "BINARY") {
    ahead.line();
    header.binary = true;
    return BinaryOff(bytes.substr(ahead.position()), header, source).read();
  }
  text.skip_comments();
  header.vertices = text.integer("the number of vertices");
  header.faces = text.integer("the number of faces");
  text.line();  // the number of edges, which some writers leave out
  check_counts(header, text.left() + 1, 6, 2, source);
  return AsciiOff(text, header, source).read();
}

bool is_off(std::string_view bytes) {
  TextCursor text(bytes.substr(0, 4096), "");
  text.skip_comments();
  const std::string_view word = text.word();
  if (word.size() > 8 || word.size() < 3 || !ends_with(word, "OFF")) return false;
  return word.find_first_not_of("STCN4nOF") == word.npos;
}

}  // namespace understudy
