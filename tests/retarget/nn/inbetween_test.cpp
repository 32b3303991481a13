// The network of the motion space: that it begins as the curve, what it learns, and what is loaded of it.
#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/inbetween_input.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/inbetween_data.hpp"
#include "retarget/training/inbetween_step.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace testing;
using namespace training;

const nn::InbetweenOptions kSmall{{24, 32, 2, 2}};

class Inbetween : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
    torch::manual_seed(1);
  }
  void TearDown() override { log::set_sink(before_); }

  nn::MotionSpaceTrainOptions options(const char* name, int64_t samples) const {
    nn::MotionSpaceTrainOptions options;
    options.data = folder_.path();
    options.out = folder_.path() + "/" + name;
    options.batch = 64;
    options.threads = 1;
    options.samples = samples;
    return options;
  }
  InbetweenBatch batch(int frames, uint64_t seed) const {
    Rng rng(seed);
    return InbetweenData(load_training_data(folder_.path(), Split::Train)).batch(frames, rng);
  }

  DataFolder folder_;
  log::Sink before_;
};

TEST_F(Inbetween, BeginsAsTheCurve) {
  nn::InbetweenNet net(kSmall);
  const InbetweenBatch seen = batch(64, 1);
  const nn::InbetweenOutput made = net->forward(seen.input);
  EXPECT_TRUE(torch::allclose(made.rotations, seen.input.rotations, 0, 1e-5));
  EXPECT_TRUE(torch::equal(made.root, seen.input.root));
}

TEST_F(Inbetween, LeavesWhatIsKnownToTheBit) {
  nn::InbetweenNet net(kSmall);
  {
    const torch::NoGradGuard no_grad;
    for (auto& parameter : net->parameters()) parameter.normal_(0, 0.3);
  }
  const InbetweenBatch seen = batch(256, 2);
  const nn::InbetweenOutput made = net->forward(seen.input);
  const auto known = seen.input.distance.amin(-1) == 0;  // [B, T, 23]
  const auto turned = (made.rotations != seen.input.rotations).flatten(3).any(-1);
  EXPECT_FALSE((turned & known.slice(2, 0, kJointCount)).any().item<bool>());
  EXPECT_TRUE((turned & ~known.slice(2, 0, kJointCount)).any().item<bool>());
  const auto moved = (made.root != seen.input.root).any(-1);
  EXPECT_FALSE((moved & known.select(2, kRootPart)).any().item<bool>());
}

TEST_F(Inbetween, ToldACodeItMakesAnotherMovementAndUntoldTheSame) {
  nn::InbetweenNet net(kSmall);
  {
    const torch::NoGradGuard no_grad;
    for (auto& parameter : net->parameters()) parameter.normal_(0, 0.3);
  }
  const InbetweenBatch seen = batch(64, 3);
  const auto code = torch::randn({seen.root.size(0), 16}), one = torch::ones({seen.root.size(0), 1});
  const auto untold = net->forward(seen.input), not_looked_at = net->forward(seen.input, code, 0 * one),
             told = net->forward(seen.input, code, one);
  EXPECT_TRUE(torch::equal(untold.rotations, not_looked_at.rotations));
  EXPECT_FALSE(torch::allclose(untold.rotations, told.rotations, 0, 1e-3));
}

TEST_F(Inbetween, ACodeOfAMovementInAMirrorIsTheCodeInAMirror) {
  nn::InbetweenNet net(kSmall);
  const Motion walk = builtin_motion("walk", builtin_person().joints);
  MotionWindow window;
  window.rest = builtin_person().joints;
  window.outlook = Outlook::of(walk.poses[40]);
  for (int t = 40; t < 70; ++t)
    window.curve.push_back(window.outlook.seen(walk.poses[static_cast<size_t>(t)]));
  window.distance.resize(window.curve.size());
  const auto code_of = [&](const MotionWindow& seen) { return net->encode(nn::input_of({seen})).mean; };
  const auto code = code_of(window), mirror = code_of(mirrored(window));
  EXPECT_TRUE(torch::allclose(nn::code_in_mirror(code), mirror, 1e-3, 1e-4));
  EXPECT_FALSE(torch::allclose(code, mirror, 1e-2, 1e-3)) << "and it is another";
}

TEST_F(Inbetween, OneBatchCanBeLearntByHeart) {
  nn::InbetweenNet net(nn::InbetweenOptions{{48, 96, 2, 4}});
  const InbetweenBatch seen = batch(64, 4);
  torch::optim::Adam optimizer(net->parameters(), 3e-3);
  double first = 0, last = 0;
  for (int i = 0; i < 150; ++i) {
    optimizer.zero_grad();
    const LossSum loss = inbetween_loss(net->forward(seen.input), seen);
    loss.total.backward();
    optimizer.step();
    (i == 0 ? first : last) = loss.parts[0].value;
  }
  EXPECT_LT(last, 0.4 * first);
}

TEST_F(Inbetween, GoingOnFromACheckpointIsTheSameAsNeverStopping) {
  EXPECT_EQ(train(options("whole", 24)), 0);
  auto stopped = options("parts", 24);
  int asked = 0;
  stopped.cancelled = [&asked] { return ++asked > 2; };
  EXPECT_EQ(train(stopped), 1);
  EXPECT_EQ(train(options("parts", 24)), 0);
  const auto net_of = [this](const char* name) {
    nn::InbetweenNet net;
    nn::load_weights(folder_.path() + "/" + name, "motion-space", nn::kInbetweenVersion, *net);
    return net->parameters();
  };
  const auto a = net_of("whole"), b = net_of("parts");
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(torch::equal(a[i], b[i]));
}

class LoadedSpace : public Inbetween {
 protected:
  void SetUp() override {
    Inbetween::SetUp();
    path_ = folder_.path() + "/space.weights";
    nn::InbetweenNet net(kSmall);
    {
      const torch::NoGradGuard no_grad;
      for (auto& parameter : net->parameters()) parameter.normal_(0, 0.2);
    }
    save(nn::kInbetweenVersion, *net);
    question_.rest = builtin_person().joints;
    question_.motion = builtin_motion("walk", question_.rest);
    question_.known.assign(question_.motion.poses.size(), all_parts(true));
    for (int t = 20; t < 30; ++t) question_.known[t] = all_parts(false);
  }
  void save(int version, const torch::nn::Module& net) const {
    nn::save_weights(
        path_, {"motion-space", version, {{"width", 24}, {"inner", 32}, {"layers", 2}, {"heads", 2}}}, net);
  }

  std::string path_;
  KnownMotion question_;
};

TEST_F(LoadedSpace, AnswersTwiceTheSameAndMirroredInAMirror) {
  const auto space = nn::load_inbetween_space(path_);
  const Completion made = space->complete(question_), again = space->complete(question_);
  KnownMotion mirror = question_;
  for (Pose& pose : mirror.motion.poses) pose = mirrored(pose);
  const Completion seen = space->complete(mirror);
  float moved = 0;
  for (int t = 0; t < ssize(question_.known); ++t) {
    const Pose &pose = made.motion.poses[t], &was = question_.motion.poses[t];
    EXPECT_EQ(pose.local, again.motion.poses[t].local);
    EXPECT_EQ(pose.root, again.motion.poses[t].root);
    if (t < 20 || t >= 30) EXPECT_EQ(pose.local, was.local);
    const Joints one = forward_kinematics(question_.rest, mirrored(pose)).joints,
                 other = forward_kinematics(question_.rest, seen.motion.poses[t]).joints;
    EXPECT_LT((one - other).rowwise().norm().maxCoeff(), 1e-3f) << t;
    moved = std::max(moved, (pose.root - was.root).norm());
  }
  EXPECT_GT(moved, 1e-3f);
}

TEST_F(LoadedSpace, RefusesOtherWeights) {
  nn::InbetweenNet net(kSmall);
  save(nn::kInbetweenVersion + 1, *net);
  EXPECT_THROW(nn::load_inbetween_space(path_), Error);
  EXPECT_THROW(nn::load_inbetween_space(folder_.path() + "/none.weights"), Error);
}

/// Mean distance of the joints from the truth over frames 20 .. 49, metres.
float gap_error(const KnownMotion& question, const Motion& made) {
  float sum = 0;
  for (int t = 20; t < 50; ++t)
    sum += (forward_kinematics(question.rest, made.poses[t]).joints -
            forward_kinematics(question.rest, question.motion.poses[t]).joints)
               .rowwise()
               .norm()
               .mean();
  return sum / 30;
}

// The built-in walk was made by hand: no network has learned from it.
TEST_F(LoadedSpace, TheShippedOneKnowsHowPeopleWalk) {
  const auto space =
      nn::load_inbetween_space(std::string(US_SOURCE_DIR) + "/assets/weights/motion_space.weights");
  KnownMotion walk = question_;
  const auto once = walk.motion.poses;
  const Vec3 way = once.back().root - once.front().root;
  for (int lap = 1; lap < 4; ++lap)
    for (size_t t = 1; t < once.size(); ++t) {
      walk.motion.poses.push_back(once[t]);
      walk.motion.poses.back().root += static_cast<float>(lap) * Vec3(way.x(), 0, way.z());
    }
  walk.known.assign(walk.motion.poses.size(), all_parts(true));
  for (int t = 20; t < 50; ++t) walk.known[t] = all_parts(false);
  Motion curve = walk.motion;
  fill_curves(walk.known, 0, ssize(curve.poses) - 1, curve);
  const Completion made = space->complete(walk);
  EXPECT_LT(gap_error(walk, made.motion), 0.7f * gap_error(walk, curve));
  EXPECT_GT(made.doubt_m[35], made.doubt_m[21]);
}

}  // namespace
}  // namespace understudy
