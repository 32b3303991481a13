#include "retarget/formats/joint_table.hpp"

#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {

JointTable::JointTable(const std::string& path, double fps) : file_(path), fps_(fps) {
  US_CHECK(fps > 0 && std::isfinite(fps), path, ": ", fps, " frames a second cannot be");
  std::string header = "frame,seconds";
  for (const char* joint : kJointNames)
    for (const char* axis : {"_x", "_y", "_z"}) header += std::string(",") + joint + axis;
  file_.write(header + '\n');
}

void JointTable::push(const Joints& joints) {
  US_CHECK(joints.allFinite(), file_.path(), ": a joint of frame ", frames_, " is not finite");
  std::string line = std::to_string(frames_) + ',';
  append_fixed(line, static_cast<double>(frames_) / fps_, 6);
  for (Eigen::Index i = 0; i < joints.size(); ++i) {
    line += ',';
    append_fixed(line, static_cast<double>(joints.data()[i]), 6);
  }
  file_.write(line + '\n');
  ++frames_;
}

}  // namespace understudy
