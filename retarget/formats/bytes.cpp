#include "retarget/formats/bytes.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace

std::optional<NumberType> number_type(std::string_view descr) {
  static const std::pair<const char*, NumberType> kTypes[] = {
      {"f2", NumberType::F16}, {"f4", NumberType::F32}, {"f8", NumberType::F64}, {"i1", NumberType::I8},
      {"u1", NumberType::U8},  {"i2", NumberType::I16}, {"u2", NumberType::U16}, {"i4", NumberType::I32},
      {"u4", NumberType::U32}, {"i8", NumberType::I64}, {"u8", NumberType::U64}};
  for (const auto& [name, type] : kTypes)
    if (descr == name) return type;
  return {};
}

size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::I8:
    case NumberType::U8:
      return 1;
    case NumberType::I16:
    case NumberType::U16:
    case NumberType::F16:
      return 2;
    case NumberType::I32:
    case NumberType::U32:
    case NumberType::F32:
      return 4;
    default:
      return 8;
  }
}

double load_number(NumberType type, const char* at, bool swap) {
  switch (type) {
    case NumberType::I8:
      return load<int8_t>(at, false);
    case NumberType::U8:
      return load<uint8_t>(at, false);
    case NumberType::I16:
      return load<int16_t>(at, swap);
    case NumberType::U16:
      return load<uint16_t>(at, swap);
    case NumberType::I32:
      return load<int32_t>(at, swap);
    case NumberType::U32:
      return load<uint32_t>(at, swap);
    case NumberType::I64:
      return static_cast<double>(load<int64_t>(at, swap));
    case NumberType::U64:
      return static_cast<double>(load<uint64_t>(at, swap));
    case NumberType::F16:
      return half_to_float(load<uint16_t>(at, swap));
    case NumberType::F32:
      return load<float>(at, swap);
    case NumberType::F64:
      return load<double>(at, swap);
  }
  return 0;
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

}  // namespace understudy
