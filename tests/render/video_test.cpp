// Films are decoded again by libav: how many pictures, how large, which colours.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include "render/video_writer.hpp"
#include "retarget/base/error.hpp"

namespace understudy::render {
namespace {

namespace fs = std::filesystem;

struct Film {
  int width = 0, height = 0;
  double fps = 0, seconds = 0;
  std::vector<Vec3> means;  ///< of each picture, 0..255
};

Vec3 mean_of(const AVFrame& frame) {
  SwsContext* scale =
      sws_getContext(frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
                     frame.height, AV_PIX_FMT_RGB24, SWS_BICUBIC, nullptr, nullptr, nullptr);
  sws_setColorspaceDetails(scale, sws_getCoefficients(SWS_CS_ITU709), 0, sws_getCoefficients(SWS_CS_ITU709),
                           1, 0, 1 << 16, 1 << 16);
  std::vector<uint8_t> rgb(static_cast<size_t>(frame.width) * frame.height * 3 + 64);
  uint8_t* rows[] = {rgb.data()};
  const int strides[] = {3 * frame.width};
  sws_scale(scale, frame.data, frame.linesize, 0, frame.height, rows, strides);
  sws_freeContext(scale);
  Vec3 sum = Vec3::Zero();
  const int count = frame.width * frame.height;
  for (int i = 0; i < 3 * count; ++i) sum[i % 3] += rgb[static_cast<size_t>(i)];
  return sum / static_cast<float>(count);
}

Film decoded(const std::string& path) {
  Film film;
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, path.c_str(), nullptr, nullptr) < 0) return film;
  avformat_find_stream_info(format, nullptr);
  const AVStream& stream = *format->streams[0];
  AVCodecContext* decoder = avcodec_alloc_context3(avcodec_find_decoder(stream.codecpar->codec_id));
  avcodec_parameters_to_context(decoder, stream.codecpar);
  avcodec_open2(decoder, nullptr, nullptr);
  film.width = stream.codecpar->width;
  film.height = stream.codecpar->height;
  film.fps = av_q2d(stream.avg_frame_rate);
  film.seconds = static_cast<double>(format->duration) / AV_TIME_BASE;
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  bool more = true;
  while (more) {
    more = av_read_frame(format, packet) >= 0;
    avcodec_send_packet(decoder, more ? packet : nullptr);
    while (avcodec_receive_frame(decoder, frame) >= 0) film.means.push_back(mean_of(*frame));
    av_packet_unref(packet);
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&decoder);
  avformat_close_input(&format);
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
  EXPECT_NEAR(film.seconds, 12 / 25., 0.02);
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
