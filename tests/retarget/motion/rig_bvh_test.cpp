// What a rig of any tree performs as BVH: read back, its bones are where they were.
#include <gtest/gtest.h>

#include <map>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/character/rig_character.hpp"
#include "retarget/motion/bvh.hpp"
#include "tests/retarget/formats/support.hpp"
#include "tests/support/moving_arm.hpp"

namespace understudy::tests {
namespace {

using test::TempFolder;

/// The arm that bends, its wrist slides.
RiggedMotion sliding_arm() {
  RiggedMotion arm = test::bending_arm(9);
  arm.rig.joints[1].name = "the {elbow}";
  arm.rig.joints[2] = {"the {elbow}", 1, JointKind::Slider, {2, 0, 0}, Vec3::UnitX()};
  for (size_t t = 0; t < 9; ++t) {
    arm.motion.poses[t].turns[2].setIdentity();
    arm.motion.poses[t].slides[2] = 0.04f * static_cast<float>(t);
  }
  return arm;
}

TEST(RigBvh, ReadBackItsBonesAreWhereTheyWere) {
  const TempFolder folder;
  for (const RiggedMotion& arm : {test::bending_arm(9), sliding_arm()}) {
    write_rig_bvh(folder.path("a.bvh"), arm);
    const Character file = read_bvh(folder.path("a.bvh"));
    ASSERT_EQ(file.nodes.size(), 4u);  // and the end of the last
    for (size_t t = 0; t < 9; ++t) {
      const BoneMotions bones = bone_motions(arm.rig, arm.motion.poses[t]);
      const Points places = joint_places(arm.rig, bones);
      const PosedNodes posed = nodes_at(file, 0, static_cast<float>(static_cast<double>(t) / arm.motion.fps));
      for (Eigen::Index j = 0; j < 3; ++j) {
        const Vec3 place = 0.01f * posed.world[static_cast<size_t>(j)].topRightCorner<3, 1>();
        EXPECT_LT((place - places.row(j).transpose()).norm(), 1e-4f) << t << ' ' << j;
      }
      const Vec3 end = 0.01f * posed.world[3].topRightCorner<3, 1>();
      EXPECT_LT((end - bones[2](Vec3(3, 0, 0))).norm(), 1e-3f) << t;  // where its surface ends
    }
  }
}

TEST(RigBvh, NamesAreWordsUnlikeEachOther) {
  const TempFolder folder;
  write_rig_bvh(folder.path("a.bvh"), sliding_arm());
  const std::string text = read_file(folder.path("a.bvh"));
  EXPECT_NE(text.find("JOINT the__elbow_\n"), std::string::npos) << text;
  EXPECT_NE(text.find("JOINT the__elbow__2\n"), std::string::npos) << text;
}

TEST(RigBvh, WritesNothingOfPosesThatDoNotFit) {
  const TempFolder folder;
  RiggedMotion arm = sliding_arm();
  arm.motion.poses[3].turns.pop_back();
  EXPECT_THROW(write_rig_bvh(folder.path("a.bvh"), arm), Error);
  EXPECT_FALSE(std::filesystem::exists(folder.path("a.bvh")));
}

}  // namespace
}  // namespace understudy::tests
