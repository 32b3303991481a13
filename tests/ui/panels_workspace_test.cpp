// The whole window: how it lies at any size, its menus, keys and dialogs.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

#include "app/study/presets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/formats/npz.hpp"
#include "tests/ui/support/panels_test.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/help.hpp"
#include "ui/panels/menus.hpp"

namespace understudy::ui {
namespace {

using Lines = std::vector<std::string>;
using render::Key;

const std::vector<std::pair<render::PixelSize, float>> kSizes = {
    {{1280, 800}, 1}, {{400, 300}, 1}, {{400, 300}, 3}, {{1280, 800}, 3}, {{3840, 2160}, 3},
    {{760, 430}, 1},  {{200, 120}, 1}, {{60, 40}, 2},   {{1, 1}, 1},      {{2000, 90}, 1}};

std::vector<Panel> panels_at(Panel::Dock place) {
  std::vector<Panel> found;
  for (const Panel& panel : panels())
    if (panel.dock == place) found.push_back(panel);
  return found;
}
const std::vector<Panel> kTabs = panels_at(Panel::Dock::Side);

TEST_F(WorkspaceTest, DrawsAtAnySizeWithAndWithoutAnythingOpen) {
  for (const bool loaded : {true, false}) {
    if (!loaded) session = app::Session();
    for (const auto& [size, scale] : kSizes)
      for (const Panel& tab : kTabs) {
        input.size = size, input.scale = scale;
        session.settings.panels = {{tab.name, true}, {"side_over", true}};
        for (const Panel& below : panels_at(Panel::Dock::Below)) session.settings.panels[below.name] = true;
        frame(3);
        EXPECT_FALSE(gui.marks().empty()) << size.width << " x " << size.height;
      }
  }
  EXPECT_GT(views_drawn, 0);
}

TEST_F(WorkspaceTest, EveryDialogDrawsAtAnySize) {
  session.study.study = app::study_preset("rekik").make("/samples");
  for (const auto& [size, scale] : kSizes)
    for (const char* name : {"open",          "open_source", "source_times", "open_target", "replace_target",
                             "open_document", "save_as",     "export",       "csv",         "picture",
                             "video",         "compare",     "settings",     "send",        "about",
                             "keys",          "here",        "study_web",    "study_run",   "teach_style"}) {
      input.size = size, input.scale = scale;
      workspace.open_dialog(session, name);
      frame(3);
      EXPECT_FALSE(workspace.dialog().empty()) << name;
      workspace.browser() = FileBrowser();
      workspace.open_dialog(session, "none");
      frame(2);
    }
  EXPECT_THROW(workspace.open_dialog(session, "nothing"), Error);
}

TEST_F(WorkspaceTest, EveryDialogCanBeClosedInASmallWindow) {
  input.size = {400, 300};
  const std::pair<const char*, const char*> closers[] = {
      {"settings", "settings.close"}, {"send", "send.close"},
      {"export", "export.cancel"},    {"picture", "export.cancel"},
      {"compare", "compare.cancel"},  {"about", "about.close"},
      {"keys", "keys.close"},         {"teach_style", "teach_style.cancel"},
      {"here", "help.close"},         {"open", "browser.cancel"}};
  for (const auto& [name, closer] : closers) {
    workspace.open_dialog(session, name);
    frame(3);
    gui.ui().reveal(closer);  // what is below is scrolled to
    frame(3);
    click(closer);
    frame(2);
    EXPECT_EQ(workspace.dialog(), "") << name;
  }
}

TEST_F(WorkspaceTest, PartsNeitherOverlapNorLeaveTheWindow) {
  Parts parts;
  parts.below = true;
  for (int width = 1; width < 2000; width += 37)
    for (int height = 1; height < 1300; height += 41)
      for (const float scale : {1.f, 2.f, 3.f}) {
        const Arrangement a = arrange({static_cast<float>(width), static_cast<float>(height)}, scale, parts);
        std::vector<Rect> rects = {a.top, a.views, a.below, a.timeline, a.status, a.side_edge};
        if (!a.narrow) rects.push_back(a.side);
        for (size_t i = 0; i < rects.size(); ++i) {
          if (rects[i].empty()) continue;
          ASSERT_TRUE(rects[i].min.x >= 0 && rects[i].min.y >= 0 &&
                      rects[i].max.x <= static_cast<float>(width) &&
                      rects[i].max.y <= static_cast<float>(height))
              << width << " x " << height << " part " << i;
          for (size_t k = 0; k < i; ++k)
            if (!rects[k].empty())
              ASSERT_TRUE(intersection(rects[i], rects[k]).empty()) << width << " x " << height;
        }
      }
}

TEST_F(WorkspaceTest, ASmallWindowKeepsTheViewsAndThePlayButton) {
  input.size = {400, 300};
  frame(3);
  EXPECT_GT(mark("views").rect.height(), 100);
  EXPECT_FALSE(mark("timeline.play").visible.empty());
  EXPECT_FALSE(shown("side.tab"));
  click("top.side");
  EXPECT_EQ(take_log(), Lines{"panel.show side_over on"});
  frame(2);
  click("side.tab.1");
  EXPECT_EQ(take_log(), Lines{"panel.show layers on"});
  frame(2);
  EXPECT_TRUE(shown("layers.source.surface"));
}

/// The widget of each tab that no other has, in the order of the tabs.
const Lines kOfTabs = {
    "inspector.source", "layers.source.surface", "edit.scan", "metrics.curves", "study.new", "map.index",
    "bones.find"};

TEST_F(WorkspaceTest, EveryClickAtATabShowsThatTabAlone) {
  session.settings.panels = {{"inspector", true}, {"layers", true}, {"metrics", true}};  // kept from long ago
  for (int turn = 0; turn < 2; ++turn)
    for (const size_t clicked : {1u, 0u, 4u, 2u, 3u, 2u, 1u, 3u, 4u, 0u}) {
      click("side.tab." + std::to_string(clicked));
      frame(5);  // and it stays so
      for (size_t i = 0; i < kTabs.size(); ++i) {
        EXPECT_EQ(panel_shown(session, kTabs[i].name), i == clicked) << kTabs[i].name << " of " << clicked;
        EXPECT_EQ(gui.find(kOfTabs[i]) != nullptr, i == clicked) << kOfTabs[i] << " on tab " << clicked;
      }
      EXPECT_EQ(take_log(), Lines{std::string("panel.show ") + kTabs[clicked].name + " on"});
    }
}

TEST_F(WorkspaceTest, KeysAndMenuChooseTabsAsClicksDo) {
  for (const auto& [key_of_tab, tab] : {std::pair(Key::Digit3, 2), {Key::Digit1, 0}, {Key::Digit3, 2}}) {
    key(key_of_tab, {false, false, true});
    frame(2);
    EXPECT_STREQ(shown_tab(session).title, kTabs[static_cast<size_t>(tab)].title);
  }
  click("menu.window");
  frame(2);
  click("menu.panel.show.metrics.on");
  frame(2);
  EXPECT_NE(gui.find(kOfTabs[3]), nullptr);
  EXPECT_EQ(gui.find(kOfTabs[2]), nullptr);
}

TEST_F(WorkspaceTest, APanelThatIsAskedForComesOnTheStartScreenToo) {
  session = app::Session();
  for (const auto& [size, scale] : {std::pair(render::PixelSize{1280, 800}, 1.f), {{1024, 640}, 1.5f}}) {
    input.size = size, input.scale = scale;
    frame(3);
    EXPECT_FALSE(shown("side.tab"));
    key(Key::Digit5, {false, false, true});
    frame(3);
    EXPECT_TRUE(shown("study.new.rekik")) << size.width;
    click("top.side");
    frame(3);
    EXPECT_FALSE(shown("study.new.rekik"));
    EXPECT_TRUE(shown("start.open_source"));
    click("top.side");
    frame(3);
    EXPECT_TRUE(shown("study.new.rekik"));
    click("top.side");
  }
}

/// As study.open does before the first frame, or in the frame in which the scale changes.
TEST_F(WorkspaceTest, ATabIsShownThoughTheWindowBecomesNarrowMeanwhile) {
  session = app::Session();
  session.study.study = app::study_preset("rekik").make("/samples");
  workspace.show_panel(session.settings, "study", true);
  input.size = {1024, 640}, input.scale = 1.5f;
  frame(3);
  EXPECT_TRUE(shown("study.problem") || shown("study.size"));
  click("top.side");
  frame(5);
  EXPECT_FALSE(shown("side.tab")) << "and hidden it stays so";
}

/// A study that can be run, saved in a folder with answers and clips.
class StudyForms : public WorkspaceTest {
 protected:
  StudyForms() {
    std::filesystem::create_directories(folder + "/mine answers");
    std::filesystem::create_directories(folder + "/films/clips");
    std::ofstream(folder + "/mine answers/P01.csv") << "participant\n";
    session.study.study = app::study_preset("rekik").make("/samples");
    app::follow_design(session.study);
    session.study.path = folder + "/mine.study";
    session.study.folders[session.study.path].clips = folder + "/films";
  }
  ~StudyForms() override { std::filesystem::remove_all(folder); }
  void choose(const std::string& entry) {
    click("menu.study");
    frame(2);
    click("menu." + entry);
    frame(3);
    take_log();
  }
  const std::string folder = testing::TempDir() + "understudy_study_forms";
};

TEST_F(StudyForms, OfARunOffersTheNextParticipantAndTheFoldersUsedLast) {
  choose("study.run");
  click("study_form.apply");
  EXPECT_EQ(take_log(),
            Lines{app::join_line("study.run", {"P02", folder + "/films", folder + "/mine answers"})});
  frame(2);
  EXPECT_EQ(workspace.dialog(), "");
}

TEST_F(StudyForms, OfARunTakesAnotherNameAndAFolderThatIsChosen) {
  choose("study.run");
  write_into("study_form.participant", "Ada");
  click("study_form.clips.browse");
  frame(3);
  click("browser.accept");  // the folder that is shown
  frame(3);
  click("study_form.apply");
  EXPECT_EQ(take_log().back(),
            app::join_line("study.run", {"Ada", folder + "/films", folder + "/mine answers"}));
}

TEST_F(StudyForms, OfAWebPageAsksForTheClipsThatAreNotKnown) {
  session.study.folders.clear();
  choose("study.web");
  EXPECT_FALSE(mark("study_form.apply").enabled);
  write_into("study_form.clips", folder + "/films");
  click("study_form.apply");
  EXPECT_EQ(take_log(), Lines{app::join_line("study.web", {folder + "/mine web", folder + "/films"})});
}

TEST_F(StudyForms, SayWhyAStudyThatIsNotSavedCannotBeShown) {
  session.study.changed = true;
  choose("study.run");
  EXPECT_TRUE(shown("study_form.problem"));
  EXPECT_FALSE(mark("study_form.apply").enabled);
  session.study.changed = false;
  frame(2);
  EXPECT_FALSE(shown("study_form.problem"));
  EXPECT_TRUE(mark("study_form.apply").enabled);
}

TEST_F(WorkspaceTest, TabsAndPanelsFollowTheirCommands) {
  session.settings.panels["side"] = false;
  frame(2);
  EXPECT_FALSE(shown("side.tab"));
  queue.emplace_back("panel.show", app::Arguments{"edit", "on"});  // as a script does
  frame(3);
  EXPECT_TRUE(shown("edit.scan"));
  session.settings.panels["timeline"] = false;
  frame(2);
  EXPECT_FALSE(shown("timeline.play"));
}

TEST_F(WorkspaceTest, EveryPanelHasAMenuEntryAKeyAndAPlace) {
  const std::vector<Menu> all = menus(session);
  const auto window = std::find_if(all.begin(), all.end(), [](const Menu& m) { return m.name == "window"; });
  std::set<std::string> names, keys;
  for (const Panel& panel : panels()) {
    names.insert(panel.name), keys.insert(panel.keys);
    const auto is_entry = [&](const MenuItem& item) {
      return item.label == panel.title && item.arguments.front() == panel.name;
    };
    EXPECT_TRUE(std::any_of(window->items.begin(), window->items.end(), is_entry)) << panel.name;
    EXPECT_EQ(keys_of(studio.commands(), "panel.show", {panel.name, "on"}), panel.keys);
  }
  EXPECT_EQ(names.size(), panels().size());
  EXPECT_EQ(keys.size(), panels().size());
  EXPECT_THROW(panel_of("nothing"), Error);
}

TEST_F(WorkspaceTest, KeysShowAndHidePanels) {
  frame(2);
  key(Key::L, {false, false, true});
  EXPECT_EQ(take_log(), Lines{"panel.show log on"});
  key(Key::L, {false, false, true});
  EXPECT_EQ(take_log(), Lines{"panel.show log off"});
  key(Key::Digit2, {false, false, true});
  frame(2);
  EXPECT_TRUE(shown("layers.source.surface"));
}

TEST_F(WorkspaceTest, TheSidePanelsWidthIsDragged) {
  frame(2);
  const Mark edge = mark("side.edge");
  const float before = mark("side.tab").rect.width();
  const ImVec2 at = edge.rect.at(0.5f, 0.5f);
  drag(at, {at.x - 100, at.y});
  frame(2);
  EXPECT_NEAR(mark("side.tab").rect.width(), before + 100, 2);
}

TEST_F(WorkspaceTest, ToolsLayoutsAndUndo) {
  for (size_t i = 0; i < kToolIcons.size(); ++i) {
    const std::string tool = app::kToolNames[i];
    click("tools." + tool);
    EXPECT_EQ(take_log(), Lines{"tool " + tool});
  }
  click("top.layout.2");
  EXPECT_EQ(take_log(), Lines{"view.layout overlay"});
  EXPECT_FALSE(mark("top.undo").enabled);
  session.history.add(session.document, "Drag a joint");
  frame(2);
  click("top.undo");
  EXPECT_EQ(take_log(), Lines{"edit.undo"});
  click("top.side");
  EXPECT_EQ(take_log(), Lines{"panel.show side off"});
}

TEST_F(WorkspaceTest, EscapeClosesMenus) {
  click("menu.view");
  frame(2);
  EXPECT_TRUE(shown("menu.view.fit"));
  key(Key::Escape);
  frame(2);
  EXPECT_FALSE(shown("menu.view.fit"));
}

TEST_F(WorkspaceTest, MenusOpenAndAsk) {
  click("menu.file");
  frame(2);
  click("menu.source.open");
  EXPECT_EQ(take_log(), Lines{"dialog.open open_source"});
  frame(2);
  EXPECT_EQ(workspace.dialog(), "files");
  click("browser.cancel");
  click("menu.view");
  frame(2);
  click("menu.view.preset.front");
  EXPECT_EQ(take_log(), Lines{"view.preset front"});
  input.size = {700, 600};  // one menu that holds the others
  frame(2);
  click("menu");
  frame(2);
  hover("menu.help");
  frame(2);
  click("menu.dialog.open.about");
  EXPECT_EQ(take_log(), Lines{"dialog.open about"});
}

TEST_F(WorkspaceTest, OneDialogOpensAllThatMovesAndABodyAsksForItsMotion) {
  const auto folder = std::filesystem::temp_directory_path() / "understudy_panels_source";
  std::filesystem::create_directories(folder);
  const auto file = [&](const char* name, const char* array) {
    write_npz((folder / name).string(), {{array, {{1, 3}, {0, 0, 0}, ""}}});
    return (folder / name).string();
  };
  const std::string body = file("body.npz", "v_template"), motion = file("walk.npz", "poses");
  const auto choose = [&](const std::string& path) {
    frame(3);
    click("browser.path");
    frame(3);
    key(Key::A, {false, true});
    type(path);
    key(Key::Enter);
    frame(3);
  };
  session = app::Session();
  frame(3);
  click("start.open_source");
  choose(body);
  EXPECT_EQ(take_log(), Lines{"dialog.open open_source"}) << "a body alone does not move";
  EXPECT_EQ(workspace.dialog(), "files");
  choose(motion);
  EXPECT_EQ(take_log(), Lines{"source.motion " + body + " " + motion});
  EXPECT_EQ(workspace.dialog(), "");
  workspace.open_dialog(session, "open_source");
  choose(motion);  // a motion that needs no body
  EXPECT_EQ(take_log(), Lines{"source.open " + motion});
  std::filesystem::remove_all(folder);
}

TEST_F(WorkspaceTest, ATableOfTimesIsChosenWithTheKeysAmongTablesAlone) {
  const auto folder = std::filesystem::temp_directory_path() / "understudy_panels_times";
  std::filesystem::create_directories(folder);
  for (const char* name : {"0.ply", "times.csv"}) std::ofstream(folder / name) << "1,0\n";
  session.settings.last_folder = folder.string();
  session.settings.panels["inspector"] = true;
  frame(3);
  click("inspector.times");
  gui.ui().reveal("source.times.browse");
  frame(3);
  click("source.times.browse");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "files");
  for (int i = 0; i < 1000 && !shown("browser.entry.times.csv"); ++i) frame(1);  // the folder is read beside
  ASSERT_TRUE(shown("browser.entry.times.csv"));
  EXPECT_FALSE(shown("browser.entry.0.ply"));
  key(Key::End);
  key(Key::Enter);
  frame(3);
  EXPECT_EQ(take_log(),
            (Lines{"dialog.open source_times", "source.times " + (folder / "times.csv").string()}));
  EXPECT_EQ(workspace.dialog(), "");
  std::filesystem::remove_all(folder);
}

void collect(const std::vector<MenuItem>& items, std::vector<MenuItem>& all) {
  for (const MenuItem& item : items) {
    if (!item.command.empty()) all.push_back(item);
    collect(item.inside, all);
  }
}

TEST_F(WorkspaceTest, EveryMenuEntryIsACommandThatExists) {
  const std::set<std::string> of_the_window = {"dialog.open", "panel.show", "help.keys", "help.here"};
  std::set<std::string> marks;
  for (const Menu& menu : menus(session)) {
    std::vector<MenuItem> items;
    collect(menu.items, items);
    for (const MenuItem& item : items) {
      EXPECT_TRUE(of_the_window.count(item.command) > 0 || studio.commands().find(item.command) != nullptr)
          << item.command;
      if (item.command == "dialog.open") EXPECT_NO_THROW(workspace.open_dialog(session, item.arguments[0]));
      workspace.browser() = FileBrowser();
      EXPECT_TRUE(menu.name == "help" || marks.insert(mark_of(item)).second)
          << mark_of(item) << " is there twice";
    }
  }
}

TEST_F(WorkspaceTest, WhatIsNotPossibleIsGrey) {
  const app::Session empty;
  std::vector<MenuItem> items;
  for (const Menu& menu : menus(empty)) collect(menu.items, items);
  for (const MenuItem& item : items) {
    const bool of_work = item.command.rfind("edit.", 0) == 0 || item.command.rfind("view.", 0) == 0 ||
                         item.command == "document.save";
    if (of_work) EXPECT_FALSE(possible(empty, item)) << item.command;
    if (item.command == "document.new" || item.command == "app.quit") EXPECT_TRUE(possible(empty, item));
  }
}

TEST_F(WorkspaceTest, NothingIsClearedWhereNothingWasEdited) {
  app::Take& take = session.document.takes[0];
  session.selected_take = 0;
  session.document.skeleton_edits.clear();
  take.pose_edits = {}, take.target_edits = {};
  const std::vector<std::string> all = {"edit.skeleton_clear", "edit.poses_clear", "edit.target_joints_clear",
                                        "edit.weights_clear"};
  for (const auto& command : all) EXPECT_FALSE(possible(session, command)) << command;
  session.document.skeleton_edits.push_back(DragEdit{7, LeftWrist, Vec3(0, 0.1f, 0), 5, false});
  take.pose_edits.skip = {3};
  take.target_edits.joints.push_back({});
  take.target_edits.weights = std::make_shared<const WeightRows>();
  for (const auto& command : all) EXPECT_TRUE(possible(session, command)) << command;
}

TEST_F(WorkspaceTest, KeysAskUnlessSomethingIsWritten) {
  frame(2);
  key(Key::Comma, {false, true});
  EXPECT_EQ(take_log(), Lines{"dialog.open settings"});
  key(Key::Escape);
  key(Key::Slash, {true});
  EXPECT_EQ(take_log(), Lines{"help.keys"});
  frame(2);
  click("keys.close");
  key(Key::Space);
  key(Key::Digit1);
  key(Key::Left, {true});
  key(Key::S, {false, true});
  EXPECT_EQ(take_log(),
            (Lines{"playback.toggle", "view.preset_front", "playback.step -10", "dialog.open save_as"}));
  frame(2);
  key(Key::Space);  // a dialog is open
  EXPECT_EQ(take_log(), Lines());
  click("browser.cancel");
  frame(2);
  click("timeline.frame");
  key(Key::Digit1), type("1");
  EXPECT_EQ(take_log(), Lines());
  key(Key::Escape);
  session.path = "/tmp/dance.understudy";
  key(Key::S, {false, true});
  EXPECT_EQ(take_log(), Lines{"document.save"});
}

TEST_F(WorkspaceTest, KeysAreListedSearchedAndChosen) {
  const auto run = [&](const std::string& words) {
    key(Key::H);
    frame(3);
    EXPECT_EQ(workspace.dialog(), "keys");
    type(words);  // the field is ready
    key(Key::Enter);
    frame(3);
    Lines lines = take_log();
    lines.erase(lines.begin());
    return lines;
  };
  EXPECT_EQ(run("turntable"), Lines{"view.turntable"});
  EXPECT_EQ(workspace.dialog(), "");
  EXPECT_EQ(run("overlay"), Lines{"view.layout overlay"}) << "an entry of an inner menu";
  EXPECT_EQ(run("panel: edit"), Lines{"panel.show edit on"});
  EXPECT_EQ(run("fix wrist"), Lines{"tool.joints"}) << "words that are in no label";
  EXPECT_EQ(run("export"), Lines{"dialog.open export"}) << "what asks for more opens its dialog";
  EXPECT_EQ(workspace.dialog(), "export");
  workspace.open_dialog(session, "none");
  frame(2);
  session.history.clear();
  EXPECT_EQ(run("redo"), Lines()) << "not possible now";
  EXPECT_EQ(workspace.dialog(), "keys");
  key(Key::Escape);
  frame(2);
  EXPECT_EQ(workspace.dialog(), "");
}

TEST_F(WorkspaceTest, EveryCommandOfThePaletteRunsAsItIs) {
  int tools = 0;
  for (const MenuItem& entry : palette(session, studio.commands())) {
    expect_known(entry.command);
    EXPECT_FALSE(entry.label.empty()) << entry.command;
    tools += entry.label == app::kToolLabels.back() ? 1 : 0;
  }
  EXPECT_EQ(tools, 1) << "in a menu and a command, but one thing";
}

TEST_F(WorkspaceTest, ScriptsAreOnTheSecondPageAndCopied) {
  key(Key::F3);
  frame(3);
  click("keys.page.1");
  frame(2);
  type("playback.seek");
  key(Key::Enter);
  frame(2);
  EXPECT_EQ(std::string(ImGui::GetClipboardText()).rfind("playback.seek ", 0), 0u)
      << ImGui::GetClipboardText();
  EXPECT_EQ(take_log(), Lines{"help.keys"}) << "nothing runs";
  click("keys.page.2");
  frame(2);
  EXPECT_FALSE(shown("scripts.search"));
  click("keys.close");
}

TEST_F(WorkspaceTest, F1ExplainsWhatThePointerIsOn) {
  session.settings.panels = {{"edit", true}};
  frame(3);
  const auto explained = [&](const std::string& name) {
    hover(name);
    const Explanation seen =
        gui.ui().explanation_at(mark(name).visible.at(0.5f, 0.5f)).value_or(Explanation());
    key(Key::F1);
    frame(3);
    EXPECT_EQ(workspace.dialog(), "here") << name;
    EXPECT_TRUE(shown("help.here"));
    key(Key::F1);  // again closes it
    frame(3);
    EXPECT_EQ(workspace.dialog(), "") << name;
    return seen.title + ": " + seen.text;
  };
  EXPECT_EQ(explained("edit.crop").rfind("Crop: ", 0), 0u) << "the switch of a row has the row's name";
  EXPECT_EQ(explained("edit.crop_tool").rfind("Edit: ", 0), 0u) << explained("edit.crop_tool");
  EXPECT_EQ(explained("tools.bones"), std::string(": ") + app::kToolLabels[2]);
  EXPECT_EQ(explained("edit.scan"), std::string("Edit: ") + panel_of("edit").help)
      << "a heading is the panel's";
  session.tool = app::Tool::Crop;
  frame(2);
  EXPECT_NE(explained("views").find("Drag a handle of the box"), std::string::npos);
  take_log();
  hover("timeline.play");
  key(Key::F1);
  frame(3);
  click("help.commands");
  frame(2);
  EXPECT_EQ(take_log(), (Lines{"help.here", "help.keys"}));
  EXPECT_EQ(workspace.dialog(), "keys");
}

TEST_F(WorkspaceTest, TheStatusBarTellsWhatClicksDoInTheCurrentTool) {
  input.size = {3000, 800};  // nothing is cut
  session.log.clear();
  std::set<float> widths;
  for (const app::Tool tool : {app::Tool::Look, app::Tool::Paint, app::Tool::Crop}) {
    session.tool = tool;
    frame(2);
    EXPECT_TRUE(shown("status.mouse"));
    widths.insert(mark("status.mouse").rect.width());
  }
  EXPECT_EQ(widths.size(), 3u);
  session.log = {{true, "frame 20 has no points"}};
  frame(2);
  EXPECT_FALSE(shown("status.mouse")) << "a message comes first";
  EXPECT_TRUE(shown("status.message"));
}

TEST_F(WorkspaceTest, ErrorsComeOneAfterTheOther) {
  for (const char* text : {"dance: no such folder", "walk: no such folder"})
    session.errors.push_back({app::Notice::Kind::Error, text, "understudy 0.1.0", 0});
  frame(3);
  click("error.copy");
  EXPECT_STREQ(ImGui::GetClipboardText(), "dance: no such folder\nunderstudy 0.1.0");
  click("error.close");
  frame(2);
  click("error.close");
  frame(3);
  EXPECT_EQ(take_log(), (Lines{"error.dismiss", "error.dismiss"}));
  click("timeline.play");
  EXPECT_EQ(take_log(), Lines{"playback.toggle"}) << "nothing is left in the way";
}

TEST_F(WorkspaceTest, ADialogThatVanishesLeavesTheWindowUsable) {
  session.errors.push_back({app::Notice::Kind::Error, "gone soon", "", 0});
  frame(3);
  session.errors.clear();
  frame(3);
  click("timeline.play");
  EXPECT_EQ(take_log(), Lines{"playback.toggle"});
}

TEST_F(WorkspaceTest, UnsavedChangesAreAskedAbout) {
  const auto asked_with = [&](const std::string& path, const char* answer) {
    session.path = path;
    session.question = app::Question{app::Question::Kind::UnsavedChanges, "Save?", "app.quit", {}, {}};
    frame(3);
    click(answer);
    frame(2);
    return take_log();
  };
  EXPECT_EQ(asked_with("/tmp/a.understudy", "unsaved.yes"), Lines{"question.answer save"});
  EXPECT_EQ(asked_with("/tmp/a.understudy", "unsaved.no"), Lines{"question.answer discard"});
  EXPECT_EQ(asked_with("/tmp/a.understudy", "unsaved.cancel"), Lines{"question.answer cancel"});
  EXPECT_EQ(asked_with("", "unsaved.yes"), Lines());  // a file is asked for first
  EXPECT_EQ(workspace.dialog(), "files");
}

TEST_F(WorkspaceTest, PaintOfAnotherSurfaceIsBroughtOverOrDropped) {
  const auto asked_with = [&](const char* answer) {
    session.question =
        app::Question{app::Question::Kind::PaintMisfit, "adult: painted elsewhere.", "", {}, {}, 0};
    frame(3);
    click(answer);
    frame(2);
    return take_log();
  };
  EXPECT_EQ(asked_with("paint.yes"), (Lines{"question.answer cancel", "edit.weights_clear 0"}));
  auto placed = std::make_shared<WeightRows>(*session.document.takes[0].target_edits.weights);
  placed->places = Points::Zero(2, 3);
  session.document.takes[0].target_edits.weights = placed;
  EXPECT_EQ(asked_with("paint.yes"), (Lines{"question.answer cancel", "edit.weights_reproject 0"}));
  EXPECT_EQ(asked_with("paint.no"), (Lines{"question.answer cancel", "edit.weights_clear 0"}));
  EXPECT_EQ(asked_with("paint.cancel"), Lines{"question.answer cancel"});
}

TEST_F(WorkspaceTest, SavingFirstAnswersTheQuestion) {
  const auto folder = std::filesystem::temp_directory_path() / "understudy_panels_save";
  std::filesystem::create_directories(folder);
  session.settings.last_folder = folder.string();
  session.question = app::Question{app::Question::Kind::UnsavedChanges, "Save?", "app.quit", {}, {}};
  frame(3);
  click("unsaved.yes");
  frame(3);
  click("browser.accept");
  EXPECT_EQ(take_log(),
            (Lines{"document.save_as " + (folder / "dance.understudy").string(), "question.answer save"}));
  std::filesystem::remove_all(folder);
}

TEST_F(WorkspaceTest, RecoveryAndMissingFiles) {
  session.question = app::Question{app::Question::Kind::Recover,
                                   "Unsaved work was kept.",
                                   "",
                                   {},
                                   {{"/s/1.auto", "/d/dance.understudy", "2024-05-01 14:03"}}};
  frame(3);
  click("recover.0");
  EXPECT_EQ(take_log(), Lines{"document.recover /s/1.auto"});
  click("discard.0");
  EXPECT_EQ(take_log(), Lines{"document.discard_recovery /s/1.auto"});
  click("recover.later");
  EXPECT_EQ(take_log(), Lines{"question.answer cancel"});
  session.question =
      app::Question{app::Question::Kind::MissingFiles, "A file is missing.", "", {"/gone/adult.glb"}, {}};
  frame(3);
  click("missing.0");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "files");
  click("browser.cancel");
  frame(3);
  click("missing.leave");
  EXPECT_EQ(take_log(), Lines{"question.answer cancel"});
}

class Exporting : public WorkspaceTest {
 protected:
  Exporting() {
    std::filesystem::create_directories(folder);
    session.path = (folder / "dance.understudy").string();
  }
  ~Exporting() override { std::filesystem::remove_all(folder); }
  void open(const char* name) {
    workspace.open_dialog(session, name);
    frame(3);
  }
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "understudy_panels_export";
};

TEST_F(Exporting, TheFormatDecidesTheCommandAndTheSuffix) {
  open("export");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() + " format=glb"});
  EXPECT_EQ(workspace.dialog(), "");
  open("export");
  click("export.format");
  frame(2);
  click("export.format.4");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.npz").string() + " format=npz"});
  open("csv");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.csv 0 " + (folder / "adult.csv").string()});
}

TEST_F(Exporting, ProposesNoFileThatTheDocumentReads) {
  const std::string read = (folder / "adult.glb").string();
  std::ofstream(read) << "a character";
  session.document.takes[0].target.path = read;
  session.source.name = "walk.npz";
  open("export");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 \"" + (folder / "adult walk.glb").string() + "\" format=glb"});
}

TEST_F(Exporting, SaysWhatTheAnimationIsToBe) {
  open("export");
  click("export.influences.1");
  click("export.morphs.2");
  write_into("export.reduce", "0.5");
  key(Key::Enter);
  click("export.in_place");
  click("export.t_pose");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() +
                              " format=glb in_place=on influences=8 morphs=8 reduce=0.5 t_pose=on"});
  open("export");  // a format without bones has no such options
  click("export.format");
  frame(2);
  click("export.format.5");
  frame(2);
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult").string() + " format=ply in_place=on"});
}

TEST_F(Exporting, TakesOfOneTargetBecomeClips) {
  const auto choose_takes = [&](const char* which) {
    click("export.takes");
    frame(2);
    click(which);
    frame(2);
  };
  open("export");
  click("export.takes");
  frame(2);
  EXPECT_FALSE(shown("export.takes.2"));  // the other take is of another target
  click("export.takes.0");
  frame(2);
  click("export.cancel");
  const app::Take adult = session.document.takes[0];
  for (const char* name : {"slow", "fast", "fast"}) {
    session.document.takes.push_back(adult);
    session.document.takes.back().name = name;
    session.takes.push_back(session.takes[0]);
  }
  open("export");
  choose_takes("export.takes.2");
  EXPECT_FALSE(shown("export.clip.1"));
  click("export.save");
  const std::string run = "export.run 0 " + (folder / "adult.glb").string() + " format=glb";
  EXPECT_EQ(take_log(), Lines{run + " take=slow take=3 take=4"});  // two are called alike
  open("export");
  frame(2);
  click("export.clip.0");
  click("export.clip.3");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 2 " + (folder / "adult.glb").string() + " format=glb take=4"});
  open("export");
  frame(2);
  click("export.format");
  frame(2);
  click("export.format.2");  // BVH holds one motion
  frame(2);
  click("export.takes");
  frame(2);
  EXPECT_FALSE(shown("export.takes.2"));
  click("export.takes.0");
  frame(2);
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.bvh").string() + " format=bvh"});
}

TEST_F(Exporting, AllTakesGoIntoAFolderAFileEach) {
  open("export");
  click("export.takes");
  frame(2);
  click("export.takes.1");
  frame(2);
  EXPECT_FALSE(shown("export.take")) << "there is none to choose";
  click("export.save");
  EXPECT_EQ(take_log(),
            Lines{app::join_line("export.all", {(folder / "dance takes").string(), "format=glb"})});
  std::filesystem::create_directories(folder / "mine");
  std::ofstream(folder / "mine/child.bvh") << "old";
  open("export");
  click("export.format");
  frame(2);
  click("export.format.2");
  write_into("export.path", "mine");
  click("export.save");
  frame(3);
  EXPECT_EQ(take_log(), Lines()) << "a file is there already";
  click("export.overwrite.yes");
  EXPECT_EQ(take_log(), Lines{app::join_line("export.all", {(folder / "mine").string(), "format=bvh"})});
  open("csv");
  write_into("export.path", (folder / "mine").string() + "/");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{app::join_line("export.all", {(folder / "mine").string(), "format=csv"})});
  open("export");
  click("export.takes");
  frame(2);
  click("export.takes.0");
  frame(2);
  EXPECT_TRUE(shown("export.take"));
}

TEST_F(Exporting, ThePathIsLeftOutOrCarriedNotBoth) {
  open("export");
  click("export.root_motion");
  frame(2);
  EXPECT_FALSE(mark("export.in_place").enabled);
  click("export.root_motion");
  frame(2);
  click("export.in_place");
  frame(2);
  EXPECT_FALSE(mark("export.root_motion").enabled);
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() + " format=glb in_place=on"});
}

TEST_F(Exporting, APresetSetsTheOptionsAndAChangeMakesThemCustom) {
  open("export");
  EXPECT_FALSE(shown("export.preset.words"));
  click("export.format");
  frame(2);
  click("export.format.2");
  const auto choose = [&](const char* preset) {
    frame(2);
    click("export.preset");
    frame(2);
    click(preset);
    frame(2);
  };
  choose("export.preset.2");
  EXPECT_TRUE(shown("export.preset.words"));
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() +
                              " format=glb root_motion=on influences=8 morphs=8"})
      << "no BVH: that has no vertices";
  open("export");
  choose("export.preset.0");
  click("export.preset");
  frame(2);
  EXPECT_FALSE(shown("export.preset.4")) << "Custom is no choice where a preset fits";
  click("export.preset.0");
  frame(2);
  click("export.morphs.1");
  frame(2);
  EXPECT_FALSE(shown("export.preset.words")) << "no preset has these";
  click("export.preset");
  frame(2);
  EXPECT_TRUE(shown("export.preset.4"));
  click("export.preset.4");
  frame(2);
  click("export.save");
  EXPECT_EQ(take_log(),
            Lines{"export.run 0 " + (folder / "adult.glb").string() + " format=glb morphs=4 reduce=0.5"});
}

TEST_F(Exporting, ABvhOfACharacterIsOnItsOwnBonesWhereThatIsChosen) {
  auto character = std::make_shared<PreparedCharacter>();
  character->rigged = true;
  session.takes[0].character = character;
  open("export");
  EXPECT_TRUE(shown("export.bones.0"));
  click("export.bones.1");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() + " format=glb bones=22"});
  open("export");
  click("export.format");
  frame(2);
  click("export.format.2");
  frame(2);
  click("export.bones.0");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.bvh").string() + " format=bvh bones=own"});
  open("export");
  session.selected_take = 1;  // has no bones of its own
  frame(2);
  click("export.format");
  frame(2);
  click("export.format.2");
  frame(2);
  EXPECT_FALSE(shown("export.bones.0"));
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 1 " + (folder / "child.bvh").string() + " format=bvh"});
}

TEST_F(Exporting, AFileThatIsThereIsAskedAbout) {
  std::ofstream(folder / "adult.glb") << "old";
  open("export");
  click("export.save");
  frame(3);
  EXPECT_EQ(take_log(), Lines());
  click("export.overwrite.cancel");
  frame(3);
  click("export.save");
  frame(3);
  click("export.overwrite.yes");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() + " format=glb"});
}

TEST_F(Exporting, PicturesAndVideosHaveASize) {
  open("picture");
  click("export.transparent");
  click("export.all.1");
  write_into("export.width", "800");
  key(Key::Enter);
  click("export.save");
  EXPECT_EQ(take_log(),
            Lines{"picture.save " + (folder / "dance.png").string() + " 800 1080 transparent view"});
  open("video");
  click("export.size");
  frame(2);
  click("export.size.0");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"video.save " + (folder / "dance.mp4").string() + " 1280 720 view"});
  open("video");
  click("export.as.1");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"video.save " + (folder / "dance").string() + " 1280 720 view"});
}

TEST_F(Exporting, TheNameFollowsTheTakeUntilItIsTyped) {
  open("export");
  session.selected_take = 1;  // as the list of takes does
  frame(2);
  write_into("export.path", "dance");
  click("export.in_place");  // what is typed counts without Enter
  session.selected_take = 0;
  frame(2);
  click("export.format");
  frame(2);
  click("export.format.2");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "dance.bvh").string() + " format=bvh in_place=on"})
      << "beside the document, with its suffix";
  open("export");
  session.selected_take = 1;
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 1 " + (folder / "child.glb").string() + " format=glb in_place=on"});
  open("export");
  write_into("export.path", "dance");
  click("export.in_place");
  write_into("export.path", " ");
  key(Key::Backspace), key(Key::Enter);  // emptied: proposed again
  EXPECT_EQ(take_log(), Lines{"export.run 1 " + (folder / "child.glb").string() + " format=glb"});
}

TEST_F(Exporting, ALongPathIsSeenWithTheNameOfItsFile) {
  session.path = "/" + std::string(60, 'a') + "/" + std::string(60, 'b') + "/dance.understudy";
  open("export");
  const Rect field = mark("export.path").rect, words = mark("export.path.shown").rect;
  EXPECT_LT(words.width(), field.width());
  EXPECT_GT(words.width(), 0.8f * field.width()) << "cut in its middle to what fits";
  click("export.path");
  frame(2);
  EXPECT_FALSE(shown("export.path.shown")) << "typed in, it is the field's own";
}

TEST_F(Exporting, EnterSaves) {
  open("export");
  key(Key::Enter);
  frame(2);
  EXPECT_EQ(workspace.dialog(), "");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() + " format=glb"});
  open("export");
  write_into("export.reduce", "0.5");
  key(Key::Enter);  // ends the number alone
  EXPECT_EQ(workspace.dialog(), "export");
  write_into("export.path", (folder / "sub").string() + "/mine.v2");
  key(Key::Enter);
  frame(2);
  EXPECT_EQ(workspace.dialog(), "");
  EXPECT_EQ(take_log(),
            Lines{"export.run 0 " + (folder / "sub/mine.v2.glb").string() + " format=glb reduce=0.5"});
}

TEST_F(Exporting, AFailureBringsTheDialogBackWithAllThatWasChosen) {
  open("export");
  click("export.influences.1");
  write_into("export.path", "dance");
  click("export.save");
  const Lines asked = take_log();
  session.errors.push_back({app::Notice::Kind::Error, "dance.glb: the disk is full", asked.at(0), 0});
  frame(3);
  click("error.close");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "export");
  take_log();
  click("export.save");
  EXPECT_EQ(take_log(), asked);
  session.errors.push_back({app::Notice::Kind::Error, "no such joint", "edit.drag 1 nose", 0});
  frame(3);
  click("error.close");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "") << "another command's failure does not";
}

TEST_F(Exporting, BeginsWithTheFormatUsedLast) {
  session.settings.export_format = "bvh";
  open("export");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.bvh").string() + " format=bvh"});
  session.settings.export_format = "csv";
  open("export");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.csv 0 " + (folder / "adult.csv").string()});
}

TEST_F(Exporting, BrowsingComesBackWithThePath) {
  open("export");
  click("export.browse");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "files");
  click("browser.accept");
  frame(3);
  EXPECT_EQ(workspace.dialog(), "export");
  click("export.save");
  EXPECT_EQ(take_log(), Lines{"export.run 0 " + (folder / "adult.glb").string() + " format=glb"});
}

TEST_F(WorkspaceTest, ComparingAddsATakeWithWhatDiffers) {
  workspace.open_dialog(session, "compare");
  frame(3);
  EXPECT_FALSE(mark("compare.apply").enabled) << "nothing would differ";
  click("compare.engine.1");
  click("compare.offsets");
  click("compare.apply");
  EXPECT_EQ(take_log(), Lines{"compare.add 0 engine=paper offsets=off"});
  EXPECT_EQ(workspace.dialog(), "");
}

TEST_F(WorkspaceTest, SettingsAreAskedFor) {
  workspace.open_dialog(session, "settings");
  frame(3);
  click("settings.theme.1");
  click("settings.samples.0");
  write_into("settings.cache", "1024");
  key(Key::Enter);
  click("settings.scale");
  frame(2);
  click("settings.scale.5");
  EXPECT_EQ(take_log(), (Lines{"settings.theme light", "settings.samples 1", "settings.cache_mb 1024",
                               "settings.scale 2"}));
  drag("settings.mouse", 0.4f, 0.5f);
  const Lines moved = take_log();
  ASSERT_FALSE(moved.empty());
  EXPECT_EQ(moved.back().rfind("settings.mouse ", 0), 0u);
  write_into("settings.undo_depth", "50");
  key(Key::Enter);
  click("settings.close");
  EXPECT_EQ(take_log(), Lines{"settings.undo_depth 50"});
  EXPECT_EQ(workspace.dialog(), "");
}

TEST_F(WorkspaceTest, NoticesLieBelowTheFiguresAndStayUnderThePointer) {
  session.time = 10;
  session.notices.push_back({app::Notice::Kind::Info, "Saved dance.understudy", "", 12, {}, 1});
  frame(3);
  EXPECT_TRUE(shown("notice.0"));
  const Rect views = mark("views").rect, notice = mark("notice.0").rect;
  EXPECT_GT(notice.min.y, views.max.y - 48);
  EXPECT_LE(notice.max.y, views.max.y);
  hover("notice.0");
  session.time = 13, session.notices.clear();
  frame(3);
  EXPECT_TRUE(shown("notice.0"));
  hover("views");
  frame(3);
  EXPECT_FALSE(shown("notice.0"));
  session.notices.push_back({app::Notice::Kind::Info, "Saved dance.understudy", "", 21, {}, 2});
  frame(3);
  hover("notice.0");
  session.notices.clear();  // dismissed before its time
  frame(3);
  EXPECT_FALSE(shown("notice.0"));
}

TEST_F(WorkspaceTest, ANoticesButtonAsksForWhatItOffersAndANoticeMadeLaterStillComes) {
  session.time = 10;
  session.notices.push_back({app::Notice::Kind::Info,
                             "Removed adult with its edits",
                             "",
                             18,
                             {"Undo", "edit.undo \"Remove adult\""},
                             1});
  frame(3);
  click("notice.0.offer");
  EXPECT_EQ(take_log(), (Lines{"notice.dismiss 1", "edit.undo \"Remove adult\""}));
  frame(2);
  EXPECT_FALSE(shown("notice.0"));
  session.time = 11;
  session.notices.push_back({app::Notice::Kind::Info, "Undone: Remove adult", "", 19, {}, 2});
  frame(3);
  EXPECT_TRUE(shown("notice.0"));
  EXPECT_FALSE(shown("notice.0.offer"));
  click("notice.0");
  EXPECT_EQ(take_log(), Lines{"notice.dismiss 2"});
}

TEST_F(WorkspaceTest, ANoticeOfAFileShowsItsFolder) {
  session.notices.push_back({app::Notice::Kind::Info,
                             "Exported a b.glb",
                             "",
                             8,
                             {"Show in folder", "file.show \"/d/a b.glb\""},
                             3});
  frame(3);
  click("notice.0.offer");
  EXPECT_EQ(take_log(), (Lines{"notice.dismiss 3", "file.show \"/d/a b.glb\""}));
}

TEST_F(WorkspaceTest, ATargetThatMayBeNoPersonIsUsedOrTakenBack) {
  for (const auto& [answer, line] : {std::pair<const char*, const char*>{"person.yes", "target.use_anyway 1"},
                                     {"person.cancel", "question.answer cancel"}}) {
    session.question =
        app::Question{app::Question::Kind::NotAPerson, "horse: does not look like a person", "", {}, {}, 1};
    frame(3);
    click(answer);
    EXPECT_EQ(take_log(), Lines{line});
    session.question.reset();
    frame(2);
  }
}

TEST_F(WorkspaceTest, WordsOfFixedPlacesFit) {
  frame(3);
  const float padding = 6;
  const auto fits = [&](const std::string& name, const char* words) {
    EXPECT_GE(mark(name).rect.width(), ImGui::CalcTextSize(words).x + padding) << words;
  };
  const char* const layouts[] = {"Side by side", "Single", "Overlay", "Wipe"};
  for (int i = 0; i < 4; ++i) fits("top.layout." + std::to_string(i), layouts[i]);
  for (size_t i = 0; i < kTabs.size(); ++i) fits("side.tab." + std::to_string(i), kTabs[i].title);
}

}  // namespace
}  // namespace understudy::ui
