// What cannot be opened is taken back, and what is no person is asked about.
#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

/// Lies on four feet: a slab on legs, one metre high and two long.
void write_table(const std::string& path) {
  std::ofstream file(path);
  auto box = [&file, at = 0](const Vec3& low, const Vec3& high) mutable {
    for (int i = 0; i < 8; ++i)
      file << "v " << ((i & 1) ? high.x() : low.x()) << ' ' << ((i & 2) ? high.y() : low.y()) << ' '
           << ((i & 4) ? high.z() : low.z()) << '\n';
    for (const auto& f :
         {std::array{1, 2, 4, 3}, {5, 7, 8, 6}, {1, 5, 6, 2}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}})
      file << "f " << at + f[0] << ' ' << at + f[1] << ' ' << at + f[2] << ' ' << at + f[3] << '\n';
    at += 8;
  };
  box({-1, 0.9f, -0.5f}, {1, 1, 0.5f});
  for (const float x : {-1.f, 0.9f})
    for (const float z : {-0.5f, 0.4f}) box({x, 0, z}, {x + 0.1f, 0.9f, z + 0.1f});
}

TEST_F(StudioTest, ATargetThatCannotBeOpenedIsTakenBackAndTheRestStays) {
  std::ofstream(path("broken.obj")) << "v 1 2\n";
  Studio studio(services());
  Session& session = studio.session();
  studio.run("open", {path("scan.npz")});
  studio.run("target.add", {path("target.obj")});
  studio.run("target.add", {path("broken.obj")});
  studio.run("take.rename", {"0", "adult"});  // meanwhile
  studio.wait_idle();
  ASSERT_EQ(session.errors.size(), 1u);
  EXPECT_NE(session.errors.front().text.find("broken.obj"), std::string::npos);
  ASSERT_EQ(session.document.takes.size(), 1u);
  EXPECT_EQ(session.document.takes[0].name, "adult");
  EXPECT_EQ(session.selected_take, 0);
  EXPECT_EQ(session.view.active_pane, 1);
  EXPECT_EQ(frame_count(session), kFrames);
  studio.run("edit.undo");  // no step leads back to what could not be opened
  EXPECT_EQ(session.document.takes[0].name, "target");
  studio.run("edit.undo");
  EXPECT_TRUE(session.document.takes.empty());
}

TEST_F(StudioTest, ATargetThatCannotTakeAnothersPlaceLeavesItThere) {
  std::ofstream(path("broken.obj")) << "v 1 2\n";
  Studio studio(services());
  open_both(studio);
  studio.run("edit.turn", {"0", "20"});
  studio.run("target.replace", {"0", path("broken.obj")});
  studio.wait_idle();
  const Session& session = studio.session();
  ASSERT_EQ(session.errors.size(), 1u);
  ASSERT_EQ(session.document.takes.size(), 1u);
  EXPECT_EQ(session.document.takes[0].target.path, path("target.obj"));
  EXPECT_TRUE(session.takes[0].ready);
  EXPECT_TRUE(session.document.takes[0].pose_edits.turn);
  EXPECT_EQ(session.history.undo_label(), studio.commands().find("edit.turn")->label);
}

TEST_F(StudioTest, ASourceThatCannotBeReadLeavesTheOneBefore) {
  fs::create_directory(path("empty_frames"));
  for (int t = 0; t < 3; ++t) std::ofstream(path("empty_frames/" + std::to_string(t) + ".xyz"));
  std::ofstream(path("broken.bvh")) << "HIERARCHY\nnothing\n";
  for (const char* bad : {"broken.bvh", "empty_frames"}) {
    Studio studio(services());
    Session& session = studio.session();
    open_both(studio);
    studio.run("edit.crop", {"-9", "-9", "-9", "9", "9", "9"});
    studio.try_run("source.open", {path(bad)});
    studio.wait_idle();
    ASSERT_EQ(session.errors.size(), 1u) << bad;
    EXPECT_EQ(session.document.source.path, path("scan.npz")) << bad;
    EXPECT_TRUE(session.document.scan_edits.crop) << bad;
    EXPECT_EQ(session.source.problem, "") << bad;
    EXPECT_EQ(frame_count(session), kFrames) << bad;
    EXPECT_EQ(session.history.undo_label(), studio.commands().find("edit.crop")->label) << bad;
  }
}

TEST_F(StudioTest, AFirstSourceThatCannotBeReadLeavesNone) {
  std::ofstream(path("broken.bvh")) << "HIERARCHY\nnothing\n";
  Studio studio(services());
  studio.run("source.open", {path("broken.bvh")});
  studio.wait_idle();
  EXPECT_EQ(studio.session().errors.size(), 1u);
  EXPECT_TRUE(studio.session().document.source.path.empty());
  EXPECT_FALSE(studio.session().changed);
  EXPECT_FALSE(studio.session().history.can_undo());
}

TEST_F(StudioTest, ADocumentsSourceThatCannotBeReadIsKeptAndSaysWhy) {
  {
    Studio studio(services());
    open_both(studio);
    studio.run("document.save_as", {path("dance.understudy")});
  }
  std::ofstream(path("scan.npz")) << "no array";
  Studio studio(services());
  studio.run("document.open", {path("dance.understudy")});
  studio.wait_idle();
  EXPECT_EQ(studio.session().document.source.path, path("scan.npz"));
  EXPECT_NE(studio.session().source.problem, "");
}

TEST_F(StudioTest, WhatIsNoPersonIsUsedOnlyWhereTheUserSaysSo) {
  write_table(path("table.obj"));
  Studio studio(services());
  Session& session = studio.session();
  open_both(studio);
  for (const bool use : {false, true}) {
    studio.run("target.add", {path("table.obj")});
    studio.wait_idle();
    ASSERT_TRUE(session.question);
    EXPECT_EQ(session.question->kind, Question::Kind::NotAPerson);
    EXPECT_NE(session.question->text.find("does not look like a person"), std::string::npos);
    EXPECT_NE(session.question->text.find("Use it anyway?"), std::string::npos);
    EXPECT_TRUE(session.errors.empty());
    EXPECT_FALSE(session.takes[1].ready);
    if (use)
      studio.run("target.use_anyway", {std::to_string(session.question->take)});
    else
      studio.run("question.answer", {"cancel"});
    EXPECT_FALSE(session.question);
    studio.wait_idle();
    ASSERT_EQ(session.takes.size(), use ? 2u : 1u);
    EXPECT_TRUE(session.takes.back().ready);
  }
  EXPECT_EQ(frame_count(session), kFrames);
}

TEST_F(StudioTest, TheFolderUsedLastIsRememberedButNotThatOfTheSamples) {
  fs::create_directories(path("targets")), fs::create_directories(path("samples"));
  fs::copy_file(path("target.obj"), path("targets/a.obj"));
  fs::copy_file(path("target.obj"), path("samples/b.obj"));
  StudioServices own = services();
  own.samples = path("samples");
  own.settings_file = path("settings.json");
  {
    Studio studio(own);
    const std::string& last = studio.session().settings.last_folder;
    EXPECT_EQ(last, "");
    studio.run("open", {path("scan.npz")});
    EXPECT_EQ(last, fs::path(path("scan.npz")).parent_path());
    studio.run("target.add", {path("targets/a.obj")});
    EXPECT_EQ(last, path("targets"));
    studio.run("target.add", {path("samples/b.obj")});
    EXPECT_EQ(last, path("targets"));
    fs::create_directories(path("work"));
    studio.run("document.save_as", {path("work/dance")});
    EXPECT_EQ(last, path("work"));
    studio.wait_idle();
    studio.run("export.run", {"0", path("out.bvh")});
    studio.wait_idle();
    EXPECT_EQ(last, fs::path(path("out.bvh")).parent_path());
  }
  EXPECT_EQ(Studio(own).session().settings.last_folder, fs::path(path("out.bvh")).parent_path());
}

TEST(RecentSource, IsAPathOrABodyAndItsMotion) {
  EXPECT_EQ(paths_of_recent(recent_source("/body.npz", "/a walk.npz")),
            (std::vector<std::string>{"/body.npz", "/a walk.npz"}));
  EXPECT_EQ(paths_of_recent(recent_source("/a b", "")), std::vector<std::string>{"/a b"});
}

TEST_F(StudioTest, WhatWasReadIsRecentAndWhatCannotBeReadAnyMoreIsTakenOffWithTheReason) {
  Studio studio(services());
  Session& session = studio.session();
  Settings& settings = session.settings;
  open_both(studio);
  EXPECT_EQ(settings.recent_sources, std::vector<std::string>{path("scan.npz")});
  EXPECT_EQ(settings.recent_targets, std::vector<std::string>{path("target.obj")});
  const std::string body = path("body.npz"), walk = path("walk.npz"), gone = path("gone.npz");
  std::ofstream(body) << "no array", std::ofstream(walk) << "no array";
  std::ofstream(path("broken.obj")) << "v 1 2\n";
  settings.recent = {path("gone.understudy")};
  settings.recent_sources = {recent_source(body, gone), recent_source(body, walk), path("scan.npz"), gone};
  settings.recent_targets = {path("broken.obj"), path("target.obj")};
  const auto fails = [&](const std::string& command, const Arguments& arguments) {
    session.errors.clear();
    studio.try_run(command, arguments);
    studio.wait_idle();
    ASSERT_EQ(session.errors.size(), 1u) << join_line(command, arguments);
    const std::string sentence = session.errors.front().text;
    EXPECT_NE(sentence.find(fs::path(arguments.back()).filename().string()), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("; it was taken off the recent list"), std::string::npos) << sentence;
  };
  fails("source.motion", {body, gone});
  EXPECT_EQ(settings.recent_sources.size(), 3u);
  fails("open", {gone});
  EXPECT_EQ(settings.recent_sources.size(), 2u);
  fails("target.add", {path("broken.obj")});
  EXPECT_EQ(settings.recent_targets, std::vector<std::string>{path("target.obj")});
  session.changed = false;  // nothing to ask about first
  fails("document.open", {path("gone.understudy")});
  EXPECT_TRUE(settings.recent.empty());
  session.errors.clear();
  studio.try_run("source.motion", {body, walk});  // both are there, and no body
  studio.wait_idle();
  ASSERT_EQ(session.errors.size(), 1u);
  EXPECT_NE(session.errors.front().text.find("; it was taken off the recent list"), std::string::npos);
  EXPECT_EQ(settings.recent_sources, std::vector<std::string>{path("scan.npz")}) << "the rest stays";
  EXPECT_EQ(session.document.source.path, path("scan.npz"));
}

TEST_F(StudioTest, WhatWasNeverReadIsNotRecent) {
  std::ofstream(path("broken.bvh")) << "HIERARCHY\nnothing\n";
  Studio studio(services());
  studio.try_run("source.open", {path("broken.bvh")});
  studio.wait_idle();
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_EQ(studio.session().errors.front().text.find("recent"), std::string::npos);
  EXPECT_TRUE(studio.session().settings.recent_sources.empty());
}

TEST_F(StudioTest, ATargetsHeightIsSetAndReset) {
  Studio studio(services());
  open_both(studio);
  const auto height = [&] {
    const auto y = studio.session().takes[0].target->mesh.vertices.col(1);
    return y.maxCoeff() - y.minCoeff();
  };
  const float own = height();
  studio.run("target.height", {"0", "1.2"});
  studio.wait_idle();
  EXPECT_NEAR(height(), 1.2f, 0.1f);
  studio.run("document.save_as", {path("small.understudy")});
  studio.run("target.height", {"0", "auto"});
  studio.wait_idle();
  EXPECT_EQ(height(), own);
  EXPECT_THROW(studio.run("target.height", {"0", "900"}), Error);
  studio.session().changed = false;
  studio.run("document.open", {path("small.understudy")});
  studio.wait_idle();
  EXPECT_NEAR(height(), 1.2f, 0.1f);
}

TEST_F(StudioTest, FitShowsAllOfTheSurface) {
  std::ofstream(path("target.obj"), std::ios::app)
      << "v 0 2.3 0\nv 0.05 2.3 0\nv 0 2.3 0.05\nf -3 -2 -1\n";  // a hat
  Studio studio(services());
  open_both(studio);
  studio.run("view.fit");
  const Session& session = studio.session();
  const CameraState& camera = session.view.cameras[0];
  const Points surface = session.takes[0].deformer->deform(
      session.takes[0].shown.poses[static_cast<size_t>(shown_frame(session))]);
  EXPECT_GT(camera.target.y() + camera.distance * std::tan(0.5f * camera.fov), surface.col(1).maxCoeff());
}

/// Is sure of nobody.
class LostExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh&) override {
    Extraction nobody;
    nobody.joints = human_rest();
    nobody.confidence.setZero();
    return nobody;
  }
  std::string name() const override { return "lost"; }
};

TEST_F(StudioTest, AScanInWhichNobodyIsRecognisedIsCleanedUpFromTheNotice) {
  StudioServices own = services();
  own.networks = [usual = own.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = usual(method, parts);
    if (parts.extractor) networks.extractor = std::make_shared<LostExtractor>();
    return networks;
  };
  Studio studio(own);
  Session& session = studio.session();
  studio.run("open", {path("scan.npz")});
  studio.wait_idle();
  ASSERT_EQ(session.notices.size(), 1u);
  EXPECT_EQ(session.notices[0].text, "No person recognised: a floor or things may hide them");
  EXPECT_EQ(session.notices[0].offer.label, "Clean up");
  studio.tick(600);
  ASSERT_EQ(session.notices.size(), 1u) << "it waits for an answer";
  studio.run(session.notices[0].offer.command);
  EXPECT_TRUE(session.document.scan_edits.floor);
  EXPECT_TRUE(session.document.scan_edits.largest_cluster);
  EXPECT_EQ(session.history.undo_label(), "Clean up the scan");
  studio.wait_idle();
  ASSERT_EQ(session.notices.size(), 1u) << "the offer went with the scan that it was about";
  EXPECT_EQ(session.notices[0].offer.label, "Find its own skeleton") << "it is cleaned up already";
  studio.tick(600);
  ASSERT_EQ(session.notices.size(), 1u) << "it waits for an answer";
  studio.run("edit.undo");
  studio.wait_idle();
  const auto offer = std::find_if(session.notices.begin(), session.notices.end(),
                                  [](const Notice& notice) { return notice.offer.label == "Clean up"; });
  ASSERT_NE(offer, session.notices.end());
  const std::string id = std::to_string(offer->id);
  const size_t before = session.notices.size();
  studio.run("notice", {"Another"});
  studio.run("notice.dismiss", {id});
  EXPECT_EQ(session.notices.size(), before);
  for (const Notice& notice : session.notices) EXPECT_EQ(notice.offer.label, "") << notice.text;
  studio.run("notice.dismiss");
  EXPECT_TRUE(session.notices.empty());
}

TEST_F(StudioTest, AScanWithAPersonIsNotOfferedACleanUp) {
  Studio studio(services());
  open_both(studio);
  for (const Notice& notice : studio.session().notices) EXPECT_EQ(notice.offer.label, "") << notice.text;
}

}  // namespace
}  // namespace understudy::app
