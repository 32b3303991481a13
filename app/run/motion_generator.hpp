// More of what a rig does: further motions of its kind, and what lies between two of its poses.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/marionette/motion_dynamics.hpp"
#include "retarget/rig/rig.hpp"

namespace understudy::app {

/// A way to make motions: what a command line, a button or a report may choose.
struct GenerationEngine {
  const char *name, *label;  ///< "match" in documents and commands, "Own motion" on buttons
  const char* sentence;      ///< what it does, for help and tooltips, without its full stop
  bool needs_keys;           ///< it makes what lies between poses alone
  bool needs_weights;        ///< it is a network, for rigs of the kinds that there are weights for
};
/// All, the default first.
const std::vector<GenerationEngine>& generation_engines();
/// Throws Error with the names that there are.
const GenerationEngine& generation_engine_named(const std::string& name);

/// Frames of the clip that the new motion begins and ends with.
struct FramesBetween {
  int first = 0, last = 0;
};
template <class V, class S>
FieldsOf<S, FramesBetween> fields(V& visit, S& between) {
  visit("first", between.first, kFrameNumbers);
  visit("last", between.last, kFrameNumbers);
}

struct GenerationOptions {
  int frames = 90;  ///< of each new motion, at the clip's rate
  std::optional<FramesBetween> between;
  bool loop = false;  ///< ends in the pose that it begins with
  uint64_t seed = 1;  ///< of the first; the next one has the next
  int count = 1;      ///< motions
  std::string engine = "match";
  bool paper_sampling = false;  ///< of networks, between poses: the best of many that do not know the last
};
constexpr Within<uint64_t> kSeeds{0, 1000000000};  ///< in documents
/// All but the count: what tells one motion.
template <class V, class S>
FieldsOf<S, GenerationOptions> fields(V& visit, S& options) {
  visit("frames", options.frames, Within<int>{2, 10000});
  visit("between", options.between);
  visit("loop", options.loop);
  visit("seed", options.seed, kSeeds);
  visit("engine", options.engine);
  visit("paper_sampling", options.paper_sampling);
}

/// A network that knows how this rig's kind moves. Throws Error (see nn::load_motion_dynamics).
using DynamicsLoader = std::function<std::unique_ptr<MotionDynamics>(const understudy::Rig& rig)>;

constexpr int kGivenFrames = 5;  ///< of the clip, that a network goes on from

struct GeneratedMotion {
  uint64_t seed = 1;
  RigMotion motion;
  double nearest_m = 0;  ///< distance_to_nearest() of the clip: 0 is a copy of a piece of it
};
struct GeneratedMotions {
  std::vector<GeneratedMotion> motions;  ///< fewer than asked for where it was ended early
  std::string remark;  ///< what the user should know of the result, a sentence; empty: nothing
};

/// Throws Error where these options are not of that rig, one sentence. known: its rig.name is named.
void check_generation(const RiggedMotion& known, const GenerationOptions& options);
/// Makes them. going_on: called before each with the number that is done; false ends it. first_frame: what
/// the remark calls the clip's first one. Throws Error as check_generation() and the loader do.
GeneratedMotions generate_motions(const RiggedMotion& known, const GenerationOptions& options,
                                  const DynamicsLoader& load, const std::function<bool(int)>& going_on,
                                  int first_frame = 0);

}  // namespace understudy::app
