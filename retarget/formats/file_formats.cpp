#include "retarget/formats/file_formats.hpp"

#include <algorithm>
#include <fstream>

#include "retarget/base/file.hpp"
#include "retarget/base/text.hpp"

namespace understudy {

// Readers and what recognises their files, each format in a file of its own.
Mesh parse_ply(std::string_view bytes, const std::string& source);
Mesh parse_obj(std::string_view bytes, const std::string& source);
Mesh parse_off(std::string_view bytes, const std::string& source);
Mesh parse_stl(std::string_view bytes, const std::string& source);
Mesh parse_xyz(std::string_view bytes, const std::string& source);
Mesh parse_pts(std::string_view bytes, const std::string& source);
Mesh parse_pcd(std::string_view bytes, const std::string& source);
Mesh parse_gltf(std::string_view bytes, const std::string& path);
bool is_obj(std::string_view bytes);
bool is_off(std::string_view bytes);
bool is_stl(std::string_view bytes);
bool is_pcd(std::string_view bytes);
std::unique_ptr<ScanSource::Frames> npy_frames(const std::string& path);
std::unique_ptr<ScanSource::Frames> npz_frames(const std::string& path);
std::unique_ptr<ScanSource::Frames> listed_frames(const std::string& path);

namespace {

bool is_ply(std::string_view bytes) {
  return starts_with(bytes, "ply\n") || starts_with(bytes, "ply\r");
}

bool is_gltf(std::string_view bytes) {
  if (starts_with(bytes, "glTF")) return true;
  TextCursor text(bytes.substr(0, 4096), "");
  text.skip_comments();
  return starts_with(text.word(), "{") && bytes.find("\"asset\"") != bytes.npos;
}

bool is_fbx(std::string_view bytes) {
  return starts_with(bytes, "Kaydara FBX Binary  ");
}

bool is_dae(std::string_view bytes) {
  return bytes.substr(0, 512).find("<COLLADA") != bytes.npos;
}

}  // namespace

const std::vector<FileFormat>& file_formats() {
  constexpr unsigned kSurface = kScanFrame | kTarget;
  // Never destroyed: a thread that lists a folder may outlive main().
  static const std::vector<FileFormat>& formats = *new std::vector<FileFormat>{
      {"PLY", {".ply"}, kSurface, parse_ply, is_ply, true},
      {"OBJ", {".obj"}, kSurface, parse_obj, is_obj},
      {"OFF", {".off", ".coff"}, kSurface, parse_off, is_off, true},
      {"STL", {".stl"}, kSurface, parse_stl, is_stl},
      {"XYZ", {".xyz", ".xyzn", ".xyzrgb", ".asc"}, kSurface, parse_xyz},
      {"PTS", {".pts"}, kSurface, parse_pts},
      {"TXT", {".txt", ".csv"}, kSurface, parse_xyz, nullptr, false, nullptr, true},
      {"PCD", {".pcd"}, kSurface, parse_pcd, is_pcd, true},
      {"glTF", {".glb", ".gltf", ".vrm"}, kSurface | kMotion, parse_gltf, is_gltf, true},
      {"FBX", {".fbx"}, kTarget | kMotion, nullptr, is_fbx},
      {"DAE", {".dae"}, kTarget | kMotion, nullptr, is_dae},
      {"BVH", {".bvh"}, kMotion},
      {"NPY", {".npy"}, kScanSequence, nullptr, nullptr, false, npy_frames},
      {"NPZ", {".npz"}, kScanSequence | kTarget | kMotion | kBody, nullptr, nullptr, false, npz_frames},
      {"list", {".lst", ".txt"}, kScanSequence, nullptr, nullptr, false, listed_frames},
      {"document", {".understudy"}, kDocument},
      {"study", {".study"}, kStudy},
      {"case", {".json"}, kCase}};
  return formats;
}

const FileFormat* format_of_suffix(std::string_view path, unsigned uses) {
  const std::string suffix = file_suffix(path);
  for (const FileFormat& format : file_formats())
    for (const char* const known : format.suffixes)
      if ((format.uses & uses) && suffix == known) return &format;
  return nullptr;
}

const FileFormat* format_of_file(const std::string& path, unsigned uses) {
  if (const FileFormat* const known = format_of_suffix(path, uses)) return known;
  if (can_be(path, ~0u)) return nullptr;
  constexpr uint64_t kGlance = 1 << 20;
  std::string bytes(std::min(check_file(path), kGlance), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return format_of_content(bytes, uses);
}

const FileFormat* format_of_content(std::string_view bytes, unsigned uses) {
  for (const FileFormat& format : file_formats())
    if ((format.uses & uses) && format.recognise && format.recognise(bytes)) return &format;
  return nullptr;
}

std::string format_names(unsigned uses) {
  std::string names;
  for (const FileFormat& format : file_formats())
    if ((format.uses & uses) && !format.is_plain_text) append_item(names, format.name);
  return names;
}

std::vector<std::string> format_suffixes(unsigned uses) {
  std::vector<std::string> suffixes;
  for (const FileFormat& format : file_formats())
    if ((format.uses & uses) && !format.is_plain_text)
      suffixes.insert(suffixes.end(), format.suffixes.begin(), format.suffixes.end());
  return suffixes;
}

}  // namespace understudy
