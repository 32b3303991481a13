// `understudy study stimuli`: the clips of a small study, made by the shipped program.
#include <nlohmann/json.hpp>

#include "tests/app/cli_fixture.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class StudyStimuli : public ShippedProgram {
 protected:
  /// Two methods, one motion of a few scans, one target, 96 x 64.
  std::string study(const std::function<void(Json&)>& change = nullptr) {
    const std::string file = scratch.path("a.study");
    std::filesystem::remove(file);
    EXPECT_EQ(run_program({"study", "new", "--preset", "rekik", "--out", file}).code, 0);
    Json json = Json::parse(read_bytes(file));
    for (const char* list : {"motions", "targets"}) json[list] = Json::array({json[list][0]});
    json["conditions"].erase(2);
    json["motions"][0]["source"]["path"] = scans();
    json["targets"][0]["target"]["path"] = target();
    json["picture"]["width"] = 96, json["picture"]["height"] = 64, json["picture"]["fps"] = 10;
    json["clip"]["seconds"] = 1, json["clip"]["card_s"] = 0.1;
    if (change) change(json);
    write_text(file, json.dump());
    return file;
  }
  Finished make(const std::string& file, std::vector<std::string> more = {}, ProgramOptions options = {}) {
    std::vector<std::string> arguments = {"study", "stimuli", file, "--out", scratch.path("stimuli")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, std::move(options));
  }
};

TEST_F(StudyStimuli, MakesEveryClipAndThenNone) {
  const std::string file = study();
  const Finished made = make(file, {"--separate"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("2 clips, 2 made now"), std::string::npos) << made.out;
  const Json manifest = Json::parse(read_bytes(scratch.path("stimuli/manifest.json")));
  ASSERT_EQ(manifest["clips"].size(), 2u);
  for (const Json& clip : manifest["clips"]) {
    EXPECT_EQ(read_bytes(scratch.path("stimuli/" + clip["file"].get<std::string>())).substr(4, 4), "ftyp");
    EXPECT_EQ(clip["panes"].size(), 3u);
  }
  EXPECT_EQ(line_count(read_bytes(scratch.path("stimuli/manifest.csv"))), 3);
  const Finished again = make(file, {"--separate"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find("2 clips, all were there"), std::string::npos) << again.out;
}

TEST_F(StudyStimuli, ControlCLeavesNoHalfClip) {
  const std::string file = study([](Json& json) {
    json["clip"]["seconds"] = 600;
    json["picture"]["width"] = 1280, json["picture"]["height"] = 720;
  });
  Program program({"study", "stimuli", file, "--out", scratch.path("stimuli")});
  ASSERT_TRUE(program.wait_for("clip 1 of 2")) << program.finish().err;
  program.send(SIGINT);
  const Finished run = program.finish();
  expect_clean_failure(run, "interrupted: 0 of 2 clips are finished, the same command makes the rest");
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("stimuli/clips")));
  EXPECT_FALSE(std::filesystem::exists(scratch.path("stimuli/manifest.json")));
}

TEST_F(StudyStimuli, SaysWhichConditionHasLostItsFileOrIsOfAnotherLength) {
  const auto with_file = [&](const std::string& path) {
    return study([&](Json& json) {
      json["conditions"][1] = {{"name", "H4D"},
                               {"kind", "files"},
                               {"files", Json::array({{{"motion", ""}, {"target", ""}, {"path", path}}})}};
    });
  };
  const std::string gone = scratch.path("h4d");
  expect_clean_failure(make(with_file(gone)), "condition 'H4D': " + gone + " is gone");
  write_scans(scratch.path("h4d"), 3 * kFrames);
  expect_clean_failure(make(with_file(gone)), "the clips of a trial must be equally long");
  EXPECT_FALSE(std::filesystem::exists(scratch.path("stimuli/manifest.json")));
}

TEST_F(StudyStimuli, RefusesAFolderThatCannotBeWrittenAndAFullDisk) {
  const std::string file = study();
  write_text(scratch.path("stimuli"), "a file");
  expect_clean_failure(make(file), "stimuli: cannot be made a folder");
  std::filesystem::remove(scratch.path("stimuli"));
  std::filesystem::create_directories(scratch.path("stimuli/clips"));
  std::filesystem::permissions(scratch.path("stimuli/clips"),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  ProgramOptions no_root;
  no_root.obey_permissions = true;
  expect_clean_failure(make(file, {}, no_root), "cannot be written");
  std::filesystem::permissions(scratch.path("stimuli/clips"), std::filesystem::perms::owner_all);
  ProgramOptions full;
  full.file_size_limit = 2000;
  expect_clean_failure(make(file, {}, full), "cannot be written");
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("stimuli/clips")));
}

}  // namespace
}  // namespace understudy::tests
