#include "retarget/motion_space/banded_blocks.hpp"

#include "retarget/base/index.hpp"

namespace understudy {

bool BandedBlocks::factor() {
  const int count = ssize(own);
  factors_.assign(own.size(), {});
  below_.assign(own.size(), {});
  below_second_.assign(own.size(), {});
  for (int t = 0; t < count; ++t) {
    Eigen::MatrixXd rest = own[t];
    for (const auto& [back, below] : {std::pair(1, &below_), std::pair(2, &below_second_)})
      if (t >= back) rest.selfadjointView<Eigen::Lower>().rankUpdate((*below)[t - back], -1);
    factors_[t].compute(rest);
    if (factors_[t].info() != Eigen::Success) return false;
    // Row blocks of the factor: X L^T = B, so X^T = L^-1 B^T.
    const auto divided = [&](const Eigen::MatrixXd& block) {
      return Eigen::MatrixXd(factors_[t].matrixL().solve(block.transpose()).transpose());
    };
    if (t + 1 < count) {
      Eigen::MatrixXd block = next[t].asDiagonal();
      if (t >= 1) block.noalias() -= below_second_[t - 1] * below_[t - 1].transpose();
      below_[t] = divided(block);
    }
    if (t + 2 < count) below_second_[t] = divided(second[t].asDiagonal());
  }
  return true;
}

void BandedBlocks::solve(Eigen::Ref<Eigen::MatrixXd> right) const {
  const int count = ssize(own);
  const Eigen::Index size = count > 0 ? own[0].rows() : 0;
  const auto rows = [&](int t) { return right.middleRows(t * size, size); };
  for (int t = 0; t < count; ++t) {
    if (t >= 1) rows(t).noalias() -= below_[t - 1] * rows(t - 1);
    if (t >= 2) rows(t).noalias() -= below_second_[t - 2] * rows(t - 2);
    factors_[t].matrixL().solveInPlace(rows(t));
  }
  for (int t = count - 1; t >= 0; --t) {
    if (t + 1 < count) rows(t).noalias() -= below_[t].transpose() * rows(t + 1);
    if (t + 2 < count) rows(t).noalias() -= below_second_[t].transpose() * rows(t + 2);
    factors_[t].matrixU().solveInPlace(rows(t));
  }
}

}  // namespace understudy
