#include "retarget/pipeline/retargeter.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "retarget/base/log.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;

struct RetargeterStage {
  Joints rest = other_body();
  PointBody source{human_rest()}, target{rest};
  TellTaleExtractor* extractor = nullptr;

  Retargeter make(const RetargetOptions& options = {}) {
    Networks networks;
    auto telltale = std::make_unique<TellTaleExtractor>();
    extractor = telltale.get();
    networks.extractor = std::move(telltale);
    networks.transfer = std::make_unique<CopyTransfer>();
    networks.deformer = std::make_unique<RigidDeformer>(target.weights);
    Retargeter retargeter(std::move(networks), options);
    retargeter.set_target(prepare_target(target.mesh, rest));
    return retargeter;
  }
  Mesh scan(int i) const { return scan_of(source, human_rest(), dance(static_cast<float>(i) / 30)); }
  std::vector<PerformedFrame> run(int frames) {
    Retargeter retargeter = make();
    std::vector<PerformedFrame> result;
    for (int i = 0; i < frames; ++i) result.push_back(retargeter.push(scan(i), 1 / 30.0f));
    return result;
  }
};

bool same_bytes(const PerformedFrame& a, const PerformedFrame& b) {
  const auto size = static_cast<size_t>(a.vertices.size()) * sizeof(float);
  return a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), size) == 0 && a.joints == b.joints &&
         a.pose.root == b.pose.root;
}

TEST(Retargeter, MovesTheTargetAsTheSource) {
  const auto frames = RetargeterStage().run(40);
  for (const auto& frame : frames) {
    EXPECT_FALSE(frame.flagged) << frame.reason;
    EXPECT_TRUE(frame.vertices.allFinite());
  }
  // The same local rotations on the target, at the same place in the air.
  const Pose truth = dance(39 / 30.0f);
  const Joints wanted = forward_kinematics(other_body(), Pose{truth.local, frames.back().pose.root}).joints;
  EXPECT_LT((frames.back().joints - wanted).rowwise().norm().mean(), 0.03f);
}

TEST(Retargeter, GivesTheSameBytesTwice) {
  const auto a = RetargeterStage().run(20), b = RetargeterStage().run(20);
  for (size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same_bytes(a[i], b[i])) << i;
}

TEST(Retargeter, DoesNotLookIntoTheFuture) {
  const auto whole = RetargeterStage().run(30), cut = RetargeterStage().run(12);
  for (size_t i = 0; i < cut.size(); ++i) EXPECT_TRUE(same_bytes(whole[i], cut[i])) << i;
}

TEST(Retargeter, StartsAnewAfterRestart) {
  RetargeterStage stage;
  Retargeter retargeter = stage.make();
  const auto first = retargeter.push(stage.scan(0), 1 / 30.0f);
  for (int i = 1; i < 10; ++i) retargeter.push(stage.scan(i), 1 / 30.0f);
  retargeter.restart();
  EXPECT_TRUE(same_bytes(retargeter.push(stage.scan(0), 1 / 30.0f), first));
}

TEST(Retargeter, RepeatsThePoseAndFlagsAFrameWithoutPoints) {
  RetargeterStage stage;
  Retargeter retargeter = stage.make();
  const auto good = retargeter.push(stage.scan(0), 1 / 30.0f);
  const auto empty = retargeter.push(Mesh{Points(0, 3)}, 1 / 30.0f);
  EXPECT_TRUE(empty.flagged);
  EXPECT_FALSE(empty.reason.empty());
  EXPECT_TRUE(same_bytes(empty, good));
}

TEST(Retargeter, FlagsNumbersThatAreNotFinite) {
  RetargeterStage stage;
  Retargeter retargeter = stage.make();
  const auto good = retargeter.push(stage.scan(0), 1 / 30.0f);
  Mesh bad = stage.scan(1);
  bad.vertices(bad.vertices.rows() - 5, 1) =
      std::numeric_limits<float>::infinity();  // a joint that the extractor tells
  const auto flagged = retargeter.push(bad, 1 / 30.0f);
  EXPECT_TRUE(flagged.flagged);
  EXPECT_TRUE(same_bytes(flagged, good));
}

TEST(Retargeter, FlagsAFrameOfLowConfidence) {
  RetargeterStage stage;
  Retargeter retargeter = stage.make();
  retargeter.push(stage.scan(0), 1 / 30.0f);
  stage.extractor->confidence = 0.01f;
  EXPECT_TRUE(retargeter.push(stage.scan(1), 1 / 30.0f).flagged);
  stage.extractor->confidence = 1;
  EXPECT_FALSE(retargeter.push(stage.scan(2), 1 / 30.0f).flagged);
}

TEST(Retargeter, StandsInTPoseBeforeTheFirstGoodFrame) {
  RetargeterStage stage;
  Retargeter retargeter = stage.make();
  const auto frame = retargeter.push(Mesh{Points(0, 3)}, 1 / 30.0f);
  EXPECT_TRUE(frame.flagged);
  EXPECT_LT((frame.joints - stage.rest).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(Retargeter, GoesOnAfterABadFrame) {
  RetargeterStage stage;
  Retargeter retargeter = stage.make();
  for (int i = 0; i < 20; ++i) retargeter.push(i == 10 ? Mesh{Points(0, 3)} : stage.scan(i), 1 / 30.0f);
  const auto frame = retargeter.push(stage.scan(20), 1 / 30.0f);
  const auto whole = stage.run(21);
  EXPECT_FALSE(frame.flagged);
  EXPECT_LT((frame.joints - whole.back().joints).rowwise().norm().mean(), 0.03f);
}

TEST(Retargeter, KeepsLittleOfAFrame) {
  RetargeterStage stage;
  const auto frame = stage.make().push(stage.scan(3), 1 / 30.0f);
  EXPECT_EQ(kept(frame).pose.root, frame.pose.root);
  EXPECT_EQ(kept(frame).source, frame.source.joints);
  EXPECT_LE(sizeof(KeptFrame), 2048u);
}

TEST(Retargeter, RefusesToStartWithoutATarget) {
  Networks networks;
  networks.transfer = std::make_unique<CopyTransfer>();
  networks.deformer = std::make_unique<RigidDeformer>(RowMatrix());
  Retargeter retargeter(std::move(networks));
  EXPECT_THROW(retargeter.push(Mesh{Points(0, 3)}, 0.1f), Error);
}

/// Sees the T-pose's joints where the points' bounding box is, a little off, more on the left.
class LopsidedExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh& scan) override {
    const Eigen::RowVector3f middle =
        0.5f * (scan.vertices.colwise().maxCoeff() + scan.vertices.colwise().minCoeff());
    Extraction e;
    e.joints = human_rest().rowwise() + middle;
    for (int j = 0; j < kJointCount; ++j)
      if (kMirror[j] > j) e.joints(j, 1) += 0.02f;
    return e;
  }
  std::string name() const override { return "lopsided"; }
};

TEST(PrepareTarget, MakesASymmetricTargetsJointsSymmetric) {
  Mesh mesh;
  mesh.vertices.resize(4000, 3);
  Rng rng(1);
  for (Eigen::Index i = 0; i < 4000; i += 2) {
    mesh.vertices.row(i) << rng.uniform(-0.8f, 0.8f), rng.uniform(-1.1f, 0.9f), rng.uniform(-0.1f, 0.1f);
    mesh.vertices.row(i + 1) = mesh.vertices.row(i);
    mesh.vertices(i + 1, 0) *= -1;
  }
  LopsidedExtractor extractor;
  const Target target = prepare_target(mesh, extractor);
  for (int j = 0; j < kJointCount; ++j) EXPECT_NEAR(target.joints(j, 1), target.joints(kMirror[j], 1), 1e-4f);
}

TEST(PrepareTarget, HasNothingToSayOfAPersonInTPose) {
  EXPECT_TRUE(prepare_target(PointBody(human_rest()).mesh, human_rest()).warnings.empty());
}

TEST(PrepareTarget, WarnsOfATargetThatIsNoPersonInTPose) {
  const Joints posed = forward_kinematics(human_rest(), dance(1)).joints;
  EXPECT_FALSE(prepare_target(PointBody(human_rest()).mesh, posed).warnings.empty());
}

TEST(Retargeter, FindsTheTargetsJointsWithTheExtractorForTPoses) {
  class NeverAsked final : public SkeletonExtractor {
   public:
    Extraction extract(const Mesh&) override {
      throw Error("the extractor of scans was asked about a target");
    }
    std::string name() const override { return "never"; }
  };
  Networks networks;
  networks.extractor = std::make_unique<NeverAsked>();
  networks.rest_extractor = std::make_unique<LopsidedExtractor>();
  networks.transfer = std::make_unique<CopyTransfer>();
  const PointBody body(human_rest());
  networks.deformer = std::make_unique<RigidDeformer>(body.weights);
  Retargeter retargeter(std::move(networks), {});
  EXPECT_NO_THROW(retargeter.set_target(body.mesh));
}

}  // namespace
}  // namespace understudy
