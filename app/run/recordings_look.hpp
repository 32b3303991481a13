// What a folder of recordings holds, found out in a thread of its own, so that nobody waits for a disk.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "retarget/base/worker.hpp"

namespace understudy::app {

/// As far as it is known.
struct RecordingsHeld {
  bool listed = false;               ///< how many there are, and of which kinds
  std::map<std::string, int> kinds;  ///< "BVH", "scans"
  size_t count = 0, timed = 0;       ///< recordings, and those of them that have been looked into
  size_t unreadable = 0;             ///< of these
  double seconds = 0;                ///< that the others last
  std::string problem;               ///< why there are none, one sentence
  /// "5 recordings: 3 BVH, 2 scans; 41.5 s"; empty before anything is known, and where there is a problem.
  std::string sentence() const;
};

/// For one thread. Its end waits for the recording at work.
class RecordingsLook {
 public:
  RecordingsLook() = default;
  /// At another folder from now on, or anew at this one; empty: at none.
  void look(const std::string& folder);
  RecordingsHeld held() const;

 private:
  Worker::Task next();
  void list(const std::string& folder);
  void time(const std::string& folder, const std::string& recording);

  std::string folder_;
  std::vector<std::string> left_;  // to be looked into
  bool to_list_ = false;
  RecordingsHeld held_;
  Worker worker_{"recordings", [this] { return next(); }};
};

}  // namespace understudy::app
