#include "retarget/discovery/surface_tracking.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <thread>
#include <utility>

#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Block = Eigen::Matrix<double, 6, 6>;
using Rows3x6 = Eigen::Matrix<double, 3, 6>;

/// How a frame is fitted, first to last round. Lengths in node spacings.
struct Schedule {
  int rounds;
  float first_radius, last_radius;         // scale of what counts as off the scan
  double first_stiffness, last_stiffness;  // of an edge, in matches
};
// Bones have said what belongs together: from a fit hardly anything else has to.
constexpr Schedule kFromTheFrameBefore = {10, 1.2f, 0.35f, 20, 1}, kFromAFit = {4, 0.5f, 0.35f, 0.7, 0.3};
constexpr float kReach = 2.5f;        // in radii: no match beyond
constexpr float kJointScale = 0.06f;  // neighbours that disagree so much count a quarter
constexpr float kPlain = 0.04f;       // weight of the distance beside that along the normal
constexpr float kTorn = 0.6f;         // of an edge's length: neighbours further off are torn apart
constexpr float kDamping = 1e-3f;

double robust(double squared, double scale) {
  const double share = scale * scale / (scale * scale + squared);
  return share * share;
}

/// The normal equations of all nodes: blocks of 6 x 6 for each node and each pair that depends on each other.
class NodeEquations {
 public:
  explicit NodeEquations(const DeformationGraph& graph);
  void clear();
  /// r^T W r for a point at r that is moved by the step J dx: of node nodes[k] J is rows[k].
  void add_point(const std::array<int, kNodesOfPoint>& nodes, const std::array<Rows3x6, kNodesOfPoint>& rows,
                 const Eigen::Vector3d& residual, const Eigen::Matrix3d& weight);
  /// The same for three rows that two nodes have part in.
  void add_pair(int a, int b, const Rows3x6& of_a, const Rows3x6& of_b, const Eigen::Vector3d& residual,
                double weight);
  /// The steps of all nodes, [6 G]: turn, then move.
  Eigen::VectorXd solve(double damping);

 private:
  int& block_of(int a, int b) { return index_[static_cast<size_t>(a) * count_ + static_cast<size_t>(b)]; }

  size_t count_;
  std::vector<int> index_;                  // of a pair's block, a >= b
  std::vector<std::pair<int, int>> pairs_;  // of the blocks
  std::vector<Block> blocks_;
  Eigen::VectorXd gradient_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  bool analysed_ = false;
};

NodeEquations::NodeEquations(const DeformationGraph& graph)
    : count_(static_cast<size_t>(graph.count())), index_(count_ * count_, -1) {
  const auto need = [this](int a, int b) {
    if (a < b) std::swap(a, b);
    if (block_of(a, b) >= 0) return;
    block_of(a, b) = static_cast<int>(pairs_.size());
    pairs_.push_back({a, b});
  };
  for (int k = 0; k < graph.count(); ++k) need(k, k);
  for (Eigen::Index i = 0; i < graph.near.rows(); ++i)
    for (int k = 0; k < kNodesOfPoint; ++k)
      for (int l = 0; l <= k; ++l) need(graph.near(i, k), graph.near(i, l));
  for (const DeformationGraph::Edge& edge : graph.edges) need(edge.a, edge.b);
  blocks_.resize(pairs_.size());
  gradient_.resize(static_cast<Eigen::Index>(6 * count_));
}

void NodeEquations::clear() {
  for (Block& block : blocks_) block.setZero();
  gradient_.setZero();
}

void NodeEquations::add_point(const std::array<int, kNodesOfPoint>& nodes,
                              const std::array<Rows3x6, kNodesOfPoint>& rows, const Eigen::Vector3d& residual,
                              const Eigen::Matrix3d& weight) {
  const Eigen::Vector3d pull = weight * residual;
  for (size_t k = 0; k < kNodesOfPoint; ++k) {
    gradient_.segment<6>(6 * nodes[k]).noalias() -= rows[k].transpose() * pull;
    const Eigen::Matrix<double, 6, 3> weighed = rows[k].transpose() * weight;
    for (size_t l = 0; l < kNodesOfPoint; ++l)  // a point's nodes differ; pairs are kept once
      if (nodes[k] >= nodes[l])
        blocks_[static_cast<size_t>(block_of(nodes[k], nodes[l]))].noalias() += weighed * rows[l];
  }
}

void NodeEquations::add_pair(int a, int b, const Rows3x6& of_a, const Rows3x6& of_b,
                             const Eigen::Vector3d& residual, double weight) {
  gradient_.segment<6>(6 * a) -= weight * of_a.transpose() * residual;
  gradient_.segment<6>(6 * b) -= weight * of_b.transpose() * residual;
  blocks_[static_cast<size_t>(block_of(a, a))].noalias() += weight * of_a.transpose() * of_a;
  blocks_[static_cast<size_t>(block_of(b, b))].noalias() += weight * of_b.transpose() * of_b;
  if (a > b)
    blocks_[static_cast<size_t>(block_of(a, b))].noalias() += weight * of_a.transpose() * of_b;
  else
    blocks_[static_cast<size_t>(block_of(b, a))].noalias() += weight * of_b.transpose() * of_a;
}

Eigen::VectorXd NodeEquations::solve(double damping) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * pairs_.size());
  for (size_t p = 0; p < pairs_.size(); ++p) {
    const auto [a, b] = pairs_[p];
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        if (a != b || c <= r)
          entries.emplace_back(6 * a + r, 6 * b + c, blocks_[p](r, c) + (a == b && r == c ? damping : 0.0));
  }
  Eigen::SparseMatrix<double> matrix(gradient_.size(), gradient_.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  if (!analysed_) solver_.analyzePattern(matrix);
  analysed_ = true;
  solver_.factorize(matrix);
  return solver_.solve(gradient_);
}

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Follows one direction of time.
class Follower {
 public:
  explicit Follower(const DeformationGraph& graph)
      : graph_(graph), equations_(graph), pull_(graph.edges.size(), 1) {}
  /// Moves `motions` so that the surface lies on the scan.
  void fit(const ThinnedFrame& scan, const Schedule& schedule, NodeMotions& motions);

 private:
  void match_points(const ThinnedFrame& scan, float radius, const NodeMotions& motions);
  void add_match(int point, const Vec3& to, const Vec3& normal, float radius, const NodeMotions& motions);
  void hold_together(double stiffness, const NodeMotions& motions);
  void apply(const Eigen::VectorXd& step, NodeMotions& motions) const;
  Points normals_now(const NodeMotions& motions) const;

  const DeformationGraph& graph_;
  NodeEquations equations_;
  std::vector<double> pull_;  // of each edge: 1, less where it was torn
  Points posed_, normals_;    // of the surface in the round that is made
};

Points Follower::normals_now(const NodeMotions& motions) const {
  Points turned(graph_.normals.rows(), 3);
  for (Eigen::Index i = 0; i < turned.rows(); ++i)
    turned.row(i) = graph_.normals.row(i) * motions[static_cast<size_t>(graph_.near(i, 0))].R.transpose();
  return turned;
}

void Follower::add_match(int point, const Vec3& to, const Vec3& normal, float radius,
                         const NodeMotions& motions) {
  const Vec3 x = posed_.row(point).transpose(), off = x - to;
  const Eigen::Vector3d n = normal.cast<double>();
  const Eigen::Matrix3d weight =
      robust(off.squaredNorm(), radius) * (n * n.transpose() + kPlain * Eigen::Matrix3d::Identity());
  std::array<int, kNodesOfPoint> nodes;
  std::array<Rows3x6, kNodesOfPoint> rows;
  for (int k = 0; k < kNodesOfPoint; ++k) {
    const int node = graph_.near(point, k);
    const Vec3 arm = motions[static_cast<size_t>(node)].R *
                     (graph_.points.row(point) - graph_.nodes.row(node)).transpose();
    nodes[static_cast<size_t>(k)] = node;
    rows[static_cast<size_t>(k)] << -cross_matrix(arm), Eigen::Matrix3d::Identity();
    rows[static_cast<size_t>(k)] *= graph_.shares(point, k);
  }
  equations_.add_point(nodes, rows, off.cast<double>(), weight);
}

void Follower::match_points(const ThinnedFrame& scan, float radius, const NodeMotions& motions) {
  posed_ = deformed(graph_, motions);
  normals_ = normals_now(motions);
  const float reach2 = kReach * kReach * radius * radius;
  const auto agree = [](const auto& a, const auto& b) { return a.dot(b) > 0.3f; };
  for (int i = 0; i < static_cast<int>(posed_.rows()); ++i) {
    const PointTree::Near near = scan.tree.nearest(posed_.row(i).transpose());
    if (near.squared > reach2 || !agree(normals_.row(i), scan.normals.row(near.point))) continue;
    add_match(i, scan.points.row(near.point).transpose(), scan.normals.row(near.point).transpose(), radius,
              motions);
  }
  const PointTree tree(posed_);
  for (int q = 0; q < scan.spread; ++q) {
    const Vec3 at = scan.points.row(q).transpose();
    const PointTree::Near near = tree.nearest(at);
    if (near.squared > reach2 || !agree(normals_.row(near.point), scan.normals.row(q))) continue;
    add_match(near.point, at, scan.normals.row(q).transpose(), radius, motions);
  }
}

/// Where neighbours see each other: |T_a g - T_b g| for both nodes g of an edge.
void Follower::hold_together(double stiffness, const NodeMotions& motions) {
  const double scale = kJointScale * graph_.spacing;
  for (size_t e = 0; e < graph_.edges.size(); ++e) {
    const auto [a, b, length] = graph_.edges[e];
    const RigidMotion &A = motions[static_cast<size_t>(a)], &B = motions[static_cast<size_t>(b)];
    const Vec3 ga = graph_.nodes.row(a).transpose(), gb = graph_.nodes.row(b).transpose();
    const Vec3 pa = A(ga), pb = B(gb);
    for (const Vec3& g : {ga, gb}) {
      const Vec3 of_a = A(g), of_b = B(g), off = of_a - of_b;
      Rows3x6 rows_a, rows_b;
      rows_a << -cross_matrix(of_a - pa), Eigen::Matrix3d::Identity();
      rows_b << cross_matrix(of_b - pb), -Eigen::Matrix3d::Identity();
      equations_.add_pair(a, b, rows_a, rows_b, off.cast<double>(),
                          stiffness * pull_[e] * std::max(0.1, std::sqrt(robust(off.squaredNorm(), scale))));
    }
  }
}

void Follower::apply(const Eigen::VectorXd& step, NodeMotions& motions) const {
  for (int k = 0; k < graph_.count(); ++k) {
    RigidMotion& motion = motions[static_cast<size_t>(k)];
    motion = stepped(motion, graph_.nodes.row(k).transpose(), step.segment<6>(6 * k).cast<float>());
  }
}

void Follower::fit(const ThinnedFrame& scan, const Schedule& schedule, NodeMotions& motions) {
  for (int round = 0; round < schedule.rounds; ++round) {
    const float share = static_cast<float>(round) / static_cast<float>(schedule.rounds - 1);
    const float radius = graph_.spacing * schedule.first_radius *
                         std::pow(schedule.last_radius / schedule.first_radius, share);
    const double stiffness =
        schedule.first_stiffness * std::pow(schedule.last_stiffness / schedule.first_stiffness, share);
    equations_.clear();
    match_points(scan, radius, motions);
    hold_together(stiffness, motions);
    apply(equations_.solve(kDamping), motions);
  }
  for (size_t e = 0; e < graph_.edges.size(); ++e) {
    const auto [a, b, length] = graph_.edges[e];
    const Vec3 ga = graph_.nodes.row(a).transpose(), gb = graph_.nodes.row(b).transpose();
    const float now = (motions[static_cast<size_t>(a)](ga) - motions[static_cast<size_t>(b)](gb)).norm();
    if (now > (1 + kTorn) * length) pull_[e] = std::min(pull_[e], 0.02);
  }
}

}  // namespace

SurfaceTracks track_surface(const std::vector<ThinnedFrame>& frames, int rest_frame, int nodes,
                            const TrackingProgress& progress) {
  SurfaceTracks tracks{deformation_graph(frames[static_cast<size_t>(rest_frame)], nodes), rest_frame, {}};
  const NodeMotions still(static_cast<size_t>(tracks.graph.count()));
  tracks.motions.assign(frames.size(), still);
  std::atomic<bool> goes_on{true};
  const auto follow = [&](int step) {
    Follower follower(tracks.graph);
    NodeMotions before = still, last = still;
    for (int t = rest_frame + step; t >= 0 && t < static_cast<int>(frames.size()); t += step) {
      NodeMotions& now = tracks.motions[static_cast<size_t>(t)];
      now = goes_on ? led_on(before, last, tracks.graph.nodes) : last;
      if (goes_on) follower.fit(frames[static_cast<size_t>(t)], kFromTheFrameBefore, now);
      before = std::exchange(last, now);
      if (goes_on && progress && !progress()) goes_on = false;
    }
  };
  std::thread backwards(follow, -1);
  follow(1);
  backwards.join();
  return tracks;
}

void track_again(const std::vector<ThinnedFrame>& frames, SurfaceTracks& tracks,
                 const TrackingProgress& progress) {
  std::atomic<bool> goes_on{true};
  const auto follow = [&](size_t first, size_t end) {
    Follower follower(tracks.graph);
    for (size_t t = first; t < end && goes_on; ++t) {
      follower.fit(frames[t], kFromAFit, tracks.motions[t]);
      if (progress && !progress()) goes_on = false;
    }
  };
  const size_t middle = frames.size() / 2;
  std::thread first_half(follow, 0, middle);
  follow(middle, frames.size());
  first_half.join();
}

}  // namespace understudy
