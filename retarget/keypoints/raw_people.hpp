// People of a frame as a file lists them, before anybody decided what the numbers mean.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "retarget/keypoints/keypoint_track.hpp"

namespace understudy {

struct RawPerson {
  std::optional<int64_t> id;  ///< the file's own number of the person
  float score = 1;
  FlatPoints points;                       ///< [K, 3], as they come: NaN, any scale, any confidence
  bool has_confidence = true;              ///< false: the file gives none, the column is 1
  FlatPoints left_hand, right_hand, face;  ///< where they are listed apart from the body, else no rows
};

struct RawFrame {
  int64_t number = 0;
  Canvas canvas;  ///< unknown: the frame does not tell
  std::vector<RawPerson> people;
};

/// What the third number of a point is.
enum class RawConfidence { Score, Visibility, Logit };  // COCO's 0, 1, 2; MediaPipe's, which may be logits

/// What a file says, or its format implies, of all its frames.
struct RawFacts {
  std::string format;
  std::vector<std::string> names;  ///< of the points, in the file's order; empty: the count tells
  std::string layout;              ///< name of the layout where the file tells it
  std::string layout_of_15;        ///< 15 points are MPI's or BODY_25's first: which where the format tells
  RawConfidence confidence = RawConfidence::Score;
  bool may_be_signed = false;  ///< fractions may be -1..1, as OpenPose's --keypoint_scale 4 has them
  bool to_last_pixel = false;  ///< 1 is the last pixel (OpenPose's), not the border behind it
  double fps = 0;              ///< 0: not told
  Canvas canvas;               ///< not told: unknown
};

/// Where readers of formats put what they find: facts first, then the frames by rising numbers.
class RawSink {
 public:
  virtual ~RawSink() = default;
  virtual void begin(const RawFacts& facts) = 0;
  /// `read` gives the people; where it throws Error that is the frame's problem.
  virtual void frame(int64_t number, const std::function<RawFrame()>& read) = 0;
};

constexpr int kMostPeople = 200;           // of one frame: more is no picture of people
constexpr int64_t kMostFrames = 10000000;  // numbers up to 2^24 are whole in a float

}  // namespace understudy
