// Rotations of arms, hands, head and feet, seen again from near: the whole body's 1,024 points leave them
// some twenty.
#pragma once

#include <memory>
#include <string>

#include "retarget/geometry/mesh.hpp"
#include "retarget/pipeline/interfaces.hpp"

namespace understudy::nn {

class LeafRefiner {
 public:
  virtual ~LeafRefiner() = default;
  /// Corrects seen.global of shoulders, elbows, wrists, neck, head, ankles and feet where the scan has points
  /// there.
  virtual void refine(const Mesh& scan, Extraction& seen) = 0;
};

/// Throws Error naming the weights file.
std::unique_ptr<LeafRefiner> load_leaf_refiner(const std::string& path);

}  // namespace understudy::nn
