#include "app/run/case_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/program.hpp"

namespace understudy::app {
namespace {

class CaseFolder : public testing::Test {
 protected:
  std::string with_json(const std::string& json) {
    std::filesystem::create_directories(scratch.path("walk"));
    std::ofstream(scratch.path("walk/case.json")) << json;
    return scratch.path("walk");
  }
  tests::ScratchFolder scratch;
};

NpyArray array(std::vector<int64_t> shape) {
  NpyArray a{shape, {}, {}};
  int64_t count = 1;
  for (const int64_t extent : a.shape) count *= extent;
  a.values.resize(static_cast<size_t>(count));
  for (size_t i = 0; i < a.values.size(); ++i) a.values[i] = static_cast<float>(i);
  return a;
}

TEST_F(CaseFolder, ReadsACase) {
  const Case c = read_case(with_json(
      R"({"fps": 25, "source": "source", "target": "target.obj", "truth": "truth.npz", "tags": ["naked", "walk"]})"));
  EXPECT_EQ(c.name, "walk");
  EXPECT_EQ(c.fps, 25);
  EXPECT_EQ(c.source, scratch.path("walk/source"));
  EXPECT_EQ(c.target, scratch.path("walk/target.obj"));
  EXPECT_EQ(c.tags, (std::vector<std::string>{"naked", "walk"}));
}

TEST_F(CaseFolder, TargetAndTruthMayBeAbsent) {
  const Case c = read_case(with_json(R"({"source": "source"})"));
  EXPECT_TRUE(c.target.empty() && c.truth.empty());
  EXPECT_EQ(c.fps, 30);
}

TEST_F(CaseFolder, RefusesWhatIsNoCase) {
  EXPECT_THROW(read_case(with_json("{\"source\"")), Error);
  EXPECT_THROW(read_case(with_json("{}")), Error);
  EXPECT_THROW(read_case(with_json(R"({"source": 3})")), Error);
  EXPECT_THROW(read_case(with_json(R"({"source": "s", "fps": 0})")), Error);
}

TEST_F(CaseFolder, FindsCasesByName) {
  for (const char* name : {"b", "a", "notes"}) std::filesystem::create_directories(scratch.path(name));
  for (const char* name : {"b", "a"}) std::ofstream(scratch.path(name) + "/case.json") << "{}";
  const auto folders = case_folders(scratch.path(""));
  ASSERT_EQ(folders.size(), 2u);
  EXPECT_NE(folders[0].find("/a"), std::string::npos);
  EXPECT_THROW(case_folders(scratch.path("notes")), Error);
  EXPECT_THROW(case_folders(scratch.path("absent")), Error);
}

TEST_F(CaseFolder, ReadsTheTruth) {
  write_npz(scratch.path("t.npz"), {{"vertices", array({2, 5, 3})},
                                    {"joints", array({2, 22, 3})},
                                    {"rotations", array({2, 22, 3, 3})},
                                    {"target_joints", array({22, 3})}});
  const Truth truth = read_truth(scratch.path("t.npz"));
  EXPECT_EQ(truth.frames, 2);
  EXPECT_EQ(truth.frame_vertices(1)(0, 0), 15);
  EXPECT_EQ(truth.joints[1](0, 1), 67);
  EXPECT_EQ(truth.rotations[1][0](0, 1), 199);  // row-major on disk
  EXPECT_EQ((*truth.target_joints)(21, 2), 65);
  EXPECT_TRUE(truth.source_joints.empty());
}

/// Two people in two frames of 3 and 2 points.
Npz scene_truth(std::vector<float> counts, std::vector<float> owners) {
  Npz npz{{"people_joints", array({2, 2, 22, 3})},
          {"people_seen", array({2, 2, 22})},
          {"people_touch", array({2, 2})}};
  npz["point_counts"] = {{static_cast<int64_t>(counts.size())}, counts, ""};
  npz["point_owners"] = {{static_cast<int64_t>(owners.size())}, owners, ""};
  return npz;
}

TEST_F(CaseFolder, ReadsTheTruthOfAScene) {
  write_npz(scratch.path("t.npz"), scene_truth({3, 2}, {0, 1, -1, -2, 1}));
  const Truth truth = read_truth(scratch.path("t.npz"));
  EXPECT_EQ(truth.frames, 2);
  ASSERT_EQ(truth.scene.size(), 2u);
  EXPECT_EQ(truth.scene[0].owners, (std::vector<int>{0, 1, kNobodysPoint}));
  EXPECT_EQ(truth.scene[1].owners, (std::vector<int>{kUndecidedPoint, 1}));
  EXPECT_EQ(truth.scene[1].people[1].joints(2, 1), 3 * 66 + 7);
  EXPECT_EQ(truth.scene[1].people[0].seen[5], 2 * 22 + 5);
  EXPECT_FALSE(truth.scene[0].people[0].touches);
  EXPECT_TRUE(truth.scene[0].people[1].touches);
  EXPECT_EQ(read_case(with_json(R"({"source": "s", "alone": ["a", "b"]})")).alone[1], scratch.path("walk/b"));
  EXPECT_THROW(read_case(with_json(R"({"source": "s", "alone": "a"})")), Error);
}

TEST_F(CaseFolder, RefusesASceneWhosePointsDoNotAddUp) {
  const auto refused = [&](Npz npz) {
    write_npz(scratch.path("t.npz"), npz);
    EXPECT_THROW(read_truth(scratch.path("t.npz")), Error);
  };
  refused(scene_truth({3, 3}, {0, 1, -1, 0, 1}));
  refused(scene_truth({3, -1}, {0, 1, -1, 0, 1}));
  refused(scene_truth({3, NAN}, {0, 1, -1, 0, 1}));
  refused(scene_truth({3, 2}, {0, 1, -1, 0, 2}));
  refused(scene_truth({3}, {0, 1, -1}));
  Npz npz = scene_truth({3, 2}, {0, 1, -1, 0, 1});
  npz.erase("people_seen");
  refused(npz);
}

TEST_F(CaseFolder, RefusesATruthThatDisagreesWithItself) {
  write_npz(scratch.path("t.npz"), {{"vertices", array({2, 5, 3})}, {"joints", array({3, 22, 3})}});
  EXPECT_THROW(read_truth(scratch.path("t.npz")), Error);
  write_npz(scratch.path("u.npz"), {{"joints", array({3, 24, 3})}});
  EXPECT_THROW(read_truth(scratch.path("u.npz")), Error);
}

}  // namespace
}  // namespace understudy::app
