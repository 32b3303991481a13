// The file browser on a folder of its own.
#include "ui/widgets/file_browser.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "retarget/formats/file_formats.hpp"
#include "tests/ui/support/ui_test.hpp"

namespace understudy::ui {
namespace {

namespace fs = std::filesystem;
using render::Key;

class Browser : public UiTest {
 protected:
  void SetUp() override {
    root = fs::temp_directory_path() / ("browser_" + std::to_string(getpid()) + "_" +
                                        testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(root);
    for (const char* folder : {"walk", "single", "case_a", "empty"}) fs::create_directories(root / folder);
    for (int i = 0; i < 12; ++i) write("walk/frame_" + std::to_string(i) + ".ply");
    write("single/body.obj"), write("case_a/case.json"), write(".hidden.obj");
    for (const char* name : {"take10.bvh", "take2.bvh", "body.obj", "notes.md", "old.understudy"})
      write(name);
    content = [this](Ui& ui) {
      if (const auto path = browser.draw(ui)) chosen = *path;
    };
  }
  void TearDown() override {
    fs::permissions(root / "empty", fs::perms::owner_all);
    fs::remove_all(root);
  }
  void write(const std::string& name) { std::ofstream(root / name) << "x"; }
  void open(std::vector<FileFilter> filters, bool save = false, const std::string& name = {}) {
    BrowseRequest request;
    request.filters = std::move(filters), request.save = save, request.folder = root.string(),
    request.name = name;
    browser.open(request);
    settle();
  }
  /// Draws until the folder has been read.
  void settle() {
    for (int i = 0; i < 60; ++i) {
      frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  std::string path(const std::string& name) const { return (root / name).string(); }
  fs::path root;
  FileBrowser browser;
  std::string chosen;
};

TEST_F(Browser, ShowsWhatFitsInNaturalOrder) {
  open({filter_of(FileKind::Source)});
  ASSERT_TRUE(shown("browser.entry.take2.bvh"));
  EXPECT_FALSE(shown("browser.entry.notes.md"));
  EXPECT_FALSE(shown("browser.entry..hidden.obj"));
  EXPECT_LT(mark("browser.entry.take2.bvh").rect.min.y, mark("browser.entry.take10.bvh").rect.min.y);
  EXPECT_LT(mark("browser.entry.walk").rect.min.y, mark("browser.entry.take2.bvh").rect.min.y);
}

TEST_F(Browser, ShowsEveryFormatThatCanBeOpenedInAnyCase) {
  const std::vector<std::string> targets = {"t.FBX", "t.dae", "t.xyz",  "t.pcd",
                                            "t.GLB", "t.npz", "t.coff", "t.VRM"},
                                 motions = {"m.BVH", "m.dae", "m.Npz"};
  for (const auto& name : targets) write(name);
  for (const auto& name : motions) write(name);
  open({filter_of(FileKind::Target)});
  for (const auto& name : targets) EXPECT_TRUE(shown("browser.entry." + name)) << name;
  EXPECT_FALSE(shown("browser.entry.m.BVH"));
  open({filter_of(FileKind::Source)});
  for (const auto& name : motions) EXPECT_TRUE(shown("browser.entry." + name)) << name;
}

TEST_F(Browser, AFolderOfGlbFramesIsAScanAndOneOfCharactersIsNot) {
  for (const char* folder : {"scan", "people"}) fs::create_directories(root / folder);
  for (const char* name : {"scan/f_1.glb", "scan/f_2.GLB", "people/anna.glb", "people/bert.glb"}) write(name);
  open({filter_of(FileKind::Source)});
  EXPECT_TRUE(shown("browser.look.scan"));
  EXPECT_FALSE(shown("browser.look.people"));
}

TEST_F(Browser, AFolderOfPosesIsChosenAsAWholeAndOneOfOtherJsonsIsNot) {
  for (const char* folder : {"poses", "settings"}) fs::create_directories(root / folder);
  for (const char* name : {"a_1.json", "a_2.json"}) {
    std::ofstream(root / "poses" / name) << R"({"people": []})";
    std::ofstream(root / "settings" / name) << R"({"theme": "dark"})";
  }
  open({filter_of(FileKind::Source)});
  EXPECT_TRUE(shown("browser.look.poses"));
  EXPECT_FALSE(shown("browser.look.settings"));
  click("browser.entry.poses");
  click("browser.accept");
  EXPECT_EQ(chosen, path("poses"));
}

TEST_F(Browser, AsManyFilesOfTwoFormatsAreNoScan) {
  fs::create_directories(root / "people");
  for (const char* name : {"anna.ply", "bert.ply", "anna.glb", "bert.glb"})
    write(std::string("people/") + name);
  open({filter_of(FileKind::Source)});
  EXPECT_FALSE(shown("browser.look.people")) << "a reader would ask which";
  write("people/carl.ply");
  open({filter_of(FileKind::Source)});
  EXPECT_TRUE(shown("browser.look.people"));
}

TEST_F(Browser, OpensTheFolderItselfOnlyWhereThatIsAScanOrACase) {
  open({filter_of(FileKind::Source)});
  EXPECT_FALSE(mark("browser.accept").enabled) << "nothing is selected, and these are no frames";
  click("browser.look.walk");
  settle();
  click("browser.accept");
  EXPECT_EQ(chosen, path("walk"));
  chosen.clear();
  open({filter_of(FileKind::Source)});
  double_click("browser.entry.single");
  settle();
  EXPECT_FALSE(mark("browser.accept").enabled);
}

TEST_F(Browser, OffersTheFolderOfDocumentsWhereThereIsOne) {
  const std::string before = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "/";
  ::setenv("HOME", root.c_str(), 1);
  open({filter_of(FileKind::Source)});
  EXPECT_FALSE(shown("browser.place.Documents"));
  fs::create_directories(root / "Documents");
  frame(2);
  EXPECT_TRUE(shown("browser.place.Documents"));
  ::setenv("HOME", before.c_str(), 1);
}

TEST_F(Browser, ADoubleClickChoosesAFile) {
  open({filter_of(FileKind::Target)});
  double_click("browser.entry.body.obj");
  EXPECT_EQ(chosen, path("body.obj"));
  EXPECT_FALSE(browser.is_open());
}

TEST_F(Browser, AFolderOfFramesIsChosenAsAWhole) {
  open({filter_of(FileKind::Source)});
  EXPECT_TRUE(shown("browser.look.walk"));
  EXPECT_FALSE(shown("browser.look.single"));
  click("browser.entry.walk");
  click("browser.accept");
  EXPECT_EQ(chosen, path("walk"));
}

TEST_F(Browser, AFolderOfFramesCanBeLookedInto) {
  open({filter_of(FileKind::Source)});
  click("browser.look.walk");
  settle();
  EXPECT_EQ(browser.folder(), path("walk"));
  EXPECT_TRUE(shown("browser.entry.frame_2.ply"));
  EXPECT_LT(mark("browser.entry.frame_2.ply").rect.min.y, mark("browser.entry.frame_10.ply").rect.min.y);
}

TEST_F(Browser, AnOrdinaryFolderIsEntered) {
  open({filter_of(FileKind::Source)});
  double_click("browser.entry.single");
  settle();
  EXPECT_EQ(browser.folder(), path("single"));
  EXPECT_TRUE(chosen.empty());
}

TEST_F(Browser, IsUsedWithKeysAlone) {
  open({filter_of(FileKind::Source)});
  key(Key::End);
  type("wa");
  key(Key::Right);  // looks inside
  settle();
  EXPECT_EQ(browser.folder(), path("walk"));
  key(Key::Backspace);
  settle();
  EXPECT_EQ(browser.folder(), root.string());
  key(Key::Enter);  // the folder one comes from is selected
  EXPECT_EQ(chosen, path("walk"));
}

TEST_F(Browser, ArrowsMoveAndEscapeCloses) {
  open({filter_of(FileKind::Target)});
  key(Key::End), key(Key::Enter);
  EXPECT_EQ(chosen, path("body.obj"));
  chosen.clear();
  open({filter_of(FileKind::Target)});
  key(Key::Escape);
  EXPECT_FALSE(browser.is_open());
  EXPECT_TRUE(chosen.empty());
}

TEST_F(Browser, ThePathIsEditedAndItsPartsAreClicked) {
  open({filter_of(FileKind::Target)});
  key(Key::L, {false, true});
  type(path("single"));
  key(Key::Enter);
  settle();
  EXPECT_EQ(browser.folder(), path("single"));
  const auto depth = std::distance(root.begin(), root.end()) - 1;
  click("browser.crumb." + std::to_string(depth));
  settle();
  EXPECT_EQ(browser.folder(), root.string());
  click("browser.up");
  EXPECT_EQ(browser.folder(), root.parent_path().string());
}

TEST_F(Browser, ASlashBeginsAPathThatIsTypedOn) {
  open({filter_of(FileKind::Target)});
  type(path("body.obj"));  // as quickly as a machine types
  key(Key::Enter);
  frame(3);
  EXPECT_EQ(chosen, path("body.obj"));
}

TEST_F(Browser, APathThatIsEditedIsTypedAtOnce) {
  open({filter_of(FileKind::Target)});
  std::vector<render::InputEvent> events(2);
  events[0].kind = events[1].kind = render::InputEvent::Kind::Key;
  events[0].key = events[1].key = Key::L;
  events[0].pressed = true, events[0].modifiers.control = true;
  for (const char letter : path("body.obj")) {
    events.emplace_back();
    events.back().kind = render::InputEvent::Kind::Char,
    events.back().codepoint = static_cast<char32_t>(letter);
  }
  play(events);
  key(Key::Enter);
  frame(3);
  EXPECT_EQ(chosen, path("body.obj"));
}

TEST_F(Browser, APathWithoutASlashIsOneFromHere) {
  open({filter_of(FileKind::Target)});
  key(Key::L, {false, true});
  type("single/body.obj");
  key(Key::Enter);
  frame(3);
  EXPECT_EQ(chosen, path("single/body.obj"));
}

TEST_F(Browser, TabReachesTheButtonsAndArrowsGiveEnterBackToTheList) {
  open({filter_of(FileKind::Target)});
  for (int i = 0; i < 30 && gui.ui().focus().name() != "browser.cancel"; ++i) key(Key::Tab);
  ASSERT_EQ(gui.ui().focus().name(), "browser.cancel");
  key(Key::End);
  key(Key::Enter);
  EXPECT_EQ(chosen, path("body.obj"));
}

TEST_F(Browser, AWrongPathIsASentence) {
  open({filter_of(FileKind::Target)});
  key(Key::L, {false, true});
  type("/nowhere/at/all");
  key(Key::Enter);
  settle();
  EXPECT_TRUE(shown("browser.problem"));
}

TEST_F(Browser, SavingAddsTheExtensionAndAsksBeforeItReplaces) {
  open({filter_of(FileKind::Document)}, true, "new");
  click("browser.accept");
  EXPECT_EQ(chosen, path("new.understudy"));
  chosen.clear();
  open({filter_of(FileKind::Document)}, true, "old");
  click("browser.accept");
  EXPECT_TRUE(chosen.empty());
  click("browser.overwrite.cancel");
  EXPECT_TRUE(browser.is_open());
  click("browser.accept");
  click("browser.overwrite.yes");
  EXPECT_EQ(chosen, path("old.understudy"));
}

TEST_F(Browser, SavingTakesTheNameTypedWithEnter) {
  open({filter_of(FileKind::Document)}, true);
  EXPECT_FALSE(mark("browser.accept").enabled);
  click("browser.name");
  type("mine");
  key(Key::Enter);
  EXPECT_EQ(chosen, path("mine.understudy"));
}

TEST_F(Browser, AParentThatIsTypedIsWhatIsChosen) {
  open({filter_of(FileKind::Folder)});
  key(Key::L, {false, true});
  type(path("walk"));
  key(Key::Enter);
  settle();
  key(Key::L, {false, true});
  type(root.string());
  key(Key::Enter);
  settle();
  click("browser.accept");
  EXPECT_EQ(chosen, root.string());
}

TEST_F(Browser, MakesFolders) {
  open({filter_of(FileKind::Document)}, true, "new");
  click("browser.new_folder");
  type("results");  // its name can be typed at once
  click("browser.create");
  settle();
  EXPECT_TRUE(fs::is_directory(root / "results"));
  EXPECT_EQ(browser.folder(), path("results"));
}

TEST_F(Browser, PlacesAndFiltersLeadElsewhere) {
  browser.places.push_back({"Samples", path("walk"), Icon::Person});
  open({filter_of(FileKind::Target), {"Motions", format_suffixes(kMotion)}});
  click("browser.filter"), click("browser.filter.1");
  settle();
  EXPECT_TRUE(shown("browser.entry.take2.bvh"));
  EXPECT_FALSE(shown("browser.entry.body.obj"));
  click("browser.place.Samples");
  settle();
  EXPECT_EQ(browser.folder(), path("walk"));
}

TEST_F(Browser, AsksForAPreviewOfTheSelection) {
  std::string asked;
  browser.preview = [&](const std::string& wanted) {
    asked = wanted;
    return FilePreview{nullptr, 0, 0, "1,204 vertices"};
  };
  input.size = {1000, 700};
  open({filter_of(FileKind::Target)});
  EXPECT_TRUE(asked.empty());
  click("browser.entry.body.obj");
  frame();
  EXPECT_EQ(asked, path("body.obj"));
}

TEST_F(Browser, StaysUsableInASmallWindowAndAtThreeTimesTheSize) {
  for (const float scale : {1.f, 3.f}) {
    input.size = {400, 300}, input.scale = scale;
    open({filter_of(FileKind::Target)});
    for (const char* name : {"browser.accept", "browser.cancel"}) {
      const Mark found = mark(name);
      EXPECT_FALSE(found.visible.empty()) << name << " at " << scale;
      EXPECT_LE(found.visible.max.y, 300) << name;
    }
    click("browser.cancel");
    EXPECT_FALSE(browser.is_open());
  }
}

TEST_F(Browser, ALargeFolderNeverHoldsUpAFrame) {
  const fs::path large = root / "large";
  fs::create_directory(large);
  for (int i = 0; i < 20000; ++i) std::ofstream(large / ("scan_" + std::to_string(i) + ".obj")).put('x');
  BrowseRequest request;
  request.folder = large.string(), request.filters = {filter_of(FileKind::Target)};
  browser.open(request);
  double longest = 0;
  for (int i = 0; i < 3000 && !shown("browser.entry.scan_3.obj"); ++i) {
    const auto before = std::chrono::steady_clock::now();
    frame();
    longest =
        std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(shown("browser.entry.scan_3.obj"));
  EXPECT_LT(longest, 0.25);  // seconds; generous: other tests share the machine
  for (int i = 0; i < 3000 && !shown("browser.entry.scan_19999.obj"); ++i) {
    settle();
    key(Key::End);
  }
  EXPECT_TRUE(shown("browser.entry.scan_19999.obj"));
}

std::shared_ptr<const FolderContents> listed(const std::string& folder) {
  const FolderListing listing(folder);
  for (int i = 0; i < 5000 && !listing.contents()->finished; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return listing.contents();
}

TEST_F(Browser, ListingCountsFramesAndFindsCases) {
  const auto found = listed(root.string());
  ASSERT_TRUE(found->finished);
  const auto entry = [&](const std::string& name) {
    return *std::find_if(found->entries.begin(), found->entries.end(),
                         [&](const FolderEntry& e) { return e.name == name; });
  };
  EXPECT_EQ(entry("walk").frames, 12);
  EXPECT_EQ(entry("single").frames, 0);
  EXPECT_TRUE(entry("case_a").is_case);
  EXPECT_EQ(entry("body.obj").bytes, 1u);
  EXPECT_GT(entry("body.obj").changed_s, 1000000000);
}

TEST_F(Browser, ListingSaysWhyItCannot) {
  EXPECT_NE(listed("/nowhere")->problem.find("no folder"), std::string::npos);
  EXPECT_NE(listed(path("body.obj"))->problem.find("not a folder"), std::string::npos);
  if (geteuid() == 0) return;  // root may look everywhere
  fs::permissions(root / "empty", fs::perms::none);
  EXPECT_NE(listed(path("empty"))->problem.find("may not"), std::string::npos);
}

TEST(FileSize, IsShort) {
  EXPECT_EQ(file_size(512), "512 B");
  EXPECT_EQ(file_size(3400000), "3.4 MB");
  EXPECT_EQ(file_size(999999), "1.0 MB");
  EXPECT_EQ(file_size(25000), "25 kB");
}

}  // namespace
}  // namespace understudy::ui
