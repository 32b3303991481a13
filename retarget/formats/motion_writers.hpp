// Motions as files that are written frame by frame: Biovision, AMASS, a table of joints, a result.
#pragma once

#include <array>
#include <set>
#include <string>
#include <vector>

#include "retarget/base/part_file.hpp"
#include "retarget/formats/npz_writer.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

// All of them throw Error when the file cannot be written or the disk is full, those of poses and joints also
// when a number is not finite. Frames go to files as they come; without finish() nothing is left behind.

/// A joint of a BVH file.
struct BvhJoint {
  std::string name;          ///< without blanks
  int parent = -1;           ///< comes before; below 0: a root
  Vec3 rest = Vec3::Zero();  ///< in the world where all angles are zero, metres
  bool moves = false;        ///< has a position in each frame, as roots have; else it stays on its parent
  /// Of one that carries no other where it ends, seen from it at rest; zero: half as long as the bone before.
  Vec3 end = Vec3::Zero();
};
/// A bone's name as a word of a BVH file, unlike those taken, which it joins.
std::string bvh_word(const std::string& name, size_t number, std::set<std::string>& taken);

/// BVH: centimetres, y up; positions X Y Z of roots and of what moves, in place of the offset, and rotations,
/// Z X Y in degrees, unwound so that curves have no jumps.
class BvhWriter {
 public:
  /// The 22 joints, in the T-pose where all angles are zero; the pelvis has position and rotation, the others
  /// rotation. rest: T-pose joints, metres.
  BvhWriter(const std::string& path, const Joints& rest, double fps);
  /// Others. Throws Error where there is none.
  BvhWriter(const std::string& path, std::vector<BvhJoint> joints, double fps);
  void push(const Pose& pose);  ///< of the 22
  /// local [J]: turned from the rest about the parent's axes; places [J, 3] on the parent, in its axes, of
  /// roots in the world, metres, used of what moves.
  void push(const std::vector<Mat3>& local, const Points& places);
  void finish();

 private:
  PartFile file_;
  size_t count_at_ = 0;  // where the number of frames is
  int64_t frames_ = 0;
  std::vector<BvhJoint> joints_;
  std::vector<size_t> order_;                  // joints as the file names them
  std::vector<std::array<double, 3>> before_;  // degrees
};

/// A .npz as the AMASS data set has them: poses [T, 156] axis-angle (22 body joints, hands at rest), trans
/// [T, 3] of the pelvis, betas [16] zero, gender "neutral", mocap_framerate. z up.
class AmassWriter {
 public:
  AmassWriter(const std::string& path, double fps);
  void push(const Pose& pose);
  void finish() { npz_.finish(); }

 private:
  std::string path_;
  NpzWriter npz_;
  int64_t frames_ = 0;
};

/// CSV with a line a frame: frame (from 0), seconds, and x, y, z in metres of each joint: pelvis_x, pelvis_y,
/// pelvis_z, left_hip_x ...
class JointTable {
 public:
  JointTable(const std::string& path, double fps);
  void push(const Joints& joints);
  void finish() { file_.finish(); }

 private:
  PartFile file_;
  double fps_;
  int64_t frames_ = 0;
};

/// A .npz of vertices [T, V, 3], joints [T, 22, 3], rotations [T, 22, 3, 3] (local) and source_joints [T, 22,
/// 3], float32, and source_to_scan [4, 4], float64.
class ResultWriter {
 public:
  ResultWriter(const std::string& path, int64_t vertex_count);

  /// Throws Error when the number of vertices changes.
  void push(const Points& vertices, const Joints& joints, const Rotations& local,
            const Joints& source_joints);
  /// source_to_scan takes source_joints to the coordinates of the source's file.
  void finish(const Eigen::Matrix4d& source_to_scan = Eigen::Matrix4d::Identity());

 private:
  std::string path_;
  int64_t vertex_count_;
  NpzWriter npz_;
};

}  // namespace understudy
