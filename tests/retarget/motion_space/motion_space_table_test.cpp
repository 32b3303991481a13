#include "retarget/motion_space/motion_space_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "retarget/base/error.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy {
namespace {

TEST(MotionSpaceTable, MakesEachByItsName) {
  const std::string folder = testing::TempDir() + "motion_space_table";
  test::write_training_folder(folder);
  for (const MotionSpaceChoice& choice : motion_spaces()) {
    EXPECT_EQ(&motion_space_named(choice.name), &choice);
    EXPECT_NE(motion_space_help().find(choice.sentence), std::string::npos);
    if (choice.make) EXPECT_EQ(make_motion_space(choice.name, folder)->name(), choice.name);
    if (!choice.make) EXPECT_NE(choice.weights, nullptr);
    if (!choice.make || choice.needs_clips) EXPECT_THROW(make_motion_space(choice.name), Error);
  }
  EXPECT_NO_THROW(motion_space_named(kDefaultMotionSpace));
  std::filesystem::remove_all(folder);
}

TEST(MotionSpaceTable, NamesThoseThatThereAreWhenAskedForAnother) {
  try {
    motion_space_named("magic");
    FAIL();
  } catch (const Error& wrong) {
    EXPECT_NE(std::string(wrong.what()).find("hold, glide, coast, slerp, hermite, nearest, paper, space"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace understudy
