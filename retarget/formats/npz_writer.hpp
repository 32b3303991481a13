// NumPy archives that grow frame by frame: the whole never lies in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "retarget/base/part_file.hpp"

namespace understudy {

/// Frames go to files beside the path; finish() packs them and renames. Without finish() nothing is left
/// behind.
class NpzWriter {
 public:
  explicit NpzWriter(const std::string& path) : path_(path) {}
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;

  /// An array [frames, ...] of float32 with frames of this shape; its number for push(). Throws Error when
  /// the folder cannot be written.
  size_t add_frames(const std::string& name, const std::vector<int64_t>& frame_shape);
  /// One frame of it. Throws Error when the disk is full.
  void push(size_t array, const float* values);
  /// Whole arrays, float64; no shape: a scalar.
  void add(const std::string& name, const std::vector<int64_t>& shape, const std::vector<double>& values);
  void add(const std::string& name, const std::string& text);
  /// Throws Error when the archive cannot be written.
  void finish();

 private:
  struct Array {
    std::string name;
    std::vector<int64_t> frame_shape;
    int64_t frame_size = 1, frames = 0;
    std::unique_ptr<PartFile> file;  // none: a whole one
    std::string bytes;               // of that
  };

  std::string path_;
  std::vector<Array> arrays_;
};

}  // namespace understudy
