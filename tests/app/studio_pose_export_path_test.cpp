// A person puts the marks of a face right, and lays pose pictures of a take onto a picture's poses: by mouse
// and keys.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "app/run/exports.hpp"
#include "app/session/document_file.hpp"
#include "retarget/body/builtin_person.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "tests/app/application_fixture.hpp"
#include "tests/support/flat_track.hpp"

namespace understudy::app {
namespace {

class PoseExportPath : public ApplicationTest {
 protected:
  /// A target with a face, and the export dialog for pose pictures.
  void open_person() {
    PersonOptions options;
    options.stature = 2.1f;  // as the stand-in that finds its joints believes
    const ShapedBody body = builtin_person(options);
    std::ofstream file(path("person.obj"));
    for (Eigen::Index v = 0; v < body.vertices.rows(); ++v) file << "v " << body.vertices.row(v) << '\n';
    for (Eigen::Index f = 0; f < body.faces.rows(); ++f)
      file << "f " << (body.faces.row(f).array() + 1) << '\n';
    file.close();
    make(render::ContextKind::Null, {1280, 1600});
    play("open samples/scan.npz \"" + path("person.obj") + "\"\nwait\nframes 3\nexpect_value takes 1");
  }
  void choose_poses() {
    const auto& formats = export_formats();
    const auto poses = std::find_if(formats.begin(), formats.end(),
                                    [](const ExportFormat& one) { return std::string(one.name) == "poses"; });
    play("dialog.open export\nframes 3\nclick export.format\nframes 3\nclick export.format." +
         std::to_string(poses - formats.begin()) + "\nframes 3\nexpect export.face");
  }
  const std::vector<FaceMove>& moved() const { return session().document.takes.at(0).target_edits.face; }
};

TEST_F(PoseExportPath, AMarkIsDraggedOverTheHeadOnBothSidesUndoneAndSaved) {
  open_person();
  const CameraState before = camera_of(session().view, 1);
  choose_poses();
  play("click export.face\nframes 5\nexpect_no export.save\nexpect_value tool face");
  for (const char* const mark : {"nose", "left_eye", "right_eye", "left_ear", "right_ear"})
    play(std::string("expect view.1.face.") + mark);
  const FaceMarks found = session().takes[0].face;
  play("drag view.1.face.left_eye 14 -18\nframes 3\nexpect_value undo_label \"Move the left eye\"");
  ASSERT_EQ(moved().size(), 2u) << "the other side follows";
  const FaceMarks now = moved_marks(found, session().takes[0].target->joints, moved());
  EXPECT_GT(now.left_eye.x(), found.left_eye.x() + 0.003f);
  EXPECT_GT(now.left_eye.y(), found.left_eye.y() + 0.003f);
  EXPECT_LT(now.right_eye.x(), found.right_eye.x() - 0.003f);
  EXPECT_FLOAT_EQ(now.right_eye.y(), now.left_eye.y());
  play("key Ctrl+Z\nframes 3");
  EXPECT_TRUE(moved().empty());

  play("click side.tab.2\nframes 3\nclick edit.face\nframes 3\nclick edit.face_mirror\nframes 2");
  play("drag view.1.face.nose 12 0\nframes 3\nexpect edit.face.0\nclick edit.face_mirror\nframes 2");
  ASSERT_EQ(moved().size(), 1u);
  EXPECT_EQ(moved()[0].mark, FaceMark::Nose);
  play("view.camera 180 0\nframes 3\nexpect_no view.1.face.nose\nexpect view.1.face.left_ear");
  play("key Escape\nframes 3\nexpect_value tool look\nexpect_no view.1.face.left_ear");
  EXPECT_EQ(camera_of(session().view, 1).distance, before.distance) << "the camera comes back";
  play("document.save_as \"" + path("face.understudy") + "\"\nwait");
  EXPECT_TRUE(
      same(read_document(path("face.understudy")).document.takes[0].target_edits.face[0], moved()[0]));
  play("export.run 0 \"" + path("moved.json") +
       "\" format=pose_list\nwait\nedit.face_clear 0\nexport.run 0 \"" + path("found.json") +
       "\" format=pose_list\nwait");
  const auto nose = [&](const std::string& name) {
    return read_keypoints(path(name)).performing().at(0)->at(body25::Nose);
  };
  EXPECT_GT((nose("moved.json") - nose("found.json")).norm(), 0.5f);
}

TEST_F(PoseExportPath, TheFirstFrameIsLaidOntoAReferencesPoses) {
  open_person();
  KeypointReading reference = standing_track(1);
  write_controlnet(path("reference.json"), reference);
  choose_poses();
  play("click export.camera.2\nframes 3\nexpect export.reference");
  EXPECT_NE(complaint("click export.save").find("greyed out"), std::string::npos) << "nothing is chosen yet";
  play("click export.reference\nframes 5\nexpect browser.path");
  play("key Ctrl+L\nkey Ctrl+A\ntype \"" + path("reference.json") + "\"\nkey Enter\nframes 5");
  play("click export.as.1\nframes 2\nclick export.path\nkey Ctrl+A\ntype \"" + path("laid") +
       "\"\nkey Enter\nframes 2\nwait\nframes 3");
  const KeypointReading laid = read_keypoints(path("laid.json"));
  EXPECT_EQ(laid.canvas, reference.canvas);
  const FlatPose &want = *reference.performing().at(0), &got = *laid.performing().at(0);
  EXPECT_LT((want.at(body25::Neck) - got.at(body25::Neck)).norm(), 40);
  EXPECT_LT((want.at(body25::MidHip) - got.at(body25::MidHip)).norm(), 40);
  EXPECT_NEAR(size_of(got) / size_of(want), 1, 0.3);
}

}  // namespace
}  // namespace understudy::app
