#include "ui/viewport/hand.hpp"

#include <algorithm>
#include <cmath>

#include "app/session/follow.hpp"
#include "render/gizmo.hpp"
#include "retarget/base/index.hpp"
#include "retarget/editing/limb_move.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/skeleton/skinning.hpp"
#include "ui/panels/panel.hpp"
#include "ui/viewport/pane.hpp"

namespace understudy::ui {
namespace {

using app::Session;
using app::Tool;
using render::GizmoHandle;

constexpr float kReach = 12;                // points around a joint in which it is met
constexpr float kLeastMove = 5e-4f;         // metres or radians: less was a click
constexpr float kThinnest = 0.05f;          // metres, of a crop box
constexpr float kDabStep = 0.35f;           // of the brush's radius, between dabs
constexpr double kSettleSeconds = 1.5;      // an edit shows within this time, or never
constexpr Eigen::Index kMostPosed = 60000;  // vertices posed for a preview on the thread that draws

/// Null where the take has no such frame, or no target to pose.
const Pose* pose_of(const Session& session, int take, int frame) {
  const app::TakeState* state = at_or_null(session.takes, take);
  return state != nullptr && state->target != nullptr ? at_or_null(state->shown.poses, frame) : nullptr;
}

app::Arguments& operator<<(app::Arguments& words, const Vec3& v) {
  for (int i = 0; i < 3; ++i) words.push_back(argument(static_cast<double>(v[i])));
  return words;
}

bool same_pose(const std::optional<Pose>& a, const std::optional<Pose>& b) {
  return a.has_value() == b.has_value() && (!a || (a->root == b->root && a->local == b->local));
}

/// What the pane shows of its first take; null for nothing.
std::shared_ptr<const app::PosedPicture> first_picture(const HandPlace& place) {
  return place.pictures.takes.empty() ? nullptr : place.pictures.takes[0];
}

int axis_of(GizmoHandle handle) {
  return std::clamp(static_cast<int>(handle) - static_cast<int>(GizmoHandle::AxisX), 0, 2);
}

}  // namespace

std::optional<Hand::Subject> Hand::subject_of(const HandPlace& place) {
  const Session& session = place.session;
  const app::TakeState* take = first_take(session, place.pane);
  const bool rest = shows_rest(session, place.pane);
  if (session.tool == Tool::Bones && tool_on_found_bones(session, place.pane)) return found_subject(place);
  Subject subject;
  subject.take = place.pane.takes.empty() ? -1 : place.pane.takes[0];
  subject.selected = session.selected_joint;
  if (session.tool == Tool::TargetJoints && rest) {
    subject.grip = Grip::RestJoint;
    subject.joints = take->target->joints;
    return subject;
  }
  if (session.tool == Tool::RestPose && rest) {
    const PosedSkeleton posed = forward_kinematics(take->target->joints, rest_pose(session, subject.take));
    subject.grip = Grip::RestBone;
    subject.joints = posed.joints;
    if (session.selected_joint >= 0) subject.axes = posed.global[session.selected_joint];
    return subject;
  }
  if (session.tool == Tool::Joints && place.pane.source)
    subject.grip = Grip::Joint, subject.take = -1;
  else if (session.tool == Tool::Bones && take != nullptr)
    subject.grip = Grip::Bone;
  const int frame = place.pictures.frame;
  const Joints* joints = app::pane_joints(session, subject.take + 1, frame);
  if (subject.grip == Grip::None || joints == nullptr || rest) return std::nullopt;
  subject.joints = *joints;
  const Pose* pose = subject.grip == Grip::Bone ? pose_of(session, subject.take, frame) : nullptr;
  if (pose != nullptr && session.selected_joint >= 0)
    subject.axes = forward_kinematics(take->target->joints, *pose).global[session.selected_joint];
  return subject;
}

std::optional<Hand::Subject> Hand::found_subject(const HandPlace& place) {
  const app::BonesState& bones = place.session.bones;
  const RigPose* const pose =
      at_or_null(bones.rig->found.motion.poses, app::frame_of_rig(*bones.rig, place.pictures.frame));
  if (pose == nullptr) return std::nullopt;
  const understudy::Rig& rig = bones.rig->found.rig;
  const BoneMotions motions = bone_motions(rig, *pose);
  Subject subject;
  subject.grip = Grip::FoundBone;
  subject.joints = joint_places(rig, motions);
  const RigJoint* const joint = at_or_null(rig.joints, bones.selected);
  if (joint == nullptr) return subject;
  subject.selected = bones.selected;
  subject.axes = motions[static_cast<size_t>(bones.selected)].R;
  if (joint->kind == JointKind::Slider || joint->kind == JointKind::Fixed) subject.rings = 0;
  if (joint->kind != JointKind::Hinge) return subject;
  subject.rings = 1;
  const Vec3 across = joint->axis.unitOrthogonal();
  subject.handles << joint->axis, across, joint->axis.cross(across);
  return subject;
}

render::GizmoView Hand::gizmo_of(const Subject& subject, int joint) {
  render::GizmoView gizmo;
  gizmo.kind = turns(subject.grip) ? render::GizmoView::Kind::Turn : render::GizmoView::Kind::Move;
  gizmo.position = subject.joints.row(joint);
  gizmo.axes = subject.axes * subject.handles;
  gizmo.rings = subject.rings;
  return gizmo;
}

void Hand::let_go() {
  grip_ = settling_ = Grip::None;
  released_ = {};
  leave();
}

/// Nothing is under the pointer any longer.
void Hand::leave() {
  handle_ = GizmoHandle::None;
  hovered_ = face_ = -1;
  brush_.reset();
  face_hand_.let_go();
  tip_.clear();
}

bool Hand::work(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue) {
  const bool here = pointer.over || pointer.held || pointer.released;
  if (busy() && !(place.pane == pane_)) return false;
  if (place.session.time >= settle_until_) released_ = {};
  if (of_found(settling_) && place.session.bones.rig != rig_before_) settling_ = Grip::None;  // it is there
  if (!here && !busy()) {
    if (place.pane == pane_) leave();
    return false;
  }
  pane_ = place.pane;
  tip_.clear();
  on_found_ = tool_on_found_bones(place.session, place.pane);
  const Tool tool = place.session.tool;
  if (tool == Tool::Face) {
    const bool taken = face_hand_.work(place, pointer, queue);
    tip_ = face_hand_.tip();
    return taken;
  }
  if (tool == Tool::Paint) return paint(place, pointer, queue);
  brush_.reset();
  return tool == Tool::Crop ? work_on_box(place, pointer, queue) : work_on_joints(place, pointer, queue);
}

/// What a click would choose: found bones along their length, other joints where they are.
int Hand::joint_under(const HandPlace& place, const std::optional<Subject>& subject, const ImVec2& at) const {
  if (on_found_) {
    const auto bones = posed_bones(place.session, place.pane, place.pictures.frame);
    return bones ? bone_at(place.view, *bones, at, kReach * place.scale) : -1;
  }
  if (subject) return point_at(place.view, subject->joints, at, kReach * place.scale);
  const Joints* any = app::pane_joints(place.session, place.pane.number, place.pictures.frame);
  return any == nullptr ? -1 : point_at(place.view, *any, at, kReach * place.scale);
}

bool Hand::work_on_joints(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue) {
  if (busy()) {
    drag(place, pointer);
    if (pointer.released || !pointer.held) finish(place, queue);
    return true;
  }
  const auto subject = subject_of(place);
  hovered_ = joint_under(place, subject, pointer.at);
  handle_ = GizmoHandle::None;
  if (!subject) return false;
  if (subject->selected >= 0)
    handle_ = render::handle_under(gizmo_of(*subject, subject->selected), place.view.camera,
                                   place.view.ray(pointer.at));
  const bool limb = subject->grip == Grip::Bone && limb_end(hovered_) >= 0;
  if (limb)
    handle_ = GizmoHandle::None;  // a hand or a foot is met before the rings around it or its neighbours
  if (handle_ != GizmoHandle::None) hovered_ = -1;
  if (limb) tip_ = is_leg(hovered_) ? "Drag: the leg follows" : "Drag: the arm follows";
  const bool meant = handle_ != GizmoHandle::None || hovered_ >= 0;
  if (pointer.pressed && meant) grab(place, *subject, pointer, queue);
  return meant;
}

void Hand::grab(const HandPlace& place, const Subject& subject, const Pointer& pointer,
                app::CommandQueue& queue) {
  const Session& session = place.session;
  joint_ = handle_ != GizmoHandle::None ? subject.selected : hovered_;
  if (joint_ != subject.selected) queue.push_back(choice_of(joint_));
  if (session.playback.playing) queue.push_back({"playback.pause", {}});
  const bool limb = subject.grip == Grip::Bone && handle_ == GizmoHandle::None;
  const bool by_rings = turns(subject.grip) && !limb && handle_ == GizmoHandle::None;
  if (by_rings || (limb && limb_end(joint_) < 0)) return;  // other bones turn by their rings alone
  if (handle_ == GizmoHandle::None) handle_ = GizmoHandle::Centre;
  grip_ = limb ? Grip::Limb : subject.grip, settling_ = Grip::None;
  frame_ = place.pictures.frame, take_ = subject.take;
  before_ = subject.joints;
  gizmo_ = gizmo_of(subject, joint_), handles_ = subject.handles;
  rig_before_ = on_found_ ? session.bones.rig : nullptr, turned_pose_ = nullptr;
  start_ = last_ = place.view.ray(pointer.at);
  offset_.setZero();
  corrections_.resize(0, 3);
  source_drag_.reset();
  released_ = {};
  if (grip_ == Grip::Joint) source_drag_.emplace(session, frame_, session.falloff);
  const app::TakeState* take = at_or_null(session.takes, take_);
  const std::optional<Pose> pose = pose_before_ = grasped_pose(session);
  if (pose && take->deformer != nullptr && take->target->mesh.vertices.rows() <= kMostPosed)
    corrections_ = grip_ == Grip::RestBone ? Points(Points::Zero(take->target->mesh.vertices.rows(), 3))
                                           : take->deformer->offsets(*pose);
}

/// The pose that is gripped of a found rig, with its bone as it is turned now.
std::shared_ptr<const RigPose> Hand::turned_found() const {
  const DiscoveredRig& rig = *rig_before_;
  const RigPose& pose = rig.found.motion.poses[static_cast<size_t>(app::frame_of_rig(rig, frame_))];
  return std::make_shared<const RigPose>(understudy::turned(rig.found.rig, pose, {joint_, 0, offset_}));
}

void Hand::drag(const HandPlace& place, const Pointer& pointer) {
  const render::Ray now = place.view.ray(pointer.at);
  const render::Camera& camera = place.view.camera;
  if (turns(grip_)) {  // step by step, so that more than half a turn is one, too
    const float angle = render::turned(gizmo_, handle_, camera, last_, now);
    offset_ += angle * handles_.col(axis_of(handle_));
    if (grip_ == Grip::FoundBone && angle != 0) turned_pose_ = turned_found();
    tip_ = figure(static_cast<double>(offset_.norm() * 180 / kPi), "deg");
  } else {
    offset_ = render::dragged(gizmo_, handle_, camera, start_, now);
    tip_ = figure(static_cast<double>(offset_.norm() * 1000), "mm");
    if (grip_ == Grip::Limb && beyond_reach(place.session)) tip_ += ", as far as it reaches";
  }
  last_ = now;
}

void Hand::finish(const HandPlace& place, app::CommandQueue& queue) {
  const Session& session = place.session;
  const Grip grip = grip_;
  released_ = {grip == Grip::RestBone ? turned_picture(place) : nullptr, first_picture(place)};
  grip_ = Grip::None;
  handle_ = GizmoHandle::None;
  tip_.clear();
  if (offset_.norm() < kLeastMove || (grip == Grip::FoundBone && rig_before_ != session.bones.rig)) return;
  app::Arguments words;
  if (grip == Grip::Joint) {
    words = {std::to_string(frame_), joint_name(joint_)};
    words << offset_;
    words.push_back(std::to_string(session.falloff));
    if (session.drag_children) words.push_back("children");
    queue.push_back({"edit.drag", words});
  } else if (of_result(grip)) {
    words = {std::to_string(take_), std::to_string(frame_), joint_name(joint_)};
    words << offset_;
    words.push_back(std::to_string(session.falloff));
    queue.push_back({grip == Grip::Limb ? "edit.move_limb" : "edit.rotate", words});
  } else if (grip == Grip::FoundBone) {
    words = {std::to_string(joint_), std::to_string(frame_)};
    words << offset_;
    words.push_back(std::to_string(session.falloff));
    queue.push_back({"bones.turn", words});
  } else if (grip == Grip::RestBone) {
    words = {std::to_string(take_), joint_name(joint_)};
    words << offset_;
    if (session.mirror_joint) words.push_back("mirror");
    queue.push_back({"edit.rest_bone", words});
  } else {
    words = {std::to_string(take_), joint_name(joint_)};
    words << Vec3(before_.row(joint_).transpose() + offset_);
    if (session.mirror_joint) words.push_back("mirror");
    queue.push_back({"edit.target_joint", words});
  }
  settling_ = grip;
  settle_until_ = session.time + kSettleSeconds;
}

/// Whether the drag, or the edit just pushed, belongs to this pane and is not in its pictures yet.
bool Hand::shown_in(const HandPlace& place) const {
  const Grip grip = current();
  if (of_found(grip))
    return place.pane == pane_ && place.session.bones.rig == rig_before_ &&
           (grip == Grip::FoundPaint || place.pictures.frame == frame_) &&
           (busy() || place.session.time < settle_until_);
  const bool of_rest = grip == Grip::RestJoint || grip == Grip::RestBone;
  if (grip != Grip::Joint && !of_result(grip) && !of_rest) return false;
  if (!(place.pane == pane_)) return false;
  if (busy()) return true;
  const auto subject = subject_of(place);
  const Grip worked_on = grip == Grip::Limb ? Grip::Bone : grip;
  return place.session.time < settle_until_ && subject && subject->grip == worked_on &&
         subject->take == take_ && (of_rest || place.pictures.frame == frame_) &&
         subject->joints == before_ && same_pose(grasped_pose(place.session), pose_before_);
}

/// The pose that is gripped: of the take's result, or its target's rest pose.
std::optional<Pose> Hand::grasped_pose(const Session& session) const {
  const app::TakeState* take = at_or_null(session.takes, take_);
  if (current() == Grip::RestBone && take != nullptr && take->target != nullptr)
    return rest_pose(session, take_);
  const Pose* pose = of_result(current()) ? pose_of(session, take_, frame_) : nullptr;
  return pose == nullptr ? std::nullopt : std::optional<Pose>(*pose);
}

/// The take's skeleton with the bone turned in its own frame, or the limb moved;
/// none where the pose is not there.
std::optional<PosedSkeleton> Hand::turned_skeleton(const Session& session) const {
  const std::optional<Pose> pose = grasped_pose(session);
  if (!pose) return std::nullopt;
  const Joints& rest = session.takes[take_].target->joints;
  if (current() == Grip::RestBone) {
    const auto& turns_before = session.document.takes[take_].target_edits.rest_pose;
    const auto turns_now = understudy::turned(turns_before, {joint_, offset_}, session.mirror_joint);
    return forward_kinematics(rest, Pose{rest_rotations(turns_now), pose->root});
  }
  if (current() == Grip::Limb) return forward_kinematics(rest, moved_limb(rest, joint_, offset_, *pose));
  Pose turned = *pose;
  turned.local[joint_] = pose->local[joint_] * rotation_from_axis_angle(offset_);
  return forward_kinematics(rest, turned);
}

/// Whether the hand or foot that is dragged stays behind the pointer.
bool Hand::beyond_reach(const Session& session) const {
  constexpr float kBehind = 0.01f;  // metres
  const auto skeleton = turned_skeleton(session);
  if (!skeleton) return false;
  return (skeleton->joints.row(joint_) - before_.row(joint_) - offset_.transpose()).norm() > kBehind;
}

Joints Hand::moved_joints(const HandPlace& place) const {
  const Session& session = place.session;
  const Joints joints = before_;
  if (current() == Grip::RestJoint) {
    JointMove move;
    move.joint = joint_, move.position = before_.row(joint_).transpose() + offset_;
    move.mirror = session.mirror_joint;
    return understudy::apply({move}, joints);
  }
  if (of_result(current()) || current() == Grip::RestBone) {
    const auto skeleton = turned_skeleton(session);
    return skeleton ? skeleton->joints : joints;
  }
  const DragEdit drag{frame_, joint_, offset_, session.falloff, session.drag_children};
  return source_drag_ ? source_drag_->joints(drag).value_or(joints) : joints;
}

/// The found rig as the drag turns it, or the stroke has painted it so far.
FoundPreview Hand::found_preview(const HandPlace& place) const {
  FoundPreview preview;
  if (!of_found(current()) || !shown_in(place)) return preview;
  if (current() == Grip::FoundBone) preview.pose = turned_pose_;
  if (current() == Grip::FoundPaint) preview.skin = painted_skin_;
  return preview;
}

EditPreview Hand::preview(const HandPlace& place) const {
  EditPreview preview;
  const Session& session = place.session;
  auto subject = subject_of(place);
  preview.found = found_preview(place);
  if (shown_in(place) && !of_found(current())) {
    const Joints moved = moved_joints(place);
    (current() == Grip::Joint ? preview.source_joints : preview.take_joints) = moved;
    if (subject) subject->joints = moved;
  }
  const bool chosen = subject && subject->selected >= 0 && subject->rings > 0 && !session.playback.playing &&
                      (subject->take < 0 || subject->take == session.selected_take);
  if (chosen) {
    preview.gizmo = gizmo_of(*subject, subject->selected);
    if (place.pane == pane_) preview.gizmo->hovered = handle_;
  }
  if (session.tool == Tool::Crop && place.pane.source) {
    const bool mine = place.pane == pane_;
    if (mine && grip_ == Grip::Face) preview.crop = box_;
    preview.crop_face = mine ? face_ : -1;
  }
  return preview;
}

/// The rest pose as it was released, until the pane has another picture of it.
std::shared_ptr<const app::PosedPicture> Hand::released_picture(const HandPlace& place) const {
  const bool waits = !busy() && place.pane == pane_ && place.session.tool == Tool::RestPose &&
                     place.session.time < settle_until_ && first_picture(place) == released_.before;
  return waits ? released_.picture : nullptr;
}

std::shared_ptr<const app::PosedPicture> Hand::turned_picture(const HandPlace& place) const {
  if (auto released = released_picture(place)) return released;
  if (!(of_result(current()) || current() == Grip::RestBone) || !shown_in(place)) return nullptr;
  const auto skeleton = turned_skeleton(place.session);
  if (!skeleton) return nullptr;
  const app::TakeState& take = place.session.takes[take_];
  const Mesh& mesh = take.target->mesh;
  if (take.weights == nullptr || corrections_.rows() != mesh.vertices.rows()) return nullptr;
  app::PosedPicture picture;
  picture.vertices =
      linear_blend_skinning(mesh.vertices + corrections_, *take.weights, take.target->joints, *skeleton);
  picture.offsets = corrections_;
  if (!mesh.is_cloud()) picture.normals = vertex_normals(picture.vertices, mesh.faces);
  return std::make_shared<const app::PosedPicture>(std::move(picture));
}

bool Hand::work_on_box(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue) {
  if (!place.pane.source) return false;
  if (!busy()) {
    box_ = app::shown_crop(place.session);
    const Points centres = face_centres(box_);
    face_ = point_at(place.view, centres, pointer.at, 1.3f * kReach * place.scale);
    if (!pointer.pressed || face_ < 0) return face_ >= 0;
    grip_ = Grip::Face;
    gizmo_ = {};
    gizmo_.position = centres.row(face_);
    start_ = place.view.ray(pointer.at);
    return true;
  }
  const int axis = face_ / 2;
  const auto handle = static_cast<GizmoHandle>(static_cast<int>(GizmoHandle::AxisX) + axis);
  const Vec3 moved = render::dragged(gizmo_, handle, place.view.camera, start_, place.view.ray(pointer.at));
  const float to = gizmo_.position[axis] + moved[axis];
  box_.side(face_) =
      face_ % 2 == 1 ? std::max(to, box_.low[axis] + kThinnest) : std::min(to, box_.high[axis] - kThinnest);
  if (pointer.released || !pointer.held) {
    grip_ = Grip::None;
    if (std::abs(moved[axis]) >= kLeastMove)
      queue.push_back({"edit.crop", {kBoxSides[face_], argument(box_.side(face_))}});
  }
  return true;
}

/// The command that chooses it.
std::pair<std::string, app::Arguments> Hand::choice_of(int joint) const {
  if (on_found_) return {"bones.select", {std::to_string(joint)}};
  return {"select.joint", {joint_name(joint)}};
}

/// Another joint than the one that is painted, under the pointer; -1: none. A stroke goes on over them.
int Hand::joint_to_paint(const HandPlace& place, const Pointer& pointer) const {
  if (busy()) return -1;
  const float reach = kReach * place.scale;
  if (on_found_) {
    const auto bones = posed_bones(place.session, place.pane, place.pictures.frame);
    const int bone =
        bones ? point_at(place.view, bones->places.topRows(bones->joints), pointer.at, reach) : -1;
    return bone == place.session.bones.selected ? -1 : bone;
  }
  const app::Layers& layers = place.pane.source ? place.session.view.source : place.session.view.take;
  const Joints* joints = app::pane_joints(place.session, place.pane.number, place.pictures.frame);
  if (!layers.skeleton || joints == nullptr) return -1;
  const int joint = point_at(place.view, *joints, pointer.at, reach);
  return joint == place.session.selected_joint ? -1 : joint;
}

std::optional<Hand::Touch> Hand::touch(const HandPlace& place, const ImVec2& at) const {
  const Session& session = place.session;
  if (on_found_ && place.bones == nullptr) return std::nullopt;
  const Vec3 moved = on_found_ ? aside(session, place.pane, 0) : Vec3(Vec3::Zero());
  const render::Ray ray = place.view.shifted(-moved).ray(at);  // found bones are drawn where they stand
  const auto hit = on_found_ ? found_under(session, *place.bones, ray)
                             : take_under(session, place.pane, place.pictures, ray);
  if (!hit) return std::nullopt;
  const Mesh& mesh =
      on_found_ ? session.bones.rig->found.rig.surface : first_take(session, place.pane)->target->mesh;
  const Points& normals = on_found_ ? *place.bones->normals : place.pictures.takes[0]->normals;
  Touch touch{{hit->position - moved, Vec3::UnitY()}, Vec3::Zero()};
  if (normals.rows() > hit->vertex) touch.brush.normal = normals.row(hit->vertex);
  if (mesh.is_cloud()) touch.rest = mesh.vertices.row(hit->vertex);
  for (int c = 0; c < 3 && !mesh.is_cloud(); ++c)
    touch.rest += hit->barycentric[c] * mesh.vertices.row(mesh.faces(hit->face, c)).transpose();
  return touch;
}

bool Hand::paint(const HandPlace& place, const Pointer& pointer, app::CommandQueue& queue) {
  brush_.reset();
  if (busy() && (pointer.released || !pointer.held)) end_stroke(place.session, queue);
  hovered_ = joint_to_paint(place, pointer);
  if (hovered_ >= 0) {
    tip_ = "Click: paint its weights";
    if (pointer.pressed) queue.push_back(choice_of(hovered_));
    return true;
  }
  const auto touched = touch(place, pointer.at);
  if (!touched) return busy();
  brush_ = touched->brush;
  if ((on_found_ ? place.session.bones.selected : place.session.selected_joint) < 0) {
    tip_ = on_found_ ? "Choose the bone to paint first" : "Choose the joint to paint first";
    return true;
  }
  const bool apart = (touched->rest - last_dab_).norm() > kDabStep * place.session.brush.radius_m;
  if (pointer.pressed) begin_stroke(place, queue);
  if (pointer.pressed || (busy() && apart)) dab(place, touched->rest, queue);
  return true;
}

void Hand::begin_stroke(const HandPlace& place, app::CommandQueue& queue) {
  const Session& session = place.session;
  if (session.playback.playing) queue.push_back({"playback.pause", {}});
  grip_ = on_found_ ? Grip::FoundPaint : Grip::Paint, settling_ = Grip::None;
  if (!on_found_) return;
  const Brush& brush = session.brush;
  stroke_ = {session.bones.selected, {}, brush.radius_m, brush.strength, brush.mode};
  rig_before_ = session.bones.rig;
  painted_ = {rig_before_->found.rig, {}};
}

/// A target's dab is an edit at once; a found bone's are one when the stroke ends, and seen until then.
void Hand::dab(const HandPlace& place, const Vec3& rest, app::CommandQueue& queue) {
  last_dab_ = rest;
  if (grip_ == Grip::Paint) {
    app::Arguments words{std::to_string(place.pane.takes[0])};
    words << rest;
    queue.push_back({"edit.paint", words});
    return;
  }
  PaintBone one = stroke_;
  one.at = {rest};
  understudy::apply(painted_, one);
  stroke_.at.push_back(rest);
  painted_skin_ = std::make_shared<const SkinWeights>(painted_.rig.skin);
}

void Hand::end_stroke(const Session& session, app::CommandQueue& queue) {
  const Grip grip = std::exchange(grip_, Grip::None);
  if (grip != Grip::FoundPaint || rig_before_ != session.bones.rig) return;
  app::Arguments words{std::to_string(stroke_.joint), argument(static_cast<double>(stroke_.radius_m)),
                       argument(static_cast<double>(stroke_.strength)),
                       kBrushModeNames[static_cast<size_t>(stroke_.mode)]};
  for (const Vec3& at : stroke_.at) words << at;
  queue.push_back({"bones.paint", words});
  settling_ = grip;
  settle_until_ = session.time + kSettleSeconds;
}

}  // namespace understudy::ui
