// Which points of the body hands may touch.
#pragma once

#include <array>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// A wrist and what it may touch, points of BODY_25: of the body, or the other wrist.
struct HandPair {
  int wrist, other;
};
/// Both hands with nose, neck, the other shoulder, middle and sides of the hips, both knees; hand and hand.
constexpr std::array<HandPair, 17> kHandPairs = {{
    {body25::RightWrist, body25::Nose},
    {body25::RightWrist, body25::Neck},
    {body25::RightWrist, body25::LeftShoulder},
    {body25::RightWrist, body25::MidHip},
    {body25::RightWrist, body25::RightHip},
    {body25::RightWrist, body25::LeftHip},
    {body25::RightWrist, body25::RightKnee},
    {body25::RightWrist, body25::LeftKnee},
    {body25::LeftWrist, body25::Nose},
    {body25::LeftWrist, body25::Neck},
    {body25::LeftWrist, body25::RightShoulder},
    {body25::LeftWrist, body25::MidHip},
    {body25::LeftWrist, body25::RightHip},
    {body25::LeftWrist, body25::LeftHip},
    {body25::LeftWrist, body25::RightKnee},
    {body25::LeftWrist, body25::LeftKnee},
    {body25::RightWrist, body25::LeftWrist},
}};

}  // namespace understudy
