#include "retarget/training/deformation_data.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/nn/modules/deformation.hpp"
#include "retarget/nn/modules/tensor_of.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy::training {

using nn::tensor_of;

struct DeformationSampler::Surface {
  Faces faces;
  RowMatrix weights;                           // [V, 22]
  std::shared_ptr<const RowMatrix> pose_dirs;  // [3V, 189] or null
  Points canonical{0, 3};                      // [V, 3] or empty
  SurfaceSampler by_area;
  std::vector<std::vector<int>> faces_of_vertex;

  explicit Surface(const ShapedBody& body)
      : faces(body.faces),
        weights(body.weights),
        pose_dirs(body.pose_dirs),
        by_area(body.vertices, body.faces),
        faces_of_vertex(body.vertices.rows()) {
    for (int f = 0; f < faces.rows(); ++f)
      for (int k = 0; k < 3; ++k) faces_of_vertex[faces(f, k)].push_back(f);
  }
};

struct DeformationSampler::Person {
  Points vertices;
  Joints joints, seen;
  const Surface* surface = nullptr;
  bool mirror = false;
};

DeformationSampler::DeformationSampler(const TrainingData& data, const DeformationDataOptions& options,
                                       uint64_t seed)
    : data_(data), options_(options), rng_(seed) {
  US_CHECK(options.points % 2 == 0, "the points of a batch come in pairs: ", options.points, " is odd");
  const ShapedBody mean = data.body.shaped(Eigen::VectorXf());
  auto surface = std::make_shared<Surface>(mean);
  surface->canonical = mean.vertices;
  surfaces_.push_back(surface);
  for (const auto& body : data.dressed) surfaces_.push_back(std::make_shared<Surface>(body));
}

namespace {

/// Somebody between two people, half the time a little unlike anybody.
Eigen::VectorXf draw_shape(const TrainingData& data, Rng& rng) {
  Eigen::VectorXf shape = random_shape(data, rng);
  const float noise = rng.chance(0.5f) ? 0.f : rng.uniform(0, 0.4f);
  for (Eigen::Index i = 0; i < shape.size(); ++i) shape[i] += noise * rng.normal();
  return shape;
}

Mat3 small_rotation(float degrees, Rng& rng) {
  const float s = degrees * kPi / 180;
  return rotation_from_axis_angle(Vec3(s * rng.normal(), s * rng.normal(), s * rng.normal()));
}

}  // namespace

DeformationSampler::Person DeformationSampler::draw_person() {
  Person person;
  if (surfaces_.size() > 1 && rng_.chance(options_.clothed_share)) {
    const int i = rng_.below(data_.dressed.size());
    person.vertices = data_.dressed[i].vertices;
    person.joints = data_.dressed[i].joints;
    person.surface = surfaces_[1 + i].get();
    // 48 outfits are few: most are seen on other proportions.
    if (rng_.chance(0.6f)) warp(person);
  } else {
    const ShapedBody body = data_.body.shaped(draw_shape(data_, rng_));
    person.vertices = body.vertices;
    person.joints = body.joints;
    person.surface = surfaces_[0].get();
    if (rng_.chance(options_.warped_share)) warp(person);
  }
  person.mirror = rng_.chance(0.5f);
  if (person.mirror) {
    person.vertices.col(0) *= -1;
    person.joints = Joints(person.joints(kMirror, Eigen::all));
    person.joints.col(0) *= -1;
  }
  person.seen = person.joints;
  if (rng_.chance(options_.noisy_share)) {
    const float sigma = rng_.uniform(0, options_.joint_noise);
    for (Eigen::Index i = 0; i < person.seen.size(); ++i) person.seen.data()[i] += sigma * rng_.normal();
  }
  return person;
}

/// Other bone lengths, another girth, limbs a few degrees off the T-pose: each joint's part of the surface
/// goes with it.
void DeformationSampler::warp(Person& person) {
  const float girth = rng_.uniform(0.88f, 1.12f), all = rng_.uniform(0.9f, 1.1f);
  const float off = rng_.chance(0.5f) ? 0.f : rng_.uniform(0, 4);
  std::array<float, kJointCount> stretch;
  for (int j = 0; j < kJointCount; ++j)
    stretch[j] = all * (kMirror[j] < j ? stretch[kMirror[j]] / all : rng_.uniform(0.88f, 1.12f));
  Rotations turn;
  PosedSkeleton warped;
  for (int j = 0; j < kJointCount; ++j) {
    const int parent = kParents[j];
    turn[j] = small_rotation(off, rng_);
    if (parent < 0) {
      turn[j] = Mat3::Identity();
      warped.joints.row(j) = person.joints.row(j);
    } else {
      turn[j] = turn[parent] * turn[j];
      const Vec3 bone = (person.joints.row(j) - person.joints.row(parent)).transpose();
      warped.joints.row(j) = warped.joints.row(parent) + (turn[parent] * bone * stretch[j]).transpose();
    }
    warped.global[j] = girth * all * turn[j];
  }
  person.vertices = linear_blend_skinning(person.vertices, person.surface->weights, person.joints, warped);
  person.joints = warped.joints;
}

/// Mostly a captured pose; often the upper half of another one, sometimes exaggerated.
Rotations DeformationSampler::draw_pose() {
  Rotations pose = random_pose(data_, rng_).local;
  if (rng_.chance(0.3f)) {
    const Rotations& other = random_pose(data_, rng_).local;
    for (int j : {3, 6, 9, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21}) pose[j] = other[j];
  }
  if (rng_.chance(0.2f)) {
    const float factor = rng_.uniform(0.8f, 1.4f);
    for (int j = 1; j < kJointCount; ++j)
      pose[j] = rotation_from_axis_angle(factor * rotation_to_axis_angle(pose[j]));
  }
  return pose;
}

int DeformationSampler::neighbour_face(const Surface& surface, int face) {
  const auto& around = surface.faces_of_vertex[surface.faces(face, rng_.below(3))];
  return around[rng_.below(around.size())];
}

/// Fills row `row` of the batch with places on a person's own side.
void DeformationSampler::place(const Person& person, int row, DeformationBatch& batch) {
  const Surface& s = *person.surface;
  const int count = options_.points;
  const float edge = person.seen.col(0).mean() - static_cast<float>(nn::kMirrorBand);
  Points points(count, 3), canonical = Points::Zero(count, 3);
  RowMatrix weights(count, kJointCount), basis = RowMatrix::Zero(count, 3 * nn::kPoseFeatureCount);
  int face = 0;
  for (int i = 0; i < count;) {
    Vec3 b(rng_.uniform(1e-3f, 1), rng_.uniform(1e-3f, 1), rng_.uniform(1e-3f, 1));
    b /= b.sum();
    // Half by area; half by triangle, which is denser where the shape is richer; the second of a pair near
    // the first.
    if (i % 2 == 1) {
      face = neighbour_face(s, face);
    } else if (rng_.chance(0.5f)) {
      const auto sample = s.by_area.sample(rng_);
      face = sample.face;
      b = sample.barycentric;
    } else {
      face = rng_.below(s.faces.rows());
    }
    points.row(i).setZero();
    weights.row(i).setZero();
    basis.row(i).setZero();
    for (int k = 0; k < 3; ++k) points.row(i) += b[k] * person.vertices.row(s.faces(face, k));
    if (points(i, 0) < edge && i % 2 == 0) continue;
    canonical.row(i).setZero();
    for (int k = 0; k < 3; ++k) {
      const int v = s.faces(face, k);
      weights.row(i) += b[k] * s.weights.row(v);
      if (s.canonical.rows() > 0) canonical.row(i) += b[k] * s.canonical.row(v);
      if (s.pose_dirs)
        for (int c = 0; c < 3; ++c)
          basis.row(i).segment(c * nn::kPoseFeatureCount, nn::kPoseFeatureCount) +=
              b[k] * s.pose_dirs->row(3 * v + c);
    }
    ++i;
  }
  batch.points[row].copy_(tensor_of(points));
  batch.surface[row].copy_(tensor_of(surface_of(person)));
  const auto side = [&](const torch::Tensor& x, auto mirrored) { return person.mirror ? mirrored(x) : x; };
  batch.weights[row].copy_(side(tensor_of(weights), nn::mirror_weights));
  batch.basis[row].copy_(side(tensor_of(basis), nn::mirror_basis));
  if (person.mirror) canonical.col(0) *= -1;
  batch.canonical[row].copy_(tensor_of(canonical));
  batch.has_canonical[row] = s.canonical.rows() > 0 ? 1.f : 0.f;
}

/// Points spread over a person, [context_points, 3].
Points DeformationSampler::surface_of(const Person& person) {
  const Surface& s = *person.surface;
  Points around(3 * options_.context_points, 3);
  for (int i = 0; i < around.rows(); ++i) {
    const auto sample = s.by_area.sample(rng_);
    around.row(i).setZero();
    for (int k = 0; k < 3; ++k)
      around.row(i) += sample.barycentric[k] * person.vertices.row(s.faces(sample.face, k));
  }
  return around(farthest_points(around, options_.context_points), Eigen::all);
}

DeformationBatch DeformationSampler::next() {
  const torch::NoGradGuard no_grad;
  const int64_t B = options_.bodies, N = options_.points, P = options_.poses;
  DeformationBatch batch{torch::empty({B, N, 3}),
                         torch::empty({B, kJointCount, 3}),
                         torch::empty({B, options_.context_points, 3}),
                         torch::empty({B, N, kJointCount}),
                         torch::empty({B, N, 3 * nn::kPoseFeatureCount}),
                         torch::empty({B, N, 3}),
                         torch::empty({B}),
                         torch::empty({B, P, nn::kPoseFeatureCount}),
                         torch::empty({B, P, kJointCount, 12})};
  for (int64_t i = 0; i < B; ++i) {
    Person person = draw_person();
    batch.seen_joints[i].copy_(tensor_of(person.seen));
    place(person, i, batch);
    for (int64_t k = 0; k < P; ++k) {
      Pose pose;
      pose.local = draw_pose();
      batch.features[i][k].copy_(tensor_of(pose_features(pose.local)).flatten());
      batch.transforms[i][k].copy_(
          tensor_of(joint_transforms(person.joints, forward_kinematics(person.joints, pose))));
    }
  }
  return batch;
}

}  // namespace understudy::training
