// Further motions of what was found in the source's scans: made, kept as clips, exported, made again.
#include "app/run/rig_performance.hpp"
#include "app/session/made_motions.hpp"
#include "retarget/character/read_character.hpp"
#include "tests/session/arm_studio.hpp"

namespace understudy::app {
namespace {

class MadeMotionsTest : public ArmStudioTest {
 protected:
  static const MadeMotionsState& made(const Studio& studio) { return studio.session().made_motions; }
  static const std::vector<MadeClip>& clips(const Studio& studio) {
    return studio.session().document.bones.clips;
  }
  void make(Studio& studio, const Arguments& words) {
    studio.run("generate.make", words);
    studio.wait_idle();
  }
  std::string refused(Studio& studio, const std::string& command, const Arguments& words) {
    std::string sentence = refusal([&] { studio.run(command, words); });
    EXPECT_NE(sentence, "") << join_line(command, words);
    EXPECT_EQ(sentence.find('\n'), std::string::npos);
    return sentence;
  }
  static bool same_poses(const RigMotion& a, const RigMotion& b) {
    return std::equal(a.poses.begin(), a.poses.end(), b.poses.begin(), b.poses.end(),
                      [](const RigPose& x, const RigPose& y) {
                        return x.root == y.root && x.turns == y.turns && x.slides == y.slides;
                      });
  }
};

TEST_F(MadeMotionsTest, SeedsAreOfferedAndOneIsKeptUndoneAndRedone) {
  Studio studio(services());
  find(studio);
  make(studio, {"20", "count", "3", "seed", "5"});
  ASSERT_EQ(made(studio).offered.size(), 3u);
  for (uint64_t i = 0; i < 3; ++i) {
    EXPECT_EQ(made(studio).offered[i].made->seed, 5 + i);
    EXPECT_EQ(made(studio).offered[i].made->motion.poses.size(), 20u);
  }
  EXPECT_EQ(undo_label(studio.session()), "Find its own skeleton") << "what is offered is no edit";
  studio.run("generate.keep", {"6"});
  studio.tick(0);
  ASSERT_EQ(clips(studio).size(), 1u);
  EXPECT_EQ(clips(studio)[0].name, "motion 6");
  EXPECT_EQ(made(studio).clips.at(0), made(studio).offered[1].made) << "it is not made once more";
  EXPECT_EQ(undo_label(studio.session()), "Keep motion 6");
  EXPECT_NE(refused(studio, "generate.keep", {"6"}).find("motion 6"), std::string::npos);
  EXPECT_EQ(shown_motions(studio.session(), 3).size(), 3u) << "each once";
  studio.run("edit.undo");
  studio.tick(0);
  EXPECT_TRUE(clips(studio).empty() && made(studio).clips.empty());
  EXPECT_EQ(made(studio).offered.size(), 3u);
  studio.run("edit.redo");
  studio.tick(0);
  EXPECT_EQ(made(studio).clips.at(0), made(studio).offered[1].made);
  EXPECT_EQ(made(studio).clips_job, 0);
}

TEST_F(MadeMotionsTest, BetweenTwoFramesBeginsAndEndsInTheirPoses) {
  Studio studio(services());
  find(studio);
  studio.run("bones.trim", {"2", "9"});
  studio.wait_idle();
  make(studio, {"12", "between", "3", "8"});
  ASSERT_EQ(made(studio).offered.size(), 1u);
  const auto& poses = made(studio).offered[0].made->motion.poses;
  const auto& clip = studio.session().bones.rig->found.motion.poses;
  for (size_t j = 0; j < 2; ++j) {
    EXPECT_TRUE(poses.front().turns[j].isApprox(clip[1].turns[j], 1e-3f)) << "frame 3 of the source";
    EXPECT_TRUE(poses.back().turns[j].isApprox(clip[6].turns[j], 1e-3f)) << "frame 8 of the source";
  }
  EXPECT_NE(refused(studio, "generate.make", {"12", "between", "1", "8"}).find("no frame 1"),
            std::string::npos);
}

TEST_F(MadeMotionsTest, AllClipsAreInTheFileUnderTheirNames) {
  Studio studio(services());
  find(studio);
  make(studio, {"15", "count", "2"});
  studio.run("generate.keep", {"1"});
  studio.run("generate.keep", {"2", "wave"});
  studio.run("generate.rename", {"motion 1", "nod"});
  studio.wait_idle();
  studio.run("bones.export", {path("rig.glb")});
  studio.wait_idle();
  const Character written = read_character(path("rig.glb"));
  ASSERT_EQ(written.animations.size(), 3u);
  EXPECT_EQ(written.animations[0].name, kFoundClip);
  EXPECT_EQ(written.animations[1].name, "nod");
  EXPECT_EQ(written.animations[2].name, "wave");
  const double fps = studio.session().bones.rig->found.motion.fps;
  EXPECT_EQ(from_character(written, 1, fps).motion.poses.size(), 15u);
  studio.run("bones.export", {path("rig.bvh")});
  studio.wait_idle();
  EXPECT_TRUE(fs::exists(path("rig.bvh"))) << "the found motion alone";
  studio.run("generate.remove", {"nod"});
  studio.tick(0);
  ASSERT_EQ(clips(studio).size(), 1u);
  EXPECT_EQ(clips(studio)[0].name, "wave");
  EXPECT_EQ(undo_label(studio.session()), "Remove nod");
}

TEST_F(MadeMotionsTest, TheDocumentsRecipesAreMadeAgainAlike) {
  RigMotion before;
  {
    Studio studio(services());
    find(studio);
    make(studio, {"18", "loop", "seed", "9"});
    studio.run("generate.keep", {"9", "round"});
    studio.tick(0);
    before = made(studio).clips.at(0)->motion;
    studio.run("document.save_as", {path("arm.understudy")});
  }
  Studio studio(services());
  studio.run("document.open", {path("arm.understudy")});
  studio.wait_idle();
  ASSERT_EQ(made(studio).clips.size(), 1u);
  ASSERT_TRUE(made(studio).clips[0]) << made(studio).problem;
  EXPECT_TRUE(same_poses(made(studio).clips[0]->motion, before));
  EXPECT_EQ(clips(studio)[0].name, "round");
  EXPECT_TRUE(made(studio).offered.empty());
}

TEST_F(MadeMotionsTest, ClipsFollowTheBonesAndTellWhereTheyCannot) {
  Studio studio(services());
  find(studio);
  make(studio, {"12", "between", "1", "8"});
  studio.run("generate.keep", {"1"});
  studio.run("bones.trim", {"3", "9"});
  studio.wait_idle();
  EXPECT_FALSE(made(studio).clips.at(0));
  EXPECT_TRUE(made(studio).offered.empty()) << "they were of another motion";
  EXPECT_NE(made(studio).problem.find("no frame 1"), std::string::npos) << made(studio).problem;
  EXPECT_EQ(studio.session().errors.size(), 1u) << "it is told once";
  EXPECT_NE(refused(studio, "bones.export", {path("rig.glb")}).find("motion 1"), std::string::npos);
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_TRUE(made(studio).clips.at(0));
  EXPECT_EQ(made(studio).problem, "");
}

TEST_F(MadeMotionsTest, ARenamedBoneLeavesWhatWasOffered) {
  Studio studio(services());
  find(studio);
  make(studio, {"12", "count", "2"});
  studio.run("generate.keep", {"1"});
  studio.tick(0);
  const auto kept = made(studio).clips.at(0);
  for (const auto& [command, words] : std::vector<std::pair<std::string, Arguments>>{
           {"bones.rename", {"1", "forearm"}}, {"edit.undo", {}}, {"edit.redo", {}}}) {
    studio.run(command, words);
    studio.tick(0);
    EXPECT_EQ(made(studio).offered.size(), 2u) << command;
    EXPECT_EQ(made(studio).clips.at(0), kept) << command << ": it is not made once more";
  }
  studio.run("generate.make", {"500", "count", "4"});
  studio.run("bones.rename", {"1", "wing"});
  studio.wait_idle();
  EXPECT_EQ(made(studio).offered.size(), 4u) << "renamed while they were made";
  studio.run("generate.keep", {"3"});
  studio.tick(0);
  EXPECT_EQ(made(studio).clips.at(1), made(studio).offered[2].made);
  studio.run("bones.kind", {"wing", "fixed"});
  studio.wait_idle();
  EXPECT_TRUE(made(studio).offered.empty()) << "they are of other joints";
}

TEST_F(MadeMotionsTest, AHurryNamesTheFramesOfTheTimeline) {
  write_arm("arm.npz", understudy::kFrames, 1, 1000, Vec3(0, 0, 0.05f));
  Studio studio(services());
  find(studio);
  studio.run("bones.trim", {"2", "9"});
  studio.wait_idle();
  make(studio, {"3", "between", "3", "8", "engine", "slerp"});
  EXPECT_EQ(made(studio).remark.find("frames 3 and 8 are 0.2"), 0u) << made(studio).remark;
}

TEST_F(MadeMotionsTest, CancelledLeavesWhatWasOffered) {
  Studio studio(services());
  find(studio);
  make(studio, {"20"});
  const auto before = made(studio).offered.at(0).made;
  studio.run("generate.make", {"3000", "count", "100"});
  studio.run("job.cancel", {std::to_string(made(studio).job)});
  studio.wait_idle();
  EXPECT_EQ(made(studio).job, 0);
  ASSERT_FALSE(made(studio).offered.empty());
  EXPECT_LT(made(studio).offered.size(), 100u);
  const auto first = made(studio).offered[0].made;  // a long one, where one was ready before the cancel
  EXPECT_TRUE(first == before || first->motion.poses.size() == 3000u);
  EXPECT_TRUE(studio.session().errors.empty());
}

TEST_F(MadeMotionsTest, RefusesWhatCannotBeMade) {
  Studio studio(services());
  EXPECT_EQ(refused(studio, "generate.make", {"20"}), "no bones have been found yet");
  find(studio);
  for (const Arguments& words : std::vector<Arguments>{{},
                                                       {"1"},
                                                       {"20", "count", "0"},
                                                       {"20", "seed", "-1"},
                                                       {"20", "backwards"},
                                                       {"20", "between", "1"},
                                                       {"20", "between", "1", "99"},
                                                       {"20", "between", "1", "8", "loop"},
                                                       {"20", "engine", "magic"},
                                                       {"20", "engine", "slerp"}})
    refused(studio, "generate.make", words);
  EXPECT_EQ(made(studio).job, 0);
  refused(studio, "generate.keep", {"1"});
  make(studio, {"20", "count", "2"});
  studio.run("generate.keep", {"1"});
  for (const char* name : {"", " ", "motion", "motion 1"}) refused(studio, "generate.keep", {"2", name});
  refused(studio, "generate.rename", {"nobody", "x"});
  refused(studio, "generate.rename", {"0", "motion"});
  refused(studio, "generate.remove", {"7"});
  EXPECT_EQ(clips(studio).size(), 1u);
}

TEST_F(MadeMotionsTest, ANetworkWithoutWeightsTellsSo) {
  Studio studio(services());
  find(studio);
  make(studio, {"20", "engine", "vrnn"});
  EXPECT_TRUE(made(studio).offered.empty());
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_NE(studio.session().errors[0].text.find("weights"), std::string::npos);
}

TEST_F(MadeMotionsTest, GhostsStandBesideEachOtherAndGoOnWithThePlayhead) {
  Studio studio(services());
  find(studio);
  make(studio, {"50", "count", "2"});
  Session& session = studio.session();
  const auto first = shown_motions(session, 0);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_LT(first[1].place.x(), first[0].place.x() - 0.3f);
  EXPECT_LT(first[0].place.x(), -0.3f);
  EXPECT_EQ(first[0].pose, &first[0].made->motion.poses[0]);
  session.made_motions.laps = 1;
  EXPECT_EQ(shown_motions(session, 2)[0].pose, &first[0].made->motion.poses[understudy::kFrames + 2]);
  studio.run("view.fit");
  const float beside = camera_of(session.view, 0).distance;
  studio.run("view.made_motions", {"over"});
  EXPECT_EQ(shown_motions(session, 0)[1].place, Vec3::Zero());
  studio.run("view.fit");
  EXPECT_LT(camera_of(session.view, 0).distance, beside);
  studio.run("view.made_motions", {"off"});
  EXPECT_TRUE(shown_motions(session, 0).empty());
}

TEST_F(MadeMotionsTest, ThePlayheadsRoundsAreCounted) {
  Studio studio(services());
  find(studio);
  make(studio, {"50"});
  studio.run("playback.play");
  for (int i = 0; i < 4; ++i) studio.tick(0.4 * understudy::kFrames / studio.session().source.fps);
  EXPECT_EQ(made(studio).laps, 1);
}

}  // namespace
}  // namespace understudy::app
