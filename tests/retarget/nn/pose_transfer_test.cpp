// The peer without a skeleton: its network, its frames and its training.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/pose_transfer.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/peers/surface_joints.hpp"
#include "retarget/training/pose_transfer_trainer.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace testing;
using namespace training;

/// Few points, so that it is quick.
PoseTransferBatch small_batch(ScanMaker& maker, int count) {
  PoseTransferBatch batch = make_pose_transfer_batch(maker, count);
  for (auto* points : {&batch.source, &batch.rest, &batch.posed})
    *points = points->slice(1, 0, 96).contiguous();
  return batch;
}

class PoseTransfer : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
  }
  void TearDown() override { log::set_sink(before_); }
  std::string file(const char* name) const { return folder_.path() + "/" + name; }

  DataFolder folder_;
  log::Sink before_;
};

TEST_F(PoseTransfer, PairsAreOnePostureOnTwoPeople) {
  const TrainingData data = load_training_data(folder_.path(), Split::Train);
  ScanMakerOptions options;
  options.captured = 0;
  ScanMaker maker(data, options, 3);
  const PosedPair pair = maker.pair();
  EXPECT_EQ(pair.source.rows(), nn::kScanPoints);
  EXPECT_EQ(pair.rest.rows(), nn::kScanPoints);
  EXPECT_EQ(pair.posed.rows(), nn::kScanPoints);
  EXPECT_GT((pair.posed - pair.rest).rowwise().norm().mean(), 0.01f);  // it is posed
}

TEST_F(PoseTransfer, ReadsTheSourceInAnyOrderAndFollowsTheTargets) {
  torch::manual_seed(1);
  const torch::NoGradGuard no_grad;
  nn::PoseTransferNet net;
  const auto source = torch::randn({1, 100, 3}), rest = torch::randn({1, 40, 3});
  const auto made = net->forward(source, rest);
  EXPECT_TRUE(torch::allclose(made, net->forward(source.flip(1), rest), 0, 1e-4));
  EXPECT_TRUE(torch::allclose(made.flip(1), net->forward(source, rest.flip(1)), 0, 1e-4));
  EXPECT_FALSE(torch::allclose(made, net->forward(2 * source, rest), 0, 1e-3));
  // Points beyond those that count change nothing but themselves.
  const auto more = torch::cat({rest, 3 * torch::randn({1, 500, 3})}, 1);
  EXPECT_TRUE(torch::allclose(made, net->forward(source, more, 40).narrow(1, 0, 40), 0, 1e-4));
}

TEST_F(PoseTransfer, OneBatchCanBeLearntByHeart) {
  const TrainingData data = load_training_data(folder_.path(), Split::Train);
  ScanMaker maker(data, {}, 3);
  const PoseTransferBatch batch = small_batch(maker, 2);
  PoseTransferTrainer trainer(1);
  const double first = trainer.judge(batch);
  for (int i = 0; i < 60; ++i) trainer.step(batch, 0);
  EXPECT_LT(trainer.judge(batch), 0.6 * first);
}

TEST_F(PoseTransfer, GoingOnFromACheckpointIsTheSameAsNeverStopping) {
  const TrainingData data = load_training_data(folder_.path(), Split::Train);
  ScanMaker maker(data, {}, 3);
  const PoseTransferBatch batch = small_batch(maker, 1);
  PoseTransferTrainer whole(1), first(1), second(2);
  for (int i = 0; i < 4; ++i) whole.step(batch, i / 4.0);
  for (int i = 0; i < 2; ++i) first.step(batch, i / 4.0);
  first.save_checkpoint(file("half"));
  second.load_checkpoint(file("half"));
  for (int i = 2; i < 4; ++i) second.step(batch, i / 4.0);
  const auto a = whole.net->parameters(), b = second.net->parameters();
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(torch::equal(a[i], b[i]));
  std::ofstream(file("junk")) << "not a checkpoint";
  EXPECT_THROW(second.load_checkpoint(file("junk")), Error);
}

TEST_F(PoseTransfer, TheCommandTrainsAndItsWeightsMoveATarget) {
  nn::TrainOptions options;
  options.network = "pose-transfer";
  options.data = folder_.path();
  options.out = file("pose.weights");
  options.batch = 1;
  options.threads = 1;
  options.samples = 2;
  EXPECT_EQ(train_pose_transfer(options), 0);
  options.samples = 3;
  EXPECT_EQ(train_pose_transfer(options), 0);
  EXPECT_EQ(nn::read_weights_header(options.out).numbers.at("samples"), 3);

  auto peer = nn::load_pose_transfer(options.out);
  Rng rng(1);
  Points rest(300, 3);
  for (int i = 0; i < rest.size(); ++i) rest.data()[i] = rng.normal();
  Mesh scan;
  scan.vertices = rest * 0.5f;
  scan.vertices.col(1).array() += 3 - scan.vertices.col(1).minCoeff();
  EXPECT_THROW(peer->push(scan, 0), Error);  // no target yet
  peer->reset({rest});
  const Points first = peer->push(scan, 0);
  EXPECT_EQ(first.rows(), 300);
  EXPECT_TRUE(first.allFinite());
  peer->reset({rest});
  EXPECT_EQ(peer->push(scan, 0), first);  // the same again
  // Whoever turns, and is told to face elsewhere, turns the result.
  const Mat3 turn = rotation_about_y(1.0f);
  Mesh turned = scan;
  turned.vertices = scan.vertices * turn.transpose();
  peer->reset({rest});
  EXPECT_LT((peer->push(turned, 1.0f) - first * turn.transpose()).rowwise().norm().maxCoeff(), 0.05f);
  EXPECT_THROW(peer->reset(Mesh{}), Error);
  EXPECT_THROW(nn::load_pose_transfer(file("absent")), Error);
}

TEST_F(PoseTransfer, JointsAreReadOffASurface) {
  constexpr int kAround = 20;  // points about each joint, half its own and half its parent's
  const auto tensor = rest_joints(1);
  const Joints rest = Eigen::Map<const Joints>(tensor.data_ptr<float>());
  Points points(kAround * kJointCount, 3);
  RowMatrix weights = RowMatrix::Zero(points.rows(), kJointCount);
  Rng rng(1);
  for (int i = 0; i < points.rows(); ++i) {
    const int j = i / kAround;
    for (int axis = 0; axis < 3; ++axis) points(i, axis) = rest(j, axis) + 0.05f * rng.normal();
    weights(i, j) = weights(i, j == 0 ? static_cast<int>(Spine1) : kParents[j]) = 0.5f;
  }
  const SurfaceJoints joints(points, weights, rest);
  EXPECT_LT((joints.of(points) - rest).rowwise().norm().maxCoeff(), 1e-4f);
  const Eigen::RowVector3f moved(1, 2, 3);
  const Mat3 turn = rotation_about_y(1.0f);
  const auto there = [&](const auto& x) { return Points((x * turn.transpose()).rowwise() + moved); };
  EXPECT_LT((Points(joints.of(there(points))) - there(rest)).rowwise().norm().maxCoeff(), 1e-3f);
  EXPECT_THROW(joints.of(Points::Zero(3, 3)), Error);
  EXPECT_THROW(SurfaceJoints(points, RowMatrix::Zero(points.rows(), kJointCount), rest), Error);  // nobody's
}

}  // namespace
}  // namespace understudy
