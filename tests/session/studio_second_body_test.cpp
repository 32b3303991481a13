// A second body that performs what was found in the source's scans: from the file to the exported rig.
#include <algorithm>

#include "app/run/rig_performance.hpp"
#include "app/session/follow.hpp"
#include "app/session/made_motions.hpp"
#include "retarget/base/index.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "tests/retarget/discovery/arm_finder.hpp"
#include "tests/session/arm_studio.hpp"

namespace understudy::app {
namespace {

/// Mean distance of two surfaces of the same vertices, metres.
float apart(const RiggedMotion& a, int frame_a, const RiggedMotion& b, int frame_b) {
  const auto surface = [](const RiggedMotion& of, int frame) {
    const RigPose& pose = of.motion.poses[static_cast<size_t>(frame)];
    return skinned(of.rig.surface.vertices, of.rig.skin, bone_motions(of.rig, pose));
  };
  return (surface(a, frame_a) - surface(b, frame_b)).rowwise().norm().mean();
}

class SecondBodyTest : public ArmStudioTest {
 protected:
  static const SecondBodyState& second(const Studio& studio) { return studio.session().second; }
  void perform(Studio& studio, const std::string& file) {
    studio.run("bones.perform", {path(file)});
    studio.wait_idle();
  }
  /// The arm's rig as a file, and with it as the second body.
  void perform_itself(Studio& studio) {
    find(studio);
    studio.run("bones.export", {path("second.glb")});
    studio.wait_idle();
    perform(studio, "second.glb");
    ASSERT_TRUE(second(studio).performed) << second(studio).problem;
  }
  /// A rig of the arm's surface, cut across into `count` bones that never move.
  void write_sliced(const Studio& studio, const std::string& file, int count) {
    RiggedMotion sliced;
    sliced.rig.name = "sliced";
    sliced.rig.surface = rig(studio).surface;
    std::vector<int> bones;
    for (Eigen::Index v = 0; v < sliced.rig.surface.vertices.rows(); ++v) {
      const float along = (0.06f + sliced.rig.surface.vertices(v, 0)) / 1.12f;  // its ends are round
      bones.push_back(std::clamp(static_cast<int>(along * static_cast<float>(count)), 0, count - 1));
    }
    sliced.rig.skin = SkinWeights::rigid(bones);
    for (int j = 0; j < count; ++j)
      sliced.rig.joints.push_back({"slice " + std::to_string(j), j - 1,
                                   j == 0 ? JointKind::Free : JointKind::Ball,
                                   Vec3(static_cast<float>(j) / static_cast<float>(count), 0, 0)});
    sliced.motion.poses.push_back(rest_pose(sliced.rig));
    write_gltf_character(path(file), to_character(sliced));
  }
  std::string refused(Studio& studio, const std::string& command, const Arguments& words) {
    std::string sentence = refusal([&] { studio.run(command, words); });
    EXPECT_NE(sentence, "") << join_line(command, words);
    EXPECT_EQ(sentence.find('\n'), std::string::npos);
    return sentence;
  }
};

TEST_F(SecondBodyTest, ARigPerformsWithTheBonesThatAreItsOwn) {
  Studio studio(services());
  perform_itself(studio);
  const RiggedMotion& performed = *second(studio).performed;
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{0, 1}));
  EXPECT_LT(second(studio).matches.cost[1], 0.2f);
  ASSERT_EQ(performed.motion.poses.size(), static_cast<size_t>(understudy::kFrames));
  const RiggedMotion& first = studio.session().bones.rig->found;
  const float moved = apart(first, understudy::kFrames - 1, first, 0);
  for (const int t : {0, understudy::kFrames - 1})
    EXPECT_LT(apart(performed, t, first, t), 0.4f * moved) << "frame " << t << " of the same body";
  EXPECT_GT(second(studio).place.y() + second(studio).place.x(), 0.5f) << "beside the first";
  EXPECT_EQ(undo_label(studio.session()), "Have a second body perform it");
}

TEST_F(SecondBodyTest, ScansOfItAreSearchedAsTheFirstOnesWere) {
  StudioServices own = services();
  own.keypoints = [](const std::string&, const std::string&) { return std::make_shared<ArmFinder>(true); };
  Studio studio(std::move(own));
  open_arm(studio);
  studio.run("bones.find", {"slots", "arm"});
  studio.wait_idle();
  write_arm("other.npz", understudy::kFrames, 1, 1200);
  perform(studio, "other.npz");
  ASSERT_TRUE(second(studio).performed) << second(studio).problem;
  const understudy::Rig &first = studio.session().bones.rig->found.rig,
                        &other = second(studio).performed->rig;
  const std::vector<int>& partner = second(studio).matches.partner;
  ASSERT_EQ(ssize(partner), other.count());
  EXPECT_GE(bone_named(other, "keypoint 1"), 0) << "found as the first one's were";
  EXPECT_TRUE(
      std::any_of(partner.begin(), partner.end(), [&](int j) { return j >= 0 && j < first.count(); }));
}

TEST_F(SecondBodyTest, OneScanGetsTheFirstOnesBones) {
  Studio studio(services());
  find(studio);
  write_arm("large.npz", 1, 2);
  perform(studio, "large.npz");
  ASSERT_TRUE(second(studio).performed) << second(studio).problem;
  EXPECT_TRUE(second(studio).other->is_scan);
  EXPECT_EQ(second(studio).performed->rig.count(), 2);
  EXPECT_NEAR(second(studio).other->laid.scale, 2, 0.3f);
  EXPECT_NE(refused(studio, "bones.match", {"0", "1"}).find("one scan has no bones of its own"),
            std::string::npos);
}

TEST_F(SecondBodyTest, ASkeletonIsFoundInScansOfIt) {
  Studio studio(services());
  find(studio);
  write_arm("scans.npz", understudy::kFrames, 1.5f, 4000);
  perform(studio, "scans.npz");
  ASSERT_TRUE(second(studio).performed) << second(studio).problem;
  EXPECT_FALSE(second(studio).other->is_scan);
  EXPECT_EQ(second(studio).performed->rig.count(), 2);
}

TEST_F(SecondBodyTest, ChosenMatchesAreKeptAndTheOthersGiveWay) {
  Studio studio(services());
  perform_itself(studio);
  const auto found = second(studio).performed;
  studio.run("bones.match", {"0", "1"});
  studio.wait_idle();
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{-1, 0})) << "the bone of bone 1 was taken";
  EXPECT_NE(second(studio).performed, found);
  studio.run("bones.match", {"bone 1", "bone 0"});
  studio.wait_idle();
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{1, 0}));
  EXPECT_EQ(undo_label(studio.session()), "Match bone 1");
  studio.run("bones.match", {"1", "none"});
  studio.wait_idle();
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{-1, 0}));
  EXPECT_NE(refused(studio, "bones.match", {"0", "none"}).find("no bone has a partner"), std::string::npos);
  studio.run("bones.match", {"1", "auto"});
  studio.run("bones.match", {"0", "auto"});
  studio.wait_idle();
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{0, 1}));
  for (int i = 0; i < 2; ++i) studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{-1, 0}));
}

TEST_F(SecondBodyTest, IsMadeToPerformAgainWhenTheFirstOnesBonesChange) {
  Studio studio(services());
  perform_itself(studio);
  studio.run("bones.match", {"1", "0"});
  studio.run("bones.rename", {"1", "forearm"});
  studio.run("bones.trim", {"2", "8"});
  studio.wait_idle();
  EXPECT_EQ(second(studio).performed->motion.poses.size(), 7u);
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{1, -1})) << "the match has the new name";
  EXPECT_EQ(studio.session().document.bones.second.matches[0].bone, "forearm");
  studio.run("bones.find", {"2"});
  studio.wait_idle();
  EXPECT_TRUE(second(studio).performed) << "the body stays, its matches were of other bones";
  EXPECT_TRUE(studio.session().document.bones.second.matches.empty());
}

TEST_F(SecondBodyTest, GoesAndComesWithUndoWithoutAnotherSearch) {
  Studio studio(services());
  perform_itself(studio);
  const auto performed = second(studio).performed;
  studio.run("bones.perform_drop");
  studio.tick(0);
  EXPECT_FALSE(second(studio).performed);
  EXPECT_NE(refused(studio, "bones.perform_drop", {}), "");
  EXPECT_NE(refused(studio, "bones.perform_export", {path("no.glb")}), "");
  studio.run("edit.undo");
  studio.tick(0);
  EXPECT_EQ(second(studio).performed, performed);
  EXPECT_EQ(second(studio).job, 0);
}

TEST_F(SecondBodyTest, IsExportedAndNeverOverTheFileItCameFrom) {
  Studio studio(services());
  perform_itself(studio);
  for (const char* name : {"performed.glb", "performed.gltf", "performed.bvh"}) {
    studio.run("bones.perform_export", {path(name)});
    studio.wait_idle();
    EXPECT_TRUE(fs::exists(path(name))) << name;
  }
  const RiggedMotion again = read_rig(path("performed.glb"));
  EXPECT_EQ(again.motion.poses.size(), static_cast<size_t>(understudy::kFrames));
  EXPECT_NE(refused(studio, "bones.perform_export", {path("second.glb")}), "");
  EXPECT_NE(refused(studio, "bones.perform_export", {path("performed.obj")}), "");
}

TEST_F(SecondBodyTest, PerformsAClipThatWasKept) {
  Studio studio(services());
  perform_itself(studio);
  const auto found = second(studio).performed;
  EXPECT_NE(refused(studio, "bones.perform_clip", {"0"}), "") << "none was kept";
  studio.run("generate.make", {"20"});
  studio.wait_idle();
  studio.run("generate.keep", {"1", "nod"});
  studio.run("bones.perform_clip", {"nod"});
  studio.wait_idle();
  const RiggedMotion& first = studio.session().bones.rig->found;
  ASSERT_TRUE(second(studio).performed) << second(studio).problem;
  const RiggedMotion performed = *second(studio).performed;
  ASSERT_EQ(performed.motion.poses.size(), 20u);
  const RiggedMotion made{first.rig, studio.session().made_motions.clips.at(0)->motion};
  const float moved = apart(first, understudy::kFrames - 1, first, 0);
  for (const int t : {0, 19}) EXPECT_LT(apart(performed, t, made, t), 0.4f * moved) << "frame " << t;
  EXPECT_EQ(undo_label(studio.session()), "Perform nod");
  studio.session().made_motions.laps = 1;
  EXPECT_EQ(second_pose(studio.session(), 3), (understudy::kFrames + 3) % 20) << "it goes on";
  studio.run("generate.rename", {"nod", "bow"});
  studio.wait_idle();
  EXPECT_EQ(studio.session().document.bones.second.clip, "bow");
  studio.run("bones.perform_export", {path("bow.glb")});
  studio.wait_idle();
  const Character written = read_character(path("bow.glb"));
  ASSERT_EQ(written.animations.size(), 1u);
  EXPECT_EQ(written.animations[0].name, "bow");
  EXPECT_EQ(from_character(written, 0, first.motion.fps).motion.poses.size(), 20u);
  studio.run("bones.perform_clip", {"motion"});
  studio.wait_idle();
  EXPECT_EQ(second(studio).performed->motion.poses.size(), found->motion.poses.size());
  studio.run("edit.undo");
  studio.run("generate.remove", {"bow"});
  studio.wait_idle();
  EXPECT_EQ(studio.session().document.bones.second.clip, "");
  EXPECT_EQ(second(studio).performed->motion.poses.size(), found->motion.poses.size());
}

TEST_F(SecondBodyTest, WaitsForAClipThatCannotBeMade) {
  Studio studio(services());
  perform_itself(studio);
  studio.run("generate.make", {"12", "between", "1", "8"});
  studio.wait_idle();
  studio.run("generate.keep", {"1", "nod"});
  studio.run("bones.perform_clip", {"nod"});
  studio.wait_idle();
  studio.run("bones.trim", {"3", "9"});
  studio.wait_idle();
  EXPECT_FALSE(second(studio).performed);
  EXPECT_NE(second(studio).problem.find("\"nod\" is not made: "), std::string::npos)
      << second(studio).problem;
  EXPECT_EQ(studio.session().errors.size(), 1u) << "it is told once";
  EXPECT_EQ(second_pose(studio.session(), 4), -1);
  studio.run("edit.undo");
  studio.wait_idle();
  ASSERT_TRUE(second(studio).performed) << second(studio).problem;
  EXPECT_EQ(second(studio).performed->motion.poses.size(), 12u);
}

TEST_F(SecondBodyTest, IsThereAgainWhenTheDocumentIsOpened) {
  {
    Studio studio(services());
    perform_itself(studio);
    studio.run("bones.match", {"0", "1"});
    studio.run("document.save_as", {path("arm.understudy")});
  }
  Studio studio(services());
  studio.run("document.open", {path("arm.understudy")});
  studio.wait_idle();
  ASSERT_TRUE(second(studio).performed) << second(studio).problem;
  EXPECT_EQ(second(studio).matches.partner, (std::vector<int>{-1, 0}));
}

TEST_F(SecondBodyTest, IsAskedForWhereItsFileIsMissing) {
  {
    Studio studio(services());
    perform_itself(studio);
    studio.run("document.save_as", {path("arm.understudy")});
  }
  fs::rename(path("second.glb"), path("moved.glb"));
  Studio studio(services());
  studio.run("document.open", {path("arm.understudy")});
  ASSERT_TRUE(studio.session().question);
  EXPECT_EQ(studio.session().question->missing, std::vector<std::string>{path("second.glb")});
  studio.wait_idle();
  EXPECT_TRUE(studio.session().bones.rig) << "the first one's bones are found all the same";
  EXPECT_FALSE(second(studio).performed);
  EXPECT_NE(second(studio).problem.find("second.glb"), std::string::npos) << second(studio).problem;
  EXPECT_EQ(second(studio).problem.find('\n'), std::string::npos);
  EXPECT_TRUE(studio.session().errors.empty()) << "the question says it already";
  studio.run("document.relocate", {path("second.glb"), path("moved.glb")});
  studio.wait_idle();
  EXPECT_TRUE(second(studio).performed) << second(studio).problem;
}

TEST_F(SecondBodyTest, IsRefusedAtOnceWhereTheFileIsNoBody) {
  Studio studio(services());
  EXPECT_EQ(refused(studio, "bones.perform", {path("arm.npz")}), "no bones have been found yet");
  find(studio);
  std::ofstream(path("photo.jpg")) << "no scan at all";
  std::ofstream(path("walk.bvh")) << "HIERARCHY\n";
  fs::create_directories(path("empty"));
  for (const char* name : {"absent.glb", "photo.jpg", "walk.bvh", "empty"})
    EXPECT_NE(refused(studio, "bones.perform", {path(name)}).find(name), std::string::npos) << name;
  EXPECT_NE(refused(studio, "bones.match", {"0", "0"}), "");
  EXPECT_TRUE(studio.session().document.bones.second.path.empty());
}

TEST_F(SecondBodyTest, TellsInOneSentenceWhatIsWrongWithAFileThatWasRead) {
  write_arm("arm.npz", understudy::kFrames, 1, 4000);
  Studio studio(services());
  find(studio);
  std::ofstream(path("broken.glb")) << "glTF, or is it?";
  std::ofstream(path("broken.ply")) << "ply\nformat ascii 1.0\nelement vertex 3\nend_header\n";
  write_sliced(studio, "sliced.glb", 60);
  for (const char* name : {"broken.glb", "broken.ply", "sliced.glb"}) {
    studio.session().errors.clear();
    perform(studio, name);
    EXPECT_FALSE(second(studio).performed) << name;
    const std::string& problem = second(studio).problem;
    EXPECT_NE(problem.find(name), std::string::npos) << problem;
    EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
    ASSERT_EQ(studio.session().errors.size(), 1u) << name;
  }
  EXPECT_NE(second(studio).problem.find("no bone has a partner"), std::string::npos) << "60 slices of two";
  ASSERT_TRUE(second(studio).other) << "its bones can be chosen";
  studio.run("bones.match", {"1", "slice 40"});
  studio.wait_idle();
  EXPECT_TRUE(second(studio).performed) << second(studio).problem;
}

TEST_F(SecondBodyTest, CancelledPerformsWhenItIsAskedForAgain) {
  Studio studio(services());
  find(studio);
  write_arm("scans.npz", understudy::kFrames, 1.5f);
  studio.run("bones.perform", {path("scans.npz")});
  while (second(studio).job == 0) studio.tick(0);
  studio.run("job.cancel", {std::to_string(second(studio).job)});
  studio.wait_idle();
  EXPECT_FALSE(second(studio).performed);
  EXPECT_EQ(second(studio).problem, "Cancelled before the second body performed");
  EXPECT_TRUE(studio.session().errors.empty());
  perform(studio, "scans.npz");
  EXPECT_TRUE(second(studio).performed) << second(studio).problem;
}

TEST_F(SecondBodyTest, IsInTheViewThatFitsAll) {
  Studio studio(services());
  find(studio);
  studio.run("view.fit");
  const float alone = camera_of(studio.session().view, 0).distance;
  studio.run("bones.export", {path("second.glb")});
  studio.wait_idle();
  perform(studio, "second.glb");
  studio.run("view.fit");
  EXPECT_GT(camera_of(studio.session().view, 0).distance, 1.3f * alone);
  const float before = second_place(studio.session()).x();
  studio.run("view.bone_surface", {"beside"});
  EXPECT_GT(second_place(studio.session()).x(), before + 0.5f) << "farther than the painted surface";
}

}  // namespace
}  // namespace understudy::app
