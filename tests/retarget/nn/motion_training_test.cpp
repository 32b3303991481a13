// Data and training of motion transfer.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/modules/forward_kinematics.hpp"
#include "retarget/nn/paper_transfer.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/motion_evaluator.hpp"
#include "retarget/training/motion_trainer.hpp"
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

  MotionTrainerOptions small() const {
    MotionTrainerOptions options;
    options.net = {/*hidden=*/24, /*layers=*/1};
    options.batch.size = 4;
    options.batch.frames = 20;
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
  auto options = small();
  options.net.hidden = 48;
  options.learning_rate = 3e-3;
  MotionTrainer trainer(options);
  Rng rng(4);
  const auto batch = data.batch({4, 20, 0}, rng);
  const MotionStep first = trainer.step(batch);
  MotionStep last;
  for (int i = 0; i < 150; ++i) last = trainer.step(batch);
  EXPECT_LT(last.cycle, 0.1 * first.cycle);
  EXPECT_LT(last.rotation, 0.5 * first.rotation);
}

TEST_F(MotionTraining, GoingOnFromACheckpointIsTheSameAsNeverStopping) {
  const MotionData data(load_training_data(folder_.path(), Split::Train));
  MotionTrainer whole(small());
  for (int i = 0; i < 6; ++i) whole.step(data, i / 6.0);

  MotionTrainer first(small());
  for (int i = 0; i < 3; ++i) first.step(data, i / 6.0);
  first.save_checkpoint(file("half"));
  auto other_seed = small();
  other_seed.seed = 99;
  MotionTrainer second(other_seed);
  second.load_checkpoint(file("half"));
  for (int i = 3; i < 6; ++i) second.step(data, i / 6.0);

  EXPECT_EQ(second.samples, whole.samples);
  const auto a = whole.net->parameters(), b = second.net->parameters();
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(torch::equal(a[i], b[i]));
  const auto c = whole.discriminator->parameters(), d = second.discriminator->parameters();
  for (size_t i = 0; i < c.size(); ++i) EXPECT_TRUE(torch::equal(c[i], d[i]));
}

TEST_F(MotionTraining, RefusesAFileThatIsNoCheckpoint) {
  std::ofstream(file("junk")) << "not a checkpoint";
  MotionTrainer trainer(small());
  EXPECT_THROW(trainer.load_checkpoint(file("junk")), Error);
  EXPECT_THROW(trainer.load_checkpoint(file("absent")), Error);
}

TEST_F(MotionTraining, TheEvaluatorRecognisesAnUntrainedNetwork) {
  const MotionEvaluator evaluator(load_training_data(folder_.path(), Split::Dev), 0, 30);
  nn::MotionGru net(nn::MotionGruOptions{16, 1});
  const MotionFigures figures = evaluator.evaluate(net);  // untrained
  EXPECT_GT(figures.rot_deg, 5);
  EXPECT_GT(figures.mpjpe_mm, figures.pa_mpjpe_mm);
}

TEST_F(MotionTraining, TheCommandTrainsStopsWhenAskedAndGoesOn) {
  nn::TrainOptions options;
  options.network = "motion";
  options.data = folder_.path();
  options.out = file("motion.weights");
  options.batch = 2;
  options.threads = 1;
  options.samples = 8;
  int asked = 0;
  options.cancelled = [&] { return ++asked == 2; };
  EXPECT_EQ(train_motion(options), 1);
  EXPECT_EQ(nn::read_weights_header(options.out).numbers.at("samples"), 4);

  options.cancelled = nullptr;
  EXPECT_EQ(train_motion(options), 0);
  EXPECT_EQ(nn::read_weights_header(options.out).numbers.at("samples"), 8);
  std::ifstream curve(options.out + ".csv");
  std::string line;
  int lines = 0;
  while (std::getline(curve, line)) ++lines;
  EXPECT_EQ(lines, 3);  // the header and one for each run
}

TEST_F(MotionTraining, TheAblationsTrainAndTheirWeightsAreRead) {
  nn::TrainOptions options;
  options.network = "motion";
  options.data = folder_.path();
  options.out = file("quaternion.weights");
  options.batch = 2;
  options.threads = 1;
  options.samples = 4;
  options.rotation = "quaternion";
  options.rotation_loss = false;
  options.context = 5;
  EXPECT_EQ(train_motion(options), 0);
  EXPECT_EQ(nn::read_weights_header(options.out).numbers.at("quaternions"), 1);
  EXPECT_NO_THROW(nn::load_paper_transfer(options.out));
}

}  // namespace
}  // namespace understudy
