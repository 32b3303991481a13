#include "retarget/motion_space/person_model.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/body/builtin_person.hpp"

namespace understudy {
namespace {

constexpr int kLookedAt = 1400;  // vertices that fitting looks at

enum Stretch {
  OfSize,
  OfTrunk,
  OfHips,
  OfShoulders,
  OfThigh,
  OfShin,
  OfFoot,
  OfUpperArm,
  OfForearm,
  OfHead,
  kStretches
};
// About how much people differ: of lengths their logarithms, the size of children and adults. Chosen wide.
constexpr std::array<float, kStretches> kSpread = {0.15f, 0.06f, 0.10f, 0.08f, 0.05f,
                                                   0.05f, 0.08f, 0.06f, 0.06f, 0.08f};
constexpr float kGirthStep = 0.3f;  // of the sample that the direction of girth is made from

/// Which stretch moves a joint away from its parent.
constexpr std::array<int, kJointCount> kOfJoint = {
    OfSize,      OfHips,      OfHips,     OfTrunk,    OfThigh,   OfThigh,     OfTrunk,     OfShin,
    OfShin,      OfTrunk,     OfFoot,     OfFoot,     OfTrunk,   OfShoulders, OfShoulders, OfHead,
    OfShoulders, OfShoulders, OfUpperArm, OfUpperArm, OfForearm, OfForearm};

/// How a stretch acts on what a bone carries: a projection, so that parts grow along one axis or all.
Mat3 stretched_by(int stretch, int bone, const Joints& joints) {
  const auto along = [&](int child) {
    const Vec3 axis = (joints.row(child) - joints.row(bone)).normalized();
    return Mat3(axis * axis.transpose());
  };
  const Mat3 none = Mat3::Zero(), wide = Vec3::UnitX() * Vec3::UnitX().transpose(),
             high = Vec3::UnitY() * Vec3::UnitY().transpose();
  if (stretch == OfSize) return Mat3::Identity();
  switch (bone) {
    case Pelvis:
      return stretch == OfHips ? wide : stretch == OfTrunk ? high : none;
    case Spine1:
      return stretch == OfHips        ? Mat3(0.6f * wide)
             : stretch == OfShoulders ? Mat3(0.4f * wide)
             : stretch == OfTrunk     ? high
                                      : none;
    case Spine2:
      return stretch == OfHips        ? Mat3(0.3f * wide)
             : stretch == OfShoulders ? Mat3(0.7f * wide)
             : stretch == OfTrunk     ? high
                                      : none;
    case Spine3:
      return stretch == OfShoulders ? wide : stretch == OfTrunk ? high : none;
    case Neck:
      return stretch == OfTrunk ? high : none;
    case Head:
      return stretch == OfHead ? Mat3(Mat3::Identity()) : none;
    case LeftCollar:
    case RightCollar:
      return stretch == OfShoulders ? along(bone == LeftCollar ? LeftShoulder : RightShoulder) : none;
    case LeftShoulder:
    case RightShoulder:
      return stretch == OfUpperArm ? along(bone + 2) : none;
    case LeftElbow:
    case RightElbow:
      return stretch == OfForearm ? along(bone + 2) : none;
    case LeftWrist:
    case RightWrist:
      return stretch == OfForearm ? Mat3(Mat3::Identity()) : none;
    case LeftHip:
    case RightHip:
      return stretch == OfThigh ? along(bone + 3) : none;
    case LeftKnee:
    case RightKnee:
      return stretch == OfShin ? along(bone + 3) : none;
    default:
      return stretch == OfFoot ? Mat3(Mat3::Identity()) : none;  // ankles and balls
  }
}

Joints stretch_joints(int stretch, const Joints& joints) {
  if (stretch == OfSize) return joints;
  Joints moved = Joints::Zero();
  for (int j = 1; j < kJointCount; ++j) {
    const int p = kParents[j];
    moved.row(j) = moved.row(p);
    if (kOfJoint[j] == stretch) moved.row(j) += joints.row(j) - joints.row(p);
  }
  return moved;
}

Points stretch_vertices(int stretch, const ShapedBody& body, const Joints& moved) {
  std::array<Mat3, kJointCount> by;
  for (int b = 0; b < kJointCount; ++b) by[b] = stretched_by(stretch, b, body.joints);
  Points dirs = Points::Zero(body.vertices.rows(), 3);
  for (Eigen::Index v = 0; v < dirs.rows(); ++v)
    for (int b = 0; b < kJointCount; ++b) {
      const float w = body.weights(v, b);
      if (w <= 0) continue;
      const Vec3 arm = (body.vertices.row(v) - body.joints.row(b)).transpose();
      dirs.row(v) += w * (moved.row(b) + (by[b] * arm).transpose());
    }
  return dirs;
}

/// How much further out the skin of a heavier person lies, for each unit of girth.
Points thickening(const ShapedBody& body, const Points& normals, PersonOptions heavy) {
  heavy.girth += kGirthStep;
  return normals.array().colwise() * (builtin_distances(heavy, body.vertices).array() / -kGirthStep);
}

std::vector<PersonModel::Skin> skin_of(const RowMatrix& weights) {
  std::vector<PersonModel::Skin> skin(static_cast<size_t>(weights.rows()));
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    Eigen::RowVectorXf left = weights.row(v);
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      Eigen::Index most;
      const float w = left.maxCoeff(&most);
      skin[v].bone[k] = static_cast<int>(most), skin[v].weight[k] = w;
      left[most] = 0, sum += w;
    }
    for (float& w : skin[v].weight) w /= sum;
  }
  return skin;
}

/// Vertices far apart on the left half and in the middle, and their mirror images.
std::vector<int> vertices_far_apart(const Points& vertices) {
  std::vector<int> left, kept;
  for (int v = 0; v < vertices.rows(); ++v)
    if (vertices(v, 0) >= 0) left.push_back(v);
  const IntMatrix other = nearest_neighbours(
      vertices, (vertices.array().rowwise() * Eigen::RowVector3f(-1, 1, 1).array()).matrix(), 1);
  for (const int v : far_apart(vertices, left, kLookedAt / 2)) {
    kept.push_back(v);
    if (other(v, 0) != v) kept.push_back(other(v, 0));
  }
  return kept;
}

std::shared_ptr<const PersonModel> make_model() {
  PersonOptions mean;
  mean.sex = 0.5f;
  auto model = std::make_shared<PersonModel>();
  model->whole = builtin_person(mean);
  const ShapedBody& body = model->whole;
  const Points normals = vertex_normals(body.vertices, body.faces);
  for (int s = 0; s < kStretches; ++s) {
    model->joint_dirs.push_back(stretch_joints(s, body.joints));
    model->whole_dirs.push_back(stretch_vertices(s, body, model->joint_dirs.back()));
    model->spread.push_back(kSpread[s]);
  }
  model->joint_dirs.push_back(Joints::Zero());
  model->whole_dirs.push_back(thickening(body, normals, mean));
  model->spread.push_back(0.3f);

  const std::vector<int> kept = vertices_far_apart(body.vertices);
  model->vertices = body.vertices(kept, Eigen::all);
  model->normals = normals(kept, Eigen::all);
  model->skin = skin_of(body.weights(kept, Eigen::all));
  for (const Points& dirs : model->whole_dirs) model->vertex_dirs.push_back(dirs(kept, Eigen::all));
  const Points image = (model->vertices.array().rowwise() * Eigen::RowVector3f(-1, 1, 1).array()).matrix();
  const IntMatrix other = nearest_neighbours(model->vertices, image, 1),
                  beside = nearest_neighbours(model->vertices, model->vertices, 7);
  for (Eigen::Index v = 0; v < other.rows(); ++v) {
    model->mirror.push_back(other(v, 0));
    std::array<int, 6> near{};
    for (int k = 0; k < 6; ++k) near[k] = beside(v, k + 1);
    model->near.push_back(near);
  }
  return model;
}

}  // namespace

Joints PersonModel::joints(const Eigen::VectorXf& shape) const {
  Joints result = whole.joints;
  for (int s = 0; s < parameters(); ++s) result += shape[s] * joint_dirs[s];
  return result;
}

Points PersonModel::shaped(const Eigen::VectorXf& shape, const Eigen::VectorXf& swelling) const {
  Points result = vertices;
  for (int s = 0; s < parameters(); ++s) result += shape[s] * vertex_dirs[s];
  if (swelling.size() > 0) result.array() += normals.array().colwise() * swelling.array();
  return result;
}

ShapedBody PersonModel::body(const Eigen::VectorXf& shape, const Eigen::VectorXf& swelling) const {
  ShapedBody result = whole;
  result.joints = joints(shape);
  for (int s = 0; s < parameters(); ++s) result.vertices += shape[s] * whole_dirs[s];
  if (swelling.size() == 0) return result;
  const Points out = vertex_normals(whole.vertices, whole.faces);
  const IntMatrix nearest = nearest_neighbours(vertices, whole.vertices, 4);
  for (Eigen::Index v = 0; v < out.rows(); ++v) {
    float sum = 0, total = 0;
    for (int k = 0; k < 4; ++k) {
      const float w = 1 / (1e-6f + (whole.vertices.row(v) - vertices.row(nearest(v, k))).squaredNorm());
      sum += w * swelling[nearest(v, k)], total += w;
    }
    result.vertices.row(v) += sum / total * out.row(v);
  }
  return result;
}

std::shared_ptr<const PersonModel> builtin_person_model() {
  static const std::shared_ptr<const PersonModel> model = make_model();
  return model;
}

}  // namespace understudy
