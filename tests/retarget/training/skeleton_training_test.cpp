#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/skeleton_form.hpp"
#include "retarget/training/losses/skeleton_losses.hpp"
#include "retarget/training/scan_streams.hpp"
#include "retarget/training/skeleton_batch.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::training {
namespace {

namespace fs = std::filesystem;

class SkeletonTraining : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("understudy_training_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    test::write_training_folder(folder_.string());
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

/// The numeric derivative of f at x along every entry, compared with autograd's.
template <class Function>
void expect_gradient(Function f, torch::Tensor x) {
  x = x.to(torch::kFloat64).requires_grad_();
  f(x).backward();
  const auto analytic = x.grad().clone().flatten();
  const torch::NoGradGuard no_grad;
  auto flat = x.view({-1});
  for (int64_t i = 0; i < flat.numel(); ++i) {
    const double at = flat[i].item<double>(), step = 1e-5;
    flat[i] = at + step;
    const double above = f(x).template item<double>();
    flat[i] = at - step;
    const double below = f(x).template item<double>();
    flat[i] = at;
    EXPECT_NEAR(analytic[i].item<double>(), (above - below) / (2 * step), 1e-5);
  }
}

TEST(SkeletonLoss, MeanDistanceHasTheRightGradient) {
  torch::manual_seed(1);
  const auto b = torch::randn({2, 22, 3}, torch::kFloat64);
  expect_gradient([&](const torch::Tensor& a) { return mean_distance(a, b); }, torch::randn({2, 22, 3}));
}

TEST(SkeletonLoss, VotesHaveTheRightGradient) {
  torch::manual_seed(2);
  const auto centres = torch::randn({1, 4, 3}, torch::kFloat64),
             joints = torch::randn({1, 22, 3}, torch::kFloat64);
  expect_gradient(
      [&](const torch::Tensor& votes) { return vote_loss(votes, centres, joints, 1.5).to(torch::kFloat64); },
      torch::randn({1, 4, 22, 3}));
}

TEST(SkeletonLoss, FarVotesCountForNothing) {
  const auto centres = torch::full({1, 1, 3}, 9.0), joints = torch::zeros({1, 22, 3});
  EXPECT_EQ(vote_loss(torch::randn({1, 1, 22, 3}), centres, joints, 0.8).item<float>(), 0.0f);
}

TEST(SkeletonLoss, SpreadHasTheRightGradientAndGivesTheJointsNone) {
  torch::manual_seed(3);
  const auto truth = torch::randn({1, 22, 3}, torch::kFloat64);
  auto joints = torch::randn({1, 22, 3}, torch::kFloat64).requires_grad_();
  const auto error = (joints - truth).norm(2, -1);
  expect_gradient([&](const torch::Tensor& s) { return spread_loss(error, s); }, torch::randn({1, 22}));
  EXPECT_FALSE(joints.grad().defined());
}

TEST(PartLoss, HasTheRightGradientOfRotationsAndPlaces) {
  torch::manual_seed(5);
  const auto truth = torch::randn({2, 2, 9}, torch::kFloat64),
             log_error = torch::randn({2, 2, 1}, torch::kFloat64);
  // The expected error is held: the error that it is compared with has no gradient by design.
  const auto loss = [&](const torch::Tensor& x) {
    const auto output = torch::cat({x, log_error}, 2);
    return part_loss(output, truth) - 0.01 * spread_loss(place_error(output, truth), log_error.squeeze(2));
  };
  expect_gradient(loss, torch::randn({2, 2, 9}));
}

TEST_F(SkeletonTraining, ScansAreTheSameForTheSameSeedAndOthersForAnother) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMaker a(data, {}, 5), b(data, {}, 5), c(data, {}, 6);
  const MadeScan one = a.next();
  EXPECT_EQ(one.points, b.next().points);
  EXPECT_NE(one.points, c.next().points);
}

TEST_F(SkeletonTraining, ScanPointsLieNearTheJointOfTheirPart) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions clean;
  clean.captured = 0;
  ScanMaker maker(data, clean, 5);
  const MadeScan scan = maker.next();
  ASSERT_EQ(scan.points.rows(), nn::kScanPoints);
  for (int i = 0; i < nn::kScanPoints; ++i)
    EXPECT_LT((scan.points.row(i) - scan.truth.joints.row(scan.parts[i])).norm(), 0.2f);
}

TEST_F(SkeletonTraining, ScansForTargetsAreNearTheTPoseAndFaceForwards) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMaker maker(data, ScanMakerOptions::rest(), 3);
  for (int i = 0; i < 20; ++i) {
    const MadeScan scan = maker.next();
    const Rotations local = local_rotations(scan.truth.global);
    for (int j = 1; j < kJointCount; ++j) EXPECT_LT(geodesic_angle(local[j], Mat3::Identity()), 0.1f);
    EXPECT_LT(geodesic_angle(local[0], Mat3::Identity()), 0.8f);
  }
}

float farthest(const Joints& a, const Joints& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

TEST_F(SkeletonTraining, SomebodyFollowedGoesOnAndIsSeenFromTheSameSide) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options;
  options.longest = 4;
  options.captured = 0;
  options.one_sided = 1;
  options.skirts = options.coats = options.hair = options.holding = options.limbless = 0;
  ScanMaker maker(data, options, 8);
  int followed = 0;
  for (int i = 0; i < 12; ++i) {
    ScanMaker::Stream stream = maker.start();
    MadeScan before = maker.next(stream);
    while (!stream.poses.empty()) {
      const MadeScan after = maker.next(stream);
      EXPECT_LT(farthest(before.truth.joints, after.truth.joints), 0.5f);
      const auto side = [](const MadeScan& scan) -> Vec3 {  // of the body that is seen
        return (scan.points.colwise().mean() - scan.truth.joints.colwise().mean()).normalized();
      };
      EXPECT_GT(side(before).dot(side(after)), 0);
      before = after;
      ++followed;
    }
  }
  EXPECT_GT(followed, 6);
}

TEST_F(SkeletonTraining, APastIsWhatWasSeenButForAFewThatAreWrong) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options;
  options.longest = 4;
  ScanStreams streams(data, options, 9, 8);
  int known = 0, right = 0;
  for (int i = 0; i < 60; ++i) {
    const FollowedScans batch = streams.next(4);
    std::vector<Joints> seen;
    for (size_t k = 0; k < batch.scans.size(); ++k) {
      const auto& last = batch.recent[k].last;
      known += last.has_value();
      right += last && farthest(*last, batch.scans[k].truth.joints) < 0.5f;
      seen.push_back(batch.scans[k].truth.joints);
    }
    streams.saw(seen);
  }
  EXPECT_GT(known, 80);
  EXPECT_LT(known, 240);  // those that are new have none
  EXPECT_GT(right, 0.85 * known);
  EXPECT_LT(right, known);
}

TEST_F(SkeletonTraining, FlaggedFramesAreLeftOut) {
  EXPECT_EQ(load_training_data(folder_.string(), Split::Train).good_frames, 59);
}

TEST_F(SkeletonTraining, OverfitsOneBatch) {
  torch::manual_seed(4);
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMaker maker(data, {}, 7);
  const SkeletonBatch batch = make_batch({maker.next(), maker.next()});
  const auto net = nn::make_skeleton_form("dense");
  torch::optim::Adam optimizer(net->parameters(), 1e-3);
  double first = 0, last = 0;
  for (int step = 0; step < 60; ++step) {
    optimizer.zero_grad();
    const auto loss = skeleton_loss(net->forward(batch.input), batch);
    loss.total.backward();
    optimizer.step();
    (step == 0 ? first : last) = loss.parts[0].value;
  }
  EXPECT_LT(last, 0.2 * first);
}

nn::SkeletonTrainOptions few_samples(const fs::path& folder, int64_t samples) {
  nn::SkeletonTrainOptions options;
  options.data = folder.string();
  options.out = (folder / "out.weights").string();
  options.samples = samples;
  options.threads = 1;
  options.batch = 4;
  return options;
}

TEST_F(SkeletonTraining, ResumesFromItsCheckpoint) {
  train(few_samples(folder_, 8));
  EXPECT_TRUE(fs::exists(folder_ / "out.weights"));
  train(few_samples(folder_, 12));
  std::ifstream curve(folder_ / "out.weights.csv");
  std::string header, first, second;
  std::getline(curve, header), std::getline(curve, first), std::getline(curve, second);
  EXPECT_NE(first.find(",2,8,"), std::string::npos) << first;
  EXPECT_NE(second.find(",3,12,"), std::string::npos) << second;
}

TEST_F(SkeletonTraining, KeepsAShareOfWhatItStartedFrom) {
  train(few_samples(folder_, 8));
  const std::string begun = (folder_ / "begun.weights").string(), out = (folder_ / "out.weights").string();
  fs::rename(out, begun);
  fs::remove(out + ".checkpoint");
  nn::SkeletonTrainOptions options = few_samples(folder_, 40);
  options.init = begun;
  train(options);
  const auto parameters_of = [](const std::string& path) {
    const auto net = nn::make_skeleton_form("dense");
    nn::load_skeleton_form(path, "dense", *net);
    return net->parameters();
  };
  const auto first = parameters_of(begun), last = parameters_of(out);
  options.keep = 0.25;
  train(options);  // nothing left to train: only written anew
  const auto kept = parameters_of(out);
  double moved = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    moved += (last[i] - first[i]).abs().sum().item<double>();
    EXPECT_TRUE(torch::allclose(kept[i], 0.25 * first[i] + 0.75 * last[i], 1e-2, 1e-3));
  }
  EXPECT_GT(moved, 0.1);
  options.init.clear();
  EXPECT_THROW(train(options), Error);
}

TEST_F(SkeletonTraining, WithoutDataIsOneSentence) {
  EXPECT_THROW(train(few_samples(folder_ / "nowhere", 8)), Error);
}

}  // namespace
}  // namespace understudy::training
