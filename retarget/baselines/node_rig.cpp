#include "retarget/baselines/node_rig.hpp"

#include <algorithm>
#include <limits>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

/// Node after node joins the tree where it is nearest (Prim): the nodes in that order, each with the place of
/// its parent in it.
struct NodeTree {
  std::vector<int> nodes, parents;
};
NodeTree shortest_tree(const Points& places) {
  const auto count = static_cast<int>(places.rows());
  NodeTree tree;
  std::vector<float> away(count, std::numeric_limits<float>::infinity());
  std::vector<int> nearest(count, -1);
  std::vector<char> taken(count, 0);
  for (int next = 0; next >= 0;) {
    const int at = static_cast<int>(tree.nodes.size());
    taken[next] = 1;
    tree.nodes.push_back(next);
    tree.parents.push_back(nearest[next]);
    int best = -1;
    for (int n = 0; n < count; ++n) {
      if (taken[n]) continue;
      const float d = (places.row(n) - places.row(next)).norm();
      if (d < away[n]) away[n] = d, nearest[n] = at;
      if (best < 0 || away[n] < away[best]) best = n;
    }
    next = best;
  }
  return tree;
}

/// The turn of what hangs on a node from offsets `from` to `to` [N, 3]; about what these leave open it turns
/// with its parent.
Mat3 node_turn(const Points& from, const Points& to, const Mat3& parent) {
  constexpr float kParentCounts = 1e-4f;
  const Eigen::Index count = from.rows();
  const float length = count > 0 ? std::max(from.rowwise().norm().mean(), 1e-6f) : 1;
  Points a(count + 3, 3), b(count + 3, 3);
  a << from, length * Mat3::Identity();
  b << to, length * parent.transpose();
  Eigen::VectorXf weights = Eigen::VectorXf::Ones(count + 3);
  weights.tail<3>().setConstant(kParentCounts);
  return kabsch(a, b, weights);
}

/// How each node moved from `rest` to `now` [J, 3].
BoneMotions node_motions(const Rig& rig, const Points& rest, const Points& now) {
  const std::vector<std::vector<int>> children = children_of(rig);
  BoneMotions bones(children.size());
  for (size_t j = 0; j < bones.size(); ++j) {
    const int parent = rig.joints[j].parent;
    const Points from = rest(children[j], Eigen::all).rowwise() - rest.row(j);
    const Points to = now(children[j], Eigen::all).rowwise() - now.row(j);
    bones[j].R = node_turn(from, to, parent >= 0 ? bones[parent].R : Mat3(Mat3::Identity()));
    bones[j].t = now.row(j).transpose() - bones[j].R * rest.row(j).transpose();
  }
  return bones;
}

}  // namespace

RiggedMotion node_rig(const std::vector<Points>& frames, double fps, int nodes) {
  US_CHECK(!frames.empty() && nodes > 0, nodes, " nodes cannot be followed through ", frames.size(),
           " frames");
  const Points first = finite_points(frames[0]);
  US_CHECK(first.rows() > 0, "frame 0 has no points");
  const int count = std::min<int>(nodes, static_cast<int>(first.rows()));
  Points places = first(farthest_points(first, count), Eigen::all);
  const NodeTree tree = shortest_tree(places);
  places = Points(places(tree.nodes, Eigen::all));
  RiggedMotion found;
  found.rig.name = "nodes";
  for (int j = 0; j < count; ++j)
    found.rig.joints.push_back({"node" + std::to_string(j), tree.parents[j],
                                j == 0 ? JointKind::Free : JointKind::Ball, places.row(j).transpose(),
                                Vec3::UnitY()});
  found.rig.surface.vertices = first;
  const IntMatrix nearest = nearest_neighbours(places, first, 1);
  found.rig.skin = SkinWeights::rigid({nearest.data(), nearest.data() + nearest.size()});
  found.motion.fps = fps;
  Points now = places;
  for (size_t t = 0; t < frames.size(); ++t) {
    const Points points = finite_points(frames[t]);
    US_CHECK(points.rows() > 0, "frame ", t, " has no points");
    const IntMatrix next = nearest_neighbours(points, now, 1);
    now = points(next.col(0), Eigen::all);
    found.motion.poses.push_back(pose_of(found.rig, node_motions(found.rig, places, now)));
  }
  return found;
}

}  // namespace understudy
