// Further motions of what was found in the source's scans: those that were made and wait for the user's
// choice, and those that were kept.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/run/motion_generator.hpp"

namespace understudy::app {

struct MadeMotion {
  GenerationOptions how;  ///< one motion, between frames of the source
  std::shared_ptr<const GeneratedMotion> made;
};

struct MadeMotionsState {
  std::vector<MadeMotion> offered;  ///< of the rig that is shown; what was kept of them stays among them
  std::string remark;               ///< what the user should know of them, a sentence; empty: nothing
  int64_t job = 0;                  ///< that makes others; 0: none
  float share = 0;                  ///< of it that is done, 0 .. 1
  /// Of each of the document's clips; null: it is being made again, or cannot be.
  std::vector<std::shared_ptr<const GeneratedMotion>> clips;
  std::string problem;    ///< why one of them cannot be made, one sentence; empty: no problem
  int64_t clips_job = 0;  ///< that makes them again; 0: none
  int laps = 0;           ///< times that the playhead has gone round since they were made
};

}  // namespace understudy::app
