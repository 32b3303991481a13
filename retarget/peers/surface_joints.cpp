#include "retarget/peers/surface_joints.hpp"

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

constexpr float kLeast = 0.02f;  // of the product of both weights, a quarter at most
constexpr size_t kFewest = 8;    // vertices of a ring

}  // namespace

SurfaceJoints::SurfaceJoints(const Points& rest, const RowMatrix& weights, const Joints& joints)
    : count_(rest.rows()) {
  US_CHECK(weights.rows() == rest.rows() && weights.cols() == kJointCount, "the weights do not fit ",
           rest.rows(), " vertices");
  for (int j = 0; j < kJointCount; ++j) {
    Ring& ring = rings_[j];
    // The pelvis has no parent: what it shares with the first of the spine.
    const int other = kParents[j] < 0 ? static_cast<int>(Spine1) : kParents[j];
    std::vector<float> shared;
    for (Eigen::Index v = 0; v < rest.rows(); ++v)
      if (const float both = weights(v, j) * weights(v, other); both > kLeast) {
        ring.vertices.push_back(static_cast<int>(v));
        shared.push_back(both);
      }
    if (ring.vertices.size() < kFewest) {
      US_CHECK(j > 0, "the surface has too few vertices about the pelvis");
      ring = rings_[static_cast<size_t>(kParents[j])];
      ring.joint += (joints.row(j) - joints.row(kParents[j])).transpose();
      continue;
    }
    ring.weights = Eigen::Map<Eigen::VectorXf>(shared.data(), static_cast<Eigen::Index>(shared.size()));
    ring.weights /= ring.weights.sum();
    ring.rest.resize(static_cast<Eigen::Index>(ring.vertices.size()), 3);
    for (size_t i = 0; i < ring.vertices.size(); ++i)
      ring.rest.row(static_cast<Eigen::Index>(i)) = rest.row(ring.vertices[i]);
    const Eigen::RowVector3f mean = ring.weights.transpose() * ring.rest;
    ring.rest.rowwise() -= mean;
    ring.joint = (joints.row(j) - mean).transpose();
  }
}

Joints SurfaceJoints::of(const Points& posed) const {
  US_CHECK(posed.rows() == count_, "a surface of ", posed.rows(), " vertices, not ", count_);
  Joints joints;
  for (int j = 0; j < kJointCount; ++j) {
    const Ring& ring = rings_[j];
    Points now(ring.rest.rows(), 3);
    for (size_t i = 0; i < ring.vertices.size(); ++i)
      now.row(static_cast<Eigen::Index>(i)) = posed.row(ring.vertices[i]);
    const Eigen::RowVector3f mean = ring.weights.transpose() * now;
    now.rowwise() -= mean;
    joints.row(j) = mean + (kabsch(ring.rest, now, ring.weights) * ring.joint).transpose();
  }
  return joints;
}

}  // namespace understudy
