// --listen, --source - and --send of the shipped program: a camera that is none, and what an engine hears.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cmath>
#include <csignal>
#include <map>
#include <sstream>

#include "retarget/formats/npz.hpp"
#include "retarget/live/sent_pose.hpp"
#include "retarget/live/socket.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

std::string free_port(int kind) {
  const Descriptor probe(socket(AF_INET, kind, 0));
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(bind(probe.value(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
  return port_of(probe);
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
  const std::string port = free_port(SOCK_DGRAM);
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
  const std::string port = free_port(SOCK_STREAM);
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

TEST_F(LiveOptionsOfTheProgram, RefusesInOneSentence) {
  const std::string taken = free_port(SOCK_STREAM);
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
