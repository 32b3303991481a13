// --times of the shipped program's commands, good and bad.
#include <fstream>
#include <nlohmann/json.hpp>

#include "retarget/base/text.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class TimesOption : public ShippedProgram {
 protected:
  /// A scan each fifth of a second, and a last one later.
  void SetUp() override {
    std::string text = "frame;seconds\r\n";
    for (int i = 0; i < kFrames; ++i) text += printed("%d;%.1f\r\n", i, 0.2 * (i + (i == kFrames - 1)));
    std::ofstream(times()) << text;
  }
  std::string times() const { return scratch.path("times.csv"); }
};

TEST_F(TimesOption, IsInTheHelp) {
  for (const char* command : {"retarget", "export", "measure"})
    EXPECT_NE(run_program({command, "--help"}).out.find("--times"), std::string::npos) << command;
}

TEST_F(TimesOption, GivesASparseCaptureItsRateAndAPoseForEachFrame) {
  const Finished own = retarget(scans(), {"--times", times(), "--report", out("own.json")});
  ASSERT_EQ(own.code, 0) << own.err;
  EXPECT_NE(own.err.find("times.csv: 5 scans in 1.20 s, 5 frames/s, 1 frame without a scan"),
            std::string::npos)
      << own.err;
  const Finished at_20 = retarget(
      scans(), {"--times", times(), "--fps", "20", "--out", out("a.npz"), "--report", out("20.json")});
  ASSERT_EQ(at_20.code, 0) << at_20.err;
  const Json slow = Json::parse(read_bytes(out("own.json"))), fast = Json::parse(read_bytes(out("20.json")));
  EXPECT_EQ(slow["fps"], 5);
  EXPECT_EQ(slow["frames"], 6);
  EXPECT_EQ(slow["flagged"], 1);
  EXPECT_EQ(fast["fps"], 20);
  EXPECT_EQ(fast["frames"], 21);
  EXPECT_EQ(fast["flagged"], 16);
  EXPECT_EQ(read_npz(out("a.npz")).at("joints").shape, (std::vector<int64_t>{21, 22, 3}));
}

TEST_F(TimesOption, IsTakenByExportAndMeasure) {
  const Finished written = run_program({"export", "--source", scans(), "--target", target(), "--times",
                                        times(), "--format", "npz", "--out", out("a.npz")});
  ASSERT_EQ(written.code, 0) << written.err;
  EXPECT_EQ(read_npz(out("a.npz")).at("joints").shape[0], 6);
  const Finished measured = run_program({"measure", scans(), "--times", times(), "--out", out("m.json")});
  ASSERT_EQ(measured.code, 0) << measured.err;
  EXPECT_EQ(Json::parse(read_bytes(out("m.json")))["frames"], 6);
}

TEST_F(TimesOption, RefusesInOneSentence) {
  expect_clean_failure(retarget(scans(), {"--times", scratch.path("gone.csv"), "--out", out("a.npz")}),
                       "gone.csv");
  expect_clean_failure(retarget(scans(), {"--times", times(), "--follow", "--out", out("a.npz")}),
                       "is still being written (--follow)");
  expect_clean_failure(run_program({"export", "--source", scans(), "--source", scans(), "--target", target(),
                                    "--times", times(), "--out", out("a.glb")}),
                       "--times is of one source, not of 2");
  expect_clean_failure(retarget(scans(), {"--times", times(), "--out", times()}), "is read here");
  std::ofstream(times(), std::ios::app) << "9;0.1\r\n";
  expect_clean_failure(retarget(scans(), {"--times", times(), "--out", out("a.npz")}),
                       "times.csv: line 7: the time falls");
}

}  // namespace
}  // namespace understudy::tests
