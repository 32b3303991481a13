// What the user changes: the scan, the skeleton, the result, the target. All of it can be undone.
// Sections: edit.scan, edit.people, edit.skeleton, edit.result, edit.target, edit.weights. Marks: edit.crop,
// edit.crop_tool, edit.crop.LOW|HIGH.AXIS (edit.crop.low.x), edit.floor_removal, edit.floor_height,
// edit.cluster; edit.people.first, .last, .person, .how, .other, .apply, edit.people.K (one made before),
// edit.people_clear; edit.joints_tool, edit.falloff, edit.children, edit.swap.first, .last, .limbs, .apply,
// edit.skeleton.K (one made before), edit.skeleton_clear; edit.bones_tool, edit.bone_falloff, edit.pin,
// edit.smooth, edit.raise, edit.turn, edit.trim, edit.trim_off, edit.skip, edit.fill, edit.filled.K,
// edit.fill_learned.K, edit.fill_variation.K (.0 to .3), edit.go_on, edit.gone_on, edit.go_on_learned,
// edit.go_on_variation, edit.loop, edit.looped, edit.loop_learned, edit.rotation.K, edit.poses_clear;
// edit.target_tool, edit.mirror, edit.target_joints_clear; edit.paint_tool, edit.joint, edit.brush_radius,
// edit.brush_strength, edit.brush_mode, edit.weights_mirror.left, .right, edit.weights_smooth,
// edit.weights_clear.
#include <algorithm>
#include <cmath>

#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/editing/limb_move.hpp"
#include "retarget/skeleton/made_frames.hpp"
#include "ui/panels/bindings.hpp"
#include "ui/panels/panels.hpp"
#include "ui/panels/rows.hpp"

namespace understudy::ui {
namespace {

/// Frames as typed; -1: the loop marks, or the frame shown.
struct TypedRange {
  int first = -1, last = -1;
};
struct EditState {
  TypedRange swap, people;
  int swap_limbs = 2;         ///< arms, legs, both
  int person = 1, other = 0;  ///< numbers of people; the other 0: somebody new
  int correction = 0;         ///< of kPersonEditNames
};

std::string plural(size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

/// `command`: also the button's name. `take`: its argument, where it has one.
void clear_button(PanelContext& context, const std::string& command, bool any, const std::string& take = {}) {
  ask_button(context, {command, "Clear", "Clears these edits; can be undone", command + " " + take}, any);
}

void draw_crop(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  const std::optional<Box>& crop = session.document.scan_edits.crop;
  ask_toggle(context,
             {"edit.crop", "Crop", "Shows a box around everything; what you leave outside is not used"},
             crop.has_value());
  if (!crop) return;
  tool_button(session, context, {"edit.crop_tool"}, app::Tool::Crop);
  hint(ui, "Drag the box's handles in the view, or its numbers here.");
  const Box box = app::shown_crop(session);
  for (int axis = 0; axis < 3; ++axis) {
    row(ui, std::string(1, "xyz"[axis]) + " from, to", "Where the box begins and ends, in metres");
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    for (int side = 2 * axis; side <= 2 * axis + 1; ++side) {
      const std::string name = std::string("edit.crop.") + kBoxSides[side];
      const bool low = side % 2 == 0;
      ImGui::BeginChild(name.c_str(), {std::max(1.f, half), ImGui::GetFrameHeight()});
      NumberOptions options{-1000, 1000, 0.01f, "%.2f m"};
      (low ? options.max : options.min) = low ? box.high[axis] - 0.01f : box.low[axis] + 0.01f;
      float value = box.side(side);
      if (number(ui, name, value, options)) context.ask("edit.crop", {kBoxSides[side], argument(value)});
      ImGui::EndChild();
      if (low) ImGui::SameLine();
    }
  }
}

void draw_scan(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.scan", "Scan")) return;
  const DisabledScope disabled(!possible(session, "edit.crop"));
  draw_crop(session, context);
  const ScanEdits& edits = session.document.scan_edits;
  ask_toggle(context,
             {"edit.floor_removal", "Remove floor", "Removes the points of the floor but keeps the soles"},
             edits.floor.has_value());
  if (edits.floor && !edits.floor->plane)
    ask_number(context,
               {"edit.floor_height", "Floor at", "Height of the floor to remove", "edit.floor_removal on"},
               edits.floor->height_m, {-5, 5, 0.002f, "%.3f m", 0, true});
  ask_toggle(context, {"edit.cluster", "Largest part only", "Removes a second person or a prop"},
             edits.largest_cluster);
}

void draw_falloff(const app::Session& session, PanelContext& context, const std::string& name) {
  float frames = static_cast<float>(session.falloff);
  row(context.ui, "Falloff", "How many frames before and after an edit follow it, less and less");
  if (number(context.ui, name, frames, {0, 120, 0.1f, "\u00b1 %.0f frames", 5, true}))
    context.ask("tool.falloff", {argument(std::round(frames))});
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

/// Rows NAME.first and NAME.last. `last`: where neither marks nor the user say so.
app::FrameRange range_rows(const app::Session& session, PanelContext& context, const std::string& name,
                           TypedRange& typed, int last_frame) {
  const app::FrameRange range = app::play_range(session.playback, app::frame_count(session));
  const bool marked = session.playback.in >= 0 || session.playback.out >= 0;
  const int shown = std::max(0, app::shown_frame(session));
  const int first = typed.first >= 0 ? typed.first : marked ? range.first : shown;
  const int last = std::max(first, typed.last >= 0 ? typed.last : marked ? range.last : last_frame);
  if (const auto f = typed_number_row(
          context.ui, {name + ".first", "From frame", "The loop's start unless you type one"}, first, 0))
    typed.first = static_cast<int>(std::max(0.0, *f));
  if (const auto f = typed_number_row(
          context.ui, {name + ".last", "To frame", "The loop's end unless you type one"}, last, 0))
    typed.last = static_cast<int>(std::max(0.0, *f));
  return {first, last};
}

void draw_swap(const app::Session& session, PanelContext& context) {
  auto& state = panel_state<EditState>(context);
  Ui& ui = context.ui;
  hint(ui, "Swap left and right in these frames:");
  const app::FrameRange frames =
      range_rows(session, context, "edit.swap", state.swap, std::max(0, app::shown_frame(session)));
  row(ui, "Limbs");
  segmented(ui, "edit.swap.limbs", {"Arms", "Legs", "Both"}, state.swap_limbs);
  ButtonOptions options;
  options.width = -1;
  if (!button(ui, "edit.swap.apply", "Swap left and right", options)) return;
  context.ask("edit.swap",
              {std::to_string(frames.first), std::to_string(frames.last), kLimbNames[state.swap_limbs]});
  state.swap = {};
}

/// One of the people seen, by number, or somebody new (0).
void person_row(const app::Session& session, PanelContext& context, const Control& control, bool or_new,
                int& number) {
  std::vector<std::string> labels;
  std::vector<int> numbers;
  for (const app::PersonSeen& one : session.source.people)
    labels.push_back("Person " + std::to_string(one.id)), numbers.push_back(one.id);
  if (or_new) labels.emplace_back("Somebody new"), numbers.push_back(0);
  auto at = std::find(numbers.begin(), numbers.end(), number);
  if (at == numbers.end()) at = numbers.begin();
  int chosen = static_cast<int>(at - numbers.begin());
  row(context.ui, control.label, control.explanation);
  dropdown(context.ui, control.name, labels, chosen);
  number = numbers[static_cast<size_t>(chosen)];
}

/// A number that nobody has.
int new_person(const app::Session& session) {
  int most = 0;
  for (const app::PersonSeen& one : session.source.people) most = std::max(most, one.id);
  for (const PersonEdit& edit : session.document.source.people)
    most = std::max({most, edit.person, edit.other});
  return most + 1;
}

void draw_people_correction(const app::Session& session, PanelContext& context) {
  auto& state = panel_state<EditState>(context);
  Ui& ui = context.ui;
  hint(ui, "Where one person was taken for another, in these frames:");
  const int end = std::max(0, static_cast<int>(session.source.frames.size()) - 1);
  const app::FrameRange frames = range_rows(session, context, "edit.people", state.people, end);
  person_row(session, context, {"edit.people.person", "Person", "Who was taken for another"}, false,
             state.person);
  row(ui, "Correction", "Exchanged: each is the other. One: what is the other's is the person's, too");
  segmented(ui, "edit.people.how", {"Exchanged", "One"}, state.correction);
  person_row(session, context, {"edit.people.other", "With", "Somebody new: the person is split off"},
             state.correction == 0, state.other);
  const bool same = state.person == state.other;
  ButtonOptions options;
  options.width = -1, options.disabled = same;
  if (!button(ui, "edit.people.apply", "Correct", options)) return;
  const int other = state.other > 0 ? state.other : new_person(session);
  context.ask("edit.people",
              {std::to_string(frames.first), std::to_string(frames.last), std::to_string(state.person),
               std::to_string(other), kPersonEditNames[static_cast<size_t>(state.correction)]});
  state.people = {};
}

std::string describe(const PersonEdit& edit) {
  const std::string person = std::to_string(edit.person), other = std::to_string(edit.other);
  return printed("Frames %d to %d: ", edit.first, edit.last) +
         (edit.how == PersonEdit::How::Join ? other + " is " + person
                                            : person + " and " + other + " exchanged");
}

/// Only where there is more than one, or was before it was put right.
void draw_person_edits(const app::Session& session, PanelContext& context) {
  const auto& edits = session.document.source.people;
  if (session.source.people.size() < 2 && edits.empty()) return;
  if (!section(context.ui, "edit.people", "People")) return;
  if (!session.source.people.empty()) draw_people_correction(session, context);
  for (size_t i = edits.size() > 50 ? edits.size() - 50 : 0; i < edits.size(); ++i)
    edit_line(context, "edit.people." + std::to_string(i), describe(edits[i]), edits[i].first,
              {"people", std::to_string(i)});
  clear_button(context, "edit.people_clear", !edits.empty());
}

void draw_skeleton(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.skeleton", "Extracted skeleton")) return;
  const DisabledScope disabled(!possible(session, "edit.swap"));
  tool_button(session, context, {"edit.joints_tool"}, app::Tool::Joints);
  draw_falloff(session, context, "edit.falloff");
  ask_toggle(context,
             {"edit.children", "Whole limb", "The children of a dragged joint move with it", "tool.children"},
             session.drag_children);
  draw_swap(session, context);
  const auto& edits = session.document.skeleton_edits;
  for (size_t i = edits.size() > 50 ? edits.size() - 50 : 0; i < edits.size(); ++i)
    edit_line(context, "edit.skeleton." + std::to_string(i), describe(edits[i]), frame_of(edits[i]),
              {"skeleton", std::to_string(i)});
  clear_button(context, "edit.skeleton_clear", !edits.empty());
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
  ask_toggle(context,
             {"edit.pin", "Pin feet", "Keeps feet that stand on the floor in place", "edit.pin " + k},
             edits.pin.has_value());
  ask_number(
      context,
      {"edit.smooth", "Smooth",
       "Smooths out jitter: 0 changes nothing, 1 averages over about 0.2 s to each side", "edit.smooth " + k},
      edits.smooth ? edits.smooth->strength : 0, {0, 1, 0.005f, "%.2f", 0, true});
  ask_number(
      context,
      {"edit.raise", "Raise by",
       "Moves the whole motion up by this many metres; negative values move it down", "edit.raise " + k},
      edits.raise ? edits.raise->offset_m : 0, {-1, 1, 0.001f, "%.3f m", 0, true});
  ask_number(context,
             {"edit.turn", "Turn by", "Turns the whole motion about the vertical axis by this many degrees",
              "edit.turn " + k},
             edits.turn ? edits.turn->turn_deg : 0, {-180, 180, 0.5f, "%.1f\u00b0", 0, true});
}

void draw_trim(const app::Session& session, PanelContext& context, const PoseEdits& edits,
               const std::string& k) {
  const app::FrameRange range = app::play_range(session.playback, app::frame_count(session));
  ButtonRow buttons(2);
  const bool marked = session.playback.in >= 0 || session.playback.out >= 0;
  const char* const tip =
      marked ? "Keeps only the frames between the loop marks" : "Set the loop marks first (In, Out)";
  const std::string frames = std::to_string(range.first) + " " + std::to_string(range.last);
  buttons.ask(context, {"edit.trim", "Trim to marks", tip, "edit.trim " + k + " " + frames},
              marked && !range.empty());
  const std::string kept = edits.trim
                               ? printed("Frames %d to %d are kept", edits.trim->first, edits.trim->last)
                               : "Nothing is trimmed";
  buttons.ask(context, {"edit.trim_off", "Untrim", kept, "edit.trim " + k + " off"}, edits.trim.has_value());
  const int frame = app::shown_frame(session);
  const DisabledScope disabled(frame < 0);
  ask_toggle(context,
             {"edit.skip", "Skip this frame", "Playback and export leave it out",
              "edit.skip " + k + " " + std::to_string(frame)},
             edits.skip.count(frame) > 0);
}

/// "Frames 41 to 47 filled, ± 3 cm".
std::string describe(const FillEdit& fill, float doubt_m) {
  const std::string frames = fill.first == fill.last ? printed("Frame %d", fill.first)
                                                     : printed("Frames %d to %d", fill.first, fill.last);
  return frames + " filled" + (doubt_m > 0 ? ", " + doubt_text(doubt_m) : "");
}

/// Which of the motion space's answers is taken: they are numbered from 1 here.
void ask_alternative(PanelContext& context, const std::string& name, const std::string& command,
                     int variation) {
  std::vector<std::string> labels, words, tips;
  for (int i = 0; i < kMostVariations; ++i) {
    labels.push_back(std::to_string(i + 1)), words.push_back(std::to_string(i));
    tips.push_back(i == 0 ? "The best answer" : "Another that is plausible, too");
  }
  Control control{name, "Alternative", "Which of the motion space's answers is taken", command};
  control.tips = tips;
  ask_choice(context, control, labels, words, words[static_cast<size_t>(variation)]);
}

void draw_fill(const app::Session& session, PanelContext& context, size_t i) {
  const FillEdit& fill = selected_take(session)->pose_edits.fill[i];
  const std::vector<float>& doubt_m = selected_state(session)->shown.doubt_m;
  const std::string k = std::to_string(session.selected_take), number = std::to_string(i);
  edit_line(context, "edit.filled." + number, describe(fill, largest_doubt(doubt_m, fill.first, fill.last)),
            fill.first, {"fill", k, number});
  ask_number(context,
             {"edit.fill_learned." + number, "Plain - learned",
              "0: the smooth curve through the frames beside; 1: what the motion space has learned of people",
              "edit.fill_learned " + k + " " + number},
             fill.learned, {0, 1, 0.01f, "%.2f", 1, true});
  ask_alternative(context, "edit.fill_variation." + number, "edit.fill_variation " + k + " " + number,
                  fill.variation);
}

void draw_fills(const app::Session& session, PanelContext& context) {
  ButtonOptions options;
  options.width = -1, options.shortcut = keys_of(context.commands, "edit.fill");
  options.tooltip =
      "Makes frames anew from those around them: between the loop marks, else the unusable frames here, else "
      "all unusable ones";
  if (button(context.ui, "edit.fill", "Fill frames", options))
    context.ask("edit.fill", {std::to_string(session.selected_take)});
  for (size_t i = 0; i < selected_take(session)->pose_edits.fill.size(); ++i) draw_fill(session, context, i);
}

struct ListedMade {
  std::string words;
  int frame = 0;
  float learned = 1;
  std::string learned_command;
  app::Arguments removal;  ///< the take is the second
};

/// A line for what was made, and how much of it is learned.
void draw_made(PanelContext& context, const std::string& name, const ListedMade& made) {
  edit_line(context, name, made.words, made.frame, made.removal);
  ask_number(context,
             {made.learned_command, "Plain - learned",
              "0: the smooth curve through the frames beside; 1: what the motion space has learned of people",
              made.learned_command + " " + made.removal[1]},
             made.learned, {0, 1, 0.01f, "%.2f", 1, true});
}

/// "Goes on for 1.5 s, ± 12 cm".
void draw_go_on(const app::Session& session, PanelContext& context) {
  const auto& edit = selected_take(session)->pose_edits.go_on;
  const std::string k = std::to_string(session.selected_take);
  ask_button(context,
             {"edit.go_on", edit ? "Go on, 1 s longer" : "Go on, 1 s",
              "Continues beyond the last captured frame: a prediction, told as such wherever it goes",
              "edit.go_on"});
  if (!edit) return;
  const app::TakeState& state = *selected_state(session);
  const int first = static_cast<int>(state.performed.size());
  const std::string doubt = doubt_text(largest_doubt(state.shown.doubt_m, first, ssize(state.shown.poses)));
  draw_made(context, "edit.gone_on",
            {printed("Goes on for %.3g s", static_cast<double>(edit->seconds)) +
                 (doubt.empty() ? "" : ", " + doubt),
             first,
             edit->learned,
             "edit.go_on_learned",
             {"go_on", k}});
  ask_alternative(context, "edit.go_on_variation", "edit.go_on_variation " + k, edit->variation);
}

void draw_loop_edit(const app::Session& session, PanelContext& context) {
  const auto& edit = selected_take(session)->pose_edits.loop;
  const std::string k = std::to_string(session.selected_take);
  ask_button(
      context,
      {"edit.loop", edit ? "Look for another loop" : "Make a loop",
       "Keeps what lies between the two most alike moments, of the frames between the loop marks or of "
       "all, and makes the seam between them anew",
       "edit.loop"});
  if (!edit) return;
  draw_made(context, "edit.looped",
            {printed("Frames %d to %d loop", edit->first, edit->last),
             edit->first,
             edit->learned,
             "edit.loop_learned",
             {"loop", k}});
}

struct ListedEdit {
  size_t first = 0;  ///< among the rotations
  std::string words;
  int frame = 0;
  app::Arguments removal;
};

/// A bone that was turned, or a hand or a foot that was moved with all that this turned.
std::vector<ListedEdit> listed_rotations(const std::vector<RotateEdit>& edits, const std::string& take) {
  std::vector<ListedEdit> listed;
  for (size_t i = 0; i < edits.size(); ++i) {
    const RotateEdit& edit = edits[i];
    const auto of_same_move = [&](const RotateEdit& other) {
      return edit.limb && other.limb == edit.limb && other.frame == edit.frame;
    };
    const auto end = edits.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(edits.begin(), end, of_same_move)) continue;
    const std::string number = std::to_string(edit.frame), frame = "Frame " + number + ": ";
    if (edit.limb)
      listed.push_back({i,
                        frame + limb_end_label(*edit.limb) + " moved",
                        edit.frame,
                        {"limb", take, number, joint_name(*edit.limb)}});
    else
      listed.push_back(
          {i,
           frame + joint_label(edit.joint) + ", " + figure(edit.axis_angle.norm() * 180 / kPi, "\u00b0"),
           edit.frame,
           {"rotation", take, std::to_string(i)}});
  }
  return listed;
}

void draw_result(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.result", take_title(session, "Result"))) return;
  const app::Take* take = selected_take(session);
  if (take == nullptr) return hint(ui, "Add a target first.");
  const PoseEdits& edits = take->pose_edits;
  const std::string k = std::to_string(session.selected_take);
  tool_button(session, context, {"edit.bones_tool"}, app::Tool::Bones);
  draw_falloff(session, context, "edit.bone_falloff");
  draw_amounts(edits, context, k);
  draw_cost(selected_state(session), ui);
  draw_trim(session, context, edits, k);
  draw_fills(session, context);
  draw_go_on(session, context);
  draw_loop_edit(session, context);
  const std::vector<ListedEdit> listed = listed_rotations(edits.rotate, k);
  for (size_t i = listed.size() > 50 ? listed.size() - 50 : 0; i < listed.size(); ++i)
    edit_line(context, "edit.rotation." + std::to_string(listed[i].first), listed[i].words, listed[i].frame,
              listed[i].removal);
  clear_button(context, "edit.poses_clear", !edits.empty(), k);
}

void draw_target(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.target", take_title(session, "Joints of the target"), false)) return;
  const app::Take* take = selected_take(session);
  if (take == nullptr) return hint(ui, "Add a target first.");
  tool_button(session, context, {"edit.target_tool"}, app::Tool::TargetJoints);
  ask_toggle(context, {"edit.mirror", "Both sides", "The joint on the other side follows", "tool.mirror"},
             session.mirror_joint);
  const auto& moved = take->target_edits.joints;
  for (size_t i = 0; i < moved.size(); ++i)
    edit_line(context, "edit.moved." + std::to_string(i),
              joint_label(moved[i].joint) + (moved[i].mirror ? ", both sides" : ""), -1,
              {"joint", std::to_string(session.selected_take), std::to_string(i)});
  if (!moved.empty()) hint(ui, plural(moved.size(), "joint") + " moved by hand.");
  clear_button(context, "edit.target_joints_clear", !moved.empty(), std::to_string(session.selected_take));
}

void draw_brush(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  row(ui, "Joint", "The joint whose weights you paint");
  int joint = session.selected_joint;
  if (dropdown(ui, "edit.joint", joint_labels(), joint)) context.ask("select.joint", {joint_name(joint)});
  brush_rows(session, context, "edit");
}

void draw_weights(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.weights", take_title(session, "Skin weights"), false)) return;
  const app::Take* take = selected_take(session);
  if (take == nullptr) return hint(ui, "Add a target first.");
  const std::string k = std::to_string(session.selected_take);
  tool_button(session, context, {"edit.paint_tool"}, app::Tool::Paint);
  draw_brush(session, context);
  ButtonRow buttons(2);
  for (const std::string from : {"left", "right"}) {
    const std::string to = from == "left" ? "right" : "left";
    const std::string tip = "Makes the " + to + " side a mirror image of the " + from;
    buttons.ask(context, {"edit.weights_mirror." + from, "Mirror " + from, tip,
                          "edit.weights_mirror " + k + " " + from});
  }
  ask_button(context, {"edit.weights_smooth", "Smooth all",
                       "Smooths the weights of the whole surface by the brush's strength",
                       "edit.weights_smooth " + k + " " + argument(session.brush.strength)});
  const auto& weights = take->target_edits.weights;
  const bool painted = weights != nullptr && !weights->empty();
  if (painted) hint(ui, plural(weights->vertex.size(), "vertex weight") + " changed by hand.");
  clear_button(context, "edit.weights_clear", painted, k);
}

/// Of pose pictures.
void draw_face(const app::Session& session, PanelContext& context) {
  Ui& ui = context.ui;
  if (!section(ui, "edit.face", take_title(session, "Marks of the face"), false)) return;
  const app::Take* take = selected_take(session);
  if (take == nullptr || take->flat) return hint(ui, "Add a target with a head first.");
  const std::string k = std::to_string(session.selected_take);
  tool_button(session, context,
              {"edit.face_tool", "", "Where pose pictures have nose, eyes and ears of this target"},
              app::Tool::Face);
  ask_toggle(context,
             {"edit.face_mirror", "Both sides",
              "The mark on the other side follows; the nose stays in the middle", "tool.mirror"},
             session.mirror_joint);
  const auto& face = take->target_edits.face;
  for (size_t i = 0; i < face.size(); ++i)
    edit_line(context, "edit.face." + std::to_string(i), face_mark_label(face[i].mark), -1,
              {"face", k, std::to_string(i)});
  if (face.empty()) hint(ui, "Found on the head's surface; drag what lies wrong.");
  clear_button(context, "edit.face_clear", !face.empty(), k);
}

}  // namespace

void draw_edit(const app::Session& session, PanelContext& context) {
  draw_scan(session, context);
  draw_person_edits(session, context);
  draw_skeleton(session, context);
  draw_result(session, context);
  draw_target(session, context);
  draw_weights(session, context);
  draw_face(session, context);
}

}  // namespace understudy::ui
