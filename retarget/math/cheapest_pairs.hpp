// Who belongs to whom, one to one, at the least cost together.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace understudy {

/// As many pairs of rows and columns as there can be, with the least sum of costs (the Hungarian method, in
/// the square of the smaller side times the larger): the column of each row, -1 where columns are too few.
/// Throws Error where a cost is not finite.
std::vector<int> cheapest_pairs(const Eigen::MatrixXd& cost);

}  // namespace understudy
