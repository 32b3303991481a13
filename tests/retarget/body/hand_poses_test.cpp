#include "retarget/body/hand_poses.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;

constexpr int kSkin = kHandJoints;  // first of the five vertices at the fingertips, one a finger
constexpr int kHandSize = kHandJoints + kFingers;  // vertices
constexpr int kBefore = 3;                         // vertices of the body before its hands

/// A left hand along +x, its back up: joints 3 cm apart, straight fingers 2 cm apart, the index in front
/// (+z).
Points straight_hand() {
  Points hand(kHandSize, 3);
  hand.row(0) << 0, 0, 0;
  for (int f = 0; f < kFingers; ++f)
    for (int l = 0; l < 5; ++l)
      hand.row(1 + 5 * f + l) << 0.05f + 0.03f * static_cast<float>(l), 0,
          0.05f - 0.02f * static_cast<float>(f);
  for (int f = 0; f < kFingers; ++f) hand.row(kSkin + f) = hand.row(1 + 5 * f + 4);
  return hand;
}

/// The body: a few vertices, the left hand, the right one in the mirror.
Points straight_body() {
  const Points hand = straight_hand();
  Points body(kBefore + 2 * kHandSize, 3);
  body.topRows(kBefore).setConstant(-1);
  body.middleRows(kBefore, kHandSize) = hand;
  body.bottomRows(kHandSize) = hand * Vec3(-1, 1, 1).asDiagonal();
  return body;
}

RowMatrix body_weights() {
  RowMatrix weights = RowMatrix::Zero(kBefore + 2 * kHandSize, kJointCount);
  weights.topRows(kBefore).col(Pelvis).setOnes();
  weights.middleRows(kBefore, kHandSize).col(LeftWrist).setOnes();
  weights.bottomRows(kHandSize).col(RightWrist).setOnes();
  for (int i = 0; i < 2 * kHandSize; ++i)  // so that each vertex is told from its neighbours
    weights.row(kBefore + i) *= 1 - 0.01f * static_cast<float>(i % 7);
  return weights;
}

Npz hand_file() {
  Npz npz;
  std::vector<float> left, right, weights(kHandSize * kFingers * kFingerBones, 0),
      joints(kHandJoints * kHandSize, 0);
  for (int i = 0; i < kHandSize; ++i) {
    left.push_back(static_cast<float>(kBefore + i));
    right.push_back(static_cast<float>(kBefore + kHandSize + i));
  }
  for (int j = 0; j < kHandJoints; ++j) joints[j * kHandSize + j] = 1;
  // Fingertips follow the last bone wholly; the thumb has one bone less.
  for (int f = 0; f < kFingers; ++f)
    weights[((kSkin + f) * kFingers + f) * kFingerBones + (f == 0 ? 2 : 3)] = 1;
  std::vector<float> poses(2 * kHandAngles, 0);
  for (int f = 1; f < kFingers; ++f) poses[kHandAngles + 1 + 5 * f + 2] = 90;  // knuckles
  npz["left_idx"] = {{kHandSize}, left, ""};
  npz["right_idx"] = {{kHandSize}, right, ""};
  npz["weights"] = {{kHandSize, kFingers, kFingerBones}, weights, ""};
  npz["joint_reg"] = {{kHandJoints, kHandSize}, joints, ""};
  npz["pose_angles"] = {{2, kHandAngles}, poses, ""};
  npz["dof_lo"] = {{kHandAngles}, std::vector<float>(kHandAngles, -20), ""};
  npz["dof_hi"] = {{kHandAngles}, std::vector<float>(kHandAngles, 60), ""};
  npz["thumb_nail"] = {{3}, {0, 0, 1}, ""};
  npz["finger_roll"] = {{kFingers}, {0, 0, 0, 0, 0}, ""};
  return npz;
}

class HandPosesTest : public testing::Test {
 protected:
  void SetUp() override {
    path_ = (fs::temp_directory_path() / ("understudy_hands_" + std::to_string(getpid()) + ".npz")).string();
  }
  void TearDown() override { fs::remove(path_); }
  HandPoses read(const Npz& npz) const {
    write_npz(path_, npz);
    return HandPoses(path_);
  }

  std::string path_;
};

TEST_F(HandPosesTest, AFingertipTurnsAboutItsKnuckleTowardsThePalm) {
  const HandPoses poses = read(hand_file());
  const HandVertices hands = poses.vertices_of(body_weights(), body_weights());
  ASSERT_FALSE(hands.empty());
  const Points rest = straight_body(),
               bent = poses.apply(rest, hands, {poses.poses()[1], HandAngles::Zero()});
  for (int f = 1; f < kFingers; ++f) {  // from the knuckle at 8 cm to the tip at 17
    const Vec3 tip = bent.row(kBefore + kSkin + f).transpose();
    EXPECT_LT((tip - Vec3(0.08f, -0.09f, 0.05f - 0.02f * static_cast<float>(f))).norm(), 1e-5f) << f;
  }
  EXPECT_EQ(bent.row(kBefore + kSkin), rest.row(kBefore + kSkin));  // the thumb
  EXPECT_EQ(bent.topRows(kBefore), rest.topRows(kBefore));
  EXPECT_EQ(bent.bottomRows(kHandSize), rest.bottomRows(kHandSize));
}

TEST_F(HandPosesTest, JointsOfAFingerBendOneAfterTheOther) {
  const HandPoses poses = read(hand_file());
  const HandVertices hands = poses.vertices_of(body_weights(), body_weights());
  HandAngles angles = HandAngles::Zero();
  for (int joint = 2; joint < 5; ++joint) angles[11 + joint] = 90;  // of the middle finger: a square
  const Points bent = poses.apply(straight_body(), hands, {angles, angles});
  // From the knuckle at 8 cm down 3 cm, back 3 cm, up 3 cm.
  EXPECT_LT((bent.row(kBefore + kSkin + 2) - Eigen::RowVector3f(0.05f, 0, 0.01f)).norm(), 1e-5f);
}

TEST_F(HandPosesTest, ARightHandIsTheMirrorImageOfALeftOne) {
  const HandPoses poses = read(hand_file());
  const HandVertices hands = poses.vertices_of(body_weights(), body_weights());
  Rng rng(3);
  HandAngles angles;
  for (float& x : angles) x = rng.uniform(-20, 60);
  const Points bent = poses.apply(straight_body(), hands, {angles, angles});
  const Points right = bent.bottomRows(kHandSize) * Vec3(-1, 1, 1).asDiagonal();
  EXPECT_LT((bent.middleRows(kBefore, kHandSize) - right).cwiseAbs().maxCoeff(), 1e-6f);
  EXPECT_GT((bent - straight_body()).cwiseAbs().maxCoeff(), 0.02f);
}

TEST_F(HandPosesTest, AFlatHandStaysAsItIs) {
  const HandPoses poses = read(hand_file());
  const HandVertices hands = poses.vertices_of(body_weights(), body_weights());
  const Points rest = straight_body();
  EXPECT_EQ(poses.apply(rest, hands, {HandAngles::Zero(), HandAngles::Zero()}), rest);
  EXPECT_EQ(poses.apply(rest, {}, {poses.poses()[1], poses.poses()[1]}), rest);  // no hands known
}

TEST_F(HandPosesTest, HandsOfADressedPersonAreFoundAmongOtherVertices) {
  const HandPoses poses = read(hand_file());
  const RowMatrix body = body_weights();
  RowMatrix dressed = RowMatrix::Zero(body.rows() + 3, kJointCount);  // skin is missing, clothes are added
  dressed.middleRows(1, body.rows() - kBefore) = body.bottomRows(body.rows() - kBefore);
  dressed.bottomRows(3).col(LeftWrist).setOnes();  // a cuff, behind the body's own vertices
  const HandVertices hands = poses.vertices_of(body, dressed);
  ASSERT_FALSE(hands.empty());
  EXPECT_EQ(hands.rows[0].front(), 1);
  EXPECT_EQ(hands.rows[1].back(), 2 * kHandSize);
  EXPECT_EQ(hands.place[1], 0);
  EXPECT_EQ(hands.place[1 + kHandSize], kHandSize);
  EXPECT_EQ(hands.place[0], -1);
  dressed(5, LeftWrist) = 0.2f;  // no longer those of the body
  EXPECT_TRUE(poses.vertices_of(body, dressed).empty());
}

TEST_F(HandPosesTest, SamplesAreWithinTheLimitsAndTheSameForASeed) {
  const HandPoses poses = read(hand_file());
  Rng a(4), b(4), c(5);
  float widest = 0;
  for (int i = 0; i < 200; ++i) {
    const HandAngles drawn = poses.sample(a);
    EXPECT_EQ(drawn, poses.sample(b));
    widest = std::max(widest, (drawn - poses.sample(c)).cwiseAbs().maxCoeff());
    EXPECT_GE(drawn.minCoeff(), -20);
    EXPECT_LE(drawn.maxCoeff(), 60);
  }
  EXPECT_GT(widest, 30);
}

TEST_F(HandPosesTest, SpheresThatMeetAreAnOverlap) {
  Npz npz = hand_file();
  const Points hand = straight_hand();
  std::vector<float> centres;
  for (const int f : {1, 2})
    for (int axis = 0; axis < 3; ++axis) centres.push_back(hand(1 + 5 * f + 4, axis));
  npz["template_joints"] = {{kHandJoints, 3}, {hand.data(), hand.data() + 3 * kHandJoints}, ""};
  npz["sph_finger"] = {{2}, {1, 2}, ""};
  npz["sph_level"] = {{2}, {3, 3}, ""};
  npz["sph_centre"] = {{2, 3}, centres, ""};
  npz["sph_r"] = {{2}, {0.008f, 0.008f}, ""};
  npz["sph_pairs"] = {{1, 2}, {0, 1}, ""};
  npz["sph_rest"] = {{1}, {0}, ""};
  const HandPoses poses = read(npz);
  EXPECT_NEAR(poses.overlap(HandAngles::Zero()), -0.004f, 1e-6f);  // 2 cm apart, 8 mm each
  HandAngles crossed = HandAngles::Zero();
  crossed[7] = -10;  // the index spread to the middle finger: 9 cm by 10 degrees
  EXPECT_NEAR(poses.overlap(crossed), 0.016f - (0.02f - 0.09f * std::sin(10 * kPi / 180)), 1e-3f);
}

TEST_F(HandPosesTest, AFileThatDoesNotFitIsOneSentence) {
  EXPECT_THROW(HandPoses(path_ + ".none"), Error);
  for (const char* array : {"left_idx", "weights", "joint_reg", "pose_angles", "dof_lo", "thumb_nail"}) {
    Npz npz = hand_file();
    npz[array].values.pop_back();
    npz[array].shape = {static_cast<int64_t>(npz[array].values.size())};
    EXPECT_THROW(read(npz), Error) << array;
  }
  const HandPoses poses = read(hand_file());
  EXPECT_THROW(poses.pose("fist"), Error);
  const RowMatrix few = body_weights().topRows(kHandSize);
  EXPECT_THROW(poses.vertices_of(few, few), Error);
}

}  // namespace
}  // namespace understudy
