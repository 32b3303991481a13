#include "retarget/keypoints/keypoint_writers.hpp"

#include "retarget/base/file.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/retarget/keypoints/support.hpp"
#include "tests/support/full_disk.hpp"

namespace understudy {
namespace {

using namespace test;

/// Three people, of whom one comes late and one is hidden for a while; one with hands and face.
KeypointReading three_people() {
  std::vector<std::vector<FlatPose>> people(3);
  for (int t = 0; t < 12; ++t) {
    const float x = 100 + 2.5f * static_cast<float>(t);
    people[0].push_back(with_hands_and_face(standing({x, 400.125f}, 300.1f, 0.7f)));
    people[1].push_back(t < 4 ? FlatPose() : standing({x + 200, 390}, 200, 1));
    people[2].push_back(t == 6 || t == 7 ? FlatPose() : standing({x + 400, 390}, 250.5f, 0.3f));
  }
  return reading_of(people);
}

/// The same people in the same frames, each as it is after the layout.
void expect_same_people(const KeypointReading& back, const KeypointReading& sent, const char* layout) {
  const KeypointLayout& row = *layout_named(layout);
  ASSERT_EQ(back.tracks.size(), sent.tracks.size());
  for (const KeypointTrack& track : sent.tracks) {
    ASSERT_GE(back.track_of(track.person), 0);
    const KeypointTrack& again = back.tracks[static_cast<size_t>(back.track_of(track.person))];
    ASSERT_EQ(again.poses.size(), track.poses.size());
    for (size_t i = 0; i < track.poses.size(); ++i) {
      EXPECT_EQ(again.poses[i].frame, track.poses[i].frame);
      const FlatPose expected = pose_of_layout(row, points_in_layout(row, track.poses[i].pose));
      EXPECT_LT(farthest_apart(again.poses[i].pose, expected), 1e-3f);
    }
  }
}

class KeypointWriters : public testing::Test {
 protected:
  TempFolder folder;
  KeypointReading sent = three_people();
};

TEST_F(KeypointWriters, OpenPoseFoldersLoseNothing) {
  write_openpose_folder(folder.path("walk"), sent);
  EXPECT_TRUE(std::filesystem::exists(folder.path("walk/walk_000000000011_keypoints.json")));
  const KeypointReading back = read_keypoints(folder.path("walk"));
  expect_same_people(back, sent, "body25");
  const KeypointTrack& anna = back.tracks[static_cast<size_t>(back.track_of(1))];
  EXPECT_EQ(anna.poses[5].pose, sent.tracks[0].poses[5].pose) << "to the last bit";
  write_openpose_folder(folder.path("walk"), sent);  // over its own
  EXPECT_EQ(openpose_json(sent, 3), read_file(folder.path("walk/walk_000000000003_keypoints.json")));
}

TEST_F(KeypointWriters, ControlNetListsShowPointsWithConfidenceExactly1) {
  write_controlnet(folder.path("c.json"), sent);
  const KeypointReading back = read_keypoints(folder.path("c.json"));
  expect_same_people(back, sent, "openpose18");
  EXPECT_EQ(back.canvas, sent.canvas);
  const std::string text = read_file(folder.path("c.json"));
  const Json json = Json::parse(text);
  for (const Json& frame : json)
    for (const Json& person : frame["people"])
      for (size_t i = 2; i < person["pose_keypoints_2d"].size(); i += 3)
        EXPECT_TRUE(person["pose_keypoints_2d"][i] == 1.0 || person["pose_keypoints_2d"][i] == 0);
  EXPECT_TRUE(contains(text, ",1.0,"));
  EXPECT_EQ(back.tracks[0].poses[0].pose.left_hand.rows(), kHandPoints);
}

TEST_F(KeypointWriters, CocoResultsLoseNobody) {
  write_coco_results(folder.path("r.json"), sent);
  const KeypointReading back = read_keypoints(folder.path("r.json"));
  expect_same_people(back, sent, "coco17");
}

TEST_F(KeypointWriters, ArraysLoseNothing) {
  sent.fps = 24;
  write_keypoint_npz(folder.path("p.npz"), sent);
  const KeypointReading back = read_keypoints(folder.path("p.npz"));
  expect_same_people(back, sent, "openpose137");
  EXPECT_EQ(back.fps, 24);
  EXPECT_EQ(back.canvas, sent.canvas);
  EXPECT_EQ(back.tracks[0].poses[5].pose, sent.tracks[0].poses[5].pose) << "to the last bit";
  EXPECT_EQ(read_npz(folder.path("p.npz")).at("keypoints").shape, (std::vector<int64_t>{12, 3, 137, 3}));
}

TEST_F(KeypointWriters, TablesHaveALineAPersonAndFrame) {
  sent.tracks[1].poses[0].pose.forget(body25::Nose);
  write_keypoint_csv(folder.path("p.csv"), sent);
  std::ifstream file(folder.path("p.csv"));
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line.substr(0, 47), "frame,seconds,person,nose_x,nose_y,nose_c,neck_");
  const auto commas = std::count(line.begin(), line.end(), ',');
  int lines = 0;
  bool found = false;
  while (std::getline(file, line)) {
    ++lines;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas);
    found |= line.rfind("4,0.133333,2,,,,", 0) == 0;
  }
  EXPECT_EQ(lines, 12 + 8 + 10);
  EXPECT_TRUE(found) << "what is missing is empty";
}

TEST_F(KeypointWriters, TheSamePeopleGiveTheSameBytes) {
  for (const char* name : {"a", "b"}) {
    write_controlnet(folder.path(std::string(name) + ".json"), sent);
    write_keypoint_npz(folder.path(std::string(name) + ".npz"), sent);
  }
  EXPECT_EQ(read_file(folder.path("a.json")), read_file(folder.path("b.json")));
  EXPECT_EQ(read_file(folder.path("a.npz")), read_file(folder.path("b.npz")));
}

TEST_F(KeypointWriters, AFullDiskLeavesTheOldFile) {
  const std::string path = folder.write("c.json", "old");
  const FullDisk disk(2000);
  EXPECT_TRUE(contains(error_of([&] { write_controlnet(path, sent); }), path + ": cannot be written"));
  EXPECT_TRUE(
      contains(error_of([&] { write_openpose_folder(folder.path("walk"), sent); }), "cannot be written"));
  EXPECT_EQ(read_file(path), "old");
  EXPECT_FALSE(std::filesystem::exists(folder.path("walk")));
}

TEST_F(KeypointWriters, WithoutFramesThereIsNothingToWrite) {
  sent.frames.clear();
  EXPECT_TRUE(
      contains(error_of([&] { write_coco_results(folder.path("r.json"), sent); }), "there are no frames"));
}

}  // namespace
}  // namespace understudy
