#include "retarget/pipeline/target.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {

namespace {

Joints mirror_image(const Joints& joints, float middle) {
  Joints result;
  for (int j = 0; j < kJointCount; ++j) {
    result.row(j) = joints.row(kMirror[j]);
    result(j, 0) = 2 * middle - result(j, 0);
  }
  return result;
}

/// The plane x = middle that the points are most symmetric about, and how far off, metres (mean distance).
struct Symmetry {
  float middle, error;
};

Symmetry symmetry(const Points& points) {
  const float middle = 0.5f * (points.col(0).minCoeff() + points.col(0).maxCoeff());
  Points flipped = points;
  flipped.col(0) = 2 * middle - points.col(0).array();
  const auto nearest = nearest_neighbours(points, flipped, 1);
  float sum = 0;
  for (Eigen::Index i = 0; i < flipped.rows(); ++i)
    sum += (flipped.row(i) - points.row(nearest(i, 0))).norm();
  return {middle, sum / static_cast<float>(flipped.rows())};
}

std::vector<std::string> warnings_about(const Mesh& mesh, const Joints& joints) {
  std::vector<std::string> result;
  const Vec3 size = (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).transpose();
  const Joints& human = human_rest();
  const auto off_deg = [&](int from, int to) {
    const Vec3 a = (joints.row(to) - joints.row(from)).transpose(),
               b = (human.row(to) - human.row(from)).transpose();
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kPi;
  };
  if (size.y() < 0.5f || size.y() > 3.0f)
    result.push_back("the target is " + short_number(static_cast<double>(size.y())) +
                     " m tall, which no person is");
  if (std::max(off_deg(LeftShoulder, LeftElbow), off_deg(RightShoulder, RightElbow)) > 35)
    result.push_back("the target's arms are not stretched out sideways: it is not in T-pose");
  if (std::max(off_deg(LeftHip, LeftKnee), off_deg(RightHip, RightKnee)) > 35 || off_deg(Spine3, Neck) > 35)
    result.push_back("the target does not stand upright: it may not be a person in T-pose");
  if (joints(LeftHip, 0) < joints(RightHip, 0) || off_deg(LeftAnkle, LeftFoot) > 75)
    result.push_back("the target does not seem to face +z");
  if (size.x() < 0.6f * size.y()) result.push_back("the target is too narrow for a person in T-pose");
  return result;
}

Mesh finite_part(const Mesh& mesh) {
  if (mesh.vertices.allFinite() && !mesh.is_cloud()) return mesh;
  return Mesh{finite_points(mesh.vertices)};
}

/// One look at the target: a sample of it turned and perhaps mirrored, the joints brought back.
Joints look(const Mesh& part, SkeletonExtractor& extractor, Rng& rng, int round) {
  constexpr int kPoints = 8000;
  const Vec3 centre =
      0.5f * (part.vertices.colwise().maxCoeff() + part.vertices.colwise().minCoeff()).transpose();
  const bool flip = round % 2 == 1;
  const Mat3 turn = rotation_about_y(rng.uniform(-0.25f, 0.25f));
  Mesh sample;
  sample.vertices = sample_points(part, kPoints, rng);
  sample.vertices.rowwise() -= centre.transpose();
  if (flip) sample.vertices.col(0) *= -1;
  sample.vertices = (sample.vertices * turn.transpose()).eval();
  Joints joints = extractor.extract(sample).joints * turn;
  if (flip) joints = mirror_image(joints, 0);
  return joints.rowwise() + centre.transpose();
}

}  // namespace

Target prepare_target(const Mesh& mesh, SkeletonExtractor& extractor) {
  const Mesh part = finite_part(mesh);
  US_CHECK(part.vertices.rows() >= 32, "the target has ", part.vertices.rows(),
           " usable points; at least 32 are needed");
  constexpr int kRounds = 12;
  Rng rng(20231);
  std::vector<Joints> looks;
  looks.reserve(kRounds);
  for (int round = 0; round < kRounds; ++round) looks.push_back(look(part, extractor, rng, round));

  Joints joints;  // the mean of the middle half: one bad look does not count
  for (Eigen::Index i = 0; i < joints.size(); ++i) {
    std::array<float, kRounds> values;
    for (int round = 0; round < kRounds; ++round) values[round] = looks[round].data()[i];
    std::sort(values.begin(), values.end());
    constexpr int kLeftOut = kRounds / 4;  // at each end
    float sum = 0;
    for (int k = kLeftOut; k < kRounds - kLeftOut; ++k) sum += values[k];
    joints.data()[i] = sum / (kRounds - 2 * kLeftOut);
  }
  Rng again(20232);
  const Symmetry s = symmetry(sample_points(part, 2000, again));
  const float tall = part.vertices.col(1).maxCoeff() - part.vertices.col(1).minCoeff();
  if (s.error < 0.02f * tall) joints = 0.5f * (joints + mirror_image(joints, s.middle));
  return prepare_target(mesh, joints);
}

Target prepare_target(const Mesh& mesh, const Joints& joints) {
  Target target{mesh, joints, {}};
  target.warnings = warnings_about(finite_part(mesh), joints);
  return target;
}

}  // namespace understudy
