#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "app/cli/evaluation.hpp"
#include "app/cli/options.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

MethodOptions parsed(const std::string& line) {
  CLI::App app;
  MethodOptions how;
  add_method_options(app, how);
  app.parse(line);
  return how;
}

TEST(MethodOptions, EverySwitchOfAMethodIsAnOption) {
  const Method off =
      parsed(
          "--engine paper --extractor paper --path in-place --no-part-refiner --no-repair-swaps "
          "--no-smooth-joints --no-fix-lengths --no-lock-feet --no-hand-contacts --no-offsets")
          .method;
  const Method all = {"paper", "paper", false, false, false, false, false, false, false, RootMode::InPlace};
  EXPECT_TRUE(same(off, all));
  EXPECT_TRUE(same(parsed("").method, Method{}));
  const Method by_old_names =
      parsed(
          "--engine paper --extractor paper --root in-place --no-near --no-swap-repair --no-smoothing "
          "--no-fixed-lengths --no-foot-lock --no-hand-contacts --no-offsets")
          .method;
  EXPECT_TRUE(same(by_old_names, all));
}

TEST(MethodOptions, OneOptionChoosesTheEngineOfWhatTheSourceIs) {
  EXPECT_EQ(flat_engine(parsed("")), "limbs");
  EXPECT_EQ(flat_engine(parsed("--engine limbs")), "limbs");
  EXPECT_EQ(failure_of([] { flat_engine(parsed("--engine positions")); }),
            "the engine 'positions' is for what moves in space; for 2D poses there are " +
                names_of(flat_engines(), ", "));
  EXPECT_EQ(parsed("").method.engine, "copy");
  EXPECT_THROW(parsed("--engine hybrid"), CLI::ValidationError);
}

TEST(ImportOptionsOfTheCommandLine, TurnByTheirNameAndTheOlderOne) {
  for (const char* line : {"--turn 30 --target-turn 20", "--yaw 30 --target-yaw 20"}) {
    CLI::App app;
    SourceOptions source;
    TargetOptions target;
    add_source_options(app, source);
    add_target_options(app, target);
    app.parse(line);
    EXPECT_EQ(source.import.turn_deg, 30) << line;
    EXPECT_EQ(target.import.turn_deg, 20) << line;
    EXPECT_FALSE(target.forward) << line;
  }
}

TEST(MethodOptions, ProportionsOfTheTargetHaveTheNamesThatTheStudioHas) {
  const Method method = parsed("--stride 1.5 --hip-height -0.1 --arm-reach 0.75").method;
  const RetargetOptions options = retarget_options(method);
  EXPECT_EQ(options.root.stride, 1.5f);
  EXPECT_EQ(options.root.hip_height_m, -0.1f);
  EXPECT_EQ(options.arm_reach, 0.75f);
  EXPECT_TRUE(options.places_limbs());
  EXPECT_FALSE(retarget_options(parsed("").method).places_limbs());
  EXPECT_THROW(parsed("--stride 0"), CLI::ValidationError);
  EXPECT_THROW(parsed("--arm-reach 2"), CLI::ValidationError);
}

TEST(MethodOptions, TurnBonesOfTheRestPose) {
  const MethodOptions how =
      parsed("--rest-pose left_shoulder=0,0,-30 --rest-pose right_shoulder=0,0,30.5 --stride 1");
  ASSERT_EQ(how.rest_pose.size(), 2u);
  EXPECT_NEAR(how.rest_pose[1].axis_angle.z(), 30.5f * kPi / 180, 1e-6f);
  const RetargetOptions options = retarget_options(how);
  ASSERT_TRUE(options.rest_pose);
  EXPECT_NEAR((*options.rest_pose)[LeftShoulder](0, 1), 0.5f, 1e-6f);
  EXPECT_FALSE(retarget_options(parsed("")).rest_pose);
  for (const char* wrong : {"left_ear=0,0,1", "head=1,2", "head", "head=1,2,3,4", "head=a,b,c"})
    EXPECT_THROW(parsed(std::string("--rest-pose ") + wrong), Error) << wrong;
}

TEST(MethodOptions, ReachThePipelineAndTheNetworks) {
  const RetargetOptions off =
      retarget_options(parsed("--root original --no-swap-repair --no-smoothing --no-fixed-lengths "
                              "--no-foot-lock --no-hand-contacts")
                           .method);
  EXPECT_FALSE(off.filter.repair_swaps || off.filter.smooth || off.filter.fix_lengths || off.lock_feet ||
               off.keep_contacts);
  EXPECT_EQ(off.root.mode, RootMode::Original);
  const nn::NetworkOptions networks = network_options(
      parsed("--engine paper --extractor paper --no-near --no-offsets --weights w --engine-weights e "
             "--extractor-weights x"));
  EXPECT_FALSE(networks.near || networks.offsets);
  EXPECT_EQ(networks.engine + networks.extractor, "paperpaper");
  EXPECT_EQ(networks.weights + networks.engine_file + networks.extractor_file, "wex");
}

/// What the report of an evaluation says of its method: "engine copy, no near".
std::string reported(const std::string& line) {
  EvalOptions options;
  options.how = parsed(line);
  options.how.weights = "no/such/folder";
  const Json report = report_of(options, Evaluation());
  std::string all;
  for (const auto& [key, value] : report.items())
    if (value == false)
      append_item(all, "no " + key);
    else if (key == "extractor" || key == "path" || key == "engine")
      append_item(all, key + " " + value.get<std::string>());
  return all;
}

TEST(EvaluationReport, NamesWhatOfTheMethodIsSwitched) {
  EXPECT_EQ(reported(""), "engine " + Method().engine);
  EXPECT_EQ(reported("--no-hand-contacts"), "engine " + Method().engine + ", no hand_contacts");
  EXPECT_EQ(reported("--engine paper --extractor paper --path in-place --no-part-refiner --no-repair-swaps "
                     "--no-smooth-joints --no-fix-lengths --no-lock-feet --no-hand-contacts --no-offsets"),
            "engine paper, no offsets, no repair_swaps, no smooth_joints, no fix_lengths, no lock_feet, "
            "no hand_contacts, no part_refiner, extractor paper, path in-place");
  EvalOptions turned;
  turned.how = parsed("--rest-pose left_shoulder=0,0,-30 --rest-pose head=30.5,0,1");
  turned.how.weights = "no/such/folder";
  EXPECT_EQ(report_of(turned, Evaluation())["rest_pose"],
            Json::array({"left_shoulder=0,0,-30", "head=30.5,0,1"}));
}

}  // namespace
}  // namespace understudy::app
