// People over the frames of a file of 2D poses, and what was decided when it was read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "retarget/keypoints/flat_pose.hpp"

namespace understudy {

constexpr int kLargestCanvas = 65536;

/// Size of the picture that the points lie on, pixels; each side at most kLargestCanvas.
struct Canvas {
  int width = 0, height = 0;
  bool is_known() const { return width > 0 && height > 0; }
};
inline bool operator==(const Canvas& a, const Canvas& b) {
  return a.width == b.width && a.height == b.height;
}
/// "1280 x 720".
std::string canvas_text(const Canvas& canvas);
/// Of "1280x720". Throws Error when it is not two whole numbers from 1 to 65,536.
Canvas parse_canvas(const std::string& text);

/// One frame of a reading, whoever is in it.
struct KeypointFrame {
  int64_t number = 0;   ///< in the file or its name; 0, 1, 2 ... where these tell none
  std::string problem;  ///< why nothing in it can be used, one sentence; empty: it could be read
};

/// A person in one frame, as the file has them: nothing is smoothed, filled or exchanged.
struct TrackedPose {
  int64_t frame = 0;  ///< position among the reading's frames
  float score = 1;    ///< of the whole person where the file tells one
  FlatPose pose;
};

/// One person over the frames.
struct KeypointTrack {
  int64_t person = 0;              ///< the file's own number, else 1, 2 ... as they appear
  std::vector<TrackedPose> poses;  ///< frames rise; those without the person are left out
  /// What the person did in a frame; null when they are not in it.
  const FlatPose* at(int64_t frame) const;
};

/// All that a file or folder of poses holds.
struct KeypointReading {
  std::string path;
  std::string format;              ///< for people: "OpenPose folder"
  std::string layout;              ///< label of the layout, see KeypointLayout
  Canvas canvas;                   ///< always known
  bool canvas_is_guessed = false;  ///< nothing tells it: the smallest usual one that holds the points
  double fps = 30;
  bool fps_is_guessed = true;         ///< nothing tells it: 30
  std::vector<KeypointFrame> frames;  ///< numbers rise; what is missing is there as a frame with a problem
  std::vector<KeypointTrack> tracks;  ///< who is seen longest first; at least one
  int performer = 0;                  ///< which of the tracks performs
  std::vector<std::string> told;      ///< sentences: what was decided, guessed or left out

  double seconds(int64_t frame) const;  ///< since the first frame, by its number
  /// The track of this person, -1 when there is none.
  int track_of(int64_t person) const;
  const KeypointTrack& performing() const { return tracks[static_cast<size_t>(performer)]; }
};

}  // namespace understudy
