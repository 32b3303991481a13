#include "retarget/discovery/inner_joints.hpp"

#include <vector>

namespace understudy {
namespace {

constexpr int kLookedAt = 5, kBallsTried = 50;  // nearest ones
constexpr float kJustBelow = 0.02f;             // of the spacing of nodes

/// How far a place is above the surface, metres, by the tangent planes of the points near it.
float height_above(const ThinnedFrame& surface, const Vec3& place) {
  std::vector<PointTree::Near> found;
  surface.tree.nearest(place, kLookedAt, found);
  float sum = 0;
  for (const PointTree::Near& near : found)
    sum += surface.normals.row(near.point).dot(place.transpose() - surface.points.row(near.point));
  return sum / static_cast<float>(found.size());
}

}  // namespace

void draw_joints_inside(const ThinnedFrame& rest, const DeformationGraph& graph, Rig& rig) {
  const PointTree balls(graph.points - graph.radii.asDiagonal() * graph.normals);
  const auto inside = [&](const Vec3& place) {
    return height_above(rest, place) <= -kJustBelow * graph.spacing;
  };
  std::vector<PointTree::Near> found;
  for (int j = 1; j < rig.count(); ++j) {
    Vec3& joint = rig.joints[static_cast<size_t>(j)].rest;
    if (inside(joint)) continue;
    balls.nearest(joint, kBallsTried, found);
    for (const PointTree::Near& near : found) {
      const Vec3 middle = balls.points().row(near.point).transpose();
      if (!inside(middle)) continue;  // the ball of a point whose normal is wrong
      joint = middle;
      break;
    }
  }
}

}  // namespace understudy
