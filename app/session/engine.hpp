// Makes frames in the background: one thread reads the source, extracts skeletons once, and lets every take
// perform them. A new plan redoes no more than has changed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "app/run/latency.hpp"
#include "app/session/session.hpp"

namespace understudy::app {

/// What the engine makes: a copy of the parts of the document that it depends on.
struct Plan {
  struct TakePlan {
    int64_t id = 0;      ///< stays with a take while others come and go
    std::string person;  ///< who of the scans is performed, as SourceOptions'
    TargetOptions target;
    Method method;
    std::vector<JointMove> joints;
    std::vector<BoneTurn> rest_pose;
  };
  SourceOptions source;
  Method shown;          ///< its extractor is of the skeletons shown
  int64_t shown_by = 0;  ///< the take that repairs and smooths these; 0: none
  ScanEdits scan_edits;
  std::vector<SkeletonEdit> skeleton_edits;
  std::vector<TakePlan> takes;
  int64_t first = 0;  ///< the take that is prepared before the others; no field: what comes of it is the same
};
Plan plan_of(const Document& document, const std::vector<int64_t>& take_ids);
template <class V, class S>
FieldsOf<S, Plan::TakePlan> fields(V& visit, S& take) {
  visit("id", take.id);
  visit("person", take.person);
  visit("target", take.target);
  visit("method", take.method);
  visit("joints", take.joints);
  visit("rest_pose", take.rest_pose);
}
template <class V, class S>
FieldsOf<S, Plan> fields(V& visit, S& plan) {
  visit("source", plan.source);
  visit("shown", plan.shown);
  visit("shown_by", plan.shown_by);
  visit("scan_edits", plan.scan_edits);
  visit("skeleton_edits", plan.skeleton_edits);
  visit("takes", plan.takes);
}

// The engine's events, in order.

/// A source was opened; all earlier frames are invalid.
struct SourceOpened {
  std::string name;
  std::optional<int64_t> count;
  double fps = 30;
  std::vector<SourceClip> clips;
  int clip = -1;
};
/// So far scans are completed, 0..1: their frames come after that.
struct SourceCompleting {
  float share = 0;
};
/// The source cannot be opened, or reading it failed.
struct SourceFailed {
  std::string sentence;
  bool wants_canvas = false;  ///< 2D poses of a picture of unknown size
};
/// Frames of the source from `first` on, new or redone.
struct SourceFrames {
  int first = 0;
  bool has_faces = false;
  std::string doubt;                                      ///< why it may be no person; set once
  std::string decision;                                   ///< about units, axes and floor
  Eigen::Matrix4d to_file = Eigen::Matrix4d::Identity();  ///< as SourceState's
  std::optional<ImportOptions> import;                    ///< as SourceState's
  std::shared_ptr<const MadeCapture> made;                ///< as SourceState's
  std::vector<PersonSeen> people;                         ///< in all frames so far
  int person = 0;                                         ///< as SourceState's
  int left_out = 0;                                       ///< people so far who are too many to be followed
  std::vector<KeptSource> frames;
};
/// A target's file was read: how it came, upright and at its size. What performs is still to be bound.
struct TakeLoaded {
  int64_t id = 0;
  std::shared_ptr<const Target> as_loaded;  ///< its mesh alone
};
struct TakeReady {
  int64_t id = 0;
  std::shared_ptr<const PreparedCharacter> character;
  std::shared_ptr<const Target> target;
  std::shared_ptr<const Deformer> deformer;    ///< bound, with the networks' weights
  std::shared_ptr<const SafeBinding> binding;  ///< where they are doubted; null on a skin of its own
};
struct TakeFailed {
  int64_t id = 0;
  std::string sentence;
  bool not_opened = false;    ///< its target's file is to blame
  bool not_a_person = false;  ///< the target could be used all the same
  bool wants_canvas = false;  ///< as SourceFailed
};
/// Frames of a take from `first` on, new or redone.
struct TakeFrames {
  int64_t id = 0;
  int first = 0;
  std::vector<KeptFrame> frames;
  std::vector<KeptSource> seen;   ///< of each frame, where it is of another person than the source's
  std::vector<FrameTimes> times;  ///< of new frames; empty when redone
  std::string warning;            ///< that the target falls apart; once
  std::string rights;             ///< as TakeState's
};
using EngineEvent = std::variant<SourceOpened, SourceCompleting, SourceFailed, SourceFrames, TakeLoaded,
                                 TakeReady, TakeFailed, TakeFrames>;

class Engine {
 public:
  /// The parts asked for, of the networks of a method.
  using NetworksOf = std::function<Networks(const Method&, const NetworkParts&)>;
  /// blender: makes sources that are blends; null: they go straight from pose to pose. tools: what sparse
  /// scans are completed and 2D poses lifted with; called on the engine's thread; the extractor is the
  /// engine's, and so is who is told the progress.
  explicit Engine(NetworksOf networks, std::shared_ptr<MotionBlender> blender = nullptr,
                  SourceTools tools = {});
  ~Engine();  ///< finishes the current frame, or breaks the completing of scans off, then stops

  /// Makes this plan from now on. Never waits.
  /// `afresh`: drops everything made before, even what would still fit.
  void set_plan(Plan plan, bool afresh = false);
  void pause(bool paused);
  /// The events since the last call.
  std::vector<EngineEvent> drain();
  /// Whether frames are still to be made (paused or not).
  bool working() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::app
