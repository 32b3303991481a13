#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/base/rng.hpp"
#include "retarget/networks/deformation_forward.hpp"
#include "retarget/networks/part_forward.hpp"
#include "retarget/nn/modules/deformation.hpp"
#include "retarget/nn/modules/part_refiner.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/nn/skeleton_form.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy::nn {
namespace {

constexpr double kRounding = 1e-4;

std::vector<const Kernels*> all_kernels() {
  std::vector<const Kernels*> found = {&plain_kernels()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) found.push_back(avx2_kernels());
#endif
  if (&kernels() != found.back() && &kernels() != found.front()) found.push_back(&kernels());
  return found;
}

/// A module's weights in a file, every number at random: what training starts from is zero in places.
class StoredModule {
 public:
  StoredModule(torch::nn::Module& module, const WeightsHeader& header) {
    const torch::NoGradGuard no_grad;
    torch::manual_seed(3);
    for (auto& p : module.named_parameters()) p.value().add_(0.05 * torch::randn_like(p.value()));
    save_weights(path, header, module, /*half=*/false);
  }
  ~StoredModule() { std::filesystem::remove(path); }
  const std::string path =
      (std::filesystem::temp_directory_path() / "understudy_forward_test.weights").string();
};

template <class Matrix>
void expect_same(const torch::Tensor& expected, const Matrix& found, const char* what) {
  const auto flat = expected.contiguous();
  const Eigen::Map<const Eigen::Array<float, Eigen::Dynamic, 1>> a(flat.template data_ptr<float>(),
                                                                   found.size());
  ASSERT_EQ(flat.numel(), found.size()) << what;
  const Eigen::Map<const Eigen::Array<float, Eigen::Dynamic, 1>> b(found.data(), found.size());
  EXPECT_LT((a - b).abs().maxCoeff(), kRounding) << what;
}

Points blob_of(int count, uint64_t seed) {
  Rng rng(seed);
  Points points(count, 3);
  for (float& x : points.reshaped()) x = rng.normal();
  return points;
}

void expect_same_extraction(const ExtractorOutput& expected, const ExtractorForwardOutput& found) {
  expect_same(expected.joints, found.joints, "joints");
  expect_same(expected.rotations, found.rotations, "rotations");
  expect_same(expected.log_spread, found.log_spread, "log_spread");
  ASSERT_TRUE(found.visibility);
  expect_same(expected.visibility, *found.visibility, "visibility");
}

TEST(ExtractorForward, GivesWhatLibTorchGivesOnEveryProcessor) {
  const torch::NoGradGuard no_grad;
  const auto form = make_skeleton_form("dense");
  const StoredModule stored(*form, skeleton_header("dense"));
  const ScanPatches patches = cut_patches(blob_of(kScanPoints, 1));
  RecentJoints none, one, two;
  one.push(0.3f * Joints::Random());
  two = one;
  two.push(0.3f * Joints::Random());
  ASSERT_GE(all_kernels().size(), 1u);
  for (const Kernels* each : all_kernels()) {
    SCOPED_TRACE(each->name);
    ExtractorForward forward(stored.path, *each);
    for (const RecentJoints& recent : {none, one, two})
      expect_same_extraction(form->forward(extractor_input({patches}, {recent})),
                             forward.run(patches, recent));
  }
}

TEST(ExtractorForward, GivesWhatLibTorchGivesWithTheTrainedWeights) {
  const torch::NoGradGuard no_grad;
  const std::string path = US_SOURCE_DIR "/assets/weights/skeleton.weights";
  const auto form = make_skeleton_form("dense");
  load_skeleton_form(path, "dense", *form);
  ExtractorForward forward(path);
  for (uint64_t seed = 0; seed < 5; ++seed) {
    Points points = blob_of(kScanPoints, seed);
    points.col(1) *= 3;
    const ScanPatches patches = cut_patches(points);
    const auto expected = form->forward(extractor_input({patches}, {RecentJoints{}}));
    const auto found = forward.run(patches, {});
    expect_same(expected.joints, found.joints, "joints");
    expect_same(expected.rotations, found.rotations, "rotations");
    expect_same(expected.log_spread, found.log_spread, "log_spread");
  }
}

TEST(PartForward, GivesWhatLibTorchGivesForEveryKindOnEveryProcessor) {
  const torch::NoGradGuard no_grad;
  PartRefinerNet net;
  const StoredModule stored(*net, {kPartFileKind, kPartVersion, {}});
  for (int number = 0; number < kPartKinds; ++number) {
    const auto kind = static_cast<PartKind>(number);
    std::vector<PartCrop> crops(3);
    std::vector<torch::Tensor> points, contexts;
    for (size_t i = 0; i < crops.size(); ++i) {
      const Points cloud = 0.1f * blob_of(kPartPoints, 10 + i);
      crops[i].points = seen_in_patches(kind) ? cut_part_patches(cloud) : cloud;
      crops[i].context.setRandom();
      points.push_back(tensor_of(crops[i].points));
      contexts.push_back(tensor_of(crops[i].context).flatten());
    }
    const auto expected = net->of(kind).forward(torch::stack(points), torch::stack(contexts));
    for (const Kernels* each : all_kernels()) {
      SCOPED_TRACE(each->name);
      const auto found = PartForward(stored.path, *each).run(kind, crops);
      for (size_t i = 0; i < crops.size(); ++i)
        expect_same(expected[static_cast<int64_t>(i)], found[i], "part");
    }
  }
}

/// A body on either side of the middle, and some on both; of people's size, a giant's and a doll's.
TEST(DeformationForward, GivesWhatLibTorchGivesOnEveryProcessor) {
  const torch::NoGradGuard no_grad;
  DeformationNet net;
  const StoredModule stored(*net, {"deformation", kDeformationVersion, {}});
  for (const float size : {1.0f, 3.0f, 0.2f}) {
    const Joints joints = size * human_rest();
    const auto around = [&](int count, uint64_t seed) {
      Points points = 0.06f * size * blob_of(count, seed);
      for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) += joints.row(i % kJointCount);
      return points;
    };
    const Points points = around(2300, 5), surface = around(kContextPoints, 6);
    const BoundSurface expected = bind_surface(net, tensor_of(points), tensor_of(joints), tensor_of(surface));
    for (const Kernels* each : all_kernels()) {
      SCOPED_TRACE(each->name);
      const SurfaceValues found = DeformationForward(stored.path, *each).evaluate(points, joints, surface);
      expect_same(expected.weights, found.weights, "weights");
      expect_same(expected.basis, found.basis, "basis");
    }
  }
}

}  // namespace
}  // namespace understudy::nn
