#include <cmath>
#include <fstream>
#include <set>

#include "app/session/command_sets.hpp"
#include "app/session/follow.hpp"
#include "app/session/source_drag.hpp"
#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

bool same_pose(const Pose& a, const Pose& b) {
  return a.local == b.local && a.root == b.root;
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

TEST_F(StudioTest, EditsOfAFrameAreMovedInTimeAndRemovedTogether) {
  Studio studio(services());
  open_both(studio);
  const Document& document = studio.session().document;
  studio.run("edit.drag", {"5", "left_wrist", "0", "0.1", "0"});
  studio.run("edit.drag", {"5", "head", "0", "0.1", "0"});
  studio.run("edit.drag", {"7", "head", "0", "0.1", "0"});
  studio.run("edit.swap", {"2", "4", "legs"});
  const auto frames = [&] {
    std::vector<int> all;
    for (size_t i = 0; i < 3; ++i) all.push_back(std::get<DragEdit>(document.skeleton_edits[i]).frame);
    return all;
  };
  studio.run("edit.move", {"drags", "5", "9"});
  EXPECT_EQ(frames(), (std::vector<int>{9, 9, 7}));
  studio.run("edit.undo");
  EXPECT_EQ(frames(), (std::vector<int>{5, 5, 7}));
  studio.run("edit.move", {"swap", "3", "10"});
  EXPECT_EQ(std::get<SwapEdit>(document.skeleton_edits[3]).first, 10);
  EXPECT_EQ(std::get<SwapEdit>(document.skeleton_edits[3]).last, 12);
  EXPECT_THROW(studio.run("edit.move", {"swap", "3", "23"}), Error);
  EXPECT_THROW(studio.run("edit.move", {"drags", "6", "9"}), Error);
  studio.run("edit.remove", {"drags", "5"});
  EXPECT_EQ(document.skeleton_edits.size(), 2u);
  const PoseEdits& edits = document.takes[0].pose_edits;
  studio.run("edit.rotate", {"0", "5", "left_elbow", "0", "0", "1"});
  studio.run("edit.move", {"rotations", "0", "5", "8"});
  EXPECT_EQ(edits.rotate[0].frame, 8);
  studio.run("edit.skip", {"0", "3", "5", "on"});
  studio.run("edit.move", {"skips", "0", "3", "5", "4"});
  EXPECT_EQ(edits.skip, (std::set<int>{4, 5, 6}));
  studio.run("edit.skip", {"0", "4", "5", "off"});
  EXPECT_EQ(edits.skip, (std::set<int>{6}));
}

TEST_F(StudioTest, AGapIsShownInItsTimeAndFilled) {
  Studio studio(services());
  studio.run("open", {folder_without({9, 10, 11, 17})});
  studio.run("open", {path("target.obj")});
  studio.wait_idle();
  const auto poses = [&]() -> const std::vector<Pose>& { return studio.session().takes[0].shown.poses; };
  ASSERT_EQ(poses().size(), static_cast<size_t>(kFrames));
  EXPECT_TRUE(studio.session().source.frames[10].flagged);
  EXPECT_TRUE(same_pose(poses()[11], poses()[8])) << "it stands still";
  const std::vector<Pose> before = poses();
  const auto fills = [&] { return studio.session().document.takes[0].pose_edits.fill.size(); };

  studio.run("playback.frame", {"10"});
  studio.run("edit.fill");
  studio.wait_idle();
  ASSERT_EQ(fills(), 1u);
  EXPECT_EQ(studio.session().history.undo_label(), "Fill frames 9 to 11");
  for (int t = 0; t < kFrames; ++t) EXPECT_EQ(same_pose(poses()[t], before[t]), t < 9 || t > 11) << t;

  studio.run("playback.frame", {"0"});
  studio.run("edit.fill", {"0"});
  EXPECT_EQ(fills(), 2u) << "all of them, none twice";
  studio.run("edit.undo");
  EXPECT_EQ(fills(), 1u);
  studio.run("edit.remove", {"fill", "0", "0"});
  studio.wait_idle();
  EXPECT_TRUE(same_pose(poses()[10], before[10]));
}

TEST_F(StudioTest, FramesBetweenTheLoopMarksAreFilled) {
  Studio studio(services());
  const auto refused = [&](const Arguments& arguments) {
    return failure_of([&] { studio.run("edit.fill", arguments); });
  };
  EXPECT_EQ(refused({}), "add a target first");
  open_both(studio);
  EXPECT_NE(refused({}).find("all frames could be used"), std::string::npos);
  studio.run("playback.in", {"4"});
  studio.run("playback.out", {"7"});
  studio.run("edit.fill");
  auto& fills = studio.session().document.takes[0].pose_edits.fill;
  studio.run("edit.fill", {"0", "8", "9"});
  ASSERT_EQ(fills.size(), 1u) << "neighbours become one";
  EXPECT_EQ(fills[0].first, 4);
  EXPECT_EQ(fills[0].last, 9);
  studio.run("edit.move", {"fill", "0", "0", "6"});
  EXPECT_EQ(fills[0].first, 6);
  EXPECT_EQ(fills[0].last, 11);
  EXPECT_NE(refused({"0", "0", "23"}).find("none is left that is known"), std::string::npos);
  EXPECT_EQ(fills.size(), 1u) << "what was refused changed nothing";
  EXPECT_NE(refused({"0", "5", "40"}), "");
}

TEST_F(StudioTest, EditsOfARangeGetOtherFramesInOneStep) {
  Studio studio(services());
  open_both(studio);
  const Document& document = studio.session().document;
  const PoseEdits& edits = document.takes[0].pose_edits;
  studio.run("edit.swap", {"2", "4", "legs"});
  studio.run("edit.move", {"swap", "0", "1", "8"});
  EXPECT_EQ(std::get<SwapEdit>(document.skeleton_edits[0]).first, 1);
  EXPECT_EQ(std::get<SwapEdit>(document.skeleton_edits[0]).last, 8);
  EXPECT_EQ(studio.session().history.undo_label(), "Change the frames of an edit");
  EXPECT_THROW(studio.run("edit.move", {"swap", "0", "8", "1"}), Error);
  studio.run("edit.skip", {"0", "3", "5", "on"});
  studio.run("edit.move", {"skips", "0", "3", "5", "3", "7"});
  EXPECT_EQ(edits.skip, (std::set<int>{3, 4, 5, 6, 7}));
  studio.run("edit.move", {"skips", "0", "3", "7", "6", "7"});
  EXPECT_EQ(edits.skip, (std::set<int>{6, 7}));
  studio.run("edit.trim", {"0", "2", "9"});
  studio.run("edit.trim", {"0", "4", "9"});  // at once: a drag is a step of its own
  studio.run("edit.undo");
  EXPECT_EQ(document.takes[0].pose_edits.trim->first, 2);
}

TEST_F(StudioTest, ANewCropCutsNothingUntilASideIsMovedAndIsUndone) {
  Studio studio(services());
  open_both(studio);
  const Session& session = studio.session();
  const auto points = [&] {
    studio.wait_idle();
    std::vector<int> all;
    for (const KeptSource& frame : session.source.frames) all.push_back(frame.points);
    return all;
  };
  const std::vector<int> before = points();
  const int extracted = *extractions_;
  const float near = session.view.cameras[0].distance;
  studio.run("edit.crop", {"on"});
  EXPECT_EQ(session.tool, Tool::Crop);
  EXPECT_GE(session.view.cameras[0].distance, near);
  studio.run("view.fit");
  EXPECT_GT(session.view.cameras[0].distance * std::tan(0.5f * session.view.cameras[0].fov),
            0.5f * (shown_crop(session).high - shown_crop(session).low).maxCoeff());  // its handles are seen
  EXPECT_EQ(points(), before);
  EXPECT_EQ(*extractions_, extracted);
  const Box box = shown_crop(session);
  for (const KeptSource& frame : session.source.frames) {
    ASSERT_TRUE(frame.extent);
    EXPECT_TRUE(box.contains(frame.extent->low) && box.contains(frame.extent->high));
  }
  const float middle = 0.5f * (box.low.y() + box.high.y());
  studio.run("edit.crop", {"high.y", std::to_string(middle)});
  const std::vector<int> after = points();
  EXPECT_EQ(shown_crop(session).low, box.low);  // what was cut is still outside it
  for (size_t i = 0; i < before.size(); ++i) EXPECT_LT(after.at(i), before[i]) << i;
  EXPECT_EQ(session.document.scan_edits.crop->low, Box::open().low);
  studio.run("edit.undo");
  EXPECT_EQ(points(), before);
  EXPECT_EQ(session.tool, Tool::Crop);
  studio.run("edit.undo");
  EXPECT_FALSE(session.document.scan_edits.crop);
  EXPECT_EQ(session.tool, Tool::Look);
}

TEST_F(StudioTest, TheCropToolStepsBackNoFurtherThanItsBoxAsksAndReturns) {
  Studio studio(services());
  open_both(studio);
  studio.wait_idle();
  studio.run("view.fit");
  const Session& session = studio.session();
  CameraState before = session.view.cameras[0];
  studio.run("tool", {"crop"});
  const CameraState& now = session.view.cameras[0];
  EXPECT_EQ(now.target, before.target);
  EXPECT_EQ(now.yaw, before.yaw);
  const Box box = shown_crop(session);
  const Vec3 offset = follow_offset(session, 0, shown_frame(session));
  const float needed = distance_to_see(before, aspect_of_a_view(session.view, session.takes.size()),
                                       box.low - offset, box.high - offset);
  EXPECT_FLOAT_EQ(now.distance, std::max(before.distance, needed));
  studio.run("tool", {"look"});
  EXPECT_TRUE(same(session.view.cameras[0], before)) << "as it was";

  studio.run("view.zoom", {"0.2"});
  before = session.view.cameras[0];
  studio.run("edit.crop", {"on"});
  EXPECT_GT(session.view.cameras[0].distance, before.distance);
  studio.run("edit.crop", {"off"});
  EXPECT_TRUE(same(session.view.cameras[0], before));
  studio.run("tool", {"crop"});
  studio.run("view.orbit", {"20", "0"});
  const CameraState moved = session.view.cameras[0];
  studio.run("tool", {"look"});
  EXPECT_TRUE(same(session.view.cameras[0], moved)) << "the user's own view stays";
}

TEST_F(StudioTest, TheCropToolStepsBackForABoxThatStandsAside) {
  Studio studio(services());
  open_both(studio);
  studio.wait_idle();
  const Session& session = studio.session();
  const auto distance = [&](const char* spread) {
    studio.run("tool", {"look"});
    studio.run("view.spread", {spread});
    studio.run("tool", {"crop"});
    return session.view.cameras[0].distance;
  };
  studio.run("view.layout", {"overlay"});
  EXPECT_GT(distance("10"), distance("0") + 5);
}

TEST_F(StudioTest, ASideOfTheCropThatIsDraggedIsOneStepBack) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.crop", {"on"});
  for (const char* metres : {"-0.5", "-0.4", "-0.3"}) studio.run("edit.crop", {"low.x", metres});
  studio.run("edit.undo");
  EXPECT_TRUE(studio.session().document.scan_edits.crop->is_open());
  EXPECT_THROW(studio.run("edit.crop", {"low.w", "1"}), Error);
  EXPECT_THROW(studio.run("edit.crop", {"high.x", "-2000000"}), Error);
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
  studio.wait_idle();  // "weights were painted at vertex ..." ended the studio
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
  studio.wait_idle();
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

/// Has no memory for other weights so many times.
class ScantDeformer : public NearestDeformer {
 public:
  ScantDeformer(const NearestDeformer& with, std::shared_ptr<std::atomic<int>> refusals)
      : NearestDeformer(with), refusals_(std::move(refusals)) {}
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override {
    if ((*refusals_)-- > 0) throw std::bad_alloc();
    const auto other = NearestDeformer::with_weights(std::move(weights));
    return std::make_shared<ScantDeformer>(dynamic_cast<const NearestDeformer&>(*other), refusals_);
  }

 private:
  std::shared_ptr<std::atomic<int>> refusals_;
};

TEST_F(StudioTest, AnEditThatCouldNotBeFollowedIsToldAndFollowedWithTheNextCommand) {
  auto refusals = std::make_shared<std::atomic<int>>(0);
  StudioServices own = services();
  own.networks = [refusals, usual = own.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = usual(method, parts);
    if (parts.deformer) networks.deformer = std::make_shared<ScantDeformer>(NearestDeformer(), refusals);
    return networks;
  };
  Studio studio(own);
  open_both(studio);
  const Session& session = studio.session();
  *refusals = 1;
  EXPECT_NO_THROW(paint(studio, 100));
  ASSERT_EQ(session.errors.size(), 1u);
  EXPECT_EQ(session.errors[0].text, "there is not enough memory");
  ASSERT_TRUE(session.document.takes[0].target_edits.weights);  // the edit itself is done, and can be undone
  EXPECT_LT((*session.takes[0].weights)(100, Head), 0.1f);
  studio.run("select.joint", {"neck"});
  EXPECT_GT((*session.takes[0].weights)(100, Head), 0.1f);
  *refusals = 1;
  paint(studio, 200);
  studio.run("compare.add", {"0", "engine=paper"});  // what else is wanted is made, too
  studio.wait_idle();
  ASSERT_EQ(session.takes.size(), 2u);
  EXPECT_EQ(session.takes[1].performed.size(), static_cast<size_t>(kFrames));
  EXPECT_EQ(session.errors.size(), 2u);
  studio.run("edit.undo");
  studio.run("edit.undo");
  EXPECT_LT((*session.takes[0].weights)(200, Head), 0.1f);
}

TEST_F(StudioTest, PaintThatDoesNotFitKeepsNothingElseFromBeingDone) {
  Studio studio(services());
  open_both(studio);
  WeightRows rows;  // as documents of before have them: where they were painted is not known
  rows.vertex = {1000000};
  rows.rows = RowMatrix::Identity(1, kJointCount);
  studio.session().document.takes[0].target_edits.weights = std::make_shared<const WeightRows>(rows);
  studio.run("compare.add", {"0", "engine=paper"});
  studio.wait_idle();
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
  studio.wait_idle();
  const TakeState& take = studio.session().takes[1];
  studio.neighbours(1);
  studio.cache().posed(take, {1, 3, false});
  studio.cache().wait();
  const int64_t bytes = studio.cache().bytes();
  const std::weak_ptr<const Deformer> deformer = take.deformer;
  const std::weak_ptr<const Target> target = take.target;
  const std::weak_ptr<const PreparedCharacter> character = take.character;
  studio.run("target.remove", {"1"});
  studio.wait_idle();
  EXPECT_TRUE(deformer.expired());
  EXPECT_TRUE(target.expired());
  EXPECT_TRUE(character.expired());
  EXPECT_LT(studio.cache().bytes(), bytes);
}

TEST_F(StudioTest, AMovedTargetJointIsKeptAndPerformedAgain) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.target_joint", {"0", "left_elbow", "0.5", "1.3", "0", "mirror"});
  studio.wait_idle();
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
  studio.wait_idle();
  ASSERT_EQ(studio.session().takes.size(), 1u);
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
}

TEST_F(StudioTest, EditsOfTheResultComeAndGo) {
  Studio studio(services());
  open_both(studio);
  const Motion before = studio.session().takes[0].shown;
  studio.run("edit.smooth", {"0", "0.8"});
  for (const auto& [old_name, name] : {std::pair{"edit.floor_offset", "edit.raise"},
                                       {"source.yaw", "source.turn"},
                                       {"target.yaw", "target.turn"}})
    EXPECT_EQ(studio.commands().find(old_name), studio.commands().find(name)) << name;
  studio.run("edit.raise", {"0", "0.25"});
  studio.wait_idle();
  EXPECT_NEAR(studio.session().takes[0].shown.poses[5].root.y(), before.poses[5].root.y() + 0.25f, 0.03f);
  EXPECT_GT(studio.session().takes[0].cost.mean_displacement_m, 0);
  studio.run("edit.poses_clear", {"0"});
  studio.wait_idle();
  EXPECT_TRUE(same_poses(studio.session().takes[0].shown, before));
}

TEST_F(StudioTest, TheRestPoseOfATargetIsPerformedSavedAndUndone) {
  Studio studio(services());
  open_both(studio);
  studio.run("method.filter", {"0", "hand_contacts", "off"});
  studio.wait_idle();
  const auto take = [&]() -> const TakeState& { return studio.session().takes[0]; };  // undo makes it anew
  const Motion before = take().shown;
  const auto deformer = take().deformer;
  studio.run("edit.rest_bone", {"0", "left_shoulder", "0", "0", "-0.5", "mirror"});
  studio.wait_idle();
  EXPECT_EQ(studio.session().history.undo_label(), "Turn left shoulder of the rest pose");
  EXPECT_EQ(take().deformer, deformer);  // nothing was bound again
  const auto turn = [&](size_t t, size_t j) {
    return rotation_to_axis_angle(before.poses[t].local[j].transpose() * take().shown.poses[t].local[j]);
  };
  EXPECT_NEAR(turn(5, LeftShoulder).z(), -0.5f, 0.02f);
  EXPECT_NEAR(turn(5, RightShoulder).z(), 0.5f, 0.02f);
  studio.run("document.save_as", {path("rest.understudy")});
  EXPECT_EQ(read_document(path("rest.understudy")).document.takes[0].target_edits.rest_pose.size(), 2u);
  studio.run("edit.rest_pose_clear", {"0"});
  studio.wait_idle();
  EXPECT_TRUE(same_poses(take().shown, before));
  studio.run("edit.undo");
  EXPECT_EQ(studio.session().document.takes[0].target_edits.rest_pose.size(), 2u);
}

TEST_F(StudioTest, AHandOfTheResultIsMovedInOneStepWithFalloff) {
  Studio studio(services());
  open_both(studio);
  const auto take = [&studio]() -> const TakeState& { return studio.session().takes[0]; };
  const std::vector<Joints> before = take().joints;
  studio.run("edit.move_limb", {"0", "10", "left_wrist", "0", "0.1", "0.05", "3"});
  studio.run("edit.move_limb", {"0", "10", "left_wrist", "0", "0", "-0.05", "3"});  // before it is shown
  studio.wait_idle();
  const auto moved = [&](size_t t, int joint) {
    return Vec3((take().joints[t].row(joint) - before[t].row(joint)).transpose());
  };
  EXPECT_LT((moved(10, LeftWrist) - Vec3(0, 0.1f, 0)).norm(), 0.01f);
  EXPECT_GT(moved(11, LeftWrist).norm(), 0.02f);
  EXPECT_LT(moved(14, LeftWrist).norm(), 1e-5f);
  EXPECT_LT(moved(10, Head).norm(), 1e-5f);
  EXPECT_EQ(studio.session().history.undo_label(), "Move left hand");
  studio.run("edit.undo");
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_LT(moved(10, LeftWrist).norm(), 1e-6f);
  EXPECT_TRUE(studio.session().document.takes[0].pose_edits.rotate.empty());
  EXPECT_THROW(studio.run("edit.move_limb", {"0", "10", "left_elbow", "0", "0.1", "0"}), Error);
}

TEST_F(StudioTest, AHandThatWasMovedIsOneEditToRemove) {
  Studio studio(services());
  open_both(studio);
  const auto& rotations = studio.session().document.takes[0].pose_edits.rotate;
  studio.run("edit.rotate", {"0", "10", "left_elbow", "0.2", "0", "0"});
  studio.run("edit.move_limb", {"0", "10", "left_wrist", "0", "0.1", "0.05", "3"});
  studio.run("edit.move_limb", {"0", "12", "left_wrist", "0", "0.1", "0.05", "3"});
  const size_t before = rotations.size();
  studio.run("edit.remove", {"limb", "0", "10", "left_wrist"});
  EXPECT_LT(rotations.size(), before);
  EXPECT_EQ(rotations[0].joint, LeftElbow) << "turned by itself";
  EXPECT_FALSE(rotations[0].limb);
  for (size_t i = 1; i < rotations.size(); ++i) EXPECT_EQ(rotations[i].frame, 12);
  EXPECT_THROW(studio.run("edit.remove", {"limb", "0", "10", "left_wrist"}), Error);
  studio.run("edit.undo");
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.rotate.size(), before);
}

TEST_F(StudioTest, ALimbThatWasMovedIsResetAsAWhole) {
  Studio studio(services());
  open_both(studio);
  const auto& rotations = studio.session().document.takes[0].pose_edits.rotate;
  studio.run("edit.move_limb", {"0", "10", "left_wrist", "0", "0.1", "0.05", "3"});
  ASSERT_GT(rotations.size(), 1u);
  studio.run("edit.rotate", {"0", "12", "right_elbow", "0.2", "0", "0"});
  studio.run("edit.remove", {"rotations_of", "0", "left_wrist"});
  EXPECT_EQ(studio.session().history.undo_label(), "Reset left arm");
  ASSERT_EQ(rotations.size(), 1u);
  EXPECT_EQ(rotations[0].joint, RightElbow);
  EXPECT_THROW(studio.run("edit.remove", {"rotations_of", "0", "left_wrist"}), Error);
  studio.run("edit.move_limb", {"0", "10", "right_foot", "0", "0.1", "0.05", "3"});
  studio.run("edit.rotate", {"0", "10", "right_foot", "0.2", "0", "0"});
  studio.run("edit.remove", {"rotations_of", "0", "right_foot"});
  EXPECT_EQ(studio.session().history.undo_label(), "Reset right leg");
  EXPECT_EQ(rotations.size(), 1u);
}

TEST_F(StudioTest, ItIsKnownWhichFeetStandInEachFrame) {
  Studio studio(services());
  open_both(studio);
  const auto take = [&studio]() -> const TakeState& { return studio.session().takes[0]; };
  ASSERT_EQ(take().shown.standing.size(), static_cast<size_t>(kFrames));
  for (size_t t = 0; t < take().shown.standing.size(); ++t)
    EXPECT_EQ(take().shown.standing[t], take().performed[t].standing) << t;
  studio.run("edit.pin", {"0", "on"});
  studio.wait_idle();
  EXPECT_EQ(take().shown.standing.size(), static_cast<size_t>(kFrames));
}

TEST_F(StudioTest, WhileAJointIsDraggedTheSkeletonIsAsItWillBeAfterwards) {
  Studio studio(services());
  open_both(studio);
  const Session& session = studio.session();
  const auto now = [&](size_t t) { return session.source.frames[t].joints; };
  studio.run("edit.swap", {"3", "4", "legs"});
  studio.run("edit.drag", {"11", "head", "0", "0.05", "0", "3"});
  studio.wait_idle();
  for (const bool with_children : {false, true}) {
    const Joints before = now(12);
    const SourceDrag drag(session, 12, 4);
    EXPECT_LT((drag.joints({12, LeftElbow, Vec3::Zero(), 4, false}).value() - before).norm(), 1e-5f);
    const Joints promised = drag.joints({12, LeftElbow, Vec3(0, 0.15f, 0.02f), 4, with_children}).value();
    EXPECT_GT((promised.row(LeftElbow) - before.row(LeftElbow)).norm(), 0.05f);
    EXPECT_GT((promised.row(LeftShoulder) - before.row(LeftShoulder)).norm(),
              1e-3f);  // bones keep their lengths
    Arguments words{"12", "left_elbow", "0", "0.15", "0.02", "4"};
    if (with_children) words.push_back("children");
    studio.run("edit.drag", words);
    studio.wait_idle();
    EXPECT_LT((now(12) - promised).norm(), 1e-4f);
  }
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

}  // namespace
}  // namespace understudy::app
