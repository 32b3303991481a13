// Films are written and read again: how many pictures, how large, which colours.
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>

#include "render/video_reader.hpp"
#include "render/video_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"

namespace understudy::render {
namespace {

namespace fs = std::filesystem;

struct Film {
  int width = 0, height = 0;
  double fps = 0;
  std::vector<Vec3> means;  ///< of each picture, 0..255
};

Vec3 mean_of(const Image& image) {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < image.pixels.size(); ++i) sum[static_cast<int>(i % 3)] += image.pixels[i];
  return sum / static_cast<float>(image.width * image.height);
}

Film decoded(const std::string& path) {
  VideoReader reader(path);
  Film film{reader.width(), reader.height(), reader.fps(), {}};
  while (reader.next()) film.means.push_back(mean_of(reader.picture()));
  return film;
}

class VideoFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / (std::string("understudy_video_") +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

Vec3 color_at(int frame) {
  return Vec3(0.2f + 0.05f * static_cast<float>(frame), 0.5f, 0.8f - 0.04f * static_cast<float>(frame));
}

void write_film(const std::string& path, const VideoOptions& options, int frames) {
  VideoWriter writer(path, options);
  for (int i = 0; i < frames; ++i) writer.push(Image(options.width, options.height, color_at(i)));
  writer.finish();
}

TEST_F(VideoFile, HasAllPicturesInTheirColours) {
  write_film(path("a.mp4"), {64, 48, 25}, 12);
  const Film film = decoded(path("a.mp4"));
  EXPECT_EQ(film.width, 64);
  EXPECT_EQ(film.height, 48);
  EXPECT_DOUBLE_EQ(film.fps, 25);
  ASSERT_EQ(film.means.size(), 12u);
  for (int i = 0; i < 12; ++i) EXPECT_LT((film.means[i] - 255 * color_at(i)).norm(), 6) << i;
}

TEST_F(VideoFile, OddSidesGainAPixelOfTheSameColour) {
  write_film(path("a.mp4"), {63, 47, 29.97}, 3);
  const Film film = decoded(path("a.mp4"));
  EXPECT_EQ(film.width, 64);
  EXPECT_EQ(film.height, 48);
  EXPECT_NEAR(film.fps, 29.97, 1e-3);
  ASSERT_EQ(film.means.size(), 3u);
  EXPECT_LT((film.means[0] - 255 * color_at(0)).norm(), 6);
}

TEST_F(VideoFile, TransparentPicturesLieOverWhite) {
  VideoWriter writer(path("a.mp4"), {32, 32, 30});
  Image image(32, 32, Vec3::Zero());
  image.alpha.assign(32 * 32, 0);
  writer.push(image);
  writer.finish();
  const Film film = decoded(path("a.mp4"));
  ASSERT_EQ(film.means.size(), 1u);
  EXPECT_GT(film.means[0].minCoeff(), 250);
}

TEST_F(VideoFile, LeavesNothingWhenItIsNotFinished) {
  {
    VideoWriter writer(path("a.mp4"), {32, 32, 30});
    writer.push(Image(32, 32));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(VideoFile, AnOldFilmStaysUntilTheNewOneIsWhole) {
  std::ofstream(path("a.mp4")) << "old";
  {
    VideoWriter writer(path("a.mp4"), {32, 32, 30});
    writer.push(Image(32, 32));
  }
  EXPECT_EQ(fs::file_size(path("a.mp4")), 3u);
  write_film(path("a.mp4"), {32, 32, 30}, 2);
  EXPECT_EQ(decoded(path("a.mp4")).means.size(), 2u);
}

/// What new memory holds is the library's business: here it is filled with a byte.
TEST_F(VideoFile, ARepeatableFilmHasTheSameBytesWhateverIsInMemory) {
  VideoOptions options{208, 110, 30};
  options.repeatable = true;
  std::set<std::string> films;
  for (const int filling : {0, 85, 170}) {
    mallopt(M_PERTURB, filling);
    VideoWriter writer(path("a.mp4"), options);
    Image image(options.width, options.height);
    for (int i = 0; i < 12; ++i) {
      for (size_t k = 0; k < image.pixels.size(); ++k)
        image.pixels[k] = static_cast<uint8_t>(k * (31 + static_cast<size_t>(i)) % 89);
      writer.push(image);
    }
    writer.finish();
    films.insert(read_file(path("a.mp4")));
  }
  mallopt(M_PERTURB, 0);
  EXPECT_EQ(films.size(), 1u);
}

TEST_F(VideoFile, FilmsOfAnyWidthAreReadWithinTheirMemory) {
  for (int width = 18; width < 66; width += 2) {
    write_film(path("a.mp4"), {width, 22, 25}, 2);
    EXPECT_EQ(decoded(path("a.mp4")).means.size(), 2u) << width;
  }
}

TEST_F(VideoFile, AFolderGetsPictures) {
  write_film(path("frames"), {20, 10, 30}, 3);
  const Image last = read_png(path("frames/frame_00002.png"));
  EXPECT_EQ(last.width, 20);
  EXPECT_EQ(last.pixels, Image(20, 10, color_at(2)).pixels);
  EXPECT_FALSE(fs::exists(path("frames/frame_00003.png")));
}

TEST_F(VideoFile, RefusesInASentence) {
  EXPECT_THROW(VideoWriter(path("none/a.mp4"), {32, 32, 30}), Error);
  EXPECT_THROW(VideoWriter(path("a.mp4"), {0, 32, 30}), Error);
  EXPECT_THROW(VideoWriter(path("a.mp4"), {32, 32, std::nan("")}), Error);
  std::ofstream(path("file")) << "no folder";
  EXPECT_THROW(VideoWriter(path("file"), {32, 32, 30}), Error);
  VideoWriter writer(path("a.mp4"), {32, 32, 30});
  EXPECT_THROW(writer.push(Image(32, 30)), Error);
  EXPECT_THROW(writer.finish(), Error);
  writer.push(Image(32, 32));
  writer.finish();
  EXPECT_THROW(writer.push(Image(32, 32)), Error);
}

TEST_F(VideoFile, IsReadAgainFromItsBeginning) {
  write_film(path("a.mp4"), {64, 48, 25}, 12);
  VideoReader reader(path("a.mp4"));
  for (int round = 0; round < 2; ++round) {
    int count = 0;
    while (reader.next())
      if (count++ == 3) EXPECT_LT((mean_of(reader.picture()) - 255 * color_at(3)).norm(), 6);
    EXPECT_EQ(count, 12);
    EXPECT_LT((mean_of(reader.picture()) - 255 * color_at(11)).norm(), 6);
    reader.restart();
  }
}

TEST_F(VideoFile, IsRefusedInASentenceWhenItIsNone) {
  const auto complaint = [](const std::string& file) {
    return failure_of([&] { VideoReader reader(file); });
  };
  EXPECT_NE(complaint(path("gone.mp4")).find("gone.mp4: "), std::string::npos);
  std::ofstream(path("text.mp4")) << "no video";
  EXPECT_NE(complaint(path("text.mp4")).find("text.mp4: is not a video, "), std::string::npos);
  write_film(path("a.mp4"), {64, 48, 25}, 40);
  fs::resize_file(path("a.mp4"), fs::file_size(path("a.mp4")) / 2);
  EXPECT_NE(failure_of([&] { decoded(path("a.mp4")); }).find("a.mp4: "), std::string::npos);
}

TEST(VideoDisk, SaysThatItIsFull) {
  const fs::path folder = fs::temp_directory_path() / "understudy_video_full";
  fs::remove_all(folder);
  fs::create_directories(folder);
  struct rlimit before {};
  ::getrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit little = {1000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &little);
  EXPECT_THROW(
      {
        VideoWriter writer((folder / "a.mp4").string(), {320, 240, 30});
        for (int i = 0; i < 30; ++i) writer.push(Image(320, 240, color_at(i % 10)));
        writer.finish();
      },
      Error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace understudy::render
