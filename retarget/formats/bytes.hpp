// Reading untrusted bytes and text: files, numbers of any type and byte order, faces.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy {

enum class NumberType { I8, U8, I16, U16, I32, U32, I64, U64, F16, F32, F64 };
/// By NumPy's name without the byte order: "f4"; none where it is no such number.
std::optional<NumberType> number_type(std::string_view descr);
/// Bytes of one number.
size_t size_of(NumberType type);
inline bool is_float(NumberType type) {
  return type >= NumberType::F16;
}

/// One value from unaligned memory; `swap` when its byte order is not this machine's.
template <class T>
T load(const char* at, bool swap) {
  T value;
  if (!swap) {
    std::memcpy(&value, at, sizeof(T));
    return value;
  }
  char turned[sizeof(T)];
  for (size_t i = 0; i < sizeof(T); ++i) turned[i] = at[sizeof(T) - 1 - i];
  std::memcpy(&value, turned, sizeof(T));
  return value;
}
double load_number(NumberType type, const char* at, bool swap);

/// To float without undefined behaviour: what is too large for a float becomes infinite.
float narrow(double value);
/// A count or an index from a file, as a whole number; NaN, fractions' tails and the huge become -1.
int64_t whole(double value);

/// How deep the brackets of a JSON text are nested, those in its strings left out.
int json_depth(std::string_view text);
/// Collects polygons as triangles and checks their indices at the end, when the number of vertices is known.
class FaceList {
 public:
  /// A polygon as a fan; fewer than three corners are no face.
  void add(const int64_t* corners, size_t count);
  void add(int64_t a, int64_t b, int64_t c);
  void reserve(size_t triangles) { corners_.reserve(3 * triangles); }
  /// [F, 3]. Throws Error naming `source` when a face names a vertex that does not exist.
  Faces finish(int64_t vertex_count, const std::string& source) const;

 private:
  std::vector<int> corners_;  // -1: fits no int
};

/// Rows of three from a flat list.
Points rows_of_three(const std::vector<float>& values);
/// A mesh from flat lists; its colours where every vertex has one. Throws Error as FaceList::finish.
Mesh mesh_of(const std::vector<float>& positions, const std::vector<float>& colours, const FaceList& faces,
             const std::string& source);

}  // namespace understudy
