#include "retarget/style/manner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

constexpr std::array<int, 4> kEnds = {LeftWrist, RightWrist, LeftFoot, RightFoot};
constexpr std::array<float, 4> kPull = {0.5f, 0.5f, 0.25f, 0.25f};  // how much of the sway follows each
constexpr float kLarge = 1.0f, kLargest = 2.4f;  // radians: movements from here on are not made larger
constexpr float kMostLean = 0.35f, kMostLook = 0.6f, kMostShift = 0.3f;  // radians, radians, legs
constexpr float kMostBounce = 0.08f;                                     // legs
constexpr float kLookHertz = 1.2f;
constexpr float kHandSpeed_s = 0.3f;
constexpr float kFollows_s = 0.04f;
constexpr float kReach = 0.985f;     // of the leg, as far as it reaches before it straightens softly
constexpr float kMostLifted = 0.3f;  // legs: no step lifts a foot more
constexpr float kMostCrouch = 0.3f;  // legs

/// Which joints share a lean of the trunk.
constexpr std::array<std::pair<int, float>, 3> kSpine = {{{Spine1, 0.4f}, {Spine2, 0.35f}, {Spine3, 0.25f}}};

/// An elbow does not bend the wrong way because its movement grows.
bool is_hinge(int j) {
  return j == LeftElbow || j == RightElbow;
}

/// Grows as x up to the bound, then no more.
float bounded(float x, float most) {
  return most * std::tanh(x / most);
}

Vec3 bounded(const Vec3& x, float most) {
  const float length = x.norm();
  return length < 1e-6f ? x : Vec3(bounded(length, most) / length * x);
}

}  // namespace

const Vec3& Follower::push(const Vec3& goal, float dt, float hertz, float damping) {
  constexpr float kStep = 1 / 240.0f, kLongest = 1;  // seconds
  if (dt > kLongest) {                               // after a gap it has come to rest
    reset(goal);
    return at_;
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kStep)));
  const float h = dt / static_cast<float>(steps), w = 2 * kPi * hertz;
  for (int i = 0; i < steps; ++i) {
    velocity_ += h * (w * w * (goal - at_) - 2 * damping * w * velocity_);
    at_ += h * velocity_;
  }
  return at_;
}

MannerStyle::MannerStyle(const Manner& manner, float posture, float size, float liveliness)
    : manner_(manner), posture_(posture), size_(size), liveliness_(liveliness) {
  reset();
}

void MannerStyle::reset() {
  movement_.reset();
  slow_height_.reset();
  started_ = false;
  next_.reset();
  hand_speed_ = {};
  added_.fill(Vec3::Zero());
}

void MannerStyle::push(const StyleFrame& frame) {
  next_ = styled(frame);
}

std::optional<Rotations> MannerStyle::pop() {
  return std::exchange(next_, std::nullopt);
}

/// The movements that the manner would make of the source's, all of it.
JointTurns MannerStyle::wanted() const {
  JointTurns made = movement_.movements();
  for (int j = 0; j < kJointCount; ++j) made[j] *= std::pow(manner_.size[j], size_);
  if (manner_.coupling) {
    const auto& joints = manner_.coupling->joints;
    const Eigen::MatrixXf& gains = manner_.coupling->gains;
    Eigen::VectorXf movements(gains.cols());
    for (size_t k = 0; k < joints.size(); ++k)
      movements.segment<3>(static_cast<Eigen::Index>(3 * k)) = movement_.movements()[joints[k]];
    const Eigen::VectorXf coupled = movements + size_ * (gains * movements - movements);
    for (size_t k = 0; k < joints.size(); ++k)
      made[joints[k]] = coupled.segment<3>(static_cast<Eigen::Index>(3 * k));
  }
  for (int j = 0; j < kJointCount; ++j)
    if (j != kMirror[j]) made[j] *= 1 + liveliness_ * manner_.uneven * (j < kMirror[j] ? 1.0f : -1.0f);
  return made;
}

/// What the manner adds to movements follows within kFollows_s: it makes no more of a source's jitter.
JointTurns MannerStyle::followed(const JointTurns& wanted, float dt) {
  const float share = started_ ? 1 - std::exp(-dt / kFollows_s) : 1;
  JointTurns made;
  for (int j = 0; j < kJointCount; ++j) {
    added_[j] += share * (wanted[j] - movement_.movements()[j] - added_[j]);
    made[j] = movement_.movements()[j] + added_[j];
  }
  return made;
}

Vec3 MannerStyle::offset(int j) const {
  if (!manner_.coupling) return Vec3::Zero();
  return posture_ * manner_.coupling->offsets[static_cast<size_t>(j)];
}

/// One joint's rotation styled; the pelvis' without its heading.
Mat3 MannerStyle::joint(int j, const Vec3& wanted, const Mat3& local, float amount) const {
  const Vec3& mean = movement_.means()[j];
  const Vec3& movement = movement_.movements()[j];
  // What is large already, an arm that is raised overhead, grows no more.
  const bool grows = wanted.dot(movement) > movement.squaredNorm();
  const Vec3 turned = movement + amount * (grows ? 1 - smooth_step(kLarge, kLargest, movement.norm()) : 1) *
                                     (wanted - movement);
  const Mat3 held = rotation_from_axis_angle(mean),
             turn = rotation_from_axis_angle(amount * posture_ * manner_.posture[j]);
  Mat3 result = held * turn * held.transpose() * rotation_from_axis_angle(mean + turned + amount * offset(j));
  if (is_hinge(j) && grows) {
    const Vec3 now = rotation_to_axis_angle(result);
    const float along = mean.dot(now);
    if (along < 0 && mean.norm() > 1e-3f && rotation_to_axis_angle(local).dot(mean) >= 0)
      result = rotation_from_axis_angle(now - along / mean.squaredNorm() * mean);
  }
  return result;
}

Rotations MannerStyle::styled(const StyleFrame& frame) {
  movement_.push(frame);
  slow_height_share_ = slow_height_.share(frame.dt);
  const float amount = uprightness(frame.pose.local[Pelvis]);
  const JointTurns wanted_turns = followed(wanted(), frame.dt);
  Rotations pose = frame.pose.local;
  for (int j = 0; j < kJointCount; ++j)
    if (!is_of_leg(j) || turns_legs()) pose[j] = joint(j, wanted_turns[j], frame.pose.local[j], amount);
  pose[Pelvis] = movement_.heading() * pose[Pelvis];
  const Vec3 shift = enliven(frame, amount, pose);
  if (turns_legs())
    keep_feet(frame, pose);
  else
    place_legs(frame, amount, shift, pose);
  started_ = true;
  return pose;
}

/// Legs that were turned keep their feet turned as the source's.
void MannerStyle::keep_feet(const StyleFrame& frame, Rotations& pose) const {
  const Rotations was = global_rotations(frame.pose.local), is = global_rotations(pose);
  for (const int side : {0, 1}) {
    const Leg leg = Leg::of(side);
    pose[leg.ankle] = is[leg.knee].transpose() * was[leg.ankle];
  }
}

/// Ankles go where the style's steps take them beside the pelvis, which is shifted over them by `shift`
/// (world axes, metres), feet turned as the source's. Where a leg is too short the pelvis is lower.
void MannerStyle::place_legs(const StyleFrame& frame, float amount, const Vec3& shift,
                             Rotations& pose) const {
  const PosedSkeleton was = forward_kinematics(frame.rest, frame.pose);
  Pose placed{pose, Vec3::Zero()};
  const PosedSkeleton is = forward_kinematics(frame.rest, placed);
  const float leg_m = leg_length(frame.rest), stride = 1 + amount * (std::pow(manner_.stride, size_) - 1),
              lift = 1 + amount * (std::pow(manner_.lift, size_) - 1);
  std::array<Vec3, 2> goals;
  float raise = amount * posture_ * manner_.crouch * leg_m;  // of the feet towards the pelvis
  for (const int side : {0, 1}) {
    const Leg leg = Leg::of(side);
    Vec3& goal = goals[static_cast<size_t>(side)];
    goal = (was.joints.row(leg.ankle) - was.joints.row(Pelvis)).transpose();
    goal.x() *= stride, goal.z() *= stride;
    const float above = was.joints(leg.ankle, 1) - soles_[static_cast<size_t>(side)].height();
    goal.y() += (lift - 1) * std::min(above, kMostLifted * leg_m);
    goal -= shift;
    const Vec3 from_hip = goal - is.joints.row(leg.hip).transpose();
    const float flat = std::hypot(from_hip.x(), from_hip.z());
    const float reach =
        std::max(kReach * leg_m, (was.joints.row(leg.ankle) - was.joints.row(leg.hip)).norm());
    const float room = -from_hip.y() - std::sqrt(std::max(0.0f, reach * reach - flat * flat));
    raise = std::max(raise, std::min(room, kMostCrouch * leg_m));
  }
  for (const int side : {0, 1}) {
    const Leg leg = Leg::of(side);
    place_ankle(frame.rest, side, goals[static_cast<size_t>(side)] + Vec3(0, raise, 0), placed);
    const Rotations global = global_rotations(placed.local);
    placed.local[leg.ankle] = global[leg.knee].transpose() * was.global[leg.ankle];
  }
  pose = placed.local;
}

/// Sway of the trunk and turns of the head by what hands and feet do; the pelvis' own sway and bounce are
/// given back, world axes, metres.
Vec3 MannerStyle::enliven(const StyleFrame& frame, float amount, Rotations& pose) {
  const PosedSkeleton posed = forward_kinematics(frame.rest, frame.pose);
  const float leg = std::max(leg_length(frame.rest), 1e-4f);
  const Mat3& heading = movement_.heading();
  Vec3 pull = Vec3::Zero();
  std::array<Vec3, 2> hands;
  for (size_t k = 0; k < kEnds.size(); ++k) {
    const Vec3 now =
        heading.transpose() * (posed.joints.row(kEnds[k]) - posed.joints.row(Pelvis)).transpose() / leg;
    ends_[k] = started_ ? Vec3(ends_[k] + movement_.slow_share() * (now - ends_[k])) : now;
    pull += kPull[k] * (now - ends_[k]);
    if (k < 2) hands[k] = now;
  }
  for (const size_t side : {0, 1}) {
    const Vec3 ankle = posed.joints.row(LeftAnkle + static_cast<int>(side)).transpose();
    if (!started_) soles_[side].reset();
    soles_[side].push(ankle, leg, frame.dt);
  }
  const float height = frame.pose.root.y() / leg;
  height_ = started_ ? height_ + slow_height_share_ * (height - height_) : height;
  const float eased = 1 - std::exp(-frame.dt / kHandSpeed_s);
  for (size_t k = 0; k < 2; ++k) {
    const float speed = started_ && frame.dt > 0 ? (hands[k] - last_hands_[k]).norm() / frame.dt : 0.0f;
    hand_speed_[k] += eased * (speed - hand_speed_[k]);
  }
  last_hands_ = hands;
  if (!started_) {
    for (Follower* follower : {&lean_, &shift_, &look_}) follower->reset(Vec3::Zero());
  }

  // About x the trunk leans forward, about y the left hand that goes forward takes the chest back, about z it
  // leans.
  const float ahead = (hands[0] - ends_[0]).z() - (hands[1] - ends_[1]).z();
  const Vec3 goal(manner_.lean * pull.z(), -manner_.twist * ahead, -manner_.lean * pull.x());
  const Vec3 lean =
      amount * liveliness_ * bounded(lean_.push(goal, frame.dt, manner_.rhythm, manner_.springs), kMostLean);
  for (const auto& [j, share] : kSpine) pose[j] = pose[j] * rotation_from_axis_angle(share * lean);

  const float both = hand_speed_[0] + hand_speed_[1];
  const Vec3 acting =
      both < 0.05f
          ? Vec3::Zero()
          : Vec3((hand_speed_[0] * (hands[0] - ends_[0]) + hand_speed_[1] * (hands[1] - ends_[1])) / both);
  const Vec3 glance(-manner_.look * acting.y() / 2, manner_.look * acting.x(), 0);
  const Vec3 look =
      amount * liveliness_ * bounded(look_.push(glance, frame.dt, kLookHertz, manner_.springs), kMostLook);
  for (const int j : {Neck, Head}) pose[j] = pose[j] * rotation_from_axis_angle(look / 2);

  const Vec3 way = bounded(shift_.push({manner_.shift * pull.x(), 0, manner_.shift * pull.z()}, frame.dt,
                                       manner_.rhythm, manner_.springs),
                           kMostShift);
  const float hop = bounded((manner_.bounce - 1) * (height - height_), kMostBounce);
  return amount * liveliness_ * leg * (heading * way + Vec3(0, hop, 0));
}

}  // namespace understudy
