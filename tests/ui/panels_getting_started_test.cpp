// The five cards of a first start, in the whole window.
#include <algorithm>

#include "tests/ui/support/panels_test.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;

class GettingStarted : public WorkspaceTest {
 protected:
  void show(int card, bool open) {
    if (!open) session = app::Session();
    session.settings.getting_started = card;
    frame(4);
    take_log();
  }
  /// Whether the ring is around the widget and the card beside it, in the window.
  void expect_ring_around(const std::string& name) {
    frame(4);
    const Rect widget = mark(name).visible, ring = mark("guide.ring").rect, card = mark("guide.card").rect;
    for (const ImVec2& corner : {widget.at(0.1f, 0.1f), widget.at(0.9f, 0.9f)})
      EXPECT_TRUE(ring.contains(corner)) << name;
    EXPECT_LT(ring.width(), widget.width() + 20) << name;
    EXPECT_TRUE(card.min.x >= 0 && card.min.y >= 0 && card.max.x <= 1280 && card.max.y <= 800) << name;
    const bool is_large = widget.width() * widget.height() > 300 * 300;
    EXPECT_TRUE(is_large || intersection(card, widget).empty()) << name;
  }
};

TEST_F(GettingStarted, EachCardPointsAtTheRealWidget) {
  show(1, false);
  expect_ring_around("start.sample.0");
  session = loaded_session();
  show(2, true);
  expect_ring_around("views");
  show(3, true);
  expect_ring_around("tools.joints");
  session.tool = app::Tool::Joints;
  expect_ring_around("views");
  session.settings.panels = {{"metrics", true}};  // its button is not to be seen
  show(4, true);
  expect_ring_around("menu.target");
  show(5, true);
  expect_ring_around("menu.file");
  click("menu.file");
  expect_ring_around("menu.dialog.open.export");
}

TEST_F(GettingStarted, CardsBelowTheTopBarLeaveHeadsFree) {
  session = loaded_session();
  const Rect views[] = {{{0, 42}, {472, 612}}, {{474, 42}, {946, 612}}};
  content = [&](Ui& ui) {
    for (const size_t k : {0, 1}) ui.mark("view." + std::to_string(k), views[k]);
    workspace.draw(session, context, 60);
    obey();
  };
  session.takes.resize(1), session.document.takes.resize(1);
  for (const int card : {3, 5}) {
    show(card, true);
    frame(4);
    const Rect place = mark("guide.card").rect;
    for (const Rect& view : views) {
      const float middle = view.at(0.5f, 0).x;
      const Rect head{{middle - 45, view.min.y + 50}, {middle + 45, view.min.y + 140}};
      EXPECT_TRUE(intersection(place, head).empty()) << "card " << card;
    }
  }
}

TEST_F(GettingStarted, TheCardAboutComparingPointsAtItsButton) {
  session = loaded_session();
  frame(2);
  click("inspector.source");  // closed: its button is then in sight
  show(4, true);
  expect_ring_around("method.compare");
}

TEST_F(GettingStarted, DoingWhatACardSaysGoesOn) {
  show(1, false);
  const auto done = [&] {
    frame(3);
    return take_log();
  };
  EXPECT_EQ(done(), Lines());
  const app::Settings kept = session.settings;
  session = loaded_session();
  session.settings = kept;
  EXPECT_EQ(done(), Lines{"help.getting_started 2"});
  EXPECT_EQ(done(), Lines()) << "what was there before does not count";
  session.view.cameras[0].yaw += 0.2f;
  EXPECT_EQ(done(), Lines{"help.getting_started 3"});
  session.document.skeleton_edits.push_back(DragEdit{7, LeftWrist, Vec3(0, 0.1f, 0), 5, false});
  EXPECT_EQ(done(), Lines{"help.getting_started 4"});
  session.document.takes.push_back(session.document.takes[0]);
  session.takes.push_back(session.takes[0]);
  EXPECT_EQ(done(), Lines{"help.getting_started 5"});
  session.notices.push_back({app::Notice::Kind::Info, "Saved a.understudy", "", 5, {}, 1});
  EXPECT_EQ(done(), Lines());
  session.notices.push_back(
      {app::Notice::Kind::Info, "Exported a.glb", "", 6, {"Show in folder", "file.show /a.glb"}, 2});
  const Lines last = done();
  ASSERT_EQ(last.size(), 2u);
  EXPECT_EQ(last[0], "help.getting_started off");
  EXPECT_EQ(last[1].substr(0, 7), "notice ");
  EXPECT_FALSE(shown("guide.card"));
}

TEST_F(GettingStarted, ClosingOrOpeningSomethingElseIsNotWhatACardSays) {
  session = loaded_session();
  frame(2);
  const auto open = [&](app::Document document) {
    session.document = std::move(document);
    session.takes.resize(session.document.takes.size());
    frame(3);
    return take_log();
  };
  const app::Document dance = session.document;
  app::Document walk;
  walk.source.path = "/data/walk";
  show(1, true);
  EXPECT_EQ(open({}), Lines()) << "File > New opens nothing";
  EXPECT_EQ(open(dance), Lines{"help.getting_started 2"}) << "what was there before, opened again, does";
  session.view.cameras[0].yaw += 0.4f;
  EXPECT_EQ(open(walk), Lines()) << "its camera was not turned by the person";
  session.view.cameras[0].yaw += 0.4f;
  EXPECT_EQ(open(walk), Lines{"help.getting_started 3"});
  EXPECT_EQ(open(dance), Lines()) << "its edits were made before";
}

TEST_F(GettingStarted, NextGoesThroughAllAndSkipEndsIt) {
  session = loaded_session();
  frame(2);
  show(1, true);
  for (const char* next : {"2", "3", "4", "5"}) {
    click("guide.next");
    EXPECT_EQ(take_log(), Lines{std::string("help.getting_started ") + next});
    frame(2);
  }
  click("guide.next");
  EXPECT_EQ(take_log().front(), "help.getting_started off");
  frame(2);
  EXPECT_FALSE(shown("guide.card"));
  click("menu.help");
  frame(2);
  click("menu.help.getting_started");
  EXPECT_EQ(take_log(), Lines{"help.getting_started"});
  frame(3);
  EXPECT_TRUE(shown("guide.card"));
  click("guide.skip");
  EXPECT_EQ(take_log(), Lines{"help.getting_started off"});
}

TEST_F(GettingStarted, StandsInNobodysWay) {
  show(1, false);
  click("start.sample.0");  // in the ring
  EXPECT_EQ(take_log(), Lines{"open /samples/scan /samples/adult.glb"});
  workspace.open_dialog(session, "settings");
  frame(3);
  EXPECT_FALSE(shown("guide.card")) << "a dialog is alone";
  click("settings.close");
  frame(3);
  EXPECT_TRUE(shown("guide.card"));
}

TEST_F(GettingStarted, FitsAnyWindow) {
  for (const auto& [width, height] : {std::pair{400, 300}, {200, 120}, {60, 40}, {2000, 90}})
    for (int card = 1; card <= app::kGettingStartedCards; ++card) {
      input.size = {width, height};
      show(card, card > 1);
      EXPECT_FALSE(gui.marks().empty());
      if (card == 1) session = loaded_session();
    }
}

TEST_F(GettingStarted, ComesToNobodyWhoDidNotAskForIt) {
  frame(3);
  EXPECT_FALSE(shown("guide.card"));
  EXPECT_FALSE(shown("guide.ring"));
}

}  // namespace
}  // namespace understudy::ui
