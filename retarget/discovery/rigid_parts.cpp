#include "retarget/discovery/rigid_parts.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Vec3d = Eigen::Vector3d;
using Mat3d = Eigen::Matrix3d;

static const float kLeastNoise = getenv("NOISE")?atof(getenv("NOISE")):0.002f;  // of the body's diagonal: nothing is followed better than that
constexpr int kSettlingRounds = 6;

/// What is known of a set of points in every frame: all that the best rigid motion depends on.
struct Moments {
  double weight = 0, squared = 0;  // of the points at rest
  Vec3d sum = Vec3d::Zero();
  struct Frame {
    Vec3d sum = Vec3d::Zero();
    Mat3d cross = Mat3d::Zero();  // posed x rest^T
    double squared = 0;
  };
  std::vector<Frame> frames;

  void add(const Moments& other) {
    weight += other.weight;
    squared += other.squared;
    sum += other.sum;
    frames.resize(other.frames.size());
    for (size_t t = 0; t < frames.size(); ++t) {
      frames[t].sum += other.frames[t].sum;
      frames[t].cross += other.frames[t].cross;
      frames[t].squared += other.frames[t].squared;
    }
  }
  Mat3d centred(size_t t) const { return frames[t].cross - frames[t].sum * sum.transpose() / weight; }
  /// Sum of squared distances after each frame's best rigid motion.
  double residual() const;
  RigidMotion best(size_t t) const;
};

/// The largest trace(R^T M) over rotations.
double best_trace(const Mat3d& M) {
  Eigen::SelfAdjointEigenSolver<Mat3d> solver;
  solver.computeDirect(M.transpose() * M, Eigen::EigenvaluesOnly);
  const Vec3d singular = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  return singular[2] + singular[1] + (M.determinant() < 0 ? -singular[0] : singular[0]);
}

double Moments::residual() const {
  const double rest = squared - sum.squaredNorm() / weight;
  double total = 0;
  for (size_t t = 0; t < frames.size(); ++t) {
    const double posed = frames[t].squared - frames[t].sum.squaredNorm() / weight;
    total += std::max(0.0, rest + posed - 2 * best_trace(centred(t)));
  }
  return total;
}

RigidMotion Moments::best(size_t t) const {
  RigidMotion motion;
  motion.R = nearest_rotation(centred(t).cast<float>());
  motion.t = (frames[t].sum / weight).cast<float>() - motion.R * (sum / weight).cast<float>();
  return motion;
}

/// Of every node: its points weigh 1 together, since they move alike.
std::vector<Moments> node_moments(const SurfaceTracks& tracks) {
  const DeformationGraph& graph = tracks.graph;
  const std::vector<int> node = graph.nearest_nodes();
  std::vector<double> points(static_cast<size_t>(graph.count()), 0);
  for (const int k : node) points[static_cast<size_t>(k)] += 1;
  std::vector<Moments> moments(points.size());
  const size_t frames = tracks.motions.size();
  for (Moments& m : moments) m.frames.resize(frames);
  for (size_t i = 0; i < node.size(); ++i) {
    Moments& m = moments[static_cast<size_t>(node[i])];
    const double w = 1 / points[static_cast<size_t>(node[i])];
    const Vec3d x = graph.points.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
    m.weight += w, m.sum += w * x, m.squared += w * x.squaredNorm();
  }
  for (size_t t = 0; t < frames; ++t) {
    const Points posed = tracks.at(static_cast<int>(t));
    for (size_t i = 0; i < node.size(); ++i) {
      Moments::Frame& m = moments[static_cast<size_t>(node[i])].frames[t];
      const double w = 1 / points[static_cast<size_t>(node[i])];
      const auto row = static_cast<Eigen::Index>(i);
      const Vec3d x = graph.points.row(row).transpose().cast<double>(),
                  y = posed.row(row).transpose().cast<double>();
      m.sum += w * y, m.cross += w * y * x.transpose(), m.squared += w * y.squaredNorm();
    }
  }
  return moments;
}

std::vector<std::vector<int>> neighbours_of(const DeformationGraph& graph) {
  std::vector<std::vector<int>> near(static_cast<size_t>(graph.count()));
  for (const DeformationGraph::Edge& edge : graph.edges) {
    near[static_cast<size_t>(edge.a)].push_back(edge.b);
    near[static_cast<size_t>(edge.b)].push_back(edge.a);
  }
  return near;
}

/// How far points are from rigid motions where the surface is most nearly rigid: about a quarter of the nodes
/// lies in the middle of a part.
float noise_of(const SurfaceTracks& tracks, const std::vector<Moments>& moments) {
  const auto near = neighbours_of(tracks.graph);
  std::vector<double> off;
  for (size_t k = 0; k < moments.size(); ++k) {
    if (moments[k].weight <= 0) continue;
    Moments ring;
    ring.add(moments[k]);
    for (const int n : near[k]) ring.add(moments[static_cast<size_t>(n)]);
    off.push_back(std::sqrt(ring.residual() / (ring.weight * static_cast<double>(ring.frames.size()))));
  }
  return std::max(static_cast<float>(percentile(off, 25)), kLeastNoise * box_diagonal(tracks.graph.points));
}

/// Sets of nodes that grow by joining.
class Agglomeration {
 public:
  Agglomeration(const SurfaceTracks& tracks, std::vector<Moments> moments);
  /// Joins the two sets that lose least by it while they lose less than `allowed`, or are more than `most`.
  void join_while(double allowed, int most);
  std::vector<int> labels() const;

 private:
  using Pair = std::pair<int, int>;
  void price(int a, int b);
  void join(int a, int b);

  std::vector<Moments> moments_;
  std::vector<double> residual_;
  std::vector<std::set<int>> near_;
  std::vector<int> set_of_;  // of each node
  std::map<Pair, double> cost_;
  std::set<std::pair<double, Pair>> queue_;
  int count_;
};

Agglomeration::Agglomeration(const SurfaceTracks& tracks, std::vector<Moments> moments)
    : moments_(std::move(moments)), near_(moments_.size()), count_(0) {
  for (size_t k = 0; k < moments_.size(); ++k) {
    set_of_.push_back(static_cast<int>(k));
    residual_.push_back(moments_[k].weight > 0 ? moments_[k].residual() : 0);
    ++count_;
  }
  for (const DeformationGraph::Edge& edge : tracks.graph.edges) price(edge.a, edge.b);
}

void Agglomeration::price(int a, int b) {
  if (a > b) std::swap(a, b);
  Moments both = moments_[static_cast<size_t>(a)];
  both.add(moments_[static_cast<size_t>(b)]);
  const double cost = both.weight > 0 ? both.residual() - residual_[static_cast<size_t>(a)] -
                                            residual_[static_cast<size_t>(b)]
                                      : 0;
  near_[static_cast<size_t>(a)].insert(b);
  near_[static_cast<size_t>(b)].insert(a);
  cost_[{a, b}] = cost;
  queue_.insert({cost, {a, b}});
}

void Agglomeration::join(int a, int b) {
  moments_[static_cast<size_t>(a)].add(moments_[static_cast<size_t>(b)]);
  residual_[static_cast<size_t>(a)] =
      moments_[static_cast<size_t>(a)].weight > 0 ? moments_[static_cast<size_t>(a)].residual() : 0;
  std::set<int> near = near_[static_cast<size_t>(a)];
  near.insert(near_[static_cast<size_t>(b)].begin(), near_[static_cast<size_t>(b)].end());
  near.erase(a), near.erase(b);
  const auto forget = [&](int x, int y) {
    const auto found = cost_.find(std::minmax(x, y));
    if (found == cost_.end()) return;
    queue_.erase({found->second, found->first});
    cost_.erase(found);
  };
  forget(a, b);
  for (const int n : near) forget(a, n), forget(b, n), near_[static_cast<size_t>(n)].erase(b);
  near_[static_cast<size_t>(a)].clear(), near_[static_cast<size_t>(b)].clear();
  for (const int n : near) price(a, n);
  for (int& set : set_of_)
    if (set == b) set = a;
  --count_;
}

void Agglomeration::join_while(double allowed, int most) {
  while (!queue_.empty()) {
    const auto [cost, pair] = *queue_.begin();
    if (cost > allowed && (most <= 0 || count_ <= most)) return;
    join(pair.first, pair.second);
  }
}

std::vector<int> Agglomeration::labels() const {
  std::map<int, int> number;
  std::vector<int> labels;
  for (const int set : set_of_)
    labels.push_back(number.emplace(set, static_cast<int>(number.size())).first->second);
  return labels;
}

std::vector<Moments> part_moments(const std::vector<Moments>& nodes, const std::vector<int>& of_node) {
  std::vector<Moments> parts(static_cast<size_t>(*std::max_element(of_node.begin(), of_node.end()) + 1));
  for (size_t k = 0; k < nodes.size(); ++k) parts[static_cast<size_t>(of_node[k])].add(nodes[k]);
  return parts;
}

/// Of a node's points under the motions of a part.
double residual_under(const Moments& node, const std::vector<RigidMotion>& motions) {
  double total = 0;
  for (size_t t = 0; t < node.frames.size(); ++t) {
    const Mat3d R = motions[t].R.cast<double>();
    const Vec3d shift = motions[t].t.cast<double>();
    const Moments::Frame& f = node.frames[t];
    // sum |y - R x - s|^2
    total += f.squared + node.squared + node.weight * shift.squaredNorm() -
             2 * (R.array() * f.cross.array()).sum() - 2 * shift.dot(f.sum) + 2 * shift.dot(R * node.sum);
  }
  return total;
}

std::vector<std::vector<RigidMotion>> motions_of(const std::vector<Moments>& parts) {
  std::vector<std::vector<RigidMotion>> motions(parts.size());
  for (size_t p = 0; p < parts.size(); ++p)
    for (size_t t = 0; t < parts[p].frames.size(); ++t) motions[p].push_back(parts[p].best(t));
  return motions;
}

/// Nodes at seams go to the part beside them that explains them best.
void settle_seams(const DeformationGraph& graph, const std::vector<Moments>& nodes, RigidParts& parts) {
  const auto near = neighbours_of(graph);
  for (int round = 0; round < kSettlingRounds; ++round) {
    parts.motions = motions_of(part_moments(nodes, parts.of_node));
    std::vector<int> held(parts.motions.size(), 0);
    for (const int part : parts.of_node) ++held[static_cast<size_t>(part)];
    std::vector<int> next = parts.of_node;
    for (size_t k = 0; k < nodes.size(); ++k) {
      const int own = parts.of_node[k];
      double least = residual_under(nodes[k], parts.motions[static_cast<size_t>(own)]);
      for (const int n : near[k]) {
        const int other = parts.of_node[static_cast<size_t>(n)];
        if (other == own || other == next[k] || held[static_cast<size_t>(own)] < 2) continue;
        const double cost = residual_under(nodes[k], parts.motions[static_cast<size_t>(other)]);
        if (cost < least) least = cost, next[k] = other;
      }
      if (next[k] != own) --held[static_cast<size_t>(own)], ++held[static_cast<size_t>(next[k])];
    }
    if (next == parts.of_node) break;
    parts.of_node = std::move(next);
  }
  parts.motions = motions_of(part_moments(nodes, parts.of_node));
}

}  // namespace

RigidParts find_rigid_parts(const SurfaceTracks& tracks, int most) {
  const std::vector<Moments> nodes = node_moments(tracks);
  RigidParts parts;
  parts.noise_m = noise_of(tracks, nodes);
  // Six numbers a frame, each known as well as so many nodes tell it: 6 T / 2 log G.
  const double frames = static_cast<double>(tracks.motions.size());
  const double price = (getenv("PRICE")?atof(getenv("PRICE")):3.0) * frames * std::log(static_cast<double>(nodes.size()));
  Agglomeration sets(tracks, nodes);
  sets.join_while(2 * parts.noise_m * parts.noise_m * price, most);
  parts.of_node = sets.labels();
  settle_seams(tracks.graph, nodes, parts);
  return parts;
}

void refit(const SurfaceTracks& tracks, RigidParts& parts) {
  parts.motions = motions_of(part_moments(node_moments(tracks), parts.of_node));
}

}  // namespace understudy
