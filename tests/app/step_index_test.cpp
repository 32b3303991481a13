// The index of steps in files: what is unchanged is not read again, and nothing that goes wrong loses it.
#include "app/run/step_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"
#include "tests/retarget/motion/made_motion.hpp"
#include "tests/support/plain_coder.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

class StepIndex : public testing::Test {
 protected:
  StepIndex() { fs::create_directories(scratch.path("motions/more")); }

  std::string path(const std::string& name) const { return scratch.path("motions/" + name); }
  std::string write_walk(const std::string& name, size_t frames = 150) {
    Motion walk = builtin_motion("walk", builtin_joints());
    walk.poses.resize(std::min(frames, walk.poses.size()));
    tests::MadeBvh how;
    how.fps = 30;
    tests::write_text(path(name), tests::made_bvh(how, builtin_joints(), walk.poses));
    return path(name);
  }
  std::string write_standing(const std::string& name) {
    Pose pose;
    pose.root = builtin_joints().row(Pelvis);
    tests::MadeBvh how;
    how.fps = 30;
    tests::write_text(path(name), tests::made_bvh(how, builtin_joints(), std::vector<Pose>(60, pose)));
    return path(name);
  }
  /// The walk as AMASS has it; frames from `flagged` on have a flag.
  std::string write_amass(const std::string& name, int flagged = 1000) {
    const Motion walk = builtin_motion("walk", builtin_joints());
    const int64_t count = ssize(walk.poses);
    NpyArray poses{{count, 66}, {}, ""}, trans{{count, 3}, {}, ""}, flags{{count}, {}, ""};
    for (int t = 0; t < count; ++t) {
      const Pose& pose = walk.poses[static_cast<size_t>(t)];
      for (const Mat3& R : pose.local) {
        const Vec3 turn = rotation_to_axis_angle(R);
        poses.values.insert(poses.values.end(), turn.begin(), turn.end());
      }
      trans.values.insert(trans.values.end(), pose.root.begin(), pose.root.end());
      flags.values.push_back(t >= flagged ? 1.0f : 0.0f);
    }
    write_npz(
        path(name),
        {{"poses", poses}, {"trans", trans}, {"mocap_framerate", {{}, {30}, ""}}, {"frame_flags", flags}});
    return path(name);
  }
  IndexedSteps index(const std::vector<std::string>& paths = {}) {
    StepIndexOptions options;
    options.folder = scratch.path("index");
    options.progress = progress;
    MapEncoders encoders([this] { return std::make_shared<tests::PlainCoder>(coder); }, {});
    return index_steps(
        motion_files(paths.empty() ? std::vector<std::string>{scratch.path("motions")} : paths), encoders,
        options);
  }
  std::vector<std::string> entries() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(scratch.path("index")))
      all.push_back(entry.path().string());
    return all;
  }
  static void expect_same(const IndexedSteps& a, const IndexedSteps& b) {
    ASSERT_EQ(a.motions.size(), b.motions.size());
    for (size_t m = 0; m < a.motions.size(); ++m) {
      EXPECT_EQ(a.motions[m].path, b.motions[m].path);
      EXPECT_EQ(a.motions[m].action, b.motions[m].action);
      EXPECT_EQ(a.motions[m].rest, b.motions[m].rest);
      ASSERT_EQ(a.motions[m].steps.size(), b.motions[m].steps.size());
      for (size_t s = 0; s < a.motions[m].steps.size(); ++s) {
        const MappedStep &one = a.motions[m].steps[s], &other = b.motions[m].steps[s];
        EXPECT_EQ(one.first, other.first);
        EXPECT_EQ(one.code, other.code) << "to the bit";
        EXPECT_EQ(one.figure, other.figure);
        EXPECT_EQ(one.seconds, other.seconds);
        EXPECT_EQ(one.left_first, other.left_first);
      }
    }
  }

  tests::ScratchFolder scratch;
  tests::PlainCoder coder;
  std::function<void(int, int)> progress;
};

TEST_F(StepIndex, HoldsTheStepsOfAllMotionsInFoldersOfFolders) {
  write_walk("walk_01.bvh");
  write_walk("more/Walk_02.bvh", 100);
  tests::write_text(path("notes.txt"), "no motion");
  const IndexedSteps all = index();
  ASSERT_EQ(all.motions.size(), 2u);
  EXPECT_EQ(all.motions[0].path, path("more/Walk_02.bvh"));
  EXPECT_EQ(all.motions[1].name, "walk_01.bvh");
  EXPECT_EQ(all.motions[1].action, "walk");
  EXPECT_EQ(all.motions[1].frames, 150);
  EXPECT_GE(all.motions[1].steps.size(), 4u);
  EXPECT_GT(all.motions[1].steps.size(), all.motions[0].steps.size());
  EXPECT_EQ(all.files, 2);
  EXPECT_EQ(all.read, 2);
  EXPECT_EQ(index_words(all).find("2 files, 2 read anew, "), 0u) << index_words(all);
}

TEST_F(StepIndex, TheSameWalkHasTheSameStepsInEveryFormat) {
  write_walk("a.bvh");
  write_amass("b_stroll.npz");
  const IndexedSteps all = index();
  ASSERT_EQ(all.motions.size(), 2u);
  ASSERT_EQ(all.motions[0].steps.size(), all.motions[1].steps.size());
  for (size_t i = 0; i < all.motions[0].steps.size(); ++i) {
    EXPECT_EQ(all.motions[0].steps[i].first, all.motions[1].steps[i].first);
    EXPECT_EQ(all.motions[0].steps[i].last, all.motions[1].steps[i].last);
  }
}

TEST_F(StepIndex, FlaggedFramesAreInNoStep) {
  write_amass("a.npz", 80);
  const IndexedSteps all = index();
  ASSERT_EQ(all.motions.size(), 1u) << index_words(all) << (all.problems.empty() ? "" : all.problems[0]);
  for (const MappedStep& step : all.motions[0].steps) EXPECT_LT(step.last, 80);
}

TEST_F(StepIndex, WhatIsUnchangedIsNotReadAgain) {
  write_walk("a.bvh");
  write_standing("stands.bvh");
  const IndexedSteps first = index(), second = index();
  EXPECT_EQ(first.read, 2);
  EXPECT_EQ(second.read, 0);
  EXPECT_EQ(second.damaged, 0);
  EXPECT_EQ(second.without_steps, std::vector<std::string>{path("stands.bvh")});
  expect_same(first, second);
  ASSERT_EQ(first.others.size(), 1u) << "who stands makes another movement";
  ASSERT_EQ(second.others.size(), 1u);
  EXPECT_EQ(second.others[0].path, path("stands.bvh"));
  EXPECT_EQ(second.others[0].steps.at(0).code, first.others[0].steps.at(0).code);
  EXPECT_NE(index_words(second).find(", 1 other movement"), std::string::npos) << index_words(second);
}

TEST_F(StepIndex, AFileThatWasTouchedIsTheSameAndOneThatHasChangedIsReadAgain) {
  write_walk("a.bvh");
  const IndexedSteps first = index();
  fs::last_write_time(path("a.bvh"), fs::file_time_type::clock::now() + std::chrono::hours(1));
  const IndexedSteps touched = index();
  EXPECT_EQ(touched.read, 0);
  expect_same(first, touched);
  write_walk("a.bvh", 90);
  const IndexedSteps changed = index();
  EXPECT_EQ(changed.read, 1);
  EXPECT_EQ(changed.motions.at(0).frames, 90);
}

TEST_F(StepIndex, AnotherCoderCodesAnew) {
  write_walk("a.bvh");
  index();
  coder = tests::PlainCoder(2);
  const IndexedSteps other = index();
  EXPECT_EQ(other.read, 1);
  EXPECT_NEAR(other.motions.at(0).steps.at(0).code[0], 2 * other.motions[0].steps[0].seconds, 1e-5f);
}

TEST_F(StepIndex, DamagedEntriesAreMadeAgain) {
  write_walk("a.bvh");
  write_walk("b.bvh", 100);
  const IndexedSteps first = index();
  const std::vector<std::string> all = entries();
  ASSERT_EQ(all.size(), 2u);
  std::string text = tests::read_bytes(all[0]);
  for (const std::string& damage :
       {std::string(), text.substr(0, text.size() / 2), std::string("{}"), std::string("[1]"),
        std::string("null"), std::string(R"({"format": "understudy-steps", "version": 99})"),
        std::string(text).replace(text.find("\"code\":[") + 8, 5, "x"),
        std::string(text).replace(text.find("\"figure\":\"") + 12, 1, "x")}) {
    tests::write_text(all[0], damage);
    const IndexedSteps again = index();
    EXPECT_EQ(again.read, 1) << damage.substr(0, 80);
    EXPECT_EQ(again.damaged, 1) << damage.substr(0, 80);
    expect_same(first, again);
    EXPECT_NE(index_words(again).find("1 entry of the index was damaged and is made again"),
              std::string::npos)
        << index_words(again);
  }
}

struct Killed {};

TEST_F(StepIndex, WhatWasReadBeforeAnEndIsNotReadAgain) {
  for (const char* name : {"a.bvh", "b.bvh", "c.bvh"}) write_walk(name, 100);
  progress = [](int done, int) {
    if (done == 2) throw Killed{};
  };
  EXPECT_THROW(index(), Killed);
  progress = {};
  const IndexedSteps all = index();
  EXPECT_EQ(all.read, 1);
  EXPECT_EQ(all.motions.size(), 3u);
}

TEST_F(StepIndex, GoesOnWhereAFileCannotBeRead) {
  write_walk("a.bvh");
  write_walk("z.bvh");
  const std::string whole = tests::read_bytes(path("a.bvh"));
  tests::write_text(path("broken.bvh"), whole.substr(0, whole.size() / 2));
  tests::write_text(path("empty.bvh"), "");
  tests::write_text(path("cut.npz"), "PK");
  const IndexedSteps all = index();
  EXPECT_EQ(all.motions.size(), 2u);
  ASSERT_EQ(all.problems.size(), 3u);
  for (const std::string& problem : all.problems)
    EXPECT_EQ(problem.find(scratch.path("motions/")), 0u) << problem << " names its file";
  EXPECT_EQ(index().problems, all.problems) << "they are tried again";
}

TEST_F(StepIndex, WorksWhereNothingCanBeKept) {
  write_walk("a.bvh");
  tests::write_text(scratch.path("index"), "a file in the folder's place");
  EXPECT_EQ(index().motions.size(), 1u);
  StepIndexOptions none;
  MapEncoders plain({}, {});
  EXPECT_EQ(index_steps(motion_files({path("a.bvh")}), plain, none).read, 1);
}

TEST_F(StepIndex, OfAnEmptyFolderIsEmpty) {
  const IndexedSteps none = index();
  EXPECT_TRUE(none.motions.empty());
  EXPECT_EQ(none.files, 0);
}

TEST_F(StepIndex, RefusesPathsThatAreNotThere) {
  EXPECT_THROW(motion_files({scratch.path("nowhere")}), Error);
  tests::write_text(path("notes.txt"), "no motion");
  EXPECT_THROW(motion_files({path("notes.txt")}), Error);
  EXPECT_THROW(read_file_motions(path("notes.txt")), Error);
  write_walk("a.bvh");
  EXPECT_EQ(motion_files({path("a.bvh"), scratch.path("motions"), path("a.bvh")}).size(), 1u) << "once";
}

TEST_F(StepIndex, KnowsTenThousandClips) {
  write_walk("a.bvh", 60);
  for (int i = 0; i < 10000; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "clip_%05d.bvh", i);
    fs::create_hard_link(path("a.bvh"), path(name));
  }
  fs::remove(path("a.bvh"));
  std::vector<std::string> files = motion_files({scratch.path("motions")});
  ASSERT_EQ(files.size(), 10000u);
  EXPECT_NE(files.front().find("clip_00000"), std::string::npos);
  EXPECT_NE(files.back().find("clip_09999"), std::string::npos);
}

}  // namespace
}  // namespace understudy::app
