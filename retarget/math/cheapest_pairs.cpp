#include "retarget/math/cheapest_pairs.hpp"

#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

/// One row after the other joins along the cheapest alternating path; u, v are the prices of rows and
/// columns. No more rows than columns. Gives the row of each column, -1 where it has none.
std::vector<int> rows_of_columns(const Eigen::MatrixXd& cost) {
  const Eigen::Index rows = cost.rows(), columns = cost.cols();
  std::vector<double> u(rows, 0), v(columns + 1, 0);
  std::vector<int> row_of(columns + 1, -1);  // the last column is where each new row starts
  for (int row = 0; row < rows; ++row) {
    std::vector<double> least(columns, std::numeric_limits<double>::infinity());
    std::vector<int> before(columns, -1);
    std::vector<char> done(columns + 1, 0);
    auto at = static_cast<int>(columns);
    row_of[at] = row;
    while (row_of[at] >= 0) {
      done[at] = 1;
      double step = std::numeric_limits<double>::infinity();
      int next = -1;
      for (int c = 0; c < columns; ++c) {
        if (done[c]) continue;
        const double reduced = cost(row_of[at], c) - u[row_of[at]] - v[c];
        if (reduced < least[c]) least[c] = reduced, before[c] = at;
        if (least[c] < step) step = least[c], next = c;
      }
      for (int c = 0; c <= columns; ++c)
        if (done[c])
          u[row_of[c]] += step, v[c] -= step;
        else if (c < columns)
          least[c] -= step;
      at = next;
    }
    for (; at != columns; at = before[at]) row_of[at] = row_of[before[at]];
    row_of[columns] = -1;
  }
  row_of.pop_back();
  return row_of;
}

}  // namespace

std::vector<int> cheapest_pairs(const Eigen::MatrixXd& cost) {
  US_CHECK(cost.allFinite(), "a cost that is not finite pairs nobody");
  if (cost.rows() > cost.cols()) return rows_of_columns(cost.transpose());
  std::vector<int> columns(cost.rows(), -1);
  const std::vector<int> rows = rows_of_columns(cost);
  for (size_t c = 0; c < rows.size(); ++c)
    if (rows[c] >= 0) columns[rows[c]] = static_cast<int>(c);
  return columns;
}

}  // namespace understudy
