#include "app/batch/results.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "app/batch/summary.hpp"
#include "retarget/base/error.hpp"
#include "tests/app/batch/batch_commands.hpp"
#include "tests/app/program.hpp"
#include "tests/app/sample_files.hpp"

namespace understudy::app {
namespace {

namespace fs = std::filesystem;
using tests::made_job;
using tests::read_bytes;
using tests::write_text;

class BatchResults : public testing::Test {
 protected:
  BatchResults() { results.prepare(); }
  static DoneRecord record(const std::string& id) {
    DoneRecord done;
    done.id = id, done.program = "understudy", done.job = to_json(made_job(id));
    return done;
  }
  void publish(WorkFolder& work, DoneRecord done, const std::string& text) {
    write_text(work.begin(done.id) + "/a.txt", text);
    work.publish(std::move(done));
  }
  static Json person(double jerk) {
    return Json::object({{"frames", 3}, {"flagged", 0}, {"metrics", {{"jerk", jerk}}}});
  }
  std::vector<std::string> work_folders() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(results.work_path()))
      names.push_back(entry.path().string());
    return names;
  }

  tests::ScratchFolder scratch;
  ResultFolder results{scratch.path("out")};
};

TEST_F(BatchResults, AppearWithTheirRecord) {
  WorkFolder work(results);
  publish(work, record("walk"), "one");
  EXPECT_EQ(read_bytes(results.files("walk") + "/a.txt"), "one");
  const auto done = read_done(results.done_path("walk"));
  ASSERT_TRUE(done);
  EXPECT_EQ(done->outputs[0]["file"], "a.txt");
  EXPECT_EQ(done->outputs[0]["bytes"], 3);
  EXPECT_TRUE(results.has_outputs(*done));
  write_text(results.files("walk") + "/a.txt", "cut");
  EXPECT_TRUE(results.has_outputs(*done)) << "of the same size";
  fs::remove(results.files("walk") + "/a.txt");
  EXPECT_FALSE(results.has_outputs(*done));
}

TEST_F(BatchResults, TakeThePlaceOfEarlierOnesAndEndAFailure) {
  WorkFolder work(results);
  publish(work, record("walk"), "one");
  write_text(results.files("walk") + "/of_then.txt", "x");
  results.tell_failure(made_job("walk"), "it fell", Json::array());
  EXPECT_EQ(results.failure("walk"), "it fell");
  publish(work, record("walk"), "another");
  EXPECT_EQ(read_bytes(results.files("walk") + "/a.txt"), "another");
  EXPECT_FALSE(fs::exists(results.files("walk") + "/of_then.txt"));
  EXPECT_FALSE(results.failure("walk"));
}

TEST_F(BatchResults, LeaveAFolderAloneThatNoBatchMade) {
  WorkFolder work(results);
  fs::create_directories(results.files("walk"));
  write_text(results.files("walk") + "/thesis.tex", "dear");
  EXPECT_NE(failure_of([&] { publish(work, record("walk"), "one"); }).find("was not made by a batch"),
            std::string::npos);
  EXPECT_EQ(read_bytes(results.files("walk") + "/thesis.tex"), "dear");
  EXPECT_FALSE(fs::exists(results.done_path("walk")));
}

TEST_F(BatchResults, OfAKilledProcessAreSweptAndThoseOfALivingOneAreNot) {
  const pid_t child = fork();
  if (child == 0) {
    const WorkFolder work(results);
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  ASSERT_EQ(work_folders().size(), 1u);
  WorkFolder living(results);
  results.sweep();
  EXPECT_EQ(work_folders().size(), 1u);
  publish(living, record("walk"), "one");
  EXPECT_TRUE(fs::exists(results.done_path("walk")));
}

TEST_F(BatchResults, AreNoneWhereTheRecordIsDamaged) {
  write_text(results.done_path("walk"), "{\"id\": \"walk\"");
  EXPECT_FALSE(read_done(results.done_path("walk")));
  write_text(results.done_path("walk"), "{\"id\": 3}");
  EXPECT_FALSE(read_done(results.done_path("walk")));
}

TEST_F(BatchResults, AreMergedInTheManifestsOrder) {
  Manifest manifest{
      "jobs.jsonl", scratch.path(""), {made_job("b"), made_job("a"), made_job("c"), made_job("d")}};
  WorkFolder work(results);
  DoneRecord one = record("a"), two = record("b"), old = record("d");
  one.results = Json::array({person(0.5)}), one.seconds = 3;
  two.results = Json::array({person(1), person(2)}), two.seconds = 5;
  two.results[0]["person"] = 1, two.results[1]["person"] = 2;
  old.job["options"]["fps"] = 24;
  for (const DoneRecord& done : {one, two, old}) publish(work, done, "x");
  results.tell_failure(manifest.jobs[2], "it fell, twice", Json::array());
  EXPECT_EQ(merged_csv(manifest, results),
            "id,person,state,error,do,source,target,frames,flagged,jerk\n"
            "b,1,done,,retarget,scans,target.glb,3,0,1.0\n"
            "b,2,done,,retarget,scans,target.glb,3,0,2.0\n"
            "a,,done,,retarget,scans,target.glb,3,0,0.5\n"
            "c,,failed,\"it fell, twice\",retarget,scans,target.glb,,,\n"
            "d,,left,,retarget,scans,target.glb,,,\n");
  const BatchStatus status = status_of(manifest, {0, 1, 2, 3}, results);
  EXPECT_EQ(to_text(status), "2 done, 1 failed, 1 left; median 5.00 s\nc: it fell, twice\n");
}

}  // namespace
}  // namespace understudy::app
