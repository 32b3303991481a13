// When scans were taken: a table of their times puts them onto the frames of a regular clock.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "retarget/formats/scan_source.hpp"

namespace understudy {

/// A line of a table of times.
struct ScanTime {
  std::string scan;    ///< its file, with or without folder and suffix, or its frame number
  double seconds = 0;  ///< finite; negative, too
  int64_t line = 0;    ///< in the file, from 1
};

/// A CSV of two columns, scan and seconds, in the order of its lines: parted by comma, semicolon or tab,
/// quoted as CSV is, with or without a header. Throws Error naming file and line: two cells are not there, a
/// time is not finite, a scan has no name; or there are fewer than two lines.
std::vector<ScanTime> read_scan_times(const std::string& path);

/// Scans on the frames of a clock, the frame of the first time is frame 0.
struct ScanPlaces {
  struct Place {
    int64_t frame = 0;  ///< of the clock
    int64_t scan = 0;   ///< its position among the scans
  };
  ScanClock clock;
  int64_t frames = 0;         ///< of the clock, from the first time to the last
  std::vector<Place> places;  ///< both rise; frames without a place are gaps
};

/// A frame of a clock is at most one of so many.
constexpr int64_t kMostClockFrames = 10000000;

/// Each scan on the frame that is nearest to its time; of two on one frame the nearer stays, which is logged,
/// as are times of scans that are not there.
/// fps: of the clock; 0: the usual interval's, which is the median of all (where there are two, the shorter);
/// those that are nearly as long are averaged, because whole milliseconds are coarser than a rate.
/// Throws Error naming the table and its line: what read_scan_times refuses, a scan without a time or with
/// two, times that are equal or fall, an hour between two, more than ten million frames.
ScanPlaces place_scans(const std::string& table, const std::vector<ScanName>& scans, double fps);

}  // namespace understudy
