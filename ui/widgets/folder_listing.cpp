#include "ui/widgets/folder_listing.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/scan_frames.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"

namespace understudy::ui {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMostFrames = 10000;

bool comes_before(const FolderEntry& a, const FolderEntry& b) {
  return a.is_folder != b.is_folder ? a.is_folder : natural_less(a.name, b.name);
}

/// A file of a format that characters come in, too, is a frame only where its name has a number.
bool is_frame(const std::string& name, const FileFormat& format) {
  return !format.is_plain_text && (!(format.uses & kMotion) || frame_number(name));
}

std::string reason(const std::string& folder, const std::error_code& error) {
  if (error == std::errc::permission_denied) return "You have no permission to open " + folder + ".";
  if (error == std::errc::no_such_file_or_directory) return "There is no folder " + folder + ".";
  if (error == std::errc::not_a_directory) return folder + " is not a folder.";
  return folder + " cannot be listed: " + error.message() + ".";
}

FolderEntry entry_of(const fs::directory_entry& found) {
  FolderEntry entry;
  entry.name = found.path().filename().string();
  struct stat about {};
  if (stat(found.path().c_str(), &about) != 0) return entry;  // a link to nothing: a file of no size
  entry.is_folder = S_ISDIR(about.st_mode);
  entry.bytes = entry.is_folder ? 0 : static_cast<uint64_t>(about.st_size);
  entry.changed_s = about.st_mtime;
  return entry;
}

/// The files of each format that frames come in. As many of two formats are no scan: a reader asks which.
class FrameCounts {
 public:
  void add(const std::string& name) {
    if (file_suffix(name) == ".json") ++jsons_;
    const FileFormat* const format = format_of_suffix(name, kScanFrame);
    if (format == nullptr || format->is_plain_text) return;
    Count& count = counts_[format];
    ++count.files, count.frames += is_frame(name, *format) ? 1 : 0;
  }
  /// A single frame is no sequence.
  int frames() const {
    Count most;
    bool is_alone = false;
    for (const auto& [format, count] : counts_) {
      if (count.files >= most.files) is_alone = count.files > most.files;
      if (count.files > most.files) most = count;
    }
    return is_alone && most.frames > 1 ? most.frames : 0;
  }
  /// The JSONs of a folder that opens as 2D poses; 0 where it does not, or is one of scans.
  int poses(const fs::path& folder) const {
    return frames() == 0 && jsons_ > 1 && looks_like_keypoints(folder.string()) ? jsons_ : 0;
  }

 private:
  struct Count {
    int files = 0, frames = 0;
  };
  std::map<const FileFormat*, Count> counts_;
  int jsons_ = 0;
};

/// Looks into a folder for scan frames, 2D poses and a case.
void look_inside(const fs::path& folder, FolderEntry& entry, const std::atomic<bool>& unwanted) {
  std::error_code error;
  FrameCounts counts;
  int seen = 0;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && !unwanted; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name == "case.json") entry.is_case = true;
    counts.add(name);
    if (++seen >= kMostFrames) break;
  }
  entry.frames = counts.frames(), entry.poses = counts.poses(folder);
}

/// What the folder itself can be opened as.
void describe_folder(const fs::path& folder, FolderContents& contents) {
  FrameCounts counts;
  for (const FolderEntry& entry : contents.entries) {
    if (!entry.is_folder) counts.add(entry.name);
    contents.is_case |= entry.name == "case.json";
  }
  contents.frames = counts.frames(), contents.poses = counts.poses(folder);
}

}  // namespace

struct FolderListing::Shared {
  std::atomic<bool> unwanted{false};
  std::mutex mutex;
  std::shared_ptr<const FolderContents> newest = std::make_shared<FolderContents>();

  void publish(FolderContents contents) {
    auto next = std::make_shared<const FolderContents>(std::move(contents));
    const std::lock_guard<std::mutex> lock(mutex);
    newest = std::move(next);
  }
  void list(const std::string& folder);
  void count_frames(const std::string& folder, FolderContents& contents);
};

void FolderListing::Shared::list(const std::string& folder) {
  FolderContents contents;
  std::error_code error;
  auto wait = std::chrono::milliseconds(100);
  auto next = Clock::now() + wait;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && !unwanted; at.increment(error)) {
    if (at->path().filename().string().front() == '.') continue;
    contents.entries.push_back(entry_of(*at));
    if (Clock::now() < next) continue;
    std::sort(contents.entries.begin(), contents.entries.end(), comes_before);
    publish(contents);
    next = Clock::now() + (wait *= 2);  // each look costs more than the last
  }
  if (error) contents.problem = reason(folder, error);
  std::sort(contents.entries.begin(), contents.entries.end(), comes_before);
  describe_folder(folder, contents);
  publish(contents);
  count_frames(folder, contents);
  contents.finished = true;
  publish(std::move(contents));
}

void FolderListing::Shared::count_frames(const std::string& folder, FolderContents& contents) {
  auto next = Clock::now() + std::chrono::milliseconds(100);
  for (FolderEntry& entry : contents.entries) {
    if (!entry.is_folder || unwanted) break;  // folders come first
    look_inside(fs::path(folder) / entry.name, entry, unwanted);
    if (Clock::now() < next) continue;
    publish(contents);
    next = Clock::now() + std::chrono::milliseconds(300);
  }
}

FolderListing::FolderListing(const std::string& folder) : shared_(std::make_shared<Shared>()) {
  // Detached: a network drive that hangs must not block closing the browser.
  std::thread([shared = shared_, folder] {
    const std::string problem = failure_of([&] { shared->list(folder); });
    if (!problem.empty()) {
      FolderContents none;
      none.finished = true, none.problem = folder + " cannot be listed: " + problem + ".";
      shared->publish(none);
    }
  }).detach();
}

FolderListing::~FolderListing() {
  shared_->unwanted = true;
}

std::shared_ptr<const FolderContents> FolderListing::contents() const {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->newest;
}

std::string file_size(uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits = {"B", "kB", "MB", "GB", "TB"};
  auto size = static_cast<double>(bytes);
  size_t unit = 0;
  while (size >= 999.5 && unit + 1 < kUnits.size()) size /= 1000, ++unit;
  return printed(unit == 0 || size >= 9.95 ? "%.0f %s" : "%.1f %s", size, kUnits[unit]);
}

}  // namespace understudy::ui
