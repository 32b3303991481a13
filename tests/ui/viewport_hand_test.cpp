// What the mouse does in the views: real input, a null context, and the commands that come out.
#include <functional>
#include <sstream>
#include <tuple>

#include "app/session/studio.hpp"
#include "render/context/context.hpp"
#include "render/gizmo.hpp"
#include "retarget/base/text.hpp"
#include "tests/ui/support/ui_test.hpp"
#include "tests/ui/support/viewport_stage.hpp"
#include "ui/panels/help.hpp"
#include "ui/viewport/pane.hpp"
#include "ui/viewport/views.hpp"

namespace understudy::ui {
namespace {

class ViewsTest : public UiTest {
 protected:
  ViewsTest() {
    stage.add_take("adult");
    stage.show_frame(10);
    input.size = {1000, 500};
    in_window([this](Ui& ui) {
      const size_t before = queue.size();
      PanelContext panels{ui, queue, commands};
      views.draw(stage.session, *stage.cache, panels);
      for (size_t i = before; i < queue.size(); ++i) obey(queue[i].first, queue[i].second);
    });
    frame(2);
    stage.cache->wait();
    frame(2);
    queue.clear();
  }
  ~ViewsTest() override = default;

  /// The commands that input depends on within a test.
  void obey(const std::string& name, const app::Arguments& words) {
    app::View& view = stage.session.view;
    if (name == "view.camera_state") {
      app::CameraState& camera = view.cameras[0];
      camera.target = {std::stof(words[1]), std::stof(words[2]), std::stof(words[3])};
      camera.yaw = std::stof(words[4]), camera.pitch = std::stof(words[5]),
      camera.distance = std::stof(words[6]);
    } else if (name == "view.pane") {
      view.active_pane = std::stoi(words[0]);
    } else if (name == "select.joint") {
      for (int j = 0; j < kJointCount; ++j)
        if (words[0] == kJointNames[static_cast<size_t>(j)]) stage.session.selected_joint = j;
    } else if (name == "bones.select") {
      stage.session.bones.selected = std::stoi(words[0]);
    }
  }
  PaneView pane(int number) {
    return {mark("view." + std::to_string(number)).rect, pane_camera(stage.session, pane_of(number))};
  }
  ImVec2 seen(int number, const Vec3& point) { return pane(number).project(point).value_or(ImVec2(-9, -9)); }
  Vec3 source_joint(int joint) { return stage.session.source.frames[10].joints.row(joint); }
  Vec3 take_joint(int joint) { return stage.session.takes[0].joints[10].row(joint); }
  /// The last command of that name; a failure when there is none.
  app::Arguments asked(const std::string& name) {
    for (auto it = queue.rbegin(); it != queue.rend(); ++it)
      if (it->first == name) return it->second;
    ADD_FAILURE() << name << " was not asked for";
    return app::Arguments(8, "0");
  }
  int count(const std::string& name) {
    int n = 0;
    for (const auto& command : queue) n += command.first == name ? 1 : 0;
    return n;
  }
  static float metres_a_pixel(const PaneView& view, const Vec3& point) {
    return render::metres_a_pixel(view.camera, view.size(), point);
  }
  static Vec3 vector_at(const app::Arguments& words, size_t first) {
    return {std::stof(words.at(first)), std::stof(words.at(first + 1)), std::stof(words.at(first + 2))};
  }

  std::unique_ptr<render::Context> context = render::make_offscreen_context({render::ContextKind::Null});
  Stage stage;
  app::Commands commands;
  app::CommandQueue queue;
  Views views;
};

TEST_F(ViewsTest, NothingIsDrawnTwice) {
  frame(5);
  EXPECT_FALSE(views.waiting());
  const int64_t before = views.drawn();
  frame(10);
  EXPECT_EQ(views.drawn(), before);
}

TEST_F(ViewsTest, WhatMovesIsDrawnQuicklyAndWellAfterwards) {
  frame(5);
  const int64_t before = views.drawn();
  stage.session.view.cameras[0].yaw += 0.1f;
  frame();
  EXPECT_EQ(views.drawn(), before + 2);  // two panes, one camera
  EXPECT_TRUE(views.waiting());
  frame();
  EXPECT_EQ(views.drawn(), before + 4);
  EXPECT_FALSE(views.waiting());
}

TEST_F(ViewsTest, DraggingTurnsTheCamera) {
  const float yaw = stage.session.view.cameras[0].yaw;
  const ImVec2 from = mark("view.0").rect.at(0.1f, 0.9f);
  drag(from, {from.x + 60, from.y});
  EXPECT_LT(stage.session.view.cameras[0].yaw, yaw - 0.2f);
  EXPECT_EQ(asked("view.camera_state")[0], "0");
}

TEST_F(ViewsTest, TheMouseDoesInTheViewsWhatTheHelpSays) {
  const std::tuple<const char*, render::MouseButton, bool> ways[] = {
      {"left", render::MouseButton::Left, false},
      {"right", render::MouseButton::Right, false},
      {"middle", render::MouseButton::Middle, false},
      {"shift+left", render::MouseButton::Left, true},
      {"shift+middle", render::MouseButton::Middle, true}};
  const auto said_of = [](const std::string& way) -> std::string {
    for (const MouseUse& use : mouse_uses(app::Tool::Look)) {
      std::istringstream words(lower_case(use.buttons));
      for (std::string word; words >> word;)
        if (word == way || word == way + ",") return use.does;
    }
    return "";
  };
  for (const auto& [way, which, shift] : ways) {
    const app::CameraState before = stage.session.view.cameras[0];
    const ImVec2 from = mark("view.0").rect.at(0.1f, 0.8f);
    render::Modifiers held;
    held.shift = shift;
    drag(from, {from.x + 40, from.y - 30}, held, which);
    const app::CameraState& after = stage.session.view.cameras[0];
    EXPECT_EQ(after.yaw != before.yaw, said_of(way) == "Turns the view") << way;
    EXPECT_EQ(after.target != before.target, said_of(way) == "Moves the view") << way;
    EXPECT_FALSE(said_of(way).empty()) << way;
  }
}

TEST_F(ViewsTest, ARightDragWithControlTurnsTheLightAndNothingElse) {
  stage.session.tool = app::Tool::Joints;
  stage.session.view.light = {10, 20, 1};
  const app::CameraState before = stage.session.view.cameras[0];
  const ImVec2 from = seen(0, source_joint(LeftWrist));
  render::Modifiers control;
  control.control = true;
  drag(from, {from.x + 60, from.y}, control, render::MouseButton::Right);
  EXPECT_GT(std::stof(asked("view.light").at(1)), 10) << "it follows the pointer";
  EXPECT_EQ(asked("view.light")[0], "turn");
  drag(from, {from.x, from.y - 60}, control, render::MouseButton::Right);
  EXPECT_EQ(asked("view.light")[0], "height");
  EXPECT_GT(std::stof(asked("view.light").at(1)), 20) << "up";
  EXPECT_EQ(stage.session.view.cameras[0].yaw, before.yaw);
  EXPECT_EQ(count("edit.drag"), 0);
  frame(3);
  EXPECT_FALSE(shown("menu.view.fit")) << "no menu after a drag";
}

TEST_F(ViewsTest, ARightClickOffersWhatCanBeDoneInThatView) {
  click(mark("view.1").rect.at(0.1f, 0.8f), render::MouseButton::Right);
  frame(3);
  EXPECT_EQ(asked("view.pane"), app::Arguments{"1"});
  ASSERT_TRUE(shown("menu.view.fit"));
  EXPECT_FALSE(shown("menu.edit.remove.drags_of.left_wrist"));
  click("menu.view.fit");
  EXPECT_EQ(asked("view.fit"), app::Arguments{});
  EXPECT_EQ(count("view.camera_state"), 0) << "the click turned nothing";
  frame(2);
  EXPECT_FALSE(shown("menu.view.fit"));
}

TEST_F(ViewsTest, ARightDragTurnsAndOpensNoMenu) {
  const ImVec2 from = mark("view.0").rect.at(0.1f, 0.8f);
  drag(from, {from.x + 40, from.y}, {}, render::MouseButton::Right);
  frame(3);
  EXPECT_GT(count("view.camera_state"), 0);
  EXPECT_FALSE(shown("menu.view.fit"));
}

TEST_F(ViewsTest, ARightClickAtAJointOffersToTakeItsEditsBack) {
  stage.session.document.skeleton_edits = {DragEdit{10, LeftWrist, Vec3(0, 0.1f, 0), 5, false}};
  click(seen(0, source_joint(LeftWrist)), render::MouseButton::Right);
  frame(3);
  click("menu.edit.remove.drags_of.left_wrist");
  EXPECT_EQ(asked("edit.remove"), (app::Arguments{"drags_of", "left_wrist"}));
  click(seen(0, source_joint(RightAnkle)), render::MouseButton::Right);
  frame(3);
  EXPECT_TRUE(shown("menu.select.joint.right_ankle"));
  EXPECT_FALSE(shown("menu.edit.remove.drags_of.right_ankle")) << "it has none";
}

TEST_F(ViewsTest, WithoutATakeEditsOfTheSkeletonAreTakenBackByAClick) {
  stage.session.document.takes.clear(), stage.session.takes.clear();
  stage.session.document.skeleton_edits = {DragEdit{10, LeftWrist, Vec3(0, 0.1f, 0), 5, false}};
  frame(2);
  click(seen(0, source_joint(LeftWrist)), render::MouseButton::Right);
  frame(3);
  click("menu.edit.remove.drags_of.left_wrist");
  EXPECT_EQ(asked("edit.remove"), (app::Arguments{"drags_of", "left_wrist"}));
}

TEST_F(ViewsTest, InAnOverlayTheMenuIsAboutThePersonOfTheTool) {
  stage.session.view.layout = app::Layout::Overlay, stage.session.view.overlay.spread_m = 0.8f;
  stage.session.tool = app::Tool::Bones;
  stage.session.document.takes[0].pose_edits.rotate = {{10, LeftShoulder, Vec3(0, 0, 0.3f), 5}};
  frame(3);
  const Vec3 wrist = take_joint(LeftWrist) + Vec3(0.4f, 0, 0);  // the take is right of the middle
  click(seen(0, wrist), render::MouseButton::Right);
  frame(3);
  EXPECT_TRUE(shown("menu.view.weights_joint.left_wrist"));
  click("menu.edit.remove.rotations_of.0.left_wrist");  // which takes the whole arm back
  EXPECT_EQ(asked("edit.remove"), (app::Arguments{"rotations_of", "0", "left_wrist"}));
  stage.session.tool = app::Tool::Joints;
  frame(2);
  click(seen(0, source_joint(LeftWrist) - Vec3(0.4f, 0, 0)), render::MouseButton::Right);
  frame(3);
  EXPECT_TRUE(shown("menu.select.joint.left_wrist"));
  EXPECT_FALSE(shown("menu.view.weights_joint.left_wrist"));
  EXPECT_FALSE(shown("menu.edit.remove.rotations_of.0.left_wrist"));
}

TEST_F(ViewsTest, WhetherAViewHasPerspectiveIsSaidOfItsOwnCamera) {
  stage.session.view.linked = false;
  stage.session.view.cameras.resize(2);
  stage.session.view.cameras[1].orthographic = true;
  for (const int number : {0, 1}) {
    const auto items = view_menu_items(stage.session, {pane_of(number)});
    const auto from =
        std::find_if(items.begin(), items.end(), [](const MenuItem& item) { return !item.inside.empty(); });
    ASSERT_NE(from, items.end());
    EXPECT_EQ(from->inside.back().command, "view.ortho");
    EXPECT_EQ(from->inside.back().checked, number == 1);
    EXPECT_EQ(from->inside.back().arguments, app::Arguments{number == 1 ? "off" : "on"});
  }
}

TEST_F(ViewsTest, EveryEntryOfTheMenuIsACommand) {
  const app::Studio studio{app::StudioServices{}};
  const std::function<void(const std::vector<MenuItem>&)> look = [&](const std::vector<MenuItem>& items) {
    for (const MenuItem& item : items) {
      look(item.inside);
      if (!item.command.empty() && item.command != "dialog.open")
        EXPECT_NE(studio.commands().find(item.command), nullptr) << item.command;
    }
  };
  for (const int number : {0, 1}) look(view_menu_items(stage.session, {pane_of(number), LeftWrist, {"0"}}));
}

TEST_F(ViewsTest, AClickAtAFaceOfTheCubeLooksFromThere) {
  click("view.1.cube.top");
  EXPECT_EQ(asked("view.preset"), app::Arguments{"top"});
  EXPECT_EQ(asked("view.pane"), app::Arguments{"1"});
  EXPECT_EQ(count("view.camera_state"), 0);
  stage.session.view.cameras[0].yaw = 0, stage.session.view.cameras[0].pitch = 0;
  frame(2);
  EXPECT_TRUE(shown("view.0.cube.front"));
  EXPECT_FALSE(shown("view.0.cube.back")) << "it is behind";
}

TEST_F(ViewsTest, DraggingTheCubeTurnsTheView) {
  const app::CameraState before = stage.session.view.cameras[0];
  const ImVec2 from = mark("view.0.cube.front").rect.at(0.5f, 0.5f);
  drag(from, {from.x - 200, from.y});
  EXPECT_GT(stage.session.view.cameras[0].yaw, before.yaw + 0.2f);
  EXPECT_EQ(count("view.preset"), 0);
}

TEST_F(ViewsTest, TheCubeCanBeHiddenAndLeavesTheCornerToTheView) {
  stage.session.view.cube = false;
  frame(2);
  EXPECT_FALSE(shown("view.0.cube"));
  const float yaw = stage.session.view.cameras[0].yaw;
  const ImVec2 from = mark("view.0").rect.at(0.9f, 0.1f);
  drag(from, {from.x - 60, from.y});
  EXPECT_GT(stage.session.view.cameras[0].yaw, yaw + 0.2f);
}

TEST_F(ViewsTest, ShiftDraggingMovesTheTargetWithThePointer) {
  const Vec3 target = stage.session.view.cameras[0].target;
  const ImVec2 from = mark("view.0").rect.at(0.1f, 0.8f);
  render::Modifiers shift;
  shift.shift = true;
  drag(from, {from.x, from.y - 50}, shift);
  EXPECT_LT(stage.session.view.cameras[0].target.y(), target.y() - 0.1f);
}

TEST_F(ViewsTest, TheWheelZoomsToThePointer) {
  stage.session.view.cameras[0].target = source_joint(LeftWrist) + Vec3(0.3f, 0.2f, 0);
  frame();
  // In the plane of the target the place under the pointer stays where it is.
  const Mat3 axes = render::axes(pane(0).camera);
  const Vec3 place = pane(0).camera.target + 0.4f * axes.col(0) - 0.3f * axes.col(1);
  const ImVec2 at = seen(0, place);
  render::InputEvent turn;
  turn.kind = render::InputEvent::Kind::Scroll;
  turn.dy = 2, turn.x = at.x, turn.y = at.y;
  render::InputEvent move;
  move.x = at.x, move.y = at.y;
  play({move, turn});
  EXPECT_LT(stage.session.view.cameras[0].distance, 3.5f);
  EXPECT_NEAR(seen(0, place).x, at.x, 1.5f);
  EXPECT_NEAR(seen(0, place).y, at.y, 1.5f);
}

TEST_F(ViewsTest, FollowingLeavesWhatIsSeenWhereItIs) {
  const Vec3 before = pane(0).camera.target;
  stage.session.view.follow = true;
  frame();
  EXPECT_LT((pane(0).camera.target - before).norm(), 1e-4f);
  EXPECT_GT((stage.session.view.cameras[0].target - before).norm(), 0.1f);  // relative to the person now
  stage.show_frame(20);
  EXPECT_GT((pane(0).camera.target - before).norm(), 0.1f);
}

TEST_F(ViewsTest, UnlinkedCamerasAreTheirPanesOwn) {
  stage.session.view.linked = false;
  stage.session.view.cameras.resize(2);
  const ImVec2 from = mark("view.1").rect.at(0.1f, 0.9f);
  drag(from, {from.x + 30, from.y});
  EXPECT_EQ(asked("view.camera_state")[0], "1");
  EXPECT_EQ(asked("view.pane")[0], "1");
}

TEST_F(ViewsTest, ADoubleClickOnTheBodyMakesItTheTarget) {
  const ImVec2 at = seen(1, take_joint(Spine3));
  click(at), click(at);
  const Vec3 target = stage.session.view.cameras[0].target;
  EXPECT_LT((target - take_joint(Spine3)).norm(), 0.2f);
  EXPECT_GT((target - take_joint(Spine3)).norm(), 0.03f);  // on its surface
}

TEST_F(ViewsTest, DraggingAJointAsksForTheEditOnce) {
  stage.session.tool = app::Tool::Joints, stage.session.drag_children = true, stage.session.falloff = 7;
  const Vec3 elbow = source_joint(LeftElbow);
  const ImVec2 from = seen(0, elbow);
  const float metres = metres_a_pixel(pane(0), elbow);
  drag(from, {from.x, from.y - 40});
  EXPECT_EQ(count("edit.drag"), 1);
  EXPECT_EQ(count("view.camera_state"), 0);
  EXPECT_EQ(asked("select.joint")[0], "left_elbow");
  const app::Arguments words = asked("edit.drag");
  EXPECT_EQ(words[0], "10");
  EXPECT_EQ(words[1], "left_elbow");
  EXPECT_NEAR(vector_at(words, 2).norm(), 40 * metres, 4 * metres);
  EXPECT_GT(vector_at(words, 2).y(), 0);
  EXPECT_EQ(words[5], "7");
  EXPECT_EQ(words[6], "children");
}

TEST_F(ViewsTest, APersonThatStandsAsideIsDraggedWhereItIsSeen) {
  stage.session.view.layout = app::Layout::Overlay, stage.session.view.overlay.spread_m = 0.8f;
  stage.session.tool = app::Tool::Joints;
  frame(3);
  const Vec3 elbow = source_joint(LeftElbow);
  const ImVec2 from =
      seen(0, elbow - Vec3(0.4f, 0, 0));  // the source is left of the middle, the take right of it
  drag(from, {from.x, from.y - 40});
  const app::Arguments words = asked("edit.drag");
  EXPECT_EQ(words[1], "left_elbow");
  EXPECT_NEAR(vector_at(words, 2).x(), 0, 0.05f);
  EXPECT_GT(vector_at(words, 2).y(), 0.05f);
}

TEST_F(ViewsTest, ADraggedJointOfTheSourceTakesItsLimbAlongInView) {
  stage.session.tool = app::Tool::Joints;
  const PaneContent content = pane_of(0);
  const PaneView view = pane(0);
  const PanePictures pictures = pictures_of(stage.session, *stage.cache, content, 10).value();
  const HandPlace place{stage.session, content, view, pictures};
  Hand hand;
  app::CommandQueue asked_of_hand;
  Pointer pointer;
  pointer.at = seen(0, source_joint(LeftWrist)), pointer.over = pointer.pressed = pointer.held = true;
  ASSERT_TRUE(hand.work(place, pointer, asked_of_hand));
  pointer.pressed = false, pointer.at.x += 60;
  hand.work(place, pointer, asked_of_hand);
  const Joints now = hand.preview(place).source_joints.value();
  const app::SourceDrag drag(stage.session, 10, stage.session.falloff);
  pointer.released = true, pointer.held = false;
  hand.work(place, pointer, asked_of_hand);
  const app::Arguments words = asked_of_hand.back().second;
  const Joints after =
      drag.joints({10, LeftWrist, vector_at(words, 2), std::stoi(words.at(5)), false}).value();
  EXPECT_LT((now - after).norm(), 1e-3f);  // what is released is what was seen
  EXPECT_GT((now.row(LeftWrist).transpose() - source_joint(LeftWrist)).norm(), 0.03f);
  EXPECT_GT((now.row(LeftElbow).transpose() - source_joint(LeftElbow)).norm(), 2e-3f);
}

TEST_F(ViewsTest, AClickOnAJointChangesNothing) {
  stage.session.tool = app::Tool::Joints;
  click(seen(0, source_joint(LeftElbow)));
  EXPECT_EQ(count("edit.drag"), 0);
  EXPECT_EQ(stage.session.selected_joint, LeftElbow);
}

TEST_F(ViewsTest, AnArrowMovesAlongItsAxisOnly) {
  stage.session.tool = app::Tool::Joints, stage.session.selected_joint = LeftWrist;
  frame();
  const Vec3 wrist = source_joint(LeftWrist);
  const ImVec2 from = seen(0, wrist + Vec3(0, 0.2f, 0)), to = seen(0, wrist + Vec3(0, 0.35f, 0));
  drag(from, to);
  const Vec3 moved = vector_at(asked("edit.drag"), 2);
  EXPECT_NEAR(moved.y(), 0.15f, 0.01f);
  EXPECT_EQ(moved.x(), 0);
  EXPECT_EQ(moved.z(), 0);
}

TEST_F(ViewsTest, EscapeDropsADrag) {
  stage.session.tool = app::Tool::Joints;
  const ImVec2 from = seen(0, source_joint(LeftElbow));
  render::InputEvent press;
  press.kind = render::InputEvent::Kind::MouseButton, press.pressed = true, press.x = from.x,
  press.y = from.y;
  render::InputEvent move;
  move.x = from.x + 50, move.y = from.y;
  play({press}), play({move});
  key(render::Key::Escape);
  press.pressed = false, press.x = move.x;
  play({press});
  EXPECT_EQ(count("edit.drag"), 0);
}

TEST_F(ViewsTest, ARingTurnsABoneInItsOwnFrame) {
  stage.session.tool = app::Tool::Bones, stage.session.selected_joint = RightElbow;
  stage.session.view.cameras[0].yaw = 0.f, stage.session.view.cameras[0].pitch = 0.f;
  frame();
  const Vec3 elbow = take_joint(RightElbow);
  const PaneView view = pane(1);
  const ImVec2 middle = seen(1, elbow);
  const float reach =
      0.13f * view.rect.height();  // the ring that faces the camera, in the frame of a turned arm
  drag({middle.x + reach * std::cos(0.6f), middle.y - reach * std::sin(0.6f)},
       {middle.x + reach * std::cos(1.2f), middle.y - reach * std::sin(1.2f)});
  const app::Arguments words = asked("edit.rotate");
  EXPECT_EQ(words[0], "0");
  EXPECT_EQ(words[2], "right_elbow");
  EXPECT_NEAR(vector_at(words, 3).norm(), 0.6f, 0.1f);
  EXPECT_NEAR(std::abs(vector_at(words, 3).z()), vector_at(words, 3).norm(), 1e-4f);
}

TEST_F(ViewsTest, ABoneIsSeenTurnedUntilTheEditShows) {
  stage.session.tool = app::Tool::Bones, stage.session.selected_joint = RightElbow;
  const PaneContent content = pane_of(1);
  const PaneView view = pane(1);
  const PanePictures pictures = pictures_of(stage.session, *stage.cache, content, 10).value();
  const HandPlace place{stage.session, content, view, pictures};
  Hand hand;
  app::CommandQueue asked_of_hand;
  // Somewhere on the circle of the gizmo a ring is met.
  const ImVec2 middle = seen(1, take_joint(RightElbow));
  const float reach = render::gizmo_reach(*hand.preview(place).gizmo, view.camera) /
                      metres_a_pixel(view, take_joint(RightElbow));
  Pointer pointer;
  pointer.over = true;
  for (int i = 0; i < 360 && !hand.busy(); ++i) {
    const float angle = static_cast<float>(i) * kPi / 180;
    pointer.at = {middle.x + reach * std::cos(angle), middle.y + reach * std::sin(angle)};
    pointer.pressed = pointer.held = hand.work(place, pointer, asked_of_hand);
    if (pointer.held) hand.work(place, pointer, asked_of_hand);
  }
  ASSERT_TRUE(hand.busy());
  pointer.pressed = false;
  pointer.at = {2 * middle.x - pointer.at.x + 5, pointer.at.y + 30};
  hand.work(place, pointer, asked_of_hand);
  const auto turned = hand.turned_picture(place);
  ASSERT_NE(turned, nullptr);
  const Points& before = pictures.takes[0]->vertices;
  const Eigen::VectorXf moved = (turned->vertices - before).rowwise().norm();
  for (Eigen::Index v = 0; v < moved.size(); ++v) {
    if ((*stage.weights)(v, RightElbow) == 0) EXPECT_NEAR(moved[v], 0, 1e-4f);
  }
  EXPECT_GT(moved.maxCoeff(), 0.05f);
  pointer.released = true, pointer.held = false;
  hand.work(place, pointer, asked_of_hand);
  EXPECT_EQ(asked_of_hand.back().first, "edit.rotate");
  EXPECT_NE(hand.turned_picture(place), nullptr);
  stage.session.time += 5;  // it never came
  EXPECT_EQ(hand.turned_picture(place), nullptr);
  stage.session.time -= 5;
  EXPECT_NE(hand.turned_picture(place), nullptr);
  stage.session.takes[0].shown.poses[10].local[RightElbow] = rotation_about_y(0.3f);  // shown; no joint moved
  EXPECT_EQ(hand.turned_picture(place), nullptr);
}

TEST_F(ViewsTest, AFoundBoneIsTurnedByARingWithOneCommand) {
  stage.add_found(0);
  stage.session.tool = app::Tool::Bones;
  stage.session.view.cameras[0].yaw = 0.f, stage.session.view.cameras[0].pitch = 0.f;
  frame(2);
  EXPECT_FALSE(shown("view.ring.z")) << "none is chosen";
  click(mark("view.bone.1").rect.at(0.5f, 0.5f));
  EXPECT_EQ(stage.session.bones.selected, 1);
  EXPECT_EQ(count("bones.turn") + count("select.joint"), 0);
  frame(2);
  const ImVec2 middle = seen(0, Vec3(0, 1.4f, 0));
  const float reach = 0.13f * pane(0).rect.height();  // the ring that faces the camera
  const auto at = [&](float angle) {
    return ImVec2(middle.x + reach * std::cos(angle), middle.y - reach * std::sin(angle));
  };
  drag(at(-0.6f), at(-0.1f));
  EXPECT_EQ(count("bones.turn"), 1);
  const app::Arguments words = asked("bones.turn");
  EXPECT_EQ(words[0], "1");
  EXPECT_EQ(words[1], "10");
  EXPECT_LT((vector_at(words, 2) - Vec3(0, 0, 0.5f)).norm(), 0.05f) << "the bone's own axes";
  EXPECT_EQ(words[5], std::to_string(stage.session.falloff));
  EXPECT_EQ(count("view.camera_state"), 0);
}

TEST_F(ViewsTest, AFoundHingeHasOneRingAndWhatDoesNotTurnNone) {
  stage.add_found(0);
  stage.session.tool = app::Tool::Bones, stage.session.bones.selected = 1;
  const auto rings = [&](JointKind kind) {
    auto rig = std::make_shared<DiscoveredRig>(*stage.session.bones.rig);
    rig->found.rig.joints[1].kind = kind, rig->found.rig.joints[1].axis = Vec3::UnitZ();
    stage.session.bones.rig = rig;
    frame(2);
    return std::array<bool, 3>{shown("view.ring.x"), shown("view.ring.y"), shown("view.ring.z")};
  };
  EXPECT_EQ(rings(JointKind::Ball), (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(rings(JointKind::Slider), (std::array<bool, 3>{}));
  EXPECT_EQ(rings(JointKind::Fixed), (std::array<bool, 3>{}));
  EXPECT_EQ(rings(JointKind::Hinge), (std::array<bool, 3>{true, false, false}));
  const ImVec2 from = mark("view.ring.x").rect.at(0.5f, 0.5f);
  drag(from, {from.x + 25, from.y + 40});
  const Vec3 turn = vector_at(asked("bones.turn"), 2);
  EXPECT_GT(turn.norm(), 0.1f);
  EXPECT_LT(turn.head<2>().norm(), 1e-4f) << "about its axis";
}

TEST_F(ViewsTest, WithoutAChosenFoundBoneAnOverlaysToolIsTheTakes) {
  stage.add_found(0);
  stage.session.view.layout = app::Layout::Overlay;
  stage.session.tool = app::Tool::Bones, stage.session.selected_joint = RightElbow;
  frame(2);
  click(seen(0, take_joint(LeftElbow)));
  EXPECT_EQ(stage.session.selected_joint, LeftElbow);
  EXPECT_EQ(count("bones.select"), 0);
}

TEST_F(ViewsTest, AHandIsDraggedAndItsArmFollowsInView) {
  stage.session.tool = app::Tool::Bones, stage.session.falloff = 4;
  frame();
  const Vec3 wrist = take_joint(RightWrist);
  const ImVec2 from = seen(1, wrist), to{from.x - 20, from.y - 45};
  const float metres = metres_a_pixel(pane(1), wrist);
  drag(from, to);
  EXPECT_EQ(count("edit.move_limb"), 1);
  EXPECT_EQ(count("edit.rotate") + count("view.camera_state"), 0);
  EXPECT_EQ(stage.session.selected_joint, RightWrist);
  const app::Arguments words = asked("edit.move_limb");
  EXPECT_EQ(app::Arguments(words.begin(), words.begin() + 3), (app::Arguments{"0", "10", "right_wrist"}));
  EXPECT_NEAR(vector_at(words, 3).norm(), std::hypot(20, 45) * metres, 0.1f * 45 * metres);
  EXPECT_EQ(words.at(6), "4");
}

TEST_F(ViewsTest, AClickOnAHandChoosesItAndItsRingsStillTurnIt) {
  stage.session.tool = app::Tool::Bones;
  stage.session.view.cameras[0].yaw = 0.f, stage.session.view.cameras[0].pitch = 0.f;
  frame();
  click(seen(1, take_joint(LeftWrist)));
  EXPECT_EQ(stage.session.selected_joint, LeftWrist);
  EXPECT_EQ(count("edit.move_limb"), 0);
  frame();
  const ImVec2 middle = seen(1, take_joint(LeftWrist));
  const float reach = 0.13f * pane(1).rect.height();
  drag({middle.x + reach * std::cos(0.6f), middle.y - reach * std::sin(0.6f)},
       {middle.x + reach * std::cos(1.2f), middle.y - reach * std::sin(1.2f)});
  EXPECT_EQ(asked("edit.rotate")[2], "left_wrist");
}

TEST_F(ViewsTest, TheArmIsSeenToFollowAHandThatIsDragged) {
  stage.session.tool = app::Tool::Bones;
  const PaneContent content = pane_of(1);
  const PaneView view = pane(1);
  const PanePictures pictures = pictures_of(stage.session, *stage.cache, content, 10).value();
  const HandPlace place{stage.session, content, view, pictures};
  Hand hand;
  app::CommandQueue asked_of_hand;
  const Vec3 wrist = take_joint(RightWrist);
  Pointer pointer;
  pointer.at = seen(1, wrist), pointer.over = pointer.pressed = pointer.held = true;
  ASSERT_TRUE(hand.work(place, pointer, asked_of_hand));
  ASSERT_TRUE(hand.busy());
  pointer.pressed = false, pointer.at.y -= 40;
  hand.work(place, pointer, asked_of_hand);
  const Joints now = hand.preview(place).take_joints.value();
  const Vec3 moved = now.row(RightWrist).transpose() - wrist;
  EXPECT_NEAR(moved.norm(), 40 * metres_a_pixel(view, wrist), 0.02f);
  EXPECT_GT((now.row(RightElbow).transpose() - take_joint(RightElbow)).norm(), 0.005f);
  EXPECT_LT((now.row(RightShoulder).transpose() - take_joint(RightShoulder)).norm(), 1e-5f);
  EXPECT_NEAR((now.row(RightWrist) - now.row(RightElbow)).norm(),
              (take_joint(RightWrist) - take_joint(RightElbow)).norm(), 1e-4f);  // no bone is stretched
  const auto picture = hand.turned_picture(place);
  ASSERT_NE(picture, nullptr);
  EXPECT_GT((picture->vertices - pictures.takes[0]->vertices).rowwise().norm().maxCoeff(), 0.05f);
  pointer.at.y -= 4000;  // no arm reaches there
  hand.work(place, pointer, asked_of_hand);
  EXPECT_NE(hand.tip().find("as far as it reaches"), std::string::npos) << hand.tip();
  hand.let_go();
  EXPECT_TRUE(asked_of_hand.size() == 1 && asked_of_hand[0].first == "select.joint");
}

TEST_F(ViewsTest, ATPoseJointGoesWhereItIsDragged) {
  stage.session.tool = app::Tool::TargetJoints;
  frame(3);
  const Vec3 knee = stage.target->joints.row(LeftKnee);
  const ImVec2 from = seen(1, knee);
  drag(from, {from.x, from.y - 20});
  const app::Arguments words = asked("edit.target_joint");
  EXPECT_EQ(words[1], "left_knee");
  EXPECT_NEAR(vector_at(words, 2).y(), knee.y() + 20 * metres_a_pixel(pane(1), knee), 0.01f);
  EXPECT_EQ(words[5], "mirror");
}

TEST_F(ViewsTest, ABoneOfTheRestPoseIsTurnedByARingAndSeenSo) {
  stage.session.tool = app::Tool::RestPose, stage.session.selected_joint = LeftShoulder;
  stage.session.view.cameras[0].yaw = 0.f, stage.session.view.cameras[0].pitch = 0.f;
  frame(3);
  const ImVec2 middle = seen(1, stage.target->joints.row(LeftShoulder));
  const float reach = 0.13f * pane(1).rect.height();  // the ring that faces the camera
  drag({middle.x + reach * std::cos(0.6f), middle.y - reach * std::sin(0.6f)},
       {middle.x + reach * std::cos(1.2f), middle.y - reach * std::sin(1.2f)});
  const app::Arguments words = asked("edit.rest_bone");
  EXPECT_EQ(words[0], "0");
  EXPECT_EQ(words[1], "left_shoulder");
  EXPECT_NEAR(std::abs(vector_at(words, 2).z()), 0.6f, 0.1f);
  EXPECT_EQ(words[5], "mirror");
  EXPECT_EQ(count("view.camera_state"), 0);

  auto& turns = stage.session.document.takes[0].target_edits.rest_pose;
  turns = turned(turns, {LeftShoulder, vector_at(words, 2)}, true);
  TargetLooks looks;
  looks.of(stage.target);
  looks.wait();
  const auto look = looks.of(stage.target);
  PictureKeeper keeper;
  const auto seen_now = [&] {
    return keeper.update(stage.session, *stage.cache, looks, pane_of(1)).takes.at(0);
  };
  EXPECT_EQ(seen_now(), look->rest) << "until the other is made, in the background";
  EXPECT_TRUE(keeper.waiting());
  stage.cache->wait();
  const auto posed = seen_now();
  EXPECT_FALSE(keeper.waiting());
  const Pose pose{rest_rotations(turns), stage.target->joints.row(Pelvis).transpose()};
  const Points wanted = linear_blend_skinning(stage.mesh.vertices, *stage.weights, stage.target->joints,
                                              forward_kinematics(stage.target->joints, pose));
  EXPECT_LT((posed->vertices - wanted).cwiseAbs().maxCoeff(), 1e-4f);
  EXPECT_GT((posed->vertices - look->rest->vertices).cwiseAbs().maxCoeff(), 0.1f);
  stage.session.tool = app::Tool::TargetJoints;  // is about the T-pose
  EXPECT_EQ(seen_now(), look->rest);
  stage.session.tool = app::Tool::RestPose;
  EXPECT_NE(seen_now(), look->rest);
  stage.session.tool = app::Tool::Look;
  seen_now();
  stage.session.tool = app::Tool::RestPose, turns.pop_back();
  EXPECT_EQ(seen_now(), look->rest) << "not the one that was left";
}

TEST_F(ViewsTest, AClickOnAJointOfTheRestPoseChoosesItsBone) {
  stage.session.tool = app::Tool::RestPose;
  frame(3);
  click(seen(1, stage.target->joints.row(LeftElbow)));
  EXPECT_EQ(stage.session.selected_joint, LeftElbow);
  EXPECT_EQ(count("edit.rest_bone"), 0);
}

TEST_F(ViewsTest, PaintingAsksForDabsOnTheTPose) {
  stage.session.tool = app::Tool::Paint, stage.session.selected_joint = Spine2;
  frame();
  const ImVec2 from = seen(1, take_joint(Spine2)), to = seen(1, take_joint(Neck));
  drag(from, to);
  EXPECT_GE(count("edit.paint"), 2);
  EXPECT_EQ(count("view.camera_state"), 0);
  const Vec3 dab = vector_at(asked("edit.paint"), 1);
  const Points& rest = stage.target->mesh.vertices;
  EXPECT_LT((rest.rowwise() - dab.transpose()).rowwise().norm().minCoeff(), 0.03f);  // on the surface
}

TEST_F(ViewsTest, AStrokeOverAFoundSurfaceIsOneEditOfItsChosenBone) {
  stage.add_found(0);
  stage.session.tool = app::Tool::Paint;
  stage.session.brush.mode = BrushMode::Subtract;
  frame(3);
  const auto stroke = [this] { drag(seen(0, Vec3(0.02f, 1.3f, 0)), seen(0, Vec3(0.02f, 1.1f, 0))); };
  stroke();
  EXPECT_EQ(count("bones.paint"), 0) << "no bone is chosen";
  queue.clear();
  click(seen(0, Vec3(0, 1.4f, 0)));
  EXPECT_EQ(stage.session.bones.selected, 1) << "by its joint";
  EXPECT_EQ(count("bones.paint"), 0);
  frame(3);
  stroke();
  EXPECT_EQ(count("bones.paint"), 1);
  EXPECT_EQ(count("edit.paint") + count("view.camera_state"), 0);
  const app::Arguments words = asked("bones.paint");
  EXPECT_EQ(words[0], "1");
  EXPECT_EQ(words[3], "subtract");
  ASSERT_GE(words.size(), 4u + 2 * 3) << "dabs along the way";
  ASSERT_EQ((words.size() - 4) % 3, 0u);
  for (size_t i = 4; i < words.size(); i += 3) {
    const Points& rest = stage.mesh.vertices;
    EXPECT_LT((rest.rowwise() - vector_at(words, i).transpose()).rowwise().norm().minCoeff(), 0.03f);
  }
}

TEST_F(ViewsTest, WithoutAJointNothingIsPainted) {
  stage.session.tool = app::Tool::Paint;
  const ImVec2 from = seen(1, take_joint(Spine2));
  drag(from, {from.x, from.y - 40});
  EXPECT_EQ(count("edit.paint"), 0);
}

TEST_F(ViewsTest, AClickOnAnotherJointChoosesItToBePaintedAndPaintsNothing) {
  stage.session.tool = app::Tool::Paint, stage.session.selected_joint = Spine2;
  frame(3);
  click(seen(1, take_joint(LeftElbow)));
  EXPECT_EQ(stage.session.selected_joint, LeftElbow);
  EXPECT_EQ(count("edit.paint"), 0);
  click(seen(0, source_joint(RightKnee)));
  EXPECT_EQ(stage.session.selected_joint, RightKnee) << "the source's, too";
  EXPECT_EQ(count("edit.paint"), 0);
  click(seen(1, take_joint(RightKnee)));
  EXPECT_EQ(count("edit.paint"), 1) << "on the chosen one it paints";
}

TEST_F(ViewsTest, AHandleOfTheCropBoxMovesItsSideAlone) {
  stage.session.tool = app::Tool::Crop;
  stage.session.document.scan_edits.crop = Box{Vec3(-1, 0, -0.5f), Vec3(1, 2, 1)};
  stage.session.view.cameras[0].distance = 6;
  frame();
  drag(mark("view.crop.high.y").rect.at(0.5f, 0.5f), seen(0, Vec3(0, 1.8f, 0.25f)));
  const app::Arguments words = asked("edit.crop");
  ASSERT_EQ(words.size(), 2u);
  EXPECT_EQ(words[0], "high.y");
  EXPECT_NEAR(std::stof(words[1]), 1.8f, 0.01f);
}

TEST_F(ViewsTest, HandlesOfTheCropBoxAreTenPixelsFromAnyDistance) {
  EXPECT_FALSE(shown("view.crop.high.y"));
  stage.session.tool = app::Tool::Crop;
  stage.session.document.scan_edits.crop = Box::open();
  for (const float metres : {4.f, 12.f}) {
    stage.session.view.cameras[0].distance = metres;
    frame(2);
    for (const char* side : kBoxSides)
      EXPECT_NEAR(mark(std::string("view.crop.") + side).rect.width(), 10, 0.01f) << side << metres;
  }
  // The box is around everybody; its handles are met where they are seen.
  drag(mark("view.crop.low.y").rect.at(0.5f, 0.5f), seen(0, source_joint(Pelvis)));
  EXPECT_EQ(asked("edit.crop")[0], "low.y");
}

TEST_F(ViewsTest, TheWipesLineIsDragged) {
  stage.session.view.layout = app::Layout::Wipe;
  frame(2);
  const ImVec2 from = mark("view.wipe").rect.at(0.5f, 0.3f);
  drag(from, {from.x + 100, from.y});
  EXPECT_NEAR(std::stof(asked("view.wipe")[0]), 0.6f, 0.02f);
  EXPECT_EQ(count("view.camera_state"), 0);
}

TEST_F(ViewsTest, ValuesAreToldUnderThePointer) {
  stage.session.view.take.colouring = app::Colouring::Offsets;
  frame(2), stage.cache->wait(), frame(2);
  EXPECT_TRUE(shown("view.legend"));
  const Rect rect = mark("view.1").rect;
  const ImVec2 at = seen(1, take_joint(Spine3));
  hover("view.1", (at.x - rect.min.x) / rect.width(), (at.y - rect.min.y) / rect.height());
  EXPECT_TRUE(shown("view.tip"));
}

TEST_F(ViewsTest, TheColoursOfAllJointsAreExplainedOnceBesideTheViews) {
  stage.add_take("child", 1);
  stage.session.view.take.colouring = app::Colouring::Weights;
  frame(2), stage.cache->wait(), frame(2);
  const Rect legend = mark("view.legend").rect;
  for (const char* view : {"view.0", "view.1", "view.2"}) {
    const Rect pane = mark(view).rect;
    EXPECT_TRUE(intersection(legend, pane).empty()) << view;
  }
  EXPECT_GT(legend.height(), 300);
  stage.session.view.weights_joint = LeftElbow;  // a scale again, in each view
  frame(2);
  EXPECT_FALSE(intersection(mark("view.legend").rect, mark("view.2").rect).empty());
}

TEST_F(ViewsTest, AnEmptyStudioAndATinyWindowAreFine) {
  stage.session = app::Session();
  frame(3);
  EXPECT_NE(gui.find("view.0"), nullptr);
  for (const int side : std::vector<int>{40, 12, 1}) {
    input.size.width = input.size.height = side;
    frame(2);
  }
}

}  // namespace
}  // namespace understudy::ui
