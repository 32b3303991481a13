#include "ui/viewport/bones_view.hpp"

#include <algorithm>
#include <cmath>

#include "app/session/follow.hpp"
#include "render/colors.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"
#include "retarget/geometry/cloud_normals.hpp"

namespace understudy::ui {
namespace {

using app::BoneSurface;
using app::Session;

const Vec3 kFoundColor(0.0f, 0.62f, 0.45f);  // Okabe and Ito's green: no side of a person has it
const Vec3 kSelectedColor(0.98f, 0.80f, 0.15f);
const Vec3 kUnselected(0.62f, 0.64f, 0.67f);  // of the surface, where one bone is chosen
constexpr float kAdult = 2;                   // diagonal of an adult's box, metres
constexpr float kBesideJoints = 0.6f;         // of the thickness, where a person's joints are shown too

struct Box3 {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  Vec3 floor() const { return {0.5f * (low.x() + high.x()), low.y(), 0.5f * (low.z() + high.z())}; }
};
Box3 box_of(const Points& points) {
  Box3 box;
  if (points.rows() == 0) return box;
  box.low = points.colwise().minCoeff().transpose(), box.high = points.colwise().maxCoeff().transpose();
  return box;
}

Vec3 color_of(int joint) {
  const ImVec4 of = bone_color(joint);
  return {of.x, of.y, of.z};
}

Points part_colors(const std::vector<int>& bone_of) {
  Points colors(ssize(bone_of), 3);
  for (Eigen::Index i = 0; i < colors.rows(); ++i)
    colors.row(i) = color_of(bone_of[static_cast<size_t>(i)]).transpose();
  return colors;
}

render::SkeletonView skeleton_of(const Points& places, const std::vector<int>& parents, float size) {
  render::SkeletonView view;
  view.joints = places, view.parents = parents;
  view.tint = kFoundColor, view.tint_share = 1;
  view.thickness = 0.9f * size / kAdult;
  return view;
}

/// The bone alone, from its joint to all places where it ends.
render::SkeletonView selected_bone(const PosedBones& bones, int joint, float size) {
  std::vector<int> rows = {joint}, parents = {-1};
  for (int i = 0; i < ssize(bones.parents); ++i)
    if (bones.parents[static_cast<size_t>(i)] == joint) rows.push_back(i), parents.push_back(0);
  render::SkeletonView view = skeleton_of(bones.places(rows, Eigen::all), parents, size);
  view.tint = kSelectedColor, view.thickness *= 1.35f;
  return view;
}

float diagonal(const Points& points) {
  const Box3 box = box_of(points);
  return (box.high - box.low).norm();
}

/// About the diagonal of the body's box. Joints are inside the body, where its surface may have strays.
float size_of(const understudy::Rig& rig) {
  constexpr int kFew = 4;
  constexpr float kBeyondJoints = 1.15f;
  return rig.count() < kFew ? diagonal(rig.surface.vertices) : kBeyondJoints * diagonal(rig.rest_joints());
}

/// What is painted is seen.
BoneSurface surface_in(const Session& session, const PaneContent& pane) {
  const BoneSurface chosen = session.view.bone_surface;
  return chosen == BoneSurface::Off && paints_found_bones(session, pane) ? BoneSurface::Over : chosen;
}

/// Of the found rig in a frame of the source; null where it has no such frame.
const RigPose* pose_in(const DiscoveredRig& rig, int frame, const FoundPreview& preview) {
  const RigPose* const pose = at_or_null(rig.found.motion.poses, app::frame_of_rig(rig, frame));
  return pose != nullptr && preview.pose != nullptr ? preview.pose.get() : pose;
}

/// By bone, or by the weights of the one that is painted.
void paint_surface(const BonesInput& in, BonesMemory& memory) {
  const int selected = in.session.bones.selected;
  const bool painting = paints_found_bones(in.session, in.pane) && selected < memory.weights.cols();
  if (memory.colors->rows() > 0 && memory.selected == selected && memory.painting == painting) return;
  memory.selected = selected, memory.painting = painting;
  memory.values = nullptr;
  if (!painting) {
    memory.colors = surface_colors(memory.weights, selected);
    return;
  }
  memory.values = std::make_shared<const Eigen::VectorXf>(memory.weights.col(selected));
  memory.colors = render::colors_along(render::viridis, *memory.values, 0, 1);
}

void add_painted(const BonesInput& in, BonesMemory& memory, render::Scene& scene) {
  const Session& session = in.session;
  const int frame = in.pictures.frame;
  const auto& rig = session.bones.rig;
  const understudy::Rig& found = rig->found.rig;
  const RigPose* const pose = pose_in(*rig, frame, in.preview);
  if (pose == nullptr) return;
  const SkinWeights& skin = in.preview.skin != nullptr ? *in.preview.skin : found.skin;
  if (memory.of != rig) {
    memory = {};
    memory.of = rig;
    memory.faces = found.surface.faces;
    memory.spacing = point_spacing(found.surface.vertices);
  }
  if (memory.weights.rows() == 0 || memory.preview.skin != in.preview.skin)
    memory.weights = skin.dense(found.count()), memory.colors = {};
  paint_surface(in, memory);
  const Vec3 offset = in.aside + app::painted_place(session);
  if (memory.frame != frame || memory.offset != offset || memory.preview.pose != in.preview.pose ||
      memory.preview.skin != in.preview.skin) {
    memory.frame = frame, memory.offset = offset, memory.preview = in.preview;
    place_surface(found, skin, *pose, memory);
  }
  add_surface(found.surface, memory, {}, scene);
}

/// Where the scan of the frame stands, whichever frame it was found in.
void add_so_far(const BonesInput& in, BonesMemory& memory, render::Scene& scene) {
  const auto& found = in.session.bones.so_far;
  const auto& scan = in.pictures.scan;
  if (memory.of != found) {
    memory = {};
    memory.of = found, memory.colors = part_colors(found->bone_of);
    memory.spacing = point_spacing(found->points);
  }
  if (memory.vertices->rows() == 0 || memory.beside != scan || memory.offset != in.aside) {
    memory.beside = scan, memory.offset = in.aside;
    const Vec3 here = scan ? box_of(scan->mesh.vertices).floor() : Vec3::Zero();
    const Vec3 moved = in.aside + (scan ? Vec3(here - box_of(found->points).floor()) : Vec3::Zero());
    memory.vertices = Points(found->points.rowwise() + moved.transpose());
  }
  render::PointsView points;
  points.positions = memory.vertices, points.colors = memory.colors;
  if (memory.spacing > 0) points.radius = 0.7f * memory.spacing;
  scene.clouds.push_back(std::move(points));
  const Vec3 moved = memory.vertices->row(0).transpose() - found->points.row(0).transpose();
  Points joints(ssize(found->tree), 3);
  std::vector<int> parents;
  for (const RigJoint& joint : found->tree) {
    joints.row(ssize(parents)) = (joint.rest + moved).transpose();
    parents.push_back(joint.parent);
  }
  scene.skeletons.push_back(skeleton_of(joints, parents, diagonal(found->points)));
}

/// Pixels from a place to what lies between two others.
float pixels_off(const ImVec2& at, const ImVec2& a, const ImVec2& b) {
  const float x = b.x - a.x, y = b.y - a.y, length = x * x + y * y;
  const float t = length > 0 ? std::clamp(((at.x - a.x) * x + (at.y - a.y) * y) / length, 0.f, 1.f) : 0;
  return std::hypot(at.x - a.x - t * x, at.y - a.y - t * y);
}

}  // namespace

Points surface_colors(const RowMatrix& weights, int selected) {
  if (selected < 0 || selected >= weights.cols()) return render::weight_colors(weights);
  const Eigen::RowVector3f own = kSelectedColor.transpose(), other = kUnselected.transpose();
  const Eigen::VectorXf share = weights.col(selected);
  return share * own + (Eigen::VectorXf::Ones(share.size()) - share) * other;
}

void place_surface(const understudy::Rig& rig, const SkinWeights& skin, const RigPose& pose,
                   BonesMemory& memory) {
  const Points posed = skinned(rig.surface.vertices, skin, bone_motions(rig, pose));
  memory.vertices = Points(posed.rowwise() + memory.offset.transpose());
  if (!rig.surface.is_cloud()) memory.normals = vertex_normals(posed, rig.surface.faces);
}

void add_surface(const Mesh& mesh, const BonesMemory& memory, const BodyLook& look, render::Scene& scene) {
  if (mesh.is_cloud()) {
    render::PointsView points;
    points.positions = memory.vertices, points.colors = memory.colors;
    points.color = look.color, points.opacity = look.opacity;
    if (memory.spacing > 0) points.radius = 1.1f * memory.spacing;
    return scene.clouds.push_back(std::move(points));
  }
  render::MeshView view;
  view.vertices = memory.vertices, view.normals = memory.normals, view.colors = memory.colors;
  view.faces = memory.faces, view.color = look.color, view.opacity = look.opacity;
  scene.meshes.push_back(std::move(view));
}

bool hides_person(const Session& session) {
  return session.source.no_person && session.document.bones.wanted;
}

bool bones_hide_scan(const Session& session, const PaneContent& pane, int frame) {
  const app::BonesState& bones = session.bones;
  if (bones.so_far) return true;
  return bones.rig && surface_in(session, pane) == BoneSurface::Over &&
         app::frame_of_rig(*bones.rig, frame) >= 0;
}

std::optional<PosedBones> posed_bones(const Session& session, const PaneContent& pane, int frame,
                                      const FoundPreview& preview) {
  const auto& rig = session.bones.rig;
  if (!rig || !pane.source || !session.view.source.bones) return std::nullopt;
  const RigPose* const pose = pose_in(*rig, frame, preview);
  if (pose == nullptr) return std::nullopt;
  return posed_bones(rig->found.rig, *pose);
}

void add_bone_lines(const PosedBones& bones, const understudy::Rig& rig, const BonesLook& look,
                    render::Scene& scene) {
  const float size = size_of(rig);
  render::SkeletonView view = skeleton_of(bones.places, bones.parents, size);
  view.thickness *= look.thickness, view.x_ray = look.x_ray;
  scene.skeletons.push_back(view);
  if (look.selected < 0 || look.selected >= bones.joints) return;
  scene.skeletons.push_back(selected_bone(bones, look.selected, size));
}

PosedBones posed_bones(const understudy::Rig& found, const RigPose& pose) {
  const BoneMotions motions = bone_motions(found, pose);
  const std::vector<BoneTip> tips = bone_tips(found);
  PosedBones bones;
  bones.joints = found.count();
  bones.places.resize(found.count() + ssize(tips), 3);
  bones.places.topRows(found.count()) = joint_places(found, motions);
  for (const RigJoint& joint : found.joints) bones.parents.push_back(joint.parent);
  for (const BoneTip& tip : tips) {
    bones.places.row(ssize(bones.parents)) = motions[static_cast<size_t>(tip.joint)](tip.rest).transpose();
    bones.parents.push_back(tip.joint);
  }
  return bones;
}

void add_bones(const BonesInput& in, BonesMemory& memory, render::Scene& scene) {
  const Session& session = in.session;
  if (session.bones.so_far) return add_so_far(in, memory, scene);
  if (!session.bones.rig) return;
  if (surface_in(session, in.pane) != BoneSurface::Off) add_painted(in, memory, scene);
  auto bones = posed_bones(session, in.pane, in.pictures.frame, in.preview);
  if (!bones) return;
  bones->places.rowwise() += in.aside.transpose();
  BonesLook look{session.bones.selected, session.view.source.x_ray};
  if (session.view.source.skeleton && !hides_person(session)) look.thickness = kBesideJoints;
  add_bone_lines(*bones, session.bones.rig->found.rig, look, scene);
}

int bone_at(const PaneView& view, const PosedBones& bones, const ImVec2& at, float reach) {
  int nearest = -1;
  float least = reach;
  for (int i = 0; i < ssize(bones.parents); ++i) {
    const int parent = bones.parents[static_cast<size_t>(i)];
    const auto a = view.project(bones.places.row(std::max(0, parent))), b = view.project(bones.places.row(i));
    if (!a || !b) continue;
    const float off = pixels_off(at, *a, *b);
    if (off < least) least = off, nearest = parent < 0 ? i : parent;
  }
  return nearest;
}

std::vector<std::pair<int, ImVec2>> bone_middles(const PaneView& view, const PosedBones& bones) {
  std::vector<std::pair<int, ImVec2>> middles;
  for (int j = 0; j < bones.joints; ++j) {
    Vec3 end = bones.places.row(j);
    for (int i = ssize(bones.parents) - 1; i > j; --i)
      if (bones.parents[static_cast<size_t>(i)] == j) end = bones.places.row(i);
    const auto at = view.project(0.5f * (Vec3(bones.places.row(j)) + end));
    if (at && view.rect.contains(*at)) middles.emplace_back(j, *at);
  }
  return middles;
}

std::vector<Overlay::Label> bone_labels(const Session& session, const PaneView& view, const PosedBones& bones,
                                        int hovered) {
  std::vector<Overlay::Label> labels;
  const auto& joints = session.bones.rig->found.rig.joints;
  for (const auto& [joint, at] : bone_middles(view, bones)) {
    const bool strong = joint == hovered || joint == session.bones.selected;
    if (strong || session.view.source.joint_names)
      labels.push_back({at, joints[static_cast<size_t>(joint)].name, strong});
  }
  return labels;
}

std::string bone_words(const Session& session, int joint) {
  const app::BonesState& bones = session.bones;
  const auto& joints = bones.rig->found.rig.joints;
  const RigJoint& one = joints[static_cast<size_t>(joint)];
  std::string words = one.name + ": " + kJointKindNames[static_cast<size_t>(one.kind)];
  if (joint > 0)
    words += printed(", turns %.0f\u00b0",
                     static_cast<double>(bones.rig->bones[static_cast<size_t>(joint)].turned_deg));
  return words;
}

}  // namespace understudy::ui
