// What surrounds the network of the motion space: here a stand-in of it that turns one elbow.
#include "retarget/motion_space/learned_space.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/foot_hold.hpp"

namespace understudy {
namespace {

/// Turns the left elbow, and less the right knee; the farther from what is known, the more. A code says how
/// far, and how far aside; it is where a movement goes.
class ElbowNetwork final : public WindowNetwork {
 public:
  explicit ElbowNetwork(float angle, float stands = 0) : angle_(angle), stands_(stands) {}
  std::vector<WindowAnswer> answer(const std::vector<MotionWindow>& windows,
                                   const std::vector<WindowCode>& codes) override {
    std::vector<WindowAnswer> answers;
    for (size_t w = 0; w < windows.size(); ++w) {
      const MotionWindow& window = windows[w];
      const WindowCode code = codes.empty() ? WindowCode(4, 0.0f) : codes[w];
      WindowAnswer& answer = answers.emplace_back();
      for (size_t i = 0; i < window.curve.size(); ++i) {
        Pose pose = window.curve[i];
        const auto& distance = window.distance[i][LeftElbow];
        const float away = std::min(1.0f, std::min(distance[0], distance[1]) / 4);
        const float angle = angle_ + 0.2f * code[0] + 0.1f * code[1];
        pose.local[LeftElbow] = pose.local[LeftElbow] * rotation_from_axis_angle({0, away * angle, 0});
        pose.local[RightKnee] =
            pose.local[RightKnee] * rotation_from_axis_angle({0.3f * away * angle_, 0, 0});
        pose.root +=
            Vec3(away * (0.1f * angle_ + 0.05f * code[2] + 0.02f * code[3]), 0, 0.05f * away * angle_);
        answer.poses.push_back(pose);
        answer.standing.push_back({stands_, stands_});
        answer.doubt_m.push_back(0.01f * away);
      }
    }
    return answers;
  }
  int code_size() const override { return 4; }
  WindowCode code_of(const MotionWindow& movement) override {
    const Vec3 way = movement.curve.back().root - movement.curve.front().root;
    return {0.1f * way.z(), 0.1f, way.x(), 0.5f * way.x()};
  }

 private:
  float angle_, stands_;
};

struct Question : KnownMotion {
  Question(int first, int last) {
    static const Joints person = builtin_person().joints;
    rest = person;
    motion = builtin_motion("walk", rest);
    known.assign(motion.poses.size(), all_parts(true));
    for (int t = first; t <= last; ++t) known[t] = all_parts(false);
  }
};

Completion completed(const KnownMotion& question, float angle, float stands = 0) {
  return LearnedSpace(std::make_unique<ElbowNetwork>(angle, stands)).complete(question);
}

/// Another of its answers.
Completion alternative(KnownMotion question, int variation) {
  question.variation = variation;
  return completed(question, 0.8f);
}

/// Mean distance of the joints over some frames, metres.
float apart(const Joints& rest, const Motion& a, const Motion& b, int first, int last) {
  float sum = 0;
  for (int t = first; t <= last; ++t)
    sum += (forward_kinematics(rest, a.poses[t]).joints - forward_kinematics(rest, b.poses[t]).joints)
               .rowwise()
               .norm()
               .mean();
  return sum / static_cast<float>(last - first + 1);
}

bool is_same(const Pose& a, const Pose& b) {
  return a.local == b.local && a.root == b.root;
}

TEST(LearnedSpace, WithoutACorrectionItIsTheCurveWhoseFeetClearTheFloor) {
  const Question question(20, 29);
  Motion curve = question.motion;
  fill_curves(question.known, 0, ssize(curve.poses) - 1, curve);
  curve.standing.resize(curve.poses.size());
  hold_standing(question.rest, 20, 29, curve);
  const Completion made = completed(question, 0);
  for (size_t t = 0; t < curve.poses.size(); ++t) {
    EXPECT_LT((made.motion.poses[t].root - curve.poses[t].root).norm(), 1e-6f);
    for (int j = 0; j < kJointCount; ++j)
      EXPECT_LT(geodesic_angle(made.motion.poses[t].local[j], curve.poses[t].local[j]), 1e-3f);
  }
}

TEST(LearnedSpace, WhatIsKnownStaysToTheBit) {
  Question question(20, 29);
  question.known[24] = all_parts(true);
  for (int t = 20; t < 24; ++t) question.known[t][LeftShoulder] = true;
  const Completion made = completed(question, 0.8f);
  for (int t = 0; t < ssize(question.known); ++t) {
    const Pose &was = question.motion.poses[t], &is = made.motion.poses[t];
    EXPECT_EQ(is_same(was, is), t < 20 || t > 29 || t == 24) << t;
    EXPECT_EQ(made.doubt_m[t] == 0, question.known[t] == all_parts(true)) << t;
    if (t < 24) EXPECT_EQ(was.local[LeftShoulder], is.local[LeftShoulder]);
  }
}

TEST(LearnedSpace, TakesTheMeanWithTheMirrorImage) {
  const Question question(20, 29);
  const Completion curve = completed(question, 0), made = completed(question, 0.8f);
  const Pose &a = curve.motion.poses[25], &b = made.motion.poses[25];
  EXPECT_NEAR(geodesic_angle(a.local[LeftElbow], b.local[LeftElbow]), 0.38f, 1e-2f);
  EXPECT_NEAR(geodesic_angle(a.local[RightElbow], b.local[RightElbow]), 0.38f, 1e-2f);
}

TEST(LearnedSpace, KeepsMoreOfWhatGoesOnThanOfWhatLiesBetween) {
  const auto turned = [](const Question& question, int frame) {
    return geodesic_angle(completed(question, 0).motion.poses[frame].local[LeftElbow],
                          completed(question, 0.8f).motion.poses[frame].local[LeftElbow]);
  };
  const int last = static_cast<int>(Question(0, -1).known.size()) - 1;
  EXPECT_NEAR(turned(Question(last - 9, last), last - 2), 0.42f, 1e-2f);
}

TEST(LearnedSpace, TurnsAndMirrorsWithWhatIsKnown) {
  const Question question(20, 29);
  Question turned = question, mirror = question;
  const Mat3 R = rotation_about_y(2);
  for (Pose& pose : turned.motion.poses)
    pose.root = R * pose.root, pose.local[Pelvis] = R * pose.local[Pelvis];
  for (Pose& pose : mirror.motion.poses) pose = mirrored(pose);
  const Completion made = completed(question, 0.8f), other = completed(turned, 0.8f),
                   seen = completed(mirror, 0.8f);
  for (int t = 20; t <= 29; ++t) {
    EXPECT_LT((R * made.motion.poses[t].root - other.motion.poses[t].root).norm(), 1e-3f);
    const Pose same = mirrored(made.motion.poses[t]);
    EXPECT_LT((same.root - seen.motion.poses[t].root).norm(), 1e-3f);
    for (int j = 0; j < kJointCount; ++j) {
      EXPECT_LT(geodesic_angle(same.local[j], seen.motion.poses[t].local[j]), 2e-3f);
      if (j != Pelvis)
        EXPECT_LT(geodesic_angle(made.motion.poses[t].local[j], other.motion.poses[t].local[j]), 2e-3f);
    }
  }
}

TEST(LearnedSpace, CorrectsAlikeAtAnyRate) {
  for (const int times : {2, 4}) {
    Question slow(20, 29);
    Question fast(0, -1);
    fast.motion.fps = slow.motion.fps * static_cast<float>(times);
    fast.motion.poses.clear();
    fast.known.clear();
    for (int t = 0; t + 1 < ssize(slow.motion.poses); ++t)
      for (int i = 0; i < times; ++i) {
        fast.motion.poses.push_back(slow.motion.poses[t]);  // as good as any curve
        fast.known.push_back(all_parts(t < 20 || (t == 29 && i > 0) || t > 29));
      }
    const Completion plain = completed(fast, 0), made = completed(fast, 0.8f);
    float largest = 0, before = 0;
    for (int t = 0; t < ssize(fast.known); ++t) {
      const float turn =
          geodesic_angle(plain.motion.poses[t].local[LeftElbow], made.motion.poses[t].local[LeftElbow]);
      largest = std::max(largest, turn);
      EXPECT_LT(std::abs(turn - before), 0.25f / static_cast<float>(times)) << t;  // no steps at 30 a second
      before = turn;
    }
    EXPECT_NEAR(largest, 0.37f, 0.03f);
  }
}

TEST(LearnedSpace, HoldsAFootThatItSaysStands) {
  Question question(20, 29);
  question.motion.standing.resize(question.known.size());
  const auto slid = [&](const Motion& motion) {
    float way = 0;
    for (int t = 21; t <= 29; ++t) {
      const auto ball = [&](int frame) -> Vec3 {
        return forward_kinematics(question.rest, motion.poses[frame]).joints.row(LeftFoot).transpose();
      };
      way += (ball(t) - ball(t - 1)).norm();
    }
    return way;
  };
  Pose still;
  still.root = question.rest.row(Pelvis).transpose();
  for (Pose& pose : question.motion.poses) pose = still;
  const Completion free = completed(question, 0.6f, 0), held = completed(question, 0.6f, 1);
  EXPECT_GT(slid(free.motion), 0.02f);
  EXPECT_LT(slid(held.motion), 0.2f * slid(free.motion));
  EXPECT_TRUE(held.motion.standing[25][0]);
  EXPECT_FALSE(free.motion.standing[25][0]);
}

TEST(LearnedSpace, ALongGapStaysTheCurve) {
  Question question(10, 30);
  const Pose last = question.motion.poses.back();
  question.motion.poses.resize(200, last);
  question.known.resize(200, all_parts(true));
  for (int t = 10; t < 150; ++t) question.known[t] = all_parts(false);
  const Completion curve = completed(question, 0), made = completed(question, 0.8f);
  for (int t = 10; t < 150; ++t) EXPECT_TRUE(is_same(curve.motion.poses[t], made.motion.poses[t])) << t;
  EXPECT_GT(made.doubt_m[80], made.doubt_m[12]);
}

TEST(LearnedSpace, AShortGapBetweenKnownFramesStaysTheCurve) {
  Question question(20, 24);
  for (int t = 30; t < 36; ++t) question.known[t] = all_parts(false);
  Motion curve = question.motion;
  fill_curves(question.known, 0, ssize(curve.poses) - 1, curve);
  const Completion made = completed(question, 0.8f, 1);
  for (int t = 20; t < 25; ++t) EXPECT_TRUE(is_same(curve.poses[t], made.motion.poses[t])) << t;
  EXPECT_FALSE(is_same(curve.poses[33], made.motion.poses[33])) << "a frame more is made";
  const Question ahead(146, 149);
  EXPECT_FALSE(is_same(completed(ahead, 0).motion.poses[149], completed(ahead, 0.8f).motion.poses[149]))
      << "after the last known frame any gap is made";
}

TEST(LearnedSpace, AlternativesDifferFromEachOtherAndTellMoreDoubt) {
  const Question question(20, 39);
  const LearnedSpace space(std::make_unique<ElbowNetwork>(0.8f));
  ASSERT_EQ(space.variations(), kMostVariations);
  std::vector<Completion> made;
  for (int k = 0; k < kMostVariations; ++k) made.push_back(alternative(question, k));
  for (int k = 0; k < kMostVariations; ++k)
    for (int other = 0; other < k; ++other)
      EXPECT_GT(apart(question.rest, made[k].motion, made[other].motion, 20, 39), 1e-3f) << k << other;
  for (int k = 1; k < kMostVariations; ++k) {
    EXPECT_GT(made[k].doubt_m[30], made[0].doubt_m[30]) << k;
    const float way = apart(question.rest, made[k].motion, made[0].motion, 30, 30);
    EXPECT_LT(made[k].doubt_m[30], made[0].doubt_m[30] + way + 0.01f) << k;
    EXPECT_TRUE(std::equal(made[k].motion.poses.begin(), made[k].motion.poses.end(),
                           alternative(question, k).motion.poses.begin(), is_same))
        << k;
  }
}

TEST(LearnedSpace, ANumberBeyondTheAlternativesIsTheBestAnswerToTheBit) {
  const Question question(20, 39);
  const Completion best = completed(question, 0.8f);
  for (const int k : {-1, 0, kMostVariations}) {
    const Completion made = alternative(question, k);
    EXPECT_EQ(made.doubt_m, best.doubt_m);
    for (size_t t = 0; t < best.motion.poses.size(); ++t)
      EXPECT_TRUE(is_same(made.motion.poses[t], best.motion.poses[t])) << k << " " << t;
  }
}

TEST(LearnedSpace, AlternativesKeepWhatIsKnownToTheBit) {
  Question question(20, 39);
  question.known[28] = all_parts(true);
  for (int t = 20; t < 28; ++t) question.known[t][LeftShoulder] = question.known[t][LeftHip] = true;
  for (int k = 1; k < kMostVariations; ++k) {
    const Completion made = alternative(question, k);
    for (int t = 0; t < ssize(question.known); ++t) {
      const Pose &was = question.motion.poses[t], &is = made.motion.poses[t];
      EXPECT_EQ(is_same(was, is), t < 20 || t > 39 || t == 28) << k << " " << t;
      for (const int joint : {LeftShoulder, LeftHip})
        if (t < 28) EXPECT_EQ(was.local[joint], is.local[joint]) << k << " " << t;
    }
  }
}

TEST(LearnedSpace, AlternativesTurnAndMirrorWithWhatIsKnown) {
  const Question question(20, 39);
  KnownMotion turned = question, mirror = question;
  const Mat3 R = rotation_about_y(2);
  for (Pose& pose : turned.motion.poses)
    pose.root = R * pose.root, pose.local[Pelvis] = R * pose.local[Pelvis];
  for (Pose& pose : mirror.motion.poses) pose = mirrored(pose);
  for (int k = 1; k < kMostVariations; ++k) {
    Motion made = alternative(question, k).motion, other = alternative(turned, k).motion,
           seen = alternative(mirror, k).motion;
    for (Pose& pose : other.poses)
      pose.root = R.transpose() * pose.root, pose.local[Pelvis] = R.transpose() * pose.local[Pelvis];
    for (Pose& pose : seen.poses) pose = mirrored(pose);
    EXPECT_LT(apart(question.rest, made, other, 20, 39), 1e-3f) << k;
    EXPECT_LT(apart(question.rest, made, seen, 20, 39), 2e-3f) << k;
  }
}

TEST(LearnedSpace, FuturesGoApartAndBeginTogether) {
  Question question(0, -1);
  const int end = ssize(question.known) - 1, first = end - 29;
  for (int t = first; t <= end; ++t) question.known[t] = all_parts(false);
  const Completion best = completed(question, 0.8f);
  for (int k = 1; k < kMostVariations; ++k) {
    const Completion made = alternative(question, k);
    const auto way = [&](int t) { return apart(question.rest, made.motion, best.motion, t, t); };
    EXPECT_GT(way(end), 1e-3f) << k;
    EXPECT_LT(way(first), 0.5f * way(end)) << k;
  }
}

TEST(LearnedSpace, CodesMovementsOfAnyRateAndPlace) {
  LearnedSpace space(std::make_unique<ElbowNetwork>(0.8f));
  MovementEncoder& encoder = *space.encoder();
  EXPECT_EQ(encoder.size(), 4);
  const Question question(0, -1);
  const auto movement = [&](int every, const Mat3& turn) {
    TimedPoses moved;
    for (int t = 0; t <= 60; t += every) {
      Pose pose = question.motion.poses[static_cast<size_t>(t)];
      pose.root = turn * pose.root + Vec3(3, 0, 1);
      pose.local[Pelvis] = turn * pose.local[Pelvis];
      moved.poses.push_back(pose);
      moved.seconds.push_back(static_cast<float>(t) / question.motion.fps);
    }
    return moved;
  };
  const auto code = encoder.encode(movement(1, Mat3::Identity()), question.rest).mean;
  for (const auto& same : {encoder.encode(movement(2, Mat3::Identity()), question.rest).mean,
                           encoder.encode(movement(1, rotation_about_y(2)), question.rest).mean})
    for (size_t i = 0; i < code.size(); ++i) EXPECT_NEAR(code[i], same[i], 1e-3f) << i;
  TimedPoses brief = movement(1, Mat3::Identity()), slow = brief;
  brief.poses.resize(5), brief.seconds.resize(5);
  for (float& second : slow.seconds) second *= 3;
  EXPECT_THROW(encoder.encode(brief, question.rest), Error);
  EXPECT_THROW(encoder.encode(slow, question.rest), Error);
}

TEST(LearnedSpace, RefusesQuestionsWithoutAnAnswer) {
  Question none(0, -1);
  none.known.assign(none.known.size(), all_parts(false));
  EXPECT_THROW(completed(none, 0), Error);
  Question shorter(20, 29);
  shorter.known.pop_back();
  EXPECT_THROW(completed(shorter, 0), Error);
}

}  // namespace
}  // namespace understudy
