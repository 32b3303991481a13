#include "retarget/body/cell_image.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

constexpr float kNothing = std::numeric_limits<float>::lowest();
constexpr float kWidest = 1000;   // cells to either side: what is farther out is seen there
constexpr float kNearest = 0.2f;  // metres before the camera: what is nearer is seen as if it were there

}  // namespace

CellImage::CellImage(const Points& image) {
  if (image.rows() == 0) return;
  US_CHECK(image.allFinite(), "points to be seen are not finite");
  const auto cells = image.leftCols(2).array().floor();
  const Eigen::Array2f low = cells.colwise().minCoeff().transpose(),
                       size = cells.colwise().maxCoeff().transpose() - low;
  US_CHECK(size.maxCoeff() < kMostCells, "points to be seen lie ", size.maxCoeff(), " cells apart");
  width_ = static_cast<int>(size[0]) + 3;
  nearest_.assign(static_cast<size_t>(width_) * (static_cast<size_t>(size[1]) + 3), kNothing);
  cell_.resize(image.rows());
  nearness_.resize(image.rows());
  for (Eigen::Index i = 0; i < image.rows(); ++i) {
    const int column = static_cast<int>(std::floor(image(i, 0)) - low[0]) + 1,
              row = static_cast<int>(std::floor(image(i, 1)) - low[1]) + 1;
    cell_[i] = row * width_ + column;
    nearness_[i] = image(i, 2);
    nearest_[cell_[i]] = std::max(nearest_[cell_[i]], nearness_[i]);
  }
}

bool CellImage::shows(int point, float depth) const {
  const int cell = cell_[point];
  float hidden_behind = nearest_[cell];
  for (const int beside : {cell - 1, cell + 1, cell - width_, cell + width_})
    if (nearest_[beside] != kNothing)
      hidden_behind = std::max(hidden_behind, nearest_[beside] - 0.5f * depth);
  return nearness_[point] > hidden_behind - depth;
}

bool CellImage::is_at_edge(int point, float depth) const {
  const int cell = cell_[point];
  for (const int beside : {cell - 1, cell + 1, cell - width_, cell + width_})
    if (nearest_[beside] == kNothing || nearest_[beside] < nearness_[point] - depth) return true;
  return false;
}

Mat3 camera_axes(const Vec3& from, const Vec3& at) {
  const Vec3 forwards = (at - from).normalized();
  const Vec3 across = forwards.cross(Vec3::UnitY());
  const Vec3 right = across.norm() > 1e-3f ? across.normalized() : Vec3(1, 0, 0);
  Mat3 axes;
  axes << right, right.cross(forwards), forwards;
  return axes;
}

Points seen_from(const Points& points, const Vec3& from, const Vec3& at, float cell) {
  Points own = (points.rowwise() - from.transpose()) * camera_axes(from, at);
  const float scale = (at - from).norm() / cell;
  for (Eigen::Index i = 0; i < own.rows(); ++i) {
    const float z = std::max(kNearest, own(i, 2));
    const auto cells = [&](float x) { return std::clamp(scale * x / z, -kWidest, kWidest); };
    own.row(i) << cells(own(i, 0)), cells(own(i, 1)), -own(i, 2);
  }
  return own;
}

}  // namespace understudy
