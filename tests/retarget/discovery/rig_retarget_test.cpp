#include "retarget/discovery/rig_retarget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/discovery/first_pose.hpp"
#include "retarget/discovery/ground_contacts.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/rig_metrics.hpp"

namespace understudy {
namespace {

constexpr int kClip = 20;

RiggedMotion creature(CreatureKind kind, uint64_t seed, int motion) {
  RiggedMotion body{make_creature(kind, seed), {}};
  body.motion = creature_motion(kind, body.rig, motion, kClip, 15, seed);
  return body;
}

std::vector<Points> surfaces(const Rig& rig, const RigMotion& motion) {
  std::vector<Points> all;
  for (const RigPose& pose : motion.poses)
    all.push_back(skinned(rig.surface.vertices, rig.skin, bone_motions(rig, pose)));
  return all;
}

/// Of a target that does what the source did, against it under the source's angles.
double error_pct(const RiggedMotion& performed, const RiggedMotion& source, const Rig& target) {
  return retarget_error_pct(surfaces(performed.rig, performed.motion), surfaces(target, source.motion));
}

class TwoLamps : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    source = new RiggedMotion(creature(CreatureKind::Lamp, 100, 0));
    target = new RiggedMotion(creature(CreatureKind::Lamp, 101, 1));
    laid = new LaidBody(lay_on(*source, *target));
  }
  static void TearDownTestSuite() {
    delete source;
    delete target;
    delete laid;
  }
  static RiggedMotion *source, *target;
  static LaidBody* laid;
};
RiggedMotion* TwoLamps::source;
RiggedMotion* TwoLamps::target;
LaidBody* TwoLamps::laid;

TEST_F(TwoLamps, BonesAreMatchedOneToOneByWhereTheyLie) {
  const BoneMatches matches = match_bones(bone_costs(*laid, *source, *target), source->rig, target->rig);
  for (int k = 0; k < target->rig.count(); ++k) EXPECT_EQ(matches.partner[static_cast<size_t>(k)], k);
  EXPECT_LT(*std::max_element(matches.cost.begin(), matches.cost.end()), 0.6f);
  EXPECT_FALSE(laid->mirrored());
}

TEST_F(TwoLamps, TheSecondDoesWhatTheFirstDid) {
  const BoneMatches matches = match_bones(bone_costs(*laid, *source, *target), source->rig, target->rig);
  const RiggedMotion performed = performed_by(*source, *target, *laid, matches);
  ASSERT_EQ(performed.motion.poses.size(), static_cast<size_t>(kClip));
  const double error = error_pct(performed, *source, target->rig);
  EXPECT_LT(error, 2);
  EXPECT_LT(2 * error, error_pct(*target, *source, target->rig));  // than what it did itself
}

TEST_F(TwoLamps, TheSecondDoesAnotherMotionOfTheFirst) {
  const BoneMatches matches = same_bones(target->rig.count());
  const RigMotion other = creature_motion(CreatureKind::Lamp, source->rig, 1, kClip / 2, 15, 7);
  RigRetargetOptions options;
  options.motion = &other;
  const RiggedMotion performed = performed_by(*source, *target, *laid, matches, options);
  ASSERT_EQ(performed.motion.poses.size(), static_cast<size_t>(kClip / 2));
  EXPECT_LT(error_pct(performed, {source->rig, other}, target->rig), 2.5);
}

TEST_F(TwoLamps, ABoneWithoutAPartnerGoesWithItsNeighbours) {
  BoneMatches matches = match_bones(bone_costs(*laid, *source, *target), source->rig, target->rig);
  const int last = target->rig.count() - 1;
  matches.partner.back() = -1;
  const RiggedMotion performed = performed_by(*source, *target, *laid, matches);
  const auto& poses = performed.motion.poses;
  for (const RigPose& pose : poses)
    EXPECT_LT(
        geodesic_angle(pose.turns[static_cast<size_t>(last)], poses[0].turns[static_cast<size_t>(last)]),
        1e-3f);
}

TEST_F(TwoLamps, RefusesPartnersThatAreNoneOrTaken) {
  BoneMatches matches = same_bones(target->rig.count());
  matches.partner[1] = source->rig.count();
  EXPECT_THROW(performed_by(*source, *target, *laid, matches), Error);
  matches.partner[1] = 0;
  EXPECT_THROW(performed_by(*source, *target, *laid, matches), Error);
  std::fill(matches.partner.begin(), matches.partner.end(), -1);
  EXPECT_THROW(performed_by(*source, *target, *laid, matches), Error);
  matches.partner.pop_back();
  EXPECT_THROW(performed_by(*source, *target, *laid, matches), Error);
}

TEST_F(TwoLamps, OneScanGetsTheOthersBones) {
  const std::vector<Points> all = surfaces(target->rig, target->motion);
  const RiggedMotion scan = body_of_one_scan({all[0], target->rig.surface.faces});
  const LaidBody once = lay_on(*source, scan);
  const RiggedMotion made = rig_laid_on(*source, scan, once);
  ASSERT_EQ(made.rig.count(), source->rig.count());
  const Points joints = joint_places(target->rig, bone_motions(target->rig, target->motion.poses[0]));
  const float size = box_diagonal(all[0]);
  EXPECT_LT((made.rig.rest_joints() - joints).rowwise().norm().mean(), 0.06f * size);
  const RiggedMotion performed = performed_by(*source, made, once, same_bones(made.rig.count()));
  EXPECT_LT(error_pct(performed, *source, target->rig), 4);
}

/// Bones of these names and parents, and nothing else.
Rig named_tree(const std::vector<std::pair<std::string, int>>& bones) {
  Rig rig;
  for (const auto& [name, parent] : bones)
    rig.joints.push_back({name, parent, parent < 0 ? JointKind::Free : JointKind::Ball});
  return rig;
}

/// Where both rigs lie alike: each bone on the one of its number.
BoneMatches matched(const Rig& source, const Rig& target) {
  Eigen::MatrixXd costs = Eigen::MatrixXd::Constant(target.count(), source.count(), 0.7);
  costs.diagonal().setConstant(0.1);
  return match_bones(costs, source, target);
}

TEST(MatchedBones, OfTheSameNameAndParentAreEachOthersThoughTheyLieElsewhere) {
  const Rig source =
                named_tree({{"keypoint 7", -1}, {"keypoint 2", 0}, {"keypoint 3", 0}, {"keypoint 1", 2}}),
            shuffled =
                named_tree({{"keypoint 7", -1}, {"keypoint 3", 0}, {"keypoint 1", 1}, {"keypoint 2", 0}});
  const BoneMatches matches = matched(source, shuffled);
  EXPECT_EQ(matches.partner, (std::vector<int>{0, 2, 3, 1}));
  EXPECT_EQ(matches.cost, (std::vector<float>{0.1f, 0.7f, 0.7f, 0.7f})) << "what they have in common is told";
}

TEST(MatchedBones, WithoutACommonNameGetWhatIsLeft) {
  const Rig source = named_tree({{"hips", -1}, {"left", 0}, {"right", 0}}),
            target = named_tree({{"hips", -1}, {"right", 0}, {"tail", 0}});
  EXPECT_EQ(matched(source, target).partner, (std::vector<int>{0, 2, 1}));
}

TEST(MatchedBones, OfNamesThatOnlyCountAreNotBelieved) {
  for (const std::string word : {"bone ", "Bone.00", "joint", "node_", ""}) {
    const Rig source = named_tree({{word + "0", -1}, {word + "1", 0}, {word + "2", 0}}),
              target = named_tree({{word + "0", -1}, {word + "2", 0}, {word + "1", 0}});
    EXPECT_EQ(matched(source, target).partner, (std::vector<int>{0, 1, 2})) << word;
  }
}

TEST(MatchedBones, OfNamesThatContradictTheTreeAreNotBelieved) {
  const Rig source = named_tree({{"a", -1}, {"b", 0}, {"c", 1}, {"d", 2}}),
            target = named_tree({{"a", -1}, {"c", 0}, {"b", 1}, {"d", 2}});
  EXPECT_EQ(matched(source, target).partner, (std::vector<int>{0, 1, 2, 3}));
  const Rig twins = named_tree({{"a", -1}, {"arm", 0}, {"leg", 0}, {"arm", 2}}),
            once = named_tree({{"a", -1}, {"leg", 0}, {"arm", 0}, {"hand", 2}});
  EXPECT_EQ(matched(twins, once).partner, (std::vector<int>{0, 2, 1, 3}))
      << "two arms: the leg alone is told";
}

TEST(RigRetarget, ALeftHandIsARightHandsMirrorImage) {
  const auto side = [](const Rig& rig) {  // of the thumb, which comes last
    return rig.joints.back().rest.x() - rig.joints[0].rest.x() > 0;
  };
  const RiggedMotion one = creature(CreatureKind::Hand, 100, 0), other = creature(CreatureKind::Hand, 101, 0);
  ASSERT_NE(side(one.rig), side(other.rig));
  const LaidBody laid = lay_on(one, other);
  EXPECT_TRUE(laid.mirrored()) << heading_of(laid.turn);
}

/// How fast what touches slides, metres a second, mean.
double slip(const RiggedMotion& body, const std::vector<std::vector<char>>& touches) {
  const std::vector<Points> all = surfaces(body.rig, body.motion);
  double sum = 0;
  int count = 0;
  for (size_t t = 1; t < all.size(); ++t)
    for (int b = 0; b < body.rig.count(); ++b) {
      if (!touches[t][static_cast<size_t>(b)] || !touches[t - 1][static_cast<size_t>(b)]) continue;
      int lowest = -1;
      for (Eigen::Index v = 0; v < all[t].rows(); ++v)
        if (body.rig.skin.bones(v, 0) == b && (lowest < 0 || all[t](v, 1) < all[t](lowest, 1)))
          lowest = static_cast<int>(v);
      if (lowest < 0) continue;
      sum += static_cast<double>((all[t].row(lowest) - all[t - 1].row(lowest)).norm()) * body.motion.fps;
      ++count;
    }
  return sum / std::max(1, count);
}

TEST(RigRetarget, FeetThatStandStayWhereTheyAre) {
  const RiggedMotion source = creature(CreatureKind::Quadruped, 100, 0),
                     target = creature(CreatureKind::Quadruped, 104, 2);
  const GroundContacts contacts = ground_contacts(source);
  int touching = 0;
  for (const auto& frame : contacts.touches)
    touching += static_cast<int>(std::count(frame.begin(), frame.end(), 1));
  EXPECT_GT(touching, kClip);  // a walk: more than one foot at a time
  const LaidBody laid = lay_on(source, target);
  const BoneMatches matches = same_bones(source.rig.count());
  RigRetargetOptions no_contacts;
  no_contacts.contacts = false;
  const RiggedMotion held = performed_by(source, target, laid, matches),
                     free = performed_by(source, target, laid, matches, no_contacts);
  EXPECT_LT(1.15 * slip(held, contacts.touches), slip(free, contacts.touches));
}

TEST(FirstPose, FindsARigThatIsTurnedAndElsewhere) {
  const RiggedMotion known = creature(CreatureKind::Quadruped, 100, 0);
  RigPose there = known.motion.poses[7];
  const Mat3 turn = rotation_about_y(2);
  there.turns[0] = turn * there.turns[0];
  there.root = turn * there.root + Vec3(3, 0, 1);
  const Points scan = skinned(known.rig.surface.vertices, known.rig.skin, bone_motions(known.rig, there));
  const RigPose found = first_pose(known, {scan, known.rig.surface.faces});
  const Points laid = skinned(known.rig.surface.vertices, known.rig.skin, bone_motions(known.rig, found));
  EXPECT_LT((laid - scan).rowwise().norm().mean(), 0.01f * box_diagonal(scan));
}

}  // namespace
}  // namespace understudy
