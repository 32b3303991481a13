// From what files list to people in pixels: decides by the first frame with somebody in it, and tells.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "retarget/keypoints/keypoint_layout.hpp"
#include "retarget/keypoints/keypoint_reader.hpp"
#include "retarget/keypoints/people_tracker.hpp"
#include "retarget/keypoints/raw_people.hpp"

namespace understudy {

/// What a picture beside the file says.
struct PictureBeside {
  std::string path;
  Canvas canvas;
};

class FrameDecoder : public RawSink {
 public:
  /// Throws Error for a layout that does not exist, a rate below 0 or above 1000.
  FrameDecoder(std::string source, const KeypointReaderOptions& options,
               std::optional<PictureBeside> picture);

  void begin(const RawFacts& facts) override;
  void frame(int64_t number, const std::function<RawFrame()>& read) override;
  /// Throws Error when nobody is in any frame, or the person who is to perform is not there.
  KeypointReading finish();

  // While frames come.
  double fps() const { return fps_; }
  /// Unknown where nothing told it yet.
  Canvas canvas() const;
  int64_t frame_count() const { return static_cast<int64_t>(frames_.size()); }
  /// Of the last frame; empty: it could be read.
  std::string last_problem() const { return frames_.empty() ? "" : frames_.back().problem; }
  /// Frames are counted as they came, gaps are not.
  const std::vector<KeypointTrack>& tracks() const { return tracks_; }

 private:
  enum class Scale { Pixels, Fractions, Signed };  // the canvas is 0..1, -1..1
  struct Oddities {
    int64_t above_one = 0, below_zero = 0, not_finite = 0, off_canvas = 0, far_away = 0;
    float highest = 0;
  };
  struct Decisions {
    KeypointLayout layout;
    Scale scale = Scale::Pixels;
    Canvas canvas;            // unknown: to be guessed at the end
    std::string canvas_from;  // "as the file says"
    bool all_are_seen = false, is_logit = false;
  };

  std::vector<PersonSighting> decode(const RawFrame& frame, int64_t number);
  Decisions decide(const RawFrame& frame, int64_t number);
  KeypointLayout layout_for(const RawPerson& person, int64_t number) const;
  Scale scale_of(const RawFrame& frame, bool all_are_seen) const;
  Canvas canvas_for(const RawFrame& frame, std::string& from) const;
  void check_like_first(const RawFrame& frame, int64_t number) const;
  bool is_place(const float* row, Scale scale) const;
  float confidence_of(float raw, bool has_confidence);
  FlatPoints in_pixels(const FlatPoints& raw, bool has_confidence);
  FlatPose pose_of(const RawPerson& person, const std::string& what);
  void keep_people(const std::vector<PersonSighting>& people, double dt);

  void fill_gaps(KeypointReading& reading) const;
  void guess_canvas(KeypointReading& reading) const;
  void choose_performer(KeypointReading& reading) const;
  void tell(KeypointReading& reading) const;
  void tell_oddities(KeypointReading& reading) const;

  std::string source_;
  KeypointReaderOptions options_;
  std::optional<PictureBeside> picture_;
  RawFacts facts_;
  bool has_begun_ = false;
  double fps_ = 30;
  std::optional<Decisions> decided_;
  bool wants_canvas_ = false;  // could not be decided without
  PeopleTracker tracker_;
  std::vector<KeypointFrame> frames_;
  std::vector<KeypointTrack> tracks_;
  Oddities odd_;
  FlatBox extent_;  // of all points
  int64_t left_out_ = 0, first_left_out_ = 0;
};

}  // namespace understudy
