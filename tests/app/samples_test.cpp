#include "app/run/samples.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

struct Folder {
  fs::path path = fs::temp_directory_path() / ("understudy_samples_" + std::to_string(getpid()));
  Folder() { write_samples(path.string()); }
  ~Folder() { fs::remove_all(path); }
};
const fs::path& written() {
  static const Folder folder;
  return folder.path;
}

uint64_t size_of(const fs::path& folder) {
  uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

TEST(Samples, HoldScansOfThreeToSixThousandPoints) {
  std::set<Eigen::Index> counts;
  int frames = 0;
  for (const auto& entry : fs::directory_iterator(written() / "scan")) {
    const Mesh scan = read_mesh(entry.path().string());
    ASSERT_TRUE(scan.is_cloud());
    ASSERT_GT(scan.vertices.rows(), 3000) << entry.path();
    ASSERT_LT(scan.vertices.rows(), 6500) << entry.path();
    counts.insert(scan.vertices.rows());
    ++frames;
  }
  EXPECT_EQ(frames, 87);
  EXPECT_GT(counts.size(), 40u);
}

TEST(Samples, HoldAnAnimalInThreeMegabytes) {
  const fs::path folder = written() / "animal", bundled = fs::path(US_SOURCE_DIR) / "assets/samples/animal";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 48);
  EXPECT_EQ(std::distance(fs::directory_iterator(bundled), {}), 48);
  EXPECT_LT(size_of(folder), 3'000'000u);
  const Mesh scan = read_mesh((bundled / "frame_00000.ply").string());
  EXPECT_GT(scan.vertices.rows(), 3000);
  EXPECT_GT(scan.vertices.col(2).maxCoeff() - scan.vertices.col(2).minCoeff(),
            scan.vertices.col(1).maxCoeff() - scan.vertices.col(1).minCoeff())
      << "longer than it is high";
}

TEST(Samples, HoldTwoDifferentTargetsStandingOnTheFloor) {
  const Mesh adult = read_mesh((written() / "target_adult.glb").string()),
             child = read_mesh((written() / "target_child.glb").string());
  for (const Mesh* mesh : {&adult, &child}) {
    EXPECT_FALSE(mesh->is_cloud());
    EXPECT_GE(mesh->vertices.rows(), 8000);
    EXPECT_NEAR(mesh->vertices.col(1).minCoeff(), 0, 1e-4f);
  }
  EXPECT_NEAR(adult.vertices.col(1).maxCoeff(), 1.76f, 0.01f);
  EXPECT_NEAR(child.vertices.col(1).maxCoeff(), 1.15f, 0.01f);
}

TEST(Samples, HoldADanceAsPosesAndAGirlToDanceInAPicture) {
  for (const fs::path& folder : {written(), fs::path(US_SOURCE_DIR) / "assets/samples"}) {
    const KeypointReading film = read_keypoints((folder / "poses").string());
    EXPECT_EQ(film.frames.size(), 90u);
    EXPECT_EQ(film.canvas, (Canvas{1024, 768}));
    ASSERT_EQ(film.tracks.size(), 2u) << "somebody walks by";
    EXPECT_EQ(film.performing().poses.size(), 90u);
    const auto ahead = [&](int64_t frame) {
      return film.tracks[1].at(frame)->at(body25::Neck).x() - film.tracks[0].at(frame)->at(body25::Neck).x();
    };
    EXPECT_LT(ahead(0), -200) << "he comes from the left,";
    EXPECT_GT(ahead(89), 50) << "and passes her";
    const KeypointReading girl = read_keypoints((folder / "reference.json").string());
    EXPECT_EQ(girl.canvas, (Canvas{1024, 768}));
    EXPECT_EQ(points_seen(*girl.performing().at(0)), 19) << "18, and the middle of the hips";
    EXPECT_EQ(render::read_png((folder / "reference.png").string()).height, 768);
    EXPECT_LT(size_of(folder / "poses") + fs::file_size(folder / "reference.png"), 1'000'000u);
  }
}

TEST(Samples, TakeUnderFifteenMegabytesAndLeaveNoParts) {
  EXPECT_LT(size_of(written()), 15'000'000u);
  for (const auto& entry : fs::recursive_directory_iterator(written()))
    EXPECT_NE(entry.path().extension(), ".part");
}

TEST(Samples, BundledOnesAreWhatTheProgramMakes) {
  // Byte for byte they may differ on another machine by the last digit of a sine: sizes and shapes may not.
  const fs::path bundled = fs::path(US_SOURCE_DIR) / "assets/samples";
  EXPECT_EQ(std::distance(fs::directory_iterator(bundled / "scan"), {}),
            std::distance(fs::directory_iterator(written() / "scan"), {}));
  const Mesh a = read_mesh((bundled / "target_child.glb").string()),
             b = read_mesh((written() / "target_child.glb").string());
  EXPECT_NEAR(static_cast<double>(a.vertices.rows()), static_cast<double>(b.vertices.rows()), 100);
  EXPECT_NEAR(a.vertices.col(0).maxCoeff(), b.vertices.col(0).maxCoeff(), 1e-3f);
  const Points frame = read_mesh((bundled / "scan/frame_00000.ply").string()).vertices,
               made = read_mesh((written() / "scan/frame_00000.ply").string()).vertices;
  EXPECT_LT((frame.colwise().mean() - made.colwise().mean()).norm(), 0.02f);
}

TEST(Samples, ReadmeNamesEveryFileWithItsChecksum) {
  const std::string readme = text_of(written() / "README.md");
  for (const char* word : {"scan/", "walk/", "animal/", "target_adult.glb", "target_child.glb", "poses/",
                           "reference.json", "reference.png", "MIT"})
    EXPECT_NE(readme.find(word), std::string::npos) << word;
}

TEST(Samples, RefuseAFolderThatCannotBeMade) {
  try {
    write_samples("/proc/samples");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/samples"), std::string::npos);
  }
}

}  // namespace
}  // namespace understudy::app
