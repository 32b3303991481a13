// Completes sparse captures with the built-in person's body.
#pragma once

#include <memory>

#include "retarget/motion_space/capture_fit.hpp"
#include "retarget/pipeline/motion_space.hpp"
#include "retarget/pipeline/sparse_fitter.hpp"

namespace understudy {

/// Extracts skeletons from the captured frames, fits a body and all poses to the points (CaptureFit), and
/// fills what lies between by a motion space.
class PersonFitter final : public SparseFitter {
 public:
  /// extractor: null where all frames have markers. between: what fills frames; null: Hermite curves.
  explicit PersonFitter(std::shared_ptr<SkeletonExtractor> extractor,
                        std::shared_ptr<MotionSpace> between = nullptr);
  CompletedCapture complete(const SparseCapture& capture, const Progress& progress) override;
  std::string name() const override { return "built-in person"; }

 private:
  std::shared_ptr<SkeletonExtractor> extractor_;
  std::shared_ptr<MotionSpace> between_;
};

}  // namespace understudy
