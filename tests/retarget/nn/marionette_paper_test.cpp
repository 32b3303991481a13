// Paper 3's own detector: its parts, what finds keypoints by it, its training.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/nn/load.hpp"
#include "retarget/nn/modules/affinity.hpp"
#include "retarget/nn/modules/voxel_keypoints.hpp"
#include "retarget/nn/weights_file.hpp"
#include "retarget/training/losses/keypoint_losses.hpp"
#include "retarget/training/training_run.hpp"
#include "retarget/training/voxel_data.hpp"
#include "tests/retarget/nn/motion_support.hpp"

namespace understudy {
namespace {

using nn::VoxelKeypoints;
using nn::VoxelKeypointsForm;
using nn::VoxelKeypointsNet;

VoxelKeypointsForm small_form(int64_t grid = 32) {
  VoxelKeypointsForm form;
  form.keypoints = 5;
  form.grid = grid;
  form.width = 16;
  return form;
}

/// A block of four cells an edge, which goes along x, [1, T, 1, G, G, G].
torch::Tensor moving_block(int64_t frames, int64_t grid = 32) {
  auto voxels = torch::zeros({1, frames, 1, grid, grid, grid});
  for (int64_t t = 0; t < frames; ++t)
    voxels[0][t][0].narrow(0, 8, 4).narrow(1, 12, 4).narrow(2, 4 + 2 * t, 4).fill_(1);
  return voxels;
}

TEST(VoxelKeypointsNet, GivesKeypointsInTheBoxAndGridsOfTheSameSize) {
  torch::manual_seed(1);
  const torch::NoGradGuard no_grad;
  for (const int64_t grid : {32, 64}) {
    VoxelKeypointsNet net(small_form(grid));
    const auto voxels = moving_block(2, grid);
    const VoxelKeypoints found = net->forward(voxels);
    EXPECT_EQ(found.places.sizes(), (torch::IntArrayRef{2, 5, 3}));
    EXPECT_EQ(found.heatmaps.sizes(), (torch::IntArrayRef{2, 5, grid / 4, grid / 4, grid / 4}));
    EXPECT_EQ(found.features.sizes(), (torch::IntArrayRef{2, 16, grid / 4, grid / 4, grid / 4}));
    EXPECT_LE(found.places.abs().max().item<float>(), 1);
    EXPECT_TRUE(torch::allclose(std::get<0>(found.intensity.max(1)), torch::ones({2})));
    EXPECT_EQ(net->decoded(found, voxels).sizes(), (torch::IntArrayRef{2, 1, grid, grid, grid}));
  }
}

TEST(VoxelKeypointsNet, AKeypointIsTheMeanOfItsMap) {
  torch::manual_seed(2);
  const torch::NoGradGuard no_grad;
  VoxelKeypointsNet net(small_form());
  const VoxelKeypoints found = net->forward(moving_block(2));
  const auto m = found.heatmaps[1][3];  // [z, y, x]
  torch::Tensor sum = torch::zeros({3}), all = torch::zeros({});
  for (int64_t z = 0; z < 8; ++z)
    for (int64_t y = 0; y < 8; ++y)
      for (int64_t x = 0; x < 8; ++x) {
        const auto centre = torch::tensor({x, y, z}, torch::kFloat32) * (2.0 / 7) - 1;
        sum += m[z][y][x] * centre, all += m[z][y][x];
      }
  EXPECT_TRUE(torch::allclose(found.places[1][3], sum / all, 1e-4, 1e-5));
  const auto means = found.heatmaps[1].mean({1, 2, 3});
  EXPECT_TRUE(torch::allclose(found.intensity[1], means / means.max(), 1e-4, 1e-5));
}

TEST(VoxelKeypointsNet, SeesTheSequenceByItsMeanOverTimeAlone) {
  torch::manual_seed(3);
  const torch::NoGradGuard no_grad;
  VoxelKeypointsNet net(small_form());
  const auto voxels = moving_block(3);
  const auto turned = net->forward(voxels.flip(1)).places.flip(0);
  EXPECT_TRUE(torch::allclose(net->forward(voxels).places, turned, 1e-4, 1e-5)) << "in any order";
  const auto alone = net->forward(voxels.narrow(1, 0, 1)).places;
  EXPECT_GT((net->forward(voxels).places.narrow(0, 0, 1) - alone).abs().max().item<float>(), 1e-5)
      << "other frames change what is found in this one";
}

TEST(VoxelKeypointsNet, AffinitiesAreRowsThatSumToOneWithoutADiagonal) {
  torch::manual_seed(4);
  const torch::NoGradGuard no_grad;
  VoxelKeypointsNet net(small_form());
  net->named_parameters()["free_affinity"][0][1][2] = 5;  // row 1 leaves out itself: the number is of 1 -> 3
  const auto A = net->affinities();
  EXPECT_EQ(A.sizes(), (torch::IntArrayRef{2, 5, 5}));
  EXPECT_TRUE(torch::allclose(A.sum(2), torch::ones({2, 5})));
  EXPECT_EQ(A.diagonal(0, 1, 2).abs().max().item<float>(), 0);
  EXPECT_GT(A[0][1][3].item<float>(), 0.99);
  EXPECT_NEAR(nn::matrices_of(A)[0](1, 3), A[0][1][3].item<float>(), 1e-6);
}

TEST(VoxelKeypointsNet, RefusesSizesThatItsHourglassCannotHalve) {
  EXPECT_THROW(VoxelKeypointsNet(small_form(48)), Error);
  VoxelKeypointsForm form = small_form();
  form.width = 8;
  EXPECT_THROW(VoxelKeypointsNet{form}, Error);
}

TEST(VoxelKeypointsNet, LearnsOneWindowByHeart) {
  torch::manual_seed(5);
  VoxelKeypointsNet net(small_form());
  torch::optim::Adam optimizer(net->parameters(), torch::optim::AdamOptions(5e-3));
  const auto voxels = moving_block(4);
  double first = 0, last = 0;
  for (int step = 0; step < 20; ++step) {
    optimizer.zero_grad();
    const auto found = net->forward(voxels);
    const auto loss = training::reconstruction_loss(net->decoded(found, voxels), voxels.flatten(0, 1));
    loss.backward();
    optimizer.step();
    last = loss.item<double>();
    if (step == 0) first = last;
  }
  EXPECT_LT(last, 0.5 * first);
  for (const auto& parameter : net->named_parameters())
    if (parameter.key() != "free_affinity") {  // it has losses of its own
      EXPECT_TRUE(parameter.value().grad().defined()) << parameter.key();
    }
}

TEST(VoxelData, IsCentresOfOccupiedCellsAndJointsAmongThem) {
  const testing::DataFolder folder;
  const training::VoxelData data("person", folder.path(), training::Split::Dev, 32);
  Rng rng(1);
  const training::VoxelBatch batch = data.batch(2, 6, rng);
  EXPECT_EQ(batch.voxels.sizes(), (torch::IntArrayRef{2, 10, 1, 32, 32, 32}));
  EXPECT_TRUE(torch::equal(batch.voxels.flatten(2).sum(2).flatten(), batch.counts.sum(1)));
  ASSERT_EQ(batch.joints.size(), 20u);
  EXPECT_LE(batch.joints[7].cwiseAbs().maxCoeff(), 1.2f);
  const auto cell = batch.cells[13][0];  // x, y, z
  const auto at = ((cell + 1) * 15.5).round().to(torch::kLong);
  EXPECT_EQ(batch.voxels[1][3][0][at[2].item<int64_t>()][at[1].item<int64_t>()][at[0].item<int64_t>()]
                .item<float>(),
            1);
}

TEST(VoxelData, WindowsOfFramesFurtherApartHoldMoreMotion) {
  const testing::DataFolder folder;
  const training::VoxelData data("person", folder.path(), training::Split::Dev, 32);
  const auto motion = [&](int apart) {
    Rng rng(1);
    const training::VoxelBatch batch = data.batch(12, apart, rng);
    float sum = 0;  // how far joints are from the window's middle frame, in its box
    for (size_t f = 0; f < batch.joints.size(); ++f)
      sum += (batch.joints[f] - batch.joints[f / 10 * 10 + 5]).rowwise().norm().mean();
    return sum;
  };
  EXPECT_GT(motion(5), 1.5f * motion(1));
  EXPECT_EQ(motion(5), motion(500)) << "clips have two seconds";
}

TEST(VoxelKeypointsNet, AMapsFloorIsTheSameForAllKeypoints) {
  torch::manual_seed(6);
  const torch::NoGradGuard no_grad;
  VoxelKeypointsNet net(small_form());
  auto parameters = net->named_parameters();
  for (const char* map : {"maps", "maps_of_time"}) {
    parameters[std::string(map) + ".weight"].zero_();
    parameters[std::string(map) + ".bias"].copy_(torch::tensor({-30.0f, -20.0f, -10.0f, 0.0f, 0.0f}));
  }
  const auto found = net->forward(moving_block(1)).intensity[0];
  EXPECT_GT(found.min().item<float>(), 0.5f) << "one that says no everywhere is as faint as the others";
  EXPECT_GT(net->forward(moving_block(1)).heatmaps.min().item<float>(), 0);
}

class PaperKeypoints : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = log::set_sink([](log::Level, const std::string&) {});
  }
  void TearDown() override { log::set_sink(before_); }
  std::string write_random(uint64_t seed = 6) const {
    torch::manual_seed(seed);
    VoxelKeypointsNet net(small_form());
    const std::string file = folder_.path() + "/marionette_paper_arm.weights";
    nn::save_weights(file,
                     {"marionette-paper",
                      nn::kVoxelKeypointsVersion,
                      {{"keypoints", 5}, {"grid", 32}, {"width", 16}},
                      {{"kind", "arm"}}},
                     *net, /*half=*/false);
    return file;
  }
  nn::MarionettePaperTrainOptions options(const char* name, int64_t windows) const {
    nn::MarionettePaperTrainOptions options;
    options.data = folder_.path();  // people: a hundred creatures take a minute to make
    options.out = folder_.path() + "/" + name;
    options.width = 16;
    options.batch = 1;
    options.samples = windows;
    return options;
  }

  testing::DataFolder folder_;
  log::Sink before_;
};

/// A cloud of a box at `at`, metres.
Mesh box_at(const Vec3& at) {
  Mesh cloud;
  Rng rng(2);
  cloud.vertices = Points(500, 3);
  for (Eigen::Index i = 0; i < 500; ++i)
    for (int c = 0; c < 3; ++c) cloud.vertices(i, c) = at[c] + rng.uniform(0, c == 1 ? 2.0f : 1.0f);
  return cloud;
}

TEST_F(PaperKeypoints, AreFoundInTheWorldAndRepeatedWhereAScanIsEmpty) {
  const auto finder = nn::load_paper_keypoints(write_random());
  EXPECT_EQ(finder->name(), "paper");
  EXPECT_EQ(finder->kind(), "arm");
  EXPECT_EQ(finder->parents().size(), 5u);
  EXPECT_EQ(std::count(finder->parents().begin(), finder->parents().end(), -1), 1);
  const Mesh here = box_at({10, 0, 0}), there = box_at({10.5f, 0, 0});
  const auto found = finder->find({Mesh{}, here, Mesh{}, there});
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].places, found[1].places);
  EXPECT_EQ(found[2].places, found[1].places);
  EXPECT_NE(found[3].places, found[1].places);
  EXPECT_TRUE(found[1].turns.empty()) << "the paper's keypoints have none";
  for (Eigen::Index k = 0; k < 5; ++k) {
    EXPECT_NEAR(found[1].places(k, 0), 10.75f, 1.01f) << "in the box of both";
    EXPECT_NEAR(found[1].places(k, 1), 1, 1.01f);
  }
  // A metre away all is a metre away.
  const auto moved = finder->find({box_at({11, 0, 0}), box_at({11.5f, 0, 0})});
  const Points expected = found[1].places.rowwise() + Eigen::RowVector3f(1, 0, 0);
  EXPECT_TRUE(moved[0].places.isApprox(expected, 1e-3f));
  EXPECT_THROW(finder->find({Mesh{}}), Error);
  EXPECT_THROW(finder->find({}), Error);
}

TEST_F(PaperKeypoints, AreThoseOfTheNetworkThatWasWritten) {
  const Mesh scan = box_at({0, 0, 0});
  const auto once = nn::load_paper_keypoints(write_random(6))->find({scan});
  EXPECT_EQ(nn::load_paper_keypoints(write_random(6))->find({scan})[0].places, once[0].places);
  EXPECT_NE(nn::load_paper_keypoints(write_random(7))->find({scan})[0].places, once[0].places);
}

TEST_F(PaperKeypoints, FilesThatAreNoneAreRefused) {
  const std::string file = write_random();
  std::filesystem::resize_file(file, 3000);
  EXPECT_THROW(nn::load_paper_keypoints(file), Error);
  EXPECT_THROW(nn::load_paper_keypoints(folder_.path() + "/none.weights"), Error);
  VoxelKeypointsNet net(small_form());
  nn::save_weights(file, {"lifter", 1, {}}, *net);
  EXPECT_THROW(nn::load_paper_keypoints(file), Error);
  nn::save_weights(file, {"marionette-paper", nn::kVoxelKeypointsVersion, {{"grid", 33}}, {{"kind", "arm"}}},
                   *net);
  EXPECT_THROW(nn::load_paper_keypoints(file), Error);
}

TEST_F(PaperKeypoints, TrainingGoesOnWhereItStoppedAndItsWeightsAreLoaded) {
  ASSERT_EQ(training::train(options("parts.weights", 1)), 0);
  ASSERT_EQ(training::train(options("parts.weights", 2)), 0);
  const auto header = nn::read_weights_header(folder_.path() + "/parts.weights");
  EXPECT_EQ(header.texts.at("kind"), "person");
  EXPECT_EQ(header.numbers.at("keypoints"), 24);
  EXPECT_GT(header.numbers.at("sc"), 0);
  EXPECT_GT(header.numbers.at("cd_1e4"), 0);
  EXPECT_EQ(header.numbers.at("samples"), 2);
  const Mesh scan = box_at({0, 0, 0});
  EXPECT_EQ(nn::load_paper_keypoints(folder_.path() + "/parts.weights")->find({scan})[0].places.rows(), 24);
}

TEST_F(PaperKeypoints, ALossThatIsLeftOutPullsNothing) {
  const auto trained = [&](const char* name, bool volume, bool affinities) {
    auto how = options(name, 3);
    how.losses.volume = volume;
    how.losses.trajectory = how.losses.local = how.losses.time = affinities;
    EXPECT_EQ(training::train(how), 0);
    VoxelKeypointsForm form = small_form();
    form.keypoints = 24;
    VoxelKeypointsNet net(form);
    nn::load_weights(how.out, "marionette-paper", nn::kVoxelKeypointsVersion, *net);
    return net->named_parameters();
  };
  const auto all = trained("all.weights", true, true), again = trained("again.weights", true, true);
  const auto no_volume = trained("no_volume.weights", false, true);
  const auto no_tree = trained("no_tree.weights", true, false);
  EXPECT_TRUE(torch::equal(all["maps.weight"], again["maps.weight"])) << "one seed, one training";
  EXPECT_FALSE(torch::equal(all["maps.weight"], no_volume["maps.weight"]));
  EXPECT_FALSE(torch::equal(all["free_affinity"], no_tree["free_affinity"]));
}

}  // namespace
}  // namespace understudy
