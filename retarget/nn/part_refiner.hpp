// Refines joints and rotations of limbs and head on part crops: of the whole body's 1,024 points a hand gets
// about twenty.
#pragma once

#include <memory>
#include <string>

#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

class PartRefiner {
 public:
  virtual ~PartRefiner() = default;
  /// Corrects rotations, places and confidences of limbs, neck and head where the scan has points there.
  virtual void refine(const Mesh& scan, Extraction& seen) = 0;
};

/// Throws Error naming the weights file.
std::unique_ptr<PartRefiner> load_part_refiner(const std::string& path);

}  // namespace understudy::nn
