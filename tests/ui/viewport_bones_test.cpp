// A source's own skeleton in the views, without GL.
#include <gtest/gtest.h>

#include <set>

#include "render/colors.hpp"
#include "retarget/rig/rig_edits.hpp"
#include "tests/ui/support/viewport_stage.hpp"
#include "ui/viewport/pane.hpp"

namespace understudy::ui {
namespace {

struct BonesScene : testing::Test {
  BonesScene() {
    stage.show_frame(10);
    stage.add_found();
  }
  render::Scene scene(const EditPreview& preview = {}) {
    const PaneContent content = pane_of(0);
    pictures_of(session, *stage.cache, content, pane_frame(session, content));
    stage.cache->wait();
    last = pictures_of(session, *stage.cache, content, pane_frame(session, content)).value();
    PaneScene made = build_scene({session, content, last, {}, preview, ThemeKind::Dark}, memory);
    legend = made.legend;
    return made.scene;
  }
  Stage stage;
  app::Session& session = stage.session;
  SceneMemory memory;
  PanePictures last;
  Legend legend;
};

TEST_F(BonesScene, AreDrawnBesideTheJointsOfAPersonInTheirOwnColour) {
  const render::Scene both = scene();
  ASSERT_EQ(both.skeletons.size(), 2u);
  EXPECT_EQ(both.skeletons[0].joints.rows(), kJointCount);
  EXPECT_GT(both.skeletons[1].joints.rows(), 2) << "two joints and where the bones end";
  EXPECT_NE(both.skeletons[0].tint, both.skeletons[1].tint);
  EXPECT_NEAR(both.skeletons[1].joints(0, 0), 1, 1e-5f) << "in frame 10";
  session.source.no_person = true;
  EXPECT_EQ(scene().skeletons.size(), 1u) << "no person, no joints of one";
  session.view.source.bones = false;
  EXPECT_TRUE(scene().skeletons.empty());
}

TEST_F(BonesScene, TheSurfaceIsPaintedInTheScansPlaceOrBesideIt) {
  EXPECT_EQ(scene().clouds.size(), 1u);
  session.view.bone_surface = app::BoneSurface::Over;
  const render::Scene over = scene();
  EXPECT_TRUE(over.clouds.empty()) << "in place of the scan";
  ASSERT_EQ(over.meshes.size(), 1u);
  EXPECT_EQ(over.meshes[0].colors->rows(), stage.mesh.vertices.rows());
  EXPECT_NEAR((*over.meshes[0].vertices)(0, 0), stage.mesh.vertices(0, 0) + 1, 1e-4f);
  const auto again = scene();
  EXPECT_EQ(again.meshes[0].vertices.pointer(), over.meshes[0].vertices.pointer()) << "made once a frame";
  session.view.bone_surface = app::BoneSurface::Beside;
  const render::Scene beside = scene();
  EXPECT_EQ(beside.clouds.size(), 1u);
  ASSERT_EQ(beside.meshes.size(), 1u);
  EXPECT_GT((*beside.meshes[0].vertices)(0, 0), stage.mesh.vertices(0, 0) + 1.5f);
}

TEST_F(BonesScene, TheChosenOneIsBrightAndAloneInColour) {
  session.view.bone_surface = app::BoneSurface::Over;
  session.bones.selected = 1;
  const render::Scene chosen = scene();
  EXPECT_EQ(chosen.skeletons.size(), 3u) << "the bone once more, bright";
  const Points& colors = *chosen.meshes[0].colors;
  std::set<std::vector<float>> own, others;
  for (Eigen::Index v = 0; v < colors.rows(); ++v)
    (stage.mesh.vertices(v, 1) > 1.4f ? own : others).insert({colors(v, 0), colors(v, 1), colors(v, 2)});
  EXPECT_EQ(own.size(), 1u);
  EXPECT_EQ(others.size(), 1u) << "all others are grey";
  EXPECT_NE(own, others);
}

TEST_F(BonesScene, OfferedMotionsArePaleGhostsBesideEachOther) {
  session.view.bone_surface = app::BoneSurface::Over;
  const size_t alone = scene().meshes.size();
  for (const uint64_t seed : {1, 2}) {
    auto made = std::make_shared<app::GeneratedMotion>();
    made->seed = seed, made->motion.poses = session.bones.rig->found.motion.poses;
    app::MadeMotion one{{}, made};
    one.how.seed = seed;
    session.made_motions.offered.push_back(one);
  }
  const render::Scene both = scene();
  ASSERT_EQ(both.meshes.size(), alone + 2);
  const render::MeshView &first = both.meshes[alone], &second = both.meshes[alone + 1];
  EXPECT_NE(first.color, second.color);
  EXPECT_TRUE(first.opacity < 1 && second.opacity < 1);
  EXPECT_LT((*second.vertices)(0, 0), (*first.vertices)(0, 0) - 0.2f);
  EXPECT_LT((*first.vertices)(0, 0), (*both.meshes[0].vertices)(0, 0) - 0.2f);
  EXPECT_EQ(scene().meshes[alone].vertices.pointer(), first.vertices.pointer()) << "made once a frame";
  session.view.made_motions = app::BoneSurface::Off;
  EXPECT_EQ(scene().meshes.size(), alone);
  EXPECT_EQ(memory.made.size(), 0u);
}

TEST_F(BonesScene, ABoneThatIsBeingTurnedIsSeenTurned) {
  session.view.bone_surface = app::BoneSurface::Over;
  const render::Scene before = scene();
  const DiscoveredRig& rig = *session.bones.rig;
  EditPreview preview;
  preview.found.pose = std::make_shared<const RigPose>(
      turned(rig.found.rig, rig.found.motion.poses[10], TurnBone{1, 0, Vec3(0, 0, 0.6f)}));
  const render::Scene after = scene(preview);
  EXPECT_EQ(after.skeletons[1].joints.topRows(2), before.skeletons[1].joints.topRows(2)) << "about its joint";
  EXPECT_GT((after.skeletons[1].joints.row(2) - before.skeletons[1].joints.row(2)).norm(), 0.1f) << "its end";
  const Points &was = *before.meshes[0].vertices, &now = *after.meshes[0].vertices;
  const Eigen::VectorXf moved = (now - was).rowwise().norm();
  for (Eigen::Index v = 0; v < was.rows(); ++v)
    if (stage.mesh.vertices(v, 1) <= 1.4f) EXPECT_EQ(moved[v], 0) << v;
  EXPECT_GT(moved.maxCoeff(), 0.1f);
  EXPECT_EQ(*scene().meshes[0].vertices, was) << "let go";
}

TEST_F(BonesScene, WhileItIsPaintedTheSurfaceShowsTheWeightsOfTheChosenBone) {
  session.bones.selected = 1;
  session.tool = app::Tool::Paint;
  const render::Scene before = scene();
  ASSERT_EQ(before.meshes.size(), 1u) << "though the surface by bone is off";
  EXPECT_TRUE(before.clouds.empty()) << "in place of the scan";
  const Eigen::Index arm = [&] {
    Eigen::Index top = 0;
    stage.mesh.vertices.col(1).maxCoeff(&top);
    return top;
  }();
  EXPECT_EQ(Vec3(before.meshes[0].colors->row(arm)), render::viridis(1));
  EXPECT_EQ(legend.title, "Weight, arm");
  const understudy::Rig& rig = session.bones.rig->found.rig;
  RiggedMotion painted{rig, {}};
  apply(painted, PaintBone{1, {rig.surface.vertices.row(arm)}, 0.1f, 1, BrushMode::Subtract});
  EditPreview preview;
  preview.found.skin = std::make_shared<const SkinWeights>(painted.rig.skin);
  EXPECT_LT((Vec3(scene(preview).meshes[0].colors->row(arm)) - render::viridis(0)).norm(), 0.01f)
      << "as the stroke goes on";
  session.tool = app::Tool::Look;
  EXPECT_TRUE(scene().meshes.empty());
  EXPECT_EQ(legend.title, "");
}

TEST_F(BonesScene, ABoneIsMetWhereItIsSeen) {
  PaneView view;
  view.rect = {{0, 0}, {800, 600}};
  view.camera.target = Vec3(1, 1, 0);
  const auto bones = posed_bones(session, pane_of(0), 10);
  ASSERT_TRUE(bones);
  const auto middles = bone_middles(view, *bones);
  ASSERT_EQ(middles.size(), 2u);
  for (const auto& [joint, at] : middles) EXPECT_EQ(bone_at(view, *bones, at, 6), joint);
  EXPECT_EQ(bone_at(view, *bones, {5, 5}, 6), -1);
  EXPECT_FALSE(posed_bones(session, pane_of(0), 24)) << "the rig has no such frame";
  EXPECT_FALSE(posed_bones(session, pane_of(1), 10)) << "bones are the source's";
}

TEST_F(BonesScene, PartsArePaintedAsTheyComeWhereTheScanStands) {
  session.bones.rig.reset();
  auto so_far = std::make_shared<PartsSoFar>();
  so_far->points = stage.mesh.vertices.rowwise() + Eigen::RowVector3f(7, 0, 0);
  for (Eigen::Index v = 0; v < so_far->points.rows(); ++v) so_far->bone_of.push_back(static_cast<int>(v % 3));
  so_far->tree = {RigJoint{"", -1, JointKind::Free, Vec3(7, 1, 0)}};
  session.bones.so_far = so_far;
  const render::Scene painted = scene();
  ASSERT_EQ(painted.clouds.size(), 1u) << "in place of the scan";
  const Points& points = *painted.clouds[0].positions;
  ASSERT_EQ(points.rows(), so_far->points.rows());
  EXPECT_LT(std::abs(points.col(0).mean()), 1.5f) << "not seven metres away";
  EXPECT_NE(Vec3(painted.clouds[0].colors->row(0)), Vec3(painted.clouds[0].colors->row(1)));
}

TEST_F(BonesScene, TheSecondBodyStandsBesideInTheColoursOfWhatItPerforms) {
  auto body = std::make_shared<RiggedMotion>(session.bones.rig->found);
  session.second.performed = body;
  session.second.matches = {{1, 0}, {0, 0}};  // exchanged
  session.second.place = Vec3(3, 0, 0);
  const render::Scene plain = scene();
  ASSERT_EQ(plain.meshes.size(), 1u);
  EXPECT_EQ(plain.meshes[0].colors->rows(), 0);
  EXPECT_NEAR((*plain.meshes[0].vertices)(0, 0), stage.mesh.vertices(0, 0) + 4, 1e-4f) << "in frame 10";
  EXPECT_EQ(plain.skeletons.size(), 3u) << "person, found bones, the second's";
  session.view.bone_surface = app::BoneSurface::Over;
  const render::Scene painted = scene();
  ASSERT_EQ(painted.meshes.size(), 2u);
  const Points &first = *painted.meshes[0].colors, &second = *painted.meshes[1].colors;
  for (Eigen::Index v = 0; v < first.rows(); ++v)
    EXPECT_NE(Vec3(first.row(v)), Vec3(second.row(v))) << "the same surface, with exchanged bones";
  session.view.bone_surface = app::BoneSurface::Beside;
  EXPECT_GT((*scene().meshes[1].vertices)(0, 0), (*plain.meshes[0].vertices)(0, 0) + 0.5f);
}

}  // namespace
}  // namespace understudy::ui
