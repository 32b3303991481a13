// A person in a picture, standing, in pixels.
#pragma once

#include "retarget/keypoints/proportions.hpp"

namespace understudy {

/// Faces the camera with hanging, slightly bent arms; about 340 pixels tall, feet at y = 400.
inline FlatPose flat_person(float x = 300, float size = 1) {
  FlatPose pose;
  const auto set = [&](int point, float right, float up) {
    pose.set(point, Vec2(x + size * right, 400 - size * up), 0.9f);
  };
  set(body25::Nose, 0, 310), set(body25::Neck, 0, 270), set(body25::MidHip, 0, 170);
  for (const int side : {0, 1}) {  // the person's right is at the picture's left
    const float s = side == 0 ? -1.0f : 1.0f;
    set(side == 0 ? body25::RightShoulder : body25::LeftShoulder, 32 * s, 268);
    set(side == 0 ? body25::RightElbow : body25::LeftElbow, 46 * s, 212);
    set(side == 0 ? body25::RightWrist : body25::LeftWrist, 40 * s, 160);
    set(side == 0 ? body25::RightHip : body25::LeftHip, 18 * s, 170);
    set(side == 0 ? body25::RightKnee : body25::LeftKnee, 20 * s, 90);
    set(side == 0 ? body25::RightAnkle : body25::LeftAnkle, 21 * s, 10);
    set(side == 0 ? body25::RightEye : body25::LeftEye, 6 * s, 318);
    set(side == 0 ? body25::RightEar : body25::LeftEar, 14 * s, 314);
    set(side == 0 ? body25::RightBigToe : body25::LeftBigToe, 26 * s, 0);
    set(side == 0 ? body25::RightSmallToe : body25::LeftSmallToe, 32 * s, 1);
    set(side == 0 ? body25::RightHeel : body25::LeftHeel, 20 * s, 4);
  }
  return pose;
}

inline Proportions lengths_of(const FlatPose& pose) {
  Proportions lengths;
  lengths.length = seen_lengths(pose);
  lengths.poses = 1;
  return lengths;
}

}  // namespace understudy
