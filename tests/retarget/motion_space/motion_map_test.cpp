// The map of steps: places, neighbours, what lies between, and what is far from anything known.
#include "retarget/motion_space/motion_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "tests/support/made_map.hpp"
#include "tests/support/plain_coder.hpp"

namespace understudy {
namespace {

using tests::made_motions;

MotionMap made_map(int motions = 20, int steps = 4) {
  return MotionMap(made_motions(motions, steps));
}

TEST(CodedSteps, OfAWalkAreAsLongAndFastAsItIs) {
  const Joints rest = builtin_joints();
  const Motion walk = builtin_motion("walk", rest);
  tests::PlainCoder coder;
  const auto steps = coded_steps(walk, rest, coder);
  ASSERT_GE(steps.size(), 4u);
  for (const MappedStep& step : steps) {
    EXPECT_NEAR(step.seconds, 1.14f, 0.05f);
    const Vec3 way =
        walk.poses[static_cast<size_t>(step.last)].root - walk.poses[static_cast<size_t>(step.first)].root;
    EXPECT_NEAR(step.speed_m_s, std::hypot(way.x(), way.z()) / step.seconds, 1e-4f);
    EXPECT_EQ(static_cast<int>(step.code.size()), coder.size());
  }
}

TEST(CodedSteps, AreShownAsTheyWere) {
  const Joints rest = builtin_joints();
  const Motion walk = builtin_motion("walk", rest);
  tests::PlainCoder coder;
  const MappedStep step = coded_steps(walk, rest, coder).at(1);
  const TimedPoses movement = movement_of(walk, step.first, step.last);
  for (int i = 0; i <= 40; ++i) {
    const float at = 0.999f * step.seconds * static_cast<float>(i) / 40;
    const Joints seen = figure_at(step, rest, at, /*in_place=*/false);
    const Joints truth = forward_kinematics(rest, pose_at(movement, at)).joints;
    EXPECT_LT((seen - truth).rowwise().norm().maxCoeff(), 0.06f) << "at " << at;
    EXPECT_LT((figure_at(step, rest, at + step.seconds, false) - seen).norm(), 1e-3f) << "it begins again";
    const Joints in_place = figure_at(step, rest, at, true);
    EXPECT_NEAR(in_place(Pelvis, 0), 0, 1e-6f);
    EXPECT_NEAR(in_place(Pelvis, 2), 0, 1e-6f);
    EXPECT_NEAR(in_place(Pelvis, 1), seen(Pelvis, 1), 1e-6f);
  }
}

TEST(CodedSteps, CanBePerformedAsTheyWere) {
  const Joints rest = builtin_joints();
  const Motion walk = builtin_motion("walk", rest);
  tests::PlainCoder coder;
  const MappedStep step = coded_steps(walk, rest, coder).at(1);
  const TimedPoses movement = movement_of(walk, step.first, step.last);
  const Motion kept = motion_of(step);
  EXPECT_NEAR(static_cast<float>(kept.poses.size() - 1) / kept.fps, step.seconds, 1e-4f);
  for (size_t t = 0; t < kept.poses.size(); ++t) {
    const Joints truth = forward_kinematics(rest, pose_at(movement, static_cast<float>(t) / kept.fps)).joints;
    EXPECT_LT((forward_kinematics(rest, kept.poses[t]).joints - truth).rowwise().norm().maxCoeff(), 0.04f)
        << t;
  }
}

/// Stands for some seconds, then walks, then stands.
Motion walk_between_rests(int still) {
  Motion motion = builtin_motion("walk", builtin_joints());
  motion.poses.insert(motion.poses.begin(), static_cast<size_t>(still), motion.poses.front());
  motion.poses.insert(motion.poses.end(), static_cast<size_t>(still), motion.poses.back());
  return motion;
}

TEST(CodedMovements, AreWhatIsInNoStep) {
  const Joints rest = builtin_joints();
  Motion motion = walk_between_rests(100);
  tests::PlainCoder coder;
  const auto steps = coded_steps(motion, rest, coder);
  const auto others = coded_movements(motion, steps, rest, coder);
  ASSERT_GE(others.size(), 4u) << "two before and two after the walk";
  for (const MappedStep& other : others) {
    EXPECT_GT(other.seconds, 1.0f);
    EXPECT_LE(other.seconds, 3.0f);
    for (const MappedStep& step : steps) EXPECT_TRUE(other.last < step.first || step.last < other.first);
  }
  EXPECT_EQ(others.front().first, 0);
  motion.flags.assign(motion.poses.size(), 0);
  for (size_t t = 0; t < 100; ++t) motion.flags[t] = 1;
  EXPECT_GE(coded_movements(motion, coded_steps(motion, rest, coder), rest, coder).front().first, 100)
      << "no flagged frames";
}

TEST(CodedStretches, AreOfAboutTwoSecondsAndNoneOfHardlyAnything) {
  const Motion motion = walk_between_rests(0);
  tests::PlainCoder coder;
  const Joints rest = builtin_joints();
  const auto stretches = coded_stretches(motion, rest, coder, 3, 139);
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_EQ(stretches[0].first, 3);
  EXPECT_EQ(stretches[0].last, stretches[1].first);
  EXPECT_EQ(stretches[1].last, 139);
  EXPECT_TRUE(coded_stretches(motion, rest, coder, 3, 9).empty());
}

TEST(MotionMap, GivesTheSamePlacesToTheBit) {
  const MotionMap a = made_map(), b = made_map();
  for (int i = 0; i < a.size(); ++i) EXPECT_EQ(a.place(i), b.place(i));
  EXPECT_EQ(a.neighbour_distance(), b.neighbour_distance());
}

TEST(MotionMap, AxesDoNotTurnWhenFilesComeInAnotherOrder) {
  auto motions = made_motions(20, 4);
  const MotionMap a(motions);
  std::reverse(motions.begin(), motions.end());
  const MotionMap b(motions);
  for (int m = 0; m < 20; ++m) EXPECT_LT((a.place(4 * m) - b.place(4 * (19 - m))).norm(), 1e-4f) << m;
}

TEST(MotionMap, AxesAreThoseAlongWhichCodesDifferMost) {
  auto motions = made_motions(3, 5, 6);
  float along = 0;
  for (auto& motion : motions)
    for (auto& step : motion.steps) {
      step.code.assign(6, 0);
      step.code[4] = 10 * (along += 1);
      step.code[1] = std::fmod(along * 7, 5.0f);
    }
  const MotionMap map(motions);
  EXPECT_NEAR(map.place(1).x() - map.place(0).x(), 10, 0.1f) << "grows with the code";
  EXPECT_GT(map.shares()[0], 0.98f);
  EXPECT_LT(map.shares()[0] + map.shares()[1], 1 + 1e-5f);
}

TEST(MotionMap, TheNearestOfAStepAreItselfAndThoseOfItsKind) {
  const MotionMap map = made_map();
  const auto near = map.nearest({map.step(9).code}, 6);
  ASSERT_EQ(near.size(), 6u);
  EXPECT_EQ(near[0].step, 9);
  EXPECT_EQ(near[0].distance, 0);
  for (size_t i = 1; i < near.size(); ++i) {
    EXPECT_GE(near[i].distance, near[i - 1].distance);
    EXPECT_EQ(map.motion_of(near[i].step).action, map.motion_of(9).action);
  }
  const auto others = map.nearest({map.step(9).code}, 3, [](int step) { return step == 9; });
  EXPECT_EQ(others[0].step, near[1].step);
  EXPECT_EQ(map.nearest({map.step(9).code}, 1000).size(), 80u) << "no more than there are";
}

TEST(MotionMap, TheNearestOfSeveralCodesAreThoseOfAny) {
  const MotionMap map = made_map();
  const auto near = map.nearest({map.step(9).code, map.step(30).code}, 2);
  EXPECT_EQ(near[0].distance, 0);
  EXPECT_EQ(near[1].distance, 0);
}

TEST(MotionMap, NeighboursAreAboutOneApart) {
  const MotionMap map = made_map();
  std::vector<float> nearest;
  for (int i = 0; i < map.size(); ++i)
    nearest.push_back(map.nearest({map.step(i).code}, 1, [i](int other) { return other == i; })[0].distance);
  std::sort(nearest.begin(), nearest.end());
  EXPECT_NEAR(nearest[nearest.size() / 2], 1, 0.05f);
}

TEST(MotionMap, StepsThatShareFramesAreNoNeighbours) {
  auto motions = made_motions(10, 2);
  for (auto& motion : motions) {
    auto twin = motion.steps[0];  // half a cycle later, and nearly the same
    twin.first += 15, twin.last += 15, twin.code[0] += 1e-4f;
    motion.steps.insert(motion.steps.begin() + 1, twin);
  }
  EXPECT_GT(MotionMap(motions).neighbour_distance(), 0.05f);
}

TEST(MotionMap, ThePlaceOfAStepIsThatStep) {
  const MotionMap map = made_map();
  for (const int i : {0, 17, 79}) {
    const MapBlend blend = map.at(map.place(i));
    ASSERT_EQ(blend.weights.size(), 1u);
    EXPECT_EQ(blend.weights[0].first, i);
    EXPECT_EQ(blend.weights[0].second, 1);
    EXPECT_EQ(blend.known.step, i);
    EXPECT_NEAR(blend.known.distance, 0, 1e-5f);
    EXPECT_LT((map.place_of(blend.code) - map.place(i)).norm(), 1e-4f);
  }
}

TEST(MotionMap, BetweenStepsLiesABlendOfThem) {
  const MotionMap map = made_map();
  const MapBlend blend = map.at(0.5f * (map.place(3) + map.place(40)));
  EXPECT_GE(blend.weights.size(), 2u);
  EXPECT_LE(blend.weights.size(), 4u);
  float sum = 0;
  for (size_t i = 0; i < blend.weights.size(); ++i) {
    sum += blend.weights[i].second;
    if (i > 0) EXPECT_LE(blend.weights[i].second, blend.weights[i - 1].second);
  }
  EXPECT_NEAR(sum, 1, 1e-5f);
}

TEST(MotionMap, TellsWhatIsFarFromAnythingKnown) {
  auto motions = made_motions(2, 6);  // a walk and a run, and nothing between
  for (auto& step : motions[1].steps) step.code[2] += 40;
  const MotionMap map(motions);
  MapPlace walk(0, 0), run(0, 0);
  for (int i = 0; i < 6; ++i) walk += map.place(i) / 6, run += map.place(6 + i) / 6;
  EXPECT_LT(map.at(walk).known.distance, kFarFromKnown);
  EXPECT_EQ(distance_words(map.at(walk).known.distance).find("far from anything"), std::string::npos);
  const MapBlend between = map.at(0.5f * (walk + run));
  ASSERT_GE(between.weights.size(), 2u);
  EXPECT_NE(map.motion_of(between.weights[0].first).action, map.motion_of(between.weights[1].first).action)
      << "it lies between both";
  EXPECT_GT(between.known.distance, kFarFromKnown);
  EXPECT_EQ(distance_words(between.known.distance).find("far from anything known"), 0u);
}

TEST(MotionMap, OfNothingIsEmptyAndOfOneStepAPoint) {
  const MotionMap none;
  EXPECT_EQ(none.size(), 0);
  EXPECT_TRUE(none.nearest({{1, 2}}, 5).empty());
  EXPECT_THROW(none.at({0, 0}), Error);
  EXPECT_EQ(MotionMap(std::vector<MappedMotion>()).size(), 0);
  EXPECT_EQ(MotionMap(made_motions(3, 0)).size(), 0) << "nobody steps";
  const MotionMap one(made_motions(1, 1));
  EXPECT_EQ(one.place(0), MapPlace(0, 0));
  EXPECT_EQ(one.neighbour_distance(), 1);
  EXPECT_EQ(one.at({3, 4}).weights.size(), 1u);
}

TEST(MotionMap, RefusesCodesThatDoNotFit) {
  auto motions = made_motions(2, 2);
  motions[1].steps[1].code.pop_back();
  EXPECT_THROW(MotionMap{motions}, Error);
  motions[1].steps[1].code.push_back(NAN);
  EXPECT_THROW(MotionMap{motions}, Error);
  EXPECT_THROW(made_map().place_of({1}), Error);
  EXPECT_THROW(made_map().nearest({{1}}, 1), Error);
}

TEST(MotionMap, HoldsTenThousandMotions) {
  const MotionMap map(made_motions(10000, 3, 64));
  EXPECT_EQ(map.size(), 30000);
  EXPECT_GT(map.neighbour_distance(), 0);
  const auto near = map.nearest({map.step(12345).code}, 8);
  EXPECT_EQ(near[0].step, 12345);
  EXPECT_EQ(map.motion_of(near[7].step).action, map.motion_of(12345).action);
  EXPECT_EQ(map.at(map.place(29999)).weights[0].first, 29999);
}

TEST(MapColouring, GroupsByActionAndFileTheLargestFirst) {
  auto motions = made_motions(20, 4);
  motions[0].action = "spin";
  const MotionMap map(motions);
  const MapColouring by_action = map_colouring(map, MapColour::Action);
  ASSERT_EQ(by_action.groups.size(), 6u);
  EXPECT_EQ(by_action.groups.back(), "spin");
  EXPECT_EQ(by_action.groups[static_cast<size_t>(by_action.group[0])], "spin");
  const MapColouring by_file = map_colouring(map, MapColour::File);
  EXPECT_EQ(static_cast<int>(by_file.groups.size()), kMapGroups);
  EXPECT_EQ(std::count(by_file.group.begin(), by_file.group.end(), -1), 80 - 4 * kMapGroups);
}

TEST(MapColouring, PutsSpeedAndDurationOnAScale) {
  const MotionMap map = made_map();
  const MapColouring speed = map_colouring(map, MapColour::Speed);
  EXPECT_TRUE(speed.groups.empty());
  EXPECT_EQ(speed.unit, "m/s");
  EXPECT_FLOAT_EQ(speed.low, 0.5f);
  EXPECT_FLOAT_EQ(speed.high, 1.5f);
  for (int i = 0; i < map.size(); ++i)
    EXPECT_NEAR(speed.low + speed.value[static_cast<size_t>(i)] * (speed.high - speed.low),
                map.step(i).speed_m_s, 1e-5f);
  EXPECT_EQ(map_colouring(map, MapColour::Duration).unit, "s");
  EXPECT_TRUE(map_colouring(MotionMap(), MapColour::Speed).value.empty());
}

TEST(ActionOfName, IsTheWordsOfTheFile) {
  EXPECT_EQ(action_of_name("/clips/Walk_03.bvh"), "walk");
  EXPECT_EQ(action_of_name("slow walk-2.fbx"), "slow walk");
  EXPECT_EQ(action_of_name("02_01.bvh"), "02_01");
}

}  // namespace
}  // namespace understudy
