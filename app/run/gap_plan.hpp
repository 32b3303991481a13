// Which frames of a test case are to be made from those around them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace understudy::app {

/// Windows of a sequence, each with one gap between known frames, each to be filled by itself. They lie in
/// stretches of frames that are not bad.
struct GapPlan {
  int frames = 0;               ///< of the sequence
  int gap = 0;                  ///< frames of a window that are not known
  int ends = 10;                ///< known frames on each side of it
  int every = 15;               ///< a window begins every so many frames
  std::vector<int> bad_frames;  ///< whose truth is wrong, rising

  int window() const { return gap + 2 * ends; }
};

/// The first frame of each window.
std::vector<int> window_starts(const GapPlan& plan);
/// Of each frame of the sequence whether it is in no window's gap.
std::vector<bool> known_frames(const GapPlan& plan);

/// "frames", "gap", "ends", "every" and "bad_frames" of a case.json; none where it has no "gap". Throws Error
/// naming the file: numbers that make no sense, no window in the sequence.
std::optional<GapPlan> gap_plan(const nlohmann::json& json, const std::string& path);

}  // namespace understudy::app
