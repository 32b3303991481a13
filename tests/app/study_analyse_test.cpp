#include "app/cli/study_analyse.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/study/answers.hpp"
#include "app/study/trials.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"
#include "tests/app/program.hpp"
#include "tests/app/study/made_study.hpp"

namespace understudy::app {
namespace {

const std::string kData = US_SOURCE_DIR "/tests/data/study/";

/// Runs `study COMMAND` with these words.
int run_study(const char* command, const std::vector<std::string>& words) {
  CLI::App study;
  const auto chosen = std::make_shared<Action>();
  add_study_analyse(study, chosen);
  add_study_power(study, chosen);
  std::vector<std::string> line(words.rbegin(), words.rend());  // CLI11 takes them from the back
  line.emplace_back(command);
  study.parse(line);
  return (*chosen)();
}

class StudyAnalyse : public testing::Test {
 protected:
  static int run(const std::vector<std::string>& words) { return run_study("analyse", words); }
  static std::string complaint_of(const std::vector<std::string>& words) {
    return failure_of([&] { run(words); });
  }
  std::string out(const std::string& name) const { return scratch_.path(name); }
  tests::ScratchFolder scratch_;
};

TEST_F(StudyAnalyse, WritesReportAndPage) {
  ASSERT_EQ(run({"--answers", kData + "exclusions", "--attention", "action=@motion", "--out",
                 out("report.json"), "--page", out("page")}),
            0);
  const auto report = nlohmann::json::parse(tests::read_bytes(out("report.json")));
  EXPECT_EQ(report["excluded"], (nlohmann::json{"E04", "E07", "E11"}));
  EXPECT_NEAR(report["questions"]["shape"]["anova"]["method"]["F"], 14.29060125, 1e-6);
  EXPECT_NE(tests::read_bytes(out("page/index.html")).find("<svg"), std::string::npos);
  EXPECT_NE(tests::read_bytes(out("page/anova.csv")).find("shape,method:motion,"), std::string::npos);
}

TEST_F(StudyAnalyse, TakesScalesFactorsAndTheShareOfAttention) {
  ASSERT_EQ(run({"--answers", kData + "exclusions", "--attention", "action=@motion", "--least-attention",
                 "60", "--question", "shape=1..9", "--factor", "method", "--out", out("report.json")}),
            0);
  const auto report = nlohmann::json::parse(tests::read_bytes(out("report.json")));
  EXPECT_EQ(report["excluded"].size(), 4u);  // E02 too: 5 of 9 right
  EXPECT_EQ(report["factors"], nlohmann::json{"method"});
  EXPECT_EQ(complaint_of({"--answers", kData + "slider", "--question", "naturalness=0..100"}), "");
}

/// A participant's file: "guest" is liked best, "walk" is taken for anything.
std::string answers_to(const Study& study, const std::string& participant) {
  std::string text =
      "participant,trial,question,answer,rt_ms,replays,shown_at,condition,motion,target,practice\n";
  for (const Trial& trial : trials_of(study, participant))
    for (const int q : trial.questions) {
      const char* const answers[] = {trial.condition == 2 ? "6"
                                     : trial.motion == 0  ? "3"
                                                          : "2",
                                     "Child", "walk"};
      for (const std::string& cell :
           {participant, trial.id, study.questions[q].name, std::string(answers[q]), std::string("900"),
            std::string("0"), std::string(), study.conditions[trial.condition].name,
            study.motions[trial.motion].name, study.targets[trial.target].name})
        text += csv_cell(cell) + ",";
      text += trial.is_practice ? "1\n" : "0\n";
    }
  return text;
}

TEST_F(StudyAnalyse, TakesAllFromTheStudyFile) {
  Study study = tests::made_study(out("files"));
  study.plan.least_right = 0;
  write_study(out("small.study"), study);
  std::filesystem::create_directory(out("answers"));
  for (const std::string name : {"P1", "P2", "P3"})
    write_file(out("answers/" + name + ".csv"), answers_to(study, name));
  ASSERT_EQ(run({out("small.study"), "--answers", out("answers"), "--out", out("report.json")}), 0);
  const auto report = nlohmann::json::parse(tests::read_bytes(out("report.json")));
  EXPECT_EQ(report["factors"], (nlohmann::json{"condition", "motion", "target"}));
  EXPECT_EQ(report["questions"]["natural"]["medians"]["condition"]["guest"], 6);
  EXPECT_TRUE(report["questions"].contains("age"));
  EXPECT_FALSE(report["questions"].contains("action"));

  EXPECT_NE(complaint_of({out("small.study"), "--answers", kData + "slider"}).find("no column \"condition\""),
            std::string::npos);
  EXPECT_NE(complaint_of({out("small.study"), "--answers", out("answers"), "--least-attention", "90"})
                .find("no participant is left"),
            std::string::npos);
}

TEST_F(StudyAnalyse, RefusesWhatItCannotRead) {
  EXPECT_NE(complaint_of({"--answers", kData + "slider"}).find("S01.csv: line 2: \""), std::string::npos);
  EXPECT_NE(complaint_of({"--answers", out("none")}).find("is not a folder of answers"), std::string::npos);
  for (const char* question :
       {"naturalness", "naturalness=7", "naturalness=7..1", "naturalness=a..b", "=1..7"})
    EXPECT_NE(complaint_of({"--answers", kData + "slider", "--question", question}).find("--question"),
              std::string::npos)
        << question;
  EXPECT_NE(complaint_of({"--answers", kData + "slider", "--attention", "action"}).find("--attention"),
            std::string::npos);
  EXPECT_THROW(run({"--out", out("report.json")}), CLI::ParseError);
}

std::string power(const std::vector<std::string>& words) {
  testing::internal::CaptureStdout();
  const int code = run_study("power", words);
  return std::to_string(code) + " " + testing::internal::GetCapturedStdout();
}

TEST(StudyPower, IsHighForALargeEffectAndTheLevelForNone) {
  const std::string large = power({"--levels", "3", "3", "--shifts", "1", "0", "-1", "--simulations", "50"});
  EXPECT_EQ(large.substr(0, 26), "0 found in 100.0 % of 50 s") << large;
  const std::string none = power({"--levels", "3", "--simulations", "200", "--level", "0.5"});
  const double share = std::stod(none.substr(std::string("0 found in ").size()));
  EXPECT_GT(share, 35);
  EXPECT_LT(share, 65);
}

TEST(StudyPower, RefusesADesignThatHasNone) {
  EXPECT_NE(failure_of([] {
              run_study("power", {"--levels", "3", "--shifts", "1", "2"});
            }).find("shifts"),
            std::string::npos);
  EXPECT_THROW(run_study("power", {"--levels", "1"}), CLI::ParseError);
  EXPECT_THROW(run_study("power", {"--participants", "1"}), CLI::ParseError);
}

}  // namespace
}  // namespace understudy::app
