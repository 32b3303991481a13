#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/study/presets.hpp"
#include "app/study/study.hpp"
#include "retarget/base/error.hpp"
#include "retarget/body/builtin_person.hpp"
#include "tests/app/program.hpp"
#include "tests/app/study/made_study.hpp"
#include "tests/retarget/motion/made_motion.hpp"
#include "tests/support/full_disk.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using tests::made_study;
using tests::read_bytes;
using tests::ScratchFolder;

void write_text(const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// A person who stands still for so many frames at 30 a second.
void write_bvh(const std::string& path, int frames) {
  tests::MadeBvh options;
  options.fps = 30;
  Pose still;
  still.root = builtin_joints().row(0);
  write_text(path, tests::made_bvh(options, builtin_joints(), std::vector<Pose>(frames, still)));
}

/// What reading the study says with this put at a JSON pointer; the file's name is taken off.
std::string problem_with(const std::string& pointer, const Json& value) {
  Json json = to_json(made_study("/a"), "/a");
  json[nlohmann::json::json_pointer(pointer)] = value;
  const std::string said = failure_of([&] { study_from_json(json, "/a", "s.study"); });
  if (said.empty()) return said;
  EXPECT_EQ(said.rfind("s.study: ", 0), 0u) << said;
  return said.substr(9);
}

std::string problem_of(const Study& study) {
  return failure_of([&] { check(study); });
}

TEST(StudyFile, GivesBackAllThatWasSaved) {
  ScratchFolder scratch;
  const std::string path = scratch.path("my study ö.study");
  Study study = made_study(scratch.path("data"));
  study.note = "two lines\nof it";
  study.consent = "I agree\nto this.";
  study.layout.panes = {StudyPane::Result, StudyPane::Source};
  study.layout.results = TrialResults::Pair;
  study.clip = {8, "Again", 0.5f, 2};
  study.picture.background = Vec3(0, 0.5f, 1);
  study.plan.order = TrialOrder::LatinSquare;
  study.plan.least_right = 0.75f;
  write_study(path, study);
  EXPECT_TRUE(same(read_study(path), study));
  EXPECT_EQ(scratch.files().size(), 1u);
}

TEST(StudyFile, WithoutAConsentHasTheUsualOne) {
  Json json = to_json(made_study("/a"), "/a");
  json.erase("consent");
  EXPECT_EQ(study_from_json(json, "/a", "s.study").consent, kConsent);
  json["consent"] = "";
  EXPECT_EQ(study_from_json(json, "/a", "s.study").consent, "");
}

TEST(StudyFile, MovesWithItsFiles) {
  ScratchFolder scratch;
  const Study study = made_study(scratch.path("a/data"));
  fs::create_directories(scratch.path("a"));
  write_study(scratch.path("a/s.study"), study);
  EXPECT_EQ(read_bytes(scratch.path("a/s.study")).find(scratch.path("a")), std::string::npos);
  fs::rename(scratch.path("a"), scratch.path("b"));
  const Study moved = read_study(scratch.path("b/s.study"));
  EXPECT_TRUE(same(moved, made_study(scratch.path("b/data"))));
  EXPECT_EQ(digest_of(moved, scratch.path("b")), digest_of(study, scratch.path("a")));
}

TEST(StudyFile, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(problem_with("/plan/repetition", 2).substr(0, 34), "plan.repetition is not known, thes");
  EXPECT_NE(problem_with("/plan/repetition", 2).find("repetitions"), std::string::npos);
  EXPECT_EQ(problem_with("/conditions/0/methods", 2).find("conditions[0].methods is not known"), 0u);
  EXPECT_EQ(problem_with("/conditions/1/method/colour", 2).find("conditions[1].method.colour is not"), 0u);
  EXPECT_EQ(problem_with("/question", 2).find("question is not known"), 0u);
  EXPECT_EQ(problem_with("/note", "a note"), "");
}

TEST(StudyFile, NamesTheNumberThatIsOutOfRange) {
  EXPECT_EQ(problem_with("/clip/seconds", 0), "clip.seconds must be a finite number from 0.5 to 600");
  EXPECT_EQ(problem_with("/plan/repetitions", 1.5), "plan.repetitions must be a whole number from 1 to 1000");
  EXPECT_EQ(problem_with("/questions/0/points", 1),
            "questions[0].points must be a whole number from 2 to 11");
  EXPECT_EQ(problem_with("/plan/least_right", 1.2), "plan.least_right must be a finite number from 0 to 1");
  EXPECT_EQ(problem_with("/picture/background", Json{0, 0, 2}),
            "picture.background must be three numbers from 0 to 1");
  EXPECT_EQ(problem_with("/plan/order", "sorted"), "plan.order must be random or latin-square");
  Study study = made_study("/a");
  study.clip.speed = 0;
  EXPECT_NE(failure_of([&] { to_json(study, "/a"); }).find("clip.speed is 0"), std::string::npos);
}

TEST(StudyFile, RefusesOtherFilesAndNewerOnes) {
  EXPECT_EQ(problem_with("/version", kStudyVersion + 1),
            "was saved by a newer Understudy (version 2 of studies, this program knows 1)");
  EXPECT_EQ(problem_with("/format", "understudy document"), "is not an Understudy study");
  ScratchFolder scratch;
  const std::string path = scratch.path("s.study");
  EXPECT_NE(failure_of([&] { read_study(path); }).find("s.study"), std::string::npos);
  write_text(path, "");
  EXPECT_EQ(failure_of([&] { read_study(path); }), path + ": is empty");
}

TEST(StudyFile, IsRefusedWhereverItIsCut) {
  ScratchFolder scratch;
  const std::string path = scratch.path("s.study");
  write_study(path, made_study(scratch.path("data")));
  const std::string whole = read_bytes(path);
  for (size_t size = 1; size + 2 < whole.size(); size += 97) {
    write_text(path, whole.substr(0, size));
    EXPECT_NE(failure_of([&] { read_study(path); }).find(path + ": is damaged at byte"), std::string::npos)
        << size;
  }
}

TEST(StudyFile, SurvivesAFullDisk) {
  ScratchFolder scratch;
  const std::string path = scratch.path("s.study");
  Study study = made_study(scratch.path("data"));
  write_study(path, study);
  study.name = "changed";
  {
    const test::FullDisk disk(100);
    EXPECT_NE(failure_of([&] { write_study(path, study); }).find(path), std::string::npos);
  }
  EXPECT_EQ(read_study(path).name, "small");
  EXPECT_EQ(scratch.files().size(), 1u);
}

TEST(StudyCheck, ComparesAtLeastTwoConditions) {
  Study study = made_study("/a");
  EXPECT_EQ(problem_of(study), "");
  study.conditions.resize(1);
  EXPECT_EQ(problem_of(study), "the study has one condition: it needs two to compare");
  study.conditions.clear();
  EXPECT_EQ(problem_of(study), "the study has no condition");
}

TEST(StudyCheck, WantsNamesOnce) {
  Study study = made_study("/a");
  study.targets[2].name = "tall";
  EXPECT_EQ(problem_of(study), "there are two of target 'tall'");
  study.targets[2].name = "";
  EXPECT_EQ(problem_of(study), "a target has no name");
  study.targets[2].name = "a\nb";
  EXPECT_NE(problem_of(study).find("control character"), std::string::npos);
}

TEST(StudyCheck, WantsOptionsOnOneLine) {
  Study study = made_study("/a");
  study.questions[1].options = {"Adult", "Child\n"};
  EXPECT_EQ(problem_of(study), "question 'age' has an option with a line end or another control character");
}

TEST(StudyCheck, WantsAFileForEveryTrialOfACondition) {
  Study study = made_study("/a");
  study.conditions[2].files.pop_back();
  EXPECT_EQ(problem_of(study), "condition 'guest' has no file for motion 'jump' on target 'short'");
  study.conditions[2].files.push_back({"run", "", "/a/run.bvh"});
  EXPECT_EQ(problem_of(study),
            "condition 'guest' has a file for motion 'run', which the study does not have");
}

TEST(StudyCheck, TakesTheFileThatIsNamedClosest) {
  Study study = made_study("/a");
  Condition& guest = study.conditions[2];
  guest.files.insert(guest.files.begin(), {"", "", "/a/any.bvh"});
  guest.files.push_back({"walk", "child", "/a/walk_child.bvh"});
  EXPECT_EQ(file_for(guest, study.motions[0], study.targets[2])->path, "/a/walk_child.bvh");
  EXPECT_EQ(file_for(guest, study.motions[0], study.targets[1])->path, "/a/walk.bvh");
  EXPECT_EQ(file_for(study.conditions[0], study.motions[0], study.targets[1]), nullptr);
}

TEST(StudyCheck, WantsQuestionsThatCanBeAnswered) {
  Study study = made_study("/a");
  study.questions[0].high.clear();
  EXPECT_EQ(problem_of(study), "question 'natural' needs a label at both ends of its scale");
  study = made_study("/a");
  study.questions[1].options = {"Adult"};
  EXPECT_EQ(problem_of(study), "question 'age' needs at least two options");
  study.questions[1].options = {"Adult", "Adult"};
  EXPECT_EQ(problem_of(study), "question 'age' has an option twice");
  study = made_study("/a");
  study.motions[1].action = "leap";
  EXPECT_EQ(problem_of(study), "question 'action': the right answer 'leap' is not among its options");
  study.questions[2].right = "walk";
  EXPECT_EQ(problem_of(study), "");
  study.conditions[1].method.engine = "magic";
  EXPECT_EQ(problem_of(study).find("condition 'no offsets': there is no engine 'magic'"), 0u);
}

TEST(StudyCheck, WantsOneResultInTheLayout) {
  Study study = made_study("/a");
  study.layout.panes = {StudyPane::Source};
  EXPECT_EQ(problem_of(study), "the layout has no pane of the result");
  study.layout.panes = {StudyPane::Result, StudyPane::Result};
  EXPECT_EQ(problem_of(study), "the layout has a pane twice");
}

TEST(StudyCheck, RefusesMoreTrialsThanAnybodyCouldList) {
  Study study = made_study("/a");
  study.plan.repetitions = 1000;
  EXPECT_EQ(problem_of(study), "");
  for (int i = 0; i < 20; ++i) {
    study.targets.push_back(study.targets[0]);
    study.targets.back().name = std::to_string(i);
  }
  study.conditions.pop_back();
  for (int i = 0; i < 2; ++i) study.conditions.push_back({std::to_string(i), {}, {}, {}});
  EXPECT_EQ(problem_of(study), "the study has 184000 trials, 100000 at most are possible");
  study.layout.results = TrialResults::Pair;
  EXPECT_EQ(problem_of(study), "the study has 276000 trials, 100000 at most are possible");
}

class StudyFiles : public testing::Test {
 protected:
  StudyFiles() : study(made_study(scratch.path("data"))) {
    for (const char* name : {"walk.bvh", "tall.bvh", "jump.bvh"}) write_bvh(scratch.path("data/") + name, 45);
    for (const char* name : {"tall.glb", "short.glb", "child.glb"})
      write_text(scratch.path("data/") + name, "x");
    study.motions[0].source.path = scratch.path("data/walk.bvh");
  }
  ScratchFolder scratch;
  Study study;
};

TEST_F(StudyFiles, ThatAreGoneAreNamedWithWhoNeedsThem) {
  EXPECT_EQ(failure_of([&] { check_files(study); }), "");
  fs::remove(scratch.path("data/short.glb"));
  EXPECT_EQ(failure_of([&] { check_files(study); }),
            "target 'short': " + scratch.path("data/short.glb") + " is gone");
  fs::remove(scratch.path("data/tall.bvh"));
  EXPECT_EQ(failure_of([&] { check_files(study); }),
            "condition 'guest': " + scratch.path("data/tall.bvh") + " is gone");
}

TEST_F(StudyFiles, AreAsLongAsTheirMotion) {
  EXPECT_EQ(failure_of([&] { check_lengths(study); }), "");
  write_bvh(scratch.path("data/tall.bvh"), 90);
  EXPECT_EQ(failure_of([&] { check_lengths(study); }),
            "condition 'guest', motion 'jump', target 'tall': tall.bvh lasts 3.00 s, the motion 1.50 s; the "
            "clips of a trial must be equally long");
}

TEST_F(StudyFiles, AreMeasuredAgainstThePartOfTheMotionThatIsShown) {
  study.motions[1].seconds = 0.5f;
  const std::string said = failure_of([&] { check_lengths(study); });
  EXPECT_EQ(said,
            "condition 'guest', motion 'jump', target 'tall': tall.bvh lasts 1.50 s, the motion 0.50 s; the "
            "clips of a trial must be equally long");
  study.motions[1].from_s = 2;
  EXPECT_EQ(failure_of([&] { check_lengths(study); }),
            "motion 'jump' starts at 2.00 s, its source lasts 1.50 s");
}

TEST_F(StudyFiles, OfScansHaveTheRateOfTheMotion) {
  const std::string folder = scratch.path("data/frames");
  study.conditions[2].files = {{"", "", folder}};
  study.motions.pop_back();
  for (int i = 0; i < 45; ++i) write_text(folder + "/" + std::to_string(i) + ".xyz", "0 0 0\n0 1 0\n");
  EXPECT_EQ(failure_of([&] { check_lengths(study); }), "");
  for (int i = 0; i < 20; ++i) fs::remove(folder + "/" + std::to_string(i) + ".xyz");
  EXPECT_NE(failure_of([&] { check_lengths(study); }).find("frames lasts 0.83 s, the motion 1.50 s"),
            std::string::npos);
}

TEST(StudyDigest, SaysWhatChanged) {
  const Study before = made_study("/a/data");
  const std::string digest = digest_of(before, "/a");
  EXPECT_EQ(changes_since(digest, before, "/a"), "");
  Study now = before;
  now.conditions[1].method.lock_feet = false;
  now.motions[0].from_s = 1;
  now.targets.pop_back();
  now.questions.push_back(now.questions[0]);
  now.questions.back().name = "smooth";
  now.clip.seconds = 5;
  now.plan.seed = 2;
  EXPECT_EQ(
      changes_since(digest, now, "/a"),
      "condition 'no offsets', motion 'walk', question 'smooth' is new, clip, plan, target 'child' is gone");
}

TEST(StudyDigest, AllowsWhatAnswersDoNotDependOn) {
  const Study before = made_study("/a/data");
  Study now = before;
  now.name = "other", now.note = "more", now.consent = "I agree.";
  now.plan.participants = 60, now.plan.break_every = 5, now.plan.least_right = 0.8f;
  EXPECT_EQ(changes_since(digest_of(before, "/a"), now, "/a"), "");
}

TEST(StudyDigest, SeesAnotherOrderOfConditions) {
  const Study before = made_study("/a/data");
  Study now = before;
  std::swap(now.conditions[0], now.conditions[1]);
  EXPECT_EQ(changes_since(digest_of(before, "/a"), now, "/a"),
            "the order of conditions, motions, targets or questions");
  EXPECT_NE(failure_of([&] { changes_since("{", now, "/a"); }).find("no digest"), std::string::npos);
}

TEST(StudyPresets, AreThoseOfThePapers) {
  const std::string samples = US_SOURCE_DIR "/assets/samples";
  for (const StudyPreset& preset : study_presets()) {
    const Study study = preset.make(samples);
    EXPECT_EQ(study.name, preset.label);
    EXPECT_EQ(problem_of(study), "");
    EXPECT_EQ(failure_of([&] { check_files(study), check_lengths(study); }), "");
    EXPECT_TRUE(same(study_from_json(to_json(study, "/"), "/", "x"), study));
  }
  const Study rekik = study_preset("rekik").make(samples);
  EXPECT_EQ(rekik.conditions.size(), 3u);
  EXPECT_EQ(rekik.motions.size(), 3u);
  EXPECT_EQ(rekik.targets.size(), 5u);
  EXPECT_EQ(rekik.questions.size(), 2u);
  EXPECT_EQ(rekik.questions[0].points, 7);
  const Study dong = study_preset("dong").make(samples);
  EXPECT_EQ(dong.conditions.size(), 5u);
  EXPECT_EQ(dong.clip.seconds, 10);
  EXPECT_EQ(right_answer(dong.questions[2], dong.motions[1]), "Dancing");
  EXPECT_NE(failure_of([] { study_preset("lee"); }).find("rekik, dong"), std::string::npos);
}

}  // namespace
}  // namespace understudy::app
