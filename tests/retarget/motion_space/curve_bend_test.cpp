// Curves that are bent where they are not known.
#include "retarget/motion_space/curve_bend.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "tests/retarget/motion_space/known_walk.hpp"

namespace understudy {
namespace {

/// Samples 12 .. 41 are not known.
MotionWindow walked_window() {
  const tests::KnownWalk walk("walk");
  KnownMotion question = walk.question(0, 54, 12, 41);
  Motion curve = question.motion;
  fill_curves(question.known, 0, ssize(curve.poses) - 1, curve);
  return windows_of(question.known, curve, question.rest).at(0);
}

std::vector<float> doubt_of(const MotionWindow& window, float metres = 0.05f) {
  return std::vector<float>(window.curve.size(), metres);
}

float apart(const Pose& a, const Pose& b) {
  float largest = (a.root - b.root).norm();
  for (int j = 0; j < kJointCount; ++j) largest = std::max(largest, (a.local[j] - b.local[j]).norm());
  return largest;
}

TEST(CurveBend, LeavesWhatIsKnownAndWhatIsSure) {
  const MotionWindow window = walked_window();
  std::vector<float> doubt_m = doubt_of(window);
  doubt_m[20] = 0;
  for (int way = 1; way <= kCurveBends; ++way) {
    const MotionWindow other = bent(window, way, doubt_m);
    float largest = 0;
    for (int i = 0; i < ssize(window.curve); ++i) {
      const float moved = apart(window.curve[i], other.curve[i]);
      if (window.distance[i][kRootPart][0] == 0) EXPECT_EQ(moved, 0) << way << " " << i;
      largest = std::max(largest, moved);
    }
    EXPECT_LT(apart(window.curve[20], other.curve[20]), 1e-5f) << way;
    EXPECT_GT(largest, 0.04f) << way;
  }
}

TEST(CurveBend, BendsMoreTheMoreDoubtThereIs) {
  const MotionWindow window = walked_window();
  for (int way = 1; way <= kCurveBends; ++way) {
    const auto moved = [&](float doubt) {
      const MotionWindow other = bent(window, way, doubt_of(window, doubt));
      return (other.curve[27].root - window.curve[27].root).norm() +
             (other.curve[27].local[LeftHip] - window.curve[27].local[LeftHip]).norm();
    };
    EXPECT_GT(moved(0.04f), 1.5f * moved(0.02f)) << way;
    EXPECT_LT(moved(2), 8) << way << ": not without end";
  }
}

TEST(CurveBend, OfAMirroredWindowIsMirrored) {
  const MotionWindow window = walked_window();
  for (int way = 1; way <= kCurveBends; ++way) {
    const MotionWindow there = bent(mirrored(window), way, doubt_of(window)),
                       here = mirrored(bent(window, way, doubt_of(window)));
    for (int i = 0; i < ssize(window.curve); ++i)
      EXPECT_LT(apart(there.curve[i], here.curve[i]), 1e-4f) << way << " " << i;
  }
}

TEST(CurveBend, RefusesWhatItDoesNotKnow) {
  const MotionWindow window = walked_window();
  EXPECT_THROW(bent(window, 0, doubt_of(window)), Error);
  EXPECT_THROW(bent(window, kCurveBends + 1, doubt_of(window)), Error);
  EXPECT_THROW(bent(window, 1, {}), Error);
}

}  // namespace
}  // namespace understudy
