// Streams of clouds: what they hold, in any pieces, cut off, and lengths that lie.
#include "retarget/live/stream_format.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"

namespace understudy {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string livescan(const std::vector<std::array<int16_t, 3>>& points) {
  std::string bytes;
  append(bytes, static_cast<int32_t>(points.size()));
  for (const auto& point : points)
    for (const int16_t c : point) append(bytes, c);
  for (size_t i = 0; i < 3 * points.size(); ++i) append(bytes, static_cast<uint8_t>(51 * (i % 3)));
  return bytes;
}

std::string floats(const std::vector<float>& numbers) {
  std::string bytes;
  append(bytes, static_cast<uint32_t>(4 * numbers.size()));
  for (const float number : numbers) append(bytes, number);
  return bytes;
}

std::string with_length(const std::string& payload) {
  std::string bytes;
  append(bytes, static_cast<uint32_t>(payload.size()));
  return bytes + payload;
}

const char* const kPly =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
    "z\nend_header\n"
    "1 2 3\n4 5 6\n";

std::vector<StreamFrame> cut(StreamFormat format, std::string_view bytes, size_t piece) {
  StreamCutter cutter(format);
  std::vector<StreamFrame> frames;
  while (!bytes.empty()) {
    std::string_view now = bytes.substr(0, piece);
    while (!now.empty()) {
      const size_t taken = cutter.push(now);
      now.remove_prefix(taken);
      bytes.remove_prefix(taken);
      if (auto frame = cutter.take()) frames.push_back(std::move(*frame));
    }
  }
  return frames;
}

std::string refusal(StreamFormat format, const std::string& bytes) {
  try {
    cut(format, bytes, bytes.size());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(StreamCutter, CutsFramesWhateverThePiecesAre) {
  const std::string bytes = livescan({{1000, -500, 20}, {0, 1, 2}}) + livescan({}) + livescan({{7, 8, 9}});
  for (size_t piece = 1; piece <= bytes.size(); ++piece) {
    const auto frames = cut(StreamFormat::Auto, bytes, piece);
    ASSERT_EQ(frames.size(), 3u) << piece;
    const Mesh first = decode(frames[0], "camera");
    ASSERT_EQ(first.vertices.rows(), 2) << piece;
    EXPECT_TRUE(first.vertices.row(0).isApprox(Vec3(1, -0.5f, 0.02f).transpose()));
    EXPECT_TRUE(first.colors.row(1).isApprox(Vec3(0, 0.2f, 0.4f).transpose()));
    EXPECT_EQ(decode(frames[1], "camera").vertices.rows(), 0);
    EXPECT_EQ(decode(frames[2], "camera").vertices.rows(), 1);
  }
}

TEST(StreamCutter, KnowsAPlyByItsMark) {
  const std::string bytes = with_length(kPly) + with_length(kPly);
  for (const size_t piece : {size_t{1}, size_t{5}, size_t{8}, bytes.size()}) {
    const auto frames = cut(StreamFormat::Auto, bytes, piece);
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames[1].format, StreamFormat::Ply);
    EXPECT_TRUE(decode(frames[1], "camera").vertices.row(1).isApprox(Vec3(4, 5, 6).transpose()));
  }
}

TEST(StreamCutter, ReadsFloatsAndLeavesOutWhatWasNotSeen) {
  const auto frames = cut(StreamFormat::Float32,
                          floats({1, 2, 3, NAN, 0, 0, 0, 0, 0, 4, 5, INFINITY, 1e30f, 1, 1, -1, 0, 0}), 7);
  ASSERT_EQ(frames.size(), 1u);
  const Mesh cloud = decode(frames[0], "camera");
  ASSERT_EQ(cloud.vertices.rows(), 2);
  EXPECT_TRUE(cloud.vertices.row(1).isApprox(Vec3(-1, 0, 0).transpose()));
}

TEST(StreamCutter, RefusesLengthsThatCannotBe) {
  std::string many, negative;
  append(many, int32_t{10'000'000});
  append(negative, int32_t{-1});
  EXPECT_NE(refusal(StreamFormat::LiveScan, many).find("10,000,000 points, more than 2,000,000"),
            std::string::npos);
  EXPECT_NE(refusal(StreamFormat::LiveScan, negative).find("-1 points"), std::string::npos);
  EXPECT_NE(refusal(StreamFormat::Ply, negative).find("more than"), std::string::npos);
  EXPECT_NE(refusal(StreamFormat::Float32, negative).find("no number of points"), std::string::npos);
  EXPECT_NE(refusal(StreamFormat::Auto, many + "abcd").find("more than 2,000,000"), std::string::npos);
  EXPECT_NE(refusal(StreamFormat::Auto, std::string("\3\0\0\0ply\n", 8)).find("too few"), std::string::npos);
}

TEST(StreamCutter, AStreamThatEndsEarlyGivesNoFrame) {
  const std::string bytes = livescan({{1, 2, 3}, {4, 5, 6}});
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_TRUE(cut(StreamFormat::LiveScan, std::string_view(bytes).substr(0, size), 64).empty()) << size;
}

TEST(StreamCutter, NoiseIsCutOrRefusedButNeverMore) {
  Rng rng(7);
  for (int i = 0; i < 2000; ++i) {
    std::string noise;
    for (int k = 0; k < 64; ++k) noise += static_cast<char>(rng.below(i % 2 ? 256 : 3));
    for (const auto format :
         {StreamFormat::Auto, StreamFormat::LiveScan, StreamFormat::Ply, StreamFormat::Float32}) {
      try {
        for (const StreamFrame& frame : cut(format, noise, 9)) decode(frame, "noise");
      } catch (const Error&) {
      }
    }
  }
}

TEST(StreamFrame, APlyThatLiesNamesTheStream) {
  const StreamFrame lie{StreamFormat::Ply, std::string(kPly).substr(0, std::strlen(kPly) - 5)};
  try {
    decode(lie, "tcp://127.0.0.1:9000");
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("tcp://127.0.0.1:9000"), std::string::npos) << error.what();
  }
}

TEST(StreamFrame, WhatIsNoPlyIsNotReadAsAnythingElse) {
  for (const char* other :
       {"0 0 0\n1 0 0\n0 1 0\n", "OFF\n1 0 0\n0 0 0\n", R"({"asset": {"version": "2.0"}})"})
    try {
      decode({StreamFormat::Ply, other}, "camera");
      FAIL() << "it was read: " << other;
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "camera: a frame is no PLY file");
    }
}

}  // namespace
}  // namespace understudy
