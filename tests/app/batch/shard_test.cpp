#include "app/batch/shard.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

using Variables = std::map<std::string, std::string>;

Shard told(const Variables& variables, int shards = 0) {
  return shard_from(
      [&](const char* name) {
        const auto found = variables.find(name);
        return found == variables.end() ? nullptr : found->second.c_str();
      },
      shards);
}

std::string refusal(const Variables& variables, int shards = 0) {
  return failure_of([&] { told(variables, shards); });
}

TEST(Shard, IsReadAsNumberOfCount) {
  EXPECT_EQ(parse_shard("0/1").count, 1);
  EXPECT_EQ(parse_shard("7/8").index, 7);
}

TEST(Shard, RefusesWhatIsNoneOfThem) {
  for (const char* text : {"0/0", "8/8", "-1/8", "1", "1/", "/8", "a/b", "1/2/3", "0.5/2", "1/99999999999"})
    EXPECT_NE(failure_of([&] { parse_shard(text); }).find(std::string("--shard ") + text), std::string::npos)
        << text;
  EXPECT_EQ(failure_of([] { parse_shard("0/0"); }),
            "--shard 0/0: there must be 1 shard or more, up to 1000000");
}

TEST(Shard, EveryJobIsInOneOfThem) {
  std::multiset<size_t> all;
  for (int i = 0; i < 3; ++i)
    for (const size_t job : jobs_of({i, 3}, 10)) all.insert(job);
  EXPECT_EQ(all.size(), 10u);
  EXPECT_EQ(std::set<size_t>(all.begin(), all.end()).size(), 10u);
  EXPECT_TRUE(jobs_of({5, 8}, 3).empty()) << "more shards than jobs";
}

TEST(Shard, IsTheSlurmArraysTask) {
  const Shard third = told({{"SLURM_ARRAY_TASK_ID", "3"},
                            {"SLURM_ARRAY_TASK_COUNT", "8"},
                            {"SLURM_ARRAY_TASK_MIN", "1"},
                            {"SLURM_ARRAY_TASK_MAX", "8"},
                            {"SLURM_ARRAY_TASK_STEP", "1"}});
  EXPECT_EQ(third.index, 2);
  EXPECT_EQ(third.count, 8);
  const Shard stepped = told({{"SLURM_ARRAY_TASK_ID", "8"},
                              {"SLURM_ARRAY_TASK_COUNT", "4"},
                              {"SLURM_ARRAY_TASK_MIN", "0"},
                              {"SLURM_ARRAY_TASK_MAX", "12"},
                              {"SLURM_ARRAY_TASK_STEP", "4"}});
  EXPECT_EQ(stepped.index, 2);
  EXPECT_EQ(told({{"SLURM_ARRAY_TASK_ID", "5"}}, 8).index, 5) << "one task of eight, started again by itself";
}

TEST(Shard, RefusesAnArrayThatIsNotNumberedEvenly) {
  const Variables some = {{"SLURM_ARRAY_TASK_ID", "5"},
                          {"SLURM_ARRAY_TASK_COUNT", "3"},
                          {"SLURM_ARRAY_TASK_MIN", "1"},
                          {"SLURM_ARRAY_TASK_MAX", "9"},
                          {"SLURM_ARRAY_TASK_STEP", "1"}};
  EXPECT_NE(refusal(some).find("--shards says how many"), std::string::npos);
  EXPECT_NE(refusal({{"SLURM_ARRAY_TASK_ID", "5"}}).find("SLURM_ARRAY_TASK_COUNT"), std::string::npos);
  EXPECT_NE(refusal({{"SLURM_ARRAY_TASK_ID", "five"}}).find("SLURM_ARRAY_TASK_ID=five"), std::string::npos);
  EXPECT_NE(refusal({{"SLURM_ARRAY_TASK_ID", "8"}}, 8).find("the last of 8 is 7"), std::string::npos);
}

TEST(Shard, IsTheKubernetesJobsCompletion) {
  const Shard second = told({{"JOB_COMPLETION_INDEX", "1"}}, 4);
  EXPECT_EQ(second.index, 1);
  EXPECT_EQ(second.count, 4);
  EXPECT_NE(refusal({{"JOB_COMPLETION_INDEX", "1"}}).find("--shards must say"), std::string::npos);
}

TEST(Shard, IsTheWholeWhereNobodySaysAnything) {
  EXPECT_EQ(told({}).count, 1);
  EXPECT_NE(refusal({}, 8).find("--shard I/N"), std::string::npos);
}

}  // namespace
}  // namespace understudy::app
