#include "app/batch/manifest.hpp"

#include <gtest/gtest.h>

#include "retarget/base/error.hpp"
#include "tests/app/batch/batch_commands.hpp"

namespace understudy::app {
namespace {

std::vector<BatchJob> parsed(const std::string& text) {
  return parse_manifest(text, "jobs.jsonl", tests::made_commands());
}

std::string refusal(const std::string& text) {
  return failure_of([&] { parsed(text); });
}

/// A line with these members beside id, source and target.
std::string line(const std::string& more) {
  return R"({"id": "a", "source": "s", "target": "t")" + more + "}";
}

TEST(BatchManifest, IsReadLineByLine) {
  const auto jobs = parsed(
      line("") + "\n\n" + R"({"id": "b.2", "do": "export", "source": ["x", "y"], "target": ["u", "v"]})" +
      "\r\n" + R"({"id": "c", "do": "export", "document": "d.understudy", "options": {"fps": 25}})");
  ASSERT_EQ(jobs.size(), 3u);
  EXPECT_EQ(jobs[0].command, "retarget") << "where a line does not say";
  EXPECT_EQ(jobs[0].sources, std::vector<std::string>{"s"});
  EXPECT_EQ(jobs[1].line, 3) << "blank lines count";
  EXPECT_EQ(jobs[1].targets, (std::vector<std::string>{"u", "v"}));
  EXPECT_EQ(jobs[2].document, "d.understudy");
  EXPECT_EQ(jobs[2].options["fps"], 25);
}

TEST(BatchManifest, RecordsAJobTheSameHoweverItsLineIsOrdered) {
  const auto one = parsed(line(R"(, "options": {"fps": 25, "no-offsets": true})"));
  const auto other = parsed(
      R"({"options": {"no-offsets": true, "fps": 25}, "target": "t", "do": "retarget", "source": ["s"], )"
      R"("id": "a"})");
  EXPECT_EQ(to_json(one[0]).dump(), to_json(other[0]).dump());
}

TEST(BatchManifest, RefusesUnknownKeysWithTheNearestKnown) {
  EXPECT_EQ(refusal(R"({"id": "a", "sorce": "s", "target": "t"})"),
            "jobs.jsonl line 1: 'sorce' is not known; the nearest that is: 'source'");
  EXPECT_EQ(refusal(line(R"(, "options": {"no-ofsets": true})")),
            "jobs.jsonl line 1: retarget option 'no-ofsets' is not known; the nearest that is: 'no-offsets'");
  EXPECT_EQ(refusal(line(R"(, "do": "exprot")")),
            "jobs.jsonl line 1: do: 'exprot' is not known; the nearest that is: 'export'");
}

TEST(BatchManifest, RefusesAnIdTwice) {
  EXPECT_EQ(refusal(line("") + "\n" + line("")), "jobs.jsonl line 2: the id 'a' is that of line 1");
}

TEST(BatchManifest, RefusesIdsThatAreNoPlainNames) {
  for (const char* id : {"../a", "a/b", "/etc/passwd", "..", ".", ".hidden", "-rf", "a\\\\b", "a\\nb", "",
                         "a.done.json", "a.failed.json"}) {
    const std::string said = refusal(std::string(R"({"id": ")") + id + R"(", "source": "s", "target": "t"})");
    EXPECT_NE(said.find("jobs.jsonl line 1: "), std::string::npos) << id << ": " << said;
  }
  EXPECT_NE(refusal(R"({"id": ")" + std::string(201, 'a') + R"(", "source": "s", "target": "t"})"), "");
  EXPECT_EQ(refusal(R"({"id": "Jörg walks_2.b-3", "source": "s", "target": "t"})"), "");
}

TEST(BatchManifest, RefusesOutputsOutsideOfTheJobsFolder) {
  for (const char* out : {"../x.glb", "/tmp/x.glb", "a/x.glb", "..", ".hidden"})
    EXPECT_NE(refusal(line(std::string(R"(, "options": {"out": ")") + out + R"("})")).find("no plain name"),
              std::string::npos)
        << out;
  EXPECT_EQ(refusal(line(R"(, "options": {"out": "x.glb"})")), "");
}

TEST(BatchManifest, RefusesValuesOfAnotherKind) {
  const auto option = [](const std::string& text) { return refusal(line(", \"options\": {" + text + "}")); };
  EXPECT_EQ(option(R"("no-offsets": 1)"), "jobs.jsonl line 1: option no-offsets must be true or false");
  EXPECT_NE(option(R"("fps": true)").find("option fps must be a text, a number or a list"),
            std::string::npos);
  EXPECT_NE(option(R"("fps": null)").find("option fps must be"), std::string::npos);
  EXPECT_NE(option(R"("fps": [])").find("option fps must be"), std::string::npos);
  EXPECT_NE(option(R"("fps": "")").find("option fps is empty"), std::string::npos);
  EXPECT_NE(option(R"("times": 3)").find("option times must be text"), std::string::npos);
  EXPECT_EQ(option(R"("fps": [1, "2"])"), "");
}

TEST(BatchManifest, RefusesLinesThatNameNoWork) {
  EXPECT_EQ(refusal(""), "jobs.jsonl: lists no job");
  EXPECT_EQ(refusal(R"({"source": "s", "target": "t"})"), "jobs.jsonl line 1: has no id");
  EXPECT_EQ(refusal(R"({"id": "a", "target": "t"})"), "jobs.jsonl line 1: has no source");
  EXPECT_EQ(refusal(R"({"id": "a", "source": "s"})"), "jobs.jsonl line 1: has no target");
  EXPECT_EQ(refusal(R"({"id": "a", "source": ["s", "r"], "target": "t"})"),
            "jobs.jsonl line 1: retarget takes one source and one target");
  EXPECT_EQ(refusal(R"({"id": "a", "document": "d"})"), "jobs.jsonl line 1: retarget takes no document");
  EXPECT_EQ(refusal(line("") + "\n[1]").find("jobs.jsonl line 2: is no object"), 0u);
  EXPECT_EQ(refusal(line("") + "\n{\"id\": ").find("jobs.jsonl line 2: is damaged at byte"), 0u);
}

}  // namespace
}  // namespace understudy::app
