// PCD, the Point Cloud Library's format: ascii, binary, binary_compressed.
#include <algorithm>
#include <vector>

#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

struct Field {
  std::string name;
  NumberType type = NumberType::F32;
  uint64_t count = 1;
  uint64_t offset = 0;  // inside a point
};

struct PcdHeader {
  std::vector<Field> fields;
  uint64_t points = 0;
  uint64_t stride = 0;   // bytes a point
  uint64_t columns = 0;  // numbers a point
  std::string encoding;
  size_t size = 0;
};

NumberType pcd_number_type(std::string_view kind, int64_t size, const std::string& source) {
  const auto type = number_type(lower_case(kind) + std::to_string(size));
  US_CHECK(type && type != NumberType::F16 && (kind == "F" || kind == "I" || kind == "U"), source,
           ": the header names an unknown type '", excerpt(kind), size, "'");
  return *type;
}

// The header's lines as read, before they are put together.
struct Lines {
  std::vector<std::string> fields, types;
  std::vector<int64_t> sizes, counts;
  int64_t width = -1, height = 1, points = -1;
};

std::vector<int64_t> integers(const std::vector<std::string_view>& words, const std::string& source) {
  std::vector<int64_t> values(words.size() - 1);
  for (size_t i = 1; i < words.size(); ++i)
    US_CHECK(parse_integer(words[i], values[i - 1]) && values[i - 1] >= 0, source, ": '", excerpt(words[i]),
             "' in the header is no count");
  return values;
}

PcdHeader assemble(const Lines& lines, const std::string& source) {
  PcdHeader header;
  const size_t n = lines.fields.size();
  US_CHECK(n > 0 && lines.sizes.size() == n && lines.types.size() == n &&
               (lines.counts.empty() || lines.counts.size() == n),
           source, ": the header's FIELDS, SIZE, TYPE and COUNT lines do not fit together");
  for (size_t i = 0; i < n; ++i) {
    const uint64_t count = lines.counts.empty() ? 1 : static_cast<uint64_t>(lines.counts[i]);
    US_CHECK(count <= 100000 && n <= 10000, source, ": the header says ", n, " fields, one of ", count,
             " numbers");
    header.fields.push_back({lower_case(lines.fields[i]),
                             pcd_number_type(lines.types[i], lines.sizes[i], source), count, header.stride});
    header.stride += count * static_cast<uint64_t>(lines.sizes[i]);
    header.columns += count;
  }
  US_CHECK(header.stride <= 1000000, source, ": the header says ", header.stride, " bytes a point");
  if (lines.points >= 0) {
    header.points = static_cast<uint64_t>(lines.points);
  } else {
    US_CHECK(lines.width >= 0 && lines.width < (int64_t{1} << 31) && lines.height < (int64_t{1} << 31),
             source, ": the header does not say how many points there are");
    header.points = static_cast<uint64_t>(lines.width) * static_cast<uint64_t>(lines.height);
  }
  US_CHECK(header.points < (uint64_t{1} << 31), source, ": the header says ", header.points,
           " points, more than can be read");
  return header;
}

PcdHeader read_pcd_header(std::string_view bytes, const std::string& source) {
  Lines lines;
  TextCursor text(bytes, source);
  std::vector<std::string_view> words;
  while (true) {
    US_CHECK(!text.at_end(), source, ": ends inside the header");
    split_words(text.line(), "", words);
    if (words.empty() || words[0][0] == '#') continue;
    const std::string key = lower_case(words[0]);
    if (key == "fields" || key == "columns") lines.fields.assign(words.begin() + 1, words.end());
    if (key == "type") lines.types.assign(words.begin() + 1, words.end());
    if (key == "size") lines.sizes = integers(words, source);
    if (key == "count") lines.counts = integers(words, source);
    if ((key == "width" || key == "height" || key == "points") && words.size() > 1)
      (key == "width"    ? lines.width
       : key == "height" ? lines.height
                         : lines.points) = integers(words, source)[0];
    if (key != "data") continue;
    US_CHECK(words.size() > 1, source, ": the header's DATA line is cut off");
    PcdHeader header = assemble(lines, source);
    header.encoding = lower_case(words[1]);
    header.size = text.position();
    return header;
  }
}

// LZF (Marc Lehmann): literal runs and back references. Throws when the stream is broken.
std::string lzf_decompress(std::string_view in, uint64_t size, const std::string& source) {
  // A reference of three bytes stands for at most 264: what promises more is a lie, and is not allocated for.
  US_CHECK(size <= in.size() * 88 + 264, source, ": the compressed data cannot hold the ", size,
           " bytes it promises");
  std::string out;
  out.reserve(size);
  size_t at = 0;
  const auto byte = [&]() -> size_t {
    US_CHECK(at < in.size(), source, ": the compressed data is cut off");
    return static_cast<unsigned char>(in[at++]);
  };
  while (at < in.size() && out.size() < size) {
    const size_t control = byte();
    if (control < 32) {
      US_CHECK(control + 1 <= in.size() - at && control + 1 <= size - out.size(), source,
               ": the compressed data is cut off");
      out.append(in.substr(at, control + 1));
      at += control + 1;
      continue;
    }
    size_t length = control >> 5;
    if (length == 7) length += byte();
    const size_t back = ((control & 31) << 8) + byte() + 1;
    length += 2;
    US_CHECK(back <= out.size() && length <= size - out.size(), source, ": the compressed data is broken");
    for (size_t i = 0; i < length; ++i) out.push_back(out[out.size() - back]);
  }
  US_CHECK(out.size() == size, source, ": the compressed data is cut off");
  return out;
}

// How to find a number: first byte of point 0, and bytes from one point to the next.
struct Column {
  const char* begin = nullptr;
  uint64_t step = 0;
  NumberType type = NumberType::F32;
};

const Field* find_field(const PcdHeader& header, const char* name) {
  for (const auto& field : header.fields)
    if (field.name == name && field.count == 1) return &field;
  return nullptr;
}

// Compressed bodies hold one field after the other, plain ones one point after the other.
Column column(const PcdHeader& header, const Field& field, std::string_view body, bool by_field) {
  const uint64_t width = field.count * size_of(field.type);
  if (by_field) return {body.data() + field.offset * header.points, width, field.type};
  return {body.data() + field.offset, header.stride, field.type};
}

const Field& required(const PcdHeader& header, const char* name, const std::string& source) {
  const Field* const field = find_field(header, name);
  US_CHECK(field, source, ": its points have no ", name);
  return *field;
}

const Field* packed_colour(const PcdHeader& header) {
  const Field* field = find_field(header, "rgb");
  if (field == nullptr) field = find_field(header, "rgba");
  return field != nullptr && size_of(field->type) == 4 ? field : nullptr;
}

void unpack_colour(uint32_t packed, Eigen::Index row, Points& colours) {
  for (int c = 0; c < 3; ++c) colours(row, c) = static_cast<float>(packed >> (16 - 8 * c) & 255u) / 255.0f;
}

Mesh read_binary(const PcdHeader& header, std::string_view body, bool by_field, const std::string& source) {
  Mesh mesh;
  const Eigen::Index rows = header.points;
  mesh.vertices.resize(rows, 3);
  int c = 0;
  for (const char* const name : {"x", "y", "z"}) {
    Column from = column(header, required(header, name, source), body, by_field);
    for (Eigen::Index i = 0; i < rows; ++i, from.begin += from.step)
      mesh.vertices(i, c) = narrow(load_number(from.type, from.begin, false));
    ++c;
  }
  if (const Field* const field = packed_colour(header)) {
    mesh.colors.resize(rows, 3);
    Column from = column(header, *field, body, by_field);
    for (Eigen::Index i = 0; i < rows; ++i, from.begin += from.step)
      unpack_colour(load<uint32_t>(from.begin, false), i, mesh.colors);
  }
  return mesh;
}

// Text keeps a packed colour as a whole number, or as the float of the same bits.
uint32_t packed_from_text(double value, NumberType type) {
  if (type != NumberType::F32)
    return static_cast<uint32_t>(std::clamp<int64_t>(whole(value), 0, 0xffffffffll));
  const float bits = narrow(value);
  return load<uint32_t>(reinterpret_cast<const char*>(&bits), false);
}

Mesh read_ascii(const PcdHeader& header, std::string_view body, const std::string& source) {
  const Field* const at[] = {&required(header, "x", source), &required(header, "y", source),
                             &required(header, "z", source)};
  const Field* const colour = packed_colour(header);
  US_CHECK(header.points <= (body.size() + 1) / (2 * header.columns), source, ": the header says ",
           header.points, " points, the file has room for at most ",
           (body.size() + 1) / (2 * header.columns));
  Mesh mesh;
  const Eigen::Index rows = header.points;
  mesh.vertices.resize(rows, 3);
  if (colour) mesh.colors.resize(rows, 3);
  TextCursor text(body, source);
  for (Eigen::Index row = 0; row < rows; ++row)
    for (const Field& field : header.fields)
      for (uint64_t i = 0; i < field.count; ++i) {
        const double value = text.number("the last point that the header promises");
        for (int c = 0; c < 3; ++c)
          if (&field == at[c]) mesh.vertices(row, c) = narrow(value);
        if (&field == colour) unpack_colour(packed_from_text(value, field.type), row, mesh.colors);
      }
  return mesh;
}

}  // namespace

/// A cloud from the bytes of a .pcd, any fields in any order, packed colours; the NaN points of organised
/// clouds are kept. Throws Error, naming `source`.
Mesh parse_pcd(std::string_view bytes, const std::string& source) {
  const PcdHeader header = read_pcd_header(bytes, source);
  const std::string_view body = bytes.substr(header.size);
  if (header.encoding == "ascii") return read_ascii(header, body, source);
  required(header, "x", source);  // so a point has bytes
  const uint64_t size = header.points * header.stride;
  if (header.encoding == "binary") {
    US_CHECK(header.points <= body.size() / header.stride, source, ": the header says ", header.points,
             " points, the file has room for at most ", body.size() / header.stride);
    return read_binary(header, body, false, source);
  }
  US_CHECK(header.encoding == "binary_compressed", source, ": unknown PCD encoding '",
           excerpt(header.encoding), "'");
  US_CHECK(body.size() >= 8, source, ": ends before its compressed data");
  const uint64_t packed = load<uint32_t>(body.data(), false),
                 whole_size = load<uint32_t>(body.data() + 4, false);
  US_CHECK(packed <= body.size() - 8, source, ": its compressed data is cut off");
  US_CHECK(whole_size == size, source, ": its compressed data is ", whole_size,
           " bytes long, its header says ", size);
  return read_binary(header, lzf_decompress(body.substr(8, packed), size, source), true, source);
}

bool is_pcd(std::string_view bytes) {
  TextCursor text(bytes.substr(0, 4096), "");
  text.skip_comments();
  const std::string_view word = text.word();
  if (word == "VERSION" || word == "FIELDS") return true;
  return bytes.substr(0, 7) == "# .PCD ";
}

}  // namespace understudy
