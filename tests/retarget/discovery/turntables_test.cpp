#include "retarget/discovery/turntables.hpp"

#include <gtest/gtest.h>

#include "retarget/creature/creature.hpp"
#include "retarget/discovery/scan_evidence.hpp"

namespace understudy {
namespace {

constexpr int kLampFrames = 30;

/// A lamp looks about: it turns on its round foot, and leans.
struct Lamp {
  Rig rig = make_creature(CreatureKind::Lamp, 100);
  std::vector<ThinnedFrame> frames;
  SurfaceTracks tracks;
  Lamp() {
    const RigMotion motion = creature_motion(CreatureKind::Lamp, rig, 0, kLampFrames, 15, 100);
    Rng rng(5);
    for (const Points& vertices : creature_surfaces(CreatureKind::Lamp, rig, motion, 100)) {
      Mesh cloud;
      cloud.vertices = sample_points({vertices, rig.surface.faces, {}}, 6000, rng);
      frames.push_back(thinned(cloud, 1500, 4000, frames.size()));
    }
    tracks = track_surface(frames, 0, 150);
  }
};

/// Of the foot's points how far the tracks take them, mean over points and frames, metres.
double foot_moves(const Lamp& lamp) {
  double sum = 0;
  int count = 0;
  for (size_t t = 0; t < lamp.tracks.motions.size(); ++t) {
    const Points now = lamp.tracks.at(static_cast<int>(t)), &rest = lamp.tracks.graph.points;
    const float low = rest.col(1).minCoeff() + 0.02f;
    for (Eigen::Index i = 0; i < rest.rows(); ++i)
      if (rest(i, 1) < low) sum += (now.row(i) - rest.row(i)).norm(), ++count;
  }
  return sum / count;
}

TEST(Turntables, ARoundFootStandsAndTheLampTurnsOnIt) {
  Lamp lamp;
  const double before = foot_moves(lamp);
  rest_what_may(lamp.frames, lamp.tracks);
  EXPECT_LT(foot_moves(lamp), 0.3 * before);
  RigidParts parts = find_rigid_parts(lamp.frames, lamp.tracks);
  PartTree tree = find_part_tree(lamp.tracks, parts);
  const int found = tree.rig.count();
  RigidParts as_many = parts;
  PartTree within = tree;
  add_turntables(lamp.tracks, as_many, within, found);
  EXPECT_EQ(within.rig.count(), found) << "no more bones than are allowed";
  add_turntables(lamp.tracks, parts, tree);
  ASSERT_EQ(tree.rig.count(), found + 1);
  ASSERT_EQ(parts.count(), found + 1);
  const RigJoint &turn = tree.rig.joints[1], &lean = tree.rig.joints[2];
  EXPECT_EQ(turn.parent, 0);
  EXPECT_EQ(turn.kind, JointKind::Hinge);
  EXPECT_GT(std::abs(turn.axis.y()), 0.98f);
  EXPECT_EQ(lean.parent, 1);
  EXPECT_EQ(lean.kind, JointKind::Hinge);
  EXPECT_LT(std::abs(lean.axis.y()), 0.1f);
}

TEST(Turntables, WhatMovesIsNotPutToRest) {
  Lamp lamp;
  const SurfaceTracks before = lamp.tracks;
  rest_what_may(lamp.frames, lamp.tracks);
  const float top = lamp.tracks.graph.points.col(1).maxCoeff() - 0.1f;
  for (int t = 0; t < kLampFrames; t += 7) {
    const Points was = before.at(t), is = lamp.tracks.at(t);
    for (Eigen::Index i = 0; i < was.rows(); ++i)
      if (lamp.tracks.graph.points(i, 1) > top) EXPECT_LT((was.row(i) - is.row(i)).norm(), 1e-6f);
  }
}

}  // namespace
}  // namespace understudy
