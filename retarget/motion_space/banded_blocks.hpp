// A symmetric system of equations about things in a row, each tied to the two before it and the two behind.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

namespace understudy {

/// Block Cholesky of a positive definite matrix of `count` x `count` blocks, each [size, size], of which only
/// those at most two beside the diagonal are not zero.
class BandedBlocks {
 public:
  BandedBlocks(int count, int size)
      : own(count, Eigen::MatrixXd::Zero(size, size)),
        next(count, Eigen::VectorXd::Zero(size)),
        second(count, Eigen::VectorXd::Zero(size)) {}

  std::vector<Eigen::MatrixXd> own;     ///< on the diagonal; lower halves are read
  std::vector<Eigen::VectorXd> next;    ///< diagonal of the block below each
  std::vector<Eigen::VectorXd> second;  ///< and of the one below that

  /// Once all blocks are set. False where the matrix is not positive definite.
  bool factor();
  /// Solves for each column of `right` [count * size, columns] in place.
  void solve(Eigen::Ref<Eigen::MatrixXd> right) const;

 private:
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factors_;
  std::vector<Eigen::MatrixXd> below_, below_second_;  // of the Cholesky factor
};

}  // namespace understudy
