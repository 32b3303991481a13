// A folder that is still being written, frame by frame.
#include <deque>

#include "retarget/base/log.hpp"
#include "retarget/formats/bytes.hpp"
#include "retarget/formats/file_formats.hpp"
#include "retarget/formats/folder_follower.hpp"
#include "retarget/formats/scan_frames.hpp"

namespace understudy {
namespace {

class FollowedFolder : public ScanSource::Frames {
 public:
  FollowedFolder(const std::string& folder, const ScanSourceOptions& options)
      : folder_(folder),
        files_(folder, {options.timeout_s, options.poll_s, options.cancelled},
               [this](std::vector<std::string> names) { return frames_among(std::move(names)); }) {}

  std::optional<ScanFrame> next() override {
    if (!ready_.empty()) return next_ready();
    ScanFrame frame;
    const auto file = files_.next([&](const FollowedFile& read) {
      frame = load_frame(read.path, read.number);
      return frame.usable;
    });
    if (!file) return {};
    if (!format_) format_ = format_of_suffix(file->name, kScanFrame);
    note_gap(*file);
    ready_.push_back(std::move(frame));
    return next_ready();
  }
  std::optional<int64_t> count() const override { return {}; }
  void seek(int64_t) override { throw Error("frames that are still being written cannot be read again"); }

 private:
  // The first frame decides on the format.
  std::vector<std::string> frames_among(std::vector<std::string> names) const {
    std::vector<std::string> frames;
    for (std::string& name : names) {
      const FileFormat* const format = format_of_suffix(name, kScanFrame);
      if (format && format_ && format != format_)
        log::warn_once(folder_ + ": " + format->name + " files are left out");
      else if (format)
        frames.push_back(std::move(name));
    }
    return format_ ? frames : frame_files(folder_, frames);
  }

  ScanFrame next_ready() {
    ScanFrame frame = std::move(ready_.front());
    ready_.pop_front();
    return frame;
  }

  void note_gap(const FollowedFile& file) {
    if (file.missing == 0) return;
    gaps.push_back({file.last_number + file.step, file.last_number + file.missing * file.step});
    log::warn(folder_ + ": frames are missing before " + file.name);
    for (int64_t i = 1; i <= file.missing && file.missing <= kLongestGap; ++i)
      ready_.push_back(missing_frame(folder_, file.last_number + i * file.step));
  }

  std::string folder_;
  const FileFormat* format_ = nullptr;  // of the first frame
  FolderFollower files_;
  std::deque<ScanFrame> ready_;  // missing ones and the one after them
};

}  // namespace

std::unique_ptr<ScanSource::Frames> follow_folder(const std::string& folder,
                                                  const ScanSourceOptions& options) {
  return std::make_unique<FollowedFolder>(folder, options);
}

}  // namespace understudy
