// What a test case shows: its scans and markers, when, and as what they are read.
#pragma once

#include <vector>

#include "app/run/case_folder.hpp"
#include "app/run/source.hpp"
#include "retarget/formats/markers.hpp"

namespace understudy::app {

/// What is true of a case by the format's definition, so that nothing has to be guessed: metres, y up, the
/// floor at 0.
SourceOptions case_source(const Case& c);

/// A frame of a case of which something is known.
struct KnownFrame {
  int64_t frame = 0;    ///< of the sequence, 0 the first
  double seconds = 0;   ///< of the first frame: 0
  Points points{0, 3};  ///< [N, 3] of the scan, metres, y up, the floor at 0; empty: none
  std::vector<Marker> markers;
};

/// Those that have a scan or markers, rising. Throws Error naming what cannot be read, and a marker that is
/// seen at no frame's time (5 % of a frame off) or after the last.
std::vector<KnownFrame> known_frames_of(const Case& c);

}  // namespace understudy::app
