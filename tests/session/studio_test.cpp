#include "tests/session/studio_fixture.hpp"

#include "app/session/document_file.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/file_formats.hpp"

namespace understudy::app {
namespace {

/// The same poses to the last bit.
bool same_poses(const Motion& a, const Motion& b) {
  if (a.poses.size() != b.poses.size()) return false;
  for (size_t t = 0; t < a.poses.size(); ++t) {
    if (a.poses[t].root != b.poses[t].root) return false;
    for (int j = 0; j < kJointCount; ++j)
      if (a.poses[t].local[j] != b.poses[t].local[j]) return false;
  }
  return true;
}

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

TEST_F(StudioTest, ExtractsSkeletonsBeforeThereIsATarget) {
  Studio studio(services());
  studio.run("open", {path("scan.npz")});
  studio.wait_idle(60);
  EXPECT_EQ(studio.session().source.frames.size(), static_cast<size_t>(kFrames));
  studio.run("open", {path("target.obj")});
  studio.wait_idle(60);
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
  studio.wait_idle(60);
  EXPECT_GT((studio.session().source.frames[10].joints - seen).row(LeftWrist).norm(), 0.02f);
  EXPECT_FALSE(same_poses(studio.session().takes[0].shown, before));
  studio.run("edit.undo");
  studio.wait_idle(60);
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
  studio.run("edit.redo");
  studio.wait_idle(60);
  EXPECT_FALSE(same_poses(studio.session().takes[0].shown, before));
  EXPECT_EQ(*extractions_, extracted);
}

TEST_F(StudioTest, OneEditIsRemovedAndTheOthersStay) {
  Studio studio(services());
  open_both(studio);
  for (const char* frame : {"5", "10", "15"})
    studio.run("edit.drag", {frame, "left_wrist", "0", "0.2", "0", "2"});
  studio.run("edit.remove", {"skeleton", "1"});
  const auto& edits = studio.session().document.skeleton_edits;
  ASSERT_EQ(edits.size(), 2u);
  EXPECT_EQ(std::get<DragEdit>(edits[0]).frame, 5);
  EXPECT_EQ(std::get<DragEdit>(edits[1]).frame, 15);
  studio.run("edit.undo");
  EXPECT_EQ(edits.size(), 3u);
  studio.run("edit.rotate", {"0", "5", "left_elbow", "0", "0", "1"});
  studio.run("edit.remove", {"rotation", "0", "0"});
  EXPECT_TRUE(studio.session().document.takes[0].pose_edits.rotate.empty());
  EXPECT_THROW(studio.run("edit.remove", {"skeleton", "3"}), Error);
}

TEST_F(StudioTest, ANewCropHoldsThePerson) {
  Studio studio(services());
  open_both(studio);
  const auto person = person_box(studio.session());
  ASSERT_TRUE(person);
  for (const KeptSource& frame : studio.session().source.frames)
    for (int j = 0; j < kJointCount; ++j) {
      EXPECT_TRUE((frame.joints.row(j).transpose().array() > person->low.array()).all());
      EXPECT_TRUE((frame.joints.row(j).transpose().array() < person->high.array()).all());
    }
  studio.run("edit.crop", {"on"});
  ASSERT_TRUE(studio.session().document.scan_edits.crop);
  EXPECT_EQ(studio.session().document.scan_edits.crop->low, person->low);
}

TEST_F(StudioTest, ANewTargetLeavesTheFrameAndItsJointsAreSeenWhole) {
  Studio studio(services());
  open_both(studio);
  studio.run("playback.frame", {"12"});
  studio.run("open", {path("target.obj")});
  studio.tick(0.01);
  studio.wait_idle(60);
  studio.tick(0.01);
  EXPECT_EQ(shown_frame(studio.session()), 12);
  studio.run("edit.crop", {"-9", "-9", "-9", "9", "9", "9"});
  studio.wait_idle(60);
  EXPECT_EQ(shown_frame(studio.session()), 12);
  studio.run("view.fit");
  studio.run("view.zoom", {"0.3"});
  const float near = studio.session().view.cameras[0].distance;
  studio.run("tool", {"target-joints"});
  EXPECT_GT(studio.session().view.cameras[0].distance, 2 * near);
}

TEST_F(StudioTest, FramesBeforeAnEditStayAsTheyWere) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  studio.run("edit.drag", {"15", "left_wrist", "0", "0.3", "0", "0"});
  studio.wait_idle(60);
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
  studio.wait_idle(60);
  EXPECT_EQ(*extractions_, extracted + kFrames);
}

TEST_F(StudioTest, PaintedWeightsShowAtOnceAndAreUndone) {
  Studio studio(services());
  open_both(studio);
  const RowMatrix before = *studio.session().takes[0].weights;
  const Vec3 at = studio.session().takes[0].target->mesh.vertices.row(100).transpose();
  studio.run("select.joint", {"head"});
  studio.run("edit.paint", {"0", std::to_string(at.x()), std::to_string(at.y()), std::to_string(at.z())});
  EXPECT_GT((*studio.session().takes[0].weights)(100, Head), 0.1f);
  studio.run("edit.undo");
  EXPECT_EQ(*studio.session().takes[0].weights, before);
}

/// Paints the head's weights at a vertex of the only take.
void paint(Studio& studio, int vertex) {
  const Vec3 at = studio.session().takes[0].target->mesh.vertices.row(vertex).transpose();
  studio.run("select.joint", {"head"});
  studio.run("edit.paint", {"0", std::to_string(at.x()), std::to_string(at.y()), std::to_string(at.z())});
}

/// The same surface with fewer vertices: each face but every sixth.
void thin_out(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::string> vertices;
  for (std::string line; std::getline(in, line);)
    if (line[0] == 'v') vertices.push_back(line);
  std::ofstream out(path);
  int kept = 0;
  for (size_t v = 0; v + 2 < vertices.size(); v += 3) {
    if (v % 18 == 15) continue;
    for (size_t k = 0; k < 3; ++k) out << vertices[v + k] << '\n';
    kept += 3;
  }
  for (int v = 1; v <= kept; v += 3) out << "f " << v << ' ' << v + 1 << ' ' << v + 2 << '\n';
}

TEST_F(StudioTest, PaintOfAnotherSurfaceIsAskedAboutAndBroughtOver) {
  {
    Studio studio(services());
    open_both(studio);
    paint(studio, 100);
    studio.run("document.save_as", {path("painted.understudy")});
  }
  thin_out(path("target.obj"));
  Studio studio(services());
  studio.run("document.open", {path("painted.understudy")});
  studio.wait_idle(60);  // "weights were painted at vertex ..." ended the studio
  const Session& session = studio.session();
  const auto take = [&session]() -> const TakeState& { return session.takes[0]; };
  ASSERT_TRUE(session.question);
  EXPECT_EQ(session.question->kind, Question::Kind::PaintMisfit);
  EXPECT_NE(session.question->text.find("target: weights were painted on "), std::string::npos);
  EXPECT_TRUE(take().ready && session.errors.empty());
  EXPECT_EQ(take().shown.poses.size(), static_cast<size_t>(kFrames));
  EXPECT_EQ(take().weights->col(Head).head(100).cwiseEqual(0.5f).count(), 0);  // as the networks gave them
  EXPECT_THROW(paint(studio, 90), Error);
  studio.run("question.answer", {"cancel"});
  studio.wait_idle(60);
  EXPECT_FALSE(session.question);  // asked once
  studio.run("edit.weights_reproject", {"0"});
  EXPECT_EQ(take().paint_problem, "");
  const WeightRows& brought = *session.document.takes[0].target_edits.weights;
  EXPECT_EQ(brought.of, take().target->mesh.vertices.rows());
  EXPECT_EQ(take().weights->row(brought.vertex[0]), brought.rows.row(0));
  studio.run("edit.undo");
  EXPECT_NE(take().paint_problem, "");
  studio.run("edit.weights_clear", {"0"});
  EXPECT_EQ(take().paint_problem, "");
}

TEST_F(StudioTest, PaintThatDoesNotFitKeepsNothingElseFromBeingDone) {
  Studio studio(services());
  open_both(studio);
  WeightRows rows;  // as documents of before have them: where they were painted is not known
  rows.vertex = {1000000};
  rows.rows = RowMatrix::Identity(1, kJointCount);
  studio.session().document.takes[0].target_edits.weights = std::make_shared<const WeightRows>(rows);
  studio.run("compare.add", {"0", "engine=paper"});
  studio.wait_idle(60);
  ASSERT_EQ(studio.session().takes.size(), 2u);
  for (const TakeState& take : studio.session().takes) {
    EXPECT_EQ(take.shown.poses.size(), static_cast<size_t>(kFrames));
    EXPECT_NE(take.paint_problem, "");
  }
  EXPECT_THROW(studio.run("edit.weights_reproject", {"0"}), Error);
  studio.run("edit.weights_clear", {"0"});
  EXPECT_EQ(studio.session().takes[0].paint_problem, "");
}

TEST_F(StudioTest, ARemovedTakeGivesItsMemoryBack) {
  Studio studio(services());
  open_both(studio);
  studio.run("compare.add", {"0", "engine=paper"});
  studio.wait_idle(60);
  const TakeState& take = studio.session().takes[1];
  studio.neighbours(1);
  studio.cache().posed(take, {1, 3, false});
  studio.cache().wait();
  const int64_t bytes = studio.cache().bytes();
  const std::weak_ptr<const Deformer> deformer = take.deformer;
  const std::weak_ptr<const Target> target = take.target;
  const std::weak_ptr<const PreparedCharacter> character = take.character;
  studio.run("target.remove", {"1"});
  studio.wait_idle(60);
  EXPECT_TRUE(deformer.expired());
  EXPECT_TRUE(target.expired());
  EXPECT_TRUE(character.expired());
  EXPECT_LT(studio.cache().bytes(), bytes);
}

TEST_F(StudioTest, AMovedTargetJointIsKeptAndPerformedAgain) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.target_joint", {"0", "left_elbow", "0.5", "1.3", "0", "mirror"});
  studio.wait_idle(60);
  const Joints& joints = studio.session().takes[0].target->joints;
  EXPECT_NEAR(joints(LeftElbow, 0), 0.5f, 1e-5f);
  EXPECT_NEAR(joints(RightElbow, 0), 2 * symmetry_centre(joints) - 0.5f, 0.02f);
  EXPECT_EQ(frame_count(studio.session()), kFrames);
}

TEST_F(StudioTest, ARemovedTakeComesBackWithUndo) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  studio.run("target.remove", {"0"});
  EXPECT_TRUE(studio.session().takes.empty());
  studio.run("edit.undo");
  studio.wait_idle(60);
  ASSERT_EQ(studio.session().takes.size(), 1u);
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
}

TEST_F(StudioTest, TwoMethodsOfOneTargetStandSideBySide) {
  Studio studio(services());
  open_both(studio);
  studio.run("compare.add", {"0", "engine=paper", "root=in-place"});
  studio.wait_idle(60);
  ASSERT_EQ(studio.session().takes.size(), 2u);
  EXPECT_EQ(studio.session().takes[1].shown.poses.size(), static_cast<size_t>(kFrames));
  EXPECT_FALSE(same_poses(studio.session().takes[0].shown, studio.session().takes[1].shown));
}

TEST_F(StudioTest, EditsOfTheResultComeAndGo) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  studio.run("edit.smooth", {"0", "0.8"});
  studio.run("edit.floor_offset", {"0", "0.25"});
  studio.wait_idle(60);
  EXPECT_NEAR(studio.session().takes[0].shown.poses[5].root.y(), before.poses[5].root.y() + 0.25f, 0.03f);
  EXPECT_GT(studio.session().takes[0].cost.mean_displacement_m, 0);
  studio.run("edit.poses_clear", {"0"});
  studio.wait_idle(60);
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
}

TEST_F(StudioTest, ASavedDocumentGivesTheSameResult) {
  Motion before;
  {
    Studio studio(services());
    open_both(studio);
    studio.run("edit.drag", {"4", "right_wrist", "0.1", "0", "0"});
    studio.run("edit.rotate", {"0", "6", "head", "0", "0.4", "0", "3"});
    studio.run("edit.skip", {"0", "3", "on"});
    studio.wait_idle(60);
    before = studio.session().takes[0].shown;
    studio.run("document.save_as", {path("dance")});
    EXPECT_FALSE(studio.session().changed);
  }
  Studio studio(services());
  studio.run("document.open", {path("dance.understudy")});
  studio.wait_idle(60);
  ASSERT_TRUE(studio.session().errors.empty());
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.skip.count(3), 1u);
}

TEST_F(StudioTest, ExportsTheFramesThatTrimAndSkipLeave) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.trim", {"0", "4", "13"});
  studio.run("edit.skip", {"0", "7", "on"});
  studio.run("export.run", {"0", path("out.npz")});
  studio.run("export.run", {"0", path("out.glb"), "morphs=2", "t_pose=on"});
  studio.run("export.csv", {"0", path("out.csv")});
  studio.wait_idle(60);
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  EXPECT_EQ(read_npz(path("out.npz")).at("joints").shape[0], 9);
  EXPECT_GT(fs::file_size(path("out.glb")), 1000u);
  EXPECT_GT(fs::file_size(path("out.csv")), 100u);
}

TEST_F(StudioTest, AnExportSaysWhatItCostsAndWhatItCannotDo) {
  Studio studio(services());
  open_both(studio);
  studio.run("export.run", {"0", path("out.bvh"), "in_place=on"});
  studio.run("export.run", {"0", path("frames"), "format=obj"});
  studio.wait_idle(60);
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  EXPECT_TRUE(fs::exists(path("frames/frame_00024.obj")));
  std::string told;
  for (const Notice& notice : studio.session().notices) told += notice.text + "; ";
  EXPECT_NE(told.find("Exported out.bvh: 24 frames"), std::string::npos) << told;
  EXPECT_NE(told.find("mean 0.00 mm"), std::string::npos) << told;
  const auto refused = [&](const Arguments& arguments) {
    try {
      studio.run("export.run", arguments);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused({"0", path("out.fbx")}).find("out.fbx"), std::string::npos);
  EXPECT_NE(refused({"0", path("out.glb"), "bones=9"}).find("bones"), std::string::npos);
  EXPECT_NE(refused({"0", path("out.glb"), "influences=5"}).find("4, 8"), std::string::npos);
  EXPECT_NE(refused({"7", path("out.glb")}).find("no take 7"), std::string::npos);
}

TEST_F(StudioTest, ACancelledExportLeavesTheOldFile) {
  std::ofstream(path("out.glb")) << "old";
  Studio studio(services());
  open_both(studio);
  studio.run("export.run", {"0", path("out.glb"), "morphs=4"});
  studio.jobs().cancel(studio.jobs().views().back().id);
  studio.wait_idle(60);
  std::ifstream file(path("out.glb"));
  std::string text;
  file >> text;
  if (text != "old") EXPECT_EQ(text.substr(0, 4), "glTF");  // it was quicker
  for (const auto& entry : fs::directory_iterator(fs::path(path("out.glb")).parent_path()))
    EXPECT_NE(entry.path().extension(), ".part");
  EXPECT_TRUE(studio.session().errors.empty());
}

TEST_F(StudioTest, AsksBeforeUnsavedWorkIsLost) {
  Studio studio(services());
  open_both(studio);
  studio.run("app.quit");
  ASSERT_TRUE(studio.session().question);
  EXPECT_FALSE(studio.session().quit);
  studio.run("question.answer", {"cancel"});
  EXPECT_FALSE(studio.session().quit);
  studio.run("app.quit");
  studio.run("question.answer", {"discard"});
  EXPECT_TRUE(studio.session().quit);
}

TEST_F(StudioTest, ABrokenTargetIsToldAndTheScanGoesOn) {
  std::ofstream(path("broken.obj")) << "v 1 2\n";
  Studio studio(services());
  studio.run("open", {path("scan.npz")});
  studio.run("target.add", {path("broken.obj")});
  studio.wait_idle(60);
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
  studio.wait_idle(60);
  const Session& session = studio.session();
  ASSERT_TRUE(session.errors.empty()) << session.errors.front().text;
  ASSERT_EQ(frame_count(session), 6);
  for (size_t t = 0; t < 6; ++t) {
    EXPECT_EQ(session.source.frames[t].flagged, t == 3) << t;
    EXPECT_EQ(session.takes[0].shown.flags[t] != 0, t == 3) << t;
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
  studio.wait_idle(60);
  *refusing = false;
  studio.run("method.engine", {"0", "paper"});
  studio.wait_idle(60);
  EXPECT_EQ(frame_count(studio.session()), kFrames);
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
  studio.wait_idle(60);
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
  studio.wait_idle(60);
  const auto& frames = studio.session().source.frames;
  const auto exported = [&](const char* take) {
    studio.run("export.run", {take, path("out.npz")});
    studio.wait_idle(60);
    EXPECT_TRUE(studio.session().errors.empty());
    const NpyArray joints = read_npz(path("out.npz")).at("source_joints");
    return Joints(Eigen::Map<const Joints>(joints.values.data() + 10 * kJointCount * 3));
  };
  EXPECT_EQ(exported("0"), frames[10].joints);
  EXPECT_NE(exported("0"), frames[10].raw);
  EXPECT_EQ(exported("1"), frames[10].raw);  // nothing was to be done to it
  studio.run("target.remove", {"0"});
  studio.wait_idle(60);
  EXPECT_EQ(frames[10].joints, frames[10].raw);
  studio.run("target.remove", {"0"});
  studio.wait_idle(60);
  EXPECT_NE(frames[10].joints, frames[10].raw);  // as before there was a target
}

TEST_F(StudioTest, ASkeletonIsShownRepairedWhereTheTargetIsBroken) {
  Studio alone(services());
  alone.run("open", {path("scan.npz")});
  alone.wait_idle(60);
  std::ofstream(path("broken.obj")) << "v 1 2\n";
  Studio studio(services());
  studio.run("target.add", {path("broken.obj")});
  studio.run("open", {path("scan.npz")});
  studio.wait_idle(60);
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
  studio.wait_idle(60);
  expect(1, 0, 0);
  studio.run("open", {path("target.obj")});
  studio.wait_idle(60);
  expect(1, 1, 1);  // a mesh without a rig is looked at
  studio.run("compare.add", {"0", "feet=off"});
  studio.wait_idle(60);
  expect(1, 2, 2);
  studio.run("method.engine", {"0", "paper"});
  studio.wait_idle(60);
  expect(1, 2, 3);
}

TEST_F(StudioTest, RetargetingAgainMakesEveryFrameAnew) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  for (int round = 2; round <= 4; ++round) {
    studio.run("work.restart");
    studio.wait_idle(60);
    EXPECT_EQ(*extractions_, round * kFrames);
  }
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
}

TEST_F(StudioTest, OfSeveralThingsOpenedOneThatFailsKeepsNoOtherOut) {
  Studio studio(services());
  studio.run("open", {path("not_there.ply"), path("scan.npz"), path("target.obj")});
  studio.wait_idle(60);
  ASSERT_EQ(studio.session().errors.size(), 1u);
  EXPECT_NE(studio.session().errors.front().text.find("not_there.ply"), std::string::npos);
  EXPECT_EQ(frame_count(studio.session()), kFrames);
}

TEST_F(StudioTest, UndoGoesBackThroughManySteps) {
  Studio studio(services());
  open_both(studio);
  const int steps = 190;
  for (int i = 1; i <= steps; ++i) studio.run("edit.rotate", {"0", "5", "left_elbow", "0", "0.01", "0", "1"});
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.rotate.size(), static_cast<size_t>(steps));
  for (int i = 1; i <= steps; ++i) studio.run("edit.undo");
  EXPECT_TRUE(studio.session().document.takes[0].pose_edits.rotate.empty());
  EXPECT_EQ(studio.session().document.takes.size(), 1u);
  for (int i = 1; i <= steps; ++i) studio.run("edit.redo");
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.rotate.size(), static_cast<size_t>(steps));
}

TEST_F(StudioTest, WhatWasSavedOrClosedLeavesNoCopyForRecovery) {
  const auto no_copy = [this] { return !fs::exists(path("state")) || fs::is_empty(path("state")); };
  for (int round = 0; round < 20; ++round) {
    Studio studio(services());
    studio.session().settings.autosave_s = 0;
    studio.run("target.add", {path("target.obj")});
    studio.tick(1);  // starts writing the copy
    if (round % 2) studio.run("document.save_as", {path("saved.understudy")});
    if (round % 2) {
      while (studio.jobs().running()) studio.tick(0);
      EXPECT_TRUE(no_copy()) << round;
    } else {
      studio.run("app.quit");
      studio.run("question.answer", {"discard"});
    }
  }
  EXPECT_TRUE(no_copy());
}

TEST_F(StudioTest, WhatEndsUnsavedKeepsItsCopy) {
  { Studio(services()).run("target.add", {path("target.obj")}); }
  ASSERT_TRUE(fs::exists(path("state")));
  const fs::path copy = fs::directory_iterator(path("state"))->path();
  EXPECT_EQ(read_autosave({copy.string(), "", ""}).document.takes.size(), 1u);
}

TEST_F(StudioTest, ACopyForRecoveryThatCannotBeWrittenIsToldOnceAndInNoDialog) {
  std::ofstream(path("state")) << "a file where the folder should be";
  Studio studio(services());
  studio.session().settings.autosave_s = 0;
  studio.run("target.add", {path("target.obj")});
  int told = 0;
  for (int i = 0; i < 5; ++i) {
    studio.session().notices.clear();
    studio.tick(1);
    studio.wait_idle(60);
    for (const Notice& notice : studio.session().notices) told += notice.kind == Notice::Kind::Warning;
  }
  EXPECT_TRUE(studio.session().errors.empty());
  EXPECT_EQ(told, 1);
}

TEST_F(StudioTest, MissingFilesAreAskedForAndFound) {
  {
    Studio studio(services());
    open_both(studio);
    studio.run("document.save_as", {path("dance.understudy")});
  }
  fs::create_directory(path("elsewhere"));
  fs::rename(path("scan.npz"), path("elsewhere/scan.npz"));
  Studio studio(services());
  studio.run("document.open", {path("dance.understudy")});
  ASSERT_TRUE(studio.session().question);
  EXPECT_EQ(studio.session().question->missing, std::vector<std::string>{path("scan.npz")});
  studio.wait_idle(60);
  EXPECT_TRUE(studio.session().errors.empty()) << "told twice: " << studio.session().errors.front().text;
  EXPECT_TRUE(studio.session().takes[0].ready);
  studio.run("document.relocate", {path("scan.npz"), path("elsewhere/scan.npz")});
  studio.wait_idle(60);
  EXPECT_FALSE(studio.session().question);
  EXPECT_EQ(frame_count(studio.session()), kFrames);
}

TEST_F(StudioTest, ACaseComesWithItsTruth) {
  const fs::path folder = folder_ / "case";
  fs::create_directory(folder);
  fs::copy_file(path("scan.npz"), folder / "source.npz");
  fs::copy_file(path("target.obj"), folder / "target.obj");
  std::ofstream(folder / "case.json") << R"({"fps": 30, "source": "source.npz", "target": "target.obj",
    "truth": "truth.npz", "tags": []})";
  NpyArray joints;
  joints.shape = {kFrames, kJointCount, 3};
  for (int t = 0; t < kFrames; ++t) {
    const Joints posed =
        forward_kinematics(human_rest(), fixtures::dance(0.1f * static_cast<float>(t))).joints;
    joints.values.insert(joints.values.end(), posed.data(), posed.data() + posed.size());
  }
  write_npz((folder / "truth.npz").string(), {{"joints", joints}, {"source_joints", joints}});
  Studio studio(services());
  studio.run("open", {folder.string()});
  studio.wait_idle(60);
  ASSERT_TRUE(studio.session().errors.empty()) << studio.session().errors.front().text;
  const Series* const error = find(studio.session().takes[0].series, "extraction_mpjpe_mm");
  ASSERT_NE(error, nullptr);
  EXPECT_NEAR(error->values[10], 120,
              30);  // the import lifts the scan onto the floor, the truth here does not
  EXPECT_NE(find(studio.session().takes[0].series, "pa_mpjpe_m"), nullptr);
}

TEST_F(StudioTest, ANewDocumentIsEmptyWhateverWasBeingMade) {
  Studio studio(services());
  for (int round = 0; round < 40; ++round) {
    studio.run("source.open", {path("scan.npz")});
    studio.run("target.add", {path("target.obj")});
    for (int i = 0; i < round; ++i) studio.tick(0.001);
    studio.replace_document({}, "");
    studio.wait_idle(60);
    ASSERT_TRUE(studio.session().source.frames.empty()) << round;
    ASSERT_TRUE(studio.session().takes.empty());
  }
}

TEST_F(StudioTest, NoCommandCrashesOnNonsense) {
  Studio studio(services());
  open_both(studio);
  const std::vector<Arguments> nonsense = {
      {}, {"x"}, {"-1"}, {"99"}, {"0", "1e99", "nan"}, {"0", "-5", "7", "x", "y", "z"}};
  std::vector<std::string> names;
  for (const Command& command : studio.commands().all()) names.push_back(command.name);
  for (const std::string& name : names)
    for (const Arguments& arguments : nonsense) {
      try {
        studio.run(name, arguments);
      } catch (const Error& error) {
        EXPECT_GT(std::string(error.what()).size(), 8u) << name;
      }
      studio.session().question.reset();
      studio.tick(0.01);
    }
  studio.wait_idle(60);
}

TEST_F(StudioTest, PlaysRoundAndStopsAtTheEndWithoutALoop) {
  Studio studio(services());
  open_both(studio);
  studio.run("playback.frame", {"0"});
  studio.run("playback.play");
  studio.tick(kFrames / 30.0 + 0.1);
  EXPECT_EQ(shown_frame(studio.session()), 3);
  studio.run("playback.loop", {"off"});
  studio.tick(10);
  EXPECT_EQ(shown_frame(studio.session()), kFrames - 1);
  EXPECT_FALSE(studio.session().playback.playing);
}

TEST_F(StudioTest, ASuffixInCapitalsOpensAsTheSameInSmallLetters) {
  fs::copy_file(US_SOURCE_DIR "/tests/fuzz/corpus/bvh/walk.bvh", path("WALK.BVH"));
  fs::copy_file(path("scan.npz"), path("SCAN.NPZ"));
  fs::copy_file(path("target.obj"), path("TARGET.OBJ"));
  std::ofstream(path("ALL.LST")) << "target.obj\n";
  Studio studio(services());
  for (const char* source : {"WALK.BVH", "SCAN.NPZ", "ALL.LST"}) {
    studio.run("open", {path(source)});
    EXPECT_EQ(studio.session().document.source.path, path(source));
  }
  EXPECT_TRUE(studio.session().document.takes.empty());
  studio.run("open", {path("TARGET.OBJ")});
  ASSERT_EQ(studio.session().document.takes.size(), 1u);
  studio.run("document.save_as", {path("WORK.UNDERSTUDY")});
  EXPECT_TRUE(fs::exists(path("WORK.UNDERSTUDY")));
  studio.run("document.new");
  studio.run("open", {path("WORK.UNDERSTUDY")});
  EXPECT_EQ(studio.session().document.takes.size(), 1u);
}

TEST_F(StudioTest, WhateverCanBeATargetOpensAsOne) {
  Studio studio(services());
  studio.run("open", {path("scan.npz")});  // without a source what moves would become it
  size_t takes = 0;
  for (const char* name : {"a.xyz", "b.PCD", "e.ply", "f.GLB"}) {
    std::ofstream(path(name)) << "x";
    studio.run("open", {path(name)});
    ASSERT_EQ(studio.session().document.takes.size(), ++takes) << name;
  }
  // These are read by a worker, which is the program itself: this one has none.
  for (const char* name : {"c.FBX", "d.dae"}) EXPECT_TRUE(can_be(name, kTarget)) << name;
}

}  // namespace
}  // namespace understudy::app
