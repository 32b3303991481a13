#include "retarget/motion/clip.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"
#include "retarget/formats/bytes.hpp"

namespace understudy {
namespace {

constexpr double kUsualFps = 30, kHighestFps = 1000;
constexpr double kMostFrames = 24 * 3600 * 60;

/// Whole rates where they nearly are: times in files are rounded.
double tidy_fps(double fps) {
  const double whole = std::round(fps);
  return whole > 0 && std::abs(fps / whole - 1) < 5e-4 ? whole : fps;
}

bool is_rate(double fps) {
  return fps >= 1 && fps <= kHighestFps;
}

/// Keys that were left out leave gaps of several frames: the rate is that of the shortest gap, if all others
/// are multiples of it.
double rate_of(std::vector<float> times) {
  std::sort(times.begin(), times.end());
  double shortest = 1;
  for (size_t i = 1; i < times.size(); ++i) {
    const double gap = static_cast<double>(times[i]) - static_cast<double>(times[i - 1]);
    if (gap > 0.5 / kHighestFps) shortest = std::min(shortest, gap);
  }
  const double fps = std::abs(1 / shortest - std::round(1 / shortest)) < 0.02 / shortest
                         ? std::round(1 / shortest)  // gaps are small differences of large times
                         : 1 / shortest;
  for (const float time : times) {
    const double frames = (static_cast<double>(time) - static_cast<double>(times[0])) * fps;
    if (std::abs(frames - std::round(frames)) > 0.1) return kUsualFps;
  }
  return is_rate(fps) ? fps : kUsualFps;
}

double own_fps(const CharacterAnimation& animation) {
  const CharacterTrack* most = nullptr;
  for (const auto& track : animation.tracks)
    if (most == nullptr || track.times.size() > most->times.size()) most = &track;
  if (most == nullptr || most->times.size() < 2) return kUsualFps;
  const auto n = static_cast<double>(most->times.size() - 1);
  const double step =
      (static_cast<double>(most->times.back()) - static_cast<double>(most->times.front())) / n;
  bool even = step > 0;
  for (size_t i = 0; even && i < most->times.size(); ++i)
    even = std::abs(static_cast<double>(most->times[i]) - static_cast<double>(most->times.front()) -
                    step * static_cast<double>(i)) < 0.05 * step;
  if (even && is_rate(tidy_fps(1 / step))) return tidy_fps(1 / step);
  std::vector<float> all;
  for (const auto& track : animation.tracks) all.insert(all.end(), track.times.begin(), track.times.end());
  return rate_of(std::move(all));
}

}  // namespace

int chosen_clip(const Character& character, const std::string& clip) {
  const auto& animations = character.animations;
  US_CHECK(!animations.empty(), character.called(), ": has no animation");
  int longest = 0;
  std::string names;
  for (size_t i = 0; i < animations.size(); ++i) {
    if (!clip.empty() && (animations[i].name == clip || std::to_string(i + 1) == clip))
      return static_cast<int>(i);
    if (animations[i].duration() > animations[longest].duration()) longest = i;
    if (i < 20) names += (i > 0 ? ", " : "") + std::to_string(i + 1) + " " + excerpt(animations[i].name);
  }
  US_CHECK(clip.empty(), character.called(), ": has no animation '", excerpt(clip), "', only ", names);
  return longest;
}

ClipTimes clip_times(const Character& character, int clip, double fps) {
  const CharacterAnimation& animation = character.animations.at(clip);
  ClipTimes out;
  double first = -1, last = 0;
  for (const auto& track : animation.tracks) {
    if (track.times.empty()) continue;
    const auto begin = static_cast<double>(track.times.front());
    first = first < 0 ? begin : std::min(first, begin);
    last = std::max(last, static_cast<double>(track.times.back()));
  }
  out.start = std::max(0.0, first);
  const double own = own_fps(animation);
  out.fps = fps > 0 ? fps : own;
  const double count = std::floor((last - out.start) * out.fps + 0.1) + 1;
  US_CHECK(count <= kMostFrames, character.called(), ": its animation '", excerpt(animation.name), "' is ",
           last - out.start, " s long at ", out.fps, " frames/s, only ", static_cast<int64_t>(kMostFrames),
           " frames are read (a day at 60 frames/s)");
  out.count = static_cast<int64_t>(count);
  return out;
}

}  // namespace understudy
