// The kinds of scan sequence behind ScanSource.
#pragma once

#include "retarget/formats/scan_source.hpp"

namespace understudy {

/// Gives the frame, which has its path, what `read` gives, thinned; a problem is written into it, not thrown.
void take_scan(ScanFrame& frame, const std::function<Mesh()>& read);
/// The file as a frame, by take_scan.
ScanFrame load_frame(const std::string& path, int64_t number);

/// A frame that the sequence's numbers leave out: time passes, and nothing is there.
ScanFrame missing_frame(const std::string& sequence, int64_t number);
/// How many frames are missing between two numbers that lie so far apart, where `usual` apart is usual.
inline int64_t missing_between(int64_t step, int64_t usual) {
  return (step + usual / 2) / usual - 1;
}
/// So many that are missing in one place are believed; more, and the numbers count something else.
constexpr int64_t kLongestGap = 1000;

/// The last run of digits in a file's name without its suffix; none when there is none or it is too long.
std::optional<int64_t> frame_number(const std::string& path);

/// A folder that is still being written.
std::unique_ptr<ScanSource::Frames> follow_folder(const std::string& folder,
                                                  const ScanSourceOptions& options);

/// The scans as `table` says when they were taken; see scan_times.hpp. Throws Error.
std::unique_ptr<ScanSource::Frames> clock_frames(std::unique_ptr<ScanSource::Frames> scans,
                                                 const std::string& source, const std::string& table,
                                                 double fps);

/// Names of the files in a folder, unsorted, hidden ones left out. Throws Error.
std::vector<std::string> folder_files(const std::string& folder);
/// The file names of the folder's most frequent mesh format, naturally sorted; warns about those left out.
/// Text that may be anything (.txt, .csv) counts only where there is nothing else. Empty when there is none.
/// Throws Error when two formats are equally frequent.
std::vector<std::string> frame_files(const std::string& folder, const std::vector<std::string>& names);

}  // namespace understudy
