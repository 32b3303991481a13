// 2D poses by the shipped program: `retarget` onto a person in a picture, the suites and their evaluation.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "retarget/base/file.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "retarget/pose2d/flat_placement.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/support/flat_person.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class FlatCommand : public ShippedProgram {
 protected:
  void SetUp() override {
    KeypointReading track = reading(flat_person());
    for (int t = 1; t < 8; ++t) {
      FlatPose pose = flat_person();
      move_pose(Vec2(4.0f * static_cast<float>(t), 0), pose);
      add(track, pose);
    }
    write_openpose_folder(scratch.path("track"), track);
    FlatPose tall = flat_person(200, 1.5f);
    move_pose(Vec2(0, 100), tall);
    write_controlnet(scratch.path("reference.json"), reading(tall));
  }
  static void add(KeypointReading& reading, const FlatPose& pose) {
    const auto number = static_cast<int64_t>(reading.frames.size());
    reading.frames.push_back({number, ""});
    reading.tracks[0].poses.push_back({number, 1, pose});
  }
  static KeypointReading reading(const FlatPose& pose) {
    KeypointReading one;
    one.canvas = {640, 560};
    one.tracks.resize(1);
    one.tracks[0].person = 1;
    add(one, pose);
    return one;
  }
  Finished perform(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"retarget", "--source", scratch.path("track"), "--target",
                                          scratch.path("reference.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(FlatCommand, ATrackIsPerformedOnTheReferencesPicture) {
  const Finished done = perform({"--out", out("made.json"), "--report", out("report.json")});
  ASSERT_EQ(done.code, 0) << done.err;
  const KeypointReading made = read_keypoints(out("made.json"));
  ASSERT_EQ(made.frames.size(), 8u);
  EXPECT_EQ(made.canvas, (Canvas{640, 560}));
  const KeypointTrack& person = made.performing();
  EXPECT_NEAR(person.at(0)->at(body25::LeftAnkle).y(), 500 - 1.5f * 10, 12);
  EXPECT_GT(person.at(7)->at(body25::Neck).x(), person.at(0)->at(body25::Neck).x() + 25);
  const Json report = Json::parse(read_file(out("report.json")));
  EXPECT_GT(report["target_lengths"]["trunk"]["length"], report["source_lengths"]["trunk"]["length"]);
  EXPECT_NE(done.err.find("from one pose"), std::string::npos) << done.err;
  EXPECT_EQ(report["engine"], "limbs");
}

TEST_F(FlatCommand, PicturesAndTablesAreWrittenToo) {
  ASSERT_EQ(perform({"--out", out("made.csv")}).code, 0);
  ASSERT_EQ(perform({"--out", out("frames")}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(out("frames/frame_00007.png")));
  EXPECT_TRUE(std::filesystem::exists(out("frames.json")));
}

TEST_F(FlatCommand, SameInputSameBytesAndNoPoseDependsOnALaterFrame) {
  ASSERT_EQ(perform({"--out", out("a.npz")}).code, 0);
  ASSERT_EQ(perform({"--out", out("b.npz")}).code, 0);
  EXPECT_EQ(read_file(out("a.npz")), read_file(out("b.npz")));
  ASSERT_EQ(perform({"--out", out("whole.json"), "--no-look-ahead"}).code, 0);
  for (const auto& file : std::filesystem::directory_iterator(scratch.path("track")))
    if (file.path().string().find("00006_") != std::string::npos ||
        file.path().string().find("00007_") != std::string::npos)
      std::filesystem::remove(file.path());
  ASSERT_EQ(perform({"--out", out("part.json"), "--no-look-ahead"}).code, 0);
  const KeypointReading whole = read_keypoints(out("whole.json")), part = read_keypoints(out("part.json"));
  ASSERT_EQ(part.frames.size(), 6u);
  for (int64_t t = 0; t < 6; ++t) EXPECT_EQ(*part.performing().at(t), *whole.performing().at(t)) << t;
}

TEST_F(FlatCommand, AFolderThatIsBeingWrittenIsFollowed) {
  write_file(scratch.path("track/done"), "");
  const Finished done = perform({"--out", scratch.path("live.json"), "--follow"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("frame 7 good"), std::string::npos) << done.out;
  ASSERT_EQ(perform({"--out", scratch.path("file.json"), "--no-look-ahead"}).code, 0);
  const KeypointReading live = read_keypoints(scratch.path("live.json")),
                        file = read_keypoints(scratch.path("file.json"));
  ASSERT_EQ(live.frames.size(), 8u);
  for (int64_t t = 0; t < 8; ++t) EXPECT_EQ(*live.performing().at(t), *file.performing().at(t)) << t;
}

TEST_F(FlatCommand, PicturesWhoseSizeNobodyTellsAreWrittenAtTheEnd) {
  write_file(scratch.path("track/done"), "");
  ASSERT_EQ(perform({"--out", out("live"), "--follow", "--place", "source"}).code, 0);
  ASSERT_EQ(perform({"--out", out("file"), "--no-look-ahead", "--place", "source"}).code, 0);
  for (const char* name : {"/frame_00000.png", "/frame_00007.png", ".json"})
    EXPECT_EQ(read_file(out("live") + name), read_file(out("file") + name)) << name;
}

TEST_F(FlatCommand, PicturesOfAFolderThatIsBeingWrittenAreThereAsTheirFramesCome) {
  const std::string live = scratch.path("live");
  std::filesystem::create_directories(live);
  const std::string pictures = out("frames/"), poses = out("frames_openpose/frames_openpose");
  std::vector<bool> was_there;
  std::thread detector([&] {
    for (int t = 0; t < 6; ++t) {
      const std::string name = printed("_%012d_keypoints.json", t);
      write_file(live + "/live" + name, read_file(scratch.path("track/track" + name)));
      if (t == 0) continue;  // a frame is whole when the next one is there
      const auto is_there = [&] {
        return std::filesystem::exists(pictures + printed("frame_%05d.png", t - 1)) &&
               std::filesystem::exists(poses + printed("_%012d_keypoints.json", t - 1));
      };
      for (int i = 0; i < 2000 && !is_there(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      was_there.push_back(is_there());
    }
    write_file(live + "/done", "");
  });
  const Finished done = run_program({"retarget", "--source", live, "--target", scratch.path("reference.json"),
                                     "--out", out("frames"), "--follow", "--pose-file", "openpose"});
  detector.join();
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(was_there, std::vector<bool>(5, true));
  ASSERT_EQ(perform({"--out", out("at_once"), "--no-look-ahead"}).code, 0);
  for (const char* name : {"frame_00000.png", "frame_00005.png"})
    EXPECT_EQ(read_file(pictures + name), read_file(out("at_once/") + name)) << name;
}

TEST_F(FlatCommand, OddReferencesAreToldInASentence) {
  FlatPose dog;  // seen from the side
  const std::vector<std::pair<int, Vec2>> points = {
      {body25::Nose, {60, 170}},          {body25::Neck, {100, 200}},
      {body25::MidHip, {250, 205}},       {body25::RightShoulder, {98, 201}},
      {body25::LeftShoulder, {103, 199}}, {body25::RightElbow, {96, 250}},
      {body25::LeftElbow, {106, 248}},    {body25::RightWrist, {95, 320}},
      {body25::LeftWrist, {104, 318}},    {body25::RightHip, {248, 206}},
      {body25::LeftHip, {252, 204}},      {body25::RightKnee, {262, 255}},
      {body25::LeftKnee, {240, 252}},     {body25::RightAnkle, {280, 318}},
      {body25::LeftAnkle, {262, 320}}};
  for (const auto& [point, place] : points) dog.set(point, place, 0.6f);
  write_controlnet(scratch.path("dog.json"), reading(dog));
  const Finished done = run_program({"retarget", "--source", scratch.path("track"), "--target",
                                     scratch.path("dog.json"), "--out", out("dog_out.json")});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.err.find("is on all fours: if that is no person"), std::string::npos) << done.err;
  const FlatBox box = box_of(*read_keypoints(out("dog_out.json")).performing().at(7));
  EXPECT_LT(box.sizes().maxCoeff(), 640);
  EXPECT_GT(box.sizes().maxCoeff(), 50);
}

TEST_F(FlatCommand, ABabyPerformsOnItsShortLegs) {
  FlatPose baby = flat_person(300, 0.5f);
  const Vec2 hips = baby.at(body25::MidHip), neck = baby.at(body25::Neck);
  for (int point = 0; point < kBodyPoints; ++point) {
    Vec2 place = baby.at(point);
    if (place.y() > hips.y()) place.y() = hips.y() + 0.6f * (place.y() - hips.y());
    if (place.y() < neck.y()) place = neck + 1.5f * (place - neck);
    baby.set(point, place, 0.9f);
  }
  write_controlnet(scratch.path("baby.json"), reading(baby));
  const Finished done = run_program({"retarget", "--source", scratch.path("track"), "--target",
                                     scratch.path("baby.json"), "--out", out("baby_out.json")});
  ASSERT_EQ(done.code, 0) << done.err;
  const auto legs_of = [](const FlatPose& pose) {
    const float hip = pose.at(body25::MidHip).y();
    return (pose.at(body25::LeftAnkle).y() - hip) / (hip - pose.at(body25::Neck).y());
  };
  const FlatPose made = *read_keypoints(out("baby_out.json")).performing().at(7);
  EXPECT_NEAR(legs_of(made), legs_of(baby), 0.15f * legs_of(baby));
  EXPECT_NEAR(made.at(body25::LeftAnkle).y(), baby.at(body25::LeftAnkle).y(), 6);
}

TEST_F(FlatCommand, WhoComesNearerGrowsOrDoesNot) {
  KeypointReading nearer = reading(flat_person());
  for (int t = 1; t < 90; ++t) add(nearer, flat_person(300, 1 + 0.005f * static_cast<float>(t)));
  write_controlnet(scratch.path("nearer.json"), nearer);
  const auto growth = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"retarget",
                                          "--source",
                                          scratch.path("nearer.json"),
                                          "--target",
                                          scratch.path("reference.json"),
                                          "--out",
                                          out("near_out.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(arguments).code, 0);
    const KeypointReading made = read_keypoints(out("near_out.json"));
    return box_of(*made.performing().at(89)).sizes().y() / box_of(*made.performing().at(0)).sizes().y();
  };
  EXPECT_NEAR(growth({}), 1.445, 0.03);
  EXPECT_NEAR(growth({"--no-growth"}), 1, 0.1);
}

TEST_F(FlatCommand, MeasureTellsOfATrackWithoutTruth) {
  const Finished done = run_program({"measure", scratch.path("track"), "--out", out("figures.json")});
  ASSERT_EQ(done.code, 0) << done.err;
  const Json report = Json::parse(read_file(out("figures.json")));
  EXPECT_EQ(report["frames"], 8);
  EXPECT_EQ(report["flagged"], 0);
  EXPECT_NEAR(report["metrics"]["seen"], 100, 1e-6);
  EXPECT_LT(report["metrics"]["jitter_px"], 0.2);
  EXPECT_LT(report["metrics"]["drift"], 1);
}

TEST_F(FlatCommand, BadInputIsASentence) {
  expect_clean_failure(perform({"--out", out("a.glb")}), "2D poses are written as");
  expect_clean_failure(perform({"--out", out("a.json"), "--person", "7"}), "7");
  expect_clean_failure(perform({"--out", out("a.json"), "--person", "anna"}), "anna");
  expect_clean_failure(perform({"--out", scratch.path("reference.json")}), "reference.json");
  expect_clean_failure(perform({"--out", out("a.json"), "--engine", "copy"}),
                       "the engine 'copy' is for what moves in space");
  expect_clean_failure(perform({"--out", out("a.json"), "--engine-weights", scratch.path("reference.json")}),
                       "has no network");
  expect_clean_failure(run_program({"retarget", "--source", scans(), "--target", target(), "--engine",
                                    "limbs", "--out", out("a.glb")}),
                       "the engine 'limbs' is for 2D poses");
  expect_clean_failure(run_program({"retarget", "--source", scratch.path("track"), "--target", target(),
                                    "--out", out("a.glb"), "--times", "t.csv"}),
                       "is 2D poses");
  expect_clean_failure(run_program({"retarget", "--source", target(), "--target", target(), "--out",
                                    out("a.glb"), "--fov", "30"}),
                       "--fov, --pitch) are for 2D poses");
}

TEST_F(FlatCommand, OfTwoFilesTheOneThatIsWrongIsNamed) {
  std::filesystem::create_directories(scratch.path("empty"));
  write_file(scratch.path("text.json"), "hello");
  write_file(scratch.path("nothing.json"), "");
  write_file(scratch.path("braces.json"), "{}");
  write_file(scratch.path("walk.bvh"), "HIERARCHY");
  const std::vector<std::pair<std::string, std::string>> sources = {
      {"nowhere.json", "there is no such file"},
      {"text.json", "is no JSON"},
      {"nothing.json", "is empty"},
      {"braces.json", "is empty JSON, there is nobody in it"},
      {"empty", "has no JSON files, so no poses"},
      {"walk.bvh", "is no 2D poses, and somebody in a picture"}};
  for (const auto& [name, problem] : sources)
    expect_clean_failure(run_program({"retarget", "--source", scratch.path(name), "--target",
                                      scratch.path("reference.json"), "--out", out("a.json")}),
                         scratch.path(name) + ": " + problem);
  for (const auto& [name, problem] : sources)
    if (file_suffix(name) == ".json")
      expect_clean_failure(run_program({"retarget", "--source", scratch.path("track"), "--target",
                                        scratch.path(name), "--out", out("a.json")}),
                           scratch.path(name) + ": " + problem);
}

TEST_F(FlatCommand, OptionsThatWouldDoNothingAreRefused) {
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--depth"},
                                                 {"--camera", "yaw=30"},
                                                 {"--rate", "10"},
                                                 {"--count", "5"},
                                                 {"--tempo", "2"},
                                                 {"--style", "old"},
                                                 {"--height", "1.8"},
                                                 {"--fov", "60"},
                                                 {"--pitch", "10"},
                                                 {"--hide-limbs"},
                                                 {"--remove-floor"},
                                                 {"--betas", "1"},
                                                 {"--preview", "p.png"}}) {
    std::vector<std::string> all = {"--out", out("a.json")};
    all.insert(all.end(), option.begin(), option.end());
    expect_clean_failure(perform(all), option[0] + ": has no meaning for 2D poses");
  }
  expect_clean_failure(perform({"--out", out("a.json"), "--format", "glb"}),
                       "--format glb: is of what moves");
  expect_clean_failure(run_program({"retarget", "--source", scratch.path("track"), "--target", target(),
                                    "--out", out("a.glb"), "--height", "1.8"}),
                       "--height: has no meaning for 2D poses, whose size is told by --stature");
  expect_clean_failure(retarget(scans(), {"--out", out("a.glb"), "--smoothing", "2"}),
                       "--smoothing: is of 2D poses");
  for (const char* option : {"--let-go", "--no-growth", "--no-look-ahead"})
    expect_clean_failure(run_program({"retarget", "--source", scratch.path("track"), "--target", target(),
                                      "--out", out("a.glb"), option}),
                         std::string(option) + ": is of 2D poses performed by somebody in a picture");
}

TEST_F(FlatCommand, ATrackIsLiftedOntoACharacterInSpace) {
  const auto lift = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"retarget", "--source", scratch.path("track"), "--target", target(),
                                          "--out",    out(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  };
  const Finished done = lift("a.bvh", {});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.err.find("lifted for a person of 1.7 m"), std::string::npos) << done.err;
  ASSERT_EQ(lift("b.bvh", {}).code, 0);
  EXPECT_EQ(read_file(out("a.bvh")), read_file(out("b.bvh")));
  const Finished tall = lift("c.bvh", {"--stature", "1.2", "--fov", "35"});
  ASSERT_EQ(tall.code, 0) << tall.err;
  EXPECT_NE(
      tall.err.find("a person of 1.2 m before a camera of 35 degrees that looks down as far as they tell"),
      std::string::npos);
  const Finished from_above = lift("d.bvh", {"--pitch", "15"});
  EXPECT_NE(from_above.err.find("that looks down by 15"), std::string::npos) << from_above.err;
  EXPECT_NE(read_file(out("d.bvh")), read_file(out("a.bvh")));
}

TEST_F(FlatCommand, TheSuiteLiftingIsMadeAndEvaluated) {
  const std::string data = scratch.path("data");
  test::write_training_folder(data);
  test::write_walk_clip(data + "/motion/a/walk_poses.npz");
  const std::string cases = scratch.path("cases"), report = out("report.json");
  const Finished made = run_program({"cases", data, "--suite", "lifting", "--cases", "2", "--frames", "10",
                                     "--split", "train", "--out", cases});
  ASSERT_EQ(made.code, 0) << made.err;
  const Finished done = run_program({"eval", cases, "--out", report});
  ASSERT_EQ(done.code, 0) << done.err;
  const Json mean = Json::parse(read_file(report))["mean"];
  EXPECT_LT(mean["n_mpjpe_mm"], 150);
  EXPECT_LT(mean["pa_mpjpe_mm"], mean["n_mpjpe_mm"]);
  for (const char* const key : {"swaps", "flips", "target_pa_mpjpe_m", "confidence_corr"})
    EXPECT_TRUE(mean.contains(key)) << key;
}

TEST_F(FlatCommand, ASuiteIsMadeAndEvaluated) {
  const std::string data = scratch.path("data");
  test::write_training_folder(data);
  test::write_walk_clip(data + "/motion/a/walk_poses.npz");
  const std::string cases = scratch.path("cases"), report = out("report.json");
  const Finished made = run_program({"cases", data, "--suite", "pose2d-seen", "--cases", "2", "--frames",
                                     "10", "--split", "train", "--out", cases});
  ASSERT_EQ(made.code, 0) << made.err;
  const Finished done = run_program({"eval", cases, "--out", report});
  ASSERT_EQ(done.code, 0) << done.err;
  const Json mean = Json::parse(read_file(report))["mean"];
  for (const char* const key : {"oks", "oks_touches", "bone_ratio", "jitter", "oks_copy", "oks_true"})
    EXPECT_TRUE(mean.contains(key)) << key;
  EXPECT_GT(mean["oks_true"], mean["oks_copy"]);
}

}  // namespace
}  // namespace understudy::tests
