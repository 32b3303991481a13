// The same done to every place of a pose.
#pragma once

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

/// change: Vec2 -> Vec2, of each point of body, hands and face that is not missing; confidences stay.
template <class Change>
void change_points(FlatPose& pose, const Change& change) {
  for (int point = 0; point < kBodyPoints; ++point)
    if (pose.has(point)) pose.set(point, change(pose.at(point)), pose.confidence(point));
  for (FlatPoints* points : {&pose.left_hand, &pose.right_hand, &pose.face})
    for (Eigen::Index i = 0; i < points->rows(); ++i)
      if ((*points)(i, 2) > 0)
        points->row(i).head<2>() = change(Vec2(points->row(i).head<2>().transpose())).transpose();
}

}  // namespace understudy
