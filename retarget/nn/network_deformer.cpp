#include "retarget/nn/network_deformer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
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

class NetworkDeformer : public Deformer {
 public:
  NetworkDeformer(const std::string& path, bool offsets) : path_(path), offsets_(offsets) {
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
  void keep_weights();
  void keep_offsets(const float* basis);
  void add_offsets(const Pose& pose, Points& rest) const;

  DeformationNet net_;
  std::string path_;
  bool offsets_;
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
  const BoundSurface bound =
      bind_surface(net_, tensor_of(rest.data(), rest.rows(), 3),
                   tensor_of(rest_joints.data(), kJointCount, 3), tensor_of(spread.data(), spread.rows(), 3));
  const torch::Tensor weights = bound.weights.contiguous(), basis = bound.basis.contiguous();
  using Numbers = Eigen::Map<const Eigen::VectorXf>;
  US_CHECK(Numbers(weights.data_ptr<float>(), weights.numel()).allFinite() &&
               Numbers(basis.data_ptr<float>(), basis.numel()).allFinite(),
           path_, ": the deformation networks give no numbers for this target");
  rest_ = rest;
  joints_ = rest_joints;
  weights_ = Eigen::Map<const RowMatrix>(weights.data_ptr<float>(), rest.rows(), kJointCount);
  tidy_weights(weights_);
  keep_weights();
  blocks_ = std::make_shared<std::vector<OffsetBlock>>();
  if (offsets_) keep_offsets(basis.data_ptr<float>());
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

void NetworkDeformer::keep_offsets(const float* basis) {
  auto blocks = std::make_shared<std::vector<OffsetBlock>>();
  for (Eigen::Index v = 0; v < rest_.rows(); ++v) {
    const Eigen::Map<const RowMatrix> own(basis + v * 3 * kPoseFeatureCount, 3, kPoseFeatureCount);
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

std::unique_ptr<Deformer> load_network_deformer(const std::string& path, bool offsets) {
  return std::make_unique<NetworkDeformer>(path, offsets);
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
