#include "retarget/keypoints/keypoint_track.hpp"

#include <algorithm>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/text.hpp"

namespace understudy {

std::string canvas_text(const Canvas& canvas) {
  return std::to_string(canvas.width) + " x " + std::to_string(canvas.height);
}

Canvas parse_canvas(const std::string& text) {
  const std::vector<std::string> sides = split(lower_case(text), 'x');
  int64_t width = 0, height = 0;
  const bool good = sides.size() == 2 && parse_integer(sides[0], width) && parse_integer(sides[1], height) &&
                    width > 0 && height > 0 && width <= kLargestCanvas && height <= kLargestCanvas;
  US_CHECK(good, "a canvas is given as 1280x720, each side at most ", kLargestCanvas, " pixels, not as '",
           excerpt(text), "'");
  return {static_cast<int>(width), static_cast<int>(height)};
}

const FlatPose* KeypointTrack::at(int64_t frame) const {
  const auto found = std::lower_bound(poses.begin(), poses.end(), frame,
                                      [](const TrackedPose& pose, int64_t f) { return pose.frame < f; });
  return found != poses.end() && found->frame == frame ? &found->pose : nullptr;
}

double KeypointReading::seconds(int64_t frame) const {
  return static_cast<double>(frames[static_cast<size_t>(frame)].number - frames.front().number) / fps;
}

int KeypointReading::track_of(int64_t person) const {
  for (int t = 0; t < ssize(tracks); ++t)
    if (tracks[static_cast<size_t>(t)].person == person) return t;
  return -1;
}

}  // namespace understudy
