// The whole window in many sizes, themes and scales: no word cut, nothing out of its place. US_GALLERY=FOLDER
// keeps the pictures.
#include <cstdlib>

#include "render/context/context.hpp"
#include "tests/ui/support/panels_test.hpp"
#include "tests/ui/support/pictures.hpp"

namespace understudy::ui {
namespace {

class Pictures : public WorkspaceTest {
 protected:
  void keep(const std::string& name) {
    const char* folder = std::getenv("US_GALLERY");
    const ImDrawData& data = frame(4);
    if (folder == nullptr) return;
    const auto gl = render::make_offscreen_context();
    DrawPass pass;
    render::write_png(std::string(folder) + "/" + name + ".png",
                      picture(pass, data, gui.atlas(), input.size));
  }
  void tab(const char* name) { session.settings.panels = {{name, true}}; }
};

TEST_F(Pictures, OfEveryTab) {
  for (const Panel& panel : panels()) {
    const char* name = panel.name;
    tab(name);
    keep(name);
    for (const Rect& letter : cut_letters(frame(), gui.atlas()))
      if (letter.min.x > 1000 && letter.max.y < 600)
        ADD_FAILURE() << name << ": a letter is cut at " << letter.min.x << ", " << letter.min.y;
  }
}

TEST_F(Pictures, OfTheStartScreen) {
  session = app::Session();
  session.settings.recent = {"/home/ada/dance.understudy", "/home/ada/walk.understudy"};
  keep("start");
  EXPECT_TRUE(cut_letters(frame(), gui.atlas()).empty());
  session.settings.dark = false, input.theme = ThemeKind::Light;
  keep("start_light");
  input.size = {400, 300};
  keep("start_small");
}

TEST_F(Pictures, OfDialogs) {
  for (const char* name : {"export", "picture", "compare", "settings", "send", "about", "keys", "open"}) {
    workspace.open_dialog(session, name);
    keep(name);
    workspace.browser() = FileBrowser();
    workspace.open_dialog(session, "none");
    frame(2);
  }
}

TEST_F(Pictures, OfMenusAndErrors) {
  click("menu.view");
  keep("menu");
  session.errors.push_back({app::Notice::Kind::Error, "dance: no frames were found in this folder", "", 0});
  keep("error");
}

TEST_F(Pictures, OfOtherSizes) {
  input.theme = ThemeKind::Light;
  keep("light");
  input.size = {400, 300};
  keep("small");
  for (const char* name : {"settings", "export", "picture", "keys", "open"}) {
    workspace.open_dialog(session, name);
    keep(std::string("small_") + name);
    workspace.browser() = FileBrowser();
    workspace.open_dialog(session, "none");
    frame(2);
  }
  session.settings.panels = {{"side_over", true}};
  keep("small_side");
  input.size = {2560, 1600}, input.scale = 2;
  keep("large");
}

}  // namespace
}  // namespace understudy::ui
