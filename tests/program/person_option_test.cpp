// --person of the shipped program's commands, good and bad, on a scene of two people and a ground.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "retarget/formats/npz.hpp"
#include "tests/app/cli_fixture.hpp"
#include "tests/retarget/scene/made_scene.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class PersonOption : public ShippedProgram {
 protected:
  static constexpr int kShown = 3;

  void SetUp() override {
    test::Actor left, right;
    left.place = {-0.9f, 0, 0}, right.place = {0.9f, 0, 0.3f};
    left.points = 2500, right.points = 4500;
    right.motion = "dance";
    test::MadeScene scene({left, right});
    scene.add_ground(2, 5000);
    NpyArray points;
    for (int t = 0; t < kShown; ++t) {
      const Points now = scene.frame(3 * t).scan.vertices;
      points.shape = {kShown, now.rows(), 3};
      points.values.insert(points.values.end(), now.data(), now.data() + now.size());
    }
    write_npz(source(), {{"points", points}});
  }

  std::string source() { return scratch.path("scene.npz"); }
  Finished run(const std::string& command, const std::string& person, const std::string& to) {
    std::vector<std::string> arguments = {command, "--source", source(), "--target", target()};
    if (command == "measure") arguments = {command, source()};
    for (const std::string& more : {std::string("--person"), person, std::string("--out"), to})
      arguments.push_back(more);
    return run_program(arguments);
  }
  /// Where the source's pelvis is in what `retarget` wrote, metres along x.
  static float pelvis_x(const std::string& path) { return read_npz(path).at("source_joints").values[0]; }
};

TEST_F(PersonOption, RetargetTakesANumberTheLargestOrAll) {
  for (const char* person : {"1", "2", "largest", "all"}) {
    const Finished done = run("retarget", person, out(std::string(person) + ".npz"));
    ASSERT_EQ(done.code, 0) << person << done.err;
  }
  const float one = pelvis_x(out("1.npz")), two = pelvis_x(out("2.npz"));
  EXPECT_GT(std::abs(one - two), 1.2f);
  EXPECT_GT(pelvis_x(out("largest.npz")), 0.5f);
  EXPECT_NEAR(pelvis_x(out("all-1.npz")), one, 0.05f);
  EXPECT_NEAR(pelvis_x(out("all-2.npz")), two, 0.05f);
}

TEST_F(PersonOption, ExportTakesANumberTheLargestOrAll) {
  for (const char* person : {"2", "largest", "all"}) {
    const Finished done = run("export", person, out(std::string(person) + ".glb"));
    ASSERT_EQ(done.code, 0) << person << done.err;
    EXPECT_TRUE(std::filesystem::exists(out(std::string(person) + ".glb"))) << person;
  }
  EXPECT_GT(read_bytes(out("all.glb")).size(), read_bytes(out("2.glb")).size());
}

TEST_F(PersonOption, MeasureTakesANumberTheLargestOrAll) {
  for (const char* person : {"1", "largest", "all"}) {
    const Finished done = run("measure", person, out(std::string(person) + ".json"));
    ASSERT_EQ(done.code, 0) << person << done.err;
  }
  const Json one = Json::parse(read_bytes(out("1.json"))),
             largest = Json::parse(read_bytes(out("largest.json")));
  EXPECT_EQ(one.at("person"), 1);
  EXPECT_EQ(one.at("people").size(), 2u);
  EXPECT_EQ(largest.at("frames"), kShown);
  EXPECT_EQ(Json::parse(read_bytes(out("all.json"))).at("measured").size(), 2u);
}

TEST_F(PersonOption, ANumberThatNobodyHasSaysWhoIsThere) {
  for (const char* command : {"retarget", "export", "measure"})
    expect_clean_failure(run(command, "7", out(std::string(command) == "measure" ? "a.json" : "a.glb")),
                         "there is no person 7 in it; it shows person 1 in 3 frames, person 2 in 3 frames");
}

TEST_F(PersonOption, AWordThatIsNoneIsRefused) {
  for (const char* command : {"retarget", "export", "measure"})
    for (const char* word : {"nobody", "0"})
      expect_clean_failure(run(command, word, out(std::string(command) == "measure" ? "a.json" : "a.glb")),
                           "--person " + std::string(word));
}

}  // namespace
}  // namespace understudy::tests
