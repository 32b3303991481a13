#include "tests/fuzz/readers.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/session/commands.hpp"
#include "app/session/document_file.hpp"
#include "app/session/document_text.hpp"
#include "app/studio/event_text.hpp"
#include "app/studio/key_chord.hpp"
#include "retarget/base/error.hpp"
#include "retarget/character/bone_choices.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/obj_character.hpp"
#include "retarget/formats/gltf_mesh.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/obj.hpp"
#include "retarget/formats/off.hpp"
#include "retarget/formats/pcd.hpp"
#include "retarget/formats/ply.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/formats/stl.hpp"
#include "retarget/formats/xyz.hpp"
#include "retarget/motion/bvh.hpp"

namespace understudy::fuzz {
namespace {

// What no reader may let through; the fuzzer takes an abort for a find.
void must(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

void check_mesh(const Mesh& mesh) {
  must(mesh.faces.size() == 0 || (mesh.faces.minCoeff() >= 0 && mesh.faces.maxCoeff() < mesh.vertices.rows()),
       "faces name vertices");
  must(mesh.colors.rows() == 0 || mesh.colors.rows() == mesh.vertices.rows(), "colours fit");
}

template <Mesh (*parse)(std::string_view, const std::string&)>
void mesh(const std::string& bytes) {
  check_mesh(parse(bytes, "x"));
}

void any_mesh(const std::string& bytes) {
  check_mesh(parse_mesh(bytes, "x"));
}

size_t nothing_packed(const std::string&) {
  return 0;
}

/// A file in a folder of this process, for readers that want a path.
class ScratchFile {
 public:
  ScratchFile(const char* name, const std::string& bytes) : path_(folder() + "/" + name) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~ScratchFile() { ::unlink(path_.c_str()); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  static const std::string& folder() {
    struct Folder {
      Folder() : path(std::filesystem::temp_directory_path() / ("us_fuzz_" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path);
      }
      ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
      }
      std::string path;
    };
    static const Folder made;
    return made.path;
  }
  std::string path_;
};

void use_character(const Character& character) {
  const BindPose bind = bind_pose(character);
  must(bind.vertices.rows() == character.vertex_count(), "every vertex is bound");
  const MergedSurface merged = merged_surface(character, bind.vertices);
  check_mesh(merged.mesh);
  map_bones(character, bind.nodes);
  for (size_t a = 0; a < std::min<size_t>(character.animations.size(), 4); ++a)
    vertices_at(character, static_cast<int>(a), character.animations[a].duration() / 3);
}

// Nothing is beside it, so that pictures and buffers outside are missing.
const std::string& nowhere() {
  static const std::string path = "/nonexistent-folder/x.gltf";
  return path;
}

void gltf_character(const std::string& bytes) {
  use_character(parse_gltf_character(bytes, nowhere()));
}

void gltf_scan(const std::string& bytes) {
  check_mesh(parse_gltf(bytes, nowhere()));
}

// Of the largest accessor, and of the pictures and buffers inside, which are part of the file.
size_t declared_by_gltf(const std::string& bytes) {
  std::string_view text = bytes;
  if (text.substr(0, 4) == "glTF" && text.size() > 20) {
    uint32_t size = 0;
    std::memcpy(&size, text.data() + 12, 4);
    text = text.substr(20, size);
  }
  const auto root = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
  if (!root.is_object() || !root.contains("accessors") || !root["accessors"].is_array()) return 0;
  double largest = 0;
  for (const auto& accessor : root["accessors"]) {
    if (!accessor.is_object() || !accessor.contains("count") || !accessor["count"].is_number()) continue;
    const std::string type =
        accessor.contains("type") && accessor["type"].is_string() ? accessor["type"] : "";
    const double parts = type == "MAT4" ? 16 : type == "MAT3" ? 9 : type.rfind("VEC", 0) == 0 ? 4 : 1;
    largest = std::max(largest, 4 * parts * accessor["count"].get<double>());
  }
  return static_cast<size_t>(std::min(largest, 1e18));
}

// The text of a .mtl follows the line "#mtl".
void obj_character(const std::string& bytes) {
  constexpr const char* kMark = "\n#mtl\n";
  const size_t cut = bytes.find(kMark);
  const ScratchFile materials("a.mtl", cut == bytes.npos ? "" : bytes.substr(cut + std::strlen(kMark)));
  const std::string path = std::filesystem::path(materials.path()).parent_path().string() + "/x.obj";
  use_character(parse_obj_character(bytes.substr(0, cut), path));
}

void npy(const std::string& bytes) {
  const NpyArray array = parse_npy(bytes, "x.npy");
  int64_t count = array.text.empty() ? 1 : 0;
  for (const int64_t extent : array.shape) count *= extent;
  must(!array.text.empty() || array.values.empty() || array.size() == count, "the shape fits");
}

void frames_of(const std::string& path) {
  ScanSource source(path);
  for (int i = 0; i < 3; ++i) {
    const auto frame = source.next();
    if (!frame) break;
    check_mesh(frame->mesh);
  }
  if (source.count().value_or(0) > 1) source.seek(1);
}

void npy_frames(const std::string& bytes) {
  frames_of(ScratchFile("x.npy", bytes).path());
}

void npz(const std::string& bytes) {
  read_npz(ScratchFile("x.npz", bytes).path());
}

void npz_frames(const std::string& bytes) {
  frames_of(ScratchFile("x.npz", bytes).path());
}

// The unpacked sizes in the archive's directory.
size_t declared_by_zip(const std::string& bytes) {
  size_t sum = 0;
  for (size_t at = bytes.find("PK\x01\x02"); at != bytes.npos && at + 28 <= bytes.size();
       at = bytes.find("PK\x01\x02", at + 4)) {
    uint32_t size = 0;
    std::memcpy(&size, bytes.data() + at + 24, 4);
    sum += size;
  }
  return sum;
}

// The unpacked size that stands before a compressed body.
size_t declared_by_pcd(const std::string& bytes) {
  const size_t line = bytes.find("binary_compressed");
  const size_t body = line == bytes.npos ? line : bytes.find('\n', line);
  if (body == bytes.npos || body + 9 > bytes.size()) return 0;
  uint32_t size = 0;
  std::memcpy(&size, bytes.data() + body + 5, 4);
  return size;
}

void document(const std::string& bytes) {
  const app::SavedDocument saved =
      app::from_json(app::parse_document(bytes, "x.understudy"), "/nonexistent-folder", "x.understudy");
  const std::string text = app::document_text(app::to_json(saved, "/nonexistent-folder"));
  const app::SavedDocument again =
      app::from_json(app::parse_document(text, "again"), "/nonexistent-folder", "again");
  must(app::same(saved.document, again.document), "what was read can be written and read again");
}

// Each line's words as the lines of scripts use them.
void script(const std::string& bytes) {
  std::istringstream lines(bytes);
  for (std::string line; std::getline(lines, line);) {
    try {
      const app::Arguments words = app::split_line(line);
      if (words.empty()) continue;
      const app::Arguments rest(words.begin() + 1, words.end());
      app::Arguments with_name = words;
      with_name[0] = "x";
      must(app::split_line(app::join_line("x", rest)) == with_name, "lines can be joined and split again");
      for (const std::string& word : rest) app::chord_of(word);
      if (words[0] == "event") app::event_of_words(rest);
      for (const std::string& word : rest) app::number_of(word);
    } catch (const Error&) {  // of one line
    }
  }
}

void bvh(const std::string& bytes) {
  const Character character = parse_bvh(bytes, "x.bvh");
  must(character.animations.size() == 1, "one motion");
  const PosedNodes posed = nodes_at(character, 0, character.animations[0].duration() / 3);
  must(posed.world.size() == character.nodes.size(), "every node is placed");
}

void bone_choices(const std::string& bytes) {
  parse_bone_choices(bytes, "map.json");
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = {{"gltf", gltf_character, declared_by_gltf},
                                          {"gltf_scan", gltf_scan, declared_by_gltf},
                                          {"obj", obj_character, nothing_packed},
                                          {"obj_scan", mesh<parse_obj>, nothing_packed},
                                          {"ply", mesh<parse_ply>, nothing_packed},
                                          {"off", mesh<parse_off>, nothing_packed},
                                          {"stl", mesh<parse_stl>, nothing_packed},
                                          {"xyz", mesh<parse_xyz>, nothing_packed},
                                          {"pcd", mesh<parse_pcd>, declared_by_pcd},
                                          {"any_mesh", any_mesh, declared_by_gltf},
                                          {"npy", npy, nothing_packed},
                                          {"npy_frames", npy_frames, nothing_packed},
                                          {"npz", npz, declared_by_zip},
                                          {"npz_frames", npz_frames, declared_by_zip},
                                          {"bvh", bvh, nothing_packed},
                                          {"document", document, nothing_packed},
                                          {"script", script, nothing_packed},
                                          {"bone_map", bone_choices, nothing_packed}};
  return all;
}

}  // namespace understudy::fuzz
