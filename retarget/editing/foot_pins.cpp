// Pinned feet: contacts from the whole motion, corrections that roll with the foot, legs by inverse
// kinematics.
#include <algorithm>
#include <cmath>

#include "retarget/editing/pose_edits.hpp"
#include "retarget/math/smooth_step.hpp"
#include "retarget/skeleton/limb_ik.hpp"

namespace understudy {
namespace {

/// Share of the leg that a standing foot is at most moved up or down by: what stands higher stands on a step.
constexpr float kOnFloor = 0.08f;

/// One foot over time.
struct Foot {
  Leg leg;
  float level = 0, heel_level = 0;     // heights of ball and heel where the foot stands
  std::vector<Vec3> ankle, ball;       // [T] world
  std::vector<Vec3> heel;              // [T] world, of the sole
  std::vector<float> clearance;        // [T] of the lowest of the sole over the floor; 0 without soles
  std::vector<char> on_ball, on_heel;  // [T] in contact
  std::vector<Vec3> offset;            // [T] added to the ankle
  bool stands(int t) const { return on_ball[t] || on_heel[t]; }
};

/// A height that a share of the values is below.
float quantile(std::vector<float> values, float share) {
  const auto at = values.begin() + static_cast<long>(share * static_cast<float>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The sole's points of one side and its rearmost, relative to ankle or ball as the support says.
struct Sole {
  std::vector<size_t> points;  // of body.soles
  Vec3 heel;                   // from the ankle, T-pose axes
  float below_ball = 0;        // from the ball's height in T-pose down to the floor; known with points only
};

Sole sole_of(const EditedBody& body, const Leg& leg) {
  Sole sole;
  const Vec3 ankle = body.rest.row(leg.ankle).transpose(), ball = body.rest.row(leg.ball).transpose();
  sole.heel = Vec3(0, ball.y() - ankle.y(), -0.06f * leg_length(body.rest));
  float lowest = 1e9f, rearmost = 1e9f;
  for (size_t i = 0; i < body.soles.joint.size(); ++i) {
    const int j = body.soles.joint[i];
    const Vec3 offset = body.soles.offset.row(i).transpose();
    if ((j != leg.ankle && j != leg.ball) || offset.isZero()) continue;  // the joints themselves are no sole
    sole.points.push_back(i);
    lowest = std::min(lowest, body.rest(j, 1) + offset.y());
    if (j == leg.ankle && offset.z() < rearmost) rearmost = offset.z(), sole.heel = offset;
  }
  if (!sole.points.empty()) sole.below_ball = ball.y() - lowest;
  return sole;
}

Foot observed(const Motion& motion, const EditedBody& body, int side) {
  Foot foot;
  foot.leg = Leg::of(side);
  const Sole sole = sole_of(body, foot.leg);
  const size_t count = motion.poses.size();
  std::vector<float> heights, heel_heights;
  for (const Pose& pose : motion.poses) {
    const PosedSkeleton posed = forward_kinematics(body.rest, pose);
    const Mat3& R = posed.global[foot.leg.ankle];
    foot.ankle.push_back(posed.joints.row(foot.leg.ankle).transpose());
    foot.ball.push_back(posed.joints.row(foot.leg.ball).transpose());
    foot.heel.push_back(foot.ankle.back() + R * sole.heel);
    heights.push_back(foot.ball.back().y());
    heel_heights.push_back(foot.heel.back().y());
    float lowest = 1e9f;
    for (const size_t i : sole.points) {
      const int j = body.soles.joint[i];
      const Vec3 offset = body.soles.offset.row(i).transpose();
      lowest = std::min(lowest, posed.joints(j, 1) + (posed.global[j] * offset).y());
    }
    foot.clearance.push_back(lowest);
  }
  foot.level = quantile(heights, 0.05f);
  foot.heel_level = quantile(heel_heights, 0.05f);
  if (sole.points.empty()) foot.clearance.assign(count, 0.0f);
  foot.offset.assign(count, Vec3::Zero());
  foot.on_ball.assign(count, 0);
  foot.on_heel.assign(count, 0);
  return foot;
}

/// Spans shorter than `shortest` frames of `value` become the other value.
void drop_short_spans(std::vector<char>& on, char value, int shortest) {
  const size_t count = on.size();
  for (size_t begin = 0; begin < count;) {
    size_t end = begin;
    while (end < count && on[end] == on[begin]) ++end;
    const bool inside = value != 0 || (begin > 0 && end < count);  // a gap has contacts on both sides
    if (on[begin] == value && inside && end - begin < static_cast<size_t>(shortest))
      std::fill(on.begin() + static_cast<long>(begin), on.begin() + static_cast<long>(end), !value);
    begin = end;
  }
}

/// Contact of one point by the hysteresis in both directions of time: either sees the whole of it.
std::vector<char> contacts(const std::vector<Vec3>& point, float level, const PinEdit& edit, float leg_m,
                           float fps) {
  const int count = point.size();
  std::vector<char> on(point.size(), 0);
  ContactSwitch forward(edit.contact, leg_m), backward(edit.contact, leg_m);
  for (int t = 0; t < count; ++t) {
    const auto f = static_cast<size_t>(t), b = static_cast<size_t>(count - 1 - t);
    if (forward.push(point[f], level, 1 / fps)) on[f] = 1;
    if (backward.push(point[b], level, 1 / fps)) on[b] = 1;
  }
  drop_short_spans(on, 0, static_cast<int>(std::lround(0.07f * fps)));
  drop_short_spans(on, 1, static_cast<int>(std::lround(0.07f * fps)));
  return on;
}

Vec3 over_floor(const Vec3& v) {
  return Vec3(v.x(), 0, v.z());
}

/// Corrections of one stance, frames begin .. end - 1: what keeps its pivot in place, from frame to frame, so
/// that the foot may roll from heel to ball; on the whole the foot stays where it was on average.
void hold_stance(Foot& foot, int begin, int end, float max_lift) {
  Vec3 offset = Vec3::Zero(), mean = Vec3::Zero();
  for (int t = begin; t < end; ++t) {
    const size_t now = t;
    if (t > begin) {
      const bool rolls_on_ball = foot.on_ball[now] && (foot.on_ball[now - 1] || !foot.on_heel[now]);
      const auto& pivot = rolls_on_ball ? foot.ball : foot.heel;
      offset += over_floor(pivot[now - 1] - pivot[now]);
    }
    foot.offset[now] = offset;
    mean += offset / static_cast<float>(end - begin);
  }
  // Up or down as a whole: heel and toes keep their way of coming and leaving.
  const float clearance = quantile({foot.clearance.begin() + begin, foot.clearance.begin() + end}, 0.5f);
  const float lift = std::clamp(-clearance, -max_lift, max_lift);
  for (int t = begin; t < end; ++t) {
    const size_t now = t;
    foot.offset[now] -= mean;
    foot.offset[now].y() = lift;
  }
}

/// Between stances the correction goes over from one to the next, or to none and back in a long gap.
void blend_gap(Foot& foot, int begin, int end, float blend_frames) {
  const int count = foot.offset.size();
  const Vec3 before = begin > 0 ? foot.offset[begin - 1] : Vec3(Vec3::Zero());
  const Vec3 after = end < count ? foot.offset[end] : Vec3(Vec3::Zero());
  const float gap = static_cast<float>(end - begin + 1);
  const bool both = begin > 0 && end < count && gap <= 2 * blend_frames;
  const float reach = std::min(blend_frames, gap);
  for (int t = begin; t < end; ++t) {
    const float since = static_cast<float>(t - begin + 1), until = static_cast<float>(end - t);
    auto& offset = foot.offset[t];
    if (both)
      offset = before + smooth_step(0, gap, since) * (after - before);
    else
      offset = (1 - smooth_step(0, reach, since)) * before + (1 - smooth_step(0, reach, until)) * after;
  }
}

void find_offsets(Foot& foot, const PinEdit& edit, float leg_m, float fps) {
  const int count = foot.offset.size();
  const auto span_end = [&](int begin) {
    int end = begin;
    while (end < count && foot.stands(end) == foot.stands(begin)) ++end;
    return end;
  };
  for (int begin = 0, end; begin < count; begin = end) {
    end = span_end(begin);
    if (foot.stands(begin)) hold_stance(foot, begin, end, edit.to_floor ? kOnFloor * leg_m : 0);
  }
  for (int begin = 0, end; begin < count; begin = end) {
    end = span_end(begin);
    if (!foot.stands(begin)) blend_gap(foot, begin, end, std::max(1.0f, edit.blend_s * fps));
  }
  if (edit.keep_soles_up)
    for (size_t t = 0; t < foot.offset.size(); ++t)
      foot.offset[t].y() = std::max(foot.offset[t].y(), -foot.clearance[t]);
}

/// How far the pelvis must sink in each frame for the held feet to be in reach; smooth in time, never less
/// than needed but for the limit.
std::vector<float> pelvis_drops(const Motion& motion, const Joints& rest, const std::vector<Foot>& feet,
                                float limit) {
  constexpr float kReach = 0.992f;  // share of the leg's length; beyond it the leg straightens softly
  const int count = motion.poses.size();
  std::vector<float> needed(motion.poses.size(), 0.0f), widest = needed, drops = needed;
  for (int t = 0; t < count; ++t)
    for (const Foot& foot : feet) {
      const size_t now = t;
      if (!foot.stands(t)) continue;
      const PosedSkeleton posed = forward_kinematics(rest, motion.poses[now]);
      const Vec3 hip = posed.joints.row(foot.leg.hip).transpose();
      const float reach = std::max(kReach * leg_length(rest), (foot.ankle[now] - hip).norm());
      const Vec3 to = foot.ankle[now] + foot.offset[now] - hip;
      const float flat = reach * reach - to.x() * to.x() - to.z() * to.z();
      needed[now] = std::clamp(-to.y() - std::sqrt(std::max(flat, 0.0f)), needed[now], limit);
    }
  const int w = std::max(1, static_cast<int>(std::lround(0.1f * motion.fps)));
  for (int t = 0; t < count; ++t)
    for (int k = -w; k <= w; ++k) widest[t] = std::max(widest[t], needed[std::clamp(t + k, 0, count - 1)]);
  for (int t = 0; t < count; ++t)
    for (int k = -w; k <= w; ++k)
      drops[t] += widest[std::clamp(t + k, 0, count - 1)] / static_cast<float>(2 * w + 1);
  return drops;
}

void find_contacts(Foot& foot, const PinEdit& edit, float leg_m, float fps) {
  foot.on_ball = contacts(foot.ball, foot.level, edit, leg_m, fps);
  foot.on_heel = contacts(foot.heel, foot.heel_level, edit, leg_m, fps);
}

/// Puts the whole body onto the floor by what its standing feet have over it as a rule, so that legs need not
/// stretch for it.
void settle(Motion& motion, std::vector<Foot>& feet, float limit) {
  std::vector<float> standing;
  for (const Foot& foot : feet)
    for (size_t t = 0; t < motion.poses.size(); ++t)
      if (foot.stands(t)) standing.push_back(foot.clearance[t]);
  if (standing.empty()) return;
  const float lift = std::clamp(-quantile(standing, 0.5f), -limit, limit);
  const Vec3 up(0, lift, 0);
  for (Pose& pose : motion.poses) pose.root += up;
  for (Foot& foot : feet)
    for (size_t t = 0; t < motion.poses.size(); ++t) {
      for (auto* points : {&foot.ankle, &foot.ball, &foot.heel}) (*points)[t] += up;
      foot.clearance[t] += lift;
    }
}

}  // namespace

void pin_feet(const PinEdit& edit, Motion& motion, const EditedBody& body) {
  if (motion.poses.empty()) return;
  const float leg_m = leg_length(body.rest);
  std::vector<Foot> feet = {observed(motion, body, 0), observed(motion, body, 1)};
  // A foot that is not to be pinned never stands.
  if (edit.left) find_contacts(feet[0], edit, leg_m, motion.fps);
  if (edit.right) find_contacts(feet[1], edit, leg_m, motion.fps);
  if (edit.to_floor) settle(motion, feet, kOnFloor * leg_m);
  for (Foot& foot : feet)
    if (foot.leg.hip == LeftHip ? edit.left : edit.right) find_offsets(foot, edit, leg_m, motion.fps);
  motion.standing.resize(motion.poses.size(), Standing{});
  for (size_t side = 0; side < feet.size(); ++side)
    for (size_t t = 0; (side == 0 ? edit.left : edit.right) && t < motion.poses.size(); ++t)
      motion.standing[t][side] = feet[side].stands(t);
  // A foot that is not pinned stays where it is when the pelvis sinks.
  const auto drops = pelvis_drops(motion, body.rest, feet, edit.max_drop_m * leg_m / 0.8f);
  for (size_t t = 0; t < motion.poses.size(); ++t) {
    motion.poses[t].root.y() -= drops[t];
    for (const Foot& foot : feet)
      place_ankle(body.rest, foot.leg.hip - LeftHip, foot.ankle[t] + foot.offset[t], motion.poses[t]);
  }
}

}  // namespace understudy
