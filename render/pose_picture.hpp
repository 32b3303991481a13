// 2D poses as pictures that OpenPose and ControlNet draw, and that generators of images and films take.
#pragma once

#include <vector>

#include "render/image.hpp"
#include "retarget/base/fields.hpp"
#include "retarget/keypoints/flat_pose.hpp"
#include "retarget/keypoints/keypoint_track.hpp"

namespace understudy::render {

/// Which points of the body are drawn, each layout with colours of its own.
enum class PoseLayout {
  OpenPose18,  ///< what ControlNet's models know: no mid-hip, no feet
  Body25
};
constexpr Names<2> kPoseLayoutNames{"openpose18", "body25"};

struct PosePictureOptions {
  PoseLayout layout = PoseLayout::OpenPose18;
  bool hands = true, face = true;  ///< where the pose has them
  float half_width = 0;      ///< of the sticks and radius of the discs, pixels; 0: as the canvas's size asks
  bool wide_sticks = false;  ///< as xinsir's SDXL model was taught: 2 to 7 times as wide from 500 pixels on
};

/// 4 pixels up to 512 of the canvas's shorter side, in proportion above.
float usual_half_width(const Canvas& canvas);
/// How much wider the sticks, not the discs, of xinsir's pictures are.
int wide_stick_factor(const Canvas& canvas);

/// Sticks at 0.6 of their colour, above them discs at full colour; every pixel has one of these colours, no
/// edge is soft. What is missing is left out, a stick with either of its ends. Hands are lines of all hues
/// with blue dots, the face is white dots.
void draw_pose(Image& image, const FlatPose& pose, const PosePictureOptions& options = {});
/// All people of a frame on black. Throws Error where Image does.
Image pose_picture(const std::vector<FlatPose>& people, const Canvas& canvas,
                   const PosePictureOptions& options = {});

/// One stick and its colour before it is dimmed, 0..255; ends are points of BODY_25.
struct PoseStick {
  int from, to;
  uint8_t rgb[3];
};
/// One disc.
struct PoseDisc {
  int point;
  uint8_t rgb[3];
};
/// What a layout draws, in this order.
const std::vector<PoseStick>& pose_sticks(PoseLayout layout);
const std::vector<PoseDisc>& pose_discs(PoseLayout layout);
/// The stick's colour in a picture.
uint8_t dimmed(uint8_t value);

}  // namespace understudy::render
