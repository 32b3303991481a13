// A retargeting result as a .npz, written frame by frame: the whole never lies in memory.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <string>

#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Writes vertices [T, V, 3], joints [T, 22, 3], rotations [T, 22, 3, 3] (local) and source_joints [T, 22,
/// 3], float32. Frames go to files beside the path; finish() packs them and renames. Without finish() nothing
/// is left behind.
class ResultWriter {
 public:
  /// Throws Error when the folder cannot be written.
  ResultWriter(const std::string& path, int64_t vertex_count);
  ~ResultWriter();
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;

  /// Throws Error when the number of vertices changes or the disk is full.
  void push(const Points& vertices, const Joints& joints, const Rotations& local,
            const Joints& source_joints);
  /// Throws Error when the archive cannot be written.
  void finish();

 private:
  struct Array {
    std::string name, shape;  // shape of one frame, after "T, "
    std::ofstream file;
  };
  std::string part_path(const Array& array) const;
  void write(Array& array, const float* values, int64_t count);

  std::string path_;
  int64_t vertex_count_, frames_ = 0;
  std::array<Array, 4> arrays_;
};

}  // namespace understudy
