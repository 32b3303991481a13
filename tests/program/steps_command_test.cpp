// `understudy train motion-space --form paper` and `understudy steps`: steps as codes, learned and judged.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/cli_fixture.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::tests {
namespace {

using Json = nlohmann::json;

class Stepping : public ShippedProgram {
 protected:
  Stepping() {
    test::write_training_folder(data_);
    for (const char* part : {"/motion/a/walk_poses.npz", "/motion/b/walk_poses.npz"})
      test::write_walk_clip(data_ + part);
    std::filesystem::create_directories(weights_);
  }
  Finished train(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"train",     "motion-space",
                                          "--form",    "paper",
                                          "--data",    data_,
                                          "--out",     weights_ + "/motion_steps.weights",
                                          "--batch",   "4",
                                          "--samples", "8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  const std::string data_ = scratch.path("data"), weights_ = scratch.path("weights");
};

TEST_F(Stepping, WhatWasLearnedIsJudgedBesideLinearCoders) {
  const Finished learned = train({"--code", "4"});
  ASSERT_EQ(learned.code, 0) << learned.err;
  const Finished judged =
      run_program({"steps", data_, "--weights", weights_, "--linear", "2,3", "--out", out("steps.json")});
  ASSERT_EQ(judged.code, 0) << judged.err;
  EXPECT_NE(judged.out.find("linear 3 by reach"), std::string::npos) << judged.out;
  const Json report = Json::parse(read_bytes(out("steps.json")));
  ASSERT_EQ(report["coders"].size(), 5u) << report.dump();
  EXPECT_EQ(report["coders"][0]["size"], 4);
  for (const Json& coder : report["coders"]) {
    EXPECT_GT(coder["all"]["steps"], 5);
    EXPECT_GT(coder["all"]["mve_m"].get<double>(), 0);
    EXPECT_LT(coder["all"]["mve_m"].get<double>(), 0.6) << coder.dump();
  }
}

TEST_F(Stepping, WhatCannotBeIsSaid) {
  expect_clean_failure(run_program({"steps", data_, "--weights", scratch.path("absent")}),
                       "motion_steps.weights");
  expect_clean_failure(run_program({"steps", scratch.path("nothing")}), "splits.json");
  EXPECT_EQ(run_program({"train", "motion-space", "--form", "waltz", "--data", data_, "--out", "x"}).code, 2);
  ASSERT_EQ(train({"--code", "4"}).code, 0);
  expect_clean_failure(run_program({"steps", data_, "--weights", weights_, "--linear", "900"}), "900");
  std::ofstream(weights_ + "/motion_steps.weights", std::ios::binary) << "no weights";
  expect_clean_failure(run_program({"steps", data_, "--weights", weights_}), "motion_steps.weights");
}

TEST_F(Stepping, AllOptionsOfAFormCanBeChosen) {
  const Finished plain =
      train({"--code", "4", "--no-surface", "--not-told", "--no-times", "--clips", "0.5", "--kl", "0.1"});
  ASSERT_EQ(plain.code, 0) << plain.err;
}

}  // namespace
}  // namespace understudy::tests
