#include "retarget/formats/bytes.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace understudy {
namespace {

/// IEEE 754 binary16.
float half_to_float(uint16_t half) {
  const int exponent = half >> 10 & 31, mantissa = half & 1023;
  const float sign = half & 0x8000 ? -1.0f : 1.0f;
  if (exponent == 0) return sign * std::ldexp(static_cast<float>(mantissa), -24);
  if (exponent == 31)
    return mantissa ? std::numeric_limits<float>::quiet_NaN() : sign * std::numeric_limits<float>::infinity();
  return sign * std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
}

template <class T>
double loaded(const char* at, bool swap) {
  return static_cast<double>(load<T>(at, swap));
}

struct TypeRow {
  std::string_view name;  // NumPy's
  size_t size;
  double (*load)(const char* at, bool swap);
};
// In the order of NumberType.
constexpr TypeRow kTypes[] = {
    {"i1", 1, loaded<int8_t>},
    {"u1", 1, loaded<uint8_t>},
    {"i2", 2, loaded<int16_t>},
    {"u2", 2, loaded<uint16_t>},
    {"i4", 4, loaded<int32_t>},
    {"u4", 4, loaded<uint32_t>},
    {"i8", 8, loaded<int64_t>},
    {"u8", 8, loaded<uint64_t>},
    {"f2", 2, [](const char* at, bool swap) -> double { return half_to_float(load<uint16_t>(at, swap)); }},
    {"f4", 4, loaded<float>},
    {"f8", 8, loaded<double>}};

}  // namespace

std::optional<NumberType> number_type(std::string_view descr) {
  for (size_t i = 0; i < std::size(kTypes); ++i)
    if (descr == kTypes[i].name) return static_cast<NumberType>(i);
  return {};
}

size_t size_of(NumberType type) {
  return kTypes[static_cast<size_t>(type)].size;
}

double load_number(NumberType type, const char* at, bool swap) {
  return kTypes[static_cast<size_t>(type)].load(at, swap);
}

float narrow(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (value > kLargest) return std::numeric_limits<float>::infinity();
  if (value < -kLargest) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(value);
}

int64_t whole(double value) {
  return value >= -9e15 && value <= 9e15 ? static_cast<int64_t>(value) : -1;  // false for NaN
}

int json_depth(std::string_view text) {
  int depth = 0, deepest = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

void FaceList::add(int64_t a, int64_t b, int64_t c) {
  for (const int64_t corner : {a, b, c})
    corners_.push_back(corner >= 0 && corner <= std::numeric_limits<int>::max() ? static_cast<int>(corner)
                                                                                : -1);
}

void FaceList::add(const int64_t* corners, size_t count) {
  for (size_t i = 2; i < count; ++i) add(corners[0], corners[i - 1], corners[i]);
}

Faces FaceList::finish(int64_t vertex_count, const std::string& source) const {
  for (const int corner : corners_)
    US_CHECK(corner >= 0 && corner < vertex_count, source, ": a face names ",
             corner < 0 ? "a vertex number out of range" : "vertex " + std::to_string(corner),
             ", the file has ", vertex_count, " vertices");
  return Eigen::Map<const Faces>(corners_.data(), corners_.size() / 3, 3);
}

Points rows_of_three(const std::vector<float>& values) {
  return Eigen::Map<const Points>(values.data(), values.size() / 3, 3);
}

Mesh mesh_of(const std::vector<float>& positions, const std::vector<float>& colours, const FaceList& faces,
             const std::string& source) {
  Mesh mesh;
  mesh.vertices = rows_of_three(positions);
  if (colours.size() == positions.size()) mesh.colors = rows_of_three(colours);
  mesh.faces = faces.finish(mesh.vertices.rows(), source);
  return mesh;
}

}  // namespace understudy
