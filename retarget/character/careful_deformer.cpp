#include "retarget/character/careful_deformer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/log.hpp"
#include "retarget/base/text.hpp"
#include "retarget/character/geometric_binding.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/skeleton/skinning.hpp"

namespace understudy {
namespace {

// Where a bone is this many times as far as the nearest one, a weight on it is doubted, and not believed.
constexpr float kImplausible = 2.2f, kAbsurd = 3.6f;

/// [V]: the share of each vertex' weights that lies on bones far away.
Eigen::VectorXf strayed_share(const BoneDistances& distances, const RowMatrix& weights) {
  Eigen::VectorXf out(weights.rows());
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    const float near = distances.metres.row(v).minCoeff() + 0.06f * distances.leg;
    float strayed = 0;
    for (Eigen::Index j = 0; j < kJointCount; ++j)
      if (weights(v, j) > 0)
        strayed += weights(v, j) * smooth_step(kImplausible, kAbsurd, distances.metres(v, j) / near);
    out[v] = strayed;
  }
  return out;
}

struct Region {
  const char* name;
  std::vector<int> joints;
};

const std::vector<Region>& regions() {
  static const std::vector<Region> all = {
      {"head", {Head, Neck}},
      {"trunk", {Pelvis, Spine1, Spine2, Spine3, LeftCollar, RightCollar}},
      {"left arm", {LeftShoulder, LeftElbow}},
      {"right arm", {RightShoulder, RightElbow}},
      {"left hand", {LeftWrist}},
      {"right hand", {RightWrist}},
      {"left leg", {LeftHip, LeftKnee}},
      {"right leg", {RightHip, RightKnee}},
      {"left foot", {LeftAnkle, LeftFoot}},
      {"right foot", {RightAnkle, RightFoot}}};
  return all;
}

/// "12 % of the surface is bound by its shape alone: head, left hand".
std::string note_on(const Eigen::VectorXf& uncertainty, const RowMatrix& weights) {
  const float whole = uncertainty.mean();
  if (whole < 0.002f) return "";
  std::string where;
  for (const Region& region : regions()) {
    Eigen::VectorXf share = Eigen::VectorXf::Zero(uncertainty.size());
    for (const int j : region.joints) share += weights.col(j);
    if (share.sum() > 0 && share.dot(uncertainty) / share.sum() > 0.1f) append_item(where, region.name);
  }
  return std::to_string(std::max(1l, std::lround(100 * whole))) +
         " % of the surface is bound by its shape alone" + (where.empty() ? "" : ": " + where);
}

}  // namespace

SafeBinding safe_binding(const Mesh& mesh, const Joints& joints, const RowMatrix& weights) {
  const BoneDistances distances = bone_distances(VoxelBody(mesh), joints, mesh.vertices);
  const ShapeHints hints = shape_hints(mesh, joints);
  SafeBinding out;
  RowMatrix uncertainty = strayed_share(distances, weights);
  for (Eigen::Index v = 0; v < uncertainty.rows(); ++v)
    uncertainty(v, 0) = smooth_step(0.08f, 0.35f, uncertainty(v, 0));
  if (uncertainty.maxCoeff() > 0) smooth_along(mesh, 0.05f * distances.leg, uncertainty);
  uncertainty = (uncertainty.array() < 0.01f).select(0.0f, uncertainty);
  out.uncertainty = uncertainty.col(0);
  if (hints.skirt) out.uncertainty = out.uncertainty.cwiseMax(hints.skirt->share);
  out.uncertainty = out.uncertainty.cwiseMax(hints.head);
  out.weights = weights;
  if (out.uncertainty.maxCoeff() > 0) {
    const RowMatrix own = geometric_weights(mesh, distances, hints);
    for (Eigen::Index v = 0; v < weights.rows(); ++v)
      out.weights.row(v) += out.uncertainty[v] * (own.row(v) - out.weights.row(v));
  }
  out.note = note_on(out.uncertainty, out.weights);
  out.hard = out.uncertainty;
  const std::vector<bool> rigid = keep_parts_rigid(mesh, distances.leg, out.weights);
  const auto kept = static_cast<double>(std::count(rigid.begin(), rigid.end(), true));
  for (size_t v = 0; v < rigid.size(); ++v)
    if (rigid[v]) out.hard[v] = 1;
  const long percent = std::max(1l, std::lround(100.0 * kept / static_cast<double>(rigid.size())));
  if (kept > 0) append_item(out.note, std::to_string(percent) + " % of it are rigid parts", "; ");
  if (hints.skirt) append_item(out.note, "its skirt follows pelvis and thighs", "; ");
  return out;
}

CarefulDeformer::CarefulDeformer(Faces faces, std::shared_ptr<Deformer> inner)
    : faces_(std::move(faces)), inner_(std::move(inner)) {
  US_CHECK(inner_, "a careful deformer needs an inner one");
}

void CarefulDeformer::bind(const Points& rest, const Joints& rest_joints) {
  inner_->bind(rest, rest_joints);
  rest_ = rest;
  joints_ = rest_joints;
  Mesh mesh{rest, faces_, {}};
  if (faces_.rows() > 0 && faces_.maxCoeff() >= rest.rows()) mesh.faces.resize(0, 3);
  binding_ = safe_binding(mesh, rest_joints, inner_->weights());
  if (!binding_.note.empty()) log::info(binding_.note);
  if (!(binding_.weights.array() == inner_->weights().array()).all())
    inner_ = inner_->with_weights(std::move(binding_.weights));
  binding_.weights.resize(0, kJointCount);  // they are inner_'s
}

std::shared_ptr<Deformer> CarefulDeformer::with_weights(RowMatrix weights) const {
  auto other = std::make_shared<CarefulDeformer>(*this);
  other->inner_ = inner_->with_weights(std::move(weights));
  return other;
}

Points CarefulDeformer::offsets(const Pose& pose) const {
  Points offsets = inner_->offsets(pose);
  if (binding_.hard.size() == offsets.rows()) offsets.array().colwise() *= 1 - binding_.hard.array();
  return offsets;
}

Points CarefulDeformer::deform(const Pose& pose) const {
  if (binding_.hard.size() == 0 || binding_.hard.maxCoeff() == 0) return inner_->deform(pose);
  return linear_blend_skinning(rest_ + offsets(pose), inner_->weights(), joints_,
                               forward_kinematics(joints_, pose));
}

}  // namespace understudy
