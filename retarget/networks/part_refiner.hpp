// The part refiner: a second look at limbs and head.
#pragma once

#include <memory>
#include <string>

#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

/// Refines joints and rotations of limbs and head on part crops: of the whole body's 1,024 points a hand gets
/// about twenty.
class PartRefiner {
 public:
  virtual ~PartRefiner() = default;
  /// Corrects rotations, places and confidences of limbs, neck and head where the scan has points there.
  virtual void refine(const Mesh& scan, Extraction& seen) = 0;
};

/// Throws Error when the file is missing, damaged, of another network or of another version.
std::unique_ptr<PartRefiner> load_part_refiner(const std::string& path);

}  // namespace understudy::nn
