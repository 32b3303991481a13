// The later stages of a frame: observations of one person in, the target's performance out.
#pragma once

#include <any>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/pipeline/arm_reach.hpp"
#include "retarget/pipeline/foot_lock.hpp"
#include "retarget/pipeline/hand_contacts.hpp"
#include "retarget/pipeline/joint_filter.hpp"
#include "retarget/pipeline/observation.hpp"
#include "retarget/pipeline/pose_prediction.hpp"
#include "retarget/pipeline/root_path.hpp"
#include "retarget/pipeline/target.hpp"
#include "retarget/pipeline/torn_surface.hpp"
#include "retarget/pipeline/unseen_limbs.hpp"

namespace understudy {

struct RetargetOptions {
  std::optional<Rotations> rest_pose;  ///< of the target, see from_rest_pose(); none: the T-pose
  JointFilterOptions filter;
  RootPathOptions root;
  bool lock_feet = true;  ///< standing feet do not slide
  FootLockOptions feet;
  float arm_reach = 0;        ///< 0..1, see ArmReach
  bool keep_contacts = true;  ///< hands that touch the body or each other do so on the target, too
  bool vertices = true;       ///< false: poses only, no deformation
  /// Frames that cannot be used go on as those before went and come to rest, instead of repeating the last.
  bool predict = false;
  /// Whether limbs are placed elsewhere than the transfer puts them, standing feet and hands' contacts apart.
  bool places_limbs() const { return root.stride != 1 || root.hip_height_m != 0 || arm_reach > 0; }
};

/// The target in one frame.
struct PerformedFrame {
  Points vertices;                 ///< [V, 3] metres, in the target's order; empty when not asked for
  Joints joints = Joints::Zero();  ///< of the target, world
  Pose pose;                       ///< of the target: local rotations and root
  Observation
      observed;  ///< as it came, styled where there is a style; the doubt is of what stands in where it is predicted
  Observation source;  ///< repaired and smoothed: what was transferred; where flagged that of
                       ///< the last good frame
  Confidence confidence = Confidence::Zero();  ///< of the observed joints; zero where flagged
  Standing standing{};                         ///< the feet that are held on the floor
  LimbsSight limbs{};                          ///< what is seen of the limbs; the rest stands or hangs still
  bool flagged = false;                        ///< it could not be used; the last good pose, or from there on
  std::string reason;                          ///< why it is flagged, one sentence
  std::string warning;                         ///< that the target falls apart, once; it is logged, too
  double transfer_ms = 0, deform_ms = 0;
};

/// What is kept of a past frame: everything else can be made again from it. Under 2 kB.
struct KeptFrame {
  Pose pose;
  Joints source = Joints::Zero();  ///< joints of the source, repaired and smoothed, before any style
  bool flagged = false;
  Standing standing{};  ///< the feet that are held on the floor
  LimbsSight limbs{};   ///< what is seen of the limbs
  float doubt_m = 0;    ///< as observed.doubt_m
};
KeptFrame kept(const PerformedFrame& frame);
/// The source's joints, repaired and smoothed, before any style; where flagged those of the last good frame.
const Joints& source_joints(const PerformedFrame& frame);

/// One target that performs. Frame i is finished before frame i + 1 is read, nothing looks into the future
/// and memory does not grow. One thread at a time.
class Performer {
 public:
  /// Has no target: its frames have a `source`, repaired and smoothed, and no pose.
  explicit Performer(const RetargetOptions& options = {});
  /// Binds the networks to the target. Throws Error when they cannot be, or one is missing. Without vertices
  /// and contacts (RetargetOptions) no deformer is needed.
  Performer(Target target, std::shared_ptr<MotionTransfer> transfer, std::shared_ptr<Deformer> deformer,
            const RetargetOptions& options = {});
  /// Starts the source anew.
  void restart();
  /// The same with other options; the target stays bound.
  void restart(const RetargetOptions& options);

  /// The target's frame, dt seconds after the one before. One that is refused (refusal(), or a stage cannot
  /// work with it) repeats the last pose (before any good one: the T-pose at the origin), or goes on from it
  /// for half a second where that is asked for (RetargetOptions::predict), is flagged and leaves no trace in
  /// what comes after.
  PerformedFrame perform(const Observation& seen, float dt);

  const Target& target() const { return target_; }
  const std::shared_ptr<Deformer>& deformer() const { return deformer_; }

 private:
  /// What the stages remember, one value.
  struct Memory {
    UnseenLimbs unseen;
    JointFilter filter;
    RootPath root;
    FootLock feet;
    ArmReach arms;
    HandContacts hands;
    std::any transfer;  // a copy: the engine keeps its own
  };

  Memory remembered() const;
  void put_back(Memory memory);
  void run(PerformedFrame& frame);
  void watch(PerformedFrame& frame);
  PerformedFrame repeat(PerformedFrame frame, std::string reason);
  void finish(PerformedFrame& frame) const;

  RetargetOptions options_;
  Target target_;
  std::shared_ptr<MotionTransfer> transfer_;  // null: no target
  std::shared_ptr<Deformer> deformer_;
  Memory now_;
  Rotations copied_;  // local, of this frame, before its limbs were placed
  TornSurface surface_;
  bool is_torn_ = false;  // and it has been told
  int64_t watched_ = 0;   // frames
  KeptFrame last_;
  std::optional<PosePrediction> ahead_;  // only where it is asked for
  float waited_ = 0;                     // seconds since the last good frame
};

}  // namespace understudy
