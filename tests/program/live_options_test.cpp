// --listen, --source -, --follow and --send of the shipped program: a camera and an engine that are none.
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

#include "retarget/formats/npz.hpp"
#include "retarget/live/sent_pose.hpp"
#include "retarget/live/socket.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/app/osc_receiver.hpp"
#include "tests/support/stream_sender.hpp"

namespace understudy::tests {
namespace {

std::string free_port() {
  return port_of(listen_at({"tcp", "127.0.0.1", "0"}));
}

ProgramOptions named(const std::string& program) {
  ProgramOptions options;
  options.program = program;
  return options;
}

/// Rotations of each bone as oscdump heard them, one after the other, in our axes.
std::map<std::string, std::vector<Mat3>> bones_heard(const std::string& dump) {
  std::map<std::string, std::vector<Mat3>> bones;
  std::istringstream lines(dump);
  for (std::string line; std::getline(lines, line);) {
    const size_t at = line.find("/VMC/Ext/Bone/Pos");
    if (at == std::string::npos) continue;
    std::istringstream words(line.substr(at));
    std::string path, types, name;
    float x, y, z, qx, qy, qz, qw;
    words >> path >> types >> name >> x >> y >> z >> qx >> qy >> qz >> qw;
    EXPECT_TRUE(words) << line;
    bones[name.substr(1, name.size() - 2)].push_back(Eigen::Quaternionf(qw, qx, -qy, -qz).toRotationMatrix());
  }
  return bones;
}

class LiveOptionsOfTheProgram : public ShippedProgram {
 protected:
  std::string camera() const { return std::string(US_SOURCE_DIR) + "/tests/live/fake_camera.py"; }
  std::string walk() const { return std::string(US_SOURCE_DIR) + "/assets/samples/walk"; }
};

TEST_F(LiveOptionsOfTheProgram, AreInTheHelp) {
  const std::string help = run_program({"retarget", "--help"}).out;
  for (const char* option : {"--listen", "--stream", "--wait", "--send"})
    EXPECT_NE(help.find(option), std::string::npos) << option;
}

TEST_F(LiveOptionsOfTheProgram, AnEngineHearsTheExportedMotionToATenthOfADegree) {
  const std::string port = OscReceiver().port();
  Program engine({"-L", port}, named("oscdump"));
  const Finished run = retarget(scans(), {"--send", "vmc://127.0.0.1:" + port, "--out", out("a.npz")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(engine.wait_for("RightHand"));
  engine.send(SIGTERM);
  const auto heard = bones_heard(engine.finish().out);
  const NpyArray rotations = read_npz(out("a.npz")).at("rotations");
  ASSERT_EQ(rotations.shape, (std::vector<int64_t>{kFrames, kJointCount, 3, 3}));
  for (int j = 0; j < kJointCount; ++j) {
    const auto& bone = heard.at(kVrmBones[j]);
    ASSERT_EQ(bone.size(), static_cast<size_t>(kFrames));
    for (int t = 0; t < kFrames; ++t) {
      Mat3 exported;
      for (int k = 0; k < 9; ++k)
        exported(k / 3, k % 3) = static_cast<float>(rotations.values[(t * kJointCount + j) * 9 + k]);
      EXPECT_LT(geodesic_angle(exported, bone[t]) * 180 / kPi, 0.1f) << kVrmBones[j] << ", frame " << t;
    }
  }
}

TEST_F(LiveOptionsOfTheProgram, ACameraThatConnectsIsPerformedAndAnInterruptKeepsWhatCame) {
  const std::string port = free_port();
  Program program({"retarget", "--listen", "tcp://127.0.0.1:" + port, "--target", target(), "--out",
                   out("a.npz"), "--report", out("a.json")});
  ASSERT_TRUE(program.wait_for("waits for a sender"));
  const Finished sent = run_program({camera(), walk(), port, "--seconds", "3"}, named("python3"));
  ASSERT_EQ(sent.code, 0) << sent.err;
  ASSERT_TRUE(program.wait_for("has ended; the next one is waited for"));
  program.send(SIGINT);
  const Finished run = program.finish();
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("from capture to wire"), std::string::npos) << run.err;
  EXPECT_NE(run.out.find("latency_ms"), std::string::npos);
  EXPECT_GT(read_npz(out("a.npz")).at("joints").shape[0], 10);
}

TEST_F(LiveOptionsOfTheProgram, ASecondCameraIsToldThatItIsRefusedAndTheFirstGoesOn) {
  const std::string address = "tcp://127.0.0.1:" + free_port();
  Program program({"retarget", "--listen", address, "--target", target(), "--out", out("a.npz")});
  ASSERT_TRUE(program.wait_for("waits for a sender"));
  Program first({camera(), walk(), address.substr(address.rfind(':') + 1), "--seconds", "90"},
                named("python3"));
  ASSERT_TRUE(program.wait_for("frame 0 root"));
  const std::string told = StreamSender(address).heard();
  EXPECT_EQ(told.rfind(address + ": 127.0.0.1:", 0), 0u) << told;
  EXPECT_NE(told.find(" is refused, 127.0.0.1:"), std::string::npos) << told;
  EXPECT_NE(told.find(" is sending\n"), std::string::npos) << told;
  EXPECT_TRUE(program.wait_for(told.substr(0, told.size() - 1))) << "the user is told, too";
  first.send(SIGTERM);
  ASSERT_TRUE(program.wait_for("the next one is waited for")) << "the first one was still the sender";
  program.send(SIGINT);
  EXPECT_EQ(program.finish().code, 0);
}

TEST_F(LiveOptionsOfTheProgram, AFolderThatIsBeingWrittenIsSentScanByScan) {
  const std::string live = scratch.path("live");
  std::filesystem::create_directories(live);
  OscReceiver engine;
  Program program({"retarget", "--source", live, "--target", target(), "--follow", "--send",
                   "osc://127.0.0.1:" + engine.port(), "--out", out("a.npz")});
  std::vector<std::map<std::string, Vec3>> sent;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(engine.heard().empty()) << "before scan " << i;
    write_cloud(live + "/" + frame_name(i), person_points(i));
    ASSERT_TRUE(program.wait_for("frame " + std::to_string(i) + " root")) << program.finish().err;
    const std::vector<std::string> heard = engine.heard();
    EXPECT_EQ(heard.size(), 1u + kJointCount);
    sent.push_back(joints_in(heard));
    ASSERT_EQ(sent.back().size(), static_cast<size_t>(kJointCount));
  }
  write_text(live + "/done", "");
  const Finished run = program.finish();
  ASSERT_EQ(run.code, 0) << run.err;
  const NpyArray joints = read_npz(out("a.npz")).at("joints");
  ASSERT_EQ(joints.shape, (std::vector<int64_t>{3, kJointCount, 3}));
  for (int t = 0; t < 3; ++t)
    for (int j = 0; j < kJointCount; ++j)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(sent[t].at(kJointNames[j])[k], joints.values[(t * kJointCount + j) * 3 + k], 1e-4f)
            << kJointNames[j] << ", frame " << t;
}

TEST_F(LiveOptionsOfTheProgram, WhatAFollowedFolderHoldsAlreadyIsNotSentInItsOwnTime) {
  const std::string late = scratch.path("late");
  std::filesystem::create_directories(late);
  for (const int number : {0, 1, 201}) write_cloud(late + "/" + frame_name(number), person_points(0));
  write_text(late + "/done", "");
  OscReceiver engine;  // 200 seconds of it, more than the program's time
  const Finished run = retarget(
      late, {"--follow", "--fps", "1", "--send", "osc://127.0.0.1:" + engine.port(), "--out", out("a.npz")});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_FALSE(engine.heard().empty());
  EXPECT_EQ(read_npz(out("a.npz")).at("joints").shape[0], 202);
}

TEST_F(LiveOptionsOfTheProgram, APortThatTheUserMayNotOpenIsNamedWithTheReason) {
  std::ifstream setting("/proc/sys/net/ipv4/ip_unprivileged_port_start");
  int first = 1024;  // that everybody may open
  setting >> first;
  if (first <= 1) GTEST_SKIP() << "on this system everybody may open every port";
  ProgramOptions nobody;
  nobody.obey_permissions = true;
  const Finished run = run_program(
      {"retarget", "--listen", "tcp://127.0.0.1:1", "--target", target(), "--out", out("a.npz")}, nobody);
  EXPECT_EQ(run.code, 1);
  expect_clean_failure(run, "tcp://127.0.0.1:1: cannot be listened at (Permission denied)");
}

TEST_F(LiveOptionsOfTheProgram, RefusesInOneSentence) {
  const std::string taken = free_port();
  const Descriptor listening = listen_at({"tcp", "127.0.0.1", taken});
  const auto listen = [&](const std::string& address, std::vector<std::string> more = {}) {
    std::vector<std::string> all = {"retarget", "--listen", address,     "--target",
                                    target(),   "--out",    out("a.npz")};
    all.insert(all.end(), more.begin(), more.end());
    return run_program(all);
  };
  expect_clean_failure(listen("tcp://127.0.0.1:" + taken), "Address already in use");
  expect_clean_failure(listen("tcp://127.0.0.1:x"), "needs a port");
  expect_clean_failure(listen("udp://127.0.0.1:9000"), "is no address of the form tcp://HOST:PORT");
  expect_clean_failure(listen("tcp://127.0.0.1:0", {"--wait", "0.2"}), "no frame came within 0.2 s");
  expect_clean_failure(listen("tcp://127.0.0.1:0", {"--person", "all"}), "one person of it");
  expect_clean_failure(listen("tcp://127.0.0.1:0", {"--send", "udp://here"}), "is no address to send to");
  expect_clean_failure(run_program({"measure", "tcp://127.0.0.1:0"}), "is a live stream");
  EXPECT_EQ(run_program({"retarget", "--target", target()}).code, 2);
}

}  // namespace
}  // namespace understudy::tests
