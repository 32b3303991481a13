#include "retarget/nn/network_deformer.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/geometry/mesh.hpp"
#include "retarget/nn/modules/deformation.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

constexpr float kLeastWeight = 2e-3f;   // smaller skin weights are noise: in truth most are exactly 0
constexpr float kLeastOffset = 2e-5f;   // metres: an offset that no pose makes larger is left out
constexpr float kLargestBend = 2.829f;  // Frobenius norm of R - I at 180 degrees

/// The part of O_net that answers to one joint at one vertex: offset += block * (R - I). Four rows, the last
/// one zero: columns of four are what the machine multiplies at once.
struct OffsetBlock {
  int vertex, joint;
  Eigen::Matrix<float, 4, 9> block;
};

struct Influence {
  int joint;
  float weight;
};

OffsetBlock offset_block(int vertex, int joint, const Eigen::Matrix<float, 3, 9>& block) {
  OffsetBlock b{vertex, joint, Eigen::Matrix<float, 4, 9>::Zero()};
  b.block.topRows<3>() = block;
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

torch::Tensor tensor_of(const float* data, int64_t rows, int64_t cols) {
  return torch::from_blob(const_cast<float*>(data), {rows, cols}).clone();
}

constexpr float kCells = 180;     // a body's height in cells of one asked point each: 1 cm on an adult
constexpr int kBetween = 8;       // asked points that tell of one between them
constexpr float kRough = 0.008f;  // a weight that is that far from linear among them is asked for itself

using Numbers = Eigen::Map<const RowMatrix>;

/// Of every cell of a grid the point next to its middle, whatever the order of the points.
std::vector<int> one_a_cell(const Points& points) {
  const Vec3 low = points.colwise().minCoeff();
  const float edge = (points.colwise().maxCoeff().transpose() - low).maxCoeff() / kCells;
  if (!(edge > 0)) return {};
  std::unordered_map<uint64_t, std::pair<float, int>> best;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 at = (points.row(i).transpose() - low) / edge;
    const Vec3 cell = at.array().floor();
    const uint64_t key = (static_cast<uint64_t>(cell.x()) << 42) | (static_cast<uint64_t>(cell.y()) << 21) |
                         static_cast<uint64_t>(cell.z());
    const std::pair<float, int> own{(at - cell - Vec3::Constant(0.5f)).squaredNorm(), static_cast<int>(i)};
    const auto [found, fresh] = best.emplace(key, own);
    if (!fresh) found->second = std::min(found->second, own);
  }
  std::vector<int> kept;
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
  A.diagonal().tail<3>().array() += 1e-3f * w.sum();  // points in one plane say nothing across it
  const Eigen::Vector4f solved = A.ldlt().solve(Eigen::Vector4f::UnitX());
  return ((terms * solved).array() * w).matrix().transpose();
}

/// Whether these rows of the weights lie near one plane over the place.
bool is_flat(const Eigen::Matrix<float, kBetween, 3>& offsets,
             const Eigen::Ref<const Eigen::RowVectorXi>& rows, const Numbers& weights) {
  Eigen::Matrix<float, kBetween, Eigen::Dynamic> seen(kBetween, weights.cols());
  for (int k = 0; k < kBetween; ++k) seen.row(k) = weights.row(rows[k]);
  if ((seen.colwise().maxCoeff() - seen.colwise().minCoeff()).maxCoeff() < kRough) return true;
  Eigen::Matrix<float, kBetween, 4> terms;
  terms << Eigen::Matrix<float, kBetween, 1>::Ones(),
      offsets / std::max(1e-6f, offsets.rowwise().norm().maxCoeff());
  Eigen::Matrix4f A = terms.transpose() * terms;
  A.diagonal().tail<3>().array() += 1e-3f;
  const Eigen::Matrix<float, 4, Eigen::Dynamic> plane = A.ldlt().solve(terms.transpose() * seen);
  return (terms * plane - seen).cwiseAbs().maxCoeff() < kRough;
}

/// What the networks said: of every vertex, or of some between which the others lie.
struct Asked {
  BoundSurface values;                                                       // contiguous
  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> near;  // [V, k] rows of values
  RowMatrix shares;                                                          // [V, k]
  Numbers weights() const {
    return {values.weights.data_ptr<float>(), values.weights.size(0), values.weights.size(1)};
  }
  Numbers basis() const {
    return {values.basis.data_ptr<float>(), values.basis.size(0), values.basis.size(1)};
  }
  void row(const Numbers& from, Eigen::Index v, Eigen::RowVectorXf& out) const {
    out = shares(v, 0) * from.row(near(v, 0));
    for (Eigen::Index k = 1; k < near.cols(); ++k)
      if (shares(v, k) != 0) out += shares(v, k) * from.row(near(v, k));
  }
};

class NetworkDeformer : public Deformer {
 public:
  NetworkDeformer(const std::string& path, bool offsets, int most_asked)
      : path_(path), offsets_(offsets), most_asked_(most_asked) {
    load_weights(path, "deformation", kDeformationVersion, *net_);
    net_->eval();
  }
  void bind(const Points& rest, const Joints& rest_joints) override;
  const RowMatrix& weights() const override { return weights_; }
  std::shared_ptr<Deformer> with_weights(RowMatrix weights) const override;
  Points deform(const Pose& pose) const override;
  Points offsets(const Pose& pose) const override;
  std::string name() const override { return offsets_ ? "network" : "network, no offsets"; }

 private:
  BoundSurface ask(const Points& points, const Points& spread);
  Asked ask_all(const Points& rest, const Points& spread);
  Asked ask_some(const Points& rest, const Points& spread, const std::vector<int>& chosen);
  void keep_weights();
  void keep_offsets(const Asked& asked);
  void add_offsets(const Pose& pose, Points& rest) const;

  DeformationNet net_;
  std::string path_;
  bool offsets_;
  int most_asked_;
  Points rest_;
  Joints joints_ = Joints::Zero();
  RowMatrix weights_;
  std::shared_ptr<const std::vector<OffsetBlock>> blocks_;  // by vertex; shared by copies with other weights
  std::vector<int> first_influence_;                        // [V + 1] into influences_
  std::vector<Influence> influences_;
};

void NetworkDeformer::bind(const Points& rest, const Joints& rest_joints) {
  US_CHECK(rest.rows() > 0, "the target has no points");
  US_CHECK(rest.allFinite() && rest_joints.allFinite(), "the target has a coordinate that is no number");
  const Points spread = spread_points(rest, static_cast<int>(net_->options.context_points));
  joints_ = rest_joints;
  const std::vector<int> chosen = rest.rows() > most_asked_ ? one_a_cell(rest) : std::vector<int>();
  const bool some = chosen.size() > kBetween && 2 * static_cast<Eigen::Index>(chosen.size()) < rest.rows();
  const Asked asked = some ? ask_some(rest, spread, chosen) : ask_all(rest, spread);
  rest_ = rest;
  weights_.resize(rest.rows(), kJointCount);
  Eigen::RowVectorXf row;
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    asked.row(asked.weights(), v, row);
    weights_.row(v) = row.cwiseMax(0);
  }
  tidy_weights(weights_);
  keep_weights();
  blocks_ = std::make_shared<std::vector<OffsetBlock>>();
  if (offsets_) keep_offsets(asked);
}

BoundSurface NetworkDeformer::ask(const Points& points, const Points& spread) {
  const BoundSurface bound =
      bind_surface(net_, tensor_of(points.data(), points.rows(), 3),
                   tensor_of(joints_.data(), kJointCount, 3), tensor_of(spread.data(), spread.rows(), 3));
  BoundSurface out{bound.weights.contiguous(), bound.basis.contiguous()};
  using Flat = Eigen::Map<const Eigen::VectorXf>;
  US_CHECK(Flat(out.weights.data_ptr<float>(), out.weights.numel()).allFinite() &&
               Flat(out.basis.data_ptr<float>(), out.basis.numel()).allFinite(),
           path_, ": the deformation networks give no numbers for this target");
  return out;
}

Asked NetworkDeformer::ask_all(const Points& rest, const Points& spread) {
  Asked asked{ask(rest, spread), {}, RowMatrix::Ones(rest.rows(), 1)};
  asked.near.resize(rest.rows(), 1);
  std::iota(asked.near.data(), asked.near.data() + rest.rows(), 0);
  return asked;
}

/// The networks change slowly over a centimetre, but not everywhere: across gaps and creases the vertices are
/// asked for themselves.
Asked NetworkDeformer::ask_some(const Points& rest, const Points& spread, const std::vector<int>& chosen) {
  const Points some = rest(chosen, Eigen::all);
  const BoundSurface known = ask(some, spread);
  Asked asked{known, nearest_neighbours(some, rest, kBetween), RowMatrix(rest.rows(), kBetween)};
  std::vector<int> rough;
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    Eigen::Matrix<float, kBetween, 3> offsets;
    for (int k = 0; k < kBetween; ++k) offsets.row(k) = some.row(asked.near(v, k)) - rest.row(v);
    asked.shares.row(v) = shares_of(offsets);
    if (!is_flat(offsets, asked.near.row(v), asked.weights())) rough.push_back(static_cast<int>(v));
  }
  if (rough.empty()) return asked;
  const BoundSurface exact = ask(rest(rough, Eigen::all), spread);
  for (size_t i = 0; i < rough.size(); ++i) {
    asked.near(rough[i], 0) = static_cast<int>(chosen.size() + i);
    asked.shares.row(rough[i]).setZero();
    asked.shares(rough[i], 0) = 1;
  }
  asked.values = {torch::cat({known.weights, exact.weights}), torch::cat({known.basis, exact.basis})};
  return asked;
}

void NetworkDeformer::keep_weights() {
  influences_.clear();
  first_influence_.assign(1, 0);
  for (Eigen::Index v = 0; v < weights_.rows(); ++v) {
    for (int j = 0; j < kJointCount; ++j)
      if (weights_(v, j) > 0) influences_.push_back({j, weights_(v, j)});
    first_influence_.push_back(static_cast<int>(influences_.size()));
  }
}

void NetworkDeformer::keep_offsets(const Asked& asked) {
  auto blocks = std::make_shared<std::vector<OffsetBlock>>();
  const Numbers basis = asked.basis();
  Eigen::RowVectorXf row;
  for (Eigen::Index v = 0; v < rest_.rows(); ++v) {
    asked.row(basis, v, row);
    const Eigen::Map<const RowMatrix> own(row.data(), 3, kPoseFeatureCount);
    for (int j = 1; j < kJointCount; ++j) {
      const auto block = own.middleCols<9>(9 * (j - 1));
      if (block.norm() * kLargestBend > kLeastOffset)
        blocks->push_back(offset_block(static_cast<int>(v), j, block));
    }
  }
  blocks_ = std::move(blocks);
}

void NetworkDeformer::add_offsets(const Pose& pose, Points& rest) const {
  std::array<Eigen::Matrix<float, 9, 1>, kJointCount> bend;  // R - I, row-major
  for (int j = 0; j < kJointCount; ++j) {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> m = pose.local[j] - Mat3::Identity();
    bend[j] = Eigen::Map<const Eigen::Matrix<float, 9, 1>>(m.data());
  }
  for (const OffsetBlock& b : *blocks_) {
    Eigen::Vector4f offset = Eigen::Vector4f::Zero();
    for (int k = 0; k < 9; ++k) offset += b.block.col(k) * bend[b.joint][k];
    rest.row(b.vertex) += offset.head<3>().transpose();
  }
}

std::shared_ptr<Deformer> NetworkDeformer::with_weights(RowMatrix weights) const {
  US_CHECK(rest_.rows() > 0, "with_weights() wants bind() first");
  US_CHECK(weights.rows() == rest_.rows() && weights.cols() == kJointCount, "skin weights are ",
           weights.rows(), " x ", weights.cols(), ", the target has ", rest_.rows(), " vertices");
  US_CHECK(weights.allFinite() && weights.minCoeff() >= 0 && weights.rowwise().sum().minCoeff() > 1e-6f,
           "skin weights must not be negative, and every vertex wants some");
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
  US_CHECK(rest_.rows() > 0, "deform() wants bind() first");
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

std::unique_ptr<Deformer> load_network_deformer(const std::string& path, bool offsets, int most_asked) {
  return std::make_unique<NetworkDeformer>(path, offsets, most_asked);
}

Points spread_points(const Points& points, int count) {
  US_CHECK(points.rows() > 0 && count > 0, "no points to spread");
  std::vector<int> order(points.rows());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&points](int i) {
    return std::array<float, 3>{-points(i, 1), points(i, 0), points(i, 2)};
  };
  std::sort(order.begin(), order.end(), [&key](int a, int b) { return key(a) < key(b); });
  Points sorted(points.rows(), 3);  // from the top down, so that the choice does not know the file's order
  for (size_t i = 0; i < order.size(); ++i) sorted.row(i) = points.row(order[i]);
  Points spread(count, 3);
  const int distinct = static_cast<int>(std::min<Eigen::Index>(count, points.rows()));
  const std::vector<int> chosen = farthest_points(sorted, distinct);
  for (int i = 0; i < count; ++i) spread.row(i) = sorted.row(chosen[i % distinct]);
  return spread;
}

}  // namespace understudy::nn
