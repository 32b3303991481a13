#include "retarget/discovery/rigid_parts.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "retarget/discovery/scan_evidence.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

using Vec3d = Eigen::Vector3d;
using Mat3d = Eigen::Matrix3d;

constexpr int kPatches = 400;          // that are joined to parts
constexpr double kUnits = 200;         // of a surface that tell as much as if each moved on its own
constexpr double kPrice = 2;           // of a part a frame, in log(units): half of what a joint leaves free
constexpr float kLeastNoise = 0.001f;  // of the body's diagonal: nothing is followed better than that
constexpr double kRigidShare = 25;     // percent of the patches that lie in the middle of a part
constexpr int kSettlingRounds = 6, kRobustRounds = 4;
// What the scans, and blends of other parts, may explain worse without a part; in its price.
constexpr double kScanAllowance = 0.3, kBlendAllowance = 0.4;
constexpr double kSubstituteCredit = 0.5;  // of what blends explain better than the part

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

/// What each point weighs: the thinner the body there the more, as a millimetre means more on a paw than on a
/// back. Together kUnits: neighbours move alike, and so many of them would tell as much if each moved on its
/// own.
Eigen::VectorXd point_weights(const DeformationGraph& graph) {
  const Eigen::VectorXd weights = graph.radii.cast<double>().array().square().inverse();
  return weights * (kUnits / weights.sum());
}

/// The surface's points in all frames.
struct Trajectories {
  explicit Trajectories(const SurfaceTracks& tracks)
      : rest(tracks.graph.points), weight(point_weights(tracks.graph)) {
    for (size_t t = 0; t < tracks.motions.size(); ++t) posed.push_back(tracks.at(static_cast<int>(t)));
  }
  /// share: of the point's weight
  void add(int point, Moments& to, double share = 1) const;
  /// Of a point, if it moved so: weighted squared distances, all frames.
  double residual(int point, const std::vector<RigidMotion>& motions) const {
    const Vec3 x = rest.row(point).transpose();
    double sum = 0;
    for (size_t t = 0; t < posed.size(); ++t)
      sum += (motions[t](x) - posed[t].row(point).transpose()).squaredNorm();
    return weight[point] * sum;
  }

  const Points& rest;
  std::vector<Points> posed;  // [T]
  Eigen::VectorXd weight;     // of the points
};

void Trajectories::add(int point, Moments& to, double share) const {
  const double w = share * weight[point];
  const Vec3d x = rest.row(point).transpose().cast<double>();
  to.weight += w, to.sum += w * x, to.squared += w * x.squaredNorm();
  to.frames.resize(posed.size());
  for (size_t t = 0; t < posed.size(); ++t) {
    const Vec3d y = posed[t].row(point).transpose().cast<double>();
    to.frames[t].sum += w * y;
    to.frames[t].cross += w * y * x.transpose();
    to.frames[t].squared += w * y.squaredNorm();
  }
}

/// Points that are joined first: those nearest to points far apart, and which patches touch.
struct Patches {
  std::vector<int> of_point;
  std::vector<std::set<int>> near;
  std::vector<Moments> moments;
};
Patches patches_of(const DeformationGraph& graph, const Trajectories& tracks) {
  const auto count = static_cast<int>(std::min<Eigen::Index>(kPatches, graph.points.rows()));
  const std::vector<int> seeds = farthest_points(graph.points, count);
  std::vector<float> least(static_cast<size_t>(graph.points.rows()), std::numeric_limits<float>::infinity());
  Patches patches;
  patches.of_point.assign(least.size(), 0);
  const float reach = 4 * box_diagonal(graph.points) / std::sqrt(static_cast<float>(count));
  for (int p = 0; p < count; ++p) {
    const std::vector<float> distance = distances_along(graph.surface, seeds[static_cast<size_t>(p)], reach);
    for (size_t i = 0; i < least.size(); ++i)
      if (distance[i] < least[i]) least[i] = distance[i], patches.of_point[i] = p;
  }
  patches.near.resize(static_cast<size_t>(count));
  patches.moments.resize(static_cast<size_t>(count));
  for (size_t i = 0; i < least.size(); ++i) {
    const int p = patches.of_point[i];
    tracks.add(static_cast<int>(i), patches.moments[static_cast<size_t>(p)]);
    for (const SurfaceGraph::Edge& edge : graph.surface.edges[i])
      if (const int q = patches.of_point[static_cast<size_t>(edge.to)]; q != p) {
        patches.near[static_cast<size_t>(p)].insert(q);
        patches.near[static_cast<size_t>(q)].insert(p);
      }
  }
  return patches;
}

/// How far points are from rigid motions where the surface is most nearly rigid: in the middle of parts.
float noise_of(const Patches& patches, float size) {
  std::vector<double> off;
  for (size_t k = 0; k < patches.moments.size(); ++k) {
    Moments ring = patches.moments[k];
    for (const int n : patches.near[k]) ring.add(patches.moments[static_cast<size_t>(n)]);
    off.push_back(std::sqrt(ring.residual() / (ring.weight * static_cast<double>(ring.frames.size()))));
  }
  return std::max(static_cast<float>(percentile(off, kRigidShare)), kLeastNoise * size);
}

/// Sets of patches that grow by joining.
class Agglomeration {
 public:
  explicit Agglomeration(const Patches& patches);
  /// Joins the two sets that lose least by it while they lose less than `allowed`, or are more than `most`.
  void join_while(double allowed, int most);
  /// Of each patch its set, with gaps in the numbers.
  const std::vector<int>& labels() const { return set_of_; }

 private:
  using Pair = std::pair<int, int>;
  void price(int a, int b);
  void join(int a, int b);

  std::vector<Moments> moments_;
  std::vector<double> residual_;
  std::vector<std::set<int>> near_;
  std::vector<int> set_of_;  // of each patch
  std::map<Pair, double> cost_;
  std::set<std::pair<double, Pair>> queue_;
  int count_;
};

Agglomeration::Agglomeration(const Patches& patches)
    : moments_(patches.moments), near_(moments_.size()), count_(static_cast<int>(moments_.size())) {
  for (size_t k = 0; k < moments_.size(); ++k) {
    set_of_.push_back(static_cast<int>(k));
    residual_.push_back(moments_[k].residual());
  }
  for (size_t k = 0; k < moments_.size(); ++k)
    for (const int n : patches.near[k])
      if (n > static_cast<int>(k)) price(static_cast<int>(k), n);
}

void Agglomeration::price(int a, int b) {
  if (a > b) std::swap(a, b);
  Moments both = moments_[static_cast<size_t>(a)];
  both.add(moments_[static_cast<size_t>(b)]);
  const double cost = both.residual() - residual_[static_cast<size_t>(a)] - residual_[static_cast<size_t>(b)];
  near_[static_cast<size_t>(a)].insert(b);
  near_[static_cast<size_t>(b)].insert(a);
  cost_[{a, b}] = cost;
  queue_.insert({cost, {a, b}});
}

void Agglomeration::join(int a, int b) {
  moments_[static_cast<size_t>(a)].add(moments_[static_cast<size_t>(b)]);
  residual_[static_cast<size_t>(a)] = moments_[static_cast<size_t>(a)].residual();
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

/// Labels without gaps, in the order of their first points.
void number_anew(std::vector<int>& labels) {
  std::map<int, int> number;
  for (int& label : labels) label = number.emplace(label, static_cast<int>(number.size())).first->second;
}

/// Where skin bends, at the ends of a part, points are blends of two motions: they hardly count.
void find_motions(const Trajectories& tracks, RigidParts& parts) {
  number_anew(parts.of_point);
  const auto count = static_cast<size_t>(*std::max_element(parts.of_point.begin(), parts.of_point.end()) + 1);
  std::vector<double> shares(parts.of_point.size(), 1);
  for (int round = 0; round < kRobustRounds; ++round) {
    std::vector<Moments> moments(count);
    for (size_t i = 0; i < shares.size(); ++i)
      tracks.add(static_cast<int>(i), moments[static_cast<size_t>(parts.of_point[i])], shares[i]);
    parts.motions.assign(count, {});
    for (size_t p = 0; p < count; ++p)
      for (size_t t = 0; t < tracks.posed.size(); ++t) parts.motions[p].push_back(moments[p].best(t));
    const double usual = parts.noise_m * parts.noise_m * static_cast<double>(tracks.posed.size());
    for (size_t i = 0; i < shares.size(); ++i) {
      const auto point = static_cast<int>(i);
      const double scale = usual * tracks.weight[point],
                   off = tracks.residual(point, parts.motions[static_cast<size_t>(parts.of_point[i])]);
      shares[i] = std::pow(scale / (scale + off), 2);
    }
  }
}

/// Of each point the parts about it: those within two steps along the surface, its own first.
std::vector<int> parts_about(const SurfaceGraph& surface, const std::vector<int>& of_point, int point) {
  std::vector<int> about{of_point[static_cast<size_t>(point)]};
  const auto see = [&](int other) {
    const int part = of_point[static_cast<size_t>(other)];
    if (std::find(about.begin(), about.end(), part) == about.end()) about.push_back(part);
  };
  for (const SurfaceGraph::Edge& edge : surface.edges[static_cast<size_t>(point)]) {
    see(edge.to);
    for (const SurfaceGraph::Edge& further : surface.edges[static_cast<size_t>(edge.to)]) see(further.to);
  }
  return about;
}

/// Points go to the part about them that explains them best.
void settle_seams(const SurfaceGraph& surface, const Trajectories& tracks, RigidParts& parts) {
  for (int round = 0; round < kSettlingRounds; ++round) {
    find_motions(tracks, parts);
    std::vector<int> next = parts.of_point;
    for (int i = 0; i < static_cast<int>(next.size()); ++i) {
      const std::vector<int> about = parts_about(surface, parts.of_point, i);
      if (about.size() < 2) continue;
      double least = std::numeric_limits<double>::infinity();
      for (const int part : about)
        if (const double off = tracks.residual(i, parts.motions[static_cast<size_t>(part)]); off < least)
          least = off, next[static_cast<size_t>(i)] = part;
    }
    if (next == parts.of_point) break;
    parts.of_point = std::move(next);
  }
  find_motions(tracks, parts);
}

/// What the points of a part would lose without it, and where they would go.
struct Removal {
  int part = -1;
  double loss = std::numeric_limits<double>::infinity();  // weighted squared metres, all frames
  std::vector<std::pair<int, int>> moves;                 // points and where they go
};

/// Each part's points, and the parts that it touches.
struct PartNeighbours {
  std::vector<std::vector<int>> points;
  std::vector<std::vector<int>> near;
};
PartNeighbours neighbours_of(const SurfaceGraph& surface, const RigidParts& parts) {
  const auto count = static_cast<size_t>(parts.count());
  std::vector<std::set<int>> near(count);
  PartNeighbours all{std::vector<std::vector<int>>(count), {}};
  for (int i = 0; i < static_cast<int>(parts.of_point.size()); ++i) {
    const int own = parts.of_point[static_cast<size_t>(i)];
    all.points[static_cast<size_t>(own)].push_back(i);
    for (const SurfaceGraph::Edge& edge : surface.edges[static_cast<size_t>(i)])
      if (const int other = parts.of_point[static_cast<size_t>(edge.to)]; other != own)
        near[static_cast<size_t>(own)].insert(other);
  }
  for (const std::set<int>& of : near) all.near.emplace_back(of.begin(), of.end());
  return all;
}

/// A point as a blend of two parts' motions, as skin bends between them: squared distance left, and the
/// second part's share.
std::pair<double, double> blended(const Trajectories& tracks, int point, const std::vector<RigidMotion>& a,
                                  const std::vector<RigidMotion>& b) {
  const Vec3 x = tracks.rest.row(point).transpose();
  double off = 0, along = 0, apart = 0;
  for (size_t t = 0; t < tracks.posed.size(); ++t) {
    const Vec3 at = a[t](x), e = at - tracks.posed[t].row(point).transpose(), d = b[t](x) - at;
    off += e.squaredNorm(), along += e.dot(d), apart += d.squaredNorm();
  }
  const double share = apart > 0 ? std::clamp(-along / apart, 0.0, 1.0) : 0.0;
  return {tracks.weight[point] * (off + 2 * share * along + share * share * apart), share};
}

/// What explains a point without its part: the weighted squared distance left, and the part that it goes to.
using Substitute = std::pair<double, int>;

/// credit: of what substitutes explain better, the share that counts. without: of a point its best
/// substitute; with: what its own part leaves.
template <class Without, class With>
Removal removal_of(const PartNeighbours& all, int part, const Without& without, const With& with,
                   double credit) {
  Removal removal{part, 0, {}};
  for (const int i : all.points[static_cast<size_t>(part)]) {
    const auto [off, to] = without(i);
    const double worse = off - with(i);
    removal.loss += worse > 0 ? worse : credit * worse;
    removal.moves.push_back({i, to});
  }
  return removal;
}

/// Without the part the scans see its points move with one beside it: what only slid along a surface that
/// looks the same, as a ring about an axle, loses nothing.
Removal removal_by_scans(const ScanEvidence& scans, const Eigen::VectorXd& weights, const RigidParts& parts,
                         const PartNeighbours& all, int part) {
  const auto p = static_cast<size_t>(part);
  const auto without = [&](int i) {
    Substitute best{std::numeric_limits<double>::infinity(), -1};
    for (const int other : all.near[p])
      if (const double off = weights[i] * scans.off(i, parts.motions[static_cast<size_t>(other)]);
          off < best.first)
        best = {off, other};
    return best;
  };
  return removal_of(
      all, part, without, [&](int i) { return weights[i] * scans.off(i, parts.motions[p]); }, 0);
}

/// Without the part its points are blends of those beside it: what is only the bend between two parts loses
/// nothing.
Removal removal_by_blends(const Trajectories& tracks, const RigidParts& parts, const PartNeighbours& all,
                          int part) {
  const auto p = static_cast<size_t>(part);
  const auto without = [&](int i) {
    Substitute best{std::numeric_limits<double>::infinity(), -1};
    for (const int a : all.near[p])
      for (const int b : all.near[p]) {
        if (b < a) continue;
        const auto [off, share] =
            blended(tracks, i, parts.motions[static_cast<size_t>(a)], parts.motions[static_cast<size_t>(b)]);
        if (off < best.first) best = {off, share < 0.5 ? a : b};
      }
    return best;
  };
  return removal_of(
      all, part, without, [&](int i) { return tracks.residual(i, parts.motions[p]); }, kSubstituteCredit);
}

/// The part that is missed least.
Removal least_missed(const SurfaceGraph& surface, const Trajectories& tracks, const ScanEvidence& scans,
                     const RigidParts& parts) {
  const PartNeighbours all = neighbours_of(surface, parts);
  Removal best;
  for (int part = 0; part < parts.count(); ++part) {
    if (all.near[static_cast<size_t>(part)].empty()) continue;
    Removal by_blends = removal_by_blends(tracks, parts, all, part);
    Removal by_scans = removal_by_scans(scans, tracks.weight, parts, all, part);
    by_scans.loss /= kScanAllowance, by_blends.loss /= kBlendAllowance;
    if (by_blends.loss < best.loss) best = std::move(by_blends);
    if (by_scans.loss < best.loss) best = std::move(by_scans);
  }
  return best;
}

}  // namespace

RigidParts find_rigid_parts(const std::vector<ThinnedFrame>& frames, const SurfaceTracks& tracks, int most) {
  const Trajectories trajectories(tracks);
  const SurfaceGraph& surface = tracks.graph.surface;
  const Patches patches = patches_of(tracks.graph, trajectories);
  RigidParts parts;
  parts.noise_m = noise_of(patches, box_diagonal(tracks.graph.points));
  // Of the six numbers a frame a joint leaves about four free, each known as well as so many units tell it:
  // 4 T / 2 log units.
  const double price = kPrice * static_cast<double>(tracks.motions.size()) * std::log(kUnits);
  const double allowed = 2 * parts.noise_m * parts.noise_m * price;
  Agglomeration sets(patches);
  sets.join_while(allowed, most);
  for (const int patch : patches.of_point)
    parts.of_point.push_back(sets.labels()[static_cast<size_t>(patch)]);
  settle_seams(surface, trajectories, parts);
  const ScanEvidence scans(frames, tracks.graph);
  while (parts.count() > 1) {
    const Removal removal = least_missed(surface, trajectories, scans, parts);
    if (removal.part < 0 || removal.loss > allowed) break;
    for (const auto& [point, to] : removal.moves) parts.of_point[static_cast<size_t>(point)] = to;
    settle_seams(surface, trajectories, parts);
  }
  return parts;
}

void refit(const SurfaceTracks& tracks, RigidParts& parts) {
  find_motions(Trajectories(tracks), parts);
}

}  // namespace understudy
