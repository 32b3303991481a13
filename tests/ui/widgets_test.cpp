// Each widget: what it asks for when it is used, and what it leaves alone.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/ui/support/ui_test.hpp"
#include "ui/widgets/controls.hpp"
#include "ui/widgets/dialogs.hpp"
#include "ui/widgets/lists.hpp"
#include "ui/widgets/plot.hpp"
#include "ui/widgets/timeline_track.hpp"

namespace understudy::ui {
namespace {

using render::Key;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class Widgets : public UiTest {};

TEST_F(Widgets, IconButtonClicksUnlessDisabled) {
  int clicks = 0;
  IconButtonOptions options;
  in_window([&](Ui& ui) { clicks += icon_button(ui, "play", Icon::Play, options) ? 1 : 0; });
  click("play");
  EXPECT_EQ(clicks, 1);
  options.disabled = true;
  frame();
  EXPECT_FALSE(mark("play").enabled);
  click(mark("play").rect.at(0.5f, 0.5f));
  EXPECT_EQ(clicks, 1);
}

TEST_F(Widgets, TooltipComesAfterARestAlsoOnWhatIsGreyedOut) {
  IconButtonOptions options;
  options.tooltip = "Play", options.shortcut = "Space";
  in_window([&](Ui& ui) { icon_button(ui, "play", Icon::Play, options); });
  frame(2);
  EXPECT_FALSE(shown("tooltip"));
  hover("play");
  EXPECT_TRUE(shown("tooltip"));
  options.disabled = true;
  hover("play");
  EXPECT_TRUE(shown("tooltip"));
}

TEST_F(Widgets, EveryIconHasANameOfItsOwn) {
  std::vector<std::string> names;
  for (int i = 0; i < static_cast<int>(Icon::Count); ++i) names.emplace_back(icon_name(static_cast<Icon>(i)));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_EQ(icon_name(Icon::Menu), "menu");  // the table is in the order of the names
  EXPECT_EQ(icon_name(Icon::Warning), "warning");
}

TEST_F(Widgets, ToggleAndSegmentsChangeWhatTheyShow) {
  bool on = false;
  int chosen = 0, changes = 0;
  in_window([&](Ui& ui) {
    toggle(ui, "on", "Skeleton", on);
    changes += segmented(ui, "view", {"Points", "Mesh"}, chosen) ? 1 : 0;
  });
  click("on");
  EXPECT_TRUE(on);
  click("view.1"), click("view.1");
  EXPECT_EQ(chosen, 1);
  EXPECT_EQ(changes, 1);
}

TEST_F(Widgets, DropdownOffersItsChoices) {
  int chosen = 0;
  in_window([&](Ui& ui) { dropdown(ui, "method", {"Full", "Without offsets", "Skeleton"}, chosen); });
  EXPECT_EQ(mark("method").name, "method");
  EXPECT_FALSE(shown("method.2"));
  click("method");
  click("method.2");
  EXPECT_EQ(chosen, 2);
  frame(2);
  EXPECT_FALSE(shown("method.2"));
}

TEST_F(Widgets, ALongListAtTheRightEdgeStaysInTheWindow) {
  int chosen = 0;
  in_window([&](Ui& ui) {
    ImGui::SetCursorPosX(640);
    dropdown(ui, "colour", {"Plain", "Error against ground truth of the whole sequence, mm"}, chosen);
  });
  click("colour");
  frame(2);
  EXPECT_LE(mark("colour.1").rect.max.x, 800);
  EXPECT_GT(mark("colour.1").rect.width(), 200);
}

TEST_F(Widgets, NumberIsDraggedClampedAndReset) {
  float value = 0.5f;
  NumberOptions options;
  options.min = 0, options.max = 1, options.initial = 0.5f, options.resettable = true;
  in_window([&](Ui& ui) { number(ui, "strength", value, options); });
  frame(2);
  EXPECT_FALSE(shown("strength.reset"));
  drag("strength", 0.1f, 0.9f);
  EXPECT_FLOAT_EQ(value, 1);
  click("strength.reset");
  EXPECT_FLOAT_EQ(value, 0.5f);
}

TEST_F(Widgets, SectionOpensAndCloses) {
  bool open = false;
  in_window([&](Ui& ui) { open = section(ui, "source", "Source"); });
  frame();
  EXPECT_TRUE(open);
  click("source");
  EXPECT_FALSE(open);
  click("source");
  EXPECT_TRUE(open);
}

TEST_F(Widgets, ProgressCanBeCancelled) {
  int cancels = 0;
  ProgressOptions options;
  options.left = "Reading", options.right = "3 s left";
  in_window([&](Ui& ui) { cancels += progress(ui, "job", options) ? 1 : 0; });
  click("job.cancel");
  EXPECT_EQ(cancels, 1);
  options.cancellable = false;
  frame();
  EXPECT_FALSE(shown("job.cancel"));
}

TEST_F(Widgets, SplitterMovesTheBorderWithinItsLimits) {
  float size = 200;
  in_window([&](Ui& ui) {
    ImGui::SetCursorPosX(400 - size);
    splitter(ui, "border", size, 100, 300);
  });
  const ImVec2 at = mark("border").rect.at(0.5f, 0.5f);
  drag(at, {at.x - 40, at.y});
  EXPECT_NEAR(size, 240, 1);
  drag(mark("border").rect.at(0.5f, 0.5f), {at.x - 190, at.y});
  EXPECT_FLOAT_EQ(size, 300);
}

TEST_F(Widgets, CutTextFitsAndKeepsLettersWhole) {
  in_window([](Ui&) {
    const std::string long_text =
        "\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9";
    EXPECT_EQ(cut_to("short", 500), "short");
    for (float width = 20; width < 100; width += 7) {
      const std::string cut = cut_to(long_text, width);
      EXPECT_LE(ImGui::CalcTextSize(cut.c_str()).x, width);
      EXPECT_EQ((cut.size() - 3) % 2, 0u);
    }
  });
  frame();
}

TEST_F(Widgets, NamesAreCutInTheirMiddle) {
  in_window([](Ui&) {
    const std::string name = "quaternius_female_dress (engine paper)";
    EXPECT_EQ(cut_name(name, 500), name);
    for (float width = 60; width < 200; width += 7) {
      const std::string cut = cut_name(name, width);
      EXPECT_LE(ImGui::CalcTextSize(cut.c_str()).x, width);
      EXPECT_EQ(cut.substr(0, 2), "qu") << width;
      EXPECT_EQ(cut.substr(cut.size() - 2), "r)") << "what tells two takes apart";
    }
    const std::string letters = "\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9";
    for (float width = 20; width < 80; width += 3)
      EXPECT_EQ((cut_name(letters, width).size() - 3) % 2, 0u) << "no letter is split";
  });
  frame();
}

TEST_F(Widgets, LinesAreBrokenAtSpacesAlone) {
  in_window([](Ui&) {
    const std::string text = "differs by 0.39 mm on average, 22.5 mm at most";
    for (float room = 60; room < 400; room += 7) {
      std::string lines = in_lines(text, room);
      std::istringstream in(lines);
      for (std::string line; std::getline(in, line);)
        EXPECT_TRUE(ImGui::CalcTextSize(line.c_str()).x <= room || line.find(' ') == line.npos) << line;
      std::replace(lines.begin(), lines.end(), '\n', ' ');
      EXPECT_EQ(lines, text);
    }
  });
  frame();
}

TEST_F(Widgets, SearchableListFindsAndChooses) {
  int chosen = -1;
  in_window([&](Ui& ui) {
    const int now =
        searchable_list(ui, "joints", {{"left_hip", ""}, {"right_hip", ""}, {"head", ""}}, -1, 200);
    if (now >= 0) chosen = now;
  });
  click("joints.1");
  EXPECT_EQ(chosen, 1);
  click("joints.search");
  type("HEAD");
  EXPECT_FALSE(shown("joints.0"));
  EXPECT_TRUE(shown("joints.2"));
  key(Key::Enter);
  EXPECT_EQ(chosen, 2);
}

TEST_F(Widgets, SearchableListFindsByWordsThatItDoesNotShow) {
  in_window([&](Ui& ui) {
    searchable_list(ui, "commands", {{"Drag joints", "W", true, "fix wrist"}, {"Export", ""}}, -1, 200);
  });
  click("commands.search");
  type("wrist");
  EXPECT_TRUE(shown("commands.0"));
  EXPECT_FALSE(shown("commands.1"));
}

TEST_F(Widgets, SearchableListMovesByArrows) {
  int chosen = -1;
  in_window([&](Ui& ui) {
    const int now =
        searchable_list(ui, "joints", {{"left_hip", ""}, {"right_hip", ""}, {"head", ""}}, -1, 200);
    if (now >= 0) chosen = now;
  });
  click("joints.search");
  key(Key::Down), key(Key::Down), key(Key::Up), key(Key::Enter);
  EXPECT_EQ(chosen, 1);
}

TEST_F(Widgets, TableRowsAreClicked) {
  int clicked = -1;
  in_window([&](Ui& ui) {
    Table table(ui, "metrics", {{"Metric"}, {"mm", 60, true}});
    if (!table.open()) return;
    for (int i = 0; i < 3; ++i) {
      if (table.row()) clicked = i;
      table.cell("MPJPE"), table.cell(i == 0 ? std::nan("") : 12.5);
    }
  });
  click("metrics.2");
  EXPECT_EQ(clicked, 2);
}

TEST_F(Widgets, ToastsAreLinesAtTheBottomBesideWhatIsToBeSeen) {
  std::vector<Toast> toasts = {{"Saved walk.understudy"}, {"Removed adult", NoticeKind::Good, "Undo"}};
  Rect over{{0, 100}, {700, 500}}, avoid;
  ToastUse used;
  content = [&](Ui& ui) {
    const ToastUse use = draw_toasts(ui, toasts, over, avoid);
    used.clicked = std::max(used.clicked, use.clicked), used.offered = std::max(used.offered, use.offered);
    used.hovered = use.hovered;
  };
  frame(3);
  EXPECT_GT(mark("notice.0").rect.max.x, 680) << "the newest at the bottom right";
  EXPECT_GT(mark("notice.0").rect.min.y, 455) << "one line: below the figures";
  EXPECT_LT(mark("notice.1").rect.max.y, mark("notice.0").rect.min.y);
  hover("notice.1");
  EXPECT_EQ(used.hovered, 0);
  click("notice.1");
  EXPECT_EQ(used.clicked, 0);
  click("notice.0.offer");
  EXPECT_EQ(used.offered, 1);
  for (const Rect& legend :
       {Rect{{560, 100}, {700, 500}}, Rect{{480, 430}, {690, 490}}, Rect{{20, 430}, {690, 490}}}) {
    avoid = legend;
    frame(2);
    for (const char* name : {"notice.0", "notice.1"}) {
      const Rect at = mark(name).rect;
      EXPECT_TRUE(intersection(at, legend).empty()) << name;
      EXPECT_TRUE(at.min.x >= 0 && at.min.y >= 100 && at.max.x <= 700 && at.max.y <= 500) << name;
    }
  }
  avoid = {}, toasts = {{std::string(400, 'w'), NoticeKind::Warning, "Clean up"}};
  frame(2);
  EXPECT_GE(mark("notice.0").rect.min.x, 0);
  EXPECT_LE(mark("notice.0.offer").rect.max.x, 700);
}

TEST_F(Widgets, QuestionsAreAnsweredByButtonsAndKeys) {
  Answer answer = Answer::None;
  bool asking = true;
  QuestionWords question{"Unsaved changes", "Save walk.understudy before closing?", "Save", "Don't save"};
  content = [&](Ui& ui) {
    if (!asking) return;
    answer = ask(ui, "unsaved", question);
    asking = answer == Answer::None;
  };
  const auto again = [&] { asking = true, frame(3); };
  again(), click("unsaved.no");
  EXPECT_EQ(answer, Answer::No);
  again(), key(Key::Enter);
  EXPECT_EQ(answer, Answer::Yes);
  again(), key(Key::Escape);
  EXPECT_EQ(answer, Answer::Cancel);
  question.dangerous = true;
  again(), key(Key::Enter);
  EXPECT_EQ(answer, Answer::None);
  click("unsaved.yes");
  EXPECT_EQ(answer, Answer::Yes);
}

TEST_F(Widgets, ErrorsCopyTheirDetails) {
  bool closed = false;
  content = [&](Ui& ui) {
    if (!closed) closed = show_error(ui, "error", "walk.obj: ends before vertex 3", "line 17");
  };
  click("error.copy");
  EXPECT_FALSE(closed);
  EXPECT_STREQ(ImGui::GetClipboardText(), "walk.obj: ends before vertex 3\nline 17");
  click("error.close");
  EXPECT_TRUE(closed);
}

TEST_F(Widgets, DialogsWaitForEachOther) {
  bool asking = true, closed = false;
  content = [&](Ui& ui) {
    if (asking) asking = ask(ui, "question", {"Unsaved changes", "Save first?", "Save", ""}) == Answer::None;
    if (!closed) closed = show_error(ui, "error", "walk.obj: ends before vertex 3", "");
  };
  frame(4);
  EXPECT_TRUE(shown("question.yes"));
  EXPECT_FALSE(shown("error.close"));
  click("question.yes");
  EXPECT_FALSE(asking);
  frame(4);
  click("error.close");
  EXPECT_TRUE(closed);
}

TEST_F(Widgets, PlotSeeksWhereItIsClickedAndDragged) {
  std::vector<float> values(101, 1);
  std::vector<int> seeks;
  in_window([&](Ui& ui) {
    if (const auto frame = plot(ui, "error", {{"MPJPE", values}})) seeks.push_back(*frame);
  });
  const Rect area = mark("error").rect;
  click(area.at(0.25f, 0.5f));
  ASSERT_FALSE(seeks.empty());
  EXPECT_EQ(seeks.back(), 25);
  drag(area.at(0.25f, 0.5f), area.at(0.75f, 0.5f));
  EXPECT_EQ(seeks.back(), 75);
}

TEST_F(Widgets, ALegendNamesEveryLine) {
  const std::vector<float> values(10, 1);
  const std::vector<PlotLine> lines = {{"quaternius_female_dress (engine paper)", values},
                                       {"quaternius_female_dress", values}};
  in_window([&](Ui& ui) {
    if (ImGui::BeginChild("side", {290, 0})) plot(ui, "error", lines);
    ImGui::EndChild();
  });
  const Rect first = mark("error.label.0").rect, second = mark("error.label.1").rect;
  EXPECT_LT(first.max.x, second.min.x);
  EXPECT_LT(second.max.x, 300);
  EXPECT_GT(std::min(first.width(), second.width()), 80);
}

TEST_F(Widgets, PlotsOfNothingAndOfNaNOnlyAreHarmless) {
  const std::vector<float> none, unknown(10, kNaN);
  in_window([&](Ui& ui) {
    plot(ui, "none", {{"None", none}});
    plot(ui, "unknown", {{"Unknown", unknown}});
    histogram(ui, "no_values", unknown);
    plot(ui, "no_series", {});
  });
  click("none"), click("unknown"), click("no_series");
  EXPECT_TRUE(shown("no_values"));
}

TEST_F(Widgets, APlotOfManyFramesStaysSmall) {
  const std::vector<float> few(500, 1);
  std::vector<float> many(200000);
  for (size_t i = 0; i < many.size(); ++i) many[i] = std::sin(static_cast<float>(i));
  const std::vector<float>* shown_values = &few;
  in_window([&](Ui& ui) { plot(ui, "error", {{"MPJPE", *shown_values}}); });
  const int small = frame(3).TotalVtxCount;
  shown_values = &many;
  EXPECT_LT(frame().TotalVtxCount, 10 * small);
}

TEST(Reduce, KeepsExtremesAndGaps) {
  std::vector<float> values(1000, 1);
  values[333] = 9, values[500] = -4;
  for (size_t i = 700; i < 800; ++i) values[i] = kNaN;
  const auto columns = reduce(values, 0, 999, 100);
  ASSERT_EQ(columns.size(), 100u);
  EXPECT_EQ(columns[33].high, 9);
  EXPECT_EQ(columns[50].low, -4);
  EXPECT_TRUE(columns[75].empty());
  EXPECT_EQ(columns[20].low, 1);
}

TEST(RoundTicks, AreRoundAndFew) {
  EXPECT_EQ(round_ticks(0, 100, 5), (std::vector<double>{0, 20, 40, 60, 80, 100}));
  EXPECT_EQ(round_ticks(-0.3, 0.3, 3).size(), 3u);
  EXPECT_TRUE(round_ticks(1, 1, 5).empty());
  EXPECT_EQ(tick_label(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_label(12000, 1000), "12k");
  EXPECT_EQ(tick_label(40, 20), "40");
}

TEST(ClockTime, CountsMinutes) {
  EXPECT_EQ(clock_time(3.266), "0:03.27");
  EXPECT_EQ(clock_time(125.5), "2:05.50");
}

class TimelineTrack : public UiTest {
 protected:
  void SetUp() override {
    data.total = 1001, data.processed = 600;
    in_window([this](Ui& ui) {
      const TrackAnswer now = timeline_track(ui, "track", data);
      if (now.seek) seek = *now.seek, data.current = seek;
      if (now.loop) data.loop = now.loop;
    });
    frame(2);
  }
  TrackData data;
  int seek = -1;
};

TEST_F(TimelineTrack, ScrubsToTheFrameUnderThePointer) {
  click(mark("track").rect.at(0.3f, 0.5f));
  EXPECT_EQ(seek, 300);
  drag("track", 0.3f, 0.9f);
  EXPECT_EQ(seek, 900);
  const Rect rect = mark("track").rect;
  drag(rect.at(0.5f, 0.5f), {rect.max.x + 500, rect.max.y});
  EXPECT_EQ(seek, 1000);
}

TEST_F(TimelineTrack, LoopMarksAreDraggedAndDoNotCross) {
  data.loop = LoopRange{200, 400};
  frame();
  const Rect rect = mark("track").rect, first = mark("track.loop_first").rect;
  drag(first.at(0.6f, 0.5f), {rect.at(0.1f, 0).x, first.at(0, 0.5f).y});
  EXPECT_NEAR(data.loop->first, 100, 3);
  EXPECT_EQ(data.loop->last, 400);
  EXPECT_EQ(seek, -1);
  const Rect last = mark("track.loop_last").rect;
  drag(last.at(0.4f, 0.5f), {rect.at(0.02f, 0).x, last.at(0, 0.5f).y});
  EXPECT_EQ(data.loop->last, data.loop->first);
}

TEST_F(TimelineTrack, WheelZoomsAboutThePointerAndTheMiddleButtonPans) {
  scroll("track", 5);
  click(mark("track").rect.at(0.5f, 0.5f));
  EXPECT_NEAR(seek, 500, 2);
  const Rect rect = mark("track").rect;
  click(rect.at(0, 0.5f));
  const int left = seek;
  EXPECT_GT(left, 250);
  // The middle button moves what is shown.
  std::vector<render::InputEvent> events(3);
  for (auto& event : events)
    event.kind = render::InputEvent::Kind::MouseButton, event.button = render::MouseButton::Middle;
  events[0].x = rect.at(0.5f, 0).x, events[0].y = rect.at(0, 0.5f).y, events[0].pressed = true;
  events[1] = events[2] = events[0];
  events[1].kind = render::InputEvent::Kind::MouseMove, events[1].x = events[2].x = rect.at(0.75f, 0).x;
  events[2].pressed = false;
  play(events);
  click(rect.at(0, 0.5f));
  EXPECT_LT(seek, left - 20);
  // A double click in the ruler shows everything again.
  double_click("track.ruler");
  click(rect.at(0, 0.5f));
  EXPECT_EQ(seek, 0);
}

TEST_F(TimelineTrack, FollowsThePlayheadWhenZoomed) {
  data.loop.reset();
  click(mark("track").rect.at(0.1f, 0.5f));
  for (int i = 0; i < 3; ++i) scroll("track", 5);
  data.current = 990, data.follow = true;
  frame(2);
  EXPECT_TRUE(shown("track.playhead"));
}

TEST_F(TimelineTrack, AnEmptySequenceAsksForNothing) {
  data = TrackData();
  click("track");
  EXPECT_EQ(seek, -1);
}

}  // namespace
}  // namespace understudy::ui
