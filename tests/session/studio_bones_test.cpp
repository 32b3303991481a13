// The source's own skeleton, from the scans that are opened to the rig that is exported.
#include <chrono>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/retarget/discovery/arm_finder.hpp"
#include "tests/session/arm_studio.hpp"

namespace understudy::app {
namespace {

/// Is sure of nobody.
class UnsureExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh&) override {
    Extraction nobody;
    nobody.joints = human_rest();
    nobody.confidence.setZero();
    return nobody;
  }
  std::string name() const override { return "unsure"; }
};

class Bones : public ArmStudioTest {
 protected:
  /// Nobody is seen in an arm.
  StudioServices no_person() {
    StudioServices own = services();
    own.networks = [usual = own.networks](const Method& method, const NetworkParts& parts) {
      Networks networks = usual(method, parts);
      if (parts.extractor) networks.extractor = std::make_shared<UnsureExtractor>();
      return networks;
    };
    return own;
  }
};

/// Knows the keypoints of arms; of hands it has no weights.
StudioServices with_keypoints(StudioServices own) {
  own.keypoints = [](const std::string& method, const std::string& kind) -> std::shared_ptr<KeypointFinder> {
    US_CHECK(kind == "arm", "weights/marionette_", method, "_", kind, ".weights: is missing");
    return std::make_shared<ArmFinder>(true);
  };
  return own;
}

bool same_rigs(const DiscoveredRig& a, const DiscoveredRig& b) {
  bool same = a.found.rig.skin.weights == b.found.rig.skin.weights &&
              a.found.rig.joints.size() == b.found.rig.joints.size() &&
              a.found.motion.poses.size() == b.found.motion.poses.size();
  for (size_t t = 0; same && t < a.found.motion.poses.size(); ++t)
    same = a.found.motion.poses[t].root == b.found.motion.poses[t].root &&
           a.found.motion.poses[t].turns == b.found.motion.poses[t].turns;
  return same;
}

TEST_F(Bones, AreOfferedWhereNoPersonIsSeen) {
  write_arm("arm.npz", understudy::kFrames, 1, 4000);
  Studio studio(no_person());
  open_arm(studio);
  const auto& notices = studio.session().notices;
  const auto offer = std::find_if(notices.begin(), notices.end(), [](const Notice& notice) {
    return notice.also.command == "bones.find" || notice.offer.command == "bones.find";
  });
  ASSERT_NE(offer, notices.end());
  EXPECT_EQ(offer->offer.label, "Clean up") << "what was offered before still is";
  EXPECT_EQ(offer->also.label, "Find its own skeleton");
  EXPECT_TRUE(studio.session().source.no_person);
  studio.run(std::string(offer->also.command));
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig);
  EXPECT_EQ(rig(studio).count(), 2);
  EXPECT_TRUE(studio.session().bones.near.empty()) << "there is no person whose joints could be near";
}

TEST_F(Bones, AreFoundWithTheirElbowAndOpenedAgainTheSame) {
  std::shared_ptr<const DiscoveredRig> found;
  {
    Studio studio(services());
    find(studio);
    found = studio.session().bones.rig;
    ASSERT_EQ(rig(studio).count(), 2);
    EXPECT_EQ(rig(studio).joints[1].kind, JointKind::Hinge);
    EXPECT_EQ(found->found.motion.poses.size(), static_cast<size_t>(understudy::kFrames));
    studio.run("bones.rename", {"1", "forearm"});
    studio.run("document.save_as", {path("arm.understudy")});
  }
  Studio studio(services());
  studio.run("document.open", {path("arm.understudy")});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig);
  EXPECT_TRUE(same_rigs(*found, *studio.session().bones.rig));
  EXPECT_EQ(rig(studio).joints[1].name, "forearm");
}

TEST_F(Bones, FoundBySlotsAreNamedAfterKeypointsAndAreOpenedAgainTheSame) {
  std::shared_ptr<const DiscoveredRig> found;
  {
    Studio studio(with_keypoints(services()));
    find(studio);
    const auto by_parts = studio.session().bones.rig;
    studio.run("bones.find", {"slots", "arm"});
    studio.wait_idle();
    found = studio.session().bones.rig;
    ASSERT_TRUE(found) << studio.session().bones.problem;
    ASSERT_GE(rig(studio).count(), 2) << "noise in few points makes more";
    EXPECT_GE(bone_named(rig(studio), "keypoint 1"), 0);
    EXPECT_EQ(found->found.motion.poses.size(), static_cast<size_t>(understudy::kFrames));
    studio.run("edit.undo");
    studio.tick(0);
    EXPECT_EQ(studio.session().bones.rig, by_parts);
    studio.run("edit.redo");
    studio.tick(0);
    EXPECT_EQ(studio.session().bones.rig, found);
    EXPECT_EQ(studio.session().bones.job, 0) << "no new search";
    studio.run("document.save_as", {path("arm.understudy")});
  }
  Studio studio(with_keypoints(services()));
  studio.run("document.open", {path("arm.understudy")});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig);
  EXPECT_TRUE(same_rigs(*found, *studio.session().bones.rig));
  EXPECT_GE(bone_named(rig(studio), "keypoint 1"), 0);
  studio.run("bones.find", {"auto"});
  EXPECT_EQ(studio.session().document.bones.search.method, "parts") << "so many bones are of parts";
}

TEST_F(Bones, KeypointsAreShownBeforeTheyAreFitted) {
  Studio studio(with_keypoints(services()));
  open_arm(studio);
  studio.run("bones.find", {"slots", "arm"});
  while (!studio.session().bones.so_far && !studio.session().bones.rig) studio.tick(0);
  ASSERT_TRUE(studio.session().bones.so_far);
  EXPECT_EQ(studio.session().bones.so_far->tree.size(), 3u);
  studio.wait_idle();
}

TEST_F(Bones, OfOneScanAreFoundBySlotsAlone) {
  write_arm("one.npz", 1);
  Studio studio(with_keypoints(services()));
  studio.run("open", {path("one.npz")});
  studio.run("source.units", {"m"});
  studio.run("source.up", {"y"});
  studio.wait_idle();
  studio.run("bones.find");
  studio.wait_idle();
  EXPECT_NE(studio.session().bones.problem.find("two frames or more"), std::string::npos);
  EXPECT_EQ(studio.session().errors.size(), 1u);
  studio.run("bones.find", {"slots", "arm"});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig) << studio.session().bones.problem;
  EXPECT_EQ(rig(studio).count(), 3);
  EXPECT_TRUE(studio.session().bones.rig->seen_once());
  EXPECT_EQ(studio.session().bones.rig->found.motion.poses.size(), 1u);
}

TEST_F(Bones, BySlotsRefuseWhatCannotBeFoundWithOneSentence) {
  Studio studio(with_keypoints(services()));
  open_arm(studio);
  EXPECT_NE(refusal([&] { studio.run("bones.find", {"slots"}); }).find("name the one that moves"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              studio.run("bones.find", {"slots", "teapot"});
            }).find("teapot"),
            std::string::npos);
  EXPECT_NE(refusal([&] { studio.run("bones.find", {"parts", "arm"}); }).find("any kind"), std::string::npos);
  EXPECT_NE(refusal([&] { studio.run("bones.find", {"slotz"}); }).find("parts, slots"), std::string::npos);
  EXPECT_FALSE(studio.session().document.bones.wanted);
  studio.run("bones.find", {"slots", "hand"});
  studio.wait_idle();
  EXPECT_FALSE(studio.session().bones.rig);
  ASSERT_EQ(studio.session().errors.size(), 1u) << "told in a dialog";
  EXPECT_EQ(studio.session().errors[0].text, "weights/marionette_slots_hand.weights: is missing");
}

TEST_F(Bones, GoAndComeWithUndoAndRedoWithoutAnotherSearch) {
  Studio studio(services());
  find(studio);
  const auto found = studio.session().bones.rig;
  EXPECT_EQ(undo_label(studio.session()), "Find its own skeleton");
  studio.run("edit.undo");
  studio.tick(0);
  EXPECT_FALSE(studio.session().bones.rig);
  studio.run("edit.redo");
  studio.tick(0);
  EXPECT_EQ(studio.session().bones.rig, found);
  EXPECT_EQ(studio.session().bones.job, 0);
  studio.run("open", {path("scan.npz")});
  studio.wait_idle();
  EXPECT_FALSE(studio.session().bones.rig) << "another source";
  EXPECT_FALSE(studio.session().document.bones.wanted);
}

TEST_F(Bones, NeverMakeTheWindowWaitAndTellTheirStages) {
  Studio studio(services());
  open_arm(studio);
  studio.run("bones.find");
  std::set<std::string> stages;
  bool painted = false;
  double longest = 0;
  do {
    const auto began = std::chrono::steady_clock::now();
    studio.tick(0);
    longest =
        std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
    const BonesState& bones = studio.session().bones;
    stages.insert(bones.stage);
    painted = painted || (bones.so_far && bones.so_far->bone_of.size() > 500);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (!studio.idle());
  EXPECT_EQ(stages.count("Surface"), 1u);
  EXPECT_EQ(stages.count("Bones"), 1u);
  EXPECT_TRUE(painted) << "parts as they come";
  EXPECT_LT(longest, 0.5);
}

TEST_F(Bones, KeepTheBestFoundSoFarWhenCancelledAndAreFoundToTheEndAgain) {
  Studio studio(services());
  open_arm(studio);
  studio.run("bones.find");
  while (!studio.session().bones.so_far && !studio.session().bones.rig) studio.tick(0);
  studio.run("job.cancel", {std::to_string(studio.session().bones.job)});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig);
  EXPECT_FALSE(studio.session().bones.rig->complete);
  EXPECT_TRUE(studio.session().errors.empty()) << "nothing failed";
  studio.run("bones.find");
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig);
  EXPECT_TRUE(studio.session().bones.rig->complete);
}

TEST_F(Bones, CancelledBeforeAnyWereFoundAreMissedWithOneSentence) {
  Studio studio(services());
  open_arm(studio);
  studio.run("bones.find");
  while (studio.session().bones.job == 0) studio.tick(0);
  studio.run("job.cancel", {std::to_string(studio.session().bones.job)});
  studio.wait_idle();
  EXPECT_FALSE(studio.session().bones.rig);
  EXPECT_EQ(studio.session().bones.problem, "Cancelled before any bones were found");
  EXPECT_TRUE(studio.session().errors.empty());
}

TEST_F(Bones, AreMergedSplitAndRenamedWithUndo) {
  Studio studio(services());
  find(studio);
  studio.run("bones.select", {"1"});
  studio.run("bones.rename", {"1", "forearm"});
  EXPECT_EQ(rig(studio).joints[1].name, "forearm");
  studio.run("bones.split", {"forearm"});
  ASSERT_EQ(rig(studio).count(), 3);
  EXPECT_EQ(undo_label(studio.session()), "Split forearm");
  studio.run("bones.merge", {"2"});
  studio.run("bones.merge", {"forearm"});
  ASSERT_EQ(rig(studio).count(), 1);
  EXPECT_EQ(studio.session().bones.selected, 0) << "what was chosen is part of the other bone now";
  for (int i = 0; i < 3; ++i) studio.run("edit.undo");
  studio.tick(0);
  ASSERT_EQ(rig(studio).count(), 2);
  EXPECT_EQ(rig(studio).joints[1].name, "forearm");
  EXPECT_EQ(studio.session().bones.job, 0) << "no new search";
  EXPECT_EQ(studio.session().document.bones.edits.size(), 1u);
}

TEST_F(Bones, TakeEveryKindOfEdit) {
  Studio studio(services());
  find(studio);
  studio.run("bones.kind", {"1", "ball"});
  EXPECT_EQ(rig(studio).joints[1].kind, JointKind::Ball);
  studio.run("bones.move", {"1", "0.5", "0.01", "0"});
  EXPECT_NEAR(rig(studio).joints[1].rest.y(), 0.01f, 1e-6f);
  const Mat3 before = studio.session().bones.rig->found.motion.poses[5].turns[1];
  studio.run("bones.turn", {"1", "5", "0", "0", "0.5", "2"});
  EXPECT_GT((studio.session().bones.rig->found.motion.poses[5].turns[1] - before).norm(), 0.3f);
  studio.run("bones.smooth", {"0.5"});
  studio.run("bones.paint", {"0", "0.1", "1", "add", "0.7", "0.05", "0"});
  studio.run("bones.trim", {"2", "8"});
  EXPECT_EQ(studio.session().bones.rig->found.motion.poses.size(), 7u);
  EXPECT_EQ(frame_of_rig(*studio.session().bones.rig, 2), 0);
  EXPECT_EQ(frame_of_rig(*studio.session().bones.rig, 9), -1);
  studio.run("bones.root", {"1"});
  EXPECT_EQ(studio.session().document.bones.edits.size(), 7u);
  const auto edited = studio.session().bones.rig;
  studio.run("bones.fit");
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig) << studio.session().bones.problem;
  EXPECT_NE(studio.session().bones.rig, edited);
  EXPECT_TRUE(studio.session().bones.problem.empty());
}

TEST_F(Bones, ATurnIsOneStepThatGoesAndComes) {
  Studio studio(services());
  find(studio);
  const auto found = studio.session().bones.rig;
  const Vec3 axis = rig(studio).joints[1].axis;
  app::Arguments words{"1", "5"};
  for (int i = 0; i < 3; ++i) words.push_back(std::to_string(0.5f * axis[i]));
  words.push_back("0");
  studio.run("bones.turn", words);
  EXPECT_EQ(undo_label(studio.session()), "Turn bone 1");
  const auto turned = studio.session().bones.rig;
  for (size_t t = 0; t < found->found.motion.poses.size(); ++t)
    EXPECT_NEAR(geodesic_angle(found->found.motion.poses[t].turns[1], turned->found.motion.poses[t].turns[1]),
                t == 5 ? 0.5f : 0, 1e-3f);
  studio.run("edit.undo");
  studio.tick(0);
  EXPECT_EQ(studio.session().bones.rig, found);
  studio.run("edit.redo");
  studio.tick(0);
  EXPECT_EQ(studio.session().bones.rig, turned);
  EXPECT_EQ(studio.session().bones.job, 0) << "no new search";
}

TEST_F(Bones, AStrokeOfTheBrushIsOneStepAndIsThereAgainWhenOpened) {
  std::shared_ptr<const DiscoveredRig> painted;
  {
    Studio studio(services());
    find(studio);
    const auto found = studio.session().bones.rig;
    Arguments words{"1", "0.1", "0.8", "add"};
    const Points& rest = rig(studio).surface.vertices;
    for (const Eigen::Index v : {0, 40, 80})  // three dabs
      for (int axis = 0; axis < 3; ++axis) words.push_back(std::to_string(rest(v, axis)));
    studio.run("bones.paint", words);
    EXPECT_EQ(undo_label(studio.session()), "Paint weights of bone 1");
    EXPECT_EQ(studio.session().document.bones.edits.size(), 1u);
    painted = studio.session().bones.rig;
    const auto weight = [](const DiscoveredRig& rig) { return rig.found.rig.skin.dense(2).col(1).sum(); };
    EXPECT_GT(weight(*painted), weight(*found) + 1) << "of vertices";
    studio.run("edit.undo");
    studio.tick(0);
    EXPECT_EQ(studio.session().bones.rig, found) << "all of the stroke at once";
    studio.run("edit.redo");
    studio.tick(0);
    EXPECT_EQ(studio.session().bones.rig, painted);
    EXPECT_NE(refusal([&] { studio.run("bones.paint", {"1", "0.1", "0.8", "add"}); }), "") << "nowhere";
    studio.run("document.save_as", {path("painted.understudy")});
  }
  Studio studio(services());
  studio.run("document.open", {path("painted.understudy")});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().bones.rig);
  EXPECT_TRUE(same_rigs(*painted, *studio.session().bones.rig));
}

TEST_F(Bones, RefuseWhatCannotBeDoneAndStayAsTheyWere) {
  Studio studio(services());
  EXPECT_NE(refusal([&] { studio.run("bones.find"); }), "");
  open_arm(studio);
  EXPECT_EQ(refusal([&] { studio.run("bones.merge", {"1"}); }), "no bones have been found yet");
  EXPECT_NE(refusal([&] { studio.run("bones.find", {"301"}); }), "");
  find(studio);
  const auto found = studio.session().bones.rig;
  for (const Arguments& words : std::vector<Arguments>{{"bones.merge", "0"},
                                                       {"bones.merge", "7"},
                                                       {"bones.rename", "1", ""},
                                                       {"bones.kind", "1", "free"},
                                                       {"bones.turn", "1", "99", "0", "0", "1"},
                                                       {"bones.trim", "8", "3"},
                                                       {"bones.export", "rig.txt"},
                                                       {"bones.export", path("arm.npz")}}) {
    const std::string sentence = refusal([&] { studio.run(words[0], {words.begin() + 1, words.end()}); });
    EXPECT_NE(sentence, "") << join_line(words[0], {words.begin() + 1, words.end()});
    EXPECT_EQ(sentence.find('\n'), std::string::npos);
  }
  EXPECT_EQ(studio.session().bones.rig, found);
  EXPECT_TRUE(studio.session().document.bones.edits.empty());
}

TEST_F(Bones, OfASkeletalMotionAreNotLookedFor) {
  Studio studio(services());
  open_walk(studio);
  EXPECT_NE(refusal([&] { studio.run("bones.find"); }).find("has bones already"), std::string::npos);
}

TEST_F(Bones, AreExportedAsACharacterThatOpensAgain) {
  Studio studio(services());
  find(studio);
  studio.run("bones.export", {path("rig.glb")});
  studio.wait_idle();
  ASSERT_TRUE(fs::exists(path("rig.glb")));
  const RiggedMotion again =
      from_character(read_character(path("rig.glb")), 0, studio.session().bones.rig->found.motion.fps);
  studio.run("bones.export", {path("rig.bvh")});
  studio.wait_idle();
  EXPECT_GT(fs::file_size(path("rig.bvh")), 500u);
  EXPECT_EQ(again.rig.count(), 2);
  EXPECT_EQ(again.motion.poses.size(), static_cast<size_t>(understudy::kFrames));
}

TEST_F(Bones, OfAPersonGetTheNamesOfTheJointsTheyAreNear) {
  Studio studio(services());
  find(studio);
  Session& session = studio.session();
  session.source.no_person = false;
  studio.tick(0);
  ASSERT_EQ(session.bones.near.size(), 2u) << "compared with the person that is seen";
  EXPECT_GE(session.bones.near[1].joint, 0);
  EXPECT_GT(session.bones.near[1].apart_m, 0);
  ASSERT_EQ(session.bones.steady.size(), static_cast<size_t>(kJointCount));
  for (const SteadyJoint& one : session.bones.steady) {
    EXPECT_TRUE(one.bone == 0 || one.bone == 1);
    EXPECT_TRUE(one.share >= 0.5 && one.share <= 1) << "one of two is the nearest in half of the frames";
    EXPECT_GE(one.apart_m + 1e-6f, session.bones.near[static_cast<size_t>(one.bone)].apart_m);
  }
  session.bones.near[1] = {LeftElbow, 0.01f, 0.01f, true};
  session.bones.near[0] = {Pelvis, 0.5f, 0.5f, false};
  studio.run("bones.name_as_joints");
  EXPECT_EQ(rig(studio).joints[1].name, "left_elbow");
  EXPECT_EQ(rig(studio).joints[0].name, "bone 0") << "far from all: it stays as it is";
  studio.run("edit.undo");
  studio.tick(0);
  EXPECT_EQ(rig(studio).joints[1].name, "bone 1");
}

}  // namespace
}  // namespace understudy::app
