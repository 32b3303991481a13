#include "retarget/base/text.hpp"

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(FileSuffix, IsInLowerCase) {
  EXPECT_EQ(file_suffix("walks/WALK.BVH"), ".bvh");
}

TEST(FileSuffix, IsTheLastOfTheFileNameAlone) {
  EXPECT_EQ(file_suffix("a.tar/scan.ply.GLB"), ".glb");
  EXPECT_EQ(file_suffix("a.tar/scan"), "");
  EXPECT_EQ(file_suffix("folder.d/"), "");
}

TEST(FileSuffix, HiddenFilesAndFoldersAboveHaveNone) {
  for (const char* path : {".npz", "a/.npz", "..", "../..", ""}) EXPECT_EQ(file_suffix(path), "") << path;
}

TEST(Text, EndsAreNoLongerThanTheText) {
  EXPECT_TRUE(ends_with("joints.npy", ".npy"));
  EXPECT_FALSE(ends_with("npy", ".npy"));
  EXPECT_FALSE(starts_with("np", "npy"));
}

TEST(Text, SplitKeepsEmptyPartsButTheLast) {
  EXPECT_EQ(split("a,,b,", ','), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_TRUE(split("", ',').empty());
}

TEST(Text, ItemsAreJoinedWithCommas) {
  std::string list;
  for (const char* item : {"a", "b", "c"}) append_item(list, item);
  EXPECT_EQ(list, "a, b, c");
}

TEST(Text, AListHasEachItemOnce) {
  EXPECT_EQ(joined_once({"b", "", "a", "b"}, "; "), "b; a");
  EXPECT_EQ(joined_once({}), "");
}

TEST(Text, LargeNumbersAreGroupedByThousands) {
  EXPECT_EQ(grouped(12345678), "12,345,678");
  EXPECT_EQ(grouped(-123), "-123");
  EXPECT_EQ(grouped(-1234), "-1,234");
}

TEST(Text, PrintsWhatIsLongerThanAnyBuffer) {
  const std::string name(5000, 'x');
  EXPECT_EQ(printed("%s %d", name.c_str(), 7), name + " 7");
}

TEST(Text, TrimsTheEndAlone) {
  EXPECT_EQ(trim_end(" a b \r\n"), " a b");
  EXPECT_EQ(trim_end(" \n"), "");
}

}  // namespace
}  // namespace understudy
