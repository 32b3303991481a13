#include "app/run/case_maker.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "app/run/case_folder.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/numpy_random.hpp"
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
