// Data and training of motion transfer.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/motion_evaluator.hpp"
#include "retarget/training/motion_step.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace testing;
using namespace training;

class MotionTraining : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
  }
  void TearDown() override { log::set_sink(before_); }

  nn::MotionTrainOptions options(const char* name, int64_t samples) const {
    nn::MotionTrainOptions options;
    options.data = folder_.path();
    options.out = file(name);
    options.batch = 2;
    options.threads = 1;
    options.samples = samples;
    return options;
  }
  std::string file(const char* name) const { return folder_.path() + "/" + name; }

  DataFolder folder_;
  log::Sink before_;
};

TEST_F(MotionTraining, BatchesAreWhatTheBodiesDo) {
  const MotionData data(load_training_data(folder_.path(), Split::Train));
  Rng rng(1);
  const auto batch = data.batch({8, 24, 0.03f}, rng);
  EXPECT_EQ(batch.crossed, 4);
  const auto posed = nn::forward_kinematics(batch.rest_a, batch.rotations).joints;
  EXPECT_TRUE(torch::allclose(posed, batch.clean, 0, 1e-5));
  EXPECT_TRUE(
      torch::equal(batch.rest_a.slice(0, 4), batch.rest_b.slice(0, 4)));  // the others stay on their body
  EXPECT_GE(batch.dt.min().item<float>(), 1.0f / 61);
  EXPECT_LE(batch.dt.max().item<float>(), 1.0f / 19.9f);
  const double error = (batch.joints - batch.clean).norm(2, -1).mean().item<double>();
  EXPECT_GT(error, 0.001);
  EXPECT_LT(error, 0.05);
}

TEST_F(MotionTraining, AStretchOfMotionIsOnOneBodyOnly) {
  const TrainingData source = load_training_data(folder_.path(), Split::Train);
  const MotionData data(source);
  ASSERT_EQ(data.stretches(), 1u);  // 60 frames, the sixth flagged: frames 6 to 59
  Rng rng(2);
  const auto batch = data.batch({16, 24, 0}, rng);
  EXPECT_TRUE(torch::equal(batch.rest_a, batch.rest_a.slice(0, 0, 1).expand_as(batch.rest_a)));
}

TEST(JointErrors, AreAsLargeAsAsked) {
  std::vector<Joints> still(400, Joints::Zero());
  Rng rng(3);
  double mean = 0;
  for (int i = 0; i < 20; ++i) {
    auto joints = still;
    add_joint_errors(joints, 0.02f, 1.0f / 30, rng);
    for (const Joints& j : joints) mean += j.rowwise().norm().mean() / (20 * 400);
  }
  EXPECT_NEAR(mean, 0.02, 0.004);
}

TEST_F(MotionTraining, OneBatchCanBeLearntByHeart) {
  const MotionData data(load_training_data(folder_.path(), Split::Train));
  Rng rng(4);
  const auto batch = data.batch({4, 20, 0}, rng);
  torch::manual_seed(1);
  nn::MotionGru net(nn::MotionGruOptions{/*hidden=*/48, /*layers=*/1});
  MotionDiscriminator discriminator;
  torch::optim::Adam optimizer(net->parameters(), 3e-3);
  Figures first, last;
  for (int i = 0; i < 151; ++i) {
    optimizer.zero_grad();
    const MotionStep step = motion_step(net, discriminator, batch, {});
    step.loss.total.backward();
    torch::nn::utils::clip_grad_norm_(net->parameters(), 0.1);
    optimizer.step();
    (i == 0 ? first : last) = step.loss.parts;
  }
  EXPECT_EQ(last[0].name, "cycle");
  EXPECT_LT(last[0].value, 0.1 * first[0].value);
  EXPECT_EQ(last[1].name, "rotation");
  EXPECT_LT(last[1].value, 0.5 * first[1].value);
}

TEST_F(MotionTraining, GoingOnFromACheckpointIsTheSameAsNeverStopping) {
  EXPECT_EQ(train(options("whole", 12)), 0);
  auto stopped = options("parts", 12);
  int asked = 0;
  stopped.cancelled = [&asked] { return ++asked > 3; };
  EXPECT_EQ(train(stopped), 1);
  auto other_seed = options("parts", 12);
  other_seed.seed = 99;
  EXPECT_EQ(train(other_seed), 0);
  const auto net_of = [this](const char* name) {
    nn::MotionGru net;
    nn::load_weights(file(name), "motion", nn::kMotionGruVersion, *net);
    return net->parameters();
  };
  const auto a = net_of("whole"), b = net_of("parts");
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(torch::equal(a[i], b[i]));
}

TEST_F(MotionTraining, RefusesAFileThatIsNoCheckpoint) {
  std::ofstream(file("junk.checkpoint")) << "not a checkpoint";
  EXPECT_THROW(train(options("junk", 4)), Error);
}

TEST_F(MotionTraining, TheEvaluatorRecognisesAnUntrainedNetwork) {
  const MotionEvaluator evaluator(load_training_data(folder_.path(), Split::Dev), 0);
  nn::MotionGru net(nn::MotionGruOptions{16, 1});
  const Figures figures = evaluator.evaluate(net, "dev_");  // untrained
  EXPECT_EQ(figures[2].name, "dev_rot_deg");
  EXPECT_GT(figures[2].value, 5);
  EXPECT_GT(figures[0].value, figures[1].value);  // aligned is nearer
}

TEST_F(MotionTraining, TheCommandTrainsStopsWhenAskedAndGoesOn) {
  auto o = options("motion.weights", 8);
  int asked = 0;
  o.cancelled = [&] { return ++asked == 3; };
  EXPECT_EQ(train(o), 1);
  EXPECT_EQ(nn::read_weights_header(o.out).numbers.at("samples"), 4);

  o.cancelled = nullptr;
  EXPECT_EQ(train(o), 0);
  EXPECT_EQ(nn::read_weights_header(o.out).numbers.at("samples"), 8);
  std::ifstream curve(o.out + ".csv");
  std::string line;
  int lines = 0;
  while (std::getline(curve, line)) ++lines;
  EXPECT_EQ(lines, 3);  // the header and one for each run
}

TEST_F(MotionTraining, TheAblationsTrainAndTheirWeightsAreRead) {
  auto o = options("quaternion.weights", 4);
  o.rotation = "quaternion";
  o.rotation_loss = false;
  o.context = 5;
  EXPECT_EQ(train(o), 0);
  EXPECT_EQ(nn::read_weights_header(o.out).numbers.at("quaternions"), 1);
  EXPECT_NO_THROW(nn::load_paper_transfer(o.out));
}

}  // namespace
}  // namespace understudy
