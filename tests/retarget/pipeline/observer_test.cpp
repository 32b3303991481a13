#include "retarget/pipeline/observer.hpp"

#include <gtest/gtest.h>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;
constexpr float kInterval = 1 / 30.0f;

/// Keeps what it was told of the frames before.
class RememberingExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh& scan) override { return telltale.extract(scan); }
  Extraction extract_after(const RecentJoints& recent, const Mesh& scan) override {
    told.push_back(recent);
    return extract(scan);
  }
  std::string name() const override { return "remembering"; }
  std::vector<RecentJoints> told;
  TellTaleExtractor telltale;
};

struct Watch {
  std::shared_ptr<RememberingExtractor> extractor = std::make_shared<RememberingExtractor>();
  Observer observer{extractor};
  PointBody body{human_rest()};

  Mesh scan(int i) const { return scan_of(body, human_rest(), dance(static_cast<float>(i) / 30)); }
  Observation see(int i, float confidence = 1) {
    extractor->telltale.confidence = confidence;
    return observer.observe(scan(i), kInterval);
  }
};

TEST(Observer, TellsTheExtractorWhatItSawJustBefore) {
  Watch watch;
  std::vector<Joints> seen;
  for (int i = 0; i < 3; ++i) seen.push_back(watch.see(i).joints);
  const auto& told = watch.extractor->told;
  ASSERT_EQ(told.size(), 3u);
  EXPECT_FALSE(told[0].last);
  EXPECT_FALSE(told[1].before_last);
  EXPECT_EQ(*told[2].last, seen[1]);
  EXPECT_EQ(*told[2].before_last, seen[0]);
  watch.observer.restart();
  watch.see(3);
  EXPECT_FALSE(told[3].last);
}

TEST(Observer, SaysInThreeDigitsHowUnsureItIs) {
  EXPECT_EQ(refusal(Watch().see(0, 0.0677433f)), "the confidence in the skeleton is only 0.068");
}

TEST(Observer, TellsNothingOfAFrameThatIsNotBelieved) {
  Watch watch;
  const Joints good = watch.see(0).joints;
  EXPECT_NE(refusal(watch.see(1, 0.02f)), "");
  watch.see(2);
  EXPECT_EQ(*watch.extractor->told[2].last, good);
}

TEST(Observer, ForgetsThePastOverAPause) {
  Watch watch;
  for (int i = 0; i < 2; ++i) watch.see(i);
  for (int i = 0; i < 3; ++i) watch.observer.skip("nothing there", kInterval);
  watch.see(5);
  EXPECT_TRUE(watch.extractor->told[2].last);  // a short one
  for (int i = 0; i < 10; ++i) watch.see(6 + i, 0.02f);
  watch.see(16);
  EXPECT_FALSE(watch.extractor->told.back().last);
  watch.see(17);
  EXPECT_TRUE(watch.extractor->told.back().last);
  watch.observer.observe(watch.scan(18), /*dt=*/2);  // a gap in the source's own time
  EXPECT_FALSE(watch.extractor->told.back().last);
}

TEST(Observer, SaysWhyThereIsNoSkeletonAndHasNoConfidenceThen) {
  Watch watch;
  const Observation few = watch.observer.observe(Mesh{Points::Zero(20, 3)}, kInterval);
  EXPECT_EQ(few.problem, "the scan has 20 usable points");
  EXPECT_EQ(few.points, 20);
  EXPECT_EQ(few.confidence.maxCoeff(), 0);
  const Observation skipped = watch.observer.skip("it cannot be read", kInterval);
  EXPECT_EQ(skipped.problem, "it cannot be read");
  EXPECT_EQ(skipped.confidence.maxCoeff(), 0);
}

TEST(Observer, LooksOnceAtTheFirstScan) {
  Watch watch;
  EXPECT_EQ(watch.observer.look(watch.scan(0)).joints, watch.see(0).joints);
  EXPECT_TRUE(watch.extractor->told.empty());
  watch.see(0);
  EXPECT_EQ(watch.extractor->told.size(), 1u);  // that is another frame
  watch.observer.restart();
  watch.observer.look(watch.scan(1));
  EXPECT_EQ(watch.see(2).joints, forward_kinematics(human_rest(), dance(2 / 30.0f)).joints);
  EXPECT_EQ(watch.extractor->told.size(), 2u);  // another scan than the one looked at
  watch.observer.restart();
  Mesh part = watch.scan(3);
  watch.observer.look(part);
  part.vertices = Points(part.vertices.topRows(part.vertices.rows() / 2));
  watch.observer.observe(part, kInterval);
  EXPECT_EQ(watch.extractor->told.size(), 3u);  // a part of it is another one, too
}

TEST(Observer, MeasuresSolesAndGirthOnTheScan) {
  Watch watch;
  const Observation seen = watch.see(0);
  const Mesh scan = watch.scan(0);
  EXPECT_EQ(seen.sole_height, sole_height(seen, scan.vertices));
  ASSERT_TRUE(seen.girth);
  EXPECT_EQ(seen.girth->radius, measure_girth(seen, scan.vertices).radius);
  const Observation told = watch.observer.observe(fixtures::seen(seen.joints), scan, kInterval);
  EXPECT_EQ(told.sole_height, seen.sole_height);
  EXPECT_EQ(told.girth->radius, seen.girth->radius);
  EXPECT_FALSE(watch.observer.observe(fixtures::seen(seen.joints), kInterval).girth);
}

TEST(Observer, WantsAnExtractorForScans) {
  EXPECT_THROW(Observer().observe(Mesh{Points::Zero(100, 3)}, kInterval), Error);
}

}  // namespace
}  // namespace understudy
