// A motion as the AMASS data set keeps them.
#pragma once

#include "retarget/formats/npz_writer.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// poses [T, 156] axis-angle (22 body joints, hands at rest), trans [T, 3] of the pelvis, betas [16] zero,
/// gender "neutral", mocap_framerate. z up, as AMASS has it. Frames go to a file as they come.
class AmassWriter {
 public:
  /// Throws Error when the folder cannot be written.
  AmassWriter(const std::string& path, double fps);
  /// Throws Error for a pose that is not finite, or when the disk is full.
  void push(const Pose& pose);
  void finish() { npz_.finish(); }

 private:
  std::string path_;
  NpzWriter npz_;
  int64_t frames_ = 0;
};

}  // namespace understudy
