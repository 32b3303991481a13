// The filter of 2D points: with and without LibTorch, its data, its training.
#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/base/file.hpp"
#include "retarget/base/log.hpp"
#include "retarget/keypoints/point_filter.hpp"
#include "retarget/training/point_data.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace training;

constexpr int kFrames = 20;

class PointNetwork : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
  }
  void TearDown() override { log::set_sink(before_); }

  std::string file(const std::string& name) const { return folder_.path() + "/" + name; }
  PointBatch batch(uint64_t seed) const {
    const PointData data(load_training_data(folder_.path(), Split::Train), kFrames);
    Rng rng(seed);
    return data.batch(6, rng);
  }

  testing::DataFolder folder_;
  log::Sink before_;
};

/// Shot `row` by PointFilter, point by point: places to show [T, 25, 2].
torch::Tensor filtered(const nn::SeenPoints& seen, int64_t row) {
  auto shown = torch::zeros({kFrames, kBodyPoints, 2});
  std::array<PointFilter, kBodyPoints> points;
  const float dt = seen.dt[row].item<float>();
  for (int64_t t = 0; t < kFrames; ++t) {
    float unrest = 0;
    for (const PointFilter& point : points) unrest += point.unrest() / kBodyPoints;
    for (int64_t p = 0; p < kBodyPoints; ++p) {
      PointFilter& point = points[static_cast<size_t>(p)];
      const PointFilter::Noise noise{seen.size[row][t].item<float>(), seen.sigma[row][t][p].item<float>(),
                                     unrest, 100};
      const auto place = seen.places[row][t][p];
      if (seen.is_seen[row][t][p].item<float>() > 0)
        point.see({place[0].item<float>(), place[1].item<float>()}, 1, dt, noise);
      else
        point.miss(dt, noise);
      shown[t][p][0] = point.place().x(), shown[t][p][1] = point.place().y();
    }
  }
  return shown;
}

TEST_F(PointNetwork, TheFilterSaysWhatTheModuleSays) {
  nn::PointGainsNet net;
  net->set_numbers(PointGains::fitted_numbers());
  EXPECT_EQ(net->numbers(), PointGains::fitted_numbers());
  const PointBatch some = batch(3);
  EXPECT_LT(some.seen.is_seen.min().item<float>(), 1) << "points are missing here and there";
  const torch::NoGradGuard no_grad;
  const auto expected = net(some.seen);
  for (int64_t row = 0; row < expected.size(0); ++row)
    EXPECT_LT((filtered(some.seen, row) - expected[row]).abs().max().item<float>(), 0.05f) << row;
}

TEST_F(PointNetwork, BatchesAreTheSameForTheSameSeed) {
  const PointBatch a = batch(4), b = batch(4), c = batch(5);
  EXPECT_TRUE(torch::equal(a.seen.places, b.seen.places) && torch::equal(a.truth, b.truth));
  EXPECT_FALSE(torch::equal(a.truth, c.truth));
  EXPECT_TRUE(a.truth.isfinite().all().item<bool>() && (a.seen.sigma > 0).all().item<bool>());
}

TEST_F(PointNetwork, FiguresAreThoseOfTheTruthAndOfWhatShakes) {
  const PointBatch some = batch(6);
  const PointFigures same = point_figures(some.truth, some.truth);
  EXPECT_NEAR(same.oks.min().item<float>(), 100, 1e-3f);
  EXPECT_NEAR(same.jitter.max().item<float>(), 1, 1e-3f);
  torch::manual_seed(1);
  const PointFigures shaken = point_figures(some.truth + 4 * torch::randn_like(some.truth), some.truth);
  EXPECT_GT(shaken.jitter.min().item<float>(), 1.2f);
  EXPECT_LT(shaken.oks.max().item<float>(), 99.5f);
}

TEST_F(PointNetwork, TrainingWritesTheNumbersForTheSourceCode) {
  nn::PointsTrainOptions options;
  options.data = folder_.path();
  options.out = file("points.weights");
  options.threads = 1;
  options.batch = 4;
  options.samples = 16;
  ASSERT_EQ(training::train(options), 0);
  const std::string text = read_file(file("points.weights.inc"));
  EXPECT_EQ(std::count(text.begin(), text.end(), ','), kGainNumbers);
}

}  // namespace
}  // namespace understudy
