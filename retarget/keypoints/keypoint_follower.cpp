#include "retarget/keypoints/keypoint_follower.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <thread>

#include "retarget/base/error.hpp"
#include "retarget/formats/scan_frames.hpp"
#include "retarget/keypoints/frame_decoder.hpp"
#include "retarget/keypoints/pose_files.hpp"
#include "retarget/keypoints/pose_json.hpp"

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

}  // namespace

class KeypointFollower::Folder {
 public:
  Folder(std::string path, const KeypointReaderOptions& options, KeypointFollowOptions follow)
      : path_(std::move(path)),
        person_(options.person),
        follow_(std::move(follow)),
        decoder_(path_, without_person(options), picture_of_folder(path_, options)),
        last_news_(Clock::now()) {
    pose_files_of(path_);  // throws when it cannot be read
  }

  std::optional<FollowedPose> next() {
    while (ready_.empty() && !ended_) {
      if (follow_.cancelled && follow_.cancelled()) break;
      if (look()) continue;
      if (!ended_) std::this_thread::sleep_for(std::chrono::duration<double>(follow_.poll_s));
    }
    if (ready_.empty()) {
      ended_ = true;
      return {};
    }
    FollowedPose frame = std::move(ready_.front());
    ready_.pop_front();
    return frame;
  }
  double fps() const { return decoder_.fps(); }
  Canvas canvas() const { return decoder_.canvas(); }
  KeypointReading finish() {
    KeypointReading reading = decoder_.finish();
    if (performer_) reading.performer = std::max(reading.track_of(*performer_), 0);
    return reading;
  }

 private:
  // Who performs may come later: until then nobody does.
  static KeypointReaderOptions without_person(KeypointReaderOptions options) {
    options.person.reset();
    return options;
  }

  /// True: something happened.
  bool look() {
    if (waiting_.size() < 2) {
      const auto names = pose_files_of(path_);
      waiting_.assign(std::upper_bound(names.begin(), names.end(), last_name_, natural_less), names.end());
    }
    std::error_code error;
    const bool done =
        fs::exists(fs::path(path_) / "done", error) || fs::exists(fs::path(path_) / ".done", error);
    const double idle = std::chrono::duration<double>(Clock::now() - last_news_).count();
    const bool late = idle >= follow_.timeout_s;
    if (waiting_.empty()) {
      US_CHECK(!late || handed_out_ > 0, path_, ": no frame came within ", follow_.timeout_s, " s");
      US_CHECK(!done || handed_out_ > 0, path_, ": holds no frames");
      ended_ = done || late;
      return ended_;
    }
    const bool written = done || late || waiting_.size() > 1;
    if (!written && !stands_still((fs::path(path_) / waiting_.front()).string())) return false;
    return take(written);
  }

  bool stands_still(const std::string& path) {
    const FileState now = state_of(path);
    const bool still = path == watched_ && now == state_ && now.first > 0;
    watched_ = path;
    state_ = now;
    return still;
  }

  /// A file that cannot be read may still be growing, unless its writer has gone on.
  bool take(bool written) {
    const std::string name = waiting_.front(), path = (fs::path(path_) / name).string();
    const int64_t number = frame_number(name).value_or(handed_out_);
    RawFrame raw;
    RawFacts facts;
    const std::string problem = failure_of([&] { raw = read_pose_file(path, number, facts); });
    if (!written && !problem.empty()) return false;
    waiting_.pop_front();
    last_name_ = name;
    last_news_ = Clock::now();
    const int64_t before = decoder_.frame_count();
    decoder_.frame(number, [&]() -> RawFrame {
      US_CHECK(problem.empty(), problem);
      decoder_.begin(facts);
      return raw;
    });
    if (decoder_.frame_count() == before) return true;  // it is there twice, which the reading tells
    note_gap(number);
    hand_out(number);
    return true;
  }

  void note_gap(int64_t number) {
    if (handed_out_ == 1) step_ = number - number_;
    if (handed_out_ < 2) return;
    const int64_t missing = missing_between(number - number_, step_);
    for (int64_t k = 1; k <= missing && missing <= kLongestGap; ++k) {
      const int64_t left_out = number_ + k * step_;
      ready_.push_back(
          {left_out, static_cast<double>(step_) / fps(), {}, frame_of(path_, left_out) + " is missing"});
    }
    if (missing > 0 && missing <= kLongestGap) number_ += missing * step_;
  }

  void hand_out(int64_t number) {
    FollowedPose frame;
    frame.number = number;
    frame.dt = static_cast<double>(handed_out_ > 0 ? number - number_ : 1) / fps();
    frame.problem = decoder_.last_problem();
    if (!performer_) performer_ = choose();
    const int64_t at = decoder_.frame_count() - 1;
    if (performer_)
      for (const KeypointTrack& track : decoder_.tracks())
        if (track.person == *performer_ && !track.poses.empty() && track.poses.back().frame == at)
          frame.pose = track.poses.back().pose;
    if (!frame.pose && frame.problem.empty())
      frame.problem = performer_ ? "person " + std::to_string(*performer_) + " is not seen in frame " +
                                       std::to_string(number)
                                 : "nobody is seen in frame " + std::to_string(number);
    number_ = number;
    ++handed_out_;
    ready_.push_back(std::move(frame));
  }

  std::optional<int64_t> choose() const {
    std::optional<int64_t> largest;
    float size = -1;
    for (const KeypointTrack& track : decoder_.tracks()) {
      if (track.poses.empty()) continue;
      if (person_ && track.person == *person_) return track.person;
      const float now = size_of(track.poses.back().pose);
      if (!person_ && now > size) largest = track.person, size = now;
    }
    return largest;
  }

  std::string path_;
  std::optional<int64_t> person_, performer_;
  KeypointFollowOptions follow_;
  FrameDecoder decoder_;
  std::deque<std::string> waiting_;
  std::deque<FollowedPose> ready_;
  std::string last_name_, watched_;
  FileState state_;
  int64_t number_ = 0, step_ = 1, handed_out_ = 0;
  Clock::time_point last_news_;
  bool ended_ = false;
};

KeypointFollower::KeypointFollower(const std::string& folder, const KeypointReaderOptions& options,
                                   const KeypointFollowOptions& follow)
    : folder_(std::make_unique<Folder>(folder, options, follow)) {}
KeypointFollower::~KeypointFollower() = default;

std::optional<FollowedPose> KeypointFollower::next() {
  return folder_->next();
}
double KeypointFollower::fps() const {
  return folder_->fps();
}
Canvas KeypointFollower::canvas() const {
  return folder_->canvas();
}
KeypointReading KeypointFollower::finish() {
  return folder_->finish();
}

}  // namespace understudy
