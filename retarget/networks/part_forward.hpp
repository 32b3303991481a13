// The forward pass of the part refiner's networks without LibTorch: what nn/modules/part_refiner computes, to
// rounding.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/networks/kernels/kernels.hpp"
#include "retarget/networks/part_crops.hpp"

namespace understudy::nn {

constexpr int kPartVersion = 2;
constexpr const char* kPartFileKind = "leaf";  ///< as its files have it
/// How the names of their tensors begin, in the order of PartKind.
constexpr std::array<const char*, kPartKinds> kPartNames = {"hand", "skull", "foot", "arm", "leg"};
/// Outputs for a joint: its rotation in the crop's frame as 6D, its displacement from where it was extracted,
/// and the log of the expected error of that, both in leg lengths.
constexpr int kPartNumbers = 10;

/// Of the joints that a crop corrects.
using PartOutput = Eigen::Matrix<float, kPartJoints, kPartNumbers, Eigen::RowMajor>;

class PartForward {
 public:
  /// Throws Error naming the file when it is missing, damaged, or of another network or version.
  explicit PartForward(const std::string& path, const Kernels& with = kernels());
  ~PartForward();
  /// Crops of one kind. One thread at a time. Keeps its buffers between calls.
  std::vector<PartOutput> run(PartKind kind, const std::vector<PartCrop>& crops);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::nn
