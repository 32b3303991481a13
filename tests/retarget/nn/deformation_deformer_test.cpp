// The facade: what bind() and deform() promise.
#include "retarget/networks/network_deformer.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include "retarget/base/error.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/nn/modules/deformation.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/skeleton/skinning.hpp"
#include "tests/retarget/nn/deformation_support.hpp"

namespace understudy::nn {
namespace {

namespace fs = std::filesystem;

torch::Tensor tensor_of(const float* data, int64_t rows, int64_t cols) {
  return torch::from_blob(const_cast<float*>(data), {rows, cols}).clone();
}

class NetworkDeformerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(11);
    net_ = DeformationNet();
    path_ = (fs::temp_directory_path() / ("deformer_" + std::to_string(::getpid()) + ".weights")).string();
    save_weights(path_, {"deformation", kDeformationVersion, {}}, *net_, /*half=*/false);
    body_ = testing::octahedron_body().shaped(Eigen::VectorXf());
    Rng rng(1);
    Mesh mesh;
    mesh.vertices = body_.vertices;
    mesh.faces = body_.faces;
    points_ = sample_points(mesh, 700, rng);
  }
  void TearDown() override { fs::remove(path_); }

  DeformationNet net_{nullptr};
  std::string path_;
  ShapedBody body_;
  Points points_;
};

TEST_F(NetworkDeformerTest, WeightsSumToOne) {
  const auto deformer = load_network_deformer(path_, true);
  deformer->bind(points_, body_.joints);
  ASSERT_EQ(deformer->weights().rows(), 700);
  EXPECT_LT((deformer->weights().rowwise().sum().array() - 1).abs().maxCoeff(), 1e-5f);
  EXPECT_GE(deformer->weights().minCoeff(), 0.f);
}

TEST_F(NetworkDeformerTest, PointOrderDoesNotMatter) {
  const auto deformer = load_network_deformer(path_, true);
  deformer->bind(points_, body_.joints);
  const RowMatrix weights = deformer->weights();
  const Points posed = deformer->deform(testing::random_test_pose(1));
  std::vector<int> order(points_.rows());
  std::iota(order.begin(), order.end(), 0);
  Rng rng(4);
  for (size_t i = order.size(); i-- > 1;) std::swap(order[i], order[rng.below(static_cast<int>(i + 1))]);
  Points shuffled(points_.rows(), 3);
  for (size_t i = 0; i < order.size(); ++i) shuffled.row(i) = points_.row(order[i]);
  deformer->bind(shuffled, body_.joints);
  const Points shuffled_posed = deformer->deform(testing::random_test_pose(1));
  for (size_t i = 0; i < order.size(); ++i) {
    EXPECT_LT((deformer->weights().row(i) - weights.row(order[i])).cwiseAbs().maxCoeff(), 3e-3f);
    EXPECT_LT((shuffled_posed.row(i) - posed.row(order[i])).norm(), 1e-3f);
  }
}

TEST_F(NetworkDeformerTest, FastPathEqualsTheFormula) {
  const auto deformer = load_network_deformer(path_, true);
  deformer->bind(points_, body_.joints);
  const Points spread = spread_points(points_, static_cast<int>(net_->options.context_points));
  const auto bound = bind_surface(net_, tensor_of(points_.data(), points_.rows(), 3),
                                  tensor_of(body_.joints.data(), kJointCount, 3),
                                  tensor_of(spread.data(), spread.rows(), 3));
  const torch::Tensor basis = bound.basis.contiguous();
  const Eigen::Map<const RowMatrix> B(basis.data_ptr<float>(), 3 * points_.rows(), kPoseFeatureCount);
  for (uint64_t seed = 0; seed < 5; ++seed) {
    const Pose pose = testing::random_test_pose(seed);
    Points rest = points_;
    Eigen::Map<Eigen::VectorXf>(rest.data(), rest.size()) += B * pose_features(pose.local);
    const Points expected = linear_blend_skinning(rest, deformer->weights(), body_.joints,
                                                  forward_kinematics(body_.joints, pose));
    EXPECT_LT((deformer->deform(pose) - expected).rowwise().norm().maxCoeff(), 5e-5f) << "seed " << seed;
  }
}

TEST_F(NetworkDeformerTest, ZeroRotationsGiveTheRestShape) {
  const auto deformer = load_network_deformer(path_, true);
  deformer->bind(points_, body_.joints);
  Pose rest;
  rest.root = body_.joints.row(Pelvis).transpose();
  EXPECT_LT((deformer->deform(rest) - points_).cwiseAbs().maxCoeff(), 1e-5f);
  rest.root += Vec3(1, 2, 3);
  const Points moved = points_.rowwise() + Eigen::RowVector3f(1, 2, 3);
  EXPECT_LT((deformer->deform(rest) - moved).cwiseAbs().maxCoeff(), 1e-5f);
}

TEST_F(NetworkDeformerTest, MovedTargetGetsTheSameWeights) {
  const auto deformer = load_network_deformer(path_, true);
  deformer->bind(points_, body_.joints);
  const RowMatrix weights = deformer->weights();
  const Eigen::RowVector3f t(0.5f, -0.25f, 2);
  deformer->bind(points_.rowwise() + t, body_.joints.rowwise() + t);
  EXPECT_LT((deformer->weights() - weights).cwiseAbs().maxCoeff(), 5e-3f);
}

TEST_F(NetworkDeformerTest, WithoutOffsetsItIsLinearBlendSkinning) {
  const auto deformer = load_network_deformer(path_, false);
  deformer->bind(points_, body_.joints);
  const Pose pose = testing::random_test_pose(2);
  const Points expected = linear_blend_skinning(points_, deformer->weights(), body_.joints,
                                                forward_kinematics(body_.joints, pose));
  EXPECT_LT((deformer->deform(pose) - expected).rowwise().norm().maxCoeff(), 1e-5f);
}

TEST_F(NetworkDeformerTest, TakesAHandfulOfPoints) {
  const auto deformer = load_network_deformer(path_, true);
  deformer->bind(points_.topRows(3), body_.joints);
  EXPECT_EQ(deformer->deform(Pose()).rows(), 3);
}

TEST_F(NetworkDeformerTest, RefusesWhatIsNoTarget) {
  const auto deformer = load_network_deformer(path_, true);
  EXPECT_THROW(deformer->deform(Pose()), Error);
  EXPECT_THROW(deformer->bind(Points(0, 3), body_.joints), Error);
  Points broken = points_;
  broken(5, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(deformer->bind(broken, body_.joints), Error);
  Joints bad = body_.joints;
  bad(2, 2) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(deformer->bind(points_, bad), Error);
}

TEST_F(NetworkDeformerTest, NaNOfTheNetworkIsAnError) {
  {
    const torch::NoGradGuard no_grad;
    net_->to_weights->bias[3] = std::numeric_limits<float>::quiet_NaN();
  }
  save_weights(path_, {"deformation", kDeformationVersion, {}}, *net_, false);
  const auto deformer = load_network_deformer(path_, true);
  EXPECT_THROW(deformer->bind(points_, body_.joints), Error);
}

TEST_F(NetworkDeformerTest, RefusesOtherWeights) {
  EXPECT_THROW(load_network_deformer(path_ + ".absent", true), Error);
  save_weights(path_, {"motion", kDeformationVersion, {}}, *net_, false);
  EXPECT_THROW(load_network_deformer(path_, true), Error);
  save_weights(path_, {"deformation", kDeformationVersion + 1, {}}, *net_, false);
  EXPECT_THROW(load_network_deformer(path_, true), Error);
  std::ofstream(path_) << "no weights";
  EXPECT_THROW(load_network_deformer(path_, true), Error);
}

TEST(SpreadPoints, CoversAllOfIt) {
  Rng rng(1);
  Points points(2000, 3);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = rng.uniform();
  const Points spread = spread_points(points, 200);
  const auto near = nearest_neighbours(spread, points, 1);
  float farthest = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    farthest = std::max(farthest, (points.row(i) - spread.row(near(i, 0))).norm());
  EXPECT_LT(farthest, 0.2f);
  EXPECT_EQ(spread_points(points.topRows(5), 12).rows(), 12);
}

}  // namespace
}  // namespace understudy::nn
