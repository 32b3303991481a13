#include "retarget/pose2d/touches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "retarget/math/smooth_step.hpp"

namespace understudy {

namespace {

constexpr float kTouches = 0.04f, kLetsGo = 0.07f;  // of the stature

struct FlatArm {
  int shoulder, elbow, wrist;
  flat_bone::Bone upper, fore;
  FlatPoints FlatPose::*hand;
};
constexpr std::array<FlatArm, 2> kArms = {
    {{body25::RightShoulder, body25::RightElbow, body25::RightWrist, flat_bone::RightUpperArm,
      flat_bone::RightForearm, &FlatPose::right_hand},
     {body25::LeftShoulder, body25::LeftElbow, body25::LeftWrist, flat_bone::LeftUpperArm,
      flat_bone::LeftForearm, &FlatPose::left_hand}}};

/// Where a wrist is wanted, and how much: 0..1.
struct Wish {
  Vec2 sum = Vec2::Zero();
  float all = 0, most = 0;
  void add(const Vec2& place, float weight) {
    sum += weight * place;
    all += weight;
    most = std::max(most, weight);
  }
};

void move_hand(const Vec2& way, FlatPoints& hand) {
  for (Eigen::Index i = 0; i < hand.rows(); ++i)
    if (hand(i, 2) > 0) hand.row(i).head<2>() += way.transpose();
}

/// Both bones of an arm, as long as they look now, or longer up to their lengths, or more foreshortened, so
/// that the wrist comes to `goal`, or as far as it gets.
void reach(const FlatArm& arm, const BoneLengths& length, const Vec2& goal, FlatPose& pose) {
  const Vec2 shoulder = pose.at(arm.shoulder), elbow = pose.at(arm.elbow), wrist = pose.at(arm.wrist);
  float upper = (elbow - shoulder).norm(), fore = (wrist - elbow).norm();
  const float longest_upper = std::max(length[arm.upper], upper),
              longest_fore = std::max(length[arm.fore], fore);
  Vec2 way = goal - shoulder;
  if (way.norm() < 1e-6f) way = Vec2(0, 1e-6f);
  const float far = std::min(way.norm(), longest_upper + longest_fore);
  way *= far / way.norm();
  if (far > upper + fore) {  // both turn towards the view's plane
    const float more = far / std::max(upper + fore, 1e-6f);
    upper = std::min(upper * more, longest_upper);
    fore = std::min(far - upper, longest_fore);
    upper = far - fore;
  } else if (upper > fore + far) {
    upper = fore + far;
  } else if (fore > upper + far) {
    fore = upper + far;
  }
  const float along = (far * far + upper * upper - fore * fore) / (2 * far),
              across = std::sqrt(std::max(0.0f, upper * upper - along * along));
  const Vec2 was = wrist - shoulder, bend = elbow - shoulder;
  const float side = was.x() * bend.y() - was.y() * bend.x() < 0 ? -1.0f : 1.0f;
  const Vec2 ahead = way / far;
  pose.set(arm.elbow, shoulder + along * ahead + side * across * Vec2(-ahead.y(), ahead.x()),
           pose.confidence(arm.elbow));
  pose.set(arm.wrist, shoulder + way, pose.confidence(arm.wrist));
  move_hand(shoulder + way - wrist, pose.*arm.hand);
}

/// How much a pair touches, 0..1; 0 where one is missing.
float touch_of(const FlatPose& pose, const HandPair& pair, float stature) {
  if (!pose.has(pair.wrist) || !pose.has(pair.other)) return 0;
  const float far = (pose.at(pair.wrist) - pose.at(pair.other)).norm() / stature;
  return 1 - smooth_step(kTouches, kLetsGo, far);
}

void move_arms(const std::array<Wish, 2>& wishes, const BoneLengths& length, FlatPose& result) {
  for (size_t side = 0; side < kArms.size(); ++side) {
    const FlatArm& arm = kArms[side];
    const Wish& wish = wishes[side];
    if (wish.all <= 0 || !result.has(arm.shoulder) || !result.has(arm.elbow)) continue;
    const Vec2 wrist = result.at(arm.wrist);
    reach(arm, length, wrist + wish.most * (wish.sum / wish.all - wrist), result);
  }
}

}  // namespace

void keep_touches(const FlatPose& source, const BoneLengths& from, const BoneLengths& to, FlatPose& result) {
  const float stature = std::max(stature_of(from), 1e-6f), ratio = stature_of(to) / stature;
  const auto apart = [&](const HandPair& pair) {
    return Vec2(ratio * (source.at(pair.wrist) - source.at(pair.other)));
  };
  std::array<Wish, 2> wishes;
  const auto side_of = [](int wrist) -> size_t { return wrist == body25::RightWrist ? 0 : 1; };
  for (const HandPair& pair : kHandPairs) {
    const float touch = touch_of(source, pair, stature);
    if (touch <= 0 || pair.other == body25::LeftWrist) continue;
    wishes[side_of(pair.wrist)].add(result.at(pair.other) + apart(pair), touch);
  }
  move_arms(wishes, to, result);

  const HandPair hands = kHandPairs.back();
  const float touch = touch_of(source, hands, stature);
  if (touch <= 0) return;
  // Who touches the body stays there, the other hand comes; otherwise both meet half way.
  const float right = wishes[0].most, left = wishes[1].most;
  const float share = (right + 1e-3f) / (right + left + 2e-3f);  // of the left hand's way
  const Vec2 between = result.at(body25::RightWrist) - result.at(body25::LeftWrist) - apart(hands);
  std::array<Wish, 2> meet;
  meet[0].add(result.at(body25::RightWrist) - (1 - share) * between, touch);
  meet[1].add(result.at(body25::LeftWrist) + share * between, touch);
  move_arms(meet, to, result);
}

}  // namespace understudy
