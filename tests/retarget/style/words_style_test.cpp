#include "retarget/style/words_style.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {
namespace {

/// Turns the left shoulder by an angle, and leaves the rest.
class Raising final : public WordTranslator {
 public:
  explicit Raising(float angle, bool knows_heads = true) : angle_(angle), knows_heads_(knows_heads) {}
  WordRows translate(const WordRows& word) override {
    ++words;
    WordRows made = word;
    for (Eigen::Index t = 0; t < word.rows(); ++t) {
      Rotations local = rotations_of_row(word.row(t), 0);
      local[LeftShoulder] = local[LeftShoulder] * rotation_from_axis_angle(Vec3(0, 0, angle_));
      local[Head] = local[Head] * rotation_from_axis_angle(Vec3(0, angle_, 0));
      made.row(t) = word_row(local);
    }
    if (broken) made(3, 3) = std::numeric_limits<float>::quiet_NaN();
    return made;
  }
  std::array<bool, kJointCount> joints() const override {
    std::array<bool, kJointCount> known{};
    known.fill(true);
    known[Head] = knows_heads_;
    return known;
  }
  int words = 0;
  bool broken = false;

 private:
  float angle_;
  bool knows_heads_;
};

std::vector<Pose> walk(float fps, size_t count) {
  const Motion clip = builtin_motion("walk", human_rest(), fps);
  std::vector<Pose> poses;
  for (size_t t = 0; t < count; ++t) poses.push_back(clip.poses[t % clip.poses.size()]);
  return poses;
}

/// All frames, and after how many more each came.
std::vector<Rotations> through(PoseStyle& style, const std::vector<Pose>& poses, float fps,
                               size_t* latest = nullptr) {
  style.reset();
  std::vector<Rotations> out;
  for (size_t t = 0; t < poses.size(); ++t) {
    style.push({human_rest(), poses[t], 1 / fps});
    while (auto next = style.pop()) out.push_back(*next);
    if (latest != nullptr) *latest = std::max(*latest, t + 1 - out.size());
  }
  style.finish();
  while (auto next = style.pop()) out.push_back(*next);
  return out;
}

float worst_deg(const std::vector<Rotations>& a, const std::vector<Pose>& b, int joint, size_t from = 0) {
  float worst = 0;
  for (size_t t = from; t + from < a.size(); ++t)
    worst = std::max(worst, geodesic_angle(a[t][joint], b[t].local[joint]) * 180 / kPi);
  return worst;
}

TEST(MotionWords, ARowKeepsTheRotationsAndTheHeadingIsGivenBack) {
  for (const Pose& pose : walk(30, 40)) {
    const Rotations again = rotations_of_row(word_row(pose.local), heading_of(pose.local[Pelvis]));
    for (int j = 0; j < kJointCount; ++j) EXPECT_LT(geodesic_angle(again[j], pose.local[j]), 1e-3f);
  }
}

TEST(MotionWords, AMotionOfAnotherRateTakesAsLong) {
  for (const float fps : {15.0f, 30.0f, 60.0f, 100.0f}) {
    std::vector<Rotations> local(static_cast<size_t>(2 * fps) + 1, identity_rotations());
    for (size_t t = 0; t < local.size(); ++t)
      local[t][Head] = rotation_from_axis_angle(Vec3(static_cast<float>(t) / fps, 0, 0));
    const std::vector<Rotations> made = at_word_rate(local, static_cast<double>(fps), 1.5);
    ASSERT_EQ(made.size(), 61u) << fps;
    for (size_t t = 0; t < made.size(); ++t)
      EXPECT_NEAR(rotation_to_axis_angle(made[t][Head]).x(), static_cast<float>(t) / kWordRate, 0.05f) << fps;
  }
  EXPECT_THROW(at_word_rate({}, 30, 1.5), Error);
  EXPECT_THROW(at_word_rate({identity_rotations()}, 0, 1.5), Error);
}

TEST(MotionWords, WordsCoverAllFramesAThirdOfASecondApart) {
  for (const Eigen::Index frames : {1, 20, 30, 31, 95}) {
    const WordRows rows = WordRows::Random(frames, kWordNumbers);
    const auto words = cut_words(rows);
    for (size_t w = 0; w < words.size(); ++w)
      for (Eigen::Index t = 0; t < kWordFrames; ++t)
        EXPECT_EQ(words[w].row(t),
                  rows.row(std::min<Eigen::Index>(10 * static_cast<Eigen::Index>(w) + t, frames - 1)));
    EXPECT_GE(kWordStride * (ssize(words) - 1) + kWordFrames, frames);
  }
  EXPECT_EQ(cut_words(WordRows::Zero(50, kWordNumbers)).size(), 3u);
}

TEST(MotionWords, APeakGoesAndAMovementStays) {
  WordRows rows(60, 1);
  for (int t = 0; t < 60; ++t) rows(t, 0) = std::sin(0.1f * static_cast<float>(t));
  WordRows peaked = rows;
  peaked(30, 0) += 0.8f;
  remove_peaks(peaked);
  EXPECT_TRUE(peaked.isApprox(rows, 0.05f));
}

TEST(MotionWords, TheLowPassTakesTremblingAndNoTime) {
  WordRows slow(120, 1), trembling(120, 1);
  for (int t = 0; t < 120; ++t) {
    slow(t, 0) = std::sin(2 * kPi * static_cast<float>(t) / 30);
    trembling(t, 0) = slow(t, 0) + 0.2f * (t % 2 == 0 ? 1.0f : -1.0f);
  }
  smooth_rows(trembling);
  EXPECT_LT((trembling - slow).middleRows(10, 100).cwiseAbs().maxCoeff(), 0.03f);
}

TEST(WordsStyle, ComesASecondLaterAtMostAndLosesNoFrame) {
  for (const float fps : {12.0f, 25.0f, 30.0f, 60.0f, 240.0f}) {
    WordsStyle style(std::make_shared<Raising>(0.0f));
    const auto poses = walk(fps, static_cast<size_t>(3.3f * fps));
    size_t latest = 0;
    const auto out = through(style, poses, fps, &latest);
    ASSERT_EQ(out.size(), poses.size()) << fps;
    EXPECT_LE(static_cast<float>(latest), fps * style.lag_s() + 2) << fps;
    EXPECT_LT(worst_deg(out, poses, LeftHip, static_cast<size_t>(fps / 4)), 8) << fps;
  }
}

TEST(WordsStyle, ShortClipsAndSingleFramesAreStyledToo) {
  for (const size_t frames : {1u, 2u, 7u, 29u, 30u, 31u}) {
    WordsStyle style(std::make_shared<Raising>(0.5f));
    const auto poses = walk(30, frames);
    const auto out = through(style, poses, 30);
    ASSERT_EQ(out.size(), frames);
    for (size_t t = 0; t < frames; ++t)
      EXPECT_NEAR(geodesic_angle(out[t][LeftShoulder], poses[t].local[LeftShoulder]), 0.5f, 0.1f)
          << frames << t;
  }
}

TEST(WordsStyle, FramesBeforeTheLagAreTheSameWhereTheSourceIsCut) {
  WordsStyle style(std::make_shared<Raising>(0.4f));
  const auto poses = walk(30, 140);
  const auto whole = through(style, poses, 30);
  const auto part = through(style, {poses.begin(), poses.begin() + 95}, 30);
  ASSERT_EQ(part.size(), 95u);
  for (size_t t = 0; t < 95 - 30; ++t) EXPECT_EQ(part[t], whole[t]) << t;
}

TEST(WordsStyle, JointsThatTheNetworkDoesNotKnowStayAsTheyAre) {
  WordsStyle style(std::make_shared<Raising>(0.4f, false));
  const auto poses = walk(30, 60);
  const auto out = through(style, poses, 30);
  EXPECT_EQ(worst_deg(out, poses, Head), 0);
  EXPECT_GT(worst_deg(out, poses, LeftShoulder), 15);
}

TEST(WordsStyle, WordsAreAThirdOfASecondApart) {
  const auto translator = std::make_shared<Raising>(0.0f);
  WordsStyle style(translator);
  through(style, walk(30, 300), 30);
  EXPECT_GE(translator->words, 28);
  EXPECT_LE(translator->words, 33);
}

TEST(WordsStyle, WordsWithoutFiniteNumbersStayAsTheyAre) {
  const auto translator = std::make_shared<Raising>(0.7f);
  translator->broken = true;
  WordsStyle style(translator);
  const auto poses = walk(30, 60);
  const auto out = through(style, poses, 30);
  ASSERT_EQ(out.size(), 60u);
  EXPECT_LT(worst_deg(out, poses, LeftShoulder, 8), 5);
}

TEST(WordsStyle, WhoLiesStaysAsTheyLie) {
  WordsStyle style(std::make_shared<Raising>(0.5f));
  auto poses = walk(30, 60);
  for (Pose& pose : poses)
    pose.local[Pelvis] = rotation_from_axis_angle(Vec3(-kPi / 2, 0, 0)) * pose.local[Pelvis];
  const auto out = through(style, poses, 30);
  for (const int j : {Pelvis, LeftShoulder}) EXPECT_LT(worst_deg(out, poses, j), 0.5f);
}

}  // namespace
}  // namespace understudy
