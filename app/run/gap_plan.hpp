// Which frames of a test case are to be made from those around them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace understudy::app {

/// Windows of a sequence, each to be filled by itself. Either they are alike, each with one gap, and lie in
/// stretches of frames that are not bad; or the sequence is one window, of which some frames are known.
struct GapPlan {
  int frames = 0;                     ///< of the sequence
  int gap = 0;                        ///< frames of a window that are not known
  int before = 10, after = 10;        ///< known frames on each side of it; none after it: it is predicted
  int every = 15;                     ///< a window begins every so many frames
  std::vector<int> bad_frames;        ///< whose truth is wrong, rising
  std::vector<int> known_alone = {};  ///< rising; where there are any the sequence is one window

  bool is_whole() const { return !known_alone.empty(); }
  int window() const { return is_whole() ? frames : before + gap + after; }
};

/// The first frame of each window.
std::vector<int> window_starts(const GapPlan& plan);
/// Of each frame of a window whether it is known there.
std::vector<bool> window_known(const GapPlan& plan);
/// Of each frame of the sequence whether it is in no window's gap.
std::vector<bool> known_frames(const GapPlan& plan);

/// Of a sequence of so many frames, the first and the last known and others evenly between: frame
/// i (frames - 1) / (count - 1), rounded. Throws Error for a count below 2 or above the frames.
std::vector<int> evenly_known(int frames, int count);

/// "frames", and either "gap", "every", "bad_frames" and "ends" (known frames on both sides) or "seen" (known
/// frames before the gap, none after it), or "known" (the known frames of a sequence that is one window);
/// none where a case.json has neither "gap" nor "known". Throws Error naming the file: numbers that make no
/// sense, no window in the sequence.
std::optional<GapPlan> gap_plan(const nlohmann::json& json, const std::string& path);

}  // namespace understudy::app
