#include "retarget/nn/pose_transfer.hpp"

#include <torch/torch.h>

#include <optional>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/pose_transfer_net.hpp"
#include "retarget/nn/scan_patches.hpp"
#include "retarget/nn/weights_file.hpp"

namespace understudy::nn {
namespace {

constexpr uint64_t kThinningSeed = 20240318;

struct Centred {
  Eigen::RowVector3f mean;
  float size;
  torch::Tensor points;  // [1, N, 3]
};

/// All points around the mean of the first `counted` and over their mean distance from it.
Centred centred(const Points& points, Eigen::Index counted) {
  const Eigen::RowVector3f mean = points.topRows(counted).colwise().mean();
  Points around = points.rowwise() - mean;
  const float size = around.topRows(counted).rowwise().norm().mean();
  US_CHECK(size > 1e-6f, "all points coincide");
  around /= size;
  return {mean, size, torch::from_blob(around.data(), {1, around.rows(), 3}, torch::kFloat32).clone()};
}

class PoseTransfer : public SurfaceTransfer {
 public:
  explicit PoseTransfer(const std::string& path) {
    load_weights(path, "pose-transfer", kPoseTransferVersion, *net_);
    net_->eval();
  }

  void reset(const Mesh& rest) override {
    US_CHECK(rest.vertices.rows() > 3 && rest.vertices.allFinite(),
             "pose transfer: the target has no usable points");
    // A file's vertices are dense in faces and hands; the network knows bodies by points spread evenly.
    Rng rng(kThinningSeed);
    const Points even = sample_points(rest, kPoseTransferPoints, rng);
    even_ = even.rows();
    Points all(even_ + rest.vertices.rows(), 3);
    all << even, rest.vertices;
    rest_ = centred(all, even_);
    first_.reset();
    sum_ = 0;
    frames_ = 0;
  }

  Points push(const Mesh& scan, float heading) override {
    US_CHECK(rest_, "pose transfer: no target was set");
    const torch::NoGradGuard no_grad;
    const Points thinned = thin_scan(scan, kThinningSeed);
    const Mat3 turn = rotation_about_y(heading);
    const Centred source = centred(thinned * turn, thinned.rows());  // rows: it faces +z
    const auto made = net_->forward(source.points, rest_->points, even_).contiguous();
    US_CHECK(torch::isfinite(made).all().item<bool>(), "the pose transfer network gave no finite point");
    Points posed = rest_->size * Eigen::Map<const Points>(made.data_ptr<float>(), made.size(1), 3);
    posed = (posed * turn.transpose()).eval();
    // Where it stands is no business of the network: over the scan's path, scaled, and as high over the
    // floor.
    const Eigen::RowVector3f here = thinned.colwise().mean();
    if (!first_) first_ = here;
    const Centred now = centred(posed, even_);
    follow(now.size / source.size);  // both in one pose
    posed.rowwise() += *first_ + scale_ * (here - *first_) - now.mean;
    posed.col(1).array() += scale_ * thinned.col(1).minCoeff() - posed.col(1).minCoeff();
    return posed.bottomRows(posed.rows() - even_);
  }

 private:
  /// Mean over the frames so far of how much larger the target is.
  void follow(float now) {
    sum_ += now;
    scale_ = static_cast<float>(sum_ / static_cast<double>(++frames_));
  }

  PoseTransferNet net_;
  std::optional<Centred> rest_;  // points spread evenly, then the vertices
  Eigen::Index even_ = 0;        // how many of them are the former
  std::optional<Eigen::RowVector3f> first_;
  float scale_ = 1;
  double sum_ = 0;
  int64_t frames_ = 0;
};

}  // namespace

std::unique_ptr<SurfaceTransfer> load_pose_transfer(const std::string& path) {
  return std::make_unique<PoseTransfer>(path);
}

}  // namespace understudy::nn
