#include "retarget/creature/creature.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/creature/puppet.hpp"

namespace understudy {
namespace {

constexpr int kFrames = 90;
constexpr double kFps = 30;

std::vector<CreatureKind> all_kinds() {
  std::vector<CreatureKind> kinds;
  for (size_t k = 0; k < kCreatureNames.size(); ++k) kinds.push_back(static_cast<CreatureKind>(k));
  return kinds;
}

bool is_machine(CreatureKind kind) {
  return kind == CreatureKind::Arm || kind == CreatureKind::Lamp || kind == CreatureKind::Excavator;
}

/// Made once for all tests.
const Rig& creature(CreatureKind kind, uint64_t seed) {
  static std::map<std::pair<CreatureKind, uint64_t>, Rig> made;
  const auto [found, is_new] = made.try_emplace({kind, seed});
  if (is_new) found->second = make_creature(kind, seed);
  return found->second;
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f) {
    const auto corner = [&](int c) -> Vec3 { return mesh.vertices.row(mesh.faces(f, c)).transpose(); };
    sum += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return sum;
}

int pieces(const Mesh& mesh) {
  std::vector<int> up(static_cast<size_t>(mesh.vertices.rows()));
  std::iota(up.begin(), up.end(), 0);
  const auto top = [&](int v) {
    while (up[static_cast<size_t>(v)] != v)
      v = up[static_cast<size_t>(v)] = up[static_cast<size_t>(up[static_cast<size_t>(v)])];
    return v;
  };
  for (Eigen::Index f = 0; f < mesh.faces.rows(); ++f)
    for (int c = 1; c < 3; ++c) up[static_cast<size_t>(top(mesh.faces(f, 0)))] = top(mesh.faces(f, c));
  int count = 0;
  for (int v = 0; v < static_cast<int>(up.size()); ++v) count += top(v) == v;
  return count;
}

/// For every motion of a kind a clip.
std::vector<RigMotion> clips(CreatureKind kind, const Rig& rig, uint64_t seed) {
  std::vector<RigMotion> all;
  for (size_t m = 0; m < creature_motions(kind).size(); ++m)
    all.push_back(creature_motion(kind, rig, static_cast<int>(m), kFrames, kFps, seed));
  return all;
}

TEST(Creature, EveryKindIsOneClosedSurfaceThatFacesOutward) {
  for (const CreatureKind kind : all_kinds())
    for (const uint64_t seed : {1, 2}) {
      const Rig& rig = creature(kind, seed);
      SCOPED_TRACE(rig.name + " " + std::to_string(seed));
      EXPECT_TRUE(is_closed(rig.surface.faces));
      EXPECT_EQ(pieces(rig.surface), 1);
      EXPECT_EQ(rig.surface.vertices.rows() - rig.surface.faces.rows() / 2, 2) << "it has a handle";
      EXPECT_GT(volume(rig.surface), 0);
      EXPECT_GE(rig.surface.vertices.rows(), 4000);
      EXPECT_LE(rig.surface.vertices.rows(), 9000);
      EXPECT_NEAR(rig.surface.vertices.col(1).minCoeff(), 0, 1e-5f);
    }
}

TEST(Creature, NoTriangleIsTurnedInside) {
  for (const CreatureKind kind : all_kinds()) {
    const Rig& rig = creature(kind, 1);
    const Points normals = vertex_normals(rig.surface.vertices, rig.surface.faces);
    int turned = 0;
    for (Eigen::Index f = 0; f < rig.surface.faces.rows(); ++f) {
      const auto corner = [&](int c) -> Vec3 {
        return rig.surface.vertices.row(rig.surface.faces(f, c)).transpose();
      };
      const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      Vec3 about = Vec3::Zero();
      for (int c = 0; c < 3; ++c) about += normals.row(rig.surface.faces(f, c)).transpose();
      turned += normal.dot(about) < 0;
    }
    EXPECT_LE(turned, 2) << rig.name;
  }
}

TEST(Creature, WeightsSumToOneAndEveryBoneCarriesSkin) {
  for (const CreatureKind kind : all_kinds()) {
    const Rig& rig = creature(kind, 1);
    EXPECT_NO_THROW(check_rig(rig));
    EXPECT_LT((rig.skin.weights.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-5f) << rig.name;
    EXPECT_GE(rig.skin.weights.minCoeff(), 0) << rig.name;
    const Eigen::RowVectorXf carried = rig.skin.dense(rig.count()).colwise().sum();
    for (int j = 0; j < rig.count(); ++j)
      EXPECT_GT(carried[j], 15) << rig.name << " " << rig.joints[static_cast<size_t>(j)].name;
    if (is_machine(kind)) EXPECT_EQ(rig.skin.weights.col(0).minCoeff(), 1) << rig.name;
  }
}

TEST(Creature, EveryJointButARootTurnsOrSlidesInItsMotions) {
  for (const CreatureKind kind : all_kinds()) {
    const Rig& rig = creature(kind, 1);
    const auto motions = clips(kind, rig, 7);
    for (size_t j = 1; j < rig.joints.size(); ++j) {
      float turned = 0, slid = 0;
      for (const RigMotion& motion : motions)
        for (size_t a = 0; a < motion.poses.size(); a += 3)
          for (size_t b = 0; b < a; b += 3) {
            const Mat3 between = motion.poses[a].turns[j].transpose() * motion.poses[b].turns[j];
            turned = std::max(turned, std::abs(Eigen::AngleAxisf(between).angle()));
            slid = std::max(slid, std::abs(motion.poses[a].slides[j] - motion.poses[b].slides[j]));
          }
      if (rig.joints[j].kind == JointKind::Slider)
        EXPECT_GT(slid, 0.04f * size_of(rig)) << rig.name << " " << rig.joints[j].name;
      else
        EXPECT_GT(turned, from_degrees(15)) << rig.name << " " << rig.joints[j].name;
    }
  }
}

TEST(Creature, JointsDoOnlyWhatTheirKindAllows) {
  for (const CreatureKind kind : all_kinds()) {
    const Rig& rig = creature(kind, 1);
    EXPECT_EQ(rig.joints[0].kind, JointKind::Free);
    for (const RigMotion& motion : clips(kind, rig, 7))
      for (const RigPose& pose : motion.poses)
        for (size_t j = 1; j < rig.joints.size(); ++j) {
          const RigJoint& joint = rig.joints[j];
          EXPECT_NEAR(joint.axis.norm(), 1, 1e-5f);
          EXPECT_LT((pose.turns[j] * pose.turns[j].transpose() - Mat3::Identity()).norm(), 1e-4f);
          if (joint.kind == JointKind::Hinge)
            EXPECT_LT((pose.turns[j] * joint.axis - joint.axis).norm(), 1e-4f) << joint.name;
          if (joint.kind == JointKind::Slider)
            EXPECT_LT((pose.turns[j] - Mat3::Identity()).norm(), 1e-6f) << joint.name;
          else
            EXPECT_EQ(pose.slides[j], 0) << joint.name;
        }
  }
}

TEST(Creature, LimbsMoveAtMostATwentiethOfTheBodyInAFrame) {
  for (const CreatureKind kind : all_kinds()) {
    const Rig& rig = creature(kind, 2);
    for (size_t m = 0; m < creature_motions(kind).size(); ++m) {
      const RigMotion motion = creature_motion(kind, rig, static_cast<int>(m), kFrames, kFps, 3);
      Points before = joint_places(rig, bone_motions(rig, motion.poses[0]));
      float fastest = 0;
      for (const RigPose& pose : motion.poses) {
        const Points now = joint_places(rig, bone_motions(rig, pose));
        fastest = std::max(fastest, (now - before).rowwise().norm().maxCoeff());
        before = now;
      }
      EXPECT_LT(fastest, 0.05f * size_of(rig)) << rig.name << " " << creature_motions(kind)[m];
      EXPECT_LT((motion.poses.back().root - motion.poses[0].root).norm(), 1.3f * size_of(rig)) << rig.name;
    }
  }
}

/// Joints whose lowest point stands on the floor in some motions.
std::vector<int> feet(const Rig& rig, const std::string& ending) {
  std::vector<int> found;
  for (int j = 1; j < rig.count(); ++j) {
    const std::string& name = rig.joints[static_cast<size_t>(j)].name;
    if (name.size() > ending.size() && name.substr(name.size() - ending.size()) == ending) found.push_back(j);
  }
  return found;
}

Vec3 lowest_point(const Rig& rig, int bone) {
  Vec3 lowest(0, 1e9f, 0);
  for (Eigen::Index v = 0; v < rig.skin.size(); ++v)
    if (rig.skin.bones(v, 0) == bone && rig.surface.vertices(v, 1) < lowest.y())
      lowest = rig.surface.vertices.row(v).transpose();
  return lowest;
}

struct Walker {
  CreatureKind kind;
  const char* feet;  // how their names end
  int motion;
  float down;  // share of all feet and frames that stand, at least
};

TEST(Creature, PlantedFeetDoNotSlide) {
  for (const Walker& walker :
       {Walker{CreatureKind::Quadruped, "_paw", 0, 0.6f}, Walker{CreatureKind::Quadruped, "_paw", 1, 0.48f},
        Walker{CreatureKind::Quadruped, "_paw", 2, 0.75f}, Walker{CreatureKind::Insect, "_ankle", 0, 0.48f},
        Walker{CreatureKind::Insect, "_ankle", 1, 0.6f}, Walker{CreatureKind::Bird, "_foot", 1, 0.5f},
        Walker{CreatureKind::Bird, "_foot", 2, 0.95f}})
    for (const uint64_t seed : {1, 2}) {
      const Rig& rig = creature(walker.kind, seed);
      SCOPED_TRACE(rig.name + " " + creature_motions(walker.kind)[static_cast<size_t>(walker.motion)]);
      const RigMotion motion = creature_motion(walker.kind, rig, walker.motion, kFrames, kFps, seed);
      const float size = size_of(rig);
      int standing = 0, looked = 0;
      for (const int foot : feet(rig, walker.feet)) {
        const Vec3 sole = lowest_point(rig, foot);
        for (int frame = 1; frame < kFrames; ++frame) {
          const auto at = [&](int f) {
            return bone_motions(rig, motion.poses[static_cast<size_t>(f)])[static_cast<size_t>(foot)](sole);
          };
          const Vec3 before = at(frame - 1), now = at(frame);
          ++looked;
          EXPECT_GT(now.y(), -0.004f * size) << "a foot in the floor";
          if (before.y() > 0.003f * size || now.y() > 0.003f * size) continue;
          ++standing;
          EXPECT_LT((now - before).norm(), 0.003f * size)
              << rig.joints[static_cast<size_t>(foot)].name << " " << frame;
        }
      }
      EXPECT_GT(standing, walker.down * static_cast<float>(looked));
    }
}

TEST(Creature, TheSameSeedGivesTheSameBytes) {
  for (const CreatureKind kind : {CreatureKind::Lamp, CreatureKind::Snake, CreatureKind::Hand}) {
    const Rig& rig = creature(kind, 1);
    const Rig again = make_creature(kind, 1);
    EXPECT_TRUE(rig.surface.vertices == again.surface.vertices && rig.surface.faces == again.surface.faces);
    EXPECT_TRUE(rig.skin.bones == again.skin.bones && rig.skin.weights == again.skin.weights);
    const RigMotion motion = creature_motion(kind, rig, 1, 12, kFps, 5);
    const auto once = creature_surfaces(kind, rig, motion, 9);
    const auto twice = creature_surfaces(kind, again, creature_motion(kind, again, 1, 12, kFps, 5), 9);
    for (size_t frame = 0; frame < once.size(); ++frame) EXPECT_TRUE(once[frame] == twice[frame]);
    EXPECT_FALSE(rig.surface.vertices.rows() == creature(kind, 2).surface.vertices.rows() &&
                 rig.surface.vertices == creature(kind, 2).surface.vertices)
        << "another seed is another body";
  }
}

TEST(Creature, FleshWobblesALittleAndMachinesDoNot) {
  for (const CreatureKind kind : all_kinds()) {
    const Rig& rig = creature(kind, 1);
    const RigMotion motion = creature_motion(kind, rig, 0, 20, kFps, 5);
    const auto surfaces = creature_surfaces(kind, rig, motion, 9);
    float most = 0;
    for (size_t frame = 0; frame < surfaces.size(); ++frame) {
      const Points stiff = skinned(rig.surface.vertices, rig.skin, bone_motions(rig, motion.poses[frame]));
      most = std::max(most, (surfaces[frame] - stiff).rowwise().norm().maxCoeff());
    }
    if (is_machine(kind))
      EXPECT_EQ(most, 0) << rig.name;
    else
      EXPECT_GT(most, 0.001f * size_of(rig)) << rig.name;
    EXPECT_LT(most, 0.015f * size_of(rig)) << rig.name;
  }
}

TEST(Creature, EveryKindHasTwoMotionsAndRefusesOthers) {
  for (const CreatureKind kind : all_kinds()) EXPECT_GE(creature_motions(kind).size(), 2u);
  const Rig& rig = creature(CreatureKind::Lamp, 1);
  EXPECT_THROW(creature_motion(CreatureKind::Lamp, rig, 2, 10, kFps, 1), Error);
  EXPECT_THROW(creature_motion(CreatureKind::Lamp, rig, 0, 0, kFps, 1), Error);
  EXPECT_THROW(creature_motion(CreatureKind::Lamp, rig, 0, 10, 0, 1), Error);
}

}  // namespace
}  // namespace understudy
