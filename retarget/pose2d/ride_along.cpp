#include "retarget/pose2d/ride_along.hpp"

namespace understudy {
namespace {

/// About a point that both poses have, as in the source, so many times as far.
class Rider {
 public:
  Rider(const FlatPose& source, FlatPose& pose, int anchor, float ratio)
      : source_(source), pose_(pose), anchor_(anchor), ratio_(ratio) {}

  void take(int point) const {
    if (source_.has(point) && is_held())
      pose_.set(point, there(source_.at(point)), source_.confidence(point));
  }
  void take_all(FlatPoints FlatPose::*part) const {
    FlatPoints& points = pose_.*part;
    points = source_.*part;
    if (!is_held()) points.setZero();
    for (Eigen::Index i = 0; i < points.rows(); ++i)
      if (points(i, 2) > 0) points.row(i).head<2>() = there(points.row(i).head<2>().transpose()).transpose();
  }

 private:
  bool is_held() const { return source_.has(anchor_) && pose_.has(anchor_); }
  Vec2 there(const Vec2& at) const { return pose_.at(anchor_) + ratio_ * (at - source_.at(anchor_)); }

  const FlatPose& source_;
  FlatPose& pose_;
  int anchor_;
  float ratio_;
};

}  // namespace

void ride_along(const FlatPose& source, const BoneLengths& ratio, FlatPose& pose) {
  const Rider head(source, pose, source.has(body25::Nose) ? body25::Nose : body25::Neck,
                   ratio[flat_bone::Head]);
  for (const int point : {body25::RightEye, body25::LeftEye, body25::RightEar, body25::LeftEar})
    head.take(point);
  head.take_all(&FlatPose::face);
  const Rider right(source, pose, body25::RightAnkle,
                    (ratio[flat_bone::RightThigh] + ratio[flat_bone::RightShin]) / 2),
      left(source, pose, body25::LeftAnkle, (ratio[flat_bone::LeftThigh] + ratio[flat_bone::LeftShin]) / 2);
  for (const int point : {body25::RightBigToe, body25::RightSmallToe, body25::RightHeel}) right.take(point);
  for (const int point : {body25::LeftBigToe, body25::LeftSmallToe, body25::LeftHeel}) left.take(point);
  Rider(source, pose, body25::RightWrist, ratio[flat_bone::RightForearm]).take_all(&FlatPose::right_hand);
  Rider(source, pose, body25::LeftWrist, ratio[flat_bone::LeftForearm]).take_all(&FlatPose::left_hand);
}

}  // namespace understudy
