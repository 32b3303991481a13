// All that the trials of one motion on one target show, made once: the source, the target, every condition's
// result. No GL. Then see StagePainter.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/stimuli/framing.hpp"
#include "app/stimuli/moving_surface.hpp"
#include "retarget/pipeline/target.hpp"

namespace understudy::app {

/// What the making of stimuli gets from the program.
struct StimulusServices {
  std::function<Networks(const Method&, const NetworkParts&)> networks;
  /// Called between frames, with what is being done and how far it is (total 0: not known). What it throws
  /// ends the work; may be empty.
  std::function<void(const std::string& what, int64_t done, int64_t total)> progress{};
  std::function<std::shared_ptr<MotionCoder>()> motion_coder{};  ///< what codes movements that are blended
};

struct Stage {
  int motion = 0, target = 0;          ///< indices into the study's lists
  double motion_s = 0;                 ///< of the motion at speed 1, as far as a clip can show it
  MovingSurface source;                ///< who is in the scan; of bones alone the skeleton
  MovingSurface standing;              ///< the target in T-pose, one frame
  std::vector<MovingSurface> results;  ///< of each condition
  StageExtents extents;                ///< over all frames, of all conditions
};

/// Makes stages of a study. Keeps what the next one may need: the networks, the last motion's source and what
/// is seen in it, so that stages are best asked for motion by motion. One thread at a time.
class StageMaker {
 public:
  StageMaker(Study study, StimulusServices services);
  ~StageMaker();
  /// Retargets with every method and reads every file: takes seconds. Throws Error naming the condition or
  /// the motion that cannot be made.
  std::shared_ptr<const Stage> stage(int motion, int target);

 private:
  struct Watched;
  Networks networks_of(const Method& method);
  const Watched& watch(int motion, const Method& method);
  Watched watched(const StudyMotion& motion, const Method& method);
  struct Body;
  Body open_body(const StudyTarget& target, const Method& method);
  MovingSurface performed(const Body& body, const Method& method, const Stage& stage);
  MovingSurface read(const Body& body, const std::string& path, const Stage& stage);
  /// The method by whose eyes a source is cut and a target is opened where no condition tells.
  const Method& first_method() const;
  void tell(const std::string& what, int64_t done, int64_t total) const;

  Study study_;
  StimulusServices services_;
  MotionBlender blender_;
  std::map<std::string, Networks> networks_;                 // by networks_key()
  int motion_ = -1;                                          // that was watched last
  std::map<std::string, std::unique_ptr<Watched>> watched_;  // by extraction_key()
};

}  // namespace understudy::app
