#include "app/session/document_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "tests/app/program.hpp"
#include "tests/session/full_document.hpp"

namespace {
/// Bytes asked of operator new so far: work that seconds would count less surely. Sanitizers have an operator
/// new of their own: nothing is counted under them.
std::atomic<uint64_t> allocated{0};
}  // namespace

#ifndef __has_feature  // clang's
#define __has_feature(name) 0
#endif
#if !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer)
void* operator new(size_t bytes) {
  allocated += bytes;
  if (void* const memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
#endif

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using tests::read_bytes;
using tests::ScratchFolder;

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string text_of(const SavedDocument& saved) {
  return to_json(saved, "").dump();
}

/// What reading says; empty when it reads.
std::string problem_of(const std::string& path) {
  try {
    read_document(path);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

/// What is said of the full document with this put at a JSON pointer; "doc: " is taken off.
std::string problem_with(const std::string& pointer, const Json& value) {
  Json json = to_json(full_document("/a"), "/a");
  json[nlohmann::json::json_pointer(pointer)] = value;
  try {
    from_json(json, "/a", "doc");
    return "";
  } catch (const Error& error) {
    const std::string what = error.what();
    return what.substr(0, 5) == "doc: " ? what.substr(5) : "not named: " + what;
  }
}

TEST(DocumentFile, GivesBackAllThatWasSaved) {
  ScratchFolder scratch;
  const std::string path = scratch.path("my dance ö.understudy");
  const SavedDocument saved = full_document(scratch.path("data"));
  write_document(path, saved);
  const SavedDocument read = read_document(path);
  EXPECT_TRUE(same(read.document, saved.document));
  EXPECT_EQ(text_of(read), text_of(saved));  // view, playback and checksums too
  EXPECT_EQ(scratch.files().size(), 1u);
}

std::string replaced(std::string text, const std::string& before, const std::string& now, size_t from = 0) {
  for (size_t at = text.find(before, from); at != text.npos; at = text.find(before, at + now.size()))
    text.replace(at, before.size(), now);
  return text;
}

/// Saved when documents still held whether the source's folder was being written, and no switches of a second
/// look and of hand contacts: those were on. Targets were not asked whether they are persons.
TEST(DocumentFile, OfTheProgramOfBeforeOpensAndIsWrittenAlike) {
  const std::string text = read_bytes(US_SOURCE_DIR "/tests/session/saved_before.understudy");
  const SavedDocument read = from_json(parse_json(text, "doc"), "/a/documents", "doc");
  Document wanted = full_document("/a").document;
  wanted.source.import.height.reset();
  wanted.bones = {};
  wanted.source = without_people(wanted.source);
  wanted.source.times.clear();
  wanted.source.blend.reset();
  wanted.source.complete = 0, wanted.source.markers.clear();
  wanted.source.layout.clear(), wanted.source.canvas.clear(), wanted.source.point_edits.clear();
  wanted.source.stature = SourceOptions().stature, wanted.source.fov = SourceOptions().fov;
  wanted.source.pitch.reset();
  wanted.source.smoothing = 1;
  wanted.flat.reset();
  for (Take& take : wanted.takes) {
    take.flat.reset();
    take.method.part_refiner = take.method.hand_contacts = true, take.method.predict = false;
    for (const Proportion& one : kProportions) take.method.*one.value = Method().*one.value;
    take.target_edits.rest_pose.clear(), take.target_edits.face.clear();
    take.method.style = {};
    take.pose_edits.fill.clear(), take.pose_edits.go_on.reset(), take.pose_edits.loop.reset();
    take.pose_edits.tempo.reset();
    for (RotateEdit& edit : take.pose_edits.rotate) edit.limb.reset();
    take.target.import.height.reset();
    take.target.not_a_person = NotAPerson::RefuseClear;
  }
  EXPECT_TRUE(same(read.document, wanted));
  std::string without = text;
  without.erase(without.find("  \"follow\": true,\n", without.find("floor_m")), 18);
  without = replaced(without, "\"root\":", "\"path\":");  // names of then
  without = replaced(without, "\"heading\":", "\"turn\":");
  without = replaced(without, "\"yaw_deg\":", "\"turn_deg\":");
  without = replaced(without, "\"floor\":", "\"raise\":", without.find("\"smooth\":"));
  without = replaced(without, "\"rig\": \"ours\"", "\"rig\": \"22\"");
  auto written = to_json(read, "/a/documents");
  for (auto& take : written["takes"]) {
    take["method"].erase("part_refiner"), take["method"].erase("hand_contacts");
    take["method"].erase("predict"), take["method"].erase("style");
    for (const Proportion& one : kProportions) take["method"].erase(one.name);
    take["target"].erase("not_a_person"), take.erase("person");
    take["target_edits"].erase("rest_pose"), take["target_edits"].erase("face");
    take["pose_edits"].erase("fill");
  }
  auto& view = written["view"];
  for (const char* added : {"cube", "overlay", "light", "background", "background_color", "ghosts_by_time",
                            "steps", "bone_surface", "made_motions", "canvases", "lifted", "reference"})
    view.erase(added);
  for (const char* layers : {"source", "take"})
    for (const char* added : {"wireframe", "scene", "bones"}) view[layers].erase(added);
  for (const char* added : {"person", "people", "times", "complete", "markers", "layout", "canvas", "stature",
                            "fov", "pitch", "smoothing", "point_edits"})
    written["source"].erase(added);
  written.erase("bones");
  EXPECT_EQ(json_text(written), without);
}

/// Each member of what is saved but not undone: none is forgotten on one of both ways.
TEST(DocumentFile, ViewAndPlaybackDifferFromTheirDefaultsInEachMember) {
  const Json full = to_json(full_document("/a"), "/a"), plain = to_json(SavedDocument{}, "/a");
  for (const char* part : {"playback", "view"})
    for (const auto& item : plain[part].items())
      EXPECT_NE(full[part][item.key()], item.value()) << item.key();
  const Json again = to_json(from_json(full, "/a", "doc"), "/a");
  EXPECT_EQ(again, full);
}

TEST(DocumentFile, PathsAreRelativeToIt) {
  ScratchFolder scratch;
  fs::create_directories(scratch.path("old/docs"));
  fs::create_directories(scratch.path("new"));
  const SavedDocument saved = full_document(scratch.path("old/data"));
  write_document(scratch.path("old/docs/a.understudy"), saved);
  EXPECT_EQ(read_bytes(scratch.path("old/docs/a.understudy")).find(scratch.path("")), std::string::npos);
  fs::rename(scratch.path("old"), scratch.path("new/moved"));
  const SavedDocument read = read_document(scratch.path("new/moved/docs/a.understudy"));
  EXPECT_EQ(read.document.truth, scratch.path("new/moved/data/truth.npz"));
  EXPECT_EQ(read.document.source.times, scratch.path("new/moved/data/scans/times.csv"));
  EXPECT_EQ(read.document.source.markers, scratch.path("new/moved/data/scans/markers.csv"));
  EXPECT_EQ(read.document.takes[1].target.path, scratch.path("new/moved/data/b.glb"));
  EXPECT_EQ(read.document.source.blend->parts[0].path, scratch.path("new/moved/data/a walk.bvh"));
}

TEST(DocumentFile, PathsWithOnlyTheRootInCommonStayAbsolute) {
  SavedDocument saved;
  saved.document.source.path = "/data/scans";
  saved.document.truth = "/home/me/truth.npz";
  const Json json = to_json(saved, "/home/me/docs");
  EXPECT_EQ(json["source"]["path"], "/data/scans");
  EXPECT_EQ(json["truth"], "../truth.npz");
  EXPECT_EQ(from_json(json, "/home/me/docs", "doc").document.source.path, "/data/scans");
  saved.document.source.path = "/home/me/docs";  // the folder itself
  EXPECT_EQ(from_json(to_json(saved, "/home/me/docs"), "/home/you", "doc").document.source.path,
            "/home/you/");
}

TEST(DocumentFile, MembersThatAreMissingAreDefaultsAndUnknownOnesPassedOver) {
  const Json json{{"format", "understudy document"}, {"version", 1}, {"of the future", {1, 2}}};
  EXPECT_EQ(text_of(from_json(json, "/a", "doc")), text_of(SavedDocument{}));
  Json full = to_json(full_document("/a"), "/a");
  full["takes"][0]["method"]["speed"] = "fast";
  EXPECT_TRUE(same(from_json(full, "/a", "doc").document, full_document("/a").document));
}

TEST(DocumentFile, ColoursOfBindingUncertaintyOpenUnderTheirOldName) {
  Json json = to_json(SavedDocument{}, "/a");
  json["view"]["take"]["colouring"] = "doubt";
  const SavedDocument saved = from_json(json, "/a", "doc");
  EXPECT_EQ(saved.view.take.colouring, Colouring::Uncertainty);
  EXPECT_EQ(to_json(saved, "/a")["view"]["take"]["colouring"], "uncertainty");
}

TEST(DocumentFile, BackgroundsOpenUnderTheirOldNames) {
  SavedDocument before;
  before.view.background = Background::Custom, before.view.background_color = Vec3(0.5f, 0.25f, 0);
  Json json = to_json(before, "/a");
  Json& view = json["view"];
  EXPECT_EQ(view["background"], "custom");
  const Json color = view["background_color"];
  view["backdrop"] = "own", view["backdrop_color"] = color;
  view.erase("background"), view.erase("background_color");
  const SavedDocument saved = from_json(json, "/a", "doc");
  EXPECT_EQ(saved.view.background, Background::Custom);
  EXPECT_EQ(saved.view.background_color, before.view.background_color);
}

/// A name is old for the member alone that had it.
TEST(DocumentFile, OldNamesOfOneMemberAreNotReadAsAnothers) {
  Json json = to_json(SavedDocument{}, "/a");
  json["source"].erase("path");
  json["source"]["root"] = "/b";
  EXPECT_EQ(from_json(json, "/a", "doc").document.source.path, "");
}

TEST(DocumentFile, SettingsOfTheMethodOpenUnderTheirOldNames) {
  Json json = to_json(full_document("/a"), "/a");
  Json& method = json["takes"][0]["method"];
  const std::pair<const char*, const char*> names[] = {
      {"part_refiner", "near"}, {"hand_contacts", "keep_contacts"}, {"path", "root"}};
  for (const auto& [now, before] : names) {
    method[before] = method[now];
    method.erase(now);
  }
  EXPECT_TRUE(same(from_json(json, "/a", "doc").document, full_document("/a").document));
}

TEST(DocumentFile, WhatIsWrongIsNamed) {
  EXPECT_EQ(problem_with("/takes/0/method/offsets", 1), "takes[0].method.offsets must be true or false");
  EXPECT_EQ(problem_with("/takes/0/method/stride", 9),
            "takes[0].method.stride must be a finite number from 0.25 to 3");
  EXPECT_EQ(problem_with("/takes", 7), "takes must be a list");
  EXPECT_EQ(problem_with("/takes/1", "x"), "takes[1] must be an object");
  EXPECT_EQ(problem_with("/source/path", nullptr), "source.path must be text");
  EXPECT_EQ(problem_with("/source/path", std::string("a\0b", 3)), "source.path must be a path");
  EXPECT_EQ(problem_with("/source/fps", -1), "source.fps must be a finite number from 0 to 1e+06");
  EXPECT_EQ(problem_with("/source/betas/0", 1e39), "source.betas must be a finite number");
  EXPECT_EQ(problem_with("/scan_edits/crop/low", {1, 2}), "scan_edits.crop.low must be three numbers");
  EXPECT_EQ(problem_with("/scan_edits/crop/low/0", "a"), "scan_edits.crop.low must be a finite number");
  EXPECT_EQ(problem_with("/skeleton_edits/0/kind", "push"), "skeleton_edits[0].kind must be drag or swap");
  EXPECT_EQ(problem_with("/skeleton_edits/1/limbs", "ears"),
            "skeleton_edits[1].limbs must be arms, legs or both");
  EXPECT_EQ(problem_with("/skeleton_edits/0/joint", 22),
            "skeleton_edits[0].joint must be a whole number from 0 to 21");
  EXPECT_EQ(problem_with("/takes/0/pose_edits/rotate/1/frame", 1.5),
            "takes[0].pose_edits.rotate[1].frame must be a whole number");
  EXPECT_EQ(problem_with("/takes/0/pose_edits/rotate/1/falloff", 1e18),
            "takes[0].pose_edits.rotate[1].falloff must be a whole number");
  EXPECT_EQ(problem_with("/takes/0/pose_edits/skip", {-1}),
            "takes[0].pose_edits.skip must be a whole number");
  EXPECT_EQ(problem_with("/view/layout", "round"),
            "view.layout must be side-by-side, single, overlay or wipe");
  EXPECT_EQ(problem_with("/view/trail_joints", {99}),
            "view.trail_joints must be a whole number from 0 to 21");
}

TEST(DocumentFile, WeightsMustBeWeights) {
  const std::string weights = "/takes/0/target_edits/weights";
  EXPECT_NE(problem_with(weights + "/vertices/1", 5).find("must ascend"), std::string::npos);
  EXPECT_NE(problem_with(weights + "/vertices", {1, 2}).find("for 2 vertices"), std::string::npos);
  EXPECT_NE(problem_with(weights + "/rows/0", {0, 0.5}).find("sum 1"), std::string::npos);
  EXPECT_NE(problem_with(weights + "/rows/0", {0}).find("pairs"), std::string::npos);
  EXPECT_NE(problem_with(weights + "/rows/0", {22, 1}).find("rows[0]"), std::string::npos);
  EXPECT_NE(problem_with(weights + "/rows/0", {0, -1, 1, 2}).find("rows[0]"), std::string::npos);
  EXPECT_EQ(problem_with(weights, nullptr), "");
}

TEST(DocumentFile, WhatIsOnlyShownIsBroughtIntoItsRange) {
  Json json = to_json(full_document("/a"), "/a");
  json["view"]["wipe"] = 7;
  json["view"]["cameras"] = Json::array();
  json["playback"]["rate"] = 1e300;
  json["playback"]["in"] = -1e300;
  const SavedDocument read = from_json(json, "/a", "doc");
  EXPECT_EQ(read.view.wipe, 1);
  EXPECT_EQ(read.view.cameras.size(), 1u);  // the first is always there
  EXPECT_EQ(read.playback.rate, 4);
  EXPECT_EQ(read.playback.in, -1);
}

TEST(DocumentFile, WhatCouldNotBeReadAgainIsNotWritten) {
  ScratchFolder scratch;
  const std::string path = scratch.path("a.understudy");
  const auto refuses = [&](SavedDocument saved, auto change) {
    change(saved);
    EXPECT_THROW(write_document(path, saved), Error);
    EXPECT_FALSE(fs::exists(path));
  };
  const SavedDocument full = full_document(scratch.path(""));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  refuses(full, [&](SavedDocument& s) { s.document.takes[0].pose_edits.raise->offset_m = nan; });
  refuses(full, [&](SavedDocument& s) { s.document.scan_edits.crop->low.x() = nan; });
  refuses(full, [&](SavedDocument& s) { s.document.takes[0].target_edits.joints[0].joint = -1; });
  refuses(full, [&](SavedDocument& s) { s.document.truth = "/a/caf\xe9.npz"; });
  SavedDocument blind = full;  // but no view keeps a document from being saved
  blind.view.cameras[0].yaw = nan;
  blind.playback.frame = std::numeric_limits<double>::infinity();
  blind.document.takes[0].name = "caf\xe9";
  write_document(path, blind);
  EXPECT_EQ(problem_of(path), "");
}

TEST(DocumentFile, FloatsComeBackToTheBit) {
  Rng rng(11);
  SavedDocument saved;
  for (int i = 0; i < 20000; ++i) {
    const uint32_t bits = static_cast<uint32_t>(rng.next());
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value)) saved.document.source.betas.push_back(value);
  }
  const std::string text = to_json(saved, "").dump();
  const SavedDocument read = from_json(Json::parse(text), "", "doc");
  EXPECT_EQ(read.document.source.betas, saved.document.source.betas);
  EXPECT_LT(text.size(), 17 * saved.document.source.betas.size());
}

TEST(DocumentFile, WhatIsNoDocumentSaysSo) {
  ScratchFolder scratch;
  const std::string path = scratch.path("a.understudy");
  EXPECT_EQ(problem_of(path), path + ": there is no such file");
  EXPECT_EQ(problem_of(scratch.path("")), scratch.path("") + ": is a folder, not a file");
  EXPECT_EQ(problem_of("/dev/zero"), "/dev/zero: is a pipe or a device, not a file");
  write(path, "");
  EXPECT_EQ(problem_of(path), path + ": is empty");
  write(path, "{\"a\": }");
  EXPECT_EQ(problem_of(path), path + ": is damaged at byte 7");
  for (const char* text : {"{}", "[1, 2]", "3", "{\"format\": 1}", "{\"format\": \"gltf\"}"}) {
    write(path, text);
    EXPECT_EQ(problem_of(path), path + ": is not an Understudy document") << text;
  }
  write(path, "{\"format\": \"understudy document\", \"version\": 2, \"source\": 4}");
  EXPECT_EQ(problem_of(path), path +
                                  ": was saved by a newer Understudy (version 2 of documents, this program "
                                  "knows 1)");
  write(path, "{\"format\": \"understudy document\", \"version\": 1, \"source\": {\"fps\": 1e999}}");
  EXPECT_EQ(problem_of(path), path + ": holds something that is not a number");
  write(path, std::string(1 << 20, '['));
  EXPECT_NE(problem_of(path).find("damaged"), std::string::npos);
}

/// Whatever the bytes: a document or an Error that names the file, and a document that was read can be saved.
/// True for a document.
bool survives(const std::string& bytes) {
  try {
    to_json(from_json(parse_json(bytes, "a.understudy"), "/a", "a.understudy"), "/a");
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 14), "a.understudy: ") << error.what();
  }
  return false;
}

TEST(DocumentFile, ATruncatedFileIsAnError) {
  ScratchFolder scratch;
  const std::string path = scratch.path("a.understudy");
  write_document(path, full_document(scratch.path("")));
  const std::string bytes = read_bytes(path);
  EXPECT_TRUE(survives(bytes));
  for (size_t length = 0; length + 2 < bytes.size(); length += 7)
    EXPECT_FALSE(survives(bytes.substr(0, length))) << length;
  write(path, bytes.substr(0, bytes.size() / 2));
  EXPECT_NE(problem_of(path).find(path + ": is damaged at byte "), std::string::npos);
}

TEST(DocumentFile, SurvivesMutations) {
  const std::string bytes = json_text(to_json(full_document("/a"), "/a"));
  const std::string inserts[] = {"9999999999", "-",  "[",   "]",       "{",    "}",
                                 "null",       "\"", "e99", "\\u0000", "\xff", ","};
  Rng rng(5);
  int read = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string mutant = bytes;
    for (int i = 0; i <= rng.below(3); ++i) {
      const size_t at = static_cast<size_t>(rng.below(static_cast<int>(mutant.size())));
      switch (rng.below(4)) {
        case 0:
          mutant[at] = static_cast<char>(rng.below(256));
          break;
        case 1:
          mutant.erase(at, static_cast<size_t>(1 + rng.below(20)));
          break;
        case 2:
          mutant.insert(at, inserts[rng.below(12)]);
          break;
        default:
          mutant[at] = static_cast<char>('0' + rng.below(10));
          break;
      }
    }
    read += survives(mutant);
  }
  EXPECT_GT(read, 100);  // figures and names that are merely others
}

/// Values are exchanged as a whole, so that all mutants are JSON and reach the reading of members.
TEST(DocumentFile, SurvivesMembersOfAnotherKind) {
  const Json full = to_json(full_document("/a"), "/a").flatten();
  const Json others[] = {nullptr,       true,           -1,         1e300,    "text",
                         Json::array(), Json::object(), 4294967296, Json{{1}}};
  int refused = 0;
  for (const auto& item : full.items())
    for (const Json& other : others) {
      Json mutant = full;
      mutant[item.key()] = other;
      try {
        to_json(from_json(mutant.unflatten(), "/a", "doc"), "/a");
      } catch (const Error&) {
        ++refused;
      } catch (const nlohmann::json::exception&) {
        // unflatten() takes no structured values: not what is tested
      }
    }
  EXPECT_GT(refused, 500);
}

/// While it lives no file may grow beyond so many bytes, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit old_{};
  void (*handler_)(int);
};

TEST(DocumentFile, AFullDiskLeavesTheOldDocument) {
  ScratchFolder scratch;
  const std::string path = scratch.path("a.understudy");
  write_document(path, SavedDocument{});
  const std::string before = read_bytes(path);
  std::string problem;
  {
    const FullDisk full(1000);
    try {
      write_document(path, full_document(scratch.path("")));
    } catch (const Error& error) {
      problem = error.what();
    }
  }
  EXPECT_EQ(problem, path + ": cannot be written (File too large)");
  EXPECT_EQ(read_bytes(path), before);
  EXPECT_EQ(scratch.files().size(), 1u);  // nothing half-written is left
}

TEST(DocumentFile, WritesOnlyWhereItMay) {
  ScratchFolder scratch;
  EXPECT_THROW(write_document(scratch.path("no/such/a.understudy"), {}), Error);
  EXPECT_THROW(write_document(scratch.path(""), {}), Error);
  EXPECT_THROW(write_document("/dev/full", {}), Error);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_THROW(write_document("/proc/a.understudy", {}), Error);
  EXPECT_THROW(write_document("", {}), Error);
}

TEST(DocumentFile, FollowsALinkAndKeepsThePermissions) {
  ScratchFolder scratch;
  write(scratch.path("real.understudy"), "old");
  chmod(scratch.path("real.understudy").c_str(), 0600);
  fs::create_symlink("real.understudy", scratch.path("link.understudy"));
  write_document(scratch.path("link.understudy"), {});
  EXPECT_TRUE(fs::is_symlink(scratch.path("link.understudy")));
  EXPECT_EQ(problem_of(scratch.path("real.understudy")), "");
  struct stat status {};
  stat(scratch.path("real.understudy").c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

/// A document with one take, all of whose `count` vertices were painted.
SavedDocument painted_document(int count) {
  Rng rng(1);
  WeightRows rows;
  rows.rows = RowMatrix::Zero(count, kJointCount);
  for (int v = 0; v < count; ++v) {
    rows.vertex.push_back(v);
    for (int k = 0; k < 4; ++k) rows.rows(v, rng.below(kJointCount)) += 0.01f + rng.uniform();
    rows.rows.row(v) /= rows.rows.row(v).sum();
  }
  SavedDocument saved;
  saved.document.takes.resize(1);
  saved.document.takes[0].target_edits.weights = std::make_shared<const WeightRows>(rows);
  return saved;
}

TEST(DocumentFile, ALargePaintedDocumentIsSmallAndCostsNoMoreAVertex) {
  ScratchFolder scratch;
  const std::string path = scratch.path("a.understudy");
  const auto bytes_allocated = [&](int count) {
    const SavedDocument saved = painted_document(count);
    const uint64_t before = allocated;
    write_document(path, saved);
    const SavedDocument read = read_document(path);
    const uint64_t after = allocated;
    EXPECT_TRUE(same(read.document, saved.document));
    EXPECT_LT(fs::file_size(path), 80u * count);
    return after - before;
  };
  const uint64_t small = bytes_allocated(5000), large = bytes_allocated(50000);
  EXPECT_LE(large, 15 * small);
  EXPECT_LT(large, uint64_t{50000} * 8192);
}

TEST(MissingFiles, AreNamedOnce) {
  ScratchFolder scratch;
  write(scratch.path("there.obj"), "");
  Document document;
  document.source.path = scratch.path("scans");
  document.source.times = scratch.path("times.csv");
  document.takes.resize(3);
  document.takes[0].target.path = scratch.path("there.obj");
  document.takes[1].target.path = document.takes[2].target.path = scratch.path("gone.obj");
  EXPECT_EQ(
      missing_files(document),
      (std::vector<std::string>{scratch.path("scans"), scratch.path("times.csv"), scratch.path("gone.obj")}));
  EXPECT_TRUE(missing_files({}).empty());
}

TEST(Relocated, MovesWhatIsBelowAndLeavesTheRest) {
  Document document;
  document.source.path = "/data/old/scans";
  document.source.times = "/data/old/times.csv";
  document.truth = "/data/older/truth.npz";
  document.takes.resize(2);
  document.takes[0].target.path = "/data/old";
  document.takes[1].target.path = "/data/old/bodies/a b.obj";
  for (const char* slash : {"", "/"}) {
    const Document moved = relocated(document, std::string("/data/old") + slash, std::string("/new") + slash);
    EXPECT_EQ(moved.source.path, "/new/scans");
    EXPECT_EQ(moved.source.times, "/new/times.csv");
    EXPECT_EQ(moved.truth, "/data/older/truth.npz");
    EXPECT_EQ(moved.takes[0].target.path, "/new");
    EXPECT_EQ(moved.takes[1].target.path, "/new/bodies/a b.obj");
    EXPECT_EQ(moved.source.motion, "");
  }
  EXPECT_THROW(relocated(document, "", "/new"), Error);
}

}  // namespace
}  // namespace understudy::app
