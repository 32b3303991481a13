// Frames that could not be used are offered to be filled, and filled: plainly first, then as learned.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "app/session/take_export.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {
namespace {

/// A motion space that cannot be had before the gate is opened.
struct Gate {
  std::mutex mutex;
  std::condition_variable opened;
  bool is_open = false, was_asked = false;

  void open() {
    const std::lock_guard lock(mutex);
    is_open = true;
    opened.notify_all();
  }
  std::shared_ptr<MotionSpace> wait_for_space() {
    std::unique_lock lock(mutex);
    was_asked = true;
    opened.wait(lock, [this] { return is_open; });
    return std::make_shared<LiftedSpace>();
  }
};

class Fills : public StudioTest {
 protected:
  void open_gaps(Studio& studio, const std::set<int>& missing) {
    studio.run("open", {folder_without(missing)});
    studio.run("open", {path("target.obj")});
    studio.wait_idle();
  }

  static std::vector<Notice> offers(const Studio& studio) {
    std::vector<Notice> all;
    for (const Notice& notice : studio.session().notices)
      if (notice.offer.label == "Fill") all.push_back(notice);
    return all;
  }
  /// As a click on its button does.
  static void accept(Studio& studio, const Notice& notice) {
    studio.run("notice.dismiss", {std::to_string(notice.id)});
    const Arguments words = split_line(notice.offer.command);
    studio.run(words[0], {words.begin() + 1, words.end()});
    studio.wait_idle();
  }
  static const Motion& shown(const Studio& studio, size_t take = 0) {
    return studio.session().takes[take].shown;
  }
};

bool equal(const Pose& a, const Pose& b) {
  return a.local == b.local && a.root == b.root;
}

TEST_F(Fills, AreOfferedOnceForFramesThatCouldNotBeUsed) {
  Studio studio(services());
  open_gaps(studio, {9, 10, 11});
  ASSERT_EQ(offers(studio).size(), 1u);
  const Notice notice = offers(studio)[0];
  EXPECT_EQ(notice.text, "3 frames (9 to 11) could not be used and repeat the last pose");
  EXPECT_EQ(notice.offer.command, "edit.fill 0 bad");
  studio.tick(600);
  EXPECT_EQ(offers(studio).size(), 1u) << "it waits";
  const std::vector<Pose> before = shown(studio).poses;
  EXPECT_TRUE(equal(before[10], before[8]));

  accept(studio, notice);
  for (int t = 0; t < kFrames; ++t) {
    const bool made = t >= 9 && t <= 11;
    EXPECT_EQ(equal(shown(studio).poses[t], before[t]), !made) << t;
    EXPECT_EQ(shown(studio).doubt_m[t] > 0, made) << t;
  }
  studio.run("edit.undo");
  studio.run("edit.smooth", {"0", "0.3"});
  studio.wait_idle();
  EXPECT_TRUE(offers(studio).empty()) << "it was answered";
}

TEST_F(Fills, InSeveralPlacesAreCountedAndOneFrameIsNamed) {
  Studio studio(services());
  open_gaps(studio, {5, 9, 10, 17});
  ASSERT_EQ(offers(studio).size(), 1u);
  EXPECT_EQ(offers(studio)[0].text, "4 frames in 3 places could not be used and repeat the last pose");
  studio.run("edit.fill", {"0", "9", "10"});
  studio.wait_idle();
  EXPECT_EQ(offers(studio).size(), 1u) << "there are others";
  studio.run("edit.skip", {"0", "5", "on"});
  studio.run("edit.fill", {"0", "17", "17"});
  studio.wait_idle();
  EXPECT_TRUE(offers(studio).empty()) << "nothing is left to be done";
  studio.run("open", {folder_without({20}, "another")});
  studio.wait_idle();
  ASSERT_EQ(offers(studio).size(), 1u) << "another source";
  EXPECT_EQ(offers(studio)[0].text, "1 frame (20) could not be used and repeats the last pose");
  studio.run("open", {path("scan.npz")});
  studio.wait_idle();
  EXPECT_TRUE(offers(studio).empty()) << "it went with its source";
}

TEST_F(Fills, AreNotOfferedWhereAllFramesWereUsed) {
  Studio studio(services());
  open_both(studio);
  EXPECT_TRUE(offers(studio).empty());
}

/// Is sure of nobody.
class NobodyExtractor final : public SkeletonExtractor {
 public:
  Extraction extract(const Mesh&) override {
    Extraction nobody;
    nobody.joints = human_rest();
    nobody.confidence.setZero();
    return nobody;
  }
  std::string name() const override { return "nobody"; }
};

TEST_F(Fills, AreNotOfferedWhereNoFrameIsKnown) {
  StudioServices own = services();
  own.networks = [usual = own.networks](const Method& method, const NetworkParts& parts) {
    Networks networks = usual(method, parts);
    if (parts.extractor) networks.extractor = std::make_shared<NobodyExtractor>();
    return networks;
  };
  Studio studio(own);
  open_both(studio);
  ASSERT_EQ(unusable_runs(studio.session(), 0).size(), 1u);
  EXPECT_TRUE(offers(studio).empty()) << "there is nothing to fill them from";
}

TEST_F(Fills, OfEachTakeAreOfferedAndFollowTheirTake) {
  Studio studio(services());
  open_gaps(studio, {9, 10});
  studio.run("compare.add", {"0", "engine=paper"});
  studio.wait_idle();
  ASSERT_EQ(offers(studio).size(), 2u);
  EXPECT_EQ(offers(studio)[1].offer.command, "edit.fill 1 bad");
  EXPECT_EQ(offers(studio)[1].text.find(studio.session().document.takes[1].name + ": 2 frames"), 0u)
      << offers(studio)[1].text;
  studio.run("target.remove", {"0"});
  studio.wait_idle();
  ASSERT_EQ(offers(studio).size(), 1u) << "its take is gone";
  EXPECT_EQ(offers(studio)[0].offer.command, "edit.fill 0 bad") << "the other is the first now";
  accept(studio, offers(studio)[0]);
  EXPECT_GT(shown(studio).doubt_m[9], 0);
}

TEST_F(Fills, AreSavedAndOpenedAgainToTheBitAndNotOfferedAgain) {
  Motion saved;
  {
    Studio studio(services());
    open_gaps(studio, {9, 10, 11});
    accept(studio, offers(studio).at(0));
    studio.run("edit.fill_learned", {"0", "0", "0.3"});
    studio.wait_idle();
    studio.run("document.save_as", {path("filled.understudy")});
    saved = shown(studio);
  }
  Studio studio(services());
  studio.run("document.open", {path("filled.understudy")});
  studio.wait_idle();
  ASSERT_EQ(shown(studio).poses.size(), saved.poses.size());
  EXPECT_TRUE(same_poses(shown(studio), saved));
  EXPECT_EQ(shown(studio).doubt_m, saved.doubt_m);
  EXPECT_TRUE(offers(studio).empty());
}

TEST_F(Fills, FollowThePlainToLearnedSliderAndUndo) {
  Studio studio(services());
  open_gaps(studio, {9, 10, 11});
  const auto height = [&] { return shown(studio).poses[10].root.y(); };
  accept(studio, offers(studio).at(0));
  const float learned = height();
  for (const char* share : {"0.7", "0.5", "0"}) studio.run("edit.fill_learned", {"0", "0", share});
  studio.wait_idle();
  EXPECT_NEAR(learned - height(), LiftedSpace::kLift_m, 1e-5) << "the plain curve";
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_EQ(height(), learned) << "one step for the whole slider";
  studio.run("edit.redo");
  studio.wait_idle();
  EXPECT_NEAR(learned - height(), LiftedSpace::kLift_m, 1e-5);
}

TEST_F(Fills, HaveFourAnswersToChooseFrom) {
  Studio studio(services());
  open_gaps(studio, {9, 10, 11});
  const auto height = [&] { return shown(studio).poses[10].root.y(); };
  accept(studio, offers(studio).at(0));
  const float best = height();
  studio.run("edit.fill_variation", {"0", "0", "2"});
  studio.wait_idle();
  EXPECT_NEAR(height() - best, 2 * LiftedSpace::kAlternativeLift_m, 1e-5);
  EXPECT_EQ(undo_label(studio.session()), "Fill by alternative 3");
  const auto alternatives = [&]() -> const auto& {
    return studio.session().takes[0].alternatives;
  };
  ASSERT_EQ(alternatives().size(), size_t{kMostVariations});
  for (int k = 0; k < kMostVariations; ++k) {
    const float lift = LiftedSpace::kAlternativeLift_m * static_cast<float>(k);
    EXPECT_NEAR(alternatives()[k][10](Pelvis, 1) - best, lift, 1e-5) << k;
    EXPECT_EQ(alternatives()[k][8], studio.session().takes[0].joints[8]) << k << ": it is known";
  }
  for (const char* bad : {"4", "-1", "best"})
    EXPECT_THROW(studio.run("edit.fill_variation", {"0", "0", bad}), Error) << bad;
  EXPECT_EQ(failure_of([&] {
              studio.run("edit.fill_variation", {"0", "0", "4"});
            }),
            "there is no alternative 4: they are 0, the best answer, to 3");
  EXPECT_THROW(studio.run("edit.fill_variation", {"0", "1", "2"}), Error) << "there is one fill";
  studio.run("edit.undo");
  studio.wait_idle();
  EXPECT_EQ(height(), best);
  studio.run("edit.redo");
  studio.run("edit.move", {"fill", "0", "0", "8", "11"});
  EXPECT_EQ(studio.session().document.takes[0].pose_edits.fill[0].variation, 2)
      << "it is moved, not asked anew";
  studio.run("edit.remove", {"fill", "0", "0"});
  studio.wait_idle();
  EXPECT_TRUE(alternatives().empty()) << "nothing is made any more";
}

TEST_F(Fills, OfTwoAlternativesEachHaveTheirOwn) {
  Studio studio(services());
  open_both(studio);
  studio.run("edit.fill", {"0", "4", "5"});
  studio.run("edit.fill", {"0", "12", "13"});
  studio.wait_idle();
  const Motion best = shown(studio);
  studio.run("edit.fill_variation", {"0", "1", "3"});
  studio.wait_idle();
  EXPECT_TRUE(equal(shown(studio).poses[4], best.poses[4]));
  EXPECT_NEAR(shown(studio).poses[12].root.y() - best.poses[12].root.y(), 3 * LiftedSpace::kAlternativeLift_m,
              1e-5);
}

TEST_F(Fills, ArePlainUntilTheLearnedOnesAreThere) {
  Gate gate;
  StudioServices own = services();
  own.motion_space = [&gate] { return gate.wait_for_space(); };
  Studio studio(own);
  open_gaps(studio, {9, 10, 11});
  const Pose still = shown(studio).poses[10];
  EXPECT_FALSE(gate.was_asked) << "nothing is filled yet";
  studio.run("edit.fill", {"0", "bad"});
  for (int i = 0; i < 5000 && shown(studio).doubt_m.empty(); ++i) {
    studio.tick(0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const Motion plain = shown(studio);
  ASSERT_FALSE(plain.doubt_m.empty()) << "the curve does not wait for the motion space";
  EXPECT_FALSE(studio.idle()) << "more is to come";
  EXPECT_FALSE(equal(plain.poses[10], still));
  gate.open();
  studio.wait_idle();
  EXPECT_NEAR(shown(studio).poses[10].root.y() - plain.poses[10].root.y(), LiftedSpace::kLift_m, 1e-5);
  EXPECT_TRUE(equal(shown(studio).poses[8], plain.poses[8]));
}

TEST_F(Fills, AreCurvesWhereTheMotionSpaceCannotBeLoaded) {
  std::atomic<int> asked{0};
  StudioServices own = services();
  own.motion_space = [&asked]() -> std::shared_ptr<MotionSpace> {
    ++asked;
    throw Error("motion_space.weights: ends before its header");
  };
  std::vector<std::string> warnings;
  std::mutex writing;
  const log::Sink before = log::set_sink([&](log::Level level, const std::string& text) {
    const std::lock_guard lock(writing);
    if (level == log::Level::Warning) warnings.push_back(text);
  });
  {
    Studio studio(own);
    open_gaps(studio, {9, 10, 11});
    const Pose still = shown(studio).poses[10];
    accept(studio, offers(studio).at(0));
    EXPECT_FALSE(equal(shown(studio).poses[10], still));
    EXPECT_TRUE(studio.session().errors.empty()) << "no dialog: it is filled";
    studio.run("edit.fill_learned", {"0", "0", "0.5"});
    studio.wait_idle();
  }
  log::set_sink(before);
  EXPECT_EQ(asked, 1) << "once is enough";
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                          [](const std::string& text) {
                            return text.find("ends before its header: filled frames follow smooth curves") !=
                                   std::string::npos;
                          }),
            1);
}

TEST_F(Fills, OverTrimmedFramesAreMadeAndExportedAsFarAsTheyAreKept) {
  Studio studio(services());
  open_both(studio);
  const std::vector<Pose> before = shown(studio).poses;
  studio.run("edit.trim", {"0", "6", "15"});
  studio.run("edit.fill", {"0", "4", "8"});
  studio.wait_idle();
  for (int t = 0; t < kFrames; ++t) EXPECT_EQ(equal(shown(studio).poses[t], before[t]), t < 4 || t > 8) << t;
  const auto inputs = export_inputs(studio.session(), {0}, {});
  ASSERT_EQ(inputs.at(0).clips.at(0).poses.size(), 10u);
  const auto& made = inputs[0].clips[0].made;
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0].first, 0);
  EXPECT_EQ(made[0].last, 2) << "as the written clip counts";
  studio.run("edit.trim", {"0", "off"});
  studio.wait_idle();
  EXPECT_FALSE(equal(shown(studio).poses[4], before[4])) << "the fill reaches beyond the trim";
}

TEST_F(Fills, AtAnEndAreSaidToBeAGuess) {
  Studio studio(services());
  open_both(studio);
  const auto is_told = [&](const std::string& words) {
    for (const Notice& notice : studio.session().notices)
      if (notice.text == words) return true;
    return false;
  };
  studio.run("edit.fill", {"0", "0", "3"});
  EXPECT_TRUE(is_told("frames 0 to 3 are a guess: nothing before them is known"));
  studio.run("edit.fill", {"0", "20", "23"});
  EXPECT_TRUE(is_told("frames 20 to 23 are a guess: nothing after them is known"));
  studio.wait_idle();
  EXPECT_TRUE(studio.session().errors.empty());
}

TEST_F(Fills, NeedOneKnownFrameAndNoMore) {
  Studio studio(services());
  open_both(studio);
  EXPECT_EQ(failure_of([&] {
              studio.run("edit.fill", {"0", "0", "23"});
            }),
            "all frames would be filled: none is left that is known");
  studio.run("edit.fill", {"0", "0", "22"});
  studio.wait_idle();
  EXPECT_TRUE(studio.session().errors.empty());
  EXPECT_GT(shown(studio).doubt_m[0], shown(studio).doubt_m[20]) << "far from what is known";
  EXPECT_EQ(shown(studio).doubt_m[23], 0);
}

}  // namespace
}  // namespace understudy::app
