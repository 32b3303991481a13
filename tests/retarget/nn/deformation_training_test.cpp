// Batches, overfitting, and a training run that is killed and goes on.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "retarget/base/error.hpp"
#include "retarget/training/deformation_step.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/deformation_support.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;

DeformationDataOptions small_batch() {
  DeformationDataOptions options;
  options.bodies = 2;
  options.points = 32;
  options.poses = 2;
  options.context_points = 32;
  return options;
}

TEST(DeformationSampler, SameSeedSameBatch) {
  const TrainingData data = testing::octahedron_data();
  DeformationSampler a(data, small_batch(), 5), b(data, small_batch(), 5), c(data, small_batch(), 6);
  const auto first = a.next();
  EXPECT_TRUE(torch::equal(first.points, b.next().points));
  EXPECT_FALSE(torch::equal(first.points, c.next().points));
  b.set_state(a.state());
  EXPECT_TRUE(torch::equal(a.next().basis, b.next().basis));
}

TEST(DeformationSampler, WeightsSumToOneAndPointsLieOnTheirOwnSide) {
  const TrainingData data = testing::octahedron_data();
  DeformationSampler sampler(data, small_batch(), 1);
  for (int i = 0; i < 10; ++i) {
    const auto batch = sampler.next();
    EXPECT_TRUE(torch::allclose(batch.weights.sum(-1), torch::ones({2, 32}), 0, 1e-5));
    const auto first_of_pairs = batch.points.slice(1, 0, c10::nullopt, 2).select(-1, 0);
    const auto middle = nn::middle_plane(batch.seen_joints).unsqueeze(-1);
    EXPECT_TRUE((first_of_pairs > middle - nn::kMirrorBand - 1e-5).all().item<bool>());
  }
}

TEST(DeformationSampler, TruthPosesAsTheBodyDoes) {
  TrainingData data = testing::octahedron_data();
  data.betas = {Eigen::VectorXf::Zero(1)};
  DeformationDataOptions options = small_batch();
  options.noisy_share = options.warped_share = 0;
  DeformationSampler sampler(data, options, 2);
  const auto batch = sampler.next();
  EXPECT_TRUE(torch::allclose(batch.canonical, batch.points, 0, 0.15));  // noisy shapes, but the same place
  const auto rest = batch.points.unsqueeze(-1) + nn::pose_offsets(batch.basis, batch.features);
  EXPECT_TRUE(nn::blend_skin(batch.weights, rest, batch.transforms).isfinite().all().item<bool>());
  EXPECT_GT(batch.basis.abs().max().item<float>(), 0.005f);
}

TEST(DeformationTraining, OverfitsOneBatch) {
  const TrainingData data = testing::octahedron_data();
  DeformationSampler sampler(data, small_batch(), 3);
  const auto batch = sampler.next();
  torch::manual_seed(1);
  nn::DeformationOptions form;
  form.width = 64;
  nn::DeformationNet net(form);
  torch::optim::Adam optimizer(net->parameters(), torch::optim::AdamOptions(3e-3));
  const double before = deformation_loss(net, batch).parts[0].value;
  for (int i = 0; i < 250; ++i) {
    optimizer.zero_grad();
    deformation_loss(net, batch).total.backward();
    torch::nn::utils::clip_grad_norm_(net->parameters(), 10.0);
    optimizer.step();
  }
  const auto after = deformation_loss(net, batch);
  EXPECT_LT(after.parts[0].value, 0.1 * before);
  EXPECT_EQ(after.parts[2].name, "weight_kl");
  EXPECT_LT(after.parts[2].value, 0.1);
}

TEST(DeformationEvaluator, TruthlikeNetworkScoresBetterThanRandom) {
  const TrainingData data = testing::octahedron_data();
  const DeformationEvaluator evaluator(data);
  torch::manual_seed(1);
  nn::DeformationNet net;
  const double random = evaluator.evaluate(net)[0].value;
  EXPECT_GT(random, 10);
  DeformationSampler sampler(data, small_batch(), 3);
  torch::optim::Adam optimizer(net->parameters(), torch::optim::AdamOptions(1e-3));
  for (int i = 0; i < 60; ++i) {
    optimizer.zero_grad();
    deformation_loss(net, sampler.next()).total.backward();
    torch::nn::utils::clip_grad_norm_(net->parameters(), 10.0);
    optimizer.step();
  }
  EXPECT_LT(evaluator.evaluate(net)[0].value, 0.6 * random);
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

class DeformationTrainerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = (fs::temp_directory_path() / ("deformation_trainer_" + std::to_string(::getpid()))).string();
    testing::write_octahedron_data(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  nn::DeformationTrainOptions options(const std::string& name) const {
    nn::DeformationTrainOptions o;
    o.data = folder_;
    o.out = folder_ + "/" + name;
    o.samples = 6 * 512;
    o.batch = 1;
    o.threads = 1;
    return o;
  }
  std::string folder_;
};

/// Everything but the header, where the seconds spent stand.
std::string tensors_of(const std::string& path) {
  const std::string all = bytes_of(path);
  return all.substr(all.rfind('}') + 1);
}

TEST_F(DeformationTrainerTest, GoesOnWhereItWasStopped) {
  EXPECT_EQ(train(options("whole")), 0);
  nn::DeformationTrainOptions stopped = options("parts");
  int asked = 0;
  stopped.cancelled = [&asked] { return ++asked > 3; };
  EXPECT_EQ(train(stopped), 1);
  EXPECT_NE(tensors_of(options("whole").out), tensors_of(stopped.out));
  EXPECT_EQ(train(options("parts")), 0);
  EXPECT_TRUE(tensors_of(options("whole").out) == tensors_of(options("parts").out));
}

TEST_F(DeformationTrainerTest, WritesALearningCurve) {
  train(options("curve"));
  const std::string curve = bytes_of(options("curve").out + ".csv");
  EXPECT_EQ(curve.rfind("minutes,step,samples", 0), 0u);
  EXPECT_NE(curve.find("3072"), std::string::npos);
}

TEST_F(DeformationTrainerTest, RefusesWhatIsNoCheckpoint) {
  std::ofstream(options("junk").out + ".checkpoint") << "not a checkpoint";
  EXPECT_THROW(train(options("junk")), Error);
}

TEST_F(DeformationTrainerTest, WantsAnEnd) {
  nn::DeformationTrainOptions endless = options("endless");
  endless.samples = 0;
  EXPECT_THROW(train(endless), Error);
}

}  // namespace
}  // namespace understudy::training
