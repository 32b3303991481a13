// The tools: what the left button does in a pane, the preview while dragging, and the final edit command.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/session/commands.hpp"
#include "app/session/source_drag.hpp"
#include "retarget/rig/rig_edits.hpp"
#include "ui/viewport/face_hand.hpp"
#include "ui/viewport/scene_builder.hpp"

namespace understudy::ui {

/// What a tool needs from a pane.
struct HandPlace {
  const app::Session& session;
  const PaneContent& pane;
  const PaneView& view;
  const PanePictures& pictures;
  float scale = 1;                     ///< of the interface: pixels a point
  const BonesMemory* bones = nullptr;  ///< what of found bones is drawn in the pane; null: nothing
};

/// One for all panes: there is one mouse.
class Hand {
 public:
  /// Handles the pointer in this frame; pushes finished edits into `queue`. True when the tool uses the left
  /// button here, false when the camera may.
  bool work(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue);
  /// Cancels the current drag (Escape, another tool).
  void let_go();
  bool busy() const { return grip_ != Grip::None || face_hand_.busy(); }
  /// The pane that the pointer was in last, or that a drag began in.
  const PaneContent& pane() const { return pane_; }

  /// The preview, in this pane, of the current drag or of the edit just pushed.
  EditPreview preview(const HandPlace& place) const;
  /// The first take's picture with the bone turned or the limb moved; null without such a drag, and as soon
  /// as the edit shows.
  std::shared_ptr<const app::PosedPicture> turned_picture(const HandPlace& place) const;

  /// The joint, or the found bone, under the pointer in a pane, -1 for none.
  int hovered_joint(const PaneContent& pane) const { return pane == pane_ && !on_found_ ? hovered_ : -1; }
  int hovered_bone(const PaneContent& pane) const { return pane == pane_ && on_found_ ? hovered_ : -1; }
  /// Where the brush is on a pane's surface, and the surface's normal there.
  struct BrushPlace {
    Vec3 position, normal;
  };
  std::optional<BrushPlace> brush(const PaneContent& pane) const {
    return pane == pane_ ? brush_ : std::nullopt;
  }
  const FaceHand& face() const { return face_hand_; }
  /// A tip beside the pointer: what a click would do; often empty.
  const std::string& tip() const { return tip_; }

 private:
  enum class Grip { None, Joint, Bone, Limb, RestJoint, RestBone, FoundBone, Face, Paint, FoundPaint };
  /// A skeleton that a tool works on: the extracted one, a take's, a target's in T-pose, or a found one.
  struct Subject {
    Grip grip = Grip::None;
    int take = -1;
    Points joints{0, 3};
    int selected = -1;             ///< of them
    Mat3 axes = Mat3::Identity();  ///< of the selected one
    /// What its handles are about, in those axes; a hinge has one ring, what does not turn none.
    Mat3 handles = Mat3::Identity();
    int rings = 3;
  };
  void leave();
  static std::optional<Subject> subject_of(const HandPlace& place);
  static std::optional<Subject> found_subject(const HandPlace& place);
  static render::GizmoView gizmo_of(const Subject& subject, int joint);
  int joint_under(const HandPlace& place, const std::optional<Subject>& subject, const ImVec2& at) const;
  bool work_on_joints(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue);
  void grab(const HandPlace& place, const Subject& subject, const Pointer& pointer, app::CommandQueue& queue);
  void drag(const HandPlace& place, const Pointer& pointer);
  void finish(const HandPlace& place, app::CommandQueue& queue);
  bool work_on_box(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue);
  bool paint(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue);
  int joint_to_paint(const HandPlace& place, const Pointer& pointer) const;
  /// Where the pointer meets the surface that is painted.
  struct Touch {
    BrushPlace brush;
    Vec3 rest;
  };
  std::optional<Touch> touch(const HandPlace& place, const ImVec2& at) const;
  void begin_stroke(const HandPlace& place, app::CommandQueue& queue);
  void dab(const HandPlace& place, const Vec3& rest, app::CommandQueue& queue);
  void end_stroke(const app::Session& session, app::CommandQueue& queue);
  std::pair<std::string, app::Arguments> choice_of(int joint) const;
  /// The drag, or else the edit just pushed.
  Grip current() const { return busy() ? grip_ : settling_; }
  Joints moved_joints(const HandPlace& place) const;
  /// A turned bone, or a limb: what is shown of it is made the same way.
  static bool of_result(Grip grip) { return grip == Grip::Bone || grip == Grip::Limb; }
  /// What was found in the source is turned or painted.
  static bool of_found(Grip grip) { return grip == Grip::FoundBone || grip == Grip::FoundPaint; }
  /// Turned by the rings of a gizmo.
  static bool turns(Grip grip) {
    return grip == Grip::Bone || grip == Grip::RestBone || grip == Grip::FoundBone;
  }
  std::optional<Pose> grasped_pose(const app::Session& session) const;
  std::optional<PosedSkeleton> turned_skeleton(const app::Session& session) const;
  bool beyond_reach(const app::Session& session) const;
  bool shown_in(const HandPlace& place) const;
  std::shared_ptr<const RigPose> turned_found() const;
  FoundPreview found_preview(const HandPlace& place) const;
  std::shared_ptr<const app::PosedPicture> released_picture(const HandPlace& place) const;

  Grip grip_ = Grip::None;
  FaceHand face_hand_;
  PaneContent pane_;  ///< the one that the pointer is in or the drag began in
  int hovered_ = -1;
  bool on_found_ = false;  ///< the tool is about found bones there, and so is what is hovered
  render::GizmoHandle handle_ = render::GizmoHandle::None;  ///< under the pointer, or gripped
  std::string tip_;

  // While something is gripped, and shortly after, until the edit shows.
  int joint_ = -1, frame_ = -1, take_ = -1;
  Points before_{0, 3};
  std::optional<Pose> pose_before_;  ///< of a turned bone or a limb
  render::GizmoView gizmo_;
  render::Ray start_{}, last_{};
  Mat3 handles_ = Mat3::Identity();  ///< of the subject
  Vec3 offset_ = Vec3::Zero();       ///< metres, world; of what turns: axis times angle, in the joint's frame
  std::shared_ptr<const DiscoveredRig> rig_before_;  ///< of FoundBone and FoundPaint
  std::shared_ptr<const RigPose> turned_pose_;       ///< of FoundBone; null: nothing has been turned yet
  PaintBone stroke_;                                 ///< of FoundPaint, as far as it has come
  RiggedMotion painted_;                             ///< the rig with it
  std::shared_ptr<const SkinWeights> painted_skin_;
  std::optional<app::SourceDrag> source_drag_;  ///< of Joint
  Points corrections_{0, 3};  ///< of a turned bone or a limb: pose-corrective offsets when it was gripped
  /// A bone of the rest pose as it was released, and what the pane showed then.
  struct Released {
    std::shared_ptr<const app::PosedPicture> picture, before;
  } released_;
  double settle_until_ = -1;  ///< Session::time
  Grip settling_ = Grip::None;
  Box box_;
  int face_ = -1;
  std::optional<BrushPlace> brush_;
  Vec3 last_dab_ = Vec3::Zero();
};

}  // namespace understudy::ui
