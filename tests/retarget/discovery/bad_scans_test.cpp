// Scans that are few, many, broken, crowded or too quick: a skeleton all the same, or a doubt that is told.
#include <gtest/gtest.h>

#include <limits>

#include "retarget/base/log.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/discovery/bone_equations.hpp"
#include "retarget/discovery/rig_figures.hpp"
#include "retarget/discovery/seen_things.hpp"
#include "tests/retarget/discovery/bending_arm.hpp"

namespace understudy {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// What is logged meanwhile.
class Told {
 public:
  Told() : before_(log::set_sink([this](log::Level, const std::string& line) { all += line + "\n"; })) {}
  ~Told() { log::set_sink(before_); }
  Told(const Told&) = delete;
  Told& operator=(const Told&) = delete;
  bool says(const std::string& words) const { return all.find(words) != std::string::npos; }
  std::string all;

 private:
  log::Sink before_;
};

Mesh both(const Points& a, const Points& b) {
  Mesh mesh;
  mesh.vertices.resize(a.rows() + b.rows(), 3);
  mesh.vertices << a, b;
  return mesh;
}

/// How far a bone has turned since the first frame.
float turned(const DiscoveredRig& rig, int bone, int frame) {
  const auto& poses = rig.found.motion.poses;
  return geodesic_angle(poses[0].turns[static_cast<size_t>(bone)],
                        poses[static_cast<size_t>(frame)].turns[static_cast<size_t>(bone)]);
}
/// The largest of all bones' turns: where noise makes a bone more, one of them is the elbow.
float most_turned(const DiscoveredRig& rig, int frame) {
  float most = 0;
  for (int j = 1; j < rig.found.rig.count(); ++j) most = std::max(most, turned(rig, j, frame));
  return most;
}

void expect_finite(const DiscoveredRig& rig) {
  EXPECT_NO_THROW(check_rig(rig.found.rig));
  for (const RigPose& pose : rig.found.motion.poses) {
    EXPECT_TRUE(pose.root.allFinite());
    for (const Mat3& turn : pose.turns) EXPECT_TRUE(turn.allFinite());
  }
}

TEST(BadScans, FiveFramesShowAnElbow) {
  const DiscoveredRig rig = discover(sequence(5, [](int t) { return sparse_arm(0.3f * t, t); }));
  expect_finite(rig);
  ASSERT_GE(rig.found.rig.count(), 2);
  EXPECT_GT(most_turned(rig, 4), 0.5f);
}

// Scans come more rarely later: following is what takes the time.
TEST(BadScans, OfThreeThousandFramesSixtyAreSearchedAndTheOthersFollowed) {
  constexpr int kMany = 3000, kAllUntil = 120, kEvery = 12;
  const auto at = [](int t) { return 0.6f - 0.6f * std::cos(0.015f * static_cast<float>(t)); };
  const auto is_seen = [](int t) { return t < kAllUntil || t % kEvery == 0; };
  DiscoveryOptions two;
  two.parts = 2;
  const DiscoveredRig rig = discover(
      sequence(kMany, [&](int t) { return is_seen(t) ? sparse(sparse_arm(at(t), t), 300) : Mesh{}; }), two);
  expect_finite(rig);
  EXPECT_EQ(rig.key_frames.size(), 60u);
  ASSERT_EQ(rig.found.motion.poses.size(), static_cast<size_t>(kMany));
  ASSERT_EQ(rig.found.rig.count(), 2);
  for (int t = 0; t < kMany; ++t) EXPECT_EQ(rig.doubted[static_cast<size_t>(t)], !is_seen(t)) << t;
  for (int t = 0; t < kMany; t += 10 * kEvery) EXPECT_NEAR(turned(rig, 1, t), at(t), 0.15f) << t;
}

TEST(BadScans, OfTwoBodiesItIsSaid) {
  const Told told;
  ScanSequence scans = sequence(8, [](int t) {
    return both(sparse_arm(angle_at(t), t).vertices, sparse_arm(angle_at(8 - t), t, {0, 0, 1.5f}).vertices);
  });
  scans.name = "two.npz";
  expect_finite(discover(scans));
  EXPECT_TRUE(told.says("two.npz: two things that do not touch")) << told.all;
}

TEST(BadScans, OfAFloorLeftInItIsSaid) {
  const Told told;
  const auto with_floor = [](int t) {
    Rng rng(static_cast<uint64_t>(t) + 99);
    Points floor(2000, 3);
    for (auto row : floor.rowwise())
      row << rng.uniform(-0.5f, 1.5f), -0.07f + 0.003f * rng.normal(), rng.uniform(-1, 1);
    return both(sparse_arm(angle_at(t), t).vertices, floor);
  };
  expect_finite(discover(sequence(6, with_floor)));
  EXPECT_TRUE(told.says("a ground is seen")) << told.all;
}

TEST(BadScans, NoCreatureIsTakenForTwoOrForAGround) {
  for (size_t k = 0; k < kCreatureNames.size(); ++k) {
    const Rig rig = make_creature(static_cast<CreatureKind>(k), 100);
    const ThinnedFrame frame = thinned(rig.surface, 600, 600, 1);
    EXPECT_FALSE(shows_two_things(frame)) << kCreatureNames[k];
    EXPECT_FALSE(shows_ground(frame)) << kCreatureNames[k];
  }
}

TEST(BadScans, ABodyThatIsAwayMeanwhileIsFoundAgain) {
  const auto is_away = [](int t) { return t >= 5 && t < 9; };
  const DiscoveredRig rig =
      discover(sequence(14, [&](int t) { return is_away(t) ? Mesh{} : sparse_arm(0.09f * t, t); }));
  expect_finite(rig);
  ASSERT_GE(rig.found.rig.count(), 2);
  for (int t = 0; t < 14; ++t) EXPECT_EQ(rig.doubted[static_cast<size_t>(t)], is_away(t)) << t;
  for (int t = 5; t < 9; ++t) EXPECT_EQ(turned(rig, 1, t), turned(rig, 1, 4)) << t;
  EXPECT_GT(most_turned(rig, 13), 0.8f);
}

TEST(BadScans, LimbsThatAlwaysTouchStillBend) {
  const DiscoveredRig rig = discover(sequence(8, [](int t) {  // two fingers side by side
    return both(sparse_arm(angle_at(t), t).vertices,
                sparse_arm(0.6f * angle_at(t), t, {0, 0, 0.09f}).vertices);
  }));
  expect_finite(rig);
  ASSERT_GE(rig.found.rig.count(), 2);
  EXPECT_GT(most_turned(rig, 7), 0.5f);
  for (size_t t = 0; t < 8; ++t) EXPECT_FALSE(rig.doubted[t]) << t;
}

/// Where the surface is not, the frame is doubted.
void expect_honest(const DiscoveredRig& rig) {
  constexpr float kWell = 0.025f;  // metres: at twice the distance between the scans' points
  for (size_t t = 0; t < rig.off_m.size(); ++t) EXPECT_TRUE(rig.off_m[t] < kWell || rig.doubted[t]) << t;
}

TEST(BadScans, MotionFasterThanALimbIsWideIsFollowedOrDoubted) {
  const auto moving = [](const std::function<float(int)>& angle) {
    return discover(sequence(10, [&](int t) { return sparse_arm(angle(t), t); }));
  };
  const DiscoveredRig jumps = moving([](int t) { return (t < 5 ? 0.0f : 1.4f) + 0.04f * t; });
  expect_honest(jumps);
  expect_honest(moving([](int t) { return t % 2 == 0 ? 0.2f : 1.6f; }));
  EXPECT_FALSE(jumps.doubted[0]);
}

TEST(BadScans, DoubtComparesWithTheBestWhereMostIsBad) {
  EXPECT_EQ(doubted_frames({1, 1, 1, 3, -1}, 10), (std::vector<bool>{false, false, false, true, true}));
  const std::vector<bool> bad = doubted_frames({0.01f, 0.1f, 0.01f, 0.1f, 0.1f, 0.1f}, 1);
  EXPECT_EQ(bad, (std::vector<bool>{false, true, false, true, true, true}));
  // So little of a body of 20 m is no matter.
  EXPECT_EQ(doubted_frames({0.01f, 0.1f, 0.01f, 0.1f, 0.1f, 0.1f}, 20), std::vector<bool>(6, false));
}

TEST(BadScans, OneCameraSeesTheElbowToo) {
  const DiscoveredRig rig = discover(sequence(kFrames, [](int t) {
    const Mesh whole = bent_arm(angle_at(t), static_cast<uint64_t>(t));
    std::vector<char> seen;
    for (const auto& v : whole.vertices.rowwise()) seen.push_back(v.z() > 0);
    return kept_part(whole, seen);
  }));
  expect_finite(rig);
  ASSERT_GE(rig.found.rig.count(), 2);
  EXPECT_NEAR(most_turned(rig, kFrames - 1), angle_at(kFrames - 1), 0.25f);
}

TEST(BadScans, MirroredFramesAreDoubted) {
  const auto is_mirrored = [](int t) { return t == 4 || t == 5; };
  const DiscoveredRig rig = discover(sequence(kFrames, [&](int t) {
    Rng rng(static_cast<uint64_t>(t) + 7);
    Mesh scan =
        both(sparse_arm(angle_at(t), t).vertices, tube({0.2f, 0, 0}, {0.2f, 0.25f, 0.2f}, 0.04f, 300, rng));
    if (is_mirrored(t)) scan.vertices.col(2) *= -1;
    return scan;
  }));
  expect_finite(rig);
  for (int t = 0; t < kFrames; ++t) EXPECT_EQ(rig.doubted[static_cast<size_t>(t)], is_mirrored(t)) << t;
}

TEST(BadScans, CoordinatesThatAreNoNumbersAreLeftOut) {
  const DiscoveredRig rig = discover(sequence(6, [](int t) {
    Mesh scan = sparse_arm(0.2f * t, t);
    for (Eigen::Index i = t; i < scan.vertices.rows(); i += 10) scan.vertices.row(i).setConstant(kNan);
    return scan;
  }));
  expect_finite(rig);
  EXPECT_GE(rig.found.rig.count(), 2);
}

TEST(BadScans, VerticesThatAreNoNumbersAreLeftOutOfASurface) {
  Rig lamp = make_creature(CreatureKind::Lamp, 100);
  const RigMotion motion = creature_motion(CreatureKind::Lamp, lamp, 0, 6, 15, 100);
  const DiscoveredRig rig = discover(sequence(6, [&](int t) {
    Mesh scan{
        skinned(lamp.surface.vertices, lamp.skin, bone_motions(lamp, motion.poses[static_cast<size_t>(t)])),
        lamp.surface.faces};
    scan.vertices.row(5 + t)[1] = kNan;
    return scan;
  }));
  expect_finite(rig);
  EXPECT_EQ(rig.found.rig.surface.vertices.rows(), lamp.surface.vertices.rows() - 1);
  EXPECT_GT(rig.found.rig.surface.faces.rows(), 0);
}

TEST(BoneEquations, OfManyBonesAreSolvedAsThoseOfFew) {
  for (const Eigen::Index count : {60, 900}) {  // a chain: each number with the next
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
    normal.diagonal().setConstant(4);
    normal.diagonal(1).setConstant(-1);
    normal.diagonal(-1).setConstant(-1);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(count, -1, 2);
    EXPECT_LT((solved(normal, normal * x) - x).cwiseAbs().maxCoeff(), 1e-9) << count;
  }
}

}  // namespace
}  // namespace understudy
