#include "retarget/pipeline/motion_style.hpp"

#include <gtest/gtest.h>

#include "tests/retarget/pipeline/fixtures.hpp"

namespace understudy {
namespace {

using namespace fixtures;
constexpr float kStyleStep = 1 / 30.0f;

/// Gives each frame, raised by a metre, so many frames later; refuses one that is too small.
class LateStyle final : public MotionStyle {
 public:
  explicit LateStyle(size_t frames) : frames_(frames) {}
  void reset() override { waiting_.clear(), finished_ = false; }
  void push(const Extraction& seen, float dt) override {
    if (leg_length(seen.joints) < 0.1f) throw Error("too small");
    waited_s += dt;
    Extraction styled = seen;
    styled.exact = true;
    styled.joints.col(1).array() += 1;
    waiting_.push_back(styled);
  }
  std::optional<Extraction> pop() override {
    if (waiting_.empty() || (!finished_ && waiting_.size() <= frames_)) return std::nullopt;
    Extraction next = waiting_.front();
    waiting_.pop_front();
    return next;
  }
  void finish() override { finished_ = true; }
  float lag_s() const override { return static_cast<float>(frames_) * kStyleStep; }

  float waited_s = 0;

 private:
  size_t frames_;
  bool finished_ = false;
  std::deque<Extraction> waiting_;
};

Observation styled_seen(int i) {
  Observation observation;
  observation.joints = forward_kinematics(human_rest(), dance(static_cast<float>(i) * kStyleStep)).joints;
  observation.points = i;
  return observation;
}

std::vector<TimedObservation> all_of(StyledStream& stream) {
  std::vector<TimedObservation> all;
  while (auto next = stream.pop()) all.push_back(std::move(*next));
  return all;
}

TEST(StyledStream, WithoutAStyleFramesPassAtOnceAsTheyCame) {
  StyledStream stream;
  for (int i = 0; i < 5; ++i) {
    stream.push(styled_seen(i), kStyleStep);
    const auto out = stream.pop();
    ASSERT_TRUE(out);
    EXPECT_EQ(out->seen.joints, styled_seen(i).joints);
    EXPECT_EQ(out->dt, kStyleStep);
    EXPECT_FALSE(out->seen.unstyled);
    EXPECT_FALSE(stream.pop());
  }
}

TEST(StyledStream, FramesComeLateInTheirOrderAndAllInTheEnd) {
  StyledStream stream(std::make_shared<LateStyle>(4));
  EXPECT_FLOAT_EQ(stream.lag_s(), 4 * kStyleStep);
  std::vector<TimedObservation> out;
  for (int i = 0; i < 10; ++i) {
    stream.push(styled_seen(i), kStyleStep);
    const auto now = all_of(stream);
    EXPECT_EQ(now.size(), i < 4 ? 0u : 1u) << i;
    out.insert(out.end(), now.begin(), now.end());
  }
  stream.finish();
  for (const TimedObservation& one : all_of(stream)) out.push_back(one);
  ASSERT_EQ(out.size(), 10u);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(out[static_cast<size_t>(i)].seen.points, i);
    ASSERT_TRUE(out[static_cast<size_t>(i)].seen.unstyled);
    const Observation& one = out[static_cast<size_t>(i)].seen;
    EXPECT_NEAR(one.joints(Pelvis, 1) - one.unstyled->joints(Pelvis, 1), 1, 1e-5f);
  }
}

TEST(StyledStream, WhatIsNotBelievedPassesInItsPlaceAndTakesItsTime) {
  const auto style = std::make_shared<LateStyle>(3);
  StyledStream stream(style);
  for (int i = 0; i < 9; ++i)
    stream.push(i == 4 || i == 5 ? without_skeleton("nobody there") : styled_seen(i), kStyleStep);
  stream.finish();
  const auto out = all_of(stream);
  ASSERT_EQ(out.size(), 9u);
  for (size_t i = 0; i < out.size(); ++i) EXPECT_EQ(out[i].seen.problem.empty(), i != 4 && i != 5) << i;
  EXPECT_NEAR(style->waited_s, 9 * kStyleStep, 1e-5f);  // the two frames' time is the next one's
}

TEST(StyledStream, AFrameThatTheStyleRefusesSaysWhy) {
  StyledStream stream(std::make_shared<LateStyle>(0));
  Observation small = styled_seen(0);
  small.joints *= 0.01f;
  stream.push(small, kStyleStep);
  stream.push(styled_seen(1), kStyleStep);
  const auto out = all_of(stream);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].seen.problem, "too small");
  EXPECT_TRUE(out[1].seen.problem.empty());
}

TEST(StyledStream, WhereNobodyComesForLongerThanTheLagWhatWasHeldBackComes) {
  StyledStream stream(std::make_shared<LateStyle>(3));
  for (int i = 0; i < 6; ++i) stream.push(styled_seen(i), kStyleStep);
  EXPECT_EQ(all_of(stream).size(), 3u);
  for (int i = 0; i < 5; ++i) stream.push(without_skeleton("nobody there"), kStyleStep);
  EXPECT_EQ(all_of(stream).size(), 8u);
  for (int i = 0; i < 6; ++i) stream.push(styled_seen(i), kStyleStep);
  EXPECT_EQ(all_of(stream).size(), 3u) << "and it goes on as before";
  stream.finish();
  EXPECT_EQ(all_of(stream).size(), 3u);
}

TEST(StyledStream, StartsAnew) {
  StyledStream stream(std::make_shared<LateStyle>(5));
  for (int i = 0; i < 3; ++i) stream.push(styled_seen(i), kStyleStep);
  stream.restart();
  stream.finish();
  EXPECT_FALSE(stream.pop());
}

}  // namespace
}  // namespace understudy
