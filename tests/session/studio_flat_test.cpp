// 2D poses in the studio: opened as a source, performed by people in pictures, put right by hand.
#include <nlohmann/json.hpp>

#include "app/run/flat_figures.hpp"
#include "app/run/flat_performance.hpp"
#include "app/session/document_file.hpp"
#include "render/image.hpp"
#include "retarget/base/error.hpp"
#include "tests/session/studio_fixture.hpp"
#include "tests/support/flat_track.hpp"

namespace understudy::app {
namespace {

constexpr int kCount = 8;

class FlatStudioTest : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    write_openpose_folder(path("track"), walking_track(kCount, 4, 2));
    write_controlnet(path("tall.json"), standing_track(1.4f));
    render::write_png(path("tall.png"), render::Image(640, 560, Vec3(0.2f, 0.5f, 0.3f)));
  }
  /// The track, performed by the tall person.
  void open_flat(Studio& studio) {
    studio.run("open", {path("track")});
    studio.run("open", {path("tall.png")});
    studio.wait_idle();
    ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
    ASSERT_TRUE(studio.session().takes.at(0).flat);
  }
};

const FlatResult& result(const Studio& studio, size_t take = 0) {
  return *studio.session().takes.at(take).flat;
}
float length_in(const FlatPose& pose, int bone) {
  return seen_lengths(pose)[bone];
}

TEST_F(FlatStudioTest, AFolderIsTheSourceAndAPictureWithPosesBesideWhoPerformsIt) {
  Studio studio(services());
  open_flat(studio);
  const Session& session = studio.session();
  ASSERT_TRUE(session.flat.poses);
  EXPECT_EQ(frame_count(session), kCount);
  EXPECT_TRUE(is_canvas(session, 0) && is_canvas(session, 1));
  EXPECT_EQ(session.source.name, "track");
  const FlatResult& made = result(studio);
  ASSERT_EQ(made.poses.size(), size_t{kCount});
  ASSERT_TRUE(made.reference->picture);
  EXPECT_EQ(made.reference->picture->width, 640);
  EXPECT_NEAR(length_in(made.poses[3], flat_bone::LeftThigh),
              1.4f * length_in(session.flat.poses->clean[3].pose, flat_bone::LeftThigh), 4);
  EXPECT_EQ(session.playback.frame, 0);
}

TEST_F(FlatStudioTest, TheTakeIsTheVeryTrackOfTheCommandLine) {
  Studio studio(services());
  open_flat(studio);
  FlatOptions options;
  options.source.path = path("track"), options.target.path = path("tall.json");
  const FlatPerformance made = perform_flat(options, {std::make_shared<const SeenLengths>(), {}});
  for (int t = 0; t < kCount; ++t)
    EXPECT_EQ(result(studio).poses[static_cast<size_t>(t)], *made.result.performing().at(t)) << t;
}

TEST_F(FlatStudioTest, ASlidLengthIsPerformedOnBothSidesAndUndone) {
  Studio studio(services());
  open_flat(studio);
  const float before = length_in(result(studio).poses[2], flat_bone::LeftForearm);
  studio.run("flat.length", {"0", "right_forearm", "120"});
  studio.wait_idle();
  EXPECT_EQ(result(studio).lengths.length[flat_bone::LeftForearm], 120);
  EXPECT_GT(length_in(result(studio).poses[2], flat_bone::LeftForearm), 1.3f * before);
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_FLOAT_EQ(length_in(result(studio).poses[2], flat_bone::LeftForearm), before);
}

TEST_F(FlatStudioTest, SlidesOfTwoBonesAreTwoStepsHoweverSoon) {
  Studio studio(services());
  open_flat(studio);
  const float forearm = result(studio).lengths.length[flat_bone::LeftForearm];
  for (const char* const pixels : {"100", "120"}) studio.run("flat.length", {"0", "left_thigh", pixels});
  for (const char* const pixels : {"70", "90"}) studio.run("flat.length", {"0", "left_forearm", pixels});
  for (const char* const point : {"left_wrist", "right_wrist"})
    studio.run("flat.drag", {"3", point, "260", "90", "0"});
  studio.run("edit.undo");
  EXPECT_EQ(studio.session().document.source.point_edits.size(), 1u);
  studio.run("edit.undo"), studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_FLOAT_EQ(result(studio).lengths.length[flat_bone::LeftForearm], forearm);
  EXPECT_FLOAT_EQ(result(studio).lengths.length[flat_bone::LeftThigh], 120) << "one slide is one step";
}

TEST_F(FlatStudioTest, ALockedLengthStaysWhenTheOtherSideOrThePersonGrows) {
  Studio studio(services());
  open_flat(studio);
  const float before = result(studio).lengths.length[flat_bone::LeftShin];
  studio.run("flat.lock", {"0", "left_shin", "on"});
  studio.run("flat.length", {"0", "right_shin", "200"});
  studio.run("flat.scale", {"0", "1.5"});
  studio.wait_idle();
  EXPECT_FLOAT_EQ(result(studio).lengths.length[flat_bone::LeftShin], before);
  EXPECT_FLOAT_EQ(result(studio).lengths.length[flat_bone::RightShin], 300);
  EXPECT_THROW(studio.run("flat.length", {"0", "left_shin", "10"}), Error);
}

TEST_F(FlatStudioTest, ADraggedPointIsWhereItWasPutAndPerformed) {
  Studio studio(services());
  open_flat(studio);
  const Vec2 untouched = result(studio).poses[6].at(body25::LeftWrist);
  const Vec2 performed = result(studio).poses[3].at(body25::LeftWrist);
  studio.run("flat.drag", {"3", "left_wrist", "260", "90", "1"});
  studio.wait_idle();
  const FlatPose& pose = studio.session().flat.poses->clean[3].pose;
  EXPECT_EQ(pose.at(body25::LeftWrist), Vec2(260, 90));
  EXPECT_GT((result(studio).poses[3].at(body25::LeftWrist) - performed).norm(), 50);
  EXPECT_LT((result(studio).poses[6].at(body25::LeftWrist) - untouched).norm(), 1);
}

TEST_F(FlatStudioTest, SidesAreExchangedOverARangeAndBackAgain) {
  Studio studio(services());
  open_flat(studio);
  const auto hip = [&](size_t t) { return studio.session().flat.poses->clean[t].pose.at(body25::LeftHip); };
  const Vec2 before = hip(4), outside = hip(6);
  studio.run("edit.swap", {"2", "4", "legs"});
  studio.wait_idle();
  EXPECT_NE(hip(4), before);
  EXPECT_EQ(hip(6), outside);
  studio.run("flat.exchange", {"2", "4", "legs"});
  studio.wait_idle();
  EXPECT_EQ(hip(4), before);
}

TEST_F(FlatStudioTest, AnExchangeOverrulesSidesThatWerePutBack) {
  KeypointReading track = walking_track(24);
  for (TrackedPose& pose : track.tracks[0].poses)
    if (pose.frame >= 10 && pose.frame < 14) pose.pose = sides_exchanged(pose.pose);
  write_openpose_folder(path("swapped"), track);
  Studio studio(services());
  studio.run("open", {path("swapped")});
  studio.wait_idle();
  const auto clean = [&](size_t t) { return studio.session().flat.poses->clean[t]; };
  const CleanPose mended = clean(11), outside = clean(16);
  ASSERT_TRUE(mended.sides_mended);
  studio.run("flat.exchange", {"10", "13"});
  studio.wait_idle();
  EXPECT_EQ(clean(11).pose, sides_exchanged(mended.pose)) << "as the file has it";
  EXPECT_TRUE(clean(11).problem.empty()) << clean(11).problem;
  EXPECT_EQ(clean(16).pose, outside.pose);
}

TEST_F(FlatStudioTest, AnotherPersonPerforms) {
  Studio studio(services());
  open_flat(studio);
  const int64_t now = studio.session().flat.poses->reading.performing().person;
  studio.run("source.person", {now == 1 ? "2" : "1"});
  studio.wait_idle();
  EXPECT_NE(studio.session().flat.poses->reading.performing().person, now);
  EXPECT_THROW(studio.run("source.person", {"9"}), Error);
}

TEST_F(FlatStudioTest, ADocumentKeepsAllOfIt) {
  {
    Studio studio(services());
    open_flat(studio);
    studio.run("flat.length", {"0", "trunk", "150"});
    studio.run("flat.place", {"0", "source"});
    studio.run("flat.drag", {"1", "nose", "160", "80"});
    studio.run("flat.exchange", {"0", "2", "arms"});
    studio.wait_idle();
    studio.run("document.save_as", {path("flat.understudy")});
  }
  Studio studio(services());
  studio.run("open", {path("flat.understudy")});
  studio.wait_idle();
  const Document& document = studio.session().document;
  ASSERT_TRUE(document.flat && document.takes.at(0).flat);
  EXPECT_EQ(document.source.point_edits.size(), 2u);
  EXPECT_EQ(document.takes[0].flat->place, FlatPlace::Source);
  EXPECT_EQ(result(studio).lengths.length[flat_bone::Trunk], 150);
  EXPECT_EQ(frame_count(studio.session()), kCount);
}

TEST_F(FlatStudioTest, ProportionsAreSavedAndAreAPersonOfTheirOwn) {
  Studio studio(services());
  open_flat(studio);
  studio.run("flat.save_proportions", {"0", path("lengths")});
  studio.run("open", {path("lengths.json")});
  studio.wait_idle();
  ASSERT_EQ(studio.session().takes.size(), 2u);
  EXPECT_FALSE(result(studio, 1).reference->target.standing);
  EXPECT_FLOAT_EQ(result(studio, 1).lengths.length[flat_bone::Trunk],
                  result(studio, 0).lengths.length[flat_bone::Trunk]);
}

TEST_F(FlatStudioTest, WhatDoesNotFitIsSaidInASentence) {
  Studio studio(services());
  open_both(studio);
  EXPECT_THROW(studio.run("target.add", {path("tall.json")}), Error);
  std::ofstream(path("broken.json")) << R"({"people": [{"pose_keypoints_2d": [1, 2, 0.5]}]})";
  studio.run("document.new");
  studio.run("question.answer", {"discard"});
  studio.try_run("open", {path("broken.json")});
  studio.wait_idle();
  ASSERT_FALSE(studio.session().errors.empty());
  EXPECT_NE(studio.session().errors.back().text.find("broken.json"), std::string::npos);
  EXPECT_TRUE(studio.session().document.source.path.empty());
}

TEST_F(FlatStudioTest, ACharacterPerformsALiftedTrackBesideAPersonInAPicture) {
  Studio studio(services());
  open_flat(studio);
  studio.run("open", {path("target.obj")});
  studio.wait_idle();
  const Session& session = studio.session();
  ASSERT_TRUE(session.errors.empty()) << session.errors.front().text;
  ASSERT_EQ(session.takes.size(), 2u);
  EXPECT_FALSE(is_canvas(session, 2));
  ASSERT_EQ(session.takes[1].shown.poses.size(), size_t{kCount});
  const Vec3 way = session.takes[1].shown.poses[kCount - 1].root - session.takes[1].shown.poses[0].root;
  EXPECT_GT(way.x(), 0.05f) << "it goes where the track goes";
  EXPECT_EQ(result(studio).poses.size(), size_t{kCount});
  EXPECT_FALSE(session.takes[0].series.empty());
  studio.run("export.run", {"1", path("lifted.glb")});
  studio.wait_idle();
  EXPECT_TRUE(fs::exists(path("lifted.glb")));

  studio.run("flat.drag", {"7", "mid_hip", "400", "230", "0"});
  studio.wait_idle();
  EXPECT_GT(session.takes[1].shown.poses[kCount - 1].root.x() - session.takes[1].shown.poses[0].root.x(),
            way.x() + 0.1f)
      << "what is put right by hand is lifted, too";
  studio.run("target.remove", {"1"});
  studio.run("flat.place", {"0", "source"});
  studio.wait_idle();
  EXPECT_TRUE(session.errors.empty());
  EXPECT_EQ(frame_count(session), kCount);
}

TEST_F(FlatStudioTest, WithoutALifterACharacterIsRefusedAndThePicturesGoOn) {
  StudioServices without = services();
  without.lifter = []() -> std::unique_ptr<Lifter> { throw Error("lifter.weights: there is no such file"); };
  Studio studio(without);
  open_flat(studio);
  studio.run("open", {path("target.obj")});
  studio.wait_idle();
  ASSERT_FALSE(studio.session().errors.empty());
  EXPECT_NE(studio.session().errors.front().text.find("lifter.weights"), std::string::npos);
  studio.run("target.remove", {"1"});
  studio.wait_idle();
  EXPECT_EQ(studio.session().source.frames.size(), size_t{kCount});
  EXPECT_TRUE(studio.session().source.problem.empty());
  EXPECT_EQ(result(studio).poses.size(), size_t{kCount});
}

TEST_F(FlatStudioTest, FiguresSayHowTheOrderOfPointsIsKept) {
  Studio studio(services());
  open_flat(studio);
  const TakeState& take = studio.session().takes[0];
  ASSERT_EQ(take.series.size(), 1u);
  EXPECT_EQ(take.series[0].values.size(), size_t{kCount});
  ASSERT_FALSE(take.metrics.empty());
  for (const auto& [key, value] : take.metrics) {
    EXPECT_GE(value, 0) << key;
    EXPECT_NE(find_flat_figure(key), nullptr) << "the panel has no name for " << key;
  }
}

}  // namespace
}  // namespace understudy::app
