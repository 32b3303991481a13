// What the studio sends of what it shows: when, and what becomes of a source that is lost.
#include "app/session/shown_pose_sender.hpp"

#include <gtest/gtest.h>

#include "retarget/math/rotation.hpp"
#include "tests/app/osc_receiver.hpp"

namespace understudy::app {
namespace {

/// One take of three frames in which an arm is bent more and more.
Session three_frames() {
  Session session;
  session.document.takes.resize(1);
  session.takes.resize(1);
  auto target = std::make_shared<Target>();
  for (int j = 0; j < kJointCount; ++j) target->joints.row(j) = Vec3(0.1f * static_cast<float>(j), 1, 0);
  session.takes[0].target = target;
  for (int t = 0; t < 3; ++t) {
    Pose pose;
    pose.local[LeftElbow] = rotation_from_axis_angle(Vec3(0, 0.5f * static_cast<float>(t), 0));
    session.takes[0].shown.poses.push_back(pose);
    session.takes[0].joints.push_back(forward_kinematics(target->joints, pose).joints);
    session.source.frames.push_back({});
  }
  session.playback.live = false;
  return session;
}

class ShownPoseSenderTest : public ::testing::Test {
 protected:
  bool push(double seconds) { return sender_.push(session_, seconds); }
  /// Of the arm below the elbow, as the receiver has it.
  Vec3 wrist() { return tests::joints_in(receiver_.heard()).at("left_wrist"); }

  tests::OscReceiver receiver_;
  ShownPoseSender sender_{PoseSender("osc://127.0.0.1:" + receiver_.port())};
  Session session_ = three_frames();
};

TEST_F(ShownPoseSenderTest, SendsAPoseOnceAndWhatStandsStillTenTimesASecond) {
  EXPECT_TRUE(push(0.01));
  EXPECT_FALSE(push(0.01));
  session_.playback.frame = 1;
  EXPECT_TRUE(push(0.01));
  int sent = 0;
  for (int i = 0; i < 100; ++i) sent += push(0.01) ? 1 : 0;
  EXPECT_NEAR(sent, 10, 1);
}

TEST_F(ShownPoseSenderTest, WithoutAPoseThatIsShownNothingIsSent) {
  session_.takes[0].shown.poses.clear();
  EXPECT_FALSE(push(1));
  session_.takes.clear();
  EXPECT_FALSE(push(1));
  EXPECT_TRUE(receiver_.heard().empty());
}

TEST_F(ShownPoseSenderTest, AFrameThatIsLookedAtIsSentAsItIsThoughTheSourceWasLostThere) {
  session_.source.frames.write(2, 3, [](size_t, KeptSource& source) { source.flagged = true; });
  session_.playback.frame = 2;
  push(0.01);
  const Vec3 bent = wrist();
  for (int i = 0; i < 50; ++i) push(0.1);
  EXPECT_LT((wrist() - bent).norm(), 1e-6f);
}

TEST_F(ShownPoseSenderTest, ALiveSourceThatIsLostBlendsToTheTPose) {
  session_.source.frames.write(2, 3, [](size_t, KeptSource& source) { source.flagged = true; });
  session_.playback.frame = 2;
  session_.playback.live = true;
  push(0.01);
  const Vec3 bent = wrist();
  for (int i = 0; i < 50; ++i) push(0.1);
  const Joints& rest = session_.takes[0].target->joints;
  const auto joints = tests::joints_in((push(0.1), receiver_.heard()));
  const Vec3 arm = joints.at("left_wrist") - joints.at("left_elbow");
  EXPECT_LT((arm - (rest.row(LeftWrist) - rest.row(LeftElbow)).transpose()).norm(), 1e-3f);
  EXPECT_GT((joints.at("left_wrist") - bent).norm(), 0.05f);
}

}  // namespace
}  // namespace understudy::app
