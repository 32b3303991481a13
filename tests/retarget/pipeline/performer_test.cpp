#include "retarget/pipeline/performer.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;
constexpr float kStep = 1 / 30.0f;

/// Skins rigidly, or refuses to.
class MoodyDeformer final : public Deformer {
 public:
  explicit MoodyDeformer(RowMatrix weights) : inner_(std::move(weights)) {}
  void bind(const Points& rest, const Joints& joints) override { inner_.bind(rest, joints); }
  const RowMatrix& weights() const override { return inner_.weights(); }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override {
    return inner_.with_weights(std::move(weights));
  }
  Points offsets(const Pose& pose) const override { return inner_.offsets(pose); }
  Points deform(const Pose& pose) const override {
    Points points = inner_.deform(pose);
    if (nan_next_) points(0, 0) = std::numeric_limits<float>::quiet_NaN();
    nan_next_ = false;
    return points;
  }
  std::string name() const override { return "moody"; }
  void fail_once() { nan_next_ = true; }

 private:
  RigidDeformer inner_;
  mutable bool nan_next_ = false;
};

struct PerformerStage {
  Joints rest = other_body();
  PointBody target{rest};
  std::shared_ptr<MoodyDeformer> deformer = std::make_shared<MoodyDeformer>(target.weights);
  Performer performer{prepare_target(target.mesh, rest), std::make_shared<CopyTransfer>(), deformer};

  static Observation seen(int i) {
    Observation observation;
    observation.joints = forward_kinematics(human_rest(), dance(static_cast<float>(i) / 30)).joints;
    return observation;
  }
  PerformedFrame push(int i) { return performer.perform(seen(i), kStep); }
};

bool same_bytes(const Points& a, const Points& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), static_cast<size_t>(a.size()) * sizeof(float)) == 0;
}

TEST(Performer, ARefusedFrameLeavesNoTrace) {
  PerformerStage refusing, skipping;
  for (int i = 0; i < 30; ++i) {
    const bool bad = i % 7 == 3;
    if (bad) refusing.deformer->fail_once();
    const PerformedFrame a = refusing.push(i);
    const PerformedFrame b =
        bad ? skipping.performer.perform(without_skeleton("left out"), kStep) : skipping.push(i);
    EXPECT_EQ(a.flagged, bad);
    EXPECT_TRUE(same_bytes(a.vertices, b.vertices)) << i;
    EXPECT_EQ(a.source.joints, b.source.joints) << i;
  }
}

TEST(Performer, KeepsTheSkeletonThatItsScanShowsBesideAStyledOne) {
  PerformerStage stage;
  Observation styled = PerformerStage::seen(0);
  styled.exact = true;
  styled.unstyled = Observation::Unstyled{PerformerStage::seen(5).joints, {}, {true, true}};
  styled.unstyled->limbs[3] = LimbSight::Unseen;
  const PerformedFrame frame = stage.performer.perform(styled, kStep);
  EXPECT_FALSE(frame.flagged);
  EXPECT_EQ(frame.source.joints, styled.joints);
  EXPECT_EQ(source_joints(frame), PerformerStage::seen(5).joints);
  EXPECT_EQ(kept(frame).source, PerformerStage::seen(5).joints);
  EXPECT_EQ(frame.limbs[3], LimbSight::Unseen);
  const PerformedFrame bad = stage.performer.perform(without_skeleton("nobody there"), kStep);
  EXPECT_EQ(source_joints(bad), PerformerStage::seen(5).joints);
}

TEST(Performer, AFrameThatFailsHasNoConfidenceAndTheLastSkeleton) {
  PerformerStage stage;
  const PerformedFrame good = stage.push(0);
  EXPECT_EQ(good.confidence.minCoeff(), 1);
  Observation weak = PerformerStage::seen(1);
  weak.confidence.setConstant(0.02f);
  stage.deformer->fail_once();
  for (const PerformedFrame& bad : {stage.push(1), stage.performer.perform(weak, kStep),
                                    stage.performer.perform(without_skeleton("nobody there"), kStep)}) {
    EXPECT_TRUE(bad.flagged);
    EXPECT_NE(bad.reason, "");
    EXPECT_EQ(bad.confidence.maxCoeff(), 0);
    EXPECT_EQ(bad.source.joints, good.source.joints);
  }
}

TEST(Performer, TellsWhichFeetItHolds) {
  PerformerStage stage;
  RetargetOptions free_feet;
  free_feet.lock_feet = false;
  PerformerStage unlocked;
  unlocked.performer = Performer(prepare_target(unlocked.target.mesh, unlocked.rest),
                                 std::make_shared<CopyTransfer>(), unlocked.deformer, free_feet);
  const auto any = [](const Standing& feet) { return feet[0] || feet[1]; };
  bool held = false;
  Standing last{};
  for (int i = 0; i < 12; ++i) {  // someone who stands still
    last = kept(stage.push(0)).standing;
    held = held || any(last);
    EXPECT_FALSE(any(unlocked.push(0).standing));
  }
  EXPECT_TRUE(held);
  EXPECT_EQ(stage.performer.perform(without_skeleton("nobody there"), kStep).standing, last);
}

TEST(Performer, WithoutATargetItRepairsAndSmoothsAlone) {
  PerformerStage stage;
  Performer alone;
  for (int i = 0; i < 20; ++i) {
    const PerformedFrame frame = alone.perform(PerformerStage::seen(i), kStep);
    EXPECT_EQ(frame.source.joints, stage.push(i).source.joints) << i;
    EXPECT_EQ(frame.vertices.rows(), 0);
  }
}

}  // namespace
}  // namespace understudy
