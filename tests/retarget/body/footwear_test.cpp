#include "retarget/body/footwear.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "retarget/body/builtin_person.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

ShoeOptions bare() {
  ShoeOptions shoe;
  shoe.sole = shoe.upper = shoe.longer = shoe.pointed = shoe.shaft_width = 0;
  return shoe;
}

const ShapedBody& barefoot() {
  static const ShapedBody body = builtin_person();
  return body;
}

class Footwear : public testing::Test {
 protected:
  const ShapedBody& body_ = barefoot();

  Points worn(const ShoeOptions& options) const {
    Points points = body_.vertices;
    Shoes(body_, options).wear(points, body_.weights);
    return points;
  }
  bool is_left_foot(Eigen::Index v) const {
    return body_.weights(v, LeftAnkle) + body_.weights(v, LeftFoot) > 0.9f;
  }
  /// Lowest of the left foot's points from `from` to `to` of its length from the heel.
  float lowest(const Points& points, float from, float to) const {
    float heel = 1e9f, tip = -1e9f, low = 1e9f;
    for (Eigen::Index v = 0; v < points.rows(); ++v)
      if (is_left_foot(v))
        heel = std::min(heel, body_.vertices(v, 2)), tip = std::max(tip, body_.vertices(v, 2));
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
      const float along = (body_.vertices(v, 2) - heel) / (tip - heel);
      if (is_left_foot(v) && along >= from && along <= to) low = std::min(low, points(v, 1));
    }
    return low;
  }
  /// How wide the left foot's first two centimetres are.
  float tip_width(const Points& points) const {
    float tip = -1e9f, left = -1e9f, right = 1e9f;
    for (Eigen::Index v = 0; v < points.rows(); ++v)
      if (is_left_foot(v)) tip = std::max(tip, points(v, 2));
    for (Eigen::Index v = 0; v < points.rows(); ++v)
      if (is_left_foot(v) && points(v, 2) > tip - 0.02f)
        left = std::max(left, points(v, 0)), right = std::min(right, points(v, 0));
    return left - right;
  }
};

TEST_F(Footwear, ASoleRaisesTheFootByItsThickness) {
  ShoeOptions shoe = bare();
  shoe.sole = 0.03f;
  const float without = lowest(worn(bare()), 0, 1);
  EXPECT_NEAR(without - lowest(worn(shoe), 0, 1), 0.03f, 0.006f);  // metres of a foot 25 cm long
}

TEST_F(Footwear, AHeelIsUnderTheHeelAndNotUnderTheToes) {
  ShoeOptions shoe = bare();
  shoe.heel = 0.07f;
  const Points flat = worn(bare()), heeled = worn(shoe);
  EXPECT_NEAR(lowest(flat, 0, 0.25f) - lowest(heeled, 0, 0.25f), 0.07f, 0.015f);
  EXPECT_NEAR(lowest(flat, 0.75f, 1) - lowest(heeled, 0.75f, 1), 0, 0.003f);
  shoe.wedge = true;
  EXPECT_GT(lowest(flat, 0.4f, 0.5f) - lowest(worn(shoe), 0.4f, 0.5f), 0.02f);
}

TEST_F(Footwear, HeelsTurnAnklesDownAndToesBack) {
  ShoeOptions shoe = bare();
  shoe.heel = 0.06f;
  Pose pose;
  Shoes(body_, shoe).lift_heels(pose);
  const PosedSkeleton stands = forward_kinematics(body_.joints, pose);
  for (const int side : {0, 1}) {
    EXPECT_LT(stands.joints(LeftFoot + side, 1), body_.joints(LeftFoot + side, 1) - 0.02f);
    EXPECT_LT(geodesic_angle(stands.global[LeftFoot + side], Mat3::Identity()), 1e-3f);
    EXPECT_GT(geodesic_angle(stands.global[LeftAnkle + side], Mat3::Identity()), 0.2f);
  }
  Pose flat;
  Shoes(body_, bare()).lift_heels(flat);
  EXPECT_EQ(flat.local[LeftAnkle], Pose().local[LeftAnkle]);
}

TEST_F(Footwear, PointedShoesAreNarrowerAtTheTipThanBluntOnes) {
  ShoeOptions blunt = bare(), pointed = bare();
  blunt.corner = 5;
  pointed.pointed = 0.8f;
  pointed.longer = 0.03f;
  EXPECT_LT(tip_width(worn(pointed)), 0.8f * tip_width(worn(blunt)));
}

TEST_F(Footwear, ABootReachesUpTheShinAndALowShoeDoesNot) {
  ShoeOptions boot = bare();
  boot.shaft = 0.5f;
  boot.shaft_width = 0.02f;
  const auto moved_to =
      [&](const ShoeOptions& shoe) {  // the highest place that is changed, share of the shin
        const Points points = worn(shoe);
        const float ankle = body_.joints(LeftAnkle, 1), knee = body_.joints(LeftKnee, 1);
        float top = -1e9f;
        for (Eigen::Index v = 0; v < points.rows(); ++v)
          if ((points.row(v) - body_.vertices.row(v)).norm() > 0.001f)
            top = std::max(top, (body_.vertices(v, 1) - ankle) / (knee - ankle));
        return top;
      };
  EXPECT_NEAR(moved_to(boot), 0.48f, 0.05f);
  boot.shaft = 0;
  boot.upper = 0.005f;
  EXPECT_LT(moved_to(boot), 0.1f);
}

TEST_F(Footwear, RandomShoesStayShoesAndMoveNothingElse) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed), same(seed);
    const Points points = worn(random_shoe(rng));
    EXPECT_EQ(points, worn(random_shoe(same)));
    ASSERT_TRUE(points.allFinite());
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
      const float moved = (points.row(v) - body_.vertices.row(v)).norm();
      EXPECT_LT(moved, 0.2f) << seed;
      if (body_.vertices(v, 1) > body_.joints(LeftKnee, 1)) EXPECT_LT(moved, 1e-5f) << seed;
    }
  }
}

}  // namespace
}  // namespace understudy
