#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "tests/app/program.hpp"
#include "tests/session/full_document.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;

class AutosaveTest : public testing::Test {
 protected:
  AutosaveTest() {
    sink_ = log::set_sink([this](log::Level, const std::string& message) { told_.push_back(message); });
  }
  ~AutosaveTest() override { log::set_sink(sink_); }

  /// A process that saves its work and is killed. Gives its number.
  pid_t killed_process() const {
    const pid_t child = fork();
    if (child == 0) {
      // A new program in effect: who it is must not be remembered from the parent.
      execl("/proc/self/exe", "autosave_test", "--gtest_filter=AutosaveChild.SavesAndIsKilled",
            "--gtest_brief=1", nullptr);
      _exit(1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
    return child;
  }
  std::string only_file() const {
    const auto files = scratch_.files();
    EXPECT_EQ(files.size(), 1u);
    return files.empty() ? "" : files[0];
  }

  tests::ScratchFolder scratch_;
  std::string folder_ = scratch_.path("auto save");
  std::vector<std::string> told_;
  log::Sink sink_;
};

/// What the killed process of the tests below does; does nothing when it runs by itself.
TEST(AutosaveChild, SavesAndIsKilled) {
  const char* folder = std::getenv("AUTOSAVE_TEST_FOLDER");
  if (!folder) return;
  write_autosave(folder, full_document("/a"), "/docs/dance.understudy");
  raise(SIGKILL);
}

class KilledTest : public AutosaveTest {
 protected:
  KilledTest() { setenv("AUTOSAVE_TEST_FOLDER", folder_.c_str(), 1); }
  ~KilledTest() override { unsetenv("AUTOSAVE_TEST_FOLDER"); }
};

TEST_F(KilledTest, WorkIsFoundAndReadAgain) {
  killed_process();
  const std::vector<Autosave> found = found_autosaves(folder_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].document_path, "/docs/dance.understudy");
  EXPECT_EQ(found[0].time.size(), std::string("2024-05-01 14:03").size());
  EXPECT_TRUE(same(read_autosave(found[0]).document, full_document("/a").document));
  discard(found[0]);
  EXPECT_TRUE(found_autosaves(folder_).empty());
  EXPECT_THROW(read_autosave(found[0]), Error);
  EXPECT_TRUE(told_.empty());
}

TEST_F(KilledTest, TwoLeaveTwoCopies) {
  killed_process();
  killed_process();
  EXPECT_EQ(found_autosaves(folder_).size(), 2u);
}

TEST_F(KilledTest, ADamagedCopyIsSetAsideAndTheOtherFound) {
  killed_process();
  const std::string damaged = found_autosaves(folder_).at(0).file;
  killed_process();
  fs::resize_file(damaged, fs::file_size(damaged) / 2);
  const std::vector<Autosave> found = found_autosaves(folder_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].file, damaged);
  EXPECT_FALSE(fs::exists(damaged));
  EXPECT_TRUE(fs::exists(damaged + ".damaged"));
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_NE(told_[0].find(damaged), std::string::npos);
  EXPECT_EQ(found_autosaves(folder_).size(), 1u);  // told once
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(KilledTest, ACopyOfANewerProgramIsLeftAlone) {
  killed_process();
  const std::string file = found_autosaves(folder_).at(0).file;
  std::string text = tests::read_bytes(file);
  const std::string version = "\"version\": 1";
  ASSERT_NE(text.find(version), std::string::npos);
  text.replace(text.find(version), version.size(), "\"version\": 9");
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_TRUE(found_autosaves(folder_).empty());
  EXPECT_TRUE(fs::exists(file));
}

TEST_F(KilledTest, AReusedProcessNumberIsNotMistaken) {
  killed_process();
  const fs::path file = found_autosaves(folder_).at(0).file;
  // As if this process had the dead one's number: the start differs.
  std::string name = file.filename().string();
  const size_t begin = name.find('_', std::string("autosave_").size()) + 1;
  name.replace(begin, name.find('_', begin) - begin, std::to_string(getpid()));
  fs::rename(file, file.parent_path() / name);
  EXPECT_EQ(found_autosaves(folder_).size(), 1u);
  remove_autosave(folder_);  // and it is not this one's to remove
  EXPECT_EQ(found_autosaves(folder_).size(), 1u);
}

TEST_F(KilledTest, ACopyFromBeforeTheLastBootIsFound) {
  write_autosave(folder_, {}, "");
  const fs::path file = fs::path(scratch_.path("")) / only_file();
  std::string name = file.filename().string();
  name.replace(std::string("autosave_").size(), 4, "0000");
  fs::rename(file, file.parent_path() / name);
  EXPECT_EQ(found_autosaves(folder_).size(), 1u);
}

TEST_F(KilledTest, WhatWasHalfWrittenGoes) {
  killed_process();
  const std::string file = found_autosaves(folder_).at(0).file;
  fs::rename(file, file + ".123.part");
  std::ofstream(folder_ + "/notes.txt") << "mine";
  EXPECT_TRUE(found_autosaves(folder_).empty());
  EXPECT_EQ(only_file(), "auto save/notes.txt");
}

TEST_F(AutosaveTest, OfALivingProcessIsLeftAlone) {
  write_autosave(folder_, full_document("/a"), "");
  EXPECT_TRUE(found_autosaves(folder_).empty());
  write_autosave(folder_, {}, "");  // replaces
  only_file();
  remove_autosave(folder_);
  EXPECT_TRUE(scratch_.files().empty());
  remove_autosave(folder_);
}

TEST_F(AutosaveTest, ThereIsNothingWhereThereIsNoFolder) {
  EXPECT_TRUE(found_autosaves(folder_).empty());
  EXPECT_TRUE(found_autosaves("").empty());
  EXPECT_THROW(write_autosave("/proc/nowhere", {}, ""), Error);
}

}  // namespace
}  // namespace understudy::app
