// What the tests of the formats share: a folder that goes away, files by hand, a look at the warnings.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/geometry/mesh.hpp"

namespace understudy::test {

class TempFolder {
 public:
  TempFolder() {
    char name[] = "/tmp/understudy_XXXXXX";
    path_ = ::mkdtemp(name);
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string path(const std::string& name = "") const { return name.empty() ? path_ : path_ + "/" + name; }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

 private:
  std::string path_;
};

// Collects warnings while it lives, in place of stderr.
class Warnings {
 public:
  Warnings()
      : before_(log::set_sink([this](log::Level, const std::string& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          all_ += message + "\n";
        })) {}
  ~Warnings() { log::set_sink(before_); }
  bool contain(const std::string& text) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return all_.find(text) != std::string::npos;
  }

 private:
  std::mutex mutex_;
  std::string all_;
  log::Sink before_;
};

template <class T>
std::string bytes_of(T value, bool big = false) {
  std::string out(sizeof(T), '\0');
  std::memcpy(out.data(), &value, sizeof(T));
  if (big) std::reverse(out.begin(), out.end());
  return out;
}

// What the Error says; empty when there was none.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A tetrahedron: what most of the files below hold.
inline Points four_points() {
  Points points(4, 3);
  points << 0, 0, 0, 1.5f, 0, 0, 0, 2.25f, 0, -0.5f, 0, 1e-3f;
  return points;
}
inline Faces four_faces() {
  Faces faces(4, 3);
  faces << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
  return faces;
}

// A tetrahedron as text, a line a point or face.
inline std::string point_lines() {
  return "0 0 0\n1.5 0 0\n0 2.25 0\n-0.5 0 1e-3\n";
}
inline std::string face_lines() {
  return "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}

inline std::string ascii_ply(const std::string& vertex_count = "4") {
  return "ply\nformat ascii 1.0\ncomment by hand\nelement vertex " + vertex_count +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
         "property list uchar int vertex_indices\nend_header\n" +
         point_lines() + face_lines();
}

inline std::string binary_ply(bool big) {
  std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                    "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const Points points = four_points();
  for (int i = 0; i < 12; ++i) out += bytes_of(points.data()[i], big);
  const Faces faces = four_faces();
  for (int f = 0; f < 4; ++f) {
    out += '\3';
    for (int c = 0; c < 3; ++c) out += bytes_of(faces(f, c), big);
  }
  return out;
}

inline std::string obj_text() {
  return "# by hand\nmtllib none.mtl\no thing\nv 0 0 0\nv 1.5 0 0\nv 0 2.25 0\nv -0.5 0 1e-3\nvn 0 0 1\n"
         "f 1 3 2\nf 1/1 2/2 4/4\nf 2//1 3//1 4//1\nf -4 -1 -2\n";
}

inline std::string off_text() {
  return "OFF\n# by hand\n4 4 6\n" + point_lines() + face_lines();
}

inline std::string binary_off() {
  std::string out = "OFF BINARY\n" + bytes_of(4, true) + bytes_of(4, true) + bytes_of(6, true);
  const Points points = four_points();
  for (int i = 0; i < 12; ++i) out += bytes_of(points.data()[i], true);
  const Faces faces = four_faces();
  for (int f = 0; f < 4; ++f) {
    out += bytes_of(3, true);
    for (int c = 0; c < 3; ++c) out += bytes_of(faces(f, c), true);
    out += bytes_of(0, true);
  }
  return out;
}

inline std::string ascii_stl() {
  std::string out = "solid by hand\n";
  const Points points = four_points();
  const Faces faces = four_faces();
  for (int f = 0; f < 4; ++f) {
    out += "facet normal 0 0 0\n outer loop\n";
    for (int c = 0; c < 3; ++c) {
      const auto p = points.row(faces(f, c));
      out += "  vertex " + detail::join(p.x(), " ", p.y(), " ", p.z()) + "\n";
    }
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid by hand\n";
}

inline std::string binary_stl(const std::string& title = "by hand") {
  std::string out = title + std::string(80 - title.size(), '\0') + bytes_of(uint32_t{4});
  const Points points = four_points();
  const Faces faces = four_faces();
  for (int f = 0; f < 4; ++f) {
    out += std::string(12, '\0');
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) out += bytes_of(points(faces(f, c), k));
    out += std::string(2, '\0');
  }
  return out;
}

inline std::string pcd_header(const std::string& encoding) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4\nHEIGHT 1\n"
         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA " +
         encoding + "\n";
}

inline std::string binary_pcd() {
  std::string out = pcd_header("binary");
  const Points points = four_points();
  for (int i = 0; i < 12; ++i) out += bytes_of(points.data()[i]);
  return out;
}

// Compressed by hand: field after field; x as literals, a back reference of six zeros where they repeat.
inline std::string compressed_pcd() {
  const Points points = four_points();
  std::string plain;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 4; ++i) plain += bytes_of(points(i, c));
  std::string packed;
  packed += static_cast<char>(32 - 1);
  packed += plain.substr(0, 32);  // x and y
  packed += static_cast<char>(10 - 1);
  packed += plain.substr(32, 10);                          // ten zeros of z
  packed += std::string{static_cast<char>(0), plain[42]};  // one more, as a literal of one
  packed += std::string{static_cast<char>(0), plain[43]};
  packed += static_cast<char>(4 - 1);
  packed += plain.substr(44, 4);
  return pcd_header("binary_compressed") + bytes_of(static_cast<uint32_t>(packed.size())) +
         bytes_of(static_cast<uint32_t>(plain.size())) + packed;
}

inline std::string base64(const std::string& bytes) {
  static const char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (int k = 3; k >= 0; --k) {
      const size_t at = i + static_cast<size_t>(3 - k);
      out += at > bytes.size() ? '=' : kAlphabet[bits >> (6 * k) & 63u];
    }
  }
  return out;
}

inline std::string gltf_buffer() {
  std::string bytes;
  const Points points = four_points();
  for (int i = 0; i < 12; ++i) bytes += bytes_of(points.data()[i]);  // 48 bytes
  const Faces faces = four_faces();
  for (int i = 0; i < 12; ++i) bytes += bytes_of(static_cast<uint16_t>(faces.data()[i]));  // 24 bytes
  return bytes;
}

// A scene of one mesh; `node` goes into its node, `more` into the root object, `uri` into the buffer.
inline std::string gltf_json(const std::string& node, const std::string& uri, const std::string& more = "") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
         R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
         R"("buffers":[{"byteLength":72)" +
         uri + "}]" + more + "}";
}
inline std::string gltf_text(const std::string& node = "") {
  return gltf_json(node, R"(,"uri":"data:application/octet-stream;base64,)" + base64(gltf_buffer()) + "\"");
}
inline std::string glb_bytes(const std::string& node = "") {
  std::string json = gltf_json(node, "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string binary = gltf_buffer();
  return "glTF" + bytes_of(uint32_t{2}) + bytes_of(static_cast<uint32_t>(28 + json.size() + binary.size())) +
         bytes_of(static_cast<uint32_t>(json.size())) + "JSON" + json +
         bytes_of(static_cast<uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
}

struct Sample {
  std::string suffix, bytes;
  bool has_faces;
};
// The tetrahedron in every format and variant.
inline std::vector<Sample> all_samples() {
  return {{".ply", ascii_ply(), true},
          {".ply", binary_ply(false), true},
          {".ply", binary_ply(true), true},
          {".obj", obj_text(), true},
          {".off", off_text(), true},
          {".off", binary_off(), true},
          {".stl", ascii_stl(), true},
          {".stl", binary_stl(), true},
          {".xyz", point_lines(), false},
          {".pcd", pcd_header("ascii") + point_lines(), false},
          {".pcd", binary_pcd(), false},
          {".pcd", compressed_pcd(), false},
          {".gltf", gltf_text(), true},
          {".glb", glb_bytes(), true},
          {".pts", "4\n" + point_lines(), false}};
}

}  // namespace understudy::test
