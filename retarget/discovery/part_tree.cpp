#include "retarget/discovery/part_tree.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "retarget/base/spanning_tree.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Pair = std::pair<int, int>;

constexpr float kDegrees = 180 / kPi;
constexpr float kFixedTurn_deg = 5, kFixedSlide = 0.008f;  // of the diagonal: less is no joint
constexpr float kSeamSpread = 0.04f;  // of the diagonal: how far a joint may be from its seam
constexpr float kHingeShare = 0.2f;   // of the main turn: what else a hinge turns, noise
constexpr float kHingeNoise_deg = 2;
constexpr float kSeamCost = 0.25f;      // of a metre from the seam, in metres carried apart
constexpr float kShortSeamCost = 0.1f;  // of the shortest seam, in node spacings,
constexpr int kWideSeam = 10;           // and of one of so many edges half as much

Mat3 mean_rotation(const std::vector<Mat3>& turns) {
  Mat3 sum = Mat3::Zero();
  for (const Mat3& R : turns) sum += R;
  return nearest_rotation(sum);
}

/// The direction in which vectors about their mean go most, and root mean squares along it and the next.
struct MainDirection {
  Vec3 axis = Vec3::UnitY();
  float first = 0, second = 0;
};
MainDirection main_direction(const std::vector<Vec3>& vectors) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : vectors) mean += v / static_cast<float>(vectors.size());
  Mat3 scatter = Mat3::Zero();
  for (const Vec3& v : vectors)
    scatter += (v - mean) * (v - mean).transpose() / static_cast<float>(vectors.size());
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(scatter);
  const Vec3 spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  Vec3 axis = solver.eigenvectors().col(2);
  Eigen::Index largest;
  axis.cwiseAbs().maxCoeff(&largest);
  if (axis[largest] < 0) axis = -axis;  // one of the two, always the same
  return {axis, spread[2], spread[1]};
}

Vec3 shared_place(const std::vector<RigidMotion>& parent, const std::vector<RigidMotion>& child,
                  const Vec3& seam, double seam_weight) {
  Eigen::Matrix3d A = seam_weight * static_cast<double>(parent.size()) * Eigen::Matrix3d::Identity();
  Eigen::Vector3d b = A * seam.cast<double>();
  for (size_t t = 0; t < parent.size(); ++t) {
    const Eigen::Matrix3d M = (parent[t].R - child[t].R).cast<double>();
    A += M.transpose() * M;
    b += M.transpose() * (child[t].t - parent[t].t).cast<double>();
  }
  return A.ldlt().solve(b).cast<float>();
}

/// The middles of the surface's edges that cross from one part to another, by the two parts. They count by
/// how thick the body is there: bones run in the thick of it, as in a wing.
struct Seam {
  Vec3 sum = Vec3::Zero();
  float weight = 0;
  int edges = 0;
  Vec3 middle() const { return sum / weight; }
};
std::map<Pair, Seam> find_seams(const SurfaceTracks& tracks, const RigidParts& parts) {
  constexpr float kTorn = 0.3f;  // of the spacing of nodes, longer than at rest: what only touched
  const DeformationGraph& graph = tracks.graph;
  std::map<Pair, Seam> seams, torn;
  for (size_t i = 0; i < parts.of_point.size(); ++i)
    for (const SurfaceGraph::Edge& edge : graph.surface.edges[i]) {
      const int a = parts.of_point[i], b = parts.of_point[static_cast<size_t>(edge.to)];
      if (a >= b) continue;  // each edge is there both ways
      const Vec3 pa = graph.points.row(static_cast<Eigen::Index>(i)).transpose(),
                 pb = graph.points.row(edge.to).transpose();
      float widest = 0;
      for (size_t t = 0; t < tracks.motions.size(); ++t)
        widest = std::max(widest, (parts.motions[static_cast<size_t>(a)][t](pa) -
                                   parts.motions[static_cast<size_t>(b)][t](pb))
                                      .norm());
      Seam& seam = (widest < edge.length + kTorn * graph.spacing ? seams : torn)[{a, b}];
      const float radius = std::min(graph.radii[static_cast<Eigen::Index>(i)], graph.radii[edge.to]);
      const float weight = radius * radius;
      seam.sum += weight * (pa + pb) / 2, seam.weight += weight;
      ++seam.edges;
    }
  UnionFind sets(static_cast<size_t>(parts.count()));
  for (const auto& [pair, seam] : seams) sets.join(pair.first, pair.second);
  for (const auto& [pair, seam] : torn)  // a piece that nothing else holds
    if (sets.root(pair.first) != sets.root(pair.second)) {
      seams[pair] = seam;
      sets.join(pair.first, pair.second);
    }
  return seams;
}

void relabel(RigidParts& parts, int from, int to) {
  std::replace(parts.of_point.begin(), parts.of_point.end(), from, to);
}

struct Link {
  int a, b;
  PartJoint joint;
  float cost;
};

std::vector<Link> links_of(const SurfaceTracks& tracks, const RigidParts& parts) {
  const float size = box_diagonal(tracks.graph.points);
  std::vector<Link> links;
  for (const auto& [pair, seam] : find_seams(tracks, parts)) {
    const auto [a, b] = pair;
    Link link{a, b,
              find_joint(parts.motions[static_cast<size_t>(a)], parts.motions[static_cast<size_t>(b)],
                         seam.middle(), parts.noise_m, size),
              0};
    link.cost =
        link.joint.off_m + kSeamCost * (link.joint.rest - seam.middle()).norm() +
        kShortSeamCost * tracks.graph.spacing * kWideSeam / static_cast<float>(kWideSeam + seam.edges);
    links.push_back(link);
  }
  std::stable_sort(links.begin(), links.end(), [](const Link& x, const Link& y) { return x.cost < y.cost; });
  return links;
}

Vec3 centre_of(const Points& points, const std::vector<int>& of_point, int part) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (size_t i = 0; i < of_point.size(); ++i)
    if (of_point[i] == part) sum += points.row(static_cast<Eigen::Index>(i)).transpose(), ++count;
  return sum / static_cast<float>(std::max(count, 1));
}

/// The largest of what stands still, on which the others move; else the central part.
int root_of(const SurfaceTracks& tracks, const RigidParts& parts, const std::vector<Link>& tree,
            const std::vector<int>& sizes) {
  const float size = box_diagonal(tracks.graph.points);
  int root = -1;
  for (int p = 0; p < parts.count(); ++p)
    if (stands_still(parts.motions[static_cast<size_t>(p)], centre_of(tracks.graph.points, parts.of_point, p),
                     size) &&
        (root < 0 || sizes[static_cast<size_t>(p)] > sizes[static_cast<size_t>(root)]))
      root = p;
  return root >= 0 ? root : central_node(tree, sizes);
}

/// A part that hardly moves against one beside it becomes one with it; false where there is none.
bool join_fixed(const SurfaceTracks& tracks, RigidParts& parts) {
  const float least = kFixedSlide * box_diagonal(tracks.graph.points);
  for (const Link& link : spanning_tree(links_of(tracks, parts), parts.count())) {
    if (link.joint.kind != JointKind::Fixed || link.joint.off_m > least) continue;
    relabel(parts, link.b, link.a);
    return true;
  }
  return false;
}

}  // namespace

PartJoint find_joint(const std::vector<RigidMotion>& parent, const std::vector<RigidMotion>& child,
                     const Vec3& seam, float noise_m, float size_m) {
  const double share = noise_m / (kSeamSpread * size_m);
  PartJoint joint;
  joint.rest = shared_place(parent, child, seam, share * share);
  std::vector<Mat3> turns;
  std::vector<Vec3> slides, vectors;
  double off = 0;
  for (size_t t = 0; t < parent.size(); ++t) {
    turns.push_back(parent[t].R.transpose() * child[t].R);
    const Vec3 apart = child[t](joint.rest) - parent[t](joint.rest);
    slides.push_back(parent[t].R.transpose() * apart);
    off += apart.squaredNorm();
  }
  const Mat3 mean = mean_rotation(turns);
  for (const Mat3& R : turns) {
    vectors.push_back(rotation_to_axis_angle(mean.transpose() * R));
  }
  joint.off_m = static_cast<float>(std::sqrt(off / static_cast<double>(parent.size())));
  const MainDirection turn = main_direction(vectors), slide = main_direction(slides);
  // Of a swing.
  const float end_to_end = 2 * std::sqrt(2.0f);
  const bool turns_much = end_to_end * kDegrees * turn.first > kFixedTurn_deg,
             slides_much = end_to_end * slide.first > kFixedSlide * size_m;
  if (!turns_much) {
    joint.kind = slides_much ? JointKind::Slider : JointKind::Fixed;
    joint.axis = slide.axis;
  } else if (turn.second < std::max(kHingeShare * turn.first, kHingeNoise_deg / kDegrees)) {
    joint.kind = JointKind::Hinge;
    joint.axis = turn.axis;
  }
  return joint;
}

bool stands_still(const std::vector<RigidMotion>& motions, const Vec3& at, float size_m) {
  constexpr float kMoved = 0.003f, kTurned = 0.02f;
  return std::all_of(motions.begin(), motions.end(), [&](const RigidMotion& motion) {
    return (motion(at) - at).norm() < kMoved * size_m && (motion.R - Mat3::Identity()).norm() < kTurned;
  });
}

PartTree find_part_tree(const SurfaceTracks& tracks, RigidParts& parts) {
  while (parts.count() > 1 && join_fixed(tracks, parts)) refit(tracks, parts);
  const std::vector<Link> tree = spanning_tree(links_of(tracks, parts), parts.count());
  std::vector<int> sizes(static_cast<size_t>(parts.count()), 0), bone(sizes.size(), -1);
  for (const int part : parts.of_point) ++sizes[static_cast<size_t>(part)];
  PartTree found;
  for (const auto& [part, l] : outwards_from(root_of(tracks, parts, tree, sizes), tree)) {
    RigJoint joint{"bone " + std::to_string(found.rig.count()), -1, JointKind::Free,
                   centre_of(tracks.graph.points, parts.of_point, part), Vec3::UnitY()};
    if (l >= 0) {
      const Link& link = tree[static_cast<size_t>(l)];
      joint.parent = bone[static_cast<size_t>(other_end(link, part))];
      joint.kind = link.joint.kind;
      joint.rest = link.joint.rest;
      joint.axis = link.joint.axis;
    }
    bone[static_cast<size_t>(part)] = found.rig.count();
    found.rig.joints.push_back(joint);
    found.part_of_bone.push_back(part);
  }
  return found;
}

}  // namespace understudy
