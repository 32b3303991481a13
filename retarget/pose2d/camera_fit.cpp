#include "retarget/pose2d/camera_fit.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/keypoints/proportions.hpp"

namespace understudy {
namespace {

constexpr int kHeadings = 12, kSteps = 40;

using Unknowns = Eigen::Vector4d;  // yaw, shift to the right and up in metres, logarithm of distance or focal

/// The points that count.
class FitProblem {
 public:
  FitProblem(const BodyPlaces& places, const FlatPose& reference, const CameraFitOptions& options)
      : options_(options) {
    for (int point = 0; point < kPaperPoints; ++point) {
      if (!reference.has(point)) continue;
      places_.emplace_back(places.row(point).transpose());
      wanted_.push_back(reference.at(point));
      weights_.push_back(std::sqrt(reference.confidence(point)));
      middle_ += places_.back();
      seen_middle_ += wanted_.back();
    }
    US_CHECK(places_.size() >= 4, "only ", places_.size(),
             " points of the reference are seen: too few to find its camera");
    middle_ /= static_cast<float>(places_.size());
    seen_middle_ /= static_cast<float>(places_.size());
  }

  Pinhole camera(const Unknowns& x) const {
    const Mat3 axes = camera_axes(static_cast<float>(x[0]), options_.pitch);
    const float scale = std::exp(static_cast<float>(x[3]));
    const Vec3 aim = middle_ - axes * Vec3(static_cast<float>(x[1]), static_cast<float>(x[2]), 0);
    Pinhole out = looking_at(aim, axes, options_.orthographic ? 10 : scale);
    out.focal = options_.orthographic ? scale : options_.focal;
    out.centre = options_.centre;
    out.orthographic = options_.orthographic;
    return out;
  }

  /// Weighed, pixels.
  Eigen::VectorXd residuals(const Unknowns& x) const {
    const Pinhole seen_by = camera(x);
    Eigen::VectorXd r(2 * static_cast<Eigen::Index>(places_.size()));
    for (size_t k = 0; k < places_.size(); ++k) {
      const Vec2 off = weights_[k] * (seen_by.project(places_[k]).head<2>() - wanted_[k]);
      r.segment<2>(2 * static_cast<Eigen::Index>(k)) = off.cast<double>();
    }
    return r;
  }

  /// Seen from a heading: as large and where the reference is.
  Unknowns start(double yaw) const {
    const Mat3 axes = camera_axes(static_cast<float>(yaw), options_.pitch);
    float size = 0, seen_size = 0;
    for (size_t k = 0; k < places_.size(); ++k) {
      size += (axes.transpose() * (places_[k] - middle_)).head<2>().squaredNorm();
      seen_size += (wanted_[k] - seen_middle_).squaredNorm();
    }
    const float pixels_a_metre = std::sqrt(std::max(seen_size, 1e-6f) / std::max(size, 1e-6f));
    const Vec2 shift = (seen_middle_ - options_.centre) / pixels_a_metre;
    const double scale = options_.orthographic ? pixels_a_metre : options_.focal / pixels_a_metre;
    return {yaw, shift.x(), -shift.y(), std::log(scale)};
  }

  /// Of the points, unweighed, root of the mean square.
  float error(const Unknowns& x) const {
    const Pinhole seen_by = camera(x);
    float sum = 0;
    for (size_t k = 0; k < places_.size(); ++k)
      sum += (seen_by.project(places_[k]).head<2>() - wanted_[k]).squaredNorm();
    return std::sqrt(sum / static_cast<float>(places_.size()));
  }

 private:
  CameraFitOptions options_;
  std::vector<Vec3> places_;
  std::vector<Vec2> wanted_;
  std::vector<float> weights_;
  Vec3 middle_ = Vec3::Zero();
  Vec2 seen_middle_ = Vec2::Zero();
};

/// Forward differences.
Eigen::MatrixXd slopes(const FitProblem& problem, const Unknowns& x, const Eigen::VectorXd& r) {
  constexpr double kStep = 1e-3;
  Eigen::MatrixXd J(r.size(), 4);
  for (int k = 0; k < 4; ++k) {
    Unknowns beside = x;
    beside[k] += kStep;
    J.col(k) = (problem.residuals(beside) - r) / kStep;
  }
  return J;
}

/// Gauss-Newton, damped (Levenberg and Marquardt).
Unknowns refined(const FitProblem& problem, Unknowns x) {
  double damping = 1e-3;
  Eigen::VectorXd r = problem.residuals(x);
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::MatrixXd J = slopes(problem, x, r);
    Eigen::Matrix4d H = J.transpose() * J;
    H.diagonal() *= 1 + damping;
    const Unknowns to = x - H.ldlt().solve(J.transpose() * r);
    const Eigen::VectorXd moved = problem.residuals(to);
    const bool helps = to.allFinite() && moved.allFinite() && moved.squaredNorm() < r.squaredNorm();
    damping = helps ? damping / 4 : damping * 8;
    if (!helps) continue;
    x = to, r = moved;
  }
  return x;
}

}  // namespace

CameraFit fit_camera(const BodyPlaces& places, const FlatPose& reference, const CameraFitOptions& options) {
  const FitProblem problem(places, reference, options);
  Unknowns best;
  double least = -1;
  for (int k = 0; k < kHeadings; ++k) {
    const Unknowns x = refined(problem, problem.start(2 * static_cast<double>(kPi) * k / kHeadings));
    const double cost = problem.residuals(x).squaredNorm();
    if (!std::isfinite(cost) || (least >= 0 && cost >= least)) continue;
    least = cost;
    best = x;
  }
  US_CHECK(least >= 0, "no camera was found that sees the body as the reference is seen");
  return {problem.camera(best), problem.error(best)};
}

}  // namespace understudy
