#include "retarget/style/fit_manner.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/time_filter.hpp"

namespace understudy {
namespace {

constexpr size_t kFewestFrames = 10;
/// radians^2: what moves less than half a degree is not made to move by a gain.
constexpr double kStill = 1e-4;
constexpr Within<float> kGains{0.25f, 4};
/// Of a movement that only the other manner has: a style's file holds up to 20, more would be noise.
constexpr double kLargestGain = 19;
/// A style's file holds up to 60.
constexpr float kLargestTurn = 59 * kPi / 180;

/// f of a symmetric matrix's eigenvalues.
template <class F>
Eigen::MatrixXd by_eigenvalues(const Eigen::MatrixXd& matrix, F&& f) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  const Eigen::VectorXd values = solver.eigenvalues().unaryExpr(f);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

/// In doubles: the product has the squares of what moves least, which floats lose beside what moves most.
Eigen::MatrixXf transport(const Eigen::MatrixXf& from, const Eigen::MatrixXf& to) {
  const auto root = [](double x) { return std::sqrt(std::max(x, 0.0)); };
  const auto inverse_root = [](double x) { return 1 / std::sqrt(std::max(x, kStill)); };
  const auto still = kStill * Eigen::MatrixXd::Identity(from.rows(), from.cols());
  const Eigen::MatrixXd a = from.cast<double>() + still, b = to.cast<double>() + still,
                        half = by_eigenvalues(a, root), back = by_eigenvalues(a, inverse_root);
  const Eigen::MatrixXd map = back * by_eigenvalues(half * b * half, root) * back;
  return by_eigenvalues(map, [](double x) { return std::min(x, kLargestGain); }).cast<float>();
}

/// How much otherwise a joint is held, as far as a file holds it.
Vec3 limited(const Vec3& turn, int joint) {
  if (turn.norm() <= kLargestTurn) return turn;
  log::warn(detail::join(kJointNames[joint], ": is held ", std::lround(turn.norm() * 180 / kPi),
                         " degrees otherwise, the style takes ", std::lround(kLargestTurn * 180 / kPi),
                         " of them"));
  return kLargestTurn * turn.normalized();
}

}  // namespace

std::vector<int> fitted_joints(const std::string& which) {
  US_CHECK(which == "all" || which == "trunk-and-limbs" || which == "upper-body", "there are no joints '",
           which, "': all, trunk-and-limbs, upper-body");
  std::vector<int> joints;
  for (int j = 0; j < kJointCount; ++j) {
    const bool leg = is_of_leg(j), foot = leg && j >= LeftAnkle, wrist = j == LeftWrist || j == RightWrist;
    if (foot || (leg && which == "upper-body") || (wrist && which != "all")) continue;
    joints.push_back(j);
  }
  return joints;
}

void MannerSample::add(const std::vector<StyleFrame>& clip) {
  if (clip.size() < kFewestFrames) return;
  std::vector<StyleFrame> smooth = clip;
  double seconds = 0;
  for (size_t t = 1; t < clip.size(); ++t) seconds += static_cast<double>(clip[t].dt);
  const auto fps = static_cast<float>(static_cast<double>(clip.size() - 1) / std::max(seconds, 1e-3));
  const auto half = half_gaussian(
      std::min(1.0f, static_cast<float>(smooth_s_ / static_cast<double>(kSmoothestSeconds))), fps);
  for (const int j : joints_) {
    std::vector<Mat3> one;
    one.reserve(clip.size());
    for (const StyleFrame& frame : clip) one.push_back(frame.pose.local[j]);
    one = filtered_rotations(one, half);
    for (size_t t = 0; t < one.size(); ++t) smooth[t].pose.local[j] = one[t];
  }
  if (clips_++ == 0) {
    const auto count = static_cast<Eigen::Index>(3 * joints_.size());
    postures_ = Eigen::VectorXf::Zero(count);
    products_ = Eigen::MatrixXf::Zero(count, count);
  }
  JointMovement movement;
  Eigen::MatrixXf turns(products_.rows(), static_cast<Eigen::Index>(smooth.size()));
  Eigen::VectorXf sum = Eigen::VectorXf::Zero(products_.rows());
  for (size_t t = 0; t < smooth.size(); ++t) {
    movement.push(smooth[t]);
    for (size_t k = 0; k < joints_.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(3 * k);
      const Vec3& turn = movement.movements()[joints_[k]];
      turns.block<3, 1>(at, static_cast<Eigen::Index>(t)) = turn;
      sum.segment<3>(at) += movement.means()[joints_[k]] + turn;
    }
  }
  postures_ += sum / static_cast<float>(smooth.size());
  products_ += turns * turns.transpose() / static_cast<float>(smooth.size());
}

Manner fit_manner(const MannerSample& from, const MannerSample& to, bool coupled) {
  for (const MannerSample* one : {&from, &to})
    US_CHECK(one->clips() > 1, "a manner of moving is fitted to two recordings at least, there ",
             one->clips() == 1 ? "is one" : "are none");
  const std::vector<int>& joints = from.joints();
  const Eigen::MatrixXf a = from.covariance(), b = to.covariance();
  const Eigen::VectorXf held = to.posture() - from.posture();
  Manner manner;
  Coupling coupling;
  coupling.joints = joints;
  coupling.gains = Eigen::MatrixXf::Zero(a.rows(), a.cols());
  for (size_t k = 0; k < joints.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    coupling.offsets[joints[k]] = limited(held.segment<3>(at), joints[k]);
    const auto moves = [&](const Eigen::MatrixXf& of) {
      return std::max(of.block<3, 3>(at, at).trace(), static_cast<float>(kStill));
    };
    coupling.gains.diagonal().segment<3>(at).setConstant(
        std::clamp(std::sqrt(moves(b) / moves(a)), kGains.low, kGains.high));
  }
  if (coupled) coupling.gains = transport(a, b);
  manner.coupling = coupling;
  return manner;
}

}  // namespace understudy
