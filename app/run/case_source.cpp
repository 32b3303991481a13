#include "app/run/case_source.hpp"

#include <cmath>
#include <map>

#include "retarget/base/error.hpp"

namespace understudy::app {
namespace {

constexpr double kOffFrame = 0.05;  // of a frame

void add_scans(const Case& c, std::map<int64_t, KnownFrame>& frames) {
  const auto source = open_source(case_source(c));
  while (const auto frame = source->next())
    if (frame->usable) frames[frame->number].points = frame->mesh.vertices;
}

void add_markers(const Case& c, std::map<int64_t, KnownFrame>& frames) {
  for (MarkerFrame& seen : read_markers(c.markers, c.fps)) {
    const double at = seen.seconds * c.fps;
    const auto frame = static_cast<int64_t>(std::llround(at));
    US_CHECK(frame >= 0 && std::abs(at - static_cast<double>(frame)) <= kOffFrame, c.markers,
             ": has markers at ", seen.seconds, " s, when there is no frame");
    US_CHECK(!c.gaps || frame < c.gaps->frames, c.markers, ": has markers at ", seen.seconds,
             " s, after the last of ", c.gaps->frames, " frames");
    frames[frame].markers = std::move(seen.markers);
  }
}

}  // namespace

SourceOptions case_source(const Case& c) {
  SourceOptions options;
  options.path = c.source;
  options.times = c.times;
  options.fps = c.fps;
  options.import.units = "m";
  options.import.up = "y";
  options.import.floor = 0.0f;
  if (c.fov > 0) options.fov = c.fov;
  options.quiet = true;  // nothing was decided
  return options;
}

std::vector<KnownFrame> known_frames_of(const Case& c) {
  std::map<int64_t, KnownFrame> frames;
  if (!c.source.empty()) add_scans(c, frames);
  if (!c.markers.empty()) add_markers(c, frames);
  std::vector<KnownFrame> known;
  for (auto& [number, frame] : frames) {
    frame.frame = number;
    frame.seconds = static_cast<double>(number) / c.fps;
    known.push_back(std::move(frame));
  }
  return known;
}

}  // namespace understudy::app
