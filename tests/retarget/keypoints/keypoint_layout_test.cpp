#include "retarget/keypoints/keypoint_layout.hpp"

#include "tests/retarget/keypoints/support.hpp"

namespace understudy {
namespace {

using namespace test;

/// K rows whose x is their number.
FlatPoints numbered(const KeypointLayout& layout) {
  FlatPoints points(layout.count(), 3);
  for (int i = 0; i < layout.count(); ++i) points.row(i) << static_cast<float>(i + 1), 1, 1;
  return points;
}
int source_of(const char* layout, int point) {
  const KeypointLayout& row = *layout_named(layout);
  return static_cast<int>(pose_of_layout(row, numbered(row)).at(point).x()) - 1;
}

TEST(KeypointLayout, RowsHaveAsManyPointsAsTheirNamesSay) {
  for (const KeypointLayout& layout : keypoint_layouts()) {
    const size_t digits = layout.name.find_first_of("0123456789");
    EXPECT_EQ(layout.count(), std::stoi(layout.name.substr(digits))) << layout.name;
    EXPECT_EQ(layout_named(layout.label == "BODY_25's first 15" ? "body15" : layout.name), &layout);
  }
}

TEST(KeypointLayout, PointsAreWhereTheProducersDocumentsHaveThem) {
  using namespace body25;
  EXPECT_EQ(source_of("coco17", LeftAnkle), 15);
  EXPECT_EQ(source_of("openpose18", RightHip), 8);
  EXPECT_EQ(source_of("openpose18", LeftEar), 17);
  EXPECT_EQ(source_of("halpe26", LeftBigToe), 20);
  EXPECT_EQ(source_of("halpe26", RightBigToe), 21);
  EXPECT_EQ(source_of("halpe26", RightHeel), 25);
  EXPECT_EQ(source_of("halpe26", Neck), 18);
  EXPECT_EQ(source_of("wholebody133", RightHeel), 22);
  EXPECT_EQ(source_of("mediapipe33", RightBigToe), 32);
  EXPECT_EQ(source_of("mediapipe33", LeftEye), 2);
  EXPECT_EQ(source_of("mpi15", LeftAnkle), 13);
  EXPECT_EQ(source_of("body15", LeftAnkle), 14);
}

TEST(KeypointLayout, HandsAndFaceAreSpans) {
  const KeypointLayout& row = *layout_named("wholebody133");
  const FlatPose pose = pose_of_layout(row, numbered(row));
  ASSERT_EQ(pose.left_hand.rows(), kHandPoints);
  EXPECT_EQ(pose.left_hand(0, 0), 92);
  EXPECT_EQ(pose.right_hand(20, 0), 133);
  EXPECT_EQ(pose.face(0, 0), 24);
  EXPECT_EQ(pose.face(67, 0), 91);
  EXPECT_EQ(pose.face(68, 2), 0) << "COCO has no pupils";
  EXPECT_EQ(pose_of_layout(*layout_named("halpe136"), numbered(*layout_named("halpe136"))).left_hand(0, 0),
            95);
}

TEST(KeypointLayout, NeckAndMidHipAreTheMiddlesWithTheLowerConfidence) {
  FlatPoints points = FlatPoints::Zero(17, 3);
  points.row(5) << 10, 20, 0.5f;
  points.row(6) << 30, 40, 0.25f;
  points.row(11) << 5, 5, 1;
  const FlatPose pose = pose_of_layout(*layout_named("COCO-17"), points);
  EXPECT_EQ(pose.at(body25::Neck), Vec2(20, 30));
  EXPECT_EQ(pose.confidence(body25::Neck), 0.25f);
  EXPECT_FALSE(pose.has(body25::MidHip)) << "one hip is missing";
}

TEST(KeypointLayout, ThereAndBackKeepsWhatTheLayoutHas) {
  const FlatPose pose = with_hands_and_face(standing({300, 400}, 300));
  for (const KeypointLayout& layout : keypoint_layouts()) {
    const FlatPose back = pose_of_layout(layout, points_in_layout(layout, pose));
    for (int p = 0; p < kBodyPoints; ++p)
      if (layout.body[static_cast<size_t>(p)] >= 0) {
        EXPECT_EQ(back.at(p), pose.at(p)) << layout.name;
      }
  }
  EXPECT_EQ(
      pose_of_layout(*layout_named("openpose137"), points_in_layout(*layout_named("openpose137"), pose)),
      pose);
}

TEST(KeypointLayout, SidesAreExchangedTwiceToNothing) {
  const FlatPose pose = with_hands_and_face(standing({300, 400}, 300));
  EXPECT_NE(sides_exchanged(pose), pose);
  EXPECT_EQ(sides_exchanged(sides_exchanged(pose)), pose);
  for (const KeypointLayout& layout : keypoint_layouts()) {
    const std::vector<int> mirror = mirrored_points(layout);
    for (size_t i = 0; i < mirror.size(); ++i)
      EXPECT_EQ(mirror[static_cast<size_t>(mirror[i])], static_cast<int>(i));
  }
  EXPECT_EQ(mirrored_points(*layout_named("coco17"))[9], 10);
}

TEST(KeypointLayout, IsFoundByOthersNames) {
  std::vector<std::string> names;
  for (const std::string& name : layout_named("coco17")->points) names.push_back(name);
  EXPECT_EQ(layout_of_names(names, "x").label, "COCO-17");
  EXPECT_EQ(
      layout_of_names({"Nose", "LEye", "REye", "LEar", "REar", "LShoulder", "RShoulder", "LElbow", "RElbow",
                       "LWrist", "RWrist", "LHip", "RHip", "LKnee", "RKnee", "LAnkle", "RAnkle"},
                      "x")
          .label,
      "COCO-17");
  std::reverse(names.begin(), names.end());
  const KeypointLayout other = layout_of_names(names, "x");
  EXPECT_EQ(other.body[body25::LeftAnkle], 1);
  EXPECT_EQ(other.body[body25::RightAnkle], 0);
  EXPECT_EQ(error_of([] {
              layout_of_names({"a", "b"}, "x.json");
            }),
            "x.json: unknown layout, none of its 2 points is called right_shoulder");
}

}  // namespace
}  // namespace understudy
