#include "app/study/web_study.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "app/study/trial_exports.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "tests/app/program.hpp"
#include "tests/app/study/made_study.hpp"
#include "tests/support/full_disk.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using tests::made_study;
using tests::read_bytes;
using tests::ScratchFolder;

constexpr const char* kPage = US_SOURCE_DIR "/assets/study_web";

class WebStudy : public testing::Test {
 protected:
  WebStudy() : study(made_study(scratch.path("data"))) {
    study.plan.participants = 3;
    options = {kPage, scratch.path("stimuli"), scratch.path("out"), 0};
    fs::create_directories(scratch.path("stimuli/clips"));
    for (const std::string& clip : web_clips(study, 3))
      write_file(options.clips + "/" + clip, "film " + clip);
  }
  std::string path() const { return scratch.path("a.study"); }
  Json data(int participants) const { return parsed(web_data(study, path(), participants)); }
  static Json parsed(const std::string& script) {
    const std::string before = "window.understudyStudy = ", after = ";\n";
    EXPECT_EQ(script.compare(0, before.size(), before), 0) << script.substr(0, 60);
    EXPECT_EQ(script.substr(script.size() - after.size()), after);
    return Json::parse(script.substr(before.size(), script.size() - before.size() - after.size()));
  }
  std::string failure() const {
    return failure_of([&] { write_web_study(study, path(), options); });
  }

  ScratchFolder scratch;
  Study study;
  WebStudyOptions options;
};

TEST_F(WebStudy, HasThePageTheDataAndTheClipsThatAreSeen) {
  write_file(options.clips + "/clips/0123.mp4", "nobody sees it");
  write_web_study(study, path(), options);
  std::set<std::string> wanted = {"data.js", "index.html", "study.css", "study.js"};
  for (const std::string& clip : web_clips(study, 3)) {
    EXPECT_EQ(read_bytes(options.out + "/" + clip), "film " + clip);
    wanted.insert(clip);
  }
  std::set<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(options.out))
    if (entry.is_regular_file()) found.insert(fs::relative(entry.path(), options.out).string());
  EXPECT_EQ(found, wanted);
  for (const char* name : {"index.html", "study.css", "study.js"})
    EXPECT_EQ(read_bytes(options.out + "/" + name), read_bytes(std::string(kPage) + "/" + name));
  EXPECT_EQ(read_bytes(options.out + "/data.js"), web_data(study, path(), 3));
}

TEST_F(WebStudy, HasEveryTrialOfEveryParticipantInItsOrder) {
  study.layout.results = TrialResults::Pair;
  study.plan.repetitions = 2;
  const Json json = data(12);
  ASSERT_EQ(json["participants"].size(), 12u);
  EXPECT_EQ(web_participant(7), "P07");
  EXPECT_EQ(web_participant(112), "P112");
  for (int number = 1; number <= 12; ++number) {
    const Json& order = json["participants"][number - 1];
    const std::vector<Trial> trials = trials_of(study, web_participant(number));
    ASSERT_EQ(order.size(), 2 * trials.size());
    for (size_t i = 0; i < trials.size(); ++i) {
      const Trial& trial = trials[i];
      const Json& screen = json["screens"][order[2 * i].get<size_t>()];
      EXPECT_EQ(screen.size(), 8u);
      EXPECT_EQ(screen[0], trial.id);
      EXPECT_EQ(screen[1], trial.condition);
      EXPECT_EQ(screen[2], trial.other);
      EXPECT_EQ(screen[3], trial.motion);
      EXPECT_EQ(screen[4], trial.target);
      EXPECT_EQ(screen[5], trial.repetition);
      EXPECT_EQ(screen[6], trial.is_practice ? 1 : 0);
      EXPECT_EQ(json["clips"][screen[7].get<size_t>()], clip_path(study, trial));
      EXPECT_EQ(json["asked"][order[2 * i + 1].get<size_t>()], Json(trial.questions));
    }
  }
}

TEST_F(WebStudy, KeepsTextsAsTheyAreAndRightAnswersToItself) {
  study.name = "a <b>study</b> & \"more\"";
  study.questions[0].text = "</script><script>alert('x')</script>\xe2\x80\xa8";
  study.questions[2].right = "jump";
  study.consent = "one\ntwo \\ three";
  const Json json = data(1);
  EXPECT_EQ(json["name"], study.name);
  EXPECT_EQ(json["consent"], study.consent);
  EXPECT_EQ(json["design"], digest_of(study, scratch.path("")));
  EXPECT_EQ(json["background"], "#ededed");
  EXPECT_EQ(json["conditions"], (Json{"copy", "no offsets", "guest"}));
  EXPECT_EQ(json["questions"][0]["text"], study.questions[0].text);
  EXPECT_EQ(json["questions"][0]["points"], 7);
  const Json attention = {{"name", "action"}, {"text", "What is it?"}, {"options", {"walk", "jump"}}};
  EXPECT_EQ(json["questions"][2], attention);
}

TEST_F(WebStudy, HasTheSameBytesAgain) {
  write_web_study(study, path(), options);
  const std::string first = options.out;
  options.out = scratch.path("again");
  write_web_study(study, path(), options);
  write_web_study(study, path(), options);  // over itself
  for (const char* name : {"index.html", "study.css", "study.js", "data.js"})
    EXPECT_EQ(read_bytes(first + "/" + name), read_bytes(options.out + "/" + name)) << name;
}

TEST_F(WebStudy, MayBeMadeInTheFolderOfTheClips) {
  options.out = options.clips;
  write_web_study(study, path(), options);
  const std::string clip = web_clips(study, 3)[0];
  EXPECT_EQ(read_bytes(options.out + "/" + clip), "film " + clip);
}

TEST_F(WebStudy, NamesAClipThatIsMissingAndWhatMakesIt) {
  const std::string clip = options.clips + "/" + web_clips(study, 3)[1];
  fs::resize_file(clip, 0);
  const std::string advice =
      ": make the clips with understudy study stimuli " + path() + " --out " + options.clips;
  EXPECT_EQ(failure(), clip + " is empty" + advice);
  fs::remove(clip);
  EXPECT_EQ(failure(), clip + " is missing" + advice);
  EXPECT_FALSE(fs::exists(options.out));
}

TEST_F(WebStudy, RefusesClipsOfTheStudyBeforeItWasChanged) {
  const Json manifest = {{"design", Json::parse(digest_of(study, scratch.path("")))},
                         {"clips", Json::array()}};
  write_file(options.clips + "/manifest.json", json_text(manifest));
  study.questions.pop_back();
  study.plan.repetitions = 2;
  EXPECT_EQ(failure(), "");  // the clips are the same
  study.motions[0].from_s = 1;
  study.picture.yaw_deg = 0;
  EXPECT_EQ(failure(),
            options.clips + " has clips of the study before it was changed (motion 'walk', picture)" +
                ": make the clips with understudy study stimuli " + path() + " --out " + options.clips);
  write_file(options.clips + "/manifest.json", "[]");
  EXPECT_EQ(failure().find(options.clips + "/manifest.json: is not of clips: make"), 0u) << failure();
}

TEST_F(WebStudy, RefusesADamagedClip) {
  const std::string clip = web_clips(study, 3)[0], path = options.clips + "/" + clip;
  const Json made = {{"file", clip}, {"checksum", checksum_of_file(path)}};
  const Json manifest = {{"design", Json::parse(digest_of(study, scratch.path("")))}, {"clips", {made}}};
  write_file(options.clips + "/manifest.json", json_text(manifest));
  EXPECT_EQ(failure(), "");
  write_file(path, "cut");
  EXPECT_EQ(failure().find(path + " is damaged: make the clips with"), 0u) << failure();
}

TEST_F(WebStudy, NamesAFolderThatCannotBeWritten) {
  write_file(scratch.path("file"), "x");
  options.out = scratch.path("file/out");
  EXPECT_EQ(failure(), options.out + "/clips: cannot be made (Not a directory)");
}

TEST_F(WebStudy, NamesAFileThatFindsNoRoom) {
  const std::string clip = web_clips(study, 3)[0];
  write_file(options.clips + "/" + clip, std::string(100000, 'x'));
  const test::FullDisk full(50000);
  EXPECT_EQ(failure().find(options.out + "/" + clip + ": cannot be written ("), 0u) << failure();
  EXPECT_FALSE(fs::exists(options.out + "/" + clip + ".part"));
  EXPECT_FALSE(fs::exists(options.out + "/data.js"));
}

}  // namespace
}  // namespace understudy::app
