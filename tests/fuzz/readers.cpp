#include "tests/fuzz/readers.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/cli/batch_job.hpp"
#include "app/cli/report.hpp"
#include "app/run/case_folder.hpp"
#include "app/session/commands.hpp"
#include "app/session/document_file.hpp"
#include "app/session/settings.hpp"
#include "app/studio/event_text.hpp"
#include "app/study/trials.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/body.hpp"
#include "retarget/body/data_folder.hpp"
#include "retarget/character/bone_map.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/picture.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/vertex_colors.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/markers.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/scan_source.hpp"
#include "retarget/formats/scan_times.hpp"
#include "retarget/keypoints/keypoint_filter.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "retarget/motion/bvh.hpp"
#include "retarget/motion/read_motion.hpp"
#include "retarget/networks/weights_layout.hpp"
#include "tests/fuzz/promises.hpp"
#include "tests/fuzz/stream_reader.hpp"
#include "ui/gui/key_chord.hpp"

namespace understudy::fuzz {
namespace {

void any_mesh(const std::string& bytes) {
  check_mesh(parse_mesh(bytes, "x"));
}

// What the bytes say they hold, once decoded. Text and JSON say it by their length: no text is denser than
// lists of two characters an element ("1,", "a "), and an element takes eight bytes a character at most (a
// JSON value or a view of a word: sixteen). Bytes that stand for themselves become floats: four for each.
constexpr size_t kOfText = 8, kOfBytes = 4;

size_t text_size(const std::string& bytes) {
  return kOfText * bytes.size();
}

size_t bytes_size(const std::string& bytes) {
  return kOfBytes * bytes.size();
}

// Frames of poses that are missing between numbers take their places, each with its sentence: up to twenty
// for each frame there is, and a thousand.
size_t declared_by_poses(const std::string& bytes) {
  constexpr size_t kMissingFrame = 256, kMost = 20, kAtOnce = 1000;
  const auto frames = static_cast<size_t>(std::count(bytes.begin(), bytes.end(), '{') +
                                          std::count(bytes.begin(), bytes.end(), '['));
  return text_size(bytes) + kMissingFrame * (kMost * frames + kAtOnce);
}

// A line of a table: a row with a text of its own, which is listed once more where it names nothing.
size_t declared_by_table(const std::string& bytes) {
  constexpr size_t kRow = 160;
  return text_size(bytes) + kRow * static_cast<size_t>(std::count(bytes.begin(), bytes.end(), '\n'));
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

double number_in(const nlohmann::json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() && found->is_number() ? found->get<double>() : 0;
}

// Four bytes for every number of an accessor.
double accessor_size(const nlohmann::json& accessors, double index) {
  if (!accessors.is_array() || !(index >= 0 && index < static_cast<double>(accessors.size()))) return 0;
  const auto& accessor = accessors[static_cast<size_t>(index)];
  const std::string type = accessor.is_object() && accessor.contains("type") && accessor["type"].is_string()
                               ? accessor["type"]
                               : "";
  const double parts = type == "MAT4" ? 16 : type == "MAT3" ? 9 : type.rfind("VEC", 0) == 0 ? 4 : 1;
  return 4 * parts * number_in(accessor, "count");
}

// Of a mesh: its corners' and vertices' accessors, each as often as it is named.
double mesh_size(const nlohmann::json& root, double index) {
  if (!root.contains("meshes") || !root["meshes"].is_array() || !root.contains("accessors")) return 0;
  const auto& meshes = root["meshes"];
  if (!(index >= 0 && index < static_cast<double>(meshes.size()))) return 0;
  const auto& mesh = meshes[static_cast<size_t>(index)];
  if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) return 0;
  double sum = 0;
  for (const auto& primitive : mesh["primitives"]) {
    sum += accessor_size(root["accessors"], number_in(primitive, "indices"));
    if (primitive.is_object() && primitive.contains("attributes") && primitive["attributes"].is_object())
      for (const auto& attribute : primitive["attributes"])
        if (attribute.is_number()) sum += accessor_size(root["accessors"], attribute.get<double>());
  }
  return sum;
}

// The text and the bytes, every accessor, and every mesh as often as nodes show it.
size_t declared_by_gltf(const std::string& bytes) {
  std::string_view text = bytes;
  if (text.substr(0, 4) == "glTF" && text.size() > 20) {
    uint32_t size = 0;
    std::memcpy(&size, text.data() + 12, 4);
    text = text.substr(20, size);
  }
  const auto root = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
  double sum = static_cast<double>(text_size(bytes));
  if (!root.is_object()) return static_cast<size_t>(sum);
  if (root.contains("accessors"))
    for (size_t i = 0; i < root["accessors"].size(); ++i)
      sum += accessor_size(root["accessors"], static_cast<double>(i));
  if (root.contains("nodes") && root["nodes"].is_array())
    for (const auto& node : root["nodes"])
      if (node.is_object() && node.contains("mesh")) sum += mesh_size(root, number_in(node, "mesh"));
  return static_cast<size_t>(std::min(sum, 1e18));
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

// The unpacked sizes in the archive's directory, which become floats, and libzip's table of as many entries
// as the directory's end announces. Where there are more, it makes room for 65,536 at once: 2 MiB at most, no
// more for being asked to take four times what is declared.
size_t declared_by_zip(const std::string& bytes) {
  constexpr size_t kEntry = 32, kMoreEntries = 65536;
  size_t sum = bytes_size(bytes), entries = 0;
  for (size_t at = bytes.find("PK\x01\x02"); at != bytes.npos && at + 28 <= bytes.size();
       at = bytes.find("PK\x01\x02", at + 4)) {
    uint32_t size = 0;
    std::memcpy(&size, bytes.data() + at + 24, 4);
    sum += kOfBytes * size;
  }
  for (size_t at = bytes.find("PK\x05\x06"); at != bytes.npos && at + 12 <= bytes.size();
       at = bytes.find("PK\x05\x06", at + 4)) {
    uint16_t count = 0;
    std::memcpy(&count, bytes.data() + at + 10, 2);
    entries = std::max<size_t>(entries, count);
  }
  return sum + kEntry * entries + kEntry * kMoreEntries / 4;
}

// The unpacked size that stands before a compressed body.
size_t declared_by_pcd(const std::string& bytes) {
  const size_t line = bytes.find("binary_compressed");
  const size_t body = line == bytes.npos ? line : bytes.find('\n', line);
  if (body == bytes.npos || body + 9 > bytes.size()) return text_size(bytes);
  uint32_t size = 0;
  std::memcpy(&size, bytes.data() + body + 5, 4);
  return text_size(bytes) + size;
}

// Any mesh: the largest of what each format takes them for.
size_t declared_by_mesh(const std::string& bytes) {
  return std::max(declared_by_gltf(bytes), declared_by_pcd(bytes));
}

// The pixels. A lossless WebP may have codes of its own for every 4 x 4 of them, 12 KiB in libwebp's tables,
// and tables for the whole.
size_t declared_by_picture(const std::string& bytes) {
  const auto decoded = static_cast<size_t>(decoded_size(bytes));
  const size_t codes = picture_type(bytes) == "image/webp" ? decoded / 3 / 16 * 3072 + (64 << 10) : 0;
  return bytes.size() + decoded + codes;
}

// On a square, by every corner of it.
void picture(const std::string& bytes) {
  Character character;
  character.name = "x";
  character.nodes.push_back({});
  character.images.push_back({"x", "image/png", bytes});
  character.textures = {R"({"source":0})"};
  character.materials = {R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})"};
  CharacterPart part;
  part.vertices.setRandom(4, 3);
  part.node = part.material = 0;
  part.uvs.push_back(RowMatrix::Zero(4, 2));
  part.uvs[0] << 0, 0, 1, 0, 0.5f, 0.99f, -7, 1e30f;
  character.parts.push_back(part);
  const Points colors = vertex_colors(character);
  must(colors.rows() == 0 || colors.allFinite(), "colours are numbers");
}

void weights(const std::string& bytes) {
  for (const auto& [name, tensor] : nn::parse_weights(bytes, "x.weights").tensors) {
    int64_t count = 1;
    for (const int64_t extent : tensor.shape) count *= extent;
    must(static_cast<int64_t>(tensor.bytes.size()) == count * (tensor.half ? 2 : 4),
         "tensors have their bytes");
    uint8_t sum = 0;
    for (const char byte : tensor.bytes) sum = static_cast<uint8_t>(sum + static_cast<uint8_t>(byte));
    must(sum + 1 > 0, "they can be read");
  }
}

void amass(const std::string& bytes) {
  const auto character = read_motion(ScratchFile("m.npz", bytes).path());
  if (!character) return;
  must(character->animations.size() == 1, "one motion");
  nodes_at(*character, 0, character->animations[0].duration() / 3);
}

void body(const std::string& bytes) {
  const Body read = read_smpl_body(ScratchFile("b.npz", bytes).path());
  check_mesh({posed_vertices(read.shaped(Eigen::VectorXf()), Pose()), read.faces});
}

void dressed_body(const std::string& bytes) {
  const ShapedBody read = read_dressed_body(ScratchFile("d.npz", bytes).path());
  check_mesh({posed_vertices(read, Pose()), read.faces});
}

void truth(const std::string& bytes) {
  const app::Truth read = app::read_truth(ScratchFile("t.npz", bytes).path());
  if (read.vertex_count > 0) read.frame_vertices(read.frames - 1);
}

void test_case(const std::string& bytes) {
  const ScratchFile file("case.json", bytes);
  app::read_case(std::filesystem::path(file.path()).parent_path().string());
}

// The people that a good split names are beside it.
void splits(const std::string& bytes) {
  const ScratchFile file("splits.json", bytes), people("betas.npz", "");
  NpyArray betas;
  betas.shape = {2, 1};
  betas.values = {0, 1};
  write_npz(people.path(), {{"betas", betas}});
  read_split(std::filesystem::path(file.path()).parent_path().string(), "dev");
}

void batch(const std::string& bytes) {
  static const std::vector<app::BatchCommand> commands = app::batch_commands();
  for (const app::BatchJob& job : app::parse_manifest(bytes, "x.jsonl", commands))
    must(app::is_plain_name(job.id) && !app::to_json(job).dump(-1, ' ', true).empty(),
         "jobs can be recorded");
}

void report_rows(const std::string& bytes) {
  app::read_report_plan(ScratchFile("rows.json", bytes).path());
}

void settings(const std::string& bytes) {
  const app::Settings read = app::read_settings(ScratchFile("settings.json", bytes).path());
  must(read.scale >= 0 && read.cache_mb >= 64 && read.window_width > 0, "settings are in their ranges");
}

// One frame is beside the list; what else it names is missing.
void scan_list(const std::string& bytes) {
  const ScratchFile frame("a.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  frames_of(ScratchFile("x.lst", bytes).path());
}

// Of three scans; the corpus names them and others.
void scan_times(const std::string& bytes) {
  const ScratchFile table("times.csv", bytes);
  const ScanPlaces placed = place_scans(table.path(), {{"a1.ply", 1}, {"b/a2.ply", 2}, {"a3.ply", 3}}, 0);
  must(placed.frames > 0 && placed.frames <= kMostClockFrames, "the clock has frames");
  int64_t before = -1;
  for (const ScanPlaces::Place& place : placed.places) {
    must(place.frame > before && place.frame < placed.frames, "places rise");
    before = place.frame;
  }
}

void markers(const std::string& bytes) {
  double before = -1e300;
  for (const MarkerFrame& frame : read_markers(ScratchFile("markers.csv", bytes).path())) {
    must(frame.seconds > before && !frame.markers.empty(), "times rise");
    before = frame.seconds;
    for (const Marker& marker : frame.markers)
      must(!marker.name.empty() && marker.place.allFinite(), "markers have names and places");
  }
}

// What the process that reads FBX and DAE says when it fails; what it makes is a GLB, and read as any other.
void worker_words(const std::string& bytes) {
  const std::string words = last_words(bytes);
  must(words.size() <= 200, "words are short");
  for (const char c : words) must(c >= ' ' && c <= '~', "words can be shown");
}

void document(const std::string& bytes) {
  const app::SavedDocument saved =
      app::from_json(app::parse_json(bytes, "x.understudy"), "/nonexistent-folder", "x.understudy");
  const std::string text = app::json_text(app::to_json(saved, "/nonexistent-folder"));
  const app::SavedDocument again =
      app::from_json(app::parse_json(text, "again"), "/nonexistent-folder", "again");
  must(same(saved.document, again.document), "what was read can be written and read again");
}

void study(const std::string& bytes) {
  const auto read = [](const std::string& text) {
    return app::study_from_json(app::parse_json(text, "x.study"), "/nonexistent-folder", "x.study");
  };
  const app::Study saved = read(bytes);
  must(same(read(app::json_text(app::to_json(saved, "/nonexistent-folder"))), saved),
       "what was read can be written and read again");
  must(app::changes_since(app::digest_of(saved, "/"), saved, "/").empty(), "nothing changed");
  const auto trials = app::trials_of(saved, "1");
  must(trials.size() == static_cast<size_t>(app::trial_count(saved) + saved.plan.practice),
       "all trials are there");
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
      for (const std::string& word : rest) ui::chord_of(word);
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

void check_poses(const KeypointReading& reading) {
  must(!reading.tracks.empty() && reading.canvas.is_known() && reading.fps > 0, "somebody is on a canvas");
  const auto frames = static_cast<int64_t>(reading.frames.size());
  for (int64_t f = 1; f < frames; ++f)
    must(reading.frames[static_cast<size_t>(f)].number > reading.frames[static_cast<size_t>(f) - 1].number,
         "numbers rise");
  for (const KeypointTrack& track : reading.tracks) {
    int64_t before = -1;
    for (const TrackedPose& pose : track.poses) {
      must(pose.frame > before && pose.frame < frames, "a person is in a frame once");
      must(pose.pose.body.allFinite() && pose.pose.body.col(2).minCoeff() >= 0 &&
               pose.pose.body.col(2).maxCoeff() <= 1,
           "points are numbers");
      before = pose.frame;
    }
  }
  for (const CleanPose& clean : clean_track(reading, reading.performer))
    must(clean.pose.body.allFinite(), "clean points are numbers");
}

// As MediaPipe's lists need it: on a canvas that is told. What was read can be written and read again.
void poses(const std::string& bytes) {
  KeypointReaderOptions options;
  options.canvas = {640, 480};
  const KeypointReading reading = parse_keypoints(bytes, "x.json", options);
  check_poses(reading);
  const int64_t frame = reading.performing().poses.front().frame;
  const KeypointReading again = parse_keypoints(openpose_json(reading, frame), "again", options);
  must(again.frames.size() == 1, "a frame can be written and read again");
}

void pose_arrays(const std::string& bytes) {
  KeypointReaderOptions options;
  options.canvas = {640, 480};
  check_poses(read_keypoints(ScratchFile("poses.npz", bytes).path(), options));
}

/// Every format of the table that holds a mesh: "ply"; "obj_scan", where "obj" reads it as a character.
void add_mesh_formats(std::vector<Reader>& all) {
  for (const FileFormat& format : file_formats()) {
    if (!format.parse || format.is_plain_text) continue;
    const auto read = [&format](const std::string& bytes) { check_mesh(format.parse(bytes, nowhere())); };
    std::string name = lower_case(format.name);
    const bool taken = std::any_of(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    const auto declared = name == "gltf" ? declared_by_gltf : name == "pcd" ? declared_by_pcd : text_size;
    all.push_back({taken ? name + "_scan" : name, read, declared});
  }
}

std::vector<Reader> all_readers() {
  std::vector<Reader> all = {{"gltf", gltf_character, declared_by_gltf},
                             {"obj", obj_character, text_size},
                             {"any_mesh", any_mesh, declared_by_mesh},
                             {"npy", npy, bytes_size},
                             {"npy_frames", npy_frames, bytes_size},
                             {"npz", npz, declared_by_zip},
                             {"npz_frames", npz_frames, declared_by_zip},
                             {"amass", amass, declared_by_zip},
                             {"body", body, declared_by_zip},
                             {"dressed_body", dressed_body, declared_by_zip},
                             {"truth", truth, declared_by_zip},
                             {"bvh", bvh, text_size},
                             {"picture", picture, declared_by_picture},
                             {"weights", weights, text_size},
                             {"worker_words", worker_words, bytes_size},
                             {"document", document, text_size},
                             {"study", study, text_size},
                             {"script", script, text_size},
                             {"bone_map", bone_choices, text_size},
                             {"scan_list", scan_list, text_size},
                             {"scan_times", scan_times, declared_by_table},
                             {"markers", markers, declared_by_table},
                             {"poses", poses, declared_by_poses},
                             {"pose_arrays", pose_arrays, declared_by_zip},
                             {"case", test_case, text_size},
                             {"batch", batch, declared_by_table},
                             {"splits", splits, text_size},
                             {"report_rows", report_rows, text_size},
                             {"settings", settings, text_size},
                             {"stream", stream, text_size}};
  add_mesh_formats(all);
  return all;
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = all_readers();
  return all;
}

}  // namespace understudy::fuzz
