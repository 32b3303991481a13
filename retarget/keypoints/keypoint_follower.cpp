#include "retarget/keypoints/keypoint_follower.hpp"

#include <algorithm>
#include <deque>

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"
#include "retarget/formats/scan_frames.hpp"
#include "retarget/keypoints/frame_decoder.hpp"
#include "retarget/keypoints/pose_files.hpp"
#include "retarget/keypoints/pose_json.hpp"

namespace understudy {

class KeypointFollower::Folder {
 public:
  Folder(const std::string& path, const KeypointReaderOptions& options, const FolderFollowOptions& follow)
      : path_(path),
        person_(options.person),
        files_(path, follow, poses_among),
        decoder_(path, without_person(options), picture_of_folder(path, options)) {}

  std::optional<FollowedPose> next() {
    while (ready_.empty())
      if (!take()) return {};
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
  static std::vector<std::string> poses_among(std::vector<std::string> names) {
    names.erase(std::remove_if(names.begin(), names.end(),
                               [](const std::string& name) { return file_suffix(name) != ".json"; }),
                names.end());
    return names;
  }
  // Who performs may come later: until then nobody does.
  static KeypointReaderOptions without_person(KeypointReaderOptions options) {
    options.person.reset();
    return options;
  }

  /// False: the folder has ended.
  bool take() {
    RawFrame raw;
    RawFacts facts;
    std::string problem;
    const auto file = files_.next([&](const FollowedFile& read) {
      problem = failure_of([&] { raw = read_pose_file(read.path, read.number, facts); });
      return problem.empty();
    });
    if (!file) return false;
    const int64_t before = decoder_.frame_count();
    decoder_.frame(file->number, [&]() -> RawFrame {
      US_CHECK(problem.empty(), problem);
      decoder_.begin(facts);
      return raw;
    });
    if (decoder_.frame_count() == before) {
      files_.forget_last();  // it is there twice, which the reading tells
      return true;
    }
    hand_out(file->number, note_gap(*file));
    return true;
  }

  /// The number of the last frame before the file, handed out or missing.
  int64_t note_gap(const FollowedFile& file) {
    if (file.missing == 0 || file.missing > kLongestGap) return number_;
    const double dt = static_cast<double>(file.step) / fps();
    for (int64_t k = 1; k <= file.missing; ++k) {
      const int64_t left_out = file.last_number + k * file.step;
      ready_.push_back({left_out, dt, {}, frame_of(path_, left_out) + " is missing"});
    }
    return file.last_number + file.missing * file.step;
  }

  void hand_out(int64_t number, int64_t before) {
    FollowedPose frame;
    frame.number = number;
    frame.dt = static_cast<double>(decoder_.frame_count() > 1 ? number - before : 1) / fps();
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
  FolderFollower files_;
  FrameDecoder decoder_;
  std::deque<FollowedPose> ready_;
  int64_t number_ = 0;
};

KeypointFollower::KeypointFollower(const std::string& folder, const KeypointReaderOptions& options,
                                   const FolderFollowOptions& follow)
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
