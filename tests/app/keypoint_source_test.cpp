// 2D poses as a source for targets in space.
#include "app/run/keypoint_source.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "tests/app/program.hpp"
#include "tests/support/fake_lifter.hpp"
#include "tests/support/flat_person.hpp"

namespace understudy::app {
namespace {

using nlohmann::json;

class KeypointSources : public testing::Test {
 protected:
  /// OpenPose's frames; those in `empty` show nobody.
  SourceOptions written(int frames, const std::vector<int>& empty = {}) {
    json list = json::array();
    for (int t = 0; t < frames; ++t) {
      json frame = {{"canvas_width", 640}, {"canvas_height", 480}, {"people", json::array()}};
      const bool shows = std::find(empty.begin(), empty.end(), t) == empty.end();
      const FlatPose pose = flat_person(300 + 2 * static_cast<float>(t));
      json numbers = json::array();
      for (Eigen::Index i = 0; i < pose.body.size(); ++i) numbers.push_back(pose.body.data()[i]);
      if (shows) frame["people"].push_back({{"pose_keypoints_2d", numbers}});
      list.push_back(frame);
    }
    SourceOptions options;
    options.path = scratch.path("poses.json");
    write_file(options.path, list.dump());
    options.quiet = true;
    return options;
  }
  static SourceTools tools() {
    SourceTools tools;
    tools.lifter = [] { return std::make_unique<FakeLifter>(); };
    return tools;
  }
  std::string refusal_of(const SourceOptions& options) {
    return failure_of([&] { open_source(options); });
  }

  tests::ScratchFolder scratch;
};

TEST_F(KeypointSources, AreOpenedByContentAndLifted) {
  const auto source = open_source(written(4));
  source->set_tools(tools());
  EXPECT_EQ(source->count(), 4);
  EXPECT_NE(source->decision().find("1.7 m"), std::string::npos);
  for (int64_t t = 0; t < 4; ++t) {
    const auto frame = source->next();
    ASSERT_TRUE(frame && frame->usable && frame->skeleton);
    EXPECT_EQ(frame->number, t);
    EXPECT_FALSE(frame->skeleton->exact);
    EXPECT_GT(frame->mesh.vertices.rows(), 0);
  }
  EXPECT_FALSE(source->next());
}

TEST_F(KeypointSources, AFrameIsTheSameInWhateverOrderItIsAskedFor) {
  const SourceOptions options = written(6);
  const auto once = open_source(options), again = open_source(options);
  once->set_tools(tools()), again->set_tools(tools());
  std::vector<Joints> in_order;
  while (const auto frame = once->next()) in_order.push_back(frame->skeleton->joints);
  for (const int64_t t : {4, 1, 5, 0}) {
    again->seek(t);
    EXPECT_EQ(again->next()->skeleton->joints, in_order[static_cast<size_t>(t)]) << t;
  }
  EXPECT_THROW(again->seek(6), Error);
}

TEST_F(KeypointSources, FramesOfNobodyAreNotUsableAndTimeGoesOn) {
  const auto source = open_source(written(4, {1, 2}));
  source->set_tools(tools());
  const auto first = source->next(), second = source->next(), third = source->next(), fourth = source->next();
  EXPECT_TRUE(first->usable && fourth->usable);
  EXPECT_FALSE(second->usable || third->usable);
  EXPECT_FALSE(second->skeleton);
  EXPECT_NE(second->problem.find("not seen in frame 1"), std::string::npos) << second->problem;
  // FakeLifter has the seconds since the frame before in z.
  EXPECT_NEAR(fourth->skeleton->joints(Pelvis, 2) - human_rest()(Pelvis, 2), 3 / 30.0f, 1e-5f);
}

TEST_F(KeypointSources, NoFrameDependsOnALaterOne) {
  const auto whole = open_source(written(5));
  whole->set_tools(tools());
  std::vector<Joints> joints;
  while (const auto frame = whole->next()) joints.push_back(frame->skeleton->joints);
  const auto part = open_source(written(3));
  part->set_tools(tools());
  for (size_t t = 0; t < 3; ++t) EXPECT_EQ(part->next()->skeleton->joints, joints[t]);
}

TEST_F(KeypointSources, WithoutALifterThereIsASentence) {
  const auto source = open_source(written(2));
  EXPECT_NE(failure_of([&] { source->next(); }).find("poses.json: 2D poses are performed in space by"),
            std::string::npos);
}

TEST_F(KeypointSources, OptionsOfOtherSourcesAreRefused) {
  const SourceOptions plain = written(2);
  const auto refused = [&](const std::function<void(SourceOptions&)>& change) {
    SourceOptions options = plain;
    change(options);
    return refusal_of(options);
  };
  EXPECT_NE(refused([](auto& o) { o.follow = true; }).find("--follow"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.times = "t.csv"; }).find("--times"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.complete = 30; }).find("--complete"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.as_scan = true; }).find("--as-scan"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.clip = "walk"; }).find("--clip"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.betas = {1}; }).find("--source-betas"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.person = "all"; }).find("--person"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.person = "anna"; }).find("anna"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.canvas = "wide"; }).find("wide"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.layout = "nobody5"; }).find("nobody5"), std::string::npos);
  EXPECT_EQ(refused([](auto&) {}), "");
}

TEST_F(KeypointSources, OtherSourcesHaveNoPicture) {
  SourceOptions scans;
  scans.path = scratch.path("scan.xyz");
  write_file(scans.path, "0 0 0\n");
  scans.layout = "coco17";
  EXPECT_NE(refusal_of(scans).find("--layout"), std::string::npos);
  scans.layout.clear(), scans.fov = 40;
  EXPECT_NE(refusal_of(scans).find("--fov"), std::string::npos);
}

}  // namespace
}  // namespace understudy::app
