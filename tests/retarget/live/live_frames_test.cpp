// A live stream as scans: what comes is handed out, what cannot be used says why.
#include "retarget/live/live_frames.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "retarget/base/log.hpp"
#include "tests/support/stream_sender.hpp"

namespace understudy {
namespace {

/// A PLY of one triangle, x of its corners as given, with its length.
std::string triangle(const std::string& x) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      x + " 0 0\n" + x + " 1 0\n" + x + " 0 1\n3 0 1 2\n";
  const auto size = static_cast<uint32_t>(ply.size());
  std::string bytes(sizeof size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  return bytes + ply;
}

class Live : public testing::Test {
 protected:
  void SetUp() override {
    static std::string said;
    said.clear();
    const log::Sink before = log::set_sink([](log::Level, const std::string& text) { said = text; });
    LiveOptions options;
    options.address = "tcp://127.0.0.1:0";
    options.wait_s = 20;
    frames_ = live_frames(options);
    log::set_sink(before);
    camera_.emplace(said.substr(0, said.find(": waits")));
  }
  /// The next one that came.
  ScanFrame next() {
    for (;;) {
      auto frame = frames_->next();
      US_CHECK(frame, "no frame came");
      if (frame->live) return std::move(*frame);
    }
  }
  std::unique_ptr<ScanSource::Frames> frames_;
  std::optional<tests::StreamSender> camera_;
};

TEST_F(Live, AMeshWithoutAFinitePointIsNotUsedAndTheNextOneIs) {
  camera_->send(triangle("nan"));
  const ScanFrame blind = next();
  EXPECT_FALSE(blind.usable);
  EXPECT_TRUE(blind.is_empty);
  EXPECT_EQ(blind.problem, blind.path + ": has no finite points");
  camera_->send(triangle("2"));
  const ScanFrame seen = next();
  EXPECT_TRUE(seen.usable) << seen.problem;
  EXPECT_EQ(seen.mesh.faces.rows(), 1);
  EXPECT_GT(seen.number, blind.number);
}

TEST_F(Live, AFrameThatCannotBeReadSaysWhyAndTheNextOneIsRead) {
  std::string cut = triangle("1");
  cut.replace(cut.find("3 0 1 2"), 7, "3 0 1 7");
  camera_->send(cut);
  const ScanFrame bad = next();
  EXPECT_FALSE(bad.usable);
  EXPECT_FALSE(bad.is_empty);
  EXPECT_EQ(bad.problem.rfind(bad.path + ": ", 0), 0u) << bad.problem;
  camera_->send(triangle("2"));
  EXPECT_TRUE(next().usable);
}

}  // namespace
}  // namespace understudy
