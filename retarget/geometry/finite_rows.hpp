// Points whose numbers are numbers.
#pragma once

#include "retarget/math/types.hpp"

namespace understudy {

/// The rows that are finite, in order.
inline Points finite_rows(const Points& points) {
  Points kept(points.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) kept.row(count++) = points.row(i);
  return kept.topRows(count);
}

}  // namespace understudy
