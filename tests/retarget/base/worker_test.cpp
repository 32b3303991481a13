#include "retarget/base/worker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <stdexcept>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"

namespace understudy {
namespace {

/// Doubles numbers, the newest first.
struct Doubler {
  std::deque<int> waiting;
  std::vector<int> done;
  Worker worker{"doubling", [this] { return next(); }};

  Worker::Task next() {
    if (waiting.empty()) return nullptr;
    const int number = waiting.back();
    waiting.pop_back();
    return [this, number] {
      if (number == 13) throw std::runtime_error("not that one");
      if (number == 14) throw 14;
      const auto held = worker.lock();
      done.push_back(2 * number);
    };
  }
  void ask(const std::vector<int>& numbers) {
    const auto held = worker.lock();
    waiting.insert(waiting.end(), numbers.begin(), numbers.end());
    worker.wake();
  }
  std::vector<int> all() {
    auto held = worker.lock();
    worker.wait(held, [this] { return waiting.empty() && !worker.working(); });
    return done;
  }
};

TEST(Worker, TakesTheNewestFirst) {
  Doubler doubler;
  doubler.ask({1, 2, 3});
  EXPECT_EQ(doubler.all(), (std::vector<int>{6, 4, 2}));
}

TEST(Worker, GoesOnAfterAnExceptionAndTellsIt) {
  std::vector<std::string> told;
  const auto before = log::set_sink([&](log::Level, const std::string& message) { told.push_back(message); });
  Doubler doubler;
  doubler.ask({1, 14, 13, 4});
  EXPECT_EQ(doubler.all(), (std::vector<int>{8, 2}));
  log::set_sink(before);
  EXPECT_EQ(told, (std::vector<std::string>{"doubling: not that one",
                                            "doubling: it failed for an unknown reason"}));
}

TEST(Worker, AnExceptionInTheChoiceOfATaskEndsNothing) {
  const auto before = log::set_sink([](log::Level, const std::string&) {});
  std::atomic<int> asked{0}, done{0};
  {
    Worker worker("choosing", [&]() -> Worker::Task {
      if (++asked == 1) throw Error("no choice");
      if (asked > 2) return nullptr;
      return [&] { ++done; };
    });
    auto held = worker.lock();
    worker.wait(held, [&] { return done == 1 && !worker.working(); });
  }
  log::set_sink(before);
  EXPECT_EQ(done, 1);
}

TEST(Worker, ItsEndWaitsForTheTaskAtWorkAndBeginsNoOther) {
  std::atomic<int> begun{0}, ended{0};
  {
    Worker worker("slow", [&]() -> Worker::Task {
      return [&] {
        ++begun;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        ++ended;
      };
    });
    while (begun == 0) std::this_thread::yield();
  }
  EXPECT_EQ(begun, ended);
  const int before = begun;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(begun, before);
}

TEST(FailureOf, GivesASentenceForAnyException) {
  EXPECT_EQ(failure_of([] {}), "");
  EXPECT_EQ(failure_of([] { throw Error("a sentence"); }), "a sentence");
  EXPECT_EQ(failure_of([] { throw std::bad_alloc(); }), "there is not enough memory");
  EXPECT_EQ(failure_of([] { throw 1; }), "it failed for an unknown reason");
}

}  // namespace
}  // namespace understudy
