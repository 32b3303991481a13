#include "retarget/formats/bvh_writer.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy {
namespace {

constexpr double kCentimetres = 100;
constexpr size_t kCountWidth = 10;

using Angles = std::array<double, 3>;  // about z, x, y; degrees

/// R = Rz Rx Ry.
Angles zxy_angles(const Eigen::Matrix3d& R) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;
  const double sine = std::clamp(R(2, 1), -1.0, 1.0);
  if (std::abs(sine) > 1 - 1e-9)  // z and y turn about one axis: y may stay
    return {std::atan2(R(1, 0), R(0, 0)) * kDegrees, std::asin(sine) * kDegrees, 0};
  return {std::atan2(-R(0, 1), R(1, 1)) * kDegrees, std::asin(sine) * kDegrees,
          std::atan2(-R(2, 0), R(2, 2)) * kDegrees};
}

/// The same angles, whole turns added so that they are next to those before.
Angles unwound(Angles angles, const Angles& before) {
  for (size_t i = 0; i < 3; ++i) angles[i] = before[i] + std::remainder(angles[i] - before[i], 360.0);
  return angles;
}

double distance(const Angles& a, const Angles& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

/// Of the two triples of angles that are one rotation, the one nearer to those before.
Angles nearest_angles(const Eigen::Matrix3d& R, const Angles& before) {
  const Angles one = zxy_angles(R);
  const Angles first = unwound(one, before);
  const Angles second = unwound({one[0] + 180, 180 - one[1], one[2] + 180}, before);
  return distance(first, before) <= distance(second, before) ? first : second;
}

void append_offset(std::string& out, const std::string& indent, const Vec3& metres) {
  out += indent + "OFFSET";
  for (int axis = 0; axis < 3; ++axis) {
    out += ' ';
    append_fixed(out, kCentimetres * static_cast<double>(metres[axis]), 5);
  }
  out += '\n';
}

void append_joint(std::string& out, const Joints& rest, int joint, int depth) {
  const std::string indent(static_cast<size_t>(2 * depth), ' '), inside = indent + "  ";
  const int parent = kParents[joint];
  out += indent + (parent < 0 ? "ROOT " : "JOINT ") + kJointNames[joint] + '\n' + indent + "{\n";
  const Vec3 offset =
      parent < 0 ? Vec3(Vec3::Zero()) : Vec3((rest.row(joint) - rest.row(parent)).transpose());
  append_offset(out, inside, offset);
  out += inside + (parent < 0 ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                              : "CHANNELS 3 Zrotation Xrotation Yrotation\n");
  bool has_child = false;
  for (int child = joint + 1; child < kJointCount; ++child)
    if (kParents[child] == joint) {
      append_joint(out, rest, child, depth + 1);
      has_child = true;
    }
  if (!has_child) {  // half as long as the bone before
    out += inside + "End Site\n" + inside + "{\n";
    append_offset(out, inside + "  ", 0.5f * offset);
    out += inside + "}\n";
  }
  out += indent + "}\n";
}

/// Joints in the order in which the file names them: depth first.
std::vector<size_t> file_order(int joint = Pelvis) {
  std::vector<size_t> order = {static_cast<size_t>(joint)};
  for (int child = joint + 1; child < kJointCount; ++child)
    if (kParents[child] == joint)
      for (const size_t below : file_order(child)) order.push_back(below);
  return order;
}

std::string count_text(int64_t frames) {
  const std::string digits = std::to_string(frames);
  return std::string(kCountWidth - std::min(kCountWidth, digits.size()), ' ') + digits;
}

}  // namespace

BvhWriter::BvhWriter(const std::string& path, const Joints& rest, double fps) : file_(path) {
  US_CHECK(rest.allFinite(), path, ": a joint of the target is not finite");
  US_CHECK(fps > 0 && std::isfinite(fps), path, ": ", fps, " frames a second cannot be");
  std::string head = "HIERARCHY\n";
  append_joint(head, rest, Pelvis, 0);
  head += "MOTION\nFrames: ";
  count_at_ = head.size();
  head += count_text(0) + "\nFrame Time: ";
  append_fixed(head, 1 / fps, 8);
  file_.write(head + '\n');
}

void BvhWriter::push(const Pose& pose) {
  static const std::vector<size_t> order = file_order();
  bool finite = pose.root.allFinite();
  for (const Mat3& R : pose.local) finite = finite && R.allFinite();
  US_CHECK(finite, file_.path(), ": the pose of frame ", frames_, " is not finite");
  std::string line;
  for (int axis = 0; axis < 3; ++axis) {
    append_fixed(line, kCentimetres * static_cast<double>(pose.root[axis]), 5);
    line += ' ';
  }
  for (const size_t j : order) {
    before_[j] = nearest_angles(pose.local[j].cast<double>(), before_[j]);
    for (const double angle : before_[j]) {
      append_fixed(line, angle, 5);
      line += ' ';
    }
  }
  line.back() = '\n';
  file_.write(line);
  ++frames_;
}

void BvhWriter::finish() {
  file_.rewrite(count_at_, count_text(frames_));
  file_.finish();
}

}  // namespace understudy
