// What the tests of 2D poses share: a person, people that move, files by hand.
#pragma once

#include <nlohmann/json.hpp>

#include "retarget/keypoints/keypoint_layout.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/keypoints/keypoint_writers.hpp"
#include "tests/retarget/formats/support.hpp"

namespace understudy::test {

using Json = nlohmann::json;

constexpr double kFrame = 1.0 / 30;  // seconds

/// Somebody of this height who stands with the feet at `foot`, seen from the front; all 25 points.
inline FlatPose standing(const Vec2& foot, float height, float confidence = 0.5f) {
  using namespace body25;
  FlatPose pose;
  const auto put = [&](int point, float x, float y) {
    pose.set(point, foot + height * Vec2(x, -y), confidence);
  };
  put(Nose, 0, 0.93f), put(Neck, 0, 0.83f), put(MidHip, 0, 0.52f);
  for (const bool left : {true, false}) {
    const float side = left ? 1.0f : -1.0f;  // facing the camera, the left is on the picture's right
    const auto both = [&](int right, float x, float y) {
      put(left ? kBodyMirror[right] : right, side * x, y);
    };
    both(RightShoulder, 0.11f, 0.82f), both(RightElbow, 0.14f, 0.65f), both(RightWrist, 0.16f, 0.49f);
    both(RightHip, 0.06f, 0.52f), both(RightKnee, 0.065f, 0.28f), both(RightAnkle, 0.07f, 0.04f);
    both(RightEye, 0.02f, 0.95f), both(RightEar, 0.045f, 0.94f);
    both(RightBigToe, 0.09f, 0.01f), both(RightSmallToe, 0.11f, 0.015f), both(RightHeel, 0.07f, 0);
  }
  return pose;
}

/// Twenty-one or more points around the one of the body.
inline FlatPoints small_part(const FlatPose& pose, int around, int count) {
  FlatPoints points(count, 3);
  for (int i = 0; i < count; ++i)
    points.row(i) << pose.at(around).x() + 0.5f * static_cast<float>(i), pose.at(around).y() - 0.25f, 0.75f;
  return points;
}
inline FlatPose with_hands_and_face(FlatPose pose) {
  pose.left_hand = small_part(pose, body25::LeftWrist, kHandPoints);
  pose.right_hand = small_part(pose, body25::RightWrist, kHandPoints);
  pose.face = small_part(pose, body25::Nose, kFacePoints);
  return pose;
}

/// x, y, c in one list, as OpenPose and COCO have it.
inline Json flat_list(const FlatPoints& points) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < points.size(); ++i) list.push_back(points.data()[i]);
  return list;
}
inline Json listed(const FlatPose& pose, const char* layout) {
  return flat_list(points_in_layout(*layout_named(layout), pose));
}
inline Json openpose_frame(const std::vector<FlatPose>& people, const char* layout = "body25") {
  Json json = {{"version", 1.3}, {"people", Json::array()}};
  for (const FlatPose& pose : people) json["people"].push_back({{"pose_keypoints_2d", listed(pose, layout)}});
  return json;
}
inline Json controlnet_frame(const std::vector<FlatPose>& people, int width = 640, int height = 480) {
  Json json = openpose_frame(people, "openpose18");
  json["canvas_width"] = width;
  json["canvas_height"] = height;
  return json;
}

/// A reading of people by hand: poses[person][frame]; nobody in a frame: not seen.
inline KeypointReading reading_of(const std::vector<std::vector<FlatPose>>& people) {
  KeypointReading reading;
  reading.path = "made";
  reading.canvas = {640, 480};
  for (size_t p = 0; p < people.size(); ++p) {
    KeypointTrack track;
    track.person = static_cast<int64_t>(p) + 1;
    for (size_t f = 0; f < people[p].size(); ++f)
      if (!is_nobody(people[p][f])) track.poses.push_back({static_cast<int64_t>(f), 1, people[p][f]});
    reading.tracks.push_back(track);
  }
  for (size_t f = 0; f < people.front().size(); ++f) reading.frames.push_back({static_cast<int64_t>(f), ""});
  return reading;
}

inline bool tells(const KeypointReading& reading, const std::string& text) {
  return std::any_of(reading.told.begin(), reading.told.end(),
                     [&](const auto& one) { return contains(one, text); });
}
inline std::string all_told(const KeypointReading& reading) {
  std::string all;
  for (const std::string& one : reading.told) all += one + "\n";
  return all;
}

/// The farthest that two poses are apart, pixels; those points that only one of them has count as far away.
inline float farthest_apart(const FlatPose& a, const FlatPose& b) {
  float far = 0;
  for (int p = 0; p < kBodyPoints; ++p)
    far = std::max(far, a.has(p) != b.has(p) ? 1e6f : a.has(p) ? (a.at(p) - b.at(p)).norm() : 0);
  return far;
}

}  // namespace understudy::test
