// The views as they are seen: each layer against a stored picture, and proof that leaving it out is noticed.
// US_UPDATE_GOLDEN=1 writes the pictures anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/render/pictures.hpp"
#include "tests/ui/support/pictures.hpp"
#include "tests/ui/support/ui_test.hpp"
#include "tests/ui/support/viewport_stage.hpp"
#include "ui/viewport/picture.hpp"
#include "ui/viewport/views.hpp"

namespace understudy::ui {
namespace {

using render::Image;
namespace fs = std::filesystem;

constexpr double kAlike = 0.01, kUnlike = 0.004;  // shares of pixels

Image picture_of(Stage& stage, int pane, bool transparent = false) {
  const auto context =
      render::make_offscreen_context({render::ContextKind::Any, render::gl::DebugMode::Fatal});
  PictureMaker maker;
  PictureOptions options;
  options.pane = pane, options.size = {200, 240}, options.transparent = transparent;
  options.legend = false;  // letters depend on the fonts installed
  return maker.picture(stage.session, *stage.cache, options);
}

std::string golden_path(const std::string& name) {
  return std::string(US_SOURCE_DIR "/tests/golden/view_") + name + ".png";
}

/// The picture is as stored, and differs from the one without the layer.
void expect_layer(const std::string& name, Stage& stage, int pane,
                  const std::function<void(app::View&)>& leave_out) {
  const Image now = picture_of(stage, pane);
  const char* update = std::getenv("US_UPDATE_GOLDEN");
  if (update != nullptr && std::string(update) == "1") write_png(golden_path(name), now);
  const Image stored = render::read_png(golden_path(name));
  if (render::difference(now, stored) > kAlike) {
    write_png("view_" + name + "_now.png", now);
    ADD_FAILURE() << "see " << fs::absolute("view_" + name + "_now.png");
  }
  leave_out(stage.session.view);
  EXPECT_GT(render::difference(picture_of(stage, pane), stored), kUnlike) << name << " is not noticed";
}

struct LayerCase {
  const char* name;
  int pane;
  void (*on)(app::View&);
  void (*off)(app::View&);
};

app::Layers bare() {
  app::Layers layers;
  layers.surface = layers.skeleton = layers.ground = false;
  return layers;
}

const LayerCase kLayers[] = {
    {"scan", 0, [](app::View& v) { v.source.surface = true; },
     [](app::View& v) { v.source.surface = false; }},
    {"skeleton", 0, [](app::View& v) { v.source.skeleton = true; },
     [](app::View& v) { v.source.skeleton = false; }},
    {"trails", 0, [](app::View& v) { v.source.trails = true; },
     [](app::View& v) { v.source.trails = false; }},
    {"ground", 1, [](app::View& v) { v.take.surface = v.take.ground = true; },
     [](app::View& v) { v.take.ground = false; }},
    {"ghosts", 1, [](app::View& v) { v.take.ghosts = v.take.surface = true; },
     [](app::View& v) { v.take.ghosts = false; }},
    {"weights", 1,
     [](app::View& v) {
       v.take.surface = true, v.take.colouring = app::Colouring::Weights, v.weights_joint = -1;
     },
     [](app::View& v) { v.take.colouring = app::Colouring::Plain; }},
    {"one_weight", 1,
     [](app::View& v) {
       v.take.surface = true, v.take.colouring = app::Colouring::Weights, v.weights_joint = LeftHip;
     },
     [](app::View& v) { v.weights_joint = RightHip; }},
    {"offsets", 1, [](app::View& v) { v.take.surface = true, v.take.colouring = app::Colouring::Offsets; },
     [](app::View& v) { v.error_scale_mm = 10; }}};

class ViewLayer : public testing::TestWithParam<LayerCase> {};

TEST_P(ViewLayer, IsAsItWasAndNoticed) {
  Stage stage;
  stage.add_take("adult");
  stage.show_frame(12);
  stage.session.view.follow = true;
  stage.session.view.source = stage.session.view.take = bare();
  stage.session.view.trail_joints = {LeftWrist, RightWrist, LeftAnkle};
  GetParam().on(stage.session.view);
  expect_layer(GetParam().name, stage, GetParam().pane, GetParam().off);
}
INSTANTIATE_TEST_SUITE_P(All, ViewLayer, testing::ValuesIn(kLayers),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(PictureMaker, LeavesOutTheBackgroundWhereAsked) {
  Stage stage;
  stage.add_take("adult");
  stage.session.view.take.ground = false;
  const Image picture = picture_of(stage, 1, true);
  ASSERT_EQ(picture.alpha.size(), static_cast<size_t>(200 * 240));
  EXPECT_EQ(picture.alpha.front(), 0);
  EXPECT_EQ(*std::max_element(picture.alpha.begin(), picture.alpha.end()), 255);
}

TEST(PictureMaker, PutsAllPanesBesideEachOther) {
  Stage stage;
  stage.add_take("adult");
  const auto context =
      render::make_offscreen_context({render::ContextKind::Any, render::gl::DebugMode::Fatal});
  PictureMaker maker;
  PictureOptions options;
  options.size = {401, 240};
  const Image both = maker.picture(stage.session, *stage.cache, options);
  options.pane = 1, options.size = {201, 240};
  const Image right = maker.picture(stage.session, *stage.cache, options);
  Image half(201, 240);
  for (int y = 0; y < 240; ++y) std::copy_n(both.at(200, y), 3 * 201, half.at(0, y));
  EXPECT_LT(render::difference(half, right), 0.001);
}

/// The whole window as it is seen, for eyes: US_VIEW_PICTURES=FOLDER keeps them.
class ViewsPicture : public UiTest {
 protected:
  void keep(Stage& stage, const std::string& name) {
    input.size = {1000, 600};
    in_window([&](Ui& ui) {
      stage.session.settings.dark = input.theme == ThemeKind::Dark;
      PanelContext panels{ui, queue, commands};
      views->draw(stage.session, *stage.cache, panels);
    });
    frame(2);
    stage.cache->wait();
    for (int i = 0; i < 100 && (views->waiting() || i < 3); ++i) frame(), stage.cache->wait();
    const Image image = picture(pass, frame(), gui.atlas(), input.size);
    if (const char* folder = std::getenv("US_VIEW_PICTURES"))
      write_png(std::string(folder) + "/" + name + ".png", image);
    last = image;
  }
  std::unique_ptr<render::Context> context =
      render::make_offscreen_context({render::ContextKind::Any, render::gl::DebugMode::Fatal});
  DrawPass pass;
  std::unique_ptr<Views> views = std::make_unique<Views>();
  app::Commands commands;
  app::CommandQueue queue;
  Image last;
};

/// Share of pixels of the left or right half that are not of the most frequent dark background.
double bright_share(const Image& image, bool right) {
  int bright = 0, all = 0;
  for (int y = 80; y < image.height; ++y)
    for (int x = right ? image.width / 2 : 0; x < (right ? image.width : image.width / 2); ++x, ++all)
      bright += image.at(x, y)[1] > 120 ? 1 : 0;
  return static_cast<double>(bright) / all;
}

TEST_F(ViewsPicture, ShowBothPanes) {
  Stage stage;
  stage.add_take("adult");
  stage.show_frame(6);
  keep(stage, "side_by_side");
  EXPECT_GT(bright_share(last, false), 0.02);
  EXPECT_GT(bright_share(last, true), 0.02);
}

TEST_F(ViewsPicture, ShowEveryLayout) {
  Stage stage;
  stage.add_take("adult");
  stage.add_take("other", 0.05f);
  stage.show_frame(6);
  for (const auto layout :
       {app::Layout::Single, app::Layout::Overlay, app::Layout::Wipe, app::Layout::SideBySide}) {
    stage.session.view.layout = layout;
    stage.session.view.take.colouring = app::Colouring::Difference;
    keep(stage, "layout_" + std::to_string(static_cast<int>(layout)));
    EXPECT_GT(bright_share(last, false), 0.01);
  }
}

TEST_F(ViewsPicture, ShowTheOverlaySpreadAndSeeThrough) {
  Stage stage;
  stage.add_take("adult");
  stage.show_frame(6);
  stage.session.view.layout = app::Layout::Overlay;
  stage.session.view.overlay = {1, 1, 1, 0};
  keep(stage, "overlay_together");
  const Image together = last;
  stage.session.view.overlay.spread_m = 1.3f;
  keep(stage, "overlay_spread");
  const double left = bright_share(last, false), right = bright_share(last, true);
  EXPECT_GT(left, 0.01);
  EXPECT_GT(right, 0.01);
  EXPECT_GT(render::difference(last, together), 0.01);
  stage.session.view.overlay.results = 0.1f;
  keep(stage, "overlay_see_through");
  EXPECT_LT(bright_share(last, true), right);
  stage.session.view.overlay.results = 0;
  stage.session.view.overlay.skeletons = 0;
  keep(stage, "overlay_scan_alone");
  EXPECT_LT(bright_share(last, true), 0.5 * right);
}

TEST_F(ViewsPicture, ShowToolsAndWordsInLightAndDark) {
  Stage stage;
  stage.add_take("adult");
  stage.show_frame(6);
  stage.session.source.frames.write(
      6, 7, [](size_t, app::KeptSource& frame) { frame.flagged = true, frame.reason = "no points"; });
  stage.session.selected_joint = LeftElbow;
  stage.session.view.source.trails = stage.session.view.take.ghosts = true;
  stage.session.view.take.joint_names = true;
  stage.session.view.take.colouring = app::Colouring::Weights;
  for (const ThemeKind kind : {ThemeKind::Dark, ThemeKind::Light}) {
    input.theme = kind;
    const std::string suffix = kind == ThemeKind::Dark ? "_dark" : "_light";
    for (const auto& [tool, name] : {std::pair(app::Tool::Joints, "joints"),
                                     {app::Tool::Bones, "bones"},
                                     {app::Tool::TargetJoints, "rest"},
                                     {app::Tool::Crop, "crop"}}) {
      stage.session.tool = tool;
      keep(stage, name + suffix);
      EXPECT_TRUE(shown("view.warning"));
    }
  }
}

}  // namespace
}  // namespace understudy::ui
