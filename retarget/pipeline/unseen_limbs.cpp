#include "retarget/pipeline/unseen_limbs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "retarget/math/rotation.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/pipeline/human_rest.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

// Confidence below which a joint that is not seen is not known either; less where its mirror image is seen.
constexpr float kUnknown = 0.2f, kUnknownAlone = 0.12f;
constexpr float kNotice_s = 0.15f;  // time constants: in which a joint becomes lost or seen,
constexpr float kFade_s = 0.15f;    // in which it is then replaced,
constexpr float kGround_s = 0.6f;   // in which the floor follows who rises
constexpr float kLostFrom = 0.7f, kSeenBelow = 0.3f;  // of the evidence
constexpr size_t kFewestLengths = 5;                  // frames from which a length seen is believed
constexpr int kFewestBones = 3;                       // that show a person's size
constexpr float kArmDown = 1.4f, kElbowBent = 0.25f;  // radians from the T-pose: an arm at rest
constexpr float kElastic =
    0.03f;                       // share of the leg that the pelvis may be off before knees bend or feet rise
constexpr float kLowest = 0.3f;  // share of the leg below which knees bend no further
constexpr float kSole = 0.03f;   // of the leg: the sole below the foot's joint

/// Limb joints, the end of each limb first: what is beyond a joint is lost before it may be.
constexpr std::array<int, 10> kLimbJoints = {LeftFoot,  RightFoot, LeftAnkle,  RightAnkle, LeftKnee,
                                             RightKnee, LeftWrist, RightWrist, LeftElbow,  RightElbow};

struct ArmJoints {
  int shoulder, elbow, wrist;
};
constexpr ArmJoints joints_of_arm(int side) {
  return {LeftShoulder + side, LeftElbow + side, LeftWrist + side};
}

Vec3 rest_direction(int joint) {
  return (human_rest().row(joint) - human_rest().row(kParents[joint])).transpose().normalized();
}

float eased(float dt, float constant) {
  return 1 - std::exp(-dt / constant);
}

Mat3 about_x(float angle) {
  return Eigen::AngleAxisf(angle, Vec3::UnitX()).toRotationMatrix();
}

Mat3 part_way(const Mat3& from, const Mat3& to, float amount) {
  return Eigen::Quaternionf(from).slerp(amount, Eigen::Quaternionf(to)).toRotationMatrix();
}

/// How pelvis or chest are turned: as seen on the surface, else by the joints.
Mat3 trunk_rotation(const Extraction& seen, int joint) {
  if (seen.global) return (*seen.global)[joint];
  const auto way = [&](int from, int to) {
    return Vec3((seen.joints.row(to) - seen.joints.row(from)).transpose());
  };
  const Vec3 x = joint == Pelvis ? way(RightHip, LeftHip) : way(RightShoulder, LeftShoulder);
  const Vec3 z = x.cross(way(joint, Neck));
  if (z.norm() < 1e-6f) return Mat3::Identity();
  Mat3 R;
  R << x.normalized(), z.cross(x).normalized(), z.normalized();
  return R;
}

/// Pelvis or chest stood up, as far as it may be said to stand: what lies keeps its limbs beside it.
struct Upright {
  Mat3 R;
  float amount = 1;  // 0: lies .. 1: stood up
};

Upright stood_up(const Mat3& R) {
  const Vec3 up = R.col(1), axis = up.cross(Vec3::UnitY());
  const float tilt = std::atan2(axis.norm(), up.y());
  const float amount = 1 - smooth_step(kPi / 3, kPi / 2, tilt);
  if (axis.norm() < 1e-6f) return {R, amount};
  return {Eigen::AngleAxisf(amount * tilt, axis.normalized()).toRotationMatrix() * R, amount};
}

/// The angle beside `a` in a triangle whose sides a and c meet there.
float angle_between(float a, float c, float opposite) {
  return std::acos(std::clamp((a * a + c * c - opposite * opposite) / (2 * a * c), -1.0f, 1.0f));
}

std::string capital(std::string text) {
  text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

void append_sentence(std::string& text, const std::string& sentence) {
  text += (text.empty() ? "" : " ") + sentence;
}

}  // namespace

bool is_lost(const Extraction& seen, int joint) {
  const float hidden = std::min(1.0f, (1 - seen.visibility[joint]) / (1 - kSeen));
  const bool alone = seen.visibility[kMirror[joint]] >= kSeen;
  return seen.confidence[joint] < hidden * (alone ? kUnknownAlone : kUnknown);
}

bool shows_bone(const Extraction& seen, int joint) {
  const auto shown = [&](int j) { return seen.visibility[j] >= kSeen && !is_lost(seen, j); };
  return shown(joint) && shown(kParents[joint]);
}

float mean_confidence(const Extraction& seen) {
  const auto visible = seen.visibility >= kSeen;
  const auto count = visible.count();
  if (count == 0 || count == kJointCount) return seen.confidence.mean();
  return visible.select(seen.confidence, 0.0f).sum() / static_cast<float>(count);
}

std::optional<float> human_size(const Extraction& seen) {
  static const auto human = bone_lengths(human_rest());
  const auto lengths = bone_lengths(seen.joints);
  float sum = 0, usual = 0;
  int bones = 0;
  for (int j = 1; j < kJointCount; ++j) {
    if (!shows_bone(seen, j)) continue;
    const float weight = std::min(seen.confidence[j], seen.confidence[kParents[j]]);
    sum += weight * lengths[j], usual += weight * human[j], ++bones;
  }
  if (bones < kFewestBones || usual <= 0) return std::nullopt;
  return sum / usual;
}

std::optional<HalfBody> half_body(const Extraction& seen) {
  for (const int j : {LeftAnkle, RightAnkle, LeftFoot, RightFoot})
    if (!is_lost(seen, j)) return std::nullopt;
  const std::optional<float> size = human_size(seen);
  if (!size) return std::nullopt;
  const float hips = 0.5f * (seen.joints(LeftHip, 1) + seen.joints(RightHip, 1));
  const float legs = human_rest()(LeftHip, 1) - human_rest()(LeftFoot, 1) + kSole * leg_length(human_rest());
  const Vec3 trunk = (seen.joints.row(Neck) - seen.joints.row(Pelvis)).transpose();
  return HalfBody{*size * kHumanStature, hips - *size * legs, trunk.normalized().y()};
}

std::string unseen_sentence(const LimbsSight& limbs) {
  struct Pair {
    size_t left;
    const char *whole, *end, *does;
  };
  constexpr std::array<Pair, 2> kPairs = {
      {{2, "leg", "lower leg", "still"}, {0, "arm", "forearm", "at rest"}}};
  std::string text;
  for (const Pair& pair : kPairs) {
    const LimbSight left = limbs[pair.left], right = limbs[pair.left + 1];
    const bool leg = pair.left == 2;
    const auto name = [&](LimbSight sight) { return sight == LimbSight::Unseen ? pair.whole : pair.end; };
    if (left == right && left != LimbSight::Seen) {
      append_sentence(
          text, capital(name(left)) + "s not seen: they " + (leg ? "stand " : "hang ") + pair.does + ".");
      continue;
    }
    for (const bool is_left : {true, false}) {
      const LimbSight sight = is_left ? left : right;
      if (sight != LimbSight::Seen)
        append_sentence(text, std::string(is_left ? "Left " : "Right ") + name(sight) + " not seen: it " +
                                  (leg ? "stands " : "hangs ") + pair.does + ".");
    }
  }
  return text;
}

std::string UnseenTold::push(const LimbsSight& limbs) {
  LimbsSight news{};
  for (size_t k = 0; k < limbs.size(); ++k)
    if (limbs[k] > told_[k]) news[k] = told_[k] = limbs[k];
  return unseen_sentence(news);
}

std::vector<int> joints_seen(const LimbsSight& limbs) {
  std::array<bool, kJointCount> gone{};
  for (const int side : {0, 1}) {
    const LimbSight arm = limbs[side], shank = limbs[2 + side];
    const Leg leg = Leg::of(side);
    gone[LeftElbow + side] = arm == LimbSight::Unseen;
    gone[LeftWrist + side] = arm != LimbSight::Seen;
    gone[leg.knee] = shank == LimbSight::Unseen;
    gone[leg.ankle] = gone[leg.ball] = shank != LimbSight::Seen;
  }
  std::vector<int> joints;
  for (int j = 0; j < kJointCount; ++j)
    if (!gone[j]) joints.push_back(j);
  return joints;
}

/// One frame in work: as seen, and as it becomes.
struct UnseenLimbs::Body {
  const Extraction& seen;
  Extraction result;
  Upright pelvis, chest;
  const std::array<Fade, kJointCount>& fades;
  std::array<float, 2> sole{};  // height of an ankle that stands

  Vec3 at(int joint) const { return result.joints.row(joint).transpose(); }
  Vec3 bone(int joint) const { return at(joint) - at(kParents[joint]); }
  /// Puts a joint at the end of its bone, which is so long and, as far as it is replaced, turned by R.
  void place(int joint, const Mat3& R, float length);
  /// Turns a joint that no other ends: a hand, a foot.
  void turn_end(int joint, const Mat3& R);
};

void UnseenLimbs::Body::place(int joint, const Mat3& R, float length) {
  const int parent = kParents[joint];
  const float amount = fades[joint].amount;
  const Vec3 was = (seen.joints.row(joint) - seen.joints.row(parent)).transpose(),
             wanted = R * rest_direction(joint);
  Vec3 direction = wanted;
  if (amount < 1 && was.norm() > 1e-6f) {
    const Vec3 turn = rotation_to_axis_angle(rotation_between(was, wanted));
    direction = rotation_from_axis_angle(amount * turn) * was.normalized();
  }
  const float reach = was.norm() + amount * (length - was.norm());
  result.joints.row(joint) = result.joints.row(parent) + reach * direction.transpose();
  if (result.global) (*result.global)[parent] = part_way((*seen.global)[parent], R, amount);
  result.confidence[joint] += amount * (result.confidence[parent] - result.confidence[joint]);
}

void UnseenLimbs::Body::turn_end(int joint, const Mat3& R) {
  if (result.global) (*result.global)[joint] = part_way((*seen.global)[joint], R, fades[joint].amount);
}

void UnseenLimbs::follow(const Extraction& seen, float dt) {
  std::array<bool, kJointCount> whole{};  // lost, and all beyond
  for (const int j : kLimbJoints) {
    Fade& fade = fades_[j];
    const float now = is_lost(seen, j) ? 1 : 0;
    fade.evidence += (started_ ? eased(dt, kNotice_s) : 1.0f) * (now - fade.evidence);
    fade.lost = fade.lost ? fade.evidence > kSeenBelow : fade.evidence > kLostFrom;
    const bool is_end = j == LeftFoot || j == RightFoot || j == LeftWrist || j == RightWrist;
    const int beyond = j < LeftShoulder ? j + 3 : j + 2;
    whole[j] = fade.lost && (is_end || whole[beyond]);
    const float wanted = whole[j] ? 1 : 0;
    fade.amount += (started_ ? eased(dt, kFade_s) : 1.0f) * (wanted - fade.amount);
    if (std::abs(wanted - fade.amount) < 0.01f) fade.amount = wanted;
  }
}

void UnseenLimbs::learn(const Extraction& seen) {
  const auto lengths = bone_lengths(seen.joints);
  for (const int j : kLimbJoints)
    if (shows_bone(seen, j)) lengths_[j].push(lengths[j]);
  if (const std::optional<float> size = human_size(seen)) size_.push(*size);
  if (size_.empty()) size_.push(lengths.sum() / bone_lengths(human_rest()).sum());
}

float UnseenLimbs::length(int joint) const {
  for (const int j : {joint, kMirror[joint]})
    if (lengths_[j].count() >= kFewestLengths) return lengths_[j].value();
  return size_.value() * (human_rest().row(joint) - human_rest().row(kParents[joint])).norm();
}

void UnseenLimbs::hang_arm(Body& body, int side) const {
  const auto [shoulder, elbow, wrist] = joints_of_arm(side);
  if (fades_[wrist].amount <= 0) return;
  const float s = side == 0 ? 1.0f : -1.0f;
  const Mat3 down = body.chest.R * Eigen::AngleAxisf(-s * kArmDown, Vec3::UnitZ()).toRotationMatrix();
  body.place(elbow, down, length(elbow));
  const Mat3 upper = body.result.global ? (*body.result.global)[shoulder] : down;
  const Mat3 along = rotation_between(upper * rest_direction(elbow), body.bone(elbow)) * upper;
  const Vec3 hinge(0, -0.87f * s, 0.49f * s);
  const Mat3 lower = along * Eigen::AngleAxisf(kElbowBent, hinge.normalized()).toRotationMatrix();
  body.place(wrist, lower, length(wrist));
  body.turn_end(wrist, lower);
}

void UnseenLimbs::stand_leg(Body& body, int side) const {
  const Leg leg = Leg::of(side);
  if (fades_[leg.ball].amount <= 0) return;
  const Mat3& R = body.pelvis.R;
  const float upright = body.pelvis.amount, floor = ground_ + body.sole[side];
  float thigh_m = length(leg.knee), shin_m = length(leg.ankle);
  const float thigh = -rest_direction(leg.knee).y() * thigh_m, shin = -rest_direction(leg.ankle).y() * shin_m;
  // How much of the way to the floor a bone bears, within the elastic share of it.
  const auto given = [&](float reach, float usual) {
    return 1 + upright * (std::clamp(reach / usual, 1 - kElastic, 1 + kElastic) - 1);
  };
  const float whole = thigh + shin, reach = body.at(leg.hip).y() - floor, k = given(reach, whole);
  const float bears = std::max(reach, kLowest * whole);
  const float forward = bears < k * whole ? upright * angle_between(k * thigh, bears, k * shin) : 0.0f;
  body.place(leg.knee, R * about_x(-forward), k * thigh_m);

  // The shin hangs from the knee, behind a thigh that points back, and ends on the floor.
  const Vec3 seen_thigh = R.transpose() * body.bone(leg.knee);
  const float behind = std::max(0.0f, std::atan2(-seen_thigh.z(), -seen_thigh.y()));
  const float drop = body.at(leg.knee).y() - floor, l = given(drop, shin);
  const float folded = upright * std::acos(std::clamp(drop / (l * shin), 0.0f, 1.0f));
  body.place(leg.ankle, R * about_x(std::max(folded, std::min(behind, kPi / 2))), l * shin_m);
  body.place(leg.ball, R, length(leg.ball));
  body.turn_end(leg.ball, R);
}

/// Both legs, and the floor that they stand on.
void UnseenLimbs::stand(Body& body, float dt) {
  float reach = 1e9f, sure = 1;
  for (const int side : {0, 1}) {
    const Leg leg = Leg::of(side);
    const float leg_m = length(leg.knee) + length(leg.ankle);
    body.sole[side] = -rest_direction(leg.ball).y() * length(leg.ball) + kSole * leg_m;
    const float straight =
        -rest_direction(leg.knee).y() * length(leg.knee) - rest_direction(leg.ankle).y() * length(leg.ankle);
    reach = std::min(reach, body.at(leg.hip).y() - body.sole[side] - straight);
    sure = std::min(sure, fades_[leg.knee].amount);
  }
  const float risen = sure * body.pelvis.amount * std::max(0.0f, reach);
  ground_ += (started_ ? eased(dt, kGround_s) : 1.0f) * (risen - ground_);
  for (const int side : {0, 1}) stand_leg(body, side);

  const float both = std::min(fades_[LeftFoot].amount, fades_[RightFoot].amount);
  if (both <= 0) return;
  const float left = body.at(LeftAnkle).y() - body.sole[0], right = body.at(RightAnkle).y() - body.sole[1];
  const float lowest = std::min(left, right) - ground_;
  std::optional<float>& height = body.result.sole_height;
  height = height ? *height + both * (lowest - *height) : lowest;
}

Extraction UnseenLimbs::push(const Extraction& seen, float dt) {
  if (seen.exact) return seen;
  follow(seen, dt);
  learn(seen);
  const bool lost =
      std::any_of(fades_.begin(), fades_.end(), [](const Fade& fade) { return fade.amount > 0; });
  Body body{seen, seen, stood_up(trunk_rotation(seen, Pelvis)), stood_up(trunk_rotation(seen, Spine3)),
            fades_};
  if (lost) {
    for (const int side : {0, 1}) hang_arm(body, side);
    stand(body, dt);
  }
  started_ = true;
  return body.result;
}

LimbsSight UnseenLimbs::limbs() const {
  const auto sight = [&](int middle, int end) {
    return fades_[middle].amount > 0.5f ? LimbSight::Unseen
           : fades_[end].amount > 0.5f  ? LimbSight::EndUnseen
                                        : LimbSight::Seen;
  };
  return {sight(LeftElbow, LeftWrist), sight(RightElbow, RightWrist), sight(LeftKnee, LeftAnkle),
          sight(RightKnee, RightAnkle)};
}

Standing UnseenLimbs::feet() const {
  return {fades_[LeftFoot].amount < 0.5f, fades_[RightFoot].amount < 0.5f};
}

}  // namespace understudy
