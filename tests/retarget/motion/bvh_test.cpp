#include "retarget/motion/bvh.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::tests {
namespace {

using test::contains;
using test::error_of;

// A root 90 units up and an arm along x, two frames.
const char* const kArm = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 90 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Left Arm
  {
    OFFSET 30 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 20 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 90 0 0 0 0 0 0 0
5 91 2 90 0 0 0 0 90
)";

Vec3 place(const Character& character, size_t node, float seconds) {
  return nodes_at(character, 0, seconds).world[node].topRightCorner<3, 1>();
}

std::string replaced(const std::string& from, const std::string& to, std::string text = kArm) {
  for (size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

TEST(Bvh, GivesNodesAndOneAnimation) {
  const Character arm = parse_bvh(kArm, "arm.bvh");
  ASSERT_EQ(arm.nodes.size(), 3u);
  EXPECT_EQ(arm.nodes[1].name, "Left Arm");
  EXPECT_EQ(arm.nodes[2].name, "Left Arm_end");
  EXPECT_EQ(arm.nodes[2].parent, 1);
  ASSERT_EQ(arm.animations.size(), 1u);
  EXPECT_NEAR(arm.animations[0].duration(), 0.04, 1e-6);
  EXPECT_LT((place(arm, 2, 0) - Vec3(50, 90, 0)).norm(), 1e-4f);
}

TEST(Bvh, TurnsByItsChannelsTheFirstOutermost) {
  const Character arm = parse_bvh(kArm, "arm.bvh");
  // The root turned about z, the arm about y: the tip points to -z, 30 above the root.
  EXPECT_LT((place(arm, 1, 1) - Vec3(5, 121, 2)).norm(), 1e-3f);
  EXPECT_LT((place(arm, 2, 1) - Vec3(5, 121, -18)).norm(), 1e-3f);
  const Character other = parse_bvh(replaced("5 91 2 90 0 0", "5 91 2 90 90 0"), "arm.bvh");  // z, then x
  EXPECT_LT((place(other, 1, 1) - Vec3(5, 121, 2)).norm(), 1e-3f);
  const Character swapped = parse_bvh(
      replaced("Zrotation Xrotation", "Xrotation Zrotation", replaced("5 91 2 90 0 0", "5 91 2 90 90 0")),
      "arm.bvh");
  EXPECT_LT((place(swapped, 1, 1) - Vec3(5, 91, 32)).norm(), 1e-3f);
}

TEST(Bvh, TakesOtherWaysToWriteIt) {
  EXPECT_EQ(parse_bvh(replaced("\n", "\r\n"), "arm.bvh").nodes.size(), 3u);
  EXPECT_EQ(parse_bvh("\xEF\xBB\xBF" + replaced("Frames: 2", "FRAMES:2"), "arm.bvh").nodes.size(), 3u);
  const std::string no_end = replaced("    End Site\n    {\n      OFFSET 20 0 0\n    }\n", "");
  EXPECT_EQ(parse_bvh(no_end, "arm.bvh").nodes.size(), 2u);
  // Six channels on every joint: positions in place of the offsets, or added to them.
  const std::string six = replaced("CHANNELS 3", "CHANNELS 6 Xposition Yposition Zposition");
  for (const char* numbers : {"0 90 0 0 0 0 30 0 0 0 0 0\n0 90 0 0 0 0 31 0 0 0 0 0\n",
                              "0 90 0 0 0 0 0 0 0 0 0 0\n0 90 0 0 0 0 1 0 0 0 0 0\n"}) {
    const std::string text = six.substr(0, six.find("0.04\n") + 5) + numbers;
    EXPECT_LT((place(parse_bvh(text, "arm.bvh"), 1, 1) - Vec3(31, 90, 0)).norm(), 1e-3f);
  }
}

TEST(Bvh, SaysWhatIsWrongAndWhere) {
  const auto said = [](const std::string& text) { return error_of([&] { parse_bvh(text, "arm.bvh"); }); };
  EXPECT_TRUE(contains(said(""), "arm.bvh: line 1: it ends where 'hierarchy' is expected"));
  EXPECT_TRUE(contains(said("PNG"), "there is 'PNG'"));
  EXPECT_TRUE(
      contains(said(replaced("Frames: 2", "Frames: -2")), "line 17: a motion of -2 frames is not possible"));
  EXPECT_TRUE(
      contains(said(replaced("Frames: 2", "Frames: 999999999")), "frames of 9 numbers are announced"));
  EXPECT_TRUE(contains(said(replaced("0.04", "0")), "line 18: a frame time of 0 s is not possible"));
  EXPECT_TRUE(contains(said(replaced("0.04", "nan")), "'nan' is not a number for the frame time"));
  EXPECT_TRUE(contains(said(replaced("5 91 2 90 0 0 0 0 90\n", "5 91 2 90 0 0 0\n")),
                       "it ends before all its frames"));
  EXPECT_TRUE(contains(said(replaced("5 91", "5 x")), "line 20: 'x' is not a number"));
  EXPECT_TRUE(contains(said(replaced("Xrotation", "Wrotation")), "'Wrotation' is not a channel"));
  EXPECT_TRUE(contains(said(replaced("CHANNELS 3", "CHANNELS 300")), "0 to 6 channels, not 300"));
  EXPECT_TRUE(contains(said(replaced("JOINT", "JOIN")), "'join' is not expected"));
  EXPECT_TRUE(contains(said(std::string(kArm).substr(0, 150)), "arm.bvh: line"));
  std::string deep = "HIERARCHY\nROOT a\n{\n";
  for (int i = 0; i < 5000; ++i) deep += "JOINT a\n{\n";
  EXPECT_TRUE(contains(said(deep), "more than 1000 levels deep"));
  std::string many = "HIERARCHY\nROOT a\n{\n";
  for (int i = 0; i < 20000; ++i) many += "JOINT a\n{\n}\n";
  EXPECT_TRUE(contains(said(many), "more than 10000 joints"));
}

TEST(Bvh, EveryCutIsASentence) {
  const std::string whole = kArm;
  for (size_t length = 0; length + 3 < whole.size(); ++length) {
    const std::string said = error_of([&] { parse_bvh(whole.substr(0, length), "arm.bvh"); });
    EXPECT_TRUE(contains(said, "arm.bvh: line")) << length << said;
  }
}

}  // namespace
}  // namespace understudy::tests
