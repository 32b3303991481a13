// Motions that a network makes: what the product does with them before anybody sees them.
#include "app/run/motion_generator.hpp"

#include <gtest/gtest.h>

#include "retarget/base/index.hpp"
#include "retarget/creature/creature.hpp"
#include "retarget/discovery/ground_contacts.hpp"

namespace understudy::app {
namespace {

/// Performs a clip, but slides over the floor, or rises from it.
class Sliding final : public MotionDynamics {
 public:
  Sliding(std::string kind, RigMotion clip, float rises = 0)
      : kind_(std::move(kind)), clip_(std::move(clip)), rises_(rises) {}
  std::string kind() const override { return kind_; }
  void begin(const understudy::Rig&) override { t_ = 0, height_ = 0; }
  void observe(const RigPose&, double) override { ++t_; }
  RigPose sample(double, Rng&) override {
    RigPose pose = clip_.poses[t_++ % clip_.poses.size()];
    height_ += rises_;
    pose.root.y() += height_;
    pose.root.x() += 0.01f * static_cast<float>(t_ - 5);  // 0.3 m/s
    return pose;
  }
  void raise(float height) override { height_ += height; }
  std::vector<RigPose> aimed(const std::vector<PoseKey>&, double, Rng&) override { return {}; }
  std::unique_ptr<MotionDynamics> clone() const override { return std::make_unique<Sliding>(*this); }

 private:
  std::string kind_;
  RigMotion clip_;
  float rises_, height_ = 0;
  size_t t_ = 0;
};

/// How far the lower ends of bones that stand go in a second, metres.
float slides(const understudy::Rig& rig, const std::vector<RigPose>& poses, const GroundContacts& contacts) {
  float sum = 0;
  int count = 0;
  for (size_t t = 6; t < poses.size(); ++t)
    for (const BoneTip& tip : bone_tips(rig)) {
      const auto bone = static_cast<size_t>(tip.joint);
      if (!contacts.touches[t][bone] || !contacts.touches[t - 1][bone]) continue;
      const Vec3 moved =
          bone_motions(rig, poses[t])[bone](tip.rest) - bone_motions(rig, poses[t - 1])[bone](tip.rest);
      sum += std::hypot(moved.x(), moved.z()) * 30;
      ++count;
    }
  return sum / static_cast<float>(std::max(1, count));
}

TEST(MotionGenerator, FeetThatANetworkLetsSlideStand) {
  RiggedMotion dog;
  dog.rig = make_creature(CreatureKind::Quadruped, 2);
  dog.motion = creature_motion(CreatureKind::Quadruped, dog.rig, 0, 40, 30, 2);
  const GroundContacts contacts = ground_contacts(dog);
  GenerationOptions options;
  options.engine = "vrnn";
  options.frames = 40;
  const auto made = [&](const char* kind) {
    const auto load = [&](const understudy::Rig&) { return std::make_unique<Sliding>(kind, dog.motion); };
    return generate_motions(dog, options, load, [](int) { return true; }).motions[0].motion.poses;
  };
  const auto walks = made("quadruped"), flies = made("hand");
  ASSERT_EQ(walks.size(), 40u);
  EXPECT_GT(slides(dog.rig, flies, contacts), 0.2f);  // a hand in the air stands on nothing
  EXPECT_LT(slides(dog.rig, walks, contacts), 0.4f * slides(dog.rig, flies, contacts));
  for (size_t t = 0; t < 5; ++t) EXPECT_EQ((walks[t].root - dog.motion.poses[t].root).norm(), 0) << t;
}

TEST(MotionGenerator, WhatWalksComesBackToTheGroundHoweverLongItGoesOn) {
  RiggedMotion dog;
  dog.rig = make_creature(CreatureKind::Quadruped, 2);
  dog.motion = creature_motion(CreatureKind::Quadruped, dog.rig, 0, 40, 30, 2);
  GenerationOptions options;
  options.engine = "vrnn";
  options.frames = 200;
  const auto height = [&](const char* kind) {
    const auto load = [&](const understudy::Rig&) {
      return std::make_unique<Sliding>(kind, dog.motion, 0.003f);
    };
    return generate_motions(dog, options, load, [](int) { return true; })
        .motions[0]
        .motion.poses[199]
        .root.y();
  };
  const float usual = dog.motion.poses[0].root.y();
  EXPECT_GT(height("hand"), usual + 0.5f);  // it flies
  EXPECT_NEAR(height("quadruped"), usual, 0.06f);
}

}  // namespace
}  // namespace understudy::app
