#include "retarget/nn/modules/skeleton_extractor.hpp"

#include <gtest/gtest.h>

#include "retarget/nn/skeleton_form.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::nn {
namespace {

ExtractorInput random_input(int64_t batch) {
  const auto centres = torch::randn({batch, 40, 3});
  return {torch::randn({batch, 256, 3}), centres, 0.1 * torch::randn({batch, 40, 12, 3})};
}

TEST(SkeletonExtractor, IgnoresTheOrderOfPatchesAndOfTheirPoints) {
  torch::manual_seed(1);
  const torch::NoGradGuard no_grad;
  SkeletonExtractorNet net;
  const auto in = random_input(1);
  const auto patches = torch::randperm(40), points = torch::randperm(12);
  const ExtractorInput shuffled{in.points, in.centres.index_select(1, patches),
                                in.offsets.index_select(1, patches).index_select(2, points)};
  EXPECT_TRUE(torch::allclose(net(in).joints, net(shuffled).joints, 0, 1e-4));
}

TEST(SkeletonExtractor, TreatsEachScanOfABatchAlone) {
  torch::manual_seed(2);
  const torch::NoGradGuard no_grad;
  SkeletonExtractorNet net;
  const auto in = random_input(3);
  const ExtractorInput second{in.points.narrow(0, 1, 1), in.centres.narrow(0, 1, 1),
                              in.offsets.narrow(0, 1, 1)};
  EXPECT_TRUE(torch::allclose(net(in).joints[1], net(second).joints[0], 0, 1e-4));
}

TEST(SkeletonForm, TheAblationsIgnoreTheOrderOfPoints) {
  for (const char* name : {"paper", "pointnet"}) {
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
