#include "retarget/pose2d/lift_transfer.hpp"

#include <algorithm>
#include <utility>

#include "retarget/base/error.hpp"
#include "retarget/pose2d/body_view.hpp"
#include "retarget/pose2d/lift_truth.hpp"
#include "retarget/pose2d/touches.hpp"

namespace understudy {
namespace {

constexpr float kPale = 0.3f;  // most confidence of what is made up
constexpr int kFewestToLift = 3;

/// From so far away that every ray is parallel.
LiftView from_afar() {
  LiftView view;
  view.canvas = {1000, 1000};
  view.fov_deg = 1;
  view.pitch_deg = 0;
  return view;
}

/// A point of the first 15, lifted. The nose sits before the head's joint.
Vec3 lifted_point(const Extraction& lifted, int point) {
  const auto at = [&](int joint) { return Vec3(lifted.joints.row(joint).transpose()); };
  if (point == body25::MidHip) return hips_middle(lifted.joints);
  if (point == body25::Neck) return (at(LeftShoulder) + at(RightShoulder)) / 2;
  if (point != body25::Nose) return at(kJointOfPoint[static_cast<size_t>(point)]);
  const float neck = (at(Head) - at(Neck)).norm();
  const Vec3 before = lifted.global ? Vec3((*lifted.global)[Head].col(2)) : Vec3(Vec3::Zero());
  return at(Head) + neck * before;
}

/// Points that go with one of the first 15.
void carry(int point, const Vec2& way, FlatPose& pose) {
  const auto move = [&](int first, int last) {
    for (int p = first; p <= last; ++p)
      if (pose.has(p)) pose.set(p, pose.at(p) + way, pose.confidence(p));
  };
  const auto move_all = [&](FlatPoints& points) {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      if (points(i, 2) > 0) points.row(i).head<2>() += way.transpose();
  };
  if (point == body25::Nose) move(body25::RightEye, body25::LeftEar), move_all(pose.face);
  if (point == body25::LeftAnkle) move(body25::LeftBigToe, body25::LeftHeel);
  if (point == body25::RightAnkle) move(body25::RightBigToe, body25::RightHeel);
  if (point == body25::LeftWrist) move_all(pose.left_hand);
  if (point == body25::RightWrist) move_all(pose.right_hand);
}

}  // namespace

LiftTransfer::LiftTransfer(std::unique_ptr<Lifter> lifter, bool touches, float dt)
    : lifter_(std::move(lifter)), limbs_(false), touches_(touches), dt_(dt) {
  US_CHECK(lifter_, "the engine lift has no lifter");
  lifter_->reset(from_afar());
}

FlatPose LiftTransfer::transfer(const FlatPose& seen, const Proportions& from, const Proportions& to) {
  FlatPose source = seen;
  add_middles(source);
  FlatPose result = limbs_.transfer(source, from, to);
  const bool has_middle = result.has(body25::MidHip) || result.has(body25::Neck);
  const auto points = (source.body.col(2).head<kPaperPoints>().array() > 0).count();
  if (points >= kFewestToLift && has_middle && source.body.allFinite()) {
    const Extraction lifted = lifter_->push(source, dt_);
    std::array<Vec2, kPaperPoints> places;  // around the mid-hip, pixels
    places[body25::MidHip] = Vec2::Zero();
    for (int b = 0; b < kFlatBoneCount; ++b) {
      const FlatBone& bone = kFlatBones[static_cast<size_t>(b)];
      const Vec3 way = (lifted_point(lifted, bone.to) - lifted_point(lifted, bone.from)).normalized();
      places[static_cast<size_t>(bone.to)] =
          places[static_cast<size_t>(bone.from)] + to.length[b] * Vec2(way.x(), -way.y());
    }
    const int kept = result.has(body25::MidHip) ? body25::MidHip : body25::Neck;
    const Vec2 middle = result.at(kept) - places[static_cast<size_t>(kept)];
    for (int p = 0; p < kPaperPoints; ++p) {
      const Vec2 place = middle + places[static_cast<size_t>(p)];
      const float made_up = std::min(kPale, lifted.confidence[kJointOfPoint[static_cast<size_t>(p)]]);
      if (result.has(p)) carry(p, place - result.at(p), result);
      result.set(p, place, source.has(p) ? source.confidence(p) : std::max(made_up, 0.01f));
    }
  }
  if (touches_) keep_touches(source, from.length, to.length, result);
  return result;
}

}  // namespace understudy
