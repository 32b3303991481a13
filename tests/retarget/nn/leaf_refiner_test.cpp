#include "retarget/nn/leaf_refiner.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/nn/modules/leaf_refiner.hpp"
#include "retarget/nn/weights_file.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy::nn {
namespace {

TEST(LeafNet, IgnoresTheOrderOfPoints) {
  torch::manual_seed(1);
  const torch::NoGradGuard no_grad;
  LeafNet net;
  const auto points = torch::randn({2, kLeafPoints, 3}), context = torch::randn({2, kLeafContext});
  const auto shuffled = points.index_select(1, torch::randperm(kLeafPoints));
  EXPECT_TRUE(torch::allclose(net(points, context), net(shuffled, context), 0, 1e-5));
}

class LeafRefinerFile : public testing::Test {
 protected:
  LeafRefinerFile() {
    torch::manual_seed(2);
    path_ = (std::filesystem::temp_directory_path() / "understudy_leaf_test.weights").string();
    save_weights(path_, {"leaf", kLeafVersion, {}}, *LeafRefinerNet());
    const PosedSkeleton posed = forward_kinematics(human_rest(), fixtures::dance(1));
    seen_.joints = posed.joints;
    seen_.global = posed.global;
    Rng rng(3);
    scan_.vertices.resize(4000, 3);
    for (Eigen::Index i = 0; i < scan_.vertices.rows(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        scan_.vertices(i, axis) = posed.joints(i % kJointCount, axis) + 0.05f * rng.normal();
  }
  ~LeafRefinerFile() override { std::filesystem::remove(path_); }

  std::string path_;
  Extraction seen_;
  Mesh scan_;
};

TEST_F(LeafRefinerFile, CorrectsLimbsAndHeadAndNothingElse) {
  Extraction refined = seen_;
  load_leaf_refiner(path_)->refine(scan_, refined);
  std::array<bool, kJointCount> told{}, moved{};
  for (const Leaf& leaf : kLeaves)
    for (int k = 0; k < kLeafJoints; ++k) {
      const int j = leaf.corrects[static_cast<size_t>(k)];
      if (j < 0) continue;
      told[static_cast<size_t>(j)] = true;
      moved[static_cast<size_t>(j)] = k < leaf.moves;
    }
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    EXPECT_EQ((*refined.global)[j] != (*seen_.global)[j], told[j]) << j;
    EXPECT_EQ(refined.joints.row(row) != seen_.joints.row(row), moved[j]) << j;
    EXPECT_EQ(refined.confidence[row] != seen_.confidence[row], moved[j]) << j;
  }
  EXPECT_TRUE((refined.confidence > 0 && refined.confidence < 1.001f).all());
  for (const Mat3& R : *refined.global) EXPECT_LT((R * R.transpose() - Mat3::Identity()).norm(), 1e-4f);
}

TEST_F(LeafRefinerFile, BelievesNoCropThatWasCutWhereTheJointMayNotBe) {
  Extraction sure = seen_, lost = seen_;
  sure.confidence.setConstant(0.99f);
  lost.confidence.setConstant(0.05f);
  load_leaf_refiner(path_)->refine(scan_, sure);
  load_leaf_refiner(path_)->refine(scan_, lost);
  EXPECT_EQ(sure.joints, lost.joints);
  EXPECT_GT(sure.confidence.mean(), 0.5f);
  EXPECT_LT(lost.confidence.maxCoeff(), 0.051f);
}

TEST_F(LeafRefinerFile, LeavesAnExtractionWithoutRotationsAlone) {
  seen_.global.reset();
  load_leaf_refiner(path_)->refine(scan_, seen_);
  EXPECT_FALSE(seen_.global);
}

TEST_F(LeafRefinerFile, LeavesWhatNoPointShows) {
  const Extraction before = seen_;
  scan_.vertices.rowwise() += Vec3(10, 0, 0).transpose();
  load_leaf_refiner(path_)->refine(scan_, seen_);
  for (size_t j = 0; j < kJointCount; ++j) EXPECT_EQ((*seen_.global)[j], (*before.global)[j]);
  EXPECT_EQ(seen_.joints, before.joints);
}

}  // namespace
}  // namespace understudy::nn
