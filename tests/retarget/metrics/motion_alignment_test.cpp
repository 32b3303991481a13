#include "retarget/metrics/motion_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "retarget/math/rotation.hpp"

namespace understudy::tests {
namespace {

/// An elbow that bends there and back, `frames` long, by this much more.
std::vector<Rotations> bends(int frames, float more_deg = 0) {
  std::vector<Rotations> all;
  for (int t = 0; t < frames; ++t) {
    const float share = static_cast<float>(t) / static_cast<float>(frames - 1);
    Rotations local = identity_rotations();
    local[LeftElbow] = rotation_from_axis_angle(Vec3(0, std::sin(kPi * share) + more_deg * kPi / 180, 0));
    all.push_back(local);
  }
  return all;
}

TEST(MotionAlignment, TheSameAtAnotherPaceIsNotApart) {
  EXPECT_LT(aligned_angle_deg(bends(31), bends(31), 15), 0.05);
  EXPECT_LT(aligned_angle_deg(bends(31), bends(61), 15), 0.15);
}

TEST(MotionAlignment, AnOffsetOfOneJointIsItsShareOfAll) {
  EXPECT_NEAR(aligned_angle_deg(std::vector<Rotations>(20, identity_rotations()),
                                std::vector<Rotations>(9, bends(2, 42).front()), 15),
              2, 0.01);
}

TEST(MotionAlignment, TheHeadingDoesNotCount) {
  std::vector<Rotations> turned = bends(20);
  for (Rotations& local : turned) local[Pelvis] = rotation_about_y(2);
  EXPECT_LT(aligned_angle_deg(bends(20), turned, 30), 0.05);
}

TEST(MotionAlignment, NothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(aligned_angle_deg({}, bends(4), 30)));
}

}  // namespace
}  // namespace understudy::tests
