#include "tests/retarget/motion/made_motion.hpp"

#include <sstream>

#include "retarget/math/rotation.hpp"

namespace understudy::tests {
namespace {

struct Writer {
  const MadeBvh& options;
  const Joints& rest;
  Mat3 axes = Mat3::Identity();  // from the program's to the file's
  std::ostringstream hierarchy = {};
  std::vector<int> order = {};  // joints as the file has them

  Vec3 in_file(const Vec3& v) const { return axes * v / options.unit; }
  void write_offset(const Vec3& v) {
    hierarchy << "OFFSET " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  }
  void write_joint(int j);
};

void Writer::write_joint(int j) {
  const int p = kParents[static_cast<size_t>(j)];
  order.push_back(j);
  hierarchy << (p < 0 ? "ROOT " : "JOINT ") << made_name(options.naming, j) << "\n{\n";
  const Vec3 from = p < 0 ? Vec3(Vec3::Zero()) : Vec3(rest.row(p).transpose());
  write_offset(p < 0 ? Vec3(Vec3::Zero()) : in_file(rest.row(j).transpose() - from));
  hierarchy << "CHANNELS " << (p < 0 ? "6 Xposition Yposition Zposition" : "3");
  for (const char axis : options.order) hierarchy << ' ' << axis << "rotation";
  hierarchy << '\n';
  bool leaf = true;
  for (int k = j + 1; k < kJointCount; ++k)
    if (kParents[static_cast<size_t>(k)] == j) {
      write_joint(k);
      leaf = false;
    }
  if (leaf) {
    hierarchy << "End Site\n{\n";
    const bool foot = j == LeftFoot || j == RightFoot;
    write_offset(in_file(foot ? Vec3(0, -0.02f, 0.08f) : 0.4f * (rest.row(j).transpose() - from)));
    hierarchy << "}\n";
  }
  hierarchy << "}\n";
}

}  // namespace

std::string made_bvh(const MadeBvh& options, const Joints& rest, const std::vector<Pose>& poses) {
  Writer writer{options, rest};
  const Mat3 to_z_up = rotation_from_axis_angle(Vec3(kPi / 2, 0, 0));
  if (options.z_up) writer.axes = to_z_up;
  writer.write_joint(Pelvis);
  std::ostringstream out;
  out << "HIERARCHY\n"
      << writer.hierarchy.str() << "MOTION\nFrames: " << poses.size() << "\nFrame Time: " << 1 / options.fps
      << '\n';
  for (const Pose& pose : poses) {
    Mat3 turn = writer.axes;  // of the whole, from the program's axes to those of the file's motion
    if (options.only_motion_z_up) turn = to_z_up;
    const Vec3 root = turn * pose.root / options.unit;
    out << root.x() << ' ' << root.y() << ' ' << root.z();
    for (const int j : writer.order) {
      const Mat3& A = writer.axes;
      Mat3 R = A * pose.local[static_cast<size_t>(j)] * A.transpose();
      if (j == Pelvis) R = turn * pose.local[Pelvis] * A.transpose();
      const auto axis = [&](size_t i) { return options.order[i] - 'X'; };
      const Vec3 angles = R.eulerAngles(axis(0), axis(1), axis(2)) * 180 / kPi;
      out << ' ' << angles[0] << ' ' << angles[1] << ' ' << angles[2];
    }
    out << '\n';
  }
  return out.str();
}

}  // namespace understudy::tests
