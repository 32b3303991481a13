// Cameras of a trial: nothing is cut off, one scale, one floor.
#include "app/stimuli/framing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "retarget/base/rng.hpp"

namespace understudy::app {
namespace {

constexpr render::PixelSize kSize{1280, 720};

/// A person-sized cloud about a path.
std::vector<Points> cloud(float height, float width, const Vec3& path, uint64_t seed) {
  Rng rng(seed);
  std::vector<Points> frames;
  for (int t = 0; t < 20; ++t) {
    Points points(400, 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      points.row(i) << width * (rng.uniform() - 0.5f), height * rng.uniform(), 0.4f * (rng.uniform() - 0.5f);
    points.rowwise() += (static_cast<float>(t) / 19 * path).transpose();
    frames.push_back(points);
  }
  return frames;
}

struct Framed {
  Study study;
  std::vector<Points> source, target, result;
  render::PixelSize size = kSize;

  Framed() {
    source = cloud(1.8f, 0.8f, Vec3(0.5f, 0, 3), 1);
    target = {cloud(1.2f, 1.1f, Vec3::Zero(), 2)[0]};
    result = cloud(1.3f, 0.7f, Vec3(-1, 0.3f, 1.5f), 3);
  }
  SeenExtent extent(const std::vector<Points>& frames) const {
    SeenExtent extent(study.picture.yaw_deg * kPi / 180, study.picture.pitch_deg * kPi / 180);
    for (const Points& points : frames) extent.add(points);
    return extent;
  }
  std::vector<PaneView> views() const {
    return frame_panes(study, {extent(source), extent(target), extent(result)}, size);
  }
  const std::vector<Points>& of(const PaneView& view) const {
    if (view.pane == StudyPane::Source) return source;
    return view.pane == StudyPane::Target ? target : result;
  }
};

/// The least distance of any point to an edge of its pane, as a share of the pane.
float least_margin(const Framed& framed, const std::vector<PaneView>& views) {
  float least = 1;
  for (const PaneView& view : views)
    for (const Points& points : framed.of(view))
      for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const Vec3 at = render::on_screen(view.camera, view.size, points.row(i));
        EXPECT_GT(at.z(), 0);
        const float x = at.x() / static_cast<float>(view.size.width),
                    y = at.y() / static_cast<float>(view.size.height);
        least = std::min({least, x, 1 - x, y, 1 - y});
      }
  return least;
}

TEST(Framing, EveryPointOfEveryFrameIsSeenAsLargeAsItCanBe) {
  for (const float yaw : {0.f, 32.f, 120.f, -80.f})
    for (const float pitch : {0.f, 10.f, 50.f})
      for (const float fov : {12.f, 28.f, 70.f}) {
        Framed framed;
        framed.study.picture.yaw_deg = yaw, framed.study.picture.pitch_deg = pitch;
        framed.study.picture.fov_deg = fov;
        const float margin = least_margin(framed, framed.views());
        EXPECT_GE(margin, 0.05f - 1e-4f) << yaw << ' ' << pitch << ' ' << fov;
        EXPECT_LE(margin, 0.07f) << yaw << ' ' << pitch << ' ' << fov;
      }
}

TEST(Framing, TheMarginIsThatOfTheStudy) {
  Framed framed;
  framed.study.picture.margin = 0.2f;
  EXPECT_GE(least_margin(framed, framed.views()), 0.2f - 1e-4f);
}

TEST(Framing, PanesHaveOneScaleOneFloorAndFillThePicture) {
  const Framed framed;
  const std::vector<PaneView> views = framed.views();
  ASSERT_EQ(views.size(), 3u);
  EXPECT_EQ(views[0].pane, StudyPane::Source);
  EXPECT_EQ(views[2].pane, StudyPane::Result);
  int x = 0;
  for (const PaneView& view : views) {
    EXPECT_EQ(view.x, x);
    x += view.size.width;
    EXPECT_EQ(view.size.width % 2, 0);
    EXPECT_EQ(view.size.height, 720);
    EXPECT_EQ(view.camera.distance, views[0].camera.distance);
    EXPECT_NEAR(view.camera.target.y(), views[0].camera.target.y(), 1e-4f);
    EXPECT_NEAR(render::metres_a_pixel(view.camera, view.size, view.camera.target),
                render::metres_a_pixel(views[0].camera, views[0].size, views[0].camera.target), 1e-6f);
  }
  EXPECT_EQ(x, 1280);
}

TEST(Framing, APairHasTwoEqualPanesAndLabelsAStripAbove) {
  Framed framed;
  framed.study.layout.results = TrialResults::Pair;
  framed.study.layout.panes = {StudyPane::Result, StudyPane::Source};
  framed.study.layout.labels = true;
  const std::vector<PaneView> views = framed.views();
  ASSERT_EQ(views.size(), 3u);
  EXPECT_EQ(views[0].side, 0);
  EXPECT_EQ(views[1].side, 1);
  EXPECT_NEAR(views[0].size.width, views[1].size.width, 2);
  EXPECT_EQ(views[0].y, label_height(framed.study, kSize));
  EXPECT_EQ(views[0].y + views[0].size.height, 720);
  EXPECT_GT(views[0].y, 20);
  EXPECT_GE(least_margin(framed, views), 0.05f - 1e-4f);
}

TEST(Framing, NothingToSeeIsFramedToo) {
  Framed framed;
  framed.result.clear();
  EXPECT_GE(least_margin(framed, framed.views()), 0.05f - 1e-4f);
}

}  // namespace
}  // namespace understudy::app
