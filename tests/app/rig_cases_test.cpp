#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/cli/evaluation.hpp"
#include "app/run/case_maker.hpp"
#include "app/run/rig_evaluation.hpp"
#include "app/run/rig_finder.hpp"
#include "app/run/rig_truth_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/mesh_reader.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/app/program.hpp"
#include "tests/support/moving_arm.hpp"
#include "tests/support/training_folder.hpp"

namespace understudy::app {
namespace {

double figure(const Metrics& metrics, const std::string& key) {
  for (const auto& [name, value] : metrics)
    if (name == key) return value;
  return NAN;
}

class RigCases : public testing::Test {
 protected:
  RigCases() {
    options.out = scratch.path("cases");
    options.suite = "creatures";
    options.frames = 6;
    options.points = 1500;
  }
  int make() {
    return make_suite(options, [this](const std::string& name) { names.push_back(name); });
  }
  Case made(const std::string& name) { return read_case(options.out + "/" + name); }
  tests::ScratchFolder scratch;
  SuiteOptions options;
  std::vector<std::string> names;
};

/// The true rig of a case of one that turns in hinges and balls alone.
FoundRig true_rig(const RigTruth& truth) {
  FoundRig rig;
  const Points joints = truth.joints[0];
  for (int j = 0; j < truth.count(); ++j) {
    const Vec3 rest = truth.bones[0][j].inverse()(joints.row(j).transpose());
    const bool hinge = !truth.axes[j].isZero();
    rig.found.rig.joints.push_back({"j" + std::to_string(j), truth.parents[j],
                                    j == 0  ? JointKind::Free
                                    : hinge ? JointKind::Hinge
                                            : JointKind::Ball,
                                    rest, hinge ? truth.axes[j] : Vec3::UnitY()});
  }
  rig.found.rig.surface = {truth.rest, truth.faces};
  rig.found.rig.skin = SkinWeights::from(truth.weights);
  for (const BoneMotions& bones : truth.bones)
    rig.found.motion.poses.push_back(pose_of(rig.found.rig, bones));
  return rig;
}

TEST(RigTruthFile, IsReadAsItWasWritten) {
  tests::ScratchFolder scratch;
  const RigTruth truth = truth_of(test::bending_arm(4));
  write_npz(scratch.path("truth.npz"), rig_truth_arrays(truth));
  const Truth read = read_truth(scratch.path("truth.npz"));
  ASSERT_TRUE(read.rig);
  EXPECT_EQ(read.frames, 4);
  EXPECT_TRUE(read.joints.empty());
  EXPECT_EQ(read.rig->parents, truth.parents);
  EXPECT_EQ(read.rig->weights, truth.weights);
  EXPECT_EQ(read.rig->faces, truth.faces);
  EXPECT_EQ(read.rig->rest, truth.rest);
  EXPECT_EQ(read.rig->vertices[3], truth.vertices[3]);
  EXPECT_EQ(read.rig->joints[3], truth.joints[3]);
  EXPECT_EQ(read.rig->axes, truth.axes);
  EXPECT_EQ(read.rig->bones[2][1].R, truth.bones[2][1].R);
  EXPECT_EQ(read.rig->bones[2][1].t, truth.bones[2][1].t);
}

TEST(RigTruthFile, SaysWhatDoesNotFit) {
  const Npz good = rig_truth_arrays(truth_of(test::bending_arm(4)));
  const auto refuses = [&](const std::string& name, auto spoil) {
    Npz bad = good;
    spoil(bad);
    const std::string why = failure_of([&] { rig_truth_of(bad, "truth.npz"); });
    EXPECT_NE(why.find("truth.npz: "), std::string::npos) << why;
    EXPECT_NE(why.find(name), std::string::npos) << why;
  };
  for (const char* name : {"rest", "vertices", "joints", "weights", "faces", "axes", "bones"}) {
    refuses(name, [&](Npz& npz) { npz.erase(name); });
    refuses(name, [&](Npz& npz) { npz[name].shape.push_back(1); });
  }
  refuses("hangs on", [](Npz& npz) { npz["parents"].values[1] = 2; });
  refuses("face", [](Npz& npz) { npz["faces"].values[0] = 1e6f; });
}

TEST_F(RigCases, OfPairsTheSecondIsEvaluatedUnderTheFirstOnesAngles) {
  options.suite = "creatures-pairs";
  options.cases = 2;
  options.points = 3000;
  ASSERT_EQ(make(), 2);
  EXPECT_EQ(names[1], "lamp101_as_100");
  const Case pair = made(names[1]);
  const Truth source = read_truth(pair.truth), target = read_truth(pair.target_truth);
  ASSERT_EQ(read_truth(pair.performed_truth).frames, source.frames);
  int calls = 0;
  const RigEvaluation evaluation = evaluate_pair(pair, [&](const std::vector<Mesh>&, double) {
    return true_rig(++calls == 1 ? *source.rig : *target.rig);
  });
  EXPECT_EQ(calls, 2);
  EXPECT_GT(figure(evaluation.metrics, "retarget_pct"), 0);
  EXPECT_LT(figure(evaluation.metrics, "retarget_scan_pct"), 12);
}

TEST_F(RigCases, AreASeedOfEachKindAfterTheOther) {
  options.cases = 9;
  ASSERT_EQ(make(), 9);
  EXPECT_EQ(names.front().substr(0, 7), "arm100_");
  EXPECT_EQ(names.back().substr(0, 7), "arm101_");
  const Case arm = made(names.front());
  ASSERT_EQ(arm.tags.size(), 3u);
  EXPECT_EQ(arm.tags[0], "creatures");
  EXPECT_EQ(arm.tags[1], "arm");
  EXPECT_NE(arm.tags[2], made(names.back()).tags[2]);  // another of its motions
  const Truth truth = read_truth(arm.truth);
  ASSERT_TRUE(truth.rig);
  EXPECT_EQ(truth.frames, 6);
  const std::vector<Mesh> scans = scans_of(arm);
  ASSERT_EQ(scans.size(), 6u);
  EXPECT_NEAR(static_cast<double>(scans[2].vertices.rows()), 1500, 301);
  EXPECT_NE(scans[2].vertices.rows(), scans[3].vertices.rows());
}

TEST_F(RigCases, AreTheSameFilesAgain) {
  options.cases = 1;
  options.suite = "creatures-captured";
  const auto scan = [&] {
    make();
    const Points points = scans_of(made(names[0]))[3].vertices;
    return std::vector<float>(points.data(), points.data() + points.size());
  };
  const auto before = scan();
  EXPECT_EQ(scan(), before);
  options.seed = 2;
  EXPECT_NE(scan(), before);
}

TEST_F(RigCases, CapturedOnesLieAboutTheBody) {
  options.cases = 1;
  options.suite = "creatures-captured";
  ASSERT_EQ(make(), 1);
  const Truth truth = read_truth(made(names[0]).truth);
  const Points& body = truth.rig->vertices[0];
  const Points scan = scans_of(made(names[0]))[0].vertices;
  const double size = body_size({body});
  const IntMatrix near = nearest_neighbours(body, scan, 1);
  int on_it = 0;
  for (Eigen::Index i = 0; i < scan.rows(); ++i)
    on_it += static_cast<double>((scan.row(i) - body.row(near(i, 0))).norm()) < 0.05 * size;
  EXPECT_GT(on_it, 0.8 * static_cast<double>(scan.rows()));
  EXPECT_GT(scan.rows(), 300);
}

TEST_F(RigCases, AreEditedBeforeAnythingIsFound) {
  options.cases = 1;
  ASSERT_EQ(make(), 1);
  const Case c = made(names[0]);
  ScanEdits edits;
  const float middle = scans_of(c)[0].vertices.col(1).mean();
  edits.crop = Box{Vec3(-9, middle, -9), Vec3(9, 9, 9)};
  for (const Mesh& scan : scans_of(c, edits)) EXPECT_GE(scan.vertices.col(1).minCoeff(), middle);
}

TEST_F(RigCases, PeopleAreAKindWhereThereAreAny) {
  test::write_training_folder(scratch.path("data"));
  options.data = scratch.path("data");
  options.cases = 9;
  ASSERT_EQ(make(), 9);
  EXPECT_EQ(names.back().substr(0, 10), "person000_");
  const Case person = made(names.back());
  EXPECT_EQ(person.tags[1], "person");
  const Truth truth = read_truth(person.truth);
  ASSERT_TRUE(truth.rig);
  EXPECT_EQ(truth.rig->count(), kJointCount);
  const Points posed = skinned(truth.rig->rest, SkinWeights::from(truth.rig->weights), truth.rig->bones[3]);
  EXPECT_LT((posed - truth.rig->vertices[3]).rowwise().norm().mean(), 0.02f);  // correctives aside
}

TEST_F(RigCases, RefuseWhatCannotBeMade) {
  options.split = "test";
  EXPECT_THROW(make(), Error);
  options.split = "dev";
  options.points = 10;
  EXPECT_THROW(make(), Error);
}

TEST_F(RigCases, TheTrueRigIsWithoutFault) {
  options.cases = 1;
  options.frames = 40;
  ASSERT_EQ(make(), 1);
  const Case c = made(names[0]);
  const RigTruth known = *read_truth(c.truth).rig;
  const RigEvaluation evaluation = evaluate_rig(c, known, [&](const std::vector<Mesh>& scans, double fps) {
    EXPECT_EQ(scans.size(), 40u);
    EXPECT_EQ(fps, 30);
    return true_rig(merged_truth(known));
  });
  EXPECT_EQ(evaluation.frames, 40);
  for (const char* key : {"joint_recall", "joint_precision", "tree_f1"})
    EXPECT_EQ(figure(evaluation.metrics, key), 1) << key;
  EXPECT_GT(figure(evaluation.metrics, "part_ri"), 0.99);
  EXPECT_LT(figure(evaluation.metrics, "joint_error_pct"),
            0.5);  // what turns by less than 5 degrees is stiff
  EXPECT_LT(figure(evaluation.metrics, "hinge_deg"), 1);
  EXPECT_LT(figure(evaluation.metrics, "track_pct"), 0.5);
}

TEST_F(RigCases, EvalTellsTheFiguresOfAKind) {
  options.cases = 2;
  ASSERT_EQ(make(), 2);
  EvalOptions eval;
  eval.cases = options.out;
  eval.find_rig = [](const std::vector<Mesh>& scans, double) -> FoundRig {
    throw Error("nothing in " + std::to_string(scans.size()) + " scans");
  };
  Evaluation evaluation = evaluate(eval, [](const CaseResult&) {});
  EXPECT_TRUE(evaluation.failed);
  EXPECT_EQ(evaluation.results[0].error, "nothing in 6 scans");
  eval.baseline = "nodes";
  evaluation = evaluate(eval, [](const CaseResult&) {});
  ASSERT_FALSE(evaluation.failed) << evaluation.results[0].error;
  EXPECT_EQ(evaluation.results[0].frames, 6);
  EXPECT_LT(figure(evaluation.mean, "joint_precision"), 0.9);
  EXPECT_EQ(figure(evaluation.mean, "found_parts"), 24);
  EXPECT_TRUE(evaluation.breakdown.json()["kinds"].contains("arm"));
  eval.baseline = "fit";
  eval.body = "no.npz";
  EXPECT_THROW(evaluate(eval, [](const CaseResult&) {}), Error);
}

/// Of scans in centimetres whose z is up.
TEST_F(RigCases, AFoundRigIsWrittenInTheScansOwnCoordinates) {
  DiscoveredRig rig;
  understudy::Rig& bar = rig.found.rig;
  bar.joints = {{"root", -1, JointKind::Free, {0, 0, 0}, Vec3::UnitY()},
                {"end", 0, JointKind::Hinge, {0, 1, 0}, Vec3::UnitY()}};
  bar.surface.vertices = (Points(3, 3) << 0, 0, 0, 0, 1, 0, 0, 2, 0.5f).finished();
  bar.surface.faces = (Faces(1, 3) << 0, 1, 2).finished();
  bar.skin = SkinWeights::rigid({0, 0, 1});
  rig.found.motion.poses = {rest_pose(bar)};
  rig.bones.resize(2), rig.off_m = {-1}, rig.doubted = {false};
  Eigen::Matrix4d to_file = Eigen::Matrix4d::Zero();
  to_file(0, 0) = to_file(2, 1) = 100, to_file(1, 2) = -100, to_file(3, 3) = 1;
  write_found_rig(scratch.path("r.npz"), rig, to_file);
  const Npz read = read_npz(scratch.path("r.npz"));
  EXPECT_EQ(read.at("vertices").values, (std::vector<float>{0, 0, 0, 0, 0, 100, 0, -50, 200}));
  EXPECT_EQ(read.at("joints").values, (std::vector<float>{0, 0, 0, 0, 0, 100}));
  EXPECT_EQ(read.at("axes").values, (std::vector<float>{0, 0, 1, 0, 0, 1})) << "of unit length";
}

}  // namespace
}  // namespace understudy::app
