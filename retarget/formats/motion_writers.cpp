#include "retarget/formats/motion_writers.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/math/rotation.hpp"

namespace understudy {
namespace {

void check_rate(double fps, const std::string& path) {
  US_CHECK(fps > 0 && std::isfinite(fps), path, ": ", fps, " frames a second are not possible");
}

void check_pose(const Pose& pose, int64_t frame, const std::string& path) {
  const bool finite = pose.root.allFinite() && std::all_of(pose.local.begin(), pose.local.end(),
                                                           [](const Mat3& R) { return R.allFinite(); });
  US_CHECK(finite, path, ": the pose of frame ", frame, " is not finite");
}

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
  for (int axis = 0; axis < 3; ++axis)
    append_fixed(out += ' ', kCentimetres * static_cast<double>(metres[axis]), 5);
  out += '\n';
}

/// A joint and those below it; `order` gets their numbers as the file names them: depth first.
void append_joint(std::string& out, const std::vector<BvhJoint>& joints, size_t joint, size_t depth,
                  std::vector<size_t>& order) {
  order.push_back(joint);
  const std::string indent(2 * depth, ' '), inside = indent + "  ";
  const BvhJoint& one = joints[joint];
  out += indent + (one.parent < 0 ? "ROOT " : "JOINT ") + one.name + '\n' + indent + "{\n";
  const Vec3 offset = one.parent < 0 ? Vec3(Vec3::Zero()) : Vec3(one.rest - joints[one.parent].rest);
  append_offset(out, inside, offset);
  out += inside + (one.moves ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
                             : "CHANNELS 3 Zrotation Xrotation Yrotation\n");
  bool has_child = false;
  for (size_t child = joint + 1; child < joints.size(); ++child)
    if (joints[child].parent == static_cast<int>(joint)) {
      append_joint(out, joints, child, depth + 1, order);
      has_child = true;
    }
  if (!has_child) {
    out += inside + "End Site\n" + inside + "{\n";
    append_offset(out, inside + "  ", one.end.isZero() ? Vec3(0.5f * offset) : one.end);
    out += inside + "}\n";
  }
  out += indent + "}\n";
}

std::vector<BvhJoint> joints_of(const Joints& rest, const std::string& path) {
  US_CHECK(rest.allFinite(), path, ": a joint of the target is not finite");
  std::vector<BvhJoint> joints;
  joints.reserve(kJointCount);
  for (int j = 0; j < kJointCount; ++j)
    joints.push_back({kJointNames[j], kParents[j], rest.row(j).transpose(), false});
  return joints;
}

std::string count_text(int64_t frames) {
  const std::string digits = std::to_string(frames);
  return std::string(kCountWidth - std::min(kCountWidth, digits.size()), ' ') + digits;
}

constexpr size_t kPoseWidth = 156;  // 52 joints: the 22, and 15 of each hand
constexpr int64_t kBetas = 16;
enum AmassArray : size_t { Poses, Trans };

/// y up to z up: x stays.
Mat3 to_z_up() {
  Mat3 C;
  C << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return C;
}

enum ResultArray : size_t { Vertices, JointsArray, RotationsArray, SourceJoints };

}  // namespace

std::string bvh_word(const std::string& name, size_t number, std::set<std::string>& taken) {
  std::string word = name.empty() ? "bone_" + std::to_string(number) : name;
  for (char& c : word)
    if (static_cast<unsigned char>(c) <= 32 || c == '{' || c == '}') c = '_';
  std::string free = word;
  for (int i = 2; !taken.insert(free).second; ++i) free = word + "_" + std::to_string(i);
  return free;
}

BvhWriter::BvhWriter(const std::string& path, const Joints& rest, double fps)
    : BvhWriter(path, joints_of(rest, path), fps) {}

BvhWriter::BvhWriter(const std::string& path, std::vector<BvhJoint> joints, double fps)
    : file_(path), joints_(std::move(joints)), before_(joints_.size(), {0, 0, 0}) {
  US_CHECK(!joints_.empty(), path, ": there is no bone to write");
  check_rate(fps, path);
  std::string head = "HIERARCHY\n";
  for (BvhJoint& joint : joints_) joint.moves = joint.moves || joint.parent < 0;
  for (size_t j = 0; j < joints_.size(); ++j)
    if (joints_[j].parent < 0) append_joint(head, joints_, j, 0, order_);
  head += "MOTION\nFrames: ";
  count_at_ = head.size();
  head += count_text(0) + "\nFrame Time: ";
  append_fixed(head, 1 / fps, 8);
  file_.write(head + '\n');
}

void BvhWriter::push(const Pose& pose) {
  check_pose(pose, frames_, file_.path());
  Points places = Points::Zero(kJointCount, 3);
  places.row(Pelvis) = pose.root.transpose();
  push({pose.local.begin(), pose.local.end()}, places);
}

void BvhWriter::push(const std::vector<Mat3>& local, const Points& places) {
  const bool finite = places.allFinite() &&
                      std::all_of(local.begin(), local.end(), [](const Mat3& R) { return R.allFinite(); });
  US_CHECK(finite, file_.path(), ": the pose of frame ", frames_, " is not finite");
  US_CHECK(local.size() == joints_.size() && places.rows() == static_cast<Eigen::Index>(local.size()),
           file_.path(), ": frame ", frames_, " has ", local.size(), " bones, not ", joints_.size());
  std::string line;
  for (const size_t j : order_) {
    for (int axis = 0; joints_[j].moves && axis < 3; ++axis)
      append_fixed(line += ' ',
                   kCentimetres * static_cast<double>(places(static_cast<Eigen::Index>(j), axis)), 5);
    before_[j] = nearest_angles(local[j].cast<double>(), before_[j]);
    for (const double angle : before_[j]) append_fixed(line += ' ', angle, 5);
  }
  file_.write(line.substr(1) + '\n');
  ++frames_;
}

void BvhWriter::finish() {
  file_.rewrite(count_at_, count_text(frames_));
  file_.finish();
}

AmassWriter::AmassWriter(const std::string& path, double fps) : path_(path), npz_(path) {
  check_rate(fps, path);
  npz_.add_frames("poses", {static_cast<int64_t>(kPoseWidth)});
  npz_.add_frames("trans", {3});
  npz_.add("betas", {kBetas}, std::vector<double>(kBetas, 0.0));
  npz_.add("gender", "neutral");
  npz_.add("mocap_framerate", {}, {fps});
}

void AmassWriter::push(const Pose& pose) {
  check_pose(pose, frames_, path_);
  std::array<float, kPoseWidth> angles{};
  for (size_t j = 0; j < kJointCount; ++j) {
    // The world turns, and with it the pelvis; all other joints turn relative to their parents.
    const Mat3 R = j == Pelvis ? Mat3(to_z_up() * pose.local[j]) : pose.local[j];
    const Vec3 turn = rotation_to_axis_angle(R);
    std::copy(turn.data(), turn.data() + 3, angles.data() + 3 * j);
  }
  const Vec3 place = to_z_up() * pose.root;
  npz_.push(Poses, angles.data());
  npz_.push(Trans, place.data());
  ++frames_;
}

JointTable::JointTable(const std::string& path, double fps) : file_(path), fps_(fps) {
  check_rate(fps, path);
  std::string header = "frame,seconds";
  for (const char* joint : kJointNames)
    for (const char* axis : {"_x", "_y", "_z"}) header += std::string(",") + joint + axis;
  file_.write(header + '\n');
}

void JointTable::push(const Joints& joints) {
  US_CHECK(joints.allFinite(), file_.path(), ": a joint of frame ", frames_, " is not finite");
  std::string line = std::to_string(frames_) + ',';
  append_fixed(line, static_cast<double>(frames_) / fps_, 6);
  for (Eigen::Index i = 0; i < joints.size(); ++i)
    append_fixed(line += ',', static_cast<double>(joints.data()[i]), 6);
  file_.write(line + '\n');
  ++frames_;
}

ResultWriter::ResultWriter(const std::string& path, int64_t vertex_count)
    : path_(path), vertex_count_(vertex_count), npz_(path) {
  npz_.add_frames("vertices", {vertex_count, 3});
  npz_.add_frames("joints", {kJointCount, 3});
  npz_.add_frames("rotations", {kJointCount, 3, 3});
  npz_.add_frames("source_joints", {kJointCount, 3});
}

void ResultWriter::push(const Points& vertices, const Joints& joints, const Rotations& local,
                        const Joints& source_joints) {
  US_CHECK(vertices.rows() == vertex_count_, path_, ": a frame has ", vertices.rows(),
           " vertices, the first had ", vertex_count_);
  std::array<float, kJointCount * 9> rotations;
  for (size_t j = 0; j < kJointCount; ++j)
    for (int i = 0; i < 9; ++i) rotations[9 * j + i] = local[j](i / 3, i % 3);
  npz_.push(Vertices, vertices.data());
  npz_.push(JointsArray, joints.data());
  npz_.push(RotationsArray, rotations.data());
  npz_.push(SourceJoints, source_joints.data());
}

void ResultWriter::finish(const Eigen::Matrix4d& source_to_scan) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = source_to_scan;
  npz_.add("source_to_scan", {4, 4}, {rows.data(), rows.data() + rows.size()});
  npz_.finish();
}

}  // namespace understudy
