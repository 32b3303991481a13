// PLY, the Stanford format: ascii and binary of both byte orders.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

struct Property {
  std::string name;
  NumberType type = NumberType::F32;
  std::optional<NumberType> count;  // of a list
};

struct Element {
  std::string name;
  int64_t rows = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  bool ascii = false, swap = false;
  std::vector<Element> elements;
  size_t size = 0;
};

NumberType ply_number_type(std::string_view name, const std::string& source) {
  static const std::pair<const char*, NumberType> kNames[] = {
      {"char", NumberType::I8},     {"int8", NumberType::I8},    {"uchar", NumberType::U8},
      {"uint8", NumberType::U8},    {"short", NumberType::I16},  {"int16", NumberType::I16},
      {"ushort", NumberType::U16},  {"uint16", NumberType::U16}, {"int", NumberType::I32},
      {"int32", NumberType::I32},   {"uint", NumberType::U32},   {"uint32", NumberType::U32},
      {"int64", NumberType::I64},   {"uint64", NumberType::U64}, {"float", NumberType::F32},
      {"float32", NumberType::F32}, {"double", NumberType::F64}, {"float64", NumberType::F64}};
  for (const auto& [known, type] : kNames)
    if (name == known) return type;
  throw Error(source + ": the header names an unknown type '" + excerpt(name) + "'");
}

void read_format(const std::vector<std::string_view>& words, PlyHeader& header, const std::string& source) {
  US_CHECK(words.size() >= 2, source, ": the header's format line is cut off");
  header.ascii = words[1] == "ascii";
  header.swap = words[1] == "binary_big_endian";
  US_CHECK(header.ascii || header.swap || words[1] == "binary_little_endian", source,
           ": unknown PLY format '", excerpt(words[1]), "'");
}

Property read_property(const std::vector<std::string_view>& words, const std::string& source) {
  const bool list = words.size() >= 2 && words[1] == "list";
  US_CHECK(words.size() >= (list ? 5u : 3u), source, ": a property line of the header is cut off");
  if (!list) return {lower_case(words[2]), ply_number_type(words[1], source), {}};
  return {lower_case(words[4]), ply_number_type(words[3], source), ply_number_type(words[2], source)};
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& source) {
  PlyHeader header;
  bool has_format = false;
  TextCursor text(bytes, source);
  std::vector<std::string_view> words;
  text.line();  // "ply"
  while (true) {
    US_CHECK(!text.at_end(), source, ": ends inside the header");
    split_words(text.line(), "", words);
    if (words.empty()) continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      read_format(words, header, source);
      has_format = true;
    } else if (words[0] == "element") {
      int64_t rows = -1;
      US_CHECK(words.size() >= 3 && parse_integer(words[2], rows) && rows >= 0, source,
               ": an element line of the header has no count");
      header.elements.push_back({lower_case(words[1]), rows, {}});
    } else if (words[0] == "property") {
      US_CHECK(!header.elements.empty(), source, ": a property comes before the first element");
      header.elements.back().properties.push_back(read_property(words, source));
    }
  }
  US_CHECK(has_format, source, ": the header does not say its format");
  header.size = text.position();
  return header;
}

// The values of a body one after the other, whatever its encoding.
class Values {
 public:
  Values(std::string_view body, const PlyHeader& header, const std::string& source)
      : body_(body), ascii_(header.ascii), swap_(header.swap), source_(source), text_(body, source) {}

  double next(NumberType type) {
    if (ascii_) return text_.number("the last value that the header promises");
    const size_t size = size_of(type);
    US_CHECK(size <= body_.size() - at_, source_, ": ends before the last value that the header promises");
    const double value = load_number(type, body_.data() + at_, swap_);
    at_ += size;
    return value;
  }
  size_t list_size(const Property& list) {
    const int64_t count = whole(next(*list.count));
    const size_t least = ascii_ ? 2 : size_of(list.type);
    US_CHECK(count >= 0 && static_cast<uint64_t>(count) <= (left() + 1) / least, source_,
             ": a list is longer than the file");
    return static_cast<size_t>(count);
  }
  /// Rows that are all so long, of a binary body, at once; null where they are not.
  const char* rows(const Element& element, size_t row_size) {
    if (ascii_) return nullptr;
    const char* const first = body_.data() + at_;
    at_ += row_size * static_cast<size_t>(element.rows);  // check_rows knows that they are there
    return first;
  }
  bool swapped() const { return swap_; }
  // Throws when so many rows cannot be in what is left: counts are checked before anything is allocated for
  // them.
  void check_rows(const Element& element) const {
    uint64_t least = 0;
    for (const auto& p : element.properties) least += ascii_ ? 2 : size_of(p.count ? *p.count : p.type);
    const uint64_t room = (left() + (ascii_ ? 1 : 0)) / std::max<uint64_t>(least, 1);
    US_CHECK(least == 0 || static_cast<uint64_t>(element.rows) <= room, source_, ": the header says ",
             element.rows, " rows of '", excerpt(element.name), "', the file has room for at most ", room);
  }

 private:
  size_t left() const { return ascii_ ? text_.left() : body_.size() - at_; }

  std::string_view body_;
  bool ascii_, swap_;
  const std::string& source_;
  TextCursor text_;
  size_t at_ = 0;
};

/// Every row's properties in turn: use(row, number of the property, its value or the values of its list).
template <class Use>
void read_rows(const Element& element, Values& values, Use use) {
  if (element.properties.empty()) return;
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < element.rows; ++row)
    for (size_t i = 0; i < element.properties.size(); ++i) {
      const Property& p = element.properties[i];
      numbers.resize(p.count ? values.list_size(p) : 1);
      for (double& number : numbers) number = values.next(p.type);
      use(row, i, numbers);
    }
}

// Where a property of the vertex element goes: 0..2 position, 3..5 colour, -1 nowhere.
int slot_of(const std::string& name) {
  static const std::pair<const char*, int> kSlots[] = {{"x", 0}, {"red", 3},   {"r", 3}, {"diffuse_red", 3},
                                                       {"y", 1}, {"green", 4}, {"g", 4}, {"diffuse_green", 4},
                                                       {"z", 2}, {"blue", 5},  {"b", 5}, {"diffuse_blue", 5}};
  for (const auto& [known, slot] : kSlots)
    if (name == known) return slot;
  return -1;
}

struct VertexLayout {
  std::vector<int> slot;  // of each property
  std::array<int, 6> property = {-1, -1, -1, -1, -1, -1};
  bool has_colours = false;
};

VertexLayout vertex_layout(const Element& element, const std::string& source) {
  VertexLayout layout;
  for (size_t i = 0; i < element.properties.size(); ++i) {
    const Property& p = element.properties[i];
    int slot = slot_of(p.name);
    if (p.count || (slot >= 0 && layout.property[slot] >= 0))
      slot = -1;  // a list, or the second of this name
    if (slot >= 0) layout.property[slot] = i;
    layout.slot.push_back(slot);
  }
  const auto& at = layout.property;
  US_CHECK(at[0] >= 0 && at[1] >= 0 && at[2] >= 0, source, ": its vertices have no x, y and z");
  layout.has_colours = at[3] >= 0 && at[4] >= 0 && at[5] >= 0;
  return layout;
}

float colour_scale(NumberType type) {
  if (is_float(type)) return 1;
  return size_of(type) == 1 ? 1 / 255.0f : 1 / 65535.0f;
}

/// Bytes of each row; 0 where lists make them differ.
size_t row_size_of(const Element& element) {
  size_t size = 0;
  for (const Property& p : element.properties) {
    if (p.count) return 0;
    size += size_of(p.type);
  }
  return size;
}

/// One property of all rows, `row_size` bytes apart.
template <class Column>
void read_column(const char* at, size_t row_size, NumberType type, bool swap, Column column) {
  const bool plain = type == NumberType::F32 && !swap;  // what nearly all files have
  for (Eigen::Index row = 0; row < column.rows(); ++row, at += row_size)
    column[row] = plain ? load<float>(at, false) : narrow(load_number(type, at, swap));
}

/// As read_rows, a column at a time; false where rows are not all as long.
bool read_columns(const Element& element, const VertexLayout& layout, Values& values, Mesh& mesh) {
  const size_t row_size = row_size_of(element);
  const char* const first = row_size > 0 ? values.rows(element, row_size) : nullptr;
  if (!first) return false;
  size_t offset = 0;
  for (size_t i = 0; i < element.properties.size(); ++i) {
    const NumberType type = element.properties[i].type;
    const int slot = layout.slot[i];
    if (slot >= 0 && slot < 3)
      read_column(first + offset, row_size, type, values.swapped(), mesh.vertices.col(slot));
    else if (slot >= 3 && layout.has_colours)
      read_column(first + offset, row_size, type, values.swapped(), mesh.colors.col(slot - 3));
    offset += size_of(type);
  }
  return true;
}

void read_vertices(const Element& element, Values& values, Mesh& mesh, const std::string& source) {
  const VertexLayout layout = vertex_layout(element, source);
  US_CHECK(mesh.vertices.rows() == 0, source, ": has two lists of vertices");
  US_CHECK(element.rows < (int64_t{1} << 31), source, ": has more than 2 billion vertices");
  mesh.vertices.resize(element.rows, 3);
  if (layout.has_colours) mesh.colors.resize(element.rows, 3);
  if (!read_columns(element, layout, values, mesh))
    read_rows(element, values, [&](Eigen::Index row, size_t property, const std::vector<double>& numbers) {
      const int slot = layout.slot[property];
      if (slot >= 0 && slot < 3) mesh.vertices(row, slot) = narrow(numbers[0]);
      if (slot >= 3 && layout.has_colours) mesh.colors(row, slot - 3) = narrow(numbers[0]);
    });
  if (!layout.has_colours) return;
  for (int c = 0; c < 3; ++c)
    mesh.colors.col(c) *= colour_scale(element.properties[layout.property[3 + c]].type);
}

// -1 in a strip starts a new one; every second triangle is turned.
void add_strip(const std::vector<int64_t>& strip, FaceList& faces) {
  size_t begin = 0;
  for (size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] == -1) {
      begin = i + 1;
    } else if (i >= begin + 2) {
      const bool odd = (i - begin) % 2 == 1;
      faces.add(strip[i - 2 + (odd ? 1 : 0)], strip[i - 2 + (odd ? 0 : 1)], strip[i]);
    }
  }
}

void read_faces(const Element& element, bool strips, Values& values, FaceList& faces) {
  if (!strips && !element.properties.empty()) faces.reserve(element.rows);
  std::vector<int64_t> corners;
  read_rows(element, values, [&](Eigen::Index, size_t property, const std::vector<double>& numbers) {
    const Property& p = element.properties[property];
    if (!p.count || (p.name != "vertex_indices" && p.name != "vertex_index")) return;
    corners.resize(numbers.size());
    std::transform(numbers.begin(), numbers.end(), corners.begin(), whole);
    if (strips)
      add_strip(corners, faces);
    else
      faces.add(corners.data(), corners.size());
  });
}

bool is_wanted(const Element& element) {
  return element.name == "vertex" || element.name == "face" || element.name == "tristrips";
}

}  // namespace

/// A mesh or cloud from the bytes of a .ply: properties of any type in any order, polygons as fans, triangle
/// strips, colours where there are any; all other elements are stepped over. NaN and infinite coordinates are
/// kept. Throws Error, naming `source`.
Mesh parse_ply(std::string_view bytes, const std::string& source) {
  const PlyHeader header = read_ply_header(bytes, source);
  Values values(bytes.substr(header.size), header, source);
  size_t wanted = 0;
  for (const auto& element : header.elements) wanted += is_wanted(element);

  Mesh mesh;
  FaceList faces;
  bool has_vertices = false;
  for (const auto& element : header.elements) {
    if (wanted == 0) break;  // what follows is of no interest, whole or not
    values.check_rows(element);
    if (element.name == "vertex") {
      read_vertices(element, values, mesh, source);
      has_vertices = true;
    } else if (is_wanted(element)) {
      read_faces(element, element.name == "tristrips", values, faces);
    } else {
      read_rows(element, values, [](Eigen::Index, size_t, const std::vector<double>&) {});
    }
    wanted -= is_wanted(element);
  }
  US_CHECK(has_vertices, source, ": the header names no vertices");
  mesh.faces = faces.finish(mesh.vertices.rows(), source);
  return mesh;
}

}  // namespace understudy
