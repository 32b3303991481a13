#include "retarget/base/file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "tests/support/full_disk.hpp"

namespace understudy {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  FileTest() { fs::create_directories(folder_); }
  ~FileTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string pipe() const {
    EXPECT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    return path("pipe");
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.push_back(entry.path().filename());
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  fs::path folder_ = fs::temp_directory_path() / ("understudy_file_" + std::to_string(::getpid()));
};

template <class Work>
std::string complaint_of(Work work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

using ReadFile = FileTest;
using WholeFile = FileTest;
using WholeFolder = FileTest;

TEST_F(ReadFile, GivesAllBytes) {
  write_file(path("a"), std::string("a\0b", 3));
  EXPECT_EQ(read_file(path("a")), std::string("a\0b", 3));
  EXPECT_EQ(check_file(path("a")), 3u);
}

TEST_F(ReadFile, RefusesAPipeInsteadOfWaitingForIt) {
  const std::string at = pipe();
  EXPECT_EQ(complaint_of([&] { read_file(at); }), at + ": is a pipe or a device, not a file");
  EXPECT_EQ(complaint_of([&] { check_file(at); }), at + ": is a pipe or a device, not a file");
}

TEST_F(ReadFile, SaysWhatIsWrong) {
  EXPECT_EQ(complaint_of([&] { read_file(path("no")); }), path("no") + ": there is no such file");
  EXPECT_EQ(complaint_of([&] { check_file(path("")); }), path("") + ": is a folder, not a file");
  write_file(path("a"), "four");
  EXPECT_EQ(complaint_of([&] { read_file(path("a"), 3); }),
            path("a") + ": has 4 bytes, more than the expected 3");
}

TEST_F(WholeFile, LeavesNothingBesideIt) {
  write_file(path("a"), "one");
  write_file(path("a"), "two");
  EXPECT_EQ(read_file(path("a")), "two");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(WholeFile, KeepsWhatWasThereUnlessItIsFinished) {
  write_file(path("a"), "old");
  {
    PartFile file(path("a"));
    file.write("new");
  }
  EXPECT_EQ(read_file(path("a")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(WholeFile, OthersWithPartInTheirNameStay) {
  const std::vector<std::string> others = {"a.part", "a." + std::to_string(::getpid()) + ".part"};
  for (const std::string& other : others) std::ofstream(path(other)) << "not ours";
  check_writable(path("a"));
  write_file(path("a"), "ours");
  for (const std::string& other : others) EXPECT_EQ(read_file(path(other)), "not ours") << other;
}

TEST_F(WholeFile, APipeWherePartWouldBeIsNoHindrance) {
  ASSERT_EQ(::mkfifo(path("a.part").c_str(), 0600), 0);
  write_file(path("a"), "whole");
  EXPECT_EQ(read_file(path("a")), "whole");
}

TEST_F(WholeFile, FollowsALink) {
  write_file(path("real"), "old");
  fs::create_symlink("real", path("link"));
  write_file(path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_file(path("real")), "new");
}

TEST_F(WholeFile, KeepsThePermissions) {
  write_file(path("a"), "old");
  ASSERT_EQ(::chmod(path("a").c_str(), 0646), 0);  // more than a usual umask leaves
  write_file(path("a"), "new");
  struct stat about {};
  ASSERT_EQ(::stat(path("a").c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 07777, 0646u);
}

TEST_F(WholeFile, NeverReplacesWhatIsNoFile) {
  const std::string at = pipe();
  EXPECT_EQ(complaint_of([&] { write_file(at, "text"); }), at + ": is a pipe or a device, not a file");
  EXPECT_EQ(complaint_of([&] { write_file(path(""), "text"); }), path("") + ": is a folder, not a file");
  EXPECT_NE(complaint_of([&] { check_writable(path("no/a")); }).find("No such file"), std::string::npos);
}

TEST_F(WholeFile, IsAsItWasWhenTheDiskIsFull) {
  write_file(path("a"), "old");
  {
    const test::FullDisk full(1000);
    EXPECT_THROW(write_file(path("a"), std::string(100000, 'x')), Error);
  }
  EXPECT_EQ(read_file(path("a")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(WholeFile, WhatALibraryPutInItsPlaceIsTaken) {
  PartFile file(path("a"));
  std::ofstream(path("of a library")) << "theirs";
  fs::rename(path("of a library"), file.part());
  file.finish();
  EXPECT_EQ(read_file(path("a")), "theirs");
}

TEST_F(WholeFile, IsRewrittenInItsMiddle) {
  PartFile file(path("a"));
  file.write("count: 0\n");
  file.write("row\n");
  file.rewrite(7, "1");
  file.write("end\n");
  file.finish();
  EXPECT_EQ(read_file(path("a")), "count: 1\nrow\nend\n");
}

std::string frame_text(int number) {
  return std::string(PartFolder::kMark) + " " + std::to_string(number);
}

TEST_F(WholeFolder, IsThereWithAllFramesOrNotAtAll) {
  {
    PartFolder folder(path("frames"));
    for (int i = 0; i < 3; ++i) folder.add(std::to_string(i), frame_text(i));
    EXPECT_FALSE(fs::exists(path("frames")));
    folder.finish();
  }
  EXPECT_EQ(names(), std::vector<std::string>{"frames"});
  EXPECT_EQ(read_file(path("frames/2")), frame_text(2));
}

TEST_F(WholeFolder, IsAsItWasWhereOneFrameFails) {
  PartFolder old(path("frames"));
  old.add("0", frame_text(7));
  old.finish();
  EXPECT_THROW(
      {
        PartFolder folder(path("frames"));
        folder.add("0", frame_text(0));
        const test::FullDisk full(1000);
        folder.add("1", std::string(100000, 'x'));
      },
      Error);
  EXPECT_EQ(names(), std::vector<std::string>{"frames"});
  EXPECT_EQ(read_file(path("frames/0")), frame_text(7));
}

TEST_F(WholeFolder, ShowsEachFrameAtOnceWhereAskedAndKeepsItWhenALaterOneFails) {
  PartFolder old(path("frames"));
  old.add("9", frame_text(9));
  old.finish();
  {
    PartFolder folder(path("frames"), PartFolder::Frames::AsTheyCome);
    folder.add("0", frame_text(0));
    EXPECT_EQ(read_file(path("frames/0")), frame_text(0));
    const test::FullDisk full(1000);
    EXPECT_THROW(folder.add("1", std::string(100000, 'x')), Error);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"frames"});
  EXPECT_EQ(read_file(path("frames/0")), frame_text(0));
  for (const char* name : {"1", "9"}) EXPECT_FALSE(fs::exists(path(std::string("frames/") + name)));
  std::ofstream(path("frames/mine")) << "not ours";
  EXPECT_NE(complaint_of([&] { PartFolder(path("frames"), PartFolder::Frames::AsTheyCome); }), "");
}

}  // namespace
}  // namespace understudy
