#include "retarget/body/posed_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

constexpr float kHandReach =
    0.27f;  // from the wrist to the fingertips and as far up the forearm, leg lengths

}  // namespace

std::array<HandAngles, 2> HandMotion::next() {
  std::array<HandAngles, 2> now;
  for (size_t side = 0; side < 2; ++side) now[side] = from[side] + share * (to[side] - from[side]);
  share = std::clamp(share + step, 0.0f, 1.0f);
  return now;
}

PosedSurface::PosedSurface(const ShapedBody& body, const Pose& pose, const SurfaceLook& look)
    : body_(body),
      look_(look),
      truth_(forward_kinematics(body.joints, pose)),
      features_(pose_features(pose.local)),
      corners_(body.vertices.rows()),
      is_known_(body.vertices.rows(), 0) {
  if (look.hand_poses && look.hands && !look.hands->empty())
    hands_.emplace(*look.hand_poses, *look.hands, body.vertices, look.angles);
}

const PosedSurface::Corner& PosedSurface::corner(int vertex) {
  Corner& at = corners_[vertex];
  if (is_known_[vertex]) return at;
  is_known_[vertex] = 1;
  at.place = hands_ ? hands_->vertex(vertex) : Vec3(body_.vertices.row(vertex).transpose());
  at.offset.setZero();
  if (body_.pose_dirs) at.offset = body_.pose_dirs->middleRows<3>(3 * vertex) * features_;
  return at;
}

PosedSurface::RestPoints PosedSurface::rest_points(const SurfaceSampler& sampler, const Faces& faces,
                                                   int count, Rng& rng) {
  RestPoints rest{Points::Zero(count, 3), Points::Zero(count, 3), Points::Zero(count, 3),
                  RowMatrix::Zero(count, kJointCount)};
  for (int i = 0; i < count; ++i) {
    const auto s = sampler.sample(rng);
    std::array<Vec3, 3> places;
    for (int k = 0; k < 3; ++k) {
      const int v = faces(s.face, k);
      const float b = s.barycentric[k];
      const Corner& at = corner(v);
      places[k] = at.place;
      rest.points.row(i) += b * at.place.transpose();
      rest.offsets.row(i) += b * at.offset.transpose();
      rest.weights.row(i) += b * body_.weights.row(v);
    }
    const Vec3 normal = (places[1] - places[0]).cross(places[2] - places[0]);
    rest.normals.row(i) = (normal / std::max(normal.norm(), 1e-20f)).transpose();
  }
  return rest;
}

OrientedPoints PosedSurface::sample(const SurfaceSampler& sampler, const Faces& faces, int count, Rng& rng) {
  RestPoints rest = rest_points(sampler, faces, count, rng);
  if (look_.uneven) look_.uneven->apply(rest.points, rest.normals, rest.weights);
  if (look_.shoes) look_.shoes->wear(rest.points, rest.weights);
  rest.points += rest.offsets;
  const RowMatrix moves = rest.weights * joint_transforms(body_.joints, truth_);  // [count, 12]
  OrientedPoints cloud;
  cloud.points.resize(count, 3);
  cloud.normals.resize(count, 3);
  cloud.parts.resize(count);
  for (int i = 0; i < count; ++i) {
    for (int r = 0; r < 3; ++r) {
      cloud.points(i, r) = moves.block<1, 3>(i, 3 * r).dot(rest.points.row(i)) + moves(i, 9 + r);
      cloud.normals(i, r) = moves.block<1, 3>(i, 3 * r).dot(rest.normals.row(i));
    }
    cloud.normals.row(i) /= std::max(cloud.normals.row(i).norm(), 1e-20f);
    rest.weights.row(i).maxCoeff(&cloud.parts[i]);
  }
  return cloud;
}

std::optional<SoftSolid> PosedSurface::hand_solid(int side, int count, float softness, uint64_t seed) {
  const float reach = kHandReach * leg_length(body_.joints);
  const auto wrist = body_.joints.row(LeftWrist + side);
  std::vector<int> near;
  for (int f = 0; f < body_.faces.rows(); ++f)
    if ((body_.vertices.row(body_.faces(f, 0)) - wrist).squaredNorm() < reach * reach) near.push_back(f);
  if (near.empty()) return std::nullopt;
  const Faces faces = body_.faces(near, Eigen::all);
  const SurfaceSampler sampler(body_.vertices, faces);
  Rng rng(seed);
  const OrientedPoints cloud = sample(sampler, faces, count, rng);
  return SoftSolid(cloud.points, cloud.normals, sampler.area() / static_cast<float>(count), softness);
}

}  // namespace understudy
