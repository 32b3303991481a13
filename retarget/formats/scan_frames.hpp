// The kinds of scan sequence behind ScanSource.
#pragma once

#include <memory>

#include "retarget/formats/scan_source.hpp"

namespace understudy {

/// What a ScanSource draws its frames from.
class ScanSource::Frames {
 public:
  virtual ~Frames() = default;
  virtual std::optional<ScanFrame> next() = 0;
  virtual std::optional<int64_t> count() const = 0;
  /// See ScanSource::seek(). Here: for what cannot.
  virtual void seek(int64_t frame);
  std::vector<FrameGap> gaps;
};

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
