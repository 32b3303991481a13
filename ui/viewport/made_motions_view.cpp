#include "ui/viewport/made_motions_view.hpp"

#include "retarget/geometry/cloud_normals.hpp"

namespace understudy::ui {
namespace {

constexpr float kPale = 0.5f, kGhostly = 0.75f;  // share of white, opacity
constexpr float kKeptOpacity = 0.95f;            // of what is a clip already

}  // namespace

void add_made_motion(const DiscoveredRig& found, const app::ShownMotion& shown, const Vec3& aside,
                     BonesMemory& memory, render::Scene& scene) {
  const Rig& rig = found.found.rig;
  if (memory.of != shown.made) {
    memory = {};
    memory.of = shown.made, memory.faces = rig.surface.faces;
    memory.spacing = point_spacing(rig.surface.vertices);
  }
  const Vec3 place = aside + shown.place;
  const int frame = static_cast<int>(shown.pose - shown.made->motion.poses.data());
  if (memory.frame != frame || memory.offset != place) {
    memory.frame = frame, memory.offset = place;
    place_surface(rig, rig.skin, *shown.pose, memory);
  }
  const ImVec4 of = made_color(shown.seed());
  const Vec3 color = (1 - kPale) * Vec3(of.x, of.y, of.z) + kPale * Vec3::Ones();
  add_surface(rig.surface, memory, {color, shown.clip < 0 ? kGhostly : kKeptOpacity}, scene);
}

}  // namespace understudy::ui
