#include "render/scene.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace understudy::render {
namespace {

/// Points sorted into cubes, so that the neighbours of a point lie in the 27 cubes around it.
class Cubes {
 public:
  Cubes(const Points& points, float side) : points_(points), side_(side), low_(points.colwise().minCoeff()) {
    order_.resize(static_cast<size_t>(points.rows()));
    std::iota(order_.begin(), order_.end(), 0);
    keys_.reserve(order_.size());
    for (int i : order_) keys_.push_back(key(cell(i)));
    std::sort(order_.begin(), order_.end(), [this](int a, int b) { return keys_[a] < keys_[b]; });
    sorted_.reserve(order_.size());
    for (int i : order_) sorted_.push_back(keys_[i]);
  }

  /// Calls visit(j) for each point in the cubes about point i; along x three cubes are one run of keys.
  template <class Visit>
  void near(int i, Visit visit) const {
    const Eigen::Vector3i c = cell(i);
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const uint64_t first = key(c + Eigen::Vector3i(-1, y, z));
        auto at = std::lower_bound(sorted_.begin(), sorted_.end(), first) - sorted_.begin();
        for (; at < static_cast<long>(sorted_.size()) && sorted_[at] <= first + 2; ++at) visit(order_[at]);
      }
  }

 private:
  Eigen::Vector3i cell(int i) const {
    const Vec3 at = (points_.row(i) - low_).transpose() / side_;
    return at.cwiseMin(1e6f).cast<int>() +
           Eigen::Vector3i::Ones();  // +1: the cube before the first has a key too
  }
  static uint64_t key(const Eigen::Vector3i& c) {
    return (static_cast<uint64_t>(c.y()) << 42) | (static_cast<uint64_t>(c.z()) << 21) |
           static_cast<uint64_t>(c.x());
  }

  const Points& points_;
  float side_;
  Eigen::RowVector3f low_;
  std::vector<int> order_;
  std::vector<uint64_t> keys_, sorted_;
};

}  // namespace

SkeletonView skeleton_view(const Joints& joints) {
  SkeletonView view;
  view.joints = joints;
  view.parents.assign(kParents.begin(), kParents.end());
  for (int j = 0; j < kJointCount; ++j)
    view.sides.push_back(kMirror[j] == j            ? Side::Middle
                         : kJointNames[j][0] == 'l' ? Side::Left
                                                    : Side::Right);
  return view;
}

void add(Scene& scene, const Mesh& mesh) {
  if (mesh.is_cloud()) {
    PointsView view;
    view.positions = mesh.vertices;
    const float spacing = point_spacing(mesh.vertices);
    view.normals = estimated_normals(mesh.vertices, 3 * spacing);
    if (spacing > 0) view.radius = spacing;
    view.colors = mesh.colors;
    scene.clouds.push_back(std::move(view));
  } else {
    MeshView view;
    view.vertices = mesh.vertices;
    view.faces = mesh.faces;
    view.colors = mesh.colors;
    scene.meshes.push_back(std::move(view));
  }
}

Points all_points(const Scene& scene) {
  std::vector<const Points*> parts;
  for (const auto& mesh : scene.meshes) parts.push_back(&mesh.vertices);
  for (const auto& cloud : scene.clouds) parts.push_back(&cloud.positions);
  for (const auto& skeleton : scene.skeletons) parts.push_back(&skeleton.joints);
  Eigen::Index rows = 0, used = 0;
  for (const Points* part : parts) rows += part->rows();
  Points all(rows, 3);
  for (const Points* part : parts)
    for (Eigen::Index i = 0; i < part->rows(); ++i)
      if (part->row(i).allFinite()) all.row(used++) = part->row(i);
  all.conservativeResize(used, 3);
  return all;
}

float point_spacing(const Points& points) {
  constexpr int kProbes = 101, kNeighbours = 6;
  if (points.rows() < kNeighbours + 2) return 0;
  std::vector<float> spacings;
  for (int probe = 0; probe < kProbes; ++probe) {
    const Eigen::Index i = probe * (points.rows() - 1) / (kProbes - 1);
    Eigen::VectorXf d = (points.rowwise() - points.row(i)).rowwise().squaredNorm();
    std::nth_element(d.data(), d.data() + kNeighbours, d.data() + d.size());
    if (std::isfinite(d[kNeighbours]))
      spacings.push_back(std::sqrt(kPi * d[kNeighbours] / (kNeighbours + 1)));
  }
  if (spacings.empty()) return 0;
  std::nth_element(spacings.begin(), spacings.begin() + static_cast<long>(spacings.size() / 2),
                   spacings.end());
  return spacings[spacings.size() / 2];
}

Points estimated_normals(const Points& points, float radius) {
  Points normals = Points::Zero(points.rows(), 3);
  if (points.rows() < 4 || !points.allFinite()) return normals;
  if (radius <= 0) radius = 3 * point_spacing(points);
  if (radius <= 0) return normals;
  const Cubes cubes(points, radius);
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  for (int i = 0; i < points.rows(); ++i) {
    Mat3 scatter = Mat3::Zero();
    Vec3 sum = Vec3::Zero();
    int count = 0;
    cubes.near(i, [&](int j) {
      const Vec3 d = (points.row(j) - points.row(i)).transpose();
      if (d.squaredNorm() > radius * radius) return;
      scatter += d * d.transpose();
      sum += d;
      ++count;
    });
    if (count < 4) continue;
    solver.computeDirect(scatter - sum * sum.transpose() / static_cast<float>(count));
    normals.row(i) = solver.eigenvectors().col(0).transpose();
  }
  return normals;
}

}  // namespace understudy::render
