// A body in space as a detector sees it, the marks of its face, and the camera that lays it onto a reference.
#include "retarget/pose2d/body_view.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "retarget/body/builtin_person.hpp"
#include "retarget/pose2d/camera_fit.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy {
namespace {

struct Person {
  ShapedBody body;
  BodyMarks marks;

  explicit Person(const PersonOptions& options = {}) : body(builtin_person(options)) {
    marks.face = face_marks(body.joints, body.vertices, Eigen::VectorXf(body.weights.col(Head)));
    marks.feet = foot_marks(body.joints);
  }
  PosedSkeleton posed(const Pose& pose = {}) const { return forward_kinematics(body.joints, pose); }
  BodyPlaces places(const Pose& pose = {}) const { return body_places(posed(pose), marks); }
};

Pinhole camera_at(float yaw_deg, float pitch_deg = 0, float distance = 4) {
  Pinhole camera =
      looking_at(Vec3::Zero(), camera_axes(yaw_deg * kPi / 180, pitch_deg * kPi / 180), distance);
  camera.focal = 900;
  camera.centre = {415.5f, 239.5f};
  return camera;
}

FlatPose seen_from(const Person& person, float yaw_deg, const BodyViewOptions& options = {}) {
  return seen_pose(person.places(), Mat3::Identity(), camera_at(yaw_deg), options);
}

TEST(FaceMarks, AreOnTheFaceOfAnyPerson) {
  for (const float stature : {0.9f, 1.7f, 2.2f})
    for (const float age : {4.0f, 30.0f, 90.0f}) {
      PersonOptions options;
      options.stature = stature, options.age = age;
      const Person person(options);
      const FaceMarks& face = person.marks.face;
      const float s = stature;
      EXPECT_NEAR(face.nose.x(), 0, 0.003f * s);
      EXPECT_GT(face.nose.z(), face.left_eye.z());
      EXPECT_GT(face.left_eye.y(), face.nose.y());
      EXPECT_LT(face.left_eye.y() - face.nose.y(), 0.045f * s);
      EXPECT_GT(face.left_eye.x(), 0.01f * s);
      EXPECT_GT(face.left_ear.x(), face.left_eye.x());
      EXPECT_LT(face.left_ear.z(), face.left_eye.z());
      EXPECT_LT((face.left_ear - Vec3(-face.right_ear.x(), face.right_ear.y(), face.right_ear.z())).norm(),
                0.004f * s);
    }
}

TEST(FaceMarks, WithoutASurfaceAreWhereAPersonHasThem) {
  const Person person;
  const FaceMarks usual = usual_face_marks(person.body.joints);
  EXPECT_LT((usual.nose - person.marks.face.nose).norm(), 0.03f);
  EXPECT_LT((usual.left_eye - person.marks.face.left_eye).norm(), 0.03f);
  EXPECT_LT((usual.left_ear - person.marks.face.left_ear).norm(), 0.03f);
  const FaceMarks of_few =
      face_marks(person.body.joints, person.body.vertices.topRows(10), Eigen::VectorXf::Ones(10));
  EXPECT_EQ(of_few.nose, usual.nose);
}

TEST(FaceMarks, AreWhereTheUserPutsThemOnceEach) {
  const Person person;
  const Joints& rest = person.body.joints;
  std::vector<FaceMove> moves;
  const FaceMove first{FaceMark::LeftEye, Vec3(0.05f, 1.6f, 0.1f)};
  put(first, moves), put(mirrored(first, 0.01f), moves);
  put({FaceMark::LeftEye, Vec3(0.04f, 1.6f, 0.1f)}, moves);
  ASSERT_EQ(moves.size(), 2u);
  const FaceMarks moved = moved_marks(person.marks.face, rest, moves);
  const Vec3 head = rest.row(Head).transpose();
  EXPECT_LT((head + moved.left_eye - Vec3(0.04f, 1.6f, 0.1f)).norm(), 1e-6f);
  EXPECT_LT((head + moved.right_eye - Vec3(-0.03f, 1.6f, 0.1f)).norm(), 1e-6f) << "as seen in the mirror";
  EXPECT_EQ(moved.nose, person.marks.face.nose);
  EXPECT_EQ(mirrored({FaceMark::Nose, Vec3(0.02f, 1.5f, 0.1f)}, 0.01f).place.x(), 0.01f);
  for (const FaceMark mark : {FaceMark::Nose, FaceMark::RightEye, FaceMark::LeftEar})
    EXPECT_EQ(kBodyPointNames[static_cast<size_t>(point_of(mark))],
              std::string(kFaceMarkNames[static_cast<size_t>(mark)]));
}

TEST(BodyView, TheLeftOfWhoFacesTheCameraIsOnThePicturesRight) {
  const Person person;
  const FlatPose pose = seen_from(person, 0);
  EXPECT_EQ(points_seen(pose), kBodyPoints);
  EXPECT_GT(pose.at(body25::LeftWrist).x(), pose.at(body25::RightWrist).x());
  EXPECT_LT(pose.at(body25::Nose).y(), pose.at(body25::MidHip).y());
  EXPECT_GT(pose.at(body25::LeftSmallToe).x(), pose.at(body25::LeftBigToe).x());
}

TEST(BodyView, TheFaceVanishesWhenTheHeadTurnsAway) {
  const Person person;
  const FlatPose behind = seen_from(person, 180);
  for (const int point : {body25::Nose, body25::LeftEye, body25::RightEye}) EXPECT_FALSE(behind.has(point));
  EXPECT_TRUE(behind.has(body25::LeftEar));
  EXPECT_TRUE(behind.has(body25::RightEar));
  const FlatPose from_left = seen_from(person, 90);
  EXPECT_TRUE(from_left.has(body25::Nose));
  EXPECT_TRUE(from_left.has(body25::LeftEar));
  EXPECT_TRUE(from_left.has(body25::LeftEye));
  EXPECT_FALSE(from_left.has(body25::RightEar));
  EXPECT_FALSE(from_left.has(body25::RightEye));
  BodyViewOptions all;
  all.hides_face = false;
  EXPECT_EQ(points_seen(seen_from(person, 180, all)), kBodyPoints);
}

TEST(BodyView, TheHeadCountsAndNotTheBody) {
  const Person person;
  Pose pose;
  pose.local[Head] = Eigen::AngleAxisf(kPi, Vec3::UnitY()).toRotationMatrix();
  const PosedSkeleton posed = person.posed(pose);
  const FlatPose seen = seen_pose(person.places(pose), posed.global[Head], camera_at(0));
  EXPECT_FALSE(seen.has(body25::Nose));
  EXPECT_TRUE(seen.has(body25::LeftWrist));
}

TEST(BodyView, WhatIsOffTheCanvasOrBehindTheEyeIsMissing) {
  const Person person;
  BodyViewOptions options;
  options.canvas = {832, 240};  // the middle of the body is at its lower edge
  const FlatPose cut = seen_pose(person.places(), Mat3::Identity(), camera_at(0), options);
  EXPECT_TRUE(cut.has(body25::Nose));
  EXPECT_FALSE(cut.has(body25::LeftAnkle));
  Pinhole turned = camera_at(0);
  turned.rotation = camera_axes(kPi, 0);
  EXPECT_TRUE(is_nobody(seen_pose(person.places(), Mat3::Identity(), turned)));
}

TEST(BodyView, LimbsBehindTheBodyAreForgotten) {
  const Person person;
  Pose pose;  // arms along z: the left one to the front, the right one to the back
  pose.local[LeftShoulder] = Eigen::AngleAxisf(-kPi / 2, Vec3::UnitY()).toRotationMatrix();
  pose.local[RightShoulder] = Eigen::AngleAxisf(-kPi / 2, Vec3::UnitY()).toRotationMatrix();
  const Points skin = posed_vertices(person.body, pose);
  const std::vector<int> joints = joints_of_vertices(person.body.weights);
  const Pinhole camera = camera_at(0);
  const SurfaceView view = surface_view(camera, 832, 480, skin, person.body.faces);
  const BodyPlaces places = person.places(pose);
  FlatPose front = seen_pose(places, Mat3::Identity(), camera);
  FlatPose whole = front;
  forget_hidden(front, places, camera, {view, person.body.faces, joints});
  EXPECT_TRUE(front.has(body25::LeftWrist));
  EXPECT_TRUE(front.has(body25::LeftShoulder));
  EXPECT_TRUE(front.has(body25::Neck));
  const Pinhole aside = camera_at(90);  // the left arm is before nothing, the right side is behind the trunk
  const SurfaceView from_left = surface_view(aside, 832, 480, skin, person.body.faces);
  FlatPose side = seen_pose(places, Mat3::Identity(), aside);
  forget_hidden(side, places, aside, {from_left, person.body.faces, joints});
  EXPECT_FALSE(side.has(body25::RightKnee));
  EXPECT_TRUE(side.has(body25::LeftKnee));
  EXPECT_GT(points_seen(whole), points_seen(side));
}

TEST(CameraFit, FindsTheCameraThatMadeTheReference) {
  const Person person;
  Pose pose;
  pose.local[LeftElbow] = Eigen::AngleAxisf(-1.2f, Vec3::UnitY()).toRotationMatrix();
  pose.local[RightHip] = Eigen::AngleAxisf(-0.7f, Vec3::UnitX()).toRotationMatrix();
  const BodyPlaces places = person.places(pose);
  for (const float yaw_deg : {-130.0f, 10.0f, 75.0f, 170.0f}) {
    Pinhole truth = camera_at(yaw_deg, 0, 5.5f);
    truth.position += Vec3(0.3f, 0.4f, -0.2f);
    CameraFitOptions options;
    options.focal = truth.focal, options.centre = truth.centre;
    const CameraFit fit = fit_camera(places, seen_pose(places, Mat3::Identity(), truth), options);
    EXPECT_LT(fit.error, 0.05f) << yaw_deg;
    EXPECT_LT((fit.camera.position - truth.position).norm(), 0.01f) << yaw_deg;
  }
}

TEST(CameraFit, WithoutPerspectiveFindsTheScale) {
  const Person person;
  const BodyPlaces places = person.places();
  Pinhole truth = camera_at(40);
  truth.orthographic = true;
  truth.focal = 180;
  CameraFitOptions options;
  options.centre = truth.centre;
  options.orthographic = true;
  const CameraFit fit = fit_camera(places, seen_pose(places, Mat3::Identity(), truth), options);
  EXPECT_LT(fit.error, 0.05f);
  EXPECT_NEAR(fit.camera.focal, 180, 0.1f);
}

TEST(CameraFit, RefusesAReferenceOfThreePoints) {
  const Person person;
  FlatPose reference;
  for (const int point : {body25::Nose, body25::Neck, body25::MidHip}) reference.set(point, Vec2(1, 2), 1);
  EXPECT_TRUE(
      test::contains(test::error_of([&] { fit_camera(person.places(), reference, {}); }), "only 3 points"));
}

}  // namespace
}  // namespace understudy
