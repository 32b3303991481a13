// The kinds of scan sequence behind ScanSource.
#pragma once

#include "retarget/formats/scan_source.hpp"

namespace understudy {

/// The file as a frame; a problem is written into it, not thrown.
ScanFrame load_frame(const std::string& path, int64_t number);

/// The last run of digits in a file's name without its suffix; none when there is none or it is too long.
std::optional<int64_t> frame_number(const std::string& path);

/// A folder that is still being written.
std::unique_ptr<ScanSource::Frames> follow_folder(const std::string& folder,
                                                  const ScanSourceOptions& options);

/// Names of the files in a folder, unsorted, hidden ones left out. Throws Error.
std::vector<std::string> folder_files(const std::string& folder);
/// The file names of the folder's most frequent mesh format, naturally sorted; warns about those left out.
/// Text that may be anything (.txt, .csv) counts only where there is nothing else. Empty when there is none.
/// Throws Error when two formats are equally frequent.
std::vector<std::string> frame_files(const std::string& folder, const std::vector<std::string>& names);

}  // namespace understudy
