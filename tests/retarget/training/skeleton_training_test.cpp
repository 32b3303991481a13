#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
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

TEST(SkeletonLoss, WeightsOfJointsCountInPlacesRotationsAndLengths) {
  torch::manual_seed(8);
  const auto truth = torch::randn({1, 22, 3}, torch::kFloat64);
  auto joints = truth.clone(), weights = torch::ones({1, 22}, torch::kFloat64);
  joints.select(1, LeftFoot) += 2;
  const double whole = mean_distance(joints, truth, weights).item<double>();
  EXPECT_NEAR(whole, mean_distance(joints, truth).item<double>(), 1e-9);
  weights.select(1, LeftFoot) = 0;
  EXPECT_NEAR(mean_distance(joints, truth, weights).item<double>(), 0, 2e-3);
  EXPECT_NEAR(length_loss(joints, truth, weights).item<double>(), 0, 1e-9);
  EXPECT_GT(length_loss(joints, truth).item<double>(), 0.01);
  auto turned = torch::zeros({1, 22, 6}, torch::kFloat64);
  turned.select(1, LeftFoot) += 1;
  EXPECT_EQ(columns_loss(turned, torch::zeros_like(turned), weights).item<double>(), 0);
  EXPECT_NEAR(columns_loss(turned, torch::zeros_like(turned)).item<double>(), 1.0 / 22, 1e-9);
}

TEST(SkeletonLoss, VisibilityHasTheRightGradient) {
  torch::manual_seed(9);
  const auto seen = torch::randint(0, 2, {2, 22}, torch::kFloat64);
  expect_gradient([&](const torch::Tensor& x) { return visibility_loss(x, seen); }, torch::randn({2, 22}));
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
  ScanMakerOptions clean = ScanMakerOptions().whole_and_alone();
  clean.captured = clean.holding = clean.skirts = clean.uneven = clean.shod = 0;
  ScanMaker maker(data, clean, 5);
  const MadeScan scan = maker.next();
  ASSERT_EQ(scan.points.rows(), nn::kScanPoints);
  for (int i = 0; i < nn::kScanPoints; ++i)
    EXPECT_LT((scan.points.row(i) - scan.truth.joints.row(scan.parts[i])).norm(), 0.2f);
}

/// Nothing but what the test turns on.
ScanMakerOptions plain_scans() {
  ScanMakerOptions options = ScanMakerOptions().whole_and_alone();
  options.captured = options.skirts = options.coats = options.hair = options.holding = options.one_sided =
      options.limbless = 0;
  options.posed_hands = options.shod = options.uneven = options.welded = options.fused_hands =
      options.voxels = 0;
  return options;
}

TEST_F(SkeletonTraining, HandsOfAllPeopleAreFoundWhereTheFolderHasHandPoses) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ASSERT_TRUE(data.hand_poses);
  EXPECT_FALSE(data.hands.empty());
  ASSERT_EQ(data.dressed_hands.size(), data.dressed.size());
  EXPECT_FALSE(data.dressed_hands[0].empty());
  fs::remove(folder_ / "body/hand_poses.npz");
  const TrainingData without = load_training_data(folder_.string(), Split::Train);
  EXPECT_FALSE(without.hand_poses);
  ScanMaker maker(without, {}, 5);
  EXPECT_EQ(maker.next().points.rows(), nn::kScanPoints);
}

TEST_F(SkeletonTraining, PosedFingersReachTheScanAndLeaveTheRest) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = plain_scans();
  options.dressed = 0;
  options.t_pose = 1;
  options.yaw = 0;
  options.points = 8000;
  const auto off_middle = [&](int part,
                              float posed) {  // how far the points' mean lies from the joint, metres
    options.posed_hands = posed;
    ScanMaker maker(data, options, 5);
    float sum = 0;
    for (int i = 0; i < 12; ++i) {
      const MadeScan scan = maker.next();
      std::vector<int> rows;
      for (int row = 0; row < ssize(scan.parts); ++row)
        if (scan.parts[row] == part) rows.push_back(row);
      sum += (scan.points(rows, Eigen::all).colwise().mean() - scan.truth.joints.row(part)).norm() / 12;
    }
    return sum;
  };
  EXPECT_NEAR(off_middle(LeftKnee, 1), off_middle(LeftKnee, 0), 0.002f);
  for (const int wrist : {LeftWrist, RightWrist})
    EXPECT_GT(off_middle(wrist, 1), off_middle(wrist, 0) + 0.004f) << wrist;
}

TEST_F(SkeletonTraining, SurfacesOfFusedViewsKeepTheirLabels) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  using Share = float ScanMakerOptions::*;
  for (const Share share : {&ScanMakerOptions::shod, &ScanMakerOptions::uneven, &ScanMakerOptions::welded,
                            &ScanMakerOptions::fused_hands, &ScanMakerOptions::voxels}) {
    ScanMakerOptions options = plain_scans();
    options.*share = 1;
    options.longest = 3;
    options.points = 2000;
    ScanMaker a(data, options, 5), b(data, options, 5);
    for (int i = 0; i < 4; ++i) {
      const MadeScan scan = a.next();
      EXPECT_EQ(scan.points, b.next().points);
      ASSERT_EQ(scan.points.rows(), ssize(scan.parts));
      ASSERT_TRUE(scan.points.allFinite());
      EXPECT_GT(scan.points.rows(), 1000);
      for (Eigen::Index p = 0; p < scan.points.rows(); ++p)
        EXPECT_LT((scan.points.row(p) - scan.truth.joints.row(scan.parts[p])).norm(), 0.35f);
    }
  }
}

/// Scans whose surface is fused in all ways.
ScanMakerOptions fused_scans() {
  ScanMakerOptions options = plain_scans();
  options.posed_hands = options.shod = options.uneven = 1;
  options.welded = options.fused_hands = options.voxels = 1;
  return options;
}

TEST_F(SkeletonTraining, FusedSurfacesShowAllJointsButThoseOfLostLimbs) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = fused_scans();
  ScanMaker whole(data, options, 16);
  options.limbless = 1;
  ScanMaker limbless(data, options, 16);
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(whole.next().sight.seen.sum(), kJointCount);
    EXPECT_LT(limbless.next().sight.seen.sum(), kJointCount);
  }
}

TEST_F(SkeletonTraining, DepthCamerasSeeTheSurfaceBeforeItIsFused) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = fused_scans();
  options.captured = options.sensors = 1;
  ScanMaker fused(data, options, 17);
  options.welded = options.fused_hands = options.voxels = 0;
  ScanMaker plain(data, options, 17);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(fused.next().points, plain.next().points);
}

TEST_F(SkeletonTraining, ScansForTargetsAreNearTheTPoseAndFaceForwards) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMaker maker(data, ScanMakerOptions::rest(), 3);
  for (int i = 0; i < 20; ++i) {
    const MadeScan scan = maker.next();
    const Rotations local = local_rotations(scan.truth.global);
    for (int j = 1; j < kJointCount; ++j) {
      const bool is_heeled = j == LeftAnkle || j == RightAnkle || j == LeftFoot || j == RightFoot;
      EXPECT_LT(geodesic_angle(local[j], Mat3::Identity()), is_heeled ? 0.6f : 0.1f) << kJointNames[j];
    }
    EXPECT_LT(geodesic_angle(local[0], Mat3::Identity()), 0.8f);
  }
}

float farthest(const Joints& a, const Joints& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

TEST_F(SkeletonTraining, SomebodyFollowedGoesOnAndIsSeenFromTheSameSide) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = ScanMakerOptions().whole_and_alone();
  options.longest = 4;
  options.captured = 0;
  options.one_sided = 1;
  options.skirts = options.coats = options.hair = options.holding = options.limbless = 0;
  options.uneven = options.welded = 0;
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

TEST_F(SkeletonTraining, HalfBodiesSayWhichJointsAreSeen) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = ScanMakerOptions().whole_and_alone();
  options.cut_below = 1;
  options.t_pose = 1;  // upright
  options.one_sided = options.holding = options.skirts = options.limbless = options.captured = 0;
  ScanMaker maker(data, options, 11);
  int footless = 0;
  constexpr int kScans = 40;
  for (int i = 0; i < kScans; ++i) {
    const MadeScan scan = maker.next();
    const auto feet = std::count(scan.parts.begin(), scan.parts.end(), LeftFoot),
               ankles = std::count(scan.parts.begin(), scan.parts.end(), LeftAnkle);
    if (feet > 40) EXPECT_EQ(scan.sight.seen[LeftFoot], 1);  // all there
    EXPECT_EQ(scan.sight.seen[Head], 1);
    EXPECT_LT((scan.sight.away * scan.sight.seen).maxCoeff(), 0.3f);
    if (feet + ankles > 0) continue;
    ++footless;
    EXPECT_EQ(scan.sight.seen[LeftFoot], 0);
    EXPECT_GT(scan.sight.away[LeftFoot], 0.3f);
  }
  EXPECT_GT(footless, kScans / 2);
}

TEST_F(SkeletonTraining, CutsAndThingsAboutStayWhereTheyAreFromFrameToFrame) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = ScanMakerOptions().whole_and_alone();
  options.longest = 4;
  options.captured = options.holding = options.one_sided = options.skirts = 0;
  options.furniture = 1;
  ScanMaker maker(data, options, 12);
  const auto middle_of_things = [](const MadeScan& scan) -> std::optional<Vec3> {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (int i = 0; i < scan.points.rows(); ++i)
      if (scan.parts[i] == kNoBody) sum += scan.points.row(i).transpose(), ++count;
    if (count < 120) return {};
    return Vec3(sum / static_cast<float>(count));
  };
  int followed = 0;
  for (int i = 0; i < 24; ++i) {
    ScanMaker::Stream stream = maker.start();
    const auto first = middle_of_things(maker.next(stream));
    while (!stream.poses.empty()) {
      const auto now = middle_of_things(maker.next(stream));
      if (!first || !now) continue;
      EXPECT_LT((*now - *first).norm(), 0.25f);
      ++followed;
    }
  }
  EXPECT_GT(followed, 5);
}

/// All that can happen to a scan at once.
ScanMakerOptions everything() {
  ScanMakerOptions options;
  options.longest = 3;
  options.captured = options.ground = options.furniture = options.balls = options.others = 1;
  options.sensors = options.cut_below = options.cut_beside = options.desks = options.seated = 0.5f;
  options.shod = options.uneven = options.welded = options.fused_hands = options.voxels = 0.5f;
  return options;
}

TEST_F(SkeletonTraining, WithAllAboutAndSeenBySensorsScansAreWholeAndTheSameForTheSameSeed) {
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMaker a(data, everything(), 13), b(data, everything(), 13);
  int not_body = 0;
  for (int i = 0; i < 12; ++i) {
    ScanMaker::Stream one = a.start(), same = b.start();
    while (!one.poses.empty()) {
      const MadeScan scan = a.next(one);
      EXPECT_EQ(scan.points, b.next(same).points);
      ASSERT_EQ(scan.points.rows(), nn::kScanPoints);
      ASSERT_EQ(scan.parts.size(), static_cast<size_t>(nn::kScanPoints));
      EXPECT_TRUE(scan.points.allFinite());
      not_body += std::count(scan.parts.begin(), scan.parts.end(), kNoBody) > 20;
    }
  }
  EXPECT_GT(not_body, 8);
}

TEST_F(SkeletonTraining, LossesStayBoundedForJointsFarOutsideTheCloud) {
  torch::manual_seed(6);
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = everything();
  options.cut_below = 1;
  ScanMaker maker(data, options, 14);
  std::vector<MadeScan> scans;
  for (int i = 0; i < 16; ++i) scans.push_back(maker.next());
  const SkeletonBatch batch = make_batch(scans);
  EXPECT_LT(batch.truth.weights.min().item<float>(), 0.5f);
  EXPECT_GE(batch.truth.weights.min().item<float>(), 0.2f);
  const auto net = nn::make_skeleton_form("dense");
  const LossSum loss = skeleton_loss(net->forward(batch.input), batch);
  EXPECT_TRUE(all_finite(loss.parts));
  EXPECT_LT(loss.total.item<double>(), 20);
}

TEST_F(SkeletonTraining, LearnsWhatIsSeen) {
  torch::manual_seed(7);
  const TrainingData data = load_training_data(folder_.string(), Split::Train);
  ScanMakerOptions options = ScanMakerOptions().whole_and_alone();
  options.cut_below = 1;
  ScanMaker maker(data, options, 15);
  const SkeletonBatch batch = make_batch({maker.next(), maker.next(), maker.next()});
  const auto net = nn::make_skeleton_form("dense");
  torch::optim::Adam optimizer(net->parameters(), 1e-3);
  double first = 0, last = 0;
  for (int step = 0; step < 60; ++step) {
    optimizer.zero_grad();
    const auto loss = skeleton_loss(net->forward(batch.input), batch);
    loss.total.backward();
    optimizer.step();
    EXPECT_EQ(loss.parts.back().name, "visibility_loss");
    (step == 0 ? first : last) = loss.parts.back().value;
  }
  EXPECT_LT(last, 0.4 * first);
}

TEST(JointWeight, FallsWithTheDistanceFromTheCloud) {
  EXPECT_EQ(joint_weight(0.1f), 1);
  EXPECT_NEAR(joint_weight(0.4f), 0.6f, 1e-5f);
  EXPECT_EQ(joint_weight(10), 0.2f);
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
  ScanMaker maker(data, ScanMakerOptions().whole_and_alone(), 7);
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
