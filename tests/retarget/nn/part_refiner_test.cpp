#include "retarget/networks/part_refiner.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/nn/modules/part_refiner.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/weights_file.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy::nn {
namespace {

TEST(PartNets, IgnoreTheOrderOfPoints) {
  torch::manual_seed(1);
  const torch::NoGradGuard no_grad;
  PartRefinerNet net;
  const auto context = torch::randn({1, kPartContext});
  const Points points = 0.1f * Points::Random(kPartPoints, 3);
  for (const PartKind kind : {PartKind::Hand, PartKind::Leg}) {
    const auto seen = [&](const Points& cloud) {
      const Points rows = seen_in_patches(kind) ? cut_part_patches(cloud) : cloud;
      return net->of(kind).forward(tensor_of(rows).unsqueeze(0), context);
    };
    EXPECT_TRUE(torch::allclose(seen(points), seen(points.colwise().reverse()), 0, 1e-5));
  }
}

class PartRefinerFile : public testing::Test {
 protected:
  PartRefinerFile() {
    torch::manual_seed(2);
    path_ = (std::filesystem::temp_directory_path() / "understudy_part_test.weights").string();
    save_weights(path_, {kPartFileKind, kPartVersion, {}}, *PartRefinerNet());
    const PosedSkeleton posed = forward_kinematics(human_rest(), fixtures::dance(1));
    seen_.joints = posed.joints;
    seen_.global = posed.global;
    Rng rng(3);
    scan_.vertices.resize(4000, 3);
    for (Eigen::Index i = 0; i < scan_.vertices.rows(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        scan_.vertices(i, axis) = posed.joints(i % kJointCount, axis) + 0.05f * rng.normal();
  }
  ~PartRefinerFile() override { std::filesystem::remove(path_); }

  std::string path_;
  Extraction seen_;
  Mesh scan_;
};

TEST_F(PartRefinerFile, CorrectsLimbsAndHeadAndNothingElse) {
  Extraction refined = seen_;
  load_part_refiner(path_)->refine(scan_, refined);
  std::array<bool, kJointCount> told{}, moved{};
  for (const Part& part : kCroppedParts)
    for (int k = 0; k < kPartJoints; ++k) {
      const int j = part.corrects[static_cast<size_t>(k)];
      if (j < 0) continue;
      told[static_cast<size_t>(j)] = true;
      moved[static_cast<size_t>(j)] = k < part.moves;
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

TEST_F(PartRefinerFile, BelievesNoCropThatWasCutWhereTheJointMayNotBe) {
  Extraction sure = seen_, lost = seen_;
  sure.confidence.setConstant(0.99f);
  lost.confidence.setConstant(0.05f);
  load_part_refiner(path_)->refine(scan_, sure);
  load_part_refiner(path_)->refine(scan_, lost);
  EXPECT_EQ(sure.joints, lost.joints);
  EXPECT_GT(sure.confidence.mean(), 0.5f);
  EXPECT_LT(lost.confidence.maxCoeff(), 0.051f);
}

TEST_F(PartRefinerFile, LeavesAnExtractionWithoutRotationsAlone) {
  seen_.global.reset();
  load_part_refiner(path_)->refine(scan_, seen_);
  EXPECT_FALSE(seen_.global);
}

TEST_F(PartRefinerFile, LeavesWhatNoPointShows) {
  const Extraction before = seen_;
  scan_.vertices.rowwise() += Vec3(10, 0, 0).transpose();
  load_part_refiner(path_)->refine(scan_, seen_);
  for (size_t j = 0; j < kJointCount; ++j) EXPECT_EQ((*seen_.global)[j], (*before.global)[j]);
  EXPECT_EQ(seen_.joints, before.joints);
}

}  // namespace
}  // namespace understudy::nn
