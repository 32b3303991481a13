#include "retarget/networks/network_deformer.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/networks/deformation_forward.hpp"

namespace understudy::nn {
namespace {

constexpr float kLeastWeight = 2e-3f;   // smaller skin weights are noise: in truth most are exactly 0
constexpr float kLeastOffset = 2e-5f;   // metres: an offset that no pose makes larger is left out
constexpr float kLargestBend = 2.829f;  // Frobenius norm of R - I at 180 degrees

/// The part of O_net that answers to one joint at one point: offset += block * (R - I). Nine columns of
/// three, and one number more: four are what the machine multiplies at once, the last of them for nothing.
struct OffsetBlock {
  int row, joint;
  std::array<float, 28> columns;
};

struct Influence {
  int joint;
  float weight;
};

OffsetBlock offset_block(int row, int joint, const Eigen::Matrix<float, 3, 9>& block) {
  OffsetBlock b{row, joint, {}};
  Eigen::Map<Eigen::Matrix<float, 3, 9>>(b.columns.data()) = block;
  return b;
}

/// Zeroes the noise and makes rows sum to 1 again.
void tidy_weights(RowMatrix& weights) {
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    auto row = weights.row(v);
    const float least = std::min(kLeastWeight, row.maxCoeff());
    row = (row.array() < least).select(0.f, row);
    row /= row.sum();
  }
}

constexpr float kCells = 180;  // a body's height in cells of one evaluated point each: 1 cm on an adult
constexpr float kMostCells = 4 * kCells;  // where a centimetre is too coarse
constexpr int kSlice = 16384;             // points evaluated at once: the output for one takes 2.4 kB
constexpr int kBetween = 8;               // evaluated points that one between them is interpolated from
constexpr float kRough = 0.008f;     // where a weight is that far from linear among them, each is evaluated
constexpr float kOffsetUnit = 0.1f;  // metres: offsets may be as rough as weights in it
constexpr int kKnown = kJointCount + 9;

using Neighbours = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of every cell of a grid that one of the points `of` that is next to its middle, whatever their order.
/// cells: along the longest side of the box around all points.
std::vector<int> one_a_cell(const Points& points, const std::vector<int>& of, float cells) {
  const Vec3 low = points.colwise().minCoeff();
  const float edge = (points.colwise().maxCoeff().transpose() - low).maxCoeff() / cells;
  if (!(edge > 0)) return {};
  std::unordered_map<uint64_t, std::pair<float, int>> best;
  for (const int i : of) {
    const Vec3 at = (points.row(i).transpose() - low) / edge;
    const Vec3 cell = at.array().floor();
    const uint64_t key = (static_cast<uint64_t>(cell.x()) << 42) | (static_cast<uint64_t>(cell.y()) << 21) |
                         static_cast<uint64_t>(cell.z());
    const std::pair<float, int> own{(at - cell - Vec3::Constant(0.5f)).squaredNorm(), i};
    const auto [found, fresh] = best.emplace(key, own);
    if (!fresh) found->second = std::min(found->second, own);
  }
  std::vector<int> kept;
  kept.reserve(best.size());
  for (const auto& [key, own] : best) kept.push_back(own.second);
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// How a point's value follows from those of points near it: the value at the point of the plane through
/// theirs, [kBetween] shares that sum to 1. offsets [kBetween, 3]: where they lie from it.
Eigen::RowVectorXf shares_of(const Eigen::Matrix<float, kBetween, 3>& offsets) {
  const Eigen::Array<float, kBetween, 1> far2 = offsets.rowwise().squaredNorm();
  const float reach2 = std::max(1e-12f, far2.maxCoeff());
  const Eigen::Array<float, kBetween, 1> w = (far2 / reach2 + 1e-4f).inverse();
  Eigen::Matrix<float, kBetween, 4> terms;
  terms << Eigen::Matrix<float, kBetween, 1>::Ones(), offsets / std::sqrt(reach2);
  Eigen::Matrix4f A = terms.transpose() * w.matrix().asDiagonal() * terms;
  A.diagonal().tail<3>().array() += 1e-3f * w.sum();  // points in one plane determine nothing across it
  const Eigen::Vector4f solved = A.ldlt().solve(Eigen::Vector4f::UnitX());
  return ((terms * solved).array() * w).matrix().transpose();
}

/// Whether what is known of these rows lies near one plane over the place.
bool is_flat(const Eigen::Matrix<float, kBetween, 3>& offsets,
             const Eigen::Ref<const Eigen::RowVectorXi>& rows, const RowMatrix& known) {
  Eigen::Matrix<float, kBetween, Eigen::Dynamic> seen(kBetween, known.cols());
  for (int k = 0; k < kBetween; ++k) seen.row(k) = known.row(rows[k]);
  if ((seen.colwise().maxCoeff() - seen.colwise().minCoeff()).maxCoeff() < kRough) return true;
  Eigen::Matrix<float, kBetween, 4> terms;
  terms << Eigen::Matrix<float, kBetween, 1>::Ones(),
      offsets / std::max(1e-6f, offsets.rowwise().norm().maxCoeff());
  Eigen::Matrix4f A = terms.transpose() * terms;
  A.diagonal().tail<3>().array() += 1e-3f;
  const Eigen::Matrix<float, 4, Eigen::Dynamic> plane = A.ldlt().solve(terms.transpose() * seen);
  return (terms * plane - seen).cwiseAbs().maxCoeff() < kRough;
}

/// The pose features of all joints bent at once about x, y or z, [189, 3]: what offsets do then is seen
/// where they are looked at for being flat.
Eigen::Matrix<float, kPoseFeatureCount, 3> probing_bends() {
  Eigen::Matrix<float, kPoseFeatureCount, 3> bends;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> bend =
        Eigen::AngleAxisf(kPi / 3, Vec3::Unit(axis)).toRotationMatrix() - Mat3::Identity();
    for (int j = 1; j < kJointCount; ++j)
      bends.block<9, 1>(9 * (j - 1), axis) = Eigen::Map<const Eigen::Matrix<float, 9, 1>>(bend.data());
  }
  return bends;
}

/// Points at which the networks were evaluated, and their output.
struct Samples {
  Points points;                    // [N, 3]
  RowMatrix known;                  // [N, kKnown]: the weights, then offsets of probing bends, kOffsetUnit
  std::vector<OffsetBlock> blocks;  // by row
};

/// How vertices lie between evaluated points; without rows: every vertex was evaluated, in their order.
struct Between {
  Neighbours near;   // [V, kBetween] rows of the evaluated points
  RowMatrix shares;  // [V, kBetween], 0 behind the first of a vertex that was evaluated itself
  /// A vertex' row from those of the points.
  template <int Columns, class Rows>
  Eigen::Matrix<float, 1, Columns> row(const Rows& rows, Eigen::Index v) const {
    Eigen::Matrix<float, 1, Columns> sum = shares(v, 0) * rows.row(near(v, 0));
    for (int k = 1; k < kBetween; ++k)
      if (shares(v, k) != 0) sum += shares(v, k) * rows.row(near(v, k));
    return sum;
  }
};

class NetworkDeformer : public Deformer {
 public:
  NetworkDeformer(const std::string& path, bool offsets, int most_evaluated)
      : net_(std::make_shared<const DeformationForward>(path)),
        path_(path),
        offsets_(offsets),
        most_evaluated_(most_evaluated) {}
  void bind(const Points& rest, const Joints& rest_joints) override;
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override;
  Points deform(const Pose& pose) const override;
  Points offsets(const Pose& pose) const override;
  std::string name() const override { return offsets_ ? "network" : "network, no offsets"; }

 private:
  void evaluate(const Points& points, const Points& context, Samples& samples);
  void evaluate_slice(Eigen::Index first, Eigen::Index count, const Points& context, Samples& samples);
  bool evaluate_some(const Points& rest, const Points& context, Samples& samples, Between& between);
  void keep_weights();
  void add_offsets(const Pose& pose, Points& rest) const;

  std::shared_ptr<const DeformationForward> net_;  // shared by copies with other weights
  std::string path_;
  bool offsets_;
  int most_evaluated_;
  Points rest_;
  Joints joints_ = Joints::Zero();
  RowMatrix weights_;
  // Shared by copies with other weights: offsets of all vertices, or of the points between which they lie.
  std::shared_ptr<const std::vector<OffsetBlock>> blocks_;
  std::shared_ptr<const Between> between_;
  Eigen::Index sampled_ = 0;          // how many of either
  std::vector<int> first_influence_;  // [V + 1] into influences_
  std::vector<Influence> influences_;
};

void NetworkDeformer::bind(const Points& rest, const Joints& rest_joints) {
  US_CHECK(rest.rows() > 0, "the target has no points");
  US_CHECK(rest.allFinite() && rest_joints.allFinite(), "the target has a coordinate that is not finite");
  const Points context = spread_points(rest, kContextPoints);
  joints_ = rest_joints;
  Samples samples;
  auto between = std::make_shared<Between>();
  if (rest.rows() <= most_evaluated_ || !evaluate_some(rest, context, samples, *between))
    evaluate(rest, context, samples);
  rest_ = rest;
  sampled_ = samples.points.rows();
  if (between->near.rows() == 0) {
    weights_ = samples.known.leftCols<kJointCount>().cwiseMax(0);
  } else {
    weights_.resize(rest.rows(), kJointCount);
    for (Eigen::Index v = 0; v < rest.rows(); ++v)
      weights_.row(v) = between->row<kKnown>(samples.known, v).head<kJointCount>().cwiseMax(0);
  }
  tidy_weights(weights_);
  keep_weights();
  samples.blocks.shrink_to_fit();
  blocks_ = std::make_shared<const std::vector<OffsetBlock>>(std::move(samples.blocks));
  between_ = std::move(between);
}

/// Appends the networks' output for these points.
void NetworkDeformer::evaluate(const Points& points, const Points& context, Samples& samples) {
  const Eigen::Index before = samples.points.rows(), all = before + points.rows();
  samples.points.conservativeResize(all, 3);
  samples.points.bottomRows(points.rows()) = points;
  samples.known.conservativeResize(all, kKnown);
  for (Eigen::Index from = before; from < all; from += kSlice)
    evaluate_slice(from, std::min<Eigen::Index>(kSlice, all - from), context, samples);
}

void NetworkDeformer::evaluate_slice(Eigen::Index first, Eigen::Index count, const Points& context,
                                     Samples& samples) {
  const SurfaceValues values = net_->evaluate(samples.points.middleRows(first, count), joints_, context);
  const RowMatrix& W = values.weights;
  const Eigen::Map<const RowMatrix> B(values.basis.data(), 3 * count, kPoseFeatureCount);
  US_CHECK(W.allFinite() && B.allFinite(), path_,
           ": the deformation networks give values that are not finite for this target");
  samples.known.middleRows(first, count).leftCols<kJointCount>() = W;
  static const Eigen::Matrix<float, kPoseFeatureCount, 3> bends = probing_bends();
  const RowMatrix probed = offsets_ ? RowMatrix(B * bends) : RowMatrix(RowMatrix::Zero(3 * count, 3));
  samples.known.middleRows(first, count).rightCols<9>() =
      Eigen::Map<const RowMatrix>(probed.data(), count, 9) / kOffsetUnit;
  for (Eigen::Index i = 0; offsets_ && i < count; ++i)
    for (int j = 1; j < kJointCount; ++j) {
      const auto block = B.block<3, 9>(3 * i, 9 * (j - 1));
      if (block.norm() * kLargestBend > kLeastOffset)
        samples.blocks.push_back(offset_block(static_cast<int>(first + i), j, block));
    }
}

/// The networks change slowly over a centimetre, but not everywhere: across gaps and creases vertices are
/// evaluated closer together, and at last each. False where the vertices lie too far apart for that.
bool NetworkDeformer::evaluate_some(const Points& rest, const Points& context, Samples& samples,
                                    Between& between) {
  std::vector<int> open(rest.rows());  // not yet known
  std::iota(open.begin(), open.end(), 0);
  for (float cells = kCells; cells <= kMostCells; cells *= 2) {
    const std::vector<int> chosen = one_a_cell(rest, open, cells);
    if (chosen.size() <= kBetween || 2 * chosen.size() >= open.size()) break;
    evaluate(rest(chosen, Eigen::all), context, samples);
    between.near.conservativeResize(rest.rows(), kBetween);
    between.shares.conservativeResize(rest.rows(), kBetween);
    const Neighbours near = nearest_neighbours(samples.points, rest(open, Eigen::all), kBetween);
    std::vector<int> rough;
    for (size_t i = 0; i < open.size(); ++i) {
      const int v = open[i];
      between.near.row(v) = near.row(i);
      Eigen::Matrix<float, kBetween, 3> offsets;
      for (int k = 0; k < kBetween; ++k)
        offsets.row(k) = samples.points.row(between.near(v, k)) - rest.row(v);
      between.shares.row(v) = shares_of(offsets);
      if (!is_flat(offsets, between.near.row(v), samples.known)) rough.push_back(v);
    }
    open = std::move(rough);
  }
  if (between.near.rows() == 0) return false;
  const Eigen::Index before = samples.points.rows();
  if (!open.empty()) evaluate(rest(open, Eigen::all), context, samples);
  for (size_t i = 0; i < open.size(); ++i) {
    between.near.row(open[i]).setConstant(static_cast<int>(before + i));
    between.shares.row(open[i]) = Eigen::RowVectorXf::Unit(kBetween, 0);
  }
  return true;
}

void NetworkDeformer::keep_weights() {
  influences_.clear();
  first_influence_.assign(1, 0);
  for (Eigen::Index v = 0; v < weights_.rows(); ++v) {
    for (int j = 0; j < kJointCount; ++j)
      if (weights_(v, j) > 0) influences_.push_back({j, weights_(v, j)});
    first_influence_.push_back(influences_.size());
  }
}

void NetworkDeformer::add_offsets(const Pose& pose, Points& rest) const {
  std::array<Eigen::Matrix<float, 9, 1>, kJointCount> bend;  // R - I, row-major
  for (int j = 0; j < kJointCount; ++j) {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> m = pose.local[j] - Mat3::Identity();
    bend[j] = Eigen::Map<const Eigen::Matrix<float, 9, 1>>(m.data());
  }
  Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor> moved;
  moved.setZero(sampled_, 4);
  for (const OffsetBlock& b : *blocks_) {
    Eigen::Vector4f offset = Eigen::Vector4f::Zero();
    for (int k = 0; k < 9; ++k)
      offset += Eigen::Map<const Eigen::Vector4f>(b.columns.data() + 3 * k) * bend[b.joint][k];
    moved.row(b.row) += offset.transpose();
  }
  if (between_->near.rows() == 0)
    rest += moved.leftCols<3>();
  else
    for (Eigen::Index v = 0; v < rest.rows(); ++v) rest.row(v) += between_->row<4>(moved, v).head<3>();
}

std::shared_ptr<Deformer> NetworkDeformer::with_weights(RowMatrix weights) const {
  US_CHECK(rest_.rows() > 0, "with_weights() needs bind() first");
  US_CHECK(weights.rows() == rest_.rows() && weights.cols() == kJointCount, "skin weights are ",
           weights.rows(), " x ", weights.cols(), ", the target has ", rest_.rows(), " vertices");
  US_CHECK(weights.allFinite() && weights.minCoeff() >= 0 && weights.rowwise().sum().minCoeff() > 1e-6f,
           "skin weights must not be negative, and every vertex needs some");
  auto other = std::make_shared<NetworkDeformer>(*this);
  other->weights_ = weights.array().colwise() / weights.rowwise().sum().array();
  other->keep_weights();
  return other;
}

Points NetworkDeformer::offsets(const Pose& pose) const {
  Points offsets = Points::Zero(rest_.rows(), 3);
  add_offsets(pose, offsets);
  return offsets;
}

Points NetworkDeformer::deform(const Pose& pose) const {
  US_CHECK(rest_.rows() > 0, "deform() needs bind() first");
  Points rest = rest_;
  add_offsets(pose, rest);
  const PosedSkeleton posed = forward_kinematics(joints_, pose);
  std::array<Eigen::Matrix4f, kJointCount> transforms;
  for (int j = 0; j < kJointCount; ++j) {
    transforms[j].setIdentity();
    transforms[j].topLeftCorner<3, 3>() = posed.global[j];
    transforms[j].topRightCorner<3, 1>() =
        posed.joints.row(j).transpose() - posed.global[j] * joints_.row(j).transpose();
  }
  Points vertices(rest.rows(), 3);
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    Eigen::Matrix4f blended = Eigen::Matrix4f::Zero();
    for (int i = first_influence_[v]; i < first_influence_[v + 1]; ++i)
      blended += influences_[i].weight * transforms[influences_[i].joint];
    const Eigen::Vector4f at = blended.col(0) * rest(v, 0) + blended.col(1) * rest(v, 1) +
                               blended.col(2) * rest(v, 2) + blended.col(3);
    vertices.row(v) = at.head<3>().transpose();
  }
  return vertices;
}

}  // namespace

std::unique_ptr<Deformer> load_network_deformer(const std::string& path, bool offsets, int most_evaluated) {
  return std::make_unique<NetworkDeformer>(path, offsets, most_evaluated);
}

Points spread_points(const Points& points, int count) {
  US_CHECK(points.rows() > 0 && count > 0, "no points to spread");
  std::vector<int> order(points.rows());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&points](int i) {
    return std::array<float, 3>{-points(i, 1), points(i, 0), points(i, 2)};
  };
  std::sort(order.begin(), order.end(), [&key](int a, int b) { return key(a) < key(b); });
  // from the top down, so that the choice does not know the file's order
  const Points sorted = points(order, Eigen::all);
  Points context(count, 3);
  const int distinct = static_cast<int>(std::min<Eigen::Index>(count, points.rows()));
  const std::vector<int> chosen = farthest_points(sorted, distinct);
  for (int i = 0; i < count; ++i) context.row(i) = sorted.row(chosen[i % distinct]);
  return context;
}

}  // namespace understudy::nn
