// STL, ascii and binary.
#include <array>
#include <unordered_map>
#include <vector>

#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

constexpr size_t kStlHeaderBytes = 84, kFaceBytes = 50;

// Corners at exactly the same position become one vertex.
class VertexMerger {
 public:
  int64_t add(const std::array<float, 3>& position) {
    std::array<float, 3> at = position;
    for (float& value : at) value += 0.0f;  // -0 is 0
    const std::string key(reinterpret_cast<const char*>(at.data()), sizeof at);
    const auto [found, is_new] = index_.try_emplace(key, static_cast<int64_t>(index_.size()));
    if (is_new) positions_.insert(positions_.end(), position.begin(), position.end());
    return found->second;
  }
  void reserve(size_t corners) { index_.reserve(corners / 6 + 16); }
  const std::vector<float>& positions() const { return positions_; }

 private:
  std::unordered_map<std::string, int64_t> index_;  // by the bytes of the position
  std::vector<float> positions_;
};

Mesh parse_binary(std::string_view bytes, const std::string& source) {
  const uint64_t count = load<uint32_t>(bytes.data() + kStlHeaderBytes - 4, false);
  const uint64_t room = (bytes.size() - kStlHeaderBytes) / kFaceBytes;
  US_CHECK(count <= room, source, ": the header says ", count, " triangles, the file has ", room);
  VertexMerger merger;
  merger.reserve(3 * count);
  FaceList faces;
  faces.reserve(count);
  for (uint64_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + kStlHeaderBytes + i * kFaceBytes + 12;  // behind the normal
    std::array<int64_t, 3> corners{};
    for (auto& corner : corners) {
      corner = merger.add({load<float>(at, false), load<float>(at + 4, false), load<float>(at + 8, false)});
      at += 12;
    }
    faces.add(corners[0], corners[1], corners[2]);
  }
  return mesh_of(merger.positions(), {}, faces, source);
}

Mesh parse_ascii(std::string_view bytes, const std::string& source) {
  TextCursor text(bytes, source);
  VertexMerger merger;
  FaceList faces;
  std::vector<int64_t> corners;
  bool in_facet = false, ended = false;
  while (true) {
    const std::string_view raw = text.word();
    if (raw.empty()) break;
    if (raw == "solid" || raw == "SOLID" || raw == "endsolid" || raw == "ENDSOLID") {
      ended = raw[0] == 'e' || raw[0] == 'E';
      text.line();  // its name, whatever the words in it
      continue;
    }
    const std::string word = lower_case(raw);
    if (word == "facet") {
      in_facet = true;
      corners.clear();
    } else if (word == "vertex") {
      std::array<float, 3> position{};
      for (auto& value : position) value = narrow(text.number("a coordinate of a vertex"));
      corners.push_back(merger.add(position));
    } else if (word == "endfacet") {
      faces.add(corners.data(), corners.size());
      in_facet = false;
    }
  }
  US_CHECK(!in_facet, source, ": ends inside a facet");
  US_CHECK(ended, source, ": ends before 'endsolid'");
  return mesh_of(merger.positions(), {}, faces, source);
}

bool is_ascii(std::string_view bytes) {
  if (lower_case(bytes.substr(0, 5)) != "solid") return false;
  if (bytes.size() < kStlHeaderBytes) return true;
  // Some binary files begin with "solid" too: their size gives them away, or a zero in what should be text.
  const uint64_t count = load<uint32_t>(bytes.data() + kStlHeaderBytes - 4, false);
  if (bytes.size() == kStlHeaderBytes + count * kFaceBytes) return false;
  return bytes.substr(0, 512).find('\0') == bytes.npos;
}

}  // namespace

/// A mesh from the bytes of a .stl; corners at exactly the same position become one vertex. Throws Error,
/// naming `source`.
Mesh parse_stl(std::string_view bytes, const std::string& source) {
  if (is_ascii(bytes)) return parse_ascii(bytes, source);
  US_CHECK(bytes.size() >= kStlHeaderBytes, source, ": is too short for an STL file");
  return parse_binary(bytes, source);
}

// Ascii STL says "solid", and so may any text: a facet must follow. Binary STL has no sign but its size.
bool is_stl(std::string_view bytes) {
  if (lower_case(bytes.substr(0, 5)) == "solid") {
    const std::string start = lower_case(bytes.substr(0, 1024));
    if (start.find("facet") != start.npos || start.find("endsolid") != start.npos) return true;
  }
  return bytes.size() >= 84 && bytes.size() == 84 + 50ull * load<uint32_t>(bytes.data() + 80, false);
}

}  // namespace understudy
