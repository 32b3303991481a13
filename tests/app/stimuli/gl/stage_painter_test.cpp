// Pictures of a stage: nothing is cut off; the same picture for whoever looks through a study.
#include "app/stimuli/stage_painter.hpp"

#include <algorithm>

#include "app/stimuli/trial_pictures.hpp"
#include "render/context/context.hpp"
#include "tests/app/stimuli/gl/small_study.hpp"

namespace understudy::app {
namespace {

class StagePictures : public SmallStudy {
 protected:
  void SetUp() override {
    SmallStudy::SetUp();
    context_ = render::make_offscreen_context();
    renderers_.emplace();
  }
  void TearDown() override {
    renderers_.reset();
    SmallStudy::TearDown();
  }
  std::shared_ptr<const Stage> stage(int motion) {
    return StageMaker(study_, {services().networks, {}}).stage(motion, 0);
  }
  StagePainter painter(const std::shared_ptr<const Stage>& stage) {
    return {study_, stage, {study_.picture.width, study_.picture.height}, *renderers_};
  }
  std::unique_ptr<render::Context> context_;
  std::optional<ClipRenderers> renderers_;
};

/// What is drawn at all, and of it at the picture's edges.
struct Drawn {
  int pixels = 0, at_edges = 0;
};
Drawn drawn(const render::Image& image, const Vec3& background) {
  Drawn drawn;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* pixel = image.at(x, y);
      bool is_drawn = false;
      for (int c = 0; c < 3; ++c)
        is_drawn = is_drawn || std::abs(static_cast<float>(pixel[c]) - 255 * background[c]) > 4;
      const bool is_edge = x == 0 || y == 0 || x + 1 == image.width || y + 1 == image.height;
      drawn.pixels += is_drawn ? 1 : 0;
      drawn.at_edges += is_drawn && is_edge ? 1 : 0;
    }
  return drawn;
}

TEST_F(StagePictures, NothingIsCutOffInAnyFrameOfAnyCondition) {
  study_.picture.width = 320, study_.picture.height = 180;
  for (const TrialResults results : {TrialResults::One, TrialResults::Pair}) {
    study_.layout.results = results;
    for (const int motion : {0, 1}) {
      const auto on = stage(motion);
      StagePainter paint = painter(on);
      for (const Trial& trial : clip_trials(study_))
        for (size_t pane = 0; trial.motion == motion && pane < paint.panes().size(); ++pane)
          for (size_t frame = 0; frame < on->source.frames.size(); ++frame) {
            const double t = static_cast<double>(frame) / on->source.fps;
            render::Scene scene = paint.scene(trial, pane, {t, false});
            const PaneView& view = paint.panes()[pane];
            const Points points = render::all_points(scene);
            for (Eigen::Index i = 0; i < points.rows(); ++i) {
              const Vec3 at = render::on_screen(view.camera, view.size, points.row(i));
              const float w = static_cast<float>(view.size.width), h = static_cast<float>(view.size.height);
              ASSERT_GE(std::min({at.x() / w, 1 - at.x() / w, at.y() / h, 1 - at.y() / h}), 0.0499f)
                  << paint.label(pane) << " frame " << frame;
            }
            if (frame % 4 != 0) continue;
            scene.ground.visible = false;
            const Drawn seen = drawn(renderers_->of(pane).render_image(scene, view.camera, view.size),
                                     study_.picture.background);
            EXPECT_GT(seen.pixels, 50) << paint.label(pane);
            EXPECT_EQ(seen.at_edges, 0) << paint.label(pane) << " frame " << frame;
          }
    }
  }
}

TEST_F(StagePictures, AStrayInAScanMakesNobodySmall) {
  const auto without = stage(1);
  study_.motions[1].source.path = path("strays.npz");
  write_dance(path("strays.npz"), Vec3(3, 1, 0));
  const auto with = stage(1);
  const auto distance = [&](const std::shared_ptr<const Stage>& one) {
    return painter(one).panes()[0].camera.distance;
  };
  EXPECT_NEAR(distance(with), distance(without), 0.05f);
}

TEST_F(StagePictures, AreDrawnOnceForAllConditionsAndRuns) {
  const auto on = stage(0);
  StagePainter paint = painter(on);
  const ClipPlan plan(study_.clip, study_.picture.fps, on->motion_s);
  for (const Trial& trial : clip_trials(study_))
    for (int frame = 0; trial.motion == 0 && frame < plan.frames(); ++frame)
      paint.picture(trial, plan.at(frame));
  EXPECT_EQ(paint.drawn(), 3 + 1 + 3 * 3) << "of the source, the target, the results";
}

TEST_F(StagePictures, DependOnNothingThatWasDrawnBefore) {
  const auto on = stage(0);
  const std::vector<Trial> trials = clip_trials(study_);
  const ClipPlan plan(study_.clip, study_.picture.fps, on->motion_s);
  std::vector<std::vector<uint8_t>> alone, after;
  StagePainter one = painter(on);
  for (int frame = 0; frame < 3; ++frame) alone.push_back(one.picture(trials[2], plan.at(frame)).pixels);
  StagePainter many = painter(on);
  for (const int k : {0, 1, 2})
    for (int frame = 0; frame < 3; ++frame) {
      const render::Image picture = many.picture(trials[static_cast<size_t>(k)], plan.at(frame));
      if (k == 2) after.push_back(picture.pixels);
    }
  for (size_t frame = 0; frame < 3; ++frame) EXPECT_TRUE(alone[frame] == after[frame]) << frame;
}

TEST_F(StagePictures, TheLightAndTheBackgroundAreTheStudys) {
  const auto on = stage(0);
  const Trial trial = clip_trials(study_)[0];
  const render::Image usual = painter(on).picture(trial, {});
  study_.picture.light_turn_deg = 100;
  EXPECT_NE(painter(on).picture(trial, {}).pixels, usual.pixels);
  study_.picture.background = Vec3(0.1f, 0.2f, 0.3f);
  const render::Image dark = painter(on).picture(trial, {});
  EXPECT_NEAR(dark.at(1, 1)[2], 77, 1);
}

TEST_F(StagePictures, APictureOfATrialIsThatOfItsClip) {
  const std::vector<Trial> trials = clip_trials(study_);
  TrialPictures pictures({services().networks, {}});
  const auto on = stage(0);
  const ClipPlan plan(study_.clip, study_.picture.fps, on->motion_s);
  StagePainter paint = painter(on);
  const auto shown = [&](const Trial& trial, float share) {
    return pictures.picture(study_, trial, share, {160, 90}).pixels;
  };
  EXPECT_EQ(shown(trials[0], 0), paint.picture(trials[0], plan.at(0)).pixels);
  EXPECT_EQ(shown(trials[1], 0.3f), paint.picture(trials[1], plan.at(3)).pixels);
  EXPECT_TRUE(plan.at(3).is_card);
  EXPECT_EQ(shown(trials[2], 1), paint.picture(trials[2], plan.at(12)).pixels);

  extractions_->store(0);
  shown(trials[1], 0.1f);
  EXPECT_EQ(extractions_->load(), 0) << "the motion is kept";
  EXPECT_EQ(pictures.picture(study_, trials[0], 0, {80, 60}).width, 80);
  EXPECT_EQ(extractions_->load(), 0) << "in another size, too";
  shown(trials[4], 0.5f);
  EXPECT_GT(extractions_->load(), 0);
}

}  // namespace
}  // namespace understudy::app
