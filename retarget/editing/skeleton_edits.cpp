#include "retarget/editing/skeleton_edits.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"

namespace understudy {
namespace {

constexpr float kBelieved = 0.9f;  // above the joint filter's threshold for repairing sides

bool in_subtree(int joint, int top) {
  while (joint > top) joint = kParents[joint];
  return joint == top;
}

/// The one child of a joint, -1 when it has none or several.
int only_child(int joint) {
  int child = -1;
  for (int j = 1; j < kJointCount; ++j)
    if (kParents[j] == joint) {
      if (child >= 0) return -1;
      child = j;
    }
  return child;
}

/// How much of an edit there is at a frame. Throws Error for one that cannot be.
float weight(const DragEdit& edit, int frame) {
  US_CHECK(edit.joint >= 0 && edit.joint < kJointCount, "a dragged joint has number ", edit.joint,
           ", there are ", kJointCount);
  US_CHECK(edit.offset.allFinite(), "a dragged joint has an offset that is not finite");
  return falloff_weight(frame, edit.frame, edit.falloff);
}
float weight(const SwapEdit& edit, int frame) {
  return frame >= edit.first && frame <= edit.last ? 1.0f : 0.0f;
}

/// The rotation seen at a joint turned as the bone to its child was.
void follow_bone(const Joints& before, int joint, Extraction& seen) {
  const int child = only_child(joint);
  if (child < 0) return;
  const Vec3 from = (before.row(child) - before.row(joint)).transpose();
  const Vec3 to = (seen.joints.row(child) - seen.joints.row(joint)).transpose();
  if (from.norm() < 1e-4f || to.norm() < 1e-4f) return;
  auto& R = (*seen.global)[joint];
  R = rotation_between(from, to) * R;
}

void edit_frame(const DragEdit& edit, float amount, Extraction& seen) {
  const Joints before = seen.joints;
  for (int j = edit.joint; j < kJointCount; ++j)
    if (j == edit.joint || (edit.with_children && in_subtree(j, edit.joint))) {
      seen.joints.row(j) += amount * edit.offset.transpose();
      seen.confidence[j] = std::max(seen.confidence[j], amount);
    }
  if (!seen.global) return;
  const int parent = kParents[edit.joint];
  if (parent >= 0) follow_bone(before, parent, seen);
  if (!edit.with_children) follow_bone(before, edit.joint, seen);
}

void edit_frame(const SwapEdit& edit, float, Extraction& seen) {
  using Limbs = SwapEdit::Limbs;
  const auto exchange = [&seen](std::initializer_list<int> left) {
    for (const int j : left) {
      const int other = kMirror[j];
      seen.joints.row(j).swap(seen.joints.row(other));
      std::swap(seen.confidence[j], seen.confidence[other]);
      for (const int k : {j, other}) seen.confidence[k] = std::max(seen.confidence[k], kBelieved);
    }
  };
  if (edit.limbs != Limbs::Legs) exchange({LeftCollar, LeftShoulder, LeftElbow, LeftWrist});
  if (edit.limbs != Limbs::Arms) exchange({LeftHip, LeftKnee, LeftAnkle, LeftFoot});
  seen.global.reset();  // the trunk's frame was seen the wrong way round too
}

}  // namespace

Extraction apply(const std::vector<SkeletonEdit>& edits, Extraction seen, int frame) {
  for (const SkeletonEdit& any : edits)
    std::visit(
        [&](const auto& edit) {
          const float amount = weight(edit, frame);
          if (amount > 0) edit_frame(edit, amount, seen);
        },
        any);
  return seen;
}

}  // namespace understudy
