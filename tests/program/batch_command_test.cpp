// Many jobs at once: what appears, what is skipped, what a failure, a signal or a damaged list leaves behind.
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class Batch : public ShippedProgram {
 protected:
  /// Jobs j0 .. of one scan each, in folders beside the manifest, that anybody may change.
  void write_jobs(int count) {
    std::string lines;
    for (int k = 0; k < count; ++k) {
      const std::string source = "scans" + std::to_string(k);
      write_scans(scratch.path(source), 2);
      lines +=
          Json({{"id", "j" + std::to_string(k)}, {"source", source}, {"target", "target.obj"}}).dump() + "\n";
    }
    fs::copy_file(target(), scratch.path("target.obj"));
    write_text(manifest(), lines);
  }
  void add_line(const Json& line) { std::ofstream(manifest(), std::ios::app) << line.dump() << '\n'; }
  std::string manifest() { return scratch.path("jobs.jsonl"); }
  std::string in(const std::string& name) { return scratch.path("results/" + name); }
  Finished batch(std::vector<std::string> more = {}, ProgramOptions options = {}) {
    std::vector<std::string> arguments = {"batch", manifest(), "--out", scratch.path("results")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, std::move(options));
  }
  std::string merged() {
    EXPECT_NE(batch({"--merge", scratch.path("merged.csv")}).code, 1);
    return read_bytes(scratch.path("merged.csv"));
  }
  void expect_refusal(const std::string& lines, const std::string& says) {
    write_text(manifest(), lines);
    const Finished run = batch();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_FALSE(fs::exists(scratch.path("results"))) << "nothing is begun";
  }
};

TEST_F(Batch, DoesItsLinesAndSkipsThemThenOn) {
  write_jobs(2);
  add_line({{"id", "as_file"},
            {"do", "export"},
            {"source", {"scans0"}},
            {"target", {"target.obj"}},
            {"options", {{"out", "motion.bvh"}, {"no-lock-feet", true}, {"fps", 25}}}});
  const Finished run = batch();
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("3 done, 0 done before, 0 failed, 0 left"), std::string::npos) << run.out;
  EXPECT_EQ(read_bytes(in("j0/j0.glb")).substr(0, 4), "glTF");
  EXPECT_EQ(read_bytes(in("as_file/motion.bvh")).substr(0, 9), "HIERARCHY");
  const Json done = Json::parse(read_bytes(in("j1.done.json")));
  EXPECT_EQ(done["results"][0]["frames"], 2);
  EXPECT_TRUE(done["results"][0]["metrics"].contains("bone_drift")) << done.dump();
  EXPECT_GT(done["results"][0]["doubt"]["joints_mm"], 0);
  EXPECT_GT(done["seconds"], 0);
  EXPECT_EQ(done["inputs"].size(), 2u);
  EXPECT_NE(done["weights"].get<std::string>().find("skeleton.weights:"), std::string::npos);

  EXPECT_NE(batch().out.find("0 done, 3 done before"), std::string::npos);
  write_cloud(scratch.path("scans1/") + frame_name(1), person_points(3));
  EXPECT_NE(batch().out.find("1 done, 2 done before"), std::string::npos) << "one input is another";
  const Finished status = batch({"--status"});
  EXPECT_EQ(status.code, 0);
  EXPECT_NE(status.out.find("3 done, 0 failed, 0 left; median "), std::string::npos) << status.out;
}

TEST_F(Batch, WritesWhatItsCommandWrites) {
  write_jobs(1);
  ASSERT_EQ(batch().code, 0);
  const Finished alone = run_program({"retarget", "--source", scratch.path("scans0"), "--target",
                                      scratch.path("target.obj"), "--out", scratch.path("alone.glb")});
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_EQ(read_bytes(in("j0/j0.glb")), read_bytes(scratch.path("alone.glb")));
}

TEST_F(Batch, GoesOnAfterAFailureAndTellsIt) {
  write_jobs(1);
  add_line({{"id", "gone"}, {"source", "nowhere"}, {"target", "target.obj"}});
  add_line({{"id", "fast"}, {"source", "scans0"}, {"target", "target.obj"}, {"options", {{"fps", 0}}}});
  write_scans(scratch.path("scans3"), 2);
  add_line({{"id", "last"}, {"source", "scans3"}, {"target", "target.obj"}});
  const Finished run = batch();
  EXPECT_EQ(run.code, 3) << run.err;
  EXPECT_TRUE(fs::exists(in("last/last.glb")));
  const Json failed = Json::parse(read_bytes(in("gone.failed.json")));
  EXPECT_NE(failed["error"].get<std::string>().find("nowhere: "), std::string::npos) << failed.dump();
  EXPECT_FALSE(fs::exists(in("gone")));
  EXPECT_NE(Json::parse(read_bytes(in("fast.failed.json")))["error"].get<std::string>().find("--fps"),
            std::string::npos);
  const Finished status = batch({"--status"});
  EXPECT_EQ(status.code, 3);
  EXPECT_NE(status.out.find("2 done, 2 failed, 0 left"), std::string::npos) << status.out;
  EXPECT_NE(status.out.find("gone: nowhere"), std::string::npos) << status.out;

  write_scans(scratch.path("nowhere"), 2);
  EXPECT_NE(batch().out.find("1 done, 2 done before, 1 failed"), std::string::npos);
  EXPECT_FALSE(fs::exists(in("gone.failed.json")));
}

TEST_F(Batch, GivesTheSameTableHoweverItIsSharedOut) {
  write_jobs(4);
  ASSERT_EQ(batch().code, 0);
  const std::string alone = merged();
  EXPECT_EQ(line_count(alone), 5);
  fs::remove_all(scratch.path("results"));
  EXPECT_EQ(batch({"--jobs", "2"}).code, 0);
  EXPECT_EQ(merged(), alone);
  fs::remove_all(scratch.path("results"));
  const Finished first = batch({"--shard", "0/2"});
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("2 done"), std::string::npos) << first.out;
  EXPECT_NE(batch({"--status"}).out.find("2 done, 0 failed, 2 left"), std::string::npos);
  const Finished second = batch({}, {"",
                                     -1,
                                     false,
                                     {"SLURM_ARRAY_TASK_ID=2", "SLURM_ARRAY_TASK_MIN=1",
                                      "SLURM_ARRAY_TASK_COUNT=2", "SLURM_ARRAY_TASK_MAX=2"}});
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_NE(second.out.find("2 done, 0 done before"), std::string::npos) << second.out;
  EXPECT_EQ(merged(), alone);
}

TEST_F(Batch, EndsBetweenFramesWhenAskedAndGoesOnLater) {
  write_jobs(5);
  Program program({"batch", manifest(), "--out", scratch.path("results"), "--jobs", "2"});
  for (int i = 0; i < 2000 && !fs::exists(in("j1.done.json")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  program.send(SIGTERM);
  program.send(SIGTERM);  // a scheduler may say it twice
  const Finished run = program.finish();
  EXPECT_EQ(run.code, 1) << run.err;
  EXPECT_NE(run.err.find("interrupted; what is done stays, and the same command goes on"), std::string::npos)
      << run.err;
  EXPECT_TRUE(fs::is_empty(in(".work"))) << "nothing half made is left";
  int done = 0;
  for (int k = 0; k < 5; ++k) {
    const std::string id = "j" + std::to_string(k);
    EXPECT_EQ(fs::exists(in(id + ".done.json")), fs::exists(in(id + "/" + id + ".glb"))) << id;
    EXPECT_FALSE(fs::exists(in(id + ".failed.json"))) << "who is asked to end has not failed";
    done += fs::exists(in(id + ".done.json"));
  }
  EXPECT_LT(done, 5);
  const Finished rest = batch();
  EXPECT_EQ(rest.code, 0) << rest.err;
  EXPECT_NE(rest.out.find(std::to_string(5 - done) + " done, " + std::to_string(done) + " done before"),
            std::string::npos)
      << rest.out;
}

TEST_F(Batch, TellsFiguresOfEachPersonByThemselves) {
  write_jobs(1);
  write_text(
      manifest(),
      Json({{"id", "all"}, {"source", "scans0"}, {"target", "target.obj"}, {"options", {{"person", "all"}}}})
          .dump());
  ASSERT_EQ(batch().code, 0);
  const Json done = Json::parse(read_bytes(in("all.done.json")));
  ASSERT_EQ(done["results"].size(), 1u) << done.dump();
  EXPECT_EQ(done["results"][0]["person"], 1);
  EXPECT_TRUE(fs::exists(in("all/all-1.glb")));
  EXPECT_FALSE(fs::exists(in("all/.report-1.json")));
}

TEST_F(Batch, RefusesListsThatAreNoneBeforeItBegins) {
  const std::string line = R"({"id": "a", "source": "s", "target": "t"})";
  expect_refusal(
      R"({"id": "a", "source": "s", "target": "t", "options": {"no-lock-foot": true}})",
      "jobs.jsonl line 1: retarget option 'no-lock-foot' is not known; the nearest that is: 'no-lock-feet'");
  expect_refusal(R"({"id": "a", "source": "s", "targets": "t"})",
                 "jobs.jsonl line 1: 'targets' is not known; the nearest that is: 'target'");
  expect_refusal(line + "\n" + line, "jobs.jsonl line 2: the id 'a' is that of line 1");
  expect_refusal(R"({"id": "../a", "source": "s", "target": "t"})",
                 "line 1: the id '../a' cannot name a file");
  expect_refusal(R"({"id": "a", "source": "s", "target": "t", "options": {"preview": "../a.png"}})",
                 "line 1: option preview: '../a.png' is no plain name");
  expect_refusal(R"({"id": "a", "source": "s", "target": "t", "options": {"follow": true}})",
                 "option 'follow' is not known");
  expect_refusal(R"({"id": "a", "source": "s", "target": "t", "options": {"send": ["vmc"]}})",
                 "retarget option 'send' is not known");
  expect_refusal("{", "jobs.jsonl line 1: is damaged");
  expect_refusal("", "jobs.jsonl: lists no job");
  write_text(manifest(), line);
  for (const char* shard : {"0/0", "2/2", "one", ""}) {
    const Finished run = batch({"--shard", shard});
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_NE(run.err.find(std::string("--shard ") + shard + ": "), std::string::npos) << run.err;
  }
  const Finished onto_itself = batch({"--merge", manifest()});
  EXPECT_EQ(onto_itself.code, 1);
  EXPECT_NE(onto_itself.err.find("jobs.jsonl: is read here, and would be lost"), std::string::npos);
  EXPECT_EQ(read_bytes(manifest()), line);
  EXPECT_EQ(batch({"--jobs", "0"}).code, 2);
  EXPECT_NE(run_program({"batch", scratch.path("none.jsonl"), "--out", "x"}).err.find("none.jsonl: "),
            std::string::npos);
  EXPECT_EQ(run_program({"batch", "--help"}).code, 0);
}

}  // namespace
}  // namespace understudy::tests
