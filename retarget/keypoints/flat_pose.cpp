#include "retarget/keypoints/flat_pose.hpp"

#include <algorithm>

namespace understudy {
namespace {

bool same_points(const FlatPoints& a, const FlatPoints& b) {
  return a.rows() == b.rows() && a == b;
}

bool any_seen(const FlatPoints& points) {
  return points.rows() > 0 && points.col(2).maxCoeff() > 0;
}

void add_middle(FlatPose& pose, int middle, int one, int other) {
  if (pose.has(middle) || !pose.has(one) || !pose.has(other)) return;
  pose.set(middle, (pose.at(one) + pose.at(other)) / 2,
           std::min(pose.confidence(one), pose.confidence(other)));
}

/// Where it is seen, else the middle of the two; false when that is not seen either.
bool middle_of(const FlatPose& pose, int middle, int one, int other, Vec2& place) {
  if (pose.has(one) && pose.has(other))
    place = (pose.at(one) + pose.at(other)) / 2;
  else if (pose.has(middle))
    place = pose.at(middle);
  else
    return false;
  return true;
}

}  // namespace

const std::array<const char*, kBodyPoints> kBodyPointNames = {
    "nose",           "neck",        "right_shoulder", "right_elbow",     "right_wrist",
    "left_shoulder",  "left_elbow",  "left_wrist",     "mid_hip",         "right_hip",
    "right_knee",     "right_ankle", "left_hip",       "left_knee",       "left_ankle",
    "right_eye",      "left_eye",    "right_ear",      "left_ear",        "left_big_toe",
    "left_small_toe", "left_heel",   "right_big_toe",  "right_small_toe", "right_heel"};

int body_point_named(std::string_view name) {
  const auto found = std::find(kBodyPointNames.begin(), kBodyPointNames.end(), name);
  return found == kBodyPointNames.end() ? -1 : static_cast<int>(found - kBodyPointNames.begin());
}

bool operator==(const FlatPose& a, const FlatPose& b) {
  return a.body == b.body && same_points(a.left_hand, b.left_hand) &&
         same_points(a.right_hand, b.right_hand) && same_points(a.face, b.face);
}

int points_seen(const FlatPose& pose) {
  return static_cast<int>((pose.body.col(2).array() > 0).count());
}

bool is_nobody(const FlatPose& pose) {
  return points_seen(pose) == 0 && !any_seen(pose.left_hand) && !any_seen(pose.right_hand) &&
         !any_seen(pose.face);
}

FlatBox box_of(const FlatPose& pose) {
  FlatBox box;
  for (int p = 0; p < kBodyPoints; ++p)
    if (pose.has(p)) box.extend(pose.at(p));
  return box;
}

float size_of(const FlatPose& pose) {
  const FlatBox box = box_of(pose);
  if (box.isEmpty()) return 0;
  using namespace body25;
  Vec2 neck, hip;
  const bool has_trunk = middle_of(pose, Neck, LeftShoulder, RightShoulder, neck) &&
                         middle_of(pose, MidHip, LeftHip, RightHip, hip);
  return std::max(box.diagonal().norm(), has_trunk ? 3 * (neck - hip).norm() : 0);
}

FlatPose sides_exchanged(const FlatPose& pose) {
  FlatPose out;
  for (int p = 0; p < kBodyPoints; ++p) out.body.row(p) = pose.body.row(kBodyMirror[p]);
  out.left_hand = pose.right_hand;
  out.right_hand = pose.left_hand;
  out.face = pose.face;
  return out;
}

FlatPose in_mirror(const FlatPose& pose) {
  FlatPose out = sides_exchanged(pose);
  out.body.col(0) *= -1;
  for (FlatPoints* points : {&out.left_hand, &out.right_hand, &out.face}) points->col(0) *= -1;
  return out;
}

void add_middles(FlatPose& pose) {
  using namespace body25;
  add_middle(pose, Neck, LeftShoulder, RightShoulder);
  add_middle(pose, MidHip, LeftHip, RightHip);
}

}  // namespace understudy
