#include "retarget/style/fit_manner.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/style/manner_file.hpp"

namespace understudy {
namespace {

/// Two recordings of a motion, or of somebody who does not move, with the left arm turned forward.
MannerSample sample(const std::string& motion, float turn_deg) {
  MannerSample taught(fitted_joints("all"));
  const Mat3 turn = rotation_from_axis_angle({0, -turn_deg * kPi / 180, 0});
  for (int i = 0; i < 2; ++i) {
    std::vector<StyleFrame> frames;
    for (Pose pose : builtin_motion(motion.empty() ? "walk" : motion, human_rest()).poses) {
      if (motion.empty()) pose.local = identity_rotations();
      pose.local[LeftShoulder] = turn * pose.local[LeftShoulder];
      frames.push_back({human_rest(), pose, frames.empty() ? 0 : 1 / 30.0f});
    }
    taught.add(frames);
  }
  return taught;
}

MannerFile file_of(const Manner& manner) {
  MannerFile file;
  file.note = {"x", "x", "x", "MIT", "", "made by code"};
  file.manner = manner;
  file.origins["coupling"] = {"this test", ""};
  return file;
}

TEST(FitManner, OfOneMannerTwiceChangesNothing) {
  const Manner manner = fit_manner(sample("walk", 0), sample("walk", 0));
  const auto count = manner.coupling->gains.rows();
  EXPECT_LT((manner.coupling->gains - Eigen::MatrixXf::Identity(count, count)).cwiseAbs().maxCoeff(), 0.05f);
  for (const Vec3& offset : manner.coupling->offsets) EXPECT_LT(offset.norm(), 1e-4f);
}

TEST(FitManner, APostureIsTurnedAsTheOtherIsHeld) {
  const Manner manner = fit_manner(sample("", 0), sample("", 40));
  EXPECT_NEAR(manner.coupling->offsets[LeftShoulder].norm() * 180 / kPi, 40, 0.5);
  EXPECT_LT(manner.coupling->offsets[RightShoulder].norm(), 1e-3f);
}

TEST(FitManner, HoweverUnlikeTwoMannersAreTheFileHoldsIt) {
  const Manner manner = fit_manner(sample("", 0), sample("dance", 110));
  EXPECT_LE(manner.coupling->gains.cwiseAbs().maxCoeff(), 20);
  EXPECT_NEAR(manner.coupling->offsets[LeftShoulder].norm() * 180 / kPi, 59, 0.1);
  EXPECT_EQ(failure_of([&] { to_json(file_of(manner)); }), "");
}

TEST(FitManner, OneRecordingIsTooFew) {
  MannerSample none(fitted_joints("all"));
  EXPECT_NE(failure_of([&] { fit_manner(none, sample("walk", 0)); }).find("two recordings at least"),
            std::string::npos);
}

}  // namespace
}  // namespace understudy
