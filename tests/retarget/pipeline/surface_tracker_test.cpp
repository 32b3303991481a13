#include "retarget/pipeline/surface_tracker.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/skinning.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

constexpr int kWatched = 40, kSettled = 16;

/// The built-in person, dancing: scans in which no point has a fellow in the next, and an extractor's
/// skeletons that err anew in each frame but the first.
class Dancer {
 public:
  PosedSkeleton truth(int frame) const {
    return forward_kinematics(body_.joints, fixtures::dance(static_cast<float>(frame) / 30));
  }
  Mesh scan(int frame, int count = 6000) const {
    Mesh posed{linear_blend_skinning(body_.vertices, body_.weights, body_.joints, truth(frame)), body_.faces};
    Rng rng(100 + frame);
    return Mesh{sample_points(posed, count, rng)};
  }
  Extraction seen(int frame) {
    const PosedSkeleton posed = truth(frame);
    Extraction seen;
    seen.joints = posed.joints;
    seen.global = posed.global;
    if (frame == 0) return seen;
    for (int j = 0; j < kJointCount; ++j) {
      seen.joints.row(j) += 0.01f * some().transpose();
      (*seen.global)[j] = rotation_from_axis_angle(0.05f * some()) * posed.global[j];
    }
    return seen;
  }

 private:
  Vec3 some() { return {rng_.normal(), rng_.normal(), rng_.normal()}; }

  ShapedBody body_ = builtin_person();
  Rng rng_{7};
};

struct Errors {
  float joints_mm = 0, turns_deg = 0;
  void add(const Extraction& seen, const PosedSkeleton& truth) {
    joints_mm += 1000 * (seen.joints - truth.joints).rowwise().norm().mean();
    for (int j = 0; j < kJointCount; ++j)
      turns_deg += 180 / kPi * geodesic_angle((*seen.global)[j], truth.global[j]) / kJointCount;
  }
};

TEST(SurfaceTracker, TakesOutWhatAnExtractorErrsAnewInEachFrame) {
  Dancer dancer;
  SurfaceTracker tracker;
  Errors extracted, followed;
  for (int i = 0; i < kWatched; ++i) {
    const Extraction seen = dancer.seen(i), kept = tracker.follow(seen, dancer.scan(i));
    if (i < kSettled) continue;
    extracted.add(seen, dancer.truth(i));
    followed.add(kept, dancer.truth(i));
  }
  EXPECT_LT(followed.joints_mm, 0.5f * extracted.joints_mm) << extracted.joints_mm / (kWatched - kSettled);
  EXPECT_LT(followed.turns_deg, 0.75f * extracted.turns_deg) << extracted.turns_deg / (kWatched - kSettled);
}

TEST(SurfaceTracker, LeavesTheFirstFrameAndWhatHasNoRotationsAsItIs) {
  Dancer dancer;
  SurfaceTracker tracker;
  const Extraction first = dancer.seen(0);
  EXPECT_EQ(tracker.follow(first, dancer.scan(0)).joints, first.joints);
  Extraction bare = dancer.seen(1);
  bare.global.reset();
  EXPECT_EQ(tracker.follow(bare, dancer.scan(1)).joints, bare.joints);
  const Extraction after = dancer.seen(2);  // as if it were the first again
  EXPECT_EQ(tracker.follow(after, dancer.scan(2)).joints, after.joints);
}

TEST(SurfaceTracker, GivesTheSameAgainAfterARestart) {
  Dancer dancer;
  const std::vector<Extraction> seen = {dancer.seen(0), dancer.seen(1), dancer.seen(2)};
  SurfaceTracker tracker;
  const auto last = [&] {
    Extraction kept;
    for (int i = 0; i < 3; ++i) kept = tracker.follow(seen[i], dancer.scan(i));
    return kept.joints;
  };
  const Joints once = last();
  tracker.restart();
  EXPECT_EQ(last(), once);
}

TEST(SurfaceTracker, StaysNearWhatIsExtractedWhereTheSurfaceIsGone) {
  Dancer dancer;
  SurfaceTracker tracker;
  for (int i = 0; i < 5; ++i) tracker.follow(dancer.seen(i), dancer.scan(i));
  Mesh elsewhere = dancer.scan(5);
  elsewhere.vertices.array() += 30;
  elsewhere.vertices.row(0).setConstant(std::numeric_limits<float>::quiet_NaN());
  const Extraction seen = dancer.seen(5), kept = tracker.follow(seen, elsewhere);
  ASSERT_TRUE(kept.joints.allFinite());
  EXPECT_LT((kept.joints - seen.joints).rowwise().norm().maxCoeff(), 0.06f);
}

/// A box about each bone: far fewer corners than places to look at.
Mesh boxes(const PosedSkeleton& posed) {
  Mesh mesh;
  mesh.vertices.resize(8 * (kJointCount - 1), 3);
  mesh.faces.resize(12 * (kJointCount - 1), 3);
  constexpr int kSides[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (int j = 1; j < kJointCount; ++j) {
    const int first = 8 * (j - 1), p = kParents[j];
    const Vec3 along = posed.global[p].transpose() * (posed.joints.row(j) - posed.joints.row(p)).transpose();
    for (int c = 0; c < 8; ++c) {
      const Vec3 corner(c & 1 ? 0.04f : -0.04f, c & 2 ? 0.06f : -0.06f, c & 4 ? 0.05f : -0.05f);
      const Vec3 local = corner + (corner.dot(along) > 0 ? along : Vec3(Vec3::Zero()));
      mesh.vertices.row(first + c) = posed.joints.row(p) + (posed.global[p] * local).transpose();
    }
    for (int side = 0; side < 6; ++side) {
      const int* q = kSides[side];
      mesh.faces.row(12 * (j - 1) + 2 * side) << first + q[0], first + q[1], first + q[2];
      mesh.faces.row(12 * (j - 1) + 2 * side + 1) << first + q[0], first + q[2], first + q[3];
    }
  }
  return mesh;
}

TEST(SurfaceTracker, LooksAtTheFacesOfAMeshOfFewCorners) {
  const auto error = [](bool faces) {
    Dancer dancer;
    SurfaceTracker tracker;
    Errors followed;
    for (int i = 0; i < kWatched; ++i) {
      Mesh scan = boxes(dancer.truth(i));
      if (!faces) scan.faces.resize(0, 3);
      const Extraction kept = tracker.follow(dancer.seen(i), scan);
      if (i >= kSettled) followed.add(kept, dancer.truth(i));
    }
    return followed.turns_deg;
  };
  EXPECT_LT(error(true), 0.8f * error(false));
}

}  // namespace
}  // namespace understudy
