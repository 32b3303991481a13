// The timeline's track: processed frames, the playhead, bad frames, loop marks, edits, bars of what holds,
// and a curve or the channel being edited.
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

/// An edit: a diamond at a frame, or a bar over a range of them.
struct TrackMark {
  std::string name;   ///< names its mark in the track, "drags.12"; each once
  std::string words;  ///< what it is, for the tooltip
  int first = 0, last = 0;
  bool diamond = false;
  int reach = 0;       ///< of a diamond: frames to each side that follow
  int row = 0;         ///< 0 or 1: the lower one
  int color = 0;       ///< of Theme::series
  bool fixed = false;  ///< nobody's edit: can be clicked, not moved or deleted
  /// Of each frame of a bar the share of its height that is filled, 0..1; empty: all of it.
  std::vector<float> heights{};
};

/// A thin row of bars over the frames in which something holds: nobody's edit, not to be clicked.
struct TrackBand {
  std::string name;             ///< names its marks in the track: BAND.K, the K-th bar
  std::string words;            ///< what holds, for the tooltip
  std::vector<LoopRange> bars;  ///< in order of time
  int color = 0;                ///< of Theme::series
};

/// A moment with a letter: loop marks that are dragged near it snap to it.
struct TrackLetter {
  int frame = 0;
  std::string letter;  ///< "L"
  std::string words;   ///< what it is, for the tooltip
  int color = 0;       ///< of Theme::series
};

struct TrackData {
  int total = 0;      ///< frames of the sequence; may grow while it is followed
  int processed = 0;  ///< frames 0..processed-1 are finished
  int current = 0;
  double fps = 30;
  std::vector<double> times;  ///< when each frame is, seconds; empty: evenly, at `fps`
  std::optional<LoopRange> loop;
  std::vector<int> bad_frames;
  Values curve;                 ///< drawn inside, one value a frame
  std::string curve_label;      ///< with its unit
  std::vector<Values> channel;  ///< drawn in place of the curve, in the curve's label: x, y and z
  std::vector<int> keys;        ///< frames in which the channel was edited: diamonds on its curves
  std::vector<TrackMark> marks;
  std::vector<TrackBand> bands;              ///< above the marks, the first on top; where there is room
  std::vector<TrackLetter> letters;          ///< under the ruler, in order of time
  std::optional<LoopRange> kept;             ///< the ends outside it are greyed: they were trimmed
  std::function<std::string(int)> describe;  ///< extra text for the frame under the pointer
  bool follow = false;                       ///< keep the playhead in view while it plays
  float height = 74;                         ///< at scale 1
};

struct TrackAnswer {
  std::optional<int> seek;  ///< clicked or dragged there
  struct Move {
    size_t mark = 0;   ///< among TrackData::marks
    LoopRange frames;  ///< that it is to have
  };
  std::optional<Move> move;       ///< a mark, or an end of a bar, was dragged and let go
  std::optional<LoopRange> kept;  ///< an end of the part that is kept was dragged and let go
  std::optional<size_t> remove;   ///< Delete was pressed while this mark was chosen
  std::optional<LoopRange> loop;  ///< a loop mark was dragged
};

/// Over the width that is left. Wheel zooms about the pointer, Shift+wheel or the middle button pans, a
/// double click in the ruler shows everything. A click at a mark chooses it and goes there; dragged it moves,
/// by an end of a bar it gets longer or shorter, as the part does that is kept. Escape cancels a drag. Marks:
/// NAME (the part under the ruler), NAME.ruler, NAME.loop_first, NAME.loop_last, NAME.playhead, NAME.MARK,
/// NAME.BAND.K, NAME.letter.K, NAME.trimmed (.before, .after), NAME.trim_first, NAME.trim_last (the grips),
/// NAME.key.K (the K-th key), NAME.chosen (the mark chosen).
TrackAnswer timeline_track(Ui& ui, const std::string& name, const TrackData& data);

/// "0:03.27": minutes, seconds, hundredths.
std::string clock_time(double seconds);

}  // namespace understudy::ui
