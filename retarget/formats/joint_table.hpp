// Joints over time as a table.
#pragma once

#include <string>

#include "retarget/base/part_file.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// CSV with a line a frame: frame (from 0), seconds, and x, y, z in metres of each joint: pelvis_x, pelvis_y,
/// pelvis_z, left_hip_x ... Lines go to the file as they come.
class JointTable {
 public:
  /// Throws Error when the file cannot be written.
  JointTable(const std::string& path, double fps);
  void push(const Joints& joints);
  void finish() { file_.finish(); }

 private:
  PartFile file_;
  double fps_;
  int64_t frames_ = 0;
};

}  // namespace understudy
