// The clips' poses at any moment, also between frames.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "retarget/body/clips.hpp"

namespace understudy::training {

constexpr float kClipRate = 30;  ///< frames/s of the clips

class ClipPoses {
 public:
  explicit ClipPoses(const std::vector<Clip>& clips);

  /// At `frame`, from 0 to the clip's last frame. Between frames a straight line will do, and is much faster
  /// than slerp.
  Pose at(int clip, float frame) const;

 private:
  struct Frame {
    std::array<Eigen::Quaternionf, kJointCount> local;
    Vec3 root;
  };
  std::vector<std::vector<Frame>> clips_;
};

}  // namespace understudy::training
