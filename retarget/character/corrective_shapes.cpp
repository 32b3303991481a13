#include "retarget/character/character_export.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr int kLookedAt = 120;
constexpr float kSmallestOffset = 5e-5f;  // metres: less is not worth its bytes

Eigen::Map<const Eigen::VectorXf> flat(const Points& points) {
  return {points.data(), points.size()};
}

/// Directions in which the offsets differ, of unit length, the largest first.
std::vector<Points> principal(const std::vector<Points>& seen, int count) {
  const Eigen::Index n = seen.size();
  Eigen::MatrixXf gram(n, n);  // O O^T with the offsets as rows of O
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b <= a; ++b) gram(a, b) = gram(b, a) = flat(seen[a]).dot(flat(seen[b]));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(gram);
  const float least = std::max(1e-10f, 1e-6f * solver.eigenvalues()[n - 1]);
  std::vector<Points> out;
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(count, n); ++k) {
    const Eigen::Index at = n - 1 - k;  // largest last
    if (solver.eigenvalues()[at] < least) break;
    Points shape = Points::Zero(seen[0].rows(), 3);
    for (Eigen::Index i = 0; i < n; ++i) shape += solver.eigenvectors()(i, at) * seen[i];
    out.push_back(shape / std::sqrt(solver.eigenvalues()[at]));
  }
  return out;
}

/// Moves the weights to 0..1, as many programs cut off what is outside; what that takes from the offsets goes
/// to `constant`.
void to_unit_range(CorrectiveShapes& shapes, Points& constant) {
  for (size_t k = 0; k < shapes.shapes.size(); ++k) {
    float low = shapes.weights[0][k], high = low;
    for (const auto& weights : shapes.weights) {
      low = std::min(low, weights[k]);
      high = std::max(high, weights[k]);
    }
    const float scale = std::max(high - low, 1e-12f);
    constant += low * shapes.shapes[k];
    shapes.shapes[k] *= scale;
    for (auto& weights : shapes.weights) weights[k] = std::clamp((weights[k] - low) / scale, 0.0f, 1.0f);
  }
}

void cut_small(std::vector<Points>& shapes) {
  for (Points& shape : shapes)
    for (Eigen::Index v = 0; v < shape.rows(); ++v)
      if (shape.row(v).norm() < kSmallestOffset) shape.row(v).setZero();
}

}  // namespace

CorrectiveShapes corrective_shapes(const Deformer& deformer, const std::vector<Pose>& poses, int count,
                                   const std::function<void(float)>& progress) {
  US_CHECK(!poses.empty() && count > 0, "there is no pose to take shapes from");
  const size_t step = (poses.size() + kLookedAt - 1) / kLookedAt;
  const size_t work = poses.size();
  size_t done = 0;
  const auto offsets_of = [&](const Pose& pose) {
    if (progress) progress(static_cast<float>(done++) / static_cast<float>(work));
    return deformer.offsets(pose);
  };
  std::vector<Points> seen;
  for (size_t i = 0; i < poses.size(); i += step) seen.push_back(offsets_of(poses[i]));
  Points constant = Points::Zero(seen[0].rows(), 3);
  for (const Points& offsets : seen) constant += offsets / static_cast<float>(seen.size());
  const Points mean = constant;
  for (Points& offsets : seen) offsets -= mean;
  CorrectiveShapes out;
  if (count > 1) out.shapes = principal(seen, count - 1);
  for (size_t i = 0; i < poses.size(); ++i) {
    const bool is_known = i % step == 0;
    const Points offsets = is_known ? std::move(seen[i / step]) : Points(offsets_of(poses[i]) - mean);
    std::vector<float> weights;
    for (const Points& shape : out.shapes) weights.push_back(flat(shape).dot(flat(offsets)));
    out.weights.push_back(std::move(weights));
  }
  to_unit_range(out, constant);
  out.shapes.insert(out.shapes.begin(), std::move(constant));
  for (auto& weights : out.weights) weights.insert(weights.begin(), 1.0f);
  cut_small(out.shapes);
  return out;
}

}  // namespace understudy
