#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/cli/evaluation.hpp"
#include "app/run/case_maker.hpp"
#include "app/run/case_source.hpp"
#include "app/run/case_writer.hpp"
#include "app/run/gap_case_writer.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/body/marker_places.hpp"
#include "tests/app/program.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::app {
namespace {

TEST(GapPlan, WindowsLieBetweenBadFrames) {
  GapPlan plan{30, 2, 3, 3, 4, {}};  // windows of 8 frames
  EXPECT_EQ(window_starts(plan), (std::vector<int>{0, 4, 8, 12, 16, 20}));
  plan.bad_frames = {0, 14, 15, 24};
  EXPECT_EQ(window_starts(plan), (std::vector<int>{1, 5, 16}));
  const std::vector<bool> known = known_frames(plan);
  for (int t = 0; t < 30; ++t)
    EXPECT_EQ(known[static_cast<size_t>(t)], t != 4 && t != 5 && t != 8 && t != 9 && t != 19 && t != 20) << t;
}

TEST(GapPlan, NothingIsKnownAfterWhatIsPredicted) {
  const auto plan =
      gap_plan(nlohmann::json::parse(R"({"frames": 12, "gap": 3, "seen": 2, "every": 7})"), "case.json");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->after, 0);
  EXPECT_EQ(window_starts(*plan), (std::vector<int>{0, 7}));
  EXPECT_EQ(window_known(*plan), (std::vector<bool>{true, true, false, false, false}));
}

TEST(GapPlan, ASequenceOfFewKnownFramesIsOneWindow) {
  const auto plan = gap_plan(nlohmann::json::parse(R"({"frames": 5, "known": [0, 3]})"), "case.json");
  ASSERT_TRUE(plan);
  EXPECT_EQ(window_starts(*plan), std::vector<int>{0});
  EXPECT_EQ(plan->window(), 5);
  EXPECT_EQ(known_frames(*plan), (std::vector<bool>{true, false, false, true, false}));
  EXPECT_EQ(window_known(*plan), known_frames(*plan));
}

TEST(GapPlan, KnownFramesLieEvenly) {
  EXPECT_EQ(evenly_known(100, 2), (std::vector<int>{0, 99}));
  EXPECT_EQ(evenly_known(100, 5), (std::vector<int>{0, 25, 50, 74, 99}));
  EXPECT_EQ(evenly_known(100, 100).size(), 100u);
  EXPECT_THROW(evenly_known(100, 1), Error);
  EXPECT_THROW(evenly_known(100, 101), Error);
}

TEST(GapPlan, IsReadFromACase) {
  const auto read = [](const char* text) { return gap_plan(nlohmann::json::parse(text), "case.json"); };
  EXPECT_FALSE(read(R"({"fps": 30})"));
  const auto plan = read(R"({"frames": 30, "gap": 5, "ends": 2, "every": 9, "bad_frames": [3]})");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->window(), 9);
  EXPECT_EQ(plan->before, 2);
  EXPECT_EQ(plan->after, 2);
  EXPECT_EQ(plan->every, 9);
  EXPECT_EQ(plan->bad_frames, std::vector<int>{3});
  for (const char* wrong :
       {R"({"gap": 5, "ends": 2, "every": 9})", R"({"frames": 30, "gap": 0, "ends": 2, "every": 9})",
        R"({"frames": 30, "gap": 5, "ends": 0, "every": 9})",   // no frame is known
        R"({"frames": 30, "gap": 27, "ends": 2, "every": 9})",  // longer than the clip
        R"({"frames": 30, "gap": 5, "ends": 2, "every": 0})",
        R"({"frames": 30, "gap": 5, "ends": 2, "every": 9, "bad_frames": [4, 4]})",
        R"({"frames": 30, "gap": 5, "ends": 2, "every": 9, "bad_frames": [30]})",
        R"({"frames": 1e30, "gap": 5, "ends": 2, "every": 9})",
        R"({"frames": 30, "gap": 5, "seen": 0, "every": 9})",
        R"({"frames": 30, "gap": 25, "seen": 6, "every": 9})",  // longer than the clip
        R"({"frames": 30, "known": []})", R"({"frames": 30, "known": [30]})",
        R"({"frames": 30, "known": [2, 2]})", R"({"known": [2]})"})
    EXPECT_THROW(read(wrong), Error) << wrong;
}

/// Cases of somebody who glides at `speed` metres a frame, with gaps of two frames.
class GapCases : public testing::Test {
 protected:
  void make(const std::string& name, int frames, float speed) {
    const std::string folder = scratch.path("cases/" + name);
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/case.json")
        << R"({"truth": "truth.npz", "gap": 2, "ends": 3, "every": 4, "tags": ["inbetween"], "frames": )"
        << frames << "}";
    Joints rest = builtin_person().joints;
    rest.col(1).array() -= rest(LeftFoot, 1);  // on the floor
    JointSequence joints(static_cast<size_t>(frames), rest);
    for (int t = 0; t < frames; ++t)
      joints[static_cast<size_t>(t)].col(0).array() += speed * static_cast<float>(t);
    Npz truth{{"joints", frames_array(joints, {kJointCount, 3})},
              {"rotations", rotations_array(std::vector<Rotations>(joints.size(), identity_rotations()))},
              {"target_joints", frames_array(JointSequence{rest}, {kJointCount, 3})}};
    truth["target_joints"].shape = {kJointCount, 3};
    write_npz(folder + "/truth.npz", truth);
  }
  Evaluation evaluated(const std::string& fill) {
    EvalOptions options;
    options.cases = scratch.path("cases");
    options.oracle = "pose";
    options.fill = fill;
    return evaluate(options, [](const CaseResult&) {});
  }
  static double figure(const Metrics& metrics, const std::string& key) {
    for (const auto& [name, value] : metrics)
      if (name == key) return value;
    return std::nan("");
  }
  tests::ScratchFolder scratch;
};

TEST_F(GapCases, AreFilledWindowByWindowAndEvaluatedInTheGapsAlone) {
  make("a", 16, 0.1f);
  const Evaluation held = evaluated("hold");
  ASSERT_EQ(held.results[0].error, "");
  EXPECT_EQ(held.results[0].frames, 6);  // three windows
  const Metrics& metrics = held.results[0].metrics;
  EXPECT_NEAR(figure(metrics, "gap_mpjpe_m"), 0.15, 1e-5);
  EXPECT_NEAR(figure(metrics, "gap_rel_mpjpe_m"), 0, 1e-6);
  EXPECT_NEAR(figure(metrics, "seam_m"), (0.1 + 0 + 0.3 + 0.2) / 4, 1e-5);
  EXPECT_NEAR(figure(metrics, "gap_foot_skate"), 30 * (0 + 0 + 0.3) / 3, 1e-4);
  EXPECT_NEAR(figure(metrics, "gap_foot_skate_true"), 30 * 0.1, 1e-4);
  EXPECT_TRUE(std::isnan(figure(metrics, "mpjpe_m")));
  for (const char* straight : {"slerp", "hermite"})
    EXPECT_NEAR(figure(evaluated(straight).mean, "gap_mpjpe_m"), 0, 1e-5) << straight;
}

TEST_F(GapCases, EveryGapCountsAlikeInTheMean) {
  make("a", 16, 0.1f);  // three windows
  make("b", 8, 0.3f);   // one
  EXPECT_NEAR(figure(evaluated("hold").mean, "gap_mpjpe_m"), (3 * 0.15 + 0.45) / 4, 1e-5);
  const Json report = report_of({}, evaluated("hold"));
  EXPECT_EQ(report["fill"], kDefaultMotionSpace);  // those options'
  EXPECT_NEAR(report["mean"]["gap_mpjpe_m"], 0.225, 1e-5);
}

TEST_F(GapCases, AreRefusedWhereTheyCannotBeEvaluated) {
  make("a", 16, 0.1f);
  EXPECT_NE(evaluated("magic").results[0].error.find("hold, glide, coast, slerp"), std::string::npos);
  EXPECT_NE(evaluated("nearest").results[0].error.find("--data"), std::string::npos);
  EvalOptions options;
  options.cases = scratch.path("cases");
  const auto error = [&] { return evaluate(options, [](const CaseResult&) {}).results[0].error; };
  EXPECT_NE(error().find("no scans"), std::string::npos) << error();
  options.oracle = "skeleton";
  EXPECT_NE(error().find("--oracle skeleton"), std::string::npos) << error();
  make("a", 15, 0.1f);  // case.json and truth disagree
  std::ofstream(scratch.path("cases/a/case.json"))
      << R"({"truth": "truth.npz", "gap": 2, "ends": 3, "every": 4, "frames": 16})";
  EXPECT_NE(evaluated("hold").results[0].error.find("case.json says 16"), std::string::npos);
}

class InbetweenSuite : public testing::Test {
 protected:
  InbetweenSuite() {
    test::write_training_folder(scratch.path("data"));  // the clip has 60 frames, 5 is flagged
    options.data = scratch.path("data");
    options.out = scratch.path("cases");
    options.suite = "inbetween";
    options.gap = 15;
    options.points = 0;
  }
  std::vector<std::string> make() {
    std::vector<std::string> names;
    make_suite(options, [&](const std::string& name) { names.push_back(name); });
    return names;
  }
  tests::ScratchFolder scratch;
  SuiteOptions options;
};

TEST_F(InbetweenSuite, HasEachClipWholeWithoutScans) {
  ASSERT_EQ(make(), std::vector<std::string>{"two_poses"});
  const Case c = read_case(options.out + "/two_poses");
  EXPECT_TRUE(c.source.empty());
  EXPECT_TRUE(c.target.empty());
  EXPECT_EQ(c.tags, std::vector<std::string>{"inbetween"});
  ASSERT_TRUE(c.gaps);
  EXPECT_EQ(c.gaps->frames, 60);
  EXPECT_EQ(c.gaps->before, 10);
  EXPECT_EQ(c.gaps->after, 10);
  EXPECT_EQ(c.gaps->bad_frames, std::vector<int>{5});
  EXPECT_EQ(window_starts(*c.gaps), (std::vector<int>{6, 21}));
  const Truth truth = read_truth(c.truth);
  EXPECT_EQ(truth.frames, 60);
  ASSERT_TRUE(truth.target_joints);
  const Pose pose{truth.rotations[30], truth.joints[30].row(Pelvis).transpose()};
  EXPECT_TRUE(forward_kinematics(*truth.target_joints, pose).joints.isApprox(truth.joints[30], 1e-5f));
  EXPECT_LT(truth.joints[30].col(1).minCoeff(), 0.2f);  // it stands on the floor
  EXPECT_GT(truth.joints[30].col(1).minCoeff(), -0.1f);
}

TEST_F(InbetweenSuite, ScansOfUnknownFramesAreMissing) {
  options.points = 200;
  options.frames = 58;
  make();
  const Case c = read_case(options.out + "/two_poses");
  EXPECT_EQ(c.gaps->every, 25);
  EXPECT_EQ(c.gaps->frames, 58);
  EXPECT_EQ(window_starts(*c.gaps), std::vector<int>{6});  // the next would end beyond
  EXPECT_EQ(read_truth(c.truth).vertex_count, 88);
  for (int t = 0; t < 60; ++t) {
    const std::string number = std::to_string(t);
    const bool there =
        std::filesystem::exists(c.source + "/frame_" + std::string(5 - number.size(), '0') + number + ".ply");
    EXPECT_EQ(there, t < 58 && (t < 16 || t > 30)) << t;
  }
}

TEST_F(InbetweenSuite, TheSameOptionsGiveTheSameFiles) {
  options.points = 200;
  make();
  const auto bytes = [&] { return tests::read_bytes(options.out + "/two_poses/source/frame_00003.ply"); };
  const std::string before = bytes();
  make();
  EXPECT_EQ(bytes(), before);
}

TEST_F(InbetweenSuite, RefusesWhatNoClipHas) {
  options.gap = 50;  // longer than the clip
  EXPECT_THROW(make(), Error);
  options.gap = 0;
  EXPECT_THROW(make(), Error);
  options.gap = 5;
  options.walks = true;  // no clip says that it is one
  EXPECT_THROW(make(), Error);
}

/// The suites predict and sparse, of the same folder, to which somebody who walks is added.
class WalkingSuite : public InbetweenSuite {
 protected:
  WalkingSuite() { options.gap = 0; }
  Evaluation filled(const std::string& fill) {
    EvalOptions eval;
    eval.cases = options.out;
    eval.oracle = "pose";
    eval.fill = fill;
    return evaluate(eval, [](const CaseResult&) {});
  }
  const Motion walk = test::write_walk_clip(scratch.path("data/motion/b/walk_poses.npz"));
  static double mean(const Evaluation& evaluation, const std::string& key) {
    for (const auto& [name, value] : evaluation.mean)
      if (name == key) return value;
    return std::nan("");
  }
};

TEST_F(WalkingSuite, PredictsFromEightFramesOn) {
  options.suite = "predict";
  ASSERT_EQ(make(), (std::vector<std::string>{"two_poses", "walk_poses"}));
  const Case c = read_case(options.out + "/walk_poses");
  ASSERT_TRUE(c.gaps);
  EXPECT_EQ(c.gaps->before, 8);
  EXPECT_EQ(c.gaps->after, 0);
  EXPECT_EQ(c.gaps->gap, 15);
  EXPECT_EQ(c.tags[0], "predict");
  const Evaluation held = filled("hold"), glided = filled("glide");
  for (const char* key : {"mve_3_m", "mve_8_m", "mve_15_m", "gap_mpjpe_m"})
    EXPECT_GT(mean(held, key), 0) << key;
  EXPECT_LT(mean(held, "mve_3_m"), mean(held, "mve_8_m"));
  EXPECT_LT(mean(glided, "mve_15_m"), 0.5 * mean(held, "mve_15_m"));
  options.gap = 20;
  make();
  EXPECT_EQ(read_case(options.out + "/walk_poses").gaps->gap, 20);
}

TEST_F(WalkingSuite, StepsHaveAHundredFramesHoweverLongTheyTake) {
  options.suite = "sparse";
  options.known = 5;
  const auto names = make();
  ASSERT_GE(names.size(), 2u);
  for (const std::string& name : names) {
    EXPECT_EQ(name.find("walk_poses_"), 0u) << name;
    const Case c = read_case(options.out + "/" + name);
    EXPECT_TRUE(c.source.empty());
    EXPECT_GT(c.fps, 33);  // at most three seconds
    ASSERT_TRUE(c.gaps);
    EXPECT_EQ(c.gaps->known_alone, evenly_known(100, 5));
    const Truth truth = read_truth(c.truth);
    EXPECT_EQ(truth.frames, 100);
    EXPECT_EQ(truth.skin.rest.rows(), 88);
    const int first = std::stoi(name.substr(11, 4)), frames = static_cast<int>(std::lround(2970 / c.fps));
    for (const int t : {0, 99}) {
      const Pose& pose = walk.poses[first + (t == 0 ? 0 : frames)];
      EXPECT_TRUE(truth.rotations[t][LeftKnee].isApprox(pose.local[LeftKnee], 1e-4f)) << name << t;
    }
  }
  const Evaluation slerped = filled("slerp"), curved = filled("hermite");
  EXPECT_EQ(slerped.results[0].frames, 95);
  EXPECT_TRUE(std::isnan(mean(slerped, "chamfer_m")));  // of few points nothing is told
  EXPECT_GT(mean(slerped, "mve_m"), 0);
  EXPECT_LT(mean(curved, "mve_m"), mean(slerped, "mve_m"));
  options.known = 20;
  make();
  EXPECT_LT(mean(filled("slerp"), "mve_m"), 0.4 * mean(slerped, "mve_m"));
}

TEST_F(WalkingSuite, KnownFramesHavePointsTimesAndMarkers) {
  options.suite = "sparse";
  options.known = 5;
  options.points = 50;
  options.markers = 16;
  options.cases = 1;
  const auto names = make();
  ASSERT_EQ(names.size(), 1u);
  const Case c = read_case(options.out + "/" + names[0]);
  const auto known = known_frames_of(c);
  const Truth truth = read_truth(c.truth);
  ASSERT_EQ(known.size(), 5u);
  for (size_t i = 0; i < known.size(); ++i) {
    EXPECT_EQ(known[i].frame, evenly_known(100, 5)[i]);
    EXPECT_NEAR(known[i].seconds * c.fps, static_cast<double>(known[i].frame), 1e-6);
    EXPECT_EQ(known[i].points.rows(), 50);
    ASSERT_EQ(known[i].markers.size(), 16u);
    const Points vertices = truth.frame_vertices(known[i].frame);
    for (const Marker& marker : known[i].markers) {
      EXPECT_GE(marker_named(marker.name), 0) << marker.name;
      EXPECT_LT((vertices.rowwise() - marker.place.transpose()).rowwise().norm().minCoeff(), 1e-5f);
    }
    // on the surface: the boxes of the body are 12 cm wide
    for (int p = 0; p < 50; ++p)
      EXPECT_LT((vertices.rowwise() - known[i].points.row(p)).rowwise().norm().minCoeff(), 0.2f);
  }
  const std::string before = tests::read_bytes(c.source + "/frame_00025.ply");
  make();
  EXPECT_EQ(tests::read_bytes(c.source + "/frame_00025.ply"), before);
}

TEST_F(WalkingSuite, MarkersAloneMakeACase) {
  options.suite = "sparse";
  options.known = 2;
  options.markers = 16;
  options.cases = 1;
  const Case c = read_case(options.out + "/" + make().at(0));
  EXPECT_TRUE(c.source.empty());
  EXPECT_FALSE(c.target.empty());
  const auto known = known_frames_of(c);
  ASSERT_EQ(known.size(), 2u);
  EXPECT_EQ(known[1].points.rows(), 0);
  EXPECT_EQ(known[1].markers.size(), 16u);
}

TEST_F(WalkingSuite, MarkersOfOtherFramesAreRefused) {
  options.suite = "sparse";
  options.known = 2;
  options.markers = 16;
  options.cases = 1;
  Case c = read_case(options.out + "/" + make().at(0));
  c.fps = 30;
  for (const char* seconds : {"0.5166", "3.34"}) {
    std::ofstream(c.markers) << "seconds,name,x,y,z\n"
                             << seconds << ",a,0,0,0\n"
                             << seconds << ",b,0,0,0\n"
                             << seconds << ",c,0,0,0\n";
    EXPECT_THROW(known_frames_of(c), Error) << seconds;
  }
}

TEST_F(WalkingSuite, RefusesWhatItCannotMake) {
  options.suite = "sparse";
  EXPECT_THROW(make(), Error);  // how many frames are known is not said
  options.known = 5;
  options.markers = 7;
  EXPECT_THROW(make(), Error);
  options.markers = 0;
  options.walks = true;  // no clip says that it is one
  EXPECT_THROW(make(), Error);
}

TEST_F(WalkingSuite, MissingNumbersAreWhatIsToBeMade) {
  options.suite = "sparse";
  options.known = 5;
  options.points = 40;
  options.cases = 1;
  const std::string folder = options.out + "/" + make().at(0);
  const auto plan_of = [&](const std::string& json) {
    std::ofstream(folder + "/case.json") << json;
    return read_case(folder).gaps;
  };
  const auto plan = plan_of(R"({"source": "source", "truth": "truth.npz", "frames": 100})");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->known_alone, evenly_known(100, 5));
  EXPECT_FALSE(plan_of(R"({"source": "source", "truth": "truth.npz"})"));
  EXPECT_THROW(plan_of(R"({"source": "source", "frames": "many"})"), Error);
  for (int t = 1; t < 100; ++t)
    std::filesystem::copy_file(folder + "/source/frame_00000.ply",
                               folder + printed("/source/frame_%05d.ply", t),
                               std::filesystem::copy_options::skip_existing);
  EXPECT_FALSE(plan_of(R"({"source": "source", "truth": "truth.npz", "frames": 100})"));  // none is missing
}

TEST(GapTags, TellWhoTravels) {
  Motion motion{30, std::vector<Pose>(31), {}};
  EXPECT_EQ(gap_tags("inbetween", motion, {"jump"}), (std::vector<std::string>{"inbetween", "jump"}));
  EXPECT_EQ(gap_tags("inbetween", motion, {"run", "turn"}),
            (std::vector<std::string>{"inbetween", "travels", "run", "turn"}));
  for (int t = 0; t < 31; ++t) motion.poses[static_cast<size_t>(t)].root.z() = 0.021f * static_cast<float>(t);
  EXPECT_EQ(gap_tags("inbetween", motion, {"dance"}),
            (std::vector<std::string>{"inbetween", "travels", "dance"}));
  motion.fps = 25;
  EXPECT_EQ(gap_tags("inbetween", motion, {"dance"}), (std::vector<std::string>{"inbetween", "dance"}));
}

}  // namespace
}  // namespace understudy::app
