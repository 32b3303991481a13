// Lengths read off 2D poses: the network with and without LibTorch, its data, its training.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/pose2d/proportion_input.hpp"
#include "retarget/training/proportion_figures.hpp"
#include "retarget/training/proportion_step.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;
using namespace training;

class Proportions : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([this](log::Level, const std::string& line) { logged_ += line + "\n"; });
  }
  void TearDown() override { log::set_sink(before_); }

  std::string file(const std::string& name) const { return folder_.path() + "/" + name; }
  nn::ProportionsTrainOptions options(const char* name, int64_t steps) const {
    nn::ProportionsTrainOptions options;
    options.data = folder_.path();
    options.out = file(name);
    options.threads = 1;
    options.batch = 16;
    options.samples = 16 * steps;
    return options;
  }
  /// Poses of the folder's people, as detectors see them.
  std::vector<FlatPose> some_poses(int count) const {
    const TrainingData data = load_training_data(folder_.path(), Split::Train);
    const std::vector<FlatPerson> people = flat_people_of(data);
    Rng rng(12);
    std::vector<FlatPose> poses;
    for (int i = 0; i < count; ++i) {
      const Pose& pose = random_pose(data, rng);
      const FlatSight sight =
          seen_flat(people[static_cast<size_t>(i) % people.size()], pose, random_view(pose.root, {}, rng));
      poses.push_back(detected(sight, random_errors(rng), rng));
    }
    return poses;
  }
  std::string write_random_weights() const {
    torch::manual_seed(4);
    nn::ProportionNet net;
    nn::save_weights(file("proportions.weights"), {"proportions", nn::kProportionVersion, {}}, *net);
    return file("proportions.weights");
  }

  testing::DataFolder folder_;
  std::string logged_;
  log::Sink before_;
};

TEST_F(Proportions, TheReaderSaysWhatTheModuleSays) {
  nn::ProportionNet net;
  nn::load_weights(write_random_weights(), "proportions", nn::kProportionVersion, *net);
  const auto reader = nn::load_length_reader(folder_.path());
  const std::vector<FlatPose> poses = some_poses(20);
  const std::vector<PoseLengths> expected = read_lengths(net, poses);
  for (size_t i = 0; i < poses.size(); ++i) {
    const PoseLengths told = reader->read(poses[i]);
    EXPECT_LT((told.log_length - expected[i].log_length).abs().maxCoeff(), 1e-4f);
    EXPECT_LT((told.doubt - expected[i].doubt).abs().maxCoeff(), 1e-4f);
  }
}

TEST_F(Proportions, APictureTwiceAsLargeHasBonesTwiceAsLongAndAMirrorChangesSides) {
  write_random_weights();
  const auto reader = nn::load_length_reader(folder_.path());
  const FlatPose pose = some_poses(1).front();
  FlatPose large = pose;
  for (int p = 0; p < kBodyPoints; ++p)
    if (pose.has(p)) large.set(p, 2 * pose.at(p) + Vec2(30, -20), pose.confidence(p));
  const PoseLengths told = reader->read(pose), twice = reader->read(large),
                    mirrored = reader->read(in_mirror(pose));
  EXPECT_LT((twice.log_length - told.log_length - std::log(2.0f)).abs().maxCoeff(), 1e-4f);
  for (int b = 0; b < kFlatBoneCount; ++b)
    EXPECT_NEAR(mirrored.log_length[kFlatBoneMirror[static_cast<size_t>(b)]], told.log_length[b], 1e-5f);
}

TEST_F(Proportions, TheReaderRefusesNobodyAndDamagedFiles) {
  const std::string path = write_random_weights();
  EXPECT_THROW(nn::load_length_reader(folder_.path())->read({}), Error);
  const auto problem = [&] { return failure_of([&] { nn::load_length_reader(folder_.path()); }); };
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_NE(problem().find("proportions.weights"), std::string::npos);
  nn::save_weights(path, {"motion", 1, {}}, *nn::ProportionNet());
  EXPECT_NE(problem().find("proportions.weights: holds weights for 'motion'"), std::string::npos);
  nn::save_weights(path, {"proportions", nn::kProportionVersion + 1, {}}, *nn::ProportionNet());
  EXPECT_NE(problem().find("this program needs version"), std::string::npos);
  nn::save_weights(path, {"proportions", nn::kProportionVersion, {}}, *torch::nn::Linear(3, 3));
  EXPECT_NE(problem().find("proportions.weights: has no 'first.weight'"), std::string::npos);
  fs::remove(path);
  EXPECT_NE(problem().find("proportions.weights"), std::string::npos);
}

TEST_F(Proportions, BatchesAreFiniteAndTheSameForTheSameSeed) {
  const ProportionData data(load_training_data(folder_.path(), Split::Train));
  Rng one(5), same(5), other(6);
  const ProportionBatch a = data.batch(64, one), b = data.batch(64, same), c = data.batch(64, other);
  EXPECT_TRUE(torch::equal(a.poses, b.poses) && torch::equal(a.log_length, b.log_length));
  EXPECT_FALSE(torch::equal(a.poses, c.poses));
  EXPECT_TRUE(a.poses.isfinite().all().item<bool>() && a.log_length.isfinite().all().item<bool>());
}

TEST_F(Proportions, OneBatchCanBeLearntByHeart) {
  const ProportionData data(load_training_data(folder_.path(), Split::Train));
  Rng rng(4);
  const ProportionBatch batch = data.batch(24, rng);
  torch::manual_seed(1);
  nn::ProportionNet net;
  torch::optim::Adam optimizer(net->parameters(), 1e-3);
  Figures first, last;
  for (int i = 0; i < 400; ++i) {
    optimizer.zero_grad();
    const LossSum loss = proportion_loss(net, batch, torch::kCPU);
    loss.total.backward();
    torch::nn::utils::clip_grad_norm_(net->parameters(), 1);
    optimizer.step();
    (i == 0 ? first : last) = loss.parts;
  }
  EXPECT_EQ(last[1].name, "log_error");
  EXPECT_LT(last[1].value, 0.05 * first[1].value);
  EXPECT_LT(last[0].value, -1);
}

TEST_F(Proportions, TrainingIsJudgedOnWhatEveryReaderStandsBetween) {
  const ProportionFigures figures(load_training_data(folder_.path(), Split::Dev), 20);
  const auto value = [](const Figures& all, const std::string& name) {
    for (const Figure& figure : all)
      if (figure.name == name) return figure.value;
    return std::nan("");
  };
  const Figures baselines = figures.baselines();
  EXPECT_GT(value(baselines, "true_ratios_odd"), value(baselines, "copy_odd") + 5);
  EXPECT_GT(value(baselines, "true_ratios_real"), 95);
  torch::manual_seed(2);
  nn::ProportionNet net;
  const Figures untrained =
      figures.of([&](const std::vector<FlatPose>& poses) { return read_lengths(net, poses); });
  EXPECT_EQ(untrained.size(), 16u);
  EXPECT_LT(value(untrained, "oks_odd_1"), value(baselines, "true_ratios_odd"));
  EXPECT_GT(value(untrained, "bone_ratio_odd_1"), 5);
}

TEST_F(Proportions, GoesOnAsIfItHadNotBeenStopped) {
  ASSERT_EQ(training::train(options("whole.weights", 12)), 0);
  EXPECT_NE(logged_.find("true_ratios_odd"), std::string::npos);
  nn::ProportionsTrainOptions parted = options("parted.weights", 12);
  int asked = 0;
  parted.cancelled = [&] { return ++asked > 5; };
  ASSERT_EQ(training::train(parted), 1);
  parted.cancelled = {};
  ASSERT_EQ(training::train(parted), 0);
  const auto weights = [&](const char* name) {
    nn::ProportionNet net;
    nn::load_weights(file(name), "proportions", nn::kProportionVersion, *net);
    std::vector<torch::Tensor> all;
    for (const auto& parameter : net->parameters()) all.push_back(parameter.flatten());
    return torch::cat(all);
  };
  EXPECT_TRUE(torch::equal(weights("whole.weights"), weights("parted.weights")));
  EXPECT_GT(nn::read_weights_header(file("whole.weights")).numbers.count("bone_ratio_odd_10"), 0u);
}

}  // namespace
}  // namespace understudy
