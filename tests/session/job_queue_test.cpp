#include "app/session/job_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

using namespace std::chrono_literals;

/// Drains until no job runs; what failed.
std::vector<std::string> finish(JobQueue& jobs) {
  std::vector<std::string> problems;
  while (jobs.running()) {
    for (const JobQueue::Failure& failed : jobs.drain()) problems.push_back(failed.sentence);
    std::this_thread::sleep_for(1ms);
  }
  return problems;
}

/// The view of the only job, once `ready` says so of it.
template <class Ready>
JobView view_when(const JobQueue& jobs, Ready ready) {
  while (true) {
    const std::vector<JobView> views = jobs.views();
    if (views.size() == 1 && ready(views[0])) return views[0];
    std::this_thread::sleep_for(1ms);
  }
}

TEST(JobQueue, HandsTheResultOverOnTheDrainingThread) {
  JobQueue jobs;
  std::thread::id worked, taken;
  int result = 0, shown = 0;
  jobs.start(
      "Adding",
      [&](JobControl&) {
        worked = std::this_thread::get_id();
        result = 42;
      },
      [&] {
        taken = std::this_thread::get_id();
        shown = result;
      });
  EXPECT_TRUE(finish(jobs).empty());
  EXPECT_EQ(shown, 42);
  EXPECT_EQ(taken, std::this_thread::get_id());
  EXPECT_NE(worked, taken);
}

TEST(JobQueue, TellsWhatFailedAndTakesNoResult) {
  JobQueue jobs;
  bool taken = false;
  jobs.start(
      "Exporting", [](JobControl&) { throw Error("a.glb: cannot be written"); }, [&] { taken = true; });
  EXPECT_EQ(finish(jobs), std::vector<std::string>{"a.glb: cannot be written"});
  EXPECT_FALSE(taken);
}

TEST(JobQueue, NamesTheJobThatRanOutOfMemory) {
  JobQueue jobs;
  jobs.start("Exporting a.glb", [](JobControl&) { throw std::bad_alloc(); });
  EXPECT_EQ(finish(jobs), std::vector<std::string>{"Exporting a.glb: there is not enough memory"});
}

TEST(JobQueue, SurvivesWhateverIsThrown) {
  JobQueue jobs;
  jobs.start("One", [](JobControl&) { throw std::out_of_range("index"); });
  jobs.start("Two", [](JobControl&) { throw 7; });
  const std::vector<std::string> problems = finish(jobs);
  ASSERT_EQ(problems.size(), 2u);
  for (const std::string& problem : problems)
    EXPECT_TRUE(problem == "One: index" || problem == "Two: failed for an unknown reason") << problem;
}

TEST(JobQueue, TellsWhatIsDoneNow) {
  JobQueue jobs;
  std::atomic<bool> seen{false};
  jobs.start("Teaching", [&](JobControl& control) {
    control.tell("recording 12 of 80");
    while (!seen) std::this_thread::sleep_for(1ms);
  });
  const JobView view = view_when(jobs, [](const JobView& one) { return !one.doing.empty(); });
  seen = true;
  EXPECT_EQ(view.doing, "recording 12 of 80");
  EXPECT_TRUE(finish(jobs).empty());
}

TEST(JobQueue, ACancelledJobEndsSilently) {
  JobQueue jobs;
  bool taken = false;
  const int64_t id = jobs.start(
      "Endless",
      [](JobControl& control) {
        while (true) control.check();
      },
      [&] { taken = true; });
  EXPECT_TRUE(jobs.views().at(0).cancellable);
  jobs.cancel(id);
  EXPECT_TRUE(finish(jobs).empty());
  EXPECT_FALSE(taken);
}

TEST(JobQueue, CancelsTheOneThatIsMeant) {
  JobQueue jobs;
  std::atomic<bool> stop{false};
  const auto work = [&](JobControl& control) {
    while (!stop) control.check();
  };
  bool first = false, second = false;
  const int64_t id = jobs.start("First", work, [&] { first = true; });
  jobs.start("Second", work, [&] { second = true; });
  jobs.cancel(id);
  while (jobs.views().size() == 2) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(jobs.views()[0].name, "Second");
  stop = true;
  finish(jobs);
  EXPECT_FALSE(first);
  EXPECT_TRUE(second);
}

TEST(JobQueue, TellsNoTimeLeftBeforeItCanKnow) {
  JobQueue jobs;
  std::atomic<float> share{-1};
  jobs.start("Retargeting", [&](JobControl& control) {
    while (!control.cancelled()) {
      if (share >= 0) control.progress(share);
      std::this_thread::sleep_for(1ms);
    }
  });
  EXPECT_LT(view_when(jobs, [](auto&) { return true; }).progress, 0);
  share = 0.02f;
  EXPECT_LT(view_when(jobs, [](auto& job) { return job.progress > 0; }).seconds_left, 0);
  std::this_thread::sleep_for(150ms);
  share = 0.25f;
  const JobView view = view_when(jobs, [](auto& job) { return job.progress > 0.2f; });
  EXPECT_GT(view.seconds_left, 0.45);  // three times what has passed
  EXPECT_LT(view.seconds_left, 60);
  jobs.cancel(view.id);
}

TEST(JobQueue, ASlowStartIsToldAfterASecond) {
  JobQueue jobs;
  const int64_t id = jobs.start("Retargeting", [](JobControl& control) {
    control.progress(0.01f);
    while (!control.cancelled()) std::this_thread::sleep_for(1ms);
  });
  const JobView view = view_when(jobs, [](auto& job) { return job.seconds_left > 0; });
  EXPECT_GT(view.seconds_left, 99 * 0.99);
  jobs.cancel(id);
}

TEST(JobQueue, ProgressStaysBetweenNothingAndAll) {
  JobQueue jobs;
  const int64_t id = jobs.start("Odd", [](JobControl& control) {
    control.progress(7);
    control.progress(std::nanf(""));
    while (!control.cancelled()) std::this_thread::sleep_for(1ms);
  });
  EXPECT_EQ(view_when(jobs, [](auto& job) { return job.progress >= 0; }).progress, 1);
  jobs.cancel(id);
}

TEST(JobQueue, WhatIsDoneMayStartAnotherJob) {
  JobQueue jobs;
  bool second = false;
  jobs.start(
      "First", [](JobControl&) {},
      [&] {
        jobs.start(
            "Second", [](JobControl&) {}, [&] { second = true; });
      });
  finish(jobs);
  EXPECT_TRUE(second);
}

TEST(JobQueue, AResultThatCannotBeTakenLosesNoOther) {
  JobQueue jobs;
  bool second = false;
  jobs.set_command("export.run 0 dance.glb");
  jobs.start(
      "First", [](JobControl&) {}, [] { throw Error("the target is gone"); });
  jobs.set_command("");
  jobs.start(
      "Second", [](JobControl&) {}, [&] { second = true; });
  while (!jobs.views().empty()) std::this_thread::sleep_for(1ms);
  const auto failed = jobs.drain();
  ASSERT_EQ(failed.size(), 1u);
  EXPECT_EQ(failed[0].sentence, "the target is gone");
  EXPECT_EQ(failed[0].command, "export.run 0 dance.glb");
  EXPECT_TRUE(second);
}

TEST(JobQueue, ItsEndCancelsAndWaits) {
  std::atomic<int> ended{0};
  {
    JobQueue jobs;
    for (int i = 0; i < 8; ++i)
      jobs.start("Endless", [&](JobControl& control) {
        while (!control.cancelled()) std::this_thread::sleep_for(1ms);
        ++ended;
      });
  }
  EXPECT_EQ(ended, 8);
}

}  // namespace
}  // namespace understudy::app
