#include "retarget/formats/mesh_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/gltf_mesh.hpp"
#include "retarget/formats/obj.hpp"
#include "retarget/formats/off.hpp"
#include "retarget/formats/pcd.hpp"
#include "retarget/formats/ply.hpp"
#include "retarget/formats/stl.hpp"
#include "retarget/formats/xyz.hpp"

namespace understudy {
namespace {

struct Format {
  MeshFormat format;
  const char* name;
  Mesh (*parse)(std::string_view bytes, const std::string& source);
};

constexpr std::array<Format, 7> kFormats = {{{MeshFormat::Ply, "PLY", parse_ply},
                                             {MeshFormat::Obj, "OBJ", parse_obj},
                                             {MeshFormat::Off, "OFF", parse_off},
                                             {MeshFormat::Stl, "STL", parse_stl},
                                             {MeshFormat::Xyz, "XYZ", parse_xyz},
                                             {MeshFormat::Pcd, "PCD", parse_pcd},
                                             {MeshFormat::Gltf, "glTF", parse_gltf}}};

const Format& format_entry(MeshFormat format) {
  return kFormats[static_cast<size_t>(format)];
}

constexpr std::array<std::pair<const char*, MeshFormat>, 15> kSuffixes = {{{".ply", MeshFormat::Ply},
                                                                           {".obj", MeshFormat::Obj},
                                                                           {".off", MeshFormat::Off},
                                                                           {".coff", MeshFormat::Off},
                                                                           {".stl", MeshFormat::Stl},
                                                                           {".xyz", MeshFormat::Xyz},
                                                                           {".xyzn", MeshFormat::Xyz},
                                                                           {".xyzrgb", MeshFormat::Xyz},
                                                                           {".txt", MeshFormat::Xyz},
                                                                           {".csv", MeshFormat::Xyz},
                                                                           {".asc", MeshFormat::Xyz},
                                                                           {".pts", MeshFormat::Xyz},
                                                                           {".pcd", MeshFormat::Pcd},
                                                                           {".gltf", MeshFormat::Gltf},
                                                                           {".glb", MeshFormat::Gltf}}};

// Ascii STL says "solid", and so may any text: a facet must follow. Binary STL has no sign but its size.
bool is_stl(std::string_view bytes) {
  if (lower_case(bytes.substr(0, 5)) == "solid") {
    const std::string start = lower_case(bytes.substr(0, 1024));
    if (start.find("facet") != start.npos || start.find("endsolid") != start.npos) return true;
  }
  return bytes.size() >= 84 && bytes.size() == 84 + 50ull * load<uint32_t>(bytes.data() + 80, false);
}

bool is_off(std::string_view word) {
  if (word.size() > 8 || word.size() < 3 || word.substr(word.size() - 3) != "OFF") return false;
  return word.find_first_not_of("STCN4nOF") == word.npos;
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

bool is_pcd(std::string_view bytes) {
  TextCursor text(bytes.substr(0, 4096), "");
  text.skip_comments();
  const std::string_view word = text.word();
  if (word == "VERSION" || word == "FIELDS") return true;
  return bytes.substr(0, 7) == "# .PCD ";
}

}  // namespace

const char* format_name(MeshFormat format) {
  return format_entry(format).name;
}

std::optional<MeshFormat> format_of_suffix(const std::string& path) {
  const std::string suffix = file_suffix(path);
  for (const auto& [known, format] : kSuffixes)
    if (suffix == known) return format;
  return {};
}

std::optional<MeshFormat> format_of_content(std::string_view bytes) {
  if (bytes.substr(0, 4) == "ply\n" || bytes.substr(0, 4) == "ply\r") return MeshFormat::Ply;
  if (bytes.substr(0, 4) == "glTF") return MeshFormat::Gltf;
  TextCursor text(bytes.substr(0, 4096), "");
  text.skip_comments();
  const std::string_view word = text.word();
  if (is_off(word)) return MeshFormat::Off;
  if (is_pcd(bytes)) return MeshFormat::Pcd;
  if (is_stl(bytes)) return MeshFormat::Stl;
  if (!word.empty() && word[0] == '{' && bytes.find("\"asset\"") != bytes.npos) return MeshFormat::Gltf;
  if (is_obj(bytes)) return MeshFormat::Obj;
  return {};
}

Mesh parse_mesh(std::string_view bytes, const std::string& path) {
  US_CHECK(!bytes.empty(), path, ": is empty");
  const auto content = format_of_content(bytes), suffix = format_of_suffix(path);
  US_CHECK(content || suffix, path,
           ": is no mesh or point cloud that is known (PLY, OBJ, OFF, STL, XYZ, PCD, glTF)");
  if (content && suffix && *content != *suffix)
    log::warn(path + ": is " + format_name(*content) + " in spite of its suffix, and is read as that");
  // Without a sign in the bytes only XYZ, binary STL with more behind it, and OBJ that starts oddly can be
  // what the suffix says.
  US_CHECK(content || *suffix == MeshFormat::Xyz || *suffix == MeshFormat::Stl || *suffix == MeshFormat::Obj,
           path, ": is not the ", format_name(*suffix), " file that its suffix says");
  const Format& format = format_entry(content ? *content : *suffix);
  Mesh mesh = format.parse(bytes, path);
  US_CHECK(content || mesh.vertices.rows() > 0, path, ": is not the ", format.name,
           " file that its suffix says");
  return mesh;
}

Mesh read_mesh(const std::string& path) {
  return parse_mesh(read_file(path), path);
}

Eigen::Index finite_count(const Points& points) {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) count += points.row(i).allFinite();
  return count;
}

Points finite_points(const Points& points) {
  Points out(finite_count(points), 3);
  Eigen::Index to = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) out.row(to++) = points.row(i);
  return out;
}

}  // namespace understudy
