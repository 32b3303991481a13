#include "retarget/rig/rig_edits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/support/moving_arm.hpp"

namespace understudy {
namespace {

constexpr float kSame = 1e-4f;  // of a body's size
constexpr int kRing = test::kArmSides;

/// The arm of three bones, soft at its joints: a ball at 1 m, a hinge about z at 2 m.
Rig tube_rig() {
  Rig rig = test::moving_arm();
  rig.joints = {{"hip", -1, JointKind::Free, {0, 0, 0}, Vec3::UnitY()},
                {"knee", 0, JointKind::Ball, {1, 0, 0}, Vec3::UnitY()},
                {"ankle", 1, JointKind::Hinge, {2, 0, 0}, Vec3::UnitZ()}};
  RowMatrix weights(rig.surface.vertices.rows(), 3);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const float x = rig.surface.vertices(v, 0), second = std::clamp(5 * (x - 0.9f), 0.0f, 1.0f),
                third = std::clamp(5 * (x - 1.9f), 0.0f, 1.0f);
    weights.row(v) << 1 - second, second - third, third;
  }
  rig.skin = SkinWeights::from(weights);
  return rig;
}

/// It goes, turns about everything that it can.
RiggedMotion moving_tube() {
  RiggedMotion tube{tube_rig(), {}};
  for (int t = 0; t < 12; ++t) {
    const auto at = static_cast<float>(t);
    RigPose pose = rest_pose(tube.rig);
    pose.root = {0.1f * at, 0.3f, 0};
    pose.turns = {rotation_from_axis_angle({0.1f * at, 0.05f * at, 0}),
                  rotation_from_axis_angle({0, 0.4f * std::sin(at), 0.1f * at}),
                  rotation_from_axis_angle({0, 0, -0.08f * at})};
    tube.motion.poses.push_back(pose);
  }
  return tube;
}

RiggedMotion creature(CreatureKind kind) {
  RiggedMotion made;
  made.rig = make_creature(kind, 100);
  made.motion = creature_motion(kind, made.rig, 0, 3, 6, 100);
  return made;
}

Points posed(const RiggedMotion& performed, size_t t) {
  return skinned(performed.rig.surface.vertices, performed.rig.skin,
                 bone_motions(performed.rig, performed.motion.poses[t]));
}

/// How far any vertex is elsewhere in any frame, share of the body's size.
float apart(const RiggedMotion& a, const RiggedMotion& b) {
  float most = 0;
  for (size_t t = 0; t < a.motion.poses.size(); ++t)
    most = std::max(most, (posed(a, t) - posed(b, t)).rowwise().norm().maxCoeff());
  return most / box_diagonal(a.rig.surface.vertices);
}

void expect_sound(const RiggedMotion& performed) {
  EXPECT_NO_THROW(check_rig(performed.rig));
  EXPECT_LT((performed.rig.skin.weights.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-5f);
  EXPECT_GE(performed.rig.skin.weights.minCoeff(), 0);
  for (const RigPose& pose : performed.motion.poses)
    EXPECT_EQ(pose.turns.size(), performed.rig.joints.size());
}

int named(const Rig& rig, const std::string& name) {
  for (int j = 0; j < rig.count(); ++j)
    if (rig.joints[static_cast<size_t>(j)].name == name) return j;
  return -1;
}

/// The middle of the vertices that hang on a bone most.
Vec3 middle_of(const Rig& rig, int bone) {
  Vec3 sum = Vec3::Zero();
  float weight = 0;
  const RowMatrix dense = rig.skin.dense(rig.count());
  for (Eigen::Index v = 0; v < dense.rows(); ++v) {
    sum += dense(v, bone) * rig.surface.vertices.row(v).transpose();
    weight += dense(v, bone);
  }
  return sum / weight;
}

TEST(MergeBone, MovesAsItsParentDidAndItsChildrenKeepTheirDirections) {
  RiggedMotion before = moving_tube();
  before.rig.joints[2].kind = JointKind::Ball;  // a hinge could not keep all of its direction
  RiggedMotion after = before;
  EXPECT_EQ(apply(after, MergeBone{1}), (std::vector<int>{0, 0, 1}));
  expect_sound(after);
  ASSERT_EQ(after.rig.count(), 2);
  for (size_t t = 0; t < 12; ++t) {
    const BoneMotions was = bone_motions(before.rig, before.motion.poses[t]),
                      is = bone_motions(after.rig, after.motion.poses[t]);
    EXPECT_LT(geodesic_angle(was[0].R, is[0].R), 1e-3f);
    EXPECT_LT(geodesic_angle(was[2].R, is[1].R), 1e-3f);
  }
}

TEST(MergeBone, OfOneThatNeverTurnedChangesNoSurface) {
  RiggedMotion before = creature(CreatureKind::Quadruped);
  const int last = before.rig.count() - 1;
  for (RigPose& pose : before.motion.poses) pose.turns[static_cast<size_t>(last)].setIdentity();
  RiggedMotion after = before;
  apply(after, MergeBone{last});
  EXPECT_LT(apart(before, after), kSame);
  expect_sound(after);
}

TEST(SplitBone, CutsAcrossTheBoneInItsMiddle) {
  const RiggedMotion before = moving_tube();
  RiggedMotion after = before;
  EXPECT_EQ(apply(after, SplitBone{1, {1.6f, 0.1f, 0}}), (std::vector<int>{0, 1, 3}));  // seen at its skin
  expect_sound(after);
  ASSERT_EQ(after.rig.count(), 4);
  const RigJoint& made = after.rig.joints[2];
  EXPECT_EQ(made.name, "knee 2");
  EXPECT_EQ(made.kind, JointKind::Ball);
  EXPECT_EQ(made.parent, 1);
  EXPECT_LT((made.rest - Vec3(1.6f, 0, 0)).norm(), 0.01f);
  EXPECT_EQ(after.rig.joints[3].parent, 2);  // the ankle lies beyond
  const RowMatrix weights = after.rig.skin.dense(4);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const float x = after.rig.surface.vertices(v, 0);
    if (x > 1.1f && x < 1.5f) EXPECT_FLOAT_EQ(weights(v, 1), 1) << x;
    if (x > 1.7f && x < 1.9f) EXPECT_FLOAT_EQ(weights(v, 2), 1) << x;
  }
  EXPECT_LT(apart(before, after), kSame);
  for (RigPose& pose : after.motion.poses) pose.turns[2] = rotation_from_axis_angle({0, 0, 0.5f});
  EXPECT_GT(apart(before, after), 0.1f);
}

TEST(SplitBone, PutsTheJointWhereItIsWantedInTheBody) {
  RiggedMotion tube = moving_tube();
  apply(tube, SplitBone{1, {1.6f, 0.03f, 0.02f}});
  EXPECT_LT((tube.rig.joints[2].rest - Vec3(1.6f, 0.03f, 0.02f)).norm(), 1e-6f);
}

TEST(SplitBone, ChangesNoSurfaceOfACreatureAndIsUndoneByAMerge) {
  const RiggedMotion before = creature(CreatureKind::Quadruped);
  for (int j = 0; j < before.rig.count(); ++j) {
    RiggedMotion after = before;
    apply(after, SplitBone{j, middle_of(before.rig, j)});
    EXPECT_LT(apart(before, after), kSame) << before.rig.joints[static_cast<size_t>(j)].name;
    expect_sound(after);
    const RowMatrix weights = after.rig.skin.dense(after.rig.count());
    const float left = weights.col(j).sum(), given = weights.col(j + 1).sum();
    EXPECT_GT(given / (left + given), 0.15f) << j;
    EXPECT_GT(left / (left + given), 0.15f) << j;
    apply(after, MergeBone{j + 1});
    EXPECT_LT((after.rig.skin.dense(after.rig.count()) - before.rig.skin.dense(before.rig.count()))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-5f);
    EXPECT_LT(apart(before, after), kSame);
  }
}

TEST(SplitBone, RefusesACutThatLeavesASideEmpty) {
  RiggedMotion tube = moving_tube();
  EXPECT_THROW(apply(tube, SplitBone{2, {3.5f, 0, 0}}), Error);
  EXPECT_EQ(tube.rig.count(), 3);
  tube.rig.surface = {};  // joints alone are cut, too
  tube.rig.skin = SkinWeights::rigid({});
  EXPECT_THROW(apply(tube, SplitBone{2, {2.5f, 0, 0}}), Error);
  apply(tube, SplitBone{1, {1.5f, 0, 0}});
  EXPECT_EQ(tube.rig.joints[3].parent, 2);
}

TEST(MoveJoint, OfTheRootChangesNoSurface) {
  const RiggedMotion before = creature(CreatureKind::Bird);
  RiggedMotion after = before;
  apply(after, MoveJoint{0, before.rig.joints[0].rest + Vec3(0.1f, -0.2f, 0.05f)});
  EXPECT_LT(apart(before, after), kSame);
  EXPECT_GT((after.motion.poses[1].root - before.motion.poses[1].root).norm(), 0.1f);
}

TEST(MoveJoint, KeepsRotationsAndWhatDoesNotTurn) {
  RiggedMotion before = moving_tube();
  before.motion.poses[0].turns[1].setIdentity();
  RiggedMotion after = before;
  apply(after, MoveJoint{1, {1.1f, 0.05f, 0}});
  EXPECT_LT((posed(after, 0) - posed(before, 0)).cwiseAbs().maxCoeff(), kSame);
  EXPECT_GT((posed(after, 9) - posed(before, 9)).cwiseAbs().maxCoeff(), 0.01f);
  for (size_t t = 0; t < 12; ++t)
    EXPECT_LT(geodesic_angle(bone_motions(before.rig, before.motion.poses[t])[2].R,
                             bone_motions(after.rig, after.motion.poses[t])[2].R),
              1e-3f);
  apply(after, MoveJoint{1, before.rig.joints[1].rest});
  EXPECT_LT(apart(before, after), kSame);
}

TEST(SetJointKind, FindsTheAxisThatMotionShows) {
  RiggedMotion before = moving_tube();
  const Vec3 axis = Vec3(0.3f, 1, -0.5f).normalized();
  for (size_t t = 0; t < 12; ++t)
    before.motion.poses[t].turns[1] = rotation_from_axis_angle(0.1f * static_cast<float>(t) * axis);
  RiggedMotion after = before;
  apply(after, SetJointKind{1, JointKind::Hinge});
  EXPECT_EQ(after.rig.joints[1].kind, JointKind::Hinge);
  EXPECT_GT(std::abs(after.rig.joints[1].axis.dot(axis)), 0.9999f);
  EXPECT_LT(apart(before, after), 1e-3f);
  apply(after, SetJointKind{1, JointKind::Ball});
  EXPECT_LT(apart(before, after), 1e-3f);
}

TEST(SetJointKind, PosesBecomeWhatTheKindAllows) {
  RiggedMotion tube = moving_tube();
  apply(tube, SetJointKind{1, JointKind::Hinge, Vec3(0, 2, 0)});
  EXPECT_LT((tube.rig.joints[1].axis - Vec3::UnitY()).norm(), 1e-6f);
  for (const RigPose& pose : tube.motion.poses) {
    const Vec3 turn = rotation_to_axis_angle(pose.turns[1]);
    EXPECT_LT(std::hypot(turn.x(), turn.z()), 1e-4f);
  }
  apply(tube, SetJointKind{1, JointKind::Fixed});
  for (const RigPose& pose : tube.motion.poses) EXPECT_TRUE(pose.turns[1].isIdentity());
  apply(tube, SetJointKind{2, JointKind::Slider});
  EXPECT_GT(std::abs(tube.rig.joints[2].axis.x()), 0.999f);  // along its bone
  EXPECT_THROW(apply(tube, SetJointKind{0, JointKind::Ball}), Error);
  EXPECT_THROW(apply(tube, SetJointKind{1, JointKind::Free}), Error);
  EXPECT_THROW(apply(tube, SetJointKind{1, JointKind::Hinge, Vec3(0, 0, 0)}), Error);
}

/// Names of neighbours, either way round.
std::set<std::pair<std::string, std::string>> links(const Rig& rig) {
  std::set<std::pair<std::string, std::string>> found;
  for (const RigJoint& joint : rig.joints) {
    if (joint.parent < 0) continue;
    const std::string& other = rig.joints[static_cast<size_t>(joint.parent)].name;
    found.insert(std::minmax(joint.name, other));
  }
  return found;
}

TEST(RootAt, AnyBoneOfACreatureAndBackChangesNoSurface) {
  for (const CreatureKind kind : {CreatureKind::Quadruped, CreatureKind::Excavator, CreatureKind::Snake}) {
    const RiggedMotion before = creature(kind);
    for (int j = 0; j < before.rig.count(); ++j) {
      RiggedMotion after = before;
      const std::vector<int> numbers = apply(after, RootAt{j});
      const std::string& name = before.rig.joints[static_cast<size_t>(j)].name;
      EXPECT_EQ(numbers[static_cast<size_t>(j)], 0);
      EXPECT_EQ(after.rig.joints[0].name, name);
      EXPECT_EQ(after.rig.joints[0].kind, JointKind::Free);
      EXPECT_LT(apart(before, after), kSame) << name;
      EXPECT_EQ(links(after.rig), links(before.rig)) << name;
      expect_sound(after);
      apply(after, RootAt{named(after.rig, before.rig.joints[0].name)});
      EXPECT_LT(apart(before, after), kSame) << name;
      for (const RigJoint& joint : before.rig.joints) {
        if (joint.parent < 0) continue;
        const RigJoint& again = after.rig.joints[static_cast<size_t>(named(after.rig, joint.name))];
        EXPECT_EQ(again.kind, joint.kind) << joint.name;
        EXPECT_LT((again.rest - joint.rest).norm(), 1e-6f) << joint.name;
      }
    }
  }
}

TEST(RootAt, KeepsSlidesOfWhatIsTurnedRound) {
  RiggedMotion before = moving_tube();
  before.rig.joints[2].kind = JointKind::Slider;
  before.rig.joints[2].axis = Vec3::UnitX();
  for (RigPose& pose : before.motion.poses) pose.turns[2].setIdentity(), pose.slides[2] = 0.3f;
  RiggedMotion after = before;
  apply(after, RootAt{2});
  EXPECT_EQ(after.rig.joints[1].kind, JointKind::Slider);
  EXPECT_NEAR(after.motion.poses[3].slides[1], -0.3f, 1e-4f);
  EXPECT_LT(apart(before, after), kSame);
}

TEST(RenameBone, RefusesNamesThatTellNothing) {
  RiggedMotion tube = moving_tube();
  apply(tube, RenameBone{1, "left knee"});
  EXPECT_EQ(tube.rig.joints[1].name, "left knee");
  EXPECT_NO_THROW(apply(tube, RenameBone{1, "left knee"}));
  EXPECT_THROW(apply(tube, RenameBone{1, "ankle"}), Error);
  EXPECT_THROW(apply(tube, RenameBone{1, " "}), Error);
  EXPECT_EQ(tube.rig.joints[1].name, "left knee");
}

TEST(PaintBone, GrowsAndShrinksTowardsItsRim) {
  const RiggedMotion before = moving_tube();
  RiggedMotion after = before;
  const Vec3 at = before.rig.surface.vertices.row(15 * kRing).transpose();  // x = 1.5
  apply(after, PaintBone{0, {at}, 0.3f, 0.5f});
  expect_sound(after);
  const RowMatrix weights = after.rig.skin.dense(3), was = before.rig.skin.dense(3);
  EXPECT_NEAR(weights(15 * kRing, 0), 0.5f, 1e-5f);
  EXPECT_NEAR(weights(15 * kRing, 1), 0.5f, 1e-5f);
  EXPECT_GT(weights(15 * kRing, 0), weights(16 * kRing, 0));
  EXPECT_GT(weights(16 * kRing, 0), weights(17 * kRing, 0));
  EXPECT_EQ(weights.topRows(12 * kRing), was.topRows(12 * kRing));
  EXPECT_EQ(weights.bottomRows(12 * kRing), was.bottomRows(12 * kRing));
  // All of it taken away, alone at its place: the parent has it.
  apply(after, PaintBone{0, {at}, 0.3f, 1, BrushMode::Subtract});
  EXPECT_NEAR(after.rig.skin.dense(3)(15 * kRing, 1), 1, 1e-5f);
  apply(after, PaintBone{1, {at}, 0.3f, 1, BrushMode::Subtract});
  EXPECT_NEAR(after.rig.skin.dense(3)(15 * kRing, 0), 1, 1e-5f);
  expect_sound(after);
}

TEST(PaintBone, LeavesWhatOnlyLiesNear) {
  RiggedMotion two = moving_tube();
  const Eigen::Index count = two.rig.surface.vertices.rows();
  const Rig one = two.rig;  // a second tube beside the first, not joined to it
  two.rig.surface.vertices.conservativeResize(2 * count, 3);
  two.rig.surface.vertices.bottomRows(count) =
      one.surface.vertices.rowwise() + Eigen::RowVector3f(0, 0.21f, 0);
  const Eigen::Index faces = one.surface.faces.rows();
  two.rig.surface.faces.conservativeResize(2 * faces, 3);
  two.rig.surface.faces.bottomRows(faces) = one.surface.faces.array() + static_cast<int>(count);
  std::vector<int> bones(static_cast<size_t>(2 * count), 1);
  two.rig.skin = SkinWeights::rigid(bones);
  apply(two, PaintBone{2, {Vec3(1.5f, 0.1f, 0)}, 0.15f, 1});
  const RowMatrix weights = two.rig.skin.dense(3);
  EXPECT_GT(weights.col(2).head(count).maxCoeff(), 0.9f);
  EXPECT_EQ(weights.col(2).tail(count).maxCoeff(), 0);
  two.rig.surface.faces.resize(0, 3);  // of a cloud nobody knows
  apply(two, PaintBone{2, {Vec3(1.5f, 0.1f, 0)}, 0.15f, 1});
  EXPECT_GT(two.rig.skin.dense(3).col(2).tail(count).maxCoeff(), 0.1f);
}

TEST(PaintBone, AStrokeIsItsDabsOneAfterTheOther) {
  RiggedMotion at_once = moving_tube(), one_by_one = at_once;
  PaintBone stroke{0, {}, 0.3f, 0.5f};
  for (const int ring : {14, 15, 17}) {
    stroke.at.emplace_back(at_once.rig.surface.vertices.row(ring * kRing).transpose());
    apply(one_by_one, PaintBone{0, {stroke.at.back()}, 0.3f, 0.5f});
  }
  apply(at_once, stroke);
  EXPECT_EQ(at_once.rig.skin.weights, one_by_one.rig.skin.weights);
  EXPECT_EQ(at_once.rig.skin.bones, one_by_one.rig.skin.bones);
}

TEST(PaintBone, SmoothsWhereWeightsChangeAtOnce) {
  RiggedMotion tube = moving_tube();
  tube.rig.skin = SkinWeights::rigid(std::vector<int>(static_cast<size_t>(tube.rig.skin.size()), 1));
  const Eigen::Index edge = 15 * kRing;
  for (Eigen::Index v = edge; v < tube.rig.skin.size(); ++v) tube.rig.skin.bones(v, 0) = 2;
  const RowMatrix was = tube.rig.skin.dense(3);
  const Vec3 at = tube.rig.surface.vertices.row(edge).transpose();
  apply(tube, PaintBone{1, {at}, 0.3f, 1, BrushMode::Smooth});
  expect_sound(tube);
  const RowMatrix weights = tube.rig.skin.dense(3);
  EXPECT_GT(weights(edge, 1), 0.1f) << "some of what is before the edge";
  EXPECT_LT(weights(edge, 1), 0.9f);
  EXPECT_NEAR(weights.row(edge).sum(), 1, 1e-5f);
  EXPECT_EQ(weights.topRows(11 * kRing), was.topRows(11 * kRing)) << "beyond the radius";
  RiggedMotion even = moving_tube();
  even.rig.skin = SkinWeights::rigid(std::vector<int>(static_cast<size_t>(even.rig.skin.size()), 1));
  const RowMatrix all = even.rig.skin.dense(3);
  apply(even, PaintBone{1, {at}, 0.3f, 1, BrushMode::Smooth});
  EXPECT_LT((even.rig.skin.dense(3) - all).cwiseAbs().maxCoeff(), 1e-6f) << "alike everywhere";
}

TEST(PaintBone, OfFiveBonesTheLeastGoes) {
  RiggedMotion snake = creature(CreatureKind::Snake);
  ASSERT_GT(snake.rig.count(), 5);
  const Vec3 at = snake.rig.surface.vertices.row(0).transpose();
  snake.rig.skin.bones.row(0) << 0, 1, 2, 3;
  snake.rig.skin.weights.row(0) << 0.4f, 0.3f, 0.2f, 0.1f;
  apply(snake, PaintBone{5, {at}, 1e-4f, 0.05f});
  EXPECT_NEAR(snake.rig.skin.dense(snake.rig.count())(0, 3), 0.1f, 1e-6f);  // which is the new one
  apply(snake, PaintBone{5, {at}, 1e-4f, 0.15f});
  const RowMatrix row = snake.rig.skin.dense(snake.rig.count()).row(0);
  EXPECT_NEAR(row(0, 5), 0.15f, 1e-5f);
  EXPECT_EQ(row(0, 3), 0);
  EXPECT_NEAR(row(0, 0) / row(0, 1), 4.0f / 3, 1e-4f);
  expect_sound(snake);
}

TEST(TurnBone, FadesToBothSides) {
  const RiggedMotion before = moving_tube();
  RiggedMotion after = before;
  apply(after, TurnBone{1, 6, {0, 0, 0.8f}, 3});
  const auto turned = [&](size_t t) {
    return geodesic_angle(before.motion.poses[t].turns[1], after.motion.poses[t].turns[1]);
  };
  EXPECT_NEAR(turned(6), 0.8f, 1e-4f);
  EXPECT_NEAR(turned(4), 0.4f, 1e-4f);
  EXPECT_NEAR(turned(8), 0.4f, 1e-4f);
  EXPECT_EQ(turned(2), 0);
  EXPECT_EQ(turned(10), 0);
  apply(after, TurnBone{1, 6, {0, 0, -0.8f}, 3});
  EXPECT_LT(apart(before, after), kSame);
}

TEST(TurnBone, OfOnePoseIsWhatTheEditMakesOfItsFrame) {
  RiggedMotion tube = moving_tube();
  for (const int joint : {1, 2}) {  // a ball, a hinge
    const TurnBone edit{joint, 6, {0.3f, -0.2f, 0.8f}, 3};
    const RigPose one = turned(tube.rig, tube.motion.poses[6], edit);
    apply(tube, edit);
    EXPECT_EQ(one.turns, tube.motion.poses[6].turns) << joint;
  }
  EXPECT_THROW(turned(tube.rig, tube.motion.poses[6], TurnBone{7, 6}), Error);
}

TEST(TurnBone, OfAHingeIsAboutItsAxis) {
  RiggedMotion tube = moving_tube();
  const Mat3 before = tube.motion.poses[5].turns[2];
  apply(tube, TurnBone{2, 5, {0.7f, 0.2f, 0.5f}, 0});
  const Vec3 turn = rotation_to_axis_angle(before.transpose() * tube.motion.poses[5].turns[2]);
  EXPECT_LT((turn - Vec3(0, 0, 0.5f)).norm(), 1e-4f);
  tube.rig.joints[2].kind = JointKind::Slider;
  EXPECT_THROW(apply(tube, TurnBone{2, 5, {0, 0, 0.5f}, 0}), Error);
}

float restlessness(const RiggedMotion& performed, size_t joint, size_t first, size_t last) {
  float sum = 0;
  for (size_t t = first; t + 2 <= last; ++t) {
    const Mat3 one = performed.motion.poses[t].turns[joint].transpose() *
                     performed.motion.poses[t + 1].turns[joint],
               two = performed.motion.poses[t + 1].turns[joint].transpose() *
                     performed.motion.poses[t + 2].turns[joint];
    sum += geodesic_angle(one, two);
  }
  return sum;
}

TEST(SmoothBones, CalmsTheFramesAskedForAndHoldsTheirEnds) {
  const RiggedMotion before = moving_tube();
  RiggedMotion after = before;
  apply(after, SmoothBones{1, 2, 9, 0.5f});
  EXPECT_LT(restlessness(after, 1, 2, 9), 0.8f * restlessness(before, 1, 2, 9));
  for (const size_t t : {0, 1, 2, 9, 10, 11})
    EXPECT_EQ(after.motion.poses[t].turns[1], before.motion.poses[t].turns[1]) << t;
  for (size_t t = 0; t < 12; ++t) {
    EXPECT_EQ(after.motion.poses[t].turns[2], before.motion.poses[t].turns[2]);
    EXPECT_EQ(after.motion.poses[t].root, before.motion.poses[t].root);
  }
  RiggedMotion shaken = before;
  shaken.motion.poses[5].root.y() += 0.2f;
  apply(shaken, SmoothBones{{}, 0, 11, 1});
  EXPECT_LT(std::abs(shaken.motion.poses[5].root.y() - 0.3f), 0.1f);
  EXPECT_EQ(shaken.motion.poses[11].root, before.motion.poses[11].root);
  for (const RigPose& pose : shaken.motion.poses) {  // a hinge stays one
    const Vec3 turn = rotation_to_axis_angle(pose.turns[2]);
    EXPECT_LT(std::hypot(turn.x(), turn.y()), 1e-4f);
  }
}

TEST(KeepFrames, LeavesThoseInside) {
  const RiggedMotion before = moving_tube();
  RiggedMotion after = before;
  apply(after, KeepFrames{3, 7});
  ASSERT_EQ(after.motion.poses.size(), 5u);
  EXPECT_EQ(after.motion.poses[0].root, before.motion.poses[3].root);
  EXPECT_EQ(after.motion.poses[4].root, before.motion.poses[7].root);
}

TEST(RigEdit, RefusesWhatIsNotThereAndChangesNothing) {
  const RiggedMotion before = moving_tube();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<RigEdit> wrong = {MergeBone{0},
                                      MergeBone{3},
                                      MergeBone{-1},
                                      SplitBone{3, {1, 0, 0}},
                                      SplitBone{1, {nan, 0, 0}},
                                      MoveJoint{7, {0, 0, 0}},
                                      MoveJoint{1, {0, nan, 0}},
                                      SetJointKind{3, JointKind::Ball},
                                      SetJointKind{1, JointKind::Hinge, Vec3(nan, 0, 0)},
                                      RootAt{3},
                                      RenameBone{-1, "a"},
                                      PaintBone{3, {Vec3::Zero()}},
                                      PaintBone{1, {Vec3(nan, 0, 0)}},
                                      PaintBone{1, {}},
                                      PaintBone{1, {Vec3::Zero()}, 0},
                                      PaintBone{1, {Vec3::Zero()}, 0.1f, 1.5f},
                                      TurnBone{1, 12, {0, 0, 1}},
                                      TurnBone{3, 1, {0, 0, 1}},
                                      TurnBone{1, 1, {0, 0, nan}},
                                      SmoothBones{3, 0, 5},
                                      SmoothBones{{}, 5, 4},
                                      SmoothBones{{}, 0, 12},
                                      SmoothBones{{}, 0, 5, nan},
                                      KeepFrames{-1, 5},
                                      KeepFrames{6, 5},
                                      KeepFrames{0, 12},
                                      FitAgain{}};
  for (size_t i = 0; i < wrong.size(); ++i) {
    RiggedMotion after = before;
    EXPECT_THROW(apply(after, wrong[i]), Error) << i;
    ASSERT_EQ(after.rig.count(), 3) << i;
    ASSERT_EQ(after.motion.poses.size(), 12u) << i;
    EXPECT_EQ(apart(before, after), 0) << i;
  }
  RiggedMotion other = before;
  other.motion.poses[4].turns.pop_back();
  EXPECT_THROW(apply(other, KeepFrames{0, 2}), Error);
}

}  // namespace
}  // namespace understudy
