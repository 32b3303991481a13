#include "ui/viewport/second_body_view.hpp"

#include "app/session/follow.hpp"
#include "app/session/made_motions.hpp"
#include "retarget/geometry/cloud_normals.hpp"

namespace understudy::ui {
namespace {

/// [V, bones of the found rig]: each vertex has the weights of the bones that lead it.
RowMatrix weights_by_partner(const Rig& rig, const BoneMatches& matches, int found) {
  const RowMatrix own = rig.skin.dense(rig.count());
  const std::vector<int> leaders = led_by(rig, matches);
  RowMatrix weights = RowMatrix::Zero(own.rows(), found);
  for (Eigen::Index k = 0; k < own.cols(); ++k)
    weights.col(matches.partner[static_cast<size_t>(leaders[static_cast<size_t>(k)])]) += own.col(k);
  return weights;
}

/// Where it is shown, in a pose.
void pose_surface(const RiggedMotion& body, int pose, const Vec3& place, BonesMemory& memory) {
  if (memory.frame == pose && memory.offset == place) return;
  memory.frame = pose, memory.offset = place;
  place_surface(body.rig, body.rig.skin, body.motion.poses[static_cast<size_t>(pose)], memory);
}

/// By the bones that it performs, where the found body is painted by bone; else plain.
void paint(const app::Session& session, BonesMemory& memory) {
  const bool painted = session.view.bone_surface != app::BoneSurface::Off;
  const int selected = session.bones.selected;
  if (painted == (memory.colors->rows() > 0) && memory.selected == selected) return;
  memory.selected = selected;
  memory.colors = painted ? surface_colors(memory.weights, selected) : Points(0, 3);
}

}  // namespace

void add_second_body(const app::Session& session, int frame, const Vec3& aside, BonesMemory& memory,
                     render::Scene& scene) {
  const auto& body = session.second.performed;
  const auto& found = session.bones.rig;
  const int at = app::second_pose(session, frame);
  if (at < 0) return;
  const BoneMatches& matches = session.second.matches;
  const Mesh& surface = body->rig.surface;
  const Vec3 place = aside + app::second_place(session);
  if (memory.of != body) {
    memory = {};
    memory.of = body, memory.faces = surface.faces;
    memory.weights = weights_by_partner(body->rig, matches, found->found.rig.count());
    memory.spacing = point_spacing(surface.vertices);
  }
  paint(session, memory);
  pose_surface(*body, at, place, memory);
  add_surface(surface, memory, {}, scene);
  if (!session.view.source.bones) return;
  PosedBones posed = posed_bones(body->rig, body->motion.poses[static_cast<size_t>(at)]);
  posed.places.rowwise() += place.transpose();
  add_bone_lines(posed, body->rig, {performer_of(matches, session.bones.selected), session.view.source.x_ray},
                 scene);
}

}  // namespace understudy::ui
