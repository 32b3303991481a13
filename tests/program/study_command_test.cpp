// `understudy study`: new studies and lists of trials.
#include <nlohmann/json.hpp>

#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using StudyCommand = ShippedProgram;
using Json = nlohmann::json;

TEST_F(StudyCommand, MakesThePresetsAndListsTheirTrials) {
  for (const auto& [preset, trials] : {std::pair{"rekik", 45}, std::pair{"dong", 50}}) {
    const std::string file = scratch.path(std::string(preset) + ".study");
    const Finished made = run_program({"study", "new", "--preset", preset, "--out", file});
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.out.find(std::to_string(trials) + " trials and"), std::string::npos) << made.out;
    expect_clean_failure(run_program({"study", "new", "--preset", preset, "--out", file}),
                         file + ": is there already");
    const Finished listed = run_program({"study", "trials", file});
    ASSERT_EQ(listed.code, 0) << listed.err;
    EXPECT_EQ(line_count(listed.out), trials + 1) << listed.out;
  }
}

TEST_F(StudyCommand, WritesAParticipantsTrialsForOtherRunners) {
  const std::string file = scratch.path("a.study");
  ASSERT_EQ(run_program({"study", "new", "--preset", "dong", "--out", file}).code, 0);
  for (const char* format : {"table", "csv", "jspsych", "psychopy"}) {
    const Finished run = run_program(
        {"study", "trials", file, "--participant", "P3", "--format", format, "--out", out(format)});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find("50 trials and 2 of practice, about"), std::string::npos) << run.err;
  }
  EXPECT_EQ(line_count(read_bytes(out("table"))), 53);
  EXPECT_EQ(read_bytes(out("csv")).rfind("position,trial,practice,", 0), 0u);
  EXPECT_EQ(read_bytes(out("psychopy")).rfind("trial,practice,clip,", 0), 0u);
  EXPECT_EQ(Json::parse(read_bytes(out("jspsych")))["timeline"].size(), 52u * 4 + 4);
  const Finished again = run_program({"study", "trials", file, "--participant", "P3", "--format", "csv"});
  EXPECT_EQ(again.out, read_bytes(out("csv")));
  const Finished other = run_program({"study", "trials", file, "--participant", "P4", "--format", "csv"});
  EXPECT_NE(other.out, again.out);
}

TEST_F(StudyCommand, WritesAFolderForBrowsers) {
  const std::string file = scratch.path("a.study"), made = scratch.path("made");
  ASSERT_EQ(run_program({"study", "new", "--preset", "dong", "--out", file}).code, 0);
  const std::vector<std::string> command = {"study", "web",   file,       "--clips",
                                            made,    "--out", out("web"), "--participants"};
  const auto web = [&](const std::string& participants) {
    std::vector<std::string> all = command;
    all.push_back(participants);
    return run_program(all);
  };
  expect_clean_failure(web("2"), "make the clips with understudy study stimuli " + file + " --out " + made);
  EXPECT_EQ(web("0").code, 2);
  const Finished listed = run_program({"study", "trials", file, "--format", "csv"});
  std::filesystem::create_directories(made + "/clips");
  for (size_t at = 0; (at = listed.out.find("clips/", at)) != std::string::npos; ++at)
    write_text(made + "/" + listed.out.substr(at, std::string("clips/0123456789abcdef.mp4").size()), "film");
  const Finished run = web("12");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out, out("web") + "/index.html: participants P01 to P12, 50 trials each\n");
  for (const char* name : {"/index.html", "/study.js", "/study.css", "/data.js"})
    EXPECT_GT(read_bytes(out("web") + name).size(), 0u) << name;
}

TEST_F(StudyCommand, RefusesWhatIsNoStudyOrHasLostAFile) {
  const std::string file = scratch.path("a.study");
  write_text(file, "{\"format\": \"understudy document\"}");
  expect_clean_failure(run_program({"study", "trials", file}), "is not an Understudy study");
  std::filesystem::remove(file);
  ASSERT_EQ(run_program({"study", "new", "--preset", "rekik", "--out", file}).code, 0);
  Json json = Json::parse(read_bytes(file));
  json["conditions"][1] = {{"name", "H4D"},
                           {"kind", "files"},
                           {"files", Json::array({{{"motion", ""}, {"target", ""}, {"path", "h4d.glb"}}})}};
  write_text(file, json.dump());
  expect_clean_failure(run_program({"study", "trials", file, "--out", out("list.txt")}),
                       "condition 'H4D': " + scratch.path("h4d.glb") + " is gone");
  EXPECT_EQ(run_program({"study", "trials", file, "--without-files"}).code, 0);
}

TEST_F(StudyCommand, RefusesUnknownPresetsAndFormats) {
  const Finished help = run_program({"study", "--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("trials"), std::string::npos);
  EXPECT_EQ(run_program({"study"}).code, 2);
  EXPECT_EQ(run_program({"study", "new", "--preset", "lee", "--out", scratch.path("a")}).code, 2);
  EXPECT_EQ(run_program({"study", "trials", "a.study", "--format", "xml"}).code, 2);
  expect_clean_failure(run_program({"study", "trials", scratch.path("none.study")}), "none.study");
  expect_clean_failure(
      run_program({"study", "new", "--preset", "rekik", "--out", scratch.path("no/folder/a.study")}),
      "a.study");
}

}  // namespace
}  // namespace understudy::tests
