#include "retarget/marionette/motion_match.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/discovery/ground_contacts.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

RiggedMotion creature(CreatureKind kind, int motion, int frames) {
  constexpr uint64_t kSeed = 3;
  const Rig rig = make_creature(kind, kSeed);
  return {rig, creature_motion(kind, rig, motion, frames, 30, kSeed)};
}

const RiggedMotion& walking_dog() {
  static const RiggedMotion dog = creature(CreatureKind::Quadruped, 1, 120);
  return dog;
}

RigMotion matched(const RiggedMotion& example, const MatchOptions& options) {
  return matched_motion(example.rig, {example.motion}, options);
}

/// Metres a second that points slide which stand on the ground, by contacts of the motion itself.
double slide(const RiggedMotion& body) {
  const GroundContacts contacts = ground_contacts(body);
  double sum = 0;
  int count = 0;
  std::vector<Points> at;
  for (const RigPose& pose : body.motion.poses)
    at.push_back(skinned(body.rig.surface.vertices, body.rig.skin, bone_motions(body.rig, pose)));
  for (size_t t = 1; t < at.size(); ++t)
    for (Eigen::Index v = 0; v < at[t].rows(); ++v) {
      const auto bone = static_cast<size_t>(body.rig.skin.main_bone(v));
      const float least = contacts.ground + 0.01f;
      if (!contacts.touches[t][bone] || !contacts.touches[t - 1][bone] || at[t](v, 1) > least ||
          at[t - 1](v, 1) > least)
        continue;
      sum += static_cast<double>((at[t].row(v) - at[t - 1].row(v)).norm()) * body.motion.fps;
      ++count;
    }
  return count == 0 ? 0 : sum / count;
}

double largest_step(const Rig& rig, const std::vector<RigPose>& poses) {
  double largest = 0;
  Points before;
  for (const RigPose& pose : poses) {
    const Points at = joint_places(rig, bone_motions(rig, pose));
    if (before.rows() > 0)
      largest = std::max(largest, static_cast<double>((at - before).rowwise().norm().maxCoeff()));
    before = at;
  }
  return largest;
}

void expect_same(const RigPose& a, const RigPose& b) {
  EXPECT_EQ((a.root - b.root).norm(), 0);
  EXPECT_EQ(a.slides, b.slides);
  for (size_t j = 0; j < a.turns.size(); ++j) EXPECT_EQ((a.turns[j] - b.turns[j]).norm(), 0) << j;
}

TEST(MotionMatch, MakesAsManyFramesAsAskedForAndTheSameForTheSameSeed) {
  for (const int frames : {2, 7, 45, 200}) {
    MatchOptions options;
    options.frames = frames;
    const RigMotion made = matched(walking_dog(), options), again = matched(walking_dog(), options);
    ASSERT_EQ(ssize(made.poses), frames);
    expect_same(made.poses.back(), again.poses.back());
    options.seed = 2;
    if (frames < 45) continue;
    EXPECT_GT(distance_to_nearest(walking_dog().rig, matched(walking_dog(), options).poses, made.poses),
              0.002);
  }
}

TEST(MotionMatch, MovesAsTheExampleDoesAndCopiesNoPieceOfIt) {
  MatchOptions options;
  options.frames = 80;
  const RiggedMotion& dog = walking_dog();
  const double own_step = largest_step(dog.rig, dog.motion.poses);
  for (options.seed = 1; options.seed <= 4; ++options.seed) {
    const RigMotion made = matched(dog, options);
    const double off = distance_to_nearest(dog.rig, made.poses, dog.motion.poses);
    EXPECT_GT(off, 0.002) << "a copy";
    EXPECT_LT(off, 0.1) << "nothing like it";
    EXPECT_LT(largest_step(dog.rig, made.poses), 2 * own_step);
    EXPECT_LT(slide({dog.rig, made}), 1.5 * slide(dog) + 0.02);
  }
}

TEST(MotionMatch, ACopyHasNoDistance) {
  const RiggedMotion& dog = walking_dog();
  const std::vector<RigPose> piece(dog.motion.poses.begin() + 20, dog.motion.poses.begin() + 60);
  EXPECT_NEAR(distance_to_nearest(dog.rig, piece, dog.motion.poses), 0, 1e-6);
}

TEST(MotionMatch, MeetsKeysToTheLastBit) {
  const RiggedMotion& dog = walking_dog();
  MatchOptions options;
  options.frames = 60;
  options.keys = {{0, dog.motion.poses[10]}, {25, dog.motion.poses[40]}, {59, dog.motion.poses[70]}};
  const RigMotion made = matched(dog, options);
  for (const PoseKey& key : options.keys) expect_same(made.poses[static_cast<size_t>(key.frame)], key.pose);
  EXPECT_LT(largest_step(dog.rig, made.poses), 2 * largest_step(dog.rig, dog.motion.poses));
}

TEST(MotionMatch, AShortGapIsFilledAsTheClipWent) {
  const RiggedMotion& dog = walking_dog();
  for (const int gap : {4, 8}) {
    const auto first = dog.motion.poses.begin() + 40, last = first + gap;
    MatchOptions options;
    options.frames = gap + 1;
    options.keys = {{0, *first}, {gap, *last}};
    const RigMotion made = matched_motion(
        dog.rig, {{30, {dog.motion.poses.begin(), first + 1}}, {30, {last, dog.motion.poses.end()}}},
        options);
    double off = 0;
    for (int t = 0; t <= gap; ++t)
      off += static_cast<double>(
                 (joint_places(dog.rig, bone_motions(dog.rig, made.poses[static_cast<size_t>(t)])) -
                  joint_places(dog.rig, bone_motions(dog.rig, first[t])))
                     .rowwise()
                     .norm()
                     .mean()) /
             gap;
    EXPECT_LT(off, 0.01 * static_cast<double>(box_diagonal(dog.rig.surface.vertices))) << gap;
  }
}

TEST(MotionMatch, ALoopEndsInThePoseThatItBeginsWith) {
  const RiggedMotion& dog = walking_dog();
  MatchOptions options;
  options.frames = 50;
  options.loop = true;
  const RigMotion made = matched(dog, options);
  const RigPose &first = made.poses.front(), &last = made.poses.back();
  EXPECT_NEAR(first.root.y(), last.root.y(), 1e-5);
  for (size_t j = 1; j < first.turns.size(); ++j)
    EXPECT_LT(geodesic_angle(first.turns[j], last.turns[j]), 1e-3f) << dog.rig.joints[j].name;
  EXPECT_LT(largest_step(dog.rig, made.poses), 2 * largest_step(dog.rig, dog.motion.poses));
}

TEST(MotionMatch, JointsStayOfTheirKind) {
  const RiggedMotion machine = creature(CreatureKind::Excavator, 0, 90);
  MatchOptions options;
  options.frames = 70;
  for (const RigPose& pose : matched(machine, options).poses)
    for (size_t j = 1; j < machine.rig.joints.size(); ++j) {
      const RigJoint& joint = machine.rig.joints[j];
      if (joint.kind == JointKind::Hinge)
        EXPECT_LT((pose.turns[j] * joint.axis - joint.axis).norm(), 1e-4f) << joint.name;
      if (joint.kind == JointKind::Slider || joint.kind == JointKind::Fixed)
        EXPECT_TRUE(pose.turns[j].isIdentity(1e-4f)) << joint.name;
      if (joint.kind != JointKind::Slider) EXPECT_EQ(pose.slides[j], 0) << joint.name;
    }
}

TEST(MotionMatch, OneFrameIsNoExample) {
  RiggedMotion dog = walking_dog();
  dog.motion.poses.resize(1);
  EXPECT_THROW(matched(dog, {}), Error);
  MatchOptions one;
  one.frames = 1;
  EXPECT_THROW(matched(walking_dog(), one), Error);
}

}  // namespace
}  // namespace understudy
