// Styles that are taught from recordings, kept beside the settings, given to takes and forgotten.
#include <cmath>
#include <fstream>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/formats/motion_writers.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

/// With the arms held 30 degrees higher, and half as much again of their movements.
Motion with_wide_arms(Motion motion) {
  const std::vector<Pose> before = motion.poses;
  for (size_t t = 0; t < before.size(); ++t)
    for (const int j : {LeftShoulder, RightShoulder}) {
      const Mat3& first = before[0].local[j];
      const Vec3 moved = rotation_to_axis_angle(first.transpose() * before[t].local[j]);
      const Vec3 raised(0, 0, (j == LeftShoulder ? 30 : -30) * kPi / 180);
      motion.poses[t].local[j] =
          rotation_from_axis_angle(raised) * first * rotation_from_axis_angle(1.5f * moved);
    }
  return motion;
}

class TeachingTest : public StudioTest {
 protected:
  void SetUp() override {
    StudioTest::SetUp();
    for (int i = 0; i < 3; ++i) write_recording("plain", i, false), write_recording("wide", i, true);
    studio.emplace(with_settings());
    open_walk(*studio);
  }
  void TearDown() override {
    studio.reset();
    StudioTest::TearDown();
  }
  StudioServices with_settings() {
    StudioServices all = services();
    all.settings_file = path("config/settings.json");
    return all;
  }
  /// Part of a walk or a dance, in a folder.
  void write_recording(const std::string& folder, int i, bool wide) {
    Motion motion = builtin_motion(i % 3 == 2 ? "dance" : "walk", human_rest());
    motion.poses.erase(motion.poses.begin(), motion.poses.begin() + 20 * (i % 3));
    motion.poses.resize(90);
    if (wide) motion = with_wide_arms(motion);
    fs::create_directories(path(folder));
    BvhWriter writer(path(folder) + "/" + std::to_string(i) + ".bvh", human_rest(), motion.fps);
    for (const Pose& pose : motion.poses) writer.push(pose);
    writer.finish();
  }
  const StyleChoice& style() const { return studio->session().document.takes[0].method.style; }
  const Motion& shown() const { return studio->session().takes[0].shown; }
  /// Between the wrists, mean over frames, metres.
  double wrists_apart() const {
    double sum = 0;
    const auto& frames = studio->session().takes[0].joints;
    for (const Joints& joints : frames)
      sum += std::abs(static_cast<double>(joints(LeftWrist, 0) - joints(RightWrist, 0)));
    return sum / static_cast<double>(frames.size());
  }
  std::string file(const std::string& name) const { return path("config/styles/" + name + ".json"); }
  void teach(const Arguments& more = {}, const std::string& from = "plain", const std::string& to = "wide") {
    Arguments arguments = {path(from), path(to), "wide arms"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    studio->try_run("style.teach", arguments);
    studio->wait_idle();
  }
  /// Its sentence; nothing is left behind.
  std::string refused(const Arguments& arguments) {
    studio->try_run("style.teach", arguments);
    studio->wait_idle();
    auto& errors = studio->session().errors;
    EXPECT_EQ(errors.size(), 1u);
    EXPECT_FALSE(fs::exists(path("config/styles")));
    EXPECT_TRUE(studio->session().styles.taught.empty());
    EXPECT_TRUE(style().called().empty());
    const std::string sentence = errors.empty() ? "" : errors.front().text;
    errors.clear();
    return sentence;
  }

  std::optional<Studio> studio;
};

TEST_F(TeachingTest, AStyleIsKeptListedAndPerformedAndUndone) {
  const Motion before = shown();
  const double apart = wrists_apart();
  teach({"made_from=an actor", "licence=CC BY-NC 4.0", "attribution=(c) Somebody"});
  ASSERT_TRUE(studio->session().errors.empty()) << studio->session().errors.front().text;
  EXPECT_EQ(style().file, file("wide arms"));
  const auto& taught = studio->session().styles.taught;
  ASSERT_EQ(taught.size(), 1u);
  EXPECT_EQ(taught[0].note.label, "wide arms");
  EXPECT_EQ(taught[0].note.made_from, "an actor");
  EXPECT_TRUE(taught[0].note.non_commercial());
  EXPECT_EQ(studio->session().takes[0].rights,
            "Performed in the style wide arms, CC BY-NC 4.0 (non-commercial), (c) Somebody");
  EXPECT_FALSE(same_poses(shown(), before));
  EXPECT_GT(wrists_apart(), apart + 0.15);
  ASSERT_FALSE(studio->session().notices.empty());
  EXPECT_EQ(studio->session().notices.back().text,
            "The style 'wide arms' was fitted to 3 recordings of wide and 3 of plain");
  studio->run("edit.undo");
  studio->wait_idle();
  EXPECT_TRUE(style().called().empty());
  EXPECT_TRUE(same_poses(shown(), before));
  EXPECT_EQ(taught.size(), 1u) << "undo is of the document";
}

TEST_F(TeachingTest, TheNextStartListsItAndADocumentHasIt) {
  teach();
  studio->run("document.save_as", {path("mine.understudy")});
  studio.reset();
  studio.emplace(with_settings());
  EXPECT_NE(taught_style(studio->session().styles, "wide arms"), nullptr);
  studio->run("document.open", {path("mine.understudy")});
  studio->wait_idle();
  EXPECT_EQ(style().file, file("wide arms"));
  EXPECT_TRUE(studio->session().takes[0].problem.empty());
}

TEST_F(TeachingTest, ATaughtStyleIsReplacedOnlyWhereThatIsSaid) {
  teach();
  const double wide = wrists_apart();
  teach({}, "wide", "plain");
  ASSERT_EQ(studio->session().errors.size(), 1u);
  EXPECT_EQ(studio->session().errors[0].text, "there is a style 'wide arms' already: replace=1 replaces it");
  studio->session().errors.clear();
  teach({"replace=1"}, "wide", "plain");
  EXPECT_TRUE(studio->session().errors.empty());
  EXPECT_LT(wrists_apart(), wide - 0.15) << "takes that have it perform in the new one";
  EXPECT_EQ(studio->session().styles.taught.size(), 1u);
}

TEST_F(TeachingTest, ItIsForgottenOnceNoTakeHasIt) {
  teach();
  const auto forget = [&](const std::string& name) {
    return failure_of([&] { studio->run("style.forget", {name}); });
  };
  EXPECT_EQ(forget("wide arms"), "target has the style wide arms: it needs another one first");
  EXPECT_EQ(forget("child"), "no style 'child' was taught here");
  EXPECT_TRUE(fs::exists(file("wide arms")));
  studio->run("method.style", {"0", "none"});
  EXPECT_EQ(forget("wide arms"), "");
  EXPECT_FALSE(fs::exists(file("wide arms")));
  EXPECT_TRUE(studio->session().styles.taught.empty());
}

TEST_F(TeachingTest, WhatWasForgottenLastIsBroughtBack) {
  const auto restore = [&](const std::string& name) {
    return failure_of([&] { studio->run("style.restore", {name}); });
  };
  EXPECT_EQ(restore("wide arms"), "the style 'wide arms' was not forgotten last");
  teach();
  const Motion wide = shown();
  const std::string text = read_file(file("wide arms"));
  studio->run("method.style", {"0", "none"});
  studio->wait_idle();
  studio->run("style.forget", {"wide arms"});
  const Notice& notice = studio->session().notices.back();
  EXPECT_EQ(notice.text, "The style 'wide arms' was forgotten");
  EXPECT_EQ(notice.offer.label, "Undo");
  EXPECT_EQ(notice.offer.command, "style.restore \"wide arms\"");
  studio->run("edit.undo");  // the take has it again, and there is none
  studio->wait_idle();
  EXPECT_NE(studio->session().takes[0].problem.find("there is no such file"), std::string::npos);
  EXPECT_EQ(restore("wide arms"), "");
  studio->wait_idle();
  EXPECT_EQ(read_file(file("wide arms")), text);
  EXPECT_NE(taught_style(studio->session().styles, "wide arms"), nullptr);
  EXPECT_TRUE(studio->session().takes[0].problem.empty()) << "it performs in it again";
  EXPECT_TRUE(same_poses(shown(), wide));
  EXPECT_NE(restore("wide arms"), "") << "once";
}

TEST_F(TeachingTest, AForgottenStyleDoesNotReplaceANewOne) {
  teach();
  studio->run("method.style", {"0", "none"});
  studio->run("style.forget", {"wide arms"});
  teach();
  EXPECT_EQ(failure_of([&] { studio->run("style.restore", {"wide arms"}); }),
            "there is another style 'wide arms' by now");
}

TEST_F(TeachingTest, JointsThatAreLeftOutStayTheSources) {
  teach({"joints=upper-body"});
  std::ifstream text(file("wide arms"));
  const std::string style{std::istreambuf_iterator<char>(text), {}};
  EXPECT_NE(style.find("left_shoulder"), std::string::npos);
  EXPECT_EQ(style.find("left_knee"), std::string::npos);
}

TEST_F(TeachingTest, FoldersThatTeachNothingAreRefusedInASentence) {
  const std::string plain = path("plain"), wide = path("wide");
  EXPECT_EQ(refused({plain, plain, "x"}), plain + ": is the other manner again");
  EXPECT_EQ(refused({plain, path("absent"), "x"}),
            path("absent") + ": there is no such folder of recordings");
  fs::create_directories(path("empty"));
  EXPECT_NE(refused({plain, path("empty"), "x"}).find("empty: holds no skeletal motion"), std::string::npos);
  write_recording("one", 0, true);
  EXPECT_EQ(refused({plain, path("one"), "x"}),
            path("one") + ": holds one recording that can be used; a manner of moving needs several");
  std::ofstream(path("one") + "/broken.bvh") << "HIERARCHY\nnothing";
  EXPECT_NE(refused({plain, path("one"), "x"}).find("holds one recording"), std::string::npos);
  EXPECT_NE(refused({path("."), wide, "x"}).find("holds the recordings of the other manner, too"),
            std::string::npos);
}

TEST_F(TeachingTest, NamesAndSettingsThatAreNoneAreRefused) {
  const std::string plain = path("plain"), wide = path("wide");
  for (const char* const name : {"a/b", "..", " x", "x ", "x.json", "a\nb"})
    EXPECT_NE(refused({plain, wide, name}).find("does not fit"), std::string::npos) << name;
  EXPECT_EQ(refused({plain, wide, ""}), "a style needs a name");
  EXPECT_NE(refused({plain, wide, std::string(61, 'x')}).find("at most 60"), std::string::npos);
  EXPECT_NE(
      refused({plain, wide, "Child"}).find("'Child' is the name of a style that comes with the program"),
      std::string::npos);
  EXPECT_NE(refused({plain, wide, "x", "joints=ears"}).find("joints is one of"), std::string::npos);
  EXPECT_NE(refused({plain, wide, "x", "speed=2"}).find("not speed"), std::string::npos);
  EXPECT_NE(refused({plain, wide, "x", "all"}).find("is written as"), std::string::npos);
  EXPECT_NE(refused({plain, wide, "x", "licence="}).find("licence"), std::string::npos);
  EXPECT_EQ(refused({plain, wide}), "a name is missing");
}

TEST_F(TeachingTest, WithoutSettingsNoneIsKept) {
  Studio forgetful(services());
  EXPECT_NE(failure_of([&] {
              forgetful.run("style.teach", {path("plain"), path("wide"), "x"});
            }).find("no settings are kept here"),
            std::string::npos);
}

TEST_F(TeachingTest, CancelledInTheMiddleNothingIsLeft) {
  for (int i = 3; i < 60; ++i) write_recording("plain", i, false);
  studio->try_run("style.teach", {path("plain"), path("wide"), "x"});
  const std::string again = failure_of([&] {
    studio->run("style.teach", {path("plain"), path("wide"), "y"});
  });
  EXPECT_EQ(again, "a style is being taught already");
  const auto job = [&] {
    studio->tick(0.01);
    for (const JobView& one : studio->session().jobs)
      if (one.id == studio->session().styles.job) return one;
    return JobView{};
  };
  JobView seen = job();
  while (seen.id != 0 && seen.progress <= 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    seen = job();
  }
  ASSERT_NE(seen.id, 0) << "it was over before it could be cancelled";
  EXPECT_NE(seen.doing.find(" of 63"), std::string::npos) << seen.doing;
  studio->run("job.cancel", {std::to_string(seen.id)});
  studio->wait_idle();
  EXPECT_TRUE(studio->session().errors.empty());
  EXPECT_FALSE(fs::exists(path("config/styles")));
  EXPECT_TRUE(style().called().empty());
}

}  // namespace
}  // namespace understudy::app
