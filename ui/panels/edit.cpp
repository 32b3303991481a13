// What the user changes: the scan, the skeleton, the result, the target. All of it can be undone.
// Sections: edit.scan, edit.skeleton, edit.result, edit.target, edit.weights. Marks: edit.crop,
// edit.crop_tool, edit.crop.LOW|HIGH.AXIS (edit.crop.low.x), edit.floor_removal, edit.floor_height,
// edit.cluster; edit.joints_tool, edit.falloff, edit.children, edit.swap.first, .last, .limbs, .apply,
// edit.skeleton.K (one made before), edit.skeleton_clear; edit.bones_tool, edit.bone_falloff, edit.pin,
// edit.smooth, edit.floor_offset, edit.heading, edit.trim, edit.trim_off, edit.skip, edit.rotation.K,
// edit.poses_clear; edit.target_tool, edit.mirror, edit.target_joints_clear; edit.paint_tool, edit.joint,
// edit.brush_radius, edit.brush_strength, edit.brush_mode, edit.weights_mirror.left, .right,
// edit.weights_smooth, edit.weights_clear.
#include <algorithm>
#include <cmath>

#include "ui/panels/bindings.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

struct EditState {
  int swap_first = -1, swap_last = -1;  ///< -1: the loop marks, or the frame shown
  int swap_limbs = 2;                   ///< arms, legs, both
};

std::string plural(size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

/// A button that takes a tool, lit while it is taken.
void tool_button(const app::Session& session, PanelContext& context, const std::string& name,
                 app::Tool tool) {
  for (const ToolChoice& choice : kTools) {
    if (choice.tool != tool) continue;
    const bool taken = session.tool == tool;
    ButtonOptions options;
    options.look = taken ? ButtonLook::Main : ButtonLook::Plain, options.width = -1;
    options.shortcut = keys_of(context.commands, "tool", {choice.argument});
    options.tooltip = taken ? "Back to looking around" : choice.label;
    options.disabled = !possible(session, "tool");
    if (button(context.ui, name, choice.label, options))
      context.ask("tool", {taken ? "look" : choice.argument});
  }
}

void clear_button(PanelContext& context, const std::string& name, const std::string& command, bool any,
                  const app::Arguments& arguments = {}) {
  ButtonOptions options;
  options.width = -1, options.disabled = !any, options.tooltip = "Clears these edits; can be undone";
  if (button(context.ui, name, "Clear", options)) context.ask(command, arguments);
}

void ask_for_crop(PanelContext& context, const Box& box) {
  app::Arguments arguments;
  for (const Vec3& corner : {box.low, box.high})
    for (int axis = 0; axis < 3; ++axis) arguments.push_back(argument(corner[axis]));
  context.ask("edit.crop", arguments);
}

void draw_crop(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const std::optional<Box>& crop = session.document.scan_edits.crop;
  if (const auto on =
          toggle_row(ui, {"edit.crop", "Crop", "Uses only the points inside a box"}, crop.has_value())) {
    if (*on)
      context.ask("edit.crop", {"on"});
    else
      context.ask("edit.crop", {"off"});
  }
  if (!crop) return;
  tool_button(session, context, "edit.crop_tool", app::Tool::Crop);
  const char* axes = "xyz";
  for (int axis = 0; axis < 3; ++axis) {
    Box box = *crop;
    row(ui, std::string(1, axes[axis]) + " from, to", "The box's sides, metres");
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    bool changed = false;
    for (const bool low : {true, false}) {
      const std::string name = std::string("edit.crop.") + (low ? "low." : "high.") + axes[axis];
      ImGui::BeginChild(name.c_str(), {std::max(1.f, half), ImGui::GetFrameHeight()});
      NumberOptions options{-50, 50, 0.01f, "%.2f m"};
      options.min = low ? -50 : box.low[axis] + 0.01f, options.max = low ? box.high[axis] - 0.01f : 50;
      changed |= number(ui, name, low ? box.low[axis] : box.high[axis], options);
      ImGui::EndChild();
      if (low) ImGui::SameLine();
    }
    if (changed) ask_for_crop(context, box);
  }
}

void draw_scan(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.scan", "Scan")) return;
  const DisabledScope disabled(!possible(session, "edit.crop"));
  draw_crop(session, context);
  const ScanEdits& edits = session.document.scan_edits;
  if (const auto on = toggle_row(
          ui, {"edit.floor_removal", "Remove floor", "Removes the points of the floor but keeps the soles"},
          edits.floor.has_value()))
    context.ask("edit.floor_removal", {on_off(*on)});
  if (edits.floor && !edits.floor->plane) {
    NumberOptions height{-5, 5, 0.002f, "%.3f m", 0, true};
    if (const auto h = number_row(ui, {"edit.floor_height", "Floor at", "Height of the floor to remove"},
                                  edits.floor->height_m, height))
      context.ask("edit.floor_removal", {"on", argument(*h)});
  }
  if (const auto on =
          toggle_row(ui, {"edit.cluster", "Largest part only", "Removes a second person or a prop"},
                     edits.largest_cluster))
    context.ask("edit.cluster", {on_off(*on)});
}

void draw_falloff(const app::Session& session, PanelContext& context, const std::string& name) {
  NumberOptions frames{0, 120, 0.1f, "\u00b1 %.0f frames", 5, true};
  if (const auto n =
          number_row(context.ui, {name, "Falloff", "How many frames to each side follow, less and less"},
                     static_cast<float>(session.falloff), frames))
    context.ask("tool.falloff", {argument(std::round(*n))});
}

std::string describe(const SkeletonEdit& edit) {
  if (const auto* drag = std::get_if<DragEdit>(&edit))
    return "Frame " + std::to_string(drag->frame) + ": " + joint_label(drag->joint) + ", " +
           figure(100 * drag->offset.norm(), "cm");
  const SwapEdit& swap = std::get<SwapEdit>(edit);
  const char* limbs[] = {"arms", "legs", "arms and legs"};
  return "Frames " + std::to_string(swap.first) + " to " + std::to_string(swap.last) + ": " +
         limbs[static_cast<int>(swap.limbs)] + " swapped";
}

int frame_of(const SkeletonEdit& edit) {
  const auto* drag = std::get_if<DragEdit>(&edit);
  return drag != nullptr ? drag->frame : std::get<SwapEdit>(edit).first;
}

/// A line for each of the newest 50 edits; a click shows its frame (-1: it has none).
void edit_line(PanelContext& context, const std::string& name, const std::string& words, int frame,
               const app::Arguments& removal) {
  Ui& ui = context.ui;
  const float side = ImGui::GetFrameHeight(), gap = ui.px(4);
  ButtonOptions options;
  options.look = ButtonLook::Quiet, options.tooltip = words + (frame < 0 ? "" : ". Click: go there");
  options.width = std::max(ui.px(40), ImGui::GetContentRegionAvail().x - side - gap) / ui.scale();
  if (button(ui, name, words, options) && frame >= 0) context.ask("playback.frame", {std::to_string(frame)});
  ImGui::SameLine(0, gap);
  if (icon_button(ui, name + ".remove", Icon::Close, {"Remove this edit", "", false, false, 26}))
    context.ask("edit.remove", removal);
}

void draw_swap(const app::Session& session, PanelContext& context) {
  auto& state = panel_state<EditState>(context);
  Ui& ui = context.ui;
  const app::FrameRange range = app::play_range(session.playback, app::frame_count(session));
  const bool marked = session.playback.in >= 0 || session.playback.out >= 0;
  const int shown = std::max(0, app::shown_frame(session));
  const int first = state.swap_first >= 0 ? state.swap_first : marked ? range.first : shown;
  const int last = std::max(first, state.swap_last >= 0 ? state.swap_last : marked ? range.last : shown);
  hint(ui, "Swap left and right in these frames:");
  if (const auto f = typed_number_row(
          ui, {"edit.swap.first", "From frame", "The loop's start unless you type one"}, first, 0))
    state.swap_first = static_cast<int>(std::max(0.0, *f));
  if (const auto f =
          typed_number_row(ui, {"edit.swap.last", "To frame", "The loop's end unless you type one"}, last, 0))
    state.swap_last = static_cast<int>(std::max(0.0, *f));
  row(ui, "Limbs");
  segmented(ui, "edit.swap.limbs", {"Arms", "Legs", "Both"}, state.swap_limbs);
  ButtonOptions options;
  options.width = -1;
  if (!button(ui, "edit.swap.apply", "Swap left and right", options)) return;
  context.ask("edit.swap", {std::to_string(first), std::to_string(last), kLimbNames[state.swap_limbs]});
  state.swap_first = state.swap_last = -1;
}

void draw_skeleton(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.skeleton", "Extracted skeleton")) return;
  const DisabledScope disabled(!possible(session, "edit.swap"));
  tool_button(session, context, "edit.joints_tool", app::Tool::Joints);
  draw_falloff(session, context, "edit.falloff");
  if (const auto on =
          toggle_row(ui, {"edit.children", "Whole limb", "The children of a dragged joint move with it"},
                     session.drag_children))
    context.ask("tool.children", {on_off(*on)});
  draw_swap(session, context);
  const auto& edits = session.document.skeleton_edits;
  for (size_t i = edits.size() > 50 ? edits.size() - 50 : 0; i < edits.size(); ++i)
    edit_line(context, "edit.skeleton." + std::to_string(i), describe(edits[i]), frame_of(edits[i]),
              {"skeleton", std::to_string(i)});
  clear_button(context, "edit.skeleton_clear", "edit.skeleton_clear", !edits.empty());
}

void draw_cost(const app::TakeState* state, Ui& ui) {
  if (state == nullptr || state->cost.max_displacement_m <= 0) return;
  const EditCost& cost = state->cost;
  hint(ui, "These edits change the acceleration from " + figure(cost.acceleration_before, "") + " to " +
               figure(cost.acceleration_after, "m/s\u00b2") + " and move joints by " +
               figure(100 * cost.mean_displacement_m, "cm") + ", " +
               figure(100 * cost.max_displacement_m, "cm") + " at most.");
}

void draw_amounts(const PoseEdits& edits, PanelContext& context, const std::string& k) {
  Ui& ui = context.ui;
  if (const auto on = toggle_row(ui, {"edit.pin", "Pin feet", "Keeps feet that stand on the floor in place"},
                                 edits.pin.has_value()))
    context.ask("edit.pin", {k, on_off(*on)});
  NumberOptions strength{0, 1, 0.005f, "%.2f", 0, true};
  if (const auto s = number_row(ui, {"edit.smooth", "Smooth", "0: not at all, 1: strongly"},
                                edits.smooth ? edits.smooth->strength : 0, strength))
    context.ask("edit.smooth", {k, argument(*s)});
  NumberOptions floor{-1, 1, 0.001f, "%.3f m", 0, true};
  if (const auto m = number_row(ui, {"edit.floor_offset", "Raise by", "Moves the whole motion up or down"},
                                edits.floor ? edits.floor->offset_m : 0, floor))
    context.ask("edit.floor_offset", {k, argument(*m)});
  NumberOptions heading{-180, 180, 0.5f, "%.1f\u00b0", 0, true};
  if (const auto deg =
          number_row(ui, {"edit.heading", "Turn by", "Turns the whole motion about the vertical axis"},
                     edits.heading ? edits.heading->yaw_deg : 0, heading))
    context.ask("edit.heading", {k, argument(*deg)});
}

void draw_trim(const app::Session& session, PanelContext& context, const PoseEdits& edits,
               const std::string& k) {
  Ui& ui = context.ui;
  const app::FrameRange range = app::play_range(session.playback, app::frame_count(session));
  ButtonRow buttons(2);
  ButtonOptions trim, off;
  const bool marked = session.playback.in >= 0 || session.playback.out >= 0;
  trim.disabled = !marked || range.empty();
  trim.tooltip =
      marked ? "Keeps only the frames between the loop marks" : "Set the loop marks first (In, Out)";
  if (buttons.add(ui, "edit.trim", "Trim to marks", trim))
    context.ask("edit.trim", {k, std::to_string(range.first), std::to_string(range.last)});
  off.disabled = !edits.trim;
  off.tooltip = edits.trim ? "Frames " + std::to_string(edits.trim->first) + " to " +
                                 std::to_string(edits.trim->last) + " are kept"
                           : "Nothing is trimmed";
  if (buttons.add(ui, "edit.trim_off", "Untrim", off)) context.ask("edit.trim", {k, "off"});
  const int frame = app::shown_frame(session);
  const DisabledScope disabled(frame < 0);
  if (const auto on = toggle_row(ui, {"edit.skip", "Skip this frame", "Playback and export leave it out"},
                                 edits.skip.count(frame) > 0))
    context.ask("edit.skip", {k, std::to_string(frame), on_off(*on)});
}

void draw_result(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.result", "Result")) return;
  const app::Take* take = selected_take(session);
  if (take == nullptr) return hint(ui, "Add a target first.");
  const PoseEdits& edits = take->pose_edits;
  const std::string k = std::to_string(session.selected_take);
  tool_button(session, context, "edit.bones_tool", app::Tool::Bones);
  draw_falloff(session, context, "edit.bone_falloff");
  draw_amounts(edits, context, k);
  draw_cost(selected_state(session), ui);
  draw_trim(session, context, edits, k);
  for (size_t i = edits.rotate.size() > 50 ? edits.rotate.size() - 50 : 0; i < edits.rotate.size(); ++i) {
    const RotateEdit& edit = edits.rotate[i];
    edit_line(context, "edit.rotation." + std::to_string(i),
              "Frame " + std::to_string(edit.frame) + ": " + joint_label(edit.joint) + ", " +
                  figure(edit.axis_angle.norm() * 180 / kPi, "\u00b0"),
              edit.frame, {"rotation", k, std::to_string(i)});
  }
  clear_button(context, "edit.poses_clear", "edit.poses_clear", !edits.empty(), {k});
}

void draw_target(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.target", "Joints of the target", false)) return;
  const app::Take* take = selected_take(session);
  if (take == nullptr) return hint(ui, "Add a target first.");
  tool_button(session, context, "edit.target_tool", app::Tool::TargetJoints);
  if (const auto on = toggle_row(ui, {"edit.mirror", "Both sides", "The joint on the other side follows"},
                                 session.mirror_joint))
    context.ask("tool.mirror", {on_off(*on)});
  const auto& moved = take->target_edits.joints;
  for (size_t i = 0; i < moved.size(); ++i)
    edit_line(context, "edit.moved." + std::to_string(i),
              joint_label(moved[i].joint) + (moved[i].mirror ? ", both sides" : ""), -1,
              {"joint", std::to_string(session.selected_take), std::to_string(i)});
  if (!moved.empty()) hint(ui, plural(moved.size(), "joint") + " moved by hand.");
  clear_button(context, "edit.target_joints_clear", "edit.target_joints_clear", !moved.empty(),
               {std::to_string(session.selected_take)});
}

void draw_brush(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  row(ui, "Joint", "The joint whose weights you paint");
  std::vector<std::string> joints;
  for (int j = 0; j < kJointCount; ++j) joints.push_back(joint_label(j));
  int joint = session.selected_joint;
  if (dropdown(ui, "edit.joint", joints, joint)) context.ask("select.joint", {joint_name(joint)});
  NumberOptions radius{0.005f, 0.5f, 0.0005f, "%.3f m"}, strength{0.01f, 1, 0.005f, "%.2f"};
  if (const auto r = number_row(ui, {"edit.brush_radius", "Radius", "Radius of the brush on the surface"},
                                session.brush.radius_m, radius))
    context.ask("tool.brush_radius", {argument(*r)});
  if (const auto s = number_row(ui, {"edit.brush_strength", "Strength", "Strength of one dab at its centre"},
                                session.brush.strength, strength))
    context.ask("tool.brush_strength", {argument(*s)});
  constexpr const char* kModes[] = {"add", "subtract", "smooth"};
  if (const auto i = choice_row(ui, {"edit.brush_mode", "Brush", "What a dab does"},
                                {"Add", "Take", "Smooth"}, static_cast<int>(session.brush.mode)))
    context.ask("tool.brush_mode", {kModes[*i]});
}

void draw_weights(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.weights", "Skin weights", false)) return;
  const app::Take* take = selected_take(session);
  if (take == nullptr) return hint(ui, "Add a target first.");
  const std::string k = std::to_string(session.selected_take);
  tool_button(session, context, "edit.paint_tool", app::Tool::Paint);
  draw_brush(session, context);
  ButtonRow buttons(2);
  ButtonOptions left, right, smooth;
  left.tooltip = "Makes the right side a mirror image of the left";
  right.tooltip = "Makes the left side a mirror image of the right";
  if (buttons.add(ui, "edit.weights_mirror.left", "Mirror left", left))
    context.ask("edit.weights_mirror", {k, "left"});
  if (buttons.add(ui, "edit.weights_mirror.right", "Mirror right", right))
    context.ask("edit.weights_mirror", {k, "right"});
  smooth.width = -1, smooth.tooltip = "Smooths the weights of the whole surface by the brush's strength";
  if (button(ui, "edit.weights_smooth", "Smooth all", smooth))
    context.ask("edit.weights_smooth", {k, argument(session.brush.strength)});
  const auto& weights = take->target_edits.weights;
  const bool painted = weights != nullptr && !weights->empty();
  if (painted) hint(ui, plural(weights->vertex.size(), "vertex weight") + " changed by hand.");
  clear_button(context, "edit.weights_clear", "edit.weights_clear", painted, {k});
}

}  // namespace

void draw_edit(const app::Session& session, PanelContext& context) {
  draw_scan(session, context);
  draw_skeleton(session, context);
  draw_result(session, context);
  draw_target(session, context);
  draw_weights(session, context);
}

}  // namespace understudy::ui
