// The stages of a frame, as the pipeline sees them: abstract, so that no user of the pipeline
// needs LibTorch.
#pragma once

#include <algorithm>
#include <any>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "retarget/geometry/mesh.hpp"
#include "retarget/skeleton/skeleton.hpp"

namespace understudy {

/// Of each joint, 0..1.
using Confidence = Eigen::Array<float, kJointCount, 1>;

constexpr float kHalfConfidence = 0.06f;  ///< metres

/// Confidence, 0..1, of a joint that is expected to be off by so many metres: one half at kHalfConfidence.
inline float confidence_for(float expected_error_m) {
  const float expected = expected_error_m / kHalfConfidence;
  return 1 / (1 + expected * expected);
}
/// The error that a confidence stands for, metres.
inline float expected_error_for(float confidence) {
  return kHalfConfidence * std::sqrt(1 / std::clamp(confidence, 1e-6f, 1.0f) - 1);
}

/// The skeleton in one frame.
struct Extraction {
  Joints joints = Joints::Zero();  ///< world, metres
  Confidence confidence = Confidence::Ones();
  std::optional<Rotations> global;   ///< world rotations seen on the surface, where known
  std::optional<float> sole_height;  ///< metres over the floor of the lowest points near the feet, where seen
  bool exact = false;  ///< a skeleton's own, seen in no scan: nothing is to be repaired, smoothed or solved
  /// 0..1, whether the scan shows the surface about each joint; 1 where the extractor does not know. Not the
  /// confidence: where a joint lies may be plain without seeing it, or doubtful although it is seen.
  Confidence visibility = Confidence::Ones();
};

/// A skeleton's own joints and rotations.
inline Extraction exact_extraction(const PosedSkeleton& posed) {
  Extraction extraction;
  extraction.joints = posed.joints, extraction.global = posed.global;
  extraction.exact = true;
  return extraction;
}

/// The joints seen in the last two frames of a stream, world, metres. Those that are not finite are left out.
struct RecentJoints {
  std::optional<Joints> last, before_last;

  void push(const Joints& joints) {
    if (!joints.allFinite()) return;
    before_last = last;
    last = joints;
  }
};

/// Joints from a scan of any number of points, any order, any heading (paper 1, section 3.1). One thread at a
/// time.
class SkeletonExtractor {
 public:
  virtual ~SkeletonExtractor() = default;
  /// Throws Error when the cloud has fewer than 32 finite points or the network gives NaN.
  virtual Extraction extract(const Mesh& scan) = 0;
  /// The same of a stream's next scan, knowing what was seen just before. Extractors without memory ignore
  /// `recent`.
  virtual Extraction extract_after(const RecentJoints& /*recent*/, const Mesh& scan) { return extract(scan); }
  virtual std::string name() const = 0;
};

/// What remembers between frames. Its memory can be copied and put back: a frame that is refused leaves no
/// trace.
class Remembering {
 public:
  virtual ~Remembering() = default;
  virtual std::any memory() const = 0;
  /// `memory` is one that the same object gave.
  virtual void restore(const std::any& memory) = 0;
};

/// Source joints in, the target's local rotations out, frame by frame, with state (paper 1, section 3.1).
class MotionTransfer : public Remembering {
 public:
  /// Forgets the past; rest_b are the target's T-pose joints, metres. Throws Error when they are no body's.
  virtual void reset(const Joints& rest_b) = 0;
  /// Local rotations of the target for one source frame, dt seconds after the one before. The root's position
  /// is RootPath's business. Throws Error when a joint, or the answer, is not finite.
  virtual Rotations push(const Extraction& source, float dt) = 0;
  virtual std::string name() const = 0;
};

/// Skin weights once per target, vertices per frame (paper 1, section 3.2). What is const may be called from
/// several threads at once.
class Deformer {
 public:
  virtual ~Deformer() = default;
  /// Prepares for a target: rest vertices [V, 3] in T-pose, its T-pose joints, metres. Throws Error when they
  /// cannot be used.
  virtual void bind(const Points& rest, const Joints& rest_joints) = 0;
  /// [V, 22], rows sum to 1. Valid after bind().
  virtual const RowMatrix& weights() const = 0;
  /// The same, bound to the same target, with other skin weights (a user's), [V, 22] >= 0; rows are made to
  /// sum to 1. Throws Error before bind(), when the shape is another or a row is empty.
  virtual std::shared_ptr<Deformer> with_weights(RowMatrix weights) const = 0;
  /// Posed vertices [V, 3] (eq. 3): offsets, then linear blend skinning. Throws Error before bind().
  virtual Points deform(const Pose& pose) const = 0;
  /// Pose-corrective offsets of the T-pose vertices in this pose, [V, 3] metres, T-pose axes; zero without
  /// such a network.
  virtual Points offsets(const Pose& pose) const = 0;
  virtual std::string name() const = 0;
};

/// Which networks are wanted: each costs time and memory to load.
struct NetworkParts {
  bool extractor = false, rest_extractor = false, transfer = false, deformer = false, style = false;
  static NetworkParts all() { return {true, true, true, true, true}; }
  static NetworkParts performers() { return {false, false, true, true, true}; }
};

class MotionStyle;

/// The networks that the pipeline runs on. Those that are not asked for are null.
struct Networks {
  std::shared_ptr<SkeletonExtractor> extractor;
  std::shared_ptr<SkeletonExtractor> rest_extractor;  ///< trained on T-poses, for targets
  std::shared_ptr<MotionTransfer> transfer;
  std::shared_ptr<Deformer> deformer;
  std::shared_ptr<MotionStyle> style;  ///< null where none was chosen, too
};

}  // namespace understudy
