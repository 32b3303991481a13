// Targets with bones of their own in the studio.
#include <chrono>
#include <future>
#include <thread>

#include "app/session/document_file.hpp"
#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"
#include "retarget/character/gltf_character.hpp"
#include "retarget/character/read_character.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "tests/retarget/character/characters.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

class StudioCharacter : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    tests::MadeCharacter made;
    made.arms_down_deg = 50;
    made.heading_deg = 90;
    write_gltf_character(path("made.glb"), tests::make_character(made));
  }
  void open(Studio& studio) {
    studio.run("open", {path("scan.npz")});
    studio.run("open", {path("made.glb")});
    studio.wait_idle();
  }
  const TakeState& take(const Studio& studio) const { return studio.session().takes.at(0); }
  /// What it says when it refuses; empty when it does not.
  std::string refusal(Studio& studio, const std::string& name, const Arguments& arguments) {
    try {
      studio.run(name, arguments);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
};

TEST_F(StudioCharacter, OpensWhateverTheReaderTakesByItsSuffixOrItsContent) {
  Studio studio(services());
  for (const char* name : {"made.vrm", "made.character"}) {
    fs::copy_file(path("made.glb"), path(name));
    studio.run("open", {path(name)});
  }
  studio.wait_idle();
  ASSERT_EQ(studio.session().takes.size(), 2u);
  for (const TakeState& take : studio.session().takes) EXPECT_TRUE(take.ready) << take.problem;
  std::ofstream(path("letter.doc")) << "Dear Ada";
  EXPECT_NE(refusal(studio, "target.add", {path("letter.doc")}).find("not a known"), std::string::npos);
  EXPECT_NE(refusal(studio, "open", {path("letter.doc")}).find("neither a scan"), std::string::npos);
  EXPECT_EQ(studio.session().takes.size(), 2u);
}

TEST_F(StudioCharacter, PerformsOnItsOwnBonesFromAnyPoseAndHeading) {
  Studio studio(services());
  open(studio);
  const TakeState& state = take(studio);
  ASSERT_TRUE(state.ready) << state.problem;
  EXPECT_TRUE(state.character->rigged);
  EXPECT_EQ(state.deformer->name(), "the rig's own skin");
  EXPECT_NEAR(state.character->pose.largest_deg, 50, 5);
  EXPECT_EQ(state.performed.size(), static_cast<size_t>(kFrames));
  const Joints& rest = state.target->joints;
  EXPECT_GT(rest(LeftWrist, 0), rest(LeftShoulder, 0) + 0.3f);  // the arms are stretched out to its left
  EXPECT_NEAR(rest(LeftWrist, 1), rest(LeftShoulder, 1), 0.06f);
  EXPECT_FALSE(state.target->mesh.is_cloud());
}

TEST_F(StudioCharacter, IsSeenAsItCameBeforeAnyNetworkIsThere) {
  std::promise<void> loaded;
  StudioServices slow = services();
  slow.networks = [networks = slow.networks, gate = loaded.get_future().share()](const Method& method,
                                                                                 const NetworkParts& parts) {
    gate.wait();
    return networks(method, parts);
  };
  Studio studio(std::move(slow));
  studio.run("target.add", {path("made.glb")});
  for (int i = 0; i < 5000 && !take(studio).as_loaded; ++i) {
    studio.tick(0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const auto came = take(studio).as_loaded;
  if (!came) loaded.set_value();
  ASSERT_NE(came, nullptr);
  EXPECT_EQ(take(studio).target, nullptr);
  EXPECT_FALSE(take(studio).ready);
  EXPECT_FALSE(studio.idle());
  studio.tick(0);
  ASSERT_EQ(studio.session().jobs.size(), 1u);
  EXPECT_EQ(studio.session().jobs[0].name, "Binding made");
  const auto y = came->mesh.vertices.col(1);
  EXPECT_NEAR(y.minCoeff(), 0, 1e-3f);
  EXPECT_NEAR(y.maxCoeff(), 1.7f, 0.15f);
  EXPECT_GT(came->mesh.colors.rows(), 0);
  loaded.set_value();
  studio.wait_idle();
  EXPECT_TRUE(take(studio).ready);
  EXPECT_EQ(take(studio).as_loaded, nullptr);
  EXPECT_EQ(take(studio).character->surface.mesh.vertices, came->mesh.vertices);
  EXPECT_GT((take(studio).target->mesh.vertices - came->mesh.vertices).cwiseAbs().maxCoeff(),
            0.2f);  // arms up
  EXPECT_TRUE(studio.session().jobs.empty());
}

TEST_F(StudioCharacter, OnlyWeightsOfNetworksAreDoubted) {
  Studio studio(services());
  open(studio);
  EXPECT_EQ(take(studio).binding, nullptr);
  studio.run("target.rig", {"0", "22"});
  studio.wait_idle();
  ASSERT_NE(take(studio).binding, nullptr);
  EXPECT_EQ(take(studio).binding->uncertainty.size(), take(studio).target->mesh.vertices.rows());
  studio.run("view.colour", {"take", "uncertainty"});
  EXPECT_EQ(studio.session().view.take.colouring, Colouring::Uncertainty);
}

TEST_F(StudioCharacter, TakesOfOneTargetAreClipsOfOneFile) {
  Studio studio(services());
  open(studio);
  studio.run("compare.add", {"0", "engine=paper"});
  studio.run("take.rename", {"1", "late"});
  studio.run("edit.trim", {"1", "10", "15"});
  studio.run("target.add", {path("target.obj")});
  studio.wait_idle();
  studio.run("export.run", {"0", path("both.glb"), "take=late"});
  studio.run("export.run", {"1", path("one.glb")});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  const auto both = read_character(path("both.glb")).animations;
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].name, "made");
  EXPECT_EQ(both[1].name, "late");
  EXPECT_NEAR(both[0].duration(), 23 / 30.0, 1e-3);
  EXPECT_NEAR(both[1].duration(), 5 / 30.0, 1e-3);
  EXPECT_EQ(read_character(path("one.glb")).animations.at(0).name, "scan");
  const auto refused = [&](const std::string& option, const std::string& file = "x.glb") {
    return refusal(studio, "export.run", {"0", path(file), option});
  };
  EXPECT_NE(refused("take=early").find("there is no take 'early', only 0 made, 1 late, 2 target"),
            std::string::npos);
  EXPECT_NE(refused("take=target").find("same target"), std::string::npos);
  EXPECT_NE(refused("take=late", "x.bvh").find("holds one motion"), std::string::npos);
  studio.run("take.rename", {"2", "late"});
  EXPECT_NE(refused("take=late").find("several takes"), std::string::npos);
  studio.run("method.offsets", {"1", "off"});
  studio.wait_idle();
  EXPECT_NE(refused("take=1").find("offsets"), std::string::npos);
}

TEST_F(StudioCharacter, ATakeBecomesPosePictures) {
  Studio studio(services());
  open(studio);
  studio.run("export.run",
             {"0", path("control.mp4"), "canvas=160x120", "rate=16", "count=4n+1", "camera=yaw=20"});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  const KeypointReading read = read_keypoints(path("control.json"));
  EXPECT_EQ(read.frames.size() % 4, 1u);
  EXPECT_EQ(read.canvas, (Canvas{160, 120}));
  EXPECT_NE(refusal(studio, "export.run", {"0", path("a.mp4"), "canvas=big"}).find("'big'"),
            std::string::npos);
}

TEST_F(StudioCharacter, WhatTheDocumentReadsIsNeverWrittenOver) {
  Studio studio(services());
  open(studio);
  const std::string before = read_file(path("made.glb"));
  EXPECT_NE(refusal(studio, "export.run", {"0", path("made.glb")}).find("would be lost"), std::string::npos);
  EXPECT_NE(refusal(studio, "export.run", {"0", path("scan.npz")}).find("would be lost"), std::string::npos);
  studio.try_run("export.all", {path(""), "format=glb"});
  studio.wait_idle();
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_NE(studio.session().errors[0].text.find("would be lost"), std::string::npos);
  EXPECT_EQ(read_file(path("made.glb")), before);
}

TEST_F(StudioCharacter, AllTakesAreExportedAFileEachAndWhatFailsKeepsNoOtherOut) {
  Studio studio(services());
  open(studio);
  studio.run("compare.add", {"0", "engine=paper"});
  studio.run("take.rename", {"1", "Made"});  // one file on many systems
  studio.run("target.add", {path("target.obj")});
  studio.run("take.rename", {"2", "a/b"});
  studio.wait_idle();
  fs::create_directories(path("all/a_b.glb/in the way"));
  studio.try_run("export.all", {path("all"), "preset=unreal", "keep_clips=on"});
  EXPECT_LE(studio.jobs().views().size(), 1u) << "one progress";
  studio.wait_idle();
  EXPECT_EQ(read_character(path("all/made.glb")).animations.at(0).name, "scan");
  EXPECT_GT(fs::file_size(path("all/Made 2.glb")), 1000u);
  ASSERT_EQ(studio.session().notices.size(), 1u) << "one notice";
  EXPECT_EQ(studio.session().notices[0].text, "Exported 2 of 3 takes to all");
  EXPECT_EQ(studio.session().notices[0].offer.label, "Show in folder");
  ASSERT_EQ(studio.session().errors.size(), 1u);
  const Notice error = studio.session().errors.front();
  EXPECT_NE(error.text.find("a_b.glb"), std::string::npos) << error.text;
  EXPECT_EQ(error.details.substr(0, 11), "export.all ") << "so that the dialog comes back";

  fs::remove_all(path("all/a_b.glb"));
  studio.run("error.dismiss");
  studio.run("export.all", {path("all"), "format=glb"});
  studio.wait_idle();
  studio.run("export.all", {path("figures"), "format=csv"});
  studio.wait_idle();
  EXPECT_TRUE(studio.session().errors.empty());
  EXPECT_EQ(studio.session().notices[1].text, "Exported 3 takes to all");
  EXPECT_GT(fs::file_size(path("all/a_b.glb")), 1000u);
  EXPECT_GT(fs::file_size(path("figures/a_b.csv")), 100u);
  EXPECT_NE(refusal(studio, "export.all", {path("all"), "take=made"}).find("all takes"), std::string::npos);
  EXPECT_NE(refusal(studio, "export.all", {path("all"), "format=ply", "bones=own"}).find("own bones"),
            std::string::npos);

  fs::remove(path("all/made.glb"));
  fs::create_directories(path("all/made.glb/in the way"));
  studio.run("export.all", {path("all"), "format=glb"});
  studio.wait_idle(60);
  const Notice& part = studio.session().notices.back();
  EXPECT_EQ(part.text, "Exported 2 of 3 takes to all");
  EXPECT_NE(part.offer.command.find("Made 2.glb"), std::string::npos) << "one that was written";
}

TEST_F(StudioTest, AnExportOfTakesThatIsCancelledLeavesNoEmptyFolder) {
  const auto stopped = [](float) { throw Error("cancelled"); };
  const std::vector<TakeFile> files = {{path("new/all/a.csv"), "", [](const auto&) {}}};
  EXPECT_THROW(write_takes(path("new/all"), files, stopped), Error);
  EXPECT_FALSE(fs::exists(path("new")));
  fs::create_directories(path("kept"));
  EXPECT_THROW(write_takes(path("kept"), files, stopped), Error);
  EXPECT_TRUE(fs::exists(path("kept"))) << "it was there before";
}

TEST_F(StudioCharacter, AnExportOfTakesThatAllFailIsAnErrorAndLeavesNoFolder) {
  Studio studio(services());
  open(studio);
  studio.run("export.all", {path("all"), "format=bvh", "morphs=4"});
  studio.wait_idle();
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_NE(studio.session().errors.front().text.find("morph"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("all")));
  EXPECT_TRUE(studio.session().notices.empty());
}

TEST_F(StudioCharacter, ABvhIsOnThe22JointsOrOnItsOwnBones) {
  Studio studio(services());
  open(studio);
  studio.run("target.add", {path("target.obj")});
  studio.wait_idle();
  studio.run("export.run", {"0", path("joints.bvh")});
  studio.run("export.run", {"0", path("own.bvh"), "bones=own"});
  studio.run("export.all", {path("all"), "format=bvh", "bones=own"});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  const auto has_bone = [&](const std::string& file, const std::string& bone) {
    std::ifstream text(path(file));
    const std::string all((std::istreambuf_iterator<char>(text)), {});
    return all.find(" " + bone + "\n") != std::string::npos;
  };
  const std::string hips = tests::made_name(tests::Naming::Mixamo, Pelvis);
  EXPECT_TRUE(has_bone("joints.bvh", "pelvis"));
  EXPECT_FALSE(has_bone("joints.bvh", hips));
  EXPECT_TRUE(has_bone("own.bvh", hips));
  EXPECT_TRUE(has_bone("all/made.bvh", hips));
  EXPECT_TRUE(has_bone("all/target.bvh", "pelvis")) << "what has no bones of its own is on the 22";
  EXPECT_NE(refusal(studio, "export.run", {"1", path("x.bvh"), "bones=own"}).find("bones of its own"),
            std::string::npos);
}

/// Only the JSON of the file is left: whoever reads more than that fails.
TEST_F(StudioCharacter, ADropOfAMotionReturnsBeforeItsNumbersAreRead) {
  write_gltf_character(path("made.glb"), tests::make_character({}));
  Character moves = tests::make_character({});
  CharacterTrack track;
  track.node = 1, track.times = {0, 1}, track.values = {0, 0, 0, 1, 0, 0.1f, 0, 0.995f};
  moves.animations.push_back({"nod", {track}});
  write_gltf_character(path("moves.glb"), moves);
  uint32_t json_bytes = 0;
  std::ifstream(path("moves.glb"), std::ios::binary).seekg(12).read(reinterpret_cast<char*>(&json_bytes), 4);
  fs::resize_file(path("moves.glb"), 20 + json_bytes);
  Studio studio(services());
  studio.run("target.add", {path("made.glb")});
  studio.run("open", {path("moves.glb")});
  EXPECT_EQ(studio.session().document.source.path, path("moves.glb"));
}

TEST_F(StudioCharacter, OneOfAFilesAnimationsIsTheSource) {
  Character moves = tests::make_character({});
  for (const float seconds : {1.0f, 2.0f}) {
    CharacterTrack track;
    track.node = 1, track.times = {0, seconds}, track.values = {0, 0, 0, 1, 0, 0.1f, 0, 0.995f};
    moves.animations.push_back({seconds < 1.5f ? "nod" : "look", {track}});
  }
  write_gltf_character(path("moves.glb"), moves);
  Studio studio(services());
  studio.run("source.open", {path("moves.glb")});
  studio.wait_idle();
  const SourceState& source = studio.session().source;
  ASSERT_EQ(source.clips.size(), 2u);
  EXPECT_EQ(source.clips[0].name, "nod");
  EXPECT_NEAR(source.clips[1].seconds, 2, 1e-4);
  EXPECT_EQ(source.clip, 1);  // the longest
  const size_t frames = source.frames.size();
  studio.run("source.clip", {"nod"});
  studio.wait_idle();
  EXPECT_EQ(source.clip, 0);
  EXPECT_LT(source.frames.size(), frames);
  EXPECT_NE(refusal(studio, "source.clip", {"jump"}).find("'jump', only 1 nod, 2 look"), std::string::npos);
  studio.run("document.save_as", {path("moves")});
  EXPECT_EQ(read_document(path("moves.understudy")).document.source.clip, "nod");
  studio.run("source.open", {path("scan.npz")});
  EXPECT_TRUE(source.clips.empty());
  EXPECT_NE(refusal(studio, "source.clip", {"nod"}).find("is a scan"), std::string::npos);
  EXPECT_NE(refusal(studio, "source.bone", {"head", "Head"}).find("is a scan"), std::string::npos);
  EXPECT_TRUE(studio.session().document.source.bones.empty());
}

TEST_F(StudioCharacter, TheRigIsChosenAndTheScanIsNotLookedAtAgain) {
  Studio studio(services());
  open(studio);
  const int extracted = *extractions_;
  studio.run("target.rig", {"0", "22"});
  studio.wait_idle();
  EXPECT_NE(take(studio).deformer->name(), "the rig's own skin");
  EXPECT_EQ(take(studio).performed.size(), static_cast<size_t>(kFrames));
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_EQ(take(studio).deformer->name(), "the rig's own skin");
  EXPECT_EQ(*extractions_, extracted);
}

TEST_F(StudioCharacter, ABoneIsTakenAwayGivenAndUndone) {
  Studio studio(services());
  open(studio);
  studio.run("target.bone", {"0", "left_wrist", "none"});
  studio.wait_idle();
  EXPECT_FALSE(take(studio).character->map.has(LeftWrist));
  EXPECT_TRUE(take(studio).character->rigged);
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_TRUE(take(studio).character->map.has(LeftWrist));
  const std::string neck = tests::made_name(tests::Naming::Mixamo, Neck);
  studio.run("target.bone", {"0", "head", neck});
  studio.wait_idle();
  const BoneMap& map = take(studio).character->map;
  EXPECT_EQ(take(studio).character->character.nodes[static_cast<size_t>(map.node[Head])].name, neck);
  EXPECT_FALSE(map.has(Neck));  // one bone for one joint
  studio.run("target.bones_clear", {"0"});
  EXPECT_TRUE(studio.session().document.takes[0].target.bones.empty());
}

TEST_F(StudioCharacter, WrongBonesAreRefusedInOneSentence) {
  Studio studio(services());
  open(studio);
  const std::string neck = tests::made_name(tests::Naming::Mixamo, Neck);
  studio.run("target.bone", {"0", "head", neck});
  EXPECT_NE(refusal(studio, "target.bone", {"0", "neck", neck}).find("to both"), std::string::npos);
  EXPECT_NE(refusal(studio, "target.bone", {"0", "neck", "Tail"}).find("'Tail'"), std::string::npos);
  EXPECT_NE(refusal(studio, "target.bone", {"0", "tail", neck}), "");
  EXPECT_NE(refusal(studio, "target.rig", {"0", "mine"}), "");
  EXPECT_EQ(studio.session().document.takes[0].target.bones, (BoneChoices{{"head", neck}}));
}

TEST_F(StudioCharacter, AMeshWithoutBonesCannotPerformOnItsOwn) {
  Studio studio(services());
  open_both(studio);
  EXPECT_NE(refusal(studio, "target.rig", {"0", "theirs"}).find("no skeleton"), std::string::npos);
}

TEST_F(StudioCharacter, ItsOwnSkinTakesMovedJointsAndPaintedWeights) {
  Studio studio(services());
  open(studio);
  const Target before = *take(studio).target;
  const Points pose_before = take(studio).deformer->deform(take(studio).shown.poses.back());
  const Vec3 elbow = before.joints.row(LeftElbow).transpose() + Vec3(-0.06f, 0.02f, 0);
  studio.run("edit.target_joint", {"0", "left_elbow", std::to_string(elbow.x()), std::to_string(elbow.y()),
                                   std::to_string(elbow.z())});
  studio.wait_idle();
  const TakeState state = take(studio);
  EXPECT_NEAR((state.target->joints.row(LeftElbow).transpose() - elbow).norm(), 0, 1e-5f);
  Pose rest;
  rest.root = state.target->joints.row(Pelvis).transpose();
  EXPECT_LT((state.deformer->deform(rest) - state.target->mesh.vertices).cwiseAbs().maxCoeff(), 1e-4f);
  const Points pose_after = state.deformer->deform(state.shown.poses.back());
  EXPECT_GT((pose_after - pose_before).cwiseAbs().maxCoeff(), 0.005f);

  studio.run("select.joint", {"head"});
  Eigen::Index vertex = 0;
  state.weights->col(LeftElbow).maxCoeff(&vertex);
  const Vec3 at = state.target->mesh.vertices.row(vertex).transpose();
  studio.run("edit.paint", {"0", std::to_string(at.x()), std::to_string(at.y()), std::to_string(at.z())});
  studio.wait_idle();
  const TakeState painted = take(studio);
  EXPECT_GT((painted.deformer->deform(state.shown.poses.back()) - pose_after).cwiseAbs().maxCoeff(), 0.005f);
  EXPECT_EQ(painted.deformer->name(), "the rig's own skin");
}

TEST_F(StudioCharacter, RigAndBonesAreSaved) {
  SharedFrames<KeptFrame> performed;
  {
    Studio studio(services());
    open(studio);
    studio.run("target.bone", {"0", "left_collar", "none"});
    studio.run("target.rig", {"0", "own"});
    studio.wait_idle();
    performed = take(studio).performed;
    studio.run("document.save_as", {path("made")});
  }
  Studio studio(services());
  studio.run("open", {path("made.understudy")});
  studio.wait_idle();
  const TargetOptions& target = studio.session().document.takes.at(0).target;
  EXPECT_EQ(target.rig, Rig::Own);
  EXPECT_EQ(target.bones, (BoneChoices{{"left_collar", ""}}));
  ASSERT_EQ(take(studio).performed.size(), performed.size());
  const size_t last = performed.size() - 1;
  EXPECT_EQ(take(studio).performed[last].pose.root, performed[last].pose.root);
}

}  // namespace
}  // namespace understudy::app
