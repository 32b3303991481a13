#include "retarget/motion_space/linear_coder.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/rng.hpp"

namespace understudy {
namespace {

constexpr int kRounds = 6, kSpare = 24;  // of subspace iteration

class LinearCoder final : public MotionCoder {
 public:
  LinearCoder(Eigen::RowVectorXf mean, RowMatrix components, Eigen::VectorXf deviation)
      : mean_(std::move(mean)), components_(std::move(components)), deviation_(std::move(deviation)) {}

  int size() const override { return static_cast<int>(components_.rows()); }
  std::string name() const override { return "linear"; }

  MotionCode encode(const TimedPoses& movement, const Joints& rest) override {
    const Eigen::VectorXf code =
        (components_ * (step_numbers(movement, rest) - mean_.transpose())).cwiseQuotient(deviation_);
    return {{code.data(), code.data() + code.size()}, {}};
  }

  TimedPoses decode(const std::vector<float>& code, const Joints& rest) override {
    US_CHECK(ssize(code) == size(), "a movement's code is ", size(), " numbers, not ", code.size());
    const Eigen::Map<const Eigen::VectorXf> z(code.data(), ssize(code));
    US_CHECK(z.allFinite(), "a movement's code is not finite");
    return movement_of_numbers(mean_.transpose() + components_.transpose() * z.cwiseProduct(deviation_),
                               rest);
  }

 private:
  Eigen::RowVectorXf mean_;
  RowMatrix components_;  // [size, kStepNumbers]
  Eigen::VectorXf deviation_;
};

/// An orthonormal basis of the columns.
Eigen::MatrixXf orthonormal(const Eigen::MatrixXf& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXf> qr(columns);
  return qr.householderQ() * Eigen::MatrixXf::Identity(columns.rows(), columns.cols());
}

}  // namespace

/// By subspace iteration (Halko et al. 2011, algorithm 4.4): the whole spectrum is not wanted.
std::unique_ptr<MotionCoder> fit_linear_coder(const RowMatrix& rows, int size) {
  US_CHECK(rows.cols() == kStepNumbers && size > 0 && rows.rows() > size && size <= kStepNumbers, "from ",
           rows.rows(), " steps no ", size, " components can be made");
  const Eigen::RowVectorXf mean = rows.colwise().mean();
  const Eigen::MatrixXf centred = rows.rowwise() - mean;
  const Eigen::Index width = std::min<Eigen::Index>(size + kSpare, std::min(rows.rows(), rows.cols()));
  Eigen::MatrixXf basis(rows.cols(), width);
  Rng rng(1);
  for (Eigen::Index i = 0; i < basis.size(); ++i) basis.data()[i] = rng.normal();
  for (int round = 0; round < kRounds; ++round)
    basis = orthonormal(centred.transpose() * orthonormal(centred * basis));
  const Eigen::JacobiSVD<Eigen::MatrixXf> svd(orthonormal(centred * basis).transpose() * centred,
                                              Eigen::ComputeThinV);
  const float count = static_cast<float>(rows.rows());
  return std::make_unique<LinearCoder>(mean, svd.matrixV().leftCols(size).transpose(),
                                       (svd.singularValues().head(size) / std::sqrt(count)).cwiseMax(1e-6f));
}

}  // namespace understudy
