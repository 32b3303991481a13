#include "app/session/engine.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/retarget/pipeline/fixtures.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

TEST_F(StudioTest, PerformsAScanThatWasOpened) {
  Studio studio(services());
  open_both(studio);
  const Session& session = studio.session();
  ASSERT_TRUE(session.errors.empty()) << session.errors.front().text;
  EXPECT_EQ(session.source.frames.size(), static_cast<size_t>(kFrames));
  EXPECT_EQ(session.source.count, kFrames);
  ASSERT_EQ(session.takes.size(), 1u);
  EXPECT_EQ(frame_count(session), kFrames);
  EXPECT_NE(find(session.takes[0].series, "foot_skate"), nullptr);
  EXPECT_FALSE(session.takes[0].metrics.empty());
  EXPECT_EQ(session.takes[0].latency.frames(), kFrames);
}

/// Sees no legs.
class HalfSeeing final : public SkeletonExtractor {
 public:
  explicit HalfSeeing(std::shared_ptr<SkeletonExtractor> whole) : whole_(std::move(whole)) {}
  Extraction extract(const Mesh& scan) override {
    Extraction seen = whole_->extract(scan);
    for (const int j : {LeftKnee, RightKnee, LeftAnkle, RightAnkle, LeftFoot, RightFoot})
      seen.visibility[j] = seen.confidence[j] = 0.05f;
    return seen;
  }
  std::string name() const override { return "half"; }

 private:
  std::shared_ptr<SkeletonExtractor> whole_;
};

TEST_F(StudioTest, TellsOnceThatLegsAreNotSeenAndMeasuresNone) {
  StudioServices half = services();
  half.networks = [all = half.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = all(method, parts);
    if (networks.extractor && !networks.rest_extractor)
      networks.extractor = std::make_shared<HalfSeeing>(networks.extractor);
    return networks;
  };
  Studio studio(half);
  open_both(studio);
  const Session& session = studio.session();
  ASSERT_EQ(session.takes.size(), 1u);
  const std::string sentence = "Legs not seen: they stand still.";
  EXPECT_EQ(unseen_sentence(session.takes[0].limbs), sentence);
  EXPECT_EQ(std::count_if(session.notices.begin(), session.notices.end(),
                          [&](const Notice& notice) { return notice.text == sentence; }),
            1);
  EXPECT_EQ(find(session.takes[0].series, "foot_skate"), nullptr);
  EXPECT_NE(find(session.takes[0].series, "jerk"), nullptr);
  for (const BadFrame& bad : bad_frames(session)) ADD_FAILURE() << bad.frame << bad.why;
  EXPECT_GT(session.source.frames[0].confidence, 0.9f);
  ASSERT_TRUE(session.source.import &&
              session.source.import->floor);  // under the legs, for everybody who reads the scans again
}

TEST_F(StudioTest, ExtractsSkeletonsBeforeThereIsATarget) {
  Studio studio(services());
  studio.run("open", {path("scan.npz")});
  studio.wait_idle();
  EXPECT_EQ(studio.session().source.frames.size(), static_cast<size_t>(kFrames));
  studio.run("open", {path("target.obj")});
  studio.wait_idle();
  EXPECT_EQ(frame_count(studio.session()), kFrames);
  EXPECT_EQ(*extractions_, kFrames);  // the target came later; nothing was extracted twice
}

TEST_F(StudioTest, ADraggedJointIsPerformedWithoutExtractingAgainAndUndone) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  const Joints seen = studio.session().source.frames[10].joints;
  const int extracted = *extractions_;
  studio.run("edit.drag", {"10", "left_wrist", "0", "0.2", "0", "2"});
  studio.wait_idle();
  EXPECT_GT((studio.session().source.frames[10].joints - seen).row(LeftWrist).norm(), 0.02f);
  EXPECT_FALSE(same_poses(studio.session().takes[0].shown, before));
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
  studio.run("edit.redo");
  studio.wait_idle();
  EXPECT_FALSE(same_poses(studio.session().takes[0].shown, before));
  EXPECT_EQ(*extractions_, extracted);
}

TEST_F(StudioTest, FramesBeforeAnEditStayAsTheyWere) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  studio.run("edit.drag", {"15", "left_wrist", "0", "0.3", "0", "0"});
  studio.wait_idle();
  const Motion& after = studio.session().takes[0].shown;
  for (size_t t = 0; t < 15; ++t)
    EXPECT_EQ(after.poses[t].local[LeftElbow], before.poses[t].local[LeftElbow]) << t;
  EXPECT_NE(after.poses[15].local[LeftElbow], before.poses[15].local[LeftElbow]);
}

TEST_F(StudioTest, CroppingTheScanExtractsAgain) {
  Studio studio(services());
  open_both(studio);
  const int extracted = *extractions_;
  studio.run("edit.crop", {"-9", "-9", "-9", "9", "9", "9"});
  studio.wait_idle();
  EXPECT_EQ(*extractions_, extracted + kFrames);
}

TEST_F(StudioTest, TwoMethodsOfOneTargetStandSideBySide) {
  Studio studio(services());
  open_both(studio);
  studio.run("compare.add", {"0", "engine=paper", "root=in-place"});
  studio.wait_idle();
  ASSERT_EQ(studio.session().takes.size(), 2u);
  EXPECT_EQ(studio.session().takes[1].shown.poses.size(), static_cast<size_t>(kFrames));
  EXPECT_FALSE(same_poses(studio.session().takes[0].shown, studio.session().takes[1].shown));
}

TEST_F(StudioTest, ProportionsOfATargetArePerformedWithoutBindingOrExtractingAgainAndUndone) {
  Studio studio(services());
  open_both(studio);
  const auto take = [&]() -> const TakeState& { return studio.session().takes[0]; };  // undo makes it anew
  const auto pelvis = [&](size_t t) { return Vec3(take().joints[t].row(Pelvis).transpose()); };
  const Motion before = take().shown;
  const Vec3 first = pelvis(0), last = pelvis(kFrames - 1);
  const auto deformer = take().deformer;
  const int extracted = *extractions_;
  for (const char* stride : {"1.2", "1.5"}) studio.run("target.stride", {"0", stride});  // as a slider does
  studio.wait_idle();
  EXPECT_NEAR(pelvis(kFrames - 1).x() - first.x(), 1.5f * (last.x() - first.x()), 1e-3f);
  studio.run("edit.undo");
  studio.run("target.hip_height", {"0", "-0.05"});
  studio.wait_idle();
  EXPECT_NEAR(pelvis(0).y(), first.y() - 0.05f, 0.01f);
  studio.run("edit.undo");
  studio.run("target.arm_reach", {"0", "7"});
  EXPECT_EQ(studio.session().document.takes[0].method.arm_reach, 1);
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_TRUE(same_poses(take().shown, before));
  EXPECT_EQ(take().deformer, deformer);
  EXPECT_EQ(*extractions_, extracted);
}

TEST_F(StudioTest, AnotherMethodOfATakeIsComparedByItsProportions) {
  Studio studio(services());
  open_both(studio);
  studio.run("compare.add", {"0", "stride=1.5", "arm_reach=0.5"});
  studio.wait_idle();
  EXPECT_EQ(studio.session().document.takes[1].method.stride, 1.5f);
  EXPECT_EQ(studio.session().document.takes[1].name, "target (stride 1.5, arm_reach 0.5)");
  EXPECT_FALSE(same_poses(studio.session().takes[0].shown, studio.session().takes[1].shown));
}

TEST_F(StudioTest, ABrokenTargetIsToldAndTheScanGoesOn) {
  std::ofstream(path("broken.obj")) << "v 1 2\n";
  Studio studio(services());
  studio.run("open", {path("scan.npz")});
  studio.run("target.add", {path("broken.obj")});
  studio.wait_idle();
  ASSERT_FALSE(studio.session().errors.empty());
  EXPECT_NE(studio.session().errors.front().text.find("broken.obj"), std::string::npos);
  EXPECT_EQ(studio.session().source.frames.size(), static_cast<size_t>(kFrames));
}

TEST_F(StudioTest, AFrameThatCannotBeReadIsFlaggedAndTheRestPerformed) {
  fs::create_directory(path("scans"));
  const fixtures::PointBody body(human_rest());
  for (int t = 0; t < 6; ++t) {
    const Mesh scan = fixtures::scan_of(body, human_rest(), fixtures::dance(0.1f * static_cast<float>(t)));
    std::ofstream file(path("scans/" + std::to_string(t) + ".xyz"));
    for (Eigen::Index v = 0; t != 3 && v < scan.vertices.rows(); ++v) file << scan.vertices.row(v) << '\n';
  }
  Studio studio(services());
  studio.run("open", {path("scans"), path("target.obj")});
  studio.wait_idle();
  const Session& session = studio.session();
  ASSERT_TRUE(session.errors.empty()) << session.errors.front().text;
  ASSERT_EQ(frame_count(session), 6);
  for (size_t t = 0; t < 6; ++t) {
    EXPECT_EQ(session.source.frames[t].flagged, t == 3) << t;
    EXPECT_EQ(session.takes[0].shown.flags[t] != 0, t == 3) << t;
    EXPECT_EQ(session.source.frames[t].confidence, t == 3 ? 0 : 1) << t;
    EXPECT_EQ(find(session.takes[0].series, "confidence")->values[t], t == 3 ? 0 : 1) << t;
  }
  EXPECT_EQ(session.takes[0].shown.poses[3].local[LeftHip], session.takes[0].shown.poses[2].local[LeftHip]);
}

/// Has no place for any target.
class RefusingDeformer : public NearestDeformer {
 public:
  void bind(const Points&, const Joints&) override { throw Error("the target cannot be bound"); }
};

TEST_F(StudioTest, ATargetThatNoNetworkTakesIsToldAndExchanged) {
  auto refusing = std::make_shared<std::atomic<bool>>(true);
  StudioServices own = services();
  own.networks = [refusing, usual = own.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = usual(method, parts);
    if (*refusing && parts.deformer) networks.deformer = std::make_shared<RefusingDeformer>();
    return networks;
  };
  Studio studio(own);
  open_both(studio);
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_EQ(studio.session().errors.front().text, "the target cannot be bound");
  studio.run("edit.swap", {"2", "4", "arms"});  // what is at work is brought in line with this
  studio.wait_idle();
  *refusing = false;
  studio.run("method.engine", {"0", "paper"});
  studio.wait_idle();
  EXPECT_EQ(frame_count(studio.session()), kFrames);
}

/// Refuses its tenth frame.
class RefusingTransfer final : public MotionTransfer {
 public:
  void reset(const Joints&) override { frames_ = 0; }
  Rotations push(const Extraction&, float) override {
    US_CHECK(++frames_ != 10 || refused_++ > 0, "nobody moves like this");
    return identity_rotations();
  }
  std::any memory() const override { return frames_; }
  void restore(const std::any& memory) override { frames_ = std::any_cast<int>(memory); }
  std::string name() const override { return "refusing"; }

 private:
  int frames_ = 0, refused_ = 0;
};

TEST_F(StudioTest, AFrameThatIsNotTransferredHasNoConfidence) {
  StudioServices own = services();
  own.networks = [usual = own.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = usual(method, parts);
    if (parts.transfer) networks.transfer = std::make_shared<RefusingTransfer>();
    return networks;
  };
  Studio studio(own);
  open_both(studio);
  const TakeState& take = studio.session().takes[0];
  ASSERT_EQ(take.performed.size(), static_cast<size_t>(kFrames));
  for (size_t t = 0; t < kFrames; ++t) {
    EXPECT_EQ(take.performed[t].flagged, t == 9) << t;
    EXPECT_EQ(find(take.series, "confidence")->values[t], t == 9 ? 0 : 1) << t;
  }
}

/// Fails at its tenth frame with what is no Error of ours.
class RunningOut final : public MotionTransfer {
 public:
  void reset(const Joints&) override { frames_ = 0; }
  Rotations push(const Extraction&, float) override {
    if (++frames_ == 10) throw std::bad_alloc();
    return identity_rotations();
  }
  std::any memory() const override { return frames_; }
  void restore(const std::any& memory) override { frames_ = std::any_cast<int>(memory); }
  std::string name() const override { return "running out"; }

 private:
  int frames_ = 0;
};

TEST_F(StudioTest, ATakeThatFailsLeavesTheOthersAtWork) {
  StudioServices own = services();
  own.networks = [usual = own.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = usual(method, parts);
    if (method.engine == "paper" && parts.transfer) networks.transfer = std::make_shared<RunningOut>();
    return networks;
  };
  Studio studio(own);
  studio.run("open", {path("target.obj")});
  studio.run("compare.add", {"0", "engine=paper"});
  studio.run("open", {path("scan.npz")});
  studio.wait_idle();
  const Session& session = studio.session();
  EXPECT_EQ(session.source.frames.size(), static_cast<size_t>(kFrames));
  EXPECT_EQ(session.takes[0].performed.size(), static_cast<size_t>(kFrames));
  EXPECT_TRUE(session.takes[0].problem.empty());
  EXPECT_EQ(session.takes[1].problem, "there is not enough memory");
  ASSERT_EQ(session.errors.size(), 1u);
}

TEST_F(StudioTest, ASkeletonIsShownAndExportedAsItsTakeTransferredIt) {
  Studio studio(services());
  open_both(studio);
  studio.run("compare.add", {"0", "smooth=off", "lengths=off", "swaps=off"});
  studio.wait_idle();
  const auto& frames = studio.session().source.frames;
  const auto exported = [&](const char* take) {
    studio.run("export.run", {take, path("out.npz")});
    studio.wait_idle();
    EXPECT_TRUE(studio.session().errors.empty());
    const NpyArray joints = read_npz(path("out.npz")).at("source_joints");
    return Joints(Eigen::Map<const Joints>(joints.values.data() + 10 * kJointCount * 3));
  };
  EXPECT_EQ(exported("0"), frames[10].joints);
  EXPECT_NE(exported("0"), frames[10].raw);
  EXPECT_EQ(exported("1"), frames[10].raw);  // nothing was to be done to it
  studio.run("target.remove", {"0"});
  studio.wait_idle();
  EXPECT_EQ(frames[10].joints, frames[10].raw);
  studio.run("target.remove", {"0"});
  studio.wait_idle();
  EXPECT_NE(frames[10].joints, frames[10].raw);  // as before there was a target
}

TEST_F(StudioTest, ExportedSkeletonsComeWithTheWayBackToTheScan) {
  Npz scan = read_npz(path("scan.npz"));
  NpyArray& points = scan.at("points");
  for (size_t i = 0; i < points.values.size(); i += 3) {  // centimetres, z up, off the origin
    float* const p = points.values.data() + i;
    const float y = p[1];
    p[0] = 300 + 100 * p[0], p[1] = -70 - 100 * p[2], p[2] = 40 + 100 * y;
  }
  write_npz(path("scan.npz"), scan);
  Studio studio(services());
  open_both(studio);
  for (const char* filter : {"smooth", "lengths", "swaps"}) studio.run("method.filter", {"0", filter, "off"});
  studio.wait_idle();
  studio.run("export.run", {"0", path("out.npz")});
  studio.wait_idle();
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  const Npz out = read_npz(path("out.npz"));
  const Eigen::Matrix4f to_scan =
      Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(out.at("source_to_scan").values.data());
  const auto row = [](const NpyArray& array, int64_t t, int64_t i) {
    return Vec3(Eigen::Map<const Vec3>(array.values.data() + 3 * (t * array.shape[1] + i)));
  };
  for (int64_t t = 0; t < kFrames; ++t)
    for (int64_t j = 0; j < kJointCount; ++j) {  // a scan's last points are its joints
      const Vec3 joint = row(out.at("source_joints"), t, j);
      const Vec3 in_scan = row(points, t, points.shape[1] - kJointCount + j);
      EXPECT_LT(((to_scan * joint.homogeneous()).head<3>() - in_scan).norm(), 0.02f) << t << ", joint " << j;
      EXPECT_LT(std::abs(joint.y() - 1), 1.1f) << t << ", joint " << j;  // metres over the floor
    }
}

TEST_F(StudioTest, ASkeletonIsShownRepairedWhereTheTargetIsBroken) {
  Studio alone(services());
  alone.run("open", {path("scan.npz")});
  alone.wait_idle();
  std::ofstream(path("broken.obj")) << "v 1 2\n";
  Studio studio(services());
  studio.run("target.add", {path("broken.obj")});
  studio.run("open", {path("scan.npz")});
  studio.wait_idle();
  for (size_t t = 0; t < kFrames; ++t)
    EXPECT_EQ(studio.session().source.frames[t].joints, alone.session().source.frames[t].joints) << t;
}

TEST_F(StudioTest, NetworksAreLoadedWhenTheyAreNeeded) {
  std::map<std::string, int> loads;
  StudioServices own = services();
  own.networks = [&loads, usual = own.networks](const Method& method, const NetworkParts& parts) {
    loads["extractor"] += parts.extractor;
    loads["rest extractor"] += parts.rest_extractor;
    loads["transfer"] += parts.transfer;
    loads["deformer"] += parts.deformer;
    return usual(method, parts);
  };
  const auto expect = [&](int extractor, int rest, int performer) {
    EXPECT_EQ(loads["extractor"], extractor);
    EXPECT_EQ(loads["rest extractor"], rest);
    EXPECT_EQ(loads["transfer"], performer);
    EXPECT_EQ(loads["deformer"], performer);
  };
  Studio studio(own);
  studio.run("open", {path("scan.npz")});
  studio.wait_idle();
  expect(1, 0, 0);
  studio.run("open", {path("target.obj")});
  studio.wait_idle();
  expect(1, 1, 1);  // a mesh without a rig is looked at
  studio.run("compare.add", {"0", "feet=off"});
  studio.wait_idle();
  expect(1, 2, 2);
  studio.run("method.engine", {"0", "paper"});
  studio.wait_idle();
  expect(1, 2, 3);
}

TEST_F(StudioTest, WhatWasExtractedForRemovedTakesAloneIsForgotten) {
  std::vector<std::weak_ptr<SkeletonExtractor>> extractors;  // one for each extraction of the engine
  StudioServices own = services();
  own.networks = [&extractors, usual = own.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = usual(method, parts);
    if (networks.extractor) extractors.push_back(networks.extractor);
    return networks;
  };
  const auto kept = [&extractors] {
    return std::count_if(extractors.begin(), extractors.end(), [](const auto& e) { return !e.expired(); });
  };
  Studio studio(own);
  open_both(studio);
  studio.run("compare.add", {"0", "near=off"});
  studio.run("compare.add", {"0", "extractor=paper"});
  studio.wait_idle();
  EXPECT_EQ(*extractions_, 3 * kFrames);
  EXPECT_EQ(kept(), 3);
  studio.run("target.remove", {"2"});
  studio.run("target.remove", {"1"});
  studio.wait_idle();
  EXPECT_EQ(kept(), 1);
  studio.run("compare.add", {"0", "root=in-place"});
  studio.wait_idle();
  EXPECT_EQ(*extractions_, 3 * kFrames);  // what is still wanted stays
  EXPECT_EQ(studio.session().takes[1].performed.size(), static_cast<size_t>(kFrames));
}

TEST_F(StudioTest, RetargetingAgainMakesEveryFrameAnew) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  for (int round = 2; round <= 4; ++round) {
    studio.run("work.restart");
    studio.wait_idle();
    EXPECT_EQ(*extractions_, round * kFrames);
  }
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
}

}  // namespace
}  // namespace understudy::app
