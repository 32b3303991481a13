// The page of a study in a real browser, from the first page to the file of answers.
#include <gtest/gtest.h>

#include <filesystem>

#include "app/study/answers.hpp"
#include "app/study/study_analysis.hpp"
#include "app/study/trial_exports.hpp"
#include "app/study/web_study.hpp"
#include "render/video_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "tests/app/program.hpp"
#include "tests/app/study/made_study.hpp"
#include "tests/interop/outside_programs.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using tests::read_bytes;
using tests::ScratchFolder;

constexpr double kTolerance_ms = 20;  ///< a picture of the screen; a clip lasts 500

/// A film of half a second; its grey tells it from others.
void write_clip(const std::string& path, int shade) {
  render::VideoOptions options;
  options.width = options.height = 64;
  render::VideoWriter film(path, options);
  for (int i = 0; i < 15; ++i)
    film.push(render::Image(64, 64, Vec3::Constant(0.1f * static_cast<float>(shade % 10))));
  film.finish();
}

/// A study with names that have to be written with care.
Study small_study() {
  Study study = tests::made_study("/nowhere");
  study.name = "<i>small</i> & \"quoted\"";
  study.consent = "You <b>see</b> clips.\nYou may stop.";
  study.conditions[0].name = "copy, <\"plain\">";
  study.targets.pop_back();
  study.questions[0].text = "How natural & <i>smooth</i> is it?";
  study.questions[1].options = {"An \"adult\", grown", "A <child>"};
  study.plan.break_every = 5;
  study.plan.participants = 4;
  return study;
}

class StudyInABrowser : public testing::Test {
 protected:
  StudyInABrowser() : study(small_study()) {
    fs::create_directories(scratch.path("stimuli/clips"));
    fs::create_directories(scratch.path("downloads"));
    int shade = 0;
    for (const std::string& clip : web_clips(study, 4)) write_clip(scratch.path("stimuli/" + clip), shade++);
    write_web("web");
  }
  void write_web(const std::string& name) {
    write_web_study(study, path(),
                    {US_SOURCE_DIR "/assets/study_web", scratch.path("stimuli"), scratch.path(name), 0});
  }
  std::string path() const { return scratch.path("a.study"); }
  /// What a scene of study_play.mjs saw.
  nlohmann::json played(const std::string& scene, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"chromium", scene, scratch.path("web"), scratch.path("downloads")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    nlohmann::json saw = tests::run_node("browser/study_play.mjs", arguments);
    EXPECT_TRUE(saw["errors"].empty()) << saw["errors"];
    return saw;
  }
  /// Every line of the file is what the participant saw and did, in the order of the study.
  void expect_answers(const std::string& file, const std::string& name, const nlohmann::json& saw);

  ScratchFolder scratch;
  Study study;
};

void StudyInABrowser::expect_answers(const std::string& file, const std::string& name,
                                     const nlohmann::json& saw) {
  std::vector<std::string> factors;
  const ParticipantAnswers read = read_participant(scratch.path("downloads/" + file), factors);
  EXPECT_EQ(factors, trial_factor_names());
  EXPECT_EQ(read.design, digest_of(study, scratch.path("")));
  EXPECT_EQ(read.participant, name);
  const std::vector<Trial> trials = trials_of(study, name);
  ASSERT_EQ(saw["trials"].size(), trials.size());
  size_t row = 0;
  for (size_t t = 0; t < trials.size(); ++t) {
    const nlohmann::json& seen = saw["trials"][t];
    EXPECT_EQ(seen["clip"], clip_path(study, trials[t])) << t;
    ASSERT_EQ(seen["answers"].size(), trials[t].questions.size()) << t;
    for (size_t q = 0; q < trials[t].questions.size(); ++q, ++row) {
      const StudyQuestion& question = study.questions[trials[t].questions[q]];
      EXPECT_EQ(seen["answers"][q]["text"], question.text);
      ASSERT_LT(row, read.answers.size());
      const StudyAnswer& answer = read.answers[row];
      EXPECT_EQ(answer.trial, trials[t].id);
      EXPECT_EQ(answer.question, question.name);
      EXPECT_EQ(answer.answer, seen["answers"][q]["answer"].get<std::string>()) << t << ", " << question.name;
      EXPECT_EQ(answer.replays, seen["replays"]) << t;
      EXPECT_GE(answer.rt_ms, seen["answers"][q]["after_ms"].get<double>() - kTolerance_ms) << t;
      EXPECT_LE(answer.rt_ms, seen["answers"][q]["before_ms"].get<double>() + kTolerance_ms) << t;
      EXPECT_GE(answer.shown_at, seen["shown_after"].get<std::string>()) << t;
      EXPECT_LE(answer.shown_at, seen["shown_before"].get<std::string>()) << t;
      EXPECT_EQ(answer.levels, trial_factors(study, trials[t]));
    }
  }
  EXPECT_EQ(row, read.answers.size());
}

TEST_F(StudyInABrowser, IsAnsweredFromFirstToLastWithAReloadBetween) {
  const auto saw = played("whole", {"P02"});
  expect_answers("P02.csv", "P02", saw);
  EXPECT_EQ(saw["title"], study.name);
  EXPECT_EQ(saw["consent"], "You <b>see</b> clips.\n\nYou may stop.");
  EXPECT_EQ(saw["second_tab"], true);
  EXPECT_EQ(saw["breaks"], 2);
  EXPECT_EQ(saw["places"][0], "Practice 1 of 2");
  EXPECT_EQ(saw["places"][2], "Trial 1 of 12");
  EXPECT_EQ(saw["places"].back(), "Trial 12 of 12");
  EXPECT_EQ(saw["resumed_at"], saw["trials"][saw["reloaded_in"].get<size_t>()]["place"]);
  EXPECT_EQ(saw["names_of_conditions_seen"], false);
  EXPECT_EQ(saw["second_download"], saw["first_download"]);
  const StudyAnswers counted =
      counted_answers(read_answers(scratch.path("downloads")), study, scratch.path(""));
  ASSERT_EQ(counted.participants.size(), 1u);
  EXPECT_FALSE(counted.participants[0].answers.empty());
}

TEST_F(StudyInABrowser, IsServedByAWebServerToo) {
  const auto saw = played("served", {"P03"});
  expect_answers("P03.csv", "P03", saw);
  EXPECT_TRUE(saw["late_clips"].empty()) << saw["late_clips"];
  EXPECT_EQ(saw["second_tab"], true);
}

TEST_F(StudyInABrowser, RefusesAnswersOfAStudyThatHasChanged) {
  study.clip.card_s = 2;
  write_web("changed");
  const auto saw = played("changed", {scratch.path("changed")});
  EXPECT_NE(saw["said"].get<std::string>().find("P01 has answered this study before it was changed (clip)."),
            std::string::npos)
      << saw["said"];
  EXPECT_EQ(saw["after_deletion"], "Practice 1 of 2");
  std::vector<std::string> factors;
  EXPECT_EQ(read_participant(scratch.path("downloads/P01.csv"), factors).answers.size(),
            saw["answered"].get<size_t>());
}

TEST_F(StudyInABrowser, TellsWhatGoesWrong) {
  const std::string missing = clip_path(study, trials_of(study, "P04")[1]);
  fs::rename(scratch.path("web/" + missing), scratch.path("web/away.mp4"));
  const auto saw = played("trouble", {missing});
  EXPECT_EQ(saw["unknown"],
            "The study has no participant \xe2\x80\x9cP05<b>\xe2\x80\x9d: there are P01 to P04.");
  EXPECT_NE(saw["missing_clip"].get<std::string>().find("This clip cannot be played (" + missing +
                                                        "). Please tell the experimenter."),
            std::string::npos)
      << saw["missing_clip"];
  EXPECT_EQ(saw["played_after_all"], true);
  EXPECT_NE(saw["full_store"].get<std::string>().find("store is full"), std::string::npos)
      << saw["full_store"];
  EXPECT_NE(saw["no_store"].get<std::string>().find("keeps nothing"), std::string::npos) << saw["no_store"];
  EXPECT_NE(saw["no_data"].get<std::string>().find("data.js is missing"), std::string::npos);
  std::vector<std::string> factors;
  EXPECT_EQ(read_participant(scratch.path("downloads/P04.csv"), factors).answers.size(),
            saw["answered"].get<size_t>());
}

}  // namespace
}  // namespace understudy::app
