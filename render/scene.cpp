#include "render/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/geometry/cloud_normals.hpp"

namespace understudy::render {

LightView turned_light(float turn_deg, float height_deg, float brightness) {
  LightView light;
  for (Vec3* const part : {&light.key, &light.fill, &light.sky, &light.floor}) *part *= brightness;
  if (turn_deg == 0 && height_deg == 0) return light;
  const Vec3& from = light.key_direction;
  const float degree = kPi / 180, most = 89 * degree;
  const float turn = std::atan2(from.x(), from.z()) + turn_deg * degree;
  const float height = std::asin(from.y() / from.norm()) + height_deg * degree;
  const float up = std::clamp(height, -most, most);
  light.key_direction = {std::sin(turn) * std::cos(up), std::sin(up), std::cos(turn) * std::cos(up)};
  return light;
}

SkeletonView skeleton_view(const Joints& joints) {
  SkeletonView view;
  view.joints = joints;
  view.parents.assign(kParents.begin(), kParents.end());
  for (int j = 0; j < kJointCount; ++j)
    view.sides.push_back(kMirror[j] == j            ? Side::Middle
                         : kJointNames[j][0] == 'l' ? Side::Left
                                                    : Side::Right);
  return view;
}

void add(Scene& scene, const Mesh& mesh) {
  if (mesh.is_cloud()) {
    PointsView view;
    view.positions = mesh.vertices;
    const float spacing = point_spacing(mesh.vertices);
    view.normals = estimated_normals(mesh.vertices, 3 * spacing);
    if (spacing > 0) view.radius = spacing;
    view.colors = mesh.colors;
    scene.clouds.push_back(std::move(view));
  } else {
    MeshView view;
    view.vertices = mesh.vertices;
    view.faces = mesh.faces;
    view.colors = mesh.colors;
    scene.meshes.push_back(std::move(view));
  }
}

LinesView trail(const Points& points, const Vec3& color, float width) {
  LinesView view;
  view.positions = points;
  view.color = color;
  view.width = width;
  view.opacities = Eigen::VectorXf::LinSpaced(points.rows(), 0, 1);
  return view;
}

LinesView box(const Vec3& low, const Vec3& high, const Vec3& color, float width) {
  LinesView view;
  view.connected = false;
  view.color = color;
  view.width = width;
  view.positions.resize(24, 3);
  Eigen::Index row = 0;
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) continue;  // each edge from its lower end
      for (const int end : {corner, corner | 1 << axis})
        for (int k = 0; k < 3; ++k)
          view.positions(row + (end != corner), k) = (end >> k & 1) != 0 ? high[k] : low[k];
      row += 2;
    }
  return view;
}

Points all_points(const Scene& scene) {
  std::vector<const Points*> parts;
  for (const auto& mesh : scene.meshes) parts.push_back(&*mesh.vertices);
  for (const auto& cloud : scene.clouds) parts.push_back(&*cloud.positions);
  for (const auto& skeleton : scene.skeletons) parts.push_back(&skeleton.joints);
  Eigen::Index rows = 0, used = 0;
  for (const Points* part : parts) rows += part->rows();
  Points all(rows, 3);
  for (const Points* part : parts)
    for (Eigen::Index i = 0; i < part->rows(); ++i)
      if (part->row(i).allFinite()) all.row(used++) = part->row(i);
  all.conservativeResize(used, 3);
  return all;
}

}  // namespace understudy::render
