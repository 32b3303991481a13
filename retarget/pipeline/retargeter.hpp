// The online pipeline: push a scan, get the target in the source's pose.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "retarget/pipeline/foot_lock.hpp"
#include "retarget/pipeline/hand_contacts.hpp"
#include "retarget/pipeline/interfaces.hpp"
#include "retarget/pipeline/joint_filter.hpp"
#include "retarget/pipeline/root_path.hpp"

namespace understudy {

struct RetargetOptions {
  JointFilterOptions filter;
  RootPathOptions root;
  bool lock_feet = true;  ///< feet that stand do not slide
  FootLockOptions feet;
  bool keep_contacts = true;  ///< hands that touch the body or each other do so on the target, too
  HandContactOptions hands;
  float min_confidence = 0.08f;  ///< mean over joints below which a frame is not believed
  int min_points = 32;           ///< finite points below which a frame is not looked at
  bool vertices = true;          ///< false: poses only, no deformation
};

/// Milliseconds of one frame by stage.
struct StageTimes {
  double extract = 0, transfer = 0, deform = 0, total = 0;
};

/// The target in one frame, and what was seen of the source.
struct RetargetedFrame {
  Points vertices;                 ///< [V, 3] metres, in the target's order; empty when not asked for
  Joints joints = Joints::Zero();  ///< of the target, world
  Pose pose;                       ///< of the target: local rotations and root
  Extraction source_raw;           ///< as extracted
  Extraction source;               ///< repaired and smoothed: what was transferred
  float confidence = 0;            ///< mean over joints, 0..1
  bool flagged = false;            ///< the scan could not be used; the pose is the last good one
  std::string reason;              ///< why it is flagged, one sentence
  StageTimes ms;
};

/// What is kept of a past frame: everything else can be made again from it. Under 2 kB.
struct KeptFrame {
  Pose pose;
  float confidence = 0;
  bool flagged = false;
};

/// A target prepared: its T-pose and the joints found in it.
struct Target {
  Mesh mesh;                          ///< T-pose, facing +z
  Joints joints = Joints::Zero();     ///< T-pose joints
  std::vector<std::string> warnings;  ///< where it does not look like a person in T-pose
};

/// Finds the T-pose joints of a target: the mean over random samples, small turns and mirror images; made
/// symmetric when the target is. Never refuses: what does not look like a person in T-pose is told in
/// `warnings`. Throws Error when the mesh has fewer than 32 finite points.
Target prepare_target(const Mesh& mesh, SkeletonExtractor& extractor);
/// A target whose T-pose joints are known.
Target prepare_target(const Mesh& mesh, const Joints& joints);

/// Owns the networks and the target. Frame i is finished before frame i + 1 is read, nothing looks into the
/// future and memory does not grow. One thread at a time.
class Retargeter {
 public:
  Retargeter(Networks networks, const RetargetOptions& options = {});
  /// Starts anew with a target.
  void set_target(const Mesh& mesh);
  void set_target(Target target);
  /// Starts the source anew, same target.
  void restart();

  /// The target's frame for the source's scan, dt seconds after the one before. A scan that cannot be used
  /// repeats the last pose (before any good one: the T-pose at the origin) and is flagged. Throws Error
  /// without a target.
  RetargetedFrame push(const Mesh& scan, float dt);
  /// The same with what was extracted given: kept from before, corrected, an oracle, or an extractor of one's
  /// own. girth: of the scan that it was extracted from (measure_girth); null where there is none.
  RetargetedFrame push(const Extraction& extraction, float dt, const BodyGirth* girth = nullptr);
  /// A frame in which nothing of the source can be used: the last pose again, flagged. Wants no extractor.
  RetargetedFrame skip(const std::string& reason, float dt);
  /// The target in a pose given, no transfer: for poses kept, and for an oracle.
  RetargetedFrame pose_target(const Pose& pose);

  const Target& target() const { return target_; }
  const RowMatrix& weights() const;
  const Networks& networks() const { return networks_; }

 private:
  RetargetedFrame transfer(RetargetedFrame frame, float dt, const BodyGirth* girth);
  RetargetedFrame repeat(RetargetedFrame frame, const std::string& reason);
  void finish(RetargetedFrame& frame);

  Networks networks_;
  RetargetOptions options_;
  Target target_;
  RecentJoints recent_;
  JointFilter filter_;
  RootPath root_;
  FootLock feet_;
  HandContacts hands_;
  Pose last_;
  float waited_ = 0;  // seconds of flagged frames since the last good one
  bool has_target_ = false;
};

KeptFrame kept(const RetargetedFrame& frame);

}  // namespace understudy
