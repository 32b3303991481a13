// A person has the studio send what it shows to another program, which hears it.
#include <gtest/gtest.h>

#include <set>

#include "tests/app/application_fixture.hpp"
#include "tests/app/osc_receiver.hpp"

namespace understudy::app {
namespace {

class SendingPath : public ApplicationTest {
 protected:
  void SetUp() override {
    ApplicationTest::SetUp();
    make();
    play(kOpenBoth);
    play("key Home\nframes 3");
  }
  /// By the menu, the dialog's field and its switch.
  void switch_on(const std::string& port, int protocol) {
    play("click menu.file\nclick menu.dialog.open.send\nclick send.protocol." + std::to_string(protocol) +
         "\nclick send.address\nkey Ctrl+A\ntype 127.0.0.1:" + port +
         "\nkey Enter\nclick send.on\nwait\nframes 3");
  }
  /// Of the take, where the playhead is.
  Joints shown() const {
    const TakeState& take = session().takes.at(0);
    return forward_kinematics(take.target->joints, take.shown.poses.at(shown_frame(session()))).joints;
  }
  void expect_heard_what_is_shown() {
    const auto joints = tests::joints_in(receiver_.heard());
    ASSERT_EQ(joints.size(), static_cast<size_t>(kJointCount));
    const Joints wanted = shown();
    for (int j = 0; j < kJointCount; ++j)
      EXPECT_LT((joints.at(kJointNames[j]) - wanted.row(j).transpose()).norm(), 1e-4f) << kJointNames[j];
  }
  tests::OscReceiver receiver_;
};

TEST_F(SendingPath, AnotherProgramHearsEachPoseThatIsShown) {
  switch_on(receiver_.port(), 1);
  play("expect_value sends_to osc://127.0.0.1:" + receiver_.port() + "\nclick send.close\nframes 3");
  expect_heard_what_is_shown();
  const Joints first = shown();
  play("key Right\nkey Right\nkey Right\nframes 3");
  expect_heard_what_is_shown();
  EXPECT_GT((shown() - first).norm(), 0.01f) << "another frame has another pose";
  play("edit.rotate 0 3 left_elbow 0 1 0\nwait\nframes 3");
  expect_heard_what_is_shown();
  play("click status.sending\nclick send.on\nclick send.close\nframes 3\nexpect_value sends_to nowhere");
  receiver_.heard();
  play("key Right\nframes 20");
  EXPECT_TRUE(receiver_.heard().empty());
}

TEST_F(SendingPath, APoseThatStandsStillIsSentAgain) {
  switch_on(receiver_.port(), 1);
  receiver_.heard();
  play("frames 30");
  const auto frames = tests::joints_in(receiver_.heard());
  EXPECT_EQ(frames.size(), static_cast<size_t>(kJointCount));
}

TEST_F(SendingPath, BonesGoOutByTheNamesOfVrm) {
  switch_on(receiver_.port(), 0);
  std::set<std::string> bones;
  for (const std::string& message : receiver_.heard())
    if (tests::path_in(message) == "/VMC/Ext/Bone/Pos") bones.insert(tests::name_in(message));
  EXPECT_EQ(bones.size(), static_cast<size_t>(kJointCount));
  EXPECT_EQ(bones.count("LeftUpperArm"), 1u);
}

TEST_F(SendingPath, AnAddressThatIsNoneIsToldAndTheOldOneStays) {
  play(
      "poses.address osc://127.0.0.1:9123\nclick menu.file\nclick menu.dialog.open.send\nclick "
      "send.address\n"
      "key Ctrl+A\ntype 127.0.0.1:many\nkey Enter\nframes 3\nexpect_value errors 1");
  EXPECT_NE(session().errors.front().text.find("many"), std::string::npos);
  EXPECT_EQ(session().settings.send_to, "osc://127.0.0.1:9123");
}

TEST_F(SendingPath, AHostThatThereIsNotIsToldAndNothingIsSent) {
  play(
      "poses.address osc://no.such.host.invalid:9123\nposes.send on\nwait\nframes 3\nexpect_value sends_to "
      "nowhere");
  ASSERT_EQ(session().errors.size(), 1u);
  EXPECT_NE(session().errors.front().text.find("there is no such host"), std::string::npos);
}

}  // namespace
}  // namespace understudy::app
