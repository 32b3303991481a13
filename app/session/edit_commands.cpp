#include <algorithm>

#include "app/session/command_sets.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"

namespace understudy::app {
namespace {

int frame_argument(const Session& session, const Arguments& a, size_t i) {
  const int frame = whole_number(a, i, "frame");
  const int count = std::max<int>(frame_count(session), session.source.frames.size());
  US_CHECK(frame >= 0 && frame < count, "there is no frame ", frame, " among ", count);
  return frame;
}

int falloff_argument(const Session& session, const Arguments& a, size_t i) {
  const bool given = i < a.size() && a[i] != "children";
  const int falloff = given ? whole_number(a, i, "falloff") : session.falloff;
  US_CHECK(falloff >= 0 && falloff <= 10000, "a falloff is 0 to 10000 frames, not ", falloff);
  return falloff;
}

void add_scan_edits(Commands& commands) {
  commands.add({"edit.crop", "Crop the scan", "LOW HIGH (six numbers, metres) | on: around the person | off",
                "", true, true, [](Studio& s, const Arguments& a) {
                  auto& crop = s.session().document.scan_edits.crop;
                  if (word(a, 0, "box") == "off") return crop.reset();
                  if (a[0] == "on") {
                    if (!crop) crop = person_box(s.session()).value_or(Box{{-1, -0.1f, -1}, {1, 2.2f, 1}});
                    return;
                  }
                  const Box box{vector_argument(a, 0, "corner"), vector_argument(a, 3, "corner")};
                  US_CHECK((box.high - box.low).minCoeff() > 0, "the crop box has no inside");
                  crop = box;
                }});
  commands.add({"edit.floor_removal", "Remove the floor", "on|off [HEIGHT]", "", true, true,
                [](Studio& s, const Arguments& a) {
                  auto& floor = s.session().document.scan_edits.floor;
                  floor.reset();
                  if (!on_off(a, 0)) return;
                  floor = FloorCut{};
                  if (a.size() > 1) floor->height_m = static_cast<float>(number(a, 1, "height"));
                }});
  commands.add(
      {"edit.cluster", "Largest cluster only", "on|off", "", true, false, [](Studio& s, const Arguments& a) {
         s.session().document.scan_edits.largest_cluster = on_off(a, 0);
       }});
}

void add_skeleton_edits(Commands& commands) {
  commands.add({"edit.drag", "Drag a joint", "FRAME JOINT X Y Z [FALLOFF] [children]: metres", "", true,
                false, [](Studio& s, const Arguments& a) {
                  Session& session = s.session();
                  DragEdit edit;
                  edit.frame = frame_argument(session, a, 0);
                  edit.joint = joint_argument(a, 1);
                  edit.offset = vector_argument(a, 2, "way");
                  edit.falloff = falloff_argument(session, a, 5);
                  edit.with_children = has_word(a, 5, "children");
                  session.document.skeleton_edits.push_back(edit);
                }});
  commands.add({"edit.swap", "Swap left and right", "FIRST LAST arms|legs|both", "", true, false,
                [](Studio& s, const Arguments& a) {
                  SwapEdit edit;
                  edit.first = frame_argument(s.session(), a, 0);
                  edit.last = frame_argument(s.session(), a, 1);
                  US_CHECK(edit.first <= edit.last, "the last frame comes before the first");
                  edit.limbs = static_cast<SwapEdit::Limbs>(choice(a, 2, "limbs", kLimbNames));
                  s.session().document.skeleton_edits.push_back(edit);
                }});
  commands.add({"edit.skeleton_clear", "Clear the skeleton's edits", "", "", true, false,
                [](Studio& s, const Arguments&) { s.session().document.skeleton_edits.clear(); }});
}

PoseEdits& pose_edits(Studio& studio, const Arguments& a) {
  return take_argument(studio.session(), a, 0).pose_edits;
}

void add_pose_edits(Commands& commands) {
  commands.add({"edit.rotate", "Rotate a bone", "TAKE FRAME JOINT X Y Z [FALLOFF]: axis times radians", "",
                true, false, [](Studio& s, const Arguments& a) {
                  RotateEdit edit;
                  edit.frame = frame_argument(s.session(), a, 1);
                  edit.joint = joint_argument(a, 2);
                  edit.axis_angle = vector_argument(a, 3, "rotation");
                  edit.falloff = falloff_argument(s.session(), a, 6);
                  pose_edits(s, a).rotate.push_back(edit);
                }});
  commands.add(
      {"edit.pin", "Pin the feet", "TAKE on|off", "", true, false, [](Studio& s, const Arguments& a) {
         auto& pin = pose_edits(s, a).pin;
         pin.reset();
         if (on_off(a, 1)) pin = PinEdit{};
       }});
  commands.add(
      {"edit.smooth", "Smooth", "TAKE STRENGTH: 0 to 1", "", true, true, [](Studio& s, const Arguments& a) {
         const float strength = std::clamp(static_cast<float>(number(a, 1, "strength")), 0.f, 1.f);
         auto& smooth = pose_edits(s, a).smooth;
         smooth.reset();
         if (strength > 0) smooth = SmoothEdit{strength};
       }});
  commands.add({"edit.floor_offset", "Move up or down", "TAKE METRES", "", true, true,
                [](Studio& s, const Arguments& a) {
                  const float offset = static_cast<float>(number(a, 1, "height"));
                  auto& floor = pose_edits(s, a).floor;
                  floor.reset();
                  if (offset != 0) floor = FloorEdit{offset};
                }});
  commands.add({"edit.heading", "Heading", "TAKE DEGREES", "", true, true, [](Studio& s, const Arguments& a) {
                  const float yaw = static_cast<float>(number(a, 1, "angle"));
                  auto& heading = pose_edits(s, a).heading;
                  heading.reset();
                  if (yaw != 0) heading = HeadingEdit{yaw};
                }});
}

template <class Edit>
void remove_at(std::vector<Edit>& edits, const Arguments& a, size_t i) {
  const int index = whole_number(a, i, "edit");
  US_CHECK(index >= 0 && index < ssize(edits), "there is no edit ", index, " among ", edits.size());
  edits.erase(edits.begin() + index);
}

void add_removal(Commands& commands) {
  commands.add({"edit.remove", "Remove an edit", "skeleton INDEX | rotation TAKE INDEX | joint TAKE INDEX",
                "", true, false, [](Studio& s, const Arguments& a) {
                  Session& session = s.session();
                  const size_t kind = choice(a, 0, "kind", {"skeleton", "rotation", "joint"});
                  if (kind == 0) return remove_at(session.document.skeleton_edits, a, 1);
                  Take& take = take_argument(session, a, 1);
                  if (kind == 1) return remove_at(take.pose_edits.rotate, a, 2);
                  remove_at(take.target_edits.joints, a, 2);
                }});
}

void add_pose_ranges(Commands& commands) {
  commands.add(
      {"edit.trim", "Trim", "TAKE FIRST LAST | TAKE off", "", true, true, [](Studio& s, const Arguments& a) {
         auto& trim = pose_edits(s, a).trim;
         if (word(a, 1, "frame") == "off") {
           trim.reset();
           return;
         }
         const Trim wanted{frame_argument(s.session(), a, 1), frame_argument(s.session(), a, 2)};
         US_CHECK(wanted.first <= wanted.last, "the last frame comes before the first");
         trim = wanted;
       }});
  commands.add(
      {"edit.skip", "Skip a frame", "TAKE FRAME on|off", "", true, false, [](Studio& s, const Arguments& a) {
         const int frame = frame_argument(s.session(), a, 1);
         if (on_off(a, 2))
           pose_edits(s, a).skip.insert(frame);
         else
           pose_edits(s, a).skip.erase(frame);
       }});
  commands.add({"edit.poses_clear", "Clear the result's edits", "TAKE", "", true, false,
                [](Studio& s, const Arguments& a) { pose_edits(s, a) = PoseEdits{}; }});
}

/// The take's edited weights, as far as they are known.
struct Painting {
  Take& take;
  const TakeState& state;
};

Painting painting(Studio& studio, const Arguments& a) {
  Take& take = take_argument(studio.session(), a, 0);
  const TakeState& state = studio.session().takes[whole_number(a, 0, "take")];
  US_CHECK(state.target && state.weights, "the target is still being prepared");
  US_CHECK(state.paint_problem.empty(), state.paint_problem);
  return {take, state};
}

void keep(Painting& painting, const WeightRows& changed) {
  auto& weights = painting.take.target_edits.weights;
  weights = std::make_shared<const WeightRows>(
      placed(weights ? merged(*weights, changed) : changed, painting.state.target->mesh.vertices));
}

void add_target_edits(Commands& commands) {
  commands.add({"edit.target_joint", "Move a joint of the target", "TAKE JOINT X Y Z [mirror]: metres", "",
                true, false, [](Studio& s, const Arguments& a) {
                  Take& take = take_argument(s.session(), a, 0);
                  JointMove move;
                  move.joint = joint_argument(a, 1);
                  move.position = vector_argument(a, 2, "place");
                  move.mirror = has_word(a, 5, "mirror");
                  auto& moves = take.target_edits.joints;
                  moves.erase(std::remove_if(moves.begin(), moves.end(),
                                             [&](const JointMove& old) { return old.joint == move.joint; }),
                              moves.end());
                  moves.push_back(move);
                }});
  commands.add(
      {"edit.target_joints_clear", "Reset the target's joints", "TAKE", "", true, false,
       [](Studio& s, const Arguments& a) { take_argument(s.session(), a, 0).target_edits.joints.clear(); }});
  commands.add({"edit.paint", "Paint weights", "TAKE X Y Z: a place on the T-pose's surface", "", true, true,
                [](Studio& s, const Arguments& a) {
                  Painting p = painting(s, a);
                  Brush brush = s.session().brush;
                  US_CHECK(brush.mode == Brush::Mode::Smooth || s.session().selected_joint >= 0,
                           "choose the joint to paint first");
                  brush.joint = std::max(0, s.session().selected_joint);
                  const Neighbours& neighbours = s.neighbours(whole_number(a, 0, "take"));
                  keep(p, stroke(*p.state.weights, {p.state.target->mesh.vertices, neighbours},
                                 vector_argument(a, 1, "place"), brush));
                }});
}

void add_weight_tools(Commands& commands) {
  commands.add(
      {"edit.weights_mirror", "Mirror weights", "TAKE left|right: the side that is copied", "", true, false,
       [](Studio& s, const Arguments& a) {
         Painting p = painting(s, a);
         const auto side = choice(a, 1, "side", {"left", "right"}) == 0 ? BodySide::Left : BodySide::Right;
         keep(p, mirrored_weights(*p.state.weights, p.state.target->mesh.vertices, side,
                                  symmetry_centre(p.state.target->joints)));
       }});
  commands.add({"edit.weights_smooth", "Smooth weights", "TAKE STRENGTH: 0 to 1", "", true, false,
                [](Studio& s, const Arguments& a) {
                  Painting p = painting(s, a);
                  const float strength = std::clamp(static_cast<float>(number(a, 1, "strength")), 0.f, 1.f);
                  keep(p, smoothed(*p.state.weights, s.neighbours(whole_number(a, 0, "take")), {}, strength));
                }});
  commands.add(
      {"edit.weights_reproject", "Bring painted weights to the target as it is now", "TAKE", "", true, false,
       [](Studio& s, const Arguments& a) {
         auto& weights = take_argument(s.session(), a, 0).target_edits.weights;
         const auto& target = s.session().takes[static_cast<size_t>(whole_number(a, 0, "take"))].target;
         US_CHECK(weights && target, "there are no painted weights, or the target is still being prepared");
         weights = std::make_shared<const WeightRows>(reprojected(*weights, target->mesh.vertices));
       }});
  commands.add(
      {"edit.weights_clear", "Clear painted weights", "TAKE", "", true, false,
       [](Studio& s, const Arguments& a) { take_argument(s.session(), a, 0).target_edits.weights.reset(); }});
}

void add_history(Commands& commands) {
  const auto step = [](Studio& studio, bool back) {
    Session& session = studio.session();
    const std::string label = back ? session.history.undo_label() : session.history.redo_label();
    session.document = back ? session.history.undo(session.document) : session.history.redo(session.document);
    session.changed = true;
    studio.notify((back ? "Undone: " : "Redone: ") + label);
  };
  commands.add({"edit.undo", "Undo", "", "Ctrl+Z", false, false,
                [step](Studio& s, const Arguments&) { step(s, true); }});
  commands.add({"edit.redo", "Redo", "", "Ctrl+Shift+Z", false, false,
                [step](Studio& s, const Arguments&) { step(s, false); }});
}

}  // namespace

void add_edit_commands(Commands& commands) {
  add_history(commands);
  add_scan_edits(commands);
  add_skeleton_edits(commands);
  add_pose_edits(commands);
  add_pose_ranges(commands);
  add_removal(commands);
  add_target_edits(commands);
  add_weight_tools(commands);
}

}  // namespace understudy::app
