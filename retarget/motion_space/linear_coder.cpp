#include "retarget/motion_space/linear_coder.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

constexpr float kLeastDeviation = 1e-3f;  // against the largest: what is less is no direction
constexpr int kRounds = 6, kSpare = 24;   // of subspace iteration

class LinearCoder final : public MotionCoder {
 public:
  explicit LinearCoder(LinearSpace space) : space_(std::move(space)) {}

  int size() const override { return static_cast<int>(space_.to_codes.rows()); }
  std::string name() const override { return "linear"; }

  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    const Eigen::VectorXf code = space_.to_codes * (step_numbers(movement, rest) - space_.mean);
    return {{code.data(), code.data() + code.size()}, {}};
  }

  TimedPoses decode(const std::vector<float>& code, const Joints& rest) override {
    US_CHECK(ssize(code) == size(), "a movement's code is ", size(), " numbers, not ", code.size());
    const Eigen::Map<const Eigen::VectorXf> z(code.data(), ssize(code));
    US_CHECK(z.allFinite(), "a movement's code is not finite");
    return movement_of_numbers(space_.mean + space_.to_movements * z, rest);
  }

 private:
  LinearSpace space_;
};

/// An orthonormal basis of the columns.
Eigen::MatrixXf orthonormal(const Eigen::MatrixXf& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXf> qr(columns);
  return qr.householderQ() * Eigen::MatrixXf::Identity(columns.rows(), columns.cols());
}

/// Principal components of rows of numbers.
struct LinearFit {
  RowMatrix components;       // [size, N] orthonormal
  Eigen::VectorXf deviation;  // [size] of the rows along each, falling
};

/// By subspace iteration (Halko et al. 2011, algorithm 4.4): the whole spectrum is not wanted.
LinearFit principal_components(const RowMatrix& rows, int size) {
  US_CHECK(size > 0 && rows.rows() > size && size <= rows.cols(), "from ", rows.rows(), " steps no ", size,
           " components can be made");
  LinearFit fit;
  const Eigen::MatrixXf centred = rows.rowwise() - rows.colwise().mean();
  const Eigen::Index width = std::min<Eigen::Index>(size + kSpare, std::min(rows.rows(), rows.cols()));
  Eigen::MatrixXf basis(rows.cols(), width);
  Rng rng(1);
  for (Eigen::Index i = 0; i < basis.size(); ++i) basis.data()[i] = rng.normal();
  for (int round = 0; round < kRounds; ++round)
    basis = orthonormal(centred.transpose() * orthonormal(centred * basis));
  const Eigen::JacobiSVD<Eigen::MatrixXf> svd(orthonormal(centred * basis).transpose() * centred,
                                              Eigen::ComputeThinV);
  fit.components = svd.matrixV().leftCols(size).transpose();
  const float count = static_cast<float>(rows.rows());
  fit.deviation = (svd.singularValues().head(size) / std::sqrt(count)).cwiseMax(1e-6f);
  return fit;
}

}  // namespace

StepNumbers surface_reach(const ShapedBody& body, const StepNumbers& movement) {
  constexpr float kLittle = 1e-2f;
  constexpr int kMiddle = kKnots / 2;
  const auto vertices = [&](const StepNumbers& numbers) {
    const Pose pose = movement_of_numbers(numbers, body.joints).poses[kMiddle];
    return linear_blend_skinning(body.vertices, body.weights, body.joints,
                                 forward_kinematics(body.joints, pose));
  };
  const Points before = vertices(movement);
  StepNumbers reach = StepNumbers::Ones(kStepNumbers);
  const auto put = [&](int first, int count, int number) {
    StepNumbers moved = movement;
    moved(first + kMiddle * count + number) += kLittle;
    const float far = std::sqrt((vertices(moved) - before).rowwise().squaredNorm().mean()) / kLittle;
    for (int k = 0; k < kKnots; ++k) reach(first + k * count + number) = std::max(far, kLittle);
  };
  for (int i = 0; i < kKnotTurns; ++i) put(0, kKnotTurns, i);
  for (int i = 0; i < 3; ++i) put(kStepTurns, 3, i);
  return reach;
}

LinearSpace::LinearSpace(const RowMatrix& rows, const StepNumbers& scale, int size) {
  US_CHECK(rows.cols() == kStepNumbers && scale.size() == kStepNumbers, "a step is ", kStepNumbers,
           " numbers, not ", rows.cols(), " by ", scale.size());
  const LinearFit fit = principal_components(rows * scale.asDiagonal(), size);
  const Eigen::VectorXf deviation = fit.deviation.cwiseMax(kLeastDeviation * fit.deviation(0));
  mean = rows.colwise().mean();
  to_codes = deviation.cwiseInverse().asDiagonal() * fit.components * scale.asDiagonal();
  to_movements = scale.cwiseInverse().asDiagonal() * fit.components.transpose() * deviation.asDiagonal();
}

std::unique_ptr<MotionCoder> fit_linear_coder(const RowMatrix& rows, int size, const ShapedBody* body) {
  StepNumbers scale = StepNumbers::Ones(kStepNumbers);
  if (body) scale = surface_reach(*body, rows.colwise().mean());
  return std::make_unique<LinearCoder>(LinearSpace(rows, scale, size));
}

}  // namespace understudy
