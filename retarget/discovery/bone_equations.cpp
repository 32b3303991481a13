#include "retarget/discovery/bone_equations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

namespace understudy {

Eigen::VectorXd solved(const Eigen::MatrixXd& normal, const Eigen::VectorXd& gradient) {
  constexpr Eigen::Index kDense = 400;  // unknowns: up to here the whole matrix is as quick
  if (normal.rows() <= kDense) return normal.ldlt().solve(gradient);
  const Eigen::SparseMatrix<double> blocks = normal.sparseView();
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(blocks).solve(gradient);
}

}  // namespace understudy
