#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "retarget/nn/modules/part_refiner.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/part_data.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;

constexpr PartKinds kAll = {true, true, true, true, true};

class PartTraining : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("understudy_part_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    test::write_training_folder(folder_.string());
  }
  void TearDown() override { fs::remove_all(folder_); }

  nn::PartTrainOptions options(int64_t samples) const {
    nn::PartTrainOptions options;
    options.data = folder_.string();
    options.out = (folder_ / "part.weights").string();
    options.samples = samples;
    options.batch = 4;
    return options;
  }

  fs::path folder_;
};

TEST_F(PartTraining, CropsComeWithRotationsAndWaysInTheirFrame) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  PartSampler a(data, kAll, 7), b(data, kAll, 7);
  const PartBatches batches = a.next(6), again = b.next(6);
  int64_t crops = 0;
  for (size_t kind = 0; kind < nn::kPartKinds; ++kind) {
    const PartBatch& batch = batches[kind];
    crops += batch.points.size(0);
    EXPECT_TRUE(torch::equal(batch.points, again[kind].points));
    if (batch.points.size(0) == 0) continue;
    EXPECT_TRUE(torch::isfinite(batch.truth).all().item<bool>());
    // Columns of a rotation have length 1.
    EXPECT_NEAR(batch.truth.narrow(2, 0, 3).square().sum(2).min().item<double>(), 1, 1e-4);
    // The frame is the first corrected joint's own: what was seen of it is no turn.
    const auto none = torch::tensor({1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f});
    EXPECT_GT(batch.truth.narrow(2, 6, 3).abs().max().item<double>(), 1e-4);  // joints were misplaced
    EXPECT_LT(batch.truth.narrow(2, 6, 3).abs().max().item<double>(), 0.4);
    EXPECT_LT((batch.before.select(1, 0) - none).abs().max().item<double>(), 1e-4);
  }
  EXPECT_GT(crops, 0);
}

TEST_F(PartTraining, WritesWeightsAndGoesOnFromItsCheckpoint) {
  EXPECT_EQ(train(options(16)), 0);
  const nn::WeightsHeader first = nn::read_weights_header(options(0).out);
  EXPECT_EQ(first.kind, nn::kPartFileKind);
  EXPECT_EQ(first.numbers.at("samples"), 16);
  EXPECT_EQ(train(options(32)), 0);
  EXPECT_EQ(nn::read_weights_header(options(0).out).numbers.at("steps"), 8);
  nn::PartRefinerNet net;
  nn::load_weights(options(0).out, nn::kPartFileKind, nn::kPartVersion, *net);
  for (const auto& p : net->parameters()) EXPECT_TRUE(torch::isfinite(p).all().item<bool>());
}

TEST_F(PartTraining, LooksAtEachScanTwiceAndOnlyAtWhatIsWanted) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  const PartBatches legs = PartSampler(data, {false, false, false, false, true}, 7).next(5);
  EXPECT_GT(legs[4].points.size(0), 5 * 2);  // but for legs that are not seen, two looks at both
  EXPECT_LE(legs[4].points.size(0), 5 * 2 * 2);
  for (size_t kind = 0; kind < 4; ++kind) EXPECT_EQ(legs[kind].points.size(0), 0);
}

TEST_F(PartTraining, LeavesKindsAloneThatAreNotTrained) {
  EXPECT_EQ(train(options(8)), 0);
  nn::PartTrainOptions hands = options(8);
  hands.init = options(0).out;
  hands.out = (folder_ / "hands.weights").string();
  hands.kinds = {"hand"};
  EXPECT_EQ(train(hands), 0);
  nn::PartRefinerNet before, after;
  nn::load_weights(hands.init, nn::kPartFileKind, nn::kPartVersion, *before);
  nn::load_weights(hands.out, nn::kPartFileKind, nn::kPartVersion, *after);
  for (const auto& parameter : before->named_parameters()) {
    const bool same = torch::equal(parameter.value(), after->named_parameters()[parameter.key()]);
    const bool of_hand = parameter.key().rfind("hand.", 0) == 0;
    if (!of_hand) EXPECT_TRUE(same) << parameter.key();
    if (parameter.key() == "hand.head.4.bias") EXPECT_FALSE(same);
  }
}

TEST_F(PartTraining, RefusesToTrainWithoutAnEnd) {
  EXPECT_ANY_THROW(train(options(0)));
}

}  // namespace
}  // namespace understudy::training
