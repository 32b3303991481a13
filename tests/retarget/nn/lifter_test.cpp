// Lifting 2D poses: the network with and without LibTorch, its data, its training.
#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/networks/networks.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/pose2d/lengths_so_far.hpp"
#include "retarget/pose2d/lift_input.hpp"
#include "retarget/pose2d/lifted_path.hpp"
#include "retarget/training/lift_step.hpp"
#include "retarget/training/proportion_data.hpp"
#include "retarget/training/training_run.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;
using namespace training;

constexpr int kFrames = 12;

class LifterNetwork : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
  }
  void TearDown() override { log::set_sink(before_); }

  std::string file(const std::string& name) const { return folder_.path() + "/" + name; }
  nn::LifterTrainOptions options(const char* name, int64_t steps) const {
    nn::LifterTrainOptions options;
    options.data = folder_.path();
    options.out = file(name);
    options.threads = 1;
    options.batch = 4;
    options.frames = kFrames;
    options.samples = 4 * steps;
    return options;
  }
  LiftSequence some_sequence(uint64_t seed) const {
    const TrainingData data = load_training_data(folder_.path(), Split::Train);
    const std::vector<ClipRun> runs = good_runs(data.clips, kFrames, 1000);
    Rng rng(seed);
    FlatShot shot;
    shot.person = flat_people_of(data).front();
    shot.clip = &data.clips[static_cast<size_t>(runs.front().clip)];
    shot.first = runs.front().first;
    shot.frames = kFrames;
    return lift_sequence(shot, data.template_leg, {random_errors(rng), 0.05f}, rng);
  }
  std::string write_random_weights() const {
    torch::manual_seed(4);
    nn::LifterNet net;
    nn::save_weights(file("lifter.weights"), {"lifter", nn::kLifterVersion, {}}, *net);
    fs::copy_file(US_SOURCE_DIR "/assets/weights/proportions.weights", file("proportions.weights"),
                  fs::copy_options::overwrite_existing);
    return file("lifter.weights");
  }

  testing::DataFolder folder_;
  log::Sink before_;
};

LiftView some_view() {
  LiftView view;
  view.canvas = {720, 720};
  return view;
}

/// The module's answers to a sequence and its mirror image, frame by frame, in both's mean.
std::vector<Extraction> by_module(nn::LifterNet& net, const LiftSequence& sequence) {
  const torch::NoGradGuard no_grad;
  const auto count = static_cast<int64_t>(sequence.poses.size());
  auto frames = torch::empty({2, count, kLiftInputs});
  std::vector<LiftFrame> plain;
  const auto reader = nn::load_length_reader(US_SOURCE_DIR "/assets/weights");
  for (const int64_t row : {0, 1}) {
    LiftInput input;
    LengthsSoFar lengths;
    for (int64_t t = 0; t < count; ++t) {
      const FlatPose& pose = sequence.poses[static_cast<size_t>(t)];
      const LiftFrame frame =
          input.push(row == 0 ? pose : in_mirror(pose), lengths.push(pose, *reader), sequence.dt);
      if (row == 0) plain.push_back(frame);
      for (int i = 0; i < kLiftInputs; ++i) frames[row][t][i] = frame.numbers[i];
    }
  }
  torch::Tensor state;
  const auto told = net(frames, state);
  LiftedPath path(some_view());
  std::vector<Extraction> extractions;
  for (int64_t t = 0; t < count; ++t) {
    LiftedPose lifted;
    for (int j = 0; j < kJointCount; ++j) {
      const int m = kMirror[static_cast<size_t>(j)];
      for (int axis = 0; axis < 3; ++axis)
        lifted.joints(j, axis) = (told.joints[0][t][j][axis].item<float>() +
                                  (axis == 0 ? -1 : 1) * told.joints[1][t][m][axis].item<float>()) /
                                 2;
      lifted.off[j] =
          std::exp((told.log_off[0][t][j].item<float>() + told.log_off[1][t][m].item<float>()) / 2);
    }
    const LiftFrame& frame = plain[static_cast<size_t>(t)];
    lifted.pitch = (told.pitch[0][t].item<float>() + told.pitch[1][t].item<float>()) / 2;
    lifted.origin = frame.origin, lifted.has_hips = frame.has_hips, lifted.size = frame.size;
    extractions.push_back(path.push(lifted, sequence.poses[static_cast<size_t>(t)], sequence.dt));
  }
  return extractions;
}

TEST_F(LifterNetwork, TheLifterSaysWhatTheModuleSays) {
  nn::LifterNet net;
  nn::load_weights(write_random_weights(), "lifter", nn::kLifterVersion, *net);
  const auto lifter = nn::load_lifter(folder_.path());
  for (const uint64_t seed : {3, 4}) {
    const LiftSequence sequence = some_sequence(seed);
    const std::vector<Extraction> expected = by_module(net, sequence);
    lifter->reset(some_view());
    for (size_t t = 0; t < expected.size(); ++t) {
      const Extraction told = lifter->push(sequence.poses[t], sequence.dt);
      // An untrained network's stature is tiny, and so lengths are huge: compared as shares.
      const float size = expected[t].joints.cwiseAbs().maxCoeff();
      EXPECT_LT((told.joints - expected[t].joints).cwiseAbs().maxCoeff(), 1e-3f * size) << t;
      EXPECT_LT((told.confidence - expected[t].confidence).abs().maxCoeff(), 1e-3f) << t;
    }
  }
}

TEST_F(LifterNetwork, TheLifterRefusesDamagedFilesAndPosesBeforeItsView) {
  const std::string path = write_random_weights();
  EXPECT_THROW(nn::load_lifter(folder_.path())->push(some_sequence(1).poses[0], 0.03f), Error);
  const auto problem = [&] { return failure_of([&] { nn::load_lifter(folder_.path()); }); };
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_NE(problem().find("lifter.weights"), std::string::npos);
  nn::save_weights(path, {"proportions", 1, {}}, *nn::LifterNet());
  EXPECT_NE(problem().find("lifter.weights: holds weights for 'proportions'"), std::string::npos);
  nn::save_weights(path, {"lifter", nn::kLifterVersion + 1, {}}, *nn::LifterNet());
  EXPECT_NE(problem().find("this program needs version"), std::string::npos);
  fs::remove(path);
  EXPECT_NE(problem().find("lifter.weights"), std::string::npos);
}

TEST_F(LifterNetwork, BatchesAreFiniteAndTheSameForTheSameSeed) {
  const LiftData data(load_training_data(folder_.path(), Split::Train), kFrames);
  Rng one(5), same(5), other(6);
  const LiftBatch a = data.batch(16, one), b = data.batch(16, same), c = data.batch(16, other);
  EXPECT_TRUE(torch::equal(a.frames, b.frames) && torch::equal(a.joints, b.joints));
  EXPECT_FALSE(torch::equal(a.frames, c.frames));
  EXPECT_TRUE(a.frames.isfinite().all().item<bool>() && a.joints.isfinite().all().item<bool>());
  // Nobody is longer than twice what their size in the picture says.
  EXPECT_LT(a.joints.abs().max().item<float>(), 2);
}

TEST_F(LifterNetwork, OneBatchCanBeLearntByHeart) {
  const LiftData data(load_training_data(folder_.path(), Split::Train), kFrames);
  Rng rng(4);
  const LiftBatch batch = data.batch(3, rng);
  torch::manual_seed(1);
  nn::LifterNet net;
  torch::optim::Adam optimizer(net->parameters(), 2e-3);
  Figures first, last;
  for (int i = 0; i < 250; ++i) {
    optimizer.zero_grad();
    const LossSum loss = lift_loss(net, batch, torch::kCPU);
    loss.total.backward();
    torch::nn::utils::clip_grad_norm_(net->parameters(), 1);
    optimizer.step();
    (i == 0 ? first : last) = loss.parts;
  }
  EXPECT_EQ(last[0].name, "places");
  EXPECT_LT(last[0].value, 0.2 * first[0].value);
}

TEST_F(LifterNetwork, GoesOnAsIfItHadNotBeenStopped) {
  ASSERT_EQ(training::train(options("whole.weights", 8)), 0);
  nn::LifterTrainOptions parted = options("parted.weights", 8);
  int asked = 0;
  parted.cancelled = [&] { return ++asked > 3; };
  ASSERT_EQ(training::train(parted), 1);
  parted.cancelled = {};
  ASSERT_EQ(training::train(parted), 0);
  const auto weights = [&](const char* name) {
    nn::LifterNet net;
    nn::load_weights(file(name), "lifter", nn::kLifterVersion, *net);
    std::vector<torch::Tensor> all;
    for (const auto& parameter : net->parameters()) all.push_back(parameter.flatten());
    return torch::cat(all);
  };
  EXPECT_TRUE(torch::equal(weights("whole.weights"), weights("parted.weights")));
  EXPECT_GT(nn::read_weights_header(file("whole.weights")).numbers.count("n_mpjpe_mm_clean"), 0u);
}

}  // namespace
}  // namespace understudy
