// The network of steps: its losses, what it learns, and what is loaded of it.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/motion_space/linear_coder.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/step_loss.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy {
namespace {

using namespace testing;
using namespace training;

const nn::StepCvaeOptions kSmallCvae{6, 24, true, true};

class Steps : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
    torch::manual_seed(1);
    for (const char* part : {"/motion/a/walk_poses.npz", "/motion/b/walk_poses.npz"})
      test::write_walk_clip(folder_.path() + part);
  }
  void TearDown() override { log::set_sink(before_); }

  nn::MotionSpaceTrainOptions options(const char* name, int64_t samples) const {
    nn::MotionSpaceTrainOptions options;
    options.form = "paper";
    options.data = folder_.path();
    options.out = folder_.path() + "/" + name;
    options.batch = 8;
    options.threads = 1;
    options.samples = samples;
    options.code = 6;
    return options;
  }
  ShapedBody mean() const {
    ShapedBody body =
        read_smpl_body(read_split(folder_.path(), "train").body).shaped(Eigen::VectorXf::Zero(1));
    const Eigen::RowVector3f pelvis = body.joints.row(Pelvis);
    body.joints.rowwise() -= pelvis;
    body.vertices.rowwise() -= pelvis;
    return body;
  }
  StepData data() const {
    const ShapedBody body = mean();
    return {read_step_clips(read_split(folder_.path(), "train"), body.joints), leg_length(body.joints)};
  }
  StepBatch batch(int count, uint64_t seed) const {
    Rng rng(seed);
    return data().batch(count, rng);
  }

  DataFolder folder_;
  log::Sink before_;
};

TEST_F(Steps, AreSeenFromTheirBeginningsAndNoneTwiceTheSame) {
  const StepBatch seen = batch(40, 1);
  EXPECT_TRUE(torch::isfinite(seen.movements).all().item<bool>());
  const auto path = seen.movements.slice(1, kStepTurns, kStepTurns + kStepPath).view({40, kKnots, 3});
  EXPECT_LT(path.select(1, 0).select(1, 0).abs().max().item<float>(), 1e-5f);
  EXPECT_LT(path.select(1, 0).select(1, 2).abs().max().item<float>(), 1e-5f);
  EXPECT_GT(path.select(1, kKnots - 1).select(1, 2).max().item<float>(), 0.9f);  // a walk goes ahead
  for (int64_t row = 1; row < 40; ++row) EXPECT_FALSE(torch::equal(seen.movements[0], seen.movements[row]));
  EXPECT_TRUE(torch::equal(batch(40, 1).movements, seen.movements));
}

TEST_F(Steps, TheSurfaceIsAsFarAsItsVerticesAre) {
  const ShapedBody body = mean();
  const StepBatch seen = batch(2, 2);
  const auto squared =
      SurfaceDistance(body).squared(seen.movements.slice(0, 0, 1), seen.movements.slice(0, 1, 2));
  std::vector<TimedPoses> movements;
  for (int64_t row = 0; row < 2; ++row) {
    const auto numbers = seen.movements[row].contiguous();
    movements.push_back(movement_of_numbers(
        Eigen::Map<const StepNumbers>(numbers.data_ptr<float>(), kStepNumbers), body.joints));
  }
  for (int k = 0; k < kKnots; ++k) {
    const Points a = posed_vertices(body, movements[0].poses[k]),
                 b = posed_vertices(body, movements[1].poses[k]);
    const float truth = (a - b).rowwise().squaredNorm().mean();
    EXPECT_NEAR(squared[0][k].item<float>(), truth, 1e-3f * truth + 1e-6f) << k;
  }
}

TEST_F(Steps, GradientsOfTheSurfaceAreThoseOfFiniteDifferences) {
  const SurfaceDistance surface(mean());
  const StepBatch seen = batch(2, 3);
  const auto truth = seen.movements.slice(0, 0, 1).to(torch::kFloat64),
             from = seen.movements.slice(0, 1, 2).to(torch::kFloat64);
  // Along some directions: a movement has thousands of numbers.
  const auto ways = 0.1 * torch::randn({6, kStepNumbers}, torch::kFloat64);
  const auto value = [&](const torch::Tensor& x) {
    return surface.squared(from + torch::matmul(x, ways), truth).sum();
  };
  EXPECT_LT(gradient_error(value, 0.1 * torch::randn({1, 6}, torch::kFloat64)), 1e-5);
}

TEST_F(Steps, GradientsOfTheDivergenceAreThoseOfFiniteDifferences) {
  const auto other = torch::randn({2, 5}, torch::kFloat64);
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return divergence(x, other); },
                           torch::randn({2, 5}, torch::kFloat64)),
            1e-7);
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return divergence(other, x); },
                           torch::randn({2, 5}, torch::kFloat64)),
            1e-7);
  const auto zero = torch::zeros({2, 5});
  EXPECT_EQ(divergence(zero, zero).item<float>(), 0);
}

TEST_F(Steps, GradientsOfPartsAreThoseOfFiniteDifferences) {
  const auto truth = torch::randn({2, 9}, torch::kFloat64);
  EXPECT_LT(gradient_error([&](const torch::Tensor& x) { return part_loss(x, truth, 2, 5); },
                           torch::randn({2, 9}, torch::kFloat64)),
            1e-7);
}

TEST(LossBalance, WeighedGradientsBecomeAlike) {
  const auto shared = torch::ones({4}, torch::requires_grad());
  const auto one = [&] { return (shared * 3).square().sum(); };
  const auto other = [&] { return 0.1 * (shared - 0.2).square().sum(); };
  LossBalance balance(2);
  for (int i = 0; i < 50; ++i) balance.update({one(), other()}, shared);
  const auto norm = [&](const torch::Tensor& loss) {
    return torch::autograd::grad({loss}, {shared})[0].norm().item<double>();
  };
  EXPECT_EQ(balance.weight(0), 1);
  EXPECT_NEAR(balance.weight(1) * norm(other()) / norm(one()), 1, 1e-4);
  LossBalance resumed(2);
  resumed.set_state(balance.state());
  EXPECT_EQ(resumed.weight(1), balance.weight(1));
  EXPECT_THROW(balance.update({one()}, shared), Error);
}

TEST_F(Steps, OneBatchCanBeLearntByHeartInBothPhases) {
  const StepBatch seen = batch(8, 4);
  const SurfaceDistance surface(mean());
  const auto noise = torch::randn({8, 16});
  for (const bool on_surface : {false, true}) {
    nn::StepCvae net(nn::StepCvaeOptions{16, 64, true, true});
    net->set_usual(seen.rest[0], 1);
    torch::optim::Adam optimizer(net->parameters(), 2e-3);
    StepBalances balances;
    double first = 0, last = 0;
    for (int i = 0; i < 200; ++i) {
      optimizer.zero_grad();
      const LossSum loss = step_loss(net, seen, noise, surface, {0.01, on_surface, i % 10 == 0}, balances);
      loss.total.backward();
      optimizer.step();
      (i == 0 ? first : last) = loss.parts[on_surface ? 3 : 0].value;
    }
    EXPECT_LT(last, 0.1 * first) << on_surface;
  }
}

TEST_F(Steps, BeginsAsALinearCoder) {
  const ShapedBody body = mean();
  const auto clips = read_step_clips(read_split(folder_.path(), "train"), body.joints);
  const RowMatrix rows = step_rows(clips, leg_length(body.joints));
  const LinearSpace space(rows, surface_reach(body, rows.colwise().mean()), 6);
  nn::StepCvae net(kSmallCvae);
  net->begin_linear(nn::tensor_of(space.mean).squeeze(1), nn::tensor_of(space.to_codes),
                    nn::tensor_of(space.to_movements));
  const auto linear = fit_linear_coder(rows, 6, &body), coder = nn::step_coder(net);
  const TimedPoses movement =
      movement_of(clips[0].clip.motion, clips[0].steps[0].first, clips[0].steps[0].last);
  const auto a = linear->encode(movement, body.joints), b = coder->encode(movement, body.joints);
  for (size_t i = 0; i < a.mean.size(); ++i) EXPECT_NEAR(a.mean[i], b.mean[i], 1e-3f);
  const TimedPoses p = linear->decode(a.mean, body.joints), q = coder->decode(a.mean, body.joints);
  EXPECT_NEAR(p.duration(), q.duration(), 1e-4f);
  for (size_t k = 0; k < p.poses.size(); ++k)
    EXPECT_LT((forward_kinematics(body.joints, p.poses[k]).joints -
               forward_kinematics(body.joints, q.poses[k]).joints)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-3f);
}

TEST_F(Steps, GoingOnFromACheckpointIsTheSameAsNeverStopping) {
  EXPECT_EQ(train(options("whole", 64)), 0);
  auto stopped = options("parts", 64);
  int asked = 0;
  stopped.cancelled = [&asked] { return ++asked > 3; };
  EXPECT_EQ(train(stopped), 1);
  EXPECT_EQ(train(options("parts", 64)), 0);
  const auto net_of = [this](const char* name) {
    nn::StepCvae net(nn::StepCvaeOptions{6});
    nn::load_weights(folder_.path() + "/" + name, "motion-steps", nn::kStepCvaeVersion, *net);
    return net->parameters();
  };
  const auto a = net_of("whole"), b = net_of("parts");
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(torch::equal(a[i], b[i]));
}

TEST_F(Steps, NobodyStepsInAFolderWithoutSteps) {
  for (const char* part : {"/motion/a", "/motion/b"}) {
    std::filesystem::remove(folder_.path() + part + "/walk_poses.npz");
    const int64_t frames = 40;
    for (const auto& file : clip_files(folder_.path() + part))
      write_npz(file, {{"poses", {{frames, 66}, std::vector<float>(frames * 66, 0), ""}},
                       {"trans", {{frames, 3}, std::vector<float>(frames * 3, 0), ""}},
                       {"mocap_framerate", {{}, {30}, ""}}});
  }
  EXPECT_THROW(train(options("none", 8)), Error);
}

class LoadedCoder : public Steps {
 protected:
  void SetUp() override {
    Steps::SetUp();
    path_ = folder_.path() + "/steps.weights";
    rest_ = builtin_joints();
    walk_ = movement_of(builtin_motion("walk", rest_), 26, 60);
    nn::StepCvae net(kSmallCvae);
    save(nn::kStepCvaeVersion, 6, *net);
  }
  void save(int version, double code, const torch::nn::Module& net) const {
    nn::save_weights(path_, {"motion-steps", version, {{"code", code}, {"width", 24}}}, net);
  }

  std::string path_;
  Joints rest_;
  TimedPoses walk_;
};

TEST_F(LoadedCoder, CodesSayNothingOfPlaceAndHeading) {
  const auto coder = nn::load_step_coder(path_);
  const MotionCode code = coder->encode(walk_, rest_), again = coder->encode(walk_, rest_);
  EXPECT_EQ(code.mean, again.mean);
  ASSERT_EQ(ssize(code.mean), coder->size());
  ASSERT_EQ(code.deviation.size(), code.mean.size());
  TimedPoses there = walk_, mirror = walk_;
  const Mat3 turn = rotation_about_y(1.9f);
  for (Pose& pose : there.poses) {
    pose.local[Pelvis] = turn * pose.local[Pelvis];
    pose.root = turn * pose.root + Vec3(5, 0, -2);
  }
  for (Pose& pose : mirror.poses) pose = mirrored(pose);
  const MotionCode turned = coder->encode(there, rest_), seen = coder->encode(mirror, rest_);
  float apart = 0;
  for (size_t i = 0; i < code.mean.size(); ++i) {
    EXPECT_NEAR(turned.mean[i], code.mean[i], 1e-4f);
    EXPECT_NEAR(turned.deviation[i], code.deviation[i], 1e-4f);
    EXPECT_GT(code.deviation[i], 0);
    apart = std::max(apart, std::abs(seen.mean[i] - code.mean[i]));
  }
  EXPECT_GT(apart, 1e-3f);
}

TEST_F(LoadedCoder, AnyCodeIsAMovementThatBeginsAtTheOrigin) {
  const auto coder = nn::load_step_coder(path_);
  const std::vector<float> code = {3, -2, 0.5f, 9, -9, 1};
  const TimedPoses made = coder->decode(code, rest_), again = coder->decode(code, rest_);
  ASSERT_EQ(ssize(made.poses), kKnots);
  EXPECT_EQ(made.seconds.front(), 0);
  for (size_t k = 0; k < made.poses.size(); ++k) {
    EXPECT_EQ(made.poses[k].local, again.poses[k].local);
    if (k > 0) EXPECT_GT(made.seconds[k], made.seconds[k - 1]);
  }
  EXPECT_NEAR(made.poses.front().root.x(), 0, 1e-6f);
  EXPECT_NEAR(heading_of(made.poses.front().local[Pelvis]), 0, 1e-4f);
}

TEST_F(LoadedCoder, RefusesCodesAndMovementsThatAreNone) {
  const auto coder = nn::load_step_coder(path_);
  EXPECT_THROW(coder->decode(std::vector<float>(5, 0), rest_), Error);
  std::vector<float> code(6, 0);
  code[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(coder->decode(code, rest_), Error);
  TimedPoses long_one = walk_;
  for (float& s : long_one.seconds) s *= 10;
  EXPECT_THROW(coder->encode(long_one, rest_), Error);
}

TEST_F(LoadedCoder, RefusesOtherWeights) {
  nn::StepCvae net(kSmallCvae);
  save(nn::kStepCvaeVersion + 1, 6, *net);
  EXPECT_THROW(nn::load_step_coder(path_), Error);
  for (const double size : {0.0, -1.0, 2.5, 1e9, 7.0}) {
    save(nn::kStepCvaeVersion, size, *net);
    EXPECT_THROW(nn::load_step_coder(path_), Error) << size;
  }
  EXPECT_THROW(nn::load_step_coder(folder_.path() + "/none.weights"), Error);
}

TEST_F(LoadedCoder, WhoIsNotToldTheBodyMakesTheSameTurnsForAll) {
  for (const bool told : {false, true}) {
    nn::StepCvae net(nn::StepCvaeOptions{6, 24, told, true});
    const auto coder = nn::step_coder(net);
    const std::vector<float> code(6, 1);
    Joints other = rest_;
    for (const int joint : {LeftKnee, RightKnee}) other(joint, 1) -= 0.1f;
    EXPECT_EQ(coder->decode(code, rest_).poses[3].local == coder->decode(code, other).poses[3].local, !told);
  }
}

TEST_F(LoadedCoder, WithoutTimesAllTakeAsLongAsTheUsualOne) {
  nn::StepCvae net(nn::StepCvaeOptions{6, 24, true, false});
  net->set_usual(torch::rand({kJointCount, 3}), 1.2);
  const auto coder = nn::step_coder(net);
  EXPECT_NEAR(coder->decode(std::vector<float>(6, 2), rest_).duration(), 1.2f, 1e-4f);
  TimedPoses slow = walk_;
  for (float& s : slow.seconds) s *= 1.5f;
  const auto a = coder->encode(walk_, rest_).mean, b = coder->encode(slow, rest_).mean;
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5f);
}

}  // namespace
}  // namespace understudy
