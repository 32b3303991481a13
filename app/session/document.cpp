#include "app/session/document.hpp"

#include <algorithm>
#include <tuple>

namespace understudy::app {
namespace {

// Declared ahead of the templates below, which use them.
bool equal(const Box& a, const Box& b) {
  return a.low == b.low && a.high == b.high;
}
bool equal(const FloorPlane& a, const FloorPlane& b) {
  return a.normal == b.normal && a.height_m == b.height_m;
}
bool equal(const FloorCut& a, const FloorCut& b);
bool equal(const SmoothEdit& a, const SmoothEdit& b) {
  return a.strength == b.strength;
}
bool equal(const FloorEdit& a, const FloorEdit& b) {
  return a.offset_m == b.offset_m;
}
bool equal(const HeadingEdit& a, const HeadingEdit& b) {
  return a.yaw_deg == b.yaw_deg;
}
bool equal(const Trim& a, const Trim& b) {
  return a.first == b.first && a.last == b.last;
}
bool equal(const PinEdit& a, const PinEdit& b) {
  const auto members = [](const PinEdit& edit) {
    const FootContactOptions& contact = edit.contact;
    return std::tie(edit.left, edit.right, contact.begin_height_m, contact.end_height_m, contact.begin_speed,
                    contact.end_speed, edit.blend_s, edit.keep_soles_up, edit.to_floor, edit.max_drop_m);
  };
  return members(a) == members(b);
}
bool equal(const RotateEdit& a, const RotateEdit& b) {
  return a.frame == b.frame && a.joint == b.joint && a.axis_angle == b.axis_angle && a.falloff == b.falloff;
}
bool equal(const JointMove& a, const JointMove& b) {
  return a.joint == b.joint && a.position == b.position && a.mirror == b.mirror;
}
bool equal(const DragEdit& a, const DragEdit& b) {
  return a.frame == b.frame && a.joint == b.joint && a.offset == b.offset && a.falloff == b.falloff &&
         a.with_children == b.with_children;
}
bool equal(const SwapEdit& a, const SwapEdit& b) {
  return a.first == b.first && a.last == b.last && a.limbs == b.limbs;
}
bool equal(const WeightRows& a, const WeightRows& b) {
  return a.vertex == b.vertex && a.rows == b.rows;
}

template <class T>
bool equal_optional(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || equal(*a, *b));
}
template <class T>
bool all(const std::vector<T>& a, const std::vector<T>& b, bool (*equals)(const T&, const T&)) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equals);
}

bool equal(const FloorCut& a, const FloorCut& b) {
  return a.height_m == b.height_m && equal_optional(a.plane, b.plane) && a.tolerance_m == b.tolerance_m &&
         a.sole_radius_m == b.sole_radius_m && a.sole_band_m == b.sole_band_m;
}
bool equal(const ImportOptions& a, const ImportOptions& b) {
  return a.units == b.units && a.up == b.up && a.yaw_deg == b.yaw_deg && a.floor == b.floor;
}

}  // namespace

bool same(const SourceOptions& a, const SourceOptions& b) {
  return a.path == b.path && a.motion == b.motion && a.betas == b.betas && a.fps == b.fps &&
         equal(a.import, b.import) && a.follow == b.follow && a.as_scan == b.as_scan && a.clip == b.clip &&
         a.bones == b.bones;
}

bool same(const ScanEdits& a, const ScanEdits& b) {
  return equal_optional(a.crop, b.crop) && equal_optional(a.floor, b.floor) &&
         a.largest_cluster == b.largest_cluster && a.cluster_gap_m == b.cluster_gap_m;
}

bool same(const SkeletonEdit& a, const SkeletonEdit& b) {
  if (a.index() != b.index()) return false;
  if (const auto* drag = std::get_if<DragEdit>(&a)) return equal(*drag, std::get<DragEdit>(b));
  return equal(std::get<SwapEdit>(a), std::get<SwapEdit>(b));
}

bool same(const std::vector<SkeletonEdit>& a, const std::vector<SkeletonEdit>& b) {
  return all(a, b, same);
}

bool same(const TargetOptions& a, const TargetOptions& b) {
  return a.path == b.path && a.betas == b.betas && equal(a.import, b.import) && a.forward == b.forward &&
         a.rig == b.rig && a.bones == b.bones;
}

bool same(const Method& a, const Method& b) {
  const auto members = [](const Method& method) {
    return std::tie(method.engine, method.extractor, method.offsets, method.repair_swaps,
                    method.smooth_joints, method.fix_lengths, method.lock_feet, method.root);
  };
  return members(a) == members(b);
}

bool same(const TargetEdits& a, const TargetEdits& b) {
  static const WeightRows none;
  const WeightRows &left = a.weights ? *a.weights : none, &right = b.weights ? *b.weights : none;
  return all(a.joints, b.joints, equal) && (a.weights == b.weights || equal(left, right));
}

bool same(const PoseEdits& a, const PoseEdits& b) {
  return all(a.rotate, b.rotate, equal) && equal_optional(a.smooth, b.smooth) &&
         equal_optional(a.floor, b.floor) && equal_optional(a.pin, b.pin) &&
         equal_optional(a.heading, b.heading) && equal_optional(a.trim, b.trim) && a.skip == b.skip;
}

bool same(const Take& a, const Take& b) {
  return a.name == b.name && same(a.target, b.target) && same(a.method, b.method) &&
         same(a.target_edits, b.target_edits) && same(a.pose_edits, b.pose_edits);
}

bool same(const Document& a, const Document& b) {
  return same(a.source, b.source) && a.truth == b.truth && same(a.scan_edits, b.scan_edits) &&
         same(a.skeleton_edits, b.skeleton_edits) && all(a.takes, b.takes, same);
}

}  // namespace understudy::app
