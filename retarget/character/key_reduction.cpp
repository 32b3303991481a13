#include "retarget/character/character_export.hpp"

#include <algorithm>
#include <cmath>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

/// How far key `i` is from what the keys `a` and `b` give at its time.
float deviation(const CharacterTrack& track, size_t width, size_t a, size_t b, size_t i) {
  const float u = (track.times[i] - track.times[a]) / (track.times[b] - track.times[a]);
  const float *va = &track.values[a * width], *vb = &track.values[b * width], *vi = &track.values[i * width];
  if (track.path == TrackPath::Rotation) {
    const Eigen::Quaternionf qa(va), qb(vb), qi(vi);
    const float sign = qa.dot(qb) < 0 ? -1.0f : 1.0f;  // engines go along the arc, or along its chord
    const Eigen::Quaternionf chord((1 - u) * qa.coeffs() + u * sign * qb.coeffs());
    return std::max(qa.slerp(u, qb).angularDistance(qi), chord.normalized().angularDistance(qi));
  }
  float sum = 0;
  for (size_t k = 0; k < width; ++k) sum += std::pow((1 - u) * va[k] + u * vb[k] - vi[k], 2.0f);
  return std::sqrt(sum);
}

}  // namespace

CharacterTrack reduced(const CharacterTrack& track, float tolerance) {
  US_CHECK(track.interpolation == TrackInterpolation::Linear, "only linear tracks can be reduced");
  const size_t count = track.times.size();
  if (count < 2) return track;
  const size_t width = track.values.size() / count;
  std::vector<bool> keep(count, false);
  keep[0] = keep[count - 1] = true;
  std::vector<std::pair<size_t, size_t>> open = {{0, count - 1}};
  while (!open.empty()) {  // split where it is worst (Douglas and Peucker)
    const auto [a, b] = open.back();
    open.pop_back();
    float worst = tolerance;
    size_t at = 0;
    for (size_t i = a + 1; i < b; ++i)
      if (const float d = deviation(track, width, a, b, i); d > worst) {
        worst = d;
        at = i;
      }
    if (at == 0) continue;
    keep[at] = true;
    open.emplace_back(a, at);
    open.emplace_back(at, b);
  }
  CharacterTrack out = track;
  out.times.clear();
  out.values.clear();
  const bool still = std::count(keep.begin(), keep.end(), true) == 2 &&
                     std::equal(track.values.begin(), track.values.begin() + static_cast<long>(width),
                                track.values.end() - static_cast<long>(width));
  for (size_t i = 0; i < (still ? 1 : count); ++i) {
    if (!keep[i]) continue;
    out.times.push_back(track.times[i]);
    out.values.insert(out.values.end(), track.values.begin() + static_cast<long>(i * width),
                      track.values.begin() + static_cast<long>((i + 1) * width));
  }
  return out;
}

}  // namespace understudy
