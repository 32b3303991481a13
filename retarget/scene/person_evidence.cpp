#include "retarget/scene/person_evidence.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/math/segment.hpp"
#include "retarget/pipeline/observer.hpp"

namespace understudy {
namespace {

constexpr Eigen::Index kLooked = 600;  // points whose distance is measured

float covered_share(const Points& points, const Joints& joints) {
  const float reach = body_reach(joints);
  const Eigen::Index step = std::max<Eigen::Index>(1, points.rows() / kLooked);
  int near = 0, all = 0;
  for (Eigen::Index i = 0; i < points.rows(); i += step) {
    if (!points.row(i).allFinite()) continue;
    ++all;
    if (bone_distance(points.row(i).transpose(), joints) <= reach) ++near;
  }
  return all > 0 ? static_cast<float>(near) / static_cast<float>(all) : 0.0f;
}

}  // namespace

float bone_distance(const Vec3& point, const Joints& joints) {
  float nearest = 1e9f;
  for (int j = 1; j < kJointCount; ++j) {
    const Vec3 from = joints.row(kParents[j]).transpose(), to = joints.row(j).transpose();
    nearest = std::min(nearest, from_segment(point, from, to).squaredNorm());
  }
  return std::sqrt(nearest);
}

float body_reach(const Joints& joints) {
  return std::clamp(0.22f * leg_length(joints), 0.08f, 0.22f);
}

PersonEvidence look_for_person(SkeletonExtractor& extractor, const Mesh& scan) {
  PersonEvidence evidence;
  evidence.seen.confidence.setZero();
  try {
    evidence.seen = extractor.extract(scan);
  } catch (const Error&) {  // too few points
    return evidence;
  }
  if (!evidence.seen.joints.allFinite() || !evidence.seen.confidence.allFinite()) return evidence;
  evidence.covered = covered_share(scan.vertices, evidence.seen.joints);
  const float sure = evidence.seen.confidence.mean(), like = is_implausible(evidence.seen) ? 0.6f : 1.0f;
  const float held = std::clamp((evidence.covered - 0.6f) / 0.35f, 0.0f, 1.0f);
  evidence.quality = sure * like * held;
  return evidence;
}

}  // namespace understudy
