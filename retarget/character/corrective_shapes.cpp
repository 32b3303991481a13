#include "retarget/character/corrective_shapes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr int kLookedAt = 120;
constexpr float kSmallest = 5e-5f;  // metres at the largest weight: less is not worth its bytes

Eigen::Map<const Eigen::VectorXf> flat(const Points& points) {
  return {points.data(), points.size()};
}

}  // namespace

CorrectiveShapes corrective_shapes(const Deformer& deformer, const std::vector<Pose>& poses, int count,
                                   const std::function<void(float)>& progress) {
  US_CHECK(!poses.empty() && count > 0, "there is no pose to take shapes from");
  const size_t step = (poses.size() + kLookedAt - 1) / kLookedAt;
  const size_t work = poses.size() + poses.size() / step;
  size_t done = 0;
  const auto offsets_of = [&](const Pose& pose) {
    if (progress) progress(static_cast<float>(done++) / static_cast<float>(work));
    return deformer.offsets(pose);
  };
  std::vector<Points> seen;
  for (size_t i = 0; i < poses.size(); i += step) seen.push_back(offsets_of(poses[i]));
  const auto n = static_cast<Eigen::Index>(seen.size());
  Eigen::MatrixXf gram(n, n);  // O O^T with the offsets as rows of O
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b <= a; ++b)
      gram(a, b) = gram(b, a) = flat(seen[static_cast<size_t>(a)]).dot(flat(seen[static_cast<size_t>(b)]));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(gram);
  CorrectiveShapes out;
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(count, n); ++k) {
    const Eigen::Index at = n - 1 - k;  // largest last
    if (solver.eigenvalues()[at] < 1e-10f) break;
    Points shape = Points::Zero(seen[0].rows(), 3);
    for (Eigen::Index i = 0; i < n; ++i) shape += solver.eigenvectors()(i, at) * seen[static_cast<size_t>(i)];
    out.shapes.push_back(shape / std::sqrt(solver.eigenvalues()[at]));
  }
  std::vector<float> largest(out.shapes.size(), 0.0f);
  for (const Pose& pose : poses) {
    const Points offsets = offsets_of(pose);
    std::vector<float> weights;
    for (const Points& shape : out.shapes) weights.push_back(flat(shape).dot(flat(offsets)));
    for (size_t k = 0; k < weights.size(); ++k) largest[k] = std::max(largest[k], std::abs(weights[k]));
    out.weights.push_back(std::move(weights));
  }
  for (size_t k = 0; k < out.shapes.size(); ++k) {  // weights within -1..1, as programs show them
    const float scale = std::max(largest[k], 1e-12f);
    out.shapes[k] *= scale;
    for (Eigen::Index v = 0; v < out.shapes[k].rows(); ++v)
      if (out.shapes[k].row(v).norm() < kSmallest) out.shapes[k].row(v).setZero();
    for (auto& weights : out.weights) weights[k] /= scale;
  }
  return out;
}

}  // namespace understudy
