#include "retarget/editing/pose_loop.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/editing/pose_edits.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

struct LoopStage {
  Joints rest = builtin_person().joints;
  Motion walk = standing_told(builtin_motion("walk", rest));

  Motion standing_told(Motion motion) const {
    std::array<ContactSwitch, 2> contact;
    std::array<float, 2> lowest = {1, 1};
    for (const Pose& pose : motion.poses)
      for (int side = 0; side < 2; ++side)
        lowest[side] = std::min(lowest[side], forward_kinematics(rest, pose).joints(LeftFoot + side, 1));
    for (const Pose& pose : motion.poses) {
      const Joints joints = forward_kinematics(rest, pose).joints;
      Standing& standing = motion.standing.emplace_back();
      for (int side = 0; side < 2; ++side)
        standing[side] =
            contact[side].push(joints.row(LeftFoot + side).transpose(), lowest[side], 1 / motion.fps);
    }
    return motion;
  }
  int last() const { return static_cast<int>(ssize(walk.poses)) - 1; }
  /// Mean distance of joints between two frames, each seen from its own place and heading.
  float apart(const Motion& motion, int a, int b) const {
    return (seen(motion, a) - seen(motion, b)).rowwise().norm().mean();
  }
  Joints seen(const Motion& motion, int t) const {
    Pose pose = motion.poses[t];
    const Mat3 R = rotation_about_y(-heading_of(pose.local[Pelvis]));
    pose.root = Vec3(0, pose.root.y(), 0);
    pose.local[Pelvis] = R * pose.local[Pelvis];
    return forward_kinematics(rest, pose).joints;
  }
};

const LoopStage& loops() {
  static const LoopStage made;
  return made;
}

TEST(PoseLoop, OfAWalkIsAWholeNumberOfItsCycles) {
  const LoopEdit loop = find_loop(loops().walk, loops().rest, 0, loops().last());
  // A cycle is as long as it takes a foot to come down again.
  std::vector<int> comes_down;
  for (int t = 1; t <= loops().last(); ++t)
    if (loops().walk.standing[t][0] && !loops().walk.standing[t - 1][0]) comes_down.push_back(t);
  ASSERT_GE(comes_down.size(), 3u);
  const float cycle =
      static_cast<float>(comes_down.back() - comes_down[0]) / static_cast<float>(comes_down.size() - 1);
  const float cycles = static_cast<float>(loop.last - loop.first) / cycle;
  EXPECT_NEAR(cycles, std::round(cycles), 0.1f) << loop.first << " to " << loop.last;
  EXPECT_GE(std::round(cycles), 1);
  const LoopTravel travel = travel_of(loop, loops().walk);
  EXPECT_GT(travel.metres, 0.5f);
  EXPECT_NEAR(travel.turn_deg, 0, 5);
}

TEST(PoseLoop, EndsAsItBegins) {
  const LoopEdit loop = find_loop(loops().walk, loops().rest, 0, loops().last());
  Motion closed = loops().walk;
  close_loop(loop, loops().rest, nullptr, closed);
  EXPECT_LT(loops().apart(closed, loop.first, loop.last), 1e-4f);
  EXPECT_EQ(closed.standing[loop.first], closed.standing[loop.last]);
  // The last frames lead on as the first ones do: no step is longer than those of the walk.
  float longest = 0;
  for (int t = 1; t <= loops().last(); ++t)
    longest = std::max(longest, loops().apart(loops().walk, t - 1, t));
  const int seam = seam_frames(loop, closed.fps);
  ASSERT_EQ(seam, 6);
  for (int i = -seam; i <= seam; ++i) {
    const int t = i <= 0 ? loop.last + i : loop.first + i;
    EXPECT_LT(loops().apart(closed, t - (i == 0 ? 1 : 0), t - (i == 0 ? 0 : 1)), 1.25f * longest) << i;
  }
}

TEST(PoseLoop, LeavesAllOtherFramesAndTellsWhatItMade) {
  const LoopEdit loop = find_loop(loops().walk, loops().rest, 0, loops().last());
  Motion closed = loops().walk;
  close_loop(loop, loops().rest, nullptr, closed);
  ASSERT_EQ(closed.poses.size(), loops().walk.poses.size());
  for (int t = 0; t <= loops().last(); ++t) {
    const bool made = (t >= loop.first && t < loop.first + 6) || (t >= loop.last - 6 && t <= loop.last);
    const Pose &now = closed.poses[t], &was = loops().walk.poses[t];
    if (!made) EXPECT_TRUE(now.local == was.local && now.root == was.root) << t;
    EXPECT_EQ(closed.doubt_m[t] > 0, made) << t;
  }
}

TEST(PoseLoop, StandingFeetDoNotSlideOverTheSeam) {
  const LoopEdit loop = find_loop(loops().walk, loops().rest, 0, loops().last());
  Motion closed = loops().walk;
  close_loop(loop, loops().rest, nullptr, closed);
  for (int t = 1; t <= loops().last(); ++t) {
    const bool near = std::abs(t - loop.first) <= 6 || std::abs(t - loop.last) <= 6;
    if (!near || t == loop.first || t == loop.last + 1) continue;  // the seam itself is no step
    const Joints now = forward_kinematics(loops().rest, closed.poses[t]).joints,
                 was = forward_kinematics(loops().rest, closed.poses[t - 1]).joints;
    for (int side = 0; side < 2; ++side)
      if (closed.standing[t][side] && closed.standing[t - 1][side])
        EXPECT_LT((now.row(LeftFoot + side) - was.row(LeftFoot + side)).norm() * closed.fps, 0.35f)
            << "foot " << side << " in frame " << t;
  }
}

TEST(PoseLoop, IsFoundTheSameHoweverTheMotionLies) {
  const LoopEdit loop = find_loop(loops().walk, loops().rest, 0, loops().last());
  Motion turned = loops().walk;
  const Mat3 R = rotation_about_y(2);
  for (Pose& pose : turned.poses)
    pose.root = R * pose.root + Vec3(3, 0, -1), pose.local[Pelvis] = R * pose.local[Pelvis];
  const LoopEdit other = find_loop(turned, loops().rest, 0, loops().last());
  EXPECT_EQ(other.first, loop.first);
  EXPECT_EQ(other.last, loop.last);
  Motion fast = builtin_motion("walk", loops().rest, 90);
  const LoopEdit at_90 = find_loop(fast, loops().rest, 0, static_cast<int>(ssize(fast.poses)) - 1);
  EXPECT_NEAR(static_cast<float>(at_90.last - at_90.first) / 3, static_cast<float>(loop.last - loop.first),
              1.5f);
}

TEST(PoseLoop, TurnsAlongWhereTheMotionTurns) {
  Motion circle = loops().walk;  // the walk around a corner
  for (size_t t = 0; t < circle.poses.size(); ++t) {
    const Mat3 R = rotation_about_y(0.02f * static_cast<float>(t));
    Pose& pose = circle.poses[t];
    pose.local[Pelvis] = R * pose.local[Pelvis];
    if (t > 0)
      pose.root =
          circle.poses[t - 1].root + R * (loops().walk.poses[t].root - loops().walk.poses[t - 1].root);
  }
  circle.standing.clear();
  const LoopEdit loop = find_loop(circle, loops().rest, 0, loops().last());
  const LoopTravel travel = travel_of(loop, circle);
  EXPECT_NEAR(travel.turn_deg, 0.02f * static_cast<float>(loop.last - loop.first) * 180 / kPi, 3);
  close_loop(loop, loops().rest, nullptr, circle);
  EXPECT_NEAR(travel_of(loop, circle).turn_deg, travel.turn_deg, 1e-2f);
  EXPECT_LT(loops().apart(circle, loop.first, loop.last), 1e-4f);
}

TEST(PoseLoop, OfUnlikeMomentsIsNoneAndItIsSaid) {
  Motion bow;  // ever deeper: no moment is like another
  bow.poses.resize(40);
  for (int t = 0; t < 40; ++t)
    for (const int joint : {LeftHip, RightHip, Spine1, LeftShoulder, RightShoulder})
      bow.poses[t].local[joint] = rotation_from_axis_angle({0.05f * static_cast<float>(t), 0, 0});
  EXPECT_EQ(failure_of([&] { find_loop(bow, loops().rest, 0, 39); }),
            "no two moments of frames 0 to 39 are alike: there is no loop in them");
  EXPECT_EQ(failure_of([&] { find_loop(loops().walk, loops().rest, 3, 9); }),
            "no two moments of frames 3 to 9 are alike: there is no loop in them")
      << "too short";
  EXPECT_THROW(find_loop(bow, loops().rest, 0, 40), Error);
  EXPECT_THROW(find_loop(bow, loops().rest, -1, 20), Error);
  EXPECT_THROW(close_loop({0, 3}, loops().rest, nullptr, bow), Error);
  EXPECT_THROW(close_loop({10, 40}, loops().rest, nullptr, bow), Error);
  EXPECT_THROW(close_loop({-2, 20}, loops().rest, nullptr, bow), Error);
}

TEST(PoseLoop, IsNotMadeOfStandingStillWhereThePersonWalks) {
  Motion waits = loops().walk;
  waits.standing.clear();
  waits.poses.insert(waits.poses.begin(), 60, Pose(waits.poses[0]));
  const LoopEdit loop = find_loop(waits, loops().rest, 0, static_cast<int>(ssize(waits.poses)) - 1);
  EXPECT_GT(travel_of(loop, waits).metres, 0.3f) << loop.first << " to " << loop.last;
  Motion still;  // where nothing moves anything is a loop
  still.poses.resize(60);
  EXPECT_NO_THROW(find_loop(still, loops().rest, 0, 59));
}

TEST(PoseLoop, IsTheLastOfTheEdits) {
  PoseEdits edits;
  edits.loop = find_loop(loops().walk, loops().rest, 0, loops().last());
  edits.smooth = SmoothEdit{0.5f};
  edits.rotate = {{edits.loop->first + 2, LeftElbow, Vec3(0.5f, 0, 0), 5}};
  edits.turn = TurnEdit{30};
  const Motion made = apply_poses(edits, loops().walk, {loops().rest, {}});
  EXPECT_LT(loops().apart(made, edits.loop->first, edits.loop->last), 1e-4f);
  edits.loop->last = loops().last() + 1;
  EXPECT_TRUE(apply_poses(edits, loops().walk, {loops().rest, {}}).doubt_m.empty()) << "may still be made";
}

}  // namespace
}  // namespace understudy
