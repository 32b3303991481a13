#include "retarget/keypoints/keypoint_follower.hpp"

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/retarget/keypoints/support.hpp"

namespace understudy {
namespace {

using namespace test;

class KeypointFollowing : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_.path("p")); }
  std::string poses() const { return folder_.path("p"); }
  void write(int number, const std::vector<FlatPose>& people) {
    folder_.write("p/f_" + std::to_string(number) + ".json", openpose_frame(people).dump());
  }
  static FlatPose bob(float x = 300) { return standing({x, 400}, 300); }
  static FolderFollowOptions quick(double timeout_s = 0.4) {
    FolderFollowOptions options;
    options.timeout_s = timeout_s, options.poll_s = 0.005;
    return options;
  }
  TempFolder folder_;
};

TEST_F(KeypointFollowing, FramesComeWhileTheFolderIsWritten) {
  std::thread writer([this] {
    for (int t = 0; t < 12; ++t) {
      write(t, {bob(300 + 2.0f * static_cast<float>(t))});
      std::this_thread::sleep_for(std::chrono::milliseconds(15));
    }
    folder_.write("p/done", "");
  });
  KeypointFollower follower(poses(), {}, quick(20));
  int64_t frames = 0;
  while (const auto frame = follower.next()) {
    ASSERT_TRUE(frame->pose) << frame->problem;
    EXPECT_EQ(frame->number, frames);
    EXPECT_EQ(frame->pose->at(body25::Nose).x(), 300 + 2.0f * static_cast<float>(frames));
    EXPECT_NEAR(frame->dt, kFrame, 1e-9);
    ++frames;
  }
  writer.join();
  EXPECT_EQ(frames, 12);
  const KeypointReading whole = follower.finish();
  EXPECT_EQ(whole.frames.size(), 12u);
  EXPECT_EQ(*whole.performing().at(5), *read_keypoints(poses()).performing().at(5));
}

TEST_F(KeypointFollowing, AFileThatIsHalfWrittenIsWaitedFor) {
  const std::string text = openpose_frame({bob()}).dump();
  folder_.write("p/f_0.json", text.substr(0, text.size() / 2));
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(80));
    folder_.write("p/f_0.json", text);
    folder_.write("p/.done", "");
  });
  KeypointFollower follower(poses(), {}, quick(20));
  const auto frame = follower.next();
  writer.join();
  ASSERT_TRUE(frame && frame->pose) << (frame ? frame->problem : "");
  EXPECT_FALSE(follower.next());
}

TEST_F(KeypointFollowing, WhatStaysBrokenIsAFrameWithAProblem) {
  write(0, {bob()}), write(2, {bob()});
  folder_.write("p/f_1.json", R"({"people":[{"pose_keypo)");
  KeypointFollower follower(poses(), {}, quick());
  ASSERT_TRUE(follower.next()->pose);
  const auto broken = follower.next();
  EXPECT_FALSE(broken->pose);
  EXPECT_TRUE(contains(broken->problem, "f_1.json: its JSON is broken or cut off")) << broken->problem;
  EXPECT_TRUE(follower.next()->pose);
  EXPECT_FALSE(follower.next());
}

TEST_F(KeypointFollowing, NumbersThatAreLeftOutTakeTheirTime) {
  for (const int number : {1, 2, 5}) write(number, {bob()});
  KeypointFollower follower(poses(), {}, quick());
  std::vector<int64_t> numbers;
  double seconds = 0;
  while (const auto frame = follower.next()) {
    numbers.push_back(frame->number), seconds += frame->dt;
    EXPECT_EQ(frame->pose.has_value(), frame->number < 3 || frame->number > 4);
    if (!frame->pose) EXPECT_TRUE(contains(frame->problem, "is missing")) << frame->problem;
  }
  EXPECT_EQ(numbers, (std::vector<int64_t>{1, 2, 3, 4, 5}));
  EXPECT_NEAR(seconds, 5 * kFrame, 1e-9);
}

TEST_F(KeypointFollowing, AFileThatIsThereTwiceCountsOnce) {
  for (const int number : {0, 1, 2}) write(number, {bob()});
  folder_.write("p/f_1_0.json", openpose_frame({bob(500)}).dump());  // sorted behind f_1, numbered before it
  folder_.write("p/done", "");
  KeypointFollower follower(poses(), {}, quick(20));
  std::vector<int64_t> numbers;
  while (const auto frame = follower.next()) {
    numbers.push_back(frame->number);
    EXPECT_EQ(frame->pose, bob());
  }
  EXPECT_EQ(numbers, (std::vector<int64_t>{0, 1, 2}));
}

TEST_F(KeypointFollowing, AFileThatComesAfterItsSuccessorFindsItsPlace) {
  for (const int number : {0, 1, 3}) write(number, {bob()});
  std::thread writer([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    write(2, {bob()});
    folder_.write("p/done", "");
  });
  KeypointFollower follower(poses(), {}, quick(20));
  std::vector<bool> seen;
  while (const auto frame = follower.next()) seen.push_back(frame->pose.has_value());
  writer.join();
  EXPECT_EQ(seen, std::vector<bool>(4, true));
}

TEST_F(KeypointFollowing, TheLargestOfTheFirstFrameOrWhoIsAskedForPerforms) {
  const FlatPose small = standing({100, 300}, 100);
  for (const int number : {0, 1, 2}) write(number, {small, bob()});
  EXPECT_EQ(KeypointFollower(poses(), {}, quick()).next()->pose, bob());
  KeypointReaderOptions first;
  first.person = 1;
  EXPECT_EQ(KeypointFollower(poses(), first, quick()).next()->pose, small);
}

TEST_F(KeypointFollowing, AFolderThatNeverGetsAFrameIsAnError) {
  KeypointFollower follower(poses(), {}, quick(0.05));
  EXPECT_EQ(error_of([&] { follower.next(); }), poses() + ": no frame came within 0.05 s");
  EXPECT_NE(error_of([&] { KeypointFollower(folder_.path("q"), {}, quick()); }), "");
}

TEST_F(KeypointFollowing, EndsWhenItIsCancelled) {
  FolderFollowOptions options = quick(1000);
  options.cancelled = [] { return true; };
  EXPECT_FALSE(KeypointFollower(poses(), {}, options).next());
}

}  // namespace
}  // namespace understudy
