// Motion words: their networks, and the training.
#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/words_pair.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/training/losses/word_losses.hpp"
#include "retarget/training/training_run.hpp"
#include "retarget/training/words_data.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;
using namespace training;

TEST(WordNetworks, GeneratorsBeginAsTheIdentity) {
  torch::manual_seed(1);
  for (const bool joint_wise : {true, false}) {
    nn::WordsOptions options;
    options.joint_wise = joint_wise;
    nn::WordGenerator generator(options);
    const auto words = torch::rand({3, kWordFrames, kWordNumbers}) * 2 - 1;
    const auto made = generator(words);
    EXPECT_EQ(made.sizes(), words.sizes());
    EXPECT_LT((made - words).abs().mean().item<double>(), 0.1);
  }
  nn::WordDiscriminator discriminator;
  EXPECT_EQ(discriminator(torch::zeros({5, kWordFrames, kWordNumbers})).size(0), 5);
}

TEST(WordNetworks, AJointsKernelsSeeThatJointAlone) {
  torch::manual_seed(2);
  nn::WordGenerator generator;
  const auto words = torch::rand({1, kWordFrames, kWordNumbers});
  auto other = words.clone();
  other.slice(2, 4 * Head, 4 * Head + 4) += 0.3;
  const auto change = (generator(other) - generator(words)).abs().amax({0, 1});
  for (int c = 0; c < kWordNumbers; ++c) EXPECT_EQ(change[c].item<float>() > 1e-6f, c / 4 == Head) << c;
}

TEST(WordLosses, AreTheirDefinitions) {
  const auto rising = torch::arange(kWordFrames, torch::kFloat32).view({1, kWordFrames, 1});
  EXPECT_NEAR(word_coherence_loss(rising).item<double>(), 1, 1e-6);
  EXPECT_NEAR(word_velocity_loss(rising, rising + 5).item<double>(), 0, 1e-6);
  EXPECT_NEAR(word_cycle_loss(rising + 2, rising).item<double>(), 2, 1e-6);
  EXPECT_NEAR(word_transition_loss(rising, rising + kWordStride).item<double>(), 0, 1e-6);
  EXPECT_NEAR(word_transition_loss(rising, rising).item<double>(), kWordStride, 1e-5);
}

/// Two manners of walking: upright, and bowed by an angle with the head turned.
class WordTraining : public ::testing::Test {
 protected:
  static constexpr float kBowed = 0.5f;

  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
    for (const char* const manner : {"upright", "bowed"})
      for (int i = 0; i < 2; ++i) write_clip(manner, i);
  }
  void TearDown() override { log::set_sink(before_); }

  static Pose in_manner(Pose pose, const std::string& manner) {
    if (manner == "bowed")
      pose.local[Spine1] = pose.local[Spine1] * rotation_from_axis_angle(Vec3(kBowed, 0, 0));
    return pose;
  }
  void write_clip(const std::string& manner, int number) const {
    fs::create_directories(file(manner));
    AmassWriter writer(file(manner) + "/" + std::to_string(number) + ".npz", 30);
    const Motion clip = builtin_motion(number == 0 ? "walk" : "dance", human_rest(), 30);
    for (const Pose& pose : clip.poses) writer.push(in_manner(pose, manner));
    writer.finish();
  }
  std::string file(const std::string& name) const { return folder_.path() + "/" + name; }
  nn::StyleTrainOptions options(const char* name, int64_t samples) const {
    nn::StyleTrainOptions options;
    options.data = folder_.path();
    options.from = "upright", options.to = "bowed";
    options.out = file(name);
    options.batch = 8;
    options.threads = 1;
    options.samples = samples;
    options.licence = "CC BY-NC 4.0";
    return options;
  }

  testing::DataFolder folder_;
  log::Sink before_;
};

TEST_F(WordTraining, LearnsAMannerAndSaysItsLicence) {
  nn::StyleTrainOptions quick = options("bowed.weights", 8 * 260);
  quick.cycle = 1, quick.coherence = 0;  // what holds a manner back
  ASSERT_EQ(train(quick), 0);
  EXPECT_EQ(nn::read_weights_header(file("bowed.weights")).texts.at("licence"), "CC BY-NC 4.0");
  const auto translator = nn::load_words(file("bowed.weights"));
  const Motion clip = builtin_motion("walk", human_rest(), 30);
  WordRows word(kWordFrames, kWordNumbers);
  for (int t = 0; t < kWordFrames; ++t) word.row(t) = word_row(clip.poses[static_cast<size_t>(20 + t)].local);
  const WordRows made = translator->translate(word);
  float bowed = 0, arms = 0;
  for (int t = 0; t < kWordFrames; ++t) {
    const Rotations was = rotations_of_row(word.row(t), 0), is = rotations_of_row(made.row(t), 0);
    bowed += rotation_to_axis_angle(was[Spine1].transpose() * is[Spine1]).x() / kWordFrames;
    arms += geodesic_angle(was[LeftElbow], is[LeftElbow]) / kWordFrames;
  }
  EXPECT_GT(bowed, 0.4f * kBowed);
  EXPECT_LT(arms, 0.25f);
}

TEST_F(WordTraining, WhatIsNoDomainIsRefusedInASentence) {
  const auto refused = [&](const std::string& from, const std::string& to) {
    nn::StyleTrainOptions wrong = options("none.weights", 8);
    wrong.from = from, wrong.to = to;
    const std::string problem = failure_of([&] { train(wrong); });
    EXPECT_FALSE(fs::exists(file("none.weights")));
    return problem;
  };
  EXPECT_NE(refused("upright", "absent").find("there is no such folder"), std::string::npos);
  fs::create_directories(file("empty"));
  EXPECT_NE(refused("upright", "empty").find("holds no clip"), std::string::npos);
  fs::create_directories(file("one"));
  fs::copy_file(file("bowed/0.npz"), file("one/0.npz"));
  EXPECT_NE(refused("upright", "one").find("holds one clip"), std::string::npos);
  EXPECT_NE(
      refused("upright", "../" + fs::path(folder_.path()).filename().string() + "/upright").find("again"),
      std::string::npos);
  EXPECT_NE(refused("upright", "").find("--from and --to"), std::string::npos);
}

TEST_F(WordTraining, WeightsOfAnotherNetworkAreRefused) {
  nn::save_weights(file("other.weights"), {"motion", 1, {}}, *nn::WordDiscriminator());
  EXPECT_NE(failure_of([&] { nn::load_words(file("other.weights")); }).find("other.weights"),
            std::string::npos);
}

}  // namespace
}  // namespace understudy
