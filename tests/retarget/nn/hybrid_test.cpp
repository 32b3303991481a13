// The engine `hybrid`: its network, its engine, what it learns from and its training.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/hybrid_transfer.hpp"
#include "retarget/nn/modules/joint_tensors.hpp"
#include "retarget/nn/skeleton_form.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/pipeline/joint_filter.hpp"
#include "retarget/training/hybrid_trainer.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using namespace testing;
using namespace training;

Joints rest() {
  return nn::to_joints(rest_joints(1)[0]);
}

float difference(const Rotations& a, const Rotations& b) {
  float worst = 0;
  for (int j = 0; j < kJointCount; ++j) worst = std::max(worst, geodesic_angle(a[j], b[j]));
  return worst;
}

/// Somebody who bends and turns, seen with a little noise.
Extraction moving(int frame, Rng& rng) {
  const float s = std::sin(0.15f * static_cast<float>(frame)),
              c = std::cos(0.11f * static_cast<float>(frame));
  Pose pose;
  pose.local[Pelvis] = rotation_about_y(0.02f * static_cast<float>(frame));
  pose.local[LeftElbow] = rotation_from_axis_angle({0, -0.8f + 0.6f * s, 0});
  pose.local[RightKnee] = rotation_from_axis_angle({0.7f + 0.6f * c, 0, 0});
  pose.local[Spine1] = rotation_from_axis_angle({0.2f * s, 0, 0.1f * c});
  const PosedSkeleton posed = forward_kinematics(rest(), pose);
  Extraction seen;
  seen.joints = posed.joints;
  for (int i = 0; i < seen.joints.size(); ++i) seen.joints.data()[i] += 0.01f * rng.normal();
  seen.confidence.setConstant(0.8f);
  seen.global = posed.global;
  return seen;
}

/// A network that says something: untrained ones say nothing.
nn::HybridGru talkative(int64_t hidden, uint64_t seed = 1) {
  torch::manual_seed(seed);
  nn::HybridGru net(nn::HybridGruOptions{hidden, 1});
  const torch::NoGradGuard no_grad;
  for (auto& p : net->parameters()) p.normal_(0, 0.3);
  return net;
}

class Hybrid : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
  }
  void TearDown() override { log::set_sink(before_); }

  std::string file(const char* name) const { return folder_.path() + "/" + name; }
  std::string weights(nn::HybridGru net, int64_t hidden) const {
    nn::save_weights(file("hybrid.weights"),
                     {"hybrid", nn::kHybridVersion, {{"hidden", static_cast<double>(hidden)}, {"layers", 1}}},
                     *net, /*half=*/false);
    return file("hybrid.weights");
  }

  DataFolder folder_;
  log::Sink before_;
};

TEST_F(Hybrid, UntrainedItIsTheAnalyticSolve) {
  auto engine = nn::load_hybrid_transfer(weights(nn::HybridGru(nn::HybridGruOptions{16, 1}), 16));
  CopyTransfer copy;
  engine->reset(rest());
  copy.reset(rest());
  Rng a(1), b(1);
  for (int t = 0; t < 8; ++t)
    EXPECT_LT(difference(engine->push(moving(t, a), 1.0f / 30), copy.push(moving(t, b), 1.0f / 30)), 2e-3f);
}

TEST_F(Hybrid, IsTheSameEveryTimeAndForgetsAtReset) {
  auto engine = nn::load_hybrid_transfer(weights(talkative(16), 16));
  std::vector<Rotations> first, second;
  for (auto* run : {&first, &second}) {
    Rng rng(1);
    engine->reset(rest());
    for (int t = 0; t < 6; ++t) run->push_back(engine->push(moving(t, rng), 1.0f / 30));
  }
  for (size_t t = 0; t < first.size(); ++t) EXPECT_EQ(difference(first[t], second[t]), 0) << "frame " << t;
  for (const Mat3& R : first.back())
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-5f);
}

TEST_F(Hybrid, FrameByFrameIsAsAWholeSequence) {
  nn::HybridGru net = talkative(16);
  auto engine = nn::load_hybrid_transfer(weights(net, 16));
  engine->reset(rest());
  nn::HybridSolve solve;
  solve.reset(rest());
  std::vector<nn::HybridFrame> frames;
  Rng a(1), b(1);
  std::vector<Rotations> online;
  for (int t = 0; t < 6; ++t) {
    frames.push_back(solve.push(moving(t, a), 1.0f / 30));
    online.push_back(engine->push(moving(t, b), 1.0f / 30));
  }
  const torch::NoGradGuard no_grad;
  nn::HybridState state;
  const auto whole = nn::local_rotations(net->forward(nn::stack_frames({frames}), state));
  for (int t = 0; t < 6; ++t) EXPECT_LT(difference(nn::to_rotations(whole[0][t]), online[t]), 2e-3f);
}

TEST_F(Hybrid, TurnsWithTheSource) {
  auto engine = nn::load_hybrid_transfer(weights(talkative(16), 16));
  const Mat3 yaw = rotation_about_y(2.5f);
  std::vector<Rotations> straight, turned;
  for (const bool turn : {false, true}) {
    Rng rng(1);
    engine->reset(rest());
    for (int t = 0; t < 4; ++t) {
      Extraction seen = moving(t, rng);
      if (turn) {
        seen.joints = (seen.joints * yaw.transpose()).eval();
        for (Mat3& R : *seen.global) R = yaw * R;
      }
      (turn ? turned : straight).push_back(engine->push(seen, 1.0f / 30));
    }
  }
  EXPECT_LT(geodesic_angle(yaw * straight[3][Pelvis], turned[3][Pelvis]), 2e-3f);
  EXPECT_LT(geodesic_angle(straight[3][LeftElbow], turned[3][LeftElbow]), 2e-3f);
}

TEST_F(Hybrid, TenThousandFramesStayNearTheSolveAndThePastIsForgotten) {
  auto engine = nn::load_hybrid_transfer(weights(talkative(8), 8));
  auto late = nn::load_hybrid_transfer(weights(talkative(8), 8));
  nn::HybridSolve solve;  // as the engine's: what it adds is bounded, not what it adds to
  for (auto* one : {engine.get(), late.get()}) one->reset(rest());
  solve.reset(rest());
  Rng rng(1);
  float most = 0, apart = 0;
  for (int t = 0; t < 10000; ++t) {
    const Extraction seen = moving(t, rng);
    const Rotations local = engine->push(seen, 1.0f / 30);
    const Rotations global = forward_kinematics(rest(), Pose{local, Vec3::Zero()}).global;
    most = std::max(most, difference(global, solve.push(seen, 1.0f / 30).solved));
    // Begun 200 frames before the end, it does what the one does that ran all the time.
    if (t >= 9800) apart = difference(local, late->push(seen, 1.0f / 30));
  }
  EXPECT_LT(most, 1.1f);
  EXPECT_GT(most, 0.05f);
  EXPECT_LT(apart, 0.05f);
}

TEST_F(Hybrid, ABadFrameIsRefusedAndLeavesNoTrace) {
  const std::string path = weights(talkative(16), 16);
  auto engine = nn::load_hybrid_transfer(path), other = nn::load_hybrid_transfer(path);
  for (auto* one : {engine.get(), other.get()}) {
    Rng rng(1);
    one->reset(rest());
    one->push(moving(0, rng), 1.0f / 30);
  }
  Rng rng(2);
  Extraction bad = moving(1, rng);
  bad.joints(LeftKnee, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(engine->push(bad, 1.0f / 30), Error);
  const Extraction good = moving(2, rng);
  EXPECT_EQ(difference(engine->push(good, 1.0f / 30), other->push(good, 1.0f / 30)), 0);
}

TEST_F(Hybrid, WantsATargetAndItsOwnWeights) {
  auto engine = nn::load_hybrid_transfer(weights(talkative(16), 16));
  Rng rng(1);
  EXPECT_THROW(engine->push(moving(0, rng), 1.0f / 30), Error);
  EXPECT_THROW(nn::load_hybrid_transfer(file("absent")), Error);
  nn::save_weights(file("motion.weights"), {"motion", 1, {{"hidden", 16}, {"layers", 1}}}, *talkative(16));
  EXPECT_THROW(nn::load_hybrid_transfer(file("motion.weights")), Error);
}

/// An extractor that has its own errors: it sees the mean of the points, and a body around it.
class RoughExtractor : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh& scan) override {
    Extraction seen;
    seen.joints = rest().rowwise() + scan.vertices.colwise().mean();
    seen.confidence.setConstant(0.5f);
    seen.global = identity_rotations();
    (*seen.global)[LeftElbow] = rotation_about_y(0.3f);
    return seen;
  }
  std::string name() const override { return "rough"; }
};

HybridCache small_cache(const TrainingData& data) {
  RoughExtractor extractor;
  HybridWindowMaker maker(data, 12, 3);
  HybridCache cache;
  cache.frames = 12;
  for (int i = 0; i < 3; ++i) cache.train.push_back(maker.next(extractor));
  cache.dev.push_back(maker.next(extractor));
  return cache;
}

TEST_F(Hybrid, WindowsComeBackFromTheirFile) {
  const TrainingData data = load_training_data(folder_.path(), Split::Train);
  const HybridCache cache = small_cache(data);
  write_hybrid_cache(file("cache"), cache);
  const HybridCache again = read_hybrid_cache(file("cache"));
  ASSERT_EQ(again.train.size(), 3u);
  ASSERT_EQ(again.dev.size(), 1u);
  EXPECT_EQ(again.frames, 12);
  const HybridWindow &a = cache.train[1], &b = again.train[1];
  EXPECT_EQ(a.dt, b.dt);
  for (size_t t = 0; t < 12; ++t) {
    EXPECT_EQ(a.seen[t].joints, b.seen[t].joints);
    EXPECT_EQ(a.truth[t].joints, b.truth[t].joints);
    EXPECT_LT(difference(*a.seen[t].global, *b.seen[t].global), 2e-3f);
    EXPECT_LT(difference(a.truth[t].global, b.truth[t].global), 2e-3f);
  }
  std::filesystem::resize_file(file("cache"), std::filesystem::file_size(file("cache")) / 2);
  EXPECT_THROW(read_hybrid_cache(file("cache")), Error);
  EXPECT_THROW(read_hybrid_cache(file("absent")), Error);
}

TEST_F(Hybrid, ErrorsAreScaledAndMirrorsComeBack) {
  const HybridWindow window = small_cache(load_training_data(folder_.path(), Split::Train)).train[0];
  const HybridWindow twice = mirrored(mirrored(window)), none = with_scaled_errors(window, 0),
                     same = with_scaled_errors(window, 1);
  for (size_t t = 0; t < window.seen.size(); ++t) {
    EXPECT_EQ(twice.seen[t].joints, window.seen[t].joints);
    EXPECT_LT(difference(*none.seen[t].global, window.truth[t].global), 2e-3f);
    EXPECT_LT((none.seen[t].joints - window.truth[t].joints).cwiseAbs().maxCoeff(), 1e-5f);
    EXPECT_LT(difference(*same.seen[t].global, *window.seen[t].global), 5e-3f);
  }
  const Joints mirror = mirrored(window).truth[0].joints;
  EXPECT_EQ(mirror(LeftWrist, 0), -window.truth[0].joints(RightWrist, 0));
}

HybridTrainerOptions small() {
  HybridTrainerOptions options;
  options.net = {/*hidden=*/32, /*layers=*/1};
  options.batch = 2;
  return options;
}

TEST_F(Hybrid, OneBatchCanBeLearntByHeart) {
  const auto windows = small_cache(load_training_data(folder_.path(), Split::Train)).train;
  HybridTrainer trainer(small(), {rest()});
  Rng rng(4);
  const HybridBatch batch = make_hybrid_batch({windows[0], windows[1]}, {rest()}, rng);
  const HybridStep first = trainer.step(batch);
  HybridStep last;
  for (int i = 0; i < 200; ++i) last = trainer.step(batch);
  EXPECT_LT(last.rotation, 0.75 * first.rotation);  // what is wrong by more than 60 degrees stays so
  EXPECT_LT(last.position, 0.6 * first.position);
  const HybridFigures figures = judge_hybrid(trainer.net, batch);
  EXPECT_LT(figures.hybrid.rot_deg, figures.solve.rot_deg);
}

TEST_F(Hybrid, GoingOnFromACheckpointIsTheSameAsNeverStopping) {
  const auto windows = small_cache(load_training_data(folder_.path(), Split::Train)).train;
  HybridTrainer whole(small(), {rest()});
  for (int i = 0; i < 4; ++i) whole.step(windows, i / 4.0);
  HybridTrainer first(small(), {rest()});
  for (int i = 0; i < 2; ++i) first.step(windows, i / 4.0);
  first.save_checkpoint(file("half"));
  auto other_seed = small();
  other_seed.seed = 99;
  HybridTrainer second(other_seed, {rest()});
  second.load_checkpoint(file("half"));
  for (int i = 2; i < 4; ++i) second.step(windows, i / 4.0);
  EXPECT_EQ(second.samples, whole.samples);
  for (const auto& [a, b] :
       {std::make_pair(whole.net, second.net), std::make_pair(whole.average, second.average)})
    for (size_t i = 0; i < a->parameters().size(); ++i)
      EXPECT_TRUE(torch::equal(a->parameters()[i], b->parameters()[i]));
  std::ofstream(file("junk")) << "not a checkpoint";
  EXPECT_THROW(second.load_checkpoint(file("junk")), Error);
}

TEST_F(Hybrid, TheCommandMakesItsWindowsTrainsAndGoesOn) {
  // A cache with enough windows of the right length wants no extractor.
  const TrainingData data = load_training_data(folder_.path(), Split::Train);
  nn::TrainOptions options;
  options.network = "hybrid";
  options.data = folder_.path();
  options.out = file("hybrid.weights");
  options.weights = file("nowhere");
  options.windows = 1;
  options.batch = 1;
  options.threads = 1;
  options.samples = 120;
  EXPECT_THROW(train_hybrid(options), Error);  // no cache
  options.cache = file("cache");
  EXPECT_THROW(train_hybrid(options), Error);  // nothing to extract with
  HybridCache cache;
  HybridWindow window = small_cache(data).train[0];
  for (int i = 0; i < 4; ++i) {  // 12 frames become 60
    for (size_t t = 0; t < 12; ++t) {
      window.seen.push_back(window.seen[t]);
      window.truth.push_back(window.truth[t]);
    }
  }
  cache.train = cache.dev = {window};
  write_hybrid_cache(options.cache, cache);
  EXPECT_EQ(train_hybrid(options), 0);
  EXPECT_EQ(nn::read_weights_header(options.out).numbers.at("frames"), 120);
  options.samples = 180;
  EXPECT_EQ(train_hybrid(options), 0);
  EXPECT_EQ(nn::read_weights_header(options.out).numbers.at("frames"), 180);
  EXPECT_NO_THROW(nn::load_hybrid_transfer(options.out));
}

}  // namespace
}  // namespace understudy
