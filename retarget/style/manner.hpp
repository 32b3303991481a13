// The analytic style: how a body is held, how far it moves, and how it sways, bounces and looks about.
// Causal, no lag.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "retarget/pipeline/motion_style.hpp"
#include "retarget/style/foot_level.hpp"
#include "retarget/style/joint_movement.hpp"
#include "retarget/style/pose_style.hpp"

namespace understudy {

/// Whether a joint is a leg's, which a manner places and does not turn.
constexpr bool is_of_leg(int joint) {
  return joint == LeftHip || joint == RightHip || (joint >= LeftKnee && joint <= RightKnee) ||
         joint == LeftAnkle || joint == RightAnkle || joint == LeftFoot || joint == RightFoot;
}

/// How joints move together: what each joint's movement gets from the movements of all of these.
struct Coupling {
  std::vector<int> joints;
  /// [3 joints, 3 joints]: their movements (JointMovement), one below the other, become these times them
  Eigen::MatrixXf gains;
  JointTurns offsets;  ///< added to their rotation vectors, radians
  Coupling() { offsets.fill(Vec3::Zero()); }
  bool turns(int joint) const { return std::find(joints.begin(), joints.end(), joint) != joints.end(); }
};

/// The figures of a manner. Lengths are in legs (thigh plus shin of the source).
struct Manner {
  /// turns of each joint's slow posture, radians, in the joint's own frame; the pelvis' in the body's heading
  std::array<Vec3, kJointCount> posture{};
  /// of each joint's movement about its slow posture; 1 as the source
  std::array<float, kJointCount> size{};
  /// in place of `size`, of the joints that it has
  std::optional<Coupling> coupling;
  // Legs that no coupling turns are placed:
  float stride = 1;  ///< of steps
  float lift = 1;    ///< of how high feet are lifted
  float crouch = 0;  ///< legs by which the pelvis is lower
  float lean =
      0;  ///< radians that the trunk leans for a leg by which hands and feet are away from where they were
  float twist = 0;       ///< the same about the vertical, for a leg between both hands' ways forward
  float shift = 0;       ///< legs that the pelvis follows them
  float look = 0;        ///< radians that the head turns after the faster hand
  float bounce = 1;      ///< of the pelvis' rise and fall in steps
  float uneven = 0;      ///< the left side moves so much more, the right so much less, a share
  float rhythm = 1;      ///< Hz, how fast the trunk follows
  float springs = 0.5f;  ///< damping of what follows: 1 none swings over
  Manner() {
    posture.fill(Vec3::Zero());
    size.fill(1);
  }
};

/// Follows a goal as a weight on a spring does.
class Follower {
 public:
  void reset(const Vec3& at) { at_ = at, velocity_.setZero(); }
  const Vec3& push(const Vec3& goal, float dt, float hertz, float damping);

 private:
  Vec3 at_ = Vec3::Zero(), velocity_ = Vec3::Zero();
};

/// Each joint's rotation is split into its slow posture and the movement about it; the posture is turned, the
/// movement scaled, or coupled with those of other joints. What sways follows hands and feet, so who stands
/// still does not sway. A body that lies is left as it is.
class MannerStyle final : public PoseStyle {
 public:
  /// The shares are those of StyleChoice.
  MannerStyle(const Manner& manner, float posture, float size, float liveliness);
  void reset() override;
  void push(const StyleFrame& frame) override;
  std::optional<Rotations> pop() override;

 private:
  Rotations styled(const StyleFrame& frame);
  JointTurns wanted() const;
  JointTurns followed(const JointTurns& wanted, float dt);
  Vec3 offset(int j) const;
  Mat3 joint(int j, const Vec3& wanted, const Mat3& local, float amount) const;
  bool turns_legs() const { return manner_.coupling && manner_.coupling->turns(LeftHip); }
  Vec3 enliven(const StyleFrame& frame, float amount, Rotations& pose);
  void keep_feet(const StyleFrame& frame, Rotations& pose) const;
  void place_legs(const StyleFrame& frame, float amount, const Vec3& shift, Rotations& pose) const;

  Manner manner_;
  float posture_, size_, liveliness_;
  JointMovement movement_;
  JointTurns added_;  // to the movements
  SlowMean slow_height_{0.5f};
  float slow_height_share_ = 1;
  std::array<Vec3, 4> ends_{};  // slow places of hands and feet beside the pelvis, in its heading, legs
  std::array<Vec3, 2> last_hands_{};
  std::array<float, 2> hand_speed_{};
  float height_ = 0;                // slow, of the pelvis, legs
  std::array<FootLevel, 2> soles_;  // of the ankles
  Follower lean_, shift_, look_;
  bool started_ = false;
  std::optional<Rotations> next_;
};

}  // namespace understudy
