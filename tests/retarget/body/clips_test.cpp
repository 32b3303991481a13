#include "retarget/body/clips.hpp"

#include <gtest/gtest.h>

#include <climits>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/formats/npz_writer.hpp"

namespace understudy {
namespace {

class Clips : public testing::Test {
 protected:
  Clips() { std::filesystem::create_directories(folder); }
  ~Clips() override { std::filesystem::remove_all(folder); }
  void write(const std::string& name, const std::vector<float>& flags) const {
    const auto count = static_cast<int64_t>(flags.size());
    write_npz(folder + "/" + name, {{"poses", {{count, 66}, std::vector<float>(66 * flags.size()), ""}},
                                    {"trans", {{count, 3}, std::vector<float>(3 * flags.size()), ""}},
                                    {"mocap_framerate", {{}, {30}, ""}},
                                    {"frame_flags", {{count}, flags, ""}}});
  }
  const std::string folder = testing::TempDir() + "clips_test";
};

TEST_F(Clips, AreReadInTheOrderOfTheirNamesWithTheirGoodFrames) {
  write("b.npz", {0, 1, 0, 0});
  write("a.npz", {0, 0});
  write("bad.npz", {1, 2});
  const std::vector<Clip> clips = read_clips(folder);
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0].good, (std::vector<int>{0, 1}));
  EXPECT_EQ(clips[1].good, (std::vector<int>{0, 2, 3}));
  EXPECT_EQ(clip_files(folder).size(), 3u);
  EXPECT_TRUE(clip_labels(folder + "/a.npz").empty());
  EXPECT_THROW(read_clip(folder + "/none.npz"), Error);
}

TEST_F(Clips, RunsHaveNoFlaggedFrame) {
  write("a.npz", {0, 0, 1, 0, 0, 0, 0, 0, 1, 0});
  const std::vector<Clip> clips = read_clips(folder);
  const auto runs = good_runs(clips, 2, INT_MAX);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].first, 0);
  EXPECT_EQ(runs[0].count, 2);
  EXPECT_EQ(runs[1].first, 3);
  EXPECT_EQ(runs[1].count, 5);
  EXPECT_EQ(good_runs(clips, 2, 3).size(), 3u);  // 2, 3 and 2
}

TEST_F(Clips, SayInASentenceWhatTheyShow) {
  const auto said = [&](const std::string& info) {
    NpzWriter writer(folder + "/a.npz");
    writer.add("info", info);
    writer.finish();
    return clip_description(folder + "/a.npz");
  };
  EXPECT_EQ(said(R"({"actions": ["wave"], "desc": "Wave your other hand"})"), "Wave your other hand");
  EXPECT_EQ(said(R"({"desc": 3})"), "");
  EXPECT_EQ(said("no JSON"), "");
  write("b.npz", {0});
  EXPECT_EQ(clip_description(folder + "/b.npz"), "");
}

TEST(ClipLabels, AreTheActionsOfTheInfo) {
  EXPECT_EQ(labels_of_info(R"({"name": "x", "actions": ["run", "turn"]})"),
            (std::vector<std::string>{"run", "turn"}));
  EXPECT_TRUE(labels_of_info(R"({"actions": "run"})").empty());
  EXPECT_TRUE(labels_of_info("").empty());
}

}  // namespace
}  // namespace understudy
