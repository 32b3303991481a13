// Makes blends from their recipes: reads the files, finds the steps, codes them, and decodes what lies
// between.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/run/blend_recipe.hpp"
#include "retarget/pipeline/motion_coder.hpp"

namespace understudy::app {

/// One of the movements as it was taken.
struct UsedPart {
  std::string path;
  BlendRange range;       ///< it may begin elsewhere than asked for, so that the same foot strides first
  bool mirrored = false;  ///< or is seen in a mirror for that
  float lead = 0;         ///< radians, see left_lead
  float seconds = 0;
};

struct BlendedMotion {
  Motion motion;                 ///< all of it made, with its doubt
  Joints rest = Joints::Zero();  ///< T-pose joints of who moves, metres
  std::vector<UsedPart> parts;
  float seconds = 0;                  ///< of one cycle
  float decoded_seconds = 0;          ///< what the coder by itself would make of them, see Blended
  std::string coder;                  ///< that made it
  std::vector<std::string> notes;     ///< what was decided, one sentence each
  std::vector<std::string> warnings;  ///< what makes it doubtful, or another than it was
};

/// Keeps what it coded last: other weights take no reading. From any thread.
class MotionBlender {
 public:
  /// Gives what codes movements; called once, when a blend first needs it. Empty, or where it throws: blends
  /// go straight from pose to pose (make_knot_coder), and say so.
  using LoadCoder = std::function<std::shared_ptr<MotionCoder>()>;
  explicit MotionBlender(LoadCoder load = {});
  ~MotionBlender();

  /// fps 0: that of the first part's file. The same recipe, files and coder give the same bits. Throws Error
  /// naming the part that cannot be used: its file is gone or no skeletal motion, it has no such frames, or
  /// nobody steps in it and no range was given.
  BlendedMotion make(const BlendRecipe& blend, double fps = 0);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::app
