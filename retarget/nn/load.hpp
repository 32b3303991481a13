// The networks as stages of the pipeline, with the weights of a file. Each throws Error when that is missing,
// damaged, of another network or of another version.
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
std::unique_ptr<PartRefiner> load_part_refiner(const std::string& path);

/// form: "dense" or "paper" (see skeleton_form.hpp); parts, which may be null, refines limbs and head.
std::unique_ptr<SkeletonExtractor> load_network_extractor(const std::string& path, const std::string& form,
                                                          std::unique_ptr<PartRefiner> parts = nullptr);

/// Motion transfer by the recurrent network of paper 1, section 3.1: the engine `paper`. Its push() throws
/// Error when joints are not finite or the network's answer is not.
std::unique_ptr<MotionTransfer> load_paper_transfer(const std::string& path);

/// Skin weights and pose-corrective offsets of any target (paper 1, section 3.2); without `offsets` linear
/// blend skinning alone. Its bind() throws Error when a coordinate is not finite or the networks give NaN;
/// deform() before bind() throws. Deforming costs no network: one thread, some milliseconds. Of targets with
/// more than `most_evaluated` vertices one a centimetre is evaluated, more where that is too coarse; the
/// others are interpolated.
std::unique_ptr<Deformer> load_network_deformer(const std::string& path, bool offsets,
                                                int most_evaluated = 40000);

/// `count` points distributed over a target's surface, the same set for any order of its points; repeated
/// where there are fewer.
Points spread_points(const Points& points, int count);

}  // namespace understudy::nn
