#include "app/run/case_maker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/run/case_folder.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/numpy_random.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/labelled_points.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/metrics/bent_volume.hpp"
#include "tests/app/program.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::app {
namespace {

class CaseMaker : public testing::Test {
 protected:
  CaseMaker() {
    test::write_training_folder(scratch.path("data"));
    options.data = scratch.path("data");
    options.out = scratch.path("cases");
    options.frames = 3;
    options.points = 400;
  }
  int make(const std::string& suite) {
    options.suite = suite;
    return make_suite(options, [this](const std::string& name) { names.push_back(name); });
  }
  Case made(const std::string& name) { return read_case(options.out + "/" + name); }
  tests::ScratchFolder scratch;
  SuiteOptions options;
  std::vector<std::string> names;
};

// Figures that NumPy gives for default_rng(12345) and default_rng(1).
TEST(NumpyRandom, DrawsWhatNumpyDraws) {
  NumpyRandom random(12345);
  EXPECT_DOUBLE_EQ(random.random(), 0.22733602246716966);
  EXPECT_NEAR(random.normal(), 1.2637284581291104, 1e-14);
  NumpyRandom other(1);
  EXPECT_EQ(other.permutation(8), (std::vector<int64_t>{5, 0, 1, 4, 2, 6, 3, 7}));
}

// Figures of the third of four cases by an independent program (NumPy) that follows the same protocol: all
// random numbers before it must have been drawn alike.
TEST_F(CaseMaker, MakesTheCaseThatAnIndependentProgramMakes) {
  ASSERT_EQ(make("captured"), 4);
  EXPECT_EQ(names, (std::vector<std::string>{"tall_sway", "short_sway", "heavy_sway", "slim_sway"}));
  const Mesh scan = read_mesh(made("heavy_sway").source + "/frame_00002.ply");
  ASSERT_EQ(scan.vertices.rows(), 364);
  EXPECT_TRUE(
      scan.vertices.row(0).isApprox(Eigen::RowVector3f(-0.26654696f, 1.24442017f, -0.35929939f), 1e-5f));
  EXPECT_NEAR(scan.vertices.cwiseAbs().sum(), 451.91179f, 0.01f);
  const Truth truth = read_truth(made("heavy_sway").truth);
  EXPECT_EQ(truth.frames, 3);
  const auto expect_row = [](const auto& row, float x, float y, float z) {
    EXPECT_LT((row - Eigen::RowVector3f(x, y, z)).norm(), 1e-5f) << row;
  };
  expect_row(truth.joints[2].row(RightWrist), 0.10807583f, 1.8450727f, 0.62734795f);
  expect_row(truth.source_joints[2].row(RightWrist), 0.08687265f, 1.5375606f, 0.5169363f);
  expect_row(truth.rotations[2][0].row(0), -0.26903328f, -0.2032855f, 0.941433f);
  expect_row(truth.frame_vertices(2).row(87), 0.22601017f, 1.856315f, 0.66629785f);
  expect_row(truth.target_joints->row(LeftWrist), 0.768f, 0.552f, 0);
}

TEST_F(CaseMaker, SuitesHaveTheirShape) {
  ASSERT_EQ(make("naked"), 4);
  EXPECT_EQ(made("tall_sway").tags, (std::vector<std::string>{"naked", "sway"}));
  EXPECT_EQ(read_mesh(made("tall_sway").target).vertices.rows(), 88);
  EXPECT_EQ(make("clothed"), 1);
  options.cases = 3;
  ASSERT_EQ(make("extraction"), 3);
  const Case extraction = made("b02");
  EXPECT_TRUE(extraction.target.empty());
  EXPECT_EQ(read_truth(extraction.truth).frames, 12);
  EXPECT_TRUE(read_truth(extraction.truth).joints.empty());
}

TEST_F(CaseMaker, BendsBendEachJointFarAndComeBack) {
  options.cases = 1;
  ASSERT_EQ(make("bends"), 1);
  const Truth truth = read_truth(made("tall").truth);
  ASSERT_EQ(truth.frames, 120);
  for (const int joint : BentVolume::kBends) {
    float most = 0;
    for (const Rotations& local : truth.rotations)
      most = std::max(most, geodesic_angle(local[static_cast<size_t>(joint)], Mat3::Identity()));
    EXPECT_GT(most, 119 * kPi / 180) << kJointNames[static_cast<size_t>(joint)];
  }
  EXPECT_LT(geodesic_angle(truth.rotations[0][LeftElbow], Mat3::Identity()), 1e-3f);
}

TEST_F(CaseMaker, OccludedSourcesAreTaggedAndCoverAllKinds) {
  options.cases = 6;
  ASSERT_EQ(make("occluded"), 6);
  EXPECT_EQ(names.front(), "b00_skirt");
  EXPECT_EQ(made("b05_limbless").tags, (std::vector<std::string>{"occluded", "sway", "limbless"}));
  EXPECT_GT(read_mesh(made("b00_skirt").source + "/frame_00003.ply").vertices.rows(), 0);
  EXPECT_FALSE(read_truth(made("b03_held").truth).source_joints.empty());
}

TEST_F(CaseMaker, HandsMoveAndAllElseIsTheNakedSuites) {
  options.frames = 60;
  options.cases = 1;
  ASSERT_EQ(make("naked"), 1);
  const Truth naked = read_truth(made("tall_sway").truth);
  ASSERT_EQ(make("hands"), 1);
  const Truth hands = read_truth(made("tall_sway").truth);
  ASSERT_EQ(naked.frames, 56);  // the clip ends there
  ASSERT_EQ(hands.frames, 45);
  EXPECT_TRUE(hands.source_joints[0].isApprox(naked.source_joints[0], 1e-3f));
  EXPECT_EQ(hands.rotations[44][Pelvis], naked.rotations[44][Pelvis]);
  EXPECT_EQ(made("tall_sway").tags, (std::vector<std::string>{"hands", "sway"}));
  std::filesystem::remove(options.data + "/body/hand_poses.npz");
  EXPECT_THROW(make("hands"), Error);
}

float nearest_to(const Eigen::RowVector3f& x, const Points& points) {
  return points.rows() == 0 ? 1e9f : (points.rowwise() - x).rowwise().norm().minCoeff();
}

Points scan_of(const Case& c, size_t frame, const std::string& folder = "source") {
  const auto root = std::filesystem::path(c.source).parent_path();
  return read_mesh((root / folder / printed("frame_%05zu.ply", frame)).string()).vertices;
}

TEST_F(CaseMaker, SeenJointsOfHalfBodiesHavePointsAndFeetHaveNone) {
  options.points = 800;
  options.cases = 8;
  ASSERT_EQ(make("partial"), 8);
  EXPECT_EQ(names[3], "desk0");
  for (const std::string& name : names) {
    const Case c = made(name);
    const Truth truth = read_truth(c.truth);
    ASSERT_EQ(truth.source_seen.size(), 3u) << name;
    int unseen = 0;
    for (size_t t = 0; t < 3; ++t) {
      const Points scan = scan_of(c, t);
      EXPECT_EQ(truth.source_seen[t][Head], 1) << name;
      for (int j = 0; j < kJointCount; ++j) {
        const float away = nearest_to(truth.source_joints[t].row(j), scan);
        if (truth.source_seen[t][j] == 1) EXPECT_LT(away, 0.2f) << name << " " << kJointNames[j];
        unseen += truth.source_seen[t][j] == 0;
      }
      if (name[0] == 'd') continue;  // a desk hides what it hides, and its own points may be there
      for (const int foot : {LeftFoot, RightFoot}) {
        EXPECT_EQ(truth.source_seen[t][foot], 0) << name;
        EXPECT_GT(nearest_to(truth.source_joints[t].row(foot), scan), 0.15f) << name;
      }
    }
    EXPECT_GT(unseen, name[0] == 'd' ? 0 : 6) << name;
  }
}

TEST_F(CaseMaker, SensorsHaveTheGroundUnderThePersonAndAsManyPointsAsWanted) {
  options.cases = 6;
  ASSERT_EQ(make("sensors"), 6);
  EXPECT_EQ(names, (std::vector<std::string>{"one0", "three0", "ten0", "one1", "three1", "ten1"}));
  for (const std::string& name : names) {
    const Case c = made(name);
    const Truth truth = read_truth(c.truth);
    EXPECT_EQ(c.tags, (std::vector<std::string>{"sensors", name.substr(0, name.size() - 1)}));
    for (size_t t = 0; t < 3; ++t) {
      const Points scan = scan_of(c, t);
      if (t > 0) EXPECT_NEAR(scan.rows(), name.back() == '0' ? 5000 : 15000, 4500) << name;
      const Joints& joints = truth.source_joints[t];
      int ground = 0;
      for (const auto& x : scan.rowwise()) ground += std::abs(x.y()) < 0.1f && nearest_to(x, joints) > 0.4f;
      EXPECT_GT(ground, 0.1 * static_cast<double>(scan.rows())) << name;
      EXPECT_GT(joints.col(1).minCoeff(), 0) << name;
      EXPECT_LT(joints.col(1).minCoeff(), 0.4f) << name;
      for (int j = 0; j < kJointCount; ++j)
        if (truth.source_seen[t][j] == 1) EXPECT_LT(nearest_to(joints.row(j), scan), 0.25f) << name;
    }
  }
}

class Scenes : public CaseMaker {
 protected:
  Scenes() {
    options.frames = 12;
    options.points = 2000;
    options.cases = 5;
    make("scenes");
  }
  Truth truth_of(const std::string& name) { return read_truth(made(name).truth); }
};

float nearest_people(const TruePeople& frame) {
  float nearest = 1e9f;
  for (size_t p = 0; p < frame.people.size(); ++p)
    for (size_t q = 0; q < p; ++q)
      for (const auto& joint : frame.people[p].joints.rowwise())
        nearest = std::min(nearest, nearest_to(joint, frame.people[q].joints));
  return nearest;
}

TEST_F(Scenes, PointsAreOnTheirOwnersAndSeenJointsHavePoints) {
  ASSERT_EQ(names, (std::vector<std::string>{"1p_apart_3c", "2p_cross_4c", "2p_handshake_4c", "4p_cross_6c",
                                             "3p_leave_4c"}));
  for (const std::string& name : names) {
    const Truth truth = truth_of(name);
    ASSERT_EQ(truth.scene.size(), 12u);
    for (size_t t = 0; t < 12; t += 5) {
      const TruePeople& frame = truth.scene[t];
      const Points scan = scan_of(made(name), t);
      ASSERT_EQ(static_cast<size_t>(scan.rows()), frame.owners.size());
      std::vector<std::vector<Vec3>> own(frame.people.size());
      int scene = 0, off = 0;
      for (int i = 0; i < scan.rows(); ++i) {
        const int owner = frame.owners[i];
        scene += owner == kNobodysPoint;
        if (owner < 0) continue;
        own[owner].push_back(scan.row(i).transpose());
        off += nearest_to(scan.row(i), frame.people[owner].joints) > 0.25f;
      }
      EXPECT_LT(off, 0.02 * static_cast<double>(scan.rows())) << name;
      EXPECT_GT(scene, 0.1 * static_cast<double>(scan.rows())) << name;
      for (size_t p = 0; p < own.size(); ++p)
        for (int j = 0; j < kJointCount; ++j)
          if (frame.people[p].seen[j] == 1)
            EXPECT_LT(nearest_to(frame.people[p].joints.row(j), rows_of(own[p])), 0.25f) << name;
    }
  }
}

TEST_F(Scenes, PeopleMeetAsTheirNameSays) {
  for (const char* const name : {"2p_cross_4c", "4p_cross_6c", "3p_leave_4c"})
    for (const TruePeople& frame : truth_of(name).scene) EXPECT_GT(nearest_people(frame), 0.2f) << name;
  const Truth shake = truth_of("2p_handshake_4c");
  const auto hands_apart = [&](size_t t) {
    const auto& people = shake.scene[t].people;
    return (people[0].joints.row(RightWrist) - people[1].joints.row(RightWrist)).norm();
  };
  EXPECT_GT(hands_apart(0), 0.3f);
  EXPECT_LT(hands_apart(6), 0.25f);
}

TEST_F(Scenes, WhoLeavesHasNoPointsAndComesBack) {
  const Truth truth = truth_of("3p_leave_4c");
  for (size_t t = 0; t < 12; ++t) {
    const bool is_away = t >= 3 && t < 7;
    const auto& owners = truth.scene[t].owners;
    EXPECT_EQ(std::count(owners.begin(), owners.end(), 0) == 0, is_away) << t;
    EXPECT_EQ(truth.scene[t].people[0].seen.sum() == 0, is_away) << t;
    EXPECT_GT(std::count(owners.begin(), owners.end(), 1), 20) << t;
  }
}

TEST_F(Scenes, EachPersonIsScannedAloneToo) {
  const Case c = made("4p_cross_6c");
  const Truth truth = read_truth(c.truth);
  ASSERT_EQ(c.alone.size(), 4u);
  for (size_t p = 0; p < 4; ++p) {
    const Points scan = scan_of(c, 11, "alone_" + std::to_string(p));
    ASSERT_GT(scan.rows(), 100);
    int off = 0;
    for (const auto& x : scan.rowwise()) off += nearest_to(x, truth.scene[11].people[p].joints) > 0.25f;
    EXPECT_LT(off, 0.15 * static_cast<double>(scan.rows()));  // what flies behind edges
  }
}

TEST_F(Scenes, AreTheSameAgainAndOthersWithAnotherSeed) {
  const Points scan = scan_of(made("2p_cross_4c"), 3);
  const std::vector<int> owners = truth_of("2p_cross_4c").scene[3].owners;
  options.cases = 2;
  make("scenes");
  EXPECT_EQ(scan_of(made("2p_cross_4c"), 3), scan);
  EXPECT_EQ(truth_of("2p_cross_4c").scene[3].owners, owners);
  options.seed = 1;
  make("scenes");
  EXPECT_NE(scan_of(made("2p_cross_4c"), 3).row(0), scan.row(0));
}

TEST_F(CaseMaker, SaysWhatIsMissing) {
  options.split = "test";
  EXPECT_THROW(make("naked"), Error);
  options.split = "dev";
  options.data = scratch.path("absent");
  EXPECT_THROW(make("naked"), Error);
  EXPECT_FALSE(std::filesystem::exists(options.out));
}

}  // namespace
}  // namespace understudy::app
