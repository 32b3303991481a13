#include "retarget/discovery/rest_surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/geometry/cells.hpp"
#include "retarget/geometry/closed_surface.hpp"
#include "retarget/geometry/cloud_normals.hpp"

namespace understudy {
namespace {

constexpr int kMostRestPoints = 200000, kRestVertices = 7000;
constexpr float kRestCell = 0.005f;  // of the body's size: of points so near one is made
constexpr int kSmoothings = 3;       // of the weights

/// Of a point the motion that its bones blend to.
struct Blend {
  Mat3 A = Mat3::Zero();  // hardly a rotation between bones that are turned much
  Vec3 t = Vec3::Zero();
  void add(float weight, const RigidMotion& bone) {
    A += weight * bone.R;
    t += weight * bone.t;
  }
};

/// How a place at rest moves: as the nearest points do, the more the nearer.
Blend blend_at(const Vec3& rest, const FittedSurface& surface, const PointTree& tree,
               const BoneMotions& bones, std::vector<PointTree::Near>& near) {
  constexpr int kNear = 4;
  tree.nearest(rest, kNear, near);
  const float soft = 0.1f * near.back().squared + 1e-12f;
  Blend blend;
  float sum = 0;
  for (const PointTree::Near& n : near) sum += 1 / (n.squared + soft);
  for (const PointTree::Near& n : near)
    for (int k = 0; k < kSkinBones; ++k)
      if (surface.skin.weights(n.point, k) > 0)
        blend.add(surface.skin.weights(n.point, k) / ((n.squared + soft) * sum),
                  bones[static_cast<size_t>(surface.skin.bones(n.point, k))]);
  return blend;
}

/// Points of one frame at rest, added to those that are there.
class RestGatherer {
 public:
  explicit RestGatherer(const FittedSurface& surface)
      : surface_(surface), tree_(surface.points), reach_(3 * point_spacing(surface.points)) {}
  void add(const ThinnedFrame& frame, const BoneMotions& bones, int most);
  OrientedPoints gathered() const {
    const auto rows = static_cast<Eigen::Index>(points_.size() / 3);
    return {Eigen::Map<const Points>(points_.data(), rows, 3),
            Eigen::Map<const Points>(normals_.data(), rows, 3)};
  }

 private:
  const FittedSurface& surface_;
  PointTree tree_;
  float reach_;
  std::vector<float> points_, normals_;
};

void RestGatherer::add(const ThinnedFrame& frame, const BoneMotions& bones, int most) {
  const PointTree posed(skinned(surface_.points, surface_.skin, bones));
  std::vector<PointTree::Near> near;
  const auto rows = std::min<Eigen::Index>(frame.points.rows(), most);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Eigen::Index i = row * frame.points.rows() / rows;
    const Vec3 at = frame.points.row(i).transpose(), normal = frame.normals.row(i).transpose();
    const PointTree::Near nearest = posed.nearest(at);
    const RigidMotion& bone = bones[static_cast<size_t>(surface_.skin.main_bone(nearest.point))];
    const Vec3 turned = bone.R.transpose() * normal;
    if (nearest.squared > reach_ * reach_ || turned.dot(surface_.normals.row(nearest.point).transpose()) < 0)
      continue;
    // As its nearest point would bring it there, then as the points about that place do.
    const Vec3 about = surface_.points.row(nearest.point).transpose() +
                       bone.R.transpose() * (at - posed.points().row(nearest.point).transpose());
    const Blend blend = blend_at(about, surface_, tree_, bones, near);
    if (blend.A.determinant() < 0.2f) continue;
    const Vec3 rest = blend.A.inverse() * (at - blend.t);
    if ((rest - about).squaredNorm() > reach_ * reach_) continue;
    points_.insert(points_.end(), rest.begin(), rest.end());
    normals_.insert(normals_.end(), turned.begin(), turned.end());
  }
}

/// One point for all those of a cell that face alike.
struct Thinned {
  OrientedPoints cloud;
  std::vector<int> counts;
};
Thinned one_a_cell(const OrientedPoints& all, float cell) {
  struct Sum {
    Vec3 point, normal;
    int count, next;  // the next of the same cell, -1: none
  };
  std::vector<Sum> sums;
  CellMap cells(static_cast<size_t>(all.points.rows()) / 4);
  for (Eigen::Index i = 0; i < all.points.rows(); ++i) {
    const Vec3 at = all.points.row(i).transpose(), normal = all.normals.row(i).transpose();
    int number = cells.at((at / cell).array().floor().cast<int>(), static_cast<int>(sums.size()));
    if (number == ssize(sums)) {
      sums.push_back({at, normal, 1, -1});
      continue;
    }
    while (sums[static_cast<size_t>(number)].normal.dot(normal) <= 0 &&
           sums[static_cast<size_t>(number)].next >= 0)
      number = sums[static_cast<size_t>(number)].next;
    Sum& sum = sums[static_cast<size_t>(number)];
    if (sum.normal.dot(normal) <= 0) {
      sum.next = ssize(sums);
      sums.push_back({at, normal, 1, -1});
    } else {
      sum.point += at, sum.normal += normal, ++sum.count;
    }
  }
  Thinned thinned{{Points(ssize(sums), 3), Points(ssize(sums), 3)}, {}};
  for (int i = 0; i < ssize(sums); ++i) {
    const Sum& sum = sums[static_cast<size_t>(i)];
    thinned.cloud.points.row(i) = (sum.point / static_cast<float>(sum.count)).transpose();
    thinned.cloud.normals.row(i) = sum.normal.normalized().transpose();
    thinned.counts.push_back(sum.count);
  }
  return thinned;
}

/// The plane of those about a point that face as it does; without what hardly anything is about.
OrientedPoints smoothed(const Thinned& thinned) {
  constexpr int kNear = 16;
  constexpr float kSparse = 0.12f;  // of the usual number of points about one
  const OrientedPoints& cloud = thinned.cloud;
  const PointTree tree(cloud.points);
  const float radius = 2.2f * point_spacing(cloud.points);
  OrientedPoints result = cloud;
  std::vector<float> about(static_cast<size_t>(cloud.points.rows()));
  std::vector<PointTree::Near> near;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    tree.nearest(cloud.points.row(i).transpose(), kNear, near);
    Vec3 mean = Vec3::Zero(), facing = Vec3::Zero();
    Mat3 moments = Mat3::Zero();
    float sum = 0;
    const Vec3 at = cloud.points.row(i).transpose();
    for (const PointTree::Near& n : near) {
      const Vec3 normal = cloud.normals.row(n.point).transpose();
      const float alike = normal.dot(cloud.normals.row(i).transpose());
      if (n.squared > radius * radius || alike < 0.2f) continue;
      const float weight = alike *
                           static_cast<float>(std::min(thinned.counts[static_cast<size_t>(n.point)], 8)) *
                           (1 - n.squared / (radius * radius));
      const Vec3 off = cloud.points.row(n.point).transpose() - at;
      mean += weight * off;
      facing += weight * normal;
      moments += weight * off * off.transpose();
      sum += weight;
    }
    about[static_cast<size_t>(i)] = sum;
    if (sum <= 0 || facing.norm() < 1e-6f) continue;
    mean /= sum;
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(moments / sum - mean * mean.transpose());
    facing.normalize();
    Vec3 normal = solver.eigenvectors().col(0);
    if (normal.dot(facing) < 0) normal = -normal;
    if (normal.dot(facing) < 0.6f || !normal.allFinite()) normal = facing;
    result.normals.row(i) = normal.transpose();
    result.points.row(i) = (at + normal.dot(mean) * normal).transpose();
  }
  std::vector<float> sorted = about;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(sorted.size() / 2), sorted.end());
  const float fewest = kSparse * sorted[sorted.size() / 2];
  std::vector<int> kept;
  for (int i = 0; i < ssize(about); ++i)
    if (about[static_cast<size_t>(i)] > fewest) kept.push_back(i);
  return {result.points(kept, Eigen::all), result.normals(kept, Eigen::all)};
}

/// Each vertex takes half of what its neighbours have.
SkinWeights smoothed_weights(const SkinWeights& skin, const Faces& faces, int bones) {
  RowMatrix weights = skin.dense(bones);
  for (int pass = 0; pass < kSmoothings; ++pass) {
    RowMatrix sum = RowMatrix::Zero(weights.rows(), weights.cols());
    Eigen::VectorXf count = Eigen::VectorXf::Constant(weights.rows(), 1e-6f);
    for (Eigen::Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) {
        sum.row(faces(f, c)) += weights.row(faces(f, (c + 1) % 3));
        count[faces(f, c)] += 1;
      }
    weights = 0.5f * (weights + count.cwiseInverse().asDiagonal() * sum);
  }
  return SkinWeights::from(weights);
}

}  // namespace

void set_rest_surface(const SeenBody& body, const Mesh& rest, Rig& rig) {
  RestGatherer gatherer(body.surface);
  const int most = kMostRestPoints / std::max(1, static_cast<int>(ssize(body.frames)));
  for (size_t t = 0; t < body.frames.size(); ++t) gatherer.add(body.frames[t], body.bones[t], most);
  const OrientedPoints all = gatherer.gathered();
  US_CHECK(all.points.rows() > 0, "no point lies on the surface");
  const float cell = std::max(kRestCell * box_diagonal(body.surface.points), point_spacing(all.points));
  Mesh surface = closed_surface(smoothed(one_a_cell(all, cell)), kRestVertices);
  if (rest.colors.rows() > 0) {
    const PointTree tree(rest.vertices);
    surface.colors.resize(surface.vertices.rows(), 3);
    for (Eigen::Index v = 0; v < surface.vertices.rows(); ++v)
      surface.colors.row(v) = rest.colors.row(tree.nearest(surface.vertices.row(v).transpose()).point);
  }
  rig.skin =
      smoothed_weights(weights_between(surface.vertices, body.surface.points, body.surface.skin, rig.count()),
                       surface.faces, rig.count());
  rig.surface = std::move(surface);
}

}  // namespace understudy
