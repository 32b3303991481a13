#include "app/batch/processes.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <map>
#include <numeric>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

std::vector<size_t> first_jobs(size_t count) {
  std::vector<size_t> jobs(count);
  std::iota(jobs.begin(), jobs.end(), size_t{0});
  return jobs;
}

/// What came of a pool, as its parent was told.
struct Told {
  std::map<size_t, JobEnd> ends;
  std::map<size_t, std::string> crashes;
};

Told told_by(
    size_t jobs, int processes, const std::function<JobEnd(size_t)>& work,
    const std::function<bool()>& stopped = [] { return false; }) {
  Told told;
  run_in_processes(first_jobs(jobs),
                   {processes, [&] { return work; }, [&](size_t job, JobEnd end) { told.ends[job] = end; },
                    [&](size_t job, const std::string& how) { told.crashes[job] = how; }, stopped});
  return told;
}

TEST(ProcessPool, DoesEveryJobOnce) {
  for (const int processes : {1, 3, 20}) {
    const Told told =
        told_by(11, processes, [](size_t job) { return job % 2 == 0 ? JobEnd::Done : JobEnd::Failed; });
    ASSERT_EQ(told.ends.size(), 11u) << processes;
    for (const auto& [job, end] : told.ends) EXPECT_EQ(end, job % 2 == 0 ? JobEnd::Done : JobEnd::Failed);
  }
  EXPECT_TRUE(told_by(0, 2, [](size_t) { return JobEnd::Done; }).ends.empty());
}

TEST(ProcessPool, OutlivesAJobThatTakesItsProcessAlong) {
  const Told told = told_by(5, 2, [](size_t job) {
    if (job == 1) kill(getpid(), SIGKILL);
    if (job == 3) _exit(9);
    return JobEnd::Done;
  });
  EXPECT_EQ(told.ends.size(), 3u);
  ASSERT_EQ(told.crashes.size(), 2u);
  EXPECT_NE(told.crashes.at(1).find("signal 9"), std::string::npos) << told.crashes.at(1);
  EXPECT_NE(told.crashes.at(3).find("exit code 9"), std::string::npos) << told.crashes.at(3);
}

std::atomic<bool> asked{false};

TEST(ProcessPool, AsksItsProcessesToStopAndWaitsForThem) {
  std::atomic<bool> stop{false};
  Told told;
  const ProcessPool pool{2,
                         [] {
                           std::signal(SIGTERM, [](int) { asked = true; });
                           return [](size_t job) {
                             if (job < 2) return JobEnd::Done;
                             while (!asked) usleep(1000);
                             return JobEnd::Stopped;
                           };
                         },
                         [&](size_t job, JobEnd end) {
                           told.ends[job] = end;
                           stop = stop || job < 2;
                         },
                         [&](size_t job, const std::string& how) { told.crashes[job] = how; },
                         [&] { return stop.load(); }};
  run_in_processes(first_jobs(50), pool);
  EXPECT_LE(told.ends.size(), 4u) << "nothing more is handed out";
  EXPECT_TRUE(told.crashes.empty());
  EXPECT_EQ(told.ends.rbegin()->second, JobEnd::Stopped);
}

TEST(ProcessPool, EndsWhereNoProcessCanBegin) {
  const ProcessPool pool{2, []() -> std::function<JobEnd(size_t)> { throw Error("no room"); },
                         [](size_t, JobEnd) {}, [](size_t, const std::string&) {}, [] { return false; }};
  EXPECT_THROW(run_in_processes(first_jobs(3), pool), Error);
}

}  // namespace
}  // namespace understudy::app
