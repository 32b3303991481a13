#include "retarget/body/builtin_person.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "retarget/body/builtin_shape.hpp"
#include "retarget/math/smooth_step.hpp"

namespace understudy {
namespace {

/// How much a point belongs to each part, summing to 1: nearer the part's own solid counts more. Measured
/// through the solids, so an arm beside the trunk or a leg beside the other does not take the other's skin.
Eigen::Array4f part_shares(const PersonShape& shape, const Vec3& p) {
  constexpr float kSoftness = 0.009f;
  Eigen::Array4f d;
  for (int part = 0; part < kPartCount; ++part) d[part] = shape.part_value(static_cast<Part>(part), p);
  const Eigen::Array4f share = (-(d - d.minCoeff()) / kSoftness).exp();
  return share / share.sum();
}

/// Weights of one point of the left half. Along each part the bones take turns at the joints.
Eigen::RowVectorXf initial_weights(const PersonShape& shape, const Vec3& p) {
  const Joints& j = shape.joints();
  const Eigen::Array4f share = part_shares(shape, p);
  Eigen::RowVectorXf w = Eigen::RowVectorXf::Zero(kJointCount);
  // Hands each share on from bone to bone: `bones` in order, `turns` in 0..1 how far each has handed over.
  const auto chain = [&w](float total, const std::vector<int>& bones, const std::vector<float>& turns) {
    for (size_t i = 0; i < bones.size(); ++i) {
      const float on = i < turns.size() ? turns[i] : 0;
      w[bones[i]] += total * (1 - on);
      total *= on;
    }
  };
  const auto above = [&](Joint joint, float half) {
    return smooth_step(j(joint, 1) - half, j(joint, 1) + half, p.y());
  };
  const auto below = [&](Joint joint, float half) { return 1 - above(joint, half); };
  const auto outside = [&](Joint joint, float half) {
    return smooth_step(j(joint, 0) - half, j(joint, 0) + half, p.x());
  };

  const float groin = p.y() - j(LeftHip, 1) + 0.45f * (j(LeftHip, 0) - std::min(p.x(), 1.6f * j(LeftHip, 0)));
  const float to_hip = smooth_step(0.055f, -0.065f, groin);  // the groin slants up and out
  const float to_shoulder = smooth_step(j(LeftShoulder, 0) - 0.055f, j(LeftShoulder, 0) + 0.035f, p.x());
  const float to_collar = smooth_step(0.02f, 0.10f, p.x()) *
                          smooth_step(j(LeftShoulder, 1) - 0.11f, j(LeftShoulder, 1) - 0.01f, p.y());
  const float toes = smooth_step(j(LeftFoot, 2) - 0.03f, j(LeftFoot, 2) + 0.03f, p.z());

  chain(share[0] * to_collar, {LeftCollar, LeftShoulder}, {to_shoulder});
  const float trunk = share[0] * (1 - to_collar);
  const float seat = to_hip * smooth_step(0.01f, 0.06f, p.x());
  w[LeftHip] += trunk * seat;
  chain(trunk * (1 - seat), {Pelvis, Spine1, Spine2, Spine3, Neck},
        {above(Spine1, .05f), above(Spine2, .04f), above(Spine3, .05f), above(Neck, .04f)});
  chain(share[1], {Pelvis, LeftHip, LeftKnee, LeftAnkle, LeftFoot},
        {to_hip, below(LeftKnee, .055f), below(LeftAnkle, .035f), toes});
  chain(share[2], {LeftCollar, LeftShoulder, LeftElbow, LeftWrist},
        {to_shoulder, outside(LeftElbow, .045f), outside(LeftWrist, .025f)});
  // The skull turns about a hinge behind the jaw: the neck's skin ends lower at the back than under the chin.
  const float hinge = p.y() - j(Head, 1) + 0.5f * (p.z() - j(Head, 2));
  chain(share[3], {Spine3, Neck, Head}, {above(Neck, .045f), smooth_step(-.045f, .03f, hinge + .015f)});
  return w;
}

/// Averages weights over neighbours, in place on all vertices at once.
void smooth_weights(RowMatrix& weights, const Faces& faces, int rounds) {
  std::set<std::pair<int, int>> edges;
  for (int f = 0; f < faces.rows(); ++f)
    for (int c = 0; c < 3; ++c) edges.insert(std::minmax(faces(f, c), faces(f, (c + 1) % 3)));
  Eigen::VectorXf degree = Eigen::VectorXf::Zero(weights.rows());
  for (const auto& [a, b] : edges) degree[a] += 1, degree[b] += 1;
  for (int round = 0; round < rounds; ++round) {
    RowMatrix sum = RowMatrix::Zero(weights.rows(), weights.cols());
    for (const auto& [a, b] : edges) {
      sum.row(a) += weights.row(b);
      sum.row(b) += weights.row(a);
    }
    for (int v = 0; v < weights.rows(); ++v)
      weights.row(v) = 0.5f * weights.row(v) + 0.5f * sum.row(v) / degree[v];
  }
}

/// A vertex of the right half has its mirror image's weights; one in the mirror plane the mean of both sides.
RowMatrix skin_weights(const PersonShape& shape, const Points& vertices, const Faces& faces) {
  RowMatrix weights(vertices.rows(), kJointCount);
  for (int v = 0; v < vertices.rows(); ++v) {
    const float x = vertices(v, 0);
    const Eigen::RowVectorXf left = initial_weights(shape, Vec3(std::abs(x), vertices(v, 1), vertices(v, 2)));
    for (int j = 0; j < kJointCount; ++j) {
      const float mirror = left[kMirror[j]];
      weights(v, j) = x > 0 ? left[j] : x < 0 ? mirror : 0.5f * (left[j] + mirror);
    }
  }
  smooth_weights(weights, faces, 6);
  weights = (weights.array() < 2e-3f).select(0.0f, weights);
  const Eigen::VectorXf sums = weights.rowwise().sum();
  for (int v = 0; v < weights.rows(); ++v) weights.row(v) /= sums[v];
  return weights;
}

}  // namespace

ShapedBody builtin_person(const PersonOptions& options) {
  const PersonShape shape(options);
  Mesh mesh = polygonise(shape.solid());
  ShapedBody body;
  body.weights = skin_weights(shape, mesh.vertices, mesh.faces);
  body.vertices = mesh.vertices * shape.scale();
  body.faces = std::move(mesh.faces);
  body.joints = shape.joints() * shape.scale();
  return body;
}

Joints builtin_joints(const PersonOptions& options) {
  const PersonShape shape(options);
  return shape.joints() * shape.scale();
}

Eigen::VectorXf builtin_distances(const PersonOptions& options, const Points& points) {
  const PersonShape shape(options);
  const float scale = shape.scale();
  Eigen::VectorXf distances(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    distances[i] = scale * shape.value(Vec3(std::abs(points(i, 0)), points(i, 1), points(i, 2)) / scale);
  return distances;
}

}  // namespace understudy
