// Edits of the result: filled and added frames, rotated bones, smoothing, raise, pinned feet, turn, a loop,
// trim.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/editing/pose_fill.hpp"
#include "retarget/editing/pose_loop.hpp"
#include "retarget/editing/tempo_edit.hpp"
#include "retarget/pipeline/root_path.hpp"
#include "retarget/skeleton/foot_contact.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// A bone turned by the hand at one frame; the frames around follow less and less (falloff_weight).
struct RotateEdit {
  int frame = 0;
  int joint = 0;
  Vec3 axis_angle = Vec3::Zero();  ///< radians, in the joint's own frame, applied after its rotation
  int falloff = 5;                 ///< frames to each side that follow
  /// The joint that ends the limb which turned the bone as it was moved (limb_end);
  /// none: the bone was turned by itself.
  std::optional<int> limb{};
};
template <class V, class S>
FieldsOf<S, RotateEdit> fields(V& visit, S& edit) {
  visit("frame", edit.frame, kFrameNumbers);
  visit("joint", edit.joint, Within<int>{0, kJointCount - 1});
  visit("axis_angle", edit.axis_angle);
  visit("falloff", edit.falloff, kFrameNumbers);
  visit("limb", edit.limb, Within<int>{0, kJointCount - 1});
}

/// Rotations and root over time through a Gaussian that looks both ways (no delay).
struct SmoothEdit {
  float strength = 0.5f;  ///< 0 nothing .. 1 a Gaussian of kSmoothestSeconds standard deviation
};
template <class V, class S>
FieldsOf<S, SmoothEdit> fields(V& visit, S& edit) {
  visit("strength", edit.strength, Within<float>{0, 1});
}

/// The whole motion moved up or down.
struct RaiseEdit {
  float offset_m = 0;
};
template <class V, class S>
FieldsOf<S, RaiseEdit> fields(V& visit, S& edit) {
  visit("offset_m", edit.offset_m);
}

/// Feet on the floor stay where they are: the legs follow by inverse kinematics. The body is put onto the
/// floor y = 0 by its soles, where these are known; a foot may roll from heel to ball but not slide.
struct PinEdit {
  bool left = true, right = true;
  FootContactOptions contact;
  float blend_s = 0.25f;      ///< a correction comes and goes within this time, or less between near contacts
  bool keep_soles_up = true;  ///< soles that are under the floor are lifted onto it at any time
  /// the body is moved so that standing soles are at y = 0, not only held where they are
  bool to_floor = true;
  float max_drop_m = 0.04f;  ///< how far the pelvis may sink where a leg is too short (leg 0.8 m)
};
template <class V, class S>
FieldsOf<S, PinEdit> fields(V& visit, S& edit) {
  visit("left", edit.left);
  visit("right", edit.right);
  visit("contact", edit.contact);
  visit("blend_s", edit.blend_s);
  visit("keep_soles_up", edit.keep_soles_up);
  visit("to_floor", edit.to_floor);
  visit("max_drop_m", edit.max_drop_m);
}

/// The motion turned about the vertical through its first pelvis.
struct TurnEdit {
  float turn_deg = 0;  ///< takes +z towards +x
};
template <class V, class S>
FieldsOf<S, TurnEdit> fields(V& visit, S& edit) {
  visit(MemberName("turn_deg", "yaw_deg"), edit.turn_deg);
}

/// What stays for playback and export. Frames are those of the motion before any edit.
struct Trim {
  int first = 0, last = 0;  ///< both inside
};
template <class V, class S>
FieldsOf<S, Trim> fields(V& visit, S& trim) {
  visit("first", trim.first, kFrameNumbers);
  visit("last", trim.last, kFrameNumbers);
}

struct PoseEdits {
  std::vector<FillEdit> fill;
  std::optional<GoOnEdit> go_on;
  std::vector<RotateEdit> rotate;
  std::optional<SmoothEdit> smooth;
  std::optional<RaiseEdit> raise;
  std::optional<PinEdit> pin;
  std::optional<TurnEdit> turn;
  std::optional<LoopEdit> loop;
  std::optional<Trim> trim;
  std::set<int> skip;  ///< frames left out, original numbers
  std::optional<TempoEdit> tempo;
  bool empty() const;
};
template <class V, class S>
FieldsOf<S, PoseEdits> fields(V& visit, S& edits) {
  visit("fill", edits.fill);
  visit("go_on", edits.go_on);
  visit("rotate", edits.rotate);
  visit("smooth", edits.smooth);
  visit(MemberName("raise", "floor"), edits.raise);
  visit("pin", edits.pin);
  visit(MemberName("turn", "heading"), edits.turn);
  visit("loop", edits.loop);
  visit("trim", edits.trim);
  visit("skip", edits.skip, kFrameNumbers);
  visit("tempo", edits.tempo);
}

/// The target in T-pose, as far as edits of its poses must know it.
struct EditedBody {
  Joints rest = Joints::Zero();
  SupportPoints soles;  ///< what may touch the floor; may be empty
  static EditedBody from(const Points& rest_vertices, const Joints& rest_joints);
};

/// All edits in this order, whatever order they were made in: fill (as listed), go on, rotate (as listed),
/// smooth, raise, pin, turn, loop. So a foot rotated by hand is still pinned, pins see the final floor, what
/// loops does so with all of that, and frame numbers are always the original ones: frames that trim and skip
/// leave out stay, for a timeline that still shows them. Deterministic. Without soles pinned feet keep their
/// heights. A pinned foot stands (Motion::standing) where it is held; a foot that was turned away from where
/// it stood does not. Frames that are to be filled, or to loop, beyond the motion's end, which may still be
/// made, are left. Throws Error for unknown joints or a strength outside 0..1. `space` makes what is filled;
/// null: smooth curves do.
Motion apply_poses(const PoseEdits& edits, const Motion& motion, const EditedBody& body,
                   MotionSpace* space = nullptr);
/// A frame's pose after the rotations alone. Throws Error for an unknown joint.
Pose rotated(const std::vector<RotateEdit>& edits, int frame, Pose pose);
/// Original numbers of the frames that trim and skip leave of `count`.
/// Throws Error for a trim that leaves none.
std::vector<int> kept_frames(const PoseEdits& edits, int count);
/// One step of it.
void pin_feet(const PinEdit& edit, Motion& motion, const EditedBody& body);

/// Whether the motion space is asked for one of the edits.
bool need_space(const PoseEdits& edits);

/// What an edit does to a motion, in figures; over the frames of the one before.
struct EditCost {
  double acceleration_before = 0, acceleration_after = 0;  ///< mean |second difference| of joints, m/s^2
  double mean_displacement_m = 0, max_displacement_m = 0;  ///< of joints
};
EditCost edit_cost(const Motion& before, const Motion& after, const Joints& rest);

}  // namespace understudy
