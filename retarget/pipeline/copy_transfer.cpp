#include "retarget/pipeline/copy_transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/pipeline/human_rest.hpp"

namespace understudy {

namespace {

constexpr float kShoulderHint = 0.3f;  // weight of the shoulders in the chest's rotation; neck and collars: 1
constexpr float kSpineHint = 0.1f;  // weight of spine2 and spine3 in the pelvis' rotation; hips and spine1: 1
constexpr float kBendLow_deg = 10;  // below this bend the last hinge axis is kept: it cannot be seen
constexpr float kBendHigh_deg = 35;  // above this bend the hinge axis is believed at once
constexpr float kRelax_s = 2;        // time in which a kept hinge axis falls back to the T-pose's

/// How a joint's rotation is found. Measured with the trained extractor: limbs lie between their joints, and
/// how they are turned about themselves is better seen on the legs than solved, less so on the arms; of
/// leaves positions say nothing. The short bones of trunk and feet are pointed badly by joints a centimetre
/// off.
struct JointRule {
  int end;      // the joint at the other end of its one bone; -1 where there is none, or more than one
  float seen;   // weight, 0..1, of the seen rotation against the one solved from positions
  float point;  // how far the bone is then turned to lie along the positions: 1 leaves only the twist as seen
};
constexpr std::array<JointRule, kJointCount> kRules = {{
    {-1, 0.5f, 1},                // Pelvis
    {LeftKnee, 1, 1},             // LeftHip
    {RightKnee, 1, 1},            // RightHip
    {Spine2, 0.5f, 0.5f},         // Spine1
    {LeftAnkle, 1, 1},            // LeftKnee
    {RightAnkle, 1, 1},           // RightKnee
    {Spine3, 0.5f, 0.5f},         // Spine2
    {LeftFoot, 1, 0},             // LeftAnkle
    {RightFoot, 1, 0},            // RightAnkle
    {-1, 0.5f, 0.5f},             // Spine3
    {-1, 1, 1},                   // LeftFoot
    {-1, 1, 1},                   // RightFoot
    {Head, 1, 0},                 // Neck
    {LeftShoulder, 0.5f, 0.5f},   // LeftCollar
    {RightShoulder, 0.5f, 0.5f},  // RightCollar
    {-1, 1, 1},                   // Head
    {LeftElbow, 0.25f, 1},        // LeftShoulder
    {RightElbow, 0.25f, 1},       // RightShoulder
    {LeftWrist, 0.25f, 1},        // LeftElbow
    {RightWrist, 0.25f, 1},       // RightElbow
    {-1, 1, 1},                   // LeftWrist
    {-1, 1, 1},                   // RightWrist
}};

Mat3 blend(const Mat3& A, const Mat3& B, float t) {
  if (t <= 0) return A;
  if (t >= 1) return B;
  return Eigen::Quaternionf(A).slerp(t, Eigen::Quaternionf(B)).toRotationMatrix();
}

/// The angle about `axis` that takes rotation A to B, both sending the same rest bone along the axis.
float twist_angle(const Mat3& A, const Mat3& B, const Vec3& axis) {
  const Eigen::Quaternionf q(Mat3(B * A.transpose()));
  return std::remainder(2 * std::atan2(q.vec().dot(axis), q.w()), 2 * kPi);
}

}  // namespace

/// One arm or leg: the joint above the hinge, the hinge, its end.
struct CopyTransfer::Limb {
  int upper, hinge, end;
  Vec3 axis;         // of flexion, in the T-pose
  float wrong_side;  // how little a bend against the flexion is believed: 1 not at all
};

struct CopyTransfer::Frame {
  const Joints& joints;
  const Rotations* seen;  // null: none
  float dt;
  Rotations global;
  Vec3 bone(int from, int to) const { return (joints.row(to) - joints.row(from)).transpose(); }
};

void CopyTransfer::reset(const Joints& rest_b) {
  US_CHECK(rest_b.allFinite() && leg_length(rest_b) > 1e-4f,
           "the target's T-pose joints are not those of a body");
  memory_ = Memory{};
}

void CopyTransfer::point_bone(Frame& frame, int j, float amount) const {
  const int end = kRules[j].end;
  if (end < 0 || amount <= 0) return;
  const Vec3 seen = frame.bone(j, end);
  if (seen.norm() < 1e-6f) return;  // two joints in one place have no direction
  const Vec3 now = frame.global[j] * (human_rest().row(end) - human_rest().row(j)).transpose();
  frame.global[j] = blend(Mat3::Identity(), rotation_between(now, seen), amount) * frame.global[j];
}

void CopyTransfer::settle(Frame& frame, int j, const Mat3& solved) const {
  frame.global[j] = frame.seen ? blend(solved, (*frame.seen)[j], kRules[j].seen) : solved;
  point_bone(frame, j, frame.seen ? kRules[j].point : 1.0f);
}

void CopyTransfer::solve_trunk(Frame& frame) const {
  const auto fit = [&](int root, std::initializer_list<std::pair<int, float>> hints) {
    Points rest(hints.size(), 3), seen(hints.size(), 3);
    Eigen::VectorXf weights(hints.size());
    int i = 0;
    for (const auto& [end, weight] : hints) {
      // Directions, not offsets: the source's proportions are not those of the assumed T-pose.
      const Vec3 r = (human_rest().row(end) - human_rest().row(root)).transpose(), s = frame.bone(root, end);
      rest.row(i) = r.transpose();
      seen.row(i) = s.normalized().transpose() * r.norm();
      weights[i++] = weight;
    }
    return kabsch(rest, seen, weights);
  };
  settle(frame, Pelvis,
         fit(Pelvis, {{LeftHip, 1}, {RightHip, 1}, {Spine1, 1}, {Spine2, kSpineHint}, {Spine3, kSpineHint}}));
  settle(frame, Spine3,
         fit(Spine3, {{Neck, 1},
                      {LeftCollar, 1},
                      {RightCollar, 1},
                      {LeftShoulder, kShoulderHint},
                      {RightShoulder, kShoulderHint}}));
  // The twist between pelvis and chest is spread over the spine.
  settle(frame, Spine1, blend(frame.global[Pelvis], frame.global[Spine3], 1 / 3.0f));
  settle(frame, Spine2, blend(frame.global[Pelvis], frame.global[Spine3], 2 / 3.0f));
  settle(frame, Neck, frame.global[Spine3]);
  settle(frame, Head, frame.global[Neck]);
  settle(frame, LeftCollar, frame.global[Spine3]);
  settle(frame, RightCollar, frame.global[Spine3]);
}

Mat3 CopyTransfer::hinge_rotation(const Frame& frame, const Limb& limb) const {
  const Mat3& parent = frame.global[kParents[limb.upper]];
  const Vec3 rest1 = (human_rest().row(limb.hinge) - human_rest().row(limb.upper)).transpose().normalized();
  const Vec3 d1 = frame.bone(limb.upper, limb.hinge).normalized();
  const Vec3 d2 = frame.bone(limb.hinge, limb.end).normalized();
  const Vec3 straight = parent * rest1;

  // Least twist from the T-pose, and from the last frame. The first is undefined for a bone turned about.
  const Mat3 least = rotation_between(straight, d1) * parent;
  const Mat3 before = parent * memory_.last[limb.upper];
  const Mat3 carried = rotation_between(before * rest1, d1) * before;
  const float turned = 1 - smooth_step(-0.95f, -0.7f, straight.dot(d1));
  const float keep = memory_.started ? std::exp(-frame.dt / kRelax_s * (1 - turned)) : 0.0f;
  float twist = keep * twist_angle(least, carried, d1);

  // The bend plane: flexion turns d1 to d2 about the hinge axis.
  const Vec3 bend = d1.cross(d2);
  const float bend_deg = std::atan2(bend.norm(), d1.dot(d2)) * 180 / kPi;
  const Vec3 axis = (limb.axis - limb.axis.dot(rest1) * rest1).normalized();
  const Vec3 now = least * axis;
  if (bend.norm() > 1e-6f) {
    const float measured = std::atan2(now.cross(bend).dot(d1), now.dot(bend));
    // A joint that seems to bend the wrong way is a straight one and noise.
    const float flexes = 0.5f + 0.5f * std::cos(measured - twist);
    const float trust =
        smooth_step(kBendLow_deg, kBendHigh_deg, bend_deg) * (1 - limb.wrong_side * (1 - flexes));
    twist += trust * std::remainder(measured - twist, 2 * kPi);
  }
  return Eigen::AngleAxisf(twist, d1).toRotationMatrix() * least;
}

void CopyTransfer::solve_limb(Frame& frame, const Limb& limb) {
  const bool known =
      frame.bone(limb.upper, limb.hinge).norm() > 1e-6f && frame.bone(limb.hinge, limb.end).norm() > 1e-6f;
  const Mat3 parent = frame.global[kParents[limb.upper]];
  settle(frame, limb.upper, known ? hinge_rotation(frame, limb) : Mat3(parent * memory_.last[limb.upper]));
  settle(frame, limb.hinge, frame.global[limb.upper]);
  settle(frame, limb.end, frame.global[limb.hinge]);
}

Rotations CopyTransfer::push(const Extraction& source, float dt) {
  US_CHECK(source.joints.allFinite(), "a source joint is not a number");
  // Elbows flex the forearm forward and a little up: arms held out sideways hinge about an axis between down
  // and forward.
  static const std::array<Limb, 4> limbs = {
      {{LeftHip, LeftKnee, LeftAnkle, Vec3(1, 0, 0), 1.0f},
       {RightHip, RightKnee, RightAnkle, Vec3(1, 0, 0), 1.0f},
       {LeftShoulder, LeftElbow, LeftWrist, Vec3(0, -0.87f, 0.49f), 0.5f},
       {RightShoulder, RightElbow, RightWrist, Vec3(0, 0.87f, -0.49f), 0.5f}}};
  const Rotations* const seen = sees_rotations_ && source.global ? &*source.global : nullptr;
  Frame frame{source.joints, seen, dt, identity_rotations()};
  if (source.exact && seen) {
    frame.global = *seen;
  } else {
    solve_trunk(frame);
    for (const Limb& limb : limbs) solve_limb(frame, limb);
    settle(frame, LeftFoot, frame.global[LeftAnkle]);
    settle(frame, RightFoot, frame.global[RightAnkle]);
  }
  memory_ = {local_rotations(frame.global), true};
  for (const Mat3& R : memory_.last)
    US_CHECK(R.allFinite(), "the motion transfer gave a rotation that is not a number");
  return memory_.last;
}

}  // namespace understudy
