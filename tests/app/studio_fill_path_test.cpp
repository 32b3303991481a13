// A person opens scans with a gap, has it filled, changes the answer, saves, opens again and exports.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/app/application_fixture.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

class FillPath : public ApplicationTest {
 protected:
  /// A window high enough for the whole Edit panel; frames 9 to 11 are missing.
  void open_gaps() {
    make(render::ContextKind::Null, {1280, 2400});
    const std::string scans = folder_without({9, 10, 11});
    play("click start.open_source\nclick browser.path\nkey Ctrl+A\ntype \"" + scans +
         "\"\nkey Enter\nwait\nframes 5\nclick browser.accept\nwait\nframes 3");
    play("open samples/target.obj\nwait\nframes 3\nexpect_value takes 1\nexpect_value frames 24");
  }
  const Motion& shown() const { return session().takes.at(0).shown; }
};

bool equal(const Pose& a, const Pose& b) {
  return a.local == b.local && a.root == b.root;
}

TEST_F(FillPath, FromTheNoticeToASavedDocument) {
  open_gaps();
  play("expect_text \"3 frames (9 to 11) could not be used and repeat the last pose\"");
  const std::vector<Pose> still = shown().poses;
  EXPECT_TRUE(equal(still[10], still[8]));
  play("click notice.0.offer\nwait\nframes 3\nexpect_value fills 9-11\nexpect_no notice.0");
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_EQ(equal(shown().poses[t], still[t]), t < 9 || t > 11) << t;
    EXPECT_FALSE(t >= 9 && t <= 11 && equal(shown().poses[t], shown().poses[8])) << t;
  }
  const float learned = shown().poses[10].root.y();
  play(
      "click side.tab.2\nframes 3\ndrag edit.fill_learned.0 -60 0\nwait\nexpect_value undo_label "
      "\"Plain or learned\"");
  const float less = shown().poses[10].root.y();
  EXPECT_LT(less, learned - 0.01f) << "nearer to the plain curve";
  play("key Ctrl+Z\nwait");
  EXPECT_EQ(shown().poses[10].root.y(), learned);
  play("key Ctrl+Shift+Z\nwait");
  EXPECT_EQ(shown().poses[10].root.y(), less);

  const Motion before = shown();
  play("key Ctrl+S\nclick browser.name\nkey Ctrl+A\ntype \"" + path("filled.understudy") +
       "\"\nkey Enter\nwait\nexpect_value changed no");
  make(render::ContextKind::Null, {1280, 2400});
  play("open \"" + path("filled.understudy") + "\"\nwait\nframes 3\nexpect_value fills 9-11");
  ASSERT_EQ(shown().poses.size(), before.poses.size());
  EXPECT_TRUE(same_poses(shown(), before));
  EXPECT_EQ(shown().doubt_m, before.doubt_m);
  play("expect_no notice.0");
}

TEST_F(FillPath, GFillsWhatIsBetweenTheLoopMarks) {
  make();
  play(kOpenBoth);
  const Pose captured = shown().poses[6];
  play(
      "playback.frame 4\nclick timeline.in\nplayback.frame 7\nclick timeline.out\nkey G\nwait\nexpect_value "
      "fills 4-7\nexpect_value undo_label \"Fill frames 4 to 7\"");
  EXPECT_FALSE(equal(shown().poses[6], captured));
  EXPECT_TRUE(shown().doubt_m.at(6) > 0 && shown().doubt_m.at(3) == 0 && shown().doubt_m.at(8) == 0);
  play(
      "drag timeline.track.made.0 200 0\nwait\nexpect_value undo_label \"Move an edit in time\"\nkey Ctrl+Z\n"
      "click timeline.track.made.0\nkey Delete\nwait\nexpect_value fills \"\"");
  EXPECT_TRUE(equal(shown().poses[6], captured));
}

TEST_F(FillPath, AnExportSaysWhichFramesWereMade) {
  open_gaps();
  play("click notice.0.offer\nwait\nkey Ctrl+E\nclick export.path\nkey Ctrl+A\ntype \"" + path("filled.glb") +
       "\"\nclick export.save\nwait");
  const std::string bytes = tests::read_bytes(path("filled.glb"));
  const size_t from = bytes.find('{');
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);  // of the first chunk, the JSON
  const auto gltf = nlohmann::json::parse(bytes.substr(from, length));
  const auto made = gltf["animations"][0]["extras"]["made_frames"];
  ASSERT_EQ(made.size(), 1u) << gltf["animations"][0].dump();
  EXPECT_EQ(made[0]["first"], 9);
  EXPECT_EQ(made[0]["last"], 11);
  EXPECT_NEAR(made[0]["doubt_m"].get<float>(), shown().doubt_m[10], 1e-6f);
}

}  // namespace
}  // namespace understudy::app
