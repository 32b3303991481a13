#include "retarget/creature/flesh.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/rng.hpp"
#include "retarget/creature/puppet.hpp"
#include "retarget/math/directions.hpp"
#include "retarget/math/segment.hpp"
#include "retarget/math/smooth_step.hpp"

namespace understudy {
namespace {

constexpr float kBreath = 0.007f, kWobble = 0.004f;  // share of the body's size
constexpr float kThin = 0.02f, kThick = 0.09f;       // flesh so thin does not wobble, so thick fully

/// How far each point is from the bones, [V].
Eigen::VectorXf depths(const Rig& rig) {
  const Points& points = rig.surface.vertices;
  Eigen::VectorXf depth(points.rows());
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Vec3 p = points.row(v).transpose();
    float nearest = 1e9f;
    for (const RigJoint& joint : rig.joints) {
      const Vec3& from = joint.parent < 0 ? joint.rest : rig.joints[static_cast<size_t>(joint.parent)].rest;
      nearest = std::min(nearest, from_segment(p, from, joint.rest).norm());
    }
    depth[v] = nearest;
  }
  return depth;
}

}  // namespace

Flesh::Flesh(const Rig& rig, const std::vector<std::string>& breathing, uint64_t seed)
    : rest_(rig.surface.vertices) {
  Rng rng(seed ^ 0x6272656174686573ull);
  const float size = size_of(rig);
  const RowMatrix weights = rig.skin.dense(rig.count());
  Eigen::VectorXf breathes = Eigen::VectorXf::Zero(rest_.rows());
  const Puppet puppet(rig);
  for (const std::string& name : breathing) breathes += weights.col(puppet.joint(name));
  breath_ = vertex_normals(rest_, rig.surface.faces);
  for (Eigen::Index v = 0; v < rest_.rows(); ++v) breath_.row(v) *= kBreath * size * breathes[v];
  softness_ = depths(rig).unaryExpr([size](float d) { return smooth_step(kThin, kThick, d / size); });
  breaths_ = rng.uniform(0.3f, 0.6f);
  begin_ = rng.uniform(0, 2 * kPi);
  for (int i = 0; i < 3; ++i) {
    Ripple ripple;
    ripple.way = random_direction(rng) * (kWobble * size * rng.uniform(0.4f, 0.7f));
    ripple.across = random_direction(rng) * (rng.uniform(4, 12) / size);
    ripple.pace = 2 * kPi * rng.uniform(0.6f, 2.0f);
    ripple.phase = rng.uniform(0, 2 * kPi);
    ripples_.push_back(ripple);
  }
}

Points Flesh::at(float seconds) const {
  Points points = rest_ + (0.5f + 0.5f * std::sin(2 * kPi * breaths_ * seconds + begin_)) * breath_;
  for (Eigen::Index v = 0; v < points.rows(); ++v)
    for (const Ripple& ripple : ripples_) {
      const float phase = rest_.row(v).dot(ripple.across.transpose()) + ripple.pace * seconds + ripple.phase;
      points.row(v) += softness_[v] * std::sin(phase) * ripple.way.transpose();
    }
  return points;
}

}  // namespace understudy
