// The vector and array types that everything shares. Metres, seconds, right-handed, y up.
#pragma once

#include <Eigen/Core>

namespace understudy {

using Vec3 = Eigen::Vector3f;
using Vec6 = Eigen::Matrix<float, 6, 1>;
using Mat3 = Eigen::Matrix3f;
/// N points, one a row, [N, 3] in memory order, metres.
using Points = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// Triangles as rows of three vertex indices, counter-clockwise from outside.
using Faces = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr float kPi = 3.14159265358979f;

}  // namespace understudy
