#include "retarget/nn/modules/skeleton_extractor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "retarget/base/rng.hpp"
#include "retarget/networks/dense_extractor.hpp"
#include "retarget/nn/skeleton_form.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {
namespace {

ExtractorInput random_input(int64_t batch) {
  const auto centres = torch::randn({batch, 40, 3});
  return {torch::randn({batch, 256, 3}), centres, 0.1 * torch::randn({batch, 40, 12, 3}), {}, {}};
}

TEST(SkeletonExtractor, IgnoresTheOrderOfPatchesAndOfTheirPoints) {
  torch::manual_seed(1);
  const torch::NoGradGuard no_grad;
  SkeletonExtractorNet net;
  const auto in = random_input(1);
  const auto patches = torch::randperm(40), points = torch::randperm(12);
  const ExtractorInput shuffled{in.points,
                                in.centres.index_select(1, patches),
                                in.offsets.index_select(1, patches).index_select(2, points),
                                {},
                                {}};
  EXPECT_TRUE(torch::allclose(net(in).joints, net(shuffled).joints, 0, 1e-4));
}

TEST(SkeletonExtractor, TreatsEachScanOfABatchAlone) {
  torch::manual_seed(2);
  const torch::NoGradGuard no_grad;
  SkeletonExtractorNet net;
  const auto in = random_input(3);
  const ExtractorInput second{
      in.points.narrow(0, 1, 1), in.centres.narrow(0, 1, 1), in.offsets.narrow(0, 1, 1), {}, {}};
  EXPECT_TRUE(torch::allclose(net(in).joints[1], net(second).joints[0], 0, 1e-4));
}

ExtractorInput with_past(ExtractorInput input, const torch::Tensor& known) {
  input.recent = 0.5 * torch::randn({known.size(0), kJointCount, 6});
  input.recent_known = known;
  return input;
}

TEST(SkeletonExtractor, ThePastSaysNothingBeforeItIsTrained) {
  torch::manual_seed(4);
  const torch::NoGradGuard no_grad;
  SkeletonExtractorNet net;
  const auto in = random_input(2);
  EXPECT_TRUE(torch::equal(net(in).joints, net(with_past(in, torch::ones({2, 2}))).joints));
}

TEST(SkeletonExtractor, OnlyAPastThatIsKnownCounts) {
  torch::manual_seed(5);
  const torch::NoGradGuard no_grad;
  SkeletonExtractorNet net;
  for (auto& p : net->named_parameters())
    if (p.key().rfind("recent_mlp", 0) == 0) p.value().normal_();
  const auto in = random_input(2);
  const auto alone = net(in).joints,
             with = net(with_past(in, torch::tensor({{1.f, 1.f}, {0.f, 0.f}}))).joints;
  EXPECT_FALSE(torch::allclose(alone[0], with[0], 0, 1e-3));
  EXPECT_TRUE(torch::allclose(alone[1], with[1], 0, 1e-5));
}

TEST(SkeletonExtractor, BeforeItIsTrainedMostIsSeenWhateverTheScan) {
  torch::manual_seed(7);
  const torch::NoGradGuard no_grad;
  SkeletonExtractorNet net;
  const auto visibility = net(random_input(2)).visibility;
  EXPECT_EQ(visibility.sizes(), (std::vector<int64_t>{2, kJointCount}));
  EXPECT_TRUE(torch::allclose(visibility, torch::full({2, kJointCount}, 2.f)));
}

Mesh random_scan() {
  Rng rng(8);
  Mesh scan;
  scan.vertices.resize(2000, 3);
  for (float& x : scan.vertices.reshaped()) x = rng.normal();
  return scan;
}

TEST(NetworkExtractor, GivesWhatIsSeenWhereItsWeightsKnow) {
  torch::manual_seed(9);
  const std::string path = (std::filesystem::temp_directory_path() / "understudy_seen_test.weights").string();
  const auto form = make_skeleton_form("dense");
  save_weights(path, skeleton_header("dense"), *form);
  const Extraction seen = load_dense_extractor(path)->extract(random_scan());
  EXPECT_LT((seen.visibility - 1 / (1 + std::exp(-2.0f))).abs().maxCoeff(), 1e-3f);
  std::filesystem::remove(path);
}

TEST(NetworkExtractor, WithWeightsFromBeforeAllJointsAreSeen) {
  const auto extractor = load_dense_extractor(US_SOURCE_DIR "/assets/weights/skeleton_rest.weights");
  EXPECT_EQ(extractor->extract(random_scan()).visibility.minCoeff(), 1);
}

/// What was seen moves and grows with the scan.
TEST(ExtractorInput, APastIsNormalisedAsItsScan) {
  Rng rng(6);
  Points points(kScanPoints, 3);
  for (float& x : points.reshaped()) x = rng.normal();
  Joints first = Joints::Random(), second = Joints::Random();
  const auto input_of = [&](float size, const Eigen::RowVector3f& way) {
    const auto placed = [&](const auto& x) { return (size * x).rowwise() + way; };
    RecentJoints recent;
    recent.push(placed(first));
    recent.push(placed(second));
    return extractor_input({cut_patches(placed(points))}, {recent});
  };
  const auto here = input_of(1, {0, 0, 0}), there = input_of(2, {3, 1, -2});
  EXPECT_TRUE(torch::allclose(here.recent, there.recent, 0, 1e-4));
  EXPECT_TRUE(torch::equal(here.recent_known, torch::ones({1, 2})));
  EXPECT_GT(here.recent.narrow(2, 3, 3).abs().max().item<float>(), 0.1f);
}

TEST(ExtractorInput, WithoutAPastNothingIsKnown) {
  const ScanPatches patches = cut_patches(Points::Random(kScanPoints, 3));
  EXPECT_FALSE(extractor_input({patches}).recent.defined());
  RecentJoints recent;
  recent.push(Joints::Constant(std::nanf("")));
  EXPECT_TRUE(torch::equal(extractor_input({patches}, {recent}).recent_known, torch::zeros({1, 2})));
  recent.push(Joints::Ones());
  EXPECT_TRUE(torch::equal(extractor_input({patches}, {recent}).recent_known, torch::tensor({{1.f, 0.f}})));
}

TEST(SkeletonForm, TheAblationsIgnoreTheOrderOfPoints) {
  for (const char* name : {"paper"}) {
    torch::manual_seed(3);
    const torch::NoGradGuard no_grad;
    const auto form = make_skeleton_form(name);
    auto in = random_input(1);
    const auto joints = form->forward(in).joints;
    EXPECT_EQ(joints.sizes(), (std::vector<int64_t>{1, kJointCount, 3}));
    in.points = in.points.index_select(1, torch::randperm(256));
    EXPECT_TRUE(torch::allclose(joints, form->forward(in).joints, 0, 1e-4)) << name;
  }
}

TEST(SkeletonForm, RefusesAnUnknownName) {
  EXPECT_ANY_THROW(make_skeleton_form("sparse"));
}

}  // namespace
}  // namespace understudy::nn
