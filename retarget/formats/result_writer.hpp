// A retargeting result as a .npz, written frame by frame: the whole never lies in memory.
#pragma once

#include "retarget/formats/npz_writer.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Writes vertices [T, V, 3], joints [T, 22, 3], rotations [T, 22, 3, 3] (local) and source_joints [T, 22,
/// 3], float32, and source_to_scan [4, 4], float64. Without finish() nothing is left behind.
class ResultWriter {
 public:
  /// Throws Error when the folder cannot be written.
  ResultWriter(const std::string& path, int64_t vertex_count);

  /// Throws Error when the number of vertices changes or the disk is full.
  void push(const Points& vertices, const Joints& joints, const Rotations& local,
            const Joints& source_joints);
  /// source_to_scan takes source_joints to the coordinates of the source's file. Throws Error when the archive
  /// cannot be written.
  void finish(const Eigen::Matrix4d& source_to_scan = Eigen::Matrix4d::Identity());

 private:
  std::string path_;
  int64_t vertex_count_;
  NpzWriter npz_;
};

}  // namespace understudy
