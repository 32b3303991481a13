// The map of motions with the mouse: what is pointed at performs, a click takes it or what lies between.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "retarget/base/clock.hpp"
#include "tests/support/made_map.hpp"
#include "tests/ui/support/panels_test.hpp"
#include "ui/panels/motion_map.hpp"

namespace understudy::ui {
namespace {

class MotionMapPanel : public PanelsTest {
 protected:
  MotionMapPanel() {
    input.size = {360, 900};
    session.jobs.clear();
  }
  void show_map(int motions = 20, int steps = 4) {
    session.map.map = session.map.maps[0] =
        std::make_shared<const MotionMap>(tests::made_motions(motions, steps));
    session.map.colouring =
        std::make_shared<MapColouring>(map_colouring(*session.map.map, session.map.colour));
    session.map.words = "20 files, 80 steps in 20 motions";
    panel("motion_map");
  }
  /// A step that has a figure.
  int drawn_step() {
    for (int i = 0; i < session.map.map->size(); ++i)
      if (gui.find("map.step." + std::to_string(i)) != nullptr) return i;
    ADD_FAILURE() << "no step has a figure";
    return 0;
  }
  std::string mark_of(int step) const { return "map.step." + std::to_string(step); }
};

TEST_F(MotionMapPanel, WithoutAMapAsksForAFolder) {
  panel("motion_map");
  EXPECT_FALSE(shown("map.canvas"));
  expect_click("map.index", {"dialog.open map_folder"});
}

TEST_F(MotionMapPanel, AClickOnAStepTakesIt) {
  show_map();
  const int step = drawn_step();
  queue.clear();
  click(mark_of(step));
  EXPECT_EQ(asked(), (std::vector<std::string>{"map.perform " + std::to_string(step),
                                               "map.take " + std::to_string(step)}));
}

TEST_F(MotionMapPanel, AClickBetweenStepsDecodesThatPlace) {
  show_map();
  const Mark canvas = mark("map.canvas");
  queue.clear();
  click(canvas.rect.at(0.02f, 0.02f));  // the corner, where no step is
  const auto lines = asked();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].find("map.decode "), 0u) << lines[0];
}

TEST_F(MotionMapPanel, TheStepUnderThePointerPerforms) {
  show_map();
  EXPECT_FALSE(gui.ui().moves());
  frame(2);
  const auto picture = [&] {
    uint64_t sum = 1469598103934665603ull;
    const ImDrawData& data = frame();
    for (int l = 0; l < data.CmdListsCount; ++l)
      for (const ImDrawVert& vertex : data.CmdLists[l]->VtxBuffer)
        for (const float value : {vertex.pos.x, vertex.pos.y})
          sum = (sum ^ static_cast<uint64_t>(static_cast<int64_t>(16 * value))) * 1099511628211ull;
    return sum;
  };
  const uint64_t still = picture();
  EXPECT_EQ(picture(), still) << "nothing moves while nothing is pointed at";
  hover(mark_of(drawn_step()));
  EXPECT_TRUE(gui.ui().moves());
  const uint64_t first = picture();
  EXPECT_NE(first, still);
  frame(12);
  EXPECT_NE(picture(), first) << "it performs";
  hover("map.index");
  EXPECT_FALSE(gui.ui().moves()) << "and rests when it is left";
}

TEST_F(MotionMapPanel, TheTargetsPerformWhatIsPointedAtAndStopWhenItIsLeft) {
  show_map();
  const int step = drawn_step();
  queue.clear();
  hover(mark_of(step));
  frame(3);
  EXPECT_EQ(asked(), (std::vector<std::string>{"map.perform " + std::to_string(step)})) << "once";
  queue.clear();
  hover("map.index");
  EXPECT_EQ(asked(), (std::vector<std::string>{"map.perform"}));
}

TEST_F(MotionMapPanel, ShowsOtherMovementsWhereTheyAreChosen) {
  show_map();
  expect_choice("map.show", 1, {"map.show others"});
  session.map.maps[1] = std::make_shared<const MotionMap>();
  session.map.shown = MapOf::Others, session.map.map = session.map.maps[1];
  frame(2);
  EXPECT_FALSE(shown("map.canvas")) << "there are none";
  expect_choice("map.show", 0, {"map.show steps"});
}

TEST_F(MotionMapPanel, IsSeenToPerformWithinATenthOfASecondOfTenThousandClips) {
  show_map(10000, 3);
  const Mark canvas = mark("map.canvas");
  double worst_ms = 0, sum_ms = 0;
  constexpr int kTries = 40;
  for (int i = 0; i < kTries; ++i) {
    const float share = 0.15f + 0.7f * static_cast<float>(i) / kTries;
    render::InputEvent move;
    move.kind = render::InputEvent::Kind::MouseMove;
    const ImVec2 at = canvas.rect.at(share, 0.5f);
    move.x = at.x, move.y = at.y;
    const auto began = std::chrono::steady_clock::now();
    play({move});
    const double ms = ms_since(began);
    worst_ms = std::max(worst_ms, ms), sum_ms += ms;
  }
  if (std::getenv("UNDERSTUDY_PRINT_TIMES") != nullptr)
    std::printf("hover to drawn, 30,000 steps: mean %.1f ms, worst %.1f ms\n", sum_ms / kTries, worst_ms);
  EXPECT_LT(sum_ms / kTries, 100);
}

TEST_F(MotionMapPanel, DraggingMovesTheMapAndTakesNothing) {
  show_map();
  const int step = drawn_step();
  const ImVec2 before = mark(mark_of(step)).rect.min;
  const ImVec2 middle = mark("map.canvas").rect.at(0.5f, 0.5f);
  queue.clear();
  drag(middle, {middle.x + 12, middle.y + 7});
  frame(2);
  EXPECT_TRUE(asked().empty());
  if (gui.find(mark_of(step)) != nullptr) {
    EXPECT_NEAR(mark(mark_of(step)).rect.min.x, before.x + 12, 1.5f);
    EXPECT_NEAR(mark(mark_of(step)).rect.min.y, before.y + 7, 1.5f);
  }
}

TEST_F(MotionMapPanel, TheWheelShowsMoreFiguresOfAPart) {
  show_map(40, 10);
  const auto figures = [&] {
    int count = 0;
    for (const Mark& one : gui.marks()) count += one.name.rfind("map.step.", 0) == 0;
    return count;
  };
  const int before = figures();
  EXPECT_GT(before, 2);
  scroll(mark_of(drawn_step()), 4);
  frame(2);
  EXPECT_NE(figures(), before);
  for (int i = 0; i < 30; ++i) scroll("map.canvas", -4);
  frame(2);
  EXPECT_EQ(figures(), before) << "no smaller than all of it";
}

TEST_F(MotionMapPanel, ColoursAreChosen) {
  show_map();
  expect_choice("map.color", 1, {"map.color speed"});
  session.map.colour = MapColour::Speed;
  session.map.colouring = std::make_shared<MapColouring>(map_colouring(*session.map.map, MapColour::Speed));
  frame(2);
  expect_choice("map.color", 3, {"map.color file"});
}

TEST_F(MotionMapPanel, AsksForWhatIsLikeTheMarkedFramesAndTakesIt) {
  show_map();
  expect_click("map.like_this", {"map.like 5 30"});
  session.map.like = {{12, 0.4f}, {33, 1.5f}};
  session.map.like_what = "frames 5 to 30";
  frame(2);
  expect_click("map.like.1", {"map.take 33"});
  session.playback.in = session.playback.out = -1;
  frame(2);
  EXPECT_FALSE(mark("map.like_this").enabled) << "no frames are marked";
}

TEST_F(MotionMapPanel, OfOneStepOrNoneIsDrawn) {
  show_map(1, 1);
  EXPECT_TRUE(shown("map.canvas"));
  session.map.map = session.map.maps[0] = std::make_shared<const MotionMap>();
  session.map.words = "3 files, 0 steps in 0 motions";
  frame(3);
  EXPECT_FALSE(shown("map.canvas"));
}

}  // namespace
}  // namespace understudy::ui
