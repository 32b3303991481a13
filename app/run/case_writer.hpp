// What all suites' cases are written with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "retarget/base/numpy_random.hpp"
#include "retarget/body/exact_body.hpp"
#include "retarget/formats/npz.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy::app {

/// [T, shape...] of matrices, one a frame.
template <class Frames>
NpyArray frames_array(const Frames& frames, std::vector<int64_t> shape) {
  NpyArray array;
  array.shape = std::move(shape);
  array.shape.insert(array.shape.begin(), static_cast<int64_t>(frames.size()));
  for (const auto& frame : frames)
    for (Eigen::Index i = 0; i < frame.size(); ++i)
      array.values.push_back(static_cast<float>(frame.data()[i]));
  return array;
}

/// [T, 22, 3, 3] of rotations of either precision.
template <class Turns>
NpyArray rotations_array(const std::vector<Turns>& frames) {
  NpyArray array;
  array.shape = {static_cast<int64_t>(frames.size()), kJointCount, 3, 3};
  for (const Turns& frame : frames)
    for (const auto& R : frame)
      for (int k = 0; k < 9; ++k) array.values.push_back(static_cast<float>(R(k / 3, k % 3)));
  return array;
}

/// An empty folder for a case's scans. One made before may have had more frames.
void make_scan_folder(const std::filesystem::path& folder);
/// FOLDER/frame_00000.ply ...
void write_scan(const std::filesystem::path& folder, size_t frame, const Points& points);

/// The person's T-pose as an OBJ file.
void write_target(const std::string& path, const ExactPerson& person);

/// Points drawn evenly on a surface. Throws Error where it has no area.
Points64 points_on_surface(NumpyRandom& random, const Points64& vertices, const Faces& faces, int64_t count);

/// Of a case's random numbers.
uint64_t case_seed(const std::string& name, uint64_t seed = 0);

}  // namespace understudy::app
