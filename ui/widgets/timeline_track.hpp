// The timeline's track: processed frames, the playhead, bad frames, loop marks and a curve.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ui/gui/ui.hpp"
#include "ui/widgets/plot.hpp"

namespace understudy::ui {

/// Frames first..last, both played.
struct LoopRange {
  int first = 0, last = 0;
};

struct TrackData {
  int total = 0;      ///< frames of the sequence; may grow while it is followed
  int processed = 0;  ///< frames 0..processed-1 are finished
  int current = 0;
  double fps = 30;
  std::optional<LoopRange> loop;
  std::vector<int> bad_frames;
  Values curve;                              ///< drawn inside, one value a frame
  std::string curve_label;                   ///< with its unit
  std::function<std::string(int)> describe;  ///< extra text for the frame under the pointer
  bool follow = false;                       ///< keep the playhead in view while it plays
  float height = 74;                         ///< at scale 1
};

struct TrackAnswer {
  std::optional<int> seek;        ///< clicked or dragged there
  std::optional<LoopRange> loop;  ///< a loop mark was dragged
};

/// Over the width that is left. Wheel zooms about the pointer, Shift+wheel or the middle button pans, a
/// double click in the ruler shows everything. Marks: NAME (the part under the ruler), NAME.ruler,
/// NAME.loop_first, NAME.loop_last, NAME.playhead.
TrackAnswer timeline_track(Ui& ui, const std::string& name, const TrackData& data);

/// "0:03.27": minutes, seconds, hundredths.
std::string clock_time(double seconds);

}  // namespace understudy::ui
