// A person opens 2D poses and somebody's picture, slides and locks lengths, puts points right, lets another
// perform, compares, saves and opens again: by mouse and keys.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/run/exports.hpp"
#include "render/image.hpp"
#include "render/pose_picture.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "tests/app/application_fixture.hpp"
#include "tests/support/flat_track.hpp"

namespace understudy::app {
namespace {

using Json = nlohmann::json;

class FlatPath : public ApplicationTest {
 protected:
  void SetUp() override {
    ApplicationTest::SetUp();
    write_openpose_folder(path("track"), walking_track(12, 6, 2));
    write_controlnet(path("tall.json"), standing_track(1.4f));
    render::write_png(path("tall.png"), render::Image(640, 560, Vec3(0.2f, 0.5f, 0.3f)));
  }
  /// A window high enough for the whole inspector.
  void open_flat() {
    make(render::ContextKind::Null, {1280, 2400});
    play("drop " + path("track") + "\nwait\nframes 3\nexpect view.0\nexpect_value frames 12");
    play("drop " + path("tall.png") + "\nwait\nframes 3\nexpect view.1\nexpect_value takes 1");
  }
  /// As MediaPipe writes them, in shares of a picture.
  void write_landmarks() {
    Json frames = Json::array();
    for (int t = 0; t < 6; ++t) {
      Json landmarks = Json::array();
      for (int k = 0; k < 33; ++k)
        landmarks.push_back(
            {{"x", 0.3 + 0.01 * (k % 7)}, {"y", 0.2 + 0.02 * k}, {"z", 0}, {"visibility", 0.9}});
      frames.push_back(landmarks);
    }
    std::ofstream(path("mediapipe.json")) << frames;
  }
  /// Folders are read beside the window: some frames later they are there.
  void play_until_shown(const std::string& name) {
    for (int i = 0; i < 250 && !complaint("expect " + name).empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      play("frames 2");
    }
    EXPECT_EQ(complaint("expect " + name), "");
  }
  const FlatResult& result(size_t take = 0) const { return *session().takes.at(take).flat; }
  const FlatPoses& source() const { return *session().flat.poses; }
  float length(int bone) const { return result().lengths.length[bone]; }
};

TEST_F(FlatPath, ASlidAndALockedLengthArePerformedAndUndone) {
  open_flat();
  const float thigh = length(flat_bone::LeftThigh),
              seen = seen_lengths(result().poses[4])[flat_bone::LeftThigh];
  play("drag flat.length.left_thigh 60 0\nwait\nframes 3");
  const float slid = length(flat_bone::LeftThigh);
  EXPECT_GT(slid, 1.1f * thigh);
  EXPECT_FLOAT_EQ(length(flat_bone::RightThigh), slid) << "the other side follows";
  EXPECT_NEAR(seen_lengths(result().poses[4])[flat_bone::LeftThigh], seen * slid / thigh, 1);
  play("click flat.lock.left_thigh\nwait\nframes 3\nclick flat.larger\nwait\nframes 3");
  EXPECT_FLOAT_EQ(length(flat_bone::LeftThigh), slid) << "locked";
  EXPECT_NEAR(length(flat_bone::RightThigh), 1.05f * slid, 0.01f);
  play("key Ctrl+Z\nwait\nkey Ctrl+Z\nwait\nkey Ctrl+Z\nwait\nframes 3");
  EXPECT_FLOAT_EQ(length(flat_bone::LeftThigh), thigh) << "one slide is one step";
}

TEST_F(FlatPath, PointsAreDraggedAndSidesExchangedOverARange) {
  open_flat();
  play("playback.frame 5\nwait\nframes 3\nexpect_no view.0.point.left_wrist\nclick flat.tool\nframes 3");
  const Vec2 before = source().clean[5].pose.at(body25::LeftWrist);
  const Vec2 performed = result().poses[5].at(body25::LeftWrist);
  play("drag view.0.point.left_wrist 40 -50\nwait\nframes 3");
  const Vec2 after = source().clean[5].pose.at(body25::LeftWrist);
  EXPECT_GT(after.x(), before.x() + 20);
  EXPECT_LT(after.y(), before.y() - 20);
  EXPECT_GT((result().poses[5].at(body25::LeftWrist) - performed).norm(), 20);
  play("expect_value undo_label \"Drag left wrist\"\nkey Ctrl+Z\nwait\nframes 3");
  EXPECT_EQ(source().clean[5].pose.at(body25::LeftWrist), before);

  const Vec2 hip = source().clean[3].pose.at(body25::LeftHip);
  play("playback.frame 2\nclick timeline.in\nplayback.frame 4\nclick timeline.out\nframes 3");
  play("click flat.exchange\nwait\nframes 3\nexpect flat.edit.0");
  EXPECT_NE(source().clean[3].pose.at(body25::LeftHip), hip);
  play("expect timeline.track.point.0\nclick flat.edit.0\nwait\nframes 3\nexpect_no flat.edit.0");
  EXPECT_EQ(source().clean[3].pose.at(body25::LeftHip), hip);
}

TEST_F(FlatPath, APointThatIsHeldIsPerformedBeforeItIsLetGo) {
  open_flat();
  play("playback.frame 5\nwait\nframes 3\nclick flat.tool\nframes 3");
  const auto wrist = [&] { return result().poses[5].at(body25::LeftWrist); };
  const Vec2 performed = wrist();
  const ImVec2 at = application_->find("view.0.point.left_wrist")->rect.at(0.5f, 0.5f);
  const auto there = [&](float x, float y) {
    return std::to_string(at.x + x) + " " + std::to_string(at.y + y) + "\nframes 3\n";
  };
  play("event move " + there(0, 0) + "event button left down " + there(0, 0) + "event move " +
       there(20, -20) + "event move " + there(40, -50) + "wait\nframes 3");
  const Vec2 held = wrist();
  EXPECT_GT((held - performed).norm(), 20);
  EXPECT_TRUE(session().document.source.point_edits.empty()) << "no edit yet";
  play("event button left up " + there(40, -50) + "wait\nframes 3");
  EXPECT_EQ(session().document.source.point_edits.size(), 1u);
  EXPECT_EQ(wrist(), held);
  play("key Ctrl+Z\nwait\nframes 3");
  EXPECT_EQ(wrist(), performed) << "one drag is one step";
  EXPECT_FALSE(session().flat.dragging);
}

TEST_F(FlatPath, AFileThatDoesNotSayHowLargeItsPictureIsAsks) {
  write_landmarks();
  make(render::ContextKind::Null, {1280, 1200});
  play("drop " + path("mediapipe.json") +
       "\nwait\nframes 3\nexpect canvas.open\nexpect_no error.close\n"
       "expect_value question canvas");
  play("click canvas.cancel\nframes 3\nexpect_no canvas.open");
  EXPECT_TRUE(session().document.source.path.empty());
  play("drop " + path("mediapipe.json") +
       "\nwait\nframes 3\nclick canvas.size\nframes 2\nclick canvas.size.1");
  play("frames 2\nclick canvas.open\nframes 3\nwait\nframes 3\nexpect_value frames 6");
  EXPECT_EQ(source().reading.canvas, (Canvas{1280, 720}));
  play("document.save_as \"" + path("mp.understudy") + "\"\nwait");
  make(render::ContextKind::Null, {1280, 1200});
  play("open \"" + path("mp.understudy") +
       "\"\nwait\nframes 3\nexpect_no canvas.open\nexpect_value frames 6");
}

TEST_F(FlatPath, APersonOfAPictureOfUnknownSizeAsksToo) {
  open_flat();
  write_landmarks();
  play("drop " + path("mediapipe.json") + "\nwait\nframes 3\nclick canvas.cancel\nwait\nframes 3");
  play("expect_value takes 1\ndrop " + path("mediapipe.json") +
       "\nwait\nframes 3\nclick canvas.width\nkey Ctrl+A");
  play("type 800\nkey Enter\nframes 2\nclick canvas.open\nframes 3\nwait\nframes 3\nexpect_value takes 2");
  ASSERT_TRUE(session().takes[1].flat) << session().takes[1].problem;
  EXPECT_EQ(result(1).made.canvas, (Canvas{800, 1080}));
  EXPECT_EQ(session().document.takes[1].flat->canvas, "800x1080");
}

TEST_F(FlatPath, AFolderOfPosesIsOpenedInTheFileWindow) {
  make(render::ContextKind::Null, {1280, 800});
  play("dialog.open open_source\nframes 5");
  play("key Ctrl+L\nkey Ctrl+A\ntype \"" + folder_.string() + "\"\nkey Enter\nframes 3");
  play_until_shown("browser.entry.track");
  play("click browser.entry.track\nframes 3\nclick browser.accept\nwait\nframes 3");
  play("expect_value frames 12\nexpect view.0");
}

TEST_F(FlatPath, AClickOnAnotherPersonLetsThemPerform) {
  open_flat();
  const int64_t now = source().reading.performing().person;
  const std::string other = now == 1 ? "2" : "1";
  play("playback.frame 1\nwait\nframes 3\nclick view.0.person." + other + "\nwait\nframes 3");
  EXPECT_EQ(std::to_string(source().reading.performing().person), other);
  play("key Ctrl+Z\nwait");
  EXPECT_EQ(source().reading.performing().person, now);
}

TEST_F(FlatPath, TheCanvasIsZoomedAboutThePointerAndMoved) {
  open_flat();
  play("scroll view.1 4\nframes 3");
  EXPECT_GT(canvas_of(session().view, 1).zoom, 1.5f);
  EXPECT_EQ(canvas_of(session().view, 0).zoom, 1) << "each has its own";
  const float x = canvas_of(session().view, 1).x;
  play("drag view.1 80 0\nframes 3");
  EXPECT_LT(canvas_of(session().view, 1).x, x);
  play("double_click view.1\nframes 3");
  EXPECT_EQ(canvas_of(session().view, 1).zoom, 1);
}

TEST_F(FlatPath, TwoWaysAreComparedByAWipeSavedAndOpenedAgain) {
  open_flat();
  play("flat.place 0 source\ncompare.add 0 place=reference\nwait\nframes 3\nexpect_value takes 2");
  EXPECT_EQ(session().document.takes[1].flat->place, FlatPlace::Reference);
  EXPECT_NE(result(0).poses[3].at(body25::Neck), result(1).poses[3].at(body25::Neck));
  play(
      "view.layout wipe\nframes 3\nexpect view.wipe\nexpect view.1\nexpect view.2\ndrag view.wipe 100 "
      "0\nframes 3");
  EXPECT_GT(session().view.wipe, 0.5f);
  play("playback.play\nframes 30\nplayback.play\nframes 3");
  play("document.save_as \"" + path("flat.understudy") + "\"\nwait");
  const FlatPose before = result(1).poses[7];
  make(render::ContextKind::Null, {1280, 800});
  play("open \"" + path("flat.understudy") + "\"\nwait\nframes 3\nexpect_value takes 2\nexpect view.wipe");
  EXPECT_EQ(result(1).poses[7], before);
}

TEST_F(FlatPath, TheDialogExportsTheTakeAsPointsAndAsPictures) {
  open_flat();
  const auto save_as = [&](int as, const std::string& to) {
    play("dialog.open export\nframes 3\nclick export.as\nframes 2\nclick export.as." + std::to_string(as) +
         "\nframes 2\nclick export.path\nkey Ctrl+A\ntype \"" + path(to) +
         "\"\nkey Enter\nframes 2\nexpect_no export.bones\nwait\nframes 3");
  };
  save_as(4, "made.npz");
  const KeypointReading made = read_keypoints(path("made.npz"));
  ASSERT_EQ(made.frames.size(), 12u);
  EXPECT_EQ(made.canvas, (Canvas{640, 560}));
  EXPECT_EQ(*made.performing().at(5), result().poses[5]);
  play("dialog.open export\nframes 3\nclick export.count.1\nframes 2\nkey Escape\nframes 3");
  save_as(1, "control");
  const render::Image picture = render::read_png(path("control/frame_00008.png"));
  EXPECT_EQ(picture.width, 640);
  EXPECT_EQ(picture.pixels, render::pose_picture({result().poses[8]}, made.canvas).pixels);
  EXPECT_TRUE(fs::exists(path("control/frame_00000.png")));
  EXPECT_FALSE(fs::exists(path("control/frame_00009.png"))) << "4n + 1";
}

TEST_F(FlatPath, ACharacterThatIsDroppedPerformsTheTrackAndIsExported) {
  make(render::ContextKind::Null, {1280, 1600});
  play("drop " + path("track") + "\nwait\nframes 3\ndrop " + path("target.obj") + "\nwait\nframes 3");
  play("expect_value takes 1\nexpect_value frames 12\nexpect view.1.cube.front\nexpect_no view.0.cube.front");
  ASSERT_EQ(session().takes[0].shown.poses.size(), 12u);
  play("dialog.open export\nframes 3\nclick export.path\nkey Ctrl+A\ntype \"" + path("lifted.glb") +
       "\"\nkey Enter\nframes 2\nwait\nframes 3");
  EXPECT_TRUE(fs::exists(path("lifted.glb")));
}

TEST_F(FlatPath, ATakeInSpaceIsExportedAsItsViewIsSeen) {
  make(render::ContextKind::Null, {1280, 1600});
  play(kOpenBoth);
  play("view.camera 0 0 6\nframes 3\ndialog.open export\nframes 3\nclick export.format\nframes 3");
  const auto& formats = export_formats();
  const auto poses = std::find_if(formats.begin(), formats.end(),
                                  [](const ExportFormat& one) { return std::string(one.name) == "poses"; });
  play("click export.format." + std::to_string(poses - formats.begin()) +
       "\nframes 3\nexpect export.camera\nclick export.camera.0\nclick export.as.1\nframes 2\nclick "
       "export.path\nkey "
       "Ctrl+A\ntype \"" +
       path("near") + "\"\nkey Enter\nframes 2\nwait\nframes 3");
  play("view.camera 0 0 12\nframes 3\nexport.run 0 \"" + path("far") + "\" format=poses camera=view\nwait");
  const auto height = [&](const std::string& name) {
    const KeypointReading read = read_keypoints(path(name + ".json"));
    EXPECT_EQ(read.frames.size(), 24u);
    return size_of(*read.performing().at(0));
  };
  EXPECT_NEAR(height("near") / height("far"), 2, 0.25);
}

TEST_F(FlatPath, FramesThatCannotBeUsedAreMarkedWithTheirSentence) {
  KeypointReading track = walking_track(12);
  for (auto& pose : track.tracks[0].poses)
    if (pose.frame == 6) pose.pose = FlatPose();
  auto& poses = track.tracks[0].poses;
  poses.erase(poses.begin() + 6);
  write_openpose_folder(path("gap"), track);
  make(render::ContextKind::Null, {1280, 1200});
  play("open \"" + path("gap") + "\"\nwait\nframes 3\nplayback.frame 6\nframes 3\nexpect view.warning");
  const auto bad = bad_frames(session());
  ASSERT_EQ(bad.size(), 1u);
  EXPECT_EQ(bad[0].frame, 6);
  EXPECT_FALSE(bad[0].why.empty());
}

}  // namespace
}  // namespace understudy::app
