// Changes of a rig and of what it performs, as plain values: a document keeps them in a list.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/geometry/brush_mode.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy {

// Joints and frames are counted as they are when the edit comes, after those before it. Every edit throws
// Error, one sentence, for what is no joint, no frame or no finite number, and changes nothing then.

constexpr Within<int> kJointNumbers = kFrameNumbers;

/// A bone and its parent become one, which moves as the parent did: what hangs on the bone hangs on the
/// parent and keeps its direction. Refused for the root.
struct MergeBone {
  int joint = 0;
};
template <class V, class S>
FieldsOf<S, MergeBone> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
}

/// A bone becomes two, where a plane through `at` cuts it across its length. What lies beyond the plane, seen
/// from the joint, is the new bone's: its number is joint + 1, it hangs on the other by a ball at `at` (from
/// there in the middle of the cut, where that is on the skin), takes the vertices (the change is soft in a
/// narrow band) and the children there, and is named after the other. It moves as the other did until it is
/// fitted again: every posed surface stays as it was. Refused where one side has nothing.
struct SplitBone {
  int joint = 0;
  Vec3 at = Vec3::Zero();  ///< at rest, in the body or on its skin, metres
};
template <class V, class S>
FieldsOf<S, SplitBone> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
  visit("at", edit.at);
}

/// A joint is put somewhere else at rest; the rest surface stays, and every bone keeps its rotation in every
/// frame. The root's can be anywhere: every posed surface stays as it was. Of any other, the bone now turns
/// about the new place: with what hangs on it, it is shifted in frames that turn it.
struct MoveJoint {
  int joint = 0;
  Vec3 to = Vec3::Zero();  ///< at rest, metres
};
template <class V, class S>
FieldsOf<S, MoveJoint> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
  visit("to", edit.to);
}

/// Another kind of joint: poses become the nearest that it allows, what hangs on it keeps its rotations where
/// it can. Refused for the root, which is free, and for "free" of any other.
struct SetJointKind {
  int joint = 0;
  JointKind kind = JointKind::Ball;
  /// Of a hinge or slider, at rest, any length but 0; none: of a hinge the one nearest to its motion, of a
  /// slider along its bone, unless it was one.
  std::optional<Vec3> axis{};
};
template <class V, class S>
FieldsOf<S, SetJointKind> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
  visit("joint_kind", edit.kind, kJointKindNames);
  visit("axis", edit.axis);
}

/// The tree hangs on another bone, which is joint 0 then. Joints stay where they are and of their kinds; on
/// the way from the old root to the new one they carry the bone on their other side. The new root joint is in
/// the middle of its bone's vertices; of a bone without any, where it was. Every posed surface stays as it
/// was.
struct RootAt {
  int joint = 0;
};
template <class V, class S>
FieldsOf<S, RootAt> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
}

/// Refused where the name is empty or another bone's.
struct RenameBone {
  int joint = 0;
  std::string name;
};
template <class V, class S>
FieldsOf<S, RenameBone> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
  visit("name", edit.name);
}

/// A stroke of a brush on the rest surface, dab by dab. A dab falls off smoothly to nothing at its radius; it
/// reaches only what hangs together with its middle within the radius (of clouds: all). The bone's weight
/// grows towards 1 or shrinks towards 0; the others of the vertex share the rest as before, where there are
/// none it is the parent's (of the root: of the first that hangs on it). Smooth brings a vertex's weights
/// nearer to their mean over it and the six nearest under the dab. Of five bones the least one goes, be it
/// the painted one. Refused without a dab.
struct PaintBone {
  int joint = 0;
  std::vector<Vec3> at{};  ///< the dabs' middles on the rest surface, metres
  float radius_m = 0.05f;
  float strength = 0.5f;  ///< 0 .. 1, of a dab in its middle
  BrushMode mode = BrushMode::Add;
};
template <class V, class S>
FieldsOf<S, PaintBone> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
  visit("at", edit.at);
  visit("radius_m", edit.radius_m);
  visit("strength", edit.strength, Within<float>{0, 1});
  visit("mode", edit.mode, kBrushModeNames);
}

/// A bone turned further at one frame; the frames around follow less and less (falloff_weight). A hinge turns
/// about its axis alone. Refused for sliders and what is fixed.
struct TurnBone {
  int joint = 0;
  int frame = 0;
  Vec3 axis_angle = Vec3::Zero();  ///< radians, in the bone's own axes (the world's at rest), after its turn
  int falloff = 5;                 ///< frames to each side that follow
};
template <class V, class S>
FieldsOf<S, TurnBone> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
  visit("frame", edit.frame, kFrameNumbers);
  visit("axis_angle", edit.axis_angle);
  visit("falloff", edit.falloff, kFrameNumbers);
}

/// Turns and slides over time through a Gaussian, and with the root its path; both ends stay as they are.
struct SmoothBones {
  std::optional<int> joint{};  ///< none: all
  int first = 0, last = 0;     ///< frames, both inside
  float strength = 0.5f;       ///< 0 nothing .. 1 a Gaussian of kSmoothestSeconds standard deviation
};
template <class V, class S>
FieldsOf<S, SmoothBones> fields(V& visit, S& edit) {
  visit("joint", edit.joint, kJointNumbers);
  visit("first", edit.first, kFrameNumbers);
  visit("last", edit.last, kFrameNumbers);
  visit("strength", edit.strength, Within<float>{0, 1});
}

/// Frames outside go.
struct KeepFrames {
  int first = 0, last = 0;  ///< both inside
};
template <class V, class S>
FieldsOf<S, KeepFrames> fields(V& visit, S& edit) {
  visit("first", edit.first, kFrameNumbers);
  visit("last", edit.last, kFrameNumbers);
}

/// All poses are fitted to the scans again, from those there are. Takes the scans: see
/// discovery/rig_refit.hpp.
struct FitAgain {};
template <class V, class S>
FieldsOf<S, FitAgain> fields(V&, S&) {}

using RigEdit = std::variant<MergeBone, SplitBone, MoveJoint, SetJointKind, RootAt, RenameBone, PaintBone,
                             TurnBone, SmoothBones, KeepFrames, FitAgain>;
/// In files, in the variant's order.
constexpr Names<std::variant_size_v<RigEdit>> kRigEditNames = {
    "merge", "split", "move", "kind", "root", "rename", "paint", "turn", "smooth", "trim", "fit"};

/// Does it, poses of all frames included. Returns the new number of each joint that was there, [J]; that of a
/// merged one is its parent's. Throws Error as told above, and for FitAgain.
std::vector<int> apply(RiggedMotion& performed, const RigEdit& edit);

/// One pose in which a bone is turned as by TurnBone, whatever the edit's frame. Throws Error as apply().
RigPose turned(const Rig& rig, const RigPose& pose, const TurnBone& edit);

/// The weighted middle of a bone's vertices at rest; of one without any its joint.
Vec3 middle_of_bone(const Rig& rig, int joint);

/// MergeBone of a rig alone. Returns the new numbers, as apply().
std::vector<int> merge_into_parent(Rig& rig, int joint);

/// Weights of joints that are numbered anew; those of one number add up.
SkinWeights renumbered(const SkinWeights& skin, const std::vector<int>& numbers);

}  // namespace understudy
