#include "tests/retarget/motion_space/known_walk.hpp"

#include <limits>

#include "retarget/base/index.hpp"
#include "retarget/body/builtin_motion.hpp"
#include "retarget/body/builtin_person.hpp"

namespace understudy::tests {

KnownWalk::KnownWalk(const std::string& name) : rest(builtin_joints()), motion(builtin_motion(name, rest)) {}

KnownMotion KnownWalk::question(int start, int count, int first, int last) const {
  KnownMotion question{{motion.fps, {}, {}}, std::vector<KnownParts>(count, all_parts(true)), rest};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int t = 0; t < count; ++t) {
    Pose& pose = question.motion.poses.emplace_back(motion.poses[start + t]);
    if (t < first || t > last) continue;
    question.known[t] = all_parts(false);
    pose.root.setConstant(nan);
    for (Mat3& R : pose.local) R.setConstant(nan);
  }
  return question;
}

double KnownWalk::error(const Motion& answer, int start, int t) const {
  const Joints p = forward_kinematics(rest, answer.poses[t]).joints;
  const Joints q = forward_kinematics(rest, motion.poses[start + t]).joints;
  return static_cast<double>((p - q).rowwise().norm().mean());
}

Motion turned(Motion motion, const Mat3& turn, const Vec3& way) {
  for (Pose& pose : motion.poses) {
    pose.local[Pelvis] = turn * pose.local[Pelvis];
    pose.root = turn * pose.root + way;
  }
  return motion;
}
KnownMotion turned(KnownMotion question, const Mat3& turn, const Vec3& way) {
  question.motion = turned(std::move(question.motion), turn, way);
  return question;
}

Motion mirrored(Motion motion) {
  for (Pose& pose : motion.poses) pose = understudy::mirrored(pose);
  return motion;
}
KnownMotion mirrored(KnownMotion question) {
  question.motion = mirrored(std::move(question.motion));
  for (KnownParts& known : question.known) {
    const KnownParts before = known;
    for (int j = 0; j < kJointCount; ++j) known[j] = before[kMirror[j]];
  }
  return question;
}

float farthest(const Joints& rest, const Motion& a, const Motion& b) {
  float most = 0;
  for (size_t t = 0; t < a.poses.size(); ++t)
    most = std::max(
        most, (forward_kinematics(rest, a.poses[t]).joints - forward_kinematics(rest, b.poses[t]).joints)
                  .rowwise()
                  .norm()
                  .maxCoeff());
  return most;
}

bool same_part(const Pose& a, const Pose& b, int part) {
  return part == kRootPart ? a.root == b.root : a.local[part] == b.local[part];
}

}  // namespace understudy::tests
