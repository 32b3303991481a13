// What the user changes: the scan, the skeleton, the result, the target. All of it can be undone.
// Sections: edit.scan, edit.skeleton, edit.result, edit.target, edit.weights. Marks: edit.crop,
// edit.crop_tool, edit.crop.LOW|HIGH.AXIS (edit.crop.low.x), edit.floor_removal, edit.floor_height,
// edit.cluster; edit.joints_tool, edit.falloff, edit.children, edit.swap.first, .last, .limbs, .apply,
// edit.skeleton.K (one made before), edit.skeleton_clear; edit.bones_tool, edit.bone_falloff, edit.pin,
// edit.smooth, edit.floor_offset, edit.heading, edit.trim, edit.trim_off, edit.skip, edit.rotation.K,
// edit.poses_clear; edit.target_tool, edit.mirror, edit.target_joints_clear; edit.paint_tool, edit.joint,
// edit.brush_radius, edit.brush_strength, edit.brush_mode, edit.weights_mirror.left, .right,
// edit.weights_smooth, edit.weights_clear.
#pragma once

#include "ui/panels/panel.hpp"

namespace understudy::ui {

struct EditState {
  int swap_first = -1, swap_last = -1;  ///< -1: the loop marks, or the frame shown
  int swap_limbs = 2;                   ///< arms, legs, both
};

void draw_edit(const app::Session& session, PanelContext& context, EditState& state);

}  // namespace understudy::ui
