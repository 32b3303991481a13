// Applies the user's edits to a result and measures it, in the background: a take's newest request wins.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "app/session/session.hpp"

namespace understudy::app {

struct RefineRequest {
  int64_t take_id = 0;
  SharedFrames<KeptFrame> performed;
  float fps = 30;
  PoseEdits edits;
  std::shared_ptr<const Target> target;
  SharedFrames<KeptSource> source;
  std::shared_ptr<const Truth> truth;  ///< may be null
  bool has_style = false;              ///< it is performed in a style
  bool all_there = true;               ///< false: more are performed yet, and nothing goes on beyond the last
};

struct Refined {
  int64_t take_id = 0;
  size_t performed = 0;  ///< frames that it was made of
  Motion shown;          ///< more than these where it goes on beyond the last
  std::vector<Joints> joints;
  std::vector<double> times;   ///< as TakeState's
  float leg_ratio = 1;         ///< as TakeState's
  std::vector<Series> series;  ///< NaN beyond the last
  EditCost cost;
  std::string problem;  ///< why the edits cannot be applied; the motion is then unedited
};

/// The same on this thread. `space` makes what is filled; null: smooth curves do.
Refined refine(const RefineRequest& request, MotionSpace* space);

/// What each of the motion space's answers makes of all that is filled and of what goes on.
struct Alternatives {
  int64_t take_id = 0;
  std::vector<std::vector<Joints>> joints;  ///< of each answer and frame; empty: there is but one answer
};
Alternatives alternatives_of(const RefineRequest& request, MotionSpace* space);

/// Loads the motion space; may be empty, then there is none.
using LoadSpace = std::function<std::shared_ptr<MotionSpace>()>;

class Refiner {
 public:
  /// The motion space is loaded when an edit first needs it, on the refiner's own thread; what is filled
  /// follows smooth curves meanwhile, or for good where it cannot be loaded, which is logged.
  explicit Refiner(LoadSpace load_space);
  ~Refiner();
  /// Never waits; replaces a request of the same take that has not begun.
  void request(RefineRequest request);
  std::vector<Refined> drain();
  /// These come after what was asked for; not where it was asked for more meanwhile.
  std::vector<Alternatives> drain_alternatives();
  bool busy() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace understudy::app
