// A folder that is still being written, frame by frame.
#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <thread>

#include "retarget/base/log.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

// Size and time of change: two equal looks mean that nobody wrote in between. Size 0: there is no such file.
using FileState = std::pair<uintmax_t, fs::file_time_type>;

FileState state_of(const std::string& path) {
  std::error_code no_size, no_time;
  const FileState state{fs::file_size(path, no_size), fs::last_write_time(path, no_time)};
  return no_size || no_time ? FileState() : state;
}

class FollowedFolder : public ScanSource::Frames {
 public:
  FollowedFolder(std::string folder, ScanSourceOptions options)
      : folder_(std::move(folder)), options_(std::move(options)), last_news_(Clock::now()) {
    folder_files(folder_);  // throws when it cannot be read
  }

  std::optional<ScanFrame> next() override {
    if (!ready_.empty()) return next_ready();
    while (!ended_) {
      if (options_.cancelled && options_.cancelled()) break;
      if (auto frame = look()) return frame;
      if (!ended_) std::this_thread::sleep_for(std::chrono::duration<double>(options_.poll_s));
    }
    ended_ = true;
    return {};
  }
  std::optional<int64_t> count() const override { return {}; }
  void seek(int64_t) override { throw Error("frames that are still being written cannot be read again"); }

 private:
  // One look at the folder: a frame that is complete, or none yet, or the end.
  std::optional<ScanFrame> look() {
    if (waiting_.size() > 1 && !skips_a_number(waiting_.front()))
      return take(true);  // the writer is ahead: no need to list the folder for each frame
    const auto names = folder_files(folder_);
    const bool done = std::any_of(names.begin(), names.end(),
                                  [](const auto& name) { return name == "done" || name == ".done"; });
    list_waiting(names);
    const double idle = std::chrono::duration<double>(Clock::now() - last_news_).count();
    const bool late = idle >= options_.timeout_s;
    if (waiting_.empty()) {
      US_CHECK(!late || handed_out_ > 0, folder_, ": no frame came within ", options_.timeout_s, " s");
      US_CHECK(!done || handed_out_ > 0, folder_, ": holds no frames");
      ended_ = done || late;
      return {};
    }
    const bool written = done || waiting_.size() > 1;  // its writer has gone on to the next
    if (!written && !late && !stands_still(waiting_.front())) return {};
    if (skips_a_number(waiting_.front()) && !done && !late && idle < kPatienceForGap) return {};
    return take(written || late);
  }

  // The frames behind the last one that went out, in order. The first frame decides on the format.
  void list_waiting(const std::vector<std::string>& names) {
    std::vector<std::string> open;
    for (const auto& name : names) {
      if (name[0] == '.' || (handed_out_ > 0 && !natural_less(last_name_, name))) continue;
      const FileFormat* const format = format_of_suffix(name, kScanFrame);
      if (!format || (format_ && format != format_)) {
        if (format) log::warn_once(folder_ + ": " + format->name + " files are left out");
        continue;
      }
      open.push_back(name);
    }
    if (!format_) open = frame_files(folder_, open);
    std::sort(open.begin(), open.end(), natural_less);
    waiting_.assign(open.begin(), open.end());
  }

  bool stands_still(const std::string& name) {
    const FileState now = state_of((fs::path(folder_) / name).string());
    const bool still = name == watched_ && now == state_ && now.first > 0;
    watched_ = name;
    state_ = now;
    return still;
  }

  bool skips_a_number(const std::string& name) const {
    const auto number = frame_number(name);
    return number && number_ && step_ && missing_between(*number - *number_, *step_) > 0;
  }

  // A file that does not parse may still be growing, unless the writer has gone on.
  std::optional<ScanFrame> take(bool written) {
    const std::string name = waiting_.front();
    const std::string path = (fs::path(folder_) / name).string();
    const auto number = frame_number(name);
    ScanFrame frame = load_frame(path, number ? *number : handed_out_);
    if (!written && (!frame.usable || state_of(path) != state_)) return {};
    waiting_.pop_front();
    if (!format_) format_ = format_of_suffix(name, kScanFrame);
    note_gap(name);
    if (number && number_ && !step_) step_ = *number - *number_;
    number_ = number;
    last_name_ = name;
    last_news_ = Clock::now();
    ++handed_out_;
    ready_.push_back(std::move(frame));
    return next_ready();
  }

  ScanFrame next_ready() {
    ScanFrame frame = std::move(ready_.front());
    ready_.pop_front();
    return frame;
  }

  void note_gap(const std::string& name) {
    if (!skips_a_number(name)) return;
    const int64_t count = missing_between(*frame_number(name) - *number_, *step_);
    gaps.push_back({*number_ + *step_, *number_ + count * *step_});
    log::warn(folder_ + ": frames are missing before " + name);
    for (int64_t i = 1; i <= count && count <= kLongestGap; ++i)
      ready_.push_back(missing_frame(folder_, *number_ + i * *step_));
  }

  static constexpr double kPatienceForGap = 0.5;  // seconds that a frame may come after its successor

  std::string folder_;
  ScanSourceOptions options_;
  const FileFormat* format_ = nullptr;  // of the first frame
  std::deque<std::string> waiting_;
  std::deque<ScanFrame> ready_;  // missing ones and the one after them
  std::string last_name_, watched_;
  FileState state_;
  std::optional<int64_t> number_, step_;
  int64_t handed_out_ = 0;
  Clock::time_point last_news_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<ScanSource::Frames> follow_folder(const std::string& folder,
                                                  const ScanSourceOptions& options) {
  return std::make_unique<FollowedFolder>(folder, options);
}

}  // namespace understudy
