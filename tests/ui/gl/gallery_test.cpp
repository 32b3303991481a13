// The gallery drawn by a real OpenGL, in both themes and at several scales. US_GALLERY=FOLDER keeps the
// pictures.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <tuple>

#include "render/context/context.hpp"
#include "tests/ui/support/gallery.hpp"
#include "tests/ui/support/pictures.hpp"
#include "ui/gui/gui.hpp"
#include "ui/widgets/dialogs.hpp"
#include "ui/widgets/file_browser.hpp"

namespace understudy::ui {
namespace {

class Gallery : public testing::TestWithParam<std::tuple<ThemeKind, int>> {
 protected:
  void SetUp() override {
    const int scale = std::get<1>(GetParam());
    input.theme = std::get<0>(GetParam()), input.scale = static_cast<float>(scale);
    input.size = {1280 * scale, 800 * scale};
  }
  const ImDrawData& frame() {
    gui.begin_frame(input);
    draw_gallery(gui.ui(), state);
    return gui.end_frame();
  }
  void keep(const render::Image& image, const std::string& name) const {
    const char* folder = std::getenv("US_GALLERY");
    const char* look = input.theme == ThemeKind::Dark ? "_dark_" : "_light_";
    if (folder != nullptr)
      render::write_png(
          std::string(folder) + "/" + name + look + std::to_string(std::get<1>(GetParam())) + ".png", image);
  }
  GalleryState state;
  FrameInput input;
  Gui gui;
};

INSTANTIATE_TEST_SUITE_P(All, Gallery,
                         testing::Combine(testing::Values(ThemeKind::Dark, ThemeKind::Light),
                                          testing::Values(1, 2)));

TEST_P(Gallery, CutsNoWordAndHidesNoWidget) {
  frame(), frame();
  const ImDrawData& data = frame();
  for (const Rect& letter : cut_letters(data, gui.atlas()))
    ADD_FAILURE() << "a letter is cut at " << letter.min.x << ", " << letter.min.y << " .. " << letter.max.x
                  << ", " << letter.max.y;
  const float width = static_cast<float>(input.size.width), height = static_cast<float>(input.size.height);
  EXPECT_GT(gui.marks().size(), 60u);
  for (const Mark& mark : gui.marks()) {
    EXPECT_FALSE(mark.visible.empty()) << mark.name << " is not to be seen";
    EXPECT_TRUE(mark.rect.min.x >= 0 && mark.rect.min.y >= 0 && mark.rect.max.x <= width &&
                mark.rect.max.y <= height)
        << mark.name << " reaches out of the window";
  }
}

/// Share of the pixels inside the mark that differ from its upper left one; of a mark that reaches out of the
/// picture those that are in it.
double drawn(const render::Image& image, const Rect& mark) {
  const Rect rect =
      intersection(mark, {{0, 0}, {static_cast<float>(image.width), static_cast<float>(image.height)}});
  int different = 0, all = 0;
  if (rect.max.x - rect.min.x < 3 || rect.max.y - rect.min.y < 3) return 0;
  const uint8_t* ground = image.at(static_cast<int>(rect.min.x) + 1, static_cast<int>(rect.min.y) + 1);
  for (int y = static_cast<int>(rect.min.y) + 1; y < static_cast<int>(rect.max.y) - 1; ++y)
    for (int x = static_cast<int>(rect.min.x) + 1; x < static_cast<int>(rect.max.x) - 1; ++x, ++all) {
      const uint8_t* p = image.at(x, y);
      different +=
          std::abs(p[0] - ground[0]) + std::abs(p[1] - ground[1]) + std::abs(p[2] - ground[2]) > 60 ? 1 : 0;
    }
  return all > 0 ? static_cast<double>(different) / all : 0;
}

TEST_P(Gallery, DrawsEveryIconAndPlot) {
  const auto context =
      render::make_offscreen_context({render::ContextKind::Any, render::gl::DebugMode::Fatal});
  DrawPass pass;
  frame(), frame();
  const render::Image image = picture(pass, frame(), gui.atlas(), input.size);
  keep(image, "gallery");
  int icons = 0;
  for (const Mark& mark : gui.marks()) {
    if (mark.name.rfind("icon.", 0) != 0) continue;
    ++icons;
    EXPECT_GT(drawn(image, mark.rect), mark.enabled ? 0.02 : 0.0) << mark.name << " is empty";
  }
  EXPECT_EQ(icons, static_cast<int>(Icon::Count) - static_cast<int>(Icon::Redo));
  for (const char* name : {"gallery.mpjpe", "gallery.acc", "gallery.latency", "gallery.track"}) {
    const Mark* const mark = gui.find(name);
    ASSERT_NE(mark, nullptr) << name;
    EXPECT_GT(drawn(image, mark->rect), 0.01) << name;
  }
}

TEST_P(Gallery, CutsNoWordOfTheBrowserOrADialog) {
  const auto context =
      render::make_offscreen_context({render::ContextKind::Any, render::gl::DebugMode::Fatal});
  DrawPass pass;
  FileBrowser browser;
  browser.places = {{"Samples", US_SOURCE_DIR "/assets/samples", Icon::Person}};
  browser.preview = [](const std::string&) { return FilePreview{nullptr, 0, 0, "9,830 points each"}; };
  BrowseRequest request;
  request.title = "Open a scan", request.folder = US_SOURCE_DIR "/assets/samples";
  request.filters = {filter_of(FileKind::Source), filter_of(FileKind::Any)};
  browser.open(request);
  bool asking = false;
  const auto draw = [&]() -> const ImDrawData& {
    gui.begin_frame(input);
    draw_gallery(gui.ui(), state);
    browser.draw(gui.ui());
    if (asking)
      ask(gui.ui(), "unsaved",
          {"Unsaved changes", "Save walk_female_03 before closing it?", "Save", "Don't save"});
    draw_toasts(gui.ui(), {{"Saved walk_female_03.understudy"}});
    return gui.end_frame();
  };
  for (int i = 0; i < 40; ++i) {
    draw();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_NE(gui.find("browser.look.scan"), nullptr) << "the sample is not known as a sequence of scans";
  for (const bool question : {false, true}) {
    if (question) browser = FileBrowser(), asking = true, draw(), draw();
    const ImDrawData& data = draw();
    for (const Rect& letter : cut_letters(data, gui.atlas()))
      ADD_FAILURE() << "a letter is cut at " << letter.min.x << ", " << letter.min.y;
    keep(picture(pass, data, gui.atlas(), input.size), question ? "question" : "browser");
  }
}

TEST_P(Gallery, PresentingTheDifferencesLooksLikeDrawingAll) {
  const auto context =
      render::make_offscreen_context({render::ContextKind::Any, render::gl::DebugMode::Fatal});
  DrawPass differences;
  frame(), frame();
  const char* visited[] = {"gallery.track", "gallery.mpjpe", "gallery.open",  "gallery.list.3",
                           "edit.undo",     "icon.camera",   "gallery.view.0"};
  for (int i = 0; i < 24; i += std::get<1>(GetParam())) {
    const Mark* const mark = gui.find(visited[i / 2 % 7]);
    ASSERT_NE(mark, nullptr) << visited[i / 2 % 7];
    const Rect rect = mark->rect;
    render::InputEvent move;
    move.x = rect.at(0.3f, 0).x + static_cast<float>(i), move.y = rect.at(0, 0.5f).y;
    state.frame = 412 + 7 * i;
    if (i == 20) input.theme = input.theme == ThemeKind::Dark ? ThemeKind::Light : ThemeKind::Dark;
    if (i == 22) input.size.width -= 100;
    input.dt = 0.3f;  // tooltips appear
    gui.begin_frame(input, {move});
    draw_gallery(gui.ui(), state);
    const ImDrawData& data = gui.end_frame();
    const auto backdrop = gui.ui().theme().backdrop;
    const auto all = picture(input.size, [&](const render::RenderTarget& target) {
      DrawPass().present(data, gui.atlas(), target, backdrop);
    });
    const auto presented = picture(input.size, [&](const render::RenderTarget& target) {
      differences.present(data, gui.atlas(), target, backdrop);
    });
    ASSERT_TRUE(all.pixels == presented.pixels) << "step " << i;
  }
}

TEST(Damage, IsOnlyWhereSomethingChanged) {
  Gui gui;
  Damage damage;
  float at = 50;
  bool second = false;
  const auto changed = [&] {
    gui.begin_frame({{800, 600}});
    ImGui::SetNextWindowPos({0, 0}), ImGui::SetNextWindowSize({400, 600});
    ImGui::Begin("one", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::TextUnformatted("These words stay");
    ImGui::GetWindowDrawList()->AddRectFilled({at, 300}, {at + 10, 320}, IM_COL32_WHITE);
    ImGui::End();
    ImGui::SetNextWindowPos({500, 100}), ImGui::SetNextWindowSize({100, 100});
    if (second) ImGui::Begin("two", nullptr, ImGuiWindowFlags_NoDecoration), ImGui::End();
    return damage.update(gui.end_frame());
  };
  changed(), changed();
  EXPECT_TRUE(changed().empty());
  at = 200;
  const auto moved = changed();
  ASSERT_FALSE(moved.empty());
  for (const Rect& rect : moved) {
    EXPECT_GE(rect.min.x, 49);
    EXPECT_LE(rect.max.x, 211);
    EXPECT_GE(rect.min.y, 299);
    EXPECT_LE(rect.max.y, 321);
  }
  second = true;
  auto appeared = changed();
  if (appeared.empty()) appeared = changed();  // windows appear in their first or second frame
  ASSERT_EQ(appeared.size(), 1u);
  EXPECT_NEAR(appeared[0].min.x, 500, 1);
  EXPECT_NEAR(appeared[0].max.y, 200, 1);
  damage.forget();
  EXPECT_EQ(changed()[0].max.x, 800);
}

TEST_P(Gallery, FindsAWordThatIsCut) {
  const auto draw = [&]() -> const ImDrawData& {
    gui.begin_frame(input);
    ImGui::SetNextWindowSize({gui.ui().px(100), gui.ui().px(60)});
    ImGui::Begin("narrow", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::TextUnformatted("WWWWWWWWWWWWWWWWWW");
    ImGui::End();
    return gui.end_frame();
  };
  draw(), draw();  // windows appear in their second frame
  EXPECT_FALSE(cut_letters(draw(), gui.atlas()).empty());
}

}  // namespace
}  // namespace understudy::ui
