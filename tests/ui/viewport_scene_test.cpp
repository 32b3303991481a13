// From the session to what is drawn, without GL.
#include <gtest/gtest.h>

#include "app/session/follow.hpp"
#include "render/colors.hpp"
#include "tests/ui/support/viewport_stage.hpp"
#include "ui/viewport/pane.hpp"

namespace understudy::ui {
namespace {

struct SceneTest : testing::Test {
  SceneTest() {
    stage.add_take("adult");
    stage.show_frame(10);
  }
  PanePictures pictures(int pane) {
    const PaneContent content = pane_of(pane);
    pictures_of(session, *stage.cache, content, pane_frame(session, content));
    stage.cache->wait();
    return pictures_of(session, *stage.cache, content, pane_frame(session, content)).value();
  }
  PaneScene scene(int pane, const EditPreview& preview = {}) {
    last = pictures(pane);
    return build_scene({session, pane_of(pane), last, {}, preview, ThemeKind::Dark}, memory);
  }
  Stage stage;
  app::Session& session = stage.session;
  SceneMemory memory;
  PanePictures last;
};

TEST_F(SceneTest, ScanIsACloudAndATakeAMesh) {
  const render::Scene source = scene(0).scene, take = scene(1).scene;
  ASSERT_EQ(source.clouds.size(), 1u);
  EXPECT_EQ(source.clouds[0].positions->rows(), 4000);
  EXPECT_TRUE(source.meshes.empty());
  ASSERT_EQ(take.meshes.size(), 1u);
  EXPECT_EQ(take.meshes[0].vertices->rows(), stage.mesh.vertices.rows());
}

TEST_F(SceneTest, EachLayerIsThereOnlyWhenItIsOn) {
  app::Layers& layers = session.view.take;
  EXPECT_EQ(scene(1).scene.skeletons.size(), 1u);
  layers.skeleton = false;
  EXPECT_TRUE(scene(1).scene.skeletons.empty());
  layers.surface = false;
  EXPECT_TRUE(scene(1).scene.meshes.empty());
  EXPECT_TRUE(scene(1).scene.lines.empty());
  layers.trails = true;
  EXPECT_EQ(scene(1).scene.lines.size(), 4u);  // before and after, of two joints
  EXPECT_TRUE(scene(1).scene.ground.visible);
  layers.ground = false;
  EXPECT_FALSE(scene(1).scene.ground.visible);
}

TEST_F(SceneTest, PeopleHaveTheirColoursAndTheSceneIsGreyOrHidden) {
  const Points points = *scene(0).scene.clouds[0].positions;
  SceneFrame parts;
  for (int v = 0; v < points.rows(); ++v) parts.owner.push_back(v % 4 - 1);  // nobody, things, 1, 2
  session.source.frames.write(10, 11, [&](size_t, app::KeptSource& frame) {
    frame.owners = app::KeptOwners::of(points, parts, 1), frame.person = 1;
  });
  session.source.people = {{1, true, 5}, {2, true, 5}}, session.source.person = 1;
  const auto color_of = [&](int number) {
    const ImVec4 color = person_color(theme(ThemeKind::Dark), number);
    return Vec3(color.x, color.y, color.z);
  };
  const auto cloud = scene(0).scene.clouds[0];
  ASSERT_EQ(cloud.colors->rows(), points.rows());
  EXPECT_EQ(Vec3(cloud.colors->row(2)), color_of(1));
  EXPECT_EQ(Vec3(cloud.colors->row(3)), color_of(2));
  EXPECT_NE(color_of(1), color_of(2));
  EXPECT_EQ(Vec3(cloud.colors->row(0)), Vec3(cloud.colors->row(1)));
  session.source.people.pop_back();
  EXPECT_NE(Vec3(scene(0).scene.clouds[0].colors->row(2)), color_of(1)) << "one person needs no colour";
  session.view.source.scene = false;
  const auto people = scene(0).scene.clouds[0];
  ASSERT_EQ(people.positions->rows(), points.rows() / 2);
  EXPECT_EQ(Vec3(people.positions->row(0)), Vec3(points.row(2)));
  EXPECT_EQ(people.normals->rows(), people.positions->rows());
  EXPECT_EQ(people.colors->rows(), people.positions->rows());
}

TEST_F(SceneTest, TwoMethodsOnOneTargetAreToldApartByALineOfTheirOwn) {
  stage.add_take("adult");
  session.document.takes[1].method.engine = "paper";
  EXPECT_EQ(pane_title(session, pane_of(1)), "adult");
  EXPECT_EQ(pane_method(session, pane_of(1)), "copied rotations");
  EXPECT_EQ(pane_method(session, pane_of(2)), "paper's network");
  EXPECT_EQ(pane_method(session, pane_of(0)), "") << "the source is not made";
  session.view.layout = app::Layout::Overlay;
  EXPECT_EQ(pane_method(session, panes_of(session)[0]), "");
}

TEST_F(SceneTest, AFrameThatWasMadeSaysSoAndHowFarItMayBeOff) {
  session.takes[0].shown.doubt_m.assign(session.takes[0].shown.poses.size(), 0.f);
  session.takes[0].shown.doubt_m[3] = 0.021f;
  EXPECT_EQ(pane_made(session, pane_of(1), 3), "filled, \u00b1 3 cm");
  session.document.takes[0].pose_edits.go_on = GoOnEdit{};
  EXPECT_EQ(pane_made(session, pane_of(1), 3), "predicted, \u00b1 3 cm")
      << "beyond those performed: none here";
  session.document.takes[0].pose_edits.go_on.reset();
  EXPECT_EQ(pane_made(session, pane_of(1), 2), "") << "captured";
  EXPECT_EQ(pane_made(session, pane_of(0), 3), "") << "the source is as it was captured";
  EXPECT_EQ(pane_made(session, pane_of(1), 4000), "");
}

/// Where a picture's points are in the middle.
Vec3 middle_of(const Points& points) {
  return points.colwise().mean().transpose();
}

class OverlayScene : public SceneTest {
 protected:
  OverlayScene() { session.view.layout = app::Layout::Overlay; }
  render::Scene overlaid() {
    const PaneContent pane = panes_of(session)[0];
    pictures_of(session, *stage.cache, pane, pane_frame(session, pane));
    stage.cache->wait();
    last = pictures_of(session, *stage.cache, pane, pane_frame(session, pane)).value();
    return build_scene({session, pane, last, {nullptr}, {}, ThemeKind::Dark}, memory).scene;
  }
};

TEST_F(OverlayScene, EachLayerHasItsOpacity) {
  app::OverlayLook& look = session.view.overlay;
  look.scan = 0.4f, look.skeletons = 0.7f, look.results = 0.2f;
  const render::Scene scene = overlaid();
  EXPECT_EQ(scene.clouds.at(0).opacity, 0.4f);
  EXPECT_EQ(scene.meshes.at(0).opacity, 0.2f);
  for (const auto& skeleton : scene.skeletons) EXPECT_EQ(skeleton.opacity, 0.7f);
  look.scan = look.skeletons = look.results = 0;
  const render::Scene nothing = overlaid();
  EXPECT_TRUE(nothing.clouds.empty() && nothing.meshes.empty() && nothing.skeletons.empty());
}

TEST_F(OverlayScene, SpreadPutsThePeopleSideBySideAndZeroOnEachOther) {
  const render::Scene together = overlaid();
  session.view.overlay.spread_m = 1.2f;
  const render::Scene apart = overlaid();
  const auto moved = [](const auto& a, const auto& b) { return Vec3(middle_of(b) - middle_of(a)); };
  EXPECT_TRUE(
      moved(*together.clouds[0].positions, *apart.clouds[0].positions).isApprox(Vec3(-0.6f, 0, 0), 1e-3f));
  EXPECT_TRUE(
      moved(*together.meshes[0].vertices, *apart.meshes[0].vertices).isApprox(Vec3(0.6f, 0, 0), 1e-3f));
  for (size_t i = 0; i < 2; ++i) {
    const Vec3 by = moved(together.skeletons[i].joints, apart.skeletons[i].joints);
    EXPECT_TRUE(by.isApprox(Vec3(i == 0 ? -0.6f : 0.6f, 0, 0), 1e-3f)) << i;
  }
  const render::Scene again = overlaid();
  EXPECT_TRUE(same(apart, again)) << "nothing is to be drawn anew";
  EXPECT_EQ(memory.moved.size(), 2u);
  session.view.take.ghosts = session.view.source.ghosts = true;
  overlaid(), overlaid();
  EXPECT_GT(memory.moved.size(), 4u);
  session.view.take.ghosts = session.view.source.ghosts = false;
  overlaid();
  EXPECT_EQ(memory.moved.size(), 2u) << "ghosts that are gone take no memory";
  session.view.overlay.spread_m = 0;
  overlaid();
  EXPECT_EQ(memory.moved.size(), 0u);
}

TEST_F(SceneTest, SpreadAndOpacityAreOfTheOverlayAlone) {
  const render::Scene before = scene(1).scene;
  session.view.overlay = {0.1f, 0.1f, 0.1f, 2};
  EXPECT_TRUE(same(before, scene(1).scene));
}

TEST_F(SceneTest, WireframeLightAndBackgroundAreTheViews) {
  const render::Scene before = scene(1).scene;
  EXPECT_FALSE(before.meshes[0].wireframe);
  EXPECT_TRUE(same(before.light, render::LightView()));
  session.view.take.wireframe = true;
  session.view.light = {90, 0, 0.5f};
  session.view.background = app::Background::White;
  const render::Scene now = scene(1).scene;
  EXPECT_TRUE(now.meshes[0].wireframe);
  EXPECT_TRUE(now.light.key.isApprox(0.5f * before.light.key));
  EXPECT_NEAR(now.light.key_direction.y(), before.light.key_direction.normalized().y(), 1e-5f);
  EXPECT_GT(now.light.key_direction.x(), 0.3f) << "it came from the left";
  EXPECT_EQ(now.background.top, Vec3(1, 1, 1));
  session.view.background = app::Background::Custom, session.view.background_color = Vec3(0.1f, 0.2f, 0.3f);
  EXPECT_EQ(scene(1).scene.background.bottom, Vec3(0.1f, 0.2f, 0.3f));
}

TEST_F(SceneTest, GhostsArePosesOfOtherFrames) {
  session.view.take.ghosts = true, session.view.ghost_count = 2, session.view.ghost_step = 4;
  pictures(1);
  const render::Scene ghosts = scene(1).scene;
  ASSERT_EQ(ghosts.meshes.size(), 5u);  // frames 2, 6, 14, 18 and this one
  EXPECT_EQ(ghosts.meshes[0].opacity, 1);
  EXPECT_LT(ghosts.meshes[1].opacity, 0.5f);
  const float moved = (ghosts.meshes[1].vertices->row(0) - ghosts.meshes[0].vertices->row(0)).norm();
  EXPECT_GT(moved, 0.05f);
}

TEST_F(SceneTest, GhostsAreColouredByTimeWhereThatIsAskedFor) {
  session.view.take.ghosts = session.view.source.ghosts = true;
  session.view.ghost_count = 2, session.view.ghost_step = 4;
  pictures(1);
  const Vec3 plain = scene(1).scene.meshes.at(1).color;
  const float faint = scene(1).scene.meshes[1].opacity;
  session.view.ghosts_by_time = true;
  const auto meshes = scene(1).scene.meshes;
  ASSERT_EQ(meshes.size(), 5u);
  EXPECT_LT((meshes[0].color - plain).norm(), 1e-5f) << "the frame shown is as ever";
  // Nearer ghosts come first: 6, 2, then 14, 18.
  const std::array<int, 4> frames = {6, 2, 14, 18};
  for (size_t i = 0; i < 4; ++i) {
    const Vec3 wanted = render::time_color(static_cast<float>(frames[i] - 2) / 16);
    EXPECT_LT((meshes[i + 1].color - wanted).norm(), 1e-5f) << frames[i];
    EXPECT_GT(meshes[i + 1].opacity, faint);
  }
  EXPECT_GT(meshes[2].color.z(), meshes[2].color.x()) << "the first is blue";
  EXPECT_GT(meshes[4].color.x(), meshes[4].color.z()) << "the last is red";
  pictures(0);
  const auto clouds = scene(0).scene.clouds;
  ASSERT_EQ(clouds.size(), 5u);
  EXPECT_LT((clouds[2].color - render::time_color(0)).norm(), 1e-5f);
}

TEST_F(SceneTest, GhostsThatWereMadeDifferFromThoseThatWereCaptured) {
  session.view.take.ghosts = true, session.view.ghost_count = 1, session.view.ghost_step = 4;
  session.takes[0].shown.doubt_m.assign(session.takes[0].shown.poses.size(), 0.f);
  session.takes[0].shown.doubt_m[14] = 0.03f;
  pictures(1);
  auto meshes = scene(1).scene.meshes;
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_GT((meshes[2].color - meshes[1].color).norm(), 0.1f) << "violet";
  session.view.ghosts_by_time = true;
  meshes = scene(1).scene.meshes;
  EXPECT_FALSE(meshes[1].wireframe);
  EXPECT_TRUE(meshes[2].wireframe) << "its colour tells the time";
}

TEST_F(SceneTest, AFutureIsAFanOfTrailsFromTheLastCapturedFrame) {
  app::TakeState& take = session.takes[0];
  session.source.fps = 5;  // so that the frame shown at first is far from the last
  const size_t count = take.joints.size();
  for (const Pose& pose : take.shown.poses) take.performed.push_back({pose});
  EXPECT_TRUE(scene(1).scene.lines.empty());
  for (int i = 0; i < 20; ++i) {
    take.shown.poses.push_back(take.shown.poses.back());
    take.joints.push_back(take.joints.back());
    take.joints.back().col(2).array() += 0.02f;
  }
  EXPECT_TRUE(scene(1).scene.lines.empty()) << "far from it";
  stage.show_frame(static_cast<int>(count) - 1);
  const auto lines = scene(1).scene.lines;
  ASSERT_EQ(lines.size(), 5u);
  const Points& path = lines[0].positions;
  ASSERT_EQ(path.rows(), 21);
  EXPECT_LT((path.row(20) - take.joints[count - 1].row(Pelvis)).norm(), 1e-5f);
  EXPECT_LT((path.row(0) - take.joints.back().row(Pelvis)).norm(), 1e-5f);
}

TEST_F(SceneTest, OtherAnswersAreThinTrailsBesideTheChosenOne) {
  app::TakeState& take = session.takes[0];
  for (const Pose& pose : take.shown.poses) take.performed.push_back({pose});
  session.document.takes[0].pose_edits.fill = {{5, 8, 1, 2}};
  stage.show_frame(6);
  EXPECT_TRUE(scene(1).scene.lines.empty()) << "they are not made yet";
  for (int k = 0; k < kMostVariations; ++k) {
    take.alternatives.push_back(take.joints);
    for (int t = 5; t <= 8; ++t) take.alternatives.back()[t].col(0).array() += 0.1f * static_cast<float>(k);
  }
  const auto lines = scene(1).scene.lines;
  ASSERT_EQ(lines.size(), 20u) << "four answers of five joints";
  for (size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].positions.rows(), 6) << "from the frame before to the one behind";
    EXPECT_EQ(lines[i].width > 2, i >= 15) << "the chosen one is full";
  }
  const float apart = lines[10].positions(2, 0) - lines[0].positions(2, 0);
  EXPECT_NEAR(apart, 0.3f, 1e-5f) << "the fourth and the first: the third is chosen";
  stage.show_frame(10);
  EXPECT_TRUE(scene(1).scene.lines.empty()) << "none of the filled frames is shown";
}

TEST_F(SceneTest, OffsetsAreTheirLengthInMillimetres) {
  session.view.take.colouring = app::Colouring::Offsets;
  const PaneScene made = scene(1);
  ASSERT_NE(made.values, nullptr);
  EXPECT_NEAR(made.values->minCoeff(), 10, 1e-3);
  EXPECT_NEAR(made.values->maxCoeff(), 10, 1e-3);
  EXPECT_EQ(made.legend.unit, "mm");
  const Vec3 wanted = render::viridis(10 / session.view.error_scale_mm);
  EXPECT_LT((made.scene.meshes[0].colors->row(5).transpose() - wanted).norm(), 1e-5f);
}

TEST_F(SceneTest, ErrorIsTheDistanceToTheTruthOfThatFrame) {
  auto truth = std::make_shared<app::Truth>();
  truth->frames = 24, truth->vertex_count = stage.mesh.vertices.rows();
  for (int f = 0; f < 24; ++f) {
    Points there = stage.deformer->deform(stage_pose(f));
    there.col(1).array() += 0.025f;
    truth->vertices.insert(truth->vertices.end(), there.data(), there.data() + there.size());
  }
  session.truth = truth;
  session.view.take.colouring = app::Colouring::Error;
  const PaneScene made = scene(1);
  ASSERT_NE(made.values, nullptr);
  EXPECT_NEAR(made.values->mean(), 25, 1e-2);
  EXPECT_EQ(made.legend.scale, Legend::Scale::Error);
}

TEST_F(SceneTest, ErrorWithoutTruthSaysSo) {
  session.view.take.colouring = app::Colouring::Error;
  const PaneScene made = scene(1);
  EXPECT_EQ(made.values, nullptr);
  EXPECT_FALSE(made.legend.missing.empty());
  EXPECT_EQ(made.scene.meshes[0].colors->rows(), 0);
}

TEST_F(SceneTest, DifferenceIsAgainstTheFirstTake) {
  stage.add_take("aside", 0.04f);
  session.view.take.colouring = app::Colouring::Difference;
  EXPECT_EQ(scene(1).values->maxCoeff(), 0);
  EXPECT_NEAR(scene(2).values->mean(), 40, 1e-2);
}

TEST_F(SceneTest, OneJointsWeightsAreOnAScaleAllJointsAreCategories) {
  session.view.take.colouring = app::Colouring::Weights;
  session.view.weights_joint = LeftHip;
  const PaneScene one = scene(1);
  EXPECT_EQ(*one.values, Eigen::VectorXf(stage.weights->col(LeftHip)));
  session.view.weights_joint = -1;
  const PaneScene all = scene(1);
  EXPECT_EQ(all.legend.categories.size(), 22u);
  Eigen::Index joint = 0;
  stage.weights->row(7).maxCoeff(&joint);
  EXPECT_EQ(Vec3(all.scene.meshes[0].colors->row(7)), render::kCategories[static_cast<size_t>(joint)]);
}

TEST_F(SceneTest, DoubtOfTheBindingIsNeutralToWarm) {
  session.view.take.colouring = app::Colouring::Uncertainty;
  EXPECT_FALSE(scene(1).legend.missing.empty());  // a skin of its own is not doubted
  auto binding = std::make_shared<SafeBinding>();
  binding->uncertainty = Eigen::VectorXf::Zero(stage.mesh.vertices.rows());
  binding->uncertainty[3] = 1, binding->uncertainty[4] = 0.25f;
  session.takes[0].binding = binding;
  const PaneScene made = scene(1);
  ASSERT_NE(made.values, nullptr);
  EXPECT_FLOAT_EQ((*made.values)[4], 25);
  EXPECT_EQ(made.legend.unit, "%");
  const Points& colors = *made.scene.meshes[0].colors;
  const Vec3 trusted = colors.row(0), doubted = colors.row(3);
  EXPECT_LT(trusted.maxCoeff() - trusted.minCoeff(), 0.03f);
  EXPECT_GT(doubted.x(), doubted.z() + 0.3f);
  EXPECT_LT((scale_color(made.legend.scale, 1) - doubted).norm(), 1e-5f);
}

TEST_F(SceneTest, ConfidenceIsOfTheNearestJoint) {
  session.view.source.colouring = app::Colouring::Confidence;
  session.source.frames.write(10, 11,
                              [](size_t, app::KeptSource& frame) { frame.confidence_of[LeftWrist] = 0.2f; });
  const PaneScene made = scene(0);
  const Joints& joints = session.source.frames[10].joints;
  const Points& points = last.scan->mesh.vertices;
  Eigen::Index near_wrist = 0;
  (points.rowwise() - joints.row(LeftWrist)).rowwise().norm().minCoeff(&near_wrist);
  EXPECT_FLOAT_EQ((*made.values)[near_wrist], 0.2f);
  EXPECT_FLOAT_EQ(made.values->maxCoeff(), 0.9f);
}

TEST_F(SceneTest, NothingChangedIsTheSamePicture) {
  session.view.take.colouring = app::Colouring::Weights;
  session.view.take.trails = true;
  const render::Scene first = scene(1).scene;
  EXPECT_TRUE(same(first, scene(1).scene));
  session.playback.frame = 11;
  EXPECT_FALSE(same(first, scene(1).scene));
}

TEST_F(SceneTest, WhatIsNotThereYetIsLeftOut) {
  const PanePictures nothing;
  const PaneScene made = build_scene({session, pane_of(1), nothing, {}, {}, ThemeKind::Light}, memory);
  EXPECT_TRUE(made.scene.meshes.empty());
  const PanePictures null_inside{10, nullptr, {nullptr}, nullptr, {{nullptr, nullptr}}};
  session.view.take.ghosts = true;
  EXPECT_EQ(build_scene({session, pane_of(1), null_inside, {nullptr}, {}, ThemeKind::Light}, memory)
                .scene.skeletons.size(),
            1u);
}

TEST_F(SceneTest, TheLastPictureStaysUntilTheNextIsThere) {
  PictureKeeper keeper;
  TargetLooks looks;
  const PaneContent pane = pane_of(1);
  keeper.update(session, *stage.cache, looks, pane);
  stage.cache->wait();
  EXPECT_EQ(keeper.update(session, *stage.cache, looks, pane).frame, 10);
  session.playback.frame = 20;
  const int seen = keeper.update(session, *stage.cache, looks, pane).frame;
  EXPECT_TRUE(seen == 10 || seen == 20);
  EXPECT_EQ(keeper.waiting(), seen == 10);
  stage.cache->wait();
  EXPECT_EQ(keeper.update(session, *stage.cache, looks, pane).frame, 20);
  EXPECT_FALSE(keeper.waiting());
  session.takes.clear(), session.document.takes.clear();
  EXPECT_EQ(keeper.update(session, *stage.cache, looks, pane).frame, -1);
}

TEST_F(SceneTest, TheCropToolShowsItsBox) {
  EXPECT_TRUE(scene(0).scene.lines.empty());
  session.tool = app::Tool::Crop;
  session.document.scan_edits.crop = Box{Vec3(-1, 0, -1), Vec3(1, 2, 1)};
  EXPECT_EQ(scene(0).scene.lines.size(), 1u);
  EXPECT_EQ(Vec3(face_centres(*session.document.scan_edits.crop).row(3)), Vec3(0, 2, 0));
}

TEST_F(SceneTest, ANewCropBoxHoldsThePersonInAllFrames) {
  const Box box = app::shown_crop(session);
  for (int f = 0; f < 24; ++f) {
    const Points person = stage.deformer->deform(stage_pose(f));
    for (Eigen::Index v = 0; v < person.rows(); ++v) ASSERT_TRUE(box.contains(person.row(v))) << f;
  }
  EXPECT_LT(box.high.y(), 2.2f);
}

TEST_F(SceneTest, APreviewStandsInForTheJoints) {
  EditPreview preview;
  preview.take_joints = Joints::Ones();
  EXPECT_EQ(scene(1, preview).scene.skeletons[0].joints, Points(Joints::Ones()));
}

TEST_F(SceneTest, WithoutFramesATakeIsInTPose) {
  session.takes[0].joints.clear(), session.takes[0].shown.poses.clear();
  EXPECT_TRUE(shows_rest(session, pane_of(1)));
  TargetLooks looks;
  PictureKeeper keeper;
  keeper.update(session, *stage.cache, looks, pane_of(1));
  looks.wait();
  EXPECT_EQ(keeper.update(session, *stage.cache, looks, pane_of(1)).takes[0]->vertices, stage.mesh.vertices);
}

TEST_F(SceneTest, ACharacterIsSeenAsItCameUntilItIsBound) {
  app::TakeState& take = session.takes[0];
  const auto target = take.target;
  auto came = std::make_shared<Target>();
  came->mesh = stage.mesh;
  came->mesh.vertices.col(0).array() += 3;  // wherever its file has it
  came->mesh.colors = Points::Constant(stage.mesh.vertices.rows(), 3, 0.25f);
  take = {};
  EXPECT_NE(pane_hint(session, pane_of(1)), "");
  take.as_loaded = came;
  EXPECT_TRUE(shows_as_loaded(session, pane_of(1)));
  EXPECT_EQ(pane_hint(session, pane_of(1)), "");
  TargetLooks looks;
  PictureKeeper keeper;
  keeper.update(session, *stage.cache, looks, pane_of(1));
  looks.wait();
  const PanePictures shown = keeper.update(session, *stage.cache, looks, pane_of(1));
  EXPECT_FALSE(keeper.waiting());
  const PaneScene made = build_scene({session, pane_of(1), shown, {}, {}, ThemeKind::Dark}, memory);
  ASSERT_EQ(made.scene.meshes.size(), 1u);
  EXPECT_EQ(*made.scene.meshes[0].vertices, came->mesh.vertices);
  EXPECT_EQ(*made.scene.meshes[0].colors, came->mesh.colors);
  EXPECT_TRUE(made.scene.skeletons.empty());
  EXPECT_NEAR(follow_offset(session, pane_of(1)).x(), 3, 0.1f);

  take.target = target, take.as_loaded = nullptr, take.ready = true;
  keeper.update(session, *stage.cache, looks, pane_of(1));
  EXPECT_EQ(keeper.pictures().takes.size(), 1u);  // no gap: what stood there stays until the T-pose is drawn
  looks.wait();
  EXPECT_EQ(keeper.update(session, *stage.cache, looks, pane_of(1)).takes[0]->vertices, stage.mesh.vertices);
}

TEST(Panes, FollowTheLayout) {
  Stage stage;
  stage.add_take("a"), stage.add_take("b");
  app::View& view = stage.session.view;
  EXPECT_EQ(panes_of(stage.session).size(), 3u);
  view.layout = app::Layout::Wipe;
  EXPECT_EQ(panes_of(stage.session), (std::vector<PaneContent>{pane_of(1), pane_of(2)}));
  view.layout = app::Layout::Single, view.active_pane = 2;
  EXPECT_EQ(panes_of(stage.session), std::vector<PaneContent>{pane_of(2)});
  view.layout = app::Layout::Overlay, stage.session.selected_take = 1;
  EXPECT_EQ(panes_of(stage.session)[0].takes, (std::vector<int>{1, 0}));
}

TEST(Panes, AFollowingCameraGoesWithThePerson) {
  Stage stage;
  stage.session.view.follow = true;
  stage.show_frame(10);
  const PaneContent pane = pane_of(0);
  const render::Camera camera = pane_camera(stage.session, pane);
  EXPECT_NEAR(camera.target.z(), 0.3f, 0.06f);
  EXPECT_NEAR(camera.target.y(), 0.9f, 1e-5f);
  const auto words = camera_arguments(stage.session, pane, camera);
  EXPECT_NEAR(std::stof(words[3]), 0, 1e-4f);  // the command says it relative to the person
}

TEST(Panes, PixelsGoThereAndBack) {
  PaneView view{{{100, 50}, {500, 450}}, render::Camera{}};
  const auto at = view.project(Vec3(0.2f, 1.1f, 0.1f));
  ASSERT_TRUE(at);
  const render::Ray ray = view.ray(*at);
  EXPECT_LT((Vec3(0.2f, 1.1f, 0.1f) - ray.origin).cross(ray.direction).norm(), 2e-3f);
  Joints joints = render::make_joints();
  EXPECT_EQ(point_at(view, joints, *view.project(joints.row(LeftElbow)), 5), LeftElbow);
  EXPECT_EQ(point_at(view, joints, {101, 51}, 5), -1);
}

TEST(TargetLook, OtherJointsKeepTheLook) {
  Stage stage(1, 500);
  TargetLooks looks;
  EXPECT_EQ(looks.of(stage.target), nullptr);
  looks.wait();
  const auto look = looks.of(stage.target);
  ASSERT_NE(look, nullptr);
  EXPECT_EQ(look->ambient->size(), stage.mesh.vertices.rows());
  Target moved = *stage.target;
  moved.joints.row(LeftKnee) *= 1.1f;
  EXPECT_EQ(looks.of(std::make_shared<const Target>(moved)), look);
  moved.mesh.vertices(0, 0) += 1;
  EXPECT_EQ(looks.of(std::make_shared<const Target>(moved)), nullptr);
}

TEST(TargetLook, WhatIsShownForAMomentStaysPlainAndIsShadedLater) {
  Stage stage(1, 500);
  TargetLooks looks;
  EXPECT_EQ(looks.plain_of(stage.target), nullptr);
  looks.wait();
  EXPECT_EQ(looks.arrived(), 1);
  const auto plain = looks.plain_of(stage.target);
  ASSERT_NE(plain, nullptr);
  EXPECT_EQ(plain->ambient->size(), 0);
  EXPECT_EQ(plain->rest->normals.rows(), stage.mesh.vertices.rows());
  EXPECT_EQ(looks.of(stage.target), plain);  // at once, while the rest is made
  looks.wait();
  EXPECT_EQ(looks.of(stage.target)->ambient->size(), stage.mesh.vertices.rows());
}

TEST(TargetLook, WhatIsForgottenIsMadeAgain) {
  Stage stage(1, 500);
  TargetLooks looks;
  looks.of(stage.target);
  looks.wait();
  ASSERT_NE(looks.of(stage.target), nullptr);
  const int64_t arrived = looks.arrived();
  looks.forget();
  EXPECT_EQ(looks.of(stage.target), nullptr);
  looks.wait();
  EXPECT_NE(looks.of(stage.target), nullptr);
  EXPECT_GT(looks.arrived(), arrived);
}

TEST(TargetLook, ATubeIsClosedAndAnOpenOneIsNot) {
  Faces faces(4, 3);
  faces << 0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0;
  EXPECT_TRUE(is_closed(faces));
  EXPECT_FALSE(is_closed(faces.topRows(3)));
}

}  // namespace
}  // namespace understudy::ui
