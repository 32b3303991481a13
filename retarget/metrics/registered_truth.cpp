#include "retarget/metrics/registered_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/math/percentile.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/segment.hpp"

namespace understudy {
namespace {

constexpr size_t kFewestVertices = 25;
constexpr int kFitRounds = 4;
constexpr double kFitScale_m = 0.01;  // a vertex so far from the rigid fit counts half

/// A part that moves nearly as one rigid piece, along a bone from `bone` to a weighted sum of joints.
struct RigidPart {
  const char* name;
  int bone;                 // the joint that turns it
  std::vector<int> joints;  // beside it
  std::vector<std::pair<int, float>> end;
  float from = 0.25f, to = 0.75f;  // of the bone: only vertices between follow no other part
  float within_m = 0.13f;          // of the bone
};

const std::vector<RigidPart>& rigid_parts() {
  constexpr float kAll = 2;  // also what lies beyond the bone's end
  static const std::vector<RigidPart> parts = {
      {"pelvis",
       Pelvis,
       {LeftHip, RightHip},
       {{Pelvis, 0.5f}, {LeftHip, 0.25f}, {RightHip, 0.25f}},
       -1,
       kAll,
       0.2f},
      {"left_thigh", LeftHip, {LeftHip, LeftKnee}, {{LeftKnee, 1}}},
      {"right_thigh", RightHip, {RightHip, RightKnee}, {{RightKnee, 1}}},
      {"left_shin", LeftKnee, {LeftKnee, LeftAnkle}, {{LeftAnkle, 1}}},
      {"right_shin", RightKnee, {RightKnee, RightAnkle}, {{RightAnkle, 1}}},
      {"left_foot", LeftAnkle, {LeftAnkle}, {{LeftFoot, 1.4f}, {LeftAnkle, -0.4f}}, 0.1f, kAll},
      {"right_foot", RightAnkle, {RightAnkle}, {{RightFoot, 1.4f}, {RightAnkle, -0.4f}}, 0.1f, kAll},
      {"chest", Spine3, {Spine3}, {{Neck, 0.8f}, {Spine3, 0.2f}}, 0.1f, 0.9f, 0.2f},
      {"head", Head, {Head}, {{Head, 2.2f}, {Neck, -1.2f}}, 0.2f, kAll, 0.25f},
      {"left_upper_arm", LeftShoulder, {LeftShoulder, LeftElbow}, {{LeftElbow, 1}}},
      {"right_upper_arm", RightShoulder, {RightShoulder, RightElbow}, {{RightElbow, 1}}},
      {"left_forearm", LeftElbow, {LeftElbow, LeftWrist}, {{LeftWrist, 1}}},
      {"right_forearm", RightElbow, {RightElbow, RightWrist}, {{RightWrist, 1}}},
      {"left_hand", LeftWrist, {LeftWrist}, {{LeftWrist, 1.5f}, {LeftElbow, -0.5f}}, 0.15f, kAll},
      {"right_hand", RightWrist, {RightWrist}, {{RightWrist, 1.5f}, {RightElbow, -0.5f}}, 0.15f, kAll}};
  return parts;
}

struct RigidFit {
  Mat3 R = Mat3::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double off_mm = 0;  // median
};

Points rows_of(const Points& points, const std::vector<int>& rows) {
  Points chosen(rows.size(), 3);
  for (size_t i = 0; i < rows.size(); ++i) chosen.row(static_cast<Eigen::Index>(i)) = points.row(rows[i]);
  return chosen;
}

/// The rigid motion that takes a to b, hardly heeding what does not move with the rest.
RigidFit robust_fit(const Points& a, const Points& b) {
  RigidFit fit;
  Eigen::VectorXf weights = Eigen::VectorXf::Ones(a.rows());
  Eigen::ArrayXd off;
  for (int round = 0; round < kFitRounds; ++round) {
    weights /= weights.sum();
    const Eigen::RowVector3f from = weights.transpose() * a, to = weights.transpose() * b;
    const Points a0 = a.rowwise() - from, b0 = b.rowwise() - to;
    fit.R = kabsch(a0, b0, weights);
    fit.t = (to.transpose() - fit.R * from.transpose()).cast<double>();
    off = (a0 * fit.R.transpose() - b0).rowwise().norm().array().cast<double>();
    weights = (1 / (1 + (off / kFitScale_m).square())).cast<float>().matrix();
  }
  fit.off_mm = 1000 * percentile({off.data(), off.data() + off.size()}, 50);
  return fit;
}

/// How far each place is from the median of all, mean, millimetres.
double wander_mm(const std::vector<Joints>& places, int joint) {
  Eigen::RowVector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(places.size());
    for (const Joints& place : places) values.push_back(place(joint, axis));
    middle[axis] = percentile(std::move(values), 50);
  }
  double sum = 0;
  for (const Joints& place : places) sum += (place.row(joint).cast<double>() - middle).norm();
  return 1000 * sum / static_cast<double>(places.size());
}

template <class Figure>
double mean_over(const std::vector<PartFigures>& parts, const Figure& figure) {
  double sum = 0;
  for (const PartFigures& part : parts) sum += figure(part);
  return parts.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(parts.size());
}

}  // namespace

RegisteredTruth::RegisteredTruth() : first_global_(identity_rotations()), parts_(rigid_parts().size()) {}

void RegisteredTruth::choose_vertices(const Joints& joints) {
  std::vector<std::array<Vec3, 2>> bones;
  for (const RigidPart& part : rigid_parts()) {
    Vec3 end = Vec3::Zero();
    for (const auto& [joint, weight] : part.end) end += weight * joints.row(joint).transpose();
    bones.push_back({joints.row(part.bone).transpose(), end});
  }
  for (Eigen::Index v = 0; v < first_.rows(); ++v) {
    const Vec3 p = first_.row(v).transpose();
    const auto distance = [&](size_t i) { return from_segment(p, bones[i][0], bones[i][1]).norm(); };
    size_t own = 0;
    for (size_t i = 1; i < bones.size(); ++i)
      if (distance(i) < distance(own)) own = i;
    const RigidPart& part = rigid_parts()[own];
    const float along = along_segment(p, bones[own][0], bones[own][1]);
    if (along >= part.from && along <= part.to && distance(own) < part.within_m)
      parts_[own].vertices.push_back(static_cast<int>(v));
  }
}

void RegisteredTruth::push(const Points& vertices, const Joints& joints, const Rotations& global) {
  if (frames_++ == 0) {
    first_ = vertices;
    first_global_ = global;
    choose_vertices(joints);
  }
  US_CHECK(vertices.rows() == first_.rows(), "a frame of a registered sequence has ", vertices.rows(),
           " vertices, the first has ", first_.rows());
  for (size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    if (part.vertices.size() < kFewestVertices) continue;
    const size_t bone = rigid_parts()[i].bone;
    const RigidFit fit = robust_fit(rows_of(first_, part.vertices), rows_of(vertices, part.vertices));
    const Mat3 turned = global[bone] * first_global_[bone].transpose();
    part.angles_deg.push_back(static_cast<double>(geodesic_angle(fit.R, turned) * 180 / kPi));
    part.fits_mm.push_back(fit.off_mm);
    part.places.emplace_back((joints.rowwise() - fit.t.cast<float>().transpose()) * fit.R);
  }
}

std::vector<PartFigures> RegisteredTruth::parts() const {
  std::vector<PartFigures> all;
  if (frames_ < 2) return all;
  for (size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (part.angles_deg.empty()) continue;
    PartFigures figures;
    figures.part = rigid_parts()[i].name;
    figures.vertices = static_cast<int>(part.vertices.size());
    figures.fit_mm = percentile(part.fits_mm, 50);
    figures.rot_deg = percentile(part.angles_deg, 50);
    figures.rot_p95_deg = percentile(part.angles_deg, 95);
    figures.joints = rigid_parts()[i].joints;
    for (const int j : figures.joints) figures.const_mm.push_back(wander_mm(part.places, j));
    all.push_back(std::move(figures));
  }
  return all;
}

double mean_rot_deg(const std::vector<PartFigures>& parts) {
  return mean_over(parts, [](const PartFigures& part) { return part.rot_deg; });
}

double mean_const_mm(const std::vector<PartFigures>& parts) {
  return mean_over(parts, [](const PartFigures& part) {
    double sum = 0;
    for (const double mm : part.const_mm) sum += mm;
    return sum / static_cast<double>(part.const_mm.size());
  });
}

}  // namespace understudy
